// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSegmentationLevels_h
#define volumicSegmentationLevels_h

#include "Core/Common/Executor.h"
#include "Core/Image/LevelImage.h"
#include "Core/Image/PointAttraction.h"
#include "Input/Workspace.h"
#include "Pyramid/PyramidLevels.h"
#include "Settings/SegmentationSettings.h"

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

class vtkDataObject;

namespace volumic
{
/**
 * The levels of a volume as a surface evolves on them: the voxels as attracting points bend them,
 * and the map of edges. Errors are std::invalid_argument; messages name the port or the property.
 *
 * A level is asked for from the coarsest on: what ReleaseCoarserThan() has let go of cannot be
 * loaded again. All is called on one thread; `threads` share the loops over voxels.
 */
class SegmentationLevels
{
public:
  /** @throws if the blocks are not the levels of a pyramid, or there is no such Metric. */
  explicit SegmentationLevels(const SegmentationRequest& request);
  ~SegmentationLevels();

  /** Once, before Load(): takes the points and the map of edges that the settings give a weight. */
  void ReadAttraction(const SegmentationRequest& request);
  bool HasPoints() const { return this->Points != nullptr; }

  const PyramidLevels& Pyramid() const { return this->Voxels; }
  const Workspace& GetWorkspace() const { return this->Voxels.GetWorkspace(); }

  /** U_h in world units. */
  double UnitInWorld(int level) const { return this->Voxels.UnitInWorld(level); }
  void SetFactorBelowLevel0(double factor) { this->Voxels.SetFactorBelowLevel0(factor); }

  /** Smallest and largest voxel of a level; the first is the larger one if none is valid. */
  std::array<double, 2> Range(int level) const;

  /**
   * Whether a surface that starts at a level finds something that it is to hold there: with
   * recovery a part that this would enclose, else one that is thick enough for it. Looks once at a
   * level, so the options must be the same always.
   */
  bool HoldsObject(int level, const SurfaceOptions& options) const;

  /** What is to be reported of the NaN voxels of level 0; empty: nothing, or it has been. */
  std::string DescribeUnreportedNaNs() const;

  /** The field of a level, whose voxels must be here still; valid until the next call. */
  LevelImage Load(int level, const SurfaceOptions& options, Executor& threads);

  /**
   * Lets go of the voxels of coarser levels (AllLevels: of all), and of what Load() gave last: what
   * was asked of them stays known.
   */
  void ReleaseCoarserThan(int level);
  bool HasVoxels(int level) const { return this->Voxels.HasVoxels(level); }

private:
  /** For LevelImage::Edges. @throws where the level has not the size of the voxels'. */
  VoxelValues LoadEdges(int level, const std::array<int, 3>& size, Executor& threads);

  bool MayHaveUnreportedNaNs;
  PyramidLevels Voxels;
  std::unique_ptr<PointAttraction> Points; ///< null: none
  /**
   * Of the map of edges. Where all blocks carry the array these are taken; else the pyramid of the
   * array of block 0 is made, by the factor that the blocks tell. Null: none, or after a stop.
   */
  std::unique_ptr<PyramidLevels> Edges;
  std::vector<float> Bent;           ///< the level's voxels as the points bend them
  mutable std::map<int, bool> Holds; ///< what HoldsObject() has found
};

/** Whom the making of the levels tells. */
struct VoxelSource
{
  /** Told the share that is done, and what is being done; false asks to stop. */
  std::function<bool(double share, const char* text)> GoOn;
  /** Told what is worth a warning of port 0 once in a filter's life, or nothing; `what` says which.
   */
  std::function<void(const char* what, const std::string& text)> WarnOnce;
};

/** Whether the data of input port 0 are an image, of which the levels are still to be made. */
bool IsImage(vtkDataObject* input);

/**
 * Sets the levels of a request, of the data of input port 0, and what its settings find for them.
 * After a stop they are null.
 * @throws std::invalid_argument naming the port or the property
 */
void SetLevels(SegmentationRequest& request, vtkDataObject* input, const VoxelSource& source);
}

#endif
