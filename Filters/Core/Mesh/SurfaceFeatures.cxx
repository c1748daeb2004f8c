// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/SurfaceFeatures.h"

#include "Core/Common/DisjointSets.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace volumic
{
namespace
{
/** Components of no more volume than this, in their area to the power of 3/2, count as flat. */
constexpr double FlatVolume = 1e-9;

/** The axes of the entries of a symmetric tensor, in the order in which they are kept. */
constexpr int TensorAxes[6][2] = { { 0, 0 }, { 1, 1 }, { 2, 2 }, { 0, 1 }, { 1, 2 }, { 0, 2 } };

/** Sums over the tetrahedra that the triangles span with a reference point of the component. */
struct Sums
{
  Point Reference = { 0., 0., 0. };
  double Area = 0.;
  double Volume = 0.;
  std::array<double, 3> AreaMoment{};
  std::array<double, 3> First{};
  std::array<double, 6> Second{}; ///< By TensorAxes.
  int Vertices = 0;
  int Triangles = 0;
};

void AddTriangle(Sums& sums, const Point& pa, const Point& pb, const Point& pc)
{
  std::array<double, 3> a;
  std::array<double, 3> b;
  std::array<double, 3> c;
  for (int k = 0; k < 3; ++k)
  {
    a[k] = pa[k] - sums.Reference[k];
    b[k] = pb[k] - sums.Reference[k];
    c[k] = pc[k] - sums.Reference[k];
  }
  const std::array<double, 3> u = { b[0] - a[0], b[1] - a[1], b[2] - a[2] };
  const std::array<double, 3> v = { c[0] - a[0], c[1] - a[1], c[2] - a[2] };
  const std::array<double, 3> n = { u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
    u[0] * v[1] - u[1] * v[0] };
  const double area = 0.5 * std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  // Six times the volume of the tetrahedron: a . (b x c) = a . n.
  const double det = a[0] * n[0] + a[1] * n[1] + a[2] * n[2];
  sums.Area += area;
  sums.Volume += det / 6.;
  for (int k = 0; k < 3; ++k)
  {
    sums.AreaMoment[k] += area * (a[k] + b[k] + c[k]) / 3.;
    sums.First[k] += det * (a[k] + b[k] + c[k]) / 24.;
  }
  for (int k = 0; k < 6; ++k)
  {
    const int i = TensorAxes[k][0];
    const int j = TensorAxes[k][1];
    const double si = a[i] + b[i] + c[i];
    const double sj = a[j] + b[j] + c[j];
    sums.Second[k] += det * (si * sj + a[i] * a[j] + b[i] * b[j] + c[i] * c[j]) / 120.;
  }
  ++sums.Triangles;
}

ComponentFeatures Finish(const Sums& sums)
{
  ComponentFeatures result;
  result.Vertices = sums.Vertices;
  result.Triangles = sums.Triangles;
  result.Area = sums.Area;
  result.Volume = sums.Volume;
  result.Genus = (2 - (sums.Vertices - sums.Triangles / 2)) / 2;
  std::array<double, 3> centre{};
  const bool solid = std::abs(sums.Volume) > FlatVolume * std::pow(sums.Area, 1.5);
  for (int k = 0; k < 3; ++k)
  {
    centre[k] = solid ? sums.First[k] / sums.Volume
                      : (sums.Area > 0. ? sums.AreaMoment[k] / sums.Area : 0.);
    result.Centroid[k] = sums.Reference[k] + centre[k];
  }
  std::array<double, 6> second = sums.Second;
  for (int k = 0; k < 6; ++k)
  {
    const int i = TensorAxes[k][0];
    const int j = TensorAxes[k][1];
    second[k] -= centre[i] * sums.First[j] + centre[j] * sums.First[i] -
      sums.Volume * centre[i] * centre[j];
  }
  result.Inertia = { second[1] + second[2], second[0] + second[2], second[0] + second[1],
    -second[3], -second[4], -second[5] };
  return result;
}
}

SurfaceFeatures ComputeFeatures(const IndexedSurface& surface)
{
  DisjointSets joined(surface.Points.size());
  for (const Triangle& t : surface.Triangles)
  {
    joined.Join(t[0], t[1]);
    joined.Join(t[1], t[2]);
  }
  std::vector<int> number(surface.Points.size(), -1);
  std::vector<Sums> sums;
  std::vector<int> component(surface.Triangles.size());
  for (std::size_t i = 0; i < surface.Triangles.size(); ++i)
  {
    const Triangle& t = surface.Triangles[i];
    int& c = number[joined.Find(t[0])];
    if (c < 0)
    {
      c = static_cast<int>(sums.size());
      sums.emplace_back();
      sums.back().Reference = surface.Points[t[0]];
    }
    component[i] = c;
    AddTriangle(sums[c], surface.Points[t[0]], surface.Points[t[1]], surface.Points[t[2]]);
  }
  for (std::size_t v = 0; v < surface.Points.size(); ++v)
  {
    const int c = number[joined.Find(static_cast<int>(v))];
    if (c >= 0)
    {
      ++sums[c].Vertices;
    }
  }
  std::vector<int> order(sums.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(
    order.begin(), order.end(), [&](int a, int b) { return sums[a].Area > sums[b].Area; });
  SurfaceFeatures result;
  std::vector<int> rank(sums.size());
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    rank[order[i]] = static_cast<int>(i);
    const ComponentFeatures features = Finish(sums[order[i]]);
    result.Area += features.Area;
    result.Volume += features.Volume;
    result.EulerCharacteristic += 2 - 2 * features.Genus;
    result.Genus += features.Genus;
    result.Components.push_back(features);
  }
  result.ComponentOfTriangle.resize(component.size());
  for (std::size_t i = 0; i < component.size(); ++i)
  {
    result.ComponentOfTriangle[i] = rank[component[i]];
  }
  return result;
}
}
