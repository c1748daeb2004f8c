// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicDistanceLattice_h
#define volumicDistanceLattice_h

#include "Core/Common/Executor.h"
#include "Core/Common/IndexedSurface.h"
#include "Core/Common/Lattice.h"
#include "Core/Common/Vector.h"

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

namespace volumic
{
/**
 * Signed distances, negative inside, at the points of a cubic lattice, and the surface where they
 * are zero: what a surface starts from. It is the dual mesh of the lattice (MakeDualFaces), with a
 * vertex at the mean of the zeros on the edges of each cube.
 *
 * Memory grows with the surface: points are kept in bricks, and those of bricks without any have
 * one value. Points of different layers of bricks may be written at once.
 */
class DistanceLattice
{
public:
  static constexpr int BrickSide = 8; ///< points

  /** About a box, beyond which all is outside. @param pitch distance of points; workspace */
  DistanceLattice(const Bounds& box, double pitch);

  double Pitch() const { return this->Distance; }
  const std::array<int, 3>& Size() const { return this->Points; }
  int NumberOfLayers() const { return this->Bricks[2]; }
  Point IjkOf(int i, int j, int k) const
  {
    return { this->Low[0] + this->Distance * i, this->Low[1] + this->Distance * j,
      this->Low[2] + this->Distance * k };
  }
  /** The first point at or beyond a coordinate along an axis. */
  int FirstFrom(double coordinate, int axis) const;
  /** The point nearest to a place. */
  LatticePoint NearestTo(const Point& place) const;

  /** The value of a point; of the pitch where none has been written near it. */
  float At(int i, int j, int k) const;
  /** The same, to be written. */
  float& Write(int i, int j, int k);
  bool IsInside(int i, int j, int k) const { return this->At(i, j, k) < 0.f; }
  /** Calls visit(place, value) for the points of the bricks in a layer, some beyond the lattice. */
  template <typename Visitor>
  void ForPoints(int layer, Visitor&& visit);

  /**
   * Changes signs until the surface is a manifold with a vertex in each cube: where points of one
   * side meet in an edge or a corner of a cube alone, what is nearest to the surface comes in, if
   * it may, and else what is least deep goes out.
   */
  void MakeWellComposed(
    const std::function<bool(const Point& place)>& mayComeIn, Executor& executor);

  /**
   * Closed, outward, and a manifold where it is well composed.
   * @param isEven squares are cut along their shorter diagonals; then it may intersect itself,
   * which is rare and must be asked
   */
  IndexedSurface Boundary(bool isEven, Executor& executor) const;

private:
  static constexpr int PointsOfBrick = BrickSide * BrickSide * BrickSide;
  struct Layer
  {
    std::vector<int> First;    ///< of each brick its first value, -1: it has none
    std::vector<float> Values; ///< of bricks, x fastest
  };

  /** Calls write(n, value) for the points of a slice, x fastest. */
  template <typename Visitor>
  void ForSlice(int k, const Visitor& write) const;
  /** The cubes that begin in a layer of bricks. */
  std::vector<LatticePoint> FindIllComposed(int layer) const;
  /** The values of the corners of a cube. */
  std::array<float, 8> CornersOf(const LatticePoint& cube) const;
  void Compose(const LatticePoint& cube, bool mayAdd,
    const std::function<bool(const Point& place)>& mayComeIn, std::vector<LatticePoint>& changed);

  Point Low;
  double Distance;
  std::array<int, 3> Points;
  std::array<int, 3> Bricks;
  std::vector<Layer> Layers;
};

template <typename Visitor>
void DistanceLattice::ForPoints(int layer, Visitor&& visit)
{
  Layer& own = this->Layers[static_cast<std::size_t>(layer)];
  for (std::size_t brick = 0; brick < own.First.size(); ++brick)
  {
    if (own.First[brick] < 0)
    {
      continue;
    }
    const int across = static_cast<int>(brick) % this->Bricks[0];
    const int along = static_cast<int>(brick) / this->Bricks[0];
    for (int n = 0; n < PointsOfBrick; ++n)
    {
      visit(LatticePoint{ BrickSide * across + n % BrickSide,
              BrickSide * along + n / BrickSide % BrickSide,
              BrickSide * layer + n / (BrickSide * BrickSide) },
        own.Values[static_cast<std::size_t>(own.First[brick] + n)]);
    }
  }
}
}

#endif
