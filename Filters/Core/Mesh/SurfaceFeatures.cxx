// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/SurfaceFeatures.h"

#include "Core/Common/DisjointSets.h"
#include "Core/Common/Select.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

namespace volumic
{
namespace
{
/** A component is flat if its volume is at most this factor times its area to the power of 3/2. */
constexpr double FlatVolume = 1e-9;

/** Axes of the entries of a symmetric tensor, in storage order. */
constexpr int TensorAxes[6][2] = { { 0, 0 }, { 1, 1 }, { 2, 2 }, { 0, 1 }, { 1, 2 }, { 0, 2 } };

/** Points or triangles per task. */
constexpr std::size_t SpanSize = 8192;
/** Triangles whose terms are stored before they are summed. */
constexpr std::size_t BatchSize = 16 * SpanSize;

/** Contribution of a triangle: its tetrahedron with a reference point of the component. */
struct Terms
{
  double Area = 0.;
  double Volume = 0.;
  std::array<double, 3> AreaMoment{};
  std::array<double, 3> First{};
  std::array<double, 6> Second{}; ///< By TensorAxes.
};

struct Sums : Terms
{
  Point Reference = { 0., 0., 0. };
  int Vertices = 0;
  int Triangles = 0;

  void Add(const Terms& terms)
  {
    this->Area += terms.Area;
    this->Volume += terms.Volume;
    for (int k = 0; k < 3; ++k)
    {
      this->AreaMoment[k] += terms.AreaMoment[k];
      this->First[k] += terms.First[k];
    }
    for (int k = 0; k < 6; ++k)
    {
      this->Second[k] += terms.Second[k];
    }
    ++this->Triangles;
  }
};

Terms TermsOf(const Point& reference, const Point& pa, const Point& pb, const Point& pc)
{
  std::array<double, 3> a;
  std::array<double, 3> b;
  std::array<double, 3> c;
  for (int k = 0; k < 3; ++k)
  {
    a[k] = pa[k] - reference[k];
    b[k] = pb[k] - reference[k];
    c[k] = pc[k] - reference[k];
  }
  const std::array<double, 3> u = { b[0] - a[0], b[1] - a[1], b[2] - a[2] };
  const std::array<double, 3> v = { c[0] - a[0], c[1] - a[1], c[2] - a[2] };
  const std::array<double, 3> n = { u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
    u[0] * v[1] - u[1] * v[0] };
  const double area = 0.5 * std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  const double det = a[0] * n[0] + a[1] * n[1] + a[2] * n[2];
  Terms terms;
  terms.Area = area;
  terms.Volume = det / 6.;
  for (int k = 0; k < 3; ++k)
  {
    terms.AreaMoment[k] = area * (a[k] + b[k] + c[k]) / 3.;
    terms.First[k] = det * (a[k] + b[k] + c[k]) / 24.;
  }
  for (int k = 0; k < 6; ++k)
  {
    const int i = TensorAxes[k][0];
    const int j = TensorAxes[k][1];
    const double si = a[i] + b[i] + c[i];
    const double sj = a[j] + b[j] + c[j];
    terms.Second[k] = det * (si * sj + a[i] * a[j] + b[i] * b[j] + c[i] * c[j]) / 120.;
  }
  return terms;
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
  const bool hasVolume = std::abs(sums.Volume) > FlatVolume * std::pow(sums.Area, 1.5);
  for (int k = 0; k < 3; ++k)
  {
    centre[k] = hasVolume ? sums.First[k] / sums.Volume
                          : (sums.Area > 0. ? sums.AreaMoment[k] / sums.Area : 0.);
    result.Centroid[k] = sums.Reference[k] + centre[k];
  }
  std::array<double, 6> second = sums.Second;
  for (int k = 0; k < 6; ++k)
  {
    const int i = TensorAxes[k][0];
    const int j = TensorAxes[k][1];
    second[k] -=
      centre[i] * sums.First[j] + centre[j] * sums.First[i] - sums.Volume * centre[i] * centre[j];
  }
  result.Inertia = { second[1] + second[2], second[0] + second[2], second[0] + second[1],
    -second[3], -second[4], -second[5] };
  return result;
}

/** Components of a surface, numbered in the order of their first triangles. */
class Components
{
public:
  Components(const IndexedSurface& surface, Executor& executor);

  LargeVector<int> OfTriangle;
  std::vector<Sums> Initial; ///< Per component, before the sums over its triangles.

private:
  void FindRoots(const IndexedSurface& surface, Executor& executor);
  void Number(const IndexedSurface& surface, Executor& executor);

