// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// The way of a surface to the next level's edge lengths.

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
/** Of a division: finds edges that are to be kept. */
class EdgesToKeep
{
public:
  /** More and more edges are kept in these, until none is flipped in the last. */
  static constexpr int Rounds = 6;

  EdgesToKeep(const SurfaceMesh& mesh, const DivisionNumbers& numbers, KeptEdges& kept)
    : Mesh(mesh), Numbers(numbers), Kept(kept)
  {
  }

  /**
   * Keeps the edges whose flips made faces that intersect; from the second round on others about
   * them, too, and all in the last one; then those at rings that would overflow.
   */
  void KeepAbout(const std::vector<Proximity::FacePair>& pairs, int round);

private:
  using Face = std::array<int, 3>;
  bool IsCentre(int v) const
  {
    const int olds = this->Mesh.Size();
    return v >= olds && v < olds + this->Numbers.Faces;
  }
  /** The old face that a new vertex is the centre of. */
  Face FaceOf(int centre) const;
  /** Keeps the edges of old faces of which corners of a new one are the centres. @return their
   * corners */
  std::vector<int> KeepOf(const Face& face);

  const SurfaceMesh& Mesh;
  const DivisionNumbers& Numbers;
  KeptEdges& Kept;
};

EdgesToKeep::Face EdgesToKeep::FaceOf(int centre) const
{
  // Of the last vertex whose faces do not begin behind it.
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

/** Sweeps of a descent, and passes in each block; more make no difference to what comes after. */
constexpr int DescendingSweeps = 2;
constexpr int DescendingPasses = 2;
/** Of what is told of a division. */
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
  return std::sqrt(JoinVertices(mesh, e.Threads, 0.f,
    [&mesh](int v, float& longest)
    { VisitEdges(mesh, v, [&](int, float squared) { longest = std::max(longest, squared); }); },
    [](float a, float b) { return std::max(a, b); }));
}

std::vector<Proximity::FacePair> FindIntersections(Evolution& e)
{
  // A division leaves some edges longer than verification may rely on; it looks further for them.
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
  // The division flips edges of the old surface; in narrow places these may pass through each
  // other. Such edges are kept, then more and more about them, and all of them at last, which
  // leaves the old surface, with more vertices.
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
  Renumber(e); // In an order that does not depend on what has been done before.
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
  constexpr float share = 1.0001f; // Of the longest that eq. (1) allows.
  const SurfaceMesh& mesh = e.State.Mesh;
  return JoinVertices(mesh, e.Threads, char(0),
           [&](int v, char& isFound)
           {
             VisitEdges(mesh, v,
               [&](int w, float squared)
               { isFound |= std::sqrt(squared) > e.State.Sizing.LongestEdge(v, w, share); });
           },
           [](char a, char b) { return char(a | b); }) != 0;
}
}
