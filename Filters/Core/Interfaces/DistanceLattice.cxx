// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/DistanceLattice.h"

#include "Core/Common/Select.h"
#include "Core/Interfaces/DualCells.h"
#include "Core/Interfaces/DualMesh.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace volumic
{
namespace
{
constexpr int Margin = 2;        ///< points of the lattice beyond each side of the box
constexpr int AddingRounds = 20; ///< Later rounds only remove points, which terminates.
/** Values of added and removed points, in pitches. */
constexpr float AddedValue = -0.15f;
constexpr float RemovedValue = 0.3f;
constexpr float MostAdded = 0.9f; ///< maximum value of a point before it is added, in pitches
}

DistanceLattice::DistanceLattice(const Bounds& box, double pitch) : Distance(pitch)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Low[axis] = box.Low[axis] - Margin * pitch;
    this->Points[axis] =
      static_cast<int>(std::ceil((box.High[axis] - box.Low[axis]) / pitch)) + 2 * Margin + 1;
    this->Bricks[axis] = (this->Points[axis] + BrickSide - 1) / BrickSide;
  }
  this->Layers.resize(static_cast<std::size_t>(this->Bricks[2]));
  for (Layer& layer : this->Layers)
  {
    layer.First.resize(static_cast<std::size_t>(this->Bricks[0]) * this->Bricks[1], -1);
  }
}

int DistanceLattice::FirstFrom(double coordinate, int axis) const
{
  const double at = std::ceil((coordinate - this->Low[axis]) / this->Distance);
  return static_cast<int>(std::clamp(at, 0., static_cast<double>(this->Points[axis])));
}

LatticePoint DistanceLattice::NearestTo(const Point& position) const
{
  LatticePoint point;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double at = std::round((position[axis] - this->Low[axis]) / this->Distance);
    point[axis] = static_cast<int>(std::clamp(at, 1., this->Points[axis] - 2.));
  }
  return point;
}

float DistanceLattice::At(int i, int j, int k) const
{
  const Layer& layer = this->Layers[static_cast<std::size_t>(k / BrickSide)];
  const int first =
    layer.First[static_cast<std::size_t>(j / BrickSide) * this->Bricks[0] + i / BrickSide];
  return first < 0 ? static_cast<float>(this->Distance)
                   : layer.Values[static_cast<std::size_t>(first + i % BrickSide +
                       BrickSide * (j % BrickSide + BrickSide * (k % BrickSide)))];
}

float& DistanceLattice::Write(int i, int j, int k)
{
  Layer& layer = this->Layers[static_cast<std::size_t>(k / BrickSide)];
  int& first =
    layer.First[static_cast<std::size_t>(j / BrickSide) * this->Bricks[0] + i / BrickSide];
  if (first < 0)
  {
    first = static_cast<int>(layer.Values.size());
    layer.Values.resize(layer.Values.size() + PointsOfBrick, static_cast<float>(this->Distance));
  }
  return layer.Values[static_cast<std::size_t>(
    first + i % BrickSide + BrickSide * (j % BrickSide + BrickSide * (k % BrickSide)))];
}

std::array<float, 8> DistanceLattice::CornersOf(const LatticePoint& cube) const
{
  std::array<float, 8> values;
  for (int corner = 0; corner < 8; ++corner)
  {
    values[static_cast<std::size_t>(corner)] =
      this->At(cube[0] + (corner & 1), cube[1] + (corner >> 1 & 1), cube[2] + (corner >> 2));
  }
  return values;
}

void DistanceLattice::Compose(const LatticePoint& cube, bool mayAdd,
  const std::function<bool(const Point& position)>& canAdd, std::vector<LatticePoint>& changed)
{
  const std::array<float, 8> values = this->CornersOf(cube);
  unsigned inside = 0;
  for (unsigned corner = 0; corner < 8; ++corner)
  {
    inside |= (values[corner] < 0.f ? 1u : 0u) << corner;
  }
  if (inside == 0 || inside == 255 || DualCells::IsPlainPattern(inside))
  {
    return;
  }
  const auto pointAt = [&cube](int corner)
  {
    return LatticePoint{ cube[0] + (corner & 1), cube[1] + (corner >> 1 & 1),
      cube[2] + (corner >> 2) };
  };
  const auto pitch = static_cast<float>(this->Distance);
  int best = -1;
  for (int corner = 0; corner < 8 && mayAdd; ++corner)
  {
    const LatticePoint p = pointAt(corner);
    const float value = values[static_cast<std::size_t>(corner)];
    const bool isWithin = p[0] > 0 && p[1] > 0 && p[2] > 0 && p[0] + 1 < this->Points[0] &&
      p[1] + 1 < this->Points[1] && p[2] + 1 < this->Points[2];
    if (value >= 0.f && value < MostAdded * pitch && isWithin &&
      (best < 0 || value < values[static_cast<std::size_t>(best)]) &&
      canAdd(this->PositionOf(p[0], p[1], p[2])))
    {
      best = corner;
    }
  }
  const bool isAdded = best >= 0;
  for (int corner = 0; corner < 8 && !isAdded; ++corner)
  {
    const float value = values[static_cast<std::size_t>(corner)];
    if (value < 0.f && (best < 0 || value > values[static_cast<std::size_t>(best)]))
    {
      best = corner;
    }
  }
  const LatticePoint p = pointAt(best);
  this->Write(p[0], p[1], p[2]) = (isAdded ? AddedValue : RemovedValue) * pitch;
  changed.push_back(p);
}

