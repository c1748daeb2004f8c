// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Input/LabelValues.h"

#include "Core/Common/ThrowInvalidArgument.h"
#include "Host/LargeArrays.h"
#include "Input/ImageVoxels.h"

#include <vtkDataArray.h>
#include <vtkIntArray.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace volumic
{
namespace
{
template <typename T>
bool IsInt(T value)
{
  const auto real = static_cast<double>(value);
  return real >= std::numeric_limits<int>::min() && real <= std::numeric_limits<int>::max();
}

template <typename T>
T Rounded(T value)
{
  return std::is_floating_point_v<T> ? static_cast<T>(std::round(value)) : value;
}

template <typename T>
std::string DigitsOf(T value)
{
  return std::to_string(
    static_cast<std::conditional_t<std::is_floating_point_v<T>, long long, T>>(value));
}

/** Values of an array that need a conversion. */
template <typename T>
struct Conversion
{
  std::map<T, int> Wide;   ///< labels outside the range of int, with their new numbers
  int Largest = 0;         ///< largest of the other labels
  std::size_t Missing = 0; ///< number of NaN voxels
  double Farthest = 0.0;   ///< largest distance from an integer
};

template <typename T>
Conversion<T> FindConversion(const T* voxels, vtkDataArray* array, std::size_t most)
{
  constexpr double mostOff = 0.01;
  const auto count = static_cast<std::size_t>(array->GetNumberOfTuples());
  Conversion<T> found;
  for (std::size_t i = 0; i < count && found.Wide.size() <= most; ++i)
  {
    const T whole = Rounded(voxels[i]);
    const auto value = static_cast<double>(voxels[i]);
    const double off = std::abs(value - static_cast<double>(whole));
    if (off > mostOff || (std::is_floating_point_v<T> && std::abs(value) > 9e18))
    {
      ThrowInvalidArgument(NameOf(array), " has the value ", value,
        "; labels must be integers. For the surface of an image that is not a label map apply "
        "Volume to Surface (vtkVolumeToSurface).");
    }
    found.Farthest = std::max(found.Farthest, off); // NaN has no effect.
    if (std::isnan(value))
    {
      ++found.Missing;
    }
    else if (IsInt(whole))
    {
      found.Largest = std::max(found.Largest, static_cast<int>(whole));
    }
    else
    {
      found.Wide[whole] = 0;
    }
  }
  const auto room = static_cast<std::size_t>(std::numeric_limits<int>::max() - found.Largest);
  if (found.Wide.size() > std::min(most, room))
  {
    ThrowInvalidArgument(NameOf(array), " has more than ", std::min(most, room),
      " different values outside the range of int, such as ", DigitsOf(found.Wide.begin()->first),
      "; it is probably not a label map. Renumber the labels if it is.");
  }
  return found;
}

template <typename T>
void MakeInts(
  const T* voxels, int background, std::size_t most, Executor& threads, LabelValues& values)
{
  vtkDataArray* array = values.Voxels;
  Conversion<T> found = FindConversion(voxels, array, most);
  if (std::is_floating_point_v<T>)
  {
    values.Conversions = Join(NameOf(array), " is of type ", array->GetDataTypeAsString(),
      found.Farthest > 0.0 ? Join("; its values are within ", found.Farthest,
                               " of integers, and are rounded to labels")
                           : std::string("; its values are integers, and are used as labels"),
      found.Missing > 0
        ? Join("; ", found.Missing, found.Missing == 1 ? " NaN voxel is" : " NaN voxels are",
            " background.")
        : std::string("."));
  }
  if (found.Wide.empty() && found.Missing == 0 && found.Farthest == 0.0)
  {
    return;
  }
  constexpr std::size_t mostListed = 5;
  std::string list;
  for (auto& [label, number] : found.Wide)
  {
    number = ++found.Largest;
    values.Numbers[number] = DigitsOf(label);
    const std::size_t n = values.Numbers.size();
    list += n > mostListed ? "" : Join(n > 1 ? ", " : "", DigitsOf(label), " is ", number);
  }
  if (const std::size_t n = found.Wide.size(); n > 0)
  {
    values.Conversions += Join(values.Conversions.empty() ? "" : " ", NameOf(array), " has ", n,
      n == 1 ? " label" : " labels",
      " outside the range of int. They are renumbered, and named by their old numbers: ", list,
      n > mostListed ? " and so on." : ".");
  }
  const auto count = static_cast<std::size_t>(array->GetNumberOfTuples());
  const auto labels = NewLargeArray<vtkIntArray>(count);
  labels->SetName(array->GetName());
  int* to = labels->GetPointer(0);
  threads.For(count, 1 << 18,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        const T whole = Rounded(voxels[i]);
        to[i] = std::isnan(static_cast<double>(whole)) ? background
          : IsInt(whole)                               ? static_cast<int>(whole)
                                                       : found.Wide.at(whole);
      }
    });
  values.Voxels = labels;
}
}

LabelValues LabelValuesOf(vtkDataArray* voxels, int background, std::size_t most, Executor& threads)
{
  LabelValues values;
  values.Voxels = voxels;
  if (voxels->GetDataTypeSize() >= 4 && voxels->GetDataType() != VTK_INT)
  {
    VisitVoxels(
      voxels, [&](const auto* numbers) { MakeInts(numbers, background, most, threads, values); });
  }
  return values;
}
}
