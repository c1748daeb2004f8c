// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicToolWorldSpace_h
#define volumicToolWorldSpace_h

#include <array>
#include <optional>
#include <string>

class vtkImageData;
class vtkMultiBlockDataSet;
class vtkPolyData;

namespace tool
{
/**
 * A unit of length as we call it, m, cm, mm, um, nm or A, of what files call it; empty: it is none
 * of these. Readers give images that of the file as the field data `LengthUnit`.
 */
std::string LengthUnitOf(const std::string& name);

/** What the options --spacing, --scale, --unit and --space ask for. */
struct WorldChoice
{
  std::optional<std::array<double, 3>> Spacing; ///< instead of the file's
  std::optional<double> Scale;                  ///< lengths are multiplied by it
  std::string Unit;                             ///< that of lengths; empty: as they are
  std::string Axes; ///< which sides of the body the axes point to; empty: as they do
};

/** Which way world axes point, and which unit lengths have. */
struct WorldSpace
{
  std::string Axes;     ///< as SetWorldAxes takes them; empty: it is not told
  std::string Unit;     ///< as LengthUnitOf has it; empty: it is not told
  double Scale = 1.0;   ///< by which lengths of the file were multiplied
  std::string FileAxes; ///< Axes and Unit as the file has them
  std::string FileUnit;

  /** "; space RAS, unit mm (of the file: um)", or nothing where nothing is known. */
  std::string Text() const;
};

/**
 * Have the image lie where the options want it. All that is made of it is in that space and unit.
 * @throws Failure where the file does not tell what is needed for that.
 */
WorldSpace PlaceInWorld(vtkImageData* image, const WorldChoice& choice);

/**
 * Tell of a space in the field data of a surface, or of all blocks: `SPACE`, as 3D Slicer reads it,
 * and `LengthUnit`.
 */
void MarkSpace(vtkPolyData* surface, const WorldSpace& space);
void MarkSpace(vtkMultiBlockDataSet* surfaces, const WorldSpace& space);

/** What these say, for comments in files: ", SPACE=RAS, unit mm", as 3D Slicer reads it, too. */
std::string SpaceRemark(vtkPolyData* surface);
}

#endif
