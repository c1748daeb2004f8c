// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Voxels behind a short header, or behind none: NumPy
// (https://numpy.org/neps/nep-0001-npy-format.html), FreeSurfer
// (https://surfer.nmr.mgh.harvard.edu/fswiki/FsTutorial/MghFormat), --raw.
#include "SlabReader.h"

#include "Texts.h"

#include <vtkType.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <sstream>

namespace tool
{
namespace
{
/** What both NumPy and --raw call types, by the kind and the bytes of a number. */
int TypeCalled(const std::string& name)
{
  static const std::map<std::string, int> types = { { "b1", VTK_UNSIGNED_CHAR },
    { "u1", VTK_UNSIGNED_CHAR }, { "i1", VTK_SIGNED_CHAR }, { "u2", VTK_UNSIGNED_SHORT },
    { "i2", VTK_SHORT }, { "u4", VTK_UNSIGNED_INT }, { "i4", VTK_INT },
    { "u8", VTK_UNSIGNED_LONG_LONG }, { "i8", VTK_LONG_LONG }, { "f2", VTK_UNSIGNED_SHORT },
    { "f4", VTK_FLOAT }, { "f8", VTK_DOUBLE }, { "uint8", VTK_UNSIGNED_CHAR },
    { "int8", VTK_SIGNED_CHAR }, { "uint16", VTK_UNSIGNED_SHORT }, { "int16", VTK_SHORT },
    { "uint32", VTK_UNSIGNED_INT }, { "int32", VTK_INT }, { "uint64", VTK_UNSIGNED_LONG_LONG },
    { "int64", VTK_LONG_LONG }, { "float16", VTK_UNSIGNED_SHORT }, { "float32", VTK_FLOAT },
    { "float64", VTK_DOUBLE }, { "float", VTK_FLOAT }, { "double", VTK_DOUBLE } };
  return EntryOf(types, name,
    "voxels of type '" + name + "' are not read: uint8, int8 to int64, float16 to float64 are");
}

/** The value of a key in the dictionary that a .npy begins with. */
std::string ValueIn(const std::string& header, const std::string& key)
{
  const std::size_t at = header.find("'" + key + "':");
  FailIf(at == std::string::npos, "its header is damaged: it lacks '" + key + "'");
  const std::string rest = Trimmed(header.substr(at + key.size() + 3));
  const std::size_t end = rest[0] == '(' ? rest.find(')') : rest.find_first_of(",}");
  return Trimmed(rest.substr(rest[0] == '(' ? 1 : 0, end - (rest[0] == '(' ? 1 : 0)));
}
}

std::unique_ptr<SlabReader> OpenNumpy(const std::string& name, const Opening& opening)
{
  BinaryFile file(name);
  file.Need(0, 12);
  FailIf(file.Text(0, 6) != "\x93NUMPY", "does not start as a .npy file does");
  const int wide = file.Number(6, 1) == 1 ? 2 : 4;
  const std::uint64_t length = file.Number(8, wide);
  FailIf(
    length > LargestText, "its header is damaged: it has " + std::to_string(length) + " bytes");
  const std::string header = file.Text(8 + static_cast<std::uint64_t>(wide), length);
  auto slabs = std::make_unique<RawSlabs>();
  slabs->Files = { name };
  slabs->Start = 8 + static_cast<std::uint64_t>(wide) + length;
  const std::string type = ValueIn(header, "descr"); // such as '<i2'
  FailIf(type.size() < 4, "its header is damaged: its type is " + type);
  slabs->IsBig = type[1] == '>';
  slabs->Type = TypeCalled(type.substr(2, type.size() - 3));
  std::vector<int> shape;
  for (const std::string& size : SplitAtCommas(ValueIn(header, "shape")))
  {
    if (!size.empty())
    {
      shape.push_back(ParseNumber<int>(size));
    }
  }
  const bool isFortran = ValueIn(header, "fortran_order") == "True";
  if (!isFortran)
  {
    std::reverse(shape.begin(), shape.end());
  }
  while (shape.size() > 3 && shape.back() == 1) // one time or channel
  {
    shape.pop_back();
  }
  FailIf(shape.size() != 3 || *std::min_element(shape.begin(), shape.end()) < 1,
    "its shape is (" + ValueIn(header, "shape") +
      "); a volume has three axes (numpy.save one of "
      "them, or the channel or time that is wanted)");
  std::copy(shape.begin(), shape.end(), slabs->Size.begin());
  slabs->Prepare(opening);
  return AsFloats(std::move(slabs), type.substr(2, 2) == "f2");
}

std::unique_ptr<SlabReader> OpenMgh(const std::string& name, const Opening& opening)
{
  constexpr std::uint64_t headerBytes = 284;
  const std::string head = HeadOf(name, headerBytes);
  FailIf(head.size() < headerBytes, "the file is cut off within its header");
  const auto number = [&head](std::size_t at, std::size_t bytes)
  { return static_cast<std::uint32_t>(NumberOf(head.substr(at, bytes), true)); };
  const auto real = [&number](std::size_t at)
  {
    const std::uint32_t bits = number(at, 4);
    float value = 0.0f;
    std::memcpy(&value, &bits, sizeof(value));
    return static_cast<double>(value);
  };
  FailIf(number(0, 4) != 1, "does not start as a .mgh file does");
  auto slabs = std::make_unique<RawSlabs>();
  slabs->Files = { name };
  slabs->IsBig = true;
  static const std::map<std::uint32_t, int> types = { { 0, VTK_UNSIGNED_CHAR }, { 1, VTK_INT },
    { 3, VTK_FLOAT }, { 4, VTK_SHORT }, { 10, VTK_UNSIGNED_SHORT } };
  slabs->Type = EntryOf(types, number(20, 4),
    "its header is damaged: there is no type " + std::to_string(number(20, 4)));
  Vector3 middle;
  std::array<Vector3, 3> steps = { { { -1, 0, 0 }, { 0, 0, -1 }, { 0, 1, 0 } } };
  Vector3 centre = { 0, 0, 0 };
  const bool isPlaced = number(28, 2) == 1;
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    const std::uint32_t size = number(4 + 4 * axis, 4);
    FailIf(size < 1 || size > 0x7FFFFFFF,
      "its header is damaged: " + std::to_string(size) + " voxels along axis " +
        std::to_string(axis + 1));
    slabs->Size[axis] = static_cast<int>(size);
    middle[axis] = 0.5 * size;
    for (std::size_t c = 0; c < 3; ++c)
    {
      steps[axis][c] = (isPlaced ? real(42 + 12 * axis + 4 * c) : steps[axis][c]) *
        (isPlaced ? real(30 + 4 * axis) : 1.0);
    }
    centre[axis] = isPlaced ? real(78 + 4 * axis) : 0.0;
  }
  slabs->Placement.SetSteps(steps);
  for (std::size_t c = 0; c < 3; ++c)
  {
    slabs->Placement.Origin[c] =
      centre[c] - steps[0][c] * middle[0] - steps[1][c] * middle[1] - steps[2][c] * middle[2];
  }
  slabs->WorldAxes = "RAS";
  slabs->LengthUnit = "mm";
  const bool isPacked = IsGzip(name);
  slabs->Code = isPacked ? RawSlabs::Packing::Zlib : RawSlabs::Packing::None;
  (isPacked ? slabs->Before : slabs->Start) = headerBytes;
  slabs->PickTime(opening.Choice, std::max<std::uint32_t>(1, number(16, 4)));
  slabs->HasMore = true; // what FreeSurfer writes behind the voxels
  slabs->Prepare(opening);
  return slabs;
}

std::unique_ptr<SlabReader> OpenRaw(const std::string& name, const Opening& opening)
{
  const std::vector<std::string> words = SplitAtCommas(opening.Choice.Raw);
  FailIf(words.size() < 4 || words.size() > 5,
    "--raw '" + opening.Choice.Raw +
      "': it is sizes, type and the order of bytes, such as "
      "512,512,400,uint16,little");
  auto slabs = std::make_unique<RawSlabs>();
  slabs->Files = { name };
  Named("--raw",
    [&]
    {
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        const std::optional<int> size = AsNumber<int>(words[axis]);
        FailIf(!size || *size < 1, "'" + words[axis] + "' is no number of voxels");
        slabs->Size[axis] = *size;
      }
      slabs->Type = TypeCalled(Lower(words[3]));
      const std::string order = words.size() < 5 ? "little" : Lower(words[4]);
      FailIf(order != "little" && order != "big", "'" + order + "' is neither little nor big");
      slabs->IsBig = order == "big";
    });
  slabs->Prepare(opening);
  return AsFloats(std::move(slabs), Lower(words[3]) == "float16");
}
}
