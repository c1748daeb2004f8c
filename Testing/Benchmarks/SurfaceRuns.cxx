// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "SurfaceRuns.h"

#include "PeakMemory.h"
#include "SurfacePeers.h"

#include <vtkImageCast.h>
#include <vtkNew.h>
#include <vtkSMPTools.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <limits>
#include <stdexcept>

namespace volumic::bench
{
namespace
{

double RadiusOf(const SurfaceBenchmarkOptions& options)
{
  return options.Radius > 0.0 ? options.Radius : MesherRadius(options.EdgeLength);
}

SurfaceJob MakePeerJob(const std::string& name, vtkImageData* image,
  const BenchmarkedVolume& volume, const SurfaceBenchmarkOptions& options)
{
  if (name == "flying")
  {
    return FlyingEdgesJob(image, volume.IsoValue);
  }
  if (name == "smoothed")
  {
    return SmoothedJob(image, volume.IsoValue);
  }
  if (name == "decimated")
  {
    return DecimatedJob(image, volume.IsoValue, options.Vertices);
  }
  if (name == "remeshed")
  {
    return RemeshedJob(image, volume.IsoValue, options.EdgeLength);
  }
  if (name == "mesher")
  {
    return MesherJob(image, volume.IsoValue, volume.ObjectIsBright, RadiusOf(options));
  }
#if defined(VOLUMIC_BENCHMARK_ITK)
  if (name == "levelset")
  {
    return LevelSetJob(image, volume.IsoValue, volume.ObjectIsBright);
  }
#endif
  throw std::invalid_argument("no run " + name + " in this build");
}

/** What follows the values of the volume upward points outward where the object is bright. */
bool FollowsGradient(const std::string& name)
{
  return name != "mesher" && name != "levelset";
}

/** What vtkPolyDataConnectivityFilter leaves behind must not count as reached. */
void DropUnusedPoints(support::TriangleSurface& surface)
{
  std::vector<int> places(surface.Points.size(), -1);
  std::vector<std::array<double, 3>> points;
  for (auto& triangle : surface.Triangles)
  {
    for (int& corner : triangle)
    {
      int& place = places[static_cast<std::size_t>(corner)];
      if (place < 0)
      {
        place = static_cast<int>(points.size());
        points.push_back(surface.Points[static_cast<std::size_t>(corner)]);
      }
      corner = place;
    }
  }
  surface.Points.swap(points);
}

std::size_t UsedPoints(const support::TriangleSurface& surface, const support::TopologyVerdict& t)
{
  return surface.Points.size() - t.UnusedPoints;
}

} // namespace

//------------------------------------------------------------------------------
void MeasureCost(const std::function<void()>& work, RunFigures& figures)
{
  double wall = 0.0, processor = 0.0;
  const MemoryUse memory = MeasureMemory(
    [&]()
    {
      const auto begin = std::chrono::steady_clock::now();
      const std::clock_t processorBegin = std::clock();
      work();
      processor = static_cast<double>(std::clock() - processorBegin) / CLOCKS_PER_SEC;
      wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    });
  figures.Set("WallSeconds", wall);
  figures.Set("ProcessorSeconds", processor);
  if (memory.Before >= 0 && memory.Peak >= 0)
  {
    figures.Set("BaseMegabytes", 1e-6 * memory.Before);
    figures.Set("PeakMegabytes", 1e-6 * memory.Peak);
  }
}

void SetVerdict(const support::TriangleSurface& surface, double delta, const std::string& prefix,
  RunFigures& figures)
{
  const auto set = [&](const char* name, double value) { figures.Set(prefix + name, value); };
  // Without bounds to hold, any will do.
  const support::SurfaceVerdict verdict =
    support::JudgeSurface(surface, delta > 0.0 ? delta : 0.85);
  const support::TopologyVerdict& topology = verdict.Topology;
  set("Vertices", static_cast<double>(UsedPoints(surface, topology)));
  set("Triangles", static_cast<double>(surface.Triangles.size()));
  set("Components", static_cast<double>(topology.Components.size()));
  // -1 means that there is none.
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  set("Genus", topology.Genus < 0 ? nothing : topology.Genus);
  const int largest = topology.Components.empty() ? -1 : topology.Components.front().Genus;
  set("GenusOfLargest", largest < 0 ? nothing : largest);
  set("Volume", topology.Volume);
  set("OpenEdges", static_cast<double>(topology.OpenEdges));
  set("NonManifold",
    static_cast<double>(
      topology.NonManifoldEdges + topology.NonManifoldVertices + topology.DegenerateTriangles));
  set("MisorientedEdges", static_cast<double>(topology.MisorientedEdges));
  set("Outward", topology.Outward);
  set("SelfIntersections", static_cast<double>(verdict.Intersections.Pairs));
  set("FlatTriangles", static_cast<double>(verdict.Intersections.FlatTriangles));
  set("EdgeShortest", verdict.Lengths.Shortest);
  set("EdgeMean", verdict.Lengths.Mean);
  set("EdgeLongest", verdict.Lengths.Longest);
  if (delta > 0.0)
  {
    set("Delta", delta);
    set("EdgesTooShort", static_cast<double>(verdict.Lengths.EdgesTooShort));
    set("EdgesTooLong", static_cast<double>(verdict.Lengths.EdgesTooLong));
    set("NearPairs", static_cast<double>(verdict.Lengths.NearPairs));
  }
}

void SetFit(const support::TriangleSurface& surface, support::JudgedVolume volume,
  LengthMetric metric, const std::array<double, 3>& world, const std::string& prefix,
  RunFigures& figures)
{
  figures.Set(prefix + "Reach", support::JudgeReach(surface, volume).Share);
  const auto set = [&](const char* name, LengthMetric of, double value)
  {
    figures.Set(prefix + (of == LengthMetric::World ? "World" : "Voxels") + name, value);
    if (of == metric)
    {
      figures.Set(prefix + name, value);
    }
  };
  for (const LengthMetric of : { LengthMetric::Voxels, LengthMetric::World })
  {
    if (of == LengthMetric::World)
    {
      volume.Spacing = world;
    }
    const support::IsoDistanceVerdict distance = support::JudgeIsoDistance(surface, volume);
    set("DistanceAtVertices", of, distance.MeanAtVertices);
    set("DistanceAtCentroids", of, distance.MeanAtCentroids);
    const support::ShapeVerdict shapes = support::JudgeShapes(Stretched(surface, volume.Spacing));
    set("RatioLeast", of, shapes.Least);
    set("RatioQuantile01", of, shapes.Quantile01);
    set("RatioMean", of, shapes.Mean);
  }
}

std::string Fingerprint(const support::TriangleSurface& surface)
{
  std::uint64_t hash = 14695981039346656037u; // FNV-1a, eight bytes at a time
  const auto add = [&hash](const void* place)
  {
    std::uint64_t word = 0;
    std::memcpy(&word, place, sizeof word);
    hash = (hash ^ word) * 1099511628211u;
    hash ^= hash >> 29;
  };
  for (const auto& point : surface.Points)
  {
    for (const double& coordinate : point)
    {
      add(&coordinate);
    }
  }
  for (const auto& triangle : surface.Triangles)
  {
    for (const int corner : triangle)
    {
      const std::uint64_t wide = static_cast<std::uint64_t>(corner);
      add(&wide);
    }
  }
  char text[32];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

vtkSmartPointer<vtkImageData> AsFloat(vtkImageData* image)
{
  vtkNew<vtkImageCast> cast;
  cast->SetInputData(image);
  cast->SetOutputScalarTypeToFloat();
  cast->Update();
  return cast->GetOutput();
}

support::JudgedVolume ToJudgedVolume(vtkImageData* inAir, const BenchmarkedVolume& volume)
{
  support::JudgedVolume judged;
  judged.Values = static_cast<const float*>(inAir->GetScalarPointer());
  inAir->GetDimensions(judged.Size.data());
  judged.IsoValue = volume.IsoValue;
  judged.ObjectIsBright = volume.ObjectIsBright;
  return judged;
}

//------------------------------------------------------------------------------
RunFigures MeasureSurfaceRun(const SurfaceBenchmarkOptions& options)
{
  BenchmarkedVolume volume = LoadVolume(options);
  const auto voxels = static_cast<double>(volume.Image->GetNumberOfPoints());
  if (options.Run.compare(0, 3, "us-") == 0)
  {
    RunFigures figures = MeasureOurs(volume, options);
    figures.Set("Voxels", voxels);
    return figures;
  }
  vtkSMPTools::Initialize(1);
  const std::array<double, 3> steps = StepsOf(volume.Image, options.Metric);
  const std::array<double, 3> world = StepsOf(volume.Image, LengthMetric::World);
  volume.Image = InSteps(InAir(volume.Image, volume.ObjectIsBright), steps);
  const SurfaceJob job = MakePeerJob(options.Run, volume.Image, volume, options);
  RunFigures figures;
  figures.Set("Voxels", voxels);
  MeasureCost(job.Work, figures);
  if (job.Iterations)
  {
    figures.Set("Iterations", job.Iterations());
  }
  support::TriangleSurface surface = job.Result();
  if (surface.Triangles.empty())
  {
    throw std::runtime_error("no surface");
  }
  DropUnusedPoints(surface);
  if (!volume.ObjectIsBright && FollowsGradient(options.Run))
  {
    for (auto& triangle : surface.Triangles)
    {
      std::swap(triangle[1], triangle[2]);
    }
  }
  if (options.Judge)
  {
    const vtkSmartPointer<vtkImageData> values = AsFloat(volume.Image);
    SetVerdict(surface, 0.0, "", figures);
    const std::array<double, 3> back = { 1.0 / steps[0], 1.0 / steps[1], 1.0 / steps[2] };
    const support::TriangleSurface inVoxels = Stretched(surface, back);
    SetFit(inVoxels, ToJudgedVolume(values, volume), options.Metric, world, "", figures);
  }
  figures.Set("Radius", options.Run == "mesher" ? RadiusOf(options) : 0.0);
  figures.SetText("Fingerprint", Fingerprint(surface));
  return figures;
}

} // namespace volumic::bench
