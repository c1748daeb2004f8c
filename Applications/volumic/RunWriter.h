// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRunWriter_h
#define volumicRunWriter_h

#include "ProgressLine.h"

#include <functional>

class vtkAlgorithm;

namespace tool
{
/**
 * Have a writer of VTK, whose input and file are set, do its work: `write` calls its Write, which is
 * no method of what they have in common. What it tells of its progress is shown. It cannot be
 * interrupted: what there is of an interrupted run is to be written.
 * @throws Failure, without the name of the file, if it reports an error.
 */
void RunWriter(vtkAlgorithm* writer, const std::function<void()>& write, ProgressLine& line);

template <class Writer>
void RunWriter(Writer* writer, ProgressLine& line)
{
  RunWriter(writer, [writer] { writer->Write(); }, line);
}
}

#endif
