// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkVolumicLabelList
 * @brief   vtkLabelTable, for a client that cannot see its output
 *
 * The columns of the table as arrays. It is run for a panel, before anybody has asked for a
 * surface: what is wrong with the input is no error here, but a text.
 */
#ifndef vtkVolumicLabelList_h
#define vtkVolumicLabelList_h

#include "vtkLabelTable.h"
#include "vtkServerManagerVolumicModule.h" // For export macro

#include <string> // For the problem

class vtkDoubleArray;
class vtkIdTypeArray;
class vtkIntArray;
class vtkStringArray;

class VTKSERVERMANAGERVOLUMIC_EXPORT vtkVolumicLabelList : public vtkLabelTable
{
public:
  static vtkVolumicLabelList* New();
  vtkTypeMacro(vtkVolumicLabelList, vtkLabelTable);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /** Of the last run, an entry (a colour: three) per label; null: there is none. */
  vtkIntArray* GetLabels();
  vtkStringArray* GetNames();
  vtkIdTypeArray* GetVoxels();
  vtkDoubleArray* GetColors();
  ///@}

  /** What was wrong with the input; empty: nothing. */
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

  std::string Problem;
};

#endif
