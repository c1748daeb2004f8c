# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause

# What the compiler reads once per target, not once per file: headers of others that most files
# include. A file includes what it uses all the same.

set(volumic_standard_headers
  <algorithm>
  <array>
  <atomic>
  <cmath>
  <cstddef>
  <cstdint>
  <cstring>
  <functional>
  <limits>
  <map>
  <memory>
  <mutex>
  <numeric>
  <optional>
  <stdexcept>
  <string>
  <unordered_map>
  <utility>
  <vector>)
set(volumic_vtk_headers
  <vtkCellArray.h>
  <vtkCellData.h>
  <vtkDataArray.h>
  <vtkDoubleArray.h>
  <vtkFieldData.h>
  <vtkImageData.h>
  <vtkInformation.h>
  <vtkInformationVector.h>
  <vtkMultiBlockDataSet.h>
  <vtkNew.h>
  <vtkObjectFactory.h>
  <vtkPointData.h>
  <vtkPoints.h>
  <vtkPolyData.h>
  <vtkSmartPointer.h>
  <vtkStreamingDemandDrivenPipeline.h>
  <vtkStringArray.h>
  <vtkTable.h>)
