// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicPropertyValues_h
#define volumicPropertyValues_h

#include "Core/Common/IndexedSurface.h"

#include <ostream>
#include <string>
#include <type_traits>
#include <vector>

namespace volumic
{
/** What a setting has of a value that Set gets: an int may stand for an enumeration. */
template <typename Setting, typename Value>
Setting SettingOf(Value value)
{
  if constexpr (std::is_same_v<Setting, std::string>)
  {
    return value ? value : "";
  }
  else
  {
    return static_cast<Setting>(value);
  }
}

/** What Get returns of a setting. */
template <typename Value, typename Setting>
Value ValueOf(const Setting& setting)
{
  if constexpr (std::is_same_v<Setting, std::string>)
  {
    return setting.c_str();
  }
  else
  {
    return static_cast<Value>(setting);
  }
}

/** As PrintSelf() tells it: of a list only how many there are. */
template <typename Setting>
void PrintSetting(std::ostream& os, const Setting& setting)
{
  if constexpr (std::is_same_v<Setting, std::vector<Point>>)
  {
    os << setting.size();
  }
  else if constexpr (std::is_enum_v<Setting>)
  {
    os << static_cast<int>(setting);
  }
  else
  {
    os << setting;
  }
}
}

#endif
