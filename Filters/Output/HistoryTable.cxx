// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Output/HistoryTable.h"

#include <vtkDoubleArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkTable.h>

#include <type_traits>

namespace volumic
{
vtkSmartPointer<vtkTable> MakeHistoryTable(
  const std::vector<HistoryRow>& rows, int last, double unit)
{
  using Row = HistoryRow;
  auto table = vtkSmartPointer<vtkTable>::New();
  const auto add = [&](const char* name, auto member, auto factor)
  {
    using Value = std::decay_t<decltype(Row().*member)>;
    vtkNew<std::conditional_t<std::is_same_v<Value, int>, vtkIntArray, vtkDoubleArray>> column;
    column->SetName(name);
    for (const Row& row : rows)
    {
      if (row.Level >= last)
      {
        column->InsertNextValue(row.*member * factor);
      }
    }
    table->AddColumn(column);
  };
  add("Iteration", &Row::Iteration, 1);
  add("Level", &Row::Level, 1);
  add("Vertices", &Row::Vertices, 1);
  add("KineticEnergy", &Row::KineticEnergy, 1);
  add("MeanEdgeLength", &Row::MeanEdgeLength, unit);
  add("Seconds", &Row::Seconds, 1);
  add("TimeStep", &Row::TimeStep, 1);
  add("ActiveVertices", &Row::ActiveVertices, 1);
  add("Merges", &Row::Merges, 1);
  add("Cuts", &Row::Cuts, 1);
  add("Splits", &Row::Splits, 1);
  add("Collapses", &Row::Collapses, 1);
  add("Flips", &Row::Flips, 1);
  add("EulerCharacteristic", &Row::EulerCharacteristic, 1);
  add("Components", &Row::Components, 1);
  return table;
}
}
