// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicVector_h
#define volumicVector_h

#include <cmath>

namespace volumic
{
/**
 * Point or vector of the computational space. Floats, with the unused fourth lane, take a quarter
 * of a cache line. Triangle tests widen to double, in which most differences of floats are exact.
 */
template <typename T>
struct alignas(16) Vector3
{
  T X = 0;
  T Y = 0;
  T Z = 0;
  T Padding = 0; ///< Fills a SIMD register.

  Vector3() = default;
  Vector3(T x, T y, T z) : X(x), Y(y), Z(z) {}
  template <typename U>
  explicit Vector3(const Vector3<U>& other)
    : X(static_cast<T>(other.X)), Y(static_cast<T>(other.Y)), Z(static_cast<T>(other.Z))
  {
  }

  Vector3& operator+=(const Vector3& b)
  {
    this->X += b.X;
    this->Y += b.Y;
    this->Z += b.Z;
    this->Padding += b.Padding;
    return *this;
  }
  Vector3& operator-=(const Vector3& b)
  {
    this->X -= b.X;
    this->Y -= b.Y;
    this->Z -= b.Z;
    this->Padding -= b.Padding;
    return *this;
  }
  Vector3& operator*=(T s)
  {
    this->X *= s;
    this->Y *= s;
    this->Z *= s;
    this->Padding *= s;
    return *this;
  }
};

template <typename T>
inline Vector3<T> operator+(const Vector3<T>& a, const Vector3<T>& b)
{
  Vector3<T> sum = a;
  return sum += b;
}
template <typename T>
inline Vector3<T> operator-(const Vector3<T>& a, const Vector3<T>& b)
{
  Vector3<T> difference = a;
  return difference -= b;
}
template <typename T>
inline Vector3<T> operator-(const Vector3<T>& a)
{
  return Vector3<T>(-a.X, -a.Y, -a.Z);
}
template <typename T>
inline Vector3<T> operator*(const Vector3<T>& a, T s)
{
  Vector3<T> product = a;
  return product *= s;
}
template <typename T>
inline T Dot(const Vector3<T>& a, const Vector3<T>& b)
{
  return a.X * b.X + a.Y * b.Y + a.Z * b.Z;
}
template <typename T>
inline Vector3<T> Cross(const Vector3<T>& a, const Vector3<T>& b)
{
  return Vector3<T>(a.Y * b.Z - a.Z * b.Y, a.Z * b.X - a.X * b.Z, a.X * b.Y - a.Y * b.X);
}
template <typename T>
inline T SquaredLength(const Vector3<T>& a)
{
  return Dot(a, a);
}
template <typename T>
inline T Length(const Vector3<T>& a)
{
  return std::sqrt(Dot(a, a));
}
/** Return the unit vector; zero stays zero. */
template <typename T>
inline Vector3<T> Normalized(const Vector3<T>& a)
{
  const T length = Length(a);
  return length > 0 ? a * (T(1) / length) : Vector3<T>();
}
template <typename T>
inline T SquaredDistance(const Vector3<T>& a, const Vector3<T>& b)
{
  return SquaredLength(b - a);
}

using Vector = Vector3<float>;
using VectorD = Vector3<double>;
}

#endif
