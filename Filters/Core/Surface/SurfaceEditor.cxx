// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/SurfaceEditor.h"

#include "Core/Mesh/CycleCut.h"
#include "Core/Mesh/EdgeCollapse.h"
#include "Core/Mesh/EdgeFlip.h"
#include "Core/Mesh/EdgeSplit.h"
#include "Core/Mesh/StarMerge.h"
#include "Core/Mesh/VertexRemoval.h"

#include <algorithm>

namespace volumic
{
namespace
{
VectorD AreaNormal(const MeshTriangle& t)
{
  return Cross(t.Corner[1] - t.Corner[0], t.Corner[2] - t.Corner[0]);
}

/** Smallest height of a new face, relative to its longest edge. */
constexpr double LeastAspect = 0.06;

/** Height over longest edge: 0 for a sliver, .87 for an even triangle. */
double Aspect(const MeshTriangle& t)
{
  const double longest = std::max({ SquaredDistance(t.Corner[0], t.Corner[1]),
    SquaredDistance(t.Corner[1], t.Corner[2]), SquaredDistance(t.Corner[2], t.Corner[0]) });
  return longest > 0 ? Length(AreaNormal(t)) / longest : 0.;
}

/** Longest rung of a merge's band, in delta. */
constexpr float LongestRung = 4.f;

bool IsSound(const MeshTriangle& t)
{
  return Aspect(t) > LeastAspect;
}

Vector FaceNormal(const SurfaceMesh& mesh, int a, int b, int c)
{
  return Normalized(
    Cross(mesh.Position[b] - mesh.Position[a], mesh.Position[c] - mesh.Position[a]));
}
}

bool SurfaceEditor::NearAnything(int u) const
{
  const Ring& ring = this->State.Mesh.Rings[u];
  bool near = this->State.Near[u];
  for (int i = 0; i < ring.Count && !near; ++i)
  {
    near = this->State.Near[ring.Item[i]];
  }
  return near;
}

int SurfaceEditor::Split(int u, int v)
{
  SurfaceState& s = this->State;
  const EdgeSplit split{ u, v };
  if (!split.IsLegal(s.Mesh))
  {
    return -1;
  }
  const int m = split.Apply(s.Mesh, (s.Mesh.Position[u] + s.Mesh.Position[v]) * 0.5f);
  s.Adopt(m, u);
  s.Velocity[m] = (s.Velocity[u] + s.Velocity[v]) * 0.5f;
  s.Before[m] = (s.Before[u] + s.Before[v]) * 0.5f;
  s.Near[m] = s.Near[u] | s.Near[v];
  s.Value[m] = 0.5f * (s.Value[u] + s.Value[v]);
  ++s.Counts.Splits;
  s.Touch(m);
  for (int i = 0; i < 4; ++i)
  {
    s.Touch(s.Mesh.Rings[m].Item[i]);
  }
  return m;
}

bool SurfaceEditor::CollapseInto(int kept, int removed, const Vector& position, Care care)
{
  SurfaceState& s = this->State;
  const SurfaceMesh& mesh = s.Mesh;
  const float longest = constraint::LongestEdge * s.Delta;
  const double leastCosine = care == Care::Smooth ? 0.7 : 0.1;
  this->Faces.clear();
  for (int end : { kept, removed })
  {
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
      if (SquaredDistance(position, mesh.Position[b]) > longest * longest)
      {
        return false;
      }
      const MeshTriangle face = { { kept, b, c },
        { VectorD(position), VectorD(mesh.Position[b]), VectorD(mesh.Position[c]) } };
      // The normal of a sliver says nothing, and any better shape is welcome there.
      MeshTriangle old = face;
      old.Corner[0] = VectorD(mesh.Position[end]);
      const double before = Aspect(old);
      const VectorD normal = AreaNormal(face);
      const VectorD oldNormal = AreaNormal(old);
      if (Aspect(face) < std::min(LeastAspect, 1.01 * before) ||
        (before > LeastAspect &&
          Dot(normal, oldNormal) < leastCosine * Length(normal) * Length(oldNormal)))
      {
        return false;
      }
      this->Faces.push_back(face);
    }
  }
  if ((care == Care::Rough || this->NearAnything(kept) || this->NearAnything(removed)) &&
    NewFacesMeet(s, this->Faces, { { kept, removed }, 2, false }))
  {
    return false;
  }
  s.Forget(removed);
  EdgeCollapse{ kept, removed }.Apply(s.Mesh);
  s.Velocity[kept] = (s.Velocity[kept] + s.Velocity[removed]) * 0.5f;
  s.Near[kept] |= s.Near[removed];
  s.MoveTo(kept, position);
  ++s.Counts.Collapses;
  s.Touch(kept);
  const Ring& ring = mesh.Rings[kept];
  for (int i = 0; i < ring.Count; ++i)
  {
    s.Touch(ring.Item[i]);
  }
  return true;
}

