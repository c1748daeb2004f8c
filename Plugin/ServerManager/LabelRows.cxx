// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LabelRows.h"

#include "Helpers.h"

#include <vtkSMPropertyHelper.h>
#include <vtkSMSourceProxy.h>
#include <vtkSmartPointer.h>

namespace
{
std::vector<volumic::LabelRow> RowsOf(vtkSMSourceProxy* helper, bool hasVoxels)
{
  vtkSMPropertyHelper labels(helper, "Labels");
  vtkSMPropertyHelper names(helper, "Names");
  vtkSMPropertyHelper colors(helper, "Colors");
  std::vector<volumic::LabelRow> rows(labels.GetNumberOfElements());
  if (names.GetNumberOfElements() != rows.size() ||
    colors.GetNumberOfElements() != 3 * rows.size())
  {
    return {};
  }
  for (unsigned int i = 0; i < rows.size(); ++i)
  {
    rows[i].Label = labels.GetAsInt(i);
    rows[i].Name = names.GetAsString(i);
    for (unsigned int c = 0; c < 3; ++c)
    {
      rows[i].Color[c] = colors.GetAsDouble(3 * i + c);
    }
    if (hasVoxels)
    {
      rows[i].Voxels = vtkSMPropertyHelper(helper, "Voxels").GetAsIdType(i);
    }
  }
  return rows;
}
}

namespace volumic
{
//------------------------------------------------------------------------------
LabelRows FetchLabelsOfMap(
  vtkSMSourceProxy* producer, unsigned int port, const std::array<std::string, 5>& array)
{
  LabelRows labels;
  if (const auto helper = NewHelper("LabelList", producer, port))
  {
    if (!array[4].empty())
    {
      vtkSMPropertyHelper selection(helper, "SetInputArrayToProcess");
      for (unsigned int i = 0; i < array.size(); ++i)
      {
        selection.Set(i, array[i].c_str());
      }
    }
    RunHelper(helper, producer->GetDataInformation(port));
    labels.Rows = RowsOf(helper, true);
    labels.Problem = vtkSMPropertyHelper(helper, "Problem").GetAsString();
  }
  return labels;
}

//------------------------------------------------------------------------------
LabelRows FetchLabelsOfSurfaces(vtkSMSourceProxy* producer, unsigned int port)
{
  LabelRows labels;
  if (const auto helper = NewHelper("LabelLegend", producer, port))
  {
    RunHelper(helper, producer->GetDataInformation(port));
    labels.Rows = RowsOf(helper, false);
  }
  return labels;
}
}
