// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LabelRows.h"

#include "Helpers.h"

#include <vtkSMPropertyHelper.h>
#include <vtkSMSourceProxy.h>
#include <vtkSmartPointer.h>
#include <vtkVariant.h>

namespace volumic
{
//------------------------------------------------------------------------------
LabelRows FetchLabels(
  vtkSMSourceProxy* producer, unsigned int port, const std::array<std::string, 5>& array)
{
  LabelRows labels;
  const auto helper = NewHelper("LabelList", producer, port);
  if (!helper)
  {
    return labels;
  }
  if (!array[4].empty())
  {
    vtkSMPropertyHelper selection(helper, "SetInputArrayToProcess");
    for (unsigned int i = 0; i < array.size(); ++i)
    {
      selection.Set(i, array[i].c_str());
    }
  }
  RunHelper(helper, producer->GetDataInformation(port));
  vtkSMPropertyHelper texts(helper, "Rows");
  for (unsigned int i = 0; i + 6 <= texts.GetNumberOfElements(); i += 6)
  {
    const auto number = [&](unsigned int column)
    { return vtkVariant(texts.GetAsString(i + column)).ToDouble(); };
    labels.Rows.push_back({ static_cast<int>(number(0)), texts.GetAsString(i + 1),
      static_cast<long long>(number(2)), { { number(3), number(4), number(5) } } });
  }
  labels.Problem = vtkSMPropertyHelper(helper, "Problem").GetAsString();
  return labels;
}
}
