// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfacePieces_h
#define volumicSurfacePieces_h

#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <vector>

class vtkPolyData;

namespace volumic
{
/**
 * Cuts a surface into a piece for each rank, as VTK's filters expect them of a parallel run: each
 * triangle in one piece, points at the border of pieces in each of them, at the same place.
 * Triangles of a piece follow each other in the whole; all pieces have nearly as many.
 */
class SurfacePieces
{
public:
  /**
   * @param whole       triangles with any arrays; must outlive the object; null: there is none
   * @param ghostLevels layers of the triangles of other pieces, by common points, that a piece has
   *                    as well, after its own
   */
  SurfacePieces(vtkPolyData* whole, int numberOfPieces, int ghostLevels);

  /**
   * A piece, which may be empty, with all arrays and field data of the whole. Its points, in the
   * order of the whole, have `GlobalIds` (vtkIdType, the attribute): the index in the whole. With
   * ghost levels points and cells have `vtkGhostType`: duplicates are the triangles of others, and
   * points of none of its own triangles.
   */
  vtkSmartPointer<vtkPolyData> Piece(int number) const;

private:
  std::vector<vtkIdType> TrianglesOf(int number, vtkIdType& numberOfOwn) const;

  vtkPolyData* Whole;
  int NumberOfPieces;
  int GhostLevels;
  // Triangles of each point, one after the other; only where there are ghost levels.
  std::vector<vtkIdType> FirstOfPoint;
  std::vector<vtkIdType> TrianglesOfPoints;
};
}

#endif
