// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// MRC2014 (https://www.ccpem.ac.uk/mrc_format/mrc2014.php), 1024 bytes of a header, then voxels.
#include "SlabReader.h"

#include "BinaryFile.h"
#include "RawSlabs.h"
#include "ToolErrors.h"
#include "VolumeImage.h"

#include <vtkType.h>

#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <tuple>
#include <utility>

namespace tool
{
namespace
{
double FloatAt(BinaryFile& file, std::uint64_t place)
{
  const auto bits = static_cast<std::uint32_t>(file.Number(place, 4));
  float number = 0.0f;
  std::memcpy(&number, &bits, sizeof(number));
  return number;
}
}

std::unique_ptr<SlabReader> OpenMrc(const std::string& name, const Opening& opening)
{
  BinaryFile file(name);
  file.Need(0, 1024);
  // The machine stamp: 0x11 is big-endian; some programs leave it out.
  const std::uint64_t stamp = file.Number(212, 1);
  file.IsBig = stamp == 0x11;
  // Types and numbers of components of the modes.
  static const std::map<std::uint64_t, std::pair<int, int>> modes = {
    { 0, { VTK_UNSIGNED_CHAR, 1 } }, { 1, { VTK_SHORT, 1 } }, { 2, { VTK_FLOAT, 1 } },
    { 3, { VTK_SHORT, 2 } },
    { 4, { VTK_FLOAT, 2 } }, { 6, { VTK_UNSIGNED_SHORT, 1 } }, { 16, { VTK_UNSIGNED_CHAR, 3 } } };
  const std::uint64_t mode = file.Number(12, 4);
  auto slabs = std::make_unique<RawSlabs>();
  slabs->Files = { name };
  slabs->ArrayName = "ImageScalars";
  std::tie(slabs->Type, slabs->Components) = EntryOf(modes, mode,
    "its header is damaged: the mode " + std::to_string(mode) + " is no type of voxels");
  slabs->IsBig = file.IsBig;
  slabs->Start = 1024 + file.Number(92, 4);
  VolumePlacement& placement = slabs->Placement;
  std::set<std::uint64_t> taken;
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    // Columns, rows and sections may lie along any of the axes of the world.
    const std::uint64_t told = file.Number(64 + 4 * axis, 4);
    const std::uint64_t world = told == 0 ? axis : told - 1;
    const std::uint64_t size = file.Number(4 * axis, 4);
    if (size < 1 || size > std::numeric_limits<int>::max() || world > 2 ||
      !taken.insert(world).second || file.Signed(28 + 4 * world, 4) < 1)
    {
      throw Failure("its header is damaged: " + std::to_string(size) + " voxels along axis " +
        std::to_string(world + 1) + ", cells " + std::to_string(file.Number(28 + 4 * axis, 4)));
    }
    slabs->Size[axis] = static_cast<int>(size);
    placement.Spacing[axis] =
      FloatAt(file, 40 + 4 * world) / static_cast<double>(file.Signed(28 + 4 * world, 4));
    placement.Axes[axis] = { 0.0, 0.0, 0.0 };
    placement.Axes[axis][world] = 1.0;
    placement.Origin[world] = FloatAt(file, 196 + 4 * world) +
      placement.Spacing[axis] * static_cast<double>(file.Signed(16 + 4 * axis, 4));
  }
  slabs->Prepare(opening);
  return slabs;
}
}
