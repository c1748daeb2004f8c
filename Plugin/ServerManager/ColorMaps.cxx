// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ColorMaps.h"

#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>
#include <vtkSMTransferFunctionManager.h>

#include <algorithm>
#include <cmath>

namespace
{
void SetNumbers(vtkSMProxy* colors, const char* property, const std::vector<double>& values)
{
  vtkSMPropertyHelper(colors, property, true)
    .Set(values.data(), static_cast<unsigned int>(values.size()));
}
}

namespace volumic
{
//------------------------------------------------------------------------------
bool IsInitialized(vtkSMProxy* colors)
{
  return vtkSMPropertyHelper(colors, "ScalarRangeInitialized", true).GetAsInt() != 0;
}

//------------------------------------------------------------------------------
void SetCategories(vtkSMProxy* colors, const std::vector<ColorCategory>& categories)
{
  std::vector<double> shown;
  vtkSMPropertyHelper annotations(colors, "Annotations");
  annotations.SetNumberOfElements(2 * static_cast<unsigned int>(categories.size()));
  unsigned int index = 0;
  for (const ColorCategory& category : categories)
  {
    annotations.Set(index++, category.Value.c_str());
    annotations.Set(index++, category.Text.c_str());
    shown.insert(shown.end(), category.Color.begin(), category.Color.end());
  }
  SetNumbers(colors, "IndexedColors", shown);
  SetNumbers(colors, "NanColor", { OtherColor.begin(), OtherColor.end() });
  vtkSMPropertyHelper(colors, "AnnotationsInitialized", true).Set(1);
  vtkSMPropertyHelper(colors, "IndexedLookup").Set(1);
  // ParaView does not rescale it at Apply, and does not search the data for values.
  vtkSMPropertyHelper(colors, "AutomaticRescaleRangeMode", true)
    .Set(static_cast<int>(vtkSMTransferFunctionManager::NEVER));
  vtkSMPropertyHelper(colors, "ScalarRangeInitialized", true).Set(1);
  colors->UpdateVTKObjects();
}

//------------------------------------------------------------------------------
std::vector<ColorCategory> CategoriesOf(vtkSMProxy* colors)
{
  vtkSMPropertyHelper annotations(colors, "Annotations", true);
  vtkSMPropertyHelper shown(colors, "IndexedColors", true);
  std::vector<ColorCategory> categories(annotations.GetNumberOfElements() / 2);
  for (unsigned int i = 0; i < categories.size(); ++i)
  {
    categories[i] = { annotations.GetAsString(2 * i), annotations.GetAsString(2 * i + 1), {} };
    for (unsigned int c = 0; c < 3 && 3 * i + c < shown.GetNumberOfElements(); ++c)
    {
      categories[i].Color[c] = shown.GetAsDouble(3 * i + c);
    }
  }
  return categories;
}

//------------------------------------------------------------------------------
bool AreSame(const std::vector<ColorCategory>& one, const std::vector<ColorCategory>& other)
{
  const auto isNear = [](double a, double b) { return std::abs(a - b) < 1e-4; };
  const auto isSame = [&](const ColorCategory& a, const ColorCategory& b)
  {
    return a.Value == b.Value && a.Text == b.Text &&
      std::equal(a.Color.begin(), a.Color.end(), b.Color.begin(), isNear);
  };
  return std::equal(one.begin(), one.end(), other.begin(), other.end(), isSame);
}
}
