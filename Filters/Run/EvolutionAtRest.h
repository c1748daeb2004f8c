// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicEvolutionAtRest_h
#define volumicEvolutionAtRest_h

#include "Core/Common/CheckedFile.h"
#include "Core/Evolution/SurfaceEvolution.h"

namespace volumic
{
/** An evolution as it rested on a level, in memory, while it is on a finer one that may be stopped. */
class EvolutionAtRest
{
public:
  /** Of one after LeaveLevel(). A run can do without: @return whether the memory has sufficed */
  bool Keep(const SurfaceEvolution& evolution);
  void Drop() { FileInMemory().swap(this->File); }
  bool IsKept() const { return !this->File.empty(); }
  /**
   * To a new one with the same options; keeps it no longer.
   * @return whether the memory has sufficed; else the evolution is of no use any more
   */
  bool GiveTo(SurfaceEvolution& evolution);

private:
  FileInMemory File;
};
}

#endif
