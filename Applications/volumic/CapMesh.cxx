// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CapMesh.h"

#include "SolidRegions.h"
#include "VolumeImage.h"

#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace tool
{
namespace
{
/** Longer edges are split, in the wanted length. */
constexpr double LongestShare = 4. / 3.;
constexpr int Smoothings = 5;
/** By how much two angles opposite an edge are more than half a turn where it is flipped. */
constexpr double LeastGain = 1e-6;

Vector3 PointOf(vtkPolyData* surface, vtkIdType point)
{
  Vector3 place;
  surface->GetPoint(point, place.data());
  return place;
}

Vector3 NormalOf(vtkPolyData* surface, const std::array<vtkIdType, 3>& corners)
{
  const Vector3 a = PointOf(surface, corners[0]);
  return Cross(Minus(PointOf(surface, corners[1]), a), Minus(PointOf(surface, corners[2]), a));
}

/** At the first of three points. */
double AngleAt(vtkPolyData* surface, vtkIdType at, vtkIdType from, vtkIdType to)
{
  const Vector3 place = PointOf(surface, at);
  const Vector3 a = Minus(PointOf(surface, from), place);
  const Vector3 b = Minus(PointOf(surface, to), place);
  const Vector3 across = Cross(a, b);
  return std::atan2(std::sqrt(Dot(across, across)), Dot(a, b));
}
}

CapMesh::CapMesh(vtkPolyData* surface, std::vector<Triangle> triangles)
  : Triangles(std::move(triangles)), Surface(surface)
{
  for (std::size_t t = 0; t < this->Triangles.size(); ++t)
  {
    this->Add(t);
  }
}

std::size_t CapMesh::TriangleAt(const Edge& edge) const
{
  const auto found = this->AtEdge.find(this->KeyOf(edge));
  return found == this->AtEdge.end() ? None : found->second;
}

void CapMesh::Add(std::size_t triangle)
{
  const std::array<vtkIdType, 3>& corners = this->Triangles[triangle].Corners;
  for (std::size_t k = 0; k < 3; ++k)
  {
    const Edge edge = { corners[k], corners[(k + 1) % 3] };
    this->IsManifold = this->AtEdge.emplace(this->KeyOf(edge), triangle).second && this->IsManifold;
  }
}

void CapMesh::Remove(std::size_t triangle)
{
  const std::array<vtkIdType, 3>& corners = this->Triangles[triangle].Corners;
  for (std::size_t k = 0; k < 3; ++k)
  {
    this->AtEdge.erase(this->KeyOf({ corners[k], corners[(k + 1) % 3] }));
  }
}

vtkIdType CapMesh::Opposite(const Triangle& triangle, const Edge& edge)
{
  return *std::find_if(triangle.Corners.begin(), triangle.Corners.end(),
    [&](vtkIdType corner) { return corner != edge[0] && corner != edge[1]; });
}

double CapMesh::SquaredLength(const Edge& edge) const
{
  const Vector3 way = Minus(PointOf(this->Surface, edge[1]), PointOf(this->Surface, edge[0]));
  return Dot(way, way);
}

std::vector<CapMesh::Edge> CapMesh::LongEdges(double length) const
{
  std::vector<std::pair<double, Edge>> found;
  for (const Triangle& triangle : this->Triangles)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      const Edge edge = { triangle.Corners[k], triangle.Corners[(k + 1) % 3] };
      const double squared = this->SquaredLength(edge);
      if (edge[0] < edge[1] && squared > length * length &&
        this->TriangleAt({ edge[1], edge[0] }) != None)
      {
        found.emplace_back(-squared, edge);
      }
    }
  }
  std::sort(found.begin(), found.end());
  std::vector<Edge> edges;
  std::transform(found.begin(), found.end(), std::back_inserter(edges),
    [](const auto& entry) { return entry.second; });
  return edges;
}

vtkIdType CapMesh::AddMiddle(const Edge& edge)
{
  const Vector3 a = PointOf(this->Surface, edge[0]);
  const Vector3 b = PointOf(this->Surface, edge[1]);
  const vtkIdType added = this->Surface->GetPoints()->InsertNextPoint(
    0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2]));
  vtkPointData* data = this->Surface->GetPointData();
  for (int n = 0; n < data->GetNumberOfArrays(); ++n)
  {
    vtkAbstractArray* array = data->GetAbstractArray(n);
    array->InterpolateTuple(added, edge[0], array, edge[1], array, 0.5);
  }
  return added;
}

void CapMesh::Split(const Edge& edge)
{
  const vtkIdType middle = this->AddMiddle(edge);
  std::vector<Edge> changed;
  for (const Edge& way : { edge, Edge{ edge[1], edge[0] } })
  {
    const std::size_t t = this->TriangleAt(way);
    const vtkIdType opposite = Opposite(this->Triangles[t], way);
    this->Remove(t);
    this->Triangles[t].Corners = { way[0], middle, opposite };
    this->Triangles.push_back({ { middle, way[1], opposite }, this->Triangles[t].Plane });
    this->Add(t);
    this->Add(this->Triangles.size() - 1);
    changed.insert(changed.end(), { { way[1], opposite }, { opposite, way[0] } });
  }
  this->FlipFrom(changed);
}

