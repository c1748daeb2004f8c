// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRowKernels_h
#define volumicRowKernels_h

#include <cstdint>

/**
 * Inner loops of the pyramid on rows of voxels, contiguous along x. Each loop is compiled for
 * several vector widths; the widest that the processor supports is selected when the library is
 * loaded. No product and sum are contracted, so all variants are bit-identical.
 */
namespace volumic
{
/** Number of rows that are processed together along x, one per vector lane. */
constexpr int RowsAtOnce = 8;

/** Computation type: double for double, float for all other types. */
template <typename T>
struct RealOf
{
  using Type = float;
};
template <>
struct RealOf<double>
{
  using Type = double;
};

/** X-macro over the scalar types of voxels. */
#define VOLUMIC_FOR_EACH_SCALAR(Macro)                                                   \
  Macro(char) Macro(signed char) Macro(unsigned char) Macro(short) Macro(unsigned short) \
    Macro(int) Macro(unsigned int) Macro(long) Macro(unsigned long) Macro(long long)     \
      Macro(unsigned long long) Macro(float) Macro(double)

#define VOLUMIC_DECLARE_ROW_KERNELS(T)                                                       \
  /** out[x] = sum over t of weights[t] * rows[t][x], for x in [0, n) and taps in [1, 6]. */ \
  void CombineRows(const T* const* rows, const RealOf<T>::Type* weights, int taps,           \
    RealOf<T>::Type* out, std::int64_t n);                                                   \
  /** Return the number of NaN and infinite values. */                                       \
  std::int64_t CountNotFinite(const T* values, std::int64_t n);
VOLUMIC_FOR_EACH_SCALAR(VOLUMIC_DECLARE_ROW_KERNELS)
#undef VOLUMIC_DECLARE_ROW_KERNELS

/**
 * Apply the operator along x to RowsAtOnce rows.
 * @param rows      RowsAtOnce rows of `stride` values; the first inputSize values are used
 * @param stride    a multiple of RowsAtOnce, at least inputSize
 * @param first     first input voxel of each output voxel
 * @param weights   `taps` weights of each output voxel
 * @param columns   buffer of RowsAtOnce * stride values
 * @param out       output rows, numberOfRows <= RowsAtOnce
 */
void ReduceRows(const float* rows, std::int64_t stride, const std::int64_t* first,
  const float* weights, int taps, std::int64_t outputSize, float* columns, float* const* out,
  int numberOfRows);
void ReduceRows(const double* rows, std::int64_t stride, const std::int64_t* first,
  const double* weights, int taps, std::int64_t outputSize, double* columns, double* const* out,
  int numberOfRows);
}

#endif
