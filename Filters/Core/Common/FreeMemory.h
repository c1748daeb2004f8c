// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicFreeMemory_h
#define volumicFreeMemory_h

namespace volumic
{
/**
 * Return freed heap memory to the system, at the end of a phase. glibc keeps freed blocks of up to
 * 32 MB if a block behind them is in use. Takes some milliseconds. No effect with other C
 * libraries.
 */
void GiveBackFreeMemory();
}

#endif