bool SurfaceEditor::Collapse(int u, int v, Care care)
{
  const SurfaceMesh& mesh = this->State.Mesh;
  if (!EdgeCollapse{ u, v }.IsLegal(mesh))
  {
    return false;
  }
  const Vector pu = mesh.Position[u];
  const Vector pv = mesh.Position[v];
  return this->CollapseInto(u, v, (pu + pv) * 0.5f, care) ||
    this->CollapseInto(u, v, pu, care) || this->CollapseInto(u, v, pv, care);
}

bool SurfaceEditor::CollapseTo(int u, int v, const Vector& position, Care care)
{
  return EdgeCollapse{ u, v }.IsLegal(this->State.Mesh) &&
    this->CollapseInto(u, v, position, care);
}

bool SurfaceEditor::FlipForShape(int u, int v)
{
  SurfaceState& s = this->State;
  const SurfaceMesh& mesh = s.Mesh;
  const EdgeFlip flip = EdgeFlip::Of(mesh, u, v);
  if (!flip.IsLegal(mesh))
  {
    return false;
  }
  const float squared = SquaredDistance(mesh.Position[flip.A], mesh.Position[flip.B]);
  const float longest = constraint::LongestEdge * s.Delta;
  if (squared > longest * longest || squared < s.Delta * s.Delta)
  {
    return false;
  }
  const Vector oldA = FaceNormal(mesh, u, v, flip.A);
  const Vector oldB = FaceNormal(mesh, v, u, flip.B);
  const MeshTriangle first = TriangleOf(mesh, flip.A, u, flip.B);
  const MeshTriangle second = TriangleOf(mesh, flip.B, v, flip.A);
  if (!IsSound(first) || !IsSound(second))
  {
    return false;
  }
  const Vector newA(Normalized(AreaNormal(first)));
  const Vector newB(Normalized(AreaNormal(second)));
  const Vector mean = Normalized(oldA + oldB);
  // Slivers have normals that say little; what counts is that the new pair is smooth.
  if (Dot(newA, newB) < 0.7f || Dot(newA, mean) < 0.7f || Dot(newB, mean) < 0.7f)
  {
    return false;
  }
  if (s.Near[u] || s.Near[v] || s.Near[flip.A] || s.Near[flip.B])
  {
    this->Faces.assign({ first, second });
    if (NewFacesMeet(s, this->Faces, { { u, v }, 2, true }))
    {
      return false;
    }
  }
  flip.Apply(s.Mesh);
  ++s.Counts.Flips;
  for (int w : { u, v, flip.A, flip.B })
  {
    s.Touched.push_back(w); // Nothing has moved: no reason to wake anyone.
  }
  return true;
}

