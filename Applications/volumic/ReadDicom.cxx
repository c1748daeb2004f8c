// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// vtkDICOMImageReader, given a folder, takes the distance of the slices from their thickness, drops
// their orientation and mixes series. So each slice is read by a reader of its own, and placed here
// by its position and orientation (DICOM PS3.3, C.7.6.2).
#include "ReadVolume.h"

#include "BinaryFile.h"
#include "DicomHeader.h"
#include "Messages.h"
#include "SlabReader.h"
#include "Texts.h"
#include "ToolErrors.h"
#include "VolumeImage.h"

#include <vtkDICOMImageReader.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkVersion.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <locale>
#include <map>
#include <memory>
#include <sstream>
#include <utility>

namespace tool
{
namespace
{
struct Slice
{
  std::string File;
  Vector3 Position;
  Vector3 Across;
  Vector3 Down;
  Vector3 Spacing; ///< between columns, between rows; the thickness
  std::string Study;
  vtkSmartPointer<vtkImageData> Image;
};

/** Tolerated deviation of the distance of two slices from their mean, as a share of it. */
constexpr double UnevenDistance = 0.05;

/** VTK's reader keeps numbers as float: the decimal number that the file most likely has. */
double Decimal(double number)
{
  char buffer[32];
  const char* end = std::to_chars(buffer, buffer + sizeof(buffer), static_cast<float>(number)).ptr;
  double value = number;
  std::from_chars(buffer, end, value);
  return value;
}

/** @throws Failure if the file has not what vtkDICOMImageReader takes for granted. */
void CheckPixels(const DicomHeader& header)
{
  FailIf(!header.HasPixels,
    "has no pixels: it is cut off, or no slice; replace it, or take it out of the folder");
  FailIf(
    header.Frames > 1, NumberText(header.Frames) + " frames; files of several frames are not read");
  FailIf(header.Samples != 1, NumberText(header.Samples) + " components per pixel; one is needed");
  FailIf(header.Bits != 8 && header.Bits != 16,
    NumberText(header.Bits) + " bits per pixel; 8 and 16 are read");
  FailIf(header.NeededBytes() == 0, "lacks its rows or columns: it is damaged, or no slice");
  // Odd numbers of bytes are made even.
  if (header.PixelBytes > header.NeededBytes() + header.NeededBytes() % 2)
  {
    NeedJustBytes(header.PixelBytes, header.NeededBytes());
  }
  FailIf(header.PixelBytes < header.NeededBytes(),
    "the pixels are cut off: " + std::to_string(header.PixelBytes) + " bytes, " +
      std::to_string(header.NeededBytes()) + " needed; copy the file again");
}

/** The header of a slice, or of something that is no image at all. */
DicomHeader ReadHeader(const std::string& file)
{
  return Named(file,
    [&file]
    {
      const DicomHeader header = ReadDicomHeader(file);
      if (!header.IsOtherThanImage())
      {
        CheckPixels(header);
      }
      return header;
    });
}

/** @throws Failure with a list of the series unless there is one. `files` have these headers. */
void CheckSingleSeries(
  const std::vector<std::string>& files, const std::vector<DicomHeader>& headers)
{
  std::map<std::string, int> counts; // of the files of each series
  for (const DicomHeader& header : headers)
  {
    ++counts[header.Series];
  }
  std::string names; // in the order of their first files
  for (std::size_t i = 0; i < headers.size(); ++i)
  {
    if (const int count = std::exchange(counts[headers[i].Series], 0); count > 0)
    {
      const std::string& description = headers[i].Description;
      names += (names.empty() ? "" : "; ") + (description.empty() ? "unnamed" : description) +
        ": " + NumberText(count) + (count == 1 ? " file, " : " files, from ") +
        std::filesystem::path(files[i]).filename().string();
    }
  }
  FailIf(counts.size() > 1,
    std::to_string(counts.size()) + " series, one per folder is needed (" + names + ")");
}

/** @throws Failure naming the first of several slices that can't be placed among the others. */
void CheckPlaces(const std::vector<std::string>& files, const std::vector<DicomHeader>& headers)
{
  for (std::size_t i = 0; headers.size() > 1 && i < headers.size(); ++i)
  {
    FailIf(!headers[i].HasPosition || !headers[i].HasOrientation,
      files[i] + ": lacks its " + (headers[i].HasPosition ? "orientation" : "position") +
        ": not a slice of a volume; take it out of the folder");
  }
}

Slice ReadSlice(const std::string& file)
{
  vtkNew<vtkDICOMImageReader> reader;
  reader->SetFileName(file.c_str());
  VtkMessages messages;
  messages.UpdateReader(reader, file);
  Slice slice;
  slice.File = file;
  const float* position = reader->GetImagePositionPatient();
  const float* orientation = reader->GetImageOrientationPatient();
  for (int c = 0; c < 3; ++c)
  {
    slice.Position[c] = Decimal(position[c]);
    slice.Across[c] = Decimal(orientation[c]);
    slice.Down[c] = Decimal(orientation[3 + c]);
  }
  const double* spacing = reader->GetPixelSpacing();
  slice.Spacing = { Decimal(spacing[0]), Decimal(spacing[1]), Decimal(spacing[2]) };
#if VTK_VERSION_NUMBER < VTK_VERSION_CHECK(9, 6, 0)
  // The file has the distance of the rows first, and so had VTK's reader.
  std::swap(slice.Spacing[0], slice.Spacing[1]);
#endif
  slice.Study = reader->GetStudyUID() ? reader->GetStudyUID() : "";
  slice.Image = reader->GetOutput();
  FailIf(!slice.Image->GetPointData()->GetScalars(), file + ": has no pixels");
  return slice;
}

void CheckFits(const Slice& slice, const Slice& first, const std::array<int, 2>& size)
{
  const bool isSameSeries = slice.Study == first.Study && Dot(slice.Across, first.Across) > 0.999 &&
    Dot(slice.Down, first.Down) > 0.999;
  const bool isSameSize = std::equal(size.begin(), size.end(), slice.Image->GetDimensions()) &&
    std::abs(slice.Spacing[0] - first.Spacing[0]) < 1e-3 &&
    std::abs(slice.Spacing[1] - first.Spacing[1]) < 1e-3;
  FailIf(!isSameSeries || !isSameSize,
    slice.File + ": its " + (isSameSize ? "study or orientation" : "size or pixel spacing") +
      " differs from that of " + first.File + "; one series per folder is needed");
}

/**
 * Distance of neighbouring slices, which are sorted. @throws Failure for missing, repeated and
 * sheared ones.
 */
double SliceDistance(const std::vector<Slice>& slices, const Vector3& normal)
{
  if (slices.size() == 1)
  {
    return slices[0].Spacing[2] > 0.0 ? slices[0].Spacing[2] : 1.0;
  }
  const auto along = [&](std::size_t i) { return Dot(slices[i].Position, normal); };
  const double mean =
    (along(slices.size() - 1) - along(0)) / static_cast<double>(slices.size() - 1);
  double shortest = mean;
  double longest = mean;
  for (std::size_t i = 1; i < slices.size(); ++i)
  {
    const double step = along(i) - along(i - 1);
    FailIf(step <= 1e-4,
      slices[i].File + " lies where " + slices[i - 1].File +
        " does; one series per folder is needed");
    shortest = std::min(shortest, step);
    longest = std::max(longest, step);
  }
  if (std::max(longest - mean, mean - shortest) > UnevenDistance * mean)
  {
    const auto rounded = [](double length) { return NumberText(std::round(1e3 * length) / 1e3); };
    throw Failure("slices are " + rounded(shortest) + " to " + rounded(longest) +
      " mm apart: some are missing, or the volume must be resampled");
  }
  for (std::size_t i = 1; i < slices.size(); ++i)
  {
    const double step = along(i) - along(i - 1);
    Vector3 aside;
    for (int c = 0; c < 3; ++c)
    {
      aside[c] = slices[i].Position[c] - slices[i - 1].Position[c] - step * normal[c];
    }
    FailIf(std::sqrt(Dot(aside, aside)) > UnevenDistance * mean,
      "the gantry was tilted; the volume must be resampled first (dcm2niix does so)");
  }
  return mean;
}

/** A series whose slices are sorted. */
struct Series
{
  std::vector<Slice> Slices; ///< with or without their images
  std::array<int, 2> Size = { 0, 0 };
  int Type = 0; ///< the widest of the slices
  VolumePlacement Placement;
};

/**
 * The voxels of so many slices one after the other; slices without an image are read again. VTK's
 * reader turns the rows upside down.
 */
vtkSmartPointer<vtkDataArray> StackVoxels(
  const Series& series, std::size_t first, std::size_t count)
{
  const std::array<int, 2>& size = series.Size;
  const vtkIdType area = static_cast<vtkIdType>(size[0]) * size[1];
  auto voxels = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(series.Type));
  voxels->SetNumberOfTuples(area * static_cast<vtkIdType>(count));
  for (std::size_t i = 0; i < count; ++i)
  {
    const Slice& slice = series.Slices[first + i];
    const vtkSmartPointer<vtkImageData> image =
      slice.Image ? slice.Image : ReadSlice(slice.File).Image;
    vtkDataArray* pixels = image->GetPointData()->GetScalars();
    for (int row = 0; row < size[1]; ++row)
    {
      voxels->InsertTuples(static_cast<vtkIdType>(i) * area + static_cast<vtkIdType>(row) * size[0],
        size[0], static_cast<vtkIdType>(size[1] - 1 - row) * size[0], pixels);
    }
  }
  return voxels;
}

/** Reads and sorts all slices; their images are kept, or let go one by one. */
Series ReadSeries(const std::vector<std::string>& files, bool keepsImages)
{
  std::vector<std::string> images;
  std::vector<DicomHeader> headers;
  for (const std::string& file : files)
  {
    const DicomHeader header = ReadHeader(file);
    if (!header.IsOtherThanImage())
    {
      images.push_back(file);
      headers.push_back(header);
    }
  }
  CheckSingleSeries(images, headers);
  CheckPlaces(images, headers);

  Series series;
  std::vector<Slice>& slices = series.Slices;
  for (const std::string& file : images)
  {
    slices.push_back(ReadSlice(file));
    const vtkSmartPointer<vtkImageData> image = slices.back().Image;
    const int* size = image->GetDimensions();
    series.Size = slices.size() == 1 ? std::array<int, 2>{ size[0], size[1] } : series.Size;
    CheckFits(slices.back(), slices.front(), series.Size);
    vtkDataArray* pixels = image->GetPointData()->GetScalars();
    // Slices may differ in slope and shift, and so in type: the widest holds all.
    const bool isWider = slices.size() == 1 ||
      pixels->GetDataTypeSize() > vtkDataArray::GetDataTypeSize(series.Type) ||
      (pixels->GetDataTypeMin() < 0 &&
        pixels->GetDataTypeSize() == vtkDataArray::GetDataTypeSize(series.Type));
    series.Type = isWider ? pixels->GetDataType() : series.Type;
    slices.back().Image = keepsImages ? image : nullptr;
  }
  FailIf(slices.empty(), "no DICOM image there");
  const Vector3 normal = Cross(slices[0].Across, slices[0].Down);
  series.Placement.Axes = { slices[0].Across, slices[0].Down, normal };
  std::stable_sort(slices.begin(), slices.end(),
    [&](const Slice& a, const Slice& b)
    { return Dot(a.Position, normal) < Dot(b.Position, normal); });
  const DicomHeader& header = headers.front();
  if (!header.HasSpacing)
  {
    std::istringstream numbers(header.ImagerSpacing);
    numbers.imbue(std::locale::classic());
    Vector3& spacing = slices[0].Spacing;
    char sign = 0;
    const bool isTold = numbers >> spacing[1] >> sign >> spacing[0] &&
      std::min(spacing[0], spacing[1]) > 0.0;
    spacing[0] = isTold ? spacing[0] : 1.0;
    spacing[1] = isTold ? spacing[1] : 1.0;
    TellOfFile("it has no Pixel Spacing; " +
      (isTold ? "the Imager Pixel Spacing, " + NumberText(spacing[1]) + " x " +
            NumberText(spacing[0]) + ", that of the detector, is taken"
              : std::string("1 x 1 is taken")) + "; choose another one with --spacing");
  }
  const double distance = SliceDistance(slices, normal);
  series.Placement.Spacing = { slices[0].Spacing[0], slices[0].Spacing[1], distance };
  series.Placement.Origin = slices[0].Position;
  return series;
}

class DicomSlabs : public SlabReader
{
public:
  DicomSlabs(const std::vector<std::string>& files, bool keepsImages)
    : Held(ReadSeries(files, keepsImages))
  {
    this->Size = { this->Held.Size[0], this->Held.Size[1],
      static_cast<int>(this->Held.Slices.size()) };
    this->Type = this->Held.Type;
    this->Placement = this->Held.Placement;
    this->WorldAxes = "LPS";
    this->LengthUnit = "mm";
  }

