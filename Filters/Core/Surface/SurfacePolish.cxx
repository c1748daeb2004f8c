// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/SurfacePolish.h"

#include "Core/Mesh/EdgeCollapse.h"

#include <algorithm>
#include <cmath>

namespace volumic
{
namespace
{
/** Stars whose worst triangle has this radius ratio are left as they are. */
constexpr float Good = 0.82f;
/** Triangles worse than this are worth an edge that is short, though legal. */
constexpr float Bad = 0.55f;
/** What an edit must gain, so that none is undone by the next. */
constexpr float Gain = 0.01f;
/** Lengths keep this share from their bounds, for the rounding of the map to the world. */
constexpr float Margin = 1e-4f;
constexpr int Rounds = 8;
constexpr int SeparatingRounds = 4;
/** Stars between two looks whether to go on: about ten milliseconds where all need an edit. */
constexpr std::size_t StarsAtATime = 512;
/** Way off the isopotential, in delta, that a slide may add. */
constexpr float Stray = 0.02f;
}

float SurfacePolish::FaceScore(const Vector& a, const Vector& b, const Vector& c) const
{
  // Twice the radius of the inscribed circle over that of the circumscribed.
  const float x = std::sqrt(SquaredDistance(a, b));
  const float y = std::sqrt(SquaredDistance(b, c));
  const float z = std::sqrt(SquaredDistance(c, a));
  const float product = x * y * z;
  return product > 0 ? (y + z - x) * (z + x - y) * (x + y - z) / product : -1.f;
}

float SurfacePolish::EdgeScore(float squared) const
{
  // Worse than any triangle where the length is not legal.
  const float length = std::sqrt(squared) / this->State.Delta;
  if (length < 1 + Margin)
  {
    return length - 1 - Margin;
  }
  const float over = length / (constraint::LongestEdge * (1 - Margin)) - 1;
  return over > 0 ? -over : 1.f;
}

float SurfacePolish::StarScore(int v, const Vector& position) const
{
  const SurfaceMesh& mesh = this->State.Mesh;
  const Ring& ring = mesh.Rings[v];
  float worst = 1;
  for (int i = 0; i < ring.Count; ++i)
  {
    const Vector& a = mesh.Position[ring.Item[i]];
    worst = std::min(worst, this->EdgeScore(SquaredDistance(position, a)));
    worst = std::min(worst, this->FaceScore(position, a, mesh.Position[ring.Next(i)]));
  }
  return worst;
}

float SurfacePolish::CollapseScore(int u, int v, const Vector& position) const
{
  const SurfaceMesh& mesh = this->State.Mesh;
  float worst = 1;
  for (int end : { u, v })
  {
    const int other = end == u ? v : u;
    const Ring& ring = mesh.Rings[end];
    for (int i = 0; i < ring.Count; ++i)
    {
      const int b = ring.Item[i];
      const int c = ring.Next(i);
      if (b == other)
      {
        continue;
      }
      worst = std::min(worst, this->EdgeScore(SquaredDistance(position, mesh.Position[b])));
      if (c != other)
      {
        worst =
          std::min(worst, this->FaceScore(position, mesh.Position[b], mesh.Position[c]));
      }
    }
  }
  return worst;
}

Vector SurfacePolish::Snapped(int v, const Vector& position) const
{
  if (!this->SnapTo)
  {
    return position;
  }
  const Vector& n = this->State.Normal[v];
  const Field::Sample sample = this->SnapTo->At(position);
  const float slope = -Dot(sample.Gradient, n);
  if (slope <= 0.15f * this->SnapTo->TypicalSlope() || slope < 0.5f * Length(sample.Gradient))
  {
    return position;
  }
  const float longest = 0.15f * this->State.Delta;
  const float step = std::min(std::max(sample.Value / slope, -longest), longest);
  return Vector(
    position.X + step * n.X, position.Y + step * n.Y, position.Z + step * n.Z);
}

bool SurfacePolish::Strays(int v, const Vector& position) const
{
  if (!this->SnapTo)
  {
    return false;
  }
  const float old = std::abs(this->SnapTo->ValueAt(this->State.Mesh.Position[v]));
  const Field::Sample sample = this->SnapTo->At(position);
  const float slope = std::max(Length(sample.Gradient), 0.15f * this->SnapTo->TypicalSlope());
  return std::abs(sample.Value) > old + Stray * this->State.Delta * slope;
}

bool SurfacePolish::CollapseEdge(int u, int v, float before)
{
  SurfaceState& s = this->State;
  const SurfaceMesh& mesh = s.Mesh;
  const EdgeCollapse collapse{ u, v };
  if (!collapse.IsLegal(mesh))
  {
    const int c = this->MayCut && before < 0 ? collapse.ThirdCommonNeighbour(mesh) : -1;
    return c >= 0 && this->Editor.Cut(u, v, c);
  }
  // Along the edge, and between it and the middle of the new star.
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
      const Vector place = this->Snapped(u, x + (middle - x) * inward);
      const float score = this->CollapseScore(u, v, place);
      if (score > before + Gain)
      {
        this->Candidates.push_back({ score, place });
      }
    }
  }
  std::stable_sort(this->Candidates.begin(), this->Candidates.end(),
    [](const Candidate& a, const Candidate& b) { return a.Score > b.Score; });
  for (const Candidate& candidate : this->Candidates)
  {
    if (this->Editor.CollapseTo(u, v, candidate.Position, SurfaceEditor::Care::Rough))
    {
      return true;
    }
  }
  return false;
}

