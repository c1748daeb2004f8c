// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkVolumicLabelList
 * @brief   the labels of a label map or of surfaces, as strings for a client
 *
 * The input is a label map, or the output of vtkLabelsToSurfaces, whose labels are in the field
 * data of the blocks. The panel runs this filter before Apply. Therefore an invalid input is not an
 * error here: GetProblem() returns the message.
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

  /** Return the error message about the input; empty if it is valid. */
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
