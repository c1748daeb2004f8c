// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Which of the slices of a folder are a volume, and where they lie (DICOM PS3.3, C.7.6.2).
#include "DicomFiles.h"
#include "Messages.h"
#include "ReadVolume.h"
#include "RegularGrid.h"
#include "SlabReader.h"
#include "Texts.h"
#include "ToolErrors.h"

#include <vtkDataArray.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <limits>
#include <map>
#include <utility>

namespace tool
{
namespace
{
// ---- Which slices -------------------------------------------------------------------------------

std::string ListOf(const std::vector<DicomSeries>& all)
{
  std::string text;
  for (std::size_t i = 0; i < all.size(); ++i)
  {
    text += (i == 0 ? "" : "; ") + all[i].Text(i + 1);
  }
  return text;
}

/** The series that is wanted: a number, an identifier, or "" for the only one. */
DicomSeries Choose(std::vector<DicomSeries> all, const std::string& wanted)
{
  FailIf(all.empty(), "no DICOM image there");
  for (std::size_t i = 0; i < all.size(); ++i)
  {
    if (wanted == std::to_string(i + 1) || (!wanted.empty() && wanted == all[i].Identifier))
    {
      return all[i];
    }
  }
  FailIf(!wanted.empty(), "no series " + wanted + "; there are " + ListOf(all));
  FailIf(all.size() > 1,
    std::to_string(all.size()) +
      " series, one is needed; choose it with --series N: " + ListOf(all));
  return all.front();
}

/** Whether two slices may be of one volume. */
bool IsLike(const DicomSlice& a, const DicomSlice& b)
{
  const auto isNear = [](const auto& one, const auto& other)
  {
    return one.has_value() == other.has_value() &&
      (!one ||
        (std::abs((*one)[0] - (*other)[0]) < 1e-3 && std::abs((*one)[1] - (*other)[1]) < 1e-3));
  };
  const bool areParallel = !a.Axes || !b.Axes ||
    (Dot((*a.Axes)[0], (*b.Axes)[0]) > 0.999 && Dot((*a.Axes)[1], (*b.Axes)[1]) > 0.999);
  return a.Size == b.Size && areParallel && isNear(a.Spacing, b.Spacing);
}

/** Those that are like most others: not a localizer, which lies across. */
std::vector<DicomSlice> MostAlike(const DicomSeries& series)
{
  std::vector<std::vector<DicomSlice>> groups;
  for (const DicomSlice& slice : series.Slices)
  {
    const auto found = std::find_if(groups.begin(), groups.end(),
      [&slice](const auto& group) { return IsLike(slice, group.front()); });
    (found != groups.end() ? *found : groups.emplace_back()).push_back(slice);
  }
  std::stable_sort(
    groups.begin(), groups.end(), [](const auto& a, const auto& b) { return a.size() > b.size(); });
  if (groups.size() > 1)
  {
    const DicomSlice& other = groups[1].front();
    const std::string which = other.File + ": its " +
      (other.Size != groups[0].front().Size ? "size" : "place, orientation or pixel spacing") +
      " differs from that of " + groups[0].front().File;
    const std::size_t left = series.Slices.size() - groups[0].size();
    FailIf(left * 4 > series.Slices.size(),
      which +
        "; take those that are no slices of the volume "
        "out of the folder");
    TellOfFile(which + "; " + std::to_string(left) + " of " + std::to_string(series.Slices.size()) +
      " slices are left out (a localizer?)");
  }
  return groups[0];
}

/** Sorts slices along their normal. @return the places of all on it */
std::vector<double> SortAlong(std::vector<DicomSlice>& slices)
{
  const Vector3 normal = Cross((*slices[0].Axes)[0], (*slices[0].Axes)[1]);
  const auto along = [&normal](const DicomSlice& slice) { return Dot(*slice.Position, normal); };
  std::stable_sort(slices.begin(), slices.end(),
    [&along](const DicomSlice& a, const DicomSlice& b) { return along(a) < along(b); });
  std::vector<double> places;
  std::transform(slices.begin(), slices.end(), std::back_inserter(places), along);
  return places;
}

/** Sorted along the normal; of several at each place those of one time. */
std::vector<DicomSlice> OfOneTime(std::vector<DicomSlice> slices, const VolumeChoice& choice)
{
  const std::vector<double> along = SortAlong(slices);
  std::vector<std::vector<DicomSlice>> places;
  double last = 0.0;
  for (std::size_t i = 0; i < slices.size(); ++i)
  {
    const bool isNew = places.empty() || along[i] - last > 1e-4;
    (isNew ? places.emplace_back() : places.back()).push_back(slices[i]);
    last = isNew ? along[i] : last;
  }
  const std::size_t times = places.front().size();
  for (std::vector<DicomSlice>& place : places)
  {
    FailIf(place.size() != times,
      place.back().File + " lies where " + place.front().File +
        " does, and others don't come twice; take what is no slice of the volume out of the "
        "folder");
    std::stable_sort(place.begin(), place.end(),
      [](const DicomSlice& a, const DicomSlice& b) { return a.Time < b.Time; });
  }
  const auto chosen = static_cast<std::size_t>(TimeOf(choice, times));
  std::vector<DicomSlice> found;
  for (const std::vector<DicomSlice>& place : places)
  {
    found.push_back(place[chosen]);
  }
  return found;
}

/** @throws Failure naming the first of several slices that can't be placed among the others. */
void NeedPlaces(const std::vector<DicomSlice>& slices)
{
  for (const DicomSlice& slice : slices)
  {
    FailIf(slices.size() > 1 && (!slice.Position || !slice.Axes),
      slice.File + ": lacks its " + (slice.Position ? "orientation" : "position") +
        ": not a slice of a volume; take it out of the folder");
  }
}

/** Tells of places that were guessed. */
void TellOfPlaces(const std::vector<DicomSlice>& slices)
{
  if (slices.front().IsGuessed)
  {
    double squared = 0.0;
    for (std::size_t c = 0; c < 3; ++c)
    {
      const double step = (*slices.back().Position)[c] - (*slices.front().Position)[c];
      squared += step * step;
    }
    const double distance =
      std::sqrt(squared) / static_cast<double>(std::max<std::size_t>(2, slices.size()) - 1);
    TellOfFile("its " + std::to_string(slices.size()) +
      " frames tell no places; they are taken for slices, " + NumberText(distance) + " mm apart");
  }
}

/** What lies between pixels, told where it is guessed. */
std::array<double, 2> SpacingOf(const DicomSlice& slice)
{
  if (slice.Spacing)
  {
    return *slice.Spacing;
  }
  const std::array<double, 2> found =
    slice.ImagerSpacing.value_or(std::array<double, 2>{ 1.0, 1.0 });
  TellOfFile("it has no Pixel Spacing; " +
    (slice.ImagerSpacing ? "the Imager Pixel Spacing, " + NumberText(found[1]) + " x " +
          NumberText(found[0]) + ", that of the detector, is taken"
                         : std::string("1 x 1 is taken")) +
    "; choose another one with --spacing");
  return found;
}

// ---- Their voxels -------------------------------------------------------------------------------

bool IsWhole(double number)
{
  return number == std::floor(number) && std::abs(number) < 1e9;
}

/** The smallest type of these that all values between two have. */
int TypeFor(double least, double most)
{
  static const int types[] = { VTK_SHORT, VTK_UNSIGNED_SHORT, VTK_INT };
  for (const int type : types)
  {
    if (least >= vtkDataArray::GetDataTypeMin(type) && most <= vtkDataArray::GetDataTypeMax(type))
    {
      return type;
    }
  }
  return VTK_DOUBLE;
}

/** Slices that are sorted, as values of one type. */
class DicomSlabs : public SlabReader
{
public:
  DicomSlabs(std::vector<DicomSlice> slices, bool isWhole) : Slices(std::move(slices))
  {
    this->Size = { this->Slices[0].Size[0], this->Slices[0].Size[1],
      static_cast<int>(this->Slices.size()) };
    bool areWhole = true;
    bool areAsStored = true;
    for (const DicomSlice& slice : this->Slices)
    {
      const vtkSmartPointer<vtkDataArray> pixels = this->Pixels.Read(slice);
      areWhole = areWhole && IsWhole(slice.Slope) && IsWhole(slice.Shift);
      this->Type = this->Type == 0 ? pixels->GetDataType() : this->Type;
      areAsStored = areAsStored && slice.Slope == 1.0 && slice.Shift == 0.0 &&
        pixels->GetDataType() == this->Type;
      this->TakeRange(slice, pixels);
      if (isWhole)
      {
        this->Kept.push_back(pixels);
      }
    }
    this->Least = std::min(this->Least, this->Most); // where there are no pixels but padding
    this->Type = areAsStored ? this->Type : areWhole ? TypeFor(this->Least, this->Most) : VTK_FLOAT;
    this->WorldAxes = "LPS";
    this->LengthUnit = "mm";
  }

