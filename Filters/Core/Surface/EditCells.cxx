// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/EditCells.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace volumic
{
namespace
{
/** Clearance times NewFaces' share of it, in delta: what an edit looks beyond its own faces. */
constexpr float LookedBeyond = 1.6f;
/** Room for rounding, in delta. */
constexpr float Spare = 0.1f;
/** Items under which the threads are not worth waking. */
constexpr std::size_t FewItems = 24;
/** Items that are sorted into cells by one thread at a time. */
constexpr std::size_t SortedBlock = 2048;
/** Cells that are filled by one thread at a time. */
constexpr std::size_t FilledCells = 64;

/** Numbers of cells along an axis: 20 bits, beyond which the outermost takes all. */
constexpr int Bits = 20;
constexpr int Half = 1 << (Bits - 1);
constexpr int Colours = 8;

int Along(float x, float inverse)
{
  const float place = std::floor(x * inverse);
  return static_cast<int>(std::clamp(place, static_cast<float>(-Half), static_cast<float>(Half - 1)));
}

/** Colour, z, y, x. */
std::uint64_t CellAt(const Vector& p, float inverse)
{
  const int place[3] = { Along(p.X, inverse), Along(p.Y, inverse), Along(p.Z, inverse) };
  std::uint64_t colour = 0;
  std::uint64_t key = 0;
  for (int axis = 2; axis >= 0; --axis)
  {
    colour = colour << 1 | static_cast<std::uint64_t>(place[axis] & 1);
    key = key << Bits | static_cast<std::uint64_t>(place[axis] + Half);
  }
  return colour << (3 * Bits) | key;
}

int ColourOf(std::uint64_t cell)
{
  return static_cast<int>(cell >> (3 * Bits));
}

Box BoxOf(std::uint64_t cell, float side)
{
  Vector low;
  const auto along = [cell](int axis)
  { return static_cast<int>(cell >> (axis * Bits) & ((1 << Bits) - 1)) - Half; };
  low.X = static_cast<float>(along(0)) * side;
  low.Y = static_cast<float>(along(1)) * side;
  low.Z = static_cast<float>(along(2)) * side;
  return { low, low + Vector(side, side, side) };
}
}

float EditCells::Side(const Pass& pass) const
{
  const float delta = this->State.Sizing.Largest();
  const float longest =
    std::max(HugeEdge * SizingField::LongestEdgeInDelta * delta, this->State.LongestEdge);
  return 3 * longest + (2 * pass.MarginInDelta + LookedBeyond + Spare) * delta;
}

void EditCells::FindStretches(const std::vector<int>& items, const Pass& pass, float side)
{
  // Items that follow each other lie near each other mostly: as vertices do along their curve.
  const float inverse = 1 / side;
  std::vector<std::vector<Stretch>> blocks((items.size() + SortedBlock - 1) / SortedBlock);
  ForBlocks(this->Threads, items.size(), SortedBlock,
    [&](std::size_t b, std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        const int v = pass.VertexOf ? pass.VertexOf(items[i]) : items[i];
        const std::uint64_t cell = CellAt(this->State.Mesh.Position[v], inverse);
        const int place = static_cast<int>(i);
        if (blocks[b].empty() || blocks[b].back().Cell != cell)
        {
          blocks[b].push_back({ cell, place, place });
        }
        blocks[b].back().End = place + 1;
      }
    });
  this->Stretches.clear();
  for (const std::vector<Stretch>& block : blocks)
  {
    this->Stretches.insert(this->Stretches.end(), block.begin(), block.end());
  }
  std::sort(this->Stretches.begin(), this->Stretches.end(),
    [](const Stretch& a, const Stretch& b)
    { return a.Cell != b.Cell ? a.Cell < b.Cell : a.Begin < b.Begin; });
}

void EditCells::FillCells(const std::vector<int>& items, const Pass& pass, float side)
{
  this->FindStretches(items, pass, side);
  this->FirstOfColour.assign(Colours + 1, 0);
  this->FirstStretch.clear();
  for (std::size_t i = 0; i < this->Stretches.size(); ++i)
  {
    const std::uint64_t cell = this->Stretches[i].Cell;
    if (i == 0 || cell != this->Stretches[i - 1].Cell)
    {
      this->FirstStretch.push_back(i);
      ++this->FirstOfColour[ColourOf(cell) + 1];
    }
  }
  const std::size_t count = this->FirstStretch.size();
  this->FirstStretch.push_back(this->Stretches.size());
  for (int colour = 0; colour < Colours; ++colour)
  {
    this->FirstOfColour[colour + 1] += this->FirstOfColour[colour];
  }
  while (this->Cells.size() < count)
  {
    this->Cells.push_back(std::make_unique<Cell>());
    Cell& made = *this->Cells.back();
    made.Editor = std::make_unique<SurfaceEditor>(this->State, &made.Share);
  }
  this->Threads.For(count, FilledCells,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t c = begin; c < end; ++c)
      {
        Cell& cell = *this->Cells[c];
        this->FillCell(cell, this->FirstStretch[c], this->FirstStretch[c + 1], items);
        cell.Share.Region = BoxOf(this->Stretches[this->FirstStretch[c]].Cell, side)
                              .Grown(pass.MarginInDelta * this->State.Sizing.Largest());
      }
    });
}

