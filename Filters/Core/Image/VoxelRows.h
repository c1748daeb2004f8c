// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicVoxelRows_h
#define volumicVoxelRows_h

#include "Core/Image/VoxelValues.h"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace volumic
{
/** Four floats side by side, each computed with as if it were alone. */
#if defined(__GNUC__)
typedef float FourFloats __attribute__((vector_size(16)));
#else
struct FourFloats
{
  float Item[4];
  float operator[](int i) const { return this->Item[i]; }
};
template <typename Operation>
FourFloats ForEach(const FourFloats& a, const FourFloats& b, Operation operation)
{
  return { operation(a[0], b[0]), operation(a[1], b[1]), operation(a[2], b[2]),
    operation(a[3], b[3]) };
}
inline FourFloats operator+(const FourFloats& a, const FourFloats& b)
{
  return ForEach(a, b, [](float x, float y) { return x + y; });
}
inline FourFloats operator-(const FourFloats& a, const FourFloats& b)
{
  return ForEach(a, b, [](float x, float y) { return x - y; });
}
inline FourFloats operator*(float factor, const FourFloats& a)
{
  return ForEach(a, a, [factor](float x, float) { return factor * x; });
}
#endif

/** Four voxels of each of four rows: Column[c][r] is the value of the c-th of row r. */
struct VoxelRows
{
  FourFloats Column[4];
};

#if defined(__SSE2__)
/** Integers of at most 16 bits: four of each row, as 16 bits; columns 0 and 1, and 2 and 3. */
struct RowsOfIntegers
{
  __m128i Pair[2];
};

template <typename T>
RowsOfIntegers ReadIntegers(const T* a, const T* b, const T* c, const T* d)
{
  if constexpr (sizeof(T) == 1)
  {
    const auto load = [](const T* row)
    {
      std::int32_t four;
      std::memcpy(&four, row, sizeof(four));
      return _mm_cvtsi32_si128(four);
    };
    const __m128i rows = _mm_unpacklo_epi8(_mm_unpacklo_epi8(load(a), load(c)),
      _mm_unpacklo_epi8(load(b), load(d)));
    if constexpr (std::is_signed_v<T>)
    {
      return { { _mm_srai_epi16(_mm_unpacklo_epi8(rows, rows), 8),
        _mm_srai_epi16(_mm_unpackhi_epi8(rows, rows), 8) } };
    }
    const __m128i zero = _mm_setzero_si128();
    return { { _mm_unpacklo_epi8(rows, zero), _mm_unpackhi_epi8(rows, zero) } };
  }
  else
  {
    const auto load = [](const T* row)
    { return _mm_loadl_epi64(reinterpret_cast<const __m128i*>(row)); };
    const __m128i odd = _mm_unpacklo_epi16(load(a), load(c));
    const __m128i even = _mm_unpacklo_epi16(load(b), load(d));
    return { { _mm_unpacklo_epi16(odd, even), _mm_unpackhi_epi16(odd, even) } };
  }
}

/** One column of 32 bits. */
template <typename T>
__m128i ColumnOf(const RowsOfIntegers& rows, int column)
{
  const __m128i pair = rows.Pair[column / 2];
  const bool isSecond = column % 2 != 0;
  if constexpr (std::is_signed_v<T>)
  {
    return _mm_srai_epi32(
      isSecond ? _mm_unpackhi_epi16(pair, pair) : _mm_unpacklo_epi16(pair, pair), 16);
  }
  const __m128i zero = _mm_setzero_si128();
  return isSecond ? _mm_unpackhi_epi16(pair, zero) : _mm_unpacklo_epi16(pair, zero);
}
#endif

/** Reads the four voxels from each of the given ones on. */
template <typename Voxels>
VoxelRows ReadRows(const Voxels& voxels, const std::ptrdiff_t (&first)[4])
{
  VoxelRows rows;
#if defined(__SSE2__)
  using T = typename Voxels::Stored;
  const T* from[4] = { voxels.Voxels + first[0], voxels.Voxels + first[1],
    voxels.Voxels + first[2], voxels.Voxels + first[3] };
  if constexpr (std::is_same_v<Voxels, PlainVoxels>)
  {
    __m128 row[4] = { _mm_loadu_ps(from[0]), _mm_loadu_ps(from[1]), _mm_loadu_ps(from[2]),
      _mm_loadu_ps(from[3]) };
    _MM_TRANSPOSE4_PS(row[0], row[1], row[2], row[3]);
    for (int c = 0; c < 4; ++c)
    {
      rows.Column[c] = row[c];
    }
    return rows;
  }
  else if constexpr (std::is_same_v<Voxels, NarrowVoxels<T>>)
  {
    const RowsOfIntegers integers = ReadIntegers(from[0], from[1], from[2], from[3]);
    const __m128 base = _mm_set1_ps(voxels.Base);
    for (int c = 0; c < 4; ++c)
    {
      rows.Column[c] = _mm_sub_ps(_mm_cvtepi32_ps(ColumnOf<T>(integers, c)), base);
    }
    return rows;
  }
  else if constexpr (std::is_integral_v<T> && sizeof(T) <= 2)
  {
    const RowsOfIntegers integers = ReadIntegers(from[0], from[1], from[2], from[3]);
    const __m128d base = _mm_set1_pd(voxels.Base);
    for (int c = 0; c < 4; ++c)
    {
      const __m128i column = ColumnOf<T>(integers, c);
      const __m128i last = _mm_unpackhi_epi64(column, column);
      rows.Column[c] =
        _mm_movelh_ps(_mm_cvtpd_ps(_mm_sub_pd(_mm_cvtepi32_pd(column), base)),
          _mm_cvtpd_ps(_mm_sub_pd(_mm_cvtepi32_pd(last), base)));
    }
    return rows;
  }
#endif
  for (int c = 0; c < 4; ++c)
  {
    rows.Column[c] = FourFloats{ voxels[first[0] + c], voxels[first[1] + c],
      voxels[first[2] + c], voxels[first[3] + c] };
  }
  return rows;
}
}

#endif
