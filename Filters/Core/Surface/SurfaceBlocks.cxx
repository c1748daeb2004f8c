// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/SurfaceBlocks.h"

#include "Core/Common/Spans.h"
#include "Core/Image/VoxelBox.h"
#include "Core/Surface/Proximity.h"

#include <algorithm>
#include <functional>
#include <utility>

namespace volumic
{
namespace
{
constexpr std::size_t VertexSpan = 8192;
/**
 * Numbers of free slots: minimum per block with vertices, and total shared by all such blocks, as a
 * small surface grows fast. The others are ratios: vertices per slot, slots per slot used in the
 * last pass, vertices per slot used if there was no pass yet, slots per vertex with a long edge.
 * Too few slots for long edges would make needles.
 */
constexpr int MinimumSlots = 40;
constexpr int SharedSlots = 4096;
constexpr int VerticesPerSlot = 8;
constexpr int SlotsPerUsedSlot = 2;
constexpr int VerticesPerUsedSlot = 12;
constexpr int SlotsPerLongEdge = 16;
/** Distance from its block, in delta, at which a vertex is assigned to another block. */
constexpr float StrayDistance = SurfaceBlocks::MovingInDelta - 0.5f;

// In delta, see SurfaceBlocks. Both ends of an edge may move by half a delta at once.
constexpr float LongestEdge = HugeEdge * SizingField::LongestEdgeInDelta + 1.f;
static_assert(LongestBridgeEdge * SizingField::LongestEdgeInDelta <= LongestEdge &&
    SizingField::DivisionFactor * SizingField::LongestEdgeInDelta <= LongestEdge,
  "merges and divisions that keep an old edge must not make longer edges");
/** Search radius of Proximity for a slow vertex. */
constexpr float SearchRadius =
  SizingField::SearchRadiusInDelta + Proximity::ExtraSearchRadiusInDelta;
static_assert(SurfaceBlocks::EditedInDelta + LongestEdge <= SurfaceBlocks::WrittenInDelta,
  "an edit writes within an edge length of the stars at which it begins");
static_assert(SurfaceBlocks::MovingInDelta + 0.5f <= SurfaceBlocks::EditedInDelta,
  "vertices must not move beyond the region of edits");
static_assert(
  SurfaceBlocks::WrittenInDelta + SearchRadius + LongestEdge <= SurfaceBlocks::HaloInDelta,
  "tested vertices are written, and stars within their search radius are read");
static_assert(
  SurfaceBlocks::WrittenInDelta + SurfaceBlocks::HaloInDelta + SizingField::SearchRadiusInDelta <=
    SurfaceBlocks::SideInDelta,
  "concurrent passes must not access the same cell of the grid");

constexpr int NoBlock = -1;

/** Return the number of free slots for a block. */
int SlotsFor(int vertices, int slotsUsed, int withLongEdge)
{
  const int more = std::max(
    { vertices / VerticesPerSlot, SlotsPerUsedSlot * slotsUsed, SlotsPerLongEdge * withLongEdge });
  return vertices > 0 ? MinimumSlots + more : 0;
}

/** Return 0, 2, 1, 4, 3, ...: even indices before their odd neighbours. */
std::vector<int> EvenFirst(int count)
{
  std::vector<int> order;
  for (int even = 0; even < count + 1; even += 2)
  {
    if (even < count)
    {
      order.push_back(even);
    }
    if (even > 0)
    {
      order.push_back(even - 1);
    }
  }
  return order;
}
}

SurfaceBlocks::Frame SurfaceBlocks::FrameOf(const std::array<double, 3>& extent, double side)
{
  Frame frame;
  float low[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    const int whole = static_cast<int>(extent[axis] / side);
    frame.Size[axis] = whole < 2 ? 1 : whole + 1;
    frame.Side[axis] = static_cast<float>(side);
    low[axis] = static_cast<float>((extent[axis] - side * frame.Size[axis]) / 2);
  }
  frame.Low = Vector(low[0], low[1], low[2]);
  return frame;
}

SurfaceBlocks::SurfaceBlocks(SurfaceState& state, const Frame& frame, Executor& executor)
  : State(state), TheFrame(frame)
{
  const std::array<int, 3>& size = frame.Size;
  this->Ranges.resize(
    static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) * size[2]);
  this->Reorder(executor, true);
  this->MakeSchedule();
}