template <typename Visitor>
void DistanceLattice::ForSlice(int k, const Visitor& write) const
{
  const Layer& layer = this->Layers[static_cast<std::size_t>(k / BrickSide)];
  std::size_t at = 0;
  for (int j = 0; j < this->Points[1]; ++j)
  {
    for (int i = 0; i < this->Points[0]; i += BrickSide)
    {
      const int first =
        layer.First[static_cast<std::size_t>(j / BrickSide) * this->Bricks[0] + i / BrickSide];
      const int count = std::min(BrickSide, this->Points[0] - i);
      const int from = first + BrickSide * (j % BrickSide + BrickSide * (k % BrickSide));
      for (int n = 0; n < count; ++n)
      {
        write(at++,
          first < 0 ? static_cast<float>(this->Distance)
                    : layer.Values[static_cast<std::size_t>(from + n)]);
      }
    }
  }
}

std::vector<LatticePoint> DistanceLattice::FindIllComposed(int layer) const
{
  std::vector<LatticePoint> cubes;
  const auto size = static_cast<std::size_t>(this->Points[0]);
  std::vector<std::uint8_t> low(size * this->Points[1]); // 1 if the point is inside
  std::vector<std::uint8_t> high(low.size());
  const auto copy = [this](int k, std::vector<std::uint8_t>& inside)
  {
    this->ForSlice(k, [&inside](std::size_t at, float value) { inside[at] = value < 0.f ? 1 : 0; });
  };
  const int first = layer * BrickSide;
  copy(first, high);
  for (int k = first; k < std::min(first + BrickSide, this->Points[2] - 1); ++k)
  {
    low.swap(high);
    copy(k + 1, high);
    for (int j = 0; j + 1 < this->Points[1]; ++j)
    {
      const std::size_t row = static_cast<std::size_t>(j) * size;
      const std::array<const std::uint8_t*, 4> rows = { &low[row], &low[row + size], &high[row],
        &high[row + size] };
      const auto column = [&rows](int i)
      { return rows[0][i] | rows[1][i] << 2 | rows[2][i] << 4 | rows[3][i] << 6; };
      for (int i = 0; i + 1 < this->Points[0]; ++i)
      {
        const auto inside = static_cast<unsigned>(column(i) | column(i + 1) << 1);
        if (inside != 0 && inside != 255 && !DualCells::IsPlainPattern(inside))
        {
          cubes.push_back({ i, j, k });
        }
      }
    }
  }
  return cubes;
}

void DistanceLattice::MakeWellComposed(
  const std::function<bool(const Point& position)>& canAdd, Executor& executor)
{
  std::vector<std::vector<LatticePoint>> perLayer(this->Layers.size());
  ForSpans(executor, perLayer.size(), 1,
    [&](std::size_t layer, std::size_t, std::size_t)
    { perLayer[layer] = this->FindIllComposed(static_cast<int>(layer)); });
  std::vector<LatticePoint> cubes = Joined(executor, perLayer);
  for (int round = 0; !cubes.empty(); ++round)
  {
    SortUnique(cubes);
    std::vector<LatticePoint> changed;
    for (const LatticePoint& cube : cubes)
    {
      this->Compose(cube, round < AddingRounds, canAdd, changed);
    }
    cubes.clear();
    for (const LatticePoint& p : changed)
    {
      for (int corner = 0; corner < 8; ++corner)
      {
        cubes.push_back({ p[0] - (corner & 1), p[1] - (corner >> 1 & 1), p[2] - (corner >> 2) });
      }
    }
  }
}

IndexedSurface DistanceLattice::Boundary(bool hasShortDiagonals, Executor& executor) const
{
  DualGrid grid;
  grid.Size = this->Points;
  grid.RankOf = { 1, 0 }; // label 0: outside, label 1: inside
  grid.HasShortDiagonals = hasShortDiagonals;
  for (int axis = 0; axis < 3; ++axis)
  {
    for (int i = 0; i < this->Points[axis]; ++i)
    {
      const double at = this->Low[axis] + this->Distance * i;
      grid.Centres[axis].push_back(static_cast<float>(at));
      grid.Planes[axis].push_back(static_cast<float>(at + 0.5 * this->Distance));
    }
    grid.Planes[axis].pop_back();
  }
  grid.CopyValues = [&](int k, float* values)
  { this->ForSlice(k, [values](std::size_t at, float value) { values[at] = value; }); };
  grid.CopySlice = [&](int k, LabelMap::Number* labels) {
    this->ForSlice(k, [labels](std::size_t at, float value) { labels[at] = value < 0.f ? 1 : 0; });
  };
  LargeVector<Vector> points;
  LargeVector<InterfaceMesh::Face> faces;
  MakeDualFaces(grid, executor, points, faces);
  IndexedSurface surface;
  surface.Points.resize(points.size());
  std::transform(points.begin(), points.end(), surface.Points.begin(),
    [](const Vector& p) {
      return Point{ p.X, p.Y, p.Z };
    });
  surface.Triangles.resize(faces.size());
  std::transform(faces.begin(), faces.end(), surface.Triangles.begin(),
    [](const InterfaceMesh::Face& face)
    {
      return Triangle{ face.Vertex[0], face.Vertex[2], face.Vertex[1] };
    }); // Reversed: counter-clockwise seen from outside.
  return surface;
}
}
