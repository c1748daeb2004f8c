// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/** What a run of BenchmarkSurface is told. */

#ifndef volumicSurfaceBenchmarkOptions_h
#define volumicSurfaceBenchmarkOptions_h

#include <limits>
#include <string>

namespace volumic::bench
{

/** Which lengths count where voxels are not cubes; the numbers of vtkDeformableSurface::MetricType. */
enum class LengthMetric
{
  Voxels = 0,
  World = 1
};

struct SurfaceBenchmarkOptions
{
  std::string Run;

  // What is measured on.
  std::string Volume; ///< a .vti, or
  std::string Scene;  ///< the name of a synthetic scene, `SceneSize` voxels along each axis
  int SceneSize = 48;
  double IsoValue = std::numeric_limits<double>::quiet_NaN(); ///< NaN: that of the scene
  bool ObjectIsBright = true;
  int ResampleTo = 0;      ///< n: as many voxels as n^3 has; 0: the volume as it is
  std::string WriteVolume; ///< instead of the run, to this .vti

  // How it is run.
  LengthMetric Metric = LengthMetric::World; ///< in which surfaces are made
  int Initialization = 0;                    ///< vtkDeformableSurface::InitializationType
  int CoarsestLevel = -1;  ///< -1: the coarsest where there is still something of the object
  double EdgeLength = 0.0; ///< for peers that are told how fine to be: the mean, voxels
  long long Vertices = 0;  ///< the same: how many
  double Radius = 0.0; ///< of CGAL's mesher: the largest surface Delaunay ball, voxels; 0: from EdgeLength
  bool Model = false;  ///< by a WorkModel in the place of its threads

  // What is told and written.
  bool Judge = true;
  bool Profile = false;
  std::string Output; ///< a .vtp
};

} // namespace volumic::bench

#endif
