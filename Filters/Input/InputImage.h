// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicInputImage_h
#define volumicInputImage_h

class vtkDataObject;
class vtkImageData;

namespace volumic
{
/**
 * The image that the input of a filter means: itself; the only image in a composite dataset; block
 * 0 of a pyramid.
 * @throws std::invalid_argument naming the type and the way out if there is none, or if there are
 *         several.
 */
vtkImageData* ImageOf(vtkDataObject* input);
}

#endif
