// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicValueRange_h
#define volumicValueRange_h

#include "Core/Common/Executor.h"

#include <vtkSmartPointer.h>

#include <limits>

class vtkDataArray;

namespace volumic
{
/** The values of an object that is neither all above nor all below one: Lower < image < Upper. */
struct ValueRange
{
  double Lower = 0.0;
  double Upper = std::numeric_limits<double>::infinity(); ///< infinite: Lower alone parts it

  bool IsUsed() const { return this->Upper != std::numeric_limits<double>::infinity(); }
  /** @throws std::invalid_argument naming Iso Value, Upper Value and what they are. */
  void Check() const;
};

/**
 * The voxels folded at the middle of the range, min(v, Lower + Upper - v): they are above Lower
 * where v is within the range, by min(v - Lower, Upper - v), so that Lower is the iso-value of the
 * object, and all that asks for voxels needs to know of no range. As float, or as double where the
 * type has more digits than float; of the same name.
 * @param voxels contiguous in memory, one component
 * @throws std::invalid_argument if their type is not supported; std::bad_alloc, ScratchFull.
 */
vtkSmartPointer<vtkDataArray> FoldVoxels(
  vtkDataArray* voxels, const ValueRange& range, Executor& threads);
}

#endif
