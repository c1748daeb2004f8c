// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSegmentationLevels_h
#define volumicSegmentationLevels_h

#include "Core/Common/Executor.h"
#include "Core/Common/IndexedSurface.h"
#include "Core/Image/LevelImage.h"
#include "Core/Image/PointAttraction.h"
#include "Pyramid/PyramidLevels.h"
#include "Run/ReadVolume.h"
#include "Settings/SegmentationSettings.h"

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <vector>

namespace volumic
{
/**
 * The levels on which a surface evolves: the voxels, modified by attracting points, and the edge
 * map. Errors are InvalidArgument exceptions whose messages name the port or the property.
 *
 * Load the levels from the coarsest to the finest. Released levels cannot be loaded again. Call all
 * methods on one thread.
 */
class SegmentationLevels
{
public:
  /**
   * Read the attracting points and the seeds, too.
   * @throws InvalidArgument if the volume is too small or a setting is out of range
   */
  SegmentationLevels(const SegmentationRequest& request, const Volume& volume);

  bool HasPoints() const { return this->Points != nullptr; }
  const PyramidLevels& Pyramid() const { return this->Voxels; }
  const ComputationalSpace& GetComputationalSpace() const
  {
    return this->Voxels.GetComputationalSpace();
  }
  void SetFactorBelowLevel0(double factor) { this->Voxels.SetFactorBelowLevel0(factor); }

  /** Return the range of the valid voxels of a level, in reverse order if none is valid. */
  std::array<double, 2> Range(int level) const;

  /**
   * Return whether the object has a part at this level with MinimumPartSize voxels, or, without
   * recovery, a part that is thick enough for a surface. The result of a level is cached, so the
   * options must not change.
   */
  bool ContainsObject(int level, const SurfaceOptions& options) const;

  /**
   * Remove the seeds outside the object at level 0, and test the others at all levels from
   * `coarsest` on. Only the first call has an effect.
   * @throws InvalidArgument if a seed is outside the image, or if all are outside the object
   */
  void TestSeeds(const SegmentationSettings& settings, int coarsest, Executor& threads);
  /** Return the seeds in computational space. */
  const std::vector<Point>& Seeds() const { return this->SeedPoints; }
  /** Return the number of seeds inside the object at a level that TestSeeds() has tested. */
  std::size_t SeedsInside(int level) const { return this->Inside[static_cast<std::size_t>(level)]; }

  /** Return the voxels of a level that is not released. They are valid until the next call. */
  LevelImage Load(int level, const SurfaceOptions& options, Executor& threads);

  /**
   * Release the voxels of coarser levels (of all levels for PyramidLevels::AllLevels) and the
   * result of the last Load(). Cached results remain.
   */
  void ReleaseCoarserThan(int level);

private:
  void ReadPoints(const SegmentationRequest& request);
  void ReadSeeds(const SegmentationRequest& request);
  /**
   * Return LevelImage::Edges. @throws InvalidArgument if the sizes of edge map and voxels differ
   */
  VoxelValues LoadEdges(int level, const std::array<int, 3>& size, Executor& threads);

  PyramidLevels Voxels;
  std::unique_ptr<PointAttraction> Points; ///< null: none
  std::unique_ptr<PyramidLevels> Edges;    ///< of the edge map; null: none
  std::vector<float> Modified;             ///< voxels of the level, modified by the points
  mutable std::map<int, bool> HasObject;   ///< cached results of ContainsObject()
  std::vector<Point> SeedPoints;           ///< computational space
  const char* SeedErrorPrefix = "";        ///< prefix of errors
  std::vector<std::size_t> Inside;         ///< results of TestSeeds(), by level
};
}

#endif