  LargeVector<int> Root; ///< By point: smallest point of its component.
};

Components::Components(const IndexedSurface& surface, Executor& executor)
{
  this->FindRoots(surface, executor);
  this->Number(surface, executor);
  LargeVector<int>().swap(this->Root);
}

void Components::FindRoots(const IndexedSurface& surface, Executor& executor)
{
  DisjointSets joined(surface.Points.size());
  ForSpans(executor, surface.Triangles.size(), SpanSize,
    [&](std::size_t, std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        const Triangle& t = surface.Triangles[i];
        joined.Join(t[0], t[1]);
        joined.Join(t[0], t[2]);
      }
    });
  MakeZeroed(this->Root, surface.Points.size());
  ForSpans(executor, this->Root.size(), SpanSize,
    [&](std::size_t, std::size_t begin, std::size_t end)
    {
      for (std::size_t p = begin; p < end; ++p)
      {
        this->Root[p] = joined.Find(static_cast<int>(p));
      }
    });
}

void Components::Number(const IndexedSurface& surface, Executor& executor)
{
  // By root: first its smallest triangle, then its number, both counted from 1, or 0.
  LargeVector<std::atomic<int>> number(this->Root.size());
  ForSpans(executor, surface.Triangles.size(), SpanSize,
    [&](std::size_t, std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        std::atomic<int>& first = number[this->Root[surface.Triangles[i][0]]];
        const int own = static_cast<int>(i) + 1;
        int found = first.load(std::memory_order_relaxed);
        while ((found == 0 || own < found) &&
          !first.compare_exchange_weak(found, own, std::memory_order_relaxed))
        {
        }
      }
    });
  std::vector<int> firsts = SelectIndices(
    executor, number.size(), [&](std::size_t root) { return number[root].load() != 0; });
  for (int& root : firsts)
  {
    root = number[root] - 1;
  }
  std::sort(firsts.begin(), firsts.end());
  for (const int first : firsts)
  {
    const int corner = surface.Triangles[first][0];
    this->Initial.emplace_back();
    this->Initial.back().Reference = surface.Points[corner];
    number[this->Root[corner]] = static_cast<int>(this->Initial.size());
  }
  MakeZeroed(this->OfTriangle, surface.Triangles.size());
  ForSpans(executor, this->OfTriangle.size(), SpanSize,
    [&](std::size_t, std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        this->OfTriangle[i] =
          number[this->Root[surface.Triangles[i][0]]].load(std::memory_order_relaxed) - 1;
      }
    });
  for (std::size_t p = 0; p < this->Root.size(); ++p)
  {
    const int own = number[this->Root[p]].load(std::memory_order_relaxed) - 1;
    if (own >= 0)
    {
      ++this->Initial[own].Vertices;
    }
  }
}

/** @param components component of each triangle */
void AddUp(const IndexedSurface& surface, const LargeVector<int>& components, Executor& executor,
  std::vector<Sums>& sums)
{
  LargeVector<Terms> terms;
  MakeZeroed(terms, std::min(surface.Triangles.size(), BatchSize));
  for (std::size_t first = 0; first < surface.Triangles.size(); first += BatchSize)
  {
    const std::size_t count = std::min(BatchSize, surface.Triangles.size() - first);
    ForSpans(executor, count, SpanSize,
      [&](std::size_t, std::size_t begin, std::size_t end)
      {
        for (std::size_t i = begin; i < end; ++i)
        {
          const Triangle& t = surface.Triangles[first + i];
          terms[i] = TermsOf(sums[components[first + i]].Reference, surface.Points[t[0]],
            surface.Points[t[1]], surface.Points[t[2]]);
        }
      });
    for (std::size_t i = 0; i < count; ++i)
    {
      sums[components[first + i]].Add(terms[i]);
    }
  }
}
}

SurfaceFeatures ComputeFeatures(const IndexedSurface& surface, Executor& executor)
{
  Components components(surface, executor);
  std::vector<Sums> sums = std::move(components.Initial);
  AddUp(surface, components.OfTriangle, executor, sums);
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
  result.ComponentOfTriangle = std::move(components.OfTriangle);
  ForSpans(executor, result.ComponentOfTriangle.size(), SpanSize,
    [&](std::size_t, std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        result.ComponentOfTriangle[i] = rank[result.ComponentOfTriangle[i]];
      }
    });
  return result;
}
}
