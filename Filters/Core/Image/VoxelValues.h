// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicVoxelValues_h
#define volumicVoxelValues_h

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace volumic
{
/** Float voxels without a base. */
struct PlainVoxels
{
  using Stored = float;
  const float* Voxels;

  float Value(float stored) const { return stored; }
  float operator[](std::ptrdiff_t i) const { return this->Voxels[i]; }
};

/** Voxels minus a base: the difference in double, rounded to float. */
template <typename T>
struct DoubleVoxels
{
  using Stored = T;
  const T* Voxels;
  double Base;

  float Value(T stored) const
  {
    return static_cast<float>(static_cast<double>(stored) - this->Base);
  }
  float operator[](std::ptrdiff_t i) const { return this->Value(this->Voxels[i]); }
};

/**
 * Integer voxels of at most 16 bits minus a base that is a float. Bit-identical to DoubleVoxels,
 * but faster: both operands are floats, so the difference is rounded once. The difference in double
 * is exact or rounded away from the midpoint of two floats, so the second rounding does not matter.
 */
template <typename T>
struct SmallIntegerVoxels
{
  static_assert(std::is_integral_v<T> && sizeof(T) <= 2, "not every such number is a float");
  using Stored = T;
  const T* Voxels;
  float Base;

  float Value(T stored) const { return static_cast<float>(stored) - this->Base; }
  float operator[](std::ptrdiff_t i) const { return this->Value(this->Voxels[i]); }
};

/**
 * View of the voxels of a level in the scalar type of the image, without a copy. Values are
 * float(double(voxel) - base), or float voxels unchanged. x fastest; not owned.
 */
class VoxelValues
{
public:
  VoxelValues() = default;

  /** View floats; null: no voxels. Converts implicitly. */
  VoxelValues(const float* voxels) : Voxels(voxels) {}

  /** View voxels minus a base. */
  template <typename T>
  VoxelValues(const T* voxels, double base)
    : Voxels(voxels), Base(base), Scalar(TypeOf<T>()), IsPlain(false),
      IsSmallInteger(sizeof(T) <= 2 && static_cast<double>(static_cast<float>(base)) == base)
  {
  }

  explicit operator bool() const { return this->Voxels != nullptr; }

  /**
   * Call visit(voxels) with PlainVoxels, SmallIntegerVoxels or DoubleVoxels: voxels[i] is value i.
   * Call it once per sample or loop, because it dispatches on the type.
   */
  template <typename Visitor>
  std::invoke_result_t<Visitor, PlainVoxels> Visit(Visitor&& visit) const
  {
    if (this->IsPlain)
    {
      return visit(PlainVoxels{ static_cast<const float*>(this->Voxels) });
    }
    switch (this->Scalar)
    {
      case Type::SignedChar:
        return this->VisitAsFloat<std::int8_t>(visit);
      case Type::UnsignedChar:
        return this->VisitAsFloat<std::uint8_t>(visit);
      case Type::Short:
        return this->VisitAsFloat<std::int16_t>(visit);
      case Type::UnsignedShort:
        return this->VisitAsFloat<std::uint16_t>(visit);
      case Type::Int:
        return this->VisitAsDouble<std::int32_t>(visit);
      case Type::UnsignedInt:
        return this->VisitAsDouble<std::uint32_t>(visit);
      case Type::Long:
        return this->VisitAsDouble<std::int64_t>(visit);
      case Type::UnsignedLong:
        return this->VisitAsDouble<std::uint64_t>(visit);
      case Type::Double:
        return this->VisitAsDouble<double>(visit);
      default:
        return this->VisitAsDouble<float>(visit);
    }
  }

  /** Return one value. Slow in loops. */
  float operator[](std::ptrdiff_t i) const
  {
    return this->Visit([i](const auto& voxels) { return voxels[i]; });
  }

  /** Copy the values [first, first + count). */
  void Copy(std::ptrdiff_t first, std::ptrdiff_t count, float* values) const
  {
    this->Visit(
      [=](const auto& voxels)
      {
        for (std::ptrdiff_t i = 0; i < count; ++i)
        {
          values[i] = voxels[first + i];
        }
      });
  }

private:
  /** By size and sign, which depend on the platform for char, long and long long. */
  enum class Type : std::uint8_t
  {
    SignedChar,
    UnsignedChar,
    Short,
    UnsignedShort,
    Int,
    UnsignedInt,
    Long,
    UnsignedLong,
    Float,
    Double
  };

  template <typename T>
  static constexpr Type TypeOf()
  {
    if constexpr (std::is_floating_point_v<T>)
    {
      return sizeof(T) == sizeof(float) ? Type::Float : Type::Double;
    }
    else
    {
      constexpr Type types[4][2] = { { Type::UnsignedChar, Type::SignedChar },
        { Type::UnsignedShort, Type::Short }, { Type::UnsignedInt, Type::Int },
        { Type::UnsignedLong, Type::Long } };
      constexpr int size = sizeof(T) == 1 ? 0 : sizeof(T) == 2 ? 1 : sizeof(T) == 4 ? 2 : 3;
      return types[size][std::is_signed_v<T> ? 1 : 0];
    }
  }

  template <typename T, typename Visitor>
  std::invoke_result_t<Visitor, PlainVoxels> VisitAsFloat(Visitor&& visit) const
  {
    if (this->IsSmallInteger)
    {
      return visit(SmallIntegerVoxels<T>{
        static_cast<const T*>(this->Voxels), static_cast<float>(this->Base) });
    }
    return this->VisitAsDouble<T>(visit);
  }
  template <typename T, typename Visitor>
  std::invoke_result_t<Visitor, PlainVoxels> VisitAsDouble(Visitor&& visit) const
  {
    return visit(DoubleVoxels<T>{ static_cast<const T*>(this->Voxels), this->Base });
  }

  const void* Voxels = nullptr;
  double Base = 0.;
  Type Scalar = Type::Float;
  bool IsPlain = true;
  bool IsSmallInteger = false; ///< See SmallIntegerVoxels.
};
}

#endif
