// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ReadVolume.h"

#include "ByteBudget.h"
#include "CheckInputs.h"
#include "InputFiles.h"
#include "RawSlabs.h"
#include "Texts.h"
#include "ToolErrors.h"
#include "VolumeImage.h"
#include "VtkReaders.h"

#include <vtkImageData.h>
#include <vtkMetaImageReader.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <sstream>

namespace tool
{
namespace
{
using Image = vtkSmartPointer<vtkImageData>;

/** MetaIO prints what it misses, and goes on: an error, unless the file is known to be whole. */
Image ReadMetaVoxels(const std::string& name, bool isWhole)
{
  std::ostringstream printed;
  std::streambuf* output = std::cerr.rdbuf(printed.rdbuf());
  Image image;
  try
  {
    image = ReadIfItsFormat<vtkMetaImageReader>(name);
  }
  catch (...)
  {
    std::cerr.rdbuf(output);
    throw;
  }
  std::cerr.rdbuf(output);
  if (!isWhole && !printed.str().empty())
  {
    std::string text = printed.str();
    std::replace(text.begin(), text.end(), '\n', ' ');
    throw Failure("cannot be read (" + text + ")");
  }
  return image;
}

/** The directions of the axes that a MetaImage's header lists, axis after axis. */
std::array<Vector3, 3> MetaAxes(const std::string& name, const std::string& key)
{
  std::istringstream words(HeaderValue(name, key));
  std::array<Vector3, 3> axes;
  for (Vector3& axis : axes)
  {
    if (!(words >> axis[0] >> axis[1] >> axis[2]))
    {
      throw Failure(key + " does not hold nine numbers");
    }
  }
  return axes;
}

/** The place that the header tells of, beside these. */
VolumePlacement PlacementOf(const std::string& name, const double* spacing, const double* origin)
{
  VolumePlacement placement;
  std::copy_n(spacing, 3, placement.Spacing.begin());
  std::copy_n(origin, 3, placement.Origin.begin());
  for (const char* key : { "TransformMatrix", "Rotation", "Orientation" })
  {
    if (!HeaderValue(name, key).empty())
    {
      placement.Axes = MetaAxes(name, key);
      break;
    }
  }
  return placement;
}

std::string WorldAxesOf(const std::string& name)
{
  const std::string sides = HeaderValue(name, "AnatomicalOrientation");
  const bool areKnown = sides.size() == 3 && sides.find_first_not_of("LRAPSI") == std::string::npos;
  return areKnown ? "LPS" : ""; // whatever the letters, which tell of the voxels' axes
}

bool IsTrue(const std::string& value)
{
  return !value.empty() && (value[0] == 'T' || value[0] == 't' || value[0] == '1');
}

/** Where the data of a file with a header begin: behind the line that tells where they are. */
std::uint64_t BehindHeader(const std::string& name)
{
  std::ifstream file(name, std::ios::binary);
  std::string line;
  while (std::getline(file, line) && line.compare(0, 15, "ElementDataFile") != 0)
  {
  }
  return file ? static_cast<std::uint64_t>(file.tellg()) : 0;
}
}

vtkSmartPointer<vtkImageData> ReadMeta(const std::string& name)
{
  const bool isWhole = CheckMeta(name);
  Image image = ReadMetaVoxels(name, isWhole);
  PlaceImage(image, PlacementOf(name, image->GetSpacing(), image->GetOrigin()));
  const std::string axes = WorldAxesOf(name);
  if (!axes.empty())
  {
    SetWorldAxes(image, axes);
  }
  return image;
}

std::unique_ptr<SlabReader> OpenMeta(const std::string& name, const ScratchDirectory& scratch)
{
  CheckMetaHeader(name);
  const std::string dataFile = HeaderValue(name, "ElementDataFile");
  const std::string isBinary = HeaderValue(name, "BinaryData");
  // These have another size in VTK than in the file.
  const bool isLong = HeaderValue(name, "ElementType").find("LONG") != std::string::npos;
  if (dataFile.empty() || dataFile.find('%') != std::string::npos ||
    dataFile.compare(0, 4, "LIST") == 0 || (!isBinary.empty() && !IsTrue(isBinary)) || isLong)
  {
    return nullptr;
  }
  const auto make = [&name] { return NewReader<vtkMetaImageReader>(name); };
  const ReaderSlabs told(name, make);
  auto slabs = std::make_unique<RawSlabs>();
  static_cast<SlabReader&>(*slabs) = told;
  slabs->ArrayName = "MetaImage";
  slabs->Placement =
    PlacementOf(name, told.Placement.Spacing.data(), told.Placement.Origin.data());
  slabs->WorldAxes = WorldAxesOf(name);
  slabs->IsBig = IsTrue(HeaderValue(name, "BinaryDataByteOrderMSB")) ||
    IsTrue(HeaderValue(name, "ElementByteOrderMSB"));
  const bool isLocal = Lower(dataFile) == "local";
  slabs->File =
    isLocal ? name : (std::filesystem::path(name).parent_path() / dataFile).string();
  slabs->Start = isLocal ? BehindHeader(name) : 0;
  if (IsTrue(HeaderValue(name, "CompressedData")))
  {
    slabs->Unpacked = Unpack(slabs->File, slabs->Start, scratch, slabs->Bytes());
    slabs->File = slabs->Unpacked->Path();
    slabs->Start = 0;
  }
  else
  {
    // -1: the voxels are the last bytes of the file, whatever is before.
    const long long skipped = std::atoll(HeaderValue(name, "HeaderSize").c_str());
    const std::uint64_t there = SizeOfData(slabs->File);
    slabs->Start = skipped < 0 ? there - std::min(there, slabs->Bytes())
                               : slabs->Start + static_cast<std::uint64_t>(skipped);
  }
  const std::uint64_t there = SizeOfData(slabs->File);
  NeedJustBytes(there - std::min(there, slabs->Start), slabs->Bytes());
  return slabs;
}
}
