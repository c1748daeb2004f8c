// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/** One run of the benchmark: us, or a peer, on the volume, measured and judged. */

#ifndef volumicSurfaceRuns_h
#define volumicSurfaceRuns_h

#include "RunFigures.h"
#include "SurfaceBenchmarkOptions.h"
#include "SurfaceBenchmarkVolume.h"
#include "SurfaceJudge.h"

#include <functional>
#include <string>
#include <vector>

namespace volumic::bench
{

/** The run options.Run. Figures, with lengths in the metric of the run:
   - WallSeconds, ProcessorSeconds, BaseMegabytes (resident before), PeakMegabytes;
   - those of SetVerdict and SetFit, and Fingerprint (text), the same for the same bits;
   - ours: CoarsestLevel, PyramidSeconds, Iterations, VertexIterations (vertices summed over the
   iterations), StopReason (text), Level, Delta, Levels (the number of levels) and, as
   `level.h.NAME`, what there is of each level: Iterations, Seconds, VertexIterations, Delta,
   LostParts, RecoveredParts, the verdict, and the columns of the history that hold the seconds of
   phases
     (`Phases`: their names in one text, with commas); with Model what SetModel sets;
   - the mesher's: Radius.
   Throws what the libraries throw, std::runtime_error where there is no surface. */
RunFigures MeasureSurfaceRun(const SurfaceBenchmarkOptions& options);

/** WallSeconds, ProcessorSeconds, BaseMegabytes and PeakMegabytes of `work`. */
void MeasureCost(const std::function<void()>& work, RunFigures& figures);

/** The judge's figures, each name with `prefix` before it. Edges outside [Delta, 2.5 Delta] and
    pairs too near only if `delta` is positive. */
void SetVerdict(const support::TriangleSurface& surface, double delta, const std::string& prefix,
  RunFigures& figures);

/** The same: how well-shaped the triangles are and how the surface fits the volume, in whose index
    coordinates it is, in both metrics (names that begin with Voxels and World; without either, that
    of the run). `world`: the steps of the volume in the metric of the world. */
void SetFit(const support::TriangleSurface& surface, support::JudgedVolume volume,
  LengthMetric metric, const std::array<double, 3>& world, const std::string& prefix,
  RunFigures& figures);

/** A hash of all bits of the points and triangles. */
std::string Fingerprint(const support::TriangleSurface& surface);

/** vtkDeformableSurface: the run options.Run of those that are ours. */
RunFigures MeasureOurs(const BenchmarkedVolume& volume, const SurfaceBenchmarkOptions& options);

/** The image as the judge wants it, without a copy; it has to be float and to stay alive. */
support::JudgedVolume ToJudgedVolume(vtkImageData* inAir, const BenchmarkedVolume& volume);

/** As float, as it is or in air. */
vtkSmartPointer<vtkImageData> AsFloat(vtkImageData* image);

} // namespace volumic::bench

#endif
