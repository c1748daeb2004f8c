// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/DualMesh.h"

#include "Core/Common/Spans.h"
#include "Core/Interfaces/CellPattern.h"
#include "Core/Interfaces/DualCells.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace volumic
{
namespace
{
using Number = LabelMap::Number;
using Slab = DualSlab;

/** The four cells around a voxel face, in cyclic order: 1 if lower along the next two axes. */
constexpr std::array<std::array<int, 2>, 4> CellsAround = { { { 0, 0 }, { 1, 0 }, { 1, 1 },
  { 0, 1 } } };
/** Axis (first or second of the two) normal to the side towards the previous and the next cell. */
constexpr std::array<int, 4> SideBefore = { 1, 0, 1, 0 };
constexpr std::array<int, 4> SideAfter = { 0, 1, 0, 1 };

class DualMesher
{
public:
  explicit DualMesher(const DualGrid& grid) : Grid(grid), Cells(grid) {}

  void Make(
    Executor& executor, LargeVector<Vector>& points, LargeVector<InterfaceMesh::Face>& faces)
  {
    this->Cells.Make(executor);
    ForSpans(executor, this->Cells.Slabs.size(), 1,
      [&](std::size_t slab, std::size_t, std::size_t) { this->AddFaces(slab); });
    this->Join(executor, points, faces);
  }

private:
  /** Contents of the two layers of cells below and above a slice of voxels. */
  struct Layers
  {
    std::vector<int> Below; ///< values of DualSlab::Contents, or NoCell
    std::vector<int> Above;
    bool IsBelowPrevious = false; ///< Whether Below belongs to the previous slab.
  };
  static constexpr int NoCell = -2147483647;

  void Fill(std::vector<int>& layer, int k) const
  {
    layer.assign(this->Cells.SliceSize(), NoCell);
    if (k < 0)
    {
      return;
    }
    const Slab& slab = this->Cells.Slabs[static_cast<std::size_t>(k / DualCells::SlabSize)];
    for (int j = 0; j < this->Cells.Rows; ++j)
    {
      const std::size_t row = static_cast<std::size_t>(k - slab.First) * this->Cells.Rows + j;
      for (std::size_t n = slab.Row[row]; n < slab.Row[row + 1]; ++n)
      {
        layer[static_cast<std::size_t>(j) * this->Grid.Size[0] + slab.X[n]] = slab.Contents[n];
      }
    }
  }

  void AddFaces(std::size_t number)
  {
    Slab& slab = this->Cells.Slabs[number];
    std::vector<Number> slice(this->Cells.SliceSize());
    std::vector<Number> next(this->Cells.SliceSize());
    Layers layers;
    this->Grid.CopySlice(slab.First, next.data());
    this->Fill(layers.Above, slab.First - 1);
    for (int k = slab.First; k < slab.End; ++k)
    {
      slice.swap(next);
      layers.Below.swap(layers.Above);
      layers.IsBelowPrevious = k == slab.First;
      this->Grid.CopySlice(k + 1, next.data());
      this->Fill(layers.Above, k);
      for (int j = 0; j + 1 < this->Grid.Size[1]; ++j)
      {
        const std::size_t row = static_cast<std::size_t>(j) * this->Grid.Size[0];
        for (int i = 0; i + 1 < this->Grid.Size[0]; ++i)
        {
          const std::size_t at = row + static_cast<std::size_t>(i);
          const std::array<Number, 3> beyond = { slice[at + 1],
            slice[at + static_cast<std::size_t>(this->Grid.Size[0])], next[at] };
          for (int axis = 0; axis < 3; ++axis)
          {
            if (slice[at] != beyond[axis])
            {
              this->AddVoxelFace(number, layers, { i, j, k }, axis, slice[at], beyond[axis]);
            }
          }
        }
      }
    }
    for (const SpecialCell& special : slab.Special)
    {
      for (int sheet = 0; sheet < special.Pattern.Sheets; ++sheet)
      {
        if (special.Pattern.IsOpened(sheet))
        {
          this->AddCaps(slab, special, sheet);
        }
      }
    }
  }

  /** Add a triangle between two labels. @param side side of the box, if one label is outside */
  void AddTriangle(
    Slab& slab, const std::array<int, 3>& vertices, Number behind, Number front, int side) const
  {
    InterfaceMesh::Face face = { vertices, behind, front };
    if (this->Cells.IsOutside(behind) || this->Cells.IsOutside(front))
    {
      const Number inside = this->Cells.IsOutside(behind) ? front : behind;
      if (inside == 0)
      {
        return;
      }
      const auto number = static_cast<Number>(this->Grid.Outside + side);
      face.Behind = this->Cells.IsOutside(behind) ? number : behind;
      face.Front = this->Cells.IsOutside(front) ? number : front;
    }
    if (face.Behind > face.Front)
    {
      std::swap(face.Behind, face.Front);
      std::swap(face.Vertex[1], face.Vertex[2]);
    }
    slab.Faces.push_back(face);
  }

  /** Boundary loop of a voxel face. Points are encoded as in DualSlab::Faces. */
  struct Loop
  {
    std::array<int, 20> Point;
    int Count = 0;
  };

  /**
   * Return the boundary loop of a voxel face with special cells.
   * @param special  the four cells in cyclic order; null: plain
   * @param contents their values of DualSlab::Contents
   * @param isPrevious whether they are in the previous slab
   */
  static Loop LoopAround(const std::array<const SpecialCell*, 4>& special,
    const std::array<int, 4>& contents, const std::array<bool, 4>& isPrevious, int axis)
  {
    Loop loop;
    for (int q = 0; q < 4; ++q)
    {
      const int edge = CellPattern::EdgeAt(axis, CellsAround[q][0], CellsAround[q][1]);
      const SpecialCell* here = special[q];
      const int before = (q + 3) % 4;
      if (here || special[before])
      {
        // The strand belongs to the special cell of the two, and to the lower one if both are.
        const int index = SideBefore[q];
        const bool isHigh = CellsAround[q][index] == 1; // The side is the high one of this cell.
        const bool isOfHere = here && (isHigh || !special[before]);
        const int q0 = isOfHere ? q : before;
        const int edge0 = isOfHere
          ? edge
          : CellPattern::EdgeAt(axis, CellsAround[before][0], CellsAround[before][1]);
        const int strand = special[q0]->Pattern.StrandOf[edge0][index];
        const int sideOfCell = CellPattern::SidesOf(edge0)[index];
        loop.Point[loop.Count++] = Encode(special[q0]->Strand[sideOfCell][strand], isPrevious[q0]);
      }
      if (!here)
      {
        loop.Point[loop.Count++] = Encode(contents[q], isPrevious[q]);
        continue;
      }
      const CellPattern& pattern = here->Pattern;
      const int sheet = pattern.SheetOf[edge];
      if (!pattern.IsOpened(sheet))
      {
        loop.Point[loop.Count++] = Encode(here->Apex[sheet], isPrevious[q]);
        continue;
      }
      loop.Point[loop.Count++] = Encode(here->InnerStrandAt(edge, SideBefore[q]), isPrevious[q]);
      loop.Point[loop.Count++] = Encode(here->InnerArc[edge], isPrevious[q]);
      loop.Point[loop.Count++] = Encode(here->InnerStrandAt(edge, SideAfter[q]), isPrevious[q]);
    }
    return loop;
  }

  static int Encode(int point, bool isPrevious) { return isPrevious ? -1 - point : point; }

  void AddVoxelFace(std::size_t number, const Layers& layers, const std::array<int, 3>& voxel,
    int axis, Number behind, Number front)
  {
    Slab& slab = this->Cells.Slabs[number];
    const std::array<int, 2> across = { (axis + 1) % 3, (axis + 2) % 3 };
    std::array<std::array<int, 3>, 4> cells;
    std::array<int, 4> contents;
    std::array<bool, 4> isPrevious;
    bool arePlain = true;
    for (int q = 0; q < 4; ++q)
    {
      cells[q] = voxel;
      cells[q][across[0]] -= CellsAround[q][0];
      cells[q][across[1]] -= CellsAround[q][1];
      const bool isBelow = cells[q][2] < voxel[2];
      contents[q] = (isBelow
          ? layers.Below
          : layers.Above)[static_cast<std::size_t>(cells[q][1]) * this->Grid.Size[0] + cells[q][0]];
      isPrevious[q] = isBelow && layers.IsBelowPrevious;
      arePlain = arePlain && contents[q] >= 0;
    }
    const int side = 2 * axis + (voxel[axis] == 0 ? 0 : 1);
    if (arePlain)
    {
      // Diagonals connect cells of one parity: other diagonals reduce the distance of triangles.
      // Opposite sides of a box have the same diagonals.
      const bool isInSide = this->Cells.IsOutside(behind) || this->Cells.IsOutside(front);
      const auto squared = [&](int q)
      {
        const auto positionOf = [&](int p)
        { return this->Cells.Slabs[number - (isPrevious[p] ? 1 : 0)].Points[contents[p]]; };
        return SquaredDistance(positionOf(q), positionOf(q + 2));
      };
      const int turn = this->Grid.HasShortDiagonals
        ? (squared(1) < squared(0) ? 1 : 0)
        : (voxel[across[0]] + voxel[across[1]] + (isInSide ? 0 : voxel[axis])) & 1;
      for (int half = 0; half < 2; ++half)
      {
        std::array<int, 3> vertices;
        for (int n = 0; n < 3; ++n)
        {
          const int q = (turn + 2 * half + n) % 4;
          vertices[n] = Encode(contents[q], isPrevious[q]);
        }
        this->AddTriangle(slab, vertices, behind, front, side);
      }
      return;
    }
    std::array<const SpecialCell*, 4> special;
    for (int q = 0; q < 4; ++q)
    {
      const Slab& own = this->Cells.Slabs[number - (isPrevious[q] ? 1 : 0)];
      special[q] =
        contents[q] < 0 ? &own.Special[static_cast<std::size_t>(-1 - contents[q])] : nullptr;
    }
    const Loop loop = this->LoopAround(special, contents, isPrevious, axis);
    const int centre = static_cast<int>(slab.Points.size());
    std::array<float, 3> position;
    for (int n = 0; n < 3; ++n)
    {
      position[n] = n == axis ? this->Grid.Planes[n][voxel[n]] : this->Grid.Centres[n][voxel[n]];
    }
    slab.Points.push_back({ position[0], position[1], position[2] });
    for (int n = 0; n < loop.Count; ++n)
    {
      this->AddTriangle(
        slab, { centre, loop.Point[n], loop.Point[(n + 1) % loop.Count] }, behind, front, side);
    }
  }

  /** Close the regions of an opened sheet by fans, except for the region at the centre. */
  void AddCaps(Slab& slab, const SpecialCell& special, int sheet)
  {
    const CellPattern& pattern = special.Pattern;
    const int centre = pattern.CentreOf[sheet];
    for (int region = 0; region < CellPattern::Octants; ++region)
    {
      if (pattern.RegionOf[region] != region || special.Labels[region] == special.Labels[centre])
      {
        continue;
      }
      std::vector<std::array<int, 2>> link; // counter-clockwise, seen from the centre
      for (int edge = 0; edge < CellPattern::Edges; ++edge)
      {
        const auto [low, high] = CellPattern::OctantsOf(edge);
        const bool isLow = pattern.RegionOf[low] == region;
        if (pattern.SheetOf[edge] != sheet || isLow == (pattern.RegionOf[high] == region))
        {
          continue;
        }
        int q = 0; // index of this cell around the voxel face of the arc
        while (CellsAround[q][0] != (edge & 1) || CellsAround[q][1] != (edge >> 1 & 1))
        {
          ++q;
        }
        const int arc = special.InnerArc[edge];
        link.push_back({ special.InnerStrandAt(edge, isLow ? SideAfter[q] : SideBefore[q]), arc });
        link.push_back({ arc, special.InnerStrandAt(edge, isLow ? SideBefore[q] : SideAfter[q]) });
      }
      if (!link.empty())
      {
        this->AddCap(slab, special, link, special.Labels[region], special.Labels[centre]);
      }
    }
  }

  void AddCap(Slab& slab, const SpecialCell& special, const std::vector<std::array<int, 2>>& link,
    Number inside, Number outside)
  {
    VectorD sum;
    for (const std::array<int, 2>& piece : link)
    {
      sum += VectorD(slab.Points[static_cast<std::size_t>(piece[0])]);
    }
    Vector middle(sum * (1. / static_cast<double>(link.size())));
    int side = 0;
    for (int axis = 0; axis < 3; ++axis)
    {
      if (this->Cells.IsAtSide(special.At, axis))
      {
        side = 2 * axis + (special.At[axis] == 0 ? 0 : 1);
        const float plane = this->Grid.Planes[axis][special.At[axis]];
        (axis == 0 ? middle.X : axis == 1 ? middle.Y : middle.Z) = plane;
      }
    }
    const int centre = static_cast<int>(slab.Points.size());
    slab.Points.push_back(middle);
    for (const std::array<int, 2>& piece : link)
    {
      this->AddTriangle(slab, { centre, piece[0], piece[1] }, inside, outside, side);
    }
  }

  void Join(
    Executor& executor, LargeVector<Vector>& points, LargeVector<InterfaceMesh::Face>& faces)
  {
    std::vector<std::size_t> first(this->Cells.Slabs.size() + 1, 0);
    std::vector<std::size_t> firstFace = first;
    for (std::size_t s = 0; s < this->Cells.Slabs.size(); ++s)
    {
      first[s + 1] = first[s] + this->Cells.Slabs[s].Points.size();
      firstFace[s + 1] = firstFace[s] + this->Cells.Slabs[s].Faces.size();
    }
    points.resize(first.back());
    faces.resize(firstFace.back());
    ForSpans(executor, this->Cells.Slabs.size(), 1,
      [&](std::size_t s, std::size_t, std::size_t)
      {
        Slab& slab = this->Cells.Slabs[s];
        std::copy(slab.Points.begin(), slab.Points.end(),
          points.begin() + static_cast<std::ptrdiff_t>(first[s]));
        for (std::size_t f = 0; f < slab.Faces.size(); ++f)
        {
          InterfaceMesh::Face face = slab.Faces[f];
          for (int& v : face.Vertex)
          {
            v = v < 0 ? static_cast<int>(first[s - 1]) - 1 - v : static_cast<int>(first[s]) + v;
          }
          faces[firstFace[s] + f] = face;
        }
        slab = Slab();
      });
  }

  const DualGrid& Grid;
  DualCells Cells;
};
}

void MakeDualFaces(const DualGrid& grid, Executor& executor, LargeVector<Vector>& points,
  LargeVector<InterfaceMesh::Face>& faces)
{
  DualMesher(grid).Make(executor, points, faces);
}

InterfaceMesh MakeDualMesh(const DualGrid& grid, Executor& executor)
{
  LargeVector<Vector> points;
  LargeVector<InterfaceMesh::Face> faces;
  MakeDualFaces(grid, executor, points, faces);
  InterfaceMesh mesh;
  if (grid.Outside >= 0)
  {
    mesh.FirstSide = grid.Outside;
    for (int axis = 0; axis < 3; ++axis)
    {
      mesh.Planes[2 * axis] = grid.Planes[axis].front();
      mesh.Planes[2 * axis + 1] = grid.Planes[axis].back();
    }
  }
  mesh.Assign(std::move(points), std::move(faces));
  mesh.FindStrata();
  return mesh;
}
}
