// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLabelReport_h
#define volumicLabelReport_h

#include "LabelChoice.h"
#include "LabelOutputs.h"
#include "SurfaceProperties.h"
#include "VolumePart.h"

#include <iosfwd>
#include <string>
#include <vector>

namespace tool
{
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
  std::vector<double> PeaksByRank = {};
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
