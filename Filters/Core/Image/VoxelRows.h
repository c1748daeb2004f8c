// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicVoxelRows_h
#define volumicVoxelRows_h

#include "Core/Common/Lanes.h"
#include "Core/Common/Vector.h"
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
/** Four voxels of four rows: lane r of Column[c] is voxel c of row r. */
struct VoxelRows
{
  Lanes Column[4];
};

#if defined(__SSE2__)
/** Four voxels of four rows as 16-bit integers: columns 0 and 1, and 2 and 3. */
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
    const __m128i rows =
      _mm_unpacklo_epi8(_mm_unpacklo_epi8(load(a), load(c)), _mm_unpacklo_epi8(load(b), load(d)));
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

/** Return a column as 32-bit integers. */
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

/** Read four voxels from each of the given positions on. */
template <typename Voxels>
VoxelRows ReadRows(const Voxels& voxels, const std::ptrdiff_t (&first)[4])
{
  VoxelRows rows;
  using T = typename Voxels::Stored;
  const T* from[4] = { voxels.Voxels + first[0], voxels.Voxels + first[1], voxels.Voxels + first[2],
    voxels.Voxels + first[3] };
  if constexpr (std::is_same_v<Voxels, PlainVoxels>)
  {
    const Vector3<Lanes> three = Gather(from[0], from[1], from[2], from[3], rows.Column[3]);
    rows.Column[0] = three.X;
    rows.Column[1] = three.Y;
    rows.Column[2] = three.Z;
    return rows;
  }
#if defined(__SSE2__)
  else if constexpr (std::is_same_v<Voxels, SmallIntegerVoxels<T>>)
  {
    const RowsOfIntegers integers = ReadIntegers(from[0], from[1], from[2], from[3]);
    const Lanes base = voxels.Base;
    for (int c = 0; c < 4; ++c)
    {
      rows.Column[c] = Lanes(_mm_cvtepi32_ps(ColumnOf<T>(integers, c))) - base;
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
      rows.Column[c] = Lanes(_mm_movelh_ps(_mm_cvtpd_ps(_mm_sub_pd(_mm_cvtepi32_pd(column), base)),
        _mm_cvtpd_ps(_mm_sub_pd(_mm_cvtepi32_pd(last), base))));
    }
    return rows;
  }
#endif
  else
  {
    for (int c = 0; c < 4; ++c)
    {
      const float column[4] = { voxels.Value(from[0][c]), voxels.Value(from[1][c]),
        voxels.Value(from[2][c]), voxels.Value(from[3][c]) };
      rows.Column[c] = Lanes::Load(column);
    }
    return rows;
  }
}
}

#endif
