// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicFieldOptions_h
#define volumicFieldOptions_h

namespace volumic
{
/** What the field is outside the image. */
enum class Border
{
  Background = 0, ///< Away from the object, ramping over one voxel: surfaces close at the border.
  Replicate = 1   ///< The nearest voxel, as far as ImageMargin::Width.
};

/** How an image is read as a field with an object in it. */
struct FieldOptions
{
  double IsoValue = 0.;        ///< Field value of the isopotential that is searched.
  bool ObjectIsBright = true;  ///< The object is where the field is above (off: below) IsoValue.
  Border BorderValue = Border::Background;
};
}

#endif
