// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * One run of vtkDeformableSurface or of a peer on one volume, measured and judged; its figures go to
 * the standard output. benchmark_surface.py starts this program for each run, with options that it
 * has checked, and makes tables of the figures.
 *
 *     BenchmarkSurface --run NAME [OPTION VALUE | FLAG]...
 *
 * NAME: one of benchmark_surface.py's, or `volume`: what there is to be measured on.
 */

#include "SurfaceBenchmarkOptions.h"
#include "SurfaceBenchmarkVolume.h"
#include "SurfaceRuns.h"

#include <cmath>
#include <exception>
#include <functional>
#include <iostream>
#include <map>
#include <stdexcept>
#include <string>

using namespace volumic::bench;

namespace
{

SurfaceBenchmarkOptions ParseOptions(int argc, char** argv)
{
  SurfaceBenchmarkOptions o;
  using Text = const std::string&;
  const std::map<std::string, std::function<void()>> flags = {
    { "--dark", [&o]() { o.ObjectIsBright = false; } },
    { "--no-judge", [&o]() { o.Judge = false; } },
    { "--profile", [&o]() { o.Profile = true; } },
    { "--model", [&o]() { o.Model = true; } },
  };
  const std::map<std::string, std::function<void(Text)>> values = {
    { "--run", [&o](Text text) { o.Run = text; } },
    { "--volume", [&o](Text text) { o.Volume = text; } },
    { "--scene", [&o](Text text) { o.Scene = text; } },
    { "--size", [&o](Text text) { o.SceneSize = std::stoi(text); } },
    { "--iso", [&o](Text text) { o.IsoValue = std::stod(text); } },
    { "--metric",
      [&o](Text text) { o.Metric = text == "world" ? LengthMetric::World : LengthMetric::Voxels; } },
    { "--initialization", [&o](Text text) { o.Initialization = std::stoi(text); } },
    { "--coarsest", [&o](Text text) { o.CoarsestLevel = std::stoi(text); } },
    { "--resample", [&o](Text text) { o.ResampleTo = std::stoi(text); } },
    { "--write-volume", [&o](Text text) { o.WriteVolume = text; } },
    { "--edge-length", [&o](Text text) { o.EdgeLength = std::stod(text); } },
    { "--vertices", [&o](Text text) { o.Vertices = std::stoll(text); } },
    { "--radius", [&o](Text text) { o.Radius = std::stod(text); } },
    { "--output", [&o](Text text) { o.Output = text; } },
  };
  for (int i = 1; i < argc; ++i)
  {
    const std::string name = argv[i];
    if (const auto flag = flags.find(name); flag != flags.end())
    {
      flag->second();
      continue;
    }
    const auto value = values.find(name);
    if (value == values.end() || ++i == argc)
    {
      throw std::invalid_argument(name + ": no option, or without its value");
    }
    value->second(argv[i]);
  }
  return o;
}

RunFigures DescribeVolume(const SurfaceBenchmarkOptions& options)
{
  const BenchmarkedVolume volume = LoadVolume(options);
  double range[2];
  volume.Image->GetScalarRange(range);
  const int* size = volume.Image->GetDimensions();
  RunFigures figures;
  figures.SetText("Size",
    std::to_string(size[0]) + " x " + std::to_string(size[1]) + " x " + std::to_string(size[2]));
  figures.SetText("Type", volume.Image->GetScalarTypeAsString());
  figures.Set("Low", range[0]);
  figures.Set("High", range[1]);
  figures.Set("IsoValue", volume.IsoValue);
#if defined(VOLUMIC_BENCHMARK_ITK)
  figures.Set("HasLevelSet", 1.0);
#endif
  return figures;
}

} // namespace

int main(int argc, char** argv)
{
  RunFigures figures;
  try
  {
    const SurfaceBenchmarkOptions options = ParseOptions(argc, argv);
    figures = options.Run == "volume" ? DescribeVolume(options)
      : options.WriteVolume.empty()   ? MeasureSurfaceRun(options)
                                      : WriteVolume(options);
  }
  catch (const std::exception& error)
  {
    figures.SetText("Failure", error.what());
  }
  figures.Write(std::cout);
  return figures.GetText("Failure").empty() ? 0 : 1;
}
