// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkVolumicHistoryRepresentation
 * @brief   curves of a table, with gaps where a logarithmic axis has no place for a value
 *
 * ParaView's chart hides behind a warning as long as a curve on a logarithmic axis has a value that
 * isn't positive: a level whose surface vanished has no vertices, a fast iteration takes 0 seconds.
 * Here such values are left out of the curve, and a curve of nothing else is left out of the chart;
 * on a linear axis all are drawn. The table stays as it is.
 */
#ifndef vtkVolumicHistoryRepresentation_h
#define vtkVolumicHistoryRepresentation_h

#include "vtkServerManagerVolumicModule.h" // For export macro
#include "vtkXYChartRepresentation.h"

class vtkPlot;

class VTKSERVERMANAGERVOLUMIC_EXPORT vtkVolumicHistoryRepresentation
  : public vtkXYChartRepresentation
{
public:
  static vtkVolumicHistoryRepresentation* New();
  vtkTypeMacro(vtkVolumicHistoryRepresentation, vtkXYChartRepresentation);
  void PrintSelf(ostream& os, vtkIndent indent) override;

protected:
  vtkVolumicHistoryRepresentation();
  ~vtkVolumicHistoryRepresentation() override;

  int ProcessViewRequest(vtkInformationRequestKey* request, vtkInformation* inInfo,
    vtkInformation* outInfo) override;
  void PrepareForRendering() override;

private:
  vtkVolumicHistoryRepresentation(const vtkVolumicHistoryRepresentation&) = delete;
  void operator=(const vtkVolumicHistoryRepresentation&) = delete;

  /** A bit for each axis of the chart that the user wants logarithmic. */
  unsigned int FindLogarithmicAxes();
  static void LeaveOutWhatHasNoLogarithm(vtkPlot* plot);

  /** Those that the curves have been prepared for. */
  unsigned int LogarithmicAxes = 0;
};

#endif