std::array<int, 3> SurfaceBlocks::IjkOf(const Vector& position) const
{
  const Vector from = position - this->TheFrame.Low;
  const float along[3] = { from.X, from.Y, from.Z };
  std::array<int, 3> ijk;
  for (int axis = 0; axis < 3; ++axis)
  {
    const float index = along[axis] / this->TheFrame.Side[axis];
    ijk[axis] = static_cast<int>( // Rounds down.
      std::clamp(index, 0.f, static_cast<float>(this->TheFrame.Size[axis] - 1)));
  }
  return ijk;
}

std::array<int, 3> SurfaceBlocks::IjkOf(int block) const
{
  const std::array<int, 3>& size = this->TheFrame.Size;
  return { block % size[0], block / size[0] % size[1], block / size[0] / size[1] };
}

int SurfaceBlocks::BlockOf(const std::array<int, 3>& ijk) const
{
  const std::array<int, 3>& size = this->TheFrame.Size;
  return ijk[0] + size[0] * (ijk[1] + size[1] * ijk[2]);
}

int SurfaceBlocks::BlockAt(const Vector& position) const
{
  return this->BlockOf(this->IjkOf(position));
}

Box SurfaceBlocks::BoxOf(int block) const
{
  constexpr float endless = 1e9f;
  const std::array<int, 3> ijk = this->IjkOf(block);
  const Vector& origin = this->TheFrame.Low;
  const float origins[3] = { origin.X, origin.Y, origin.Z };
  float low[3];
  float high[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    const auto at = [&](int k)
    { return origins[axis] + this->TheFrame.Side[axis] * static_cast<float>(k); };
    low[axis] = ijk[axis] == 0 ? -endless : at(ijk[axis]);
    high[axis] = ijk[axis] == this->TheFrame.Size[axis] - 1 ? endless : at(ijk[axis] + 1);
  }
  return { Vector(low[0], low[1], low[2]), Vector(high[0], high[1], high[2]) };
}

std::vector<int> SurfaceBlocks::NeighboursOf(int block) const
{
  std::vector<int> neighbours;
  const std::array<int, 3> ijk = this->IjkOf(block);
  const VoxelBox near = { ijk, { ijk[0] + 1, ijk[1] + 1, ijk[2] + 1 } };
  near.Grown(1)
    .CommonWith(VoxelBox::Of(this->TheFrame.Size))
    .ForVoxels(
      [&](int x, int y, int z)
      {
        const int other = this->BlockOf({ x, y, z });
        if (other != block)
        {
          neighbours.push_back(other);
        }
      });
  return neighbours;
}

void SurfaceBlocks::Reorder(Executor& executor, bool isNew)
{
  const SurfaceMesh& mesh = this->State.Mesh;
  const std::size_t n = mesh.Rings.size();
  LargeVector<int> blocks;
  MakeZeroed(blocks, n);
  ForSpans(executor, n, VertexSpan,
    [&](std::size_t, std::size_t begin, std::size_t end)
    {
      for (std::size_t v = begin; v < end; ++v)
      {
        blocks[v] = mesh.IsAlive(static_cast<int>(v)) ? this->BlockAt(mesh.Position[v]) : NoBlock;
      }
    });
  std::vector<int> counts(this->Ranges.size(), 0);
  std::vector<int> withLongEdge(this->Ranges.size(), 0);
  for (std::size_t v = 0; v < n; ++v)
  {
    if (blocks[v] != NoBlock)
    {
      ++counts[blocks[v]];
      withLongEdge[blocks[v]] += (this->State.RemeshFlags[v] & HasLongEdge) != 0;
    }
  }
  const auto withVertices =
    std::count_if(counts.begin(), counts.end(), [](int count) { return count > 0; });
  const int sharedSlots = SharedSlots / std::max(static_cast<int>(withVertices), 1);
  int first = 0;
  for (std::size_t block = 0; block < counts.size(); ++block)
  {
    VertexRange& own = this->Ranges[block];
    own.SlotsUsed = isNew ? counts[block] / VerticesPerUsedSlot : own.SlotsUsed;
    own.First = own.Next = first;
    const int slots = SlotsFor(counts[block], own.SlotsUsed, withLongEdge[block]);
    own.End = first += counts[block] + slots + (slots > 0 ? sharedSlots : 0);
    own.HasStray = false;
  }
  std::vector<int> order(static_cast<std::size_t>(first), NoVertex);
  for (std::size_t v = 0; v < n; ++v)
  {
    if (blocks[v] != NoBlock)
    {
      order[this->Ranges[blocks[v]].Next++] = static_cast<int>(v);
    }
  }
  blocks = {};
  this->State.Reorder(order, this->Buffers, executor);
}

