// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/Box.h"
#include "Core/Common/Select.h"
#include "Core/Common/ThrowInvalidArgument.h"
#include "Core/Evolution/Evolution.h"
#include "Core/Evolution/InitialSurface.h"
#include "Core/Evolution/MissedParts.h"
#include "Core/Mesh/SurfaceCheck.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace volumic
{
namespace
{
void Enter(Evolution& e)
{
  const LevelImage& image = e.Task.Image;
  e.MakeField();
  e.State.Margin = e.TheField->Margin();
  e.State.Sizing = SizingField(static_cast<float>(e.Task.Options.SamplingRatio * image.Unit));
  e.Status = Monitor::Status();
  e.Status.Level = e.Task.Level;
  e.History.BeginLevel(e.Task.Level);
}

Box BoxOfGrid(const Evolution& e)
{
  const SurfaceMesh& mesh = e.State.Mesh;
  const LevelImage& image = e.Task.Image;
  const Box ofImage = { Vector(0, 0, 0),
    Vector(static_cast<float>(image.Size[0] * image.Step[0]),
      static_cast<float>(image.Size[1] * image.Step[1]),
      static_cast<float>(image.Size[2] * image.Step[2])) };
  const Box all = JoinVertices(
    mesh, e.Threads, ofImage,
    [&mesh](int v, Box& box) {
      box = box.With({ mesh.Position[v], mesh.Position[v] });
    },
    [](const Box& a, const Box& b) { return a.With(b); });
  return all.Grown(2 * e.State.Sizing.Largest());
}

RecoverySurfaces FindParts(
  Evolution& e, PartKind kind, int minimumSize, RecoveryShape shape, double from, double to)
{
  const auto find = [&]
  {
    return FindMissedParts(e.State, *e.TheField, kind, minimumSize, shape, e.Threads,
      e.ProgressCallbackOf(Monitor::Activity::Recovering, from, to));
  };
  RecoverySurfaces recovery = find();
  if (recovery.Found > 0 && e.Task.Options.RecoverMissedParts && e.State.Sizing.IsGraded())
  {
    DivideNear(e, recovery.Boundary); // Otherwise there is no room for near recovery surfaces.
    recovery = find();
  }
  return recovery;
}

/** Add recovery surfaces. Intersecting components are replaced by those of RecoveryShape::Safe. */
template <typename MakeSafe>
void Enclose(Evolution& e, const IndexedSurface& even, const MakeSafe& makeSafe)
{
  if (!e.Blocks->Append(even, false, e.Threads))
  {
    const IndexedSurface safe = makeSafe();
    if (!e.Stopped)
    {
      e.Blocks->Append(safe, true, e.Threads);
    }
  }
  ++e.Unchecked;
}

/** Recover missed parts. @param isStart start with all parts of the object, of any size */
void Recover(Evolution& e, bool isStart = false)
{
  const SurfaceOptions& options = e.Task.Options;
  // Without an iso-value the object is undefined.
  if (!options.Drive().HasObject && !isStart)
  {
    return;
  }
  const bool recovers = options.RecoverMissedParts || isStart;
  const bool hasCavities = options.RecoverMissedParts && options.RecoverCavities && !isStart;
  const int size = isStart ? 1 : options.MinimumPartSize;
  const double objectShare = hasCavities ? 0.5 : 1.;
  RecoverySurfaces objects =
    FindParts(e, PartKind::Object, size, RecoveryShape::Even, 0., objectShare);
  RecoverySurfaces cavities;
  if (hasCavities && !e.Stopped)
  {
    cavities = FindParts(e, PartKind::Cavity, size, RecoveryShape::Even, objectShare, 1.);
  }
  if (e.Stopped)
  {
    return;
  }
  e.Missed.Found = objects.Found;
  e.Missed.Enclosed = recovers ? objects.Enclosed : 0;
  e.Missed.FoundCavities = cavities.Found;
  e.Missed.EnclosedCavities = cavities.Enclosed;
  e.Boundary.Add(objects.Boundary);
  e.Boundary.Add(cavities.Boundary);
  for (const PartKind kind : { PartKind::Object, PartKind::Cavity })
  {
    const RecoverySurfaces& recovery = kind == PartKind::Object ? objects : cavities;
    if (recovers && recovery.Enclosed > 0)
    {
      Enclose(e, recovery.Surface,
        [&] { return FindParts(e, kind, size, RecoveryShape::Safe, 1., 1.).Surface; });
    }
  }
}

void PlaceSeeds(Evolution& e, const std::vector<Point>& centres)
{
  const double delta = e.State.Sizing.OfLevel();
  const double requested = e.Task.Options.SeedRadius;
  const double radius = std::max(requested > 0. ? requested : 1.2 * delta, SmallestSeed * delta);
  for (const Point& centre : ChooseSeeds(*e.TheField, centres, 2. * radius + 1.6 * delta))
  {
    e.State.Mesh.Append(DividedIcosahedron(centre, radius, 2. * delta));
  }
  Renumber(e);
}

void Start(Evolution& e, const SurfaceStart& start)
{
  using Kind = SurfaceStart::Kind;
  if (start.From == Kind::Surface)
  {
    CheckInitialSurface(start.Surface);
    CheckOverlapsImage(start.Surface, e.Task.Image);
  }
  Enter(e);
  const bool isIso = start.From == Kind::IsoSurface;
  if (start.From == Kind::EnclosingParts || isIso)
  {
    Renumber(e);
    Recover(e, isIso);
  }
  const bool isEnclosed =
    e.Missed.Enclosed > 0 || (start.From == Kind::EnclosingParts && e.Stopped);
  if (start.From == Kind::Surface)
  {
    TakeGiven(e, start.Surface);
  }
  else if (isIso && !e.Stopped)
  {
    if (!isEnclosed)
    {
      ThrowInvalidArgument(
        "there is no isosurface to start from: no voxel of this level lies in the object. "
        "Choose another Iso Value, a finer Coarsest Level, or another Initialization.");
    }
    e.HasDescended = true;
    ActivateWhereOff(e, Dynamics::LeftOff);
  }
  else if (start.From == Kind::Seeds)
  {
    PlaceSeeds(e, start.Seeds);
  }
  else if (!isEnclosed && !isIso)
  {
    e.State.Mesh.Append(EnclosingSurface(e.Task.Image, e.State.Sizing.OfLevel()));
    Renumber(e);
    e.GoOn(Monitor::Activity::Starting, 1.);
  }
}

void Divide(Evolution& e, const ConvergedSurface& converged)
{
  e.Unchecked = converged.Unchecked;
  const double coarse = converged.Delta;
  Enter(e);
  // The number of divisions that brings delta nearest to the new one: 1 for a pyramid factor of
  // sqrt 3.
  const int divisions = static_cast<int>(std::lround(
    std::log(coarse / e.State.Sizing.OfLevel()) / std::log(SizingField::DivisionFactor)));
  // After each of these steps the surface is a valid result.
  const bool isGraded = e.Task.Grading.IsRequested();
  // Parts that are too thin for the undivided mesh vanish in a descent, and must be recovered.
  // Outside the image the field is that of the coarser level.
  const bool descends = e.Task.Options.Drive().IsPredictable && e.Task.Options.RecoverMissedParts;
  if (descends && !isGraded && divisions > 0 && e.Task.Level >= 0)
  {
    DescendField(e, coarse);
  }
  bool goesOn = true;
  if (!isGraded || divisions == 0 || !DivideWhereRequested(e, coarse))
  {
    goesOn = DivideAll(e, divisions);
  }
  goesOn = e.GoOn(Monitor::Activity::Dividing, 1.) && goesOn;
  if (goesOn)
  {
    Recover(e);
  }
  if (e.HasDescended)
  {
    ActivateWhereOff(e, Dynamics::LeftOff);
  }
  e.GoOn(Monitor::Activity::Recovering, 1.);
}
}

void Renumber(Evolution& e)
{
  SurfaceState& s = e.State;
  ForgetBlocks(e);
  s.Mesh.Reorder(SpaceFillingOrder(s.Mesh, s.Sizing.Smallest(), e.Threads), e.Threads);
  LayOut(e);
}

void LayOut(Evolution& e)
{
  ForgetBlocks(e);
  LayGrid(e);
  MakeBlocks(e);
  Sweep sweep;
  sweep.IsMonitored = false;
  SplitLongEdges(e, sweep);
  LabelComponents(e);
}

void LayGrid(Evolution& e)
{
  const Box box = BoxOfGrid(e);
  e.State.Reset(box.Low, box.High, e.Threads);
  e.State.UpdateShape(AliveVertices(e), e.Threads);
}

std::vector<int> AliveVertices(const Evolution& e)
{
  return SelectIndices(e.Threads, e.State.Mesh.Rings.size(),
    [&e](std::size_t v) { return e.State.Mesh.IsAlive(static_cast<int>(v)); });
}

void ActivateAll(Evolution& e)
{
  SurfaceState& s = e.State;
  ForAlive(s.Mesh, e.Threads, [&s](int v) { s.Active[v] = 1; });
}

bool ReachLevel(Evolution& e, ConvergedSurface& converged)
{
  if (e.Task.Start)
  {
    Start(e, *e.Task.Start);
    return true;
  }
  std::swap(e.State.Mesh, converged.Mesh);
  e.Status.Level = converged.Level;
  if (!e.GoOn(Monitor::Activity::Regularising, 1.))
  {
    std::swap(e.State.Mesh, converged.Mesh);
    return false;
  }
  Divide(e, converged);
  return true;
}
}