bool SurfacePolish::CollapseEdges(int v)
{
  const SurfaceMesh& mesh = this->State.Mesh;
  const float delta = this->State.Delta;
  const Ring ring = mesh.Rings[v];
  const float star = this->StarScore(v, mesh.Position[v]);
  const float longest = star < Bad ? 1.5f * delta : (1 + Margin) * delta;
  for (int i = 0; i < ring.Count; ++i)
  {
    const int w = ring.Item[i];
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
    if (this->CollapseEdge(
          v, w, std::min(star, this->StarScore(w, mesh.Position[w]))))
    {
      return true;
    }
  }
  return false;
}

bool SurfacePolish::FlipEdges(int v)
{
  const SurfaceMesh& mesh = this->State.Mesh;
  const Ring ring = mesh.Rings[v];
  const Vector& p = mesh.Position[v];
  for (int i = 0; i < ring.Count; ++i)
  {
    const int w = ring.Item[i];
    const Vector& q = mesh.Position[w];
    const Vector& a = mesh.Position[ring.Next(i)];
    const Vector& b = mesh.Position[ring.Previous(i)];
    const float before = std::min({ this->EdgeScore(SquaredDistance(p, q)),
      this->FaceScore(p, q, a), this->FaceScore(q, p, b) });
    const float after = std::min({ this->EdgeScore(SquaredDistance(a, b)),
      this->FaceScore(a, p, b), this->FaceScore(b, q, a) });
    if (before < Good && after > before + Gain && this->Editor.FlipForShape(v, w))
    {
      return true;
    }
  }
  return false;
}

bool SurfacePolish::Slide(int v)
{
  SurfaceState& s = this->State;
  s.UpdateShape(v);
  const Vector p = s.Mesh.Position[v];
  const float before = this->StarScore(v, p);
  const bool bad = before < Bad;
  Vector n = s.Normal[v];
  n.Unused = 0;
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
      // A bad star in a crease has no plane to slide in.
      for (int lift = bad ? -1 : 0; lift <= (bad ? 1 : 0); ++lift)
      {
        const Vector x = p + (slide + n * static_cast<float>(lift)) * (step * s.Delta);
        const float score = this->StarScore(v, x);
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
    const Vector place = bad ? candidate.Position : this->Snapped(v, candidate.Position);
    if (this->StarScore(v, place) > before + Gain &&
      (bad || !(this->Strays(v, place) || this->Approaches(v, place))) &&
      this->Editor.Move(v, place, SurfaceEditor::Care::Smooth))
    {
      return true;
    }
  }
  return false;
}

bool SurfacePolish::Improve(int v)
{
  const SurfaceMesh& mesh = this->State.Mesh;
  if (mesh.Rings[v].Count == 3 && this->Editor.Remove(v))
  {
    return true;
  }
  return this->CollapseEdges(v) || this->FlipEdges(v) || this->Slide(v);
}

