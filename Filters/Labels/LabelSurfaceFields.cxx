// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// The fields that LabelSurfaceMaker makes surfaces of, and how they change where a surface should
// be elsewhere.

#include "Labels/LabelSurface.h"

#include "Core/Image/VoxelNumbers.h"
#include "Core/Labels/DrawBack.h"
#include "Core/Labels/TouchingSurfaces.h"
#include "Core/Labels/WrongVoxels.h"
#include "Core/Mesh/SurfaceFeatures.h"
#include "Input/Workspace.h"

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace volumic
{
namespace
{
/**
 * Margins of voxels that the triangles have cut off, round after round of the surface, in smallest
 * distances of voxels.
 */
constexpr std::array<float, 2> FurtherMargins = { 0.3f, 0.5f };

/** With Gap only voxels are held that its isopotential has so far inside, in the same. */
constexpr double LeastHeldInGap = 0.1;

/**
 * Of a coarser level: how much of its Laplacian is taken off the field, times the square of the
 * level's unit less 1. A quarter makes up for the Gaussian of the pyramid, the rest for chords.
 */
constexpr double BendPerLevel = 0.4;

/**
 * By what fields are lowered, at least, where surfaces of neighbours touch, in smallest distances
 * of voxels: half a small gap would not part triangles that are deep in each other.
 */
constexpr double LeastLowering = 0.2;

/**
 * By what the whole field of an object is lowered that has met others again, and twice as much each
 * time after that, in the same: surfaces that are made again cut other corners, anywhere.
 */
constexpr double FurtherIn = 0.05;

/**
 * What lies within a neighbour stays so many times, while that alone is lowered there: mostly it
 * has closed the room for it, and opens it then.
 */
constexpr int TimesForRoom = 2;

/** Of a surface's volume more or less than its voxels' nothing is changed for. */
constexpr double HarmlessVolumeError = 0.01;
/** Times which a field is shifted at most for the volume, */
constexpr int MostShifts = 6;
/** the last but the first two only while each leaves at most this share of the error, */
constexpr double LeastGain = 0.9; // of triangles outside a lowered field, too
/** by how much at most each, in smallest distances of voxels, */
constexpr double MostShift = 2.0;
/** if the volume changes at least by this share of the area times that. */
constexpr double LeastRate = 0.15;

/** For a gap, times which triangles that leave their own field's inside are drawn back. */
constexpr int RoundsOfGap = 6;
}

Point InMap(const Point& inBox, const std::array<int, 3>& first)
{
  constexpr double grid = 1 << 24; // Sums of its points and of numbers of voxels are exact.
  Point place;
  for (int axis = 0; axis < 3; ++axis)
  {
    place[axis] = first[axis] + std::round(inBox[axis] * grid) / grid;
  }
  return place;
}

void LabelSurfaceMaker::AddClaim(int object, HostThreads& threads)
{
  threads.Run([&]
    { this->Claims.Add(object, MakeLabelField(this->Bricks, object, this->Options, threads)); });
}

double LabelSurfaceMaker::HalfGap() const
{
  return 0.5 * this->Settings.Gap / Workspace(this->Image, Metric::World).WorldUnit();
}

LabelSurfaceMaker::FieldImage LabelSurfaceMaker::MakeField(
  const Place& place, int object, HostThreads& threads) const
{
  const int level = place.Level;
  FieldImage made;
  made.Options = this->Options;
  made.Options.Sigma *= place.Smoothing;
  made.Options.Tolerance = place.IsStrict ? 0.0 : made.Options.Tolerance;
  threads.Run([&] { made.Field = MakeLabelField(this->Bricks, object, made.Options, threads); });
  this->Claims.Settle(object, made.Field);
  if (place.IsStrict && this->HasClaims())
  {
    // What neighbours claim within their tolerance must not take its own voxels away.
    threads.Run([&] { HoldFurther(made.Field, this->Bricks, object, made.Options, {}, threads); });
  }
  if (level > 0)
  {
    const double squaredFactor = std::pow(this->LevelFactor(), 2 * level);
    threads.Run(
      [&] {
        CorrectBends(
          made.Field, this->Bricks, object, BendPerLevel * (squaredFactor - 1.0), threads);
      });
  }
  const Lowering& lowered = this->Lowered[static_cast<std::size_t>(object)];
  if (lowered.Times > 1)
  {
    const auto further = static_cast<float>(FurtherIn * std::pow(2.0, lowered.Times - 2));
    for (float& value : made.Field.Values)
    {
      value -= further;
    }
  }
  for (const std::array<int, 3>& voxel : lowered.Voxels)
  {
    if (made.Field.Box.Contains(voxel))
    {
      made.Field
        .Values[static_cast<std::size_t>(made.Field.Box.NumberOf(voxel[0], voxel[1], voxel[2]))] -=
        static_cast<float>(std::max(this->HalfGap(), LeastLowering));
    }
  }
  made.Image = vtkSmartPointer<vtkImageData>::New();
  const int* extent = this->Image->GetExtent();
  int box[6];
  for (int axis = 0; axis < 3; ++axis)
  {
    box[2 * axis] = extent[2 * axis] + made.Field.Box.First[axis];
    box[2 * axis + 1] = extent[2 * axis] + made.Field.Box.End[axis] - 1;
  }
  made.Image->SetExtent(box);
  made.Image->SetOrigin(this->Image->GetOrigin());
  made.Image->SetSpacing(this->Image->GetSpacing());
  made.Image->SetDirectionMatrix(this->Image->GetDirectionMatrix());
  vtkNew<vtkFloatArray> values;
  values->SetName("Distance");
  constexpr int isOurs = 1;
  values->SetArray(
    made.Field.Values.data(), static_cast<vtkIdType>(made.Field.Values.size()), isOurs);
  made.Image->GetPointData()->SetScalars(values);
  return made;
}

IndexedSurface LabelSurfaceMaker::InVoxels(int object, vtkPolyData* surface) const
{
  const VoxelBox& bricks = this->Bricks.ExtentOf(object).Bricks;
  std::array<int, 3> first; // of the box of its field
  int box[6];
  for (int axis = 0; axis < 3; ++axis)
  {
    first[axis] = (bricks.First[axis] - 1) * LabelBricks::Side;
    box[2 * axis] = box[2 * axis + 1] = this->Image->GetExtent()[2 * axis] + first[axis];
  }
  vtkNew<vtkImageData> frame;
  frame->CopyStructure(this->Image);
  frame->SetExtent(box);
  const Workspace voxels(frame, Metric::Voxels);
  IndexedSurface indexed;
  const vtkIdType count = surface->GetNumberOfPoints();
  indexed.Points.resize(static_cast<std::size_t>(count));
  for (vtkIdType i = 0; i < count; ++i)
  {
    Point world;
    surface->GetPoint(i, world.data());
    indexed.Points[static_cast<std::size_t>(i)] = InMap(voxels.ToWorkspace(world), first);
  }
  const int second = voxels.IsMirrored() ? 2 : 1;
  auto cells = vtk::TakeSmartPointer(surface->GetPolys()->NewIterator());
  for (cells->GoToFirstCell(); !cells->IsDoneWithTraversal(); cells->GoToNextCell())
  {
    vtkIdType size = 0;
    const vtkIdType* corners = nullptr;
    cells->GetCurrentCell(size, corners);
    indexed.Triangles.push_back({ static_cast<int>(corners[0]), static_cast<int>(corners[second]),
      static_cast<int>(corners[3 - second]) });
  }
  return indexed;
}

std::vector<std::int64_t> LabelSurfaceMaker::FindMissed(
  int object, const IndexedSurface& surface) const
{
  return FindMissedVoxels(this->Bricks.Map(), FindWrongVoxels(this->Bricks, object, surface),
    surface, this->AllowedDistance());
}

bool LabelSurfaceMaker::CorrectVolume(
  int object, Revision& revision, const IndexedSurface& surface, FieldImage& made) const
{
  const LabelMap& map = this->Bricks.Map();
  const std::vector<std::int64_t> wrong = FindWrongVoxels(this->Bricks, object, surface);
  const auto lost = [&](bool isObject)
  { return static_cast<double>(FindLostVoxels(map, object, wrong, isObject).size()); };
  // What is lost, or closed, is not made up for elsewhere.
  const double wanted =
    static_cast<double>(this->Bricks.ExtentOf(object).Voxels) - lost(true) + lost(false);
  IndexedSurface scaled = surface;
  for (Point& p : scaled.Points)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      p[axis] =
        (p[axis] - made.Field.Box.First[axis]) * map.Spacing[axis]; // the same wherever it lies
    }
  }
  const SurfaceFeatures features = ComputeFeatures(scaled);
  const double voxel = map.Spacing[0] * map.Spacing[1] * map.Spacing[2];
  const double error = features.Volume / voxel - wanted;
  const bool isBetter =
    revision.Shifts < 2 || std::abs(error) < LeastGain * std::abs(revision.LastError);
  if (revision.Shifts == MostShifts || std::abs(error) <= HarmlessVolumeError * wanted || !isBetter)
  {
    return false;
  }
  double rate = features.Area / voxel; // voxels for a shift by 1
  if (revision.Shifts > 0)
  {
    // Voxels that are held take part no more.
    const double before = (revision.LastError - error) / revision.LastShift;
    rate = std::clamp(before, LeastRate * rate, rate);
  }
  ++revision.Shifts;
  revision.LastError = error;
  revision.LastShift = std::clamp(error / rate, -MostShift, MostShift);
  ShiftField(made.Field, this->Bricks, object, made.Options, revision.LastShift, OnThisThread());
  return true;
}

