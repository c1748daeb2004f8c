// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicStreamedWriters_h
#define volumicStreamedWriters_h

#include "ProgressLine.h"

#include <vtkSmartPointer.h>

#include <string>

class vtkImageData;
class vtkPolyData;

namespace tool
{
// The writers of VTK's own formats, with a full disk told (see FileBuffer) and no memory but some
// megabytes, whatever the size of what they write. All throw a Failure without the file's name.

/** The surface as .vtp; its cells are triangles. */
void WriteVtp(vtkPolyData* surface, const std::string& path, ProgressLine& line);

/** The surface in VTK's legacy format, binary. */
void WriteLegacy(vtkPolyData* surface, const std::string& path, ProgressLine& line);

/** The volume as .vti. */
void WriteVti(vtkImageData* volume, const std::string& path, ProgressLine& line);

/**
 * The surface again, its arrays shared, which knows that its cells are triangles: VTK's writers make
 * a table of the types of the cells of others, eight bytes each.
 */
vtkSmartPointer<vtkPolyData> AsTriangles(vtkPolyData* surface);
}

#endif
