// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicGatherSurface_h
#define volumicGatherSurface_h

#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <vector>

class vtkMultiBlockDataSet;
class vtkPolyData;

namespace tool
{
class Ranks;

// Surfaces of which each rank has a piece: each triangle is in one of them; a point that several
// have is the same one by its GlobalIds, which count the points of the whole surface. A rank's
// piece may be null. All ranks make the same calls.

/** How large the whole is. */
struct SurfaceSize
{
  vtkIdType Vertices = 0;
  vtkIdType Triangles = 0;
};

/** The whole, counted; on all ranks. */
SurfaceSize SizeOf(const Ranks& ranks, vtkPolyData* piece);

/** Of each block that the first rank has, or would have. */
std::vector<SurfaceSize> SizesOf(const Ranks& ranks, vtkMultiBlockDataSet* pieces);

/**
 * The whole surface on the first rank, null on the others: the points in the order of their ids,
 * the triangles in that of their own, or, without those, in the order of the ranks. On one rank, and
 * where the first has it all, the surface as it is.
 */
vtkSmartPointer<vtkPolyData> GatherSurface(const Ranks& ranks, vtkPolyData* piece);

/** Each block likewise, under its name. */
vtkSmartPointer<vtkMultiBlockDataSet> GatherBlocks(
  const Ranks& ranks, vtkMultiBlockDataSet* pieces);
}

#endif
