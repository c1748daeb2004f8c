// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * vtkDeformableSurface on one volume: time, memory, and the judge's verdict on every level.
 *
 *     MeasureSurface --volume FILE.vti --iso VALUE [--dark] [--threads N] [--initialization N]
 *                    [--coarsest LEVEL] [--levels] [--peer] [--output FILE.vtp]
 *
 * --coarsest 0 runs without the pyramid; --levels judges all levels, not only the finest. Lengths
 * are in voxels of level 0, the space in which the surface is made; distances to the isopotential
 * in voxels of the level. Times include the pyramid.
 */

#include "PeakMemory.h"
#include "SupportVtkConversions.h"
#include "SurfacePeers.h"

#include <vtkDeformableSurface.h>
#include <vtkImagePyramid.h>

#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkImageCast.h>
#include <vtkImageConstantPad.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLPolyDataWriter.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <exception>
#include <iostream>
#include <stdexcept>
#include <string>

using namespace volumic::support;

namespace
{

struct Options
{
  std::string Volume;
  std::string Output;
  double IsoValue = 0.0;
  bool HasIsoValue = false;
  bool ObjectIsBright = true;
  bool AllLevels = false;
  bool WithPeer = false;
  int Threads = 1;
  int Initialization = 0;
  int CoarsestLevel = -1;
};

Options ParseOptions(int argc, char** argv)
{
  Options options;
  for (int i = 1; i < argc; ++i)
  {
    const std::string name = argv[i];
    if (name == "--dark")
    {
      options.ObjectIsBright = false;
      continue;
    }
    if (name == "--levels")
    {
      options.AllLevels = true;
      continue;
    }
    if (name == "--peer")
    {
      options.WithPeer = true;
      continue;
    }
    if (++i == argc)
    {
      throw std::invalid_argument(name + ": unknown, or its value is missing");
    }
    const std::string value = argv[i];
    if (name == "--volume")
      options.Volume = value;
    else if (name == "--output")
      options.Output = value;
    else if (name == "--iso")
    {
      options.IsoValue = std::stod(value);
      options.HasIsoValue = true;
    }
    else if (name == "--threads")
      options.Threads = std::stoi(value);
    else if (name == "--initialization")
      options.Initialization = std::stoi(value);
    else if (name == "--coarsest")
      options.CoarsestLevel = std::stoi(value);
    else
      throw std::invalid_argument(name + ": unknown");
  }
  if (options.Volume.empty() || !options.HasIsoValue)
  {
    throw std::invalid_argument("--volume FILE.vti and --iso VALUE are needed");
  }
  return options;
}

double Field(vtkPolyData* surface, const char* name)
{
  vtkDataArray* array = surface->GetFieldData()->GetArray(name);
  return array && array->GetNumberOfTuples() > 0 ? array->GetComponent(0, 0) : 0.0;
}

std::string StopReason(vtkPolyData* surface)
{
  auto* reason =
    vtkStringArray::SafeDownCast(surface->GetFieldData()->GetAbstractArray("StopReason"));
  return reason && reason->GetNumberOfValues() > 0 ? std::string(reason->GetValue(0)) : "unknown";
}

/** The image as float with a voxel of air around it, as the surface sees it. */
vtkSmartPointer<vtkImageData> InAir(vtkImageData* image, const Options& options)
{
  vtkNew<vtkImageCast> cast;
  cast->SetInputData(image);
  cast->SetOutputScalarTypeToFloat();
  cast->Update();
  double range[2];
  cast->GetOutput()->GetScalarRange(range);
  const int* extent = image->GetExtent();
  vtkNew<vtkImageConstantPad> pad;
  pad->SetInputConnection(cast->GetOutputPort());
  pad->SetConstant(range[options.ObjectIsBright ? 0 : 1]);
  pad->SetOutputWholeExtent(
    extent[0] - 1, extent[1] + 1, extent[2] - 1, extent[3] + 1, extent[4] - 1, extent[5] + 1);
  pad->Update();
  return pad->GetOutput();
}

JudgedVolume ToJudgedVolume(vtkImageData* inAir, const Options& options)
{
  JudgedVolume volume;
  volume.Values = static_cast<const float*>(inAir->GetScalarPointer());
  inAir->GetDimensions(volume.Size.data());
  volume.IsoValue = options.IsoValue;
  volume.ObjectIsBright = options.ObjectIsBright;
  return volume;
}

SurfaceVerdict JudgeLevel(
  vtkPolyData* surface, vtkImageData* level0, vtkImageData* level, const Options& options)
{
  double spacing[3];
  level0->GetSpacing(spacing);
  const double unit = std::min({ spacing[0], spacing[1], spacing[2] });
  SurfaceVerdict verdict =
    JudgeSurface(ToTriangleSurface(surface, level0), Field(surface, "Delta") / unit);
  const vtkSmartPointer<vtkImageData> inAir = InAir(level, options);
  const JudgedVolume volume = ToJudgedVolume(inAir, options);
  const TriangleSurface inLevel = ToTriangleSurface(surface, inAir);
  verdict.HasVolume = true;
  verdict.IsoDistance = JudgeIsoDistance(inLevel, volume);
  verdict.Reach = JudgeReach(inLevel, volume);
  return verdict;
}

/** Iterations, seconds and the sum of vertices over the iterations of one level. */
struct Effort
{
  long long Iterations = 0;
  double Seconds = 0.0;
  double VertexIterations = 0.0;
};

Effort EffortAt(vtkTable* history, int level)
{
  Effort effort;
  for (vtkIdType row = 0; row < history->GetNumberOfRows(); ++row)
  {
    if (history->GetValueByName(row, "Level").ToInt() == level)
    {
      ++effort.Iterations;
      effort.Seconds += history->GetValueByName(row, "Seconds").ToDouble();
      effort.VertexIterations += history->GetValueByName(row, "Vertices").ToDouble();
    }
  }
  return effort;
}

/** What something cost. */
struct Cost
{
  double Seconds = 0.0;
  double ProcessorSeconds = 0.0;
  double Megabytes = 0.0; ///< by which the memory grew at its peak
};

template <typename Work>
Cost CostOf(Work work)
{
  Cost cost;
  const auto begin = std::chrono::steady_clock::now();
  const std::clock_t processorBegin = std::clock();
  cost.Megabytes = 1e-6 * volumic::bench::PeakGrowth(work);
  cost.ProcessorSeconds = static_cast<double>(std::clock() - processorBegin) / CLOCKS_PER_SEC;
  cost.Seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return cost;
}

void CompareWithPeer(
  vtkImageData* image, double edgeLength, double delta, const Cost& ours, const Options& options)
{
  const vtkSmartPointer<vtkImageData> inAir = InAir(image, options);
  TriangleSurface surface;
  const Cost cost = CostOf([&]()
    { surface = volumic::bench::RemeshedMarchingSurface(inAir, options.IsoValue, edgeLength); });
  std::printf("\nFlyingEdges, largest component, WindowedSinc, CGAL isotropic remeshing: "
              "%.2f s (%.2f s), memory grown by %.0f MB at most\n",
    cost.Seconds, cost.ProcessorSeconds, cost.Megabytes);
  for (auto& point : surface.Points)
  {
    for (int a = 0; a < 3; ++a)
    {
      point[a] -= inAir->GetExtent()[2 * a]; // judged in a volume whose first voxel is 0
    }
  }
  const JudgedVolume volume = ToJudgedVolume(inAir, options);
  std::fputs(Describe(JudgeSurface(surface, delta, &volume)).c_str(), stdout);
  std::printf("\nOurs relative to it: processor time %.2f, memory %.2f\n",
    ours.ProcessorSeconds / cost.ProcessorSeconds, ours.Megabytes / cost.Megabytes);
}

int Main(int argc, char** argv)
{
  const Options options = ParseOptions(argc, argv);
  vtkNew<vtkXMLImageDataReader> reader;
  reader->SetFileName(options.Volume.c_str());
  reader->Update();
  vtkImageData* image = reader->GetOutput();

  vtkNew<vtkImagePyramid> pyramid;
  pyramid->SetInputData(image);
  pyramid->SetNumberOfThreads(options.Threads);
  vtkNew<vtkDeformableSurface> deformable;
  deformable->SetInputConnection(pyramid->GetOutputPort());
  deformable->SetIsoValue(options.IsoValue);
  deformable->SetObjectIsBright(options.ObjectIsBright);
  deformable->SetInitialization(options.Initialization);
  deformable->SetCoarsestLevel(options.CoarsestLevel);
  deformable->SetNumberOfThreads(options.Threads);

  const Cost cost = CostOf([&]() { deformable->Update(); });
  vtkPolyData* finest = deformable->GetOutput();
  if (finest->GetNumberOfPoints() == 0)
  {
    std::cerr << "no surface" << std::endl;
    return 1;
  }
  std::printf("%s: %.2f s (%.2f s) with %d threads, memory grown by %.0f MB at most, %s\n",
    options.Volume.c_str(), cost.Seconds, cost.ProcessorSeconds, options.Threads, cost.Megabytes,
    StopReason(finest).c_str());

  vtkMultiBlockDataSet* levels = deformable->GetLevels();
  double vertexIterations = 0.0;
  LengthVerdict lengths;
  for (int h = static_cast<int>(levels->GetNumberOfBlocks()) - 1; h >= 0; --h)
  {
    auto* surface = vtkPolyData::SafeDownCast(levels->GetBlock(static_cast<unsigned int>(h)));
    if (!surface || surface->GetNumberOfPoints() == 0)
    {
      continue;
    }
    const Effort effort = EffortAt(deformable->GetHistory(), h);
    vertexIterations += effort.VertexIterations;
    std::printf("\nLevel %d: %lld iterations, %.2f s, %.2f microseconds per vertex and iteration, "
                "lost parts %g, recovered %g\n",
      h, effort.Iterations, effort.Seconds, 1e6 * effort.Seconds / effort.VertexIterations,
      Field(surface, "LostParts"), Field(surface, "RecoveredParts"));
    if (options.AllLevels || h == static_cast<int>(Field(finest, "Level")))
    {
      auto* level =
        vtkImageData::SafeDownCast(pyramid->GetOutput()->GetBlock(static_cast<unsigned int>(h)));
      const SurfaceVerdict verdict = JudgeLevel(surface, image, level, options);
      lengths = verdict.Lengths;
      std::fputs(Describe(verdict).c_str(), stdout);
    }
  }
  std::printf("\nAltogether %.2f microseconds per vertex and iteration\n",
    1e6 * cost.Seconds / vertexIterations);

  if (options.WithPeer)
  {
    double spacing[3];
    image->GetSpacing(spacing);
    const double delta = Field(finest, "Delta") / std::min({ spacing[0], spacing[1], spacing[2] });
    CompareWithPeer(image, lengths.Mean, delta, cost, options);
  }

  if (!options.Output.empty())
  {
    vtkNew<vtkXMLPolyDataWriter> writer;
    writer->SetInputData(finest);
    writer->SetFileName(options.Output.c_str());
    writer->Write();
  }
  return 0;
}

} // namespace

int main(int argc, char** argv)
{
  try
  {
    return Main(argc, argv);
  }
  catch (const std::exception& error)
  {
    std::cerr << argv[0] << ": " << error.what() << std::endl;
    return 1;
  }
}
