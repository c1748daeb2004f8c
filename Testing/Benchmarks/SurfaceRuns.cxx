// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// One run of vtkDeformableSurface or of a peer on a volume, measured and judged:
//
//     run=us | flat | flying | smoothed | remeshed | mesher
//     volume=FILE.vti iso=VALUE metric=0|1 threads=N repetitions=N
//     edge=LENGTH radius=R    resolution of the peers
//
// Peers get the volume with a border of one background voxel. The object is bright. Lengths are
// those of the metric (in rows of a level: of level 0), in units of the smallest voxel distance.
// Distances to the isosurface and radius ratios are reported in both metrics.

#include "Benchmark.h"

#include "SupportVtkConversions.h"

#include <vtkDeformableSurface.h>
#include <vtkImagePyramid.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkPolyDataConnectivityFilter.h>
#include <vtkSMPTools.h>
#include <vtkTable.h>
#include <vtkVariant.h>
#include <vtkWindowedSincPolyDataFilter.h>

#include <limits>

namespace volumic::bench
{
namespace
{

using Steps = std::array<double, 3>;
using support::TriangleSurface;

struct Volume
{
  vtkSmartPointer<vtkImageData> Image;
  double IsoValue;
  bool IsWorld; ///< the metric
};

/** Return the voxel distances in units of the smallest one; all 1 in the voxel metric. */
Steps StepsOf(vtkImageData* image, bool isWorld)
{
  Steps steps;
  image->GetSpacing(steps.data());
  const double least = std::min({ steps[0], steps[1], steps[2] });
  for (double& step : steps)
  {
    step = isWorld ? step / least : 1.0;
  }
  return steps;
}

TriangleSurface Stretched(TriangleSurface surface, const Steps& factors, bool isBack = false)
{
  for (auto& point : surface.Points)
  {
    for (int a = 0; a < 3; ++a)
    {
      point[a] *= isBack ? 1.0 / factors[a] : factors[a];
    }
  }
  return surface;
}

/** Return the voxels with extent and origin 0 and these distances. */
vtkSmartPointer<vtkImageData> InSteps(vtkImageData* image, const Steps& steps)
{
  auto result = vtkSmartPointer<vtkImageData>::New();
  result->SetDimensions(image->GetDimensions());
  result->SetSpacing(steps.data());
  result->GetPointData()->SetScalars(image->GetPointData()->GetScalars());
  return result;
}

//------------------------------------------------------------------------------
/** Return a value of the field data; 0 if the array is missing. */
double Field(vtkPolyData* surface, const char* name)
{
  vtkDataArray* array = surface->GetFieldData()->GetArray(name);
  return array && array->GetNumberOfTuples() > 0 ? array->GetComponent(0, 0) : 0.0;
}

vtkImageData* LevelOf(vtkImagePyramid* pyramid, unsigned int level)
{
  return vtkImageData::SafeDownCast(pyramid->GetOutput()->GetBlock(level));
}

/** Set the figures of the surface alone, in its units. @param delta 0 if it has no edge bounds */
void SetVerdict(
  const TriangleSurface& surface, double delta, const std::string& prefix, Figures& figures)
{
  const auto set = [&](const char* name, auto value)
  { figures.Set(prefix + name, static_cast<double>(value)); };
  const support::SurfaceVerdict verdict =
    support::JudgeSurface(surface, delta > 0.0 ? delta : 0.85);
  const support::TopologyVerdict& topology = verdict.Topology;
  set("Vertices", surface.Points.size() - topology.UnusedPoints);
  set("Triangles", surface.Triangles.size());
  set("Components", topology.Components.size());
  if (topology.Genus >= 0)
  {
    set("Genus", topology.Genus);
  }
  set("Faults", topology.Faults);
  set("SelfIntersections", verdict.Intersections.Pairs);
  set("EdgeShortest", verdict.Lengths.Shortest);
  set("EdgeMean", verdict.Lengths.Mean);
  set("EdgeLongest", verdict.Lengths.Longest);
  if (delta > 0.0)
  {
    set("EdgesOutside", verdict.Lengths.EdgesTooShort + verdict.Lengths.EdgesTooLong);
    set("NearPairs", verdict.Lengths.NearPairs);
  }
}

/** Set how a surface, in index coordinates of the padded image, fits it, in both metrics. */
void SetFit(const TriangleSurface& surface, vtkImageData* padded, double isoValue,
  const std::string& prefix, Figures& figures)
{
  support::JudgedVolume volume = support::ToJudgedVolume(padded, isoValue);
  figures.Set(prefix + "Reach", support::ReachedShare(surface, volume));
  for (const bool isWorld : { false, true })
  {
    const std::string metric = prefix + (isWorld ? "World" : "Voxels");
    volume.Spacing = StepsOf(padded, isWorld);
    const support::IsoDistanceVerdict distance = support::JudgeIsoDistance(surface, volume);
    figures.Set(metric + "DistanceAtVertices", distance.MeanAtVertices);
    figures.Set(metric + "DistanceAtCentroids", distance.MeanAtCentroids);
    const support::ShapeVerdict shapes = support::JudgeShapes(Stretched(surface, volume.Spacing));
    figures.Set(metric + "RatioLeast", shapes.Least);
    figures.Set(metric + "Ratio01", shapes.Quantile01);
    figures.Set(metric + "RatioMean", shapes.Mean);
  }
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkPolyData> LargestComponent(vtkImageData* image, double isoValue)
{
  vtkNew<vtkPolyDataConnectivityFilter> largest;
  largest->SetInputData(FlyingEdges(image, isoValue));
  largest->SetExtractionModeToLargestRegion();
  largest->Update();
  return largest->GetOutput();
}

vtkSmartPointer<vtkPolyData> Smoothed(vtkImageData* image, double isoValue)
{
  vtkNew<vtkWindowedSincPolyDataFilter> smooth;
  smooth->SetInputData(LargestComponent(image, isoValue));
  smooth->NormalizeCoordinatesOn();
  smooth->Update();
  return smooth->GetOutput();
}

Job PeerJob(const Options& options, vtkImageData* image, double iso)
{
  const double edge = options.Number("edge", 1.35);
  const double radius = options.Number("radius", 0.8 * edge);
  const std::map<std::string, std::function<Job()>> jobs = {
    { "flying", [=]() { return PolyDataJob([=]() { return FlyingEdges(image, iso); }); } },
    { "smoothed", [=]() { return PolyDataJob([=]() { return Smoothed(image, iso); }); } },
    { "remeshed", [=]() { return RemeshingJob([=]() { return Smoothed(image, iso); }, edge); } },
    { "mesher", [=]() { return MesherJob(image, LargestComponent(image, iso), iso, radius); } },
  };
  const auto found = jobs.find(options.Text("run"));
  if (found == jobs.end())
  {
    throw std::invalid_argument("Unknown run " + options.Text("run"));
  }
  return found->second();
}

void MeasurePeer(const Volume& volume, const Options& options, Figures& figures)
{
  vtkSMPTools::Initialize(1);
  const Steps steps = StepsOf(volume.Image, volume.IsWorld);
  const vtkSmartPointer<vtkImageData> padded = support::Padded(volume.Image);
  const vtkSmartPointer<vtkImageData> image = InSteps(padded, steps);
  const Job job = PeerJob(options, image, volume.IsoValue);
  Measure(job.Work, options.Integer("repetitions", 1), figures);
  const TriangleSurface surface = job.Result();
  if (surface.Triangles.empty())
  {
    throw std::runtime_error("The surface is empty");
  }
  SetVerdict(surface, 0.0, "", figures);
  SetFit(Stretched(surface, steps, true), padded, volume.IsoValue, "", figures);
}

//------------------------------------------------------------------------------
/** Return the coarsest level that shows the object. The filter reports an error if it starts at a
    level where all of the object has vanished, as thin objects do. */
int CoarsestLevelWithObject(const Volume& volume)
{
  vtkNew<vtkImagePyramid> pyramid;
  pyramid->SetInputData(volume.Image);
  pyramid->Update();
  unsigned int level = pyramid->GetOutput()->GetNumberOfBlocks() - 1;
  while (level > 0 && !(LevelOf(pyramid, level)->GetScalarRange()[1] > volume.IsoValue))
  {
    --level;
  }
  return static_cast<int>(level);
}

/** Set sums over the rows of the history, which are independent of the machine. */
void SetEfforts(vtkTable* history, Figures& figures)
{
  std::map<std::string, double> sums;
  for (vtkIdType row = 0; row < history->GetNumberOfRows(); ++row)
  {
    const auto value = [&](const char* name)
    { return history->GetValueByName(row, name).ToDouble(); };
    for (const std::string& prefix :
      { std::string(), "level." + std::to_string(static_cast<int>(value("Level"))) + "." })
    {
      sums[prefix + "Iterations"] += 1.0;
      sums[prefix + "Updates"] += value("ActiveVertices");
      sums[prefix + "Edits"] += value("Splits") + value("Collapses") + value("Flips");
      sums[prefix + "Joins"] += value("Merges") + value("Cuts");
    }
  }
  for (const auto& [name, sum] : sums)
  {
    figures.Set(name, sum);
  }
}

void JudgeLevel(vtkPolyData* surface, vtkImageData* level, const Volume& volume,
  const std::string& prefix, Figures& figures)
{
  double spacing[3];
  volume.Image->GetSpacing(spacing);
  const double unit = std::min({ spacing[0], spacing[1], spacing[2] });
  SetVerdict(Stretched(support::ToTriangleSurface(surface, volume.Image),
               StepsOf(volume.Image, volume.IsWorld)),
    Field(surface, "Delta") / unit, prefix, figures);
  const vtkSmartPointer<vtkImageData> padded = support::Padded(level);
  SetFit(support::ToTriangleSurface(surface, padded), padded, volume.IsoValue, prefix, figures);
}

void MeasureOurs(const Volume& volume, const Options& options, Figures& figures)
{
  const int threads = options.Integer("threads", 1);
  const bool isFlat = options.Text("run") == "flat";
  vtkSMPTools::Initialize(threads);
  vtkNew<vtkImagePyramid> pyramid;
  pyramid->SetInputData(volume.Image);
  pyramid->SetNumberOfThreads(threads);
  pyramid->SetNumberOfLevels(isFlat ? 1 : 0);
  vtkNew<vtkDeformableSurface> deformable;
  deformable->SetInputConnection(pyramid->GetOutputPort());
  deformable->SetIsoValue(volume.IsoValue);
  deformable->SetMetric(volume.IsWorld);
  deformable->SetNumberOfThreads(threads);
  deformable->SetCoarsestLevel(isFlat ? 0 : CoarsestLevelWithObject(volume));
  Measure(
    [&]()
    {
      pyramid->Modified();
      deformable->Update();
    },
    options.Integer("repetitions", 1), figures);
  if (deformable->GetOutput()->GetNumberOfPoints() == 0)
  {
    throw std::runtime_error("The surface is empty. See the error message of the filter");
  }
  SetEfforts(deformable->GetHistory(), figures);
  vtkMultiBlockDataSet* levels = deformable->GetLevels();
  figures.Set("Levels", levels->GetNumberOfBlocks());
  for (unsigned int h = 0; h < levels->GetNumberOfBlocks(); ++h)
  {
    auto* surface = vtkPolyData::SafeDownCast(levels->GetBlock(h));
    if (surface && surface->GetNumberOfPoints() > 0)
    {
      JudgeLevel(surface, LevelOf(pyramid, h), volume, "level." + std::to_string(h) + ".", figures);
    }
  }
}

} // namespace

void RunSurface(const Options& options)
{
  const Volume volume = { ReadImage(options.Text("volume")),
    options.Number("iso", std::numeric_limits<double>::quiet_NaN()),
    options.Integer("metric", 1) == 1 };
  Figures figures;
  const std::string run = options.Text("run");
  (run == "us" || run == "flat" ? MeasureOurs : MeasurePeer)(volume, options, figures);
  figures.Write();
}

} // namespace volumic::bench
