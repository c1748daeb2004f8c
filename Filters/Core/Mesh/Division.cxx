// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/Division.h"

#include "Core/Common/Spans.h"

#include <utility>

namespace volumic
{
namespace
{
/** Vertices, faces or edges that one thread looks at at a time. */
constexpr std::size_t SpanSize = 8192;
}

EdgeSlots::EdgeSlots(const SurfaceMesh& mesh, Executor& executor)
{
  MakeZeroed(this->First, mesh.Rings.size() + 1);
  const auto sumOf = [&mesh](std::size_t begin, std::size_t end)
  {
    std::size_t sum = 0;
    for (std::size_t v = begin; v < end; ++v)
    {
      sum += static_cast<std::size_t>(mesh.Rings[v].Count);
    }
    return sum;
  };
  const std::size_t n = mesh.Rings.size();
  const std::vector<std::size_t> before = FirstOfSpans(executor, n, SpanSize, sumOf);
  ForSpans(executor, n, SpanSize,
    [&](std::size_t span, std::size_t begin, std::size_t end)
    {
      std::size_t next = before[span];
      for (std::size_t v = begin; v < end; ++v)
      {
        next += static_cast<std::size_t>(mesh.Rings[v].Count);
        this->First[v + 1] = next;
      }
    });
}

KeptEdges::KeptEdges(const SurfaceMesh& mesh) : Mesh(mesh), Slots(mesh), Flags(Slots.Count(), 0) {}

void KeptEdges::Keep(int u, int v)
{
  this->Flags[this->Slots.At(u, this->Mesh.Rings[u].Find(v))] = 1;
  this->Flags[this->Slots.At(v, this->Mesh.Rings[v].Find(u))] = 1;
}

void KeptEdges::KeepAllAt(int v)
{
  for (int i = 0; i < this->Mesh.Rings[v].Count; ++i)
  {
    this->Keep(v, this->Mesh.Rings[v].Item[i]);
  }
}

void KeptEdges::MakeRoom()
{
  // Each run of kept edges adds a neighbour; with all of them kept there are as many as before.
  for (bool changed = true; changed;)
  {
    changed = false;
    for (int v = 0; v < this->Mesh.Size(); ++v)
    {
      const int count = this->Mesh.Rings[v].Count;
      if (count + count / 2 <= Ring::Capacity)
      {
        continue; // Runs have edges between them that are not kept.
      }
      int runs = 0;
      for (int i = 0; i < count; ++i)
      {
        runs += this->Has(v, i) && !this->HasAfter(v, i);
      }
      if (count + runs > Ring::Capacity)
      {
        this->KeepAllAt(v);
        changed = true;
      }
    }
  }
}

namespace
{
constexpr int None = -1;

void Append(Ring& ring, int vertex)
{
  if (vertex != None)
  {
    ring.Item[ring.Count++] = vertex;
  }
}

/** A division at work. Rings of old vertices are those before it until they are replaced. */
class SqrtThreeDivision
{
public:
  SqrtThreeDivision(SurfaceMesh& mesh, const KeptEdges* kept, Executor& executor)
    : Mesh(mesh), Kept(kept), Threads(executor), Olds(mesh.Rings.size()), Slots(mesh, executor),
      Middle(kept ? Slots.Count() : 0, None)
  {
    MakeZeroed(this->Centre, this->Slots.Count()); // All of them get one.
  }

  LargeVector<Triangle> Run()
  {
    this->AddCentres();
    this->AddMiddles();
    LengthenZeroed(this->Mesh.Rings, this->Mesh.Position.size());
    const auto forAll = [this](std::size_t n, void (SqrtThreeDivision::*join)(std::size_t))
    {
      ForSpans(this->Threads, n, SpanSize,
        [&](std::size_t, std::size_t begin, std::size_t end)
        {
          for (std::size_t i = begin; i < end; ++i)
          {
            (this->*join)(i);
          }
        });
    };
    forAll(this->Faces.size(), &SqrtThreeDivision::JoinCentre);
    forAll(this->HalvedEdges.size(), &SqrtThreeDivision::JoinMiddle);
    forAll(this->Olds, &SqrtThreeDivision::JoinOld);
    return std::move(this->Faces);
  }

private:
  std::size_t Slot(int v, int neighbour) const
  {
    return this->Slots.At(v, this->Mesh.Rings[v].Find(neighbour));
  }
  int MiddleAt(std::size_t slot) const { return this->Kept ? this->Middle[slot] : None; }
  /** Calls visit(v, place in its ring) for the kept edges whose smaller end is in a range. */
  template <typename Visit>
  void VisitKept(std::size_t begin, std::size_t end, Visit&& visit) const;

  void AddCentres();
  void AddMiddles();
  void JoinCentre(std::size_t face);
  void JoinMiddle(std::size_t edge);
  void JoinOld(std::size_t vertex);

