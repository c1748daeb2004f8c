// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Labels/LabelField.h"

#include "Core/Common/Lanes.h"
#include "Core/Common/Spans.h"
#include "Core/Labels/LabelConstraints.h"
#include "Core/Labels/LabelDistance.h"
#include "Core/Labels/LabelSides.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace volumic
{
namespace
{
/** Maximum distance of a voxel from the boundary at which it may become misclassified. */
constexpr float MostMisclassified = 1.5f;
/** Maximum curvature: larger values are sharp edges, which the chord correction does not follow. */
constexpr float MostCurvature = 0.35f;
/** Least absolute field value at a voxel if not all constraints can be satisfied. */
constexpr float LeastSize = 0.05f;
/** Maximum number of searches for missed voxels with a tolerance. */
constexpr int MostMissedSearches = 4;
/** Least slope for the chord correction: a flatter field has a ridge. */
constexpr float LeastSlope = 0.2f;
/** Maximum distance from the boundary for the chord correction. */
constexpr float MostCorrected = 2.5f;

class FieldMaker
{
public:
  FieldMaker(const LabelBricks& bricks, int object, const LabelFieldOptions& options,
    Executor& executor, const VoxelBox& within)
    : Map(bricks.Map()), Sides(bricks, object, within), Options(options), Threads(executor),
      Rows(this->Sides.NearBoundary(LabelSides::ReachOfFields(options.Sigma, bricks.Map().Spacing)))
  {
  }

  LabelField Make()
  {
    this->Field.Box = this->Sides.Box();
    this->Field.Values.resize(static_cast<std::size_t>(this->Field.Box.Count()));
    this->FillFarVoxels();
    this->Field.Rows = this->Rows;
    if (this->Options.Sigma > 0.)
    {
      MakeLabelDistance(this->Sides, this->Map.Spacing, this->Options, this->Field, this->Threads);
      this->CorrectChords();
      this->Constrain();
    }
    return std::move(this->Field);
  }

private:
  /** A field without smoothing has no misclassified voxels, and hence no tolerance. */
  bool HasTolerance() const { return this->Options.Tolerance > 0. && this->Options.Sigma > 0.; }
  float* RowAt(int i, int j, int k)
  {
    return this->Field.Values.data() + this->Field.Box.NumberOf(i, j, k);
  }

  /** Set all voxels to +-Far, the final value outside the rows; without smoothing to +-1/2. */
  void FillFarVoxels()
  {
    const float size = this->Options.Sigma > 0. ? LabelField::Far : 0.5f;
    const VoxelBox& box = this->Field.Box;
    ForSpans(this->Threads, static_cast<std::size_t>(box.Length(2)), 1,
      [&](std::size_t layer, std::size_t, std::size_t)
      {
        const int k = box.First[2] + static_cast<int>(layer);
        for (int j = box.First[1]; j < box.End[1]; ++j)
        {
          float* row = this->RowAt(box.First[0], j, k);
          this->Sides.CopyMembership(box.First[0], j, k, box.Length(0), row);
          for (int x = 0; x < box.Length(0); ++x)
          {
            row[x] = row[x] > 0.5f ? size : -size;
          }
        }
      });
  }

  void CorrectChords()
  {
    const VoxelBox& box = this->Field.Box;
    const LargeVector<float> before = this->Field.Values;
    const auto correction = static_cast<float>(this->Options.ChordCorrection);
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
          if (std::abs(old[x]) < MostCorrected)
          {
            values[x] -=
              correction * std::clamp(this->CurvatureAt(old + x), -MostCurvature, MostCurvature);
          }
        }
      });
  }

  /** Return the curvature term of the chord correction. All 26 neighbours must be in the box. */
  float CurvatureAt(const float* at) const
  {
    const VoxelBox& box = this->Field.Box;
    const std::array<std::int64_t, 3> step = { 1, box.Length(0),
      static_cast<std::int64_t>(box.Length(0)) * box.Length(1) };
    std::array<float, 3> inverse;
    std::array<float, 3> second;
    for (int a = 0; a < 3; ++a)
    {
      inverse[a] = static_cast<float>(1. / this->Map.Spacing[a]);
      second[a] = inverse[a] * inverse[a] * (at[-step[a]] - 2.f * at[0] + at[step[a]]);
    }
    const float laplacian = second[0] + second[1] + second[2];
    if (!this->HasTolerance())
    {
      return laplacian;
    }
    std::array<float, 3> gradient;
    for (int a = 0; a < 3; ++a)
    {
      gradient[a] = 0.5f * inverse[a] * (at[step[a]] - at[-step[a]]);
    }
    float square = 0.f;
    float across = 0.f; // second derivative along the gradient, times its squared length
    for (int a = 0; a < 3; ++a)
    {
      const int b = (a + 1) % 3;
      const float mixed = 0.25f * inverse[a] * inverse[b] *
        (at[step[a] + step[b]] - at[step[a] - step[b]] - at[step[b] - step[a]] +
          at[-step[a] - step[b]]);
      square += gradient[a] * gradient[a];
      across += gradient[a] * (gradient[a] * second[a] + 2.f * gradient[b] * mixed);
    }
    return square > LeastSlope * LeastSlope ? laplacian - across / square : 0.f;
  }

  void Constrain()
  {
    if (this->HasTolerance() && !(this->Field.IsConstrained.Box() == this->Field.Box))
    {
      this->Field.IsConstrained = VoxelBits(this->Field.Box);
    }
    ConstrainToLabels(this->Field, this->Map.Spacing, this->FindConstraints());
    for (int round = 0; this->HasTolerance() && round < MostMissedSearches && this->FindMissed();
         ++round)
    {
      ConstrainToLabels(this->Field, this->Map.Spacing, this->FindConstraints());
    }
    this->Rows.For(this->Threads,
      [&](int i, int j, int k, int count)
      {
        // Enforce the sign: kernels reach other voxels, and constraints may contradict each other.
        float* values = this->RowAt(i, j, k);
        for (int x = 0; x < count; ++x)
        {
          const float side = this->Sides.SideOf(i + x, j, k);
          values[x] = side * std::max(side * values[x], this->LeastAt(i + x, j, k));
        }
      });
  }

  /** Return a bit mask of four voxels: whether side * field is less than `least`. */
  unsigned FindLess(int i, int j, int k, float least)
  {
    const Lanes four = Lanes::Load(this->RowAt(i, j, k));
    const unsigned members = this->Sides.FourAt(i, j, k);
    return (LessBits(four, Lanes(least)) & members) |
      (LessBits(Lanes(-least), four) & ~members & 15u);
  }

  float LeastAt(int i, int j, int k) const
  {
    return this->IsConstrained(i, j, k) ? LeastSize
                                        : LeastSize - static_cast<float>(this->Options.Tolerance);
  }

  bool IsConstrained(int i, int j, int k) const
  {
    return !this->HasTolerance() || this->Field.IsConstrained.Has(i, j, k);
  }

  /** Add missed voxels (LabelSides::FindMissed) to IsConstrained. @return whether any are new */
  bool FindMissed()
  {
    const VoxelBits missed =
      this->Sides.FindMissed(this->Field, this->Rows, this->Threads) - this->Field.IsConstrained;
    this->Field.IsConstrained |= missed;
    return !missed.IsEmpty();
  }

  /** Return the distance to the nearest thin neighbour of the other side; 0: none. */
  double DistanceToThin(int i, int j, int k) const
  {
    const bool side = this->Sides.IsObject(i, j, k);
    double least = 0.;
    for (int axis = 0; axis < 3; ++axis)
    {
      for (const int step : { -1, 1 })
      {
        std::array<int, 3> at = { i, j, k };
        at[axis] += step;
        if (this->Thin.Has(at[0], at[1], at[2]) &&
          this->Sides.IsObject(at[0], at[1], at[2]) != side)
        {
          least = least > 0. ? std::min(least, this->Map.Spacing[axis]) : this->Map.Spacing[axis];
        }
      }
    }
    return least;
  }

  double MarginAt(int i, int j, int k) const
  {
    return this->Thin.Has(i, j, k)    ? this->Options.ThinMargin
      : this->BesideThin.Has(i, j, k) ? this->Options.MarginBesideThin
      : this->IsConstrained(i, j, k)  ? this->Options.Margin
                                      : this->Options.Margin - this->Options.Tolerance;
  }

  /** Return the voxels whose constraints may be violated now or by enforcing others. */
  VoxelBits FindChanging()
  {
    VoxelBits changing = this->BesideThin;
    const auto least = static_cast<float>(this->Options.Margin - this->Options.Tolerance);
    const auto most = static_cast<float>(this->Options.ThinMargin);
    this->Rows.For(this->Threads,
      [&](int i, int j, int k, int count)
      {
        for (int x = 0; x < count; x += Lanes::Count)
        {
          const bool isConstrained = !this->HasTolerance() ||
            this->Field.IsConstrained.FourAt(i + x, j, k) != 0 ||
            this->BesideThin.FourAt(i + x, j, k) != 0;
          changing.AddFour(i + x, j, k, this->FindLess(i + x, j, k, isConstrained ? most : least));
        }
      });
    constexpr int reach = 2 * ConstraintReach;
    return this->Rows & changing.Grown({ reach, reach, reach });
  }

  std::vector<VoxelConstraint> FindConstraints()
  {
    // With a tolerance, only constrained voxels are treated as thin.
    this->Thin = this->Sides.FindThin();
    if (this->HasTolerance())
    {
      this->Thin &= this->Field.IsConstrained;
    }
    this->BesideThin = this->Sides.FindBeside(this->Thin);
    const VoxelBits rows = this->FindChanging();
    return CollectInSpans<VoxelConstraint>(this->Threads,
      static_cast<std::size_t>(rows.NumberOfLayers()), 1,
      [&](std::size_t layer, std::vector<VoxelConstraint>& constraints)
      {
        rows.ForLayer(static_cast<int>(layer),
          [&](int i, int j, int k, int count)
          { this->FindConstraintsOfRow(i, j, k, count, constraints); });
      });
  }

  void FindConstraintsOfRow(
    int i, int j, int k, int count, std::vector<VoxelConstraint>& constraints)
  {
    const float* values = this->RowAt(i, j, k);
    for (int x = 0; x < count; ++x)
    {
      const float side = this->Sides.SideOf(i + x, j, k);
      if (side * values[x] > 1.f && this->BesideThin.Has(i + x, j, k) &&
        !this->Thin.Has(i + x, j, k))
      {
        const double distance = this->DistanceToThin(i + x, j, k);
        if (side * values[x] > distance)
        {
          constraints.push_back({ this->Field.Box.NumberOf(i + x, j, k), -side,
            static_cast<float>(-this->Options.MostBesideThin * distance) });
        }
      }
      if (side * values[x] < MostMisclassified)
      {
        constraints.push_back({ this->Field.Box.NumberOf(i + x, j, k), side,
          static_cast<float>(this->MarginAt(i + x, j, k)) });
      }
    }
  }

  const LabelMap& Map;
  LabelSides Sides;
  LabelFieldOptions Options;
  Executor& Threads;
  VoxelBits Rows;       ///< voxels to compute
  VoxelBits Thin;       ///< constrained voxels with both neighbours along an axis on the other side
  VoxelBits BesideThin; ///< neighbours of thin voxels on the other side
  LabelField Field;
};
}

LabelField MakeLabelField(const LabelBricks& bricks, int object, const LabelFieldOptions& options,
  Executor& executor, const VoxelBox& within)
{
  return FieldMaker(bricks, object, options, executor, within).Make();
}
}
