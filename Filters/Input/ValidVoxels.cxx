// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Input/ValidVoxels.h"

#include "Core/Common/Join.h"
#include "Core/Common/Refuse.h"
#include "Core/Image/LevelReduction.h"
#include "Core/Image/VoxelPieces.h"
#include "Input/ImagePieces.h"
#include "Input/ImageVoxels.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkImageData.h>
#include <vtkPointData.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <vector>

namespace volumic
{
namespace
{
/** The ghost array, or null where no bit of `hidden` is set in it. */
const unsigned char* HidingGhosts(
  vtkDataSetAttributes* attributes, vtkIdType count, unsigned char hidden)
{
  auto* ghosts = vtkUnsignedCharArray::SafeDownCast(
    attributes->GetArray(vtkDataSetAttributes::GhostArrayName()));
  if (!ghosts || ghosts->GetNumberOfTuples() != count || ghosts->GetNumberOfComponents() != 1)
  {
    return nullptr;
  }
  const unsigned char* values = ghosts->GetPointer(0);
  const bool hides =
    std::any_of(values, values + count, [hidden](unsigned char g) { return (g & hidden) != 0; });
  return hides ? values : nullptr;
}

/** Marks the corners of all visible cells that are points of the box. */
void MarkVisibleCorners(const unsigned char* ghosts, const VoxelBox& cells, const VoxelBox& points,
  LargeVector<std::uint8_t>& marks)
{
  std::int64_t cell = 0;
  for (int k = cells.First[2]; k < cells.End[2]; ++k)
  {
    for (int j = cells.First[1]; j < cells.End[1]; ++j)
    {
      for (int i = cells.First[0]; i < cells.End[0]; ++i, ++cell)
      {
        for (int corner = 0; corner < 8 && !(ghosts[cell] & vtkDataSetAttributes::HIDDENCELL);
             ++corner)
        {
          const std::array<int, 3> p = { i + (corner & 1), j + (corner >> 1 & 1),
            k + (corner >> 2) };
          // Along an axis of one point there is no other corner.
          if (points.Contains(p))
          {
            marks[points.NumberOf(p[0], p[1], p[2])] = 1;
          }
        }
      }
    }
  }
}

/** The cells of which these points are corners; along an axis of one point there is one. */
VoxelBox CellsOf(const VoxelBox& points)
{
  VoxelBox cells = points;
  for (int axis = 0; axis < 3 && !points.IsEmpty(); ++axis)
  {
    cells.End[axis] = std::max(cells.First[axis] + 1, cells.End[axis] - 1);
  }
  return cells;
}

/** Marks the points of the piece that are corners of a visible cell, of whichever piece. */
void MarkVisibleCorners(Communicator& ranks, const ImagePieces& pieces,
  const unsigned char* ghosts, LargeVector<std::uint8_t>& marks)
{
  const VoxelBox points = pieces.Voxels().HeldBy(ranks.Rank());
  const VoxelBox held = CellsOf(points);
  marks.assign(static_cast<std::size_t>(points.Count()), 0);
  if (ranks.NumberOfRanks() == 1)
  {
    MarkVisibleCorners(ghosts, held, points, marks);
    return;
  }
  const VoxelPieces cells(ranks, held);
  VoxelBox around = held;
  for (int axis = 0; axis < 3; ++axis)
  {
    --around.First[axis];
    around.End[axis] = points.End[axis];
  }
  around = points.IsEmpty() ? points : around.CommonWith(cells.Bounds());
  const std::vector<unsigned char> none(
    ghosts ? 0 : static_cast<std::size_t>(held.Count()), std::uint8_t(0));
  std::vector<unsigned char> found(static_cast<std::size_t>(around.Count()), 0);
  cells.Fetch(ranks, ghosts ? ghosts : none.data(), around, found.data());
  MarkVisibleCorners(found.data(), around, points, marks);
}

/** Empty on all ranks where nothing is blanked. */
LargeVector<std::uint8_t> NotBlanked(
  Communicator& ranks, const ImagePieces& pieces, vtkImageData* image)
{
  LargeVector<std::uint8_t> marks;
  const unsigned char* cells = nullptr;
  const unsigned char* points = nullptr;
  if (image)
  {
    cells = HidingGhosts(
      image->GetCellData(), image->GetNumberOfCells(), vtkDataSetAttributes::HIDDENCELL);
    points = HidingGhosts(
      image->GetPointData(), image->GetNumberOfPoints(), vtkDataSetAttributes::HIDDENPOINT);
  }
  if (ranks.IsAny(cells != nullptr))
  {
    MarkVisibleCorners(ranks, pieces, cells, marks);
  }
  if (points)
  {
    marks.resize(static_cast<std::size_t>(image->GetNumberOfPoints()), 1);
    std::transform(marks.begin(), marks.end(), points, marks.begin(),
      [](std::uint8_t mark, unsigned char ghost)
      { return ghost & vtkDataSetAttributes::HIDDENPOINT ? std::uint8_t(0) : mark; });
  }
  return marks;
}

/** Voxels of one kind: how many, and which is the first in the whole image. */
struct CountedVoxels
{
  std::int64_t Count = 0;
  std::int64_t First = -1;

