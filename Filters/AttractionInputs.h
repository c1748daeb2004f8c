// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicAttractionInputs_h
#define volumicAttractionInputs_h

#include "Core/Common/Monitor.h"
#include "Core/Image/PointAttraction.h"
#include "PyramidLevels.h"
#include "Workspace.h"

#include <vtkSmartPointer.h>

#include <array>
#include <memory>
#include <vector>

class vtkInformation;
class vtkMultiBlockDataSet;
class vtkPolyData;

namespace volumic
{
/**
 * The points of input port 2 of vtkDeformableSurface (PointsMeantBy); point arrays `Weight` and
 * `Radius` (world units), both optional.
 * @param size voxels of level 0 along each axis
 * @throws std::invalid_argument for cells without vertices, a point outside the image, an array that is not numbers of one
 *         component, a negative or infinite weight or radius.
 */
std::vector<AttractingPoint> AttractingPointsOf(
  vtkPolyData* polyData, const Workspace& space, const std::array<int, 3>& size);

/**
 * The levels of the map of edges. Where all blocks carry the array these are taken; else the
 * pyramid of the array of block 0 is made, by the factor that the blocks tell.
 */
class EdgeLevels
{
public:
  /**
   * @param blocks    the levels of the voxels
   * @param selection of the map, as GetInputArrayInformation()
   * @param goOn      asked where the map's pyramid is made; after false there are no levels
   * @throws std::invalid_argument if no array is selected or block 0 has none of that name.
   */
  EdgeLevels(vtkMultiBlockDataSet* blocks, vtkInformation* selection, int numberOfThreads,
    const Checkpoint& goOn);

  /// The voxels of the map, for LevelImage::Edges; valid until the next call.
  /// @throws std::invalid_argument if the level has not the size of the voxels'.
  const float* Load(int level, const std::array<int, 3>& size, Executor& executor);

private:
  vtkSmartPointer<vtkMultiBlockDataSet> Blocks;
  std::unique_ptr<PyramidLevels> Levels;
};
}

#endif
