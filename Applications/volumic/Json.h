// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicJson_h
#define volumicJson_h

#include <cmath>
#include <string>

// Newer versions of VTK have a copy of their own, whose headers and Debian's shut each other out.
#if __has_include(<vtk_nlohmannjson.h>)
#include <vtk_nlohmannjson.h>
#include VTK_NLOHMANN_JSON(json.hpp)
#else
#include <nlohmann/json.hpp>
#endif

namespace tool
{
using Json = nlohmann::ordered_json; ///< members in their order in the file

/** Whole numbers without a point; NaN and infinities, which JSON has not, become null. */
inline Json AsJson(double value)
{
  const bool isWhole = value == std::floor(value) && std::abs(value) < 1e15;
  return isWhole ? Json(static_cast<long long>(value)) : Json(value);
}

/** An array of numbers, each as above. */
template <class Numbers>
Json AsJsonArray(const Numbers& numbers)
{
  Json array = Json::array();
  for (const auto& number : numbers)
  {
    array.push_back(AsJson(static_cast<double>(number)));
  }
  return array;
}

/** Names of files may be any bytes: those that are not UTF-8 become the replacement character. */
inline std::string TextOf(const Json& json, int indent = 2)
{
  return json.dump(indent, ' ', false, Json::error_handler_t::replace) + "\n";
}
}

#endif
