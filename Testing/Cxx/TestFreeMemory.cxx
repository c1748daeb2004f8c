// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/FreeMemory.h"
#include "TestPrelude.h"

#include <fstream>

#include <unistd.h>

using namespace volumic;

namespace
{
/** Memory that this process takes, in MB; 0 where it cannot be told. */
double ResidentMegabytes()
{
  long all = 0;
  long resident = 0;
  std::ifstream("/proc/self/statm") >> all >> resident;
  return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}
}

TEST(FreeMemory, IsGivenBackThoughABlockBehindItIsInUse)
{
#if !defined(__GLIBC__) || defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "another allocator";
#endif
  // 64 MB in blocks that are too small to be given back one by one.
  constexpr std::size_t size = 16 * 1024;
  std::vector<std::vector<char>> blocks(4096);
  for (std::vector<char>& block : blocks)
  {
    block.assign(size, 'x');
  }
  const std::vector<char> last(size, 'x');
  const double before = ResidentMegabytes();
  ASSERT_GT(before, 64.) << "cannot be told here";
  blocks.clear();
  GiveBackFreeMemory();
  EXPECT_LT(ResidentMegabytes(), before - 50.);
  EXPECT_EQ(last.back(), 'x');
}
