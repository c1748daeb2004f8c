// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/VertexGrid.h"

#include "Core/Common/Grow.h"

#include <algorithm>
#include <cmath>

namespace volumic
{
namespace
{
/**
 * Limits of the memory of a grid, whatever its box: 8 bytes per brick pointer, and 32 bits per cell
 * number. They allow 2048 cells along each axis for the first and 1625 for the second, which
 * suffices for images of 2500^3 voxels. Larger grids get larger cells.
 */
constexpr double MaximumNumberOfBricks = 1 << 24;
constexpr double MaximumNumberOfCells = 4294967295.;
/** Minimum and maximum number of bricks per allocation, at 2 KiB each. */
constexpr std::size_t FewBricks = 32;
constexpr std::size_t ManyBricks = 1 << 15;
/** Growth factor of the cell size until the limits are met. */
constexpr float CellGrowth = 1.25f;
/** Vertices per task that are sorted into layers. */
constexpr std::size_t InsertedSpan = 1 << 14;
}

void VertexGrid::Reset(const Vector& low, const Vector& high, float cell)
{
  const auto count = [&](float from, float to)
  { return std::max(1., std::ceil(static_cast<double>(to - from) / cell)); };
  const auto bricks = [](double cells) { return std::ceil(cells / (Mask + 1)); };
  double size[3];
  const auto isTooFine = [&]
  {
    size[0] = count(low.X, high.X);
    size[1] = count(low.Y, high.Y);
    size[2] = count(low.Z, high.Z);
    return size[0] * size[1] * size[2] >= MaximumNumberOfCells ||
      bricks(size[0]) * bricks(size[1]) * bricks(size[2]) > MaximumNumberOfBricks;
  };
  while (isTooFine())
  {
    cell *= CellGrowth;
  }
  std::copy(size, size + 3, this->Size);
  this->Low[0] = low.X;
  this->Low[1] = low.Y;
  this->Low[2] = low.Z;
  this->Inverse = 1.f / cell;
  this->BricksAlong[0] = static_cast<int>(bricks(size[0]));
  this->BricksAlong[1] = static_cast<int>(bricks(size[1]));
  const auto numberOfBricks =
    static_cast<std::size_t>(bricks(size[0]) * bricks(size[1]) * bricks(size[2]));
  this->Made.clear();
  this->NumberMade = 0;
  this->Bricks = LargeVector<std::atomic<Brick*>>(numberOfBricks);
  this->Next = {};
  this->Cell = {};
}

void VertexGrid::Resize(std::size_t n)
{
  Grow(this->Cell, n, NoCell);
  Grow(this->Next, n, -1);
}

void VertexGrid::Clear()
{
  for (LargeVector<Brick>& bricks : this->Made)
  {
    for (Brick& brick : bricks)
    {
      brick.fill(-1);
    }
  }
  this->Next.clear();
  this->Cell.clear();
}

VertexGrid::Brick* VertexGrid::MakeBrick(std::size_t number)
{
  const std::lock_guard<std::mutex> lock(this->Making);
  Brick* brick = this->Bricks[number].load(std::memory_order_relaxed);
  if (!brick)
  {
    if (this->Made.empty() || this->Made.back().size() == this->Made.back().capacity())
    {
      const std::size_t n = std::max(FewBricks, this->NumberMade);
      this->Made.emplace_back();
      this->Made.back().reserve(std::min(n, ManyBricks));
    }
    this->Made.back().emplace_back();
    ++this->NumberMade;
    brick = &this->Made.back().back();
    brick->fill(-1);
    this->Bricks[number].store(brick, std::memory_order_release);
  }
  return brick;
}

int& VertexGrid::HeadOf(std::uint32_t cell)
{
  const auto sizeX = static_cast<std::uint32_t>(this->Size[0]);
  const auto sizeY = static_cast<std::uint32_t>(this->Size[1]);
  const std::uint32_t row = cell / sizeX;
  const int x = static_cast<int>(cell % sizeX);
  const int y = static_cast<int>(row % sizeY);
  const int z = static_cast<int>(row / sizeY);
  const std::size_t number = this->NumberOfBrick(x, y, z);
  Brick* brick = this->Bricks[number].load(std::memory_order_acquire);
  if (!brick)
  {
    brick = this->MakeBrick(number);
  }
  return (*brick)[IndexInBrick(x, y, z)];
}

void VertexGrid::Link(int v, std::uint32_t cell)
{
  int* link = &this->HeadOf(cell);
  while (*link >= 0 && *link < v)
  {
    link = &this->Next[*link];
  }
  this->Cell[v] = cell;
  this->Next[v] = *link;
  *link = v;
}

void VertexGrid::Insert(int v, const Vector& position)
{
  if (static_cast<std::size_t>(v) >= this->Cell.size())
  {
    this->Resize(static_cast<std::size_t>(v) + 1);
  }
  this->Link(v, this->CellOf(position));
}

namespace
{
/** Lists of vertices by layer of bricks. Threads process different layers concurrently. */
class LayeredTasks
{
public:
  /** @param put put(i, add) calls add(layer, vertex) for item i, or does nothing */
  template <typename Put>
  LayeredTasks(Executor& executor, std::size_t items, std::size_t layers, Put&& put)
    : Layers(layers), Lists((items + InsertedSpan - 1) / InsertedSpan)
  {
    ForSpans(executor, items, InsertedSpan,
      [&](std::size_t b, std::size_t begin, std::size_t end)
      {
        this->Lists[b].resize(layers);
        for (std::size_t i = begin; i < end; ++i)
        {
          put(i, [&](std::size_t layer, int v) { this->Lists[b][layer].push_back(v); });
        }
      });
  }

  /** Call work(v) for all vertices: sequentially and in order within a layer. */
  template <typename Work>
  void Run(Executor& executor, Work&& work) const
  {
    ForSpans(executor, this->Layers, 1,
      [&](std::size_t layer, std::size_t, std::size_t)
      {
        for (const auto& span : this->Lists)
        {
          for (int v : span[layer])
          {
            work(v);
          }
        }
      });
  }

private:
  std::size_t Layers;
  std::vector<std::vector<std::vector<int>>> Lists; ///< By span, then by layer.
};
}

void VertexGrid::InsertAll(const LargeVector<Vector>& positions, std::size_t first,
  const std::function<bool(int v)>& isThere, Executor& executor)
{
  this->Resize(positions.size());
  const auto layers = static_cast<std::size_t>((this->Size[2] + Mask) >> Bits);
  const LayeredTasks linking(executor, positions.size() - first, layers,
    [&](std::size_t i, auto&& add)
    {
      const int v = static_cast<int>(first + i);
      if (isThere(v))
      {
        add(this->LayerOf(this->CellOf(positions[v])), v);
      }
    });
  linking.Run(executor, [&](int v) { this->Link(v, this->CellOf(positions[v])); });
}

void VertexGrid::Remove(int v)
{
  int* link = &this->HeadOf(this->Cell[v]);
  while (*link != v)
  {
    link = &this->Next[*link];
  }
  *link = this->Next[v];
  this->Cell[v] = NoCell;
}
}
