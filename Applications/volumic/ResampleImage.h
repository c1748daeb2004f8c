// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicResampleImage_h
#define volumicResampleImage_h

#include "VolumeImage.h"

#include <vtkSmartPointer.h>

class vtkImageData;

namespace tool
{
class Announcer;
struct ToolOptions;

/**
 * The active scalars on a grid with this spacing (world units) that fills the same box, from outer
 * face to outer face of the voxels, as nearly as whole voxels do: the rest is shared by both ends.
 * Labels are those of the nearest voxel; other values are interpolated linearly, as float.
 */
vtkSmartPointer<vtkImageData> Resampled(
  vtkImageData* image, const Vector3& spacing, bool areLabels);

/** What --region or --region-box leaves of the image. @throws Failure if it lies beside it */
void CropAsAsked(const ToolOptions& options, vtkSmartPointer<vtkImageData>& image);

/**
 * What --resample or --isotropic asks for, and, of values, what an image of fewer than eight voxels
 * along an axis needs to have a surface; it is told, and is in the fact `Resampling`. With neither
 * the image stays. @param areLabels see Resampled
 */
void ResampleAsAsked(const ToolOptions& options, bool areLabels,
  vtkSmartPointer<vtkImageData>& image, const Announcer& announcer);
}

#endif