  double Outside() const { return this->Least; } ///< the least value of the pixels

  vtkSmartPointer<vtkDataArray> Read(int first, int count) override
  {
    const vtkIdType area = static_cast<vtkIdType>(this->Size[0]) * this->Size[1];
    auto values = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(this->Type));
    values->SetNumberOfTuples(area * count);
    for (int i = 0; i < count; ++i)
    {
      const auto number = static_cast<std::size_t>(first + i);
      const DicomSlice& slice = this->Slices[number];
      const vtkSmartPointer<vtkDataArray> pixels =
        this->Kept.empty() ? this->Pixels.Read(slice) : this->Kept[number];
      if (slice.Slope == 1.0 && slice.Shift == 0.0 && !slice.Padding &&
        pixels->GetDataType() == this->Type)
      {
        values->InsertTuples(area * i, area, 0, pixels);
        continue;
      }
      for (vtkIdType pixel = 0; pixel < area; ++pixel)
      {
        const double value = pixels->GetComponent(pixel, 0);
        values->SetComponent(area * i + pixel, 0,
          slice.Padding == value ? this->Least : slice.Slope * value + slice.Shift);
      }
    }
    return values;
  }

private:
  /** Of the pixels that are such. */
  void TakeRange(const DicomSlice& slice, vtkDataArray* pixels)
  {
    for (vtkIdType i = 0; i < pixels->GetNumberOfTuples(); ++i)
    {
      const double pixel = pixels->GetComponent(i, 0);
      if (slice.Padding != pixel)
      {
        const double value = slice.Slope * pixel + slice.Shift;
        this->Least = std::min(this->Least, value);
        this->Most = std::max(this->Most, value);
      }
    }
  }

