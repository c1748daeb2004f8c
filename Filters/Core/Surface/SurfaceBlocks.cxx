// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/SurfaceBlocks.h"

#include "Core/Common/Blocks.h"
#include "Core/Mesh/SurfaceMeasures.h"

#include <algorithm>
#include <cmath>

namespace volumic
{
namespace
{
/** Vertices that one thread looks at at a time. */
constexpr std::size_t VertexBlock = 8192;
/** Places that a block keeps for itself; others are anyone's. */
constexpr std::size_t MostPlaces = 1024;

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

SurfaceBlocks::SurfaceBlocks(SurfaceState& state, float side, Executor& executor)
  : State(state)
  , Side(side)
{
  this->Collect(executor);
  this->FindOrder();
}

int SurfaceBlocks::BlockAt(const Vector& position) const
{
  const Vector from = position - this->Low;
  const float along[3] = { from.X, from.Y, from.Z };
  int block = 0;
  for (int axis = 2; axis >= 0; --axis)
  {
    const int place = static_cast<int>(std::floor(along[axis] / this->Side));
    block = block * this->Size[axis] + std::clamp(place, 0, this->Size[axis] - 1);
  }
  return block;
}

void SurfaceBlocks::Collect(Executor& executor)
{
  const SurfaceMesh& mesh = this->State.Mesh;
  const Box bounds = BoundsOf(mesh, executor);
  this->Low = bounds.Low;
  const Vector extent = bounds.High - bounds.Low;
  const float along[3] = { extent.X, extent.Y, extent.Z };
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Size[axis] = std::max(1, static_cast<int>(std::ceil(along[axis] / this->Side)));
  }
  const std::size_t n = mesh.Rings.size();
  ForBlocks(executor, n, VertexBlock,
    [&](std::size_t, std::size_t begin, std::size_t end)
    {
      for (std::size_t v = begin; v < end; ++v)
      {
        this->State.Block[v] =
          mesh.IsAlive(static_cast<int>(v)) ? this->BlockAt(mesh.Position[v]) : NoBlock;
      }
    });
  const std::size_t count =
    static_cast<std::size_t>(this->Size[0]) * this->Size[1] * this->Size[2];
  this->Vertices.resize(count);
  this->Places.resize(count);
  for (std::size_t v = 0; v < n; ++v)
  {
    if (this->State.Block[v] != NoBlock)
    {
      this->Vertices[this->State.Block[v]].push_back(static_cast<int>(v));
    }
  }
}

void SurfaceBlocks::FindOrder()
{
  for (const int z : EvenFirst(this->Size[2]))
  {
    for (const int y : EvenFirst(this->Size[1]))
    {
      for (const int x : EvenFirst(this->Size[0]))
      {
        this->Visits.push_back(x + this->Size[0] * (y + this->Size[1] * z));
      }
    }
  }
}

const std::vector<int>& SurfaceBlocks::Open(int block)
{
  this->Opened = block;
  this->CommonPlaces = this->State.Mesh.NumberOfFreePlaces();
  this->State.Mesh.TakeFromAside(this->Places[block]);
  // Others' visits have removed some of them; places that are taken again belong to whom they say.
  std::vector<int>& vertices = this->Vertices[block];
  const auto isOther = [this, block](int v)
  { return !this->State.Mesh.IsAlive(v) || this->State.Block[v] != block; };
  vertices.erase(std::remove_if(vertices.begin(), vertices.end(), isOther), vertices.end());
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  this->OldOnes = static_cast<std::ptrdiff_t>(vertices.size());
  return vertices;
}

void SurfaceBlocks::AddNew(const std::vector<int>& vertices)
{
  std::vector<int>& all = this->Vertices[this->Opened];
  const auto endOfOld = all.begin() + this->OldOnes;
  std::vector<int> added(endOfOld, all.end());
  for (const int v : vertices)
  {
    if (this->State.Mesh.IsAlive(v) && this->State.Block[v] == NoBlock)
    {
      this->State.Block[v] = this->Opened;
      if (!std::binary_search(all.begin(), endOfOld, v)) // Else in the place of an old one.
      {
        added.push_back(v);
      }
    }
  }
  std::sort(added.begin(), added.end());
  added.erase(std::unique(added.begin(), added.end()), added.end());
  all.erase(endOfOld, all.end());
  all.insert(all.end(), added.begin(), added.end());
}

void SurfaceBlocks::Close()
{
  const SurfaceMesh& mesh = this->State.Mesh;
  std::vector<int> stay;
  for (const int v : this->Vertices[this->Opened])
  {
    if (mesh.IsAlive(v) && this->State.Block[v] == this->Opened)
    {
      const int block = this->BlockAt(mesh.Position[v]);
      this->State.Block[v] = block;
      (block == this->Opened ? stay : this->Vertices[block]).push_back(v);
    }
  }
  this->Vertices[this->Opened].swap(stay);
  const std::size_t free = mesh.NumberOfFreePlaces();
  const std::size_t own = free > this->CommonPlaces ? free - this->CommonPlaces : 0;
  this->State.Mesh.PutAside(this->Places[this->Opened], std::min(own, MostPlaces));
  this->Opened = NoBlock;
}

SurfaceBlocks::~SurfaceBlocks()
{
  for (VertexPlaces& places : this->Places)
  {
    this->State.Mesh.TakeFromAside(places);
  }
}

void SurfaceBlocks::Prefetch(int block) const
{
  // They follow each other but for a few that came later, whose places are anywhere.
  const std::vector<int>& vertices = this->Vertices[block];
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
  const std::vector<int>& vertices = this->Vertices[block];
  return std::any_of(vertices.begin(), vertices.end(),
    [&](int v) { return this->State.Block[v] == block && this->State.Active[v] != 0; });
}

}
