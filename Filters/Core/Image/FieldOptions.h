// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicFieldOptions_h
#define volumicFieldOptions_h

namespace volumic
{
/** Field outside the image. */
enum class Border
{
  Background = 0, ///< background after one voxel: surfaces close at the border
  Replicate = 1   ///< nearest voxel, up to ImageMargin::Width
};

/** Definition of the object in an image. */
struct FieldOptions
{
  double IsoValue = 0.;       ///< value of the isosurface
  bool ObjectIsBright = true; ///< object above (off: below) IsoValue
  Border BorderValue = Border::Background;
};
}

#endif
