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

namespace volumic::bench
{

/** The words NAME=VALUE of the command line. */
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

/** Sets Seconds and ProcessorSeconds, the fastest of the repetitions, and PeakMegabytes, what the
    process had resident at most. */
void Measure(const std::function<void()>& work, int repetitions, Figures& figures);

/** A .vti with scalars of one component. */
vtkSmartPointer<vtkImageData> ReadImage(const std::string& file);

/** What a peer does, which is measured, and then what it made. The image has to live as long. */
struct Job
{
  std::function<void()> Work;
  std::function<support::TriangleSurface()> Result;
};

/** Its triangles without points that no triangle has: they must not count as reached. */
support::TriangleSurface TrianglesOf(vtkPolyData* surface);

/** A job whose work makes a poly data. */
Job PolyDataJob(const std::function<vtkSmartPointer<vtkPolyData>()>& make);

vtkSmartPointer<vtkPolyData> FlyingEdges(vtkImageData* image, double isoValue);

/** CGAL's isotropic_remeshing in 3 iterations of what `make` makes. */
Job RemeshingJob(const std::function<vtkSmartPointer<vtkPolyData>()>& make, double edgeLength);

/** CGAL's make_surface_mesh on the trilinear field of an image in air: angles of at least 30
    degrees, surface Delaunay balls of at most `radius`. It starts from a voxel beside the largest
    component. */
Job MesherJob(vtkImageData* image, vtkPolyData* largest, double isoValue, double radius);

void RunSurface(const Options& options);

} // namespace volumic::bench

#endif
