// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicCheckEnumeration_h
#define volumicCheckEnumeration_h

#include "Core/Common/Refuse.h"

namespace volumic
{
/**
 * Properties of VTK classes give enumerations as any int: this refuses what is none of them.
 * @param name of the property, for the message
 * @param last the largest of the enumeration, which begins at 0 and leaves none out
 */
template <typename Enumeration>
void CheckEnumeration(const char* name, Enumeration value, Enumeration last)
{
  const int number = static_cast<int>(value);
  if (number < 0 || value > last)
  {
    Refuse(name, " is ", number, "; it must be 0 to ", static_cast<int>(last), ".");
  }
}
}

#endif
