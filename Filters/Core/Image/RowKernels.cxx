// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Image/RowKernels.h"

#include <cstring>
#include <type_traits>

// Compiled for the baseline and for two wider vector units; the dynamic linker selects one.
// Features are named instead of processors, because `arch=` matches one model only. Other systems
// use the baseline: arm64, other compilers, and sanitizers, which run before the selection.
#if defined(__x86_64__) && defined(__ELF__) && defined(__GNUC__) && !defined(__clang__) && \
  !defined(__SANITIZE_THREAD__) && !defined(__SANITIZE_ADDRESS__)
#define VOLUMIC_VECTOR_CLONES __attribute__((target_clones("default", "avx2", "avx512f")))
#else
#define VOLUMIC_VECTOR_CLONES
#endif

// Bodies must be inlined into the clones. Otherwise they are compiled for the baseline only.
#if defined(__GNUC__)
#define VOLUMIC_INLINE inline __attribute__((always_inline))
#define VOLUMIC_HAS_VECTORS 1
#else
#define VOLUMIC_INLINE inline
#define VOLUMIC_HAS_VECTORS 0
#endif

// GCC has __builtin_shufflevector since version 12.
#define VOLUMIC_HAS_SHUFFLE 0
#if VOLUMIC_HAS_VECTORS && defined(__has_builtin)
#if __has_builtin(__builtin_shufflevector)
#undef VOLUMIC_HAS_SHUFFLE
#define VOLUMIC_HAS_SHUFFLE 1
#endif
#endif

// Calls function<taps>(...), so that the compiler unrolls loops over weights. It is a macro because
// a lambda would not be part of the clone.
#define VOLUMIC_SWITCH_TAPS(taps, function, ...) \
  switch (taps)                                  \
  {                                              \
    case 1:                                      \
      return function<1>(__VA_ARGS__);           \
    case 2:                                      \
      return function<2>(__VA_ARGS__);           \
    case 3:                                      \
      return function<3>(__VA_ARGS__);           \
    case 4:                                      \
      return function<4>(__VA_ARGS__);           \
    case 5:                                      \
      return function<5>(__VA_ARGS__);           \
    default:                                     \
      return function<6>(__VA_ARGS__);           \
  }

