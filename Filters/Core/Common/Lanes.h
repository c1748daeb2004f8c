// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLanes_h
#define volumicLanes_h

#include "Core/Common/Vector.h"

#include <algorithm>
#include <cmath>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace volumic
{
/**
 * Four floats in a SIMD register. Each lane is rounded like a single float, so results do not
 * depend on the use of lanes. Uses SSE2 on x86-64, and loops that compilers vectorize elsewhere.
 */
class Lanes
{
public:
  static constexpr int Count = 4;
#ifdef __SSE2__
  using Type = __m128;
#else
  struct Type
  {
    float Lane[Count];
  };
#endif

  Lanes() = default;
  Lanes(float x); ///< Set all lanes to x.
  explicit Lanes(const Type& value) : Value(value) {}
  static Lanes Load(const float* from); ///< Load from an address of any alignment.
  void Store(float* to) const;

  Lanes& operator+=(const Lanes& b)
  {
    return *this = *this + b;
  }
  Lanes& operator-=(const Lanes& b)
  {
    return *this = *this - b;
  }
  Lanes& operator*=(const Lanes& b)
  {
    return *this = *this * b;
  }

  friend Lanes operator+(const Lanes& a, const Lanes& b);
  friend Lanes operator-(const Lanes& a, const Lanes& b);
  friend Lanes operator*(const Lanes& a, const Lanes& b);
  friend Lanes operator/(const Lanes& a, const Lanes& b);
  friend Lanes Minimum(const Lanes& a, const Lanes& b);
  friend Lanes Maximum(const Lanes& a, const Lanes& b);
  friend Lanes SquareRoot(const Lanes& a);
  /** Return x in the lanes where a < b, 0 in the others. */
  friend Lanes WhereLess(const Lanes& a, const Lanes& b, const Lanes& x);
  /** Return bit i set if a < b in lane i. */
  friend unsigned LessBits(const Lanes& a, const Lanes& b);
  friend Vector3<Lanes> Gather(
    const float* a, const float* b, const float* c, const float* d, Lanes& fourth);

  Type Value;
};

#ifdef __SSE2__
inline Lanes::Lanes(float x) : Value(_mm_set1_ps(x)) {}
inline Lanes Lanes::Load(const float* from)
{
  return Lanes(_mm_loadu_ps(from));
}
inline void Lanes::Store(float* to) const
{
  _mm_storeu_ps(to, this->Value);
}
inline Lanes operator+(const Lanes& a, const Lanes& b)
{
  return Lanes(_mm_add_ps(a.Value, b.Value));
}
inline Lanes operator-(const Lanes& a, const Lanes& b)
{
  return Lanes(_mm_sub_ps(a.Value, b.Value));
}
inline Lanes operator*(const Lanes& a, const Lanes& b)
{
  return Lanes(_mm_mul_ps(a.Value, b.Value));
}
inline Lanes operator/(const Lanes& a, const Lanes& b)
{
  return Lanes(_mm_div_ps(a.Value, b.Value));
}
inline Lanes Minimum(const Lanes& a, const Lanes& b)
{
  return Lanes(_mm_min_ps(b.Value, a.Value)); // Returns the first of equal values, like std::min.
}
inline Lanes Maximum(const Lanes& a, const Lanes& b)
{
  return Lanes(_mm_max_ps(b.Value, a.Value));
}
inline Lanes SquareRoot(const Lanes& a)
{
  return Lanes(_mm_sqrt_ps(a.Value));
}
inline Lanes WhereLess(const Lanes& a, const Lanes& b, const Lanes& x)
{
  return Lanes(_mm_and_ps(_mm_cmplt_ps(a.Value, b.Value), x.Value));
}
inline unsigned LessBits(const Lanes& a, const Lanes& b)
{
  return static_cast<unsigned>(_mm_movemask_ps(_mm_cmplt_ps(a.Value, b.Value)));
}
inline Vector3<Lanes> Gather(
  const float* a, const float* b, const float* c, const float* d, Lanes& fourth)
{
  __m128 x = _mm_loadu_ps(a);
  __m128 y = _mm_loadu_ps(b);
  __m128 z = _mm_loadu_ps(c);
  __m128 w = _mm_loadu_ps(d);
  _MM_TRANSPOSE4_PS(x, y, z, w);
  fourth = Lanes(w);
  return Vector3<Lanes>(Lanes(x), Lanes(y), Lanes(z));
}
/** Return bit i set if the i-th of four numbers equals `number`. */
inline unsigned EqualBits(const int* four, int number)
{
  const __m128i equal = _mm_cmpeq_epi32(
    _mm_loadu_si128(reinterpret_cast<const __m128i*>(four)), _mm_set1_epi32(number));
  return static_cast<unsigned>(_mm_movemask_ps(_mm_castsi128_ps(equal)));
}
#else
namespace lanes
{
template <typename Operation>
inline Lanes Each(Operation&& operation)
{
  Lanes result;
  for (int i = 0; i < Lanes::Count; ++i)
  {
    result.Value.Lane[i] = operation(i);
  }
  return result;
}
}
inline Lanes::Lanes(float x) : Value{ { x, x, x, x } } {}
inline Lanes Lanes::Load(const float* from)
{
  return lanes::Each([&](int i) { return from[i]; });
}
inline void Lanes::Store(float* to) const
{
  std::copy(this->Value.Lane, this->Value.Lane + Count, to);
}
inline Lanes operator+(const Lanes& a, const Lanes& b)
{
  return lanes::Each([&](int i) { return a.Value.Lane[i] + b.Value.Lane[i]; });
}
inline Lanes operator-(const Lanes& a, const Lanes& b)
{
  return lanes::Each([&](int i) { return a.Value.Lane[i] - b.Value.Lane[i]; });
}
inline Lanes operator*(const Lanes& a, const Lanes& b)
{
  return lanes::Each([&](int i) { return a.Value.Lane[i] * b.Value.Lane[i]; });
}
inline Lanes operator/(const Lanes& a, const Lanes& b)
{
  return lanes::Each([&](int i) { return a.Value.Lane[i] / b.Value.Lane[i]; });
}
inline Lanes Minimum(const Lanes& a, const Lanes& b)
{
  return lanes::Each([&](int i) { return std::min(a.Value.Lane[i], b.Value.Lane[i]); });
}
inline Lanes Maximum(const Lanes& a, const Lanes& b)
{
  return lanes::Each([&](int i) { return std::max(a.Value.Lane[i], b.Value.Lane[i]); });
}
inline Lanes SquareRoot(const Lanes& a)
{
  return lanes::Each([&](int i) { return std::sqrt(a.Value.Lane[i]); });
}
inline Lanes WhereLess(const Lanes& a, const Lanes& b, const Lanes& x)
{
  return lanes::Each(
    [&](int i) { return a.Value.Lane[i] < b.Value.Lane[i] ? x.Value.Lane[i] : 0.f; });
}
inline unsigned LessBits(const Lanes& a, const Lanes& b)
{
  unsigned bits = 0;
  for (int i = 0; i < Lanes::Count; ++i)
  {
    bits |= (a.Value.Lane[i] < b.Value.Lane[i] ? 1u : 0u) << i;
  }
  return bits;
}
inline Vector3<Lanes> Gather(
  const float* a, const float* b, const float* c, const float* d, Lanes& fourth)
{
  const auto lane = [&](int k)
  {
    const float four[Lanes::Count] = { a[k], b[k], c[k], d[k] };
    return Lanes::Load(four);
  };
  fourth = lane(3);
  return Vector3<Lanes>(lane(0), lane(1), lane(2));
}
/** Return bit i set if the i-th of four numbers equals `number`. */
inline unsigned EqualBits(const int* four, int number)
{
  unsigned bits = 0;
  for (int i = 0; i < Lanes::Count; ++i)
  {
    bits |= (four[i] == number ? 1u : 0u) << i;
  }
  return bits;
}
#endif

inline float LeastOf(const Lanes& a)
{
  float lane[Lanes::Count];
  a.Store(lane);
  return std::min(std::min(lane[0], lane[1]), std::min(lane[2], lane[3]));
}
inline float GreatestOf(const Lanes& a)
{
  float lane[Lanes::Count];
  a.Store(lane);
  return std::max(std::max(lane[0], lane[1]), std::max(lane[2], lane[3]));
}

/** Return the index of the lowest set bit. At least one bit must be set. */
inline int LowestBit(unsigned bits)
{
#ifdef __GNUC__
  return __builtin_ctz(bits);
#else
  int lowest = 0;
  while (!(bits >> lowest & 1))
  {
    ++lowest;
  }
  return lowest;
#endif
}

/** Four vectors, with the operations of Vector.h. */
using VectorLanes = Vector3<Lanes>;

inline VectorLanes AllLanes(const Vector& v)
{
  return VectorLanes(Lanes(v.X), Lanes(v.Y), Lanes(v.Z));
}
inline VectorLanes Gather(const Vector& a, const Vector& b, const Vector& c, const Vector& d)
{
  Lanes padding;
  return Gather(&a.X, &b.X, &c.X, &d.X, padding);
}
/** Return unit vectors; zero vectors stay zero. */
inline VectorLanes Normalized(const VectorLanes& a)
{
  const Lanes length = SquareRoot(Dot(a, a));
  const Lanes zero(0.f);
  const VectorLanes unit = a * (Lanes(1.f) / length);
  return VectorLanes(WhereLess(zero, length, unit.X), WhereLess(zero, length, unit.Y),
    WhereLess(zero, length, unit.Z));
}
inline VectorLanes Minimum(const VectorLanes& a, const VectorLanes& b)
{
  return VectorLanes(Minimum(a.X, b.X), Minimum(a.Y, b.Y), Minimum(a.Z, b.Z));
}
inline VectorLanes Maximum(const VectorLanes& a, const VectorLanes& b)
{
  return VectorLanes(Maximum(a.X, b.X), Maximum(a.Y, b.Y), Maximum(a.Z, b.Z));
}
}

#endif