void SurfaceBlocks::Prepare(Executor& executor)
{
  const std::uint8_t* flags = this->State.RemeshFlags.AsVector().data();
  const auto isUnfit = [flags](const VertexRange& own)
  {
    const auto withLongEdge = std::count_if(flags + own.First, flags + own.Next,
      [](std::uint8_t ofVertex) { return (ofVertex & HasLongEdge) != 0; });
    return own.HasStray ||
      own.End - own.Next <
      SlotsFor(own.Next - own.First, own.SlotsUsed, static_cast<int>(withLongEdge)) / 2;
  };
  if (std::any_of(this->Ranges.begin(), this->Ranges.end(), isUnfit))
  {
    this->Reorder(executor, false);
  }
}

void SurfaceBlocks::MakeSchedule()
{
  std::vector<int> order;
  for (const int z : EvenFirst(this->TheFrame.Size[2]))
  {
    for (const int y : EvenFirst(this->TheFrame.Size[1]))
    {
      for (const int x : EvenFirst(this->TheFrame.Size[0]))
      {
        order.push_back(this->BlockOf({ x, y, z }));
      }
    }
  }
  // Slab by slab, which needs less memory traffic than colour by colour.
  this->Passes = std::make_unique<BlockSchedule>(
    std::move(order), [this](int block) { return this->NeighboursOf(block); });
}

bool SurfaceBlocks::Append(const IndexedSurface& surface, bool isInParts, Executor& executor)
{
  SurfaceState& s = this->State;
  const int first = s.Mesh.Size();
  s.Append(surface, executor);
  std::vector<int> added(static_cast<std::size_t>(s.Mesh.Size() - first));
  std::iota(added.begin(), added.end(), first);
  const std::vector<Proximity::FacePair> found = Proximity::FindIntersections(s, added, executor);
  std::vector<int> intersecting;
  for (const Proximity::FacePair& pair : found)
  {
    intersecting.insert(intersecting.end(), { pair.First[0], pair.Second[0] });
  }
  for (const int v : isInParts || found.empty() ? intersecting : added)
  {
    if (v >= first && s.Mesh.IsAlive(v))
    {
      s.RemoveComponent(v);
    }
  }
  this->Reorder(executor, true);
  return found.empty();
}

BlockPass SurfaceBlocks::Open(int block)
{
  const VertexRange& own = this->Ranges[block];
  BlockPass pass;
  pass.Block = block;
  pass.First = own.First;
  pass.Context.Slots = { own.Next, own.End };
  const Box box = this->BoxOf(block);
  const float delta = this->State.Sizing.Smallest();
  pass.Moving = box.Grown(MovingInDelta * delta);
  pass.Context.Region = box.Grown(EditedInDelta * delta);
  pass.Written = box.Grown(WrittenInDelta * this->State.Sizing.Largest());
  return pass;
}

double SurfaceBlocks::SumUp(const std::function<double(int v)>& ofVertex, Executor& executor) const
{
  return SumOfSpans(executor, this->Ranges.size(), 1,
    [&](std::size_t block, std::size_t)
    {
      double sum = 0.;
      for (int v = this->Ranges[block].First; v < this->Ranges[block].Next; ++v)
      {
        sum += ofVertex(v);
      }
      return sum;
    });
}

void SurfaceBlocks::Close(BlockPass&& pass)
{
  SurfaceState& s = this->State;
  VertexRange& own = this->Ranges[pass.Block];
  own.SlotsUsed = pass.End() - own.Next;
  own.Next = pass.End();
  const Box box = this->BoxOf(pass.Block).Grown(StrayDistance * s.Sizing.Smallest());
  for (int v = own.First; v < own.Next && !own.HasStray; ++v)
  {
    own.HasStray = s.Mesh.IsAlive(v) && !box.Contains(s.Mesh.Position[v]);
  }
  const std::lock_guard<std::mutex> lock(this->Closing);
  s.Mesh.Count(pass.Context.Slots);
  s.EulerCharacteristic += pass.Context.EulerCharacteristic;
}

bool SurfaceBlocks::HasActive(int block) const
{
  const VertexRange& own = this->Ranges[block];
  const std::uint8_t* active = this->State.Active.AsVector().data();
  return std::any_of(
    active + own.First, active + own.Next, [](std::uint8_t isActive) { return isActive != 0; });
}
}
