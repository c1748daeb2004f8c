// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicVolumeFacts_h
#define volumicVolumeFacts_h

#include "VolumeImage.h"
#include "WorldSpace.h"

#include <array>
#include <limits>
#include <string>

class vtkDataArray;
class vtkImageData;
class vtkInformation;

namespace tool
{
/** What a volume is, without its voxels. */
struct VolumeFacts
{
  std::array<int, 6> Extent = { 0, -1, 0, -1, 0, -1 };
  Vector3 Spacing = { 1.0, 1.0, 1.0 };
  Vector3 Origin = { 0.0, 0.0, 0.0 };
  WorldSpace World;       ///< that Spacing and Origin are in
  std::string Resampling; ///< how it was made a regular grid; empty: it was one
  int Type = 0;           ///< of the voxels, as VTK numbers types
  int Components = 1;
  /** Of the selected component: the smallest and the largest. */
  std::array<double, 2> Range = { std::numeric_limits<double>::infinity(),
    -std::numeric_limits<double>::infinity() };

  std::array<int, 3> Size() const;
};

/** Of an image that is there, and these of its arrays. */
VolumeFacts FactsOf(vtkImageData* image, vtkDataArray* scalars, int component);

/** What a source tells of its voxels, empty: of its active scalars; null: nothing. */
vtkInformation* VoxelsIn(vtkInformation* info, const std::string& array);

/** How many components that says; 1: nothing. */
int ComponentsIn(vtkInformation* voxels);
}

#endif
