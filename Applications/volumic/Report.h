// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicReport_h
#define volumicReport_h

#include "GatherSurface.h"
#include "SurfaceProperties.h"
#include "VolumePart.h"

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

class vtkPolyData;

namespace tool
{
class Ranks;

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
  SurfaceSize Size;                    ///< of the surface, of all ranks
  std::vector<SurfaceSize> LevelSizes; ///< by block of the levels
  std::vector<double> PeaksByRank;     ///< as the function gives them
};

/** The report as JSON. Lengths, areas and volumes are in world units. */
std::string ReportText(const ReportInput& input);

// ---- Parts of reports ---------------------------------------------------------------------------

using Json = nlohmann::ordered_json;

/** The member `input`: what the volume is. */
Json InputFacts(const std::string& name, const VolumeFacts& volume);

/** Members of the size and shape of a surface, from its field data. */
void AddSurfaceFacts(Json& json, vtkPolyData* surface, const SurfaceSize& size);

/** The member `component_features`: an object per component, the one of the largest area first. */
Json ComponentFeatures(vtkPolyData* surface);

/** The member `properties`: those that are meant, with their values. */
Json PropertyValues(const FilterTrio& filters, bool (*isMeant)(const PropertyOption&));

/** The member `memory`. @param reader PeakMemory() when the volume had been read */
Json MemoryFacts(double reader, const std::vector<double>& byRank);

/** The report with the members `warnings` and `versions` at its end, as text. */
std::string EndedReport(Json& json, const std::vector<std::string>& warnings);

/** The most memory that was resident so far, MiB. */
double PeakMemory();

/** That of each rank, by all of them; nothing where there is one only. */
std::vector<double> PeaksByRank(const Ranks& ranks);
}

#endif
