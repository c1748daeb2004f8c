// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Subdivision of the surface to the edge lengths of the next level.

#include "Core/Common/Select.h"
#include "Core/Evolution/Evolution.h"
#include "Core/Mesh/Division.h"
#include "Core/Surface/Proximity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace volumic
{
namespace
{
/** Find the edges that a division must not flip. */
class EdgesToKeep
{
public:
  /** Rounds with more and more kept edges; the last one keeps all. */
  static constexpr int Rounds = 6;

  EdgesToKeep(const SurfaceMesh& mesh, const DivisionNumbers& numbers, KeptEdges& kept)
    : Mesh(mesh), Numbers(numbers), Kept(kept)
  {
  }

  /**
   * Keep the edges whose flips create intersecting faces. From the second round on, keep edges
   * around them, too, and all edges in the last round. Then keep edges at rings that would
   * overflow.
   */
  void KeepAbout(const std::vector<Proximity::FacePair>& pairs, int round);

private:
  using Face = std::array<int, 3>;
  bool IsCentre(int v) const
  {
    const int olds = this->Mesh.Size();
    return v >= olds && v < olds + this->Numbers.Faces;
  }
  /** Return the old face whose centre a new vertex is. */
  Face FaceOf(int centre) const;
  /** Keep the edges of the old faces whose centres are corners of a new face. @return their
   * corners */
  std::vector<int> KeepOf(const Face& face);

  const SurfaceMesh& Mesh;
  const DivisionNumbers& Numbers;
  KeptEdges& Kept;
};

EdgesToKeep::Face EdgesToKeep::FaceOf(int centre) const
{
  // The last vertex whose faces start at or before this one.
  int number = centre - this->Mesh.Size();
  const LargeVector<int>& first = this->Numbers.FirstFace;
  const auto behind = std::upper_bound(first.begin(), first.end(), number);
  const auto v = static_cast<std::size_t>(behind - first.begin() - 1);
  number -= first[v];
  Face found{};
  this->Mesh.VisitFaces(v, v + 1,
    [&](int a, int b, int c)
    {
      if (number-- == 0)
      {
        found = { a, b, c };
      }
    });
  return found;
}

std::vector<int> EdgesToKeep::KeepOf(const Face& face)
{
  std::vector<int> corners;
  for (int k = 0; k < 3; ++k)
  {
    if (!this->IsCentre(face[k]))
    {
      continue;
    }
    const Face own = this->FaceOf(face[k]);
    corners.insert(corners.end(), own.begin(), own.end());
    const int next = face[(k + 1) % 3];
    if (this->IsCentre(next))
    {
      const Face other = this->FaceOf(next);
      const auto has = [&other](int v)
      { return std::find(other.begin(), other.end(), v) != other.end(); };
      for (int i = 0; i < 3; ++i)
      {
        if (has(own[i]) && has(own[(i + 1) % 3]))
        {
          this->Kept.Keep(own[i], own[(i + 1) % 3]);
        }
      }
    }
  }
  return corners;
}

void EdgesToKeep::KeepAbout(const std::vector<Proximity::FacePair>& pairs, int round)
{
  std::vector<int> about;
  for (const Proximity::FacePair& pair : pairs)
  {
    for (const Face& face : { pair.First, pair.Second })
    {
      const std::vector<int> corners = this->KeepOf(face);
      about.insert(about.end(), corners.begin(), corners.end());
    }
  }
  for (int ring = 0; ring < round; ++ring)
  {
    SortUnique(about);
    const std::size_t count = about.size();
    for (std::size_t i = 0; i < count; ++i)
    {
      this->Kept.KeepAllAt(about[i]);
      const Ring& neighbours = this->Mesh.Rings[about[i]];
      about.insert(about.end(), neighbours.Item, neighbours.Item + neighbours.Count);
    }
  }
  if (round == Rounds - 1)
  {
    this->Kept.KeepAll();
  }
  for (auto full = this->Kept.FindOverfull(); !full.empty(); full = this->Kept.FindOverfull())
  {
    for (const int v : full)
    {
      this->Kept.KeepAllAt(v);
    }
  }
}

/** Sweeps of a descent, and passes per block. More have no effect on the result. */
constexpr int DescendingSweeps = 2;
constexpr int DescendingPasses = 2;
/** Fraction of the progress of a division. */
constexpr double DescendingShare = 0.3;

/** Call visit(w, squared length) for each edge from v to a larger vertex. */
template <typename Visit>
void VisitEdges(const SurfaceMesh& mesh, int v, const Visit& visit)
{
  const Ring& ring = mesh.Rings[v];
  for (int i = 0; i < ring.Count; ++i)
  {
    const int w = ring.Item[i];
    if (v < w)
    {
      visit(w, SquaredDistance(mesh.Position[v], mesh.Position[w]));
    }
  }
}

float LongestEdge(const Evolution& e)
{
  const SurfaceMesh& mesh = e.State.Mesh;
  return std::sqrt(JoinVertices(
    mesh, e.Threads, 0.f,
    [&mesh](int v, float& longest)
    { VisitEdges(mesh, v, [&](int, float squared) { longest = std::max(longest, squared); }); },
    [](float a, float b) { return std::max(a, b); }));
}

std::vector<Proximity::FacePair> FindIntersections(Evolution& e)
{
  // A division leaves some edges longer than eq. (1) allows. The verification extends its reach.
  SurfaceState& s = e.State;
  const SizingField sizing = s.Sizing;
  s.Sizing = sizing.ForEdgesOf(LongestEdge(e));
  LayGrid(e);
  const std::vector<Proximity::FacePair> found =
    Proximity::FindIntersections(s, AliveVertices(e), e.Threads);
  s.Sizing = sizing;
  return found;
}

void DivideOnce(Evolution& e)
{
  // Flips of old edges may create intersections in thin regions. Such edges are kept, then more and
  // more around them, finally all, which preserves the old surface with more vertices.
  ForgetBlocks(e);
  SurfaceMesh old = std::exchange(e.State.Mesh, SurfaceMesh());
  old.Reorder(SpaceFillingOrder(old, e.State.Sizing.Smallest(), e.Threads), e.Threads);
  std::unique_ptr<KeptEdges> kept;
  for (int round = 0; round <= EdgesToKeep::Rounds; ++round)
  {
    const DivisionNumbers numbers = NumberForDivision(old, kept.get(), e.Threads);
    e.State.Mesh = volumic::Divide(old, numbers, kept.get(), e.Threads);
    const std::vector<Proximity::FacePair> found = FindIntersections(e);
    if (found.empty() || round == EdgesToKeep::Rounds)
    {
      return;
    }
    if (!kept)
    {
      kept = std::make_unique<KeptEdges>(old);
    }
    EdgesToKeep(old, numbers, *kept).KeepAbout(found, round);
  }
}
}

void DescendField(Evolution& e, double delta)
{
  const SizingField sizing = e.State.Sizing;
  e.State.Sizing = SizingField(static_cast<float>(delta));
  Renumber(e); // The order must not depend on earlier edits.
  ActivateAll(e);
  for (int sweep = 0; sweep < DescendingSweeps && !e.Stopped; ++sweep)
  {
    Relax(e, SurfaceIteration::Mode::Descend, DescendingPasses,
      { Monitor::Activity::Dividing, DescendingShare * sweep / DescendingSweeps,
        DescendingShare * (sweep + 1) / DescendingSweeps });
  }
  ForgetBlocks(e);
  e.State.Sizing = sizing;
  e.HasDescended = true;
}

bool DivideAll(Evolution& e, int divisions)
{
  bool goesOn = true;
  for (int i = 0; i < divisions && goesOn; ++i)
  {
    DivideOnce(e);
    goesOn = e.GoOn(Monitor::Activity::Dividing, (i + 1.) / divisions);
  }
  if (divisions > 0)
  {
    LayOut(e);
  }
  else
  {
    Renumber(e);
  }
  return goesOn;
}

bool HasEdgeTooLong(const Evolution& e)
{
  constexpr float share = 1.0001f; // relative to the longest legal edge of eq. (1)
  const SurfaceMesh& mesh = e.State.Mesh;
  return JoinVertices(
           mesh, e.Threads, char(0),
           [&](int v, char& isFound)
           {
             VisitEdges(mesh, v,
               [&](int w, float squared)
               { isFound |= std::sqrt(squared) > e.State.Sizing.LongestEdge(v, w, share); });
           },
           [](char a, char b) { return char(a | b); }) != 0;
}
}
