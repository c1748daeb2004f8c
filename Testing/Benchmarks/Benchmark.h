// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/** What the parts of the program Benchmark share: see Benchmark.cxx. */

#ifndef volumicBenchmark_h
#define volumicBenchmark_h

#include "SurfaceJudge.h"

#include <vtkImageData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

class vtkImagePyramid;

namespace volumic::bench
{

/** The words NAME=VALUE of the command line. */
class Options
{
public:
  explicit Options(const std::vector<std::string>& words);

  std::string Text(const std::string& name, const std::string& otherwise = "") const;
  double Number(const std::string& name, double otherwise) const;
  int Integer(const std::string& name, int otherwise) const;
  std::vector<std::string> List(const std::string& name, const std::string& otherwise) const;

private:
  std::map<std::string, std::string> Values;
};

/** Numbers and texts by name; written in lines "@NAME VALUE". */
class Figures
{
public:
  void Set(const std::string& name, double value);
  void SetText(const std::string& name, const std::string& text) { this->Values[name] = text; }
  void Write() const;

private:
  std::map<std::string, std::string> Values;
};

/** Sets Seconds and ProcessorSeconds, the fastest of the repetitions, for each of so many things
   that it makes, PeakMegabytes, what the process had resident at most, and GrownBytes, how much
   more than before. */
void Measure(
  const std::function<void()>& work, int repetitions, Figures& figures, std::size_t things = 1);

/** A .vti, .nii or .nii.gz with scalars of one component. */
vtkSmartPointer<vtkImageData> ReadImage(const std::string& file);

/** What a peer does, which is measured, and then what it made. The image has to live as long. */
struct Job
{
  std::function<void()> Work;
  std::function<support::TriangleSurface()> Result;
};

/** Its triangles without points that no triangle has: they must not count as reached. */
support::TriangleSurface TrianglesOf(vtkPolyData* surface);

vtkImageData* LevelOf(vtkImagePyramid* pyramid, unsigned int level);

/** A number of its field data; 0 where there is none. */
double Field(vtkPolyData* surface, const char* name);

/** Sets what the surface is by itself, in its units. @param delta 0 where there are no bounds to
    hold */
support::SurfaceVerdict SetVerdict(const support::TriangleSurface& surface, double delta,
  const std::string& prefix, Figures& figures);

/** A job whose work makes a poly data. */
Job PolyDataJob(const std::function<vtkSmartPointer<vtkPolyData>()>& make);

vtkSmartPointer<vtkPolyData> FlyingEdges(vtkImageData* image, double isoValue);

/** CGAL's isotropic_remeshing in 3 iterations of what `make` makes. */
Job RemeshingJob(const std::function<vtkSmartPointer<vtkPolyData>()>& make, double edgeLength);

/** CGAL's make_surface_mesh on the trilinear field of an image in air: angles of at least 30
    degrees, surface Delaunay balls of at most `radius`. It starts from a voxel beside the largest
    component. */
Job MesherJob(vtkImageData* image, vtkPolyData* largest, double isoValue, double radius);

#if defined(VOLUMIC_BENCHMARK_ITK)
/** itk::ThresholdSegmentationLevelSetImageFilter from the border inward, to an RMS change of 0.02
    or 1200 iterations, then vtkFlyingEdges3D. One thread. */
Job LevelSetJob(vtkImageData* image, double isoValue);

/** ITK's Gaussian and resampling to each of the sizes, one after the other, of int16 voxels. */
void RunItkPyramid(vtkImageData* volume, const std::vector<std::array<int, 3>>& sizes, int threads);
#endif

void RunSurface(const Options& options);
void RunPyramid(const Options& options);

} // namespace volumic::bench

#endif
