// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/InitialSurface.h"

#include "Core/Common/Lattice.h"
#include "Core/Common/ThrowInvalidArgument.h"
#include "Core/Image/VoxelBox.h"
#include "Core/Mesh/Division.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <utility>

namespace volumic
{
IndexedSurface Icosahedron(const Point& centre, double radius)
{
  const double golden = 0.5 * (1. + std::sqrt(5.));
  const double scale = radius / std::sqrt(1. + golden * golden);
  const double s = scale;
  const double l = scale * golden;
  IndexedSurface surface;
  for (const Point& p :
    { Point{ -s, l, 0 }, Point{ s, l, 0 }, Point{ -s, -l, 0 }, Point{ s, -l, 0 }, Point{ 0, -s, l },
      Point{ 0, s, l }, Point{ 0, -s, -l }, Point{ 0, s, -l }, Point{ l, 0, -s }, Point{ l, 0, s },
      Point{ -l, 0, -s }, Point{ -l, 0, s } })
  {
    surface.Points.push_back({ p[0] + centre[0], p[1] + centre[1], p[2] + centre[2] });
  }
  surface.Triangles = { { 0, 11, 5 }, { 0, 5, 1 }, { 0, 1, 7 }, { 0, 7, 10 }, { 0, 10, 11 },
    { 1, 5, 9 }, { 5, 11, 4 }, { 11, 10, 2 }, { 10, 7, 6 }, { 7, 1, 8 }, { 3, 9, 4 }, { 3, 4, 2 },
    { 3, 2, 6 }, { 3, 6, 8 }, { 3, 8, 9 }, { 4, 9, 5 }, { 2, 4, 11 }, { 6, 2, 10 }, { 8, 6, 7 },
    { 9, 8, 1 } };
  return surface;
}

namespace
{
/** Edge length of an icosahedron in the unit sphere: 1 / sin(2 pi / 5). */
constexpr double EdgeOfIcosahedron = 1.0515;
/** 16 divisions would create 430 million vertices. */
constexpr int MaximumNumberOfDivisions = 16;
/**
 * A surface that is wider than the image by this factor must have another unit. A ball around a
 * flat image is not.
 */
constexpr double MaximumWidth = 5.;

/** Return an icosahedron in the unit sphere. */
SurfaceMesh DividedSphere(double meanEdge)
{
  SurfaceMesh mesh;
  mesh.Append(Icosahedron({ 0., 0., 0. }, 1.));
  double edge = EdgeOfIcosahedron;
  for (int i = 0; i < MaximumNumberOfDivisions && edge > meanEdge; ++i)
  {
    mesh = Divide(mesh);
    for (Vector& p : mesh.Position)
    {
      p = Normalized(p);
    }
    edge /= std::sqrt(3.);
  }
  return mesh;
}
}

IndexedSurface DividedIcosahedron(const Point& centre, double radius, double meanEdge)
{
  IndexedSurface surface = DividedSphere(meanEdge / radius).ToIndexed();
  for (Point& p : surface.Points)
  {
    for (int k = 0; k < 3; ++k)
    {
      p[k] = centre[k] + radius * p[k];
    }
  }
  return surface;
}

namespace
{
/** Edges of the rounded box along its sides, in delta. Diagonals are sqrt 2 times as long. */
constexpr double EnclosingEdge = 1.4;
/** Radius of its rounding per edge length: an edge is the chord of 45 degrees, 1 / (2 sin(pi / 8)).
 */
constexpr double RoundingOfEdge = 1.3065629648763766;
/** Largest number of vertices; images of 2000^3 voxels need 12 million. */
constexpr double MostVertices = 3e7;

/** Rounded box, as a lattice of quadrangles on its surface. */
class RoundedBox
{
public:
  /** @param half half widths of the enclosed box */
  RoundedBox(const Point& centre, const Point& half, double edge)
    : Centre(centre), Edge(edge), Radius(RoundingOfEdge * edge)
  {
    for (int k = 0; k < 3; ++k)
    {
      // The rounded corner must enclose the corner of the box.
      const double core = std::max(half[k] - this->Radius / std::sqrt(3.), 0.);
      this->Last[k] = static_cast<int>(std::ceil(2. * core / edge)) + 2;
    }
  }

