// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// MetaImage and MRC: a header tells of the voxels, which lie behind it or in other files as they
// are.
#include "SlabReader.h"

#include "ReadVolume.h"
#include "Texts.h"

#include <vtkMath.h>
#include <vtkType.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <sstream>
#include <tuple>
#include <utility>

namespace tool
{
// ---- MetaImage ----------------------------------------------------------------------------------

// VTK's and ITK's reader give what memory holds where a file has been cut off, and VTK's drops the
// directions of the axes.
namespace
{
/** The type of the values as they are in the file; VTK has other sizes for some. */
int TypeOf(const std::string& name)
{
  static const std::map<std::string, int> types = { { "MET_CHAR", VTK_SIGNED_CHAR },
    { "MET_UCHAR", VTK_UNSIGNED_CHAR }, { "MET_SHORT", VTK_SHORT },
    { "MET_USHORT", VTK_UNSIGNED_SHORT }, { "MET_INT", VTK_INT }, { "MET_UINT", VTK_UNSIGNED_INT },
    { "MET_LONG", VTK_INT }, { "MET_ULONG", VTK_UNSIGNED_INT }, { "MET_LONG_LONG", VTK_LONG_LONG },
    { "MET_ULONG_LONG", VTK_UNSIGNED_LONG_LONG }, { "MET_FLOAT", VTK_FLOAT },
    { "MET_DOUBLE", VTK_DOUBLE } };
  return EntryOf(
    types, name, "its header is damaged: the ElementType '" + name + "' is no number's");
}

/** Whether a key says yes, or, where it is not there, what is so otherwise. */
bool IsTrue(const std::string& name, const std::string& key, bool otherwise = false)
{
  const std::string value = Lower(HeaderValue(name, key));
  static const std::set<std::string> known = { "", "true", "false", "t", "f", "1", "0" };
  FailIf(known.count(value) == 0, "its header is damaged: " + key + " is '" + value + "'");
  return value.empty() ? otherwise : value[0] == 't' || value[0] == '1';
}

std::vector<std::string> SizesOf(const std::string& name)
{
  std::istringstream sizes(HeaderValue(name, "DimSize"));
  const std::vector<std::string> words{ std::istream_iterator<std::string>(sizes), {} };
  const std::size_t most = 10; // for which MetaIO has room
  FailIf(HeaderValue(name, "NDims") != std::to_string(words.size()) || words.empty() ||
      words.size() > most,
    "its header is damaged: it has no NDims, or not as many sizes");
  return words;
}

/** The directions of the axes that the header lists, axis after axis. */
std::array<Vector3, 3> AxesOf(const std::string& name, const std::string& key)
{
  std::istringstream words(HeaderValue(name, key));
  std::array<Vector3, 3> axes;
  for (Vector3& axis : axes)
  {
    FailIf(!(words >> axis[0] >> axis[1] >> axis[2]), key + " does not hold nine numbers");
  }
  return axes;
}

std::string WorldAxesOf(const std::string& name)
{
  const std::string sides = HeaderValue(name, "AnatomicalOrientation");
  const bool areKnown = sides.size() == 3 && sides.find_first_not_of("LRAPSI") == std::string::npos;
  return areKnown ? "LPS" : ""; // whatever the letters, which tell of the voxels' axes
}

/** Where the data of a file with a header begin: behind the line that tells where they are. */
std::uint64_t BehindHeader(const std::string& name)
{
  BinaryFile file(name);
  std::istringstream head(file.Text(0, std::min(LargestText, file.Size())));
  std::string line;
  while (std::getline(head, line) && !IsOfKey(line, "ElementDataFile"))
  {
  }
  return head.good() ? static_cast<std::uint64_t>(head.tellg()) : file.Size();
}

/** Numbers of a key, or of one that means the same; others where it is not there. */
Vector3 NumbersOf(const std::string& name, const std::vector<const char*>& keys, double otherwise)
{
  Vector3 numbers = { otherwise, otherwise, otherwise };
  for (const char* key : keys)
  {
    std::istringstream words(HeaderValue(name, key));
    std::string word;
    for (std::size_t axis = 0; axis < 3 && words >> word; ++axis)
    {
      numbers[axis] = ParseNumber<double>(word);
    }
    if (!HeaderValue(name, key).empty())
    {
      break;
    }
  }
  return numbers;
}

/**
 * The files of "slice%03d.raw [FIRST [LAST [STEP]]]". @throws Failure for what gives no such number
 * of them.
 */
std::vector<std::string> FilesOfPattern(
  const std::filesystem::path& folder, const std::string& text, std::uint64_t slices)
{
  std::istringstream words(text);
  std::string pattern;
  words >> pattern;
  std::vector<long> numbers;
  for (std::string word; numbers.size() < 4 && words >> word;)
  {
    numbers.push_back(ParseNumber<int>(word));
  }
  const std::size_t begin = std::min(pattern.find('%'), pattern.size());
  const std::size_t end =
    std::min(pattern.find_first_not_of("0123456789", begin + 1), pattern.size());
  const std::string width = pattern.substr(std::min(begin + 1, end), end - begin - 1);
  const long most = 100000; // files; a damaged header may ask for any number
  const long steps = static_cast<long>(std::min<std::uint64_t>(slices, most)) - 1;
  const long first = numbers.empty() ? 1 : numbers[0];
  const long last = numbers.size() > 1 ? numbers[1] : first + steps;
  const long step = numbers.size() == 3 ? numbers[2]
    : numbers.size() == 2               ? (last - first) / (steps + 1)
                                        : 1;
  FailIf(end == pattern.size() || pattern.find_first_of("diu", end) != end || width.size() > 3 ||
      pattern.find('%', end) != std::string::npos || numbers.size() > 3 || slices > most ||
      first < 0 || step < 1 || first + steps * step > last,
    "its header is damaged: the ElementDataFile '" + text.substr(0, 80) + "' gives no " +
      std::to_string(slices) + " files, as 'slice%03d.raw 1 100 1' gives 100");
  std::vector<std::string> files;
  for (long i = 0; i <= steps; ++i)
  {
    std::string digits = std::to_string(first + i * step);
    const auto wanted = static_cast<std::size_t>(std::atoi(width.c_str()));
    digits.insert(0, wanted - std::min(wanted, digits.size()), width[0] == '0' ? '0' : ' ');
    files.push_back(
      (folder / (pattern.substr(0, begin) + digits + pattern.substr(end + 1))).string());
  }
  return files;
}

/** The files in the lines behind the header: one for each slice, or one for all. */
std::vector<std::string> FilesOfList(const std::string& name, std::uint64_t slices)
{
  std::vector<std::string> files = FilesOfVolume(name);
  files.erase(files.begin()); // the header
  FailIf(files.size() < slices,
    "its header lists " + std::to_string(files.size()) + " files for " + std::to_string(slices) +
      " slices");
  files.resize(static_cast<std::size_t>(slices));
  return files;
}

/** The files that have the voxels, as much each. */
std::vector<std::string> DataFiles(const std::string& name, const std::string& told)
{
  const std::filesystem::path folder = std::filesystem::path(name).parent_path();
  const std::uint64_t slices =
    std::max(1ULL, std::strtoull(SizesOf(name).back().c_str(), nullptr, 10));
  if (told.find('%') != std::string::npos)
  {
    return FilesOfPattern(folder, told, slices);
  }
  if (told.compare(0, 4, "LIST") == 0)
  {
    return FilesOfList(name, told.find('3') != std::string::npos ? 1 : slices); // "LIST 3D"
  }
  return { Lower(told) == "local" ? name : (folder / told).string() };
}
}

std::unique_ptr<SlabReader> OpenMeta(const std::string& name, const Opening& opening)
{
  const std::vector<std::string> sizes = SizesOf(name);
  FailIf(sizes.size() > 4,
    std::to_string(sizes.size()) +
      " axes; a volume has three, or four with "
      "times");
  auto slabs = std::make_unique<RawSlabs>();
  slabs->Type = TypeOf(HeaderValue(name, "ElementType"));
  const std::string told = HeaderValue(name, "ElementDataFile");
  slabs->Files = DataFiles(name, told);
  slabs->IsBig = IsTrue(name, "BinaryDataByteOrderMSB") || IsTrue(name, "ElementByteOrderMSB");
  slabs->Code = !IsTrue(name, "BinaryData", true) ? RawSlabs::Packing::Text
    : IsTrue(name, "CompressedData")              ? RawSlabs::Packing::Zlib
                                                  : RawSlabs::Packing::None;
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    slabs->Size[axis] = axis < sizes.size() ? ParseNumber<int>(sizes[axis]) : 1;
    FailIf(slabs->Size[axis] < 1,
      "its header is damaged: " + std::to_string(slabs->Size[axis]) + " voxels along axis " +
        std::to_string(axis + 1));
  }
  const std::string channels = HeaderValue(name, "ElementNumberOfChannels");
  slabs->Components = channels.empty() ? 1 : ParseNumber<int>(channels);
  VolumePlacement& placement = slabs->Placement;
  placement.Spacing = NumbersOf(name, { "ElementSpacing", "ElementSize" }, 1.0);
  placement.Origin = NumbersOf(name, { "Offset", "Position", "Origin" }, 0.0);
  slabs->ArrayName = "MetaImage";
  slabs->WorldAxes = WorldAxesOf(name);
  slabs->LengthUnit = HeaderValue(name, "DistanceUnits");
  for (const char* key : { "TransformMatrix", "Rotation", "Orientation" })
  {
    if (!HeaderValue(name, key).empty())
    {
      placement.Axes = AxesOf(name, key);
      break;
    }
  }
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    placement.Turn(axis, placement.Spacing[axis] < 0.0);
    placement.Spacing[axis] = std::abs(placement.Spacing[axis]);
  }
  slabs->Start = Lower(told) == "local" ? BehindHeader(name) : 0;
  if (slabs->Code == RawSlabs::Packing::None)
  {
    // -1: the voxels are the last bytes of the file, whatever is before.
    const long long skipped = std::atoll(HeaderValue(name, "HeaderSize").c_str());
    slabs->AreLast = skipped < 0;
    slabs->Start += static_cast<std::uint64_t>(std::max(skipped, 0LL));
  }
  slabs->PickTime(opening.Choice,
    sizes.size() < 4 ? 1 : static_cast<std::uint64_t>(std::max(1, ParseNumber<int>(sizes[3]))));
  slabs->Prepare(opening);
  return slabs;
}