  vtkSmartPointer<vtkDataArray> Read(int first, int count) override
  {
    return StackVoxels(
      this->Held, static_cast<std::size_t>(first), static_cast<std::size_t>(count));
  }

private:
  Series Held;
};
}

bool IsDicom(const std::string& file)
{
  // VTK's reader takes some other files for old DICOM without this mark.
  std::ifstream stream(file, std::ios::binary);
  char head[132];
  return stream.read(head, sizeof(head)) && std::memcmp(head + 128, "DICM", 4) == 0;
}

bool IsLikeSlice(const std::string& file, const std::vector<std::string>& slices)
{
  const auto withoutNumbers = [](const std::string& name)
  {
    std::string path = std::filesystem::path(name).filename().string();
    std::replace_if(
      path.begin(), path.end(), [](char c) { return c >= '0' && c <= '9'; }, '0');
    path.erase(std::unique(path.begin(), path.end(),
                 [](char a, char b) { return a == '0' && b == '0'; }),
      path.end());
    return path;
  };
  const std::string suffix = SuffixOf(file);
  if (slices.empty() || suffix == ".dcm" || suffix == ".dicom" || suffix == ".ima")
  {
    return !slices.empty();
  }
  // A preamble of zeros, most often, and a mark; the length of the first group.
  BinaryFile bytes(file);
  const std::string head = bytes.Text(0, std::min<std::uint64_t>(bytes.Size(), 136));
  const bool isPreamble = head.find_first_not_of('\0') == std::string::npos;
  const bool isMarked = head.size() == 136 && head.compare(132, 4, "\2\0\0\0", 4) == 0;
  const std::string like = withoutNumbers(file);
  return isMarked ||
    std::any_of(slices.begin(), slices.end(),
      [&](const std::string& slice)
      {
        return withoutNumbers(slice) == like || (isPreamble && SuffixOf(slice) == suffix);
      });
}

std::unique_ptr<SlabReader> OpenDicom(
  const std::vector<std::string>& files, const Opening& opening)
{
  return std::make_unique<DicomSlabs>(files, opening.IsWhole);
}
}
