// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicFreeMemory_h
#define volumicFreeMemory_h

namespace volumic
{
/**
 * Gives memory that has been freed back to the system, where the C library would keep it: glibc
 * does, of pieces of up to 32 MB, as long as one behind them is in use. Takes some milliseconds:
 * for the end of a phase after which other arrays are needed. Other C libraries are left alone.
 */
void GiveBackFreeMemory();
}

#endif
