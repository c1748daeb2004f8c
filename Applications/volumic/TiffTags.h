// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicTiffTags_h
#define volumicTiffTags_h

#include "BinaryFile.h"
#include "VolumeImage.h"

#include <vtk_tiff.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

// What the directory of a page of a TIFF tells; of ReadTiff.cxx alone.
namespace tool::tiff
{
/** Of libtiff, the first on this thread since it was emptied. */
std::string& Complaint();

/** The same in brackets, for the end of a message; empty: there is none. */
std::string Reason();

/** As long as it is there, libtiff tells Complaint() of errors, and nobody of warnings. */
class Listening
{
public:
  Listening();
  ~Listening();
  Listening(const Listening&) = delete;
  Listening& operator=(const Listening&) = delete;

private:
  TIFFErrorHandler Errors;
  TIFFErrorHandler Warnings;
};

template <class T>
T Tag(TIFF* file, std::uint32_t tag, T otherwise)
{
  T value = otherwise;
  return TIFFGetFieldDefaulted(file, tag, &value) == 1 ? value : otherwise;
}

/** What of a page tells what its pixels are. */
struct Kind
{
  std::uint32_t Width = 0;
  std::uint32_t Height = 0;
  std::uint16_t Bits = 1;
  std::uint16_t Samples = 1;
  std::uint16_t Format = SAMPLEFORMAT_UINT;
  std::uint16_t Colours = 0;
  std::uint16_t Planes = PLANARCONFIG_CONTIG;
  std::uint16_t Orientation = ORIENTATION_TOPLEFT;

  std::string Text() const
  {
    return std::to_string(this->Width) + " x " + std::to_string(this->Height) + ", " +
      std::to_string(this->Samples) + " of " + std::to_string(this->Bits) + " bits, format " +
      std::to_string(this->Format) + ", colours " + std::to_string(this->Colours) +
      ", orientation " + std::to_string(this->Orientation);
  }
};

Kind KindOf(TIFF* file);

/** As VTK numbers types. @throws Failure for pixels that are not read. */
int TypeOf(const Kind& kind);

/** Bytes of the values that the entries of a directory tell of. */
std::uint64_t ValueBytes(BinaryFile& file, std::uint64_t first, std::uint64_t count, bool isWide);

/** From a byte of the file to behind another one. */
using Part = std::pair<std::uint64_t, std::uint64_t>;

/** Adds the parts of the file that have the pixels of the page at hand. @return their bytes */
std::uint64_t AddParts(TIFF* file, std::vector<Part>& parts);

/** What ImageJ and OME-TIFF tell in the description of the first page. */
class Description
{
public:
  explicit Description(TIFF* file);

  bool IsKnown = false;
  bool IsOme = false;

  std::string Value(const std::string& ofImageJ, const std::string& ofOme) const;
  /** A number above 0. */
  double Number(const std::string& ofImageJ, const std::string& ofOme, double otherwise) const;
  std::uint64_t Count(const std::string& ofImageJ, const std::string& ofOme) const;

private:
  std::string Text;
};

/** Distances of voxels that Zeiss's microscopes tell, in metres there: here micrometres. */
bool TakeZeiss(TIFF* file, Vector3& spacing);
}

#endif
