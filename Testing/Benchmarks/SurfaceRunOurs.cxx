// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "SurfaceRuns.h"

#include "WorkModel.h"

#include "Host/HostThreads.h"
#include "SupportVtkConversions.h"

#include <vtkDeformableSurface.h>
#include <vtkImagePyramid.h>

#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkSMPTools.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkXMLPolyDataWriter.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>

namespace volumic::bench
{
namespace
{

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

/** The columns of the history that tell the seconds of a phase: all `...Seconds`. */
std::vector<std::string> PhaseColumns(vtkTable* history)
{
  const std::string ending = "Seconds";
  std::vector<std::string> names;
  for (vtkIdType c = 0; c < history->GetNumberOfColumns(); ++c)
  {
    const std::string name = history->GetColumnName(c) ? history->GetColumnName(c) : "";
    if (name.size() > ending.size() &&
      name.compare(name.size() - ending.size(), ending.size(), ending) == 0)
    {
      names.push_back(name);
    }
  }
  return names;
}

/** Whether it is no part of another one. */
bool AddsUp(const std::string& phase)
{
  return phase.find("Serial") == std::string::npos && phase != "RecoverySeconds" &&
    phase != "RegularisationSeconds";
}

void SetEfforts(vtkTable* history, int numberOfLevels, RunFigures& figures)
{
  const std::vector<std::string> phases = PhaseColumns(history);
  std::string phaseNames;
  for (const std::string& phase : phases)
  {
    if (AddsUp(phase))
    {
      phaseNames += (phaseNames.empty() ? "" : ",") + phase;
    }
  }
  figures.SetText("Phases", phaseNames);
  double vertexIterations = 0.0;
  for (int h = 0; h < numberOfLevels; ++h)
  {
    const auto name = [h](const std::string& what)
    { return RunFigures::Indexed("level", h, what); };
    double iterations = 0.0, seconds = 0.0, vertices = 0.0;
    std::vector<double> phaseSeconds(phases.size(), 0.0);
    for (vtkIdType row = 0; row < history->GetNumberOfRows(); ++row)
    {
      if (history->GetValueByName(row, "Level").ToInt() != h)
      {
        continue;
      }
      iterations += 1.0;
      seconds += history->GetValueByName(row, "Seconds").ToDouble();
      vertices += history->GetValueByName(row, "Vertices").ToDouble();
      for (std::size_t p = 0; p < phases.size(); ++p)
      {
        phaseSeconds[p] += history->GetValueByName(row, phases[p].c_str()).ToDouble();
      }
    }
    figures.Set(name("Iterations"), iterations);
    figures.Set(name("Seconds"), seconds);
    figures.Set(name("VertexIterations"), vertices);
    for (std::size_t p = 0; p < phases.size(); ++p)
    {
      figures.Set(name(phases[p]), phaseSeconds[p]);
    }
    vertexIterations += vertices;
  }
  figures.Set("Iterations", static_cast<double>(history->GetNumberOfRows()));
  figures.Set("VertexIterations", vertexIterations);
}

/** Lengths that the surface promises are in units of level 0; distances to the isopotential and
    reach in those of the level. */
void JudgeLevel(vtkPolyData* surface, vtkImageData* level0, vtkImageData* level,
  const BenchmarkedVolume& volume, LengthMetric metric, const std::string& prefix,
  RunFigures& figures)
{
  double spacing[3];
  level0->GetSpacing(spacing);
  const double unit = std::min({ spacing[0], spacing[1], spacing[2] });
  const double delta = Field(surface, "Delta") / unit;
  SetVerdict(Stretched(support::ToTriangleSurface(surface, level0), StepsOf(level0, metric)), delta,
    prefix, figures);
  const vtkSmartPointer<vtkImageData> values = AsFloat(InAir(level, volume.ObjectIsBright));
  SetFit(
    support::ToTriangleSurface(surface, values), ToJudgedVolume(values, volume), metric,
    StepsOf(level, LengthMetric::World), prefix, figures);
}

/** The coarsest level where there is still something of the object: the filter refuses to start
   from one where all of it has vanished, as thin things do, and advises this one. */
int CoarsestLevelWithObject(const BenchmarkedVolume& volume)
{
  vtkNew<vtkImagePyramid> pyramid;
  pyramid->SetInputData(volume.Image);
  pyramid->Update();
  int level = static_cast<int>(pyramid->GetOutput()->GetNumberOfBlocks()) - 1;
  for (; level > 0; --level)
  {
    auto* image =
      vtkImageData::SafeDownCast(pyramid->GetOutput()->GetBlock(static_cast<unsigned int>(level)));
    double range[2];
    image->GetScalarRange(range);
    if (volume.ObjectIsBright ? range[1] > volume.IsoValue : range[0] < volume.IsoValue)
    {
      break;
    }
  }
  return level;
}

/** The phases as figures `model.i.NAME`. */
void SetModel(const WorkModel& model, RunFigures& figures)
{
  const ThreadOverhead overhead;
  figures.Set("ModelSecondsOfCall", overhead.SecondsOfCall);
  figures.Set("ModelSecondsOfChunk", overhead.SecondsOfChunk);
  const std::vector<WorkModel::Phase>& phases = model.Phases();
  figures.Set("ModelPhases", static_cast<double>(phases.size()));
  for (std::size_t i = 0; i < phases.size(); ++i)
  {
    const auto name = [i](const std::string& what)
    { return RunFigures::Indexed("model", static_cast<int>(i), what); };
    figures.SetText(name("Name"), phases[i].Name);
    figures.Set(name("Serial"), phases[i].Serial);
    figures.Set(name("Small"), phases[i].Small);
    figures.Set(name("Parallel"), phases[i].Parallel);
    figures.Set(name("Calls"), phases[i].Calls);
    figures.Set(name("Chunks"), phases[i].Chunks);
    for (std::size_t t = 0; t < ModelledThreads.size(); ++t)
    {
      figures.Set(
        name("Scheduled" + std::to_string(ModelledThreads[t])), phases[i].Scheduled[t]);
    }
  }
}

int ThreadsOf(const std::string& run)
{
  return run.find_first_not_of("0123456789", 3) == std::string::npos ? std::stoi(run.substr(3)) : 1;
}

} // namespace

//------------------------------------------------------------------------------
RunFigures MeasureOurs(const BenchmarkedVolume& volume, const SurfaceBenchmarkOptions& options)
{
  const int threads = ThreadsOf(options.Run);
  vtkSMPTools::Initialize(threads);
  vtkNew<vtkImagePyramid> pyramid;
  pyramid->SetInputData(volume.Image);
  pyramid->SetNumberOfThreads(threads);
  vtkNew<vtkDeformableSurface> deformable;
  deformable->SetInputConnection(pyramid->GetOutputPort());
  deformable->SetIsoValue(volume.IsoValue);
  deformable->SetObjectIsBright(volume.ObjectIsBright);
  deformable->SetMetric(static_cast<int>(options.Metric));
  deformable->SetInitialization(options.Initialization);
  deformable->SetNumberOfThreads(threads);
  int coarsest =
    options.CoarsestLevel >= 0 ? options.CoarsestLevel : CoarsestLevelWithObject(volume);
  if (options.Run == "us-flat")
  {
    pyramid->SetNumberOfLevels(1);
    coarsest = 0;
  }
  deformable->SetCoarsestLevel(coarsest);
  if (options.Run == "us-paper")
  {
    deformable->SetRecovery(vtkDeformableSurface::NoRecovery);
  }
  deformable->SetProfile(options.Profile);

  RunFigures figures;
  figures.Set("CoarsestLevel", coarsest);
  double pyramidSeconds = 0.0;
  WorkModel model;
  HostThreads::UseInstead(options.Model ? &model : nullptr);
  MeasureCost(
    [&]()
    {
      const auto begin = std::chrono::steady_clock::now();
      model.Start();
      pyramid->Update();
      model.EndPhase("Pyramid");
      pyramidSeconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      deformable->Update();
      model.EndPhase("Output");
    },
    figures);
  HostThreads::UseInstead(nullptr);
  if (options.Model)
  {
    SetModel(model, figures);
  }
  vtkPolyData* finest = deformable->GetOutput();
  if (finest->GetNumberOfPoints() == 0)
  {
    throw std::runtime_error("no surface, see the filter's message");
  }
  figures.Set("PyramidSeconds", pyramidSeconds);
  figures.SetText("StopReason", StopReason(finest));
  figures.Set("Level", Field(finest, "Level"));
  vtkMultiBlockDataSet* levels = deformable->GetLevels();
  const int numberOfLevels = static_cast<int>(levels->GetNumberOfBlocks());
  figures.Set("Levels", numberOfLevels);
  SetEfforts(deformable->GetHistory(), numberOfLevels, figures);
  figures.SetText("Fingerprint", Fingerprint(support::ToTriangleSurface(finest)));
  figures.Set("Vertices", static_cast<double>(finest->GetNumberOfPoints()));
  for (int h = 0; h < numberOfLevels; ++h)
  {
    const auto name = [h](const std::string& what)
    { return RunFigures::Indexed("level", h, what); };
    auto* surface = vtkPolyData::SafeDownCast(levels->GetBlock(static_cast<unsigned int>(h)));
    if (!surface || surface->GetNumberOfPoints() == 0)
    {
      continue;
    }
    auto* level =
      vtkImageData::SafeDownCast(pyramid->GetOutput()->GetBlock(static_cast<unsigned int>(h)));
    figures.Set(name("Vertices"), static_cast<double>(surface->GetNumberOfPoints()));
    figures.Set(name("LostParts"), Field(surface, "LostParts"));
    figures.Set(name("RecoveredParts"), Field(surface, "RecoveredParts"));
    if (options.Judge)
    {
      JudgeLevel(surface, volume.Image, level, volume, options.Metric, name(""), figures);
      if (h == static_cast<int>(Field(finest, "Level")))
      {
        JudgeLevel(surface, volume.Image, level, volume, options.Metric, "", figures);
      }
    }
  }
  if (!options.Output.empty())
  {
    vtkNew<vtkXMLPolyDataWriter> writer;
    writer->SetInputData(finest);
    writer->SetFileName(options.Output.c_str());
    if (!writer->Write() || writer->GetErrorCode() != 0)
    {
      throw std::runtime_error(options.Output + ": can't be written");
    }
  }
  return figures;
}

} // namespace volumic::bench
