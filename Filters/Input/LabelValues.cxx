// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Input/LabelValues.h"

#include "Core/Common/Refuse.h"
#include "Host/LargeArrays.h"
#include "Input/ImageVoxels.h"

#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkIntArray.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <type_traits>

namespace volumic
{
namespace
{
/** Voxels that a thread takes at a time. */
constexpr std::size_t ValuesGrain = 1 << 18;

/** Whether a whole number is an int. */
template <typename T>
bool IsInt(T value)
{
  const auto real = static_cast<double>(value);
  return real >= std::numeric_limits<int>::min() && real <= std::numeric_limits<int>::max();
}

/** What are labels but for what resampling or a scale leaves. @param told given what was done */
vtkSmartPointer<vtkDataArray> Rounded(vtkDataArray* voxels, int background, std::string& told)
{
  constexpr double most = 0.01;
  const vtkIdType count = voxels->GetNumberOfTuples();
  vtkIdType missing = 0;
  double farthest = 0.0;
  VisitVoxels(voxels,
    [&](const auto* values)
    {
      for (vtkIdType i = 0; i < count; ++i)
      {
        const auto value = static_cast<double>(values[i]);
        const double off = std::abs(value - std::round(value));
        if (off > most || std::isinf(value))
        {
          Refuse(NameOf(voxels), " has the value ", value,
            "; labels must be integers. For the surface of a volume that is no label map apply "
            "Volume to Surface (vtkVolumeToSurface).");
        }
        missing += std::isnan(value);
        farthest = std::max(farthest, off);
      }
    });
  told = Join(NameOf(voxels), " is of type ", voxels->GetDataTypeAsString(),
    farthest > 0.0
      ? Join("; its values are within ", farthest, " of integers, and are rounded to labels")
      : std::string("; its values are integers and are taken as labels"),
    missing > 0 ? Join("; NaN, at ", missing, missing == 1 ? " voxel" : " voxels",
                    ", is background.")
                : std::string("."));
  if (missing == 0 && farthest == 0.0)
  {
    return voxels;
  }
  auto rounded = vtkSmartPointer<vtkDoubleArray>::New();
  rounded->SetName(voxels->GetName());
  rounded->SetNumberOfTuples(count);
  VisitVoxels(voxels,
    [&](const auto* values)
    {
      std::transform(values, values + count, rounded->GetPointer(0),
        [background](auto value)
        {
          const auto real = static_cast<double>(value);
          return std::isnan(real) ? background : std::round(real);
        });
    });
  return rounded;
}

/** The whole number as a file has it. */
template <typename T>
std::string DigitsOf(T value)
{
  if constexpr (std::is_floating_point_v<T>)
  {
    return std::to_string(static_cast<long long>(value));
  }
  else
  {
    return std::to_string(value);
  }
}

template <typename T>
void NumberAnew(
  const T* voxels, std::size_t count, std::size_t most, Executor& threads, LabelValues& values)
{
  std::set<T> wide;
  int largest = 0;
  for (std::size_t i = 0; i < count && wide.size() <= most; ++i)
  {
    if (!IsInt(voxels[i]))
    {
      wide.insert(voxels[i]);
    }
    else
    {
      largest = std::max(largest, static_cast<int>(voxels[i]));
    }
  }
  const auto room = static_cast<std::size_t>(std::numeric_limits<int>::max() - largest);
  if (wide.size() > std::min(most, room))
  {
    Refuse(NameOf(values.Voxels), " has more than ", std::min(most, room),
      " different values that 32 bits don't hold, such as ", DigitsOf(*wide.begin()),
      ": it is likely no label map. Number them anew if it is.");
  }
  if (wide.empty())
  {
    return;
  }
  std::map<T, int> numbers;
  constexpr std::size_t listed = 5;
  std::string list;
  for (const T label : wide)
  {
    const int number = largest + 1 + static_cast<int>(numbers.size());
    numbers[label] = number;
    values.Numbers[number] = DigitsOf(label);
    list += numbers.size() > listed
      ? ""
      : Join(numbers.size() > 1 ? ", " : "", DigitsOf(label), " is ", number);
  }
  const auto labels = NewLargeArray<vtkIntArray>(count);
  labels->SetName(values.Voxels->GetName());
  int* to = labels->GetPointer(0);
  threads.For(count, ValuesGrain,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        to[i] = IsInt(voxels[i]) ? static_cast<int>(voxels[i]) : numbers.at(voxels[i]);
      }
    });
  values.Told += Join(values.Told.empty() ? "" : " ", NameOf(values.Voxels), " has ",
    wide.size(), wide.size() == 1 ? " label" : " labels",
    " that 32 bits don't hold; they are numbered anew, and named by what "
    "they were: ",
    list, wide.size() > listed ? " and so on." : ".");
  values.Voxels = labels;
}
}

LabelValues LabelValuesOf(vtkDataArray* voxels, int background, std::size_t most, Executor& threads)
{
  LabelValues values;
  values.Voxels = voxels;
  const int type = voxels->GetDataType();
  if (type == VTK_FLOAT || type == VTK_DOUBLE)
  {
    values.Voxels = Rounded(voxels, background, values.Told);
  }
  if (voxels->GetDataTypeSize() >= 4 && type != VTK_INT)
  {
    const vtkSmartPointer<vtkDataArray> wide = values.Voxels;
    VisitVoxels(wide,
      [&](const auto* numbers)
      {
        NumberAnew(
          numbers, static_cast<std::size_t>(wide->GetNumberOfTuples()), most, threads, values);
      });
  }
  return values;
}
}
