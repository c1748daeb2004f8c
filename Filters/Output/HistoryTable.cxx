// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Output/HistoryTable.h"

#include <vtkDoubleArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkTable.h>

#include <type_traits>
#include <variant>

namespace volumic
{
namespace
{
struct Column
{
  const char* Name;
  std::variant<int HistoryRow::*, double HistoryRow::*> Member;
};

const Column Columns[] = { { "Iteration", &HistoryRow::Iteration }, { "Level", &HistoryRow::Level },
  { "Vertices", &HistoryRow::Vertices }, { "KineticEnergy", &HistoryRow::KineticEnergy },
  { "MeanEdgeLength", &HistoryRow::MeanEdgeLength }, { "Seconds", &HistoryRow::Seconds },
  { "TimeStep", &HistoryRow::TimeStep }, { "ActiveVertices", &HistoryRow::ActiveVertices },
  { "Merges", &HistoryRow::Merges }, { "Cuts", &HistoryRow::Cuts },
  { "Splits", &HistoryRow::Splits }, { "Collapses", &HistoryRow::Collapses },
  { "Flips", &HistoryRow::Flips }, { "EulerCharacteristic", &HistoryRow::EulerCharacteristic },
  { "Components", &HistoryRow::Components } };
}

vtkSmartPointer<vtkTable> MakeHistoryTable(std::vector<HistoryRow> rows, int last, double unit)
{
  auto table = vtkSmartPointer<vtkTable>::New();
  const auto add = [&](const char* name, auto member)
  {
    using Value = std::decay_t<decltype(HistoryRow().*member)>;
    vtkNew<std::conditional_t<std::is_same_v<Value, int>, vtkIntArray, vtkDoubleArray>> column;
    column->SetName(name);
    for (const HistoryRow& row : rows)
    {
      if (row.Level >= last)
      {
        column->InsertNextValue(row.*member);
      }
    }
    table->AddColumn(column);
  };
  for (HistoryRow& row : rows)
  {
    row.MeanEdgeLength *= unit;
  }
  for (const Column& column : Columns)
  {
    std::visit([&](auto member) { add(column.Name, member); }, column.Member);
  }
  return table;
}
}
