// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LabelJudge.h"

#include "JudgeInternals.h"
#include "MisclassifiedVoxels.h"
#include "SurfaceJudge.h"

#include <algorithm>
#include <map>

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
  TruthVerdict verdict;
  double area = 0.0, volume = 0.0;
  for (const auto& triangle : surface.Triangles)
  {
    const Vector normal = NormalOf(surface, triangle);
    const Foot foot(shape, CentroidOf(surface, triangle));
    const double weight = Norm(normal);
    area += weight;
    volume += Dot(surface.Points[triangle[0]], normal) / 6.0;
    verdict.MeanAtCentroids += weight * foot.Distance;
    verdict.MeanAngle += weight * AngleBetween(normal, foot.Normal);
  }
  for (const Vector& point : surface.Points)
  {
    verdict.MeanAtVertices += Foot(shape, point).Distance / surface.Points.size();
  }
  verdict.MeanAtCentroids /= area;
  verdict.MeanAngle /= area;
  verdict.VolumeError = volume / shape.Volume - 1.0;
  return verdict;
}

double DihedralQuantile(const TriangleSurface& surface)
{
  std::map<std::pair<int, int>, Vector> normals; // of the first triangle at each edge
  std::vector<double> angles;
  for (const auto& triangle : surface.Triangles)
  {
    const Vector normal = NormalOf(surface, triangle);
    for (int c = 0; c < 3; ++c)
    {
      const auto added = normals.emplace(std::minmax(triangle[c], triangle[(c + 1) % 3]), normal);
      if (!added.second)
      {
        angles.push_back(AngleBetween(added.first->second, normal));
      }
    }
  }
  return Quantile(angles, 0.95);
}

MisclassifiedVoxelVerdict JudgeVoxels(
  const TriangleSurface& surface, const LabelMap& map, int label)
{
  TriangleSurface inIndices = surface;
  for (Vector& point : inIndices.Points)
  {
    for (int a = 0; a < 3; ++a)
    {
      point[a] /= map.Spacing[a];
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
