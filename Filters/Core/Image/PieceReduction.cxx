// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Image/PieceReduction.h"

#include "Core/Image/ValidReduction.h"

#include <algorithm>
#include <vector>

namespace volumic
{
namespace
{
/** The slices of the piece along z that are made at a time. */
int SlicesAtATime(const VoxelBox& source, const VoxelBox& made, double bytesOfVoxel, double most)
{
  const double slice = bytesOfVoxel * source.Length(0) * source.Length(1);
  const double taps = 6.0; // beyond what the slices themselves lie on
  const double perSlice = static_cast<double>(source.Length(2)) / made.Length(2);
  return static_cast<int>(std::clamp((most / slice - taps) / perSlice, 1.0, 1e6));
}

VoxelBox SlabOf(const VoxelBox& box, int slices, int n)
{
  VoxelBox slab = box;
  slab.First[2] = std::min(box.First[2] + n * slices, box.End[2]);
  slab.End[2] = std::min(slab.First[2] + slices, box.End[2]);
  return slab.IsEmpty() ? VoxelBox() : slab;
}

template <typename T>
void Reduce(const MarkedVoxels<T>& voxels, const LevelPiece& input,
  typename RealOf<T>::Type* made, const LevelPiece& output, Executor& executor)
{
  const LevelProgress goOn = [](double) { return true; };
  if (voxels.HaveAllValues)
  {
    ReduceLevel(voxels.Values, input, made, output, executor, goOn);
    return;
  }
  const LargeVector<std::uint8_t> marks(voxels.Marks, voxels.Marks + input.Box.Count());
  ReduceValidVoxels(voxels.Values, marks, input, made, output, executor, goOn);
}
}

template <typename T>
bool ReducePieces(Communicator& ranks, const VoxelPieces& pieces, const MarkedVoxels<T>& below,
  const LevelGeometry& inputGeometry, typename RealOf<T>::Type* made, const LevelPiece& outputPiece,
  Executor& executor, const LevelProgress& progress, std::size_t bytesOfSlab)
{
  const VoxelBox held = pieces.HeldBy(ranks.Rank());
  const VoxelBox box = outputPiece.Box;
  const VoxelBox whole = SourceOf(box, inputGeometry, outputPiece.Level);
  const int slices = box.IsEmpty() ? 1 : SlicesAtATime(whole, box,
    sizeof(T) + (below.HaveAllValues ? 0 : 1), static_cast<double>(bytesOfSlab));
  const int own = box.IsEmpty() ? 0 : (box.Length(2) + slices - 1) / slices;
  const std::vector<int> counts = GatherValues(ranks, own);
  const int count = *std::max_element(counts.begin(), counts.end());
  for (int n = 0; n < count; ++n)
  {
    const VoxelBox slab = SlabOf(box, slices, n);
    const VoxelBox source = SourceOf(slab, inputGeometry, outputPiece.Level);
    const bool isHere = source.CommonWith(held) == source;
    const VoxelBox wanted = isHere ? VoxelBox() : source;
    LargeVector<T> values(static_cast<std::size_t>(wanted.Count()));
    pieces.Fetch(ranks, below.Values, wanted, values.data());
    LargeVector<std::uint8_t> marks;
    if (!below.HaveAllValues)
    {
      marks.resize(values.size());
      pieces.Fetch(ranks, below.Marks, wanted, marks.data());
    }
    if (!slab.IsEmpty())
    {
      MarkedVoxels<T> voxels = below;
      voxels.Values = isHere ? below.Values : values.data();
      voxels.Marks = isHere ? below.Marks : marks.data();
      Reduce(voxels, LevelPiece(inputGeometry, isHere ? held : source),
        made + box.NumberOf(box.First[0], box.First[1], slab.First[2]),
        LevelPiece(outputPiece.Level, slab), executor);
    }
    if (ranks.IsAny(!progress(static_cast<double>(n + 1) / count)))
    {
      return false;
    }
  }
  return true;
}

#define VOLUMIC_INSTANTIATE(T)                                                                   \
  template bool ReducePieces<T>(Communicator&, const VoxelPieces&, const MarkedVoxels<T>&,       \
    const LevelGeometry&, RealOf<T>::Type*, const LevelPiece&, Executor&, const LevelProgress&,   \
    std::size_t);
VOLUMIC_FOR_EACH_SCALAR(VOLUMIC_INSTANTIATE)
#undef VOLUMIC_INSTANTIATE
}
