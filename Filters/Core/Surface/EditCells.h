// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicEditCells_h
#define volumicEditCells_h

#include "Core/Common/Executor.h"
#include "Core/Surface/SurfaceEditor.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace volumic
{
/**
 * Edits all over the surface, on all threads, with the same result whatever their number.
 *
 * Space is cut into cubes, the cells, of eight colours, two along each axis. An item (a vertex, or
 * a pair) belongs to the cell of its vertex. Cells of one colour are edited at the same time, those
 * of the next colour after all of them; within a cell the items are visited in their order. Cells
 * of one colour are so far apart that none reads what another one writes:
 *
 *   - the stars of vertices within a margin of the cell are edited (EditShare::Region);
 *   - with L the longest edge there is (HugeEdge, SurfaceState::LongestEdge), such an edit writes
 *     within margin + L of the cell;
 *   - it reads the faces that its own could intersect: corners within ReachShare clearances of
 *     these, and the other ends of their edges, so all within margin + 2 L + 1.6 delta.
 *
 * So the side of a cell is 2 margin + 3 L + 1.6 delta, and a bit. What is refused because a vertex
 * lies beyond its cell's margin, or for want of places for new vertices, is tried again in a next
 * round, in which items are sorted into cells anew, as long as anything changes. Places of removed
 * vertices are not used again before the pass is over: an item of another cell may still name them.
 *
 * Instead of locks, which would make the order of edits, and so the surface, depend on chance.
 */
class EditCells
{
public:
  /** How far from its cell an edit may begin, in delta. */
  static constexpr float Margin = 2.6f;
  /** The same for merges: bridge edges are split at their ends, on the rims of the two stars. */
  static constexpr float MergeMargin = 4.6f;

  EditCells(SurfaceState& state, Executor& threads)
    : State(state)
    , Threads(threads)
  {
  }

  /** What the visitor of an item may add to. */
  struct Lists
  {
    std::vector<int> Items; ///< Of the cell, in the order of their visits; new ones at the end.
    std::vector<int> Kept;  ///< For the caller: EditCells::Kept().
  };
  struct Pass
  {
    std::vector<int> Items;
    /** Whose position tells the cell of an item; empty: items are vertices. */
    std::function<int(int item)> VertexOf;
    float MarginInDelta = Margin;
    /** Places for new vertices that a cell gets for each of its items, and beside these. */
    std::size_t PlacesPerItem = 0;
    std::size_t PlacesPerCell = 0;
    /** Called for each item. On any thread; in a cell one after the other. */
    std::function<void(SurfaceEditor& editor, int item, Lists& lists)> Visit;
    /** Asked between two colours, on the thread that called Run(); false ends the pass. */
    std::function<bool()> GoOn;
  };
  /** Visits all items. State::Counts and Euler characteristic are up to date afterwards. */
  void Run(const Pass& pass);

  /** Items that the visits of the last pass have added, cell by cell. */
  const std::vector<int>& Added() const { return this->AllAdded; }
  /** The lists Kept of the last pass, cell by cell. */
  const std::vector<int>& Kept() const { return this->AllKept; }

  /** Changed vertices of all edits since TakeChanged(), cell by cell; some are named often. */
  const std::vector<int>& Changed() const { return this->Log; }
  std::vector<int> TakeChanged();

private:
  /** Items of one cell that follow each other in the list. */
  struct Stretch
  {
    std::uint64_t Cell; ///< Colour, then place.
    int Begin;
    int End;
  };
  struct Cell
  {
    Lists Content;
    EditShare Share;
    std::unique_ptr<SurfaceEditor> Editor;
    std::vector<int> LeftForPlaces;
    std::vector<int> LeftForRegion;
    std::vector<int> Changed;
  };

  float Side(const Pass& pass) const;
  void FindStretches(const std::vector<int>& items, const Pass& pass, float side);
  void FillCells(const std::vector<int>& items, const Pass& pass, float side);
  void FillCell(Cell& cell, std::size_t firstStretch, std::size_t lastStretch,
    const std::vector<int>& items);
  void LendPlaces(const Pass& pass, std::size_t first, std::size_t last);
  void VisitCell(const Pass& pass, Cell& cell);
  void Collect(std::size_t first, std::size_t last);
  /** One look at all items, colour by colour. @return false if asked to stop. */
  bool RunRound(const std::vector<int>& items, const Pass& pass);

  SurfaceState& State;
  Executor& Threads;
  std::vector<Stretch> Stretches;
  std::vector<std::unique_ptr<Cell>> Cells; ///< Those in use first.
  std::vector<std::size_t> FirstStretch;    ///< Of each cell, and the end of the last.
  std::vector<int> FirstOfColour;           ///< Nine places among them.
  VertexPlaces Removed;
  std::vector<int> LeftForPlaces;
  std::vector<int> LeftForRegion;
  std::vector<int> AllAdded;
  std::vector<int> AllKept;
  std::vector<int> Log;
};
}

#endif