  void Add(std::int64_t count, std::int64_t first)
  {
    this->First = this->First < 0 || (first >= 0 && first < this->First) ? first : this->First;
    this->Count += count;
  }
};

struct NotFinite
{
  CountedVoxels NaNs;
  CountedVoxels Infinite;
};

/** Of those marked as valid, each voxel at the lowest rank that holds it. */
template <typename T>
NotFinite CountNotFinite(const T* values, const LargeVector<std::uint8_t>& marks,
  const ImagePieces& pieces, int rank)
{
  NotFinite found;
  if constexpr (std::is_floating_point_v<T>)
  {
    const VoxelBox held = pieces.Voxels().HeldBy(rank);
    const VoxelBox all = VoxelBox::Of(pieces.Size());
    for (const VoxelBox& box : pieces.Voxels().OwnOf(rank))
    {
      for (int k = box.First[2]; k < box.End[2]; ++k)
      {
        for (int j = box.First[1]; j < box.End[1]; ++j)
        {
          for (int i = box.First[0]; i < box.End[0]; ++i)
          {
            const std::int64_t n = held.NumberOf(i, j, k);
            if (!std::isfinite(values[n]) && (marks.empty() || marks[n] != 0))
            {
              (std::isnan(values[n]) ? found.NaNs : found.Infinite).Add(1, all.NumberOf(i, j, k));
            }
          }
        }
      }
    }
  }
  return found;
}

template <typename T>
void ExcludeNaNs(const T* values, std::int64_t count, LargeVector<std::uint8_t>& marks)
{
  marks.resize(static_cast<std::size_t>(count), 1);
  for (std::int64_t i = 0; i < count; ++i)
  {
    if constexpr (std::is_floating_point_v<T>)
    {
      marks[i] = std::isnan(values[i]) ? std::uint8_t(0) : marks[i];
    }
  }
}

template <typename T>
void FindRange(const T* values, const LargeVector<std::uint8_t>& marks, double range[2])
{
  for (std::size_t i = 0; i < marks.size(); ++i)
  {
    const auto value = static_cast<double>(values[i]);
    range[0] = marks[i] != 0 && value < range[0] ? value : range[0];
    range[1] = marks[i] != 0 && value > range[1] ? value : range[1];
  }
}

/** `3 NaN voxels, the first at (i, j, k)` */
std::string Describe(
  const char* kind, std::int64_t count, const std::string& share, std::int64_t first,
  vtkImageData* image)
{
  const int* extent = image->GetExtent();
  const int* size = image->GetDimensions();
  const std::int64_t row = first / size[0];
  return Join(count, " ", kind, " voxel", count == 1 ? "" : "s", share, ", the first at (",
    extent[0] + first % size[0], ", ", extent[2] + row % size[1], ", ", extent[4] + row / size[1],
    ")");
}
}

ValidVoxels FindValidVoxels(vtkDataArray* original, vtkDataArray* contiguous, vtkImageData* image,
  bool nanIsBackground, Executor& executor)
{
  const ImagePieces pieces(OnThisRank(), image);
  return FindValidVoxels(
    OnThisRank(), pieces, original, contiguous, image, nanIsBackground, executor);
}

ValidVoxels FindValidVoxels(Communicator& ranks, const ImagePieces& pieces, vtkDataArray* original,
  vtkDataArray* contiguous, vtkImageData* image, bool nanIsBackground, Executor& executor)
{
  ValidVoxels valid;
  valid.Marks = NotBlanked(ranks, pieces, image);
  const std::int64_t count = contiguous->GetNumberOfTuples();
  NotFinite own;
  switch (contiguous->GetDataType())
  {
    vtkTemplateMacro({
      const auto* values = static_cast<const VTK_TT*>(contiguous->GetVoidPointer(0));
      if (FindNotFiniteVoxels(values, count, executor).Count > 0)
      {
        own = CountNotFinite(values, valid.Marks, pieces, ranks.Rank());
        ExcludeNaNs(values, count, valid.Marks);
      }
    });
    default:
      break;
  }
  NotFinite all;
  for (const NotFinite& found : GatherValues(ranks, own))
  {
    all.NaNs.Add(found.NaNs.Count, found.NaNs.First);
    all.Infinite.Add(found.Infinite.Count, found.Infinite.First);
  }
  if (all.Infinite.Count > 0)
  {
    Refuse(NameOf(original), " has ",
      Describe("infinite", all.Infinite.Count, "", all.Infinite.First, pieces.Frame()),
      ". Replace them by numbers, for instance by the value of the background.");
  }
  valid.NaNs = all.NaNs.Count;
  valid.FirstNaN = all.NaNs.First;
  if (valid.NaNs > 0 && !nanIsBackground)
  {
    Refuse(NameOf(original), " has ",
      Describe("NaN", valid.NaNs, "", valid.FirstNaN, pieces.Frame()),
      ". Turn NaN Is Background on, or replace them by numbers.");
  }
  valid.AreAll = !ranks.IsAny(!valid.Marks.empty());
  if (!valid.AreAll)
  {
    valid.Marks.resize(static_cast<std::size_t>(count), 1);
  }
  return valid;
}

std::array<double, 2> RangeOf(vtkDataArray* contiguous, const ValidVoxels& valid)
{
  std::array<double, 2> range = { std::numeric_limits<double>::max(),
    std::numeric_limits<double>::lowest() };
  if (!contiguous)
  {
    return range;
  }
  if (valid.Marks.empty() && contiguous->GetNumberOfTuples() > 0)
  {
    contiguous->GetRange(range.data());
    return range;
  }
  switch (contiguous->GetDataType())
  {
    vtkTemplateMacro(FindRange(
      static_cast<const VTK_TT*>(contiguous->GetVoidPointer(0)), valid.Marks, range.data()));
    default:
      break;
  }
  return range;
}

std::array<double, 2> RangeOf(
  Communicator& ranks, vtkDataArray* contiguous, const ValidVoxels& valid)
{
  std::array<double, 2> range = RangeOf(contiguous, valid);
  for (const std::array<double, 2>& other : GatherValues(ranks, range))
  {
    range = { std::min(range[0], other[0]), std::max(range[1], other[1]) };
  }
  return range;
}

void CheckAnyIsValid(vtkDataArray* original, const ValidVoxels& valid, Communicator& ranks)
{
  const bool isAny = valid.AreAll ||
    std::find(valid.Marks.begin(), valid.Marks.end(), std::uint8_t(1)) != valid.Marks.end();
  if (!ranks.IsAny(isAny))
  {
    Refuse("all voxels of ", NameOf(original), " are NaN or blanked: there is nothing to see.");
  }
}

std::string DescribeNaNs(vtkDataArray* original, vtkImageData* image, const ValidVoxels& valid)
{
  const double share =
    100.0 * static_cast<double>(valid.NaNs) / static_cast<double>(image->GetNumberOfPoints());
  const std::string percent =
    share < 0.1 ? std::string() : Join(" (", std::round(share * 10.0) / 10.0, " %)");
  return Join(NameOf(original), " has ",
    Describe("NaN", valid.NaNs, percent, valid.FirstNaN, image),
    ". They count as background; turn NaN Is Background off to refuse them.");
}
}