  SurfaceMesh& Mesh;
  const KeptEdges* Kept;
  Executor& Threads;
  const std::size_t Olds;
  EdgeSlots Slots;
  LargeVector<int> Centre; ///< New vertex of the face (v, ring[i], ring[i + 1]).
  LargeVector<int> Middle; ///< New vertex of the edge; None: it is flipped. Empty: all are.
  LargeVector<Triangle> Faces;
  LargeVector<std::array<int, 2>> HalvedEdges;
};

void SqrtThreeDivision::AddCentres()
{
  const std::vector<std::size_t> first = FirstOfSpans(this->Threads, this->Olds, SpanSize,
    [this](std::size_t begin, std::size_t end) { return this->Mesh.CountFaces(begin, end); });
  MakeZeroed(this->Faces, first.back());
  LargeVector<Vector>& position = this->Mesh.Position;
  LengthenZeroed(position, this->Olds + this->Faces.size());
  ForSpans(this->Threads, this->Olds, SpanSize,
    [&](std::size_t span, std::size_t begin, std::size_t end)
    {
      std::size_t next = first[span];
      this->Mesh.VisitFaces(begin, end,
        [&](int a, int b, int c)
        {
          const std::size_t number = this->Olds + next;
          this->Faces[next++] = { a, b, c };
          for (const std::size_t slot : { this->Slot(a, b), this->Slot(b, c), this->Slot(c, a) })
          {
            this->Centre[slot] = static_cast<int>(number);
          }
          position[number] = (position[a] + position[b] + position[c]) * (1.f / 3.f);
        });
    });
}

template <typename Visit>
void SqrtThreeDivision::VisitKept(std::size_t begin, std::size_t end, Visit&& visit) const
{
  for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v)
  {
    for (int i = 0; i < this->Mesh.Rings[v].Count; ++i)
    {
      if (v < this->Mesh.Rings[v].Item[i] && this->Kept->Has(v, i))
      {
        visit(v, i);
      }
    }
  }
}

void SqrtThreeDivision::AddMiddles()
{
  if (!this->Kept)
  {
    return;
  }
  const std::vector<std::size_t> first = FirstOfSpans(this->Threads, this->Olds, SpanSize,
    [this](std::size_t begin, std::size_t end)
    {
      std::size_t count = 0;
      this->VisitKept(begin, end, [&count](int, int) { ++count; });
      return count;
    });
  this->HalvedEdges.resize(first.back());
  LargeVector<Vector>& position = this->Mesh.Position;
  const std::size_t before = position.size();
  position.resize(before + this->HalvedEdges.size());
  ForSpans(this->Threads, this->Olds, SpanSize,
    [&](std::size_t span, std::size_t begin, std::size_t end)
    {
      std::size_t next = first[span];
      this->VisitKept(begin, end,
        [&](int v, int i)
        {
          const int w = this->Mesh.Rings[v].Item[i];
          const std::size_t number = before + next;
          this->HalvedEdges[next++] = { v, w };
          position[number] = (position[v] + position[w]) * 0.5f;
          this->Middle[this->Slots.At(v, i)] = static_cast<int>(number);
          this->Middle[this->Slot(w, v)] = static_cast<int>(number);
        });
    });
}

void SqrtThreeDivision::JoinCentre(std::size_t face)
{
  // Corner, then what lies across the edge to the next corner.
  Ring& ring = this->Mesh.Rings[this->Olds + face];
  for (int k = 0; k < 3; ++k)
  {
    const int a = this->Faces[face][k];
    const int b = this->Faces[face][(k + 1) % 3];
    const int c = this->Faces[face][(k + 2) % 3];
    const int middle = this->MiddleAt(this->Slot(a, b));
    const bool isCutOff = middle != None && this->MiddleAt(this->Slot(a, c)) != None;
    Append(ring, isCutOff ? None : a);
    Append(ring, middle != None ? middle : this->Centre[this->Slot(b, a)]);
  }
}

void SqrtThreeDivision::JoinMiddle(std::size_t edge)
{
  const int u = this->HalvedEdges[edge][0];
  const int v = this->HalvedEdges[edge][1];
  const int left = this->Mesh.Rings[u].After(v);
  const int right = this->Mesh.Rings[u].Before(v);
  Ring& ring = this->Mesh.Rings[this->Olds + this->Faces.size() + edge];
  Append(ring, u);
  Append(ring, this->Middle[this->Slot(u, right)]);
  Append(ring, this->Centre[this->Slot(v, u)]);
  Append(ring, this->Middle[this->Slot(v, right)]);
  Append(ring, v);
  Append(ring, this->Middle[this->Slot(v, left)]);
  Append(ring, this->Centre[this->Slot(u, v)]);
  Append(ring, this->Middle[this->Slot(u, left)]);
}

void SqrtThreeDivision::JoinOld(std::size_t vertex)
{
  const int v = static_cast<int>(vertex);
  Ring ring;
  const int count = this->Mesh.Rings[v].Count;
  for (int i = 0; i < count; ++i)
  {
    const int middle = this->MiddleAt(this->Slots.At(v, i));
    const bool isCutOff =
      middle != None && this->MiddleAt(this->Slots.At(v, i + 1 < count ? i + 1 : 0)) != None;
    Append(ring, middle);
    Append(ring, isCutOff ? None : this->Centre[this->Slots.At(v, i)]);
  }
  this->Mesh.Rings[v] = ring;
}
}

LargeVector<Triangle> Divide(SurfaceMesh& mesh, const KeptEdges* kept, Executor& executor)
{
  return SqrtThreeDivision(mesh, kept, executor).Run();
}

SurfaceMesh Undivided(const SurfaceMesh& mesh, int numberOfVertices, Executor& executor)
{
  SurfaceMesh old;
  old.Position.assign(mesh.Position.begin(), mesh.Position.begin() + numberOfVertices);
  old.Rings.resize(numberOfVertices);
  ForSpans(executor, old.Rings.size(), SpanSize,
    [&](std::size_t, std::size_t begin, std::size_t end)
    {
      for (std::size_t v = begin; v < end; ++v)
      {
        // The edge between the centres of two faces at v was flipped from v and the other vertex
        // there.
        const Ring& ring = mesh.Rings[v];
        old.Rings[v].Count = ring.Count;
        for (int i = 0; i < ring.Count; ++i)
        {
          old.Rings[v].Item[i] = mesh.Rings[ring.Item[i]].After(ring.Previous(i));
        }
      }
    });
  return old;
}
}
