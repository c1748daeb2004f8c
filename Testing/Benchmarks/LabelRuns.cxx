// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "LabelRuns.h"

#include "LabelJudge.h"
#include "LabelMaps.h"
#include "LabelPeers.h"
#include "PeakMemory.h"
#include "SupportVtkConversions.h"
#include "SurfaceJudge.h"
#include "vtkLabelsToSurfaces.h"

#include <vtkDataArray.h>
#include <vtkErrorCode.h>
#include <vtkFieldData.h>
#include <vtkMultiBlockDataSet.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <limits>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace volumic::bench
{
namespace
{

/** So many voxels about a label decide how its surface is: neighbours, and the Gaussian's reach. */
constexpr int MarginOfOurs = 8;
constexpr int MarginOfPeers = 4; ///< ITK's layers; for VTK's one would do, and costs as much

void Measure(const std::function<void()>& work, int repetitions, RunFigures& figures)
{
  double seconds = std::numeric_limits<double>::infinity();
  double processor = seconds;
  for (int i = 0; i < repetitions; ++i)
  {
    const auto begin = std::chrono::steady_clock::now();
    const std::clock_t processorBegin = std::clock();
    work();
    processor = std::min(
      processor, static_cast<double>(std::clock() - processorBegin) / CLOCKS_PER_SEC);
    seconds = std::min(seconds,
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  figures.Set("Seconds", seconds);
  figures.Set("ProcessorSeconds", processor);
}

double FieldOf(vtkPolyData* surface, const char* name)
{
  vtkDataArray* array = surface->GetFieldData()->GetArray(name);
  return array && array->GetNumberOfTuples() > 0 ? array->GetComponent(0, 0) : 0.0;
}

vtkSmartPointer<vtkLabelsToSurfaces> MakeFilter(
  const support::LabelMap& map, const std::vector<int>& labels, const LabelSettings& settings)
{
  auto filter = vtkSmartPointer<vtkLabelsToSurfaces>::New();
  filter->SetInputDataObject(support::ToImage(map));
  for (const int label : labels)
  {
    filter->AddLabel(label);
  }
  if (settings.Smoothing >= 0.0)
  {
    filter->SetSmoothing(settings.Smoothing);
  }
  if (settings.VoxelTolerance >= 0.0)
  {
    filter->SetVoxelTolerance(settings.VoxelTolerance);
  }
  filter->SetGap(settings.Gap * map.ShortestSpacing());
  filter->SetFinestLevel(settings.FinestLevel);
  filter->SetNumberOfThreads(settings.Threads);
  return filter;
}

void Update(vtkLabelsToSurfaces* filter)
{
  filter->Modified();
  filter->Update();
  if (filter->GetErrorCode() != vtkErrorCode::NoError)
  {
    throw std::runtime_error("vtkLabelsToSurfaces failed, see above");
  }
}

std::vector<LabelSurface> SurfacesOf(vtkMultiBlockDataSet* blocks)
{
  std::vector<LabelSurface> surfaces;
  for (unsigned int b = 0; b < blocks->GetNumberOfBlocks(); ++b)
  {
    auto* block = vtkPolyData::SafeDownCast(blocks->GetBlock(b));
    if (!block)
    {
      throw std::runtime_error("a block is no poly data");
    }
    LabelSurface surface;
    surface.Label = static_cast<int>(FieldOf(block, "Label"));
    surface.Delta = FieldOf(block, "Delta");
    surface.ReportedWrong = FieldOf(block, "WrongVoxels");
    surface.Surface = support::ToTriangleSurface(block);
    surfaces.push_back(std::move(surface));
  }
  return surfaces;
}

SurfaceJob PeerJob(const std::string& run, vtkImageData* image, int label, double edgeLength)
{
  if (run == "windowed")
  {
    return WindowedLabelJob(image, label, 20, 0.1);
  }
  if (run == "windowed-more")
  {
    return WindowedLabelJob(image, label, 15, 0.001);
  }
  if (run == "remeshed")
  {
    return RemeshedLabelJob(image, label, edgeLength);
  }
#if defined(VOLUMIC_BENCHMARK_SURFACE_NETS)
  if (run == "nets")
  {
    return NetsLabelJob(image, label);
  }
#endif
#if defined(VOLUMIC_BENCHMARK_ITK)
  if (run == "antialiased")
  {
    return AntiAliasedLabelJob(image, label);
  }
#endif
  throw std::logic_error("no run " + run);
}

double SignedVolume(const support::TriangleSurface& surface)
{
  double volume = 0.0;
  for (const auto& t : surface.Triangles)
  {
    const auto& [a, b, c] = std::tie(surface.Points[t[0]], surface.Points[t[1]],
      surface.Points[t[2]]);
    volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                a[2] * (b[0] * c[1] - b[1] * c[0])) /
      6.0;
  }
  return volume;
}

/** Which way peers turn their triangles is nothing that they are judged by. */
void TurnOutward(support::TriangleSurface& surface)
{
  if (SignedVolume(surface) < 0.0)
  {
    for (auto& triangle : surface.Triangles)
    {
      std::swap(triangle[1], triangle[2]);
    }
  }
}

std::array<double, 6> BoxOf(const support::TriangleSurface& surface)
{
  const double far = std::numeric_limits<double>::infinity();
  std::array<double, 6> box = { far, far, far, -far, -far, -far };
  for (const auto& point : surface.Points)
  {
    for (int a = 0; a < 3; ++a)
    {
      box[a] = std::min(box[a], point[a]);
      box[a + 3] = std::max(box[a + 3], point[a]);
    }
  }
  return box;
}

bool Overlap(const std::array<double, 6>& a, const std::array<double, 6>& b)
{
  return a[0] <= b[3] && b[0] <= a[3] && a[1] <= b[4] && b[1] <= a[4] && a[2] <= b[5] &&
    b[2] <= a[5];
}

} // namespace

//------------------------------------------------------------------------------
std::vector<std::string> LabelRunNames()
{
  return { "us", "us-gap", "us-alone", "windowed", "windowed-more",
#if defined(VOLUMIC_BENCHMARK_SURFACE_NETS)
    "nets",
#endif
#if defined(VOLUMIC_BENCHMARK_ITK)
    "antialiased",
#endif
    "remeshed" };
}

std::vector<LabelSurface> OurSurfaces(const support::LabelMap& map, const std::vector<int>& labels,
  const LabelSettings& settings, RunFigures& figures)
{
  const auto filter = MakeFilter(map, labels, settings);
  const MemoryUse memory = MeasureMemory(
    [&]() { Measure([&]() { Update(filter); }, settings.Repetitions, figures); });
  if (memory.Peak >= 0)
  {
    figures.Set("PeakMegabytes", 1e-6 * memory.Peak);
  }
  return SurfacesOf(vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(0)));
}

LabelSurface SurfaceAlone(const std::string& run, const support::LabelMap& map, int label,
  double edgeLength, const LabelSettings& settings, RunFigures& figures)
{
  LabelSurface surface;
  if (run == "us-alone")
  {
    const auto filter = MakeFilter(CropToLabel(map, label, MarginOfOurs), { label }, settings);
    Measure([&]() { Update(filter); }, settings.Repetitions, figures);
    surface =
      SurfacesOf(vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(0))).at(0);
  }
  else
  {
    const auto image = support::ToImage(CropToLabel(map, label, MarginOfPeers));
    SurfaceJob job;
    Measure(
      [&]()
      {
        job = PeerJob(run, image, label, edgeLength);
        job.Work();
      },
      settings.Repetitions, figures);
    surface.Label = label;
    surface.Surface = job.Result();
    TurnOutward(surface.Surface);
  }
  return surface;
}

