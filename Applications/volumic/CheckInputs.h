// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicCheckInputs_h
#define volumicCheckInputs_h

#include <cstdint>
#include <iosfwd>
#include <string>

class vtkObject;

namespace tool
{
// VTK's readers of these formats give what memory holds where a file has been cut off or damaged,
// or end the program. Hence these looks at a file before: all throw a Failure, without its name,
// with the bytes that are there and those that its header asks for.

/** netCDF of the classic form, which MINC 1 is: the size of the data. Others are passed over. */
void CheckNetcdf(const std::string& name);

/**
 * VTK's XML, whatever the encoding: elements within elements, which its reader takes by recursion;
 * the blocks that arrays are packed in, for whose sizes it takes memory; and the values of each
 * array, of which it makes zeros where they are missing. Of a name all parts, as .pvti has.
 * @return how many points the cells of a surface have, which is to be compared with what was read
 */
std::uint64_t CheckXmlInput(std::istream& file);
std::uint64_t CheckXmlInput(const std::string& name);

/** Wavefront's .obj: the corners of faces are among the points, and so what comes with them. */
void CheckObj(const std::string& name);

/** A surface in VTK's legacy format: its cells have as many points as they tell of. */
void CheckLegacy(const std::string& name);

/** A polygon file (.ply): all elements that its head tells of are there. */
void CheckPly(const std::string& name);

/** PNG: the checksums; BMP, PGM, PPM: the size of the data. Others are passed over. */
void CheckPixels(const std::string& name);

/**
 * What VTK has chosen a reader for, by a few bytes that any file may have: of TGA all pixels must
 * be there; PNM of other kinds, and the pictures of Radiance, are refused, as VTK's readers go on
 * where those end.
 */
void CheckChosen(vtkObject* reader, const std::string& name);
}

#endif
