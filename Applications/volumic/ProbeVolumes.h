// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicProbeVolumes_h
#define volumicProbeVolumes_h

#include <vtkSmartPointer.h>

#include <string>
#include <utility>
#include <vector>

class vtkImageData;
class vtkPolyData;

namespace tool
{
class Announcer;
struct ToolOptions;

/** The volumes of --probe, in whatever grid, whose values surfaces get. */
class ProbeVolumes
{
public:
  /** Reads them. @throws Failure that names the one that cannot be read, or has no place of its own */
  ProbeVolumes(const ToolOptions& options, const Announcer& announcer);

  /**
   * Give the surface a point array for each, named as its file: the values there, interpolated
   * linearly, with a depth their mean from each vertex so far inward along its normal; NaN where the
   * volume does not reach.
   */
  void AddTo(vtkPolyData* surface) const;

private:
  std::vector<std::pair<std::string, vtkSmartPointer<vtkImageData>>> Volumes;
  double Depth = 0.0; ///< world units
};
}

#endif
