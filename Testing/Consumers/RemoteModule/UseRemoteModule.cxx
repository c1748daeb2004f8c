// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <vtkImageData.h>
#include <vtkImagePyramid.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>

int main()
{
  vtkNew<vtkImageData> image;
  image->SetDimensions(30, 30, 30);
  image->AllocateScalars(VTK_FLOAT, 1);
  vtkNew<vtkImagePyramid> pyramid;
  pyramid->SetInputData(image);
  pyramid->SetNumberOfLevels(2);
  pyramid->Update();
  return pyramid->GetOutput()->GetNumberOfBlocks() == 2 ? 0 : 1;
}
