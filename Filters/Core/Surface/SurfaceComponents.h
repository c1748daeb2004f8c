// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceComponents_h
#define volumicSurfaceComponents_h

#include "Core/Common/Executor.h"
#include "Core/Surface/ConnectedVertices.h"
#include "Core/Surface/RankPiece.h"
#include "Core/Surface/SurfaceState.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace volumic
{
/**
 * The components of a surface, of which each rank has a piece (RankPiece), or one has all: their
 * labels, and which of them must go. All that is said of them is the same on all ranks, for any
 * number of them, and for any executor.
 *
 * Sets of own vertices that edges join are found by each rank; sizes, places and the vertices along
 * borders go to rank 0, which joins them to components, and tells each rank those of its own. So
 * messages go with the borders and the number of components. Places that no vertex has are not
 * written, and of vertices of other ranks only those are looked at that are neighbours of own ones.
 *
 * SurfaceState::Counts tell on all ranks what was deleted. On each rank the number of vertices
 * falls by its own ones, and the Euler characteristic changes where it owns the first vertex of the
 * component: so the changes of all ranks add up to that of the surface (RankBlocks::ShareCounts).
 */
class SurfaceComponents
{
public:
  explicit SurfaceComponents(const RankPiece& piece)
    : Piece(piece)
  {
  }

  /**
   * Labels, in SurfaceState::Component, the rank's own vertices: components from 0, in the order of
   * their smallest vertices. What is asked for below is asked of these labels.
   */
  void Label(SurfaceState& state, Executor& executor);

  /** How many there were when they were last labelled, less those deleted since. */
  int NumberOfComponents() const { return this->Components; }

  /**
   * Deletes the small components that must go: ComponentWatch::DeleteDegenerate. Other labels stay.
   * @return whether anything was deleted.
   */
  bool DeleteDegenerate(SurfaceState& state);

  /**
   * Labels, and deletes the components that are inside out: a cavity must lie inside the others, any
   * other one outside. Such a one may be born by a cut, of no size and without any intersection, and
   * would grow without limit. They are judged from outside in, as if what is deleted had never been:
   * what lies in one that is inside out need not be.
   * @return whether anything was deleted; labels are fresh then, too
   */
  bool DeleteInsideOut(SurfaceState& state, Executor& executor);

  /** The smallest vertices of those that are inside out, of what Label() has labelled. */
  std::vector<int> FindInsideOut(const SurfaceState& state, Executor& executor);

private:
  static constexpr std::uint8_t Own = 1; ///< The mark of own vertices.

  /** What a rank has of a component: a set of own vertices that edges join. */
  struct OwnSet
  {
    int Root; ///< Its smallest vertex, and
    int Size;
    Vector Place; ///< Of the root.
  };
  /** A set is of the same component as all others, of any rank, that name the same vertex. */
  struct Name
  {
    int Vertex;
    int Set;
    bool operator<(const Name& other) const
    {
      return this->Vertex != other.Vertex ? this->Vertex < other.Vertex : this->Set < other.Set;
    }
    bool operator==(const Name& other) const
    {
      return this->Vertex == other.Vertex && this->Set == other.Set;
    }
  };
  /** The component of a set, as rank 0 tells it. */
  struct Whole
  {
    int Label;
    int Root;
    int Size;
    Vector Place; ///< Of the root.
  };

  void Mark(const SurfaceState& state, Executor& executor);
  MarkedVertices OwnOnes() const { return { this->Marks, Own }; }
  void FindOwnSets(SurfaceState& state, Executor& executor);
  std::vector<Name> NameBorders(const SurfaceState& state, Executor& executor) const;
  void FindWholes(const std::vector<Name>& names);
  std::vector<Message> JoinSets(const std::vector<Message>& ofRanks);
  std::vector<int> LabelsOf(const std::vector<int>& roots) const;
  void Remove(SurfaceState& state, const std::vector<int>& roots);

  const RankPiece Piece;
  ConnectedVertices Connected;
  LargeVector<std::uint8_t> Marks; ///< By vertex: Own or 0.
  std::vector<OwnSet> Sets;
  std::vector<Whole> Wholes; ///< Of each set.
  std::vector<int> SetOf;    ///< By label: an own set, or -1.
  std::vector<Whole> All;    ///< By label; on rank 0 only.
  int Components = 0;
};
}

#endif
