// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LabelSurface.h"

#include "AlgorithmErrors.h"
#include "BuildPyramid.h"
#include "Core/Common/Refuse.h"
#include "Core/Labels/WrongVoxels.h"
#include "LargeArray.h"
#include "Workspace.h"
#include "vtkImagePyramid.h"
#include "vtkVolumeToSurface.h"

#include <vtkCallbackCommand.h>
#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkCommand.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <cmath>

namespace volumic
{
namespace
{
/** Rounds of finding wrong voxels and holding them further off. */
constexpr int Rounds = 1;

void CheckNumber(const char* name, double value)
{
  if (!(value >= 0.0) || !std::isfinite(value))
  {
    Refuse(name, " is ", value, "; it must be 0 (none) or more.");
  }
}
}

void LabelSettings::Check() const
{
  CheckNumber("Smoothing", this->Smoothing);
  if (this->Smoothing > 10.0)
  {
    Refuse("Smoothing is ", this->Smoothing, " voxels; it must be at most 10.");
  }
  CheckNumber("Gap", this->Gap);
  CheckNumber("Edge Length", this->EdgeLength);
  CheckNumber("Minimum Component Volume", this->MinimumComponentVolume);
  if (this->KeepComponents != vtkDeformableSurface::AllComponents &&
    this->KeepComponents != vtkDeformableSurface::LargestComponent &&
    this->KeepComponents != vtkDeformableSurface::LargeComponents)
  {
    Refuse("Keep Components is ", this->KeepComponents,
      "; for labels it must be 0 (all), 1 (the largest) or 3 (large ones).");
  }
}

LabelSurfaceMaker::LabelSurfaceMaker(
  const LabelBricks& bricks, vtkImageData* image, const LabelSettings& settings)
  : Bricks(bricks)
  , Image(image)
  , Settings(settings)
  , Claims(bricks)
{
  const std::array<double, 3>& spacing = bricks.Map().Spacing;
  this->Options.Sigma = settings.Smoothing * *std::max_element(spacing.begin(), spacing.end());
}

void LabelSurfaceMaker::AddClaim(int object, HostThreads& threads)
{
  threads.Run([&]
    { this->Claims.Add(object, MakeLabelField(this->Bricks, object, this->Options, {}, threads)); });
}

vtkSmartPointer<vtkImageData> LabelSurfaceMaker::MakeFieldImage(
  int object, const std::vector<HeldVoxel>& held, HostThreads& threads) const
{
  LabelField field;
  threads.Run(
    [&] { field = MakeLabelField(this->Bricks, object, this->Options, held, threads); });
  this->Claims.Settle(object, field);
  auto image = vtkSmartPointer<vtkImageData>::New();
  const int* extent = this->Image->GetExtent();
  int box[6];
  for (int axis = 0; axis < 3; ++axis)
  {
    box[2 * axis] = extent[2 * axis] + field.Box.First[axis];
    box[2 * axis + 1] = extent[2 * axis] + field.Box.End[axis] - 1;
  }
  image->SetExtent(box);
  image->SetOrigin(this->Image->GetOrigin());
  image->SetSpacing(this->Image->GetSpacing());
  image->SetDirectionMatrix(this->Image->GetDirectionMatrix());
  const auto unit = static_cast<float>(Workspace(this->Image, Metric::World).WorldUnit());
  auto values = NewLargeArray<vtkFloatArray>(field.Values.size());
  std::transform(field.Values.begin(), field.Values.end(), values->GetPointer(0),
    [unit](float value) { return unit * value; });
  values->SetName("Distance");
  image->GetPointData()->SetScalars(values);
  return image;
}

std::vector<std::int64_t> LabelSurfaceMaker::FindWrong(int object, vtkPolyData* surface) const
{
  const Workspace voxels(this->Image, Metric::Voxels);
  IndexedSurface indexed;
  const vtkIdType count = surface->GetNumberOfPoints();
  indexed.Points.resize(static_cast<std::size_t>(count));
  for (vtkIdType i = 0; i < count; ++i)
  {
    Point world;
    surface->GetPoint(i, world.data());
    indexed.Points[static_cast<std::size_t>(i)] = voxels.ToWorkspace(world);
  }
  const int second = voxels.IsMirrored() ? 2 : 1;
  auto cells = vtk::TakeSmartPointer(surface->GetPolys()->NewIterator());
  for (cells->GoToFirstCell(); !cells->IsDoneWithTraversal(); cells->GoToNextCell())
  {
    vtkIdType size = 0;
    const vtkIdType* corners = nullptr;
    cells->GetCurrentCell(size, corners);
    indexed.Triangles.push_back({ static_cast<int>(corners[0]),
      static_cast<int>(corners[second]), static_cast<int>(corners[3 - second]) });
  }
  return FindWrongVoxels(this->Bricks, object, indexed);
}

LabelSurface LabelSurfaceMaker::Evolve(vtkImageData* field, vtkPolyData* start,
  int numberOfThreads, const Progress& progress) const
{
  LabelSurface made;
  vtkNew<vtkVolumeToSurface> filter;
  filter->SetController(nullptr);
  filter->SetInputData(field);
  filter->SetIsoValue(0.5 * this->Settings.Gap);
  filter->SetMetric(this->Settings.Metric);
  filter->SetEdgeLength(this->Settings.EdgeLength);
  filter->SetKeepComponents(this->Settings.KeepComponents);
  filter->SetMinimumComponentVolume(this->Settings.MinimumComponentVolume);
  filter->SetNumberOfThreads(numberOfThreads);
  int finest = this->Settings.FinestLevel;
  if (this->Settings.EdgeLength != 0.0)
  {
    vtkNew<vtkImagePyramid> pyramid;
    finest = PlanEdgeLength(
      this->Settings.EdgeLength, filter->GetSamplingRatio(), field, pyramid).FinestLevel;
  }
  else
  {
    filter->SetFinestLevel(finest);
  }
  filter->SetCoarsestLevel(std::max(finest, 0));
  filter->SetRecovery(vtkDeformableSurface::NoRecovery);
  filter->SetInitialization(vtkDeformableSurface::IsoSurface);
  if (start)
  {
    filter->SetInitialization(vtkDeformableSurface::InputSurface);
    filter->SetInitialSurfaceData(start);
  }
  struct Host
  {
    const Progress& Report;
    std::vector<std::string>& Warnings;
  } host{ progress, made.Warnings };
  vtkNew<vtkCallbackCommand> follow;
  follow->SetClientData(&host);
  follow->SetCallback(
    [](vtkObject* caller, unsigned long event, void* client, void* data)
    {
      auto* filter = static_cast<vtkAlgorithm*>(caller);
      auto* host = static_cast<Host*>(client);
      if (event == vtkCommand::WarningEvent)
      {
        host->Warnings.emplace_back(static_cast<const char*>(data));
        return;
      }
      const char* text = filter->GetProgressText();
      if (!host->Report(filter->GetProgress(), text ? text : ""))
      {
        filter->SetAbortExecute(1);
      }
    });
  filter->AddObserver(vtkCommand::ProgressEvent, follow);
  filter->AddObserver(vtkCommand::WarningEvent, follow);
  made.Error = UpdateAndCollectErrors(filter);
  made.Surface = filter->GetOutput();
  return made;
}

LabelSurface LabelSurfaceMaker::Make(
  int object, int numberOfThreads, HostThreads& threads, const Progress& progress) const
{
  std::vector<HeldVoxel> held;
  LabelSurface made;
  for (int round = 0;; ++round)
  {
    const vtkSmartPointer<vtkImageData> field = this->MakeFieldImage(object, held, threads);
    const vtkSmartPointer<vtkPolyData> start = made.Surface;
    made = this->Evolve(field, start, numberOfThreads, progress);
    const std::vector<std::int64_t> wrong = this->FindWrong(object, made.Surface);
    made.WrongVoxels = static_cast<vtkIdType>(wrong.size());
    if (wrong.empty() || round == Rounds || !made.Error.empty() || !progress(1.0, ""))
    {
      return made;
    }
    for (const std::int64_t voxel : wrong)
    {
      held.push_back({ voxel, 0.3f });
    }
  }
}
}