// ---- MRC ----------------------------------------------------------------------------------------

// MRC2014 (https://www.ccpem.ac.uk/mrc_format/mrc2014.php), 1024 bytes of a header, then voxels.
namespace
{
double FloatAt(BinaryFile& file, std::uint64_t place)
{
  const auto bits = static_cast<std::uint32_t>(file.Number(place, 4));
  float number = 0.0f;
  std::memcpy(&number, &bits, sizeof(number));
  return number;
}

/** The unit vectors along the axes of cells, whose angles are told where they are none of 90. */
std::array<Vector3, 3> AxesOfCells(BinaryFile& file)
{
  Vector3 cosines;
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    const double angle = FloatAt(file, 52 + 4 * axis);
    const bool isRight = angle == 0.0 || std::abs(angle - 90.0) < 0.01;
    cosines[axis] = isRight ? 0.0 : std::cos(angle * vtkMath::Pi() / 180.0);
  }
  const double sine = std::sqrt(1.0 - cosines[2] * cosines[2]);
  const double y = (cosines[0] - cosines[1] * cosines[2]) / sine;
  const double z = std::sqrt(1.0 - cosines[1] * cosines[1] - y * y);
  FailIf(!(sine > 0.0 && z > 0.0), "its header is damaged: its cells have no such angles");
  return { { { 1, 0, 0 }, { cosines[2], sine, 0 }, { cosines[1], y, z } } };
}
}

