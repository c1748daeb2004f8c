// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/InterfaceClearance.h"

#include "Core/Common/Spans.h"
#include "Core/Interfaces/TriangleShape.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace volumic
{
namespace
{
constexpr std::size_t SpanSize = 4096;

bool Has(const MeshTriangle& face, int v)
{
  return face.Vertex[0] == v || face.Vertex[1] == v || face.Vertex[2] == v;
}

const VectorD& CornerAt(const MeshTriangle& face, int v)
{
  return face.Corner[std::find(face.Vertex, face.Vertex + 3, v) - face.Vertex];
}

/** Signed dihedral angle between two faces at an edge: cosine and sine, up to a common factor. */
struct Turn
{
  double Cosine;
  double Sine;
};

Turn TurnAt(int u, int v, const std::array<MeshTriangle, 2>& faces)
{
  const VectorD first = AcrossEdge(faces[0], u, v);
  const VectorD second = AcrossEdge(faces[1], u, v);
  const VectorD axis = Normalized(CornerAt(faces[0], v) - CornerAt(faces[0], u));
  return { Dot(first, second), Dot(axis, Cross(first, second)) };
}
}

VectorD AcrossEdge(const MeshTriangle& face, int u, int v)
{
  const int at = static_cast<int>(
    std::find_if(face.Vertex, face.Vertex + 3, [&](int w) { return w != u && w != v; }) -
    face.Vertex);
  const VectorD& from = CornerAt(face, u);
  const VectorD axis = CornerAt(face, v) - from;
  const VectorD toCorner = face.Corner[at] - from;
  return toCorner * SquaredLength(axis) - axis * Dot(axis, toCorner);
}

bool HavePassed(
  int u, int v, const std::array<MeshTriangle, 2>& before, const std::array<MeshTriangle, 2>& after)
{
  const Turn from = TurnAt(u, v, before);
  const Turn to = TurnAt(u, v, after);
  if (std::signbit(from.Sine) == std::signbit(to.Sine))
  {
    return false;
  }
  constexpr double straightAngle = 3.14159265358979;
  return std::abs(std::atan2(from.Sine, from.Cosine)) + std::abs(std::atan2(to.Sine, to.Cosine)) <
    straightAngle;
}

float LongestSide(const Box& box)
{
  const Vector sides = box.High - box.Low;
  return std::max({ sides.X, sides.Y, sides.Z });
}

Box BoxOf(const MeshTriangle& t)
{
  return Box::Of(Vector(t.Corner[0]), Vector(t.Corner[1]), Vector(t.Corner[2]));
}

FaceCoordinates FaceCoordinatesOf(const InterfaceMesh& mesh, const InterfaceMesh::Face& face)
{
  return { TriangleOf(mesh, face.Vertex), face.Behind, face.Front };
}

bool AreInOrder(int u, int v, const std::vector<FaceCoordinates>& faces)
{
  struct Side
  {
    double Angle;
    LabelMap::Number Before; ///< the object at smaller angles
    LabelMap::Number After;
  };
  std::vector<Side> turns;
  VectorD axis;
  VectorD first;
  VectorD second;
  for (const FaceCoordinates& face : faces)
  {
    int at = 0;
    while (face.Vertex[at] == u || face.Vertex[at] == v)
    {
      ++at;
    }
    // Direction of the edge in the face, from the opposite vertex on.
    const bool isForward = face.Vertex[(at + 1) % 3] == u;
    const VectorD& from = face.Corner[(at + (isForward ? 1 : 2)) % 3];
    if (turns.empty())
    {
      axis = Normalized(face.Corner[(at + (isForward ? 2 : 1)) % 3] - from);
    }
    const VectorD toCorner = face.Corner[at] - from;
    const VectorD across = toCorner - axis * Dot(axis, toCorner);
    if (turns.empty())
    {
      first = across;
      second = Cross(axis, across);
    }
    turns.push_back({ std::atan2(Dot(second, across), Dot(first, across)),
      isForward ? face.Behind : face.Front, isForward ? face.Front : face.Behind });
  }
  std::sort(
    turns.begin(), turns.end(), [](const Side& a, const Side& b) { return a.Angle < b.Angle; });
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

MeshTriangle TriangleAt(const InterfaceMesh& mesh, int face)
{
  return TriangleOf(mesh, mesh.Faces[static_cast<std::size_t>(face)].Vertex);
}

InterfaceClearance::InterfaceClearance(const InterfaceMesh& mesh, double tolerance)
  : Mesh(mesh), Tolerance(tolerance)
{
}

void InterfaceClearance::Reset(Executor& executor)
{
  const LargeVector<InterfaceMesh::Face>& faces = this->Mesh.Faces;
  const Vector* at = this->Mesh.Position.data();
  LargeVector<Vector> middles(faces.size());
  this->Boxes.resize(faces.size());
  const FaceBoxes boxes = FindBoxes(this->Mesh, SpanSize, executor,
    [&](int face)
    {
      const auto f = static_cast<std::size_t>(face);
      const std::array<int, 3>& v = faces[f].Vertex;
      this->Boxes[f] = Box::Of(at[v[0]], at[v[1]], at[v[2]]);
      middles[f] = this->Boxes[f].Middle();
      return this->Boxes[f];
    });
  this->All = boxes.All;
  this->Reach = 0.5f * boxes.Longest;
  this->Grid.Reset(
    this->All.Low, this->All.High, std::max(static_cast<float>(boxes.MeanSide()), 1e-6f));
  this->Grid.InsertAll(
    middles, 0, [&](int f) { return faces[static_cast<std::size_t>(f)].IsThere(); }, executor);
}

void InterfaceClearance::Change(int face)
{
  const std::array<int, 3>& v = this->Mesh.Faces[static_cast<std::size_t>(face)].Vertex;
  if (v[0] < 0)
  {
    this->Grid.Remove(face);
    return;
  }
  const Vector* at = this->Mesh.Position.data();
  Box& box = this->Boxes[static_cast<std::size_t>(face)];
  box = Box::Of(at[v[0]], at[v[1]], at[v[2]]);
  if (0.5f * LongestSide(box) > this->Reach)
  {
    this->Reach = 0.5f * LongestSide(box);
  }
  this->Grid.Move(face, box.Middle());
}

void InterfaceClearance::FindNear(const Box& box, std::vector<int>& near) const
{
  near.clear();
  const Box thick = box.Grown(static_cast<float>(this->Tolerance));
  const Box reached = thick.Grown(this->Reach);
  this->Grid.VisitBox(reached.Low, reached.High,
    [&](int face)
    {
      if (!this->Boxes[static_cast<std::size_t>(face)].IsApartFrom(thick))
      {
        near.push_back(face);
      }
    });
}

int InterfaceClearance::FindIntersecting(int face, std::vector<int>& near) const
{
  const MeshTriangle triangle = TriangleAt(this->Mesh, face);
  this->FindNear(this->BoxOf(face), near);
  for (const int other : near)
  {
    if (other != face &&
      TrianglesIntersect(triangle, TriangleAt(this->Mesh, other), this->Tolerance))
    {
      return other;
    }
  }
  return -1;
}

bool InterfaceClearance::AreClear(const std::vector<FaceCoordinates>& faces,
  const std::vector<int>& replaced, std::vector<int>& near) const
{
  if (faces.empty())
  {
    return true;
  }
  Box all = volumic::BoxOf(faces.front());
  std::vector<Box> boxes;
  for (const FaceCoordinates& triangle : faces)
  {
    const Box box = volumic::BoxOf(triangle);
    all = all.With(box);
    boxes.push_back(box.Grown(static_cast<float>(this->Tolerance)));
  }
  for (const int face : replaced)
  {
    all = all.With(this->BoxOf(face));
  }
  this->FindNear(all, near);
  const std::vector<Sheet> sheets = this->FindSheets(faces, near);
  if (sheets.size() == 1 && sheets.front().IsOne && sheets.front().IsAlone)
  {
    return true;
  }
  std::vector<const Sheet*> sheetOf;
  std::transform(faces.begin(), faces.end(), std::back_inserter(sheetOf),
    [&](const FaceCoordinates& face) -> const Sheet*
    {
      return &*std::find_if(
        sheets.begin(), sheets.end(), [&](const Sheet& sheet) { return sheet.Has(face); });
    });
  for (std::size_t n = 0; n < faces.size(); ++n)
  {
    for (std::size_t m = n + 1; m < faces.size(); ++m)
    {
      if (!(sheetOf[n] == sheetOf[m] && sheetOf[n]->IsOne) &&
        TrianglesIntersect(faces[n], faces[m], this->Tolerance))
      {
        return false;
      }
    }
  }
  const bool isAtLine = std::any_of(faces.begin(), faces.end(),
    [this](const FaceCoordinates& face) { return this->IsAtLine(face); });
  std::vector<int> others;
  for (const int face : near)
  {
    if (std::find(replaced.begin(), replaced.end(), face) != replaced.end())
    {
      continue;
    }
    if (isAtLine)
    {
      others.push_back(face);
    }
    const InterfaceMesh::Face& existing = this->Mesh.Faces[static_cast<std::size_t>(face)];
    const Box& box = this->BoxOf(face);
    for (std::size_t n = 0; n < faces.size(); ++n)
    {
      if (!(sheetOf[n]->IsOne && sheetOf[n]->Has(existing)) && !box.IsApartFrom(boxes[n]) &&
        TrianglesIntersect(faces[n], TriangleOf(this->Mesh, existing.Vertex), this->Tolerance))
      {
        return false;
      }
    }
  }
  return (!isAtLine || this->AreInOrderAtLines(faces, others)) && !this->PassAny(faces, replaced);
}

std::vector<InterfaceClearance::Sheet> InterfaceClearance::FindSheets(
  const std::vector<FaceCoordinates>& faces, const std::vector<int>& near) const
{
  std::vector<Sheet> sheets;
  const auto sheetOf = [&](const auto& face)
  {
    return std::find_if(
      sheets.begin(), sheets.end(), [&](const Sheet& sheet) { return sheet.Has(face); });
  };
  for (const FaceCoordinates& face : faces)
  {
    auto sheet = sheetOf(face);
    if (sheet == sheets.end())
    {
      sheet = sheets.insert(sheet, Sheet{ face.Behind, face.Front, VectorD() });
    }
    sheet->Along += NormalOf(face);
  }
  for (Sheet& sheet : sheets)
  {
    sheet.Along = Normalized(sheet.Along);
  }
  const auto update = [](Sheet& sheet, const VectorD& normal)
  { sheet.IsOne = sheet.IsOne && Dot(normal, sheet.Along) > LeastSheetCosine * Length(normal); };
  for (const FaceCoordinates& face : faces)
  {
    update(*sheetOf(face), NormalOf(face));
  }
  for (const int f : near)
  {
    const InterfaceMesh::Face& face = this->Mesh.Faces[static_cast<std::size_t>(f)];
    const auto sheet = sheetOf(face);
    if (sheet != sheets.end())
    {
      update(*sheet, this->Mesh.NormalOf(face));
    }
    else
    {
      sheets.front().IsAlone = false;
    }
  }
  return sheets;
}

bool InterfaceClearance::PassAny(
  const std::vector<FaceCoordinates>& faces, const std::vector<int>& replaced) const
{
  std::vector<int> atEdge;
  const auto isFixed = [this](const FaceCoordinates& face, int k)
  {
    const Vector& position = this->Mesh.Position[static_cast<std::size_t>(face.Vertex[k])];
    return SquaredDistance(face.Corner[k], VectorD(position)) == 0.;
  };
  for (const FaceCoordinates& face : faces)
  {
    for (int k = 0; k < 3; ++k)
    {
      const int u = face.Vertex[k];
      const int v = face.Vertex[(k + 1) % 3];
      if (!isFixed(face, k) || !isFixed(face, (k + 1) % 3))
      {
        continue;
      }
      this->Mesh.FindFaces(u, v, atEdge);
      const auto isReplaced = [&](int f)
      { return std::find(replaced.begin(), replaced.end(), f) != replaced.end(); };
      const auto isPredecessor = [&](int f)
      {
        const InterfaceMesh::Face& old = this->Mesh.Faces[static_cast<std::size_t>(f)];
        return isReplaced(f) && old.Behind == face.Behind && old.Front == face.Front;
      };
      const auto old = std::find_if(atEdge.begin(), atEdge.end(), isPredecessor);
      if (old == atEdge.end())
      {
        continue; // The face has no predecessor at this edge.
      }
      const MeshTriangle before = TriangleAt(this->Mesh, *old);
      for (const int f : atEdge)
      {
        const MeshTriangle other = TriangleAt(this->Mesh, f);
        if (!isReplaced(f) && HavePassed(u, v, { before, other }, { face, other }))
        {
          return true;
        }
      }
    }
  }
  return false;
}

bool InterfaceClearance::IsAtLine(const FaceCoordinates& face) const
{
  return std::count_if(face.Vertex, face.Vertex + 3,
           [this](int v)
           { return this->Mesh.StratumOf[static_cast<std::size_t>(v)] != Stratum::Interface; }) > 1;
}

bool InterfaceClearance::AreInOrderAtLines(
  const std::vector<FaceCoordinates>& faces, const std::vector<int>& others) const
{
  std::vector<FaceCoordinates> atEdge;
  for (const FaceCoordinates& face : faces)
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
      atEdge.clear();
      std::copy_if(faces.begin(), faces.end(), std::back_inserter(atEdge),
        [&](const FaceCoordinates& other) { return Has(other, u) && Has(other, v); });
      for (const int other : others)
      {
        const InterfaceMesh::Face& existing = this->Mesh.Faces[static_cast<std::size_t>(other)];
        if (existing.Has(u) && existing.Has(v))
        {
          atEdge.push_back(FaceCoordinatesOf(this->Mesh, existing));
        }
      }
      for (FaceCoordinates& neighbour : atEdge)
      {
        neighbour.Front =
          this->Mesh.IsSide(neighbour.Front) ? LabelMap::Number(0) : neighbour.Front;
      }
      if (atEdge.size() > 2 && !AreInOrder(u, v, atEdge))
      {
        return false;
      }
    }
  }
  return true;
}
}
