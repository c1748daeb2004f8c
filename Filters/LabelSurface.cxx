// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LabelSurface.h"

#include "BuildPyramid.h"
#include "Core/Common/Communicator.h"
#include "Core/Common/Refuse.h"
#include "Core/Labels/DrawBack.h"
#include "Core/Labels/WrongVoxels.h"
#include "SegmentationRequest.h"
#include "SegmentationSettings.h"
#include "SurfaceOutput.h"
#include "SurfaceSegmentation.h"
#include "Workspace.h"
#include "vtkImagePyramid.h"

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace volumic
{
namespace
{
/** Share of the work on a label that its field is. */
constexpr double FieldShare = 0.2;

/**
 * Margins of voxels that the triangles have cut off, round after round of the surface, in smallest
 * distances of voxels.
 */
constexpr std::array<float, 2> FurtherMargins = { 0.3f, 0.5f };

/**
 * Smoothing is in smallest distances of voxels, or in this share of the longest, if that is more:
 * stairs are as high as voxels are long; but with all of it bulges what is thin along other axes.
 */
constexpr double ShareOfLongest = 0.625;

/**
 * Of a coarser level: how much of its Laplacian is taken off the field, times the square of the
 * level's unit less 1. A quarter makes up for the Gaussian of the pyramid, the rest for chords.
 */
constexpr double BendPerLevel = 0.4;

/** The same for a gap, times which triangles that leave their own field's inside are drawn back. */
constexpr int RoundsOfGap = 6;

void CheckNumber(const char* name, double value)
{
  if (!(value >= 0.0) || !std::isfinite(value))
  {
    Refuse(name, " is ", value, "; it must be 0 (none) or more.");
  }
}

/** That of the active scalars, as GetInputArrayInformation(). */
vtkSmartPointer<vtkInformation> SelectScalars()
{
  auto selection = vtkSmartPointer<vtkInformation>::New();
  selection->Set(vtkDataObject::FIELD_ASSOCIATION(), vtkDataObject::FIELD_ASSOCIATION_POINTS);
  selection->Set(vtkDataObject::FIELD_ATTRIBUTE_TYPE(), vtkDataSetAttributes::SCALARS);
  return selection;
}

/**
 * The field in a larger image, so that a coarser level of it has the voxels that it needs, and room
 * about the object.
 */
vtkSmartPointer<vtkImageData> PadForLevel(vtkImageData* field, double factor, int level)
{
  constexpr double leastVoxels = 10.0; // At the level, along each axis.
  constexpr double room = 2.0;         // Voxels of the level on each side.
  const double scale = std::pow(factor, level);
  int old[6];
  int box[6];
  field->GetExtent(old);
  for (int axis = 0; axis < 3; ++axis)
  {
    const int size = old[2 * axis + 1] - old[2 * axis] + 1;
    const int wanted =
      static_cast<int>(std::ceil(std::max(size + 2.0 * room * scale, leastVoxels * scale)));
    box[2 * axis] = old[2 * axis] - (wanted - size) / 2;
    box[2 * axis + 1] = box[2 * axis] + wanted - 1;
  }
  auto padded = vtkSmartPointer<vtkImageData>::New();
  padded->CopyStructure(field);
  padded->SetExtent(box);
  padded->AllocateScalars(VTK_FLOAT, 1);
  padded->GetPointData()->GetScalars()->SetName("Distance");
  auto* values = static_cast<float*>(padded->GetScalarPointer());
  std::fill(values, values + padded->GetNumberOfPoints(),
    *static_cast<float*>(field->GetScalarPointer())); // A corner of the box is far outside.
  for (int k = old[4]; k <= old[5]; ++k)
  {
    for (int j = old[2]; j <= old[3]; ++j)
    {
      const auto* row = static_cast<float*>(field->GetScalarPointer(old[0], j, k));
      std::copy(row, row + (old[1] - old[0] + 1),
        static_cast<float*>(padded->GetScalarPointer(old[0], j, k)));
    }
  }
  return padded;
}

/** Multiplies the residuals, which are in smallest distances of voxels. */
void ScaleResidual(vtkPolyData* surface, double unit)
{
  for (vtkDataArray* residual : { surface->GetPointData()->GetArray("Residual"),
         surface->GetFieldData()->GetArray("ResidualQuantile") })
  {
    for (vtkIdType i = 0; residual && i < residual->GetNumberOfTuples(); ++i)
    {
      residual->SetComponent(i, 0, unit * residual->GetComponent(i, 0));
    }
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
  if (this->FinestLevel < -1)
  {
    Refuse("Finest Level is ", this->FinestLevel, "; it must be -1 or more.");
  }
  if (this->Metric != 0 && this->Metric != 1)
  {
    Refuse("Metric is ", this->Metric, "; it must be 0 (Voxels) or 1 (World).");
  }
  const auto keep = static_cast<KeepComponentsType>(this->KeepComponents);
  if (keep != KeepComponentsType::AllComponents && keep != KeepComponentsType::LargestComponent &&
    keep != KeepComponentsType::LargeComponents)
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
  const double longest = *std::max_element(spacing.begin(), spacing.end());
  this->Options.Sigma = settings.Smoothing * std::max(1.0, ShareOfLongest * longest);
  if (settings.EdgeLength != 0.0)
  {
    // Fields get as much room as their levels need, whatever the size of the image.
    constexpr int enough = 1 << 12;
    vtkNew<vtkImageData> frame;
    frame->SetDimensions(enough, enough, enough);
    frame->SetSpacing(image->GetSpacing());
    vtkNew<vtkImagePyramid> pyramid;
    this->Plan =
      PlanEdgeLength(settings.EdgeLength, SurfaceOptions().SamplingRatio, frame, pyramid);
  }
}

void LabelSurfaceMaker::AddClaim(int object, HostThreads& threads)
{
  threads.Run(
    [&]
    { this->Claims.Add(object, MakeLabelField(this->Bricks, object, this->Options, threads)); });
}

LabelSurfaceMaker::FieldImage LabelSurfaceMaker::MakeField(
  int object, HostThreads& threads) const
{
  FieldImage made;
  threads.Run([&] { made.Field = MakeLabelField(this->Bricks, object, this->Options, threads); });
  this->Claims.Settle(object, made.Field);
  const int level = this->Settings.EdgeLength != 0.0 ? this->Plan.FinestLevel
                                                     : this->Settings.FinestLevel;
  if (level > 0)
  {
    const double squaredFactor = std::pow(this->LevelFactor(), 2 * level);
    threads.Run(
      [&]
      {
        CorrectBends(
          made.Field, this->Bricks, object, BendPerLevel * (squaredFactor - 1.0), threads);
      });
  }
  made.Image = vtkSmartPointer<vtkImageData>::New();
  const int* extent = this->Image->GetExtent();
  int box[6];
  for (int axis = 0; axis < 3; ++axis)
  {
    box[2 * axis] = extent[2 * axis] + made.Field.Box.First[axis];
    box[2 * axis + 1] = extent[2 * axis] + made.Field.Box.End[axis] - 1;
  }
  made.Image->SetExtent(box);
  made.Image->SetOrigin(this->Image->GetOrigin());
  made.Image->SetSpacing(this->Image->GetSpacing());
  made.Image->SetDirectionMatrix(this->Image->GetDirectionMatrix());
  vtkNew<vtkFloatArray> values;
  values->SetName("Distance");
  constexpr int isOurs = 1;
  values->SetArray(
    made.Field.Values.data(), static_cast<vtkIdType>(made.Field.Values.size()), isOurs);
  made.Image->GetPointData()->SetScalars(values);
  return made;
}

SegmentationVolume LabelSurfaceMaker::MakeVolume(
  vtkImageData* field, const Progress& progress) const
{
  SegmentationVolume volume;
  volume.Selection = SelectScalars();
  SegmentationSettings& settings = volume.Settings;
  const double unit = Workspace(this->Image, Metric::World).WorldUnit();
  settings.Options.IsoValue = 0.5 * this->Settings.Gap / unit;
  settings.Options.RecoverLostParts = false;
  settings.Recovery = RecoveryType::NoRecovery;
  settings.Metric = static_cast<Metric>(this->Settings.Metric);
  settings.EdgeLength = this->Settings.EdgeLength;
  settings.KeepComponents = static_cast<KeepComponentsType>(this->Settings.KeepComponents);
  settings.MinimumComponentVolume = this->Settings.MinimumComponentVolume;
  settings.Initialization = InitializationType::IsoSurface;
  settings.End.FinestLevel = this->Settings.FinestLevel;
  vtkNew<vtkImagePyramid> pyramid;
  if (settings.EdgeLength != 0.0)
  {
    settings.End.FinestLevel = this->Plan.FinestLevel;
    settings.Options.SamplingRatio = this->Plan.SamplingRatio;
    pyramid->SetReductionFactor(this->Plan.ReductionFactor);
    volume.FactorBelowLevel0 = this->Plan.ReductionFactor;
    volume.EdgeLengthIsPlanned = true;
  }
  // No coarser ones: what is thin, or hollow, would be lost there.
  settings.CoarsestLevel = std::max(settings.End.FinestLevel, 0);
  pyramid->SetNumberOfLevels(settings.CoarsestLevel + 1);
  pyramid->SetNumberOfThreads(1);
  vtkSmartPointer<vtkImageData> image = field;
  if (settings.CoarsestLevel > 0)
  {
    image = PadForLevel(field, pyramid->GetReductionFactor(), settings.CoarsestLevel);
  }
  volume.LevelsAreOwn = true;
  SingleRank alone;
  volume.Levels = BuildPyramid(alone, pyramid, image, volume.Selection,
    [&](double) { return progress(FieldShare, "Pyramid of the field"); });
  return volume;
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

bool LabelSurfaceMaker::ReviseField(int object, int round, const IndexedSurface& surface,
  const LabelField& original, LabelField& field) const
{
  if (this->Settings.Gap > 0.0)
  {
    const double unit = Workspace(this->Image, Metric::World).WorldUnit();
    return round < RoundsOfGap &&
      DrawBackWithin(original, surface, static_cast<float>(0.5 * this->Settings.Gap / unit), field);
  }
  if (round >= static_cast<int>(FurtherMargins.size()) || this->Settings.Smoothing == 0.0)
  {
    return false;
  }
  std::vector<HeldVoxel> held;
  for (const std::int64_t voxel : FindWrongVoxels(this->Bricks, object, surface))
  {
    held.push_back({ voxel, FurtherMargins[static_cast<std::size_t>(round)] });
  }
  if (!held.empty())
  {
    HoldFurther(field, this->Bricks, object, this->Options, held, OnThisThread());
  }
  return !held.empty();
}

LabelSurface LabelSurfaceMaker::Make(
  int object, int numberOfThreads, HostThreads& threads, const Progress& progress) const
{
  LabelSurface made;
  made.Surface = MakeStopped(std::max(this->Settings.FinestLevel, 0), "vanished");
  FieldImage field = this->MakeField(object, threads);
  if (!progress(FieldShare, "Field of the label"))
  {
    made.Surface = nullptr;
    return made;
  }
  const LabelExtent& extent = this->Bricks.ExtentOf(object);
  made.WrongVoxels = extent.Voxels;
  SegmentationRequest request;
  request.Progress = [&](double share, const std::string& text)
  { return progress(FieldShare + (1.0 - FieldShare) * share, text); };
  request.Warn = [](const std::string&) {}; // Of all labels that are empty one warning tells.
  const LabelField original = this->Settings.Gap > 0.0 ? field.Field : LabelField();
  try
  {
    const SegmentationVolume volume = this->MakeVolume(field.Image, progress);
    if (!volume.Levels)
    {
      made.Surface = nullptr;
      return made;
    }
    request.End = volume.Settings.End;
    request.End.NumberOfThreads = numberOfThreads;
    const Point step = Workspace(this->Image, volume.Settings.Metric).Step();
    Point first;
    std::copy(field.Field.Box.First.begin(), field.Field.Box.First.end(), first.begin());
    int round = 0;
    request.Revise = [&](const SurfaceResult& surface)
    {
      IndexedSurface inVoxels = surface;
      for (Point& p : inVoxels.Points)
      {
        for (int axis = 0; axis < 3; ++axis)
        {
          p[axis] = first[axis] + p[axis] / step[axis];
        }
      }
      return this->ReviseField(object, round++, inVoxels, original, field.Field);
    };
    SurfaceSegmentation run(volume, request);
    run.Run();
    vtkPolyData* surface = run.Results().Outcome(run.EndsAt());
    if (!surface)
    {
      made.Surface = nullptr;
      return made;
    }
    ScaleResidual(surface, Workspace(this->Image, Metric::World).WorldUnit());
    made.Surface = surface;
    made.WrongVoxels = static_cast<vtkIdType>(this->FindWrong(object, surface).size());
  }
  catch (const std::invalid_argument&)
  {
    // Settings are checked before: it is too small or too thin for such triangles, and stays empty.
  }
  return made;
}
}
