// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSegmentationLevels_h
#define volumicSegmentationLevels_h

#include "Core/Common/Executor.h"
#include "Core/Image/LevelImage.h"
#include "Core/Image/PointAttraction.h"
#include "Pyramid/PyramidLevels.h"
#include "Run/ReadVolume.h"
#include "Settings/SegmentationSettings.h"

#include <array>
#include <map>
#include <memory>
#include <vector>

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
  /**
   * Takes the points that the settings give a weight, too.
   * @throws if a surface cannot evolve on them, or there is no such Metric.
   */
  SegmentationLevels(const SegmentationRequest& request, const Volume& volume);

  bool HasPoints() const { return this->Points != nullptr; }
  const PyramidLevels& Pyramid() const { return this->Voxels; }
  const Workspace& GetWorkspace() const { return this->Voxels.GetWorkspace(); }
  void SetFactorBelowLevel0(double factor) { this->Voxels.SetFactorBelowLevel0(factor); }

  /** Smallest and largest voxel of a level; the first is the larger one if none is valid. */
  std::array<double, 2> Range(int level) const;

  /**
   * Whether a surface that starts at a level finds something that it is to hold there: with
   * recovery a part that this would enclose, else one that is thick enough for it. Looks once at a
   * level, so the options must be the same always.
   */
  bool HoldsObject(int level, const SurfaceOptions& options) const;

  /** The field of a level, whose voxels must be here still; valid until the next call. */
  LevelImage Load(int level, const SurfaceOptions& options, Executor& threads);

  /**
   * Lets go of the voxels of coarser levels (PyramidLevels::AllLevels: of all), and of what Load()
   * gave last: what was asked of them stays known.
   */
  void ReleaseCoarserThan(int level);

private:
  void ReadPoints(const SegmentationRequest& request);
  /** For LevelImage::Edges. @throws where the level has not the size of the voxels'. */
  VoxelValues LoadEdges(int level, const std::array<int, 3>& size, Executor& threads);

  PyramidLevels Voxels;
  std::unique_ptr<PointAttraction> Points; ///< null: none
  std::unique_ptr<PyramidLevels> Edges;    ///< of the map of edges; null: none
  std::vector<float> Bent;                 ///< the level's voxels as the points bend them
  mutable std::map<int, bool> Holds;       ///< what HoldsObject() has found
};
}

#endif
