// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Labels/LabelField.h"

#include "Core/Common/Blocks.h"
#include "Core/Labels/BoundaryGaussian.h"
#include "Core/Labels/BoundaryRows.h"
#include "Core/Labels/LabelHold.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace volumic
{
namespace
{
/** Only voxels nearer to the boundary than this can come to the wrong side of it. */
constexpr float MostWrong = 1.5f;
/** More than that is the ridge of a thin part, which is no bend. */
constexpr float MostCurvature = 0.35f;
/** What the field has at a voxel at least, where not all constraints can be met. */
constexpr float LeastSize = 0.05f;
/** The Laplacian of the distance is taken this near to the boundary. */
constexpr float MostBent = 2.5f;

/** The quantiles of the normal distribution, from a table: the same bits on any machine. */
class NormalQuantile
{
public:
  static const NormalQuantile& Table()
  {
    static const NormalQuantile table;
    return table;
  }

  float At(float share) const
  {
    const float place = std::clamp(share, 0.f, 1.f) * Steps;
    const int step = std::min(static_cast<int>(place), Steps - 1);
    const float* values = this->Values.data() + step;
    return values[0] + (place - static_cast<float>(step)) * (values[1] - values[0]);
  }

private:
  static constexpr int Steps = 4096;

  NormalQuantile()
  {
    for (int i = 0; i <= Steps; ++i)
    {
      const double share = std::clamp(i / static_cast<double>(Steps), 1e-5, 1. - 1e-5);
      double low = -5.;
      double high = 5.;
      for (int halving = 0; halving < 50; ++halving)
      {
        const double middle = 0.5 * (low + high);
        (0.5 * std::erfc(-middle / std::sqrt(2.)) < share ? low : high) = middle;
      }
      this->Values[static_cast<std::size_t>(i)] = static_cast<float>(0.5 * (low + high));
    }
  }

  std::array<float, Steps + 1> Values;
};

/** Makes the field of one object, step by step. */
class FieldMaker
{
public:
  FieldMaker(const LabelBricks& bricks, int object, const LabelFieldOptions& options,
    Executor& executor)
    : Map(bricks.Map())
    , Object(static_cast<LabelMap::Number>(object))
    , Options(options)
    , Threads(executor)
    , Rows(bricks, object)
  {
  }

  LabelField Make()
  {
    this->Field.Box = this->Rows.Box();
    this->Field.Values.resize(static_cast<std::size_t>(this->Field.Box.Count()));
    this->FillFarVoxels();
    if (this->Options.Sigma > 0.)
    {
      this->MakeDistance();
      this->CorrectBends(this->Options.ChordCorrection);
      this->Hold({});
    }
    return std::move(this->Field);
  }

  void CorrectBendsOf(LabelField& field, double amount)
  {
    this->Field = std::move(field);
    this->CorrectBends(amount);
    field = std::move(this->Field);
  }

  void HoldFurther(LabelField& field, const std::vector<HeldVoxel>& held)
  {
    this->Field = std::move(field);
    this->Hold(held);
    field = std::move(this->Field);
  }

private:
  float SideOf(int i, int j, int k) const { return this->IsObject(i, j, k) ? 1.f : -1.f; }
  bool IsObject(int i, int j, int k) const { return this->Map.At(i, j, k) == this->Object; }
  float* RowAt(int i, int j, int k)
  {
    return this->Field.Values.data() + this->Field.Box.NumberOf(i, j, k);
  }

  /** Without smoothing +-1/2; elsewhere they are what voxels off the rows stay. */
  void FillFarVoxels()
  {
    const float size = this->Options.Sigma > 0. ? LabelField::Far : 0.5f;
    const VoxelBox& box = this->Field.Box;
    ForBlocks(this->Threads, static_cast<std::size_t>(box.Length(2)), 1,
      [&](std::size_t layer, std::size_t, std::size_t)
      {
        const int k = box.First[2] + static_cast<int>(layer);
        for (int j = box.First[1]; j < box.End[1]; ++j)
        {
          float* row = this->RowAt(box.First[0], j, k);
          this->CopyMembership(box.First[0], j, k, box.Length(0), row);
          for (int x = 0; x < box.Length(0); ++x)
          {
            row[x] = row[x] > 0.5f ? size : -size;
          }
        }
      });
  }

  /** 1 in the object, 0 elsewhere, also outside the map. */
  void CopyMembership(int i, int j, int k, int count, float* values) const
  {
    std::fill(values, values + count, 0.f);
    const std::array<int, 3>& size = this->Map.Size;
    if (j < 0 || k < 0 || j >= size[1] || k >= size[2])
    {
      return;
    }
    const int first = std::max(i, 0);
    const int end = std::min(i + count, size[0]);
    const LabelMap::Number* row =
      this->Map.Voxels.data() + VoxelBox::Of(size).NumberOf(0, j, k);
    for (int x = first; x < end; ++x)
    {
      values[x - i] = row[x] == this->Object ? 1.f : 0.f;
    }
  }

  void MakeDistance()
  {
    const auto sigma = static_cast<float>(this->Options.Sigma);
    std::array<double, 3> inVoxels;
    for (int axis = 0; axis < 3; ++axis)
    {
      inVoxels[axis] = this->Options.Sigma / this->Map.Spacing[axis];
    }
    BoundaryGaussian gaussian(this->Rows, inVoxels);
    LargeVector<float> smooth(this->Field.Values.size());
    gaussian.Smooth([this](int i, int j, int k, int count, float* values)
      { this->CopyMembership(i, j, k, count, values); }, smooth, this->Threads);
    this->ForValues(smooth, [sigma](float& value, float share)
      { value = std::clamp(sigma * NormalQuantile::Table().At(share), -LabelField::Far,
          LabelField::Far); });
    gaussian.Smooth([this](int i, int j, int k, int count, float* values)
      { this->CopyMissingVolume(i, j, k, count, values); }, smooth, this->Threads);
    const float perShare = sigma * 2.5066283f; // sqrt(2 pi)
    this->ForValues(smooth, [perShare](float& value, float missing)
      { value = std::clamp(value + perShare * missing, -LabelField::Far, LabelField::Far); });
  }

  /** Calls change(value, other) for each voxel of the rows. */
  template <typename Change>
  void ForValues(const LargeVector<float>& others, Change&& change)
  {
    this->Rows.For(this->Threads,
      [&](int i, int j, int k, int count)
      {
        float* values = this->RowAt(i, j, k);
        const float* other = others.data() + this->Field.Box.NumberOf(i, j, k);
        for (int x = 0; x < count; ++x)
        {
          change(values[x], other[x]);
        }
      });
  }

  /** The membership less what of each voxel is inside by the field; off the rows there is none. */
  void CopyMissingVolume(int i, int j, int k, int count, float* values) const
  {
    this->CopyMembership(i, j, k, count, values);
    const VoxelBox& box = this->Field.Box;
    const int first = std::max(i, box.First[0]);
    const int end = std::min(i + count, box.End[0]);
    const float* row = this->Field.Values.data() + box.NumberOf(first, j, k);
    for (int x = first; x < end; ++x)
    {
      values[x - i] -= std::clamp(row[x - first] + 0.5f, 0.f, 1.f);
    }
  }

  void CorrectBends(double amount)
  {
    const VoxelBox& box = this->Field.Box;
    const LargeVector<float> before = this->Field.Values;
    const std::array<std::int64_t, 3> step = { 1, box.Length(0),
      static_cast<std::int64_t>(box.Length(0)) * box.Length(1) };
    std::array<float, 3> weight;
    for (int axis = 0; axis < 3; ++axis)
    {
      weight[axis] =
        static_cast<float>(1. / (this->Map.Spacing[axis] * this->Map.Spacing[axis]));
    }
    const auto correction = static_cast<float>(amount);
    this->Rows.For(this->Threads,
      [&](int i, int j, int k, int count)
      {
        if (j == box.First[1] || j == box.End[1] - 1 || k == box.First[2] || k == box.End[2] - 1)
        {
          return;
        }
        float* values = this->RowAt(i, j, k);
        const float* old = before.data() + box.NumberOf(i, j, k);
        const int first = std::max(i, box.First[0] + 1);
        const int end = std::min(i + count, box.End[0] - 1);
        for (int x = first - i; x < end - i; ++x)
        {
          if (std::abs(old[x]) < MostBent)
          {
            float laplacian = 0.f;
            for (int axis = 0; axis < 3; ++axis)
            {
              laplacian +=
                weight[axis] * (old[x - step[axis]] - 2.f * old[x] + old[x + step[axis]]);
            }
            values[x] -= correction * std::clamp(laplacian, -MostCurvature, MostCurvature);
          }
        }
      });
  }

  /** Whether both neighbours along an axis are on the other side. */
  bool IsThin(int i, int j, int k) const
  {
    const bool side = this->IsObject(i, j, k);
    return (this->IsObject(i - 1, j, k) != side && this->IsObject(i + 1, j, k) != side) ||
      (this->IsObject(i, j - 1, k) != side && this->IsObject(i, j + 1, k) != side) ||
      (this->IsObject(i, j, k - 1) != side && this->IsObject(i, j, k + 1) != side);
  }

  void Hold(const std::vector<HeldVoxel>& held)
  {
    HoldToLabels(this->Field, this->Map.Spacing, this->FindConstraints(held));
    this->Rows.For(this->Threads,
      [&](int i, int j, int k, int count)
      {
        // Kernels reach beyond the constraints, and those may have been too many to be met.
        float* values = this->RowAt(i, j, k);
        for (int x = 0; x < count; ++x)
        {
          const float side = this->SideOf(i + x, j, k);
          values[x] = side * std::clamp(side * values[x], LeastSize, LabelField::Far);
        }
      });
  }

  /** Whether one of the other side beside it is: it must not take all of the way between. */
  bool IsBesideThin(int i, int j, int k) const { return this->WayToThin(i, j, k) > 0.; }

  /** To the nearest of the other side beside it that is thin; 0: there is none. */
  double WayToThin(int i, int j, int k) const
  {
    const bool side = this->IsObject(i, j, k);
    const auto isThinOther = [&](int a, int b, int c)
    { return this->IsObject(a, b, c) != side && this->IsThin(a, b, c); };
    const std::array<double, 3>& way = this->Map.Spacing;
    double least = 0.;
    const auto take = [&least](bool isThere, double length)
    { least = isThere && (least == 0. || length < least) ? length : least; };
    take(isThinOther(i - 1, j, k) || isThinOther(i + 1, j, k), way[0]);
    take(isThinOther(i, j - 1, k) || isThinOther(i, j + 1, k), way[1]);
    take(isThinOther(i, j, k - 1) || isThinOther(i, j, k + 1), way[2]);
    return least;
  }

  double MarginAt(int i, int j, int k) const
  {
    return this->IsThin(i, j, k)       ? this->Options.ThinMargin
      : this->IsBesideThin(i, j, k) ? this->Options.MarginBesideThin
                                    : this->Options.Margin;
  }

  std::vector<VoxelConstraint> FindConstraints(const std::vector<HeldVoxel>& held)
  {
    std::vector<std::vector<VoxelConstraint>> ofLayers(
      static_cast<std::size_t>(this->Rows.NumberOfLayers()));
    ForBlocks(this->Threads, ofLayers.size(), 1,
      [&](std::size_t layer, std::size_t, std::size_t)
      {
        this->Rows.ForLayer(static_cast<int>(layer),
          [&](int i, int j, int k, int count)
          { this->FindConstraintsOfRow(i, j, k, count, held, ofLayers[layer]); });
      });
    return Joined(this->Threads, ofLayers);
  }

  void FindConstraintsOfRow(int i, int j, int k, int count, const std::vector<HeldVoxel>& held,
    std::vector<VoxelConstraint>& constraints)
  {
    const float* values = this->RowAt(i, j, k);
    for (int x = 0; x < count; ++x)
    {
      const float side = this->SideOf(i + x, j, k);
      if (side * values[x] > 1.f && !this->IsThin(i + x, j, k))
      {
        const double way = this->WayToThin(i + x, j, k);
        if (way > 0. && side * values[x] > way)
        {
          constraints.push_back({ this->Field.Box.NumberOf(i + x, j, k), -side,
            static_cast<float>(-this->Options.MostBesideThin * way) });
        }
      }
      if (side * values[x] >= MostWrong)
      {
        continue;
      }
      auto margin = static_cast<float>(this->MarginAt(i + x, j, k));
      const VoxelBox all = VoxelBox::Of(this->Map.Size);
      const std::int64_t voxel =
        all.Contains({ i + x, j, k }) ? all.NumberOf(i + x, j, k) : std::int64_t(-1);
      const auto found = std::lower_bound(held.begin(), held.end(), voxel,
        [](const HeldVoxel& one, std::int64_t number) { return one.Voxel < number; });
      if (found != held.end() && found->Voxel == voxel)
      {
        margin = std::max(margin, found->Margin);
      }
      constraints.push_back({ this->Field.Box.NumberOf(i + x, j, k), side, margin });
    }
  }

  const LabelMap& Map;
  LabelMap::Number Object;
  LabelFieldOptions Options;
  Executor& Threads;
  BoundaryRows Rows;
  LabelField Field;
};
}

LabelField MakeLabelField(
  const LabelBricks& bricks, int object, const LabelFieldOptions& options, Executor& executor)
{
  return FieldMaker(bricks, object, options, executor).Make();
}

void CorrectBends(LabelField& field, const LabelBricks& bricks, int object, double amount,
  Executor& executor)
{
  FieldMaker(bricks, object, LabelFieldOptions(), executor).CorrectBendsOf(field, amount);
}

void HoldFurther(LabelField& field, const LabelBricks& bricks, int object,
  const LabelFieldOptions& options, const std::vector<HeldVoxel>& held, Executor& executor)
{
  FieldMaker(bricks, object, options, executor).HoldFurther(field, held);
}
}
