// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/SurfaceBlocks.h"

#include "Core/Common/Spans.h"
#include "Core/Surface/Proximity.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <utility>

namespace volumic
{
namespace
{
/** Vertices that one thread looks at at a time. */
constexpr std::size_t VertexSpan = 8192;
/**
 * Places for new vertices that a block gets at least, for how many of its own one more, and how many
 * for each that its last visit took: a surface that grows takes more each time.
 */
constexpr int FewPlaces = 128;
constexpr int VerticesPerPlace = 4;
constexpr int PlacesPerTaken = 4;

// See SurfaceBlocks; in delta. An edge, of which both ends may move by half a delta at once:
constexpr float LongestEdge = HugeEdge * SizingField::LongestEdgeInDelta + 1.f;
static_assert(LongestBridgeEdge * SizingField::LongestEdgeInDelta <= LongestEdge &&
    SizingField::DivisionFactor * SizingField::LongestEdgeInDelta <= LongestEdge,
  "a merge, and a division that keeps an old edge, make none longer");
/** As far as Proximity looks, about a vertex that is slow. */
constexpr float Reach = SizingField::ReachInDelta + Proximity::FurtherReachInDelta;
static_assert(SurfaceBlocks::EditedInDelta + LongestEdge <= SurfaceBlocks::WrittenInDelta,
  "an edit writes as far as the edges of the stars that it may begin at");
static_assert(SurfaceBlocks::MovingInDelta + 0.5f <= SurfaceBlocks::EditedInDelta,
  "what has moved is written no further than what is edited");
static_assert(SurfaceBlocks::WrittenInDelta + Reach + LongestEdge <= SurfaceBlocks::HaloInDelta,
  "what is examined is written, and stars within its reach are read");
static_assert(SurfaceBlocks::WrittenInDelta + SurfaceBlocks::HaloInDelta +
      SizingField::ReachInDelta <=
    SurfaceBlocks::SideInDelta,
  "what visits of one colour write and read has no cell of the grid in common");

/** 0, 2, 1, 4, 3, ...: those of even place before their neighbours of odd place. */
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
  : State(state)
  , TheFrame(frame)
{
  state.Mesh.PutAside(this->Others); // What is free is for nobody.
  this->Collect(executor);
  this->FindOrder();
}

std::array<int, 3> SurfaceBlocks::PlaceOf(const Vector& position) const
{
  const Vector from = position - this->TheFrame.Low;
  const float along[3] = { from.X, from.Y, from.Z };
  std::array<int, 3> places;
  for (int axis = 0; axis < 3; ++axis)
  {
    const float place = along[axis] / this->TheFrame.Side[axis];
    places[axis] = static_cast<int>( // Which rounds down what is not negative.
      std::clamp(place, 0.f, static_cast<float>(this->TheFrame.Size[axis] - 1)));
  }
  return places;
}

std::array<int, 3> SurfaceBlocks::PlaceOf(int block) const
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
  return this->BlockOf(this->PlaceOf(position));
}

Box SurfaceBlocks::BoxOf(int block) const
{
  constexpr float endless = 1e9f;
  const std::array<int, 3> place = this->PlaceOf(block);
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
  const std::array<int, 3> place = this->PlaceOf(block);
  const std::array<int, 3>& size = this->TheFrame.Size;
  const auto from = [&place](int axis) { return std::max(place[axis] - 1, 0); };
  const auto to = [&](int axis) { return std::min(place[axis] + 1, size[axis] - 1); };
  for (int z = from(2); z <= to(2); ++z)
  {
    for (int y = from(1); y <= to(1); ++y)
    {
      for (int x = from(0); x <= to(0); ++x)
      {
        const int other = this->BlockOf({ x, y, z });
        if (other != block)
        {
          neighbours.push_back(other);
        }
      }
    }
  }
  return neighbours;
}

void SurfaceBlocks::Collect(Executor& executor)
{
  const SurfaceMesh& mesh = this->State.Mesh;
  const std::size_t n = mesh.Rings.size();
  ForSpans(executor, n, VertexSpan,
    [&](std::size_t, std::size_t begin, std::size_t end)
    {
      for (std::size_t v = begin; v < end; ++v)
      {
        if (mesh.IsAlive(static_cast<int>(v)))
        {
          this->State.Block[v] = this->BlockAt(mesh.Position[v]);
        }
      }
    });
  const std::array<int, 3>& size = this->TheFrame.Size;
  const std::size_t count =
    static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) * size[2];
  this->All.resize(count);
  for (std::size_t v = 0; v < n; ++v)
  {
    if (mesh.IsAlive(static_cast<int>(v)))
    {
      this->All[this->State.Block[v]].Vertices.push_back(static_cast<int>(v));
    }
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
  // Slab by slab, which touches memory less often than a colour after the other.
  this->Visits = std::make_unique<VisitSchedule>(
    std::move(order), [this](int block) { return this->NeighboursOf(block); });
}

int SurfaceBlocks::MissingPlacesOf(int block) const
{
  const OfBlock& own = this->All[block];
  const int has = own.Unused.Count() + static_cast<int>(own.Places.Free.size());
  const auto wantedFor = [&own](const std::vector<int>& vertices)
  {
    return vertices.empty() ? 0
                            : FewPlaces + static_cast<int>(vertices.size()) / VerticesPerPlace +
        PlacesPerTaken * own.Taken;
  };
  if (has >= wantedFor(own.Vertices) / 2)
  {
    return 0; // Also for those of the list that it really has.
  }
  const int wanted = wantedFor(this->VerticesOf(block));
  return has < wanted / 2 ? wanted : 0;
}

std::vector<int> SurfaceBlocks::MissingPlaces(Executor& executor) const
{
  std::vector<int> counts(this->All.size());
  ForSpans(executor, counts.size(), 1,
    [&](std::size_t b, std::size_t, std::size_t)
    { counts[b] = this->MissingPlacesOf(static_cast<int>(b)); });
  return counts;
}

void SurfaceBlocks::AddPlaces(const std::vector<int>& counts, Executor& executor)
{
  const int total = std::accumulate(counts.begin(), counts.end(), 0);
  if (total == 0)
  {
    return;
  }
  int next = this->State.AddUnusedPlaces(total, executor).Next;
  for (std::size_t block = 0; block < counts.size(); ++block)
  {
    if (counts[block] > 0)
    {
      OfBlock& own = this->All[block];
      for (int v = own.Unused.End; v > own.Unused.Next; --v)
      {
        own.Places.Free.push_back(v - 1); // Few are left; they stay aside.
      }
      own.Unused = { next, next + counts[block] };
      next += counts[block];
    }
  }
}

void SurfaceBlocks::Append(const IndexedSurface& surface, Executor& executor)
{
  for (const int v : this->State.Append(surface, executor))
  {
    this->State.Block[v] = this->BlockAt(this->State.Mesh.Position[v]);
    this->All[this->State.Block[v]].Vertices.push_back(v);
  }
}

void SurfaceBlocks::Clean(int block, std::vector<int>& vertices) const
{
  // Others' visits have removed some of them; places that are taken again belong to whom they say.
  const auto isOther = [this, block](int v)
  { return !this->State.Mesh.IsAlive(v) || this->State.Block[v] != block; };
  vertices.erase(std::remove_if(vertices.begin(), vertices.end(), isOther), vertices.end());
  const auto isInOrder = [&vertices]
  {
    return std::adjacent_find(vertices.begin(), vertices.end(), std::greater_equal<int>()) ==
      vertices.end();
  };
  if (!isInOrder()) // As they are where none has come from elsewhere.
  {
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  }
}

BlockVisit SurfaceBlocks::Open(int block)
{
  OfBlock& own = this->All[block];
  BlockVisit visit;
  visit.Block = block;
  visit.Vertices.swap(own.Vertices);
  this->Clean(block, visit.Vertices);
  visit.OldOnes = static_cast<std::ptrdiff_t>(visit.Vertices.size());
  visit.Share.Block = block;
  visit.Share.Places.Free.swap(own.Places.Free);
  // Some have come back from visits of others: the smallest is taken first, whoever came when.
  std::sort(visit.Share.Places.Free.begin(), visit.Share.Places.Free.end(), std::greater<int>());
  visit.Share.Unused = own.Unused;
  visit.PlacesBefore = visit.Share.NumberOfPlaces();
  const Box box = this->BoxOf(block);
  const float delta = this->State.Sizing.Smallest();
  visit.Moving = box.Grown(MovingInDelta * delta);
  visit.Share.Region = box.Grown(EditedInDelta * delta);
  visit.Written = box.Grown(WrittenInDelta * this->State.Sizing.Largest());
  return visit;
}

double SurfaceBlocks::SumUp(
  const std::function<double(int v)>& ofVertex, Executor& executor) const
{
  return SumOfSpans(executor, this->All.size(), 1,
    [&](std::size_t block, std::size_t)
    {
      double sum = 0.;
      for (const int v : this->VerticesOf(static_cast<int>(block)))
      {
        sum += ofVertex(v);
      }
      return sum;
    });
}

void SurfaceBlocks::AddNew(BlockVisit& visit, const std::vector<int>& vertices) const
{
  std::vector<int>& all = visit.Vertices;
  const auto oldOnes = visit.OldOnes;
  const std::size_t before = all.size();
  for (const int v : vertices)
  {
    if (this->State.Mesh.IsAlive(v) && this->State.Block[v] == NoBlock)
    {
      this->State.Block[v] = visit.Block;
      if (!std::binary_search(all.begin(), all.begin() + oldOnes, v)) // Else in an old one's place.
      {
        all.push_back(v);
      }
    }
  }
  if (all.size() > before)
  {
    std::sort(all.begin() + oldOnes, all.end());
    all.erase(std::unique(all.begin() + oldOnes, all.end()), all.end());
  }
}

void SurfaceBlocks::Close(BlockVisit&& visit)
{
  SurfaceState& s = this->State;
  visit.Share.EndPass(s);
  std::vector<int> stay;
  std::vector<int> gone;
  for (const int v : visit.Vertices)
  {
    if (s.Mesh.IsAlive(v) && s.Block[v] == visit.Block)
    {
      s.Block[v] = this->BlockAt(s.Mesh.Position[v]);
      (s.Block[v] == visit.Block ? stay : gone).push_back(v);
    }
  }
  std::sort(stay.begin(), stay.end());
  OfBlock& own = this->All[visit.Block];
  own.Places.Free.swap(visit.Share.Places.Free);
  own.Unused = visit.Share.Unused;
  const int places = static_cast<int>(own.Places.Free.size()) + own.Unused.Count();
  own.Taken = std::max(0, visit.PlacesBefore - places);
  const std::lock_guard<std::mutex> lock(this->Closing);
  own.Vertices.insert(own.Vertices.end(), stay.begin(), stay.end());
  for (const int v : gone)
  {
    this->All[s.Block[v]].Vertices.push_back(v);
  }
  for (const int v : visit.Share.Others)
  {
    this->All[s.Block[v]].Places.Free.push_back(v);
  }
  s.Mesh.CountOthers(
    visit.PlacesBefore - places - static_cast<int>(visit.Share.Others.size()));
  s.EulerCharacteristic += visit.Share.EulerCharacteristic;
}

std::vector<int> SurfaceBlocks::VerticesOf(int block) const
{
  std::vector<int> vertices = this->All[block].Vertices;
  this->Clean(block, vertices);
  return vertices;
}

SurfaceBlocks::~SurfaceBlocks()
{
  for (OfBlock& block : this->All)
  {
    this->State.Mesh.FreeFromAside(block.Places, block.Unused);
  }
  this->State.Mesh.FreeFromAside(this->Others, UnusedPlaces());
}

void SurfaceBlocks::Prefetch(int block) const
{
  // They follow each other but for a few that came later, whose places are anywhere.
  const std::vector<int>& vertices = this->All[block].Vertices;
  const std::size_t few = vertices.size() / 32;
  if (vertices.size() > 2 * few)
  {
    const int first = vertices[few];
    const int last = vertices[vertices.size() - 1 - few];
    if (first < last && last - first < 2 * static_cast<int>(vertices.size()))
    {
      this->State.Prefetch(first, last);
    }
  }
}

bool SurfaceBlocks::HasActive(int block) const
{
  const std::vector<int>& vertices = this->All[block].Vertices;
  return std::any_of(vertices.begin(), vertices.end(),
    [&](int v) { return this->State.Block[v] == block && this->State.Active[v] != 0; });
}
}
