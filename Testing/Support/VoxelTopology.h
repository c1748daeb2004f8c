// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicVoxelTopology_h
#define volumicVoxelTopology_h

#include "ForVoxels.h"

#include <algorithm>
#include <array>
#include <climits>
#include <map>
#include <numeric>
#include <ostream>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

/**
 * Topology of labels, computed from the voxels and the documented connectivity. Shares no code with
 * the tested module.
 */
namespace volumic
{
/** Topology of the compact solid of a label. */
struct BlockTopology
{
  long long Euler = 0;
  int Components = 0;
  int Cavities = 0;

  bool operator==(const BlockTopology& o) const
  {
    return this->Euler == o.Euler && this->Components == o.Components &&
      this->Cavities == o.Cavities;
  }
};

inline std::ostream& operator<<(std::ostream& stream, const BlockTopology& topology)
{
  return stream << "chi " << topology.Euler << ", " << topology.Components << " components, "
                << topology.Cavities << " cavities";
}

/**
 * Labels of a box of voxels. A label is connected through voxel faces. It is connected across a
 * voxel edge with two opposite voxels of the label, if the two other voxels have different labels,
 * or one label of higher rank.
 */
class VoxelTopology
{
public:
  using Voxel = std::array<int, 3>;

  /** @param labels x fastest @param rankOf rank of each label */
  VoxelTopology(const Voxel& size, const std::vector<int>& labels, std::vector<int> rankOf)
    : RankOf(std::move(rankOf)), Beyond(static_cast<int>(this->RankOf.size())),
      Size({ size[0] + 2, size[1] + 2, size[2] + 2 }),
      Stride({ 1, size[0] + 2, (size[0] + 2) * (size[1] + 2) }),
      Labels(static_cast<std::size_t>(this->Stride[2] * this->Size[2]), this->Beyond)
  {
    this->RankOf.push_back(INT_MAX);
    auto label = labels.begin();
    this->ForBox({ 1, 1, 1 }, { size[0] + 1, size[1] + 1, size[2] + 1 },
      [&](int v) { this->Labels[static_cast<std::size_t>(v)] = *label++; });
  }

  /** Return the topology of all labels. */
  std::map<int, BlockTopology> Count() const
  {
    std::map<int, BlockTopology> counts;
    std::map<int, std::array<Voxel, 2>> boxes; // bounding boxes with a margin of one voxel
    Sets parts(this->Labels.size());
    const Voxel end = { this->Size[0] - 1, this->Size[1] - 1, this->Size[2] - 1 };
    this->ForBox({ 0, 0, 0 }, end,
      [&](int v)
      {
        Octants voxels;
        for (int o = 0; o < 8; ++o)
        {
          voxels[o] = v + this->NumberOf(o & 1, o >> 1 & 1, o >> 2);
        }
        const Octants octants = this->LabelsOf(voxels);
        const Octants regions = this->RegionsOf(octants);
        for (int o = 0; o < 8; ++o)
        {
          parts.Join(voxels[o], voxels[regions[o]]);
          counts[octants[o]].Euler += regions[o] == o ? 1 : 0;
        }
        for (int axis = 0; axis < 3; ++axis) // faces and edges at the first octant
        {
          counts[octants[0]].Euler += octants[0] == octants[1 << axis] ? 3 : 0;
          const Ring four = this->LabelsOf(this->RingAt(v, axis));
          const int d = this->JoinedDiagonal(four);
          counts[four[0]].Euler -= std::count(four.begin(), four.end(), four[0]) == 4 ? 1 : 0;
          counts[four[d < 0 ? 0 : d]].Euler += d < 0 ? 0 : 1;
        }
      });
    this->ForBox({ 1, 1, 1 }, end,
      [&](int v)
      {
        const int label = this->LabelOf(v);
        counts[label].Euler -= 7;
        counts[label].Components += parts.Find(v) == v ? 1 : 0;
        auto& box = boxes.emplace(label, std::array<Voxel, 2>{ this->Size }).first->second;
        const Voxel at = { v % this->Stride[1], v / this->Stride[1] % this->Size[1],
          v / this->Stride[2] };
        for (int axis = 0; axis < 3; ++axis)
        {
          box[0][axis] = std::min(box[0][axis], at[axis] - 1);
          box[1][axis] = std::max(box[1][axis], at[axis] + 2);
        }
      });
    counts.erase(this->Beyond);
    for (auto& [label, topology] : counts)
    {
      topology.Cavities = this->PartsWithout(label, boxes[label][0], boxes[label][1]) - 1;
    }
    return counts;
  }

private:
  /** Sets of numbers from 0. The root of a set is its smallest member. */
  struct Sets
  {
    explicit Sets(std::size_t n) : Parent(n)
    {
      std::iota(this->Parent.begin(), this->Parent.end(), 0);
    }
    int Find(int i)
    {
      while (this->Parent[i] != i)
      {
        i = this->Parent[i] = this->Parent[this->Parent[i]];
      }
      return i;
    }
    void Join(int i, int j)
    {
      const auto [low, high] = std::minmax({ this->Find(i), this->Find(j) });
      this->Parent[high] = low;
    }
    std::vector<int> Parent;
  };