//------------------------------------------------------------------------------
void SetLabelVerdict(const LabelSurface& surface, const support::LabelMap& map,
  const support::LabelShape* shape, RunFigures& figures)
{
  const double unit = map.ShortestSpacing();
  const auto set = [&figures](const char* name, double value) { figures.Set(name, value); };
  const auto count = [&figures](const char* name, std::size_t value)
  { figures.Set(name, static_cast<double>(value)); };
  const double delta = surface.Delta > 0.0 ? surface.Delta : 0.85 * unit;
  const support::SurfaceVerdict verdict = support::JudgeSurface(surface.Surface, delta);
  const support::TopologyVerdict& topology = verdict.Topology;
  count("Vertices", surface.Surface.Points.size() - topology.UnusedPoints);
  count("Triangles", surface.Surface.Triangles.size());
  count("Components", topology.Components.size());
  count("OpenEdges", topology.OpenEdges);
  count("NonManifold",
    topology.NonManifoldEdges + topology.NonManifoldVertices + topology.DegenerateTriangles);
  count("MisorientedEdges", topology.MisorientedEdges);
  count("SelfIntersections", verdict.Intersections.Pairs + verdict.Intersections.FlatTriangles);
  set("EdgeMean", verdict.Lengths.Mean / unit);
  if (surface.Delta > 0.0)
  {
    set("EdgesOutside", verdict.Lengths.ShareOutside);
    count("NearPairs", verdict.Lengths.NearPairs);
    set("ReportedWrong", surface.ReportedWrong);
  }
  set("RatioLeast", verdict.Shapes.Least);
  set("RatioQuantile01", verdict.Shapes.Quantile01);
  set("RatioMean", verdict.Shapes.Mean);

  const support::DihedralVerdict dihedrals = support::JudgeDihedrals(surface.Surface);
  set("DihedralMedian", dihedrals.Median);
  set("Dihedral95", dihedrals.Quantile95);
  set("DihedralLargest", dihedrals.Largest);
  const support::WrongVoxelVerdict voxels =
    support::JudgeVoxels(surface.Surface, map, surface.Label);
  count("LabelVoxels", voxels.Label);
  count("VoxelsOutside", voxels.Outside);
  count("VoxelsInside", voxels.Inside);
  const double voxel = map.Spacing[0] * map.Spacing[1] * map.Spacing[2];
  set("VolumeByVoxels", topology.Volume / (static_cast<double>(voxels.Label) * voxel) - 1.0);
  if (shape && shape->Distance)
  {
    const support::TruthVerdict truth = support::JudgeTruth(surface.Surface, *shape);
    set("DistanceAtVertices", truth.MeanAtVertices / unit);
    set("DistanceAtCentroids", truth.MeanAtCentroids / unit);
    set("DistanceLargest", truth.Largest / unit);
    set("NormalAngle", truth.MeanAngle);
    set("VolumeError", truth.VolumeError);
  }
}

