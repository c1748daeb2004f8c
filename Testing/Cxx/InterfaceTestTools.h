// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicInterfaceTestTools_h
#define volumicInterfaceTestTools_h

#include "Core/Common/Executor.h"
#include "Core/Interfaces/InterfaceClearance.h"
#include "Core/Interfaces/InterfaceFields.h"
#include "Core/Interfaces/InterfaceMesh.h"
#include "Core/Labels/LabelMapPadding.h"
#include "Core/Mesh/SelfIntersections.h"
#include "LabelTestTools.h"
#include "SurfaceTopology.h"

#include <optional>

/** Tools of the tests of interfaces. */
namespace volumic
{
/** A label map with its bricks and fields. */
struct InterfaceScene
{
  LabelMap Map;
  std::optional<LabelBricks> Bricks;
  std::optional<InterfaceFields> Fields;

  explicit InterfaceScene(LabelMap map) : InterfaceScene(map, VoxelBox::Of(map.Size())) {}
  /** @param inside box at which objects end */
  InterfaceScene(LabelMap map, const VoxelBox& inside, bool isPeriodic = false)
    : Map(std::move(map))
  {
    PadLabelMap(this->Map, inside, isPeriodic);
    this->Bricks.emplace(this->Map, OnThisThread(), inside);
    this->Fields.emplace(
      *this->Bricks, LabelFieldOptions(), this->Map.Spacing, OnThisThread(),
      [](double) { return true; }, isPeriodic);
  }
  InterfaceScene(const InterfaceScene&) = delete;
};

/** A cube of objects objectAt(i, j, k) in background. */
inline LabelMap InBackground(
  int side, int objects, const std::function<int(int, int, int)>& objectAt)
{
  const int margin = LabelBricks::Side;
  return MakeLabelMap({ side, side, side }, objects,
    [&](int i, int j, int k)
    {
      const bool isIn = std::min({ i, j, k }) >= margin && std::max({ i, j, k }) < side - margin;
      return isIn ? objectAt(i, j, k) : 0;
    });
}

/** A point, and the largest distance from it in its Voronoi cell. */
using Cell = std::array<double, 4>;

/** Return the number of the cell, from 1, that contains a point; 0: none. */
inline int CellAt(const std::vector<Cell>& cells, double x, double y, double z)
{
  const auto far = [&](const Cell& cell)
  { return std::hypot(x - cell[0], y - cell[1], z - cell[2]); };
  const auto nearest = std::min_element(
    cells.begin(), cells.end(), [&](const Cell& a, const Cell& b) { return far(a) < far(b); });
  return far(*nearest) < (*nearest)[3] ? 1 + static_cast<int>(nearest - cells.begin()) : 0;
}

/** Truncated Voronoi cells of random points, each an object, in background. */
inline LabelMap ManyCells(int side, int objects, unsigned seed)
{
  std::vector<Cell> cells(static_cast<std::size_t>(objects));
  for (Cell& cell : cells)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      cell[axis] = LabelBricks::Side + RandomShare(seed) * (side - 2 * LabelBricks::Side);
    }
    cell[3] = 3. + RandomShare(seed) * side / 4.;
  }
  return InBackground(side, objects, [&](int i, int j, int k) { return CellAt(cells, i, j, k); });
}

/** Voronoi cells of random points that fill the map. */
inline LabelMap Grains(
  const std::array<int, 3>& size, const std::array<double, 3>& spacing, int objects, unsigned seed)
{
  std::vector<Cell> cells(static_cast<std::size_t>(objects), Cell{ 0., 0., 0., 1e9 });
  for (Cell& cell : cells)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      cell[axis] = RandomShare(seed) * size[axis] * spacing[axis];
    }
  }
  LabelMap map = MakeLabelMap(size, objects,
    [&](int i, int j, int k)
    { return CellAt(cells, spacing[0] * i, spacing[1] * j, spacing[2] * k); });
  map.Spacing = spacing;
  return map;
}

/** Random pairs of voxels that share a face, an edge or a corner. */
inline LabelMap ScatteredVoxels(int side, int objects, unsigned seed)
{
  const auto next = [&seed](int choices)
  { return static_cast<int>(RandomBits(seed) % static_cast<unsigned>(choices)); };
  const int margin = LabelBricks::Side;
  std::map<std::array<int, 3>, int> voxels;
  for (int n = 0; n < side; ++n)
  {
    std::array<int, 3> voxel;
    const int object = 1 + next(objects);
    for (int& at : voxel)
    {
      at = margin + 1 + next(side - 2);
    }
    voxels[voxel] = object;
    for (int& at : voxel)
    {
      at += next(3) - 1;
    }
    voxels[voxel] = next(3) > 0 ? object : 1 + next(objects);
  }
  return InBackground(side + 2 * margin, objects,
    [&](int i, int j, int k)
    {
      const auto found = voxels.find({ i, j, k });
      return found == voxels.end() ? 0 : found->second;
    });
}

/** Return the number of faces at each edge. */
inline std::map<std::array<int, 2>, int> FacesAtEdges(const InterfaceMesh& mesh)
{
  std::map<std::array<int, 2>, int> edges;
  for (const InterfaceMesh::Face& face : mesh.Faces)
  {
    for (int k = 0; k < 3 && face.IsThere(); ++k)
    {
      const int u = face.Vertex[k];
      const int v = face.Vertex[(k + 1) % 3];
      ++edges[{ std::min(u, v), std::max(u, v) }];
    }
  }
  return edges;
}

