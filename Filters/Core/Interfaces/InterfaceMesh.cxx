// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/InterfaceMesh.h"

#include "Core/Common/Select.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <numeric>
#include <tuple>
#include <utility>

namespace volumic
{
void InterfaceMesh::Assign(LargeVector<Vector> positions, LargeVector<Face> faces)
{
  this->Position = std::move(positions);
  this->Faces = std::move(faces);
  this->StratumOf.assign(this->Position.size(), Stratum::Interface);
  this->Size.assign(this->Position.size(), 1.f);
  this->Head.assign(this->Position.size(), -1);
  this->NextImage.resize(this->Position.size());
  std::iota(this->NextImage.begin(), this->NextImage.end(), 0);
  this->Next.resize(3 * this->Faces.size());
  for (std::size_t f = 0; f < this->Faces.size(); ++f)
  {
    for (int k = 0; k < 3; ++k)
    {
      this->Link(static_cast<int>(3 * f) + k, this->Faces[f].Vertex[k]);
    }
  }
}

int InterfaceMesh::AddVertex(const Vector& position, Stratum stratum, float size)
{
  this->Position.push_back(position);
  this->StratumOf.push_back(stratum);
  this->Size.push_back(size);
  this->Head.push_back(-1);
  this->NextImage.push_back(static_cast<int>(this->Position.size()) - 1);
  return this->NextImage.back();
}

void InterfaceMesh::Link(int corner, int v)
{
  this->Next[static_cast<std::size_t>(corner)] = this->Head[static_cast<std::size_t>(v)];
  this->Head[static_cast<std::size_t>(v)] = corner;
}

void InterfaceMesh::Unlink(int corner, int v)
{
  int* at = &this->Head[static_cast<std::size_t>(v)];
  while (*at != corner)
  {
    at = &this->Next[static_cast<std::size_t>(*at)];
  }
  *at = this->Next[static_cast<std::size_t>(corner)];
}

int InterfaceMesh::AddFace(const Face& face)
{
  constexpr std::size_t most = std::numeric_limits<int>::max() / 3;
  if (this->Faces.size() >= most)
  {
    throw std::bad_alloc(); // Corner numbers would overflow.
  }
  const int number = static_cast<int>(this->Faces.size());
  this->Faces.push_back(face);
  this->Next.resize(3 * this->Faces.size());
  for (int k = 0; k < 3; ++k)
  {
    this->Link(3 * number + k, face.Vertex[k]);
  }
  return number;
}

void InterfaceMesh::RemoveFace(int face)
{
  Face& removed = this->Faces[static_cast<std::size_t>(face)];
  for (int k = 0; k < 3; ++k)
  {
    this->Unlink(3 * face + k, removed.Vertex[k]);
  }
  removed.Vertex = { -1, -1, -1 };
}

void InterfaceMesh::ReplaceVertex(int face, int old, int vertex)
{
  Face& changed = this->Faces[static_cast<std::size_t>(face)];
  const int k = changed.Vertex[0] == old ? 0 : changed.Vertex[1] == old ? 1 : 2;
  this->Unlink(3 * face + k, old);
  changed.Vertex[k] = vertex;
  this->Link(3 * face + k, vertex);
}

void InterfaceMesh::FindFaces(int u, int v, std::vector<int>& faces) const
{
  faces.clear();
  this->ForFaces(u,
    [&](int face)
    {
      if (this->Faces[static_cast<std::size_t>(face)].Has(v))
      {
        faces.push_back(face);
      }
    });
}

bool InterfaceMesh::IsLine(const std::vector<int>& faces) const
{
  const auto isOther = [this](int f, int g)
  {
    const Face& first = this->Faces[static_cast<std::size_t>(f)];
    const Face& second = this->Faces[static_cast<std::size_t>(g)];
    return first.Behind != second.Behind || first.Front != second.Front;
  };
  return faces.size() > 2 || (faces.size() == 2 && isOther(faces[0], faces[1]));
}

Vector InterfaceMesh::ProjectToSides(int v, const Vector& position) const
{
  if (this->FirstSide == std::numeric_limits<int>::max())
  {
    return position; // There is no box.
  }
  const Vector& own = this->Position[static_cast<std::size_t>(v)];
  Vector moved(std::clamp(position.X, this->Planes[0], this->Planes[1]),
    std::clamp(position.Y, this->Planes[2], this->Planes[3]),
    std::clamp(position.Z, this->Planes[4], this->Planes[5]));
  this->ForFaces(v,
    [&](int f)
    {
      const int front = this->Faces[static_cast<std::size_t>(f)].Front;
      if (this->IsSide(front))
      {
        float Vector::*const along[] = { &Vector::X, &Vector::Y, &Vector::Z };
        moved.*along[this->AxisOf(front)] = own.*along[this->AxisOf(front)];
      }
    });
  return moved;
}

bool InterfaceMesh::HasEdge(int u, int v) const
{
  bool has = false;
  this->ForFaces(
    u, [&](int face) { has = has || this->Faces[static_cast<std::size_t>(face)].Has(v); });
  return has;
}

void InterfaceMesh::FindNeighbours(int v, std::vector<int>& neighbours) const
{
  neighbours.clear();
  bool hasSides = false;
  this->ForFaces(v,
    [&](int face)
    {
      hasSides = hasSides || this->IsSide(this->Faces[static_cast<std::size_t>(face)].Front);
      for (const int w : this->Faces[static_cast<std::size_t>(face)].Vertex)
      {
        if (w != v)
        {
          neighbours.push_back(w);
        }
      }
    });
  std::sort(neighbours.begin(), neighbours.end());
  std::vector<int> faces;
  for (std::size_t n = 0; hasSides && n + 1 < neighbours.size(); ++n)
  {
    const int w = neighbours[n];
    if (neighbours[n + 1] == w && (n == 0 || neighbours[n - 1] != w))
    {
      this->FindFaces(v, w, faces);
      if (faces.size() == 2 && this->IsLine(faces))
      {
        neighbours.insert(neighbours.begin() + static_cast<std::ptrdiff_t>(n), w);
      }
    }
  }
}

void InterfaceMesh::FindObjects(int v, std::vector<int>& objects) const
{
  objects.clear();
  this->ForFaces(v,
    [&](int face)
    {
      objects.push_back(this->Faces[static_cast<std::size_t>(face)].Behind);
      objects.push_back(this->Faces[static_cast<std::size_t>(face)].Front);
    });
  SortUnique(objects);
}

void InterfaceMesh::FindStrata()
{
  std::vector<int> neighbours;
  for (int v = 0; v < static_cast<int>(this->Position.size()); ++v)
  {
    this->FindNeighbours(v, neighbours);
    int lines = 0;
    ForLineNeighbours(neighbours, [&lines](int) { ++lines; });
    this->StratumOf[static_cast<std::size_t>(v)] = lines == 0 ? Stratum::Interface
      : lines == 2                                            ? Stratum::Line
                                                              : Stratum::Corner;
  }
}

std::vector<std::array<int, 2>> InterfaceMesh::FindLines() const
{
  std::vector<std::array<int, 2>> lines;
  std::vector<int> neighbours;
  for (int v = 0; v < static_cast<int>(this->Position.size()); ++v)
  {
    if (this->StratumOf[static_cast<std::size_t>(v)] == Stratum::Interface)
    {
      continue;
    }
    this->FindNeighbours(v, neighbours);
    ForLineNeighbours(neighbours,
      [&](int w)
      {
        if (v < w)
        {
          lines.push_back({ v, w });
        }
      });
  }
  return lines;
}

std::vector<std::vector<int>> InterfaceMesh::FindFacesOfObjects() const
{
  std::vector<std::vector<int>> faces;
  for (int f = 0; f < static_cast<int>(this->Faces.size()); ++f)
  {
    const Face& face = this->Faces[static_cast<std::size_t>(f)];
    if (face.IsThere())
    {
      faces.resize(std::max<std::size_t>(faces.size(), face.Front + std::size_t(1)));
      faces[face.Behind].push_back(f);
      faces[face.Front].push_back(f);
    }
  }
  return faces;
}

IndexedSurface InterfaceMesh::SurfaceOf(
  int object, const std::vector<int>& faces, std::vector<int>& vertices) const
{
  vertices.clear();
  for (const int f : faces)
  {
    const std::array<int, 3>& corners = this->Faces[static_cast<std::size_t>(f)].Vertex;
    vertices.insert(vertices.end(), corners.begin(), corners.end());
  }
  SortUnique(vertices);
  IndexedSurface surface;
  for (const int v : vertices)
  {
    const Vector& p = this->Position[static_cast<std::size_t>(v)];
    surface.Points.push_back({ p.X, p.Y, p.Z });
  }
  for (const int f : faces)
  {
    const Face& face = this->Faces[static_cast<std::size_t>(f)];
    Triangle triangle;
    for (int k = 0; k < 3; ++k)
    {
      triangle[k] = static_cast<int>(
        std::lower_bound(vertices.begin(), vertices.end(), face.Vertex[k]) - vertices.begin());
    }
    if (this->Whole(face.Front) == object)
    {
      std::swap(triangle[1], triangle[2]);
    }
    surface.Triangles.push_back(triangle);
  }
  return surface;
}

VectorD InterfaceMesh::NormalOf(const Face& face) const
{
  const VectorD a(this->Position[static_cast<std::size_t>(face.Vertex[0])]);
  const VectorD b(this->Position[static_cast<std::size_t>(face.Vertex[1])]);
  const VectorD c(this->Position[static_cast<std::size_t>(face.Vertex[2])]);
  return Cross(b - a, c - a);
}

double InterfaceMesh::MeanEdge() const
{
  double sum = 0.;
  double count = 0.;
  for (const Face& face : this->Faces)
  {
    for (int k = 0; k < 3 && face.IsThere(); ++k)
    {
      sum += Length(this->Position[static_cast<std::size_t>(face.Vertex[k])] -
        this->Position[static_cast<std::size_t>(face.Vertex[(k + 1) % 3])]);
      count += 1.;
    }
  }
  return count > 0. ? sum / count : 0.;
}

void InterfaceMesh::Compact(bool isSorted)
{
  std::vector<int> order(this->Position.size());
  std::iota(order.begin(), order.end(), 0);
  if (isSorted)
  {
    std::sort(order.begin(), order.end(),
      [this](int a, int b)
      {
        const Vector& p = this->Position[static_cast<std::size_t>(a)];
        const Vector& q = this->Position[static_cast<std::size_t>(b)];
        return std::tie(p.Z, p.Y, p.X, a) < std::tie(q.Z, q.Y, q.X, b);
      });
  }
  InterfaceMesh kept;
  kept.FirstSide = this->FirstSide;
  kept.WholeOf = this->WholeOf;
  kept.Planes = this->Planes;
  std::vector<int> number(this->Position.size(), -1);
  for (const int vertex : order)
  {
    const auto v = static_cast<std::size_t>(vertex);
    if (this->Head[v] >= 0)
    {
      number[v] = kept.AddVertex(this->Position[v], this->StratumOf[v], this->Size[v]);
    }
  }
  for (std::size_t v = 0; v < number.size(); ++v)
  {
    if (number[v] >= 0)
    {
      kept.NextImage[static_cast<std::size_t>(number[v])] =
        number[static_cast<std::size_t>(this->NextImage[v])];
    }
  }
  for (Face face : this->Faces)
  {
    if (face.IsThere())
    {
      for (int& v : face.Vertex)
      {
        v = number[static_cast<std::size_t>(v)];
      }
      kept.AddFace(face);
    }
  }
  *this = std::move(kept);
}
}
