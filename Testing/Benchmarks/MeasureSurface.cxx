// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * vtkDeformableSurface on one volume: time, memory, and the judge's verdict on every level.
 *
 *     MeasureSurface --volume FILE.vti --iso VALUE [--dark] [--threads N] [--initialization N]
 *                    [--coarsest LEVEL] [--levels] [--output FILE.vtp]
 *
 * --coarsest 0 runs without the pyramid; --levels judges all levels, not only the finest. Lengths
 * are in voxels of level 0, the space in which the surface is made; distances to the isopotential
 * in voxels of the level. Times include the pyramid.
 */

#include "PeakMemory.h"
#include "SupportVtkConversions.h"

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

/** Judges a surface; the level with a voxel of air around it, as the surface sees it. */
SurfaceVerdict JudgeLevel(
  vtkPolyData* surface, vtkImageData* level0, vtkImageData* level, const Options& options)
{
  vtkNew<vtkImageCast> cast;
  cast->SetInputData(level);
  cast->SetOutputScalarTypeToFloat();
  cast->Update();
  double range[2];
  cast->GetOutput()->GetScalarRange(range);
  const int* extent = level->GetExtent();
  vtkNew<vtkImageConstantPad> pad;
  pad->SetInputConnection(cast->GetOutputPort());
  pad->SetConstant(range[options.ObjectIsBright ? 0 : 1]);
  pad->SetOutputWholeExtent(
    extent[0] - 1, extent[1] + 1, extent[2] - 1, extent[3] + 1, extent[4] - 1, extent[5] + 1);
  pad->Update();
  vtkImageData* padded = pad->GetOutput();

  JudgedVolume volume;
  volume.Values = static_cast<const float*>(padded->GetScalarPointer());
  padded->GetDimensions(volume.Size.data());
  volume.IsoValue = options.IsoValue;
  volume.ObjectIsBright = options.ObjectIsBright;

  double spacing[3];
  level0->GetSpacing(spacing);
  const double unit = std::min({ spacing[0], spacing[1], spacing[2] });
  SurfaceVerdict verdict =
    JudgeSurface(ToTriangleSurface(surface, level0), Field(surface, "Delta") / unit);
  const TriangleSurface inLevel = ToTriangleSurface(surface, padded);
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

  const auto begin = std::chrono::steady_clock::now();
  const long long growth = volumic::bench::PeakGrowth([&]() { deformable->Update(); });
  const double seconds =
    std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  vtkPolyData* finest = deformable->GetOutput();
  if (finest->GetNumberOfPoints() == 0)
  {
    std::cerr << "no surface" << std::endl;
    return 1;
  }
  std::printf("%s: %.2f s with %d threads, memory grown by %.0f MB at most, %s\n",
    options.Volume.c_str(), seconds, options.Threads, growth / 1e6, StopReason(finest).c_str());

  vtkMultiBlockDataSet* levels = deformable->GetLevels();
  double vertexIterations = 0.0;
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
      std::fputs(Describe(JudgeLevel(surface, image, level, options)).c_str(), stdout);
    }
  }
  std::printf(
    "\nAltogether %.2f microseconds per vertex and iteration\n", 1e6 * seconds / vertexIterations);

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
