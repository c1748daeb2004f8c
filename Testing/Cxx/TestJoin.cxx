// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CommaLocale.h"
#include "Core/Common/Refuse.h"
#include "TestPrelude.h"

#include <sstream>

using namespace volumic;

TEST(Join, WritesNumbersAsEveryoneReadsThem)
{
  const CommaLocale locale;
  std::ostringstream local;
  local << 1234.5;
  ASSERT_EQ(local.str(), "1.234,5") << "the locale is not what it should be";
  EXPECT_EQ(Join("level ", 1000, ", ", std::int64_t(1234567), " voxels of ", 0.5f),
    "level 1000, 1234567 voxels of 0.5");
}

TEST(Join, IsWhatARefusalSays)
{
  const CommaLocale locale;
  try
  {
    Refuse("it is ", 1234.5, ".");
    FAIL();
  }
  catch (const std::invalid_argument& error)
  {
    EXPECT_STREQ(error.what(), "it is 1234.5.");
  }
}
