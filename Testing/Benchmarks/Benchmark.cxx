// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Runs us and what else there is, measures and judges both; benchmark.py, which starts this
 * program, makes the tables.
 *
 *     Benchmark surface run=NAME volume=FILE.vti iso=VALUE [NAME=VALUE]...
 *     Benchmark pyramid volume=FILE.vti [repetitions=N] [peak=THREADS]
 *
 * See SurfaceRuns.cxx, PyramidRuns.cxx.
 */

#include "Benchmark.h"

#include <vtkDataArray.h>
#include <vtkNIFTIImageReader.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkXMLImageDataReader.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <fstream>
#include <iostream>
#include <limits>
#include <sstream>
#include <stdexcept>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace volumic::bench
{
namespace
{

/** A line of /proc/self/status, in bytes; -1 without it. */
long long StatusBytes(const std::string& name)
{
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
  {
    if (word == name + ":")
    {
      long long kilobytes = -1;
      return status >> kilobytes ? kilobytes * 1024 : -1;
    }
  }
  return -1;
}

/** The peak starts again from what is resident now, which is returned; -1 where it cannot. */
long long StartPeakAgain()
{
#if defined(__GLIBC__)
  malloc_trim(0); // memory that was freed before must not serve what is measured
#endif
  std::ofstream refs("/proc/self/clear_refs");
  refs << "5";
  refs.flush();
  return refs ? StatusBytes("VmRSS") : -1;
}

} // namespace

//------------------------------------------------------------------------------
Options::Options(const std::vector<std::string>& words)
{
  for (const std::string& word : words)
  {
    const std::size_t sign = word.find('=');
    if (sign == std::string::npos)
    {
      throw std::invalid_argument(word + " is not NAME=VALUE");
    }
    this->Values[word.substr(0, sign)] = word.substr(sign + 1);
  }
}

std::string Options::Text(const std::string& name, const std::string& otherwise) const
{
  const auto found = this->Values.find(name);
  return found == this->Values.end() ? otherwise : found->second;
}

double Options::Number(const std::string& name, double otherwise) const
{
  const std::string text = this->Text(name);
  return text.empty() ? otherwise : std::stod(text);
}

int Options::Integer(const std::string& name, int otherwise) const
{
  return static_cast<int>(this->Number(name, otherwise));
}

std::vector<std::string> Options::List(const std::string& name, const std::string& otherwise) const
{
  std::vector<std::string> list;
  std::istringstream words(this->Text(name, otherwise));
  for (std::string word; std::getline(words, word, ',');)
  {
    list.push_back(word);
  }
  return list;
}

void Figures::Set(const std::string& name, double value)
{
  std::ostringstream text;
  text.precision(17);
  text << value;
  this->Values[name] = text.str();
}

void Figures::Write() const
{
  for (const auto& [name, value] : this->Values)
  {
    std::cout << '@' << name << ' ' << value << '\n';
  }
  std::cout.flush();
}

void Measure(
  const std::function<void()>& work, int repetitions, Figures& figures, std::size_t things)
{
  double seconds = std::numeric_limits<double>::infinity();
  double processor = seconds;
  const long long before = StartPeakAgain();
  for (int i = 0; i < repetitions; ++i)
  {
    const auto begin = std::chrono::steady_clock::now();
    const std::clock_t processorBegin = std::clock();
    work();
    processor =
      std::min(processor, static_cast<double>(std::clock() - processorBegin) / CLOCKS_PER_SEC);
    seconds = std::min(
      seconds, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  figures.Set("Seconds", seconds / static_cast<double>(things));
  figures.Set("ProcessorSeconds", processor / static_cast<double>(things));
  const auto peak = static_cast<double>(StatusBytes("VmHWM"));
  if (before >= 0)
  {
    figures.Set("PeakMegabytes", 1e-6 * peak);
    figures.Set("GrownBytes", peak - static_cast<double>(before));
  }
}

vtkSmartPointer<vtkImageData> ReadImage(const std::string& file)
{
  const auto read = [&file](auto* reader)
  {
    if (!reader->CanReadFile(file.c_str()))
    {
      throw std::runtime_error(file + ": not a readable volume");
    }
    reader->SetFileName(file.c_str());
    reader->Update();
    return vtkSmartPointer<vtkImageData>(reader->GetOutput());
  };
  const bool isVti = file.size() > 4 && file.compare(file.size() - 4, 4, ".vti") == 0;
  const vtkSmartPointer<vtkImageData> image = isVti
    ? read(vtkNew<vtkXMLImageDataReader>().GetPointer())
    : read(vtkNew<vtkNIFTIImageReader>().GetPointer());
  vtkPointData* points = image->GetPointData();
  if (!points->GetScalars() && points->GetNumberOfArrays() > 0)
  {
    points->SetActiveScalars(points->GetArrayName(0));
  }
  if (!points->GetScalars() || points->GetScalars()->GetNumberOfComponents() != 1)
  {
    throw std::runtime_error(file + ": has no point scalars of one component");
  }
  return image;
}

} // namespace volumic::bench

int main(int count, char** words)
{
  using namespace volumic::bench;
  const std::map<std::string, void (*)(const Options&)> commands = { { "surface", RunSurface },
    { "pyramid", RunPyramid } };
  const auto command = count > 1 ? commands.find(words[1]) : commands.end();
  if (command == commands.end())
  {
    std::cerr << "Benchmark: surface or pyramid; benchmark.py starts it" << std::endl;
    return 2;
  }
  try
  {
    command->second(Options(std::vector<std::string>(words + 2, words + count)));
    return 0;
  }
  catch (const std::exception& error)
  {
    Figures figures;
    figures.SetText("Failure", error.what());
    figures.Write();
    return 1;
  }
}
