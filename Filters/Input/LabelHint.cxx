// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Input/LabelHint.h"

#include "Core/Common/Join.h"
#include "Input/ImageVoxels.h"

#include <vtkDataArray.h>
#include <vtkType.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace volumic
{
namespace
{
/** About as many voxels are looked at. */
constexpr vtkIdType MostVoxels = 1 << 20;
/** More different values in them are no labels. */
constexpr std::size_t MostValues = 1024;
/**
 * Share of equal neighbours from which on voxels are labels. Of nine atlases the least is 0.82; of
 * fourteen scans, half of them of 8 bits, the most is 0.57, and that one is saturated.
 */
constexpr double LeastShareOfEqual = 0.75;
/** Fewer pairs of neighbours tell nothing. */
constexpr vtkIdType LeastPairs = 50;

/** Of one value. */
struct Neighbours
{
  vtkIdType Voxels = 0;
  vtkIdType Equal = 0;   ///< pairs of this value
  vtkIdType Unequal = 0; ///< pairs of it and another one
};

template <typename T>
bool LookLikeLabels(const T* voxels, const int size[3], std::size_t& count)
{
  const vtkIdType rows = static_cast<vtkIdType>(size[1]) * size[2];
  const vtkIdType step = std::max<vtkIdType>(1, rows * size[0] / MostVoxels);
  std::unordered_map<double, Neighbours> found;
  vtkIdType unequal = 0;
  for (vtkIdType row = 0; row < rows; row += step)
  {
    const T* values = voxels + row * size[0];
    for (int i = 0; i < size[0]; ++i)
    {
      const auto value = static_cast<double>(values[i]);
      if (!(value == std::floor(value)) || found.size() > MostValues)
      {
        return false;
      }
      Neighbours& own = found[value];
      ++own.Voxels;
      if (i > 0)
      {
        const bool isEqual = values[i - 1] == values[i];
        own.Equal += isEqual;
        own.Unequal += !isEqual;
        unequal += !isEqual;
        found[static_cast<double>(values[i - 1])].Unequal += !isEqual;
      }
    }
  }
  count = found.size();
  const auto background = std::max_element(found.begin(), found.end(),
    [](const auto& a, const auto& b) { return a.second.Voxels < b.second.Voxels; });
  unequal -= background->second.Unequal;
  vtkIdType equal = -background->second.Equal;
  for (const auto& entry : found)
  {
    equal += entry.second.Equal;
  }
  return equal + unequal >= LeastPairs &&
    static_cast<double>(equal) >= LeastShareOfEqual * static_cast<double>(equal + unequal);
}
}

std::string HintAtLabels(vtkDataArray* voxels, const int size[3])
{
  bool areLabels = false;
  std::size_t count = 0;
  switch (voxels->GetDataType())
  {
    vtkTemplateMacro(areLabels = LookLikeLabels(
                       static_cast<const VTK_TT*>(voxels->GetVoidPointer(0)), size, count));
  }
  return areLabels
    ? Join(NameOf(voxels), " looks like a label map: ", count,
        " different integers. Labels to Surfaces (vtkLabelsToSurfaces) makes a smooth surface of "
        "each label; here an isopotential between them is searched.")
    : std::string();
}
}