void SetOverlap(const std::vector<LabelSurface>& surfaces, double unit, RunFigures& figures)
{
  std::vector<std::array<double, 6>> boxes;
  for (const LabelSurface& surface : surfaces)
  {
    boxes.push_back(BoxOf(surface.Surface));
  }
  double pairs = 0.0, vertices = 0.0, sum = 0.0, largest = 0.0, intersections = 0.0;
  for (std::size_t a = 0; a < surfaces.size(); ++a)
  {
    for (std::size_t b = a + 1; b < surfaces.size(); ++b)
    {
      if (Overlap(boxes[a], boxes[b]))
      {
        const support::OverlapVerdict verdict =
          support::JudgeOverlap(surfaces[a].Surface, surfaces[b].Surface);
        const auto inside = static_cast<double>(verdict.VerticesInside);
        ++pairs;
        vertices += inside;
        sum += inside * verdict.MeanDepth;
        largest = std::max(largest, verdict.LargestDepth);
        intersections += static_cast<double>(verdict.IntersectingPairs);
      }
    }
  }
  figures.Set("OverlapPairs", pairs);
  figures.Set("OverlapVertices", vertices);
  figures.Set("OverlapMean", vertices > 0.0 ? sum / vertices / unit : 0.0);
  figures.Set("OverlapLargest", largest / unit);
  figures.Set("OverlapIntersections", intersections);
}

} // namespace volumic::bench
