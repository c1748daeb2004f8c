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
/** Vertices per task. */
constexpr std::size_t VertexSpan = 8192;
/**
 * Numbers of free slots: minimum per block with vertices, and total shared by all such blocks, as a
 * small surface grows fast. The others are ratios: vertices per slot, slots per slot used in the
 * last pass, vertices per slot used if there was no pass yet, slots per vertex with a long edge.
 * Too few slots for long edges would make needles.
 */
constexpr int FewPlaces = 40;
constexpr int SharedPlaces = 4096;
constexpr int VerticesPerPlace = 8;
constexpr int PlacesPerTaken = 2;
constexpr int VerticesPerTaken = 12;
constexpr int PlacesPerLong = 16;
/** Distance from its block, in delta, at which a vertex is assigned to another block. */
constexpr float Astray = SurfaceBlocks::MovingInDelta - 0.5f;

// In delta, see SurfaceBlocks. Both ends of an edge may move by half a delta at once.
constexpr float LongestEdge = HugeEdge * SizingField::LongestEdgeInDelta + 1.f;
static_assert(LongestBridgeEdge * SizingField::LongestEdgeInDelta <= LongestEdge &&
    SizingField::DivisionFactor * SizingField::LongestEdgeInDelta <= LongestEdge,
  "a merge, and a division that keeps an old edge, make none longer");
/** Search radius of Proximity for a slow vertex. */
constexpr float Reach = SizingField::ReachInDelta + Proximity::FurtherReachInDelta;
static_assert(SurfaceBlocks::EditedInDelta + LongestEdge <= SurfaceBlocks::WrittenInDelta,
  "an edit writes as far as the edges of the stars that it may begin at");
static_assert(SurfaceBlocks::MovingInDelta + 0.5f <= SurfaceBlocks::EditedInDelta,
  "what has moved is written no further than what is edited");
static_assert(SurfaceBlocks::WrittenInDelta + Reach + LongestEdge <= SurfaceBlocks::HaloInDelta,
  "what is examined is written, and stars within its reach are read");
static_assert(
  SurfaceBlocks::WrittenInDelta + SurfaceBlocks::HaloInDelta + SizingField::ReachInDelta <=
    SurfaceBlocks::SideInDelta,
  "what visits of one colour write and read has no cell of the grid in common");

constexpr int NoBlock = -1;

/** Return the number of free slots for a block. */
int RoomFor(int vertices, int taken, int withLongEdge)
{
  const int more =
    std::max({ vertices / VerticesPerPlace, PlacesPerTaken * taken, PlacesPerLong * withLongEdge });
  return vertices > 0 ? FewPlaces + more : 0;
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
  this->All.resize(static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) * size[2]);
  this->Reorder(executor, true);
  this->FindOrder();
}

std::array<int, 3> SurfaceBlocks::IjkOf(const Vector& position) const
{
  const Vector from = position - this->TheFrame.Low;
  const float along[3] = { from.X, from.Y, from.Z };
  std::array<int, 3> places;
  for (int axis = 0; axis < 3; ++axis)
  {
    const float place = along[axis] / this->TheFrame.Side[axis];
    places[axis] = static_cast<int>( // Rounds down.
      std::clamp(place, 0.f, static_cast<float>(this->TheFrame.Size[axis] - 1)));
  }
  return places;
}

std::array<int, 3> SurfaceBlocks::IjkOf(int block) const
{
  const std::array<int, 3>& size = this->TheFrame.Size;
  return { block % size[0], block / size[0] % size[1], block / size[0] / size[1] };
}

int SurfaceBlocks::BlockOf(const std::array<int, 3>& place) const
{
  const std::array<int, 3>& size = this->TheFrame.Size;
  return place[0] + size[0] * (place[1] + size[1] * place[2]);
}

int SurfaceBlocks::BlockAt(const Vector& position) const
{
  return this->BlockOf(this->IjkOf(position));
}

Box SurfaceBlocks::BoxOf(int block) const
{
  constexpr float endless = 1e9f;
  const std::array<int, 3> place = this->IjkOf(block);
  const Vector& origin = this->TheFrame.Low;
  const float origins[3] = { origin.X, origin.Y, origin.Z };
  float low[3];
  float high[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    const auto at = [&](int k)
    { return origins[axis] + this->TheFrame.Side[axis] * static_cast<float>(k); };
    low[axis] = place[axis] == 0 ? -endless : at(place[axis]);
    high[axis] = place[axis] == this->TheFrame.Size[axis] - 1 ? endless : at(place[axis] + 1);
  }
  return { Vector(low[0], low[1], low[2]), Vector(high[0], high[1], high[2]) };
}

