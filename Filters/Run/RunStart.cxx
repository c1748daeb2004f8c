// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/RunStart.h"

#include "Core/Common/ThrowInvalidArgument.h"
#include "Input/ComputationalSpace.h"
#include "Input/InputPoints.h"
#include "Pyramid/PyramidLevels.h"

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkTriangleFilter.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

namespace volumic
{
namespace
{
/** Return the requested levels. CoarsestLevel -1 is the last that is large enough. */
LevelChoice RequestedLevels(const PyramidLevels& pyramid, const SegmentationSettings& settings)
{
  LevelChoice choice;
  const int last = pyramid.NumberOfLevels() - 1;
  choice.Coarsest = settings.CoarsestLevel;
  if (settings.CoarsestLevel == -1)
  {
    // A pyramid may have levels of a single voxel.
    for (choice.Coarsest = last; !pyramid.HasRoom(choice.Coarsest);)
    {
      --choice.Coarsest;
    }
  }
  const int finest = settings.End.FinestLevel;
  if (choice.Coarsest < 0 || choice.Coarsest > last)
  {
    ThrowInvalidArgument("Coarsest Level is ", settings.CoarsestLevel,
      ", but the pyramid has levels 0 to ", last,
      ". Set it to one of these, or to -1 (automatic).");
  }
  if (settings.EdgeLength != 0.0 && finest > choice.Coarsest)
  {
    ThrowInvalidArgument("Edge Length is ", settings.EdgeLength, ", for which the finest level is ",
      finest, ", but Coarsest Level is ", settings.CoarsestLevel,
      ". Set Coarsest Level to at least ", finest, ", or to -1 (automatic).");
  }
  if (finest < -1 || finest > choice.Coarsest)
  {
    ThrowInvalidArgument("Finest Level is ", finest, ". Set it to 0 to ", choice.Coarsest,
      ", the coarsest level, or to -1 for a subdivision beyond the image.");
  }
  while (choice.Preview < choice.Coarsest &&
    pyramid.NumberOfVoxels(choice.Preview) > LevelChoice::MaximumPreviewVoxels)
  {
    ++choice.Preview;
  }
  return choice;
}

/** @param folded range of the voxels after FoldVoxels() */
void CheckFolded(const ValueRange& range, const std::array<double, 2>& folded)
{
  const bool hasNone = folded[1] <= range.Lower;
  if (hasNone || folded[0] >= range.Lower)
  {
    ThrowInvalidArgument(hasNone ? "no voxel is" : "all voxels are", " between Iso Value, ",
      range.Lower, ", and Upper Value, ", range.Upper,
      ". Set them to the range of the object's values.");
  }
}

void CheckIsoValue(double iso, const std::array<double, 2>& range)
{
  if (!(range[0] < range[1]))
  {
    ThrowInvalidArgument("all voxels are ", range[0],
      ", so no value separates an object from the background. Choose another image, array or "
      "component.");
  }
  if (std::isnan(iso))
  {
    ThrowInvalidArgument("Iso Value is not set. Set it to the value that separates the object from "
                         "the background. The "
                         "voxels range from ",
      range[0], " to ", range[1], ".");
  }
  if (iso <= range[0] || iso >= range[1])
  {
    const char* where = iso < range[0] || iso > range[1] ? "outside" : "at an end of";
    ThrowInvalidArgument("Iso Value is ", iso, ", ", where,
      " the range of the voxels. Set it between ", range[0], " and ", range[1], ".");
  }
}

/** Return the coarsest level, at most `from`, with a voxel of the object, or 0. */
int CoarsestLevelWithObject(
  const SegmentationLevels& levels, const SurfaceOptions& options, int from)
{
  int level = from;
  for (; level > 0; --level)
  {
    const std::array<double, 2> range = levels.Range(level);
    if (options.ObjectIsBright ? range[1] > options.IsoValue : range[0] < options.IsoValue)
    {
      break;
    }
  }
  return level;
}

/**
 * Start at the coarsest level with a sufficiently large part of the object, between the level to
 * end at and `withObject`, the coarsest level with a voxel of it.
 */
void StartWhereContained(LevelChoice& choice, int withObject, const SegmentationLevels& levels,
  const SurfaceOptions& options)
{
  const int last = std::exchange(choice.Coarsest, withObject);
  // With recovery a vanished surface is recovered, and the last level takes little time.
  if (!options.Drive().IsFieldAlone || (options.RecoverMissedParts && withObject == last))
  {
    return;
  }
  int level = withObject;
  while (level > std::max(choice.Last, 0) && !levels.ContainsObject(level, options))
  {
    --level;
  }
  choice.StartsAtParts = options.RecoverMissedParts && levels.ContainsObject(level, options);
  choice.Coarsest = options.RecoverMissedParts && !choice.StartsAtParts ? withObject : level;
}

/** @param withObject coarsest level with a voxel of the object, finer than choice.Coarsest */
[[noreturn]] void ThrowInvalidCoarsestLevel(
  const LevelChoice& choice, const SegmentationSettings& settings, int withObject)
{
  const ValueRange range = settings.Range();
  const std::string where = range.IsUsed()
    ? Join(settings.Options.ObjectIsBright ? "" : "not ", "between Iso Value ", range.Lower,
        " and Upper Value ", range.Upper)
    : Join(settings.Options.ObjectIsBright ? "above" : "below", " Iso Value ", range.Lower);
  if (settings.EdgeLength != 0.0 && choice.Coarsest == choice.Last)
  {
    ThrowInvalidArgument("Edge Length is ", settings.EdgeLength, ", for which the finest level is ",
      choice.Last, ", but no voxel is ", where,
      " at this level, as the object is too thin. Set a shorter Edge Length.");
  }
  ThrowInvalidArgument("no voxel is ", where, " at the coarsest level, ", choice.Coarsest,
    ", as the object is too thin. Set Coarsest Level to ", withObject, " or less.");
}

void StartAtObject(
  LevelChoice& choice, const SegmentationLevels& levels, const SegmentationSettings& settings)
{
  // Attracting points are part of the object at every level.
  const int withObject = levels.HasPoints()
    ? choice.Coarsest
    : CoarsestLevelWithObject(levels, settings.Options, choice.Coarsest);
  choice.Preview = std::min(choice.Preview, withObject);
  choice.Last = settings.End.Preview ? std::max(settings.End.FinestLevel, choice.Preview)
                                     : settings.End.FinestLevel;
  if (!levels.HasPoints() && settings.CoarsestLevel == -1 && withObject >= choice.Last)
  {
    StartWhereContained(choice, withObject, levels, settings.Options);
  }
  else if (withObject != choice.Coarsest)
  {
    ThrowInvalidCoarsestLevel(choice, settings, withObject);
  }
}

void StartAtSeeds(
  LevelChoice& choice, const SegmentationLevels& levels, const SegmentationSettings& settings)
{
  const std::size_t all = levels.Seeds().size();
  int level = choice.Coarsest;
  while (level > 0 && levels.SeedsInside(level) < all)
  {
    --level;
  }
  if (settings.CoarsestLevel == -1)
  {
    choice.Preview = std::min(choice.Preview, level);
    choice.Last = settings.End.Preview ? std::max(settings.End.FinestLevel, choice.Preview)
                                       : settings.End.FinestLevel;
    choice.Coarsest = std::max(level, choice.Last);
  }
  // With recovery the objects of other seeds are recovered.
  const std::size_t inside = levels.SeedsInside(choice.Coarsest);
  if (inside == 0 || (inside < all && !settings.Options.RecoverMissedParts))
  {
    const std::string where = Join(choice.Coarsest,
      ", but at this level the object is too thin at ", all - inside, " of ", all, " seeds. ");
    if (settings.CoarsestLevel != -1)
    {
      ThrowInvalidArgument(
        "Coarsest Level is ", where, "Set it to ", level, " or less, or to -1 (automatic).");
    }
    if (settings.EdgeLength != 0.0)
    {
      ThrowInvalidArgument("Edge Length is ", settings.EdgeLength,
        ", for which the finest level is ", where, "Set a shorter Edge Length.");
    }
    ThrowInvalidArgument("Finest Level is ", where, "Set it to ", level, " or less.");
  }
}
}

LevelChoice ChooseLevels(
  SegmentationLevels& levels, const SegmentationSettings& settings, Executor& threads)
{
  LevelChoice choice = RequestedLevels(levels.Pyramid(), settings);
  const ValueRange range = settings.Range();
  if (range.IsUsed())
  {
    CheckFolded(range, levels.Range(0));
  }
  CheckIsoValue(settings.Options.IsoValue, levels.Range(0));
  levels.TestSeeds(settings, choice.Coarsest, threads);
  StartAtObject(choice, levels, settings);
  if (!levels.Seeds().empty())
  {
    StartAtSeeds(choice, levels, settings);
  }
  return choice;
}

namespace
{
IndexedSurface Triangles(vtkPolyData* polyData)
{
  IndexedSurface surface;
  surface.Points.resize(static_cast<std::size_t>(polyData->GetNumberOfPoints()));
  for (std::size_t i = 0; i < surface.Points.size(); ++i)
  {
    polyData->GetPoint(static_cast<vtkIdType>(i), surface.Points[i].data());
  }
  auto cells = vtk::TakeSmartPointer(polyData->GetPolys()->NewIterator());
  for (cells->GoToFirstCell(); !cells->IsDoneWithTraversal(); cells->GoToNextCell())
  {
    vtkIdType size;
    const vtkIdType* ids;
    cells->GetCurrentCell(size, ids);
    surface.Triangles.push_back(
      { static_cast<int>(ids[0]), static_cast<int>(ids[1]), static_cast<int>(ids[2]) });
  }
  return surface;
}

IndexedSurface SurfaceOf(vtkPolyData* polyData, const ComputationalSpace& space)
{
  if (!polyData || polyData->GetNumberOfPolys() + polyData->GetNumberOfStrips() == 0)
  {
    ThrowInvalidArgument(
      "the initial surface has no polygons. Connect a closed surface, or choose another "
      "Initialization.");
  }
  if (const std::string error = FindInvalidCells(polyData); !error.empty())
  {
    ThrowInvalidArgument("the data ", error);
  }
  vtkNew<vtkTriangleFilter> triangulate;
  triangulate->SetInputData(polyData);
  triangulate->PassVertsOff();
  triangulate->PassLinesOff();
  triangulate->Update();
  return ToComputationalSpace(Triangles(triangulate->GetOutput()), space);
}
}

SurfaceStart StartOf(const SegmentationRequest& request, const ComputationalSpace& space,
  const std::vector<Point>& seeds)
{
  const SegmentationSettings& settings = request.Settings;
  const bool hasSeeds = settings.Initialization == InitializationType::Seeds;
  // Seeds do not grow through thin parts, so their extent would depend on the level.
  const bool selectsLater = hasSeeds && !seeds.empty() && settings.Options.RecoverMissedParts &&
    settings.Options.Drive().IsFieldAlone;
  SurfaceStart start;
  start.Seeds = seeds;
  if (settings.Initialization == InitializationType::IsoSurface || selectsLater)
  {
    start.From = SurfaceStart::Kind::IsoSurface;
  }
  else if (hasSeeds)
  {
    start.From = SurfaceStart::Kind::Seeds;
  }
  else if (settings.Initialization == InitializationType::InputSurface)
  {
    start.From = SurfaceStart::Kind::Surface;
    start.Surface = SurfaceOf(request.InitialSurface, space);
  }
  return start;
}
}
