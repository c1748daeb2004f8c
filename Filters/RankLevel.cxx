// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "RankLevel.h"

#include "Core/Common/FreeMemory.h"
#include "Core/Common/Monitor.h"
#include "HostThreads.h"

#include <cstddef>

namespace volumic
{
namespace
{
/** Of a rank that helps: it shows nothing. */
class HelpersMonitor final : public Monitor
{
public:
  explicit HelpersMonitor(const std::function<bool()>& goOn) : Goes(goOn) {}
  bool Continue(const Status&) override { return this->Goes(); }
  bool GoOn(const Status&) override { return this->Goes(); }

private:
  const std::function<bool()>& Goes;
};
}

RankLevel::RankLevel(Communicator& ranks, const LevelImage& image)
  : Ranks(ranks), Level(BroadcastValue(ranks, image))
{
  const VoxelBox all = VoxelBox::Of(this->Level.Size);
  const bool isFirst = ranks.Rank() == 0;
  this->Pieces = VoxelPieces(ranks, isFirst ? all : VoxelBox());
  if (!isFirst)
  {
    MakeZeroed(this->Voxels,
      static_cast<std::size_t>(all.Count()) * this->Level.Values.BytesPerVoxel());
    this->Level.Values = this->Level.Values.At(this->Voxels.data());
  }
}

void RankLevel::Need(const VoxelBox& box)
{
  const bool isFirst = this->Ranks.Rank() == 0; // It has them.
  this->Pieces.FetchInto(this->Ranks, this->Level.Values.Data(), this->Level.Values.BytesPerVoxel(),
    isFirst ? VoxelBox() : box, VoxelBox::Of(this->Level.Size), this->Voxels.data());
}

bool EvolveOnRanks(Communicator& ranks, const SharedLevel& shared, const LevelImage& image,
  SurfaceEvolution& evolution, StopReason& reason, SurfaceResult& surface)
{
  BroadcastValue(ranks, shared);
  RankLevel level(ranks, image);
  evolution.SetRanks(&ranks, [&level](const VoxelBox& box) { level.Need(box); });
  const bool isDivided = evolution.Divide(image, shared.Level);
  if (isDivided)
  {
    reason = evolution.Run();
    surface = evolution.Result();
    if (!shared.IsLast)
    {
      evolution.Unite();
    }
  }
  evolution.SetRanks(nullptr);
  return isDivided;
}

void HelpWithLevel(Communicator& ranks, const std::function<bool()>& goOn)
{
  const SharedLevel shared = BroadcastValue(ranks, SharedLevel());
  RankLevel level(ranks, LevelImage());
  HostThreads threads(shared.NumberOfThreads);
  HelpersMonitor monitor(goOn);
  threads.Run(
    [&]
    {
      SurfaceEvolution evolution(shared.Options, threads, monitor);
      evolution.SetRanks(&ranks, [&level](const VoxelBox& box) { level.Need(box); });
      if (evolution.Divide(level.Image(), shared.Level))
      {
        evolution.Run();
        evolution.Result();
        if (!shared.IsLast)
        {
          evolution.Unite();
        }
      }
    });
  GiveBackFreeMemory();
}
}
