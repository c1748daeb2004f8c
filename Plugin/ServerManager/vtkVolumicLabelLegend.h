// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkVolumicLabelLegend
 * @brief   the labels of surfaces, with names and colours, for the client that displays them
 *
 * The input is what vtkLabelsToSurfaces puts out: the field data of its blocks are read. The output
 * is a table with a row per label, in the order of the blocks: `Label`, `Name`, `Color`.
 */
#ifndef vtkVolumicLabelLegend_h
#define vtkVolumicLabelLegend_h

#include "vtkServerManagerVolumicModule.h" // For export macro
#include "vtkTableAlgorithm.h"

class vtkDoubleArray;
class vtkIntArray;
class vtkStringArray;

class VTKSERVERMANAGERVOLUMIC_EXPORT vtkVolumicLabelLegend : public vtkTableAlgorithm
{
public:
  static vtkVolumicLabelLegend* New();
  vtkTypeMacro(vtkVolumicLabelLegend, vtkTableAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /** Of the last run, an entry (a colour: three) per label; null: there was none. */
  vtkIntArray* GetLabels();
  vtkStringArray* GetNames();
  vtkDoubleArray* GetColors();
  ///@}

protected:
  vtkVolumicLabelLegend();
  ~vtkVolumicLabelLegend() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;

private:
  vtkVolumicLabelLegend(const vtkVolumicLabelLegend&) = delete;
  void operator=(const vtkVolumicLabelLegend&) = delete;
};

#endif