bool SurfacePolish::Approaches(int v, const Vector& position) const
{
  const SurfaceState& s = this->State;
  if (!s.Near[v])
  {
    return false;
  }
  const float near = constraint::NearestOthers * s.Delta;
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

Vector SurfacePolish::PushAt(int v) const
{
  const SurfaceState& s = this->State;
  const float near = (1 + Margin) * constraint::NearestOthers * s.Delta;
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
  push.Unused = 0;
  return push;
}

bool SurfacePolish::Separate(int v)
{
  SurfaceState& s = this->State;
  const Vector p = s.Mesh.Position[v];
  Vector push = this->PushAt(v);
  const float length = Length(push);
  if (length <= 1e-3f * Margin * s.Delta)
  {
    return false;
  }
  push *= std::min(1.f, 0.25f * s.Delta / length);
  const float least = std::min(this->StarScore(v, p), Bad);
  for (float share : { 1.f, 0.4f })
  {
    const Vector place = p + push * share;
    if (this->StarScore(v, place) >= least &&
      this->Editor.Move(v, place, SurfaceEditor::Care::Smooth))
    {
      return true;
    }
  }
  return false;
}

void SurfacePolish::SeparateAll()
{
  if (this->Stopped)
  {
    return;
  }
  SurfaceState& s = this->State;
  std::vector<int> crowded;
  for (int v = 0; v < s.Mesh.Size(); ++v)
  {
    if (s.Mesh.IsAlive(v) && s.Near[v])
    {
      crowded.push_back(v);
    }
  }
  for (int round = 0; round < SeparatingRounds; ++round)
  {
    this->Scores.assign(crowded.size(), 0.f);
    this->Threads.For(crowded.size(), 256,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t i = begin; i < end; ++i)
        {
          this->Scores[i] = SquaredLength(this->PushAt(crowded[i]));
        }
      });
    for (std::size_t i = 0; i < crowded.size(); ++i)
    {
      if (i % StarsAtATime == 0 && this->IsToStop())
      {
        return;
      }
      if (this->Scores[i] > 0)
      {
        this->Separate(crowded[i]);
      }
    }
  }
}

void SurfacePolish::ImproveAll(float good)
{
  if (this->Stopped)
  {
    return;
  }
  SurfaceState& s = this->State;
  std::vector<int> list;
  for (int v = 0; v < s.Mesh.Size(); ++v)
  {
    if (s.Mesh.IsAlive(v))
    {
      list.push_back(v);
    }
  }
  std::vector<int> left;
  for (int round = 0; round < Rounds && !list.empty(); ++round)
  {
    const std::size_t edited = s.Touched.size();
    left.clear();
    const auto score = [&s, this](int v)
    { return s.Mesh.IsAlive(v) ? this->StarScore(v, s.Mesh.Position[v]) : 1.f; };
    this->Scores.resize(list.size());
    this->Threads.For(list.size(), 1024,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t i = begin; i < end; ++i)
        {
          this->Scores[i] = score(list[i]);
        }
      });
    for (std::size_t i = 0; i < list.size(); ++i)
    {
      if (i % StarsAtATime == 0 && this->IsToStop())
      {
        return;
      }
      const int v = list[i];
      // An edit beside it may have changed what was found.
      const float now = this->Scores[i] < good ? score(v) : 1.f;
      if (now < good && !this->Improve(v) && now < Bad)
      {
        left.push_back(v); // What is edited next to it may help.
      }
    }
    left.insert(
      left.end(), s.Touched.begin() + static_cast<std::ptrdiff_t>(edited), s.Touched.end());
    std::sort(left.begin(), left.end());
    left.erase(std::unique(left.begin(), left.end()), left.end());
    list.swap(left);
  }
}

bool SurfacePolish::IsToStop()
{
  this->Stopped = this->Stopped || !this->Goes(this->Done);
  return this->Stopped;
}

void SurfacePolish::Run()
{
  // A collapse may bring strangers together, and what is pushed apart may become uneven.
  this->SeparateAll();
  this->Done = 0.1;
  this->ImproveAll(Good);
  this->Done = 0.7;
  this->SeparateAll();
  this->Done = 0.8;
  // What could not be mended before may be now; if not, a cycle of three stands in the way.
  this->ImproveAll(Bad);
  const int cuts = this->State.Counts.Cuts;
  this->MayCut = this->TopologyChanges;
  this->Done = 0.9;
  this->ImproveAll(0.f);
  if (this->State.Counts.Cuts > cuts)
  {
    this->SeparateAll(); // The two sides of a cut are near each other.
    this->ImproveAll(Bad);
  }
}
}
