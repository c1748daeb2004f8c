// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkLabelTable
 * @brief   list the labels of a label map
 *
 * vtkLabelTable lists the labels of an image with names, sizes, extents and colors.
 *
 * @par Input:
 * Port 0: a label map, as for vtkLabelsToSurfaces.
 *
 * @par Output:
 * Port 0: a vtkTable with a row per label, sorted by label, and the columns
 * - `Label` (int)
 * - `Name` (string): the name in the image, or `Label 3`
 * - `Voxels` (vtkIdType): number of voxels
 * - `Extent` (int, 6): indices of the first and last voxels along x, y and z
 * - `Color` (double, 3, 0 to 1): the color in the image, or a color of a fixed palette
 *
 * @par Errors:
 * On error the filter invokes `ErrorEvent`, produces an empty table and sets GetErrorCode().
 *
 * @par Processes:
 * In a parallel run the processes other than the first (piece 0) have an empty table.
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