bool SurfaceEditor::FlipForConstraint(int u, int v)
{
  SurfaceState& s = this->State;
  const SurfaceMesh& mesh = s.Mesh;
  const EdgeFlip flip = EdgeFlip::Of(mesh, u, v);
  if (!flip.IsLegal(mesh))
  {
    return false;
  }
  const MeshTriangle first = TriangleOf(mesh, flip.A, u, flip.B);
  const MeshTriangle second = TriangleOf(mesh, flip.B, v, flip.A);
  if (!IsSound(first) || !IsSound(second))
  {
    return false;
  }
  this->Faces.assign({ first, second });
  if (NewFacesMeet(s, this->Faces, { { u, v }, 2, true }))
  {
    return false;
  }
  flip.Apply(s.Mesh);
  ++s.Counts.Flips;
  for (int w : { u, v, flip.A, flip.B })
  {
    s.Touch(w);
  }
  return true;
}

bool SurfaceEditor::Remove(int v)
{
  SurfaceState& s = this->State;
  const VertexRemoval removal{ v };
  if (!removal.IsLegal(s.Mesh))
  {
    return false;
  }
  const Ring ring = s.Mesh.Rings[v];
  this->Faces.assign({ TriangleOf(s.Mesh, ring.Item[0], ring.Item[1], ring.Item[2]) });
  if (!IsSound(this->Faces[0]) ||
    (this->NearAnything(v) && NewFacesMeet(s, this->Faces, { { v }, 1, false })))
  {
    return false;
  }
  s.Forget(v);
  removal.Apply(s.Mesh);
  ++s.Counts.Collapses;
  for (int i = 0; i < 3; ++i)
  {
    s.Touch(ring.Item[i]);
  }
  return true;
}

bool SurfaceEditor::Move(int v, const Vector& position, Care care)
{
  SurfaceState& s = this->State;
  if (!s.Around.Allows(s.Mesh.Position[v], position))
  {
    return false;
  }
  const Ring& ring = s.Mesh.Rings[v];
  const float longest = constraint::LongestEdge * s.Delta;
  this->Faces.clear();
  for (int i = 0; i < ring.Count; ++i)
  {
    const MeshTriangle old = TriangleOf(s.Mesh, v, ring.Item[i], ring.Next(i));
    MeshTriangle face = old;
    face.Corner[0] = VectorD(position);
    // What is bad already may stay so if it gets better.
    const Vector& end = s.Mesh.Position[ring.Item[i]];
    const float squared = SquaredDistance(position, end);
    if (Aspect(face) < std::min(LeastAspect, 1.01 * Aspect(old)) ||
      (squared > longest * longest && squared > SquaredDistance(s.Mesh.Position[v], end)))
    {
      return false;
    }
    if (care == Care::Smooth && Aspect(old) > LeastAspect)
    {
      const VectorD normal = AreaNormal(face);
      const VectorD oldNormal = AreaNormal(old);
      if (Dot(normal, oldNormal) < 0.7 * Length(normal) * Length(oldNormal))
      {
        return false;
      }
    }
    this->Faces.push_back(face);
  }
  if ((care == Care::Rough || this->NearAnything(v)) &&
    NewFacesMeet(s, this->Faces, { { v }, 1, false }))
  {
    return false;
  }
  s.MoveTo(v, position);
  s.Touch(v);
  for (int i = 0; i < ring.Count; ++i)
  {
    s.Touch(ring.Item[i]);
  }
  return true;
}

bool SurfaceEditor::Merge(int u, int v)
{
  SurfaceState& s = this->State;
  StarMerge merge;
  merge.U = u;
  merge.V = v;
  // Between sharp rims rungs are long; the remesher splits them at once.
  const float longest = LongestRung * s.Delta;
  if (!merge.Plan(s.Mesh) || merge.SquaredLongestBridgeEdge() > longest * longest)
  {
    return false;
  }
  this->Faces.clear();
  for (const auto& t : merge.Strip())
  {
    this->Faces.push_back(TriangleOf(s.Mesh, t[0], t[1], t[2]));
    if (!IsSound(this->Faces.back()))
    {
      return false;
    }
  }
  if (NewFacesMeet(s, this->Faces, { { u, v }, 2, false }))
  {
    return false;
  }
  s.Forget(u);
  s.Forget(v);
  merge.Apply(s.Mesh);
  s.EulerCharacteristic -= 2;
  ++s.Counts.Merges;
  for (const auto& t : merge.Strip())
  {
    for (int w : t)
    {
      s.Touch(w);
      s.Near[w] = 1;
    }
  }
  return true;
}