  IndexedSurface Surface()
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      this->AddSide(axis, 0);
      this->AddSide(axis, this->Last[axis]);
    }
    return std::move(this->Result);
  }

private:
  using LatticeIndex = std::array<int, 3>; ///< 0 to Last

  void AddSide(int axis, int at)
  {
    const int i = (axis + 1) % 3;
    const int j = (axis + 2) % 3;
    LatticeIndex p;
    p[axis] = at;
    for (p[i] = 0; p[i] < this->Last[i]; ++p[i])
    {
      for (p[j] = 0; p[j] < this->Last[j]; ++p[j])
      {
        LatticeIndex corner[4] = { p, p, p, p }; // counter-clockwise seen from outside if at > 0
        ++corner[1][i];
        ++corner[2][i];
        ++corner[2][j];
        ++corner[3][j];
        int index[4];
        for (int k = 0; k < 4; ++k)
        {
          index[k] = this->IndexOf(corner[k]);
        }
        // The diagonal ends at the corner of the box, so no vertex has valence 3.
        const int first = (p[i] == 0) == (p[j] == 0) ? 0 : 1;
        this->AddTriangle(index[first], index[first + 1], index[first + 2], at > 0);
        this->AddTriangle(index[first], index[first + 2], index[(first + 3) % 4], at > 0);
      }
    }
  }

  void AddTriangle(int a, int b, int c, bool isOutward)
  {
    this->Result.Triangles.push_back({ a, isOutward ? b : c, isOutward ? c : b });
  }

  int IndexOf(const LatticeIndex& index)
  {
    const auto found = this->Index.emplace(
      LatticeKey(index[0], index[1], index[2]), static_cast<int>(this->Result.Points.size()));
    if (found.second)
    {
      this->Result.Points.push_back(this->PointAt(index));
    }
    return found.first->second;
  }

  Point PointAt(const LatticeIndex& index) const
  {
    // Nearest point of the core, and the direction from there.
    Point p = this->Centre;
    Point out;
    for (int k = 0; k < 3; ++k)
    {
      const int onCore = std::clamp(index[k], 1, this->Last[k] - 1);
      p[k] += (onCore - 0.5 * this->Last[k]) * this->Edge;
      out[k] = index[k] - onCore;
    }
    const double scale = this->Radius / std::hypot(out[0], out[1], out[2]);
    for (int k = 0; k < 3; ++k)
    {
      p[k] += scale * out[k];
    }
    return p;
  }

  Point Centre;
  double Edge;
  double Radius;
  LatticeIndex Last;
  IndexedSurface Result;
  std::unordered_map<std::uint64_t, int> Index; ///< of points, by lattice index
};
}

IndexedSurface EnclosingSurface(const LevelImage& image, double delta)
{
  Point centre;
  Point half;
  for (int k = 0; k < 3; ++k)
  {
    // Voxels lie at 0 .. (Size - 1) Step. The field falls to the background one Step beyond.
    centre[k] = 0.5 * (image.Size[k] - 1) * image.Step[k];
    half[k] = centre[k] + image.Step[k];
  }
  CheckNumberOfVertices(
    8. * (half[0] * half[1] + half[1] * half[2] + half[2] * half[0]), image, delta);
  return RoundedBox(centre, half, EnclosingEdge * delta).Surface();
}

void CheckNumberOfVertices(double area, const LevelImage& image, double delta)
{
  const double vertices = area / (EnclosingEdge * delta * EnclosingEdge * delta);
  if (!(vertices <= MostVertices))
  {
    const auto [least, most] = std::minmax_element(image.Step.begin(), image.Step.end());
    ThrowInvalidArgument("The surface to start from would have ", std::round(vertices / 1e6),
      " million vertices, as the image's voxels are ", *most / *least,
      " times as long as wide. Check the Spacing, resample the image, or set "
      "Metric to Voxels (0).");
  }
}

