// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicCheckInputs_h
#define volumicCheckInputs_h

#include <array>
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
 * the blocks that arrays are packed in, for whose sizes it takes memory; and the values of each array,
 * of which it makes zeros where they are missing. Of a name all parts, as .pvti has.
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

/** What programs that write volumes as TIFF tell beside the pixels. */
struct TiffFacts
{
  std::array<double, 3> Spacing = { 1.0, 1.0, 1.0 };
  std::string Unit; ///< of them, as the file calls it
};

/**
 * What the description of a first page tells, if ImageJ or OME-TIFF is its writer.
 * @param distances of the pixels, as the page's tags tell
 * @throws Failure for what makes the pages others than the slices of one volume
 */
TiffFacts FactsOf(const std::string& text, bool isOnlyPage, std::array<double, 3> distances);

/**
 * TIFF: all pages are of one kind that VTK reads, their data lie within the file without overlap,
 * and no page is left out. @return how many there are; 0 for other formats.
 */
int CheckTiff(const std::string& name, TiffFacts* facts = nullptr);

/**
 * TIFF as above; PNG: the checksums; BMP, PGM, PPM: the size of the data. Others are passed over.
 * @return pages of a TIFF, else 1
 */
int CheckPicture(const std::string& name, TiffFacts* facts = nullptr);

/**
 * What VTK has chosen a reader for, by a few bytes that any file may have: of TGA all pixels must be
 * there; PNM of other kinds, and the pictures of Radiance, are refused, as VTK's readers go on where
 * those end.
 */
void CheckChosen(vtkObject* reader, const std::string& name);
}

#endif