void CapMesh::FlipFrom(std::vector<Edge> edges)
{
  while (!edges.empty())
  {
    const Edge edge = edges.back();
    edges.pop_back();
    const std::size_t t = this->TriangleAt(edge);
    const std::size_t u = this->TriangleAt({ edge[1], edge[0] });
    if (t != None && u != None && this->TryFlip(edge))
    {
      for (const std::size_t flipped : { t, u })
      {
        const std::array<vtkIdType, 3>& corners = this->Triangles[flipped].Corners;
        for (std::size_t k = 0; k < 3; ++k)
        {
          edges.push_back({ corners[k], corners[(k + 1) % 3] });
        }
      }
    }
  }
}

bool CapMesh::TryFlip(const Edge& edge)
{
  const std::size_t t = this->TriangleAt(edge);
  const std::size_t u = this->TriangleAt({ edge[1], edge[0] });
  const vtkIdType p = Opposite(this->Triangles[t], edge);
  const vtkIdType q = Opposite(this->Triangles[u], edge);
  const std::array<vtkIdType, 3> first = { edge[0], q, p };
  const std::array<vtkIdType, 3> second = { q, edge[1], p };
  const Vector3 normal = NormalOf(this->Surface, this->Triangles[t].Corners);
  const Vector3 other = NormalOf(this->Surface, this->Triangles[u].Corners);
  const Vector3 out = Dot(normal, normal) > Dot(other, other) ? normal : other;
  if (this->Triangles[t].Plane != this->Triangles[u].Plane ||
    AngleAt(this->Surface, p, edge[0], edge[1]) + AngleAt(this->Surface, q, edge[0], edge[1]) <
      M_PI + LeastGain ||
    this->TriangleAt({ p, q }) != None || this->TriangleAt({ q, p }) != None ||
    !(Dot(NormalOf(this->Surface, first), out) > 0.) ||
    !(Dot(NormalOf(this->Surface, second), out) > 0.))
  {
    return false;
  }
  this->Remove(t);
  this->Remove(u);
  this->Triangles[t].Corners = first;
  this->Triangles[u].Corners = second;
  this->Add(t);
  this->Add(u);
  return true;
}

void CapMesh::Smooth()
{
  std::map<vtkIdType, std::vector<std::size_t>> about; // of points within a plane
  std::map<vtkIdType, bool> isFixed;
  for (std::size_t t = 0; t < this->Triangles.size(); ++t)
  {
    const Triangle& triangle = this->Triangles[t];
    for (std::size_t k = 0; k < 3; ++k)
    {
      const Edge back = { triangle.Corners[(k + 1) % 3], triangle.Corners[k] };
      const std::size_t beside = this->TriangleAt(back);
      const bool isRim = beside == None || this->Triangles[beside].Plane != triangle.Plane;
      isFixed[back[0]] = isFixed[back[0]] || isRim;
      isFixed[back[1]] = isFixed[back[1]] || isRim;
      about[back[0]].push_back(t);
    }
  }
  for (const auto& [point, triangles] : about)
  {
    if (isFixed[point])
    {
      continue;
    }
    const Vector3 before = PointOf(this->Surface, point);
    Vector3 place = { 0.0, 0.0, 0.0 };
    for (const std::size_t t : triangles)
    {
      for (const vtkIdType corner : this->Triangles[t].Corners)
      {
        const Vector3 at = PointOf(this->Surface, corner);
        for (std::size_t axis = 0; axis < 3 && corner != point; ++axis)
        {
          place[axis] += at[axis] / (2.0 * static_cast<double>(triangles.size()));
        }
      }
    }
    std::vector<Vector3> normals;
    for (const std::size_t t : triangles)
    {
      normals.push_back(NormalOf(this->Surface, this->Triangles[t].Corners));
    }
    this->Surface->GetPoints()->SetPoint(point, place.data());
    for (std::size_t n = 0; n < triangles.size(); ++n)
    {
      if (!(Dot(NormalOf(this->Surface, this->Triangles[triangles[n]].Corners), normals[n]) > 0.))
      {
        this->Surface->GetPoints()->SetPoint(point, before.data());
        break;
      }
    }
  }
}

void CapMesh::MakeEven(double length)
{
  if (!this->IsManifold)
  {
    return; // Loops that touch are left as they are closed.
  }
  this->FlipFrom(this->LongEdges(0.));
  for (std::vector<Edge> edges; !(edges = this->LongEdges(LongestShare * length)).empty();)
  {
    for (const Edge& edge : edges)
    {
      if (this->TriangleAt(edge) != None && this->TriangleAt({ edge[1], edge[0] }) != None)
      {
        this->Split(edge);
      }
    }
  }
  for (int n = 0; n < Smoothings; ++n)
  {
    this->Smooth();
    this->FlipFrom(this->LongEdges(0.));
  }
}
}
