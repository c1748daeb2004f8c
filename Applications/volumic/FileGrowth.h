// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicFileGrowth_h
#define volumicFileGrowth_h

#include "ProgressLine.h"

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>

namespace tool
{
/**
 * As long as it is there, shows how a file grows to the size that it will have: for writers that do
 * not tell how far they are.
 */
class FileGrowth
{
public:
  FileGrowth(const std::string& path, std::uint64_t bytes, ProgressLine& line);
  ~FileGrowth();
  FileGrowth(const FileGrowth&) = delete;
  FileGrowth& operator=(const FileGrowth&) = delete;

private:
  void Watch(const std::string& path, std::uint64_t bytes, ProgressLine& line);

  std::mutex Mutex;
  std::condition_variable Changed;
  bool IsOver = false;
  std::thread Watcher;
};
}

#endif