  using Ring = std::array<int, 4>;    ///< around an edge, in cyclic order
  using Octants = std::array<int, 8>; ///< around a corner; bit 0 of the index is along x

  /** Return the diagonal of four labels that is connected; -1: none. */
  int JoinedDiagonal(const Ring& ring) const
  {
    const auto isSplit = [&](int d)
    { return ring[d] == ring[d + 2] && ring[d] != ring[1 - d] && ring[d] != ring[3 - d]; };
    if (isSplit(0) && isSplit(1))
    {
      return this->Rank(ring[0]) < this->Rank(ring[1]) ? 0 : 1;
    }
    return isSplit(0) ? 0 : isSplit(1) ? 1 : -1;
  }

  /** Return for each octant the first octant that is connected with it within the cell. */
  Octants RegionsOf(const Octants& octants) const
  {
    if (std::count(octants.begin(), octants.end(), octants[0]) == 8)
    {
      return {};
    }
    Octants regions = { 0, 1, 2, 3, 4, 5, 6, 7 };
    const auto join = [&](int a, int b)
    {
      const auto [low, high] = std::minmax({ regions[a], regions[b] });
      std::replace(regions.begin(), regions.end(), high, low);
    };
    for (int o = 0; o < 8; ++o)
    {
      for (const int bit : { 1, 2, 4 })
      {
        if ((o & bit) == 0 && octants[o] == octants[o | bit])
        {
          join(o, o | bit);
        }
      }
    }
    for (int side = 0; side < 6; ++side)
    {
      const int axis = side / 2;
      const Ring ring = RingAt((side & 1) << axis, 1 << (axis + 1) % 3, 1 << (axis + 2) % 3);
      const int d = this->JoinedDiagonal(
        { octants[ring[0]], octants[ring[1]], octants[ring[2]], octants[ring[3]] });
      if (d >= 0)
      {
        join(ring[d], ring[d + 2]);
      }
    }
    // ABCDDCBA: the label of the lowest rank is connected through the centre.
    if (std::equal(octants.begin(), octants.end(), octants.rbegin()) &&
      std::set<int>(octants.begin(), octants.end()).size() == 4)
    {
      const auto first = std::min_element(octants.begin(), octants.end(),
        [&](int a, int b) { return this->Rank(a) < this->Rank(b); });
      const auto o = static_cast<int>(first - octants.begin());
      join(o, 7 - o);
    }
    return regions;
  }

  int NumberOf(int i, int j, int k) const { return i + j * this->Stride[1] + k * this->Stride[2]; }
  int Rank(int label) const { return this->RankOf[static_cast<std::size_t>(label)]; }
  int LabelOf(int v) const { return this->Labels[static_cast<std::size_t>(v)]; }
  template <typename Voxels>
  Voxels LabelsOf(Voxels voxels) const
  {
    for (int& v : voxels)
    {
      v = this->LabelOf(v);
    }
    return voxels;
  }
  static Ring RingAt(int first, int b, int c)
  {
    return { first, first + b, first + b + c, first + c };
  }
  /** Return the voxels around an edge along an axis. */
  Ring RingAt(int v, int axis) const
  {
    return RingAt(v, this->Stride[(axis + 1) % 3], this->Stride[(axis + 2) % 3]);
  }

