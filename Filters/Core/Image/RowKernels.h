// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRowKernels_h
#define volumicRowKernels_h

#include <cstdint>

/**
 * The inner loops of the pyramid, on rows of voxels that are contiguous along x. Each is compiled
 * for several vector widths; the processor's best is chosen when the library is loaded. None of
 * them contracts a product and a sum, so that all of them give the same bits.
 */
namespace volumic
{
/** Rows that are worked on together along x; the lanes of the vectors are these rows. */
constexpr int RowsAtOnce = 8;

/** Doubles stay doubles, every other scalar type becomes float. */
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

/** X-macro over the native scalar types of voxels. */
#define VOLUMIC_FOR_EACH_SCALAR(Macro)                                                   \
  Macro(char) Macro(signed char) Macro(unsigned char) Macro(short) Macro(unsigned short) \
    Macro(int) Macro(unsigned int) Macro(long) Macro(unsigned long) Macro(long long)     \
      Macro(unsigned long long) Macro(float) Macro(double)

#define VOLUMIC_DECLARE_ROW_KERNELS(T)                                                       \
  /** out[x] = sum over t of weights[t] * rows[t][x], for x in [0, n) and taps in [1, 6]. */ \
  void CombineRows(const T* const* rows, const RealOf<T>::Type* weights, int taps,           \
    RealOf<T>::Type* out, std::int64_t n);                                                   \
  /** How many of the n values are NaN or infinite. */                                       \
  std::int64_t CountNotFinite(const T* values, std::int64_t n);
VOLUMIC_FOR_EACH_SCALAR(VOLUMIC_DECLARE_ROW_KERNELS)
#undef VOLUMIC_DECLARE_ROW_KERNELS

/**
 * The operator along x, for RowsAtOnce rows at once.
 * @param rows      RowsAtOnce rows of `stride` values, of which the first inputSize count
 * @param stride    a multiple of RowsAtOnce, at least inputSize
 * @param first     first input voxel of each output voxel
 * @param weights   `taps` weights of each output voxel
 * @param columns   work space of RowsAtOnce * stride values
 * @param out       where the output rows go; fewer than RowsAtOnce may be wanted
 */
void ReduceRows(const float* rows, std::int64_t stride, const std::int64_t* first,
  const float* weights, int taps, std::int64_t outputSize, float* columns, float* const* out,
  int numberOfRows);
void ReduceRows(const double* rows, std::int64_t stride, const std::int64_t* first,
  const double* weights, int taps, std::int64_t outputSize, double* columns, double* const* out,
  int numberOfRows);
}

#endif
