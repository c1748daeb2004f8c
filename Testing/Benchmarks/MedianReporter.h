// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/** Medians over the repetitions of each benchmark of one run, to be compared with each other. */

#ifndef volumicMedianReporter_h
#define volumicMedianReporter_h

#include <benchmark/benchmark.h>

#include <map>
#include <string>
#include <vector>

namespace volumic
{
namespace bench
{

class MedianReporter : public benchmark::BenchmarkReporter
{
public:
  /** Says what runs where. The output files of Google Benchmark have the rest. */
  bool ReportContext(const Context& context) override;
  void ReportRuns(const std::vector<Run>& runs) override;

  bool Has(const std::string& name) const;

  /** Median of the time that passed, in seconds. Throws std::out_of_range where nothing was
     measured under that name. */
  double WallSeconds(const std::string& name) const;

  /** The shortest time that passed, of all repetitions: the one least disturbed by others. */
  double LeastWallSeconds(const std::string& name) const;

  /** Median of the processor time of all threads, in seconds: what others do on the machine counts
      less. Throws as above. */
  double ProcessorSeconds(const std::string& name) const;

private:
  struct Times
  {
    std::vector<double> Wall;
    std::vector<double> Processor;
  };
  std::map<std::string, Times> Measured;
};

} // namespace bench
} // namespace volumic

#endif
