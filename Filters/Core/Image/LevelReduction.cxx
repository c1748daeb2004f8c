// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Image/LevelReduction.h"

#include "Core/Image/AxisOperator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>
#include <vector>

namespace volumic
{
namespace
{
/** Input bytes of a tile of rows per output slice, which fit in the cache of a core. */
constexpr std::int64_t TileBytes = 768 * 1024;
/** Input voxels between two calls of the progress callback: about a millisecond. */
constexpr std::int64_t VoxelsPerBatch = 4 * 1024 * 1024;
/** Minimum number of rows of a tile. Neighbouring tiles combine their common rows twice. */
constexpr std::int64_t LeastRowsPerTile = 4 * RowsAtOnce;
/** Minimum number of slices per thread. */
constexpr std::size_t TileGrain = 4;
/** Voxels per span of the search for values that are not finite. */
constexpr std::int64_t ScanSpan = 64 * 1024;
/** Minimum number of spans per thread. */
constexpr std::size_t ScanGrain = 8;

AxisOperator OperatorOf(const LevelGeometry& input, const LevelGeometry& output, int axis)
{
  const double distance = std::abs(input.Spacing[axis]);
  // Eq. 4 keeps U_h <= mu/M_h; a rounding error must not make it more.
  const double offset = input.Size[axis] > 1 ? std::min(1.0, input.Unit / distance) : 0.0;
  return AxisOperator(input.Size[axis], output.Size[axis], offset);
}

/** AxisOperator with weights of type Real. */
template <typename Real>
struct Axis
{
  std::vector<std::int64_t> First; ///< first input voxel of each output voxel
  std::vector<Real> Weights;
  int Taps;

  Axis(const LevelGeometry& input, const LevelGeometry& output, int axis)
  {
    const AxisOperator axisOperator = OperatorOf(input, output, axis);
    const int size = static_cast<int>(output.Size[axis]);
    this->Taps = axisOperator.NumberOfTaps();
    this->First.resize(size);
    this->Weights.resize(static_cast<std::size_t>(size) * this->Taps);
    for (int i = 0; i < size; ++i)
    {
      this->First[i] = axisOperator.First(i);
      const double* weights = axisOperator.Weights(i);
      std::transform(weights, weights + this->Taps,
        this->Weights.begin() + static_cast<std::ptrdiff_t>(i) * this->Taps,
        [](double w) { return static_cast<Real>(w); });
    }
  }

  const Real* Weight(std::int64_t i) const { return this->Weights.data() + i * this->Taps; }
};

template <typename T>
class Reduction
{
public:
  using Real = typename RealOf<T>::Type;

  Reduction(const T* input, const LevelGeometry& inputGeometry, Real* output,
    const LevelGeometry& outputGeometry)
    : Input(input), Output(output), InputSize(inputGeometry.Size), OutputSize(outputGeometry.Size),
      X(inputGeometry, outputGeometry, 0), Y(inputGeometry, outputGeometry, 1),
      Z(inputGeometry, outputGeometry, 2),
      Stride((InputSize[0] + RowsAtOnce - 1) / RowsAtOnce * RowsAtOnce)
  {
    const std::int64_t rowBytes = InputSize[0] * Z.Taps * static_cast<std::int64_t>(sizeof(T));
    const std::int64_t inputRows = TileBytes / std::max<std::int64_t>(rowBytes, 1);
    const std::int64_t rows = inputRows * OutputSize[1] / InputSize[1];
    this->RowsPerTile = std::max(rows, LeastRowsPerTile) / RowsAtOnce * RowsAtOnce;
    this->Tiles = (OutputSize[1] + this->RowsPerTile - 1) / this->RowsPerTile;
  }

  bool Run(Executor& executor, const ProgressCallback& progress) const
  {
    // Slices of one tile follow each other, so that a thread finds their input in its cache.
    const std::int64_t tasks = this->Tiles * this->OutputSize[2];
    const std::int64_t voxels = InputSize[0] * InputSize[1] * InputSize[2];
    const std::int64_t batches = std::clamp<std::int64_t>(voxels / VoxelsPerBatch, 1, tasks);
    for (std::int64_t batch = 0; batch < batches; ++batch)
    {
      const std::int64_t begin = tasks * batch / batches;
      const std::int64_t end = tasks * (batch + 1) / batches;
      executor.For(static_cast<std::size_t>(end - begin), TileGrain,
        [&](std::size_t first, std::size_t last) { this->RunTasks(begin + first, begin + last); });
      const bool goOn = progress(static_cast<double>(batch + 1) / static_cast<double>(batches));
      if (!goOn && batch + 1 < batches)
      {
        return false;
      }
    }
    return true;
  }

private:
  /** Buffers of one thread. */
  struct RowBuffers
  {
    // Power of two, at least the six rows of one band along y.
    static constexpr std::int64_t RingRows = 8;
    std::vector<Real> Ring;    ///< rows combined along z, by their y modulo RingRows
    std::vector<Real> Rows;    ///< rows combined along z and y
    std::vector<Real> Columns; ///< buffer of ReduceRows()

    explicit RowBuffers(std::int64_t stride)
      : Ring(RingRows * stride), Rows(RowsAtOnce * stride), Columns(RowsAtOnce * stride)
    {
    }
  };

