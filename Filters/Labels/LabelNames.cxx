// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Labels/LabelNames.h"

#include "Core/Common/Join.h"
#include "Core/Common/ThrowInvalidArgument.h"

#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkFieldData.h>
#include <vtkMath.h>
#include <vtkStringArray.h>
#include <vtkType.h>

#include <algorithm>
#include <cmath>

namespace volumic
{
namespace
{
void CheckEntries(vtkAbstractArray* array, vtkIdType requested)
{
  if (array && array->GetNumberOfTuples() != requested)
  {
    ThrowInvalidArgument("field array '", array->GetName(), "' has ", array->GetNumberOfTuples(),
      " entries, but 'LabelValues' has ", requested, ". Provide an entry for each label.");
  }
}
}

LabelNames LabelNames::Of(vtkDataObject* image)
{
  LabelNames labels;
  vtkFieldData* fields = image->GetFieldData();
  vtkDataArray* values = fields->GetArray("LabelValues");
  if (!values)
  {
    return labels;
  }
  const vtkIdType count = values->GetNumberOfTuples();
  auto* names = vtkStringArray::SafeDownCast(fields->GetAbstractArray("LabelNames"));
  vtkDataArray* colors = fields->GetArray("LabelColors");
  CheckEntries(names, count);
  CheckEntries(colors, count);
  if (colors && colors->GetNumberOfComponents() != 3)
  {
    ThrowInvalidArgument("field array 'LabelColors' has ", colors->GetNumberOfComponents(),
      " components. Provide 3: red, green, blue.");
  }
  for (vtkIdType i = 0; i < count; ++i)
  {
    // In this order NaN is in the range of int, too.
    const int label = static_cast<int>(
      std::max(-VTK_INT_MAX + 0.0, std::min(VTK_INT_MAX + 0.0, values->GetComponent(i, 0))));
    if (names && !names->GetValue(i).empty())
    {
      labels.Names[label] = names->GetValue(i);
    }
    if (colors)
    {
      const double scale = colors->GetDataType() == VTK_UNSIGNED_CHAR ? 1.0 / 255.0 : 1.0;
      for (int c = 0; c < 3; ++c)
      {
        labels.Colors[label][static_cast<std::size_t>(c)] = scale * colors->GetComponent(i, c);
      }
    }
  }
  return labels;
}

void LabelNames::Complete(const LabelNames& others)
{
  this->Names.insert(others.Names.begin(), others.Names.end());
  this->Colors.insert(others.Colors.begin(), others.Colors.end());
}

std::string LabelNames::NameOf(int label) const
{
  const auto found = this->Names.find(label);
  return found != this->Names.end() ? found->second : "Label " + std::to_string(label);
}

std::string LabelNames::NameOf(const std::vector<int>& labels) const
{
  if (labels.size() == 1)
  {
    return this->NameOf(labels.front());
  }
  std::string text;
  for (const int label : labels)
  {
    text += (text.empty() ? "Labels " : ", ") + std::to_string(label);
  }
  return text;
}

LabelNames::Color LabelNames::ColorOf(int label) const
{
  const auto found = this->Colors.find(label);
  if (found != this->Colors.end())
  {
    return found->second;
  }
  // With these constants the first 30 labels differ by 17 (CIE 1976), and the first 120 by 7.4. The
  // colors of maps with one object, 1 and 255, are light enough to show its relief.
  const auto spread = [label](double step) { return step * label - std::floor(step * label); };
  constexpr double goldenRatio = 0.6180339887498949;
  const double hue = std::fmod(0.68 + spread(goldenRatio), 1.0);
  const double saturation = 0.4 + 0.55 * spread(0.882);
  const double value = 0.55 + 0.45 * spread(0.958);
  Color color;
  vtkMath::HSVToRGB(hue, saturation, value, &color[0], &color[1], &color[2]);
  return color;
}

std::string Listed(const std::vector<std::string>& texts, std::size_t most)
{
  std::string list;
  for (std::size_t i = 0; i < std::min(texts.size(), most); ++i)
  {
    list += (i == 0 ? "" : ", ") + texts[i];
  }
  return texts.size() > most ? Join(list, " and ", texts.size() - most, " others") : list;
}
}
