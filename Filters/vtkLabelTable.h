// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkLabelTable
 * @brief   which labels a label map has
 *
 * vtkLabelTable lists the labels of an image, for those who choose some of them for
 * vtkLabelsToSurfaces.
 *
 * @par Input:
 * Port 0: as vtkLabelsToSurfaces.
 *
 * @par Output:
 * A vtkTable with a row per label, in the order of their values: `Label` (int), `Name` (string: the
 * one that comes with the image, or `Label 3`), `Voxels` (vtkIdType), `Extent` (int, 6 components:
 * indices of its first and last voxels along x, y and z, as an extent of the image), `Color`
 * (double, 3 components, 0 to 1: that which comes with the image, or one of a fixed palette).
 *
 * @par Errors:
 * As vtkLabelsToSurfaces.
 *
 * @sa
 * vtkLabelsToSurfaces
 */
#ifndef vtkLabelTable_h
#define vtkLabelTable_h

#include "vtkFiltersVolumicModule.h" // For export macro
#include "vtkTableAlgorithm.h"

class VTKFILTERSVOLUMIC_EXPORT vtkLabelTable : public vtkTableAlgorithm
{
public:
  static vtkLabelTable* New();
  vtkTypeMacro(vtkLabelTable, vtkTableAlgorithm);

protected:
  vtkLabelTable() = default;
  ~vtkLabelTable() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestUpdateExtent(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;
  int RequestData(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;

private:
  vtkLabelTable(const vtkLabelTable&) = delete;
  void operator=(const vtkLabelTable&) = delete;
};

#endif
