// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FileGrowth.h"

#include <chrono>
#include <filesystem>
#include <system_error>

namespace tool
{
FileGrowth::FileGrowth(const std::string& path, std::uint64_t bytes, ProgressLine& line)
{
  if (!line.IsShown())
  {
    return;
  }
  try
  {
    this->Watcher = std::thread([this, path, bytes, &line] { this->Watch(path, bytes, line); });
  }
  catch (const std::system_error&)
  {
    // No thread can be had: the file is written all the same.
  }
}

FileGrowth::~FileGrowth()
{
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    this->IsOver = true;
  }
  this->Changed.notify_all();
  if (this->Watcher.joinable())
  {
    this->Watcher.join();
  }
}

void FileGrowth::Watch(const std::string& path, std::uint64_t bytes, ProgressLine& line)
{
  std::unique_lock<std::mutex> lock(this->Mutex);
  const std::chrono::milliseconds pause(100);
  while (!this->Changed.wait_for(lock, pause, [this] { return this->IsOver; }))
  {
    std::error_code failed;
    const std::uintmax_t size = std::filesystem::file_size(path, failed);
    if (!failed && bytes > 0)
    {
      line.Show(static_cast<double>(size) / static_cast<double>(bytes), "");
    }
  }
}
}