  std::vector<DicomSlice> Slices;
  DicomPixels Pixels;
  std::vector<vtkSmartPointer<vtkDataArray>> Kept;
  double Least = std::numeric_limits<double>::max();
  double Most = std::numeric_limits<double>::lowest();
};

/** The volume that slices of a series are. */
std::unique_ptr<SlabReader> OpenSeries(const DicomSeries& series, const Opening& opening)
{
  std::vector<DicomSlice> slices = MostAlike(series);
  NeedPlaces(slices);
  TellOfPlaces(slices);
  if (slices.size() > 1)
  {
    slices = OfOneTime(std::move(slices), opening.Choice);
  }
  SlicePlaces places;
  for (const DicomSlice& slice : slices)
  {
    places.Positions.push_back(slice.Position.value_or(Vector3{ 0, 0, 0 }));
  }
  const std::array<Vector3, 2> axes =
    slices[0].Axes.value_or(std::array<Vector3, 2>{ { { 1, 0, 0 }, { 0, 1, 0 } } });
  places.Across = axes[0];
  places.Down = axes[1];
  places.Spacing = SpacingOf(slices[0]);
  const double thickness = slices[0].Thickness > 0.0 ? slices[0].Thickness : 1.0;
  auto slabs = std::make_unique<DicomSlabs>(std::move(slices), opening.IsWhole);
  const std::string uneven = places.Unevenness();
  if (uneven.empty())
  {
    slabs->Placement = places.Placement(thickness);
    return slabs;
  }
  const double outside = opening.Choice.AreLabels ? 0.0 : slabs->Outside();
  return ResampledSlices(
    std::shared_ptr<SlabReader>(std::move(slabs)), places, uneven, outside, opening);
}

// ---- Segmentations ------------------------------------------------------------------------------

/** All frames of a segmentation as one label map. */
class SegmentSlabs : public SlabReader
{
public:
  explicit SegmentSlabs(const DicomSeries& series)
  {
    const DicomSlice& first = series.Slices.front();
    std::vector<DicomSlice> sorted = series.Slices;
    NeedPlaces(sorted);
    FailIf(!first.Axes || !first.Position, "its frames tell no places");
    TellOfPlaces(sorted);
    const std::vector<double> along = SortAlong(sorted);
    SlicePlaces places;
    places.Across = (*first.Axes)[0];
    places.Down = (*first.Axes)[1];
    places.Spacing = SpacingOf(first);
    // Frames of several segments lie at one place, and empty ones are left out.
    double distance = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i < along.size(); ++i)
    {
      const double step = along[i] - along[i - 1];
      distance = step > 1e-4 ? std::min(distance, step) : distance;
    }
    distance = std::isfinite(distance) ? distance : std::max(first.Thickness, 1e-3);
    places.Positions = { *sorted.front().Position };
    this->Placement = places.Placement(distance);
    const double steps = std::round((along.back() - along.front()) / distance);
    FailIf(steps > 100000, "its frames lie too far from each other");
    this->Frames.resize(static_cast<std::size_t>(steps) + 1);
    for (std::size_t i = 0; i < along.size(); ++i)
    {
      const double place = (along[i] - along.front()) / distance;
      FailIf(std::abs(place - std::round(place)) > 0.05, "its frames lie at uneven distances");
      this->Frames[static_cast<std::size_t>(std::round(place))].push_back(sorted[i]);
    }
    this->Size = { first.Size[0], first.Size[1], static_cast<int>(this->Frames.size()) };
    this->Type = VTK_UNSIGNED_SHORT;
    this->WorldAxes = "LPS";
    this->LengthUnit = "mm";
    this->ArrayName = "Labels";
    this->Names = series.Segments;
  }

