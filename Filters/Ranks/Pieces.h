// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicPieces_h
#define volumicPieces_h

#include <vtkSmartPointer.h>

#include <vector>

class vtkDataObject;
class vtkPolyData;

namespace volumic
{
/** Which piece of a whole. */
struct Cut
{
  int Number = 0;
  int Count = 1;
  int Ghosts = 0;       ///< layers of the others' cells, by common points, that it has as well
  bool IsEmpty = false; ///< nothing but blocks, their names and fields
};

/**
 * A piece of an output, as VTK's filters expect them of a parallel run, with all field data:
 * - of a surface of triangles that follow each other in the whole, all pieces having nearly as
 *   many; points at the border of pieces are in each of them. Its points have `GlobalIds`
 *   (vtkIdType, the attribute): the index in the whole. With ghosts, which come after its own
 *   triangles, points and cells have `vtkGhostType`: duplicates are the triangles of others, and
 *   points of none of its own triangles;
 * - of an image a part of its extent, as VTK cuts images; null where there are more pieces than
 *   voxels for them;
 * - of a table all rows for the first, and for others its columns;
 * - of blocks the pieces of each.
 */
vtkSmartPointer<vtkDataObject> CutData(vtkDataObject* whole, const Cut& cut);

/** What is no ghost in a piece; null of null. */
vtkSmartPointer<vtkPolyData> OwnPartOf(vtkPolyData* piece);

/**
 * A surface, or points, of which each rank has a piece. Of polygons, points at the borders of
 * pieces become one: those of the same global id, which then come in its order, or else those
 * nearer than 1e-6 of the surface's size. What several ranks have alike counts once; what one rank
 * has all of is as given.
 * @param given by rank, without ghosts; those that are null are none
 */
vtkSmartPointer<vtkPolyData> JoinSurfaces(const std::vector<vtkSmartPointer<vtkPolyData>>& given);
}

#endif
