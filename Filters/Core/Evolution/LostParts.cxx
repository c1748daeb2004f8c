// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/LostParts.h"

#include "Core/Common/Spans.h"
#include "Core/Evolution/LostVoxels.h"
#include "Core/Image/VoxelNumbers.h"
#include "Core/Mesh/CellSurface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace volumic
{
namespace
{
/**
 * The longest voxel that is looked at by its middle alone, in units of the level: cells of the
 * cover are longer.
 */
constexpr double LongestSampled = 1.5;
/** Spans of runs between two questions whether to go on. */
constexpr std::size_t SpansPerBatch = 32;

/** Shares of the whole work that are done after its steps, as the questions tell them. */
constexpr double AfterLost = 0.7;
constexpr double AfterCells = 0.9;

/** The places that stand for a voxel. */
class VoxelSamples
{
public:
  explicit VoxelSamples(const LevelImage& image) : Step(image.Step)
  {
    for (int k = 0; k < 3; ++k)
    {
      this->Samples[k] =
        std::max(1, static_cast<int>(std::ceil(image.Step[k] / image.Unit / LongestSampled)));
    }
  }

  /**
   * Calls visit(point) for the middle of a voxel, or, where it is longer than LongestSampled along
   * an axis, for the middles of the fewest equal boxes of it that are not.
   */
  template <typename Visit>
  void VisitAll(const std::array<int, 3>& voxel, const Visit& visit) const
  {
    const auto place = [&](int axis, int sample)
    { return this->Step[axis] * (voxel[axis] + (sample + 0.5) / this->Samples[axis] - 0.5); };
    for (int c = 0; c < this->Samples[2]; ++c)
    {
      for (int b = 0; b < this->Samples[1]; ++b)
      {
        for (int a = 0; a < this->Samples[0]; ++a)
        {
          visit(Point{ place(0, a), place(1, b), place(2, c) });
        }
      }
    }
  }

private:
  std::array<double, 3> Step;
  std::array<int, 3> Samples; ///< Of a voxel along each axis.
};

/**
 * Edge length of the cells, in delta. Edges are then 1.7 and 2.4 delta long, within eq. (1), and
 * corners that no edge joins keep 1.7 delta, over lambda.
 */
constexpr double CellEdge = 1.7;

/** A cell that holds voxels of a part. */
struct PartCell
{
  CellLattice::Cell Cell;
  int Part;
  bool operator==(const PartCell& other) const
  {
    return this->Cell == other.Cell && this->Part == other.Part;
  }
  bool operator<(const PartCell& other) const
  {
    return this->Cell != other.Cell ? this->Cell < other.Cell : this->Part < other.Part;
  }
};

/** Those of the runs from one to another, each once. */
std::vector<PartCell> CellsOf(const std::vector<VoxelRun>& runs, std::size_t begin,
  std::size_t end, const VoxelNumbers& numbers, const VoxelSamples& samples,
  const CellLattice& lattice)
{
  std::vector<PartCell> cells;
  for (std::size_t r = begin; r < end; ++r)
  {
    const VoxelRun& run = runs[r];
    std::array<int, 3> voxel = numbers.PlaceOf(run.First);
    for (int i = 0; i < run.Length; ++i, ++voxel[0])
    {
      samples.VisitAll(voxel,
        [&](const Point& place)
        {
          const PartCell cell = { lattice.CellAt(place), run.Part };
          if (cells.empty() || !(cells.back() == cell))
          {
            cells.push_back(cell);
          }
        });
    }
  }
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

/** Two triangles that intersect, one of them about v, have corners nearer than this. */
float ReachAbout(const SurfaceState& state, int v)
{
  const float least = state.Sizing.SmallestReach();
  if (!state.Sizing.IsGraded())
  {
    return least;
  }
  // That of a surface whose longest edges are those of the faces about it.
  const SurfaceMesh& mesh = state.Mesh;
  const Ring& ring = mesh.Rings[v];
  float squared = 0.f;
  for (int i = 0; i < ring.Count; ++i)
  {
    const Vector p = mesh.Position[ring.Item[i]];
    squared = std::max({ squared, SquaredDistance(mesh.Position[v], p),
      SquaredDistance(p, mesh.Position[ring.Next(i)]) });
  }
  return std::max(least,
    std::sqrt(squared) * (SizingField::ReachInDelta / SizingField::LongestEdgeInDelta));
}

/** Whether no triangle of the surface can reach the cell. */
bool IsClearOfSurface(
  const SurfaceState& state, const CellLattice& lattice, const CellLattice::Cell& cell)
{
  const auto hasWithin = [&state](const Point& p, float more)
  {
    const Vector place(
      static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]));
    bool found = false;
    state.Grid.Visit(place, state.Sizing.LargestReach() + more,
      [&](int v)
      {
        const float reach = ReachAbout(state, v) + more;
        found = found || SquaredDistance(place, state.Mesh.Position[v]) <= reach * reach;
      });
    return found;
  };
  const float radius =
    static_cast<float>(CellLattice::Circumradius * CellEdge) * state.Sizing.OfLevel();
  if (!hasWithin(lattice.Centre(cell), radius))
  {
    return true;
  }
  for (int i = 0; i < CellLattice::NumberOfCorners; ++i)
  {
    if (hasWithin(lattice.Corner(cell, i), 0.f))
    {
      return false;
    }
  }
  return true;
}

/** Leaves those that no triangle of the surface can reach. */
void LeaveClear(
  std::vector<PartCell>& cells, const SurfaceState& state, const CellLattice& lattice)
{
  const auto isTaken = [&](const PartCell& cell)
  { return !IsClearOfSurface(state, lattice, cell.Cell); };
  cells.erase(std::remove_if(cells.begin(), cells.end(), isTaken), cells.end());
}

/**
 * The cells that hold lost voxels and are clear of the surface. Asked to stop it returns none.
 */
std::vector<PartCell> FindPartCells(const SurfaceState& state, const Field& field,
  const LostVoxels& lost, const CellLattice& lattice, Executor& executor,
  const ProgressQuestion& goOn)
{
  const VoxelNumbers numbers(field.Image().Size);
  const VoxelSamples samples(field.Image());
  const std::size_t n = lost.Runs.size();
  constexpr std::size_t batch = SpansPerBatch * LostVoxels::RunSpan;
  std::vector<std::vector<PartCell>> spans((n + LostVoxels::RunSpan - 1) / LostVoxels::RunSpan);
  for (std::size_t first = 0; first < n; first += batch)
  {
    const std::size_t count = std::min(batch, n - first);
    ForSpans(executor, count, LostVoxels::RunSpan,
      [&](std::size_t span, std::size_t begin, std::size_t end)
      {
        std::vector<PartCell>& cells = spans[first / LostVoxels::RunSpan + span];
        cells = CellsOf(lost.Runs, first + begin, first + end, numbers, samples, lattice);
        LeaveClear(cells, state, lattice);
      });
    if (!goOn(static_cast<double>(first + count) / static_cast<double>(n)))
    {
      return {};
    }
  }
  std::vector<PartCell> all = Joined(executor, spans);
  SortInSpans(executor, all);
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

/** Each cell once. @param cells sorted @param parts how many parts have one */
std::vector<CellLattice::Cell> CellsOfParts(
  const std::vector<PartCell>& cells, int numberOfParts, int& parts)
{
  std::vector<char> isCovered(static_cast<std::size_t>(numberOfParts), 0);
  std::vector<CellLattice::Cell> all;
  for (const PartCell& cell : cells)
  {
    isCovered[static_cast<std::size_t>(cell.Part)] = 1;
    if (all.empty() || all.back() != cell.Cell)
    {
      all.push_back(cell.Cell);
    }
  }
  parts = static_cast<int>(std::count(isCovered.begin(), isCovered.end(), 1));
  return all;
}

}

LostPartCover FindLostParts(const SurfaceState& state, const Field& field, PartKind kind,
  int minimumSize, Executor& executor, const ProgressQuestion& goOn)
{
  LostPartCover stopped;
  stopped.IsStopped = true;
  const LostVoxels lost = FindLostVoxels(state, field, kind, minimumSize, executor,
    [&goOn](double share) { return goOn(AfterLost * share); });
  if (lost.IsStopped)
  {
    return stopped;
  }
  LostPartCover result;
  result.Found = lost.Parts;
  result.Boundary.Add(lost, field, kind, executor);
  const CellLattice lattice(CellEdge * state.Sizing.OfLevel());
  bool goesOn = true;
  const std::vector<PartCell> cells = FindPartCells(state, field, lost, lattice, executor,
    [&](double share)
    {
      goesOn = goOn(AfterLost + (AfterCells - AfterLost) * share);
      return goesOn;
    });
  if (!goesOn)
  {
    return stopped;
  }
  result.Surface = lattice.Boundary(CellsOfParts(cells, result.Found, result.Covered), executor);
  if (kind == PartKind::Cavity)
  {
    for (Triangle& triangle : result.Surface.Triangles)
    {
      std::swap(triangle[1], triangle[2]);
    }
  }
  return goOn(1.) ? result : stopped;
}
}
