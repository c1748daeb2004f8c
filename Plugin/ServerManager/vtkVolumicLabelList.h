// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkVolumicLabelList
 * @brief   vtkLabelTable, for a client that cannot see its output
 *
 * The input is a label map, or what vtkLabelsToSurfaces puts out: then the labels are those in the
 * field data of the blocks. It is run for a panel, before a surface is requested: what is wrong with
 * the input is no error here, but a text.
 */
#ifndef vtkVolumicLabelList_h
#define vtkVolumicLabelList_h

#include "vtkLabelTable.h"
#include "vtkNew.h"
#include "vtkServerManagerVolumicModule.h" // For export macro

#include <string> // For the problem

class vtkStringArray;

class VTKSERVERMANAGERVOLUMIC_EXPORT vtkVolumicLabelList : public vtkLabelTable
{
public:
  static vtkVolumicLabelList* New();
  vtkTypeMacro(vtkVolumicLabelList, vtkLabelTable);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /** Return label, name, number of voxels, red, green and blue of each label of the last run. */
  vtkStringArray* GetRows();

  /** Return what was wrong with the input; empty: nothing. */
  const char* GetProblem();

protected:
  vtkVolumicLabelList();
  ~vtkVolumicLabelList() override;

  int RequestData(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;

private:
  vtkVolumicLabelList(const vtkVolumicLabelList&) = delete;
  void operator=(const vtkVolumicLabelList&) = delete;

  void OnMessage(vtkObject* caller, unsigned long event, void* text);

  vtkNew<vtkStringArray> Rows;
  std::string Problem;
};

#endif
