// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/** Declarations shared by the sources of the program Benchmark; see Benchmark.cxx. */

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

namespace volumic::bench
{

/** The arguments NAME=VALUE of the command line. */
class Options
{
public:
  explicit Options(const std::vector<std::string>& words);

  std::string Text(const std::string& name) const;
  double Number(const std::string& name, double otherwise) const;
  int Integer(const std::string& name, int otherwise) const;

private:
  std::map<std::string, std::string> Values;
};

/** Numbers and texts by name, written as lines "@NAME VALUE". */
class Figures
{
public:
  void Set(const std::string& name, double value);
  void SetText(const std::string& name, const std::string& text) { this->Values[name] = text; }
  void Write() const;

private:
  std::map<std::string, std::string> Values;
};

/** Measure `work`: set Seconds and ProcessorSeconds of the fastest repetition, and PeakMegabytes,
    the peak resident memory of the process. */
void Measure(const std::function<void()>& work, int repetitions, Figures& figures);

/** Read a .vti with scalars of one component. */
vtkSmartPointer<vtkImageData> ReadImage(const std::string& file);

/** The measured work of a peer, and its result. The image must outlive the job. */
struct Job
{
  std::function<void()> Work;
  std::function<support::TriangleSurface()> Result;
};

/** Convert to triangles without unused points, which must not count as reached. */
support::TriangleSurface TrianglesOf(vtkPolyData* surface);

/** Return a job whose work makes a poly data. */
Job PolyDataJob(const std::function<vtkSmartPointer<vtkPolyData>()>& make);

vtkSmartPointer<vtkPolyData> FlyingEdges(vtkImageData* image, double isoValue);

/** Return a job that remeshes the output of `make`: CGAL's isotropic_remeshing, 3 iterations. */
Job RemeshingJob(const std::function<vtkSmartPointer<vtkPolyData>()>& make, double edgeLength);

/** Return a job that runs CGAL's make_surface_mesh on the trilinear field of an image with a
    background border: angles of at least 30 degrees, surface Delaunay balls of at most `radius`. It
    starts from a voxel beside the largest component. */
Job MesherJob(vtkImageData* image, vtkPolyData* largest, double isoValue, double radius);

void RunSurface(const Options& options);

} // namespace volumic::bench

#endif
