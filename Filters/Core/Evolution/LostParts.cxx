// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/LostParts.h"

#include "Core/Image/VoxelNumbers.h"
#include "Core/Image/VoxelParts.h"
#include "Core/Mesh/CellSurface.h"
#include "Core/Mesh/RowCrossing.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace volumic
{
namespace
{
/**
 * Longest piece of a voxel that is looked at by its middle alone, in units of the level: cells of
 * the cover are longer.
 */
constexpr double LongestPiece = 1.5;
/**
 * Rows pass beside the voxels by so much, in voxels along y and z, so that hardly any hits an edge
 * or a corner of a surface on round numbers.
 */
constexpr double Aside[2] = { 1.2345e-4, 1.7 * 1.2345e-4 };
/** Voxels between two calls of the checkpoint. */
constexpr std::int64_t VoxelsPerBatch = 1 << 22;
/** Cells between two calls of the checkpoint. */
constexpr std::size_t CellsPerBatch = 4096;

/** Shares of the whole work that are done after its steps, for the checkpoint. */
constexpr double AfterInside = 0.25;
constexpr double AfterCover = 0.4;
constexpr double AfterLost = 0.7;
constexpr double WithinCells = 0.8;

enum : std::uint8_t
{
  Unknown = 0,
  Covered = 1,
  Lost = 2
};

class Search
{
public:
  Search(const SurfaceState& state, const Field& field, PartKind kind)
    : State(state)
    , TheField(field)
    , Kind(kind)
    , Size(field.Image().Size)
    , Numbers(Size)
    , Mark(static_cast<std::size_t>(Numbers.Count()),
        kind == PartKind::Object ? Unknown : Covered)
  {
    for (int k = 0; k < 3; ++k)
    {
      this->Inverse[k] = 1. / field.Image().Step[k];
      this->Pieces[k] = std::max(
        1, static_cast<int>(std::ceil(field.Image().Step[k] / field.Image().Unit / LongestPiece)));
    }
  }

  /** Marks what lies inside the surface: of no interest for lost objects, all for cavities. */
  void MarkInside();
  void CoverNear();
  /** @return false if asked to stop. */
  bool MarkLost(Executor& executor, const Checkpoint& goOn);
  /** The connected sets of lost voxels, which count as covered once they are found. */
  VoxelParts LostOnes() { return VoxelParts(this->Mark, this->Size, Lost, Covered); }

  /**
   * Calls visit(point) for the middle of a voxel, or, where it is longer than LongestPiece along an
   * axis, for the middles of equal pieces of it that are not.
   */
  template <typename Visit>
  void VisitPieces(std::int64_t voxel, Visit&& visit) const
  {
    const auto& step = this->TheField.Image().Step;
    const std::array<int, 3> index = this->Numbers.PlaceOf(voxel);
    const auto place = [&](int axis, int piece)
    { return step[axis] * (index[axis] + (piece + 0.5) / this->Pieces[axis] - 0.5); };
    for (int c = 0; c < this->Pieces[2]; ++c)
    {
      for (int b = 0; b < this->Pieces[1]; ++b)
      {
        for (int a = 0; a < this->Pieces[0]; ++a)
        {
          visit(Point{ place(0, a), place(1, b), place(2, c) });
        }
      }
    }
  }

private:
  /** Finds the crossings of the rows of voxels with a face. */
  void FindCrossings(int a, int b, int c);

  const SurfaceState& State;
  const Field& TheField;
  PartKind Kind;
  std::array<int, 3> Size;
  VoxelNumbers Numbers;
  double Inverse[3];
  int Pieces[3]; ///< Of a voxel along each axis, see VisitPieces.
  std::vector<std::uint8_t> Mark;
  /** Of rows and the surface: number of the first voxel of the row, and place along it. */
  std::vector<std::pair<std::int64_t, float>> Crossings;
};

void Search::FindCrossings(int a, int b, int c)
{
  Point corner[3];
  Bounds bounds;
  const int vertices[3] = { a, b, c };
  for (int k = 0; k < 3; ++k)
  {
    const Vector& p = this->State.Mesh.Position[vertices[k]];
    corner[k] = { p.X * this->Inverse[0], p.Y * this->Inverse[1] - Aside[0],
      p.Z * this->Inverse[2] - Aside[1] };
    bounds.Add(corner[k]);
  }
  int first[3];
  int last[3];
  for (int axis : { 1, 2 })
  {
    first[axis] = std::max(0, static_cast<int>(std::ceil(bounds.Low[axis])));
    last[axis] = std::min(this->Size[axis] - 1, static_cast<int>(std::floor(bounds.High[axis])));
  }
  for (int k = first[2]; k <= last[2]; ++k)
  {
    for (int j = first[1]; j <= last[1]; ++j)
    {
      const RowCrossing crossing = RowCrossing::Of(corner[0], corner[1], corner[2], j, k);
      if (crossing.Winding != 0)
      {
        this->Crossings.emplace_back(this->Numbers.Of(0, j, k), static_cast<float>(crossing.X));
      }
    }
  }
}

void Search::MarkInside()
{
  this->State.Mesh.VisitFaces([this](int a, int b, int c) { this->FindCrossings(a, b, c); });
  std::sort(this->Crossings.begin(), this->Crossings.end());
  for (std::size_t i = 0; i + 1 < this->Crossings.size();)
  {
    if (this->Crossings[i].first != this->Crossings[i + 1].first)
    {
      ++i; // Odd ones don't exist on a closed surface.
      continue;
    }
    const std::int64_t row = this->Crossings[i].first;
    const int first = std::max(0, static_cast<int>(std::ceil(this->Crossings[i].second)));
    const int last =
      std::min(this->Size[0] - 1, static_cast<int>(std::floor(this->Crossings[i + 1].second)));
    for (int x = first; x <= last; ++x)
    {
      this->Mark[row + x] = this->Kind == PartKind::Object ? Covered : Unknown;
    }
    i += 2;
  }
}

void Search::CoverNear()
{
  // Whatever the distances of the voxels.
  const double width = NearUnits * this->TheField.Image().Unit;
  const auto& step = this->TheField.Image().Step;
  for (int v = 0; v < this->State.Mesh.Size(); ++v)
  {
    if (!this->State.Mesh.IsAlive(v))
    {
      continue;
    }
    const Vector& p = this->State.Mesh.Position[v];
    const double place[3] = { p.X * this->Inverse[0], p.Y * this->Inverse[1],
      p.Z * this->Inverse[2] };
    int low[3];
    int high[3];
    for (int k = 0; k < 3; ++k)
    {
      const double reach = width * this->Inverse[k];
      low[k] = std::max(0, static_cast<int>(std::ceil(place[k] - reach)));
      high[k] = std::min(this->Size[k] - 1, static_cast<int>(std::floor(place[k] + reach)));
    }
    for (int k = low[2]; k <= high[2]; ++k)
    {
      for (int j = low[1]; j <= high[1]; ++j)
      {
        const std::int64_t row = this->Numbers.Of(0, j, k);
        const double y = (j - place[1]) * step[1];
        const double z = (k - place[2]) * step[2];
        for (int i = low[0]; i <= high[0]; ++i)
        {
          const double x = (i - place[0]) * step[0];
          if (x * x + y * y + z * z <= width * width)
          {
            this->Mark[row + i] = Covered;
          }
        }
      }
    }
  }
}

bool Search::MarkLost(Executor& executor, const Checkpoint& goOn)
{
  const int batch = static_cast<int>(
    std::clamp<std::int64_t>(VoxelsPerBatch / this->Numbers.Stride(2), 1, this->Size[2]));
  for (int first = 0; first < this->Size[2]; first += batch)
  {
    const int last = std::min(first + batch, this->Size[2]);
    ForBlocks(executor, static_cast<std::size_t>(last - first), 1,
      [&](std::size_t slab, std::size_t, std::size_t)
      {
        const int k = first + static_cast<int>(slab);
        std::int64_t voxel = this->Numbers.Of(0, 0, k);
        for (int j = 0; j < this->Size[1]; ++j)
        {
          for (int i = 0; i < this->Size[0]; ++i, ++voxel)
          {
            if (this->Mark[voxel] == Unknown &&
              (this->TheField.Voxel(i, j, k) > 0) == (this->Kind == PartKind::Object))
            {
              this->Mark[voxel] = Lost;
            }
          }
        }
      });
    if (!goOn(static_cast<double>(last) / this->Size[2]))
    {
      return false;
    }
  }
  return true;
}

/**
 * Edge length of the cells, in delta. Edges are then 1.7 and 2.4 delta long, within eq. (1), and
 * corners that no edge joins keep 1.7 delta, over lambda.
 */
constexpr double CellEdge = 1.7;

void MakeUnique(std::vector<CellLattice::Cell>& cells)
{
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
}

/** The cells that hold voxels of a part, each once. */
std::vector<CellLattice::Cell> CellsOf(
  const std::vector<std::int64_t>& part, const Search& search, const CellLattice& lattice)
{
  std::vector<CellLattice::Cell> cells;
  for (std::int64_t voxel : part)
  {
    search.VisitPieces(voxel, [&](const Point& place) { cells.push_back(lattice.CellAt(place)); });
  }
  MakeUnique(cells);
  return cells;
}

/** Whether no triangle of the surface can reach the cell. */
bool IsClearOfSurface(
  const SurfaceState& state, const CellLattice& lattice, const CellLattice::Cell& cell)
{
  const auto hasWithin = [&state](const Point& p, float radius)
  {
    const Vector place(
      static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]));
    return state.Grid.HasWithin(place, radius, state.Mesh.Position);
  };
  const float reach = state.Sizing.LargestReach();
  const float radius =
    static_cast<float>(CellLattice::Circumradius * CellEdge) * state.Sizing.OfLevel();
  if (!hasWithin(lattice.Centre(cell), radius + reach))
  {
    return true;
  }
  for (int i = 0; i < CellLattice::NumberOfCorners; ++i)
  {
    if (hasWithin(lattice.Corner(cell, i), reach))
    {
      return false;
    }
  }
  return true;
}
}

