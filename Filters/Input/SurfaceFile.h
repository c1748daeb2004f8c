// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceFile_h
#define volumicSurfaceFile_h

#include "Core/Common/CheckedFile.h"

#include <vtkSmartPointer.h>

class vtkPolyData;

namespace volumic
{
/**
 * Puts a surface of SurfaceOutput.h into a file: points, triangles and all arrays, bit by bit. Text
 * arrays are those of the field data. @throws FileError.
 */
void WriteSurfaceTo(CheckedWriter& file, vtkPolyData* surface);

/** What that wrote. @throws FileError. */
vtkSmartPointer<vtkPolyData> ReadSurfaceFrom(CheckedReader& file);
}

#endif
