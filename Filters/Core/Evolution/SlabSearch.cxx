// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/SlabSearch.h"

#include "Core/Image/VoxelNumbers.h"

#include <algorithm>
#include <cmath>

namespace volumic
{
namespace
{
/**
 * Offset of rows from the voxels along y and z, in voxels. Rows then hardly hit edges or corners of
 * surfaces with round coordinates.
 */
constexpr double Aside[2] = { 1.2345e-4, 1.7 * 1.2345e-4 };

constexpr int BitsOfWord = 64;
}

SlabSearch::SlabSearch(
  const SurfaceState& state, const Field& field, PartKind kind, int begin, int end)
  : State(state), TheField(field), Kind(kind),
    Size(field.Image().Size), Rows{ { 0, 0, begin }, { Size[0], Size[1], end } },
    Words((Size[0] + BitsOfWord - 1) / BitsOfWord),
    Open(static_cast<std::size_t>(end - begin) * Size[1] * Words,
      kind == PartKind::Object ? ~std::uint64_t(0) : 0)
{
  for (int k = 0; k < 3; ++k)
  {
    this->Inverse[k] = 1. / field.Image().Step[k];
  }
}

void SlabSearch::Set(std::int64_t row, int first, int last, bool isOpen)
{
  if (first > last)
  {
    return;
  }
  std::uint64_t* words = this->Open.data() + static_cast<std::size_t>(row) * this->Words;
  for (int w = first / BitsOfWord; w <= last / BitsOfWord; ++w)
  {
    const std::uint64_t all = ~std::uint64_t(0);
    const std::uint64_t bits = (w == first / BitsOfWord ? all << first % BitsOfWord : all) &
      (w == last / BitsOfWord ? all >> (BitsOfWord - 1 - last % BitsOfWord) : all);
    words[w] = isOpen ? words[w] | bits : words[w] & ~bits;
  }
}

void SlabSearch::LeaveSide(const int* vertices, std::size_t count)
{
  const auto cornerAt = [this](int v)
  {
    const Vector& p = this->State.Mesh.Position[v];
    return Point{ p.X * this->Inverse[0], p.Y * this->Inverse[1] - Aside[0],
      p.Z * this->Inverse[2] - Aside[1] };
  };
  std::vector<RowGrid::Crossing> crossings;
  for (std::size_t i = 0; i < count; ++i)
  {
    const auto v = static_cast<std::size_t>(vertices[i]);
    this->State.Mesh.VisitFaces(v, v + 1,
      [&](int a, int b, int c) {
        this->Rows.AddCrossings({ cornerAt(a), cornerAt(b), cornerAt(c) }, crossings);
      });
  }
  std::sort(crossings.begin(), crossings.end());
  for (std::size_t i = 0; i + 1 < crossings.size();)
  {
    if (crossings[i].Row != crossings[i + 1].Row)
    {
      ++i; // A closed surface has no odd crossings.
      continue;
    }
    const auto x = [&](std::size_t n) { return static_cast<float>(crossings[n].Where.X); };
    const int first = std::max(0, static_cast<int>(std::ceil(x(i))));
    const int last = std::min(this->Size[0] - 1, static_cast<int>(std::floor(x(i + 1))));
    this->Set(crossings[i].Row, first, last, this->Kind == PartKind::Cavity);
    i += 2;
  }
}

void SlabSearch::CloseNear(int v)
{
  // Independent of the voxel distances.
  const double width = NearUnits * this->TheField.Image().Unit;
  const auto& step = this->TheField.Image().Step;
  const Vector& p = this->State.Mesh.Position[v];
  const double position[3] = { p.X * this->Inverse[0], p.Y * this->Inverse[1],
    p.Z * this->Inverse[2] };
  int low[3];
  int high[3];
  for (int k = 0; k < 3; ++k)
  {
    const double reach = width * this->Inverse[k];
    low[k] = std::max(
      static_cast<int>(this->Rows.First[k]), static_cast<int>(std::ceil(position[k] - reach)));
    high[k] = std::min(
      static_cast<int>(this->Rows.End[k]) - 1, static_cast<int>(std::floor(position[k] + reach)));
  }
  for (int k = low[2]; k <= high[2]; ++k)
  {
    for (int j = low[1]; j <= high[1]; ++j)
    {
      const double y = (j - position[1]) * step[1];
      const double z = (k - position[2]) * step[2];
      const auto isFar = [&](int i)
      {
        const double x = (i - position[0]) * step[0];
        return !(x * x + y * y + z * z <= width * width);
      };
      int first = low[0];
      int last = high[0];
      while (first <= last && isFar(first))
      {
        ++first;
      }
      while (first <= last && isFar(last))
      {
        --last;
      }
      this->Set(this->Rows.RowOf(j, k), first, last, false);
    }
  }
}

std::vector<VoxelRun> SlabSearch::FindRuns() const
{
  std::vector<VoxelRun> runs;
  std::vector<float> values(static_cast<std::size_t>(this->Size[0]));
  for (int k = static_cast<int>(this->Rows.First[2]); k < this->Rows.End[2]; ++k)
  {
    for (int j = 0; j < this->Size[1]; ++j)
    {
      const std::uint64_t* open =
        this->Open.data() + static_cast<std::size_t>(this->Rows.RowOf(j, k)) * this->Words;
      if (std::any_of(open, open + this->Words, [](std::uint64_t word) { return word != 0; }))
      {
        this->TheField.Row(0, j, k, this->Size[0], values.data());
        this->AddRuns(VoxelNumbers(this->Size).Of(0, j, k), open, values, runs);
      }
    }
  }
  return runs;
}

void SlabSearch::AddRuns(std::int64_t row, const std::uint64_t* open,
  const std::vector<float>& values, std::vector<VoxelRun>& runs) const
{
  bool isOnRun = false;
  for (int w = 0; w < this->Words; ++w)
  {
    int i = w * BitsOfWord;
    const int end = std::min(i + BitsOfWord, this->Size[0]);
    for (std::uint64_t bits = open[w]; bits != 0 && i < end; bits >>= 1, ++i)
    {
      const bool isMissed = (bits & 1) != 0 && (values[i] > 0) == (this->Kind == PartKind::Object);
      if (isMissed && isOnRun)
      {
        ++runs.back().Length;
      }
      else if (isMissed)
      {
        runs.push_back({ row + i, 1, 0 });
      }
      isOnRun = isMissed;
    }
    isOnRun = isOnRun && i == end;
  }
}
}