void CheckOverlapsImage(const IndexedSurface& surface, const LevelImage& image)
{
  const Bounds bounds = Bounds::Of(surface);
  double widest = 0.;
  double widestImage = 0.;
  for (int k = 0; k < 3; ++k)
  {
    widest = std::max(widest, bounds.High[k] - bounds.Low[k]);
    widestImage = std::max(widestImage, image.Size[k] * image.Step[k]);
  }
  if (widest > MaximumWidth * widestImage)
  {
    ThrowInvalidArgument("The initial surface is too large for the image: it is ", widest,
      " voxel distances wide, the image ", widestImage,
      ". Are its coordinates in another unit than the image's, for example micrometres instead of "
      "millimetres? Scale it to the image's.");
  }
  for (int k = 0; k < 3; ++k)
  {
    if (bounds.High[k] < 0. || bounds.Low[k] > image.Size[k] * image.Step[k])
    {
      ThrowInvalidArgument("The initial surface lies wholly outside the image: along axis ", k,
        " it runs from ", bounds.Low[k], " to ", bounds.High[k],
        " voxel distances, the image from 0 to ", image.Size[k] * image.Step[k],
        ". Check that both use the same space.");
    }
  }
}

namespace
{
float ValueAt(const Field& field, const Point& p)
{
  return field.ValueAt(
    Vector(static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])));
}

/** Return the points of a centred grid that lie inside the object. */
std::vector<Point> GridOfSeeds(const Field& field, double spacing)
{
  const LevelImage& image = field.Image();
  std::array<int, 3> count;
  double first[3];
  for (int k = 0; k < 3; ++k)
  {
    const double extent = (image.Size[k] - 1) * image.Step[k];
    count[k] = static_cast<int>(extent / spacing) + 1;
    first[k] = 0.5 * (extent - (count[k] - 1) * spacing);
  }
  std::vector<Point> chosen;
  VoxelBox::Of(count).ForVoxels(
    [&](int x, int y, int z)
    {
      const Point p = { first[0] + x * spacing, first[1] + y * spacing, first[2] + z * spacing };
      if (ValueAt(field, p) > 0)
      {
        chosen.push_back(p);
      }
    });
  return chosen;
}
}

std::vector<float> ValuesAtSeeds(const Field& field, const std::vector<Point>& centres)
{
  const LevelImage& image = field.Image();
  std::vector<float> values;
  for (std::size_t i = 0; i < centres.size(); ++i)
  {
    const Point& p = centres[i];
    for (int k = 0; k < 3; ++k)
    {
      if (!(p[k] >= 0. && p[k] <= image.Size[k] * image.Step[k]))
      {
        ThrowInvalidArgument("Seed ", i, " lies outside the image: ", p[k],
          " voxel distances along axis ", k, ", the image has ", image.Size[k] * image.Step[k],
          ".");
      }
    }
    values.push_back(ValueAt(field, p));
  }
  return values;
}

std::vector<Point> ChooseSeeds(
  const Field& field, const std::vector<Point>& centres, double spacing)
{
  if (centres.empty())
  {
    std::vector<Point> grid = GridOfSeeds(field, spacing);
    if (grid.empty())
    {
      ThrowInvalidArgument(
        "No point of the grid of seeds lies inside the object. Set Seed Positions, a smaller "
        "Seed Radius, a finer Coarsest Level or another Iso Value.");
    }
    return grid;
  }
  const std::vector<float> values = ValuesAtSeeds(field, centres);
  std::vector<Point> chosen;
  for (std::size_t i = 0; i < centres.size(); ++i)
  {
    const VectorD centre(centres[i][0], centres[i][1], centres[i][2]);
    if (values[i] > 0 &&
      std::none_of(chosen.begin(), chosen.end(),
        [&](const Point& q)
        { return SquaredDistance(VectorD(q[0], q[1], q[2]), centre) < spacing * spacing; }))
    {
      chosen.push_back(centres[i]);
    }
  }
  if (chosen.empty())
  {
    ThrowInvalidArgument("No seed lies inside the object.");
  }
  return chosen;
}
}