  vtkSmartPointer<vtkDataArray> Read(int first, int count) override
  {
    const vtkIdType area = static_cast<vtkIdType>(this->Size[0]) * this->Size[1];
    auto values = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(this->Type));
    values->SetNumberOfTuples(area * count);
    values->Fill(0);
    vtkIdType overlap = 0;
    for (int i = 0; i < count; ++i)
    {
      for (const DicomSlice& frame : this->Frames[static_cast<std::size_t>(first + i)])
      {
        const vtkSmartPointer<vtkDataArray> pixels = this->Pixels.Read(frame);
        for (vtkIdType pixel = 0; pixel < area; ++pixel)
        {
          // Of segments that overlap the last one; a file without segments holds labels.
          if (const double value = pixels->GetComponent(pixel, 0); value > 0.0)
          {
            overlap += values->GetComponent(area * i + pixel, 0) != 0.0 ? 1 : 0;
            values->SetComponent(area * i + pixel, 0, this->Names.empty() ? value : frame.Segment);
          }
        }
      }
    }
    if (overlap > 0)
    {
      TellOfFile("its segments overlap in " + std::to_string(overlap) +
        " voxels, which get the last one of them");
    }
    return values;
  }

private:
  std::vector<std::vector<DicomSlice>> Frames; ///< of each slice
  DicomPixels Pixels;
};
}

std::vector<std::string> ListSeries(const std::string& name)
{
  const std::vector<DicomSeries> all = DicomSeriesOf(FilesOfVolume(name));
  FailIf(all.empty(), "no DICOM image there");
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < all.size(); ++i)
  {
    texts.push_back(all[i].Text(i + 1) + ", " + all[i].Identifier);
  }
  return texts;
}

std::unique_ptr<SlabReader> OpenDicom(
  const std::vector<std::string>& files, const std::string& slice, const Opening& opening)
{
  std::vector<DicomSeries> all = DicomSeriesOf(files);
  const auto own = slice.empty() ? std::vector<DicomSeries>() : DicomSeriesOf({ slice });
  const std::string wanted =
    opening.Choice.Series.empty() && !own.empty() ? own.front().Identifier : opening.Choice.Series;
  const DicomSeries series = Choose(std::move(all), wanted);
  if (series.Modality == "SEG")
  {
    return std::make_unique<SegmentSlabs>(series);
  }
  return OpenSeries(series, opening);
}
}
