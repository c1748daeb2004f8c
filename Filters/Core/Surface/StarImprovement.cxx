// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/StarImprovement.h"

#include "Core/Mesh/EdgeCollapse.h"
#include "Core/Surface/StarScore.h"

#include <algorithm>
#include <cmath>

namespace volumic
{
namespace
{
/** Longest edge of a bad star that may be collapsed although it is legal, in delta. */
constexpr float ShortEdge = 1.5f;
/** Least gain of an edit, so that the next one does not undo it. */
constexpr float Gain = 0.01f;
/** Additional distance from the isosurface, in delta, that a slide may cause. */
constexpr float OffIsosurface = 0.02f;
/** Longest step onto the isosurface, in delta. */
constexpr float LongestSnap = 0.15f;
/** Longest step that separates two vertices, in delta. */
constexpr float LongestPush = 0.25f;
/** Least push that is applied, in ScoreMargin delta. */
constexpr float LeastPush = 1e-3f;
}

Vector StarImprovement::Snapped(int v, const Vector& position) const
{
  if (!this->SnapTo)
  {
    return position;
  }
  const Vector n = this->State.Normal[v].Axis();
  const float longest = LongestSnap * this->State.Sizing.At(v);
  return position + n * this->SnapTo->StepToIso(this->SnapTo->At(position), n, longest);
}

bool StarImprovement::LeavesIsosurface(int v, const Vector& position) const
{
  if (!this->SnapTo)
  {
    return false;
  }
  const float old = std::abs(this->SnapTo->ValueAt(this->State.Mesh.Position[v]));
  const Field::Sample sample = this->SnapTo->At(position);
  return std::abs(sample.Value) >
    old + OffIsosurface * this->State.Sizing.At(v) * this->SnapTo->SlopeOf(sample);
}

bool StarImprovement::CollapseEdge(int u, int v, float before)
{
  SurfaceState& s = this->State;
  const SurfaceMesh& mesh = s.Mesh;
  const EdgeCollapse collapse{ u, v };
  if (!collapse.IsLegal(mesh))
  {
    const int c = this->MayCut && before < 0 ? collapse.ThirdCommonNeighbour(mesh) : -1;
    return c >= 0 && this->Editor.Cut(u, v, c).IsDone;
  }
  // Try positions on the edge, and between it and the mean of the new link.
  const Vector p = mesh.Position[u];
  const Vector q = mesh.Position[v];
  Vector sum;
  int count = 0;
  for (int end : { u, v })
  {
    const Ring& ring = mesh.Rings[end];
    for (int i = 0; i < ring.Count; ++i)
    {
      if (ring.Item[i] != u && ring.Item[i] != v)
      {
        sum += mesh.Position[ring.Item[i]];
        ++count;
      }
    }
  }
  const Vector middle = sum * (1.f / static_cast<float>(count));
  this->Candidates.clear();
  for (float along : { 0.5f, 0.f, 1.f, 0.25f, 0.75f })
  {
    for (float inward : { 0.f, 0.5f, 1.f })
    {
      const Vector x = p + (q - p) * along;
      const Vector target = this->Snapped(u, x + (middle - x) * inward);
      const float score = CollapseScore(this->State, u, v, target, before + Gain);
      if (score > before + Gain)
      {
        this->Candidates.push_back({ score, target });
      }
    }
  }
  std::stable_sort(this->Candidates.begin(), this->Candidates.end(),
    [](const Candidate& a, const Candidate& b) { return a.Score > b.Score; });
  for (const Candidate& candidate : this->Candidates)
  {
    if (this->Editor.CollapseTo(u, v, candidate.Position, EditTolerance::Loose))
    {
      return true;
    }
  }
  return false;
}

bool StarImprovement::CollapseEdges(int v)
{
  const SurfaceMesh& mesh = this->State.Mesh;
  const Ring ring = mesh.Rings[v];
  const float star = StarScore(this->State, v, mesh.Position[v]);
  const float factor = star < BadStar ? ShortEdge : 1 + ScoreMargin;
  for (int i = 0; i < ring.Count; ++i)
  {
    const int w = ring.Item[i];
    const float longest = factor * this->State.Sizing.ShortestEdge(v, w);
    if (SquaredDistance(mesh.Position[v], mesh.Position[w]) >= longest * longest)
    {
      continue;
    }
    for (int opposite : { ring.Next(i), ring.Previous(i) })
    {
      if (mesh.Rings[opposite].Count == 3 && this->Editor.Remove(opposite))
      {
        return true;
      }
    }
    if (this->CollapseEdge(v, w, std::min(star, StarScore(this->State, w, mesh.Position[w]))))
    {
      return true;
    }
  }
  return false;
}

bool StarImprovement::FlipEdges(int v)
{
  const SizingField& sizing = this->State.Sizing;
  const SurfaceMesh& mesh = this->State.Mesh;
  const Ring ring = mesh.Rings[v];
  const Vector& p = mesh.Position[v];
  for (int i = 0; i < ring.Count; ++i)
  {
    const int w = ring.Item[i];
    const Vector& q = mesh.Position[w];
    const Vector& a = mesh.Position[ring.Next(i)];
    const Vector& b = mesh.Position[ring.Previous(i)];
    const float before = std::min(
      { EdgeScore(sizing, v, w, SquaredDistance(p, q)), FaceScore(p, q, a), FaceScore(q, p, b) });
    const float after =
      std::min({ EdgeScore(sizing, ring.Next(i), ring.Previous(i), SquaredDistance(a, b)),
        FaceScore(a, p, b), FaceScore(b, q, a) });
    if (before < GoodStar && after > before + Gain &&
      this->Editor.Flip(v, w, EditTolerance::Smooth))
    {
      return true;
    }
  }
  return false;
}

bool StarImprovement::Slide(int v)
{
  SurfaceState& s = this->State;
  s.UpdateShape(v);
  const Vector p = s.Mesh.Position[v];
  const float before = StarScore(this->State, v, p);
  const bool bad = before < BadStar;
  const Vector n = s.Normal[v].Axis();
  const Vector across = std::abs(n.X) < 0.6f ? Vector(1, 0, 0) : Vector(0, 1, 0);
  const Vector first = Normalized(Cross(n, across));
  const Vector second = Cross(n, first);
  this->Candidates.clear();
  for (float step : { 0.4f, 0.2f, 0.1f, 0.05f })
  {
    Candidate best{ before + Gain, p };
    for (int k = 0; k < 8; ++k)
    {
      static const float cosine[8] = { 1, 0.70710678f, 0, -0.70710678f, -1, -0.70710678f, 0,
        0.70710678f };
      const Vector slide = first * cosine[k] + second * cosine[(k + 6) % 8];
      // A bad star in a crease has no tangent plane.
      for (int lift = bad ? -1 : 0; lift <= (bad ? 1 : 0); ++lift)
      {
        const Vector x = p + (slide + n * static_cast<float>(lift)) * (step * s.Sizing.At(v));
        const float score = StarScore(this->State, v, x, best.Score);
        if (score > best.Score)
        {
          best = { score, x };
        }
      }
    }
    if (best.Score > before + Gain)
    {
      this->Candidates.push_back(best);
    }
  }
  std::stable_sort(this->Candidates.begin(), this->Candidates.end(),
    [](const Candidate& a, const Candidate& b) { return a.Score > b.Score; });
  for (const Candidate& candidate : this->Candidates)
  {
    const Vector target = bad ? candidate.Position : this->Snapped(v, candidate.Position);
    if (StarScore(this->State, v, target, before + Gain) > before + Gain &&
      (bad || !(this->LeavesIsosurface(v, target) || this->Approaches(v, target))) &&
      this->Editor.Move(v, target, EditTolerance::Smooth))
    {
      return true;
    }
  }
  return false;
}

bool StarImprovement::Improve(int v)
{
  const SurfaceMesh& mesh = this->State.Mesh;
  if (mesh.Rings[v].Count == 3 && this->Editor.Remove(v))
  {
    return true;
  }
  return this->CollapseEdges(v) || this->FlipEdges(v) || this->Slide(v);
}

bool StarImprovement::Approaches(int v, const Vector& position) const
{
  const SurfaceState& s = this->State;
  if (!s.NearOthers[v])
  {
    return false;
  }
  const float near = s.Sizing.LargestClearance(v);
  bool approaches = false;
  s.Grid.Visit(position, near,
    [&](int w)
    {
      const float squared = SquaredDistance(position, s.Mesh.Position[w]);
      approaches = approaches ||
        (w != v && squared < near * near &&
          squared < SquaredDistance(s.Mesh.Position[v], s.Mesh.Position[w]) &&
          s.Mesh.AreFarApart(v, w));
    });
  return approaches;
}

Vector PushAt(const SurfaceState& s, int v)
{
  const float near = s.Sizing.LargestClearance(v, 1 + ScoreMargin);
  const Vector p = s.Mesh.Position[v];
  Vector push;
  s.Grid.Visit(p, near,
    [&](int w)
    {
      const float squared = SquaredDistance(p, s.Mesh.Position[w]);
      if (w != v && squared < near * near && squared > 0 && s.Mesh.AreFarApart(v, w))
      {
        const float distance = std::sqrt(squared);
        push += (p - s.Mesh.Position[w]) * (0.5f * (near - distance) / distance);
      }
    });
  return push;
}

bool StarImprovement::Separate(int v)
{
  SurfaceState& s = this->State;
  const Vector p = s.Mesh.Position[v];
  Vector push = PushAt(s, v);
  const float length = Length(push);
  if (length <= LeastPush * ScoreMargin * s.Sizing.At(v))
  {
    return false;
  }
  push *= std::min(1.f, LongestPush * s.Sizing.At(v) / length);
  const float least = std::min(StarScore(this->State, v, p), BadStar);
  for (float factor : { 1.f, 0.4f })
  {
    const Vector target = p + push * factor;
    if (StarScore(this->State, v, target) >= least &&
      this->Editor.Move(v, target, EditTolerance::Smooth))
    {
      return true;
    }
  }
  return false;
}
}