std::unique_ptr<SlabReader> OpenMrc(const std::string& name, const Opening& opening)
{
  const bool isPacked = IsGzip(name); // as EMDB packs its maps
  std::optional<NamelessFile> head;
  if (isPacked)
  {
    const std::string bytes = HeadOf(name, 1024);
    head.emplace(opening.Scratch).Append(bytes.data(), bytes.size());
  }
  BinaryFile file(head ? head->Path() : name);
  file.Need(0, 1024);
  // The machine stamp: 0x11 is big-endian; some programs leave it out.
  const std::uint64_t stamp = file.Number(212, 1);
  file.IsBig = stamp == 0x11;
  // Types and numbers of components of the modes.
  static const std::map<std::uint64_t, std::pair<int, int>> modes = { { 0, { VTK_SIGNED_CHAR, 1 } },
    { 1, { VTK_SHORT, 1 } }, { 2, { VTK_FLOAT, 1 } }, { 3, { VTK_SHORT, 2 } },
    { 4, { VTK_FLOAT, 2 } }, { 6, { VTK_UNSIGNED_SHORT, 1 } }, { 12, { VTK_UNSIGNED_SHORT, 1 } },
    { 16, { VTK_UNSIGNED_CHAR, 3 } } };
  const std::uint64_t mode = file.Number(12, 4);
  auto slabs = std::make_unique<RawSlabs>();
  slabs->Files = { name };
  slabs->ArrayName = "ImageScalars";
  FailIf(mode == 101,
    "voxels of mode 101, of half a byte, are not read; write them as mode 2 (IMOD: newstack -mode "
    "2)");
  std::tie(slabs->Type, slabs->Components) = EntryOf(modes, mode,
    "its header is damaged: the mode " + std::to_string(mode) + " is no type of voxels");
  // IMOD tells where its bytes have no sign.
  const bool isOfImod = file.Number(152, 4) == 1146047817;
  const bool isUnsigned = mode == 0 && isOfImod && file.Number(156, 4) % 2 == 0;
  slabs->Type = isUnsigned ? VTK_UNSIGNED_CHAR : slabs->Type;
  slabs->IsBig = file.IsBig;
  slabs->LengthUnit = "A";
  slabs->Code = isPacked ? RawSlabs::Packing::Zlib : RawSlabs::Packing::None;
  (isPacked ? slabs->Before : slabs->Start) = 1024 + file.Number(92, 4);
  VolumePlacement& placement = slabs->Placement;
  const std::array<Vector3, 3> cells = AxesOfCells(file);
  std::set<std::uint64_t> taken;
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    // Columns, rows and sections may lie along any of the axes of the world.
    const std::uint64_t told = file.Number(64 + 4 * axis, 4);
    const std::uint64_t world = told == 0 ? axis : told - 1;
    const std::uint64_t size = file.Number(4 * axis, 4);
    FailIf(size < 1 || size > std::numeric_limits<int>::max() || world > 2 ||
        !taken.insert(world).second || file.Signed(28 + 4 * world, 4) < 1,
      "its header is damaged: " + std::to_string(size) + " voxels along axis " +
        std::to_string(world + 1) + ", cells " + std::to_string(file.Number(28 + 4 * axis, 4)));
    slabs->Size[axis] = static_cast<int>(size);
    placement.Spacing[axis] =
      FloatAt(file, 40 + 4 * world) / static_cast<double>(file.Signed(28 + 4 * world, 4));
    placement.Axes[axis] = cells[world];
    const double first =
      placement.Spacing[axis] * static_cast<double>(file.Signed(16 + 4 * axis, 4));
    placement.Origin[world] += FloatAt(file, 196 + 4 * world);
    for (std::size_t c = 0; c < 3; ++c)
    {
      placement.Origin[c] += first * cells[world][c];
    }
  }
  slabs->Prepare(opening);
  return AsFloats(std::move(slabs), mode == 12);
}
}
