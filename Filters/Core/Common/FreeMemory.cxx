// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/FreeMemory.h"

#include <cstdlib> // For __GLIBC__

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace volumic
{
void GiveBackFreeMemory()
{
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}
}
