// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/MissedParts.h"

#include "Core/Common/Spans.h"
#include "Core/Evolution/MissedVoxels.h"
#include "Core/Image/VoxelBox.h"
#include "Core/Image/VoxelNumbers.h"
#include "Core/Interfaces/DistanceLattice.h"
#include "Core/Mesh/LegalEdges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

namespace volumic
{
namespace
{
/** Longest voxel with a single sample at its centre, in units of the level. */
constexpr double LongestSampled = 1.5;
/** Progress after each step. */
constexpr double AfterMissed = 0.7;
constexpr double AfterDistances = 0.9;

/** Sample points of a voxel. */
class VoxelSamples
{
public:
  explicit VoxelSamples(const LevelImage& image) : Step(image.Step)
  {
    for (int k = 0; k < 3; ++k)
    {
      this->Samples[k] =
        std::max(1, static_cast<int>(std::ceil(image.Step[k] / image.Unit / LongestSampled)));
    }
  }

  /**
   * Call visit(point) for the centre of a voxel, or for the centres of equal boxes of it with edges
   * of at most LongestSampled.
   */
  template <typename Visit>
  void VisitAll(const std::array<int, 3>& voxel, const Visit& visit) const
  {
    const auto coordinate = [&](int axis, int sample)
    { return this->Step[axis] * (voxel[axis] + (sample + 0.5) / this->Samples[axis] - 0.5); };
    VoxelBox::Of(this->Samples)
      .ForVoxels(
        [&](int a, int b, int c) {
          visit(Point{ coordinate(0, a), coordinate(1, b), coordinate(2, c) });
        });
  }

private:
  std::array<double, 3> Step;
  std::array<int, 3> Samples; ///< per voxel, along each axis
};

/** Pitch of the recovery lattice, in delta. */
constexpr double Pitch = 1.6;
/** Edge lengths of recovery surfaces, in delta: shorter ones are collapsed, longer ones split. */
constexpr float ShortestEdge = 1.3f;
constexpr float LongestEdge = 2.45f;
/** Largest distance of a recovery surface from a missed voxel, and from the isosurface, in units.
 */
constexpr double Farthest = 1.4;
constexpr double Margin = 0.5;
/** Depth of a voxel, in units, from which on it is nearest to no point outside. */
constexpr double Deep = 1.;
/** Smallest distance from vertices of the existing surface, in delta. */
constexpr float Clear = 1.9f;

/** Intersecting triangles, one of them with corner v, have corners nearer than this. */
float ReachAbout(const SurfaceState& state, int v)
{
  const float least = state.Sizing.SmallestSearchRadius();
  if (!state.Sizing.IsGraded())
  {
    return least;
  }
  // The reach for the longest edges of the faces around it.
  const SurfaceMesh& mesh = state.Mesh;
  const Ring& ring = mesh.Rings[v];
  float squared = 0.f;
  for (int i = 0; i < ring.Count; ++i)
  {
    const Vector p = mesh.Position[ring.Item[i]];
    squared = std::max({ squared, SquaredDistance(mesh.Position[v], p),
      SquaredDistance(p, mesh.Position[ring.Next(i)]) });
  }
  return std::max(least,
    std::sqrt(squared) * (SizingField::SearchRadiusInDelta / SizingField::LongestEdgeInDelta));
}

/** Recovery surface of missed voxels: the zero set of the distance to the nearest one, minus a
 * radius. */
class RecoverySurfaceMaker
{
public:
  RecoverySurfaceMaker(const SurfaceState& state, const Field& field, const MissedVoxels& missed)
    : State(state), TheField(field), Missed(missed), Numbers(field.Image().Size),
      Samples(field.Image()), Unit(field.Image().Unit),
      Lattice(this->BoxOfVoxels(), Pitch * state.Sizing.OfLevel())
  {
  }