bool SurfaceEditor::Cut(int u, int v, int w)
{
  SurfaceState& s = this->State;
  SurfaceMesh& mesh = s.Mesh;
  const CycleCut cut{ u, v, w };
  if (!cut.IsLegal(mesh))
  {
    return false;
  }
  // All that the cut writes to, to be able to take it back.
  std::vector<std::pair<int, Ring>> saved;
  const int corner[3] = { u, v, w };
  Vector place[3];
  for (int k = 0; k < 3; ++k)
  {
    place[k] = mesh.Position[corner[k]];
    saved.emplace_back(corner[k], mesh.Rings[corner[k]]);
    for (int i = 0; i < mesh.Rings[corner[k]].Count; ++i)
    {
      const int x = mesh.Rings[corner[k]].Item[i];
      saved.emplace_back(x, mesh.Rings[x]);
    }
  }
  const std::array<int, 3> copy = cut.Apply(mesh);
  const int all[6] = { u, v, w, copy[0], copy[1], copy[2] };
  for (int k = 0; k < 3; ++k)
  {
    s.Adopt(copy[k], corner[k]);
    s.Near[copy[k]] = s.Near[corner[k]] = 1;
  }
  // Each copy goes a little towards the rest of its own star.
  for (int side = 0; side < 2; ++side)
  {
    for (int k = 0; k < 3; ++k)
    {
      const int x = all[side * 3 + k];
      const Ring& ring = mesh.Rings[x];
      Vector sum;
      int count = 0;
      for (int i = 0; i < ring.Count; ++i)
      {
        const int y = ring.Item[i];
        if (y != all[side * 3] && y != all[side * 3 + 1] && y != all[side * 3 + 2])
        {
          sum += mesh.Position[y];
          ++count;
        }
      }
      const Vector mean = sum * (1.f / static_cast<float>(std::max(count, 1)));
      s.MoveTo(x, place[k] + (mean - place[k]) * 0.25f);
    }
  }
  this->Faces.clear();
  for (int side = 0; side < 2; ++side)
  {
    for (int k = 0; k < 3; ++k)
    {
      const int x = all[side * 3 + k];
      const Ring& ring = mesh.Rings[x];
      for (int i = 0; i < ring.Count; ++i)
      {
        const int b = ring.Item[i];
        const int c = ring.Next(i);
        // A face with several corners of the side is taken from the first of them only.
        const auto earlier = [&](int y)
        { return std::find(all + side * 3, all + side * 3 + k, y) != all + side * 3 + k; };
        if (!earlier(b) && !earlier(c))
        {
          this->Faces.push_back(TriangleOf(mesh, x, b, c));
        }
      }
    }
  }
  bool sound = true;
  for (const MeshTriangle& face : this->Faces)
  {
    sound = sound && IsSound(face);
  }
  const GoneFaces gone = { { all[0], all[1], all[2], all[3], all[4], all[5] }, 6, false };
  sound = sound && !NewFacesMeet(s, this->Faces, gone);
  if (!sound)
  {
    for (int k = 0; k < 3; ++k)
    {
      s.Forget(copy[k]);
      mesh.RemoveVertex(copy[k]);
    }
    for (const auto& entry : saved)
    {
      mesh.Rings[entry.first] = entry.second;
    }
    for (int k = 0; k < 3; ++k)
    {
      s.MoveTo(corner[k], place[k]);
    }
    return false;
  }
  s.EulerCharacteristic += 2;
  ++s.Counts.Cuts;
  for (int x : all)
  {
    s.Touch(x);
    for (int i = 0; i < mesh.Rings[x].Count; ++i)
    {
      s.Touch(mesh.Rings[x].Item[i]);
    }
  }
  return true;
}
}
