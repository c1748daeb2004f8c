// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLabelImages_h
#define volumicLabelImages_h

#include "FilterTestTools.h"
#include "vtkLabelsToSurfaces.h"

#include <vtkCompositeDataSet.h>
#include <vtkInformation.h>
#include <vtkPolyData.h>

/** What the tests of vtkLabelsToSurfaces share. */
namespace volumic
{
/** A label map with the label that labelAt(i, j, k) names, of any type; `Labels`. */
inline vtkSmartPointer<vtkImageData> LabelImageOf(int nx, int ny, int nz,
  const std::function<double(int, int, int)>& labelAt, int scalarType = VTK_SHORT)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(nx, ny, nz);
  image->AllocateScalars(scalarType, 1);
  vtkDataArray* voxels = image->GetPointData()->GetScalars();
  voxels->SetName("Labels");
  vtkIdType index = 0;
  ForVoxels({ nx, ny, nz },
    [&](int i, int j, int k)
    {
      voxels->SetComponent(index, 0, labelAt(i, j, k));
      ++index;
    });
  return image;
}

/** Two balls side by side that touch, labels 3 and 7, the first of radius 8 about (11, 14, 14). */
inline double TwoBalls(int i, int j, int k)
{
  return std::hypot(i - 11., j - 14., k - 14.) < 8. ? 3
    : std::hypot(i - 25., j - 14., k - 14.) < 7.    ? 7
                                                    : 0;
}

/** The updated filter. */
inline vtkSmartPointer<vtkLabelsToSurfaces> LabelSurfacesOf(vtkDataObject* input)
{
  auto filter = vtkSmartPointer<vtkLabelsToSurfaces>::New();
  filter->SetInputDataObject(input);
  filter->Update();
  return filter;
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