bool LabelSurfaceMaker::ReviseField(int object, Revision& revision, const IndexedSurface& surface,
  const LabelField& original, FieldImage& made) const
{
  const int round = revision.Round++;
  const double halfGap = this->HalfGap();
  const int holds = static_cast<int>(FurtherMargins.size());
  // What is lowered for a neighbour is not raised again.
  const bool mayHold =
    this->Settings.Smoothing > 0.0 && this->Lowered[static_cast<std::size_t>(object)].Times == 0;
  if (round < holds && mayHold)
  {
    const float further = FurtherMargins[static_cast<std::size_t>(round)];
    const VoxelNumbers numbers(this->Bricks.Map().Size());
    std::vector<HeldVoxel> held;
    for (const std::int64_t voxel : this->FindMissed(object, surface))
    {
      const std::array<int, 3> p = numbers.PlaceOf(voxel);
      if (halfGap == 0.0)
      {
        held.push_back({ voxel, further - static_cast<float>(this->AllowedDistance()) });
      }
      else if (this->Bricks.Map().At(p[0], p[1], p[2]) == object)
      {
        // Those near the gap it has taken away, others the triangles.
        const float before =
          original.Values[static_cast<std::size_t>(original.Box.NumberOf(p[0], p[1], p[2]))];
        if (before > halfGap + LeastHeldInGap)
        {
          held.push_back({ voxel, before + further });
        }
      }
    }
    if (!held.empty())
    {
      HoldFurther(made.Field, this->Bricks, object, made.Options, held, OnThisThread());
      return true;
    }
  }
  if (halfGap == 0.0)
  {
    return this->CorrectVolume(object, revision, surface, made);
  }
  if (round == holds + RoundsOfGap)
  {
    return false;
  }
  const std::size_t outside =
    DrawBackWithin(original, surface, static_cast<float>(halfGap), made.Field);
  // What has been lowered where it met others need but stay away from these.
  const bool mayStop = this->Lowered[static_cast<std::size_t>(object)].Times > 0 && round > 0;
  const bool isBetter =
    static_cast<double>(outside) < LeastGain * static_cast<double>(revision.LastOutside);
  revision.LastOutside = outside;
  return outside > 0 && (isBetter || !mayStop);
}

