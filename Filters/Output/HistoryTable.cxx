// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Output/HistoryTable.h"

#include <vtkDoubleArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkTable.h>

#include <cstddef>
#include <string>
#include <vector>

namespace volumic
{
namespace
{
/** What one column of seconds is the sum of. */
struct PhaseColumn
{
  const char* Name;
  std::vector<Phase> Phases;
};

const PhaseColumn PhaseColumns[] = {
  { "Forces", { Phase::Forces } },
  { "Contact", { Phase::Contact } },
  { "Proximity", { Phase::Proximity } },
  { "Verification", { Phase::Verification } },
  { "Remeshing", { Phase::Remeshing } },
  { "Topology", { Phase::Topology } },
  { "Division", { Phase::Division, Phase::Recovery, Phase::Regularisation } },
  { "Recovery", { Phase::Recovery } },
  { "Regularisation", { Phase::Regularisation } },
};

template <typename Array, typename Get>
void AddColumn(
  vtkTable* table, const char* name, const std::vector<HistoryRow>& rows, const Get& get)
{
  vtkNew<Array> column;
  column->SetName(name);
  column->SetNumberOfTuples(static_cast<vtkIdType>(rows.size()));
  for (std::size_t r = 0; r < rows.size(); ++r)
  {
    column->SetValue(static_cast<vtkIdType>(r), get(rows[r]));
  }
  table->AddColumn(column);
}

void AddPhases(vtkTable* table, const std::vector<HistoryRow>& rows)
{
  for (const PhaseColumn& column : PhaseColumns)
  {
    AddColumn<vtkDoubleArray>(table, (std::string(column.Name) + "Seconds").c_str(), rows,
      [&](const HistoryRow& row)
      {
        double sum = 0.0;
        for (const Phase phase : column.Phases)
        {
          sum += row.PhaseSeconds[static_cast<std::size_t>(phase)];
        }
        return sum;
      });
  }
}
}

vtkSmartPointer<vtkTable> MakeHistory(
  const std::vector<HistoryRow>& rows, const Workspace& space, bool withPhases)
{
  using Row = HistoryRow;
  const double unit = space.WorldUnit();
  auto table = vtkSmartPointer<vtkTable>::New();
  AddColumn<vtkIntArray>(table, "Iteration", rows, [](const Row& r) { return r.Iteration; });
  AddColumn<vtkIntArray>(table, "Level", rows, [](const Row& r) { return r.Level; });
  AddColumn<vtkIntArray>(table, "Vertices", rows, [](const Row& r) { return r.Vertices; });
  AddColumn<vtkDoubleArray>(
    table, "KineticEnergy", rows, [](const Row& r) { return r.KineticEnergy; });
  AddColumn<vtkDoubleArray>(
    table, "MeanEdgeLength", rows, [unit](const Row& r) { return r.MeanEdgeLength * unit; });
  AddColumn<vtkDoubleArray>(table, "Seconds", rows, [](const Row& r) { return r.Seconds; });
  AddColumn<vtkDoubleArray>(table, "TimeStep", rows, [](const Row& r) { return r.TimeStep; });
  AddColumn<vtkIntArray>(
    table, "ActiveVertices", rows, [](const Row& r) { return r.ActiveVertices; });
  AddColumn<vtkIntArray>(table, "Merges", rows, [](const Row& r) { return r.Merges; });
  AddColumn<vtkIntArray>(table, "Cuts", rows, [](const Row& r) { return r.Cuts; });
  AddColumn<vtkIntArray>(table, "Splits", rows, [](const Row& r) { return r.Splits; });
  AddColumn<vtkIntArray>(table, "Collapses", rows, [](const Row& r) { return r.Collapses; });
  AddColumn<vtkIntArray>(table, "Flips", rows, [](const Row& r) { return r.Flips; });
  AddColumn<vtkIntArray>(
    table, "EulerCharacteristic", rows, [](const Row& r) { return r.EulerCharacteristic; });
  AddColumn<vtkIntArray>(table, "Components", rows, [](const Row& r) { return r.Components; });
  AddColumn<vtkIntArray>(table, "RecoveredParts", rows, [](const Row& r) { return r.Recovered; });
  AddColumn<vtkIntArray>(table, "Deletions", rows, [](const Row& r) { return r.Deletions; });
  AddColumn<vtkIntArray>(table, "DeletedGenus", rows, [](const Row& r) { return r.DeletedGenus; });
  AddColumn<vtkIntArray>(table, "AddedEulerCharacteristic", rows,
    [](const Row& r) { return r.AddedEulerCharacteristic; });
  AddColumn<vtkIntArray>(
    table, "IterationVertices", rows, [](const Row& r) { return r.IterationVertices; });
  AddColumn<vtkDoubleArray>(table, "IterationMeanEdgeLength", rows,
    [unit](const Row& r) { return r.IterationMeanEdgeLength * unit; });
  AddColumn<vtkIntArray>(table, "IterationEulerCharacteristic", rows,
    [](const Row& r) { return r.IterationEulerCharacteristic; });
  AddColumn<vtkIntArray>(
    table, "IterationComponents", rows, [](const Row& r) { return r.IterationComponents; });
  AddColumn<vtkIntArray>(
    table, "RegularisationCuts", rows, [](const Row& r) { return r.RegularisationCuts; });
  AddColumn<vtkIntArray>(
    table, "RegularisationDeletions", rows, [](const Row& r) { return r.RegularisationDeletions; });
  AddColumn<vtkDoubleArray>(
    table, "SecondsBefore", rows, [](const Row& r) { return r.SecondsBefore; });
  AddColumn<vtkDoubleArray>(
    table, "SecondsAfter", rows, [](const Row& r) { return r.SecondsAfter; });
  if (withPhases)
  {
    AddPhases(table, rows);
  }
  return table;
}
}
