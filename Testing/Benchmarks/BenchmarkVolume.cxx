// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "BenchmarkVolume.h"

#include <vtkImageCast.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkXMLImageDataReader.h>

#include <cstdint>
#include <stdexcept>

namespace volumic::bench
{

vtkSmartPointer<vtkImageData> ReadVolume(const std::string& file)
{
  vtkNew<vtkXMLImageDataReader> reader;
  if (!reader->CanReadFile(file.c_str()))
  {
    throw std::runtime_error(file + ": not a readable .vti file");
  }
  reader->SetFileName(file.c_str());
  reader->Update();
  if (!reader->GetOutput()->GetPointData()->GetScalars())
  {
    throw std::runtime_error(file + ": has no point scalars");
  }
  double range[2];
  reader->GetOutput()->GetScalarRange(range);
  if (range[0] < -32768.0 || range[1] > 32767.0)
  {
    throw std::runtime_error(file + ": has values that do not fit into 16 bits");
  }
  vtkNew<vtkImageCast> cast;
  cast->SetInputConnection(reader->GetOutputPort());
  cast->SetOutputScalarTypeToShort();
  cast->Update();
  return cast->GetOutput();
}

vtkSmartPointer<vtkImageData> GenerateVolume(int size)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(size, size, size);
  image->AllocateScalars(VTK_SHORT, 1);
  auto* voxel = static_cast<std::int16_t*>(image->GetScalarPointer());
  std::uint32_t random = 1;
  for (int k = 0; k < size; ++k)
  {
    for (int j = 0; j < size; ++j)
    {
      for (int i = 0; i < size; ++i, ++voxel)
      {
        const std::int64_t x = 2 * i - size, y = 2 * j - size, z = 2 * k - size;
        const bool shell =
          (x * x + y * y + z * z) * 8 / (static_cast<std::int64_t>(size) * size) % 2;
        random = random * 1664525u + 1013904223u;
        *voxel = static_cast<std::int16_t>((shell ? 1000 : -1000) + static_cast<int>(random >> 25));
      }
    }
  }
  return image;
}

} // namespace volumic::bench
