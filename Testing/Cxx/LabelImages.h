// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLabelImages_h
#define volumicLabelImages_h

#include "FilterTestTools.h"
#include "vtkLabelsToSurfaces.h"

#include <vtkCompositeDataSet.h>
#include <vtkInformation.h>
#include <vtkIntArray.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>

/** Tools for tests of vtkLabelsToSurfaces. */
namespace volumic
{
/** A label map with the label that labelAt(i, j, k) names, of any type; `Labels`. */
inline vtkSmartPointer<vtkImageData> LabelImageOf(int nx, int ny, int nz,
  const std::function<double(int, int, int)>& labelAt, int scalarType = VTK_SHORT)
{
  return ImageOf({ nx, ny, nz }, labelAt, scalarType, "Labels");
}

/** Two balls side by side that touch, labels 3 and 7, the first of radius 8 about (11, 14, 14). */
inline double TwoBalls(int i, int j, int k)
{
  return std::hypot(i - 11., j - 14., k - 14.) < 8. ? 3
    : std::hypot(i - 25., j - 14., k - 14.) < 7.    ? 7
                                                    : 0;
}

inline vtkSmartPointer<vtkImageData> BallsImage(int type = VTK_SHORT)
{
  return LabelImageOf(34, 28, 28, TwoBalls, type);
}

/** Names and colours of labels 3 and 7. */
inline void AddNames(vtkImageData* image)
{
  vtkNew<vtkIntArray> values;
  values->SetName("LabelValues");
  values->InsertNextValue(7);
  values->InsertNextValue(3);
  vtkNew<vtkStringArray> names;
  names->SetName("LabelNames");
  names->InsertNextValue("kidney");
  names->InsertNextValue("liver");
  vtkNew<vtkUnsignedCharArray> colors;
  colors->SetName("LabelColors");
  colors->SetNumberOfComponents(3);
  colors->InsertNextTuple3(255, 0, 51);
  colors->InsertNextTuple3(0, 102, 0);
  image->GetFieldData()->AddArray(values);
  image->GetFieldData()->AddArray(names);
  image->GetFieldData()->AddArray(colors);
}

inline vtkSmartPointer<vtkLabelsToSurfaces> LabelSurfacesOf(
  vtkDataObject* input, const std::function<void(vtkLabelsToSurfaces*)>& choose = {})
{
  return choose ? Updated<vtkLabelsToSurfaces>(input, choose) : Updated<vtkLabelsToSurfaces>(input);
}

inline vtkPolyData* BlockOf(vtkLabelsToSurfaces* filter, unsigned int block)
{
  return vtkPolyData::SafeDownCast(filter->GetOutput()->GetBlock(block));
}

inline std::vector<std::string> BlockNames(vtkMultiBlockDataSet* blocks)
{
  std::vector<std::string> names;
  for (unsigned int block = 0; block < blocks->GetNumberOfBlocks(); ++block)
  {
    names.emplace_back(blocks->GetMetaData(block)->Get(vtkCompositeDataSet::NAME()));
  }
  return names;
}
}

#endif
