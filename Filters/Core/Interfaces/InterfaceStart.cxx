// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/InterfaceStart.h"

#include "Core/Interfaces/DualMesh.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace volumic
{
namespace
{
using Number = LabelMap::Number;

/** Voxel layer of the map that corresponds to a layer of the grid. */
struct LayerOfGrid
{
  int Voxel = 0;
  bool IsOutside = false;
  bool IsHalf = false; ///< The outer half-layer of a periodic box, between Voxel - 1 and Voxel.
};

std::vector<LayerOfGrid> LayersAlong(const InterfaceFields& fields, int axis)
{
  const VoxelBox box =
    fields.HaveBox() ? fields.Bricks().Inside() : VoxelBox::Of(fields.Bricks().Map().Size());
  std::vector<LayerOfGrid> layers;
  for (int voxel = box.First[axis]; voxel < box.End[axis]; ++voxel)
  {
    layers.push_back({ voxel, false, false });
  }
  if (fields.ArePeriodic())
  {
    layers.insert(layers.begin(), { box.First[axis], false, true });
    layers.push_back({ box.End[axis], false, true });
  }
  if (fields.HaveBox())
  {
    layers.insert(layers.begin(), { box.First[axis] - 1, true, false });
    layers.push_back({ box.End[axis], true, false });
  }
  return layers;
}

/** Return the ranks (StartInterfaces). The outside of the box comes last. */
std::vector<int> RanksOf(const LabelBricks& bricks)
{
  const LabelMap& map = bricks.Map();
  const auto count = static_cast<std::size_t>(map.NumberOfObjects);
  std::vector<std::int64_t> voxels(count + 1, 0);
  for (std::size_t object = 1; object <= count; ++object)
  {
    voxels[map.Whole(static_cast<int>(object))] += bricks.ExtentOf(static_cast<int>(object)).Voxels;
  }
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 1);
  std::stable_sort(order.begin(), order.end(),
    [&](int a, int b)
    { return voxels[static_cast<std::size_t>(a)] < voxels[static_cast<std::size_t>(b)]; });
  std::vector<int> ranks(count + 2);
  for (std::size_t n = 0; n < count; ++n)
  {
    ranks[static_cast<std::size_t>(order[n])] = static_cast<int>(n);
  }
  // Parts of one object have one rank, as they do not meet.
  for (std::size_t object = 1; object <= count; ++object)
  {
    ranks[object] = ranks[map.Whole(static_cast<int>(object))];
  }
  ranks.front() = static_cast<int>(count);
  ranks.back() = static_cast<int>(count) + 1;
  return ranks;
}

class GridMaker
{
public:
  explicit GridMaker(const InterfaceFields& fields) : Fields(fields)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Layers[axis] = LayersAlong(fields, axis);
    }
  }

  DualGrid Make() const
  {
    const LabelBricks& bricks = this->Fields.Bricks();
    DualGrid grid;
    for (int axis = 0; axis < 3; ++axis)
    {
      const std::vector<LayerOfGrid>& layers = this->Layers[axis];
      const double step = this->Fields.Step()[axis];
      const auto put = [step](std::vector<float>& at, double voxels)
      { at.push_back(static_cast<float>(step * voxels)); };
      grid.Size[axis] = static_cast<int>(layers.size());
      for (std::size_t n = 0; n < layers.size(); ++n)
      {
        const LayerOfGrid& layer = layers[n];
        const bool isFirst = 2 * n < layers.size();
        put(grid.Centres[axis],
          layer.IsHalf ? layer.Voxel + (isFirst ? -0.375 : -0.625) : layer.Voxel);
        if (n + 1 < layers.size())
        {
          const LayerOfGrid& next = layers[n + 1];
          put(grid.Planes[axis],
            layer.IsHalf && isFirst     ? layer.Voxel - 0.25
              : next.IsHalf && !isFirst ? next.Voxel - 0.75
                                        : next.Voxel - 0.5);
        }
      }
    }
    grid.RankOf = RanksOf(bricks);
    grid.Outside = this->Fields.HaveBox() ? bricks.Map().NumberOfObjects + 1 : -1;
    grid.CopySlice = [maker = *this, outside = grid.Outside](int k, Number* labels)
    { maker.CopySlice(k, static_cast<Number>(outside), labels); };
    return grid;
  }

private:
  void CopySlice(int k, Number outside, Number* labels) const
  {
    const LabelMap& map = this->Fields.Bricks().Map();
    const LayerOfGrid& slice = this->Layers[2][static_cast<std::size_t>(k)];
    if (!this->Fields.HaveBox())
    {
      VoxelBox box = VoxelBox::Of(map.Size());
      box.First[2] = k;
      box.End[2] = k + 1;
      map.ForParts(box,
        [&](const VoxelBox& part, Number object)
        {
          for (int j = part.First[1]; j < part.End[1]; ++j)
          {
            std::fill_n(labels + box.NumberOf(part.First[0], j, k), part.Length(0), object);
          }
        });
      return;
    }
    for (const LayerOfGrid& row : this->Layers[1])
    {
      for (const LayerOfGrid& column : this->Layers[0])
      {
        *labels++ = slice.IsOutside || row.IsOutside || column.IsOutside
          ? outside
          : this->ObjectAt({ column, row, slice });
      }
    }
  }

  /** Return the object at a grid point; in half-layers the adjacent one with the largest field. */
  Number ObjectAt(const std::array<LayerOfGrid, 3>& layers) const
  {
    const LabelMap& map = this->Fields.Bricks().Map();
    std::array<std::array<int, 3>, 8> voxels;
    std::size_t count = 1;
    voxels[0] = { layers[0].Voxel, layers[1].Voxel, layers[2].Voxel };
    for (int axis = 0; axis < 3; ++axis)
    {
      for (std::size_t n = 0; n < (layers[axis].IsHalf ? count : 0); ++n)
      {
        voxels[count + n] = voxels[n];
        --voxels[count + n][axis];
      }
      count *= layers[axis].IsHalf ? 2 : 1;
    }
    std::array<Number, 8> candidates;
    for (std::size_t n = 0; n < count; ++n)
    {
      voxels[n] = this->Fields.SourceOf(voxels[n]);
      candidates[n] = map.At(voxels[n][0], voxels[n][1], voxels[n][2]);
    }
    std::sort(candidates.begin(), candidates.begin() + static_cast<std::ptrdiff_t>(count));
    Number best = candidates[0];
    float most = -std::numeric_limits<float>::max();
    for (std::size_t n = 0; n < count && candidates[0] != candidates[count - 1]; ++n)
    {
      float sum = 0.f;
      std::array<float, 8> values;
      for (std::size_t v = 0; v < count; ++v)
      {
        values[v] = this->Fields.At(candidates[n], voxels[v][0], voxels[v][1], voxels[v][2]);
      }
      std::sort(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count));
      for (std::size_t v = 0; v < count; ++v)
      {
        sum += values[v]; // Sorted, so that opposite sides give bit-identical sums.
      }
      best = sum > most ? candidates[n] : best;
      most = std::max(most, sum);
    }
    return best;
  }

  const InterfaceFields& Fields;
  std::array<std::vector<LayerOfGrid>, 3> Layers;
};
}

InterfaceMesh StartInterfaces(const InterfaceFields& fields, Executor& executor)
{
  InterfaceMesh mesh = MakeDualMesh(GridMaker(fields).Make(), executor);
  mesh.WholeOf = fields.Bricks().Map().WholeOf;
  if (fields.ArePeriodic())
  {
    mesh.MatchSides();
  }
  return mesh;
}
}
