// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/** The command line of BenchmarkSurface. */

#ifndef volumicSurfaceBenchmarkOptions_h
#define volumicSurfaceBenchmarkOptions_h

#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace volumic
{
namespace bench
{

/** A command line that can't be understood; the message tells what is wrong with it. */
class UsageError : public std::invalid_argument
{
public:
  using std::invalid_argument::invalid_argument;
};

/** Which lengths count where voxels are not cubes; the numbers of vtkDeformableSurface::MetricType. */
enum class LengthMetric
{
  Voxels = 0,
  World = 1
};

struct SurfaceBenchmarkOptions
{
  // What is measured on.
  std::string Volume; ///< a .vti, or
  std::string Scene;  ///< the name of a synthetic scene, `SceneSize` voxels along each axis
  int SceneSize = 48;
  double IsoValue = std::numeric_limits<double>::quiet_NaN(); ///< NaN: that of the scene
  bool ObjectIsBright = true;

  // What is run.
  std::vector<std::string> Runs; ///< empty: all that are found but the slow ones
  bool Slow = false;
  bool NoRecovery = false;
  int Repetitions = 0; ///< 0, in the command line only: 5 with Threads, else 1
  LengthMetric Metric = LengthMetric::World; ///< in which surfaces are made
  int Initialization = 0; ///< vtkDeformableSurface::InitializationType
  int CoarsestLevel = -1; ///< -1: the coarsest where there is still something of the object

  // Cost growth instead of the table of runs.
  bool Growth = false;
  // Or one of these.
  bool Model = false;       ///< also of one run
  std::vector<int> Threads; ///< empty: not measured
  bool Peaks = false;       ///< the memory that a volume takes
  std::vector<int> Sizes; ///< of all four; n: as many voxels as n^3 has; 0: the volume as it is

  // What is written.
  bool Profile = false;
  std::string Csv;
  std::string Output;
  bool Help = false;

  // For one run, in a process of its own.
  std::string Run;
  int ResampleTo = 0; ///< n as in Sizes; 0: the volume as it is
  std::string WriteVolume; ///< instead of the run, to this .vti
  bool Judge = true;
  double Delta = 0.0;      ///< by which edges are judged, voxels; 0: not judged
  double EdgeLength = 0.0; ///< for peers that are told how fine to be: the mean, voxels
  long long Vertices = 0;  ///< the same: how many
  double Radius = 0.0;     ///< of CGAL's mesher: the largest surface Delaunay ball, voxels; 0: from
                           ///< EdgeLength
};

/** Throws UsageError. */
SurfaceBenchmarkOptions ParseSurfaceOptions(int argc, char** argv);

/** The command line that makes one run in a process of its own, with the settings of `options`. */
std::vector<std::string> ArgumentsOfRun(const SurfaceBenchmarkOptions& options);

/** A run of ours on the volume at a size, of which nothing is judged or written. */
SurfaceBenchmarkOptions OursAt(
  const SurfaceBenchmarkOptions& options, const std::string& run, int size);

/** Of options.Sizes, for people. */
std::string NameOfSize(int size);

/** What --help prints. */
std::string SurfaceUsage();

} // namespace bench
} // namespace volumic

#endif
