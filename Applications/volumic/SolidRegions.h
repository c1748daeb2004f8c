// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSolidRegions_h
#define volumicSolidRegions_h

#include "SurfaceFacts.h"
#include "VolumeImage.h"

#include <vtkBoundingBox.h>

#include <array>
#include <cstddef>
#include <vector>

class vtkPolyData;

namespace tool
{
/** A connected part of space, bounded by triangles. */
struct SolidRegion
{
  int Label = -1;                     ///< which of SolidRegions::Labels; -1: of none, it is empty
  Vector3 Inside = { 0.0, 0.0, 0.0 }; ///< a point in it, off its boundary; none of the outermost
};

/**
 * What meshers of solids have to know: the connected regions into which triangles part space.
 * Region 0 is the outermost one, all others are bounded; those of labels come first, in their
 * order.
 */
struct SolidRegions
{
  struct Triangle
  {
    std::array<vtkIdType, 3> Corners;
    int Behind;  ///< the region that its normal points away from: one of a label
    int InFront; ///< the other one
  };
  std::vector<SurfaceLabel> Labels;
  std::vector<SolidRegion> Regions;
  std::vector<Triangle> Triangles;

  /** Whether a label fills it. */
  bool IsSolid(std::size_t region) const { return this->Regions[region].Label >= 0; }
};

/**
 * The regions of the output `Interfaces` of vtkLabelsToSurfaces, or, without `BoundaryLabels`, of a
 * closed surface, of one label then, with the label's name or `object`.
 * @throws Failure, without the name of a file, if the triangles do not part space.
 */
SolidRegions FindRegions(vtkPolyData* surface);

// ---- Shells -------------------------------------------------------------------------------------

// Each triangle t has two sides: side 2 t is behind it, 2 t + 1 in front of it, where its normal
// points. Sides that face each other across a wedge of an edge are of the same region of space;
// those that are joined so make a shell: the outer boundary of a region, or that of a cavity in it.
using Side = std::size_t;

using Corners = std::array<Vector3, 3>;

struct Shell
{
  int Label;           ///< which of LabelledTriangles::Labels; -1: none
  double Volume = 0.0; ///< enclosed by it, negative if the region is about it
  vtkBoundingBox Box = {};
  std::vector<Side> Sides = {};
};

/** The triangles of a surface, or of interfaces, with a label or none on each side. */
class LabelledTriangles
{
public:
  /** Interfaces have `BoundaryLabels`; of others one label is behind. @throws Failure if it has
   * none */
  explicit LabelledTriangles(vtkPolyData* surface);

  /** In the order of their first sides. @throws Failure if the triangles do not part space */
  std::vector<Shell> FindShells();

  const Vector3& Place(vtkIdType point) const
  {
    return this->Places[static_cast<std::size_t>(point)];
  }
  /** Those of its triangle, in the order that makes the normal point out of the side's region. */
  Corners CornersOf(Side side) const;

  std::vector<SurfaceLabel> Labels;
  std::vector<std::array<vtkIdType, 3>> Triangles;

private:
  struct EdgeUse;

  void ReadLabels(vtkPolyData* surface);
  void ReadTriangles(vtkPolyData* surface);
  void JoinSides();
  void JoinAbout(std::vector<EdgeUse>& uses);
  void SortAbout(std::vector<EdgeUse>& uses) const;
  Side RootOf(Side side);
  void Join(Side a, Side b);

  std::vector<Vector3> Places; ///< of points
  std::vector<int> LabelOf;    ///< of each side
  std::vector<Side> Parents;   ///< of each side, up to the first one of its shell
};

Vector3 Minus(const Vector3& a, const Vector3& b);

/** The number of each label in files: its own, or one that no label has where that is not positive.
 */
std::vector<int> SolidNumbers(const std::vector<SurfaceLabel>& labels);
}

#endif
