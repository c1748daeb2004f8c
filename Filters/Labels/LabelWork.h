// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLabelWork_h
#define volumicLabelWork_h

#include "Labels/LabelCourse.h"
#include "Labels/LabelSurface.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace volumic
{
/**
 * What one rank makes of the objects of a label map. Items are the objects that get surfaces, then
 * those about them that only claim. Those that are large are done one after another, each by all
 * threads; the others side by side, each by one.
 */
class LabelWork
{
public:
  /** What is done of an item. */
  enum class Kind : int
  {
    Claim,
    Surface
  };

  /**
   * @param names           of the objects that get surfaces, from 1 on
   * @param numberOfThreads 0: all
   */
  LabelWork(LabelSurfaceMaker& maker, const LabelBricks& bricks,
    const std::vector<std::string>& names, int numberOfThreads);

  /** About the work that each item is: the bricks that it is in. */
  const std::vector<double>& Sizes() const { return this->SizeOf; }

  /**
   * Some of the items that are due, in this order, which large ones come first in. State must expect
   * them (LabelCourse::Expect).
   * @param isBeside whether the calling thread must only tell; else it works, too
   * @param tell     called on the calling thread: several times a second, or after each iteration
   *                 of what that thread does
   */
  void Do(Kind kind, const std::vector<std::size_t>& own, bool isBeside,
    const std::function<void()>& tell);

private:
  void DoItem(Kind kind, std::size_t item, int numberOfThreads, HostThreads& threads,
    const std::function<void()>& tell);

  LabelSurfaceMaker& Maker;
  int NumberOfThreads;
  HostThreads Threads;
  std::vector<int> Objects; ///< of each item
  std::vector<double> SizeOf;

public:
  LabelCourse State;
  std::vector<LabelSurface> Surfaces; ///< as far as they are there; with the seconds that they took
};
}

#endif
