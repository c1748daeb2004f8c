// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicTestPrelude_h
#define volumicTestPrelude_h

/** Common includes of all tests. */

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
/** Whether a text contains a part. A failing expectation prints both. */
inline ::testing::AssertionResult Has(const std::string& text, const std::string& part)
{
  return text.find(part) != std::string::npos
    ? ::testing::AssertionSuccess() << '`' << part << "` in: " << text
    : ::testing::AssertionFailure() << "no `" << part << "` in: " << text;
}

/** Return the message of the std::invalid_argument that a function throws; empty if none. */
template <typename Function>
std::string ErrorMessageOf(const Function& function)
{
  try
  {
    function();
    return "";
  }
  catch (const std::invalid_argument& error)
  {
    return error.what();
  }
}
}

#endif
