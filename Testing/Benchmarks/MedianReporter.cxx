// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "MedianReporter.h"

#include <algorithm>
#include <ostream>

namespace volumic
{
namespace bench
{
namespace
{

double Median(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

} // namespace

bool MedianReporter::ReportContext(const Context& context)
{
  this->GetOutputStream() << context.cpu_info.num_cpus << " processors of "
                          << context.cpu_info.cycles_per_second / 1e9 << " GHz, load";
  for (const double load : context.cpu_info.load_avg)
  {
    this->GetOutputStream() << ' ' << load;
  }
  this->GetOutputStream() << std::endl;
  return true;
}

void MedianReporter::ReportRuns(const std::vector<Run>& runs)
{
  for (const Run& run : runs)
  {
    if (run.run_type == Run::RT_Iteration)
    {
      Times& times = this->Measured[run.run_name.function_name];
      const auto iterations = static_cast<double>(run.iterations);
      times.Wall.push_back(run.real_accumulated_time / iterations);
      times.Processor.push_back(run.cpu_accumulated_time / iterations);
    }
  }
}

bool MedianReporter::Has(const std::string& name) const
{
  return this->Measured.count(name) != 0;
}

double MedianReporter::WallSeconds(const std::string& name) const
{
  return Median(this->Measured.at(name).Wall);
}

double MedianReporter::LeastWallSeconds(const std::string& name) const
{
  const std::vector<double>& wall = this->Measured.at(name).Wall;
  return *std::min_element(wall.begin(), wall.end());
}

double MedianReporter::ProcessorSeconds(const std::string& name) const
{
  return Median(this->Measured.at(name).Processor);
}

} // namespace bench
} // namespace volumic
