// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicTestPrelude_h
#define volumicTestPrelude_h

/**
 * What nearly every test needs. Tests and their tools include it instead of these, and do not
 * include again what their tools include.
 */

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace volumic
{
/** Whether a text has a part; an expectation that fails shows both. */
inline ::testing::AssertionResult Has(const std::string& text, const std::string& part)
{
  return text.find(part) != std::string::npos
    ? ::testing::AssertionSuccess() << '`' << part << "` in: " << text
    : ::testing::AssertionFailure() << "no `" << part << "` in: " << text;
}

/** What work says as it refuses an argument; nothing where it takes it. */
template <typename Work>
std::string ErrorMessageOf(const Work& work)
{
  try
  {
    work();
    return "";
  }
  catch (const std::invalid_argument& error)
  {
    return error.what();
  }
}
}

#endif
