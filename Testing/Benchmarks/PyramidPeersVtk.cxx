// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "PyramidPeers.h"

#include <vtkImageData.h>
#include <vtkImageGaussianSmooth.h>
#include <vtkImageResize.h>
#include <vtkNew.h>
#include <vtkSMPTools.h>
#include <vtkSmartPointer.h>

#include <benchmark/benchmark.h>

#include <cstring>

namespace volumic::bench
{

void RunVtkPyramid(vtkImageData* volume, const LevelSizes& sizes, int threads)
{
  vtkSmartPointer<vtkImageData> level = volume;
  for (const auto& size : sizes)
  {
    vtkNew<vtkImageGaussianSmooth> smooth;
    smooth->SetInputData(level);
    smooth->SetStandardDeviation(1.0);
    smooth->SetRadiusFactor(2.0); // two voxels to either side
    smooth->SetNumberOfThreads(threads);
    vtkNew<vtkImageResize> resize;
    resize->SetInputConnection(smooth->GetOutputPort());
    resize->SetResizeMethodToOutputDimensions();
    resize->SetOutputDimensions(size[0], size[1], size[2]);
    resize->SetNumberOfThreads(threads);
    resize->Update();
    level = resize->GetOutput();
  }
  benchmark::DoNotOptimize(level->GetScalarPointer());
}

void RunCopy(vtkImageData* volume, std::vector<std::int16_t>& copy, int threads)
{
  const std::size_t count = copy.size();
  const auto* from = static_cast<const std::int16_t*>(volume->GetScalarPointer());
  vtkSMPTools::LocalScope(vtkSMPTools::Config(threads),
    [&]()
    {
      vtkSMPTools::For(0, threads,
        [&](vtkIdType begin, vtkIdType end)
        {
          const std::size_t first = count * begin / threads, last = count * end / threads;
          std::memcpy(copy.data() + first, from + first, (last - first) * sizeof(std::int16_t));
        });
    });
  benchmark::DoNotOptimize(copy.data());
  benchmark::ClobberMemory();
}

} // namespace volumic::bench
