// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkVolumicHistoryRepresentation.h"

#include <vtkAxis.h>
#include <vtkChartXY.h>
#include <vtkContextMapper2D.h>
#include <vtkDoubleArray.h>
#include <vtkMath.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPVView.h>
#include <vtkPlot.h>
#include <vtkTable.h>

#include <algorithm>

vtkStandardNewMacro(vtkVolumicHistoryRepresentation);

namespace
{
bool HasPlaceOn(vtkAxis* axis, double value)
{
  return !axis->GetLogScale() || value > 0.0;
}
}

//------------------------------------------------------------------------------
vtkVolumicHistoryRepresentation::vtkVolumicHistoryRepresentation() = default;
vtkVolumicHistoryRepresentation::~vtkVolumicHistoryRepresentation() = default;

//------------------------------------------------------------------------------
unsigned int vtkVolumicHistoryRepresentation::FindLogarithmicAxes()
{
  unsigned int axes = 0;
  if (vtkChartXY* chart = this->GetChart())
  {
    for (int i = 0; i < chart->GetNumberOfAxes(); ++i)
    {
      axes |= chart->GetAxis(i)->GetLogScale() ? 1u << i : 0u;
    }
  }
  return axes;
}

//------------------------------------------------------------------------------
int vtkVolumicHistoryRepresentation::ProcessViewRequest(
  vtkInformationRequestKey* request, vtkInformation* inInfo, vtkInformation* outInfo)
{
  const int succeeded = this->Superclass::ProcessViewRequest(request, inInfo, outInfo);
  // An axis belongs to the view, which tells nobody when it becomes logarithmic or linear.
  if (succeeded && request == vtkPVView::REQUEST_RENDER() && this->GetChart() &&
    this->LogarithmicAxes != this->FindLogarithmicAxes())
  {
    this->PrepareForRendering();
  }
  return succeeded;
}

//------------------------------------------------------------------------------
void vtkVolumicHistoryRepresentation::PrepareForRendering()
{
  this->Superclass::PrepareForRendering();
  this->LogarithmicAxes = this->FindLogarithmicAxes();
  vtkChartRepresentation::MapOfTables tables;
  if (!this->GetLocalOutput(tables))
  {
    return;
  }
  vtkChartXY* chart = this->GetChart();
  for (vtkIdType p = 0; p < chart->GetNumberOfPlots(); ++p)
  {
    vtkPlot* plot = chart->GetPlot(p);
    // A chart may show the curves of others as well.
    const bool isOurs = std::any_of(tables.begin(), tables.end(),
      [plot](const auto& table) { return table.second.first == plot->GetInput(); });
    if (!isOurs || !plot->GetVisible())
    {
      continue;
    }
    if (plot->GetInput()->GetNumberOfRows() < 2)
    {
      // VTK takes a line of one point for an error.
      plot->SetVisible(false);
    }
    else if (plot->GetXAxis()->GetLogScale() || plot->GetYAxis()->GetLogScale())
    {
      LeaveOutWhatHasNoLogarithm(plot);
    }
  }
  if (this->LogarithmicAxes != 0)
  {
    chart->RecalculateBounds();
  }
}

//------------------------------------------------------------------------------
void vtkVolumicHistoryRepresentation::LeaveOutWhatHasNoLogarithm(vtkPlot* plot)
{
  vtkTable* table = plot->GetInput();
  vtkDataArray* y = plot->GetData()->GetInputArrayToProcess(1, table);
  vtkDataArray* x =
    plot->GetUseIndexForXSeries() ? nullptr : plot->GetData()->GetInputArrayToProcess(0, table);
  if (!y || y->GetNumberOfComponents() != 1)
  {
    return;
  }
  vtkNew<vtkDoubleArray> shown;
  shown->SetName(y->GetName());
  shown->SetNumberOfTuples(y->GetNumberOfTuples());
  bool isAnyShown = false;
  for (vtkIdType row = 0; row < y->GetNumberOfTuples(); ++row)
  {
    const double value = y->GetComponent(row, 0);
    const bool isShown = HasPlaceOn(plot->GetYAxis(), value) &&
      HasPlaceOn(plot->GetXAxis(), x ? x->GetComponent(row, 0) : static_cast<double>(row));
    shown->SetValue(row, isShown ? value : vtkMath::Nan());
    isAnyShown = isAnyShown || isShown;
  }
  if (!isAnyShown)
  {
    plot->SetVisible(false);
    return;
  }
  vtkNew<vtkTable> ofPlot;
  if (x && x != y)
  {
    ofPlot->AddColumn(x);
  }
  ofPlot->AddColumn(shown);
  // The plot finds its columns by their names, as before.
  plot->SetInputData(ofPlot);
}

//------------------------------------------------------------------------------
void vtkVolumicHistoryRepresentation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}