LostPartCover FindLostParts(const SurfaceState& state, const Field& field, PartKind kind,
  int minimumSize, Executor& executor, const Checkpoint& goOn)
{
  LostPartCover stopped;
  stopped.IsStopped = true;
  Search search(state, field, kind);
  search.MarkInside();
  if (!goOn(AfterInside))
  {
    return stopped;
  }
  search.CoverNear();
  if (!search.MarkLost(executor,
        [&goOn](double share) { return goOn(AfterCover + (AfterLost - AfterCover) * share); }))
  {
    return stopped;
  }
  LostPartCover result;
  const CellLattice lattice(CellEdge * state.Sizing.OfLevel());
  std::vector<CellLattice::Cell> cells;
  std::size_t seen = 0;
  VoxelParts parts = search.LostOnes();
  for (const auto* part = &parts.Next(); !part->empty(); part = &parts.Next())
  {
    if (static_cast<std::int64_t>(part->size()) < minimumSize)
    {
      continue;
    }
    ++result.Found;
    result.Boundary.Add(*part, field, kind);
    const std::size_t before = cells.size();
    for (const CellLattice::Cell& cell : CellsOf(*part, search, lattice))
    {
      if (IsClearOfSurface(state, lattice, cell))
      {
        cells.push_back(cell);
      }
      if (++seen % CellsPerBatch == 0 && !goOn(WithinCells))
      {
        return stopped;
      }
    }
    result.Covered += cells.size() > before;
  }
  MakeUnique(cells);
  result.Surface = lattice.Boundary(cells);
  if (kind == PartKind::Cavity)
  {
    for (Triangle& triangle : result.Surface.Triangles)
    {
      std::swap(triangle[1], triangle[2]);
    }
  }
  if (!goOn(1.))
  {
    return stopped;
  }
  return result;
}
}
