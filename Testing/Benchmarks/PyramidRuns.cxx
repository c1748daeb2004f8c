// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// vtkImagePyramid beside VTK's Gaussian + resize and ITK's: one level and all levels, with 1 and 2
// threads, on the same int16 voxels, the repetitions of all by turns. Everything that a program
// allocates and frees for the job counts. Lines: "@time WHO<tab>LEVELS<tab>THREADS", then seconds
// of each repetition. With peak=THREADS instead what memory all levels take beyond the volume.

#include "Benchmark.h"

#include <vtkImageCast.h>
#include <vtkImageGaussianSmooth.h>
#include <vtkImagePyramid.h>
#include <vtkImageResize.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>

#include <array>
#include <chrono>
#include <ctime>
#include <iostream>

namespace volumic::bench
{
namespace
{

using Sizes = std::vector<std::array<int, 3>>;

/** Sizes from level 1 on. @param levels counting level 0; 0 for all */
Sizes RunOurs(vtkImageData* volume, int levels, int threads)
{
  vtkNew<vtkImagePyramid> pyramid;
  pyramid->SetInputData(volume);
  pyramid->SetNumberOfLevels(levels);
  pyramid->SetNumberOfThreads(threads);
  pyramid->Update();
  Sizes sizes;
  for (unsigned int h = 1; h < pyramid->GetOutput()->GetNumberOfBlocks(); ++h)
  {
    const int* size = LevelOf(pyramid, h)->GetDimensions();
    sizes.push_back({ size[0], size[1], size[2] });
  }
  return sizes;
}

void RunVtk(vtkImageData* volume, const Sizes& sizes, int threads)
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
}

/** Prints seconds: with one thread those of the processor, else those of the clock. */
void Time(const std::string& who, const Sizes& sizes, int threads, int times,
  const std::function<void(const Sizes&, int)>& run)
{
  const auto begin = std::chrono::steady_clock::now();
  const std::clock_t processorBegin = std::clock();
  for (int i = 0; i < times; ++i)
  {
    run(sizes, threads);
  }
  const double processor = static_cast<double>(std::clock() - processorBegin) / CLOCKS_PER_SEC;
  const double seconds =
    std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  std::cout << "@time " << who << '\t' << (sizes.size() > 1 ? "all levels" : "one level") << '\t'
            << threads << '\n'
            << (threads == 1 ? processor : seconds) / times << '\n';
}

/** In a process of its own, where no memory has been used and freed. */
void TellPeak(vtkImageData* volume, int threads)
{
  vtkNew<vtkImageData> small; // libraries, threads and their stacks are loaded before it counts
  small->SetDimensions(32, 32, 32);
  small->AllocateScalars(VTK_SHORT, 1);
  RunOurs(small, 0, threads);
  vtkNew<vtkImagePyramid> pyramid;
  pyramid->SetInputData(volume);
  pyramid->SetNumberOfThreads(threads);
  Figures figures;
  Measure([&]() { pyramid->Update(); }, 1, figures);
  double bytes = 0.0;
  for (unsigned int h = 1; h < pyramid->GetOutput()->GetNumberOfBlocks(); ++h)
  {
    bytes += 4.0 * static_cast<double>(LevelOf(pyramid, h)->GetNumberOfPoints());
  }
  figures.Set("Pyramid", bytes);
  figures.Set("Plane", 4.0 * volume->GetDimensions()[0] * volume->GetDimensions()[1]);
  figures.Write();
}

} // namespace

vtkImageData* LevelOf(vtkImagePyramid* pyramid, unsigned int level)
{
  return vtkImageData::SafeDownCast(pyramid->GetOutput()->GetBlock(level));
}

void RunPyramid(const Options& options)
{
  vtkNew<vtkImageCast> cast;
  cast->SetInputData(ReadImage(options.Text("volume")));
  cast->SetOutputScalarTypeToShort();
  cast->Update();
  vtkImageData* volume = cast->GetOutput();
  if (options.Integer("peak", 0) > 0)
  {
    return TellPeak(volume, options.Integer("peak", 1));
  }
  const Sizes all = RunOurs(volume, 0, 1), first(all.begin(), all.begin() + 1);
  for (int i = 0; i < options.Integer("repetitions", 15); ++i)
  {
    for (const int threads : { 1, 2 })
    {
      for (const Sizes& sizes : { first, all })
      {
        // What is quick is repeated: it must not measure the caches that others left.
        Time("vtkImagePyramid", sizes, threads, 6,
          [&](const Sizes& s, int n) { RunOurs(volume, static_cast<int>(s.size()) + 1, n); });
        Time("VTK Gaussian, resize", sizes, threads, 1,
          [&](const Sizes& s, int n) { RunVtk(volume, s, n); });
#if defined(VOLUMIC_BENCHMARK_ITK)
        Time("ITK Gaussian, resample", sizes, threads, 1,
          [&](const Sizes& s, int n) { RunItkPyramid(volume, s, n); });
#endif
      }
    }
  }
}

} // namespace volumic::bench