  /** @param covered number of enclosed parts @return empty if cancelled */
  IndexedSurface Make(
    RecoveryShape shape, Executor& executor, int& enclosed, const ProgressCallback& goOn)
  {
    const auto layers = static_cast<std::size_t>(this->Lattice.NumberOfLayers());
    for (std::size_t first = 0; first < layers; first += LayersPerBatch)
    {
      const std::size_t count = std::min(LayersPerBatch, layers - first);
      ForSpans(executor, count, 1,
        [&](std::size_t layer, std::size_t, std::size_t)
        {
          this->Measure(static_cast<int>(first + layer));
          this->KeepClear(static_cast<int>(first + layer));
        });
      if (!goOn(static_cast<double>(first + count) / static_cast<double>(layers)))
      {
        return {};
      }
    }
    const auto isClear = [this](const Point& position)
    { return this->NearestRoom(position) > 0.f; };
    enclosed = this->TakeSmallParts(isClear);
    this->Lattice.MakeWellComposed(isClear, executor);
    const float delta = this->State.Sizing.OfLevel();
    const bool isEven = shape == RecoveryShape::Even;
    return WithLegalEdges(this->Lattice.Boundary(isEven, executor),
      isEven ? ShortestEdge * delta : 0.f, LongestEdge * delta, executor);
  }

private:
  /** Layers of bricks between two calls of the progress callback. */
  static constexpr std::size_t LayersPerBatch = 16;

  /** Call visit(voxel, part) for the voxels of some runs. */
  template <typename Visitor>
  void ForVoxels(std::size_t begin, std::size_t end, const Visitor& visit) const
  {
    for (std::size_t r = begin; r < end; ++r)
    {
      const VoxelRun& run = this->Missed.Runs[r];
      std::array<int, 3> voxel = this->Numbers.IjkOf(run.First);
      for (int i = 0; i < run.Length; ++i, ++voxel[0])
      {
        visit(voxel, run.Part);
      }
    }
  }

  Bounds BoxOfVoxels() const
  {
    Bounds box;
    this->ForVoxels(0, this->Missed.Runs.size(),
      [&](const std::array<int, 3>& voxel, int)
      { this->Samples.VisitAll(voxel, [&box](const Point& p) { box.Add(p); }); });
    for (int axis = 0; axis < 3; ++axis)
    {
      box.Low[axis] -= Farthest * this->Unit;
      box.High[axis] += Farthest * this->Unit;
    }
    return box;
  }

  /** Return the runs within reach of a layer along z. */
  std::array<std::size_t, 2> RunsNear(double low, double high) const
  {
    const double step = this->TheField.Image().Step[2];
    const auto firstOf = [&](double z)
    {
      const auto slice = static_cast<std::int64_t>(std::max(0., std::floor(z / step)));
      const std::int64_t number = slice * this->Numbers.Stride(2);
      return static_cast<std::size_t>(
        std::lower_bound(this->Missed.Runs.begin(), this->Missed.Runs.end(), number,
          [](const VoxelRun& run, std::int64_t least) { return run.First < least; }) -
        this->Missed.Runs.begin());
    };
    return { firstOf(low - step), firstOf(high + 2. * step) };
  }

  /** Compute the distances of the points in a layer of bricks. */
  void Measure(int layer)
  {
    const int firstLayer = layer * DistanceLattice::BrickSide;
    const int endLayer = std::min(firstLayer + DistanceLattice::BrickSide, this->Lattice.Size()[2]);
    const double reach = Farthest * this->Unit + this->Lattice.Pitch();
    const auto [begin, end] = this->RunsNear(this->Lattice.PositionOf(0, 0, firstLayer)[2] - reach,
      this->Lattice.PositionOf(0, 0, endLayer)[2] + reach);
    const double slope = this->TheField.TypicalSlope();
    this->ForVoxels(begin, end,
      [&](const std::array<int, 3>& voxel, int)
      {
        const double depth =
          std::abs(this->TheField.Voxel(voxel[0], voxel[1], voxel[2])) / slope / this->Unit;
        const double radius = this->Unit * std::min(Farthest, std::min(depth, 1.) + Margin);
        const double far = radius + (depth < Deep ? this->Lattice.Pitch() : 0.);
        this->Samples.VisitAll(voxel,
          [&](const Point& centre) { this->AddBall(centre, radius, far, firstLayer, endLayer); });
      });
  }

  void AddBall(const Point& centre, double radius, double far, int firstLayer, int endLayer)
  {
    const int firstK = std::max(this->Lattice.FirstFrom(centre[2] - far, 2), firstLayer);
    const int endK = std::min(this->Lattice.FirstFrom(centre[2] + far, 2), endLayer);
    const int endJ = this->Lattice.FirstFrom(centre[1] + far, 1);
    for (int k = firstK; k < endK; ++k)
    {
      for (int j = this->Lattice.FirstFrom(centre[1] - far, 1); j < endJ; ++j)
      {
        const Point row = this->Lattice.PositionOf(0, j, k);
        const double beside =
          (row[1] - centre[1]) * (row[1] - centre[1]) + (row[2] - centre[2]) * (row[2] - centre[2]);
        if (beside >= far * far)
        {
          continue;
        }
        const double half = std::sqrt(far * far - beside);
        const int endI = this->Lattice.FirstFrom(centre[0] + half, 0);
        for (int i = this->Lattice.FirstFrom(centre[0] - half, 0); i < endI; ++i)
        {
          const double along = row[0] + this->Lattice.Pitch() * i - centre[0];
          float& distance = this->Lattice.Write(i, j, k);
          distance =
            std::min(distance, static_cast<float>(std::sqrt(beside + along * along) - radius));
        }
      }
    }
  }