/**
 * Expect the invariants of interfaces:
 * - The surface of each object except for 0 is closed, oriented and manifold, with a positive
 *   volume.
 * - No triangles intersect.
 * - Strata correspond to the faces at the edges.
 * - Faces at junction lines are in consistent order (AreInOrder).
 */
inline void ExpectSound(const InterfaceMesh& mesh)
{
  for (const auto& [object, surface] : SurfacesOf(mesh))
  {
    EXPECT_TRUE(object == 0 || (surface.BadLinks == 0 && surface.Volume > 0.)) << object;
  }
  EXPECT_EQ(CountSelfIntersections(AllFaces(mesh)), 0);
  InterfaceMesh recomputed = mesh;
  recomputed.FindStrata();
  for (std::size_t v = 0; v < mesh.Position.size(); ++v)
  {
    if (mesh.IsVertex(static_cast<int>(v)))
    {
      ASSERT_EQ(static_cast<int>(recomputed.StratumOf[v]), static_cast<int>(mesh.StratumOf[v]))
        << v;
    }
  }
  using Edges = std::set<std::array<int, 2>>;
  Edges lines;
  std::vector<int> edgeFaces;
  for (const auto& edge : FacesAtEdges(mesh))
  {
    EXPECT_GE(edge.second, 2);
    mesh.FindFaces(edge.first[0], edge.first[1], edgeFaces);
    const bool isAtSide = std::any_of(edgeFaces.begin(), edgeFaces.end(),
      [&](int f) { return mesh.IsSide(mesh.Faces[static_cast<std::size_t>(f)].Front); });
    if (edge.second != 2 || (isAtSide && mesh.IsLine(edgeFaces)))
    {
      lines.insert(edge.first);
    }
  }
  const std::vector<std::array<int, 2>> found = mesh.FindLines();
  EXPECT_EQ(Edges(found.begin(), found.end()), lines);
  EXPECT_EQ(found.size(), lines.size());
  for (const std::array<int, 2>& line : found)
  {
    mesh.FindFaces(line[0], line[1], edgeFaces);
    std::vector<FaceCoordinates> faces;
    for (const int f : edgeFaces)
    {
      faces.push_back(FaceCoordinatesOf(mesh, mesh.Faces[static_cast<std::size_t>(f)]));
      faces.back().Front =
        mesh.IsSide(faces.back().Front) ? LabelMap::Number(0) : faces.back().Front;
    }
    EXPECT_TRUE(AreInOrder(line[0], line[1], faces)) << line[0] << ' ' << line[1];
  }
}

/**
 * Expect that faces on a side of the box lie in its plane, and that no face is beyond it.
 * @return number of faces on each side
 */
inline std::array<int, 6> ExpectFlatSides(const InterfaceMesh& mesh, const InterfaceFields& fields)
{
  const VoxelBox& box = fields.Bricks().Inside();
  std::array<int, 6> counts = {};
  for (const InterfaceMesh::Face& face : mesh.Faces)
  {
    for (int k = 0; k < 3 && face.IsThere(); ++k)
    {
      const Vector& p = mesh.Position[static_cast<std::size_t>(face.Vertex[k])];
      const std::array<float, 3> at = { p.X, p.Y, p.Z };
      for (int side = 0; side < 6; ++side)
      {
        const int axis = side / 2;
        const bool isFirst = side % 2 == 0;
        const auto plane = static_cast<float>(
          fields.Step()[axis] * ((isFirst ? box.First[axis] : box.End[axis]) - 0.5));
        const bool isAt = face.Front == mesh.FirstSide + side;
        EXPECT_TRUE(isAt ? at[axis] == plane
            : isFirst    ? at[axis] >= plane
                         : at[axis] <= plane)
          << side << ' ' << at[axis] << ' ' << plane;
        counts[side] += isAt ? 1 : 0;
      }
    }
  }
  return counts;
}

/** Expect bit-identical triangles of the same objects on opposite sides. */
inline void ExpectMatchingSides(const InterfaceMesh& mesh)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    std::array<std::multiset<std::pair<int, std::set<std::array<float, 2>>>>, 2> sides;
    for (const InterfaceMesh::Face& face : mesh.Faces)
    {
      if (face.IsThere() && mesh.IsSide(face.Front) && mesh.AxisOf(face.Front) == axis)
      {
        std::set<std::array<float, 2>> points;
        for (const int v : face.Vertex)
        {
          const Vector& p = mesh.Position[static_cast<std::size_t>(v)];
          const std::array<float, 3> at = { p.X, p.Y, p.Z };
          points.insert({ at[(axis + 1) % 3], at[(axis + 2) % 3] });
        }
        sides[static_cast<std::size_t>((face.Front - mesh.FirstSide) % 2)].emplace(
          face.Behind, points);
      }
    }
    EXPECT_FALSE(sides[0].empty());
    EXPECT_TRUE(sides[0] == sides[1]) << axis;
  }
}

/** Return the volume of an object in computational space. */
inline double VolumeOf(const InterfaceMesh& mesh, int object)
{
  return SurfacesOf(mesh).at(object).Volume;
}

/** Return the sum of SurfaceTopology::Euler() over all objects except for 0. */
inline double EulerCharacteristicOf(const InterfaceMesh& mesh)
{
  double sum = 0.;
  for (const auto& [object, surface] : SurfacesOf(mesh))
  {
    sum += object == 0 ? 0. : surface.Euler();
  }
  return sum;
}
}

#endif
