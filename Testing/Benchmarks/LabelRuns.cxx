// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// vtkLabelsToSurfaces and its peers, on digitised shapes, whose surfaces are known, or on a label
// map:
//
//     runs=LIST of us, strict (VoxelTolerance 0), windowed, remeshed
//     map=FILE mask=1 least=VOXELS | shapes=LIST size=N stretch=S; threads=N (of us) repetitions=N
//
// Figures of each label follow "@row MAP<tab>LABEL<tab>RUN". Ours are made of the whole map, each
// with its share of the seconds; peers get each label cut out, which makes them faster than they
// are on the whole map.

#include "Benchmark.h"

#include "ForVoxels.h"
#include "LabelJudge.h"
#include "SupportVtkConversions.h"

#include <vtkDiscreteFlyingEdges3D.h>
#include <vtkErrorCode.h>
#include <vtkLabelsToSurfaces.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkSMPTools.h>
#include <vtkWindowedSincPolyDataFilter.h>

#include <cmath>
#include <iostream>

namespace volumic::bench
{
namespace
{

using support::LabelMap;
using support::LabelShape;

/** A map, its labels to be measured, and their shapes where these are known. */
struct Subject
{
  std::string Name;
  LabelMap Map;
  std::vector<int> Labels;
  std::map<int, LabelShape> Shapes;
};

struct LabelSurface
{
  int Label;
  support::TriangleSurface Surface; ///< world
};

LabelMap ReadLabelMap(const std::string& file, bool isMask)
{
  const vtkSmartPointer<vtkImageData> image = ReadImage(file);
  LabelMap map;
  image->GetDimensions(map.Size.data());
  image->GetSpacing(map.Spacing.data());
  vtkDataArray* values = image->GetPointData()->GetScalars();
  for (vtkIdType v = 0; v < values->GetNumberOfTuples(); ++v)
  {
    const double value = values->GetComponent(v, 0);
    map.Values.push_back(static_cast<std::int16_t>(isMask ? value > 0 : value));
  }
  return map;
}

/** The label with so many voxels about it. */
LabelMap CropToLabel(const LabelMap& map, int label, int margin)
{
  std::array<int, 3> from = map.Size, to = { -1, -1, -1 };
  std::size_t voxel = 0;
  ForVoxels(map.Size,
    [&](int i, int j, int k)
    {
      if (map.Values[voxel++] == label)
      {
        from = { std::min(from[0], i), std::min(from[1], j), std::min(from[2], k) };
        to = { std::max(to[0], i), std::max(to[1], j), std::max(to[2], k) };
      }
    });
  LabelMap crop;
  crop.Spacing = map.Spacing;
  for (int a = 0; a < 3; ++a)
  {
    from[a] -= margin;
    crop.Size[a] = to[a] + margin - from[a] + 1;
    crop.Origin[a] = map.Origin[a] + from[a] * map.Spacing[a];
  }
  const auto isIn = [&map](int a, int i) { return i >= 0 && i < map.Size[a]; };
  ForVoxels(crop.Size,
    [&](int x, int y, int z)
    {
      const int i = from[0] + x, j = from[1] + y, k = from[2] + z;
      crop.Values.push_back(isIn(0, i) && isIn(1, j) && isIn(2, k)
          ? map.Values[(static_cast<std::size_t>(k) * map.Size[1] + j) * map.Size[0] + i]
          : std::int16_t(0));
    });
  return crop;
}

//------------------------------------------------------------------------------
std::vector<LabelSurface> OurSurfaces(
  const std::string& run, const Subject& subject, const Options& options, Figures& figures)
{
  vtkNew<vtkLabelsToSurfaces> filter;
  filter->SetInputDataObject(support::ToImage(subject.Map));
  for (const int label : subject.Labels)
  {
    filter->AddLabel(label);
  }
  filter->SetVoxelTolerance(run == "strict" ? 0.0 : filter->GetVoxelTolerance());
  filter->SetNumberOfThreads(options.Integer("threads", 1));
  Measure(
    [&]()
    {
      filter->Modified();
      filter->Update();
    },
    options.Integer("repetitions", 1), figures, subject.Labels.size());
  if (filter->GetErrorCode() != vtkErrorCode::NoError)
  {
    throw std::runtime_error("vtkLabelsToSurfaces failed, see above");
  }
  std::vector<LabelSurface> surfaces;
  auto* blocks = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  for (unsigned int b = 0; b < blocks->GetNumberOfBlocks(); ++b)
  {
    auto* block = vtkPolyData::SafeDownCast(blocks->GetBlock(b));
    surfaces.push_back(
      { static_cast<int>(Field(block, "Label")), support::ToTriangleSurface(block) });
  }
  return surfaces;
}

vtkSmartPointer<vtkPolyData> Windowed(vtkImageData* image, int label)
{
  vtkNew<vtkDiscreteFlyingEdges3D> marching;
  marching->SetInputData(image);
  marching->SetValue(0, label);
  marching->ComputeNormalsOff();
  marching->ComputeScalarsOff();
  vtkNew<vtkWindowedSincPolyDataFilter> smooth;
  smooth->SetInputConnection(marching->GetOutputPort());
  smooth->BoundarySmoothingOff();
  smooth->FeatureEdgeSmoothingOff();
  smooth->NonManifoldSmoothingOn();
  smooth->NormalizeCoordinatesOn();
  smooth->Update();
  return smooth->GetOutput();
}

Job PeerJob(const std::string& run, vtkImageData* image, int label, double edgeLength)
{
  const auto windowed = [=]() { return Windowed(image, label); };
  if (run == "windowed")
  {
    return PolyDataJob(windowed);
  }
  if (run == "remeshed")
  {
    return RemeshingJob(windowed, edgeLength);
  }
  throw std::invalid_argument("no run " + run + " in this build");
}

LabelSurface PeerSurface(const std::string& run, const Subject& subject, int label,
  double edgeLength, const Options& options, Figures& figures)
{
  constexpr int margin = 4; // ITK's layers; for VTK's one would do, and costs as much
  const auto image = support::ToImage(CropToLabel(subject.Map, label, margin));
  const Job job = PeerJob(run, image, label, edgeLength);
  Measure(job.Work, options.Integer("repetitions", 1), figures);
  LabelSurface made = { label, job.Result() };
  // Which way peers turn their triangles is nothing that they are judged by.
  if (support::JudgeTopology(made.Surface).Volume < 0.0)
  {
    for (auto& triangle : made.Surface.Triangles)
    {
      std::swap(triangle[1], triangle[2]);
    }
  }
  return made;
}

//------------------------------------------------------------------------------
/** Returns the mean edge, world. */
double SetLabelVerdict(const LabelSurface& of, const Subject& subject, Figures& figures)
{
  const double unit = subject.Map.ShortestSpacing();
  const auto set = [&figures](const char* name, auto value)
  { figures.Set(name, static_cast<double>(value)); };
  const support::SurfaceVerdict verdict = SetVerdict(of.Surface, 0.0, "", figures);
  set("RatioLeast", verdict.Shapes.Least);
  set("Ratio01", verdict.Shapes.Quantile01);
  set("RatioMean", verdict.Shapes.Mean);
  set("Dihedral95", support::JudgeDihedrals(of.Surface).Quantile95);
  const support::WrongVoxelVerdict voxels =
    support::JudgeVoxels(of.Surface, CropToLabel(subject.Map, of.Label, 4), of.Label);
  set("LabelVoxels", voxels.Label);
  set("Wrong", voxels.Wrong());
  const std::array<double, 3>& spacing = subject.Map.Spacing;
  set("VolumeByVoxels",
    verdict.Topology.Volume /
        (static_cast<double>(voxels.Label) * spacing[0] * spacing[1] * spacing[2]) -
      1.0);
  const auto shape = subject.Shapes.find(of.Label);
  if (shape != subject.Shapes.end() && shape->second.Distance)
  {
    const support::TruthVerdict truth = support::JudgeTruth(of.Surface, shape->second);
    set("DistanceAtVertices", truth.MeanAtVertices / unit);
    set("DistanceAtCentroids", truth.MeanAtCentroids / unit);
    set("NormalAngle", truth.MeanAngle);
    set("VolumeError", truth.VolumeError);
  }
  return verdict.Lengths.Mean;
}

//------------------------------------------------------------------------------
/** Failures are rows, too. */
void Tell(const Subject& subject, int label, const std::string& run,
  const std::function<void(Figures&)>& work)
{
  Figures figures;
  try
  {
    work(figures);
  }
  catch (const std::exception& error)
  {
    figures.SetText("Failure", error.what());
  }
  std::cout << "@row " << subject.Name << '\t' << label << '\t' << run << '\n';
  figures.Write();
}

void MeasureRun(const std::string& run, const Subject& subject, const Options& options,
  std::map<int, double>& edgeLengths)
{
  std::cerr << subject.Name << ' ' << run << std::endl;
  if (run == "us" || run == "strict")
  {
    Figures costs;
    for (const LabelSurface& surface : OurSurfaces(run, subject, options, costs))
    {
      Tell(subject, surface.Label, run,
        [&](Figures& figures)
        {
          figures = costs;
          edgeLengths[surface.Label] = SetLabelVerdict(surface, subject, figures);
        });
    }
    return;
  }
  for (const int label : subject.Labels)
  {
    Tell(subject, label, run,
      [&](Figures& figures)
      {
        const double edge = edgeLengths[label];
        SetLabelVerdict(PeerSurface(run, subject, label,
                          edge > 0.0 ? edge : subject.Map.ShortestSpacing(), options, figures),
          subject, figures);
      });
  }
}

std::vector<Subject> Shapes(const Options& options)
{
  std::vector<Subject> subjects;
  for (const auto kind : support::AllLabelShapeKinds())
  {
    const std::string name = support::LabelShapeName(kind);
    const std::vector<std::string> asked = options.List("shapes", name);
    if (std::count(asked.begin(), asked.end(), name) > 0)
    {
      const int size = options.Integer("size", 128);
      support::DigitisedShapes shapes =
        support::Digitise(kind, size, options.Number("stretch", 1.0));
      Subject subject = { name + options.Text("stretch"), std::move(shapes.Map), {}, {} };
      for (const LabelShape& shape : shapes.Shapes)
      {
        subject.Labels.push_back(shape.Label);
        subject.Shapes[shape.Label] = shape;
      }
      subjects.push_back(std::move(subject));
    }
  }
  return subjects;
}

Subject MapToMeasure(const Options& options)
{
  const std::string file = options.Text("map");
  Subject subject = { file.substr(file.rfind('/') + 1),
    ReadLabelMap(file, options.Integer("mask", 0) == 1), {}, {} };
  std::map<int, int> counts;
  for (const std::int16_t value : subject.Map.Values)
  {
    ++counts[value];
  }
  for (const auto& [label, voxels] : counts)
  {
    if (label != 0 && voxels >= options.Integer("least", 1))
    {
      subject.Labels.push_back(label);
    }
  }
  return subject;
}

} // namespace

void RunLabels(const Options& options)
{
  vtkSMPTools::Initialize(1);
  const std::vector<Subject> subjects =
    options.Text("map").empty() ? Shapes(options) : std::vector<Subject>(1, MapToMeasure(options));
  for (const Subject& subject : subjects)
  {
    std::map<int, double> edgeLengths; // of us; what the remeshed peer is told
    for (const std::string& run : options.List("runs", "us,strict,windowed,remeshed"))
    {
      MeasureRun(run, subject, options, edgeLengths);
    }
  }
}

} // namespace volumic::bench
