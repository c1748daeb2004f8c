// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicScratchTestTools_h
#define volumicScratchTestTools_h

#include "Core/Common/ScratchFile.h"
#include "Core/Common/ScratchMemory.h"
#include "TestPrelude.h"

#include <cstdlib>
#include <filesystem>

#include <unistd.h>

namespace volumic::test
{
constexpr std::size_t MiB = std::size_t(1) << 20;

/** A directory of its own, removed with all that is in it. */
class OwnDirectory
{
public:
  OwnDirectory()
  {
    std::string name = (std::filesystem::temp_directory_path() / "volumic-test-XXXXXX").string();
    this->Path = mkdtemp(name.data());
  }
  OwnDirectory(const OwnDirectory&) = delete;
  OwnDirectory& operator=(const OwnDirectory&) = delete;
  ~OwnDirectory() { std::filesystem::remove_all(this->Path); }

  bool IsEmpty() const { return std::filesystem::is_empty(this->Path); }

  std::string Path;
};

/** A test of scratch memory, with a directory for it. */
class ScratchTest : public testing::Test
{
protected:
  void SetUp() override
  {
    if (!ScratchIsPossible)
    {
      GTEST_SKIP() << "no scratch memory on this system";
    }
  }
  OwnDirectory Directory;
};

/** So much beyond what the process has. */
inline ScratchOptions Allowing(std::size_t bytes, const std::string& directory)
{
  ScratchOptions options;
  options.Limit = ResidentMemoryMeter().Read().All + bytes;
  options.Directory = directory;
  return options;
}

/** Numbers that differ from place to place. */
inline std::uint64_t NumberAt(std::size_t i)
{
  return (static_cast<std::uint64_t>(i) + 1) * 0x9e3779b97f4a7c15ull;
}

inline void FillWithNumbers(std::uint64_t* values, std::size_t begin, std::size_t end)
{
  for (std::size_t i = begin; i < end; ++i)
  {
    values[i] = NumberAt(i);
  }
}

inline std::size_t CountWrongNumbers(const std::uint64_t* values, std::size_t begin,
  std::size_t end)
{
  std::size_t wrong = 0;
  for (std::size_t i = begin; i < end; ++i)
  {
    wrong += values[i] == NumberAt(i) ? 0 : 1;
  }
  return wrong;
}

/** Whether an address lies in a mapped file, as the system sees it. */
bool IsInFile(const void* address);
}

#endif