std::vector<int> SurfaceBlocks::NeighboursOf(int block) const
{
  std::vector<int> neighbours;
  const std::array<int, 3> place = this->IjkOf(block);
  const VoxelBox near = { place, { place[0] + 1, place[1] + 1, place[2] + 1 } };
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
  std::vector<int> counts(this->All.size(), 0);
  std::vector<int> withLongEdge(this->All.size(), 0);
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
  const int share = SharedPlaces / std::max(static_cast<int>(withVertices), 1);
  int first = 0;
  for (std::size_t block = 0; block < counts.size(); ++block)
  {
    OfBlock& own = this->All[block];
    own.Taken = isNew ? counts[block] / VerticesPerTaken : own.Taken;
    own.First = own.Next = first;
    const int room = RoomFor(counts[block], own.Taken, withLongEdge[block]);
    own.End = first += counts[block] + room + (room > 0 ? share : 0);
    own.IsAstray = false;
  }
  std::vector<int> order(static_cast<std::size_t>(first), NoVertex);
  for (std::size_t v = 0; v < n; ++v)
  {
    if (blocks[v] != NoBlock)
    {
      order[this->All[blocks[v]].Next++] = static_cast<int>(v);
    }
  }
  blocks = {};
  this->State.Reorder(order, this->Spares, executor);
}

void SurfaceBlocks::Prepare(Executor& executor)
{
  const std::uint8_t* flags = this->State.RemeshFlags.AsVector().data();
  const auto isUnfit = [flags](const OfBlock& own)
  {
    const auto withLongEdge = std::count_if(flags + own.First, flags + own.Next,
      [](std::uint8_t ofVertex) { return (ofVertex & HasLongEdge) != 0; });
    return own.IsAstray ||
      own.End - own.Next <
      RoomFor(own.Next - own.First, own.Taken, static_cast<int>(withLongEdge)) / 2;
  };
  if (std::any_of(this->All.begin(), this->All.end(), isUnfit))
  {
    this->Reorder(executor, false);
  }
}

void SurfaceBlocks::FindOrder()
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
  std::vector<int> wrong;
  for (const Proximity::FacePair& pair : found)
  {
    wrong.insert(wrong.end(), { pair.First[0], pair.Second[0] });
  }
  for (const int v : isInParts || found.empty() ? wrong : added)
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
  const OfBlock& own = this->All[block];
  BlockPass visit;
  visit.Block = block;
  visit.First = own.First;
  visit.Share.Room = { own.Next, own.End };
  const Box box = this->BoxOf(block);
  const float delta = this->State.Sizing.Smallest();
  visit.Moving = box.Grown(MovingInDelta * delta);
  visit.Share.Region = box.Grown(EditedInDelta * delta);
  visit.Written = box.Grown(WrittenInDelta * this->State.Sizing.Largest());
  return visit;
}

double SurfaceBlocks::SumUp(const std::function<double(int v)>& ofVertex, Executor& executor) const
{
  return SumOfSpans(executor, this->All.size(), 1,
    [&](std::size_t block, std::size_t)
    {
      double sum = 0.;
      for (int v = this->All[block].First; v < this->All[block].Next; ++v)
      {
        sum += ofVertex(v);
      }
      return sum;
    });
}

void SurfaceBlocks::Close(BlockPass&& visit)
{
  SurfaceState& s = this->State;
  OfBlock& own = this->All[visit.Block];
  own.Taken = visit.End() - own.Next;
  own.Next = visit.End();
  const Box box = this->BoxOf(visit.Block).Grown(Astray * s.Sizing.Smallest());
  for (int v = own.First; v < own.Next && !own.IsAstray; ++v)
  {
    own.IsAstray = s.Mesh.IsAlive(v) && !box.Contains(s.Mesh.Position[v]);
  }
  const std::lock_guard<std::mutex> lock(this->Closing);
  s.Mesh.Count(visit.Share.Room);
  s.EulerCharacteristic += visit.Share.EulerCharacteristic;
}

bool SurfaceBlocks::HasActive(int block) const
{
  const OfBlock& own = this->All[block];
  const std::uint8_t* active = this->State.Active.AsVector().data();
  return std::any_of(
    active + own.First, active + own.Next, [](std::uint8_t isActive) { return isActive != 0; });
}
}
