// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicReport_h
#define volumicReport_h

#include "LabelMap.h"
#include "SurfaceFacts.h"
#include "SurfaceProperties.h"
#include "Tetrahedra.h"
#include "VolumeFacts.h"
#include "WriteOutputs.h"

#include <iosfwd>
#include <string>
#include <vector>

class vtkPolyData;

namespace tool
{
/**
 * All that a report tells; the names in it are those of the quickstart's report.json, and besides
 * `finished` (false: interrupted, at the time or the iteration limit) and `properties`.
 */
struct ReportInput
{
  std::string VolumeName;
  VolumeFacts Volume;
  FilterTrio Filters;
  std::string StopReason; ///< of the surface
  bool IsFinished = false;
  double PyramidSeconds = 0.0;
  double SurfaceSeconds = 0.0;
  double ReaderMemory = 0.0; ///< PeakMemory() when the volume had been read
  std::vector<std::string> Warnings;
  vtkSmartPointer<vtkPolyData> Surface; ///< as it is written
  SurfaceSize Size;                     ///< of the surface
  std::vector<SurfaceSize> LevelSizes;  ///< by block of the levels
  Solid Filling;                        ///< made of it, if it was
};

/** The report as JSON. Lengths, areas and volumes are in world units. */
std::string ReportText(const ReportInput& input);

/** What tetrahedra are like, in a line. */
std::string TextOf(const Solid& solid);

/** The most memory that was resident so far, MiB. */
double PeakMemory();

// ---- Labels -------------------------------------------------------------------------------------

/** All that a report of labels tells; names in it are those of ReportText where it has them. */
struct LabelReport
{
  std::string VolumeName;
  VolumeFacts Volume;
  FilterTrio Filters;
  const std::vector<LabelSurface>& Surfaces;
  bool IsFinished = false;
  double Seconds = 0.0;      ///< of the surfaces
  double ReaderMemory = 0.0; ///< PeakMemory() when the volume had been read
  std::vector<std::string> Warnings = {};
  Solid Filling = {}; ///< made of the interfaces, if it was
};

/** The report as JSON, `labels` with an object for each surface. */
std::string ReportText(const LabelReport& report);

/** Of a surface's field data: voxel centres on the wrong side; 0 where that is not told. */
vtkIdType WrongVoxels(vtkPolyData* surface, const char* name = "WrongVoxels");

// ---- The list of labels -------------------------------------------------------------------------

/** What --list-labels tells; names in it are those of LabelReport where it has them. */
struct LabelList
{
  std::string VolumeName;
  VolumeFacts Volume;
  int Layers = 1;
  std::vector<KnownLabel> Labels = {};
  std::vector<std::string> Warnings = {};
};

/** As a table for the eye, a line for each label below a heading. */
void WriteTable(std::ostream& out, const LabelList& list);

/** As JSON, `labels` with an object for each. */
std::string ReportText(const LabelList& list);
}

#endif
