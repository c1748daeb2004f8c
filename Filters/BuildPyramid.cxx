// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BuildPyramid.h"

#include "AlgorithmErrors.h"
#include "Core/Refuse.h"
#include "vtkImagePyramid.h"

#include <vtkErrorCode.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>

#include <stdexcept>

namespace volumic
{
vtkSmartPointer<vtkMultiBlockDataSet> BuildPyramid(
  vtkImagePyramid* pyramid, vtkImageData* image, vtkInformation* selection)
{
  pyramid->SetInputData(image);
  pyramid->SetInputArrayToProcess(0, selection);
  const std::string errors = UpdateAndCollectErrors(pyramid);
  if (!errors.empty() && pyramid->GetErrorCode() == vtkErrorCode::UnknownError)
  {
    throw std::runtime_error(errors);
  }
  if (!errors.empty())
  {
    Refuse(errors);
  }
  return pyramid->GetOutput();
}
}