void EditCells::FillCell(Cell& cell, std::size_t firstStretch, std::size_t lastStretch,
  const std::vector<int>& items)
{
  cell.Content.Items.clear();
  cell.Content.Kept.clear();
  for (std::size_t i = firstStretch; i < lastStretch; ++i)
  {
    const Stretch& stretch = this->Stretches[i];
    cell.Content.Items.insert(
      cell.Content.Items.end(), items.begin() + stretch.Begin, items.begin() + stretch.End);
  }
}

void EditCells::LendPlaces(const Pass& pass, std::size_t first, std::size_t last)
{
  const auto wanted = [&](std::size_t c)
  { return pass.PlacesPerCell + pass.PlacesPerItem * this->Cells[c]->Content.Items.size(); };
  std::size_t total = 0;
  for (std::size_t c = first; c < last; ++c)
  {
    total += wanted(c);
  }
  if (total == 0)
  {
    return;
  }
  VertexPlaces all;
  this->State.Lend(all, total);
  for (std::size_t c = first; c < last; ++c)
  {
    // Of a block there may be fewer: those that come too late wait for its next visit.
    const auto from =
      all.Free.end() - static_cast<std::ptrdiff_t>(std::min(wanted(c), all.Free.size()));
    this->Cells[c]->Share.Places.Free.assign(from, all.Free.end());
    all.Free.erase(from, all.Free.end());
  }
}

void EditCells::VisitCell(const Pass& pass, Cell& cell)
{
  // The list grows while it is walked.
  const std::size_t given = cell.Content.Items.size();
  for (std::size_t i = 0; i < cell.Content.Items.size(); ++i)
  {
    const int item = cell.Content.Items[i];
    cell.Share.WasOutOfRegion = false;
    cell.Share.LackedPlaces = false;
    pass.Visit(*cell.Editor, item, cell.Content);
    if (cell.Share.LackedPlaces)
    {
      cell.LeftForPlaces.push_back(item);
    }
    else if (cell.Share.WasOutOfRegion)
    {
      cell.LeftForRegion.push_back(item);
    }
  }
  // An edit names all that it has changed: of a cell's, many are the same.
  cell.Changed = cell.Editor->TakeChanged();
  std::sort(cell.Changed.begin(), cell.Changed.end());
  cell.Changed.erase(std::unique(cell.Changed.begin(), cell.Changed.end()), cell.Changed.end());
  std::vector<int>& items = cell.Content.Items;
  items.erase(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(given));
}

void EditCells::Collect(std::size_t first, std::size_t last)
{
  const auto append = [](std::vector<int>& to, std::vector<int>& from)
  {
    to.insert(to.end(), from.begin(), from.end());
    from.clear();
  };
  // The last that was given away comes back first, so that the list is as it was.
  for (std::size_t c = last; c-- > first;)
  {
    this->State.Mesh.TakeBack(this->Cells[c]->Share.Places);
  }
  for (std::size_t c = first; c < last; ++c)
  {
    Cell& cell = *this->Cells[c];
    append(this->Removed.Removed, cell.Share.Places.Removed);
    append(this->LeftForPlaces, cell.LeftForPlaces);
    append(this->LeftForRegion, cell.LeftForRegion);
    append(this->AllAdded, cell.Content.Items);
    append(this->AllKept, cell.Content.Kept);
    this->State.Counts += cell.Share.Counts;
    this->State.EulerCharacteristic += cell.Share.EulerCharacteristic;
    cell.Share.Counts = EditCounts();
    cell.Share.EulerCharacteristic = 0;
    append(this->Log, cell.Changed);
  }
}

bool EditCells::RunRound(const std::vector<int>& items, const Pass& pass)
{
  this->FillCells(items, pass, this->Side(pass));
  for (int colour = 0; colour < Colours; ++colour)
  {
    const auto first = static_cast<std::size_t>(this->FirstOfColour[colour]);
    const auto last = static_cast<std::size_t>(this->FirstOfColour[colour + 1]);
    if (first == last)
    {
      continue;
    }
    if (pass.GoOn && !pass.GoOn())
    {
      return false;
    }
    this->LendPlaces(pass, first, last);
    std::size_t count = 0;
    for (std::size_t c = first; c < last; ++c)
    {
      count += this->Cells[c]->Content.Items.size();
    }
    this->Threads.For(last - first, count < FewItems ? last - first : 1,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t c = begin; c < end; ++c)
        {
          this->VisitCell(pass, *this->Cells[first + c]);
        }
      });
    this->Collect(first, last);
  }
  return true;
}

void EditCells::Run(const Pass& pass)
{
  this->AllAdded.clear();
  this->AllKept.clear();
  std::vector<int> items = pass.Items;
  while (!items.empty())
  {
    this->LeftForPlaces.clear();
    this->LeftForRegion.clear();
    const std::size_t changed = this->Log.size();
    if (!this->RunRound(items, pass))
    {
      break;
    }
    const std::size_t visited = items.size();
    items = std::exchange(this->LeftForPlaces, {});
    // Where nothing has changed it would be refused again.
    if (this->Log.size() == changed && items.size() == visited)
    {
      break;
    }
    if (this->Log.size() > changed)
    {
      items.insert(items.end(), this->LeftForRegion.begin(), this->LeftForRegion.end());
    }
  }
  this->State.Mesh.TakeRemoved(this->Removed);
}

std::vector<int> EditCells::TakeChanged()
{
  return std::exchange(this->Log, {});
}
}