namespace volumic
{
namespace
{
template <int Taps, typename T, typename Real>
VOLUMIC_INLINE void CombineRowsOfTaps(
  const T* const* rows, const Real* weights, Real* __restrict out, std::int64_t n)
{
  const T* row[Taps];
  Real weight[Taps];
  for (int t = 0; t < Taps; ++t)
  {
    row[t] = rows[t];
    weight[t] = weights[t];
  }
  for (std::int64_t x = 0; x < n; ++x)
  {
    Real sum = weight[0] * static_cast<Real>(row[0][x]);
    for (int t = 1; t < Taps; ++t)
    {
      sum += weight[t] * static_cast<Real>(row[t][x]);
    }
    out[x] = sum;
  }
}

template <typename T, typename Real>
VOLUMIC_INLINE void CombineRowsOf(
  const T* const* rows, const Real* weights, int taps, Real* out, std::int64_t n)
{
  VOLUMIC_SWITCH_TAPS(taps, CombineRowsOfTaps, rows, weights, out, n)
}

template <typename T>
VOLUMIC_INLINE std::int64_t CountNotFiniteOf(const T* values, std::int64_t n)
{
  std::int64_t count = 0;
  if constexpr (std::is_floating_point_v<T>)
  {
    for (std::int64_t x = 0; x < n; ++x)
    {
      // x - x is zero for finite numbers and NaN for all others; unlike isfinite, this vectorizes.
      count += (values[x] - values[x] == T(0)) ? 0 : 1;
    }
  }
  else
  {
    static_cast<void>(values);
    static_cast<void>(n);
  }
  return count;
}

#if VOLUMIC_HAS_VECTORS
template <typename Real>
struct VectorOf
{
  typedef Real Type __attribute__((vector_size(RowsAtOnce * sizeof(Real))));
  // For memory that is not aligned to the vector's size.
  typedef Real Unaligned
    __attribute__((vector_size(RowsAtOnce * sizeof(Real)), aligned(alignof(Real)), may_alias));
};
#endif

#if VOLUMIC_HAS_SHUFFLE
/** Transpose an 8 x 8 square by three rounds of exchanged halves. */
template <typename Real>
VOLUMIC_INLINE void TransposeSquare(
  const Real* in, std::int64_t inStride, Real* out, std::int64_t outStride)
{
  using Vector = typename VectorOf<Real>::Type;
  using Unaligned = typename VectorOf<Real>::Unaligned;
  Vector a[8];
  Vector b[8];
  for (int r = 0; r < 8; ++r)
  {
    a[r] = *reinterpret_cast<const Unaligned*>(in + r * inStride);
  }
  for (int r = 0; r < 8; r += 2)
  {
    b[r] = __builtin_shufflevector(a[r], a[r + 1], 0, 8, 2, 10, 4, 12, 6, 14);
    b[r + 1] = __builtin_shufflevector(a[r], a[r + 1], 1, 9, 3, 11, 5, 13, 7, 15);
  }
  for (int r = 0; r < 8; r += 4)
  {
    for (int half = 0; half < 2; ++half)
    {
      const Vector low = b[r + half];
      const Vector high = b[r + half + 2];
      a[r + half] = __builtin_shufflevector(low, high, 0, 1, 8, 9, 4, 5, 12, 13);
      a[r + half + 2] = __builtin_shufflevector(low, high, 2, 3, 10, 11, 6, 7, 14, 15);
    }
  }
  for (int r = 0; r < 4; ++r)
  {
    b[r] = __builtin_shufflevector(a[r], a[r + 4], 0, 1, 2, 3, 8, 9, 10, 11);
    b[r + 4] = __builtin_shufflevector(a[r], a[r + 4], 4, 5, 6, 7, 12, 13, 14, 15);
  }
  for (int c = 0; c < 8; ++c)
  {
    *reinterpret_cast<Unaligned*>(out + c * outStride) = b[c];
  }
}
#else
template <typename Real>
VOLUMIC_INLINE void TransposeSquare(
  const Real* in, std::int64_t inStride, Real* out, std::int64_t outStride)
{
  for (int r = 0; r < 8; ++r)
  {
    for (int c = 0; c < 8; ++c)
    {
      out[c * outStride + r] = in[r * inStride + c];
    }
  }
}
#endif

/** Compute one output voxel of all rows. */
template <int Taps, typename Real>
VOLUMIC_INLINE void ReduceColumn(const Real* columns, const Real* weights, Real* out)
{
#if VOLUMIC_HAS_VECTORS
  using Vector = typename VectorOf<Real>::Type;
  using Unaligned = typename VectorOf<Real>::Unaligned;
  const Unaligned* column = reinterpret_cast<const Unaligned*>(columns);
  Vector sum = column[0] * weights[0];
  for (int t = 1; t < Taps; ++t)
  {
    sum += column[t] * weights[t];
  }
  *reinterpret_cast<Unaligned*>(out) = sum;
#else
  for (int r = 0; r < RowsAtOnce; ++r)
  {
    Real sum = columns[r] * weights[0];
    for (int t = 1; t < Taps; ++t)
    {
      sum += columns[t * RowsAtOnce + r] * weights[t];
    }
    out[r] = sum;
  }
#endif
}

template <int Taps, typename Real>
VOLUMIC_INLINE void ReduceRowsOfTaps(const Real* rows, std::int64_t stride,
  const std::int64_t* first, const Real* weights, std::int64_t outputSize, Real* columns,
  Real* const* out, int numberOfRows)
{
  static_assert(RowsAtOnce == 8, "squares are transposed eight by eight");
  for (std::int64_t x = 0; x < stride; x += RowsAtOnce)
  {
    TransposeSquare(rows + x, stride, columns + x * RowsAtOnce, RowsAtOnce);
  }
  Real reduced[RowsAtOnce * RowsAtOnce];
  Real back[RowsAtOnce * RowsAtOnce];
  for (std::int64_t x = 0; x < outputSize; x += RowsAtOnce)
  {
    const auto width =
      static_cast<int>(outputSize - x < RowsAtOnce ? outputSize - x : std::int64_t{ RowsAtOnce });
    for (int i = 0; i < width; ++i)
    {
      ReduceColumn<Taps>(
        columns + first[x + i] * RowsAtOnce, weights + (x + i) * Taps, reduced + i * RowsAtOnce);
    }
    if (width == RowsAtOnce && numberOfRows == RowsAtOnce)
    {
      TransposeSquare(reduced, RowsAtOnce, back, RowsAtOnce);
      for (int r = 0; r < RowsAtOnce; ++r)
      {
        std::memcpy(out[r] + x, back + r * RowsAtOnce, RowsAtOnce * sizeof(Real));
      }
    }
    else
    {
      for (int r = 0; r < numberOfRows; ++r)
      {
        for (int i = 0; i < width; ++i)
        {
          out[r][x + i] = reduced[i * RowsAtOnce + r];
        }
      }
    }
  }
}

template <typename Real>
VOLUMIC_INLINE void ReduceRowsOf(const Real* rows, std::int64_t stride, const std::int64_t* first,
  const Real* weights, int taps, std::int64_t outputSize, Real* columns, Real* const* out,
  int numberOfRows)
{
  VOLUMIC_SWITCH_TAPS(
    taps, ReduceRowsOfTaps, rows, stride, first, weights, outputSize, columns, out, numberOfRows)
}
}

#define VOLUMIC_DEFINE_ROW_KERNELS(T)                                                          \
  VOLUMIC_VECTOR_CLONES void CombineRows(const T* const* rows, const RealOf<T>::Type* weights, \
    int taps, RealOf<T>::Type* out, std::int64_t n)                                            \
  {                                                                                            \
    CombineRowsOf(rows, weights, taps, out, n);                                                \
  }                                                                                            \
  VOLUMIC_VECTOR_CLONES std::int64_t CountNotFinite(const T* values, std::int64_t n)           \
  {                                                                                            \
    return CountNotFiniteOf(values, n);                                                        \
  }
VOLUMIC_FOR_EACH_SCALAR(VOLUMIC_DEFINE_ROW_KERNELS)

#define VOLUMIC_DEFINE_REDUCE_ROWS(Real)                                                      \
  VOLUMIC_VECTOR_CLONES void ReduceRows(const Real* rows, std::int64_t stride,                \
    const std::int64_t* first, const Real* weights, int taps, std::int64_t outputSize,        \
    Real* columns, Real* const* out, int numberOfRows)                                        \
  {                                                                                           \
    ReduceRowsOf(rows, stride, first, weights, taps, outputSize, columns, out, numberOfRows); \
  }
VOLUMIC_DEFINE_REDUCE_ROWS(float)
VOLUMIC_DEFINE_REDUCE_ROWS(double)
}
