// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/** The volumes that are measured on. */

#ifndef volumicBenchmarkVolume_h
#define volumicBenchmarkVolume_h

#include <vtkImageData.h>
#include <vtkSmartPointer.h>

#include <string>

namespace volumic::bench
{

/** Reads a .vti as int16, the type of a CT, whatever type the file has: all programs that are
   compared then get the same voxels. Throws std::runtime_error where it can't be read, has no
   scalars, or values that do not fit. */
vtkSmartPointer<vtkImageData> ReadVolume(const std::string& file);

/** int16, `size` voxels along each axis, spacing 1: shells around the middle and noise. */
vtkSmartPointer<vtkImageData> GenerateVolume(int size);

} // namespace volumic::bench

#endif
