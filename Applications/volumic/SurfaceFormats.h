// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceFormats_h
#define volumicSurfaceFormats_h

#include "ProgressLine.h"

#include <functional>
#include <string>

class vtkPolyData;

namespace tool
{
/** A surface, and all that is told to a writer of it. */
struct SurfaceFile
{
  vtkPolyData* Surface;
  std::string Path;
  std::string Remark;
  int PieceSize;
  ProgressLine& Line;
};

/** How files with a suffix are written. Both throw a Failure without the name of the file. */
struct SurfaceFormat
{
  std::function<void(const SurfaceFile&)> Write;
  /** Looks whether the disk took it all; null where that was seen at once. */
  std::function<void(const SurfaceFile&)> Check;
};

/** Null: no writer has this suffix. */
const SurfaceFormat* FindSurfaceFormat(const std::string& name);
}

#endif
