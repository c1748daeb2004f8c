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

// As vtkGetMacro() and vtkSetMacro() of vtkSetGet.h, but for where the value is: a member of the
// class, or of what it holds. When it has changed, `modified` is called.
#define VOLUMIC_SET_AND_GET(Class, name, type, setting, modified)                                  \
  type Class::Get##name()                                                                          \
  {                                                                                                \
    const auto value = volumic::ValueOf<type>(this->setting);                           \
    vtkDebugMacro(<< "returning " #name " of " << value);                                          \
    return value;                                                                                  \
  }                                                                                                \
  void Class::Set##name(type value)                                                                \
  {                                                                                                \
    auto& now = this->setting;                                                          \
    const auto wanted = volumic::SettingOf<std::decay_t<decltype(now)>>(value);                    \
    vtkDebugMacro(<< "setting " #name " to " << volumic::ValueOf<type>(wanted));                   \
    if (now != wanted)                                                                             \
    {                                                                                              \
      now = wanted;                                                                                \
      modified;                                                                                    \
    }                                                                                              \
  }

#endif