  /** Return the distance of a position from the existing surface, minus the smallest allowed one.
   */
  float NearestRoom(const Point& p) const
  {
    const Vector position(
      static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]));
    const SizingField& sizing = this->State.Sizing;
    const float delta = sizing.OfLevel();
    const float more = Clear * delta - sizing.SmallestSearchRadius();
    float room = static_cast<float>(0.5 * this->Lattice.Pitch());
    this->State.Grid.Visit(position, sizing.LargestSearchRadius() + more + room,
      [&](int v)
      {
        const float far = Length(position - this->State.Mesh.Position[v]);
        room = std::min(room, far - ReachAbout(this->State, v) - more);
      });
    return room;
  }

  /** Clamp distances to keep the recovery surface clear of the existing surface. */
  void KeepClear(int layer)
  {
    const float far = static_cast<float>(0.9 * this->Lattice.Pitch());
    this->Lattice.ForPoints(layer,
      [&](const LatticePoint& p, float& distance)
      {
        if (distance < far)
        {
          distance =
            std::max(distance, -this->NearestRoom(this->Lattice.PositionOf(p[0], p[1], p[2])));
        }
      });
  }

  /** Give parts without a lattice point the nearest one. @return number of enclosed parts */
  int TakeSmallParts(const std::function<bool(const Point& position)>& isClear)
  {
    std::vector<char> isEnclosed(static_cast<std::size_t>(this->Missed.Parts), 0);
    const auto forPoints = [&](const auto& visit)
    {
      this->ForVoxels(0, this->Missed.Runs.size(),
        [&](const std::array<int, 3>& voxel, int part)
        {
          if (!isEnclosed[static_cast<std::size_t>(part)])
          {
            this->Samples.VisitAll(voxel,
              [&](const Point& p)
              { visit(this->Lattice.NearestTo(p), isEnclosed[static_cast<std::size_t>(part)]); });
          }
        });
    };
    forPoints([this](const LatticePoint& p, char& has)
      { has |= this->Lattice.IsInside(p[0], p[1], p[2]) ? 1 : 0; });
    forPoints(
      [&](const LatticePoint& p, char& has)
      {
        if (isClear(this->Lattice.PositionOf(p[0], p[1], p[2])))
        {
          this->Lattice.Write(p[0], p[1], p[2]) = -0.5f * static_cast<float>(Margin * this->Unit);
          has = 1;
        }
      });
    return static_cast<int>(std::count(isEnclosed.begin(), isEnclosed.end(), 1));
  }

  const SurfaceState& State;
  const Field& TheField;
  const MissedVoxels& Missed;
  VoxelNumbers Numbers;
  VoxelSamples Samples;
  double Unit;
  DistanceLattice Lattice;
};
}

RecoverySurfaces FindMissedParts(const SurfaceState& state, const Field& field, PartKind kind,
  int minimumSize, RecoveryShape shape, Executor& executor, const ProgressCallback& goOn)
{
  RecoverySurfaces stopped;
  stopped.IsStopped = true;
  const MissedVoxels missed = FindMissedVoxels(state, field, kind, minimumSize, executor,
    [&goOn](double share) { return goOn(AfterMissed * share); });
  if (missed.IsStopped)
  {
    return stopped;
  }
  RecoverySurfaces result;
  result.Found = missed.Parts;
  result.Boundary.Add(missed, field, kind, executor);
  bool goesOn = true;
  if (!missed.Runs.empty())
  {
    result.Surface = RecoverySurfaceMaker(state, field, missed)
                       .Make(shape, executor, result.Enclosed,
                         [&](double share)
                         {
                           goesOn = goOn(AfterMissed + (AfterDistances - AfterMissed) * share);
                           return goesOn;
                         });
  }
  if (!goesOn)
  {
    return stopped;
  }
  if (kind == PartKind::Cavity)
  {
    for (Triangle& triangle : result.Surface.Triangles)
    {
      std::swap(triangle[1], triangle[2]);
    }
  }
  return goOn(1.) ? result : stopped;
}
}