LabelSurfaceMaker::VoxelsOfObjects LabelSurfaceMaker::FindTouchingVoxels(
  std::vector<LabelSurface>& surfaces, HostThreads& threads) const
{
  std::vector<IndexedSurface> inVoxels(surfaces.size());
  std::vector<std::vector<SurfaceTriangle>> touching;
  threads.Run(
    [&]
    {
      threads.For(surfaces.size(), 1,
        [&](std::size_t begin, std::size_t end)
        {
          for (std::size_t i = begin; i < end; ++i)
          {
            inVoxels[i] = surfaces[i].Surface
              ? this->InVoxels(static_cast<int>(i) + 1, surfaces[i].Surface)
              : IndexedSurface();
          }
        });
      touching = FindTouching(inVoxels, threads);
    });
  std::vector<std::vector<SurfaceTriangle>> lowering = touching;
  std::vector<std::size_t> within(surfaces.size(), 0);
  for (std::size_t i = 0; i < surfaces.size(); ++i)
  {
    for (const SurfaceTriangle& t : touching[i])
    {
      within[t.Surface] += t.Surface != i ? 1 : 0;
      if (t.Surface != i && this->Lowered[i + 1].Times >= TimesForRoom)
      {
        lowering[t.Surface].push_back(t);
      }
    }
  }
  VoxelsOfObjects voxels(surfaces.size());
  for (std::size_t i = 0; i < surfaces.size(); ++i)
  {
    surfaces[i].TouchingFaces = static_cast<vtkIdType>(touching[i].size() + within[i]);
    voxels[i] = VoxelsAbout(inVoxels, lowering[i]);
  }
  return voxels;
}

void LabelSurfaceMaker::Lower(
  const VoxelsOfObjects& voxels, const std::vector<std::uint8_t>& areFiner)
{
  for (std::size_t i = 0; i < voxels.size(); ++i)
  {
    Lowering& lowered = this->Lowered[i + 1];
    lowered.Times += voxels[i].empty() ? 0 : 1;
    lowered.Voxels.insert(lowered.Voxels.end(), voxels[i].begin(), voxels[i].end());
    lowered.IsFiner = areFiner[i] != 0;
  }
}
}
