// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Run Volumic or a peer on a volume, measure the run and judge its surface. benchmark.py starts
 * this program and prints the tables.
 *
 *     Benchmark run=NAME volume=FILE.vti iso=VALUE [NAME=VALUE]...
 *
 * See SurfaceRuns.cxx.
 */

#include "Benchmark.h"

#include <vtkDataArray.h>
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

double PeakMegabytes()
{
  std::ifstream status("/proc/self/status");
  std::string word;
  double kilobytes = 0.0;
  while (status >> word && word != "VmHWM:")
  {
  }
  status >> kilobytes;
  return 1024e-6 * kilobytes;
}

/** Reset the peak to the current resident memory; return false if the system cannot. */
bool ResetPeak()
{
#if defined(__GLIBC__)
  malloc_trim(0); // freed memory must not be reused by the measured work
#endif
  std::ofstream refs("/proc/self/clear_refs");
  refs << "5";
  refs.flush();
  return static_cast<bool>(refs);
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
      throw std::invalid_argument("Argument " + word + " is not of the form NAME=VALUE");
    }
    this->Values[word.substr(0, sign)] = word.substr(sign + 1);
  }
}

std::string Options::Text(const std::string& name) const
{
  const auto found = this->Values.find(name);
  return found == this->Values.end() ? std::string() : found->second;
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

void Measure(const std::function<void()>& work, int repetitions, Figures& figures)
{
  double seconds = std::numeric_limits<double>::infinity();
  double processor = seconds;
  const bool hasPeak = ResetPeak();
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
  figures.Set("Seconds", seconds);
  figures.Set("ProcessorSeconds", processor);
  if (hasPeak)
  {
    figures.Set("PeakMegabytes", PeakMegabytes());
  }
}

vtkSmartPointer<vtkImageData> ReadImage(const std::string& file)
{
  vtkNew<vtkXMLImageDataReader> reader;
  if (!reader->CanReadFile(file.c_str()))
  {
    throw std::runtime_error("Cannot read the volume " + file);
  }
  reader->SetFileName(file.c_str());
  reader->Update();
  const vtkSmartPointer<vtkImageData> image = reader->GetOutput();
  vtkPointData* points = image->GetPointData();
  if (!points->GetScalars() && points->GetNumberOfArrays() > 0)
  {
    points->SetActiveScalars(points->GetArrayName(0));
  }
  if (!points->GetScalars() || points->GetScalars()->GetNumberOfComponents() != 1)
  {
    throw std::runtime_error(file + " has no point scalars of one component");
  }
  return image;
}

} // namespace volumic::bench

int main(int count, char** words)
{
  using namespace volumic::bench;
  try
  {
    RunSurface(Options(std::vector<std::string>(words + 1, words + count)));
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
