// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/InterfaceClearance.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace volumic
{
namespace
{
/** A point of a triangle is at most so far from the nearest corner, in its longest edge. */
constexpr double ReachOfEdge = 0.5773503;

struct Box
{
  Vector Low;
  Vector High;

  explicit Box(const MeshTriangle& t)
    : Low(static_cast<float>(std::min({ t.Corner[0].X, t.Corner[1].X, t.Corner[2].X })),
        static_cast<float>(std::min({ t.Corner[0].Y, t.Corner[1].Y, t.Corner[2].Y })),
        static_cast<float>(std::min({ t.Corner[0].Z, t.Corner[1].Z, t.Corner[2].Z }))),
      High(static_cast<float>(std::max({ t.Corner[0].X, t.Corner[1].X, t.Corner[2].X })),
        static_cast<float>(std::max({ t.Corner[0].Y, t.Corner[1].Y, t.Corner[2].Y })),
        static_cast<float>(std::max({ t.Corner[0].Z, t.Corner[1].Z, t.Corner[2].Z })))
  {
  }
  void Add(const Box& other)
  {
    this->Low = Vector(std::min(this->Low.X, other.Low.X), std::min(this->Low.Y, other.Low.Y),
      std::min(this->Low.Z, other.Low.Z));
    this->High = Vector(std::max(this->High.X, other.High.X),
      std::max(this->High.Y, other.High.Y), std::max(this->High.Z, other.High.Z));
  }
};

bool Has(const PlacedFace& face, int v)
{
  return face.Vertex[0] == v || face.Vertex[1] == v || face.Vertex[2] == v;
}

bool IsFaceApart(const Vector& a, const Vector& b, const Vector& c, const Vector& low,
  const Vector& high)
{
  return (a.X < low.X && b.X < low.X && c.X < low.X) ||
    (a.X > high.X && b.X > high.X && c.X > high.X) ||
    (a.Y < low.Y && b.Y < low.Y && c.Y < low.Y) ||
    (a.Y > high.Y && b.Y > high.Y && c.Y > high.Y) ||
    (a.Z < low.Z && b.Z < low.Z && c.Z < low.Z) || (a.Z > high.Z && b.Z > high.Z && c.Z > high.Z);
}
}

PlacedFace PlacedFaceOf(const InterfaceMesh& mesh, const InterfaceMesh::Face& face)
{
  return { TriangleOf(mesh, face.Vertex), face.Behind, face.Front };
}

bool AreInOrder(int u, int v, const std::vector<PlacedFace>& faces)
{
  struct Turn
  {
    double Angle;
    LabelMap::Number Before; ///< the object at smaller angles
    LabelMap::Number After;
  };
  std::vector<Turn> turns;
  VectorD axis;
  VectorD first;
  VectorD second;
  for (const PlacedFace& face : faces)
  {
    int at = 0;
    while (face.Vertex[at] == u || face.Vertex[at] == v)
    {
      ++at;
    }
    // From the opposite vertex on, the edge is gone along in the one direction or the other.
    const bool isForward = face.Vertex[(at + 1) % 3] == u;
    const VectorD& from = face.Corner[(at + (isForward ? 1 : 2)) % 3];
    if (turns.empty())
    {
      axis = Normalized(face.Corner[(at + (isForward ? 2 : 1)) % 3] - from);
    }
    const VectorD way = face.Corner[at] - from;
    const VectorD across = way - axis * Dot(axis, way);
    if (turns.empty())
    {
      first = across;
      second = Cross(axis, across);
    }
    turns.push_back({ std::atan2(Dot(second, across), Dot(first, across)),
      isForward ? face.Behind : face.Front, isForward ? face.Front : face.Behind });
  }
  std::sort(turns.begin(), turns.end(),
    [](const Turn& a, const Turn& b) { return a.Angle < b.Angle; });
  for (std::size_t n = 0; n < turns.size(); ++n)
  {
    if (turns[n].After != turns[(n + 1) % turns.size()].Before)
    {
      return false;
    }
  }
  return true;
}

MeshTriangle TriangleOf(const InterfaceMesh& mesh, const std::array<int, 3>& vertices)
{
  MeshTriangle triangle;
  for (int k = 0; k < 3; ++k)
  {
    triangle.Vertex[k] = vertices[k];
    triangle.Corner[k] = VectorD(mesh.Position[static_cast<std::size_t>(vertices[k])]);
  }
  return triangle;
}

InterfaceClearance::InterfaceClearance(const InterfaceMesh& mesh, double tolerance)
  : Mesh(mesh), Tolerance(tolerance)
{
}

void InterfaceClearance::Reset(double longest)
{
  const std::vector<Vector>& positions = this->Mesh.Position;
  Vector low;
  Vector high;
  if (!positions.empty())
  {
    low = high = positions.front();
  }
  for (const Vector& p : positions)
  {
    low = Vector(std::min(low.X, p.X), std::min(low.Y, p.Y), std::min(low.Z, p.Z));
    high = Vector(std::max(high.X, p.X), std::max(high.Y, p.Y), std::max(high.Z, p.Z));
  }
  this->LongestReach = static_cast<float>(ReachOfEdge * longest + this->Tolerance);
  this->Grid.Reset(low, high, static_cast<float>(std::max(longest, 1e-6)));
  this->Grid.Resize(positions.size());
  for (int v = 0; v < static_cast<int>(positions.size()); ++v)
  {
    if (this->Mesh.IsVertex(v))
    {
      this->Insert(v);
    }
  }
  this->Reach.assign(positions.size(), 0.f);
  for (int face = 0; face < static_cast<int>(this->Mesh.Faces.size()); ++face)
  {
    this->Change(face);
  }
}

void InterfaceClearance::Change(int face)
{
  const std::array<int, 3>& v = this->Mesh.Faces[static_cast<std::size_t>(face)].Vertex;
  if (v[0] < 0)
  {
    return;
  }
  const Vector* at = this->Mesh.Position.data();
  const float longest = std::max({ SquaredDistance(at[v[0]], at[v[1]]),
    SquaredDistance(at[v[1]], at[v[2]]), SquaredDistance(at[v[2]], at[v[0]]) });
  const float reach = static_cast<float>(ReachOfEdge * std::sqrt(longest) + this->Tolerance);
  this->LongestReach = std::max(this->LongestReach, reach);
  for (const int w : v)
  {
    float& of = this->Reach[static_cast<std::size_t>(w)];
    of = std::max(of, reach);
  }
}

void InterfaceClearance::FindNear(
  const Vector& low, const Vector& high, int first, Memory& memory) const
{
  memory.Seen.resize(this->Mesh.Faces.size(), 0);
  memory.Near.clear();
  ++memory.Now;
  const Vector margin(this->LongestReach, this->LongestReach, this->LongestReach);
  const float tolerance = static_cast<float>(this->Tolerance);
  const Vector thick(tolerance, tolerance, tolerance);
  const Vector from = low - thick;
  const Vector to = high + thick;
  this->Grid.VisitBox(low - margin, high + margin,
    [&](int w)
    {
      const Vector& p = this->Mesh.Position[static_cast<std::size_t>(w)];
      const float reach = this->Reach[static_cast<std::size_t>(w)];
      if (p.X < low.X - reach || p.X > high.X + reach || p.Y < low.Y - reach ||
        p.Y > high.Y + reach || p.Z < low.Z - reach || p.Z > high.Z + reach)
      {
        return;
      }
      this->Mesh.ForFaces(w,
        [&](int face)
        {
          int& seen = memory.Seen[static_cast<std::size_t>(face)];
          if (face < first || seen == memory.Now)
          {
            return;
          }
          seen = memory.Now;
          const std::array<int, 3>& v = this->Mesh.Faces[static_cast<std::size_t>(face)].Vertex;
          const Vector* at = this->Mesh.Position.data();
          if (!IsFaceApart(at[v[0]], at[v[1]], at[v[2]], from, to))
          {
            memory.Near.push_back(face);
          }
        });
    });
}

int InterfaceClearance::FindIntersecting(int face, int first, Memory& memory) const
{
  const MeshTriangle triangle =
    TriangleOf(this->Mesh, this->Mesh.Faces[static_cast<std::size_t>(face)].Vertex);
  const Box box(triangle);
  this->FindNear(box.Low, box.High, first, memory);
  for (const int other : memory.Near)
  {
    if (other != face &&
      TrianglesIntersect(triangle,
        TriangleOf(this->Mesh, this->Mesh.Faces[static_cast<std::size_t>(other)].Vertex),
        this->Tolerance))
    {
      return other;
    }
  }
  return -1;
}

bool InterfaceClearance::AreClear(const std::vector<PlacedFace>& faces,
  const std::vector<int>& replaced, Memory& memory) const
{
  if (faces.empty())
  {
    return true;
  }
  Box all(faces.front());
  std::vector<Box> boxes;
  const float thick = static_cast<float>(this->Tolerance);
  for (const PlacedFace& triangle : faces)
  {
    boxes.emplace_back(triangle);
    all.Add(boxes.back());
    boxes.back().Low -= Vector(thick, thick, thick);
    boxes.back().High += Vector(thick, thick, thick);
  }
  this->FindNear(all.Low, all.High, 0, memory);
  for (std::size_t n = 0; n < faces.size(); ++n)
  {
    for (std::size_t m = n + 1; m < faces.size(); ++m)
    {
      if (TrianglesIntersect(faces[n], faces[m], this->Tolerance))
      {
        return false;
      }
    }
  }
  const bool isAtLine = std::any_of(faces.begin(), faces.end(),
    [this](const PlacedFace& face) { return this->IsAtLine(face); });
  std::vector<int> others;
  for (const int face : memory.Near)
  {
    if (std::find(replaced.begin(), replaced.end(), face) != replaced.end())
    {
      continue;
    }
    if (isAtLine)
    {
      others.push_back(face);
    }
    const std::array<int, 3>& v = this->Mesh.Faces[static_cast<std::size_t>(face)].Vertex;
    const Vector* at = this->Mesh.Position.data();
    for (std::size_t n = 0; n < faces.size(); ++n)
    {
      if (!IsFaceApart(at[v[0]], at[v[1]], at[v[2]], boxes[n].Low, boxes[n].High) &&
        TrianglesIntersect(faces[n], TriangleOf(this->Mesh, v), this->Tolerance))
      {
        return false;
      }
    }
  }
  return !isAtLine || this->AreInOrderAtLines(faces, others);
}

bool InterfaceClearance::IsAtLine(const PlacedFace& face) const
{
  return std::count_if(face.Vertex, face.Vertex + 3,
           [this](int v)
           {
             return this->Mesh.StratumOf[static_cast<std::size_t>(v)] != Stratum::Interface;
           }) > 1;
}

bool InterfaceClearance::AreInOrderAtLines(
  const std::vector<PlacedFace>& faces, const std::vector<int>& others) const
{
  std::vector<PlacedFace> about;
  for (const PlacedFace& face : faces)
  {
    for (int k = 0; k < 3; ++k)
    {
      const int u = face.Vertex[k];
      const int v = face.Vertex[(k + 1) % 3];
      if (this->Mesh.StratumOf[static_cast<std::size_t>(u)] == Stratum::Interface ||
        this->Mesh.StratumOf[static_cast<std::size_t>(v)] == Stratum::Interface)
      {
        continue;
      }
      about.clear();
      std::copy_if(faces.begin(), faces.end(), std::back_inserter(about),
        [&](const PlacedFace& other) { return Has(other, u) && Has(other, v); });
      for (const int other : others)
      {
        const InterfaceMesh::Face& there = this->Mesh.Faces[static_cast<std::size_t>(other)];
        if (there.Has(u) && there.Has(v))
        {
          about.push_back(PlacedFaceOf(this->Mesh, there));
        }
      }
      if (about.size() > 2 && !AreInOrder(u, v, about))
      {
        return false;
      }
    }
  }
  return true;
}
}
