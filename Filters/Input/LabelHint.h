// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLabelHint_h
#define volumicLabelHint_h

#include <string>

class vtkDataArray;

namespace volumic
{
/**
 * What someone should know who searches an isopotential in a label map: that there is a filter for
 * that. Empty: the voxels don't look like one. They do where they are integers, of which not many
 * are different, and almost all neighbours along x that are no background (the most frequent value)
 * are equal. Some rows are looked at.
 *
 * @param size voxels along each axis
 */
std::string HintAtLabels(vtkDataArray* voxels, const int size[3]);
}

#endif
