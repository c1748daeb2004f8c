// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/** The runs of BenchmarkLabels: us, or a peer, on labels of a map, measured and judged. */

#ifndef volumicLabelRuns_h
#define volumicLabelRuns_h

#include "LabelShapes.h"
#include "RunFigures.h"
#include "TriangleSurface.h"

#include <functional>
#include <string>
#include <vector>

namespace volumic::bench
{

struct LabelSettings
{
  int Threads = 1;         ///< of ours; peers have one
  double Smoothing = -1.0; ///< of ours; negative: as it comes
  double VoxelTolerance = -1.0; ///< of ours; negative: as it comes
  double Gap = 0.0;        ///< of ours, in smallest distances of voxels
  int FinestLevel = 0;     ///< of ours
  int Repetitions = 1;     ///< of what is measured, of which the fastest counts
};

/** us: all labels in one run; us-gap: the same with Settings.Gap. us-alone and the peers: a label
    by itself, cut out. */
std::vector<std::string> LabelRunNames();

struct LabelSurface
{
  int Label = 0;
  support::TriangleSurface Surface; ///< world
  double Delta = 0.0;               ///< ours: 0 where there is no surface, and of peers
  double ReportedWrong = 0.0;       ///< ours: WrongVoxels
};

/** vtkLabelsToSurfaces on the whole map, a surface for each label asked for. Sets Seconds (of the
    clock), ProcessorSeconds and, of the whole process, PeakMegabytes. Throws std::runtime_error for
    its errors. */
std::vector<LabelSurface> OurSurfaces(const support::LabelMap& map, const std::vector<int>& labels,
  const LabelSettings& settings, RunFigures& figures);

/** us-alone on the label with 8 voxels about it, a peer with as many as it needs. `edgeLength`: for
    those that are told. Sets Seconds and ProcessorSeconds. Throws std::runtime_error. */
LabelSurface SurfaceAlone(const std::string& run, const support::LabelMap& map, int label,
  double edgeLength, const LabelSettings& settings, RunFigures& figures);

/** What SurfaceJudge.h and LabelJudge.h say of it, as figures. Lengths in the smallest distance of
    two voxels. `shape`: may be null. */
void SetLabelVerdict(const LabelSurface& surface, const support::LabelMap& map,
  const support::LabelShape* shape, RunFigures& figures);

/** All neighbours: OverlapPairs (of surfaces with boxes that overlap), OverlapVertices,
    OverlapMean, OverlapLargest (depths in smallest distances of voxels), OverlapIntersections. */
void SetOverlap(const std::vector<LabelSurface>& surfaces, double unit, RunFigures& figures);

} // namespace volumic::bench

#endif
