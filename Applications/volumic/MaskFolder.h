// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicToolMaskFolder_h
#define volumicToolMaskFolder_h

#include "ReadVolume.h"

#include <vtkSmartPointer.h>

#include <string>
#include <vector>

class vtkImageData;

namespace tool
{
/** The volumes among the files of a folder that are masks if there are any, by their names. */
std::vector<std::string> MasksAmong(const std::vector<std::string>& files);

/**
 * A label map of masks, as TotalSegmentator writes one for each organ: the first is label 1, and so
 * on, named as its file. A voxel of several has the label of the smallest of them, as small organs
 * lie within large ones; how many such there are is told.
 * @throws Failure that names the file which is no mask, or does not lie as the first.
 */
vtkSmartPointer<vtkImageData> ReadMasks(
  const std::vector<std::string>& files, const VolumeChoice& all);

/**
 * The same of so many masks in one file, one behind the other: "one-hot". They have no names.
 * @param first that has been read
 */
vtkSmartPointer<vtkImageData> ReadMasksOf(
  const std::string& file, vtkImageData* first, int count, VolumeChoice choice);
}

#endif
