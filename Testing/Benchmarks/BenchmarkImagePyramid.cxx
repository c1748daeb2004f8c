// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * vtkImagePyramid against VTK's Gaussian + resize and, where it was found, ITK's: one level and all
 * levels, with 1 and 2 threads, on the same int16 voxels, in one run with the repetitions of all in
 * random order. Everything that a program allocates and frees for the job counts.
 * benchmark_pyramid.py makes the tables.
 *
 *     BenchmarkImagePyramid [--volume FILE.vti | --generate SIZE] [--repetitions N]
 *                           [--peak-memory THREADS | OPTION OF GOOGLE BENCHMARK]...
 */

#include "BenchmarkVolume.h"
#include "PeakMemory.h"
#include "PyramidPeers.h"

#include <vtkImagePyramid.h>

#include <vtkImageData.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>

#include <benchmark/benchmark.h>

#include <cstdint>
#include <cstdio>
#include <exception>
#include <functional>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

using namespace volumic::bench;

namespace
{

struct Options
{
  std::string Volume;
  int GeneratedSize = 512;
  int Repetitions = 9;
  int PeakMemoryThreads = 0; ///< over 0: this process only measures memory
  std::vector<char*> Others; ///< for Google Benchmark
};

Options ParseOptions(int argc, char** argv)
{
  Options options;
  options.Others.push_back(argv[0]);
  for (int i = 1; i < argc; ++i)
  {
    const std::string name = argv[i];
    const bool known = name == "--volume" || name == "--generate" || name == "--repetitions" ||
      name == "--peak-memory";
    if (!known)
    {
      options.Others.push_back(argv[i]);
      continue;
    }
    if (++i == argc)
    {
      throw std::invalid_argument(name + " wants a value");
    }
    if (name == "--volume")
    {
      options.Volume = argv[i];
      continue;
    }
    const int value = std::stoi(argv[i]);
    if (value < 1)
    {
      throw std::invalid_argument(name + " wants a positive number");
    }
    (name == "--generate"         ? options.GeneratedSize
        : name == "--repetitions" ? options.Repetitions
                                  : options.PeakMemoryThreads) = value;
  }
  return options;
}

/** @param levels counting level 0; 0 for all */
void RunOurPyramid(vtkImageData* volume, int levels, int threads)
{
  vtkNew<vtkImagePyramid> pyramid;
  pyramid->SetInputData(volume);
  pyramid->SetNumberOfLevels(levels);
  pyramid->SetNumberOfThreads(threads);
  pyramid->Update();
  benchmark::DoNotOptimize(pyramid->GetOutput()->GetNumberOfBlocks());
}

/** Sizes from level 1 on, so that the others make the same ones. */
LevelSizes SizesOfLevels(vtkImageData* volume)
{
  vtkNew<vtkImagePyramid> pyramid;
  pyramid->SetInputData(volume);
  pyramid->Update();
  LevelSizes sizes;
  for (unsigned int h = 1; h < pyramid->GetOutput()->GetNumberOfBlocks(); ++h)
  {
    const int* dimensions =
      vtkImageData::SafeDownCast(pyramid->GetOutput()->GetBlock(h))->GetDimensions();
    sizes.push_back({ dimensions[0], dimensions[1], dimensions[2] });
  }
  if (sizes.empty())
  {
    throw std::runtime_error("the volume is too small for a second level");
  }
  return sizes;
}

//------------------------------------------------------------------------------
struct Contender
{
  std::string Name;
  bool HasAllLevels;
  int Iterations; ///< per repetition: what is quick must not measure the caches that others left
  std::function<void(const LevelSizes&, int threads)> Run;
};

std::vector<Contender> Contenders(vtkImageData* volume)
{
  std::vector<Contender> contenders;
  const auto copy = std::make_shared<std::vector<std::int16_t>>(
    static_cast<std::size_t>(volume->GetNumberOfPoints()));
  contenders.push_back({ "copying the voxels", false, 20,
    [volume, copy](const LevelSizes&, int threads) { RunCopy(volume, *copy, threads); } });
  contenders.push_back({ "vtkImagePyramid", true, 6,
    [volume](const LevelSizes& sizes, int threads)
    { RunOurPyramid(volume, static_cast<int>(sizes.size()) + 1, threads); } });
  contenders.push_back({ "VTK Gaussian + resize", true, 1,
    [volume](const LevelSizes& sizes, int threads) { RunVtkPyramid(volume, sizes, threads); } });
#ifdef VOLUMIC_BENCHMARK_ITK
  contenders.push_back({ "ITK Gaussian + resample", true, 1,
    [volume](const LevelSizes& sizes, int threads) { RunItkPyramid(volume, sizes, threads); } });
#endif
  return contenders;
}

std::string RunName(const std::string& contender, bool allLevels, int threads)
{
  return contender + (allLevels ? ", all levels, " : ", one level, ") + std::to_string(threads) +
    (threads == 1 ? " thread" : " threads");
}

void Register(const std::vector<Contender>& contenders, const LevelSizes& sizes, int repetitions)
{
  const LevelSizes first(sizes.begin(), sizes.begin() + 1);
  for (const Contender& contender : contenders)
  {
    for (const bool allLevels : { false, true })
    {
      for (const int threads : { 1, 2 })
      {
        if (allLevels && !contender.HasAllLevels)
        {
          continue;
        }
        const auto work = contender.Run;
        const LevelSizes& wanted = allLevels ? sizes : first;
        benchmark::RegisterBenchmark(RunName(contender.Name, allLevels, threads).c_str(),
          [work, wanted, threads](benchmark::State& state)
          {
            for (auto _ : state)
            {
              work(wanted, threads);
            }
          })
          ->Iterations(contender.Iterations)
          ->Repetitions(repetitions)
          ->MeasureProcessCPUTime()
          ->UseRealTime()
          ->Unit(benchmark::kMillisecond);
      }
    }
  }
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkImageData> MakeVolume(const Options& options)
{
  return options.Volume.empty() ? GenerateVolume(options.GeneratedSize)
                                : ReadVolume(options.Volume);
}

/** Prints the growth of memory by the whole pyramid, the bytes of its levels from 1 on, the size. */
int MeasureMemory(const Options& options)
{
  const vtkSmartPointer<vtkImageData> volume = MakeVolume(options);
  // Libraries, threads and their stacks are loaded before it counts.
  RunOurPyramid(GenerateVolume(32), 0, options.PeakMemoryThreads);
  vtkNew<vtkImagePyramid> pyramid;
  pyramid->SetInputData(volume);
  pyramid->SetNumberOfThreads(options.PeakMemoryThreads);
  const long long growth = PeakGrowth([&]() { pyramid->Update(); });
  long long bytes = 0;
  for (unsigned int h = 1; h < pyramid->GetOutput()->GetNumberOfBlocks(); ++h)
  {
    bytes += static_cast<long long>(sizeof(float)) *
      vtkImageData::SafeDownCast(pyramid->GetOutput()->GetBlock(h))->GetNumberOfPoints();
  }
  const int* size = volume->GetDimensions();
  std::printf("%lld %lld %d %d %d\n", growth, bytes, size[0], size[1], size[2]);
  return growth < 0;
}

int Main(int argc, char** argv)
{
  Options options = ParseOptions(argc, argv);
  if (options.PeakMemoryThreads > 0)
  {
    return MeasureMemory(options);
  }

  // Interleaved unless the command line says otherwise: the last one counts.
  static char interleaving[] = "--benchmark_enable_random_interleaving=true";
  options.Others.insert(options.Others.begin() + 1, interleaving);
  int count = static_cast<int>(options.Others.size());
  benchmark::Initialize(&count, options.Others.data());
  if (benchmark::ReportUnrecognizedArguments(count, options.Others.data()))
  {
    return 1;
  }

  const vtkSmartPointer<vtkImageData> volume = MakeVolume(options);
  const LevelSizes sizes = SizesOfLevels(volume);
  const std::vector<Contender> contenders = Contenders(volume);
  std::printf("\n%s: %d x %d x %d int16, %zu levels above it\n",
    options.Volume.empty() ? "Generated volume" : options.Volume.c_str(),
    volume->GetDimensions()[0], volume->GetDimensions()[1], volume->GetDimensions()[2],
    sizes.size());
  std::fflush(stdout);

  Register(contenders, sizes, options.Repetitions);
  return benchmark::RunSpecifiedBenchmarks() == 0;
}

} // namespace

int main(int argc, char** argv)
{
  try
  {
    return Main(argc, argv);
  }
  catch (const std::exception& error)
  {
    std::cerr << argv[0] << ": " << error.what() << std::endl;
    return 1;
  }
}
