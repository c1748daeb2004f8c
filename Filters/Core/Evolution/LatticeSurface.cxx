// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/LatticeSurface.h"

#include "Core/Common/Sort.h"
#include "Core/Common/Spans.h"
#include "Core/Interfaces/DistanceLattice.h"
#include "Core/Mesh/ObliqueRotation.h"
#include "Core/Mesh/RowCrossing.h"
#include "Core/Mesh/SelfIntersections.h"
#include "Core/Mesh/TriangleTree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace volumic
{
namespace
{
/** Smallest stored distance of a lattice point, in pitches. Its sign is the side. */
constexpr double LeastDistance = 1e-6;
/** Minimum number of points per thread. */
constexpr std::size_t PointGrain = 64;
/** Fraction of the distances in the progress. */
constexpr double ShareOfDistances = 0.8;

/** Sides of the lattice points of a layer, x fastest. */
using Layer = std::vector<unsigned char>;
constexpr unsigned char Inside = 1;
constexpr unsigned char Near = 2; ///< has a neighbour on the other side

/** Winding numbers along the rows of a lattice, layer by layer. */
class RowFollower
{
public:
  RowFollower(const IndexedSurface& surface, const DistanceLattice& lattice, Executor& executor)
  {
    std::copy(lattice.Size().begin(), lattice.Size().end(), this->Rows.End.begin());
    this->Rows.Origin = lattice.PositionOf(0, 0, 0);
    this->Rows.Pitch = lattice.Pitch();
    for (const Triangle& t : surface.Triangles)
    {
      this->Rows.AddCrossings(
        { surface.Points[t[0]], surface.Points[t[1]], surface.Points[t[2]] }, this->Crossings);
    }
    Sort(executor, this->Crossings);
  }

  /** Find the inside points of a layer. Call it in order, from layer 0 on. */
  void Fill(std::int64_t k, Layer& layer)
  {
    std::fill(layer.begin(), layer.end(), static_cast<unsigned char>(0));
    const std::int64_t firstRow = this->Rows.RowOf(0, k);
    const auto placeOf = [&](const RowGrid::Crossing& crossing)
    {
      const double x = (crossing.Where.X - this->Rows.Origin[0]) / this->Rows.Pitch;
      return layer.begin() + (crossing.Row - firstRow) * this->Rows.End[0] +
        static_cast<std::ptrdiff_t>(std::ceil(x));
    };
    int winding = 0; // 0 again at the end of each row
    for (; this->Next < this->Crossings.size() &&
         this->Crossings[this->Next].Row < this->Rows.RowOf(0, k + 1);
         ++this->Next)
    {
      const RowGrid::Crossing& crossing = this->Crossings[this->Next];
      winding += crossing.Where.Winding;
      if (winding > 0)
      {
        std::fill(placeOf(crossing), placeOf(this->Crossings[this->Next + 1]), Inside);
      }
    }
  }

private:
  RowGrid Rows;
  std::vector<RowGrid::Crossing> Crossings;
  std::size_t Next = 0; ///< the first crossing in the next layer
};

/** Mark the points with a neighbour on the other side, in a layer and the next one. */
void MarkNear(Layer& layer, Layer& next, std::size_t width)
{
  const auto compare = [](unsigned char& a, unsigned char& b)
  {
    const auto mark = static_cast<unsigned char>(((a ^ b) & Inside) != 0 ? Near : 0);
    a |= mark;
    b |= mark;
  };
  // The outermost points are outside, so rows may be compared beyond their ends.
  for (std::size_t n = 0; n < layer.size(); ++n)
  {
    compare(layer[n], next[n]);
    if (n + width < layer.size())
    {
      compare(layer[n], layer[n + 1]);
      compare(layer[n], layer[n + width]);
    }
  }
}
}

IndexedSurface RemeshOnLattice(const IndexedSurface& given, double pitch, int attempt,
  Executor& executor, const std::function<bool(double share)>& goOn)
{
  const ObliqueRotation rotation(attempt);
  IndexedSurface surface = given;
  for (Point& p : surface.Points)
  {
    p = rotation.Apply(p);
  }
  DistanceLattice lattice(Bounds::Of(surface), pitch);
  const std::array<int, 3>& size = lattice.Size();
  RowFollower rows(surface, lattice, executor);
  const TriangleTree tree(surface);
  struct Found
  {
    LatticePoint At;
    float Distance;
  };
  std::vector<Found> points;
  Layer layer(static_cast<std::size_t>(size[0]) * size[1], 0);
  Layer next = layer;
  for (int k = 0; k + 1 < size[2]; ++k)
  {
    if (!goOn(ShareOfDistances * k / size[2]))
    {
      return {};
    }
    rows.Fill(k + 1, next);
    MarkNear(layer, next, static_cast<std::size_t>(size[0]));
    points.clear();
    for (int n = 0; n < static_cast<int>(layer.size()); ++n)
    {
      if (layer[n] != 0)
      {
        points.push_back({ { n % size[0], n / size[0], k }, static_cast<float>(pitch) });
      }
    }
    executor.For(points.size(), PointGrain,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t n = begin; n < end; ++n)
        {
          const auto [i, j, unused] = points[n].At;
          const unsigned char side = layer[static_cast<std::size_t>(j) * size[0] + i];
          if ((side & Near) != 0)
          {
            points[n].Distance = static_cast<float>(std::max(
              std::sqrt(tree.SquaredDistance(lattice.PositionOf(i, j, k))), LeastDistance * pitch));
          }
          points[n].Distance *= (side & Inside) != 0 ? -1.f : 1.f;
        }
      });
    for (const Found& point : points)
    {
      lattice.Write(point.At[0], point.At[1], k) = point.Distance;
    }
    layer.swap(next);
  }
  lattice.MakeWellComposed([](const Point&) { return false; }, executor);
  IndexedSurface result = lattice.Boundary(true, executor);
  if (CountSelfIntersections(result, 1) > 0)
  {
    result = lattice.Boundary(false, executor);
  }
  for (Point& p : result.Points)
  {
    p = rotation.Undo(p);
  }
  return goOn(1.) ? result : IndexedSurface();
}
}
