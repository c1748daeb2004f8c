// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/SurfaceEditor.h"

#include "Core/Mesh/EdgeCollapse.h"
#include "Core/Mesh/EdgeFlip.h"
#include "Core/Mesh/EdgeSplit.h"
#include "Core/Mesh/VertexRemoval.h"
#include "Core/Surface/FaceShape.h"

#include <algorithm>
#include <utility>

namespace volumic
{
namespace
{
/** Least cosine between the normals of a face before and after an edit: 45 degrees. */
constexpr double SmoothCosine = 0.7;
/** The same if an edit must only keep the orientation of a face, with a margin. */
constexpr double LooseCosine = 0.1;

double LeastCosine(EditTolerance tolerance)
{
  return tolerance == EditTolerance::Smooth ? SmoothCosine : LooseCosine;
}

Vector FaceNormal(const SurfaceMesh& mesh, int a, int b, int c)
{
  return Normalized(
    Cross(mesh.Position[b] - mesh.Position[a], mesh.Position[c] - mesh.Position[a]));
}
}

void SurfaceEditor::MarkChanged(int v)
{
  this->Log.push_back(v);
  this->State.Activate(v);
}

void SurfaceEditor::MarkStarChanged(int v)
{
  this->MarkChanged(v);
  const Ring& ring = this->State.Mesh.Rings[v];
  for (int i = 0; i < ring.Count; ++i)
  {
    this->MarkChanged(ring.Item[i]);
  }
}

Edit SurfaceEditor::Done(std::size_t firstChange, int vertex) const
{
  const int* log = this->Log.data();
  return { true, vertex, { log + firstChange, log + this->Log.size() } };
}

std::vector<int> SurfaceEditor::TakeChanged()
{
  return std::exchange(this->Log, {});
}

bool SurfaceEditor::MayEdit(std::initializer_list<int> vertices) const
{
  return !this->Context ||
    std::all_of(vertices.begin(), vertices.end(),
      [this](int v) { return this->Context->Region.Contains(this->State.Mesh.Position[v]); });
}

void SurfaceEditor::AddToEulerCharacteristic(int change)
{
  (this->Context ? this->Context->EulerCharacteristic : this->State.EulerCharacteristic) += change;
}

Edit SurfaceEditor::Split(int u, int v)
{
  SurfaceState& s = this->State;
  const EdgeSplit split{ u, v };
  if (!this->MayEdit({ u }) || !split.IsLegal(s.Mesh) || !this->HasSlots(1))
  {
    return {};
  }
  const std::size_t first = this->Log.size();
  const int m =
    split.Apply(s.Mesh, (s.Mesh.Position[u] + s.Mesh.Position[v]) * 0.5f, this->Slots());
  s.AddVertex(m, u);
  s.Velocity[m] = (s.Velocity[u] + s.Velocity[v]) * 0.5f;
  // Only vertices being moved have a valid previous position.
  const auto before = [&s](int w)
  { return s.Marks[w] & IsWorking ? s.PreviousPosition[w] : s.Mesh.Position[w]; };
  s.PreviousPosition[m] = (before(u) + before(v)) * 0.5f;
  s.NearOthers[m] = s.NearOthers[u] | s.NearOthers[v];
  s.FieldValue[m] = 0.5f * (s.FieldValue[u] + s.FieldValue[v]);
  s.Size[m] = s.Sizing.OfEdge(u, v);
  ++this->Counts().Splits;
  this->MarkStarChanged(m);
  return this->Done(first, m);
}

bool SurfaceEditor::AddFacesAfterCollapse(
  int end, int kept, int removed, const Vector& position, EditTolerance tolerance)
{
  const SurfaceMesh& mesh = this->State.Mesh;
  const int otherEnd = end == kept ? removed : kept;
  const Ring& ring = mesh.Rings[end];
  for (int i = 0; i < ring.Count; ++i)
  {
    const int b = ring.Item[i];
    const int c = ring.Next(i);
    if (b == otherEnd || c == otherEnd)
    {
      continue;
    }
    const float longest = this->State.Sizing.LongestEdge(kept, b);
    if (SquaredDistance(position, mesh.Position[b]) > longest * longest)
    {
      return false;
    }
    const MeshTriangle face = { { kept, b, c },
      { VectorD(position), VectorD(mesh.Position[b]), VectorD(mesh.Position[c]) } };
    MeshTriangle old = face;
    old.Corner[0] = VectorD(mesh.Position[end]);
    if (!KeepsShape(old, face) || !TurnsLittle(old, face, LeastCosine(tolerance)))
    {
      return false;
    }
    this->Faces.push_back(face);
  }
  return true;
}

Edit SurfaceEditor::CollapseInto(
  int kept, int removed, const Vector& position, EditTolerance tolerance)
{
  SurfaceState& s = this->State;
  this->Faces.clear();
  if (!this->AddFacesAfterCollapse(kept, kept, removed, position, tolerance) ||
    !this->AddFacesAfterCollapse(removed, kept, removed, position, tolerance))
  {
    return {};
  }
  if (NewFacesIntersect(s, this->Faces, { { kept, removed }, 2, false }))
  {
    return {};
  }
  const std::size_t first = this->Log.size();
  if (s.Sizing.IsGraded())
  {
    // Interpolate along the edge, to keep the gradation if an end moves.
    const float toKept = Length(position - s.Mesh.Position[kept]);
    const float toRemoved = Length(position - s.Mesh.Position[removed]);
    const float length = toKept + toRemoved;
    const float weight = length > 0.f ? toRemoved / length : 1.f;
    s.Size[kept] = s.Sizing.At(kept) * weight + s.Sizing.At(removed) * (1.f - weight);
  }
  s.RemoveVertex(removed);
  EdgeCollapse{ kept, removed }.Apply(s.Mesh, this->Slots());
  s.Velocity[kept] = (s.Velocity[kept] + s.Velocity[removed]) * 0.5f;
  s.NearOthers[kept] |= s.NearOthers[removed];
  s.MoveTo(kept, position);
  ++this->Counts().Collapses;
  this->MarkStarChanged(kept);
  return this->Done(first);
}

Edit SurfaceEditor::Collapse(int u, int v, EditTolerance tolerance)
{
  const SurfaceMesh& mesh = this->State.Mesh;
  if (!this->MayEdit({ u, v }) || !EdgeCollapse{ u, v }.IsLegal(mesh))
  {
    return {};
  }
  const Vector pu = mesh.Position[u];
  const Vector pv = mesh.Position[v];
  Edit edit;
  for (const Vector& position : { (pu + pv) * 0.5f, pu, pv })
  {
    edit = this->CollapseInto(u, v, position, tolerance);
    if (edit)
    {
      break;
    }
  }
  return edit;
}

Edit SurfaceEditor::CollapseTo(int u, int v, const Vector& position, EditTolerance tolerance)
{
  return this->MayEdit({ u, v }) && EdgeCollapse{ u, v }.IsLegal(this->State.Mesh)
    ? this->CollapseInto(u, v, position, tolerance)
    : Edit();
}

bool SurfaceEditor::StaysSmooth(
  int u, int v, const MeshTriangle& first, const MeshTriangle& second) const
{
  const SurfaceMesh& mesh = this->State.Mesh;
  const Vector oldA = FaceNormal(mesh, u, v, first.Vertex[0]);
  const Vector oldB = FaceNormal(mesh, v, u, second.Vertex[0]);
  const Vector newA(Normalized(AreaNormal(first)));
  const Vector newB(Normalized(AreaNormal(second)));
  const Vector mean = Normalized(oldA + oldB);
  constexpr float least = static_cast<float>(SmoothCosine);
  // Only the new pair must be smooth: normals of slivers are unreliable.
  return Dot(newA, newB) >= least && Dot(newA, mean) >= least && Dot(newB, mean) >= least;
}

Edit SurfaceEditor::Flip(int u, int v, EditTolerance tolerance)
{
  SurfaceState& s = this->State;
  const SurfaceMesh& mesh = s.Mesh;
  const EdgeFlip flip = EdgeFlip::Of(mesh, u, v);
  if (!this->MayEdit({ u }) || !flip.IsLegal(mesh))
  {
    return {};
  }
  const bool smooth = tolerance == EditTolerance::Smooth;
  const float squared = SquaredDistance(mesh.Position[flip.A], mesh.Position[flip.B]);
  const float longest = s.Sizing.LongestEdge(flip.A, flip.B);
  const float shortest = s.Sizing.ShortestEdge(flip.A, flip.B);
  if (smooth && (squared > longest * longest || squared < shortest * shortest))
  {
    return {};
  }
  const MeshTriangle first = TriangleOf(mesh, flip.A, u, flip.B);
  const MeshTriangle second = TriangleOf(mesh, flip.B, v, flip.A);
  if (!IsWellShaped(first) || !IsWellShaped(second) ||
    (smooth && !this->StaysSmooth(u, v, first, second)))
  {
    return {};
  }
  this->Faces.assign({ first, second });
  if (NewFacesIntersect(s, this->Faces, { { u, v }, 2, true }))
  {
    return {};
  }
  const std::size_t firstChange = this->Log.size();
  flip.Apply(s.Mesh);
  ++this->Counts().Flips;
  for (int w : { u, v, flip.A, flip.B })
  {
    this->Log.push_back(w);
    if (!smooth) // A smooth flip hardly changes the surface.
    {
      s.Activate(w);
    }
  }
  return this->Done(firstChange);
}

Edit SurfaceEditor::Remove(int v)
{
  SurfaceState& s = this->State;
  const VertexRemoval removal{ v };
  if (!this->MayEdit({ v }) || !removal.IsLegal(s.Mesh))
  {
    return {};
  }
  const Ring ring = s.Mesh.Rings[v];
  this->Faces.assign({ TriangleOf(s.Mesh, ring.Item[0], ring.Item[1], ring.Item[2]) });
  if (!IsWellShaped(this->Faces[0]) || NewFacesIntersect(s, this->Faces, { { v }, 1, false }))
  {
    return {};
  }
  const std::size_t first = this->Log.size();
  s.RemoveVertex(v);
  removal.Apply(s.Mesh, this->Slots());
  ++this->Counts().Collapses;
  for (int i = 0; i < 3; ++i)
  {
    this->MarkChanged(ring.Item[i]);
  }
  return this->Done(first);
}

Edit SurfaceEditor::Move(int v, const Vector& position, EditTolerance tolerance)
{
  SurfaceState& s = this->State;
  if (!this->MayEdit({ v }) || !s.Margin.Allows(s.Mesh.Position[v], position))
  {
    return {};
  }
  const Ring& ring = s.Mesh.Rings[v];
  this->Faces.clear();
  for (int i = 0; i < ring.Count; ++i)
  {
    const MeshTriangle old = TriangleOf(s.Mesh, v, ring.Item[i], ring.Next(i));
    MeshTriangle face = old;
    face.Corner[0] = VectorD(position);
    // An edge that is too long may stay so if it gets shorter.
    const Vector& end = s.Mesh.Position[ring.Item[i]];
    const float squared = SquaredDistance(position, end);
    const float longest = s.Sizing.LongestEdge(v, ring.Item[i]);
    if (!KeepsShape(old, face) ||
      (squared > longest * longest && squared > SquaredDistance(s.Mesh.Position[v], end)) ||
      (tolerance == EditTolerance::Smooth && !TurnsLittle(old, face, LeastCosine(tolerance))))
    {
      return {};
    }
    this->Faces.push_back(face);
  }
  if (NewFacesIntersect(s, this->Faces, { { v }, 1, false }))
  {
    return {};
  }
  const std::size_t first = this->Log.size();
  s.MoveTo(v, position);
  this->MarkStarChanged(v);
  return this->Done(first);
}
}
