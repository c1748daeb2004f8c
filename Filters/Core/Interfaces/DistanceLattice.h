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
 * Signed distances, negative inside, at the points of a cubic lattice, and their zero isosurface.
 * The isosurface is the dual mesh of the lattice (MakeDualFaces). Each vertex is the mean of the
 * zeros on the edges of its cube.
 *
 * Values are stored in sparse bricks, so that memory grows with the surface area. Threads may write
 * different layers of bricks concurrently.
 */
class DistanceLattice
{
public:
  static constexpr int BrickSide = 8; ///< points along each axis

  /** Create a lattice around a box. @param pitch distance of points in computational space */
  DistanceLattice(const Bounds& box, double pitch);

  double Pitch() const { return this->Distance; }
  const std::array<int, 3>& Size() const { return this->Points; }
  int NumberOfLayers() const { return this->Bricks[2]; }
  Point PositionOf(int i, int j, int k) const
  {
    return { this->Low[0] + this->Distance * i, this->Low[1] + this->Distance * j,
      this->Low[2] + this->Distance * k };
  }
  /** Return the index of the first point at or beyond a coordinate along an axis. */
  int FirstFrom(double coordinate, int axis) const;
  LatticePoint NearestTo(const Point& position) const;

  /** Return the value of a point; the pitch if its brick is not stored. */
  float At(int i, int j, int k) const;
  /** Return the value of a point for writing; create its brick if necessary. */
  float& Write(int i, int j, int k);
  bool IsInside(int i, int j, int k) const { return this->At(i, j, k) < 0.f; }
  /** Call visit(point, value) for all points of the stored bricks of a layer. */
  template <typename Visitor>
  void ForPoints(int layer, Visitor&& visit);

  /**
   * Change signs until the surface is a manifold with one vertex per crossed cube. In each cube
   * whose points of one side meet only at an edge or a corner, the outside point nearest to the
   * surface is moved inside. If no such point may be added, the shallowest inside point is removed.
   * @param canAdd whether the point at a position may be moved inside
   */
  void MakeWellComposed(
    const std::function<bool(const Point& position)>& canAdd, Executor& executor);

  /**
   * Return the isosurface: closed, oriented outward, and a manifold after MakeWellComposed().
   * @param hasShortDiagonals cut quadrilaterals along the shorter diagonal. The surface may then
   *                          intersect itself in rare cases, which the caller must test.
   */
  IndexedSurface Boundary(bool hasShortDiagonals, Executor& executor) const;

private:
  static constexpr int PointsOfBrick = BrickSide * BrickSide * BrickSide;
  struct Layer
  {
    std::vector<int> First;    ///< index of the first value of each brick; -1: not stored
    std::vector<float> Values; ///< values of the stored bricks, x fastest
  };

  template <typename Visitor>
  void ForSlice(int k, const Visitor& write) const;
  /** Return the cubes that start in a layer of bricks and are not well composed. */
  std::vector<LatticePoint> FindIllComposed(int layer) const;
  std::array<float, 8> CornersOf(const LatticePoint& cube) const;
  void Compose(const LatticePoint& cube, bool mayAdd,
    const std::function<bool(const Point& position)>& canAdd, std::vector<LatticePoint>& changed);

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
    const int brickX = static_cast<int>(brick) % this->Bricks[0];
    const int brickY = static_cast<int>(brick) / this->Bricks[0];
    for (int n = 0; n < PointsOfBrick; ++n)
    {
      visit(LatticePoint{ BrickSide * brickX + n % BrickSide,
              BrickSide * brickY + n / BrickSide % BrickSide,
              BrickSide * layer + n / (BrickSide * BrickSide) },
        own.Values[static_cast<std::size_t>(own.First[brick] + n)]);
    }
  }
}
}

#endif
