// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicTemporaryFolder_h
#define volumicTemporaryFolder_h

#include "TestPrelude.h"

#include <csignal>
#include <filesystem>
#include <fstream>
#include <stdlib.h>
#include <sys/resource.h>

namespace volumic
{
/** A new folder, deleted with the object. */
class TemporaryFolder
{
public:
  TemporaryFolder() : Name((std::filesystem::temp_directory_path() / "volumic-XXXXXX").string())
  {
    if (!mkdtemp(this->Name.data()))
    {
      throw std::runtime_error("no temporary folder");
    }
  }
  ~TemporaryFolder()
  {
    std::error_code ignored;
    std::filesystem::remove_all(this->Name, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::string& Path() const { return this->Name; }
  std::string File(const std::string& name) const { return this->Name + "/" + name; }
  std::set<std::string> Names() const
  {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(this->Name))
    {
      names.insert(entry.path().filename().string());
    }
    return names;
  }

  /** Return the addresses that the process maps from files of the folder, as [begin, end). */
  std::vector<std::pair<std::uintptr_t, std::uintptr_t>> Mapped() const
  {
    std::vector<std::pair<std::uintptr_t, std::uintptr_t>> mapped;
    std::ifstream maps("/proc/self/maps");
    for (std::string line; std::getline(maps, line);)
    {
      std::size_t dash = 0;
      const std::uintptr_t begin = std::stoull(line, &dash, 16);
      if (line.find(this->Name + "/") != std::string::npos)
      {
        mapped.emplace_back(begin, std::stoull(line.substr(dash + 1), nullptr, 16));
      }
    }
    return mapped;
  }

private:
  std::string Name;
};

/** Limits the size of files of the process until destruction, to simulate a full disk. */
class LimitedFileSize
{
public:
  explicit LimitedFileSize(rlim_t bytes) : Handler(std::signal(SIGXFSZ, SIG_IGN))
  {
    getrlimit(RLIMIT_FSIZE, &this->Before);
    const rlimit limited = { bytes, this->Before.rlim_max };
    setrlimit(RLIMIT_FSIZE, &limited);
  }
  ~LimitedFileSize()
  {
    setrlimit(RLIMIT_FSIZE, &this->Before);
    std::signal(SIGXFSZ, this->Handler);
  }
  LimitedFileSize(const LimitedFileSize&) = delete;
  LimitedFileSize& operator=(const LimitedFileSize&) = delete;

private:
  void (*Handler)(int);
  rlimit Before{};
};
}

#endif