  /** Count the components of the complement of a label in a box (complementary connectivity). */
  int PartsWithout(int label, const Voxel& first, const Voxel& end) const
  {
    const Voxel size = { end[0] - first[0], end[1] - first[1], end[2] - first[2] };
    const Voxel stride = { 1, size[0], size[0] * size[1] };
    Sets parts(static_cast<std::size_t>(stride[2] * size[2]));
    const auto isOther = [&](int v) { return this->LabelOf(v) != label; };
    int local = -1; // number in the box
    this->ForBox(first, end,
      [&](int v)
      {
        ++local;
        const Voxel at = { local % size[0], local / stride[1] % size[1], local / stride[2] };
        for (int a = 0; a < 3; ++a)
        {
          const int b = (a + 1) % 3;
          const int c = (a + 2) % 3;
          if (at[a] + 1 < size[a] && isOther(v) && isOther(v + this->Stride[a]))
          {
            parts.Join(local, local + stride[a]);
          }
          if (at[b] + 1 == size[b] || at[c] + 1 == size[c])
          {
            continue;
          }
          const Ring ring = this->RingAt(v, a);
          const int joined = this->JoinedDiagonal(this->LabelsOf(ring));
          if (joined != 1 && isOther(ring[0]) && isOther(ring[2]))
          {
            parts.Join(local, local + stride[b] + stride[c]);
          }
          if (joined != 0 && isOther(ring[1]) && isOther(ring[3]))
          {
            parts.Join(local + stride[b], local + stride[c]);
          }
        }
      });
    int count = 0;
    local = -1;
    this->ForBox(first, end,
      [&](int v)
      {
        ++local;
        count += isOther(v) && parts.Find(local) == local ? 1 : 0;
      });
    return count;
  }

  template <typename Visit>
  void ForBox(const Voxel& first, const Voxel& end, Visit&& visit) const
  {
    volumic::ForBox(first, end, [&](int i, int j, int k) { visit(this->NumberOf(i, j, k)); });
  }

  std::vector<int> RankOf;
  int Beyond; ///< label outside the box, of the highest rank
  Voxel Size;
  Voxel Stride;
  std::vector<int> Labels;
};

using Voxel = VoxelTopology::Voxel;

/** Labels in a box whose outermost layer is background. */
struct VoxelLabels
{
  Voxel Size;
  std::vector<int> Labels; ///< x fastest
  std::vector<int> RankOf;
  int Outside = -1;

  /** Create inner voxels and a layer around them. Ranks: fewest voxels first, background last. */
  template <typename LabelAt>
  VoxelLabels(const Voxel& inner, LabelAt&& labelAt, int outside = -1)
    : Size({ inner[0] + 2, inner[1] + 2, inner[2] + 2 }), Outside(outside)
  {
    ForVoxels(this->Size,
      [&](int i, int j, int k)
      {
        const bool isIn =
          i > 0 && j > 0 && k > 0 && i <= inner[0] && j <= inner[1] && k <= inner[2];
        this->Labels.push_back(isIn ? labelAt(i - 1, j - 1, k - 1) : std::max(outside, 0));
      });
    this->RankByCount();
  }

  int NumberOfLabels() const
  {
    return 1 + *std::max_element(this->Labels.begin(), this->Labels.end());
  }

  void RankByCount()
  {
    std::vector<long long> counts(static_cast<std::size_t>(this->NumberOfLabels()), 0);
    for (const int label : this->Labels)
    {
      ++counts[static_cast<std::size_t>(label)];
    }
    std::vector<int> order(counts.size());
    std::iota(order.begin(), order.end(), 0);
    const auto key = [&](int label)
    {
      return std::make_tuple(
        label == this->Outside, label == 0, counts[static_cast<std::size_t>(label)]);
    };
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b); });
    this->RankInOrder(order);
  }
  void RankInOrder(const std::vector<int>& order)
  {
    this->RankOf.resize(order.size());
    for (std::size_t n = 0; n < order.size(); ++n)
    {
      this->RankOf[static_cast<std::size_t>(order[n])] = static_cast<int>(n);
    }
  }

  int At(int i, int j, int k) const
  {
    return this->Labels[static_cast<std::size_t>(i + this->Size[0] * (j + this->Size[1] * k))];
  }
  VoxelTopology Voxels() const { return { this->Size, this->Labels, this->RankOf }; }
};

/** Return the topology of each label of a map, x fastest; 0 is background. Merged labels count as
   the first of them. @param isInBox whether the map ends at the sides of a box */
inline std::map<double, BlockTopology> TopologiesOf(
  const Voxel& size, std::vector<double> labels, const std::set<double>& merged, bool isInBox)
{
  std::map<double, int> numbers = { { 0., 0 } };
  for (double& label : labels)
  {
    label = merged.count(label) > 0 ? *merged.begin() : label;
    numbers.emplace(label, 0);
  }
  int count = 0;
  for (auto& number : numbers)
  {
    number.second = count++;
  }
  auto next = labels.begin();
  const VoxelLabels voxels(
    size, [&](int, int, int) { return numbers.at(*next++); }, isInBox ? count : -1);
  std::map<int, BlockTopology> counts = voxels.Voxels().Count();
  std::map<double, BlockTopology> topologies;
  for (const auto& [label, number] : numbers)
  {
    topologies[label] = counts[number];
  }
  return topologies;
}
}

#endif
