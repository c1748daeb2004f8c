// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/Box.h"
#include "Core/Common/Spans.h"
#include "Core/Evolution/EvolutionImplementation.h"
#include "Core/Evolution/InitialSurface.h"
#include "Core/Evolution/LostParts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

namespace volumic
{
namespace
{
/** Vertices that one thread looks at at a time. */
constexpr std::size_t VertexSpan = 8192;
}

void SurfaceEvolution::Implementation::Enter(const LevelImage& image, int level)
{
  this->TheField = std::make_unique<Field>(image, this->Options, this->Threads);
  this->State.Margin = this->TheField->Margin();
  this->Level = level;
  this->LastIterations = 0;
  this->HasDescended = false;
  this->Visit = {};
  this->State.Sizing = SizingField(static_cast<float>(this->Options.SamplingRatio * image.Unit));
}

void SurfaceEvolution::Implementation::Clear()
{
  this->ForgetBlocks();
  this->State.Mesh.Clear();
}

void SurfaceEvolution::Implementation::Reset()
{
  SurfaceState& s = this->State;
  this->ForgetBlocks();
  s.Mesh.Reorder(
    SpaceFillingOrder(s.Mesh, s.Sizing.Smallest(), this->Threads), this->Threads);
  this->LayOut();
}

void SurfaceEvolution::Implementation::LayOut()
{
  this->ForgetBlocks();
  this->LayGrid();
  this->MakeBlocks();
  this->SplitLongEdges();
  this->LabelComponents();
}

Box SurfaceEvolution::Implementation::BoxOfGrid() const
{
  const SurfaceMesh& mesh = this->State.Mesh;
  const LevelImage& image = this->TheField->Image();
  const Box ofImage = { Vector(0, 0, 0), Vector(static_cast<float>(image.Size[0] * image.Step[0]),
    static_cast<float>(image.Size[1] * image.Step[1]),
    static_cast<float>(image.Size[2] * image.Step[2])) };
  std::vector<Box> boxes((mesh.Position.size() + VertexSpan - 1) / VertexSpan, ofImage);
  ForSpans(this->Threads, mesh.Position.size(), VertexSpan,
    [&](std::size_t span, std::size_t begin, std::size_t end)
    {
      for (std::size_t v = begin; v < end; ++v)
      {
        boxes[span] = boxes[span].With({ mesh.Position[v], mesh.Position[v] });
      }
    });
  const Box all = std::accumulate(boxes.begin(), boxes.end(), ofImage,
    [](const Box& a, const Box& b) { return a.With(b); });
  return all.Grown(2 * this->State.Sizing.Largest());
}

void SurfaceEvolution::Implementation::LayGrid()
{
  SurfaceState& s = this->State;
  const Box box = this->BoxOfGrid();
  s.Reset(box.Low, box.High, this->Threads);
  s.UpdateShape(this->AliveVertices(), this->Threads);
}

void SurfaceEvolution::Implementation::ActivateAll()
{
  SurfaceState& s = this->State;
  ForSpans(this->Threads, s.Mesh.Rings.size(), VertexSpan,
    [&](std::size_t, std::size_t begin, std::size_t end)
    {
      for (std::size_t v = begin; v < end; ++v)
      {
        if (s.Mesh.IsAlive(static_cast<int>(v)))
        {
          s.Active[v] = 1;
        }
      }
    });
}

void SurfaceEvolution::Implementation::Recover()
{
  this->LastLost = LostParts();
  this->Lost = LostBoundary();
  // Without an isopotential there is no object's side to look for.
  if (!(this->Options.IsopotentialWeight > 0.))
  {
    return;
  }
  const bool recovers = this->Options.RecoverLostParts;
  const double objectShare = recovers && this->Options.RecoverCavities ? 0.5 : 1.;
  const auto find = [&](PartKind kind, double from, double to)
  {
    const auto look = [&]
    {
      return FindLostParts(this->State, *this->TheField, kind, this->Options.MinimumPartSize,
        this->Threads, this->QuestionOf(Monitor::Activity::Recovering, from, to));
    };
    LostPartCover cover = look();
    if (cover.Found > 0 && recovers && this->State.Sizing.IsGraded())
    {
      this->DivideNear(cover.Boundary); // Else nothing that is near would be clear of it.
      cover = look();
    }
    return cover;
  };
  LostPartCover objects = find(PartKind::Object, 0., objectShare);
  this->LastLost.Found = objects.Found;
  this->LastLost.Enclosed = recovers ? objects.Covered : 0;
  this->Lost = objects.Boundary;
  LostPartCover cavities;
  if (recovers && this->Options.RecoverCavities && !this->Stopped)
  {
    cavities = find(PartKind::Cavity, objectShare, 1.);
    this->LastLost.FoundCavities = cavities.Found;
    this->LastLost.EnclosedCavities = cavities.Covered;
    this->Lost.Add(cavities.Boundary);
  }
  if (this->Stopped)
  {
    this->LastLost = LostParts();
    this->Lost = LostBoundary();
    return;
  }
  if (this->LastLost.Enclosed > 0)
  {
    this->Blocks->Append(std::move(objects.Surface), this->Threads);
    ++this->Unchecked;
  }
  if (this->LastLost.EnclosedCavities > 0)
  {
    this->Blocks->Append(std::move(cavities.Surface), this->Threads);
    ++this->Unchecked;
  }
}
}
