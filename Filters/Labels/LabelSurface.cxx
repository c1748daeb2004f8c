// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Labels/LabelSurface.h"

#include "Core/Labels/WrongVoxels.h"
#include "Core/Mesh/SurfaceFeatures.h"
#include "Input/Workspace.h"
#include "Output/SurfaceOutput.h"
#include "Pyramid/PyramidBlocks.h"
#include "Run/SurfaceSegmentation.h"

#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace volumic
{
namespace
{
/** Share of the work on a label that its field is. */
constexpr double FieldShare = 0.2;

/**
 * Smoothing is in smallest distances of voxels, or in this share of the longest, if that is more:
 * stairs are as high as voxels are long; but with all of it bulges what is thin along other axes.
 */
constexpr double ShareOfLongest = 0.625;

/** Labels whose volumes are off are made with half the smoothing down to this, in the same. */
constexpr double LeastSmoothing = 1.0;

/** More than so many times the smoothing a share of the longest is enough: thick slices are few. */
constexpr double MostBeyondVoxel = 2.5;

/** A part of so many voxels that level 0 has lost is worth three times the triangles, */
constexpr std::int64_t LostPartSize = 8;

/** but of a large label one of so many: a mask of a whole head has crumbs about it. */
constexpr std::int64_t LostPartShare = 20000;

/** In smallest distances of voxels: boundaries are twice as far from centres. */
constexpr double MostHarmlessHalfGap = 0.25;

/** One of so many voxels on the wrong side is, too. */
constexpr std::int64_t SeverelyLost = 4;

/** Share of what is left of the work on a label that a surface is, where it may be made again. */
constexpr double ShareOfFirst = 0.7;

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

double VolumeErrorOf(const IndexedSurface& inVoxels, std::int64_t voxels)
{
  return ComputeFeatures(inVoxels).Volume / static_cast<double>(voxels) - 1.0;
}

LabelFieldOptions LabelSurfaceMaker::FieldOptions(
  const LabelSettings& settings, const LabelMap& map)
{
  const double longest = *std::max_element(map.Spacing.begin(), map.Spacing.end());
  LabelFieldOptions options;
  options.Sigma = std::min(settings.Smoothing * std::max(1.0, ShareOfLongest * longest),
    std::max(settings.Smoothing * MostBeyondVoxel, ShareOfLongest * longest));
  options.Tolerance = settings.VoxelTolerance;
  return options;
}

EdgeLengthPlan LabelSurfaceMaker::PlanOf(const LabelSettings& settings, vtkImageData* image)
{
  if (settings.EdgeLength == 0.0)
  {
    return {};
  }
  // Fields get as much room as their levels need, whatever the size of the image.
  constexpr int enough = 1 << 12;
  vtkNew<vtkImageData> frame;
  frame->SetDimensions(enough, enough, enough);
  frame->SetSpacing(image->GetSpacing());
  PyramidOptions pyramid;
  return PlanEdgeLength(settings.EdgeLength, SurfaceOptions().SamplingRatio, frame, pyramid);
}

LabelSurfaceMaker::LabelSurfaceMaker(
  const LabelBricks& bricks, vtkImageData* image, const LabelSettings& settings)
  : Bricks(bricks), Image(image), Settings(settings), Claims(bricks),
    Lowered(static_cast<std::size_t>(bricks.Map().NumberOfObjects) + 1)
{
  this->Options = FieldOptions(settings, bricks.Map());
  this->Plan = PlanOf(settings, image);
}

SegmentationRequest LabelSurfaceMaker::MakeRequest(
  const Place& place, vtkImageData* field, int numberOfThreads, const Progress& progress) const
{
  const int level = place.Level;
  SegmentationRequest request;
  request.Progress = [&progress](double share, const std::string& text)
  { return progress(FieldShare + (1.0 - FieldShare) * share, text); };
  request.Warn = [](const std::string&) {}; // Of all labels that are empty one warning tells.
  request.Selection = SelectScalars();
  SegmentationSettings& settings = request.Settings;
  settings.End.NumberOfThreads = numberOfThreads;
  settings.Options.IsoValue = this->HalfGap();
  // The field's iso-surface has all parts but those too thin for its triangles.
  settings.Recovery =
    place.IsForThinParts ? RecoveryType::RecoverObjects : RecoveryType::NoRecovery;
  settings.Metric = static_cast<Metric>(this->Settings.Metric);
  settings.EdgeLength = this->Settings.EdgeLength;
  settings.Grading = this->Settings.Grading;
  settings.Grading.ThinParts = place.IsForThinParts;
  settings.End.KeepComponents = static_cast<KeepComponentsType>(this->Settings.KeepComponents);
  settings.End.MinimumComponentVolume = this->Settings.MinimumComponentVolume;
  settings.Initialization = InitializationType::IsoSurface;
  settings.End.FinestLevel = level;
  PyramidRequest pyramid;
  if (settings.EdgeLength != 0.0)
  {
    settings.Options.SamplingRatio = this->Plan.SamplingRatio;
    pyramid.Levels.ReductionFactor = this->Plan.ReductionFactor;
    request.FactorBelowLevel0 = this->Plan.ReductionFactor;
  }
  // No coarser ones, not even above level -1: what is thin, or hollow, would be lost there.
  settings.CoarsestLevel = std::max(level, 0);
  settings.BeginsBelowImage = level < 0 && !place.IsForThinParts;
  pyramid.Levels.NumberOfLevels = settings.CoarsestLevel + 1;
  pyramid.NumberOfThreads = 1;
  pyramid.Progress = [&progress](double, const std::string&)
  { return progress(FieldShare, "Pyramid of the field"); };
  vtkSmartPointer<vtkImageData> image = field;
  if (settings.CoarsestLevel > 0)
  {
    image = PadForLevel(field, pyramid.Levels.ReductionFactor, settings.CoarsestLevel);
  }
  request.LevelsAreOwn = true;
  request.Levels = BuildPyramid(image, request.Selection, -1, pyramid);
  return request;
}

double LabelSurfaceMaker::AllowedDistance() const
{
  return this->Settings.VoxelTolerance +
    this->Settings.Grading.Tolerance / Workspace(this->Image, Metric::World).WorldUnit();
}

bool LabelSurfaceMaker::LosesParts(int object, const LabelSurface& made) const
{
  if (made.Surface->GetNumberOfCells() == 0)
  {
    return this->Bricks.ExtentOf(object).Voxels > 0;
  }
  // What is taken away on purpose is not lost; no small gap takes centres away.
  if (this->HalfGap() > MostHarmlessHalfGap ||
    static_cast<KeepComponentsType>(this->Settings.KeepComponents) !=
      KeepComponentsType::AllComponents)
  {
    return false;
  }
  const std::int64_t voxels = this->Bricks.ExtentOf(object).Voxels;
  const std::int64_t worth = std::max(LostPartSize, voxels / LostPartShare);
  return SeverelyLost * made.MissedVoxels > voxels ||
    (this->Settings.Gap == 0.0 && made.MissedVoxels >= worth &&
      SizeOfLargestLostPart(this->Bricks.Map(), object,
        this->FindMissed(object, this->InVoxels(object, made.Surface))) >= worth);
}

std::vector<LabelSurfaceMaker::Place> LabelSurfaceMaker::PlacesToTry(int object) const
{
  Place first{ this->FinestLevel() };
  const bool mayGoFiner = first.Level == 0 && this->Settings.EdgeLength == 0.0;
  if (this->Settings.Grading.ThinParts && first.Level <= 0)
  {
    first = { -1, true };
  }
  std::vector<Place> places{ first };
  if (mayGoFiner)
  {
    places.push_back({ -1 });
    if (this->Lowered[static_cast<std::size_t>(object)].IsFiner)
    {
      places.erase(places.begin());
    }
  }
  if (this->Options.Tolerance > 0.0)
  {
    // Voxels that hold a part cost less than triangles that do.
    for (std::size_t p = 0; p < places.size(); p += 2)
    {
      Place strict = places[p];
      strict.IsStrict = true;
      places.insert(places.begin() + static_cast<std::ptrdiff_t>(p) + 1, strict);
    }
  }
  return places;
}

LabelSurface LabelSurfaceMaker::Make(
  int object, int numberOfThreads, HostThreads& threads, const Progress& progress) const
{
  LabelSurface best;
  double done = 0.0;
  for (const Place& place : this->PlacesToTry(object))
  {
    const bool losesParts = !best.Surface || this->LosesParts(object, best);
    // Where labels meet by threes a tolerance may cost volume.
    const bool isOff =
      !losesParts && place.IsStrict && place.Level <= 0 && this->HasVolumeOff(object, best);
    if (!losesParts && !isOff)
    {
      break;
    }
    const double share = ShareOfFirst * (1.0 - done);
    LabelSurface made = this->MakeWithVolume(place, object, numberOfThreads, threads,
      [&](double ofThis, const std::string& text)
      { return progress(done + share * ofThis, text); });
    done += share;
    if (!made.Surface)
    {
      break; // It was stopped; what there is is finished.
    }
    const bool isBetter = !best.Surface || best.Surface->GetNumberOfCells() == 0 ||
      (isOff ? std::abs(made.VolumeError) < std::abs(best.VolumeError)
             : made.MissedVoxels < best.MissedVoxels);
    made.IsFiner = place.Level < 0 && !place.IsForThinParts;
    best = isBetter ? made : best;
  }
  return best;
}

bool LabelSurfaceMaker::HasVolumeOff(int object, const LabelSurface& made) const
{
  return made.Surface->GetNumberOfCells() > 0 && this->Settings.Gap == 0.0 &&
    this->Settings.KeepComponents == 0 && made.IsVolumeOff(this->Bricks.ExtentOf(object).Voxels);
}

LabelSurface LabelSurfaceMaker::MakeWithVolume(const Place& place, int object, int numberOfThreads,
  HostThreads& threads, const Progress& progress) const
{
  LabelSurface made = this->MakeAt(place, object, numberOfThreads, threads, progress);
  const auto stayAtEnd = [&](double, const std::string& text) { return progress(1.0, text); };
  for (Place less = place; made.Surface && place.Level <= 0 && this->HasVolumeOff(object, made) &&
       less.Smoothing * this->Options.Sigma > LeastSmoothing;)
  {
    less.Smoothing *= 0.5;
    const LabelSurface other = this->MakeAt(less, object, numberOfThreads, threads, stayAtEnd);
    if (!other.Surface)
    {
      break; // It was stopped; what there is is finished.
    }
    if (std::abs(other.VolumeError) < std::abs(made.VolumeError))
    {
      made = other;
    }
  }
  return made;
}

LabelSurface LabelSurfaceMaker::MakeAt(const Place& place, int object, int numberOfThreads,
  HostThreads& threads, const Progress& progress) const
{
  const int level = place.Level;
  LabelSurface made;
  made.Surface = MakeStopped(level, "vanished");
  FieldImage field = this->MakeField(place, object, threads);
  if (!progress(FieldShare, "Field of the label"))
  {
    made.Surface = nullptr;
    return made;
  }
  const LabelExtent& extent = this->Bricks.ExtentOf(object);
  made.WrongVoxels = made.MissedVoxels = extent.Voxels;
  const LabelField original = this->Settings.Gap > 0.0 ? field.Field : LabelField();
  try
  {
    SegmentationRequest request = this->MakeRequest(place, field.Image, numberOfThreads, progress);
    if (!request.Levels)
    {
      made.Surface = nullptr;
      return made;
    }
    const Point step = Workspace(this->Image, request.Settings.Metric).Step();
    Revision revision;
    request.Revise = [&](const SurfaceResult& surface)
    {
      IndexedSurface inVoxels = surface;
      for (Point& p : inVoxels.Points)
      {
        p = InMap({ p[0] / step[0], p[1] / step[1], p[2] / step[2] }, field.Field.Box.First);
      }
      return this->ReviseField(object, revision, inVoxels, original, field);
    };
    SurfaceSegmentation run(request);
    request.Levels = nullptr;
    run.Run();
    vtkPolyData* surface = run.Results().Outcome(run.EndsAt());
    if (!surface)
    {
      made.Surface = nullptr;
      return made;
    }
    ScaleResidual(surface, Workspace(this->Image, Metric::World).WorldUnit());
    made.Surface = surface;
    const IndexedSurface inVoxels = this->InVoxels(object, surface);
    const std::vector<std::int64_t> wrong = FindWrongVoxels(this->Bricks, object, inVoxels);
    made.WrongVoxels = static_cast<vtkIdType>(wrong.size());
    made.VolumeError = VolumeErrorOf(inVoxels, extent.Voxels);
    made.MissedVoxels = static_cast<vtkIdType>(
      FindMissedVoxels(this->Bricks.Map(), wrong, inVoxels, this->AllowedDistance()).size());
  }
  catch (const std::invalid_argument&)
  {
    // Settings are checked before: it is too small or too thin for such triangles, and stays empty.
  }
  return made;
}
}
