// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "LabelJudge.h"

#include "JudgeInternals.h"
#include "MisclassifiedVoxels.h"
#include "SurfaceJudge.h"

#include <algorithm>
#include <stdexcept>

namespace volumic::support
{
namespace
{

using Vector = std::array<double, 3>;

constexpr double Degrees = 57.295779513082320877;

/** Return a normal whose length is twice the area. */
Vector NormalOf(const TriangleSurface& surface, const std::array<int, 3>& triangle)
{
  const Vector& origin = surface.Points[triangle[0]];
  return Cross(Difference(surface.Points[triangle[1]], origin),
    Difference(surface.Points[triangle[2]], origin));
}

double AngleBetween(const Vector& a, const Vector& b)
{
  return Degrees * std::atan2(Norm(Cross(a, b)), Dot(a, b));
}

/** Closest point of the surface of a shape, found by Newton's method. */
class Foot
{
public:
  double Distance;
  Vector Normal;

  Foot(const LabelShape& shape, const Vector& from)
  {
    Vector point = from;
    for (int i = 0; i < 5; ++i)
    {
      const double value = shape.Distance(point);
      this->Normal = GradientAt(shape, point);
      const double squared = Dot(this->Normal, this->Normal);
      if (std::abs(value) < 1e-10 || squared < 1e-6)
      {
        break; // converged, or the gradient vanishes
      }
      for (int a = 0; a < 3; ++a)
      {
        point[a] -= value / squared * this->Normal[a];
      }
    }
    this->Distance = Norm(Difference(from, point));
  }

private:
  static Vector GradientAt(const LabelShape& shape, const Vector& point)
  {
    const double step = 1e-4;
    Vector gradient;
    for (int a = 0; a < 3; ++a)
    {
      Vector before = point, behind = point;
      before[a] -= step;
      behind[a] += step;
      gradient[a] = (shape.Distance(behind) - shape.Distance(before)) / (2.0 * step);
    }
    return gradient;
  }
};

} // namespace

TruthVerdict JudgeTruth(const TriangleSurface& surface, const LabelShape& shape)
{
  CheckSurface(surface);
  if (!shape.Distance)
  {
    throw std::invalid_argument("JudgeTruth: the shape has no distance");
  }
  TruthVerdict verdict;
  std::vector<char> used(surface.Points.size(), 0);
  double area = 0.0, volume = 0.0;
  for (const auto& triangle : surface.Triangles)
  {
    Vector centroid = { 0.0, 0.0, 0.0 };
    for (const int corner : triangle)
    {
      used[corner] = 1;
      for (int a = 0; a < 3; ++a)
      {
        centroid[a] += surface.Points[corner][a] / 3.0;
      }
    }
    const Vector normal = NormalOf(surface, triangle);
    const Foot foot(shape, centroid);
    const double weight = Norm(normal);
    area += weight;
    volume += Dot(surface.Points[triangle[0]], normal) / 6.0;
    verdict.MeanAtCentroids += weight * foot.Distance;
    verdict.MeanAngle += weight * AngleBetween(normal, foot.Normal);
    verdict.Largest = std::max(verdict.Largest, foot.Distance);
  }
  std::size_t count = 0;
  for (std::size_t p = 0; p < surface.Points.size(); ++p)
  {
    if (used[p])
    {
      const Foot foot(shape, surface.Points[p]);
      verdict.MeanAtVertices += foot.Distance;
      verdict.Largest = std::max(verdict.Largest, foot.Distance);
      ++count;
    }
  }
  if (count > 0 && area > 0.0)
  {
    verdict.MeanAtVertices /= static_cast<double>(count);
    verdict.MeanAtCentroids /= area;
    verdict.MeanAngle /= area;
  }
  verdict.VolumeError = volume / shape.Volume - 1.0;
  return verdict;
}

DihedralVerdict JudgeDihedrals(const TriangleSurface& surface)
{
  CheckSurface(surface);
  struct Side
  {
    std::pair<int, int> Edge;
    std::size_t Triangle;
  };
  std::vector<Side> sides;
  sides.reserve(3 * surface.Triangles.size());
  for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
  {
    for (int c = 0; c < 3; ++c)
    {
      sides.push_back(
        { std::minmax({ surface.Triangles[t][c], surface.Triangles[t][(c + 1) % 3] }), t });
    }
  }
  std::sort(sides.begin(), sides.end(),
    [](const Side& a, const Side& b)
    { return a.Edge != b.Edge ? a.Edge < b.Edge : a.Triangle < b.Triangle; });
  std::vector<double> angles;
  for (std::size_t s = 0; s < sides.size();)
  {
    std::size_t end = s + 1;
    while (end < sides.size() && sides[end].Edge == sides[s].Edge)
    {
      ++end;
    }
    if (end == s + 2)
    {
      const Vector a = NormalOf(surface, surface.Triangles[sides[s].Triangle]);
      const Vector b = NormalOf(surface, surface.Triangles[sides[s + 1].Triangle]);
      angles.push_back(AngleBetween(a, b));
    }
    s = end;
  }
  DihedralVerdict verdict;
  if (!angles.empty())
  {
    verdict.Largest = *std::max_element(angles.begin(), angles.end());
    verdict.Median = Quantile(angles, 0.5);
    verdict.Quantile95 = Quantile(angles, 0.95);
  }
  return verdict;
}

MisclassifiedVoxelVerdict JudgeVoxels(
  const TriangleSurface& surface, const LabelMap& map, int label)
{
  CheckSurface(surface);
  TriangleSurface inIndices = surface;
  for (Vector& point : inIndices.Points)
  {
    for (int a = 0; a < 3; ++a)
    {
      point[a] = (point[a] - map.Origin[a]) / map.Spacing[a];
    }
  }
  const std::vector<char> enclosed = EnclosedVoxels(inIndices, map.Size);
  MisclassifiedVoxelVerdict verdict;
  for (std::size_t v = 0; v < enclosed.size(); ++v)
  {
    const bool isOfLabel = map.Values[v] == label;
    verdict.Label += isOfLabel;
    verdict.Outside += isOfLabel && !enclosed[v];
    verdict.Inside += !isOfLabel && enclosed[v];
  }
  return verdict;
}

} // namespace volumic::support
