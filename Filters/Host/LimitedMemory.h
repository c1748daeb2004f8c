// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLimitedMemory_h
#define volumicLimitedMemory_h

#include "Core/Common/ScratchMemory.h"

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace volumic
{
/**
 * The scratch memory of a filter with the properties Memory Limit and Scratch Directory. The filter
 * has one, from its first run with a limit to its end: what it made is in it that long.
 */
class LimitedMemory
{
public:
  LimitedMemory();
  ~LimitedMemory();

  /**
   * For the run that begins. What was made under another limit stays where it is.
   * @param mebibytes 0: no limit
   * @throws std::invalid_argument naming the property where the limit is none, or the directory
   *         cannot be used; then there is no limit.
   */
  void Set(int mebibytes, const std::string& directory);

  /** Bytes; 0: there is none. */
  std::size_t Limit() const { return this->Options.Limit; }

  /** What ScratchMemory warns of, each as long as it is new, for the end of a run. */
  std::vector<std::string> TakeWarnings();

  /** The property's mebibytes in bytes; 0 where it is no limit. */
  static std::size_t BytesOf(int mebibytes)
  {
    return static_cast<std::size_t>(mebibytes > 0 ? mebibytes : 0) << 20;
  }

private:
  ScratchOptions Options;
  std::unique_ptr<ScratchMemory> Scratch; ///< null where there is no limit
  std::vector<std::string> Told;          ///< the warnings that were taken
};
}

#endif