  void RunTasks(std::int64_t begin, std::int64_t end) const
  {
    RowBuffers work(this->Stride);
    for (std::int64_t task = begin; task < end; ++task)
    {
      const std::int64_t tile = task / this->OutputSize[2];
      const std::int64_t slice = task % this->OutputSize[2];
      const std::int64_t row = tile * this->RowsPerTile;
      this->MakeRows(slice, row, std::min(row + this->RowsPerTile, this->OutputSize[1]), work);
    }
  }

  /** Compute rows [begin, end) of an output slice. */
  void MakeRows(std::int64_t slice, std::int64_t begin, std::int64_t end, RowBuffers& work) const
  {
    std::int64_t made = this->Y.First[begin]; // The ring has the rows before this one.
    for (std::int64_t first = begin; first < end; first += RowsAtOnce)
    {
      const auto rows = static_cast<int>(std::min<std::int64_t>(RowsAtOnce, end - first));
      std::array<Real*, RowsAtOnce> out{};
      for (int r = 0; r < rows; ++r)
      {
        const std::int64_t y = first + r;
        const std::int64_t last = this->Y.First[y] + this->Y.Taps;
        for (made = std::max(made, this->Y.First[y]); made < last; ++made)
        {
          this->CombineAlongZ(slice, made, this->RingRow(work, made));
        }
        this->CombineAlongY(y, work, work.Rows.data() + r * this->Stride);
        out[r] = this->Output + (slice * this->OutputSize[1] + y) * this->OutputSize[0];
      }
      ReduceRows(work.Rows.data(), this->Stride, this->X.First.data(), this->X.Weights.data(),
        this->X.Taps, this->OutputSize[0], work.Columns.data(), out.data(), rows);
    }
  }

  Real* RingRow(RowBuffers& work, std::int64_t y) const
  {
    return work.Ring.data() + (y % RowBuffers::RingRows) * this->Stride;
  }

  void CombineAlongZ(std::int64_t slice, std::int64_t y, Real* out) const
  {
    std::array<const T*, AxisOperator::MaximumNumberOfTaps> rows{};
    for (int t = 0; t < this->Z.Taps; ++t)
    {
      const std::int64_t z = this->Z.First[slice] + t;
      rows[t] = this->Input + (z * this->InputSize[1] + y) * this->InputSize[0];
    }
    CombineRows(rows.data(), this->Z.Weight(slice), this->Z.Taps, out, this->InputSize[0]);
  }

  void CombineAlongY(std::int64_t y, RowBuffers& work, Real* out) const
  {
    std::array<const Real*, AxisOperator::MaximumNumberOfTaps> rows{};
    for (int t = 0; t < this->Y.Taps; ++t)
    {
      rows[t] = this->RingRow(work, this->Y.First[y] + t);
    }
    // The whole stride, so that the loop has no remainder. ReduceRows() ignores what is behind the
    // row.
    CombineRows(rows.data(), this->Y.Weight(y), this->Y.Taps, out, this->Stride);
  }

  const T* Input;
  Real* Output;
  LevelSize InputSize;
  LevelSize OutputSize;
  Axis<Real> X;
  Axis<Real> Y;
  Axis<Real> Z;
  std::int64_t Stride;
  std::int64_t RowsPerTile;
  std::int64_t Tiles;
};
}

template <typename T>
bool ReduceLevel(const T* input, const LevelGeometry& inputGeometry,
  typename RealOf<T>::Type* output, const LevelGeometry& outputGeometry, Executor& executor,
  const ProgressCallback& progress)
{
  return Reduction<T>(input, inputGeometry, output, outputGeometry).Run(executor, progress);
}

template <typename T>
NotFiniteVoxels FindNotFiniteVoxels([[maybe_unused]] const T* values,
  [[maybe_unused]] std::int64_t n, [[maybe_unused]] Executor& executor)
{
  NotFiniteVoxels found;
  if constexpr (std::is_floating_point_v<T>)
  {
    std::vector<std::int64_t> counts((n + ScanSpan - 1) / ScanSpan);
    const auto sizeOf = [n](std::int64_t span) { return std::min(ScanSpan, n - span * ScanSpan); };
    executor.For(counts.size(), ScanGrain,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t span = begin; span < end; ++span)
        {
          const auto b = static_cast<std::int64_t>(span);
          counts[span] = CountNotFinite(values + b * ScanSpan, sizeOf(b));
        }
      });
    for (std::int64_t span = 0; span < static_cast<std::int64_t>(counts.size()); ++span)
    {
      if (counts[span] > 0 && found.First < 0)
      {
        const T* begin = values + span * ScanSpan;
        const auto isNotFinite = [](T value) { return !std::isfinite(value); };
        found.First = std::find_if(begin, begin + sizeOf(span), isNotFinite) - values;
      }
      found.Count += counts[span];
    }
  }
  return found;
}

#define VOLUMIC_INSTANTIATE(T)                                                   \
  template bool ReduceLevel<T>(const T*, const LevelGeometry&, RealOf<T>::Type*, \
    const LevelGeometry&, Executor&, const ProgressCallback&);                   \
  template NotFiniteVoxels FindNotFiniteVoxels<T>(const T*, std::int64_t, Executor&);
VOLUMIC_FOR_EACH_SCALAR(VOLUMIC_INSTANTIATE)
#undef VOLUMIC_INSTANTIATE
}
