// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "TiffTags.h"

#include "Texts.h"
#include "ToolErrors.h"

#include <vtkType.h>

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <limits>
#include <map>

namespace tool::tiff
{
namespace
{
void Complain(const char*, const char* format, va_list values)
{
  char text[300];
  std::vsnprintf(text, sizeof(text), format, values);
  Complaint() = Complaint().empty() ? text : Complaint();
}
}

std::string& Complaint()
{
  thread_local std::string complaint;
  return complaint;
}

std::string Reason()
{
  return Complaint().empty() ? "" : " (" + AsUtf8(Complaint()) + ")";
}

Listening::Listening()
  : Errors(TIFFSetErrorHandler(Complain)), Warnings(TIFFSetWarningHandler(nullptr))
{
  Complaint().clear();
}

Listening::~Listening()
{
  TIFFSetErrorHandler(this->Errors);
  TIFFSetWarningHandler(this->Warnings);
}

Kind KindOf(TIFF* file)
{
  Kind kind;
  kind.Width = Tag<std::uint32_t>(file, TIFFTAG_IMAGEWIDTH, 0);
  kind.Height = Tag<std::uint32_t>(file, TIFFTAG_IMAGELENGTH, 0);
  kind.Bits = Tag<std::uint16_t>(file, TIFFTAG_BITSPERSAMPLE, 1);
  kind.Samples = Tag<std::uint16_t>(file, TIFFTAG_SAMPLESPERPIXEL, 1);
  kind.Format = Tag<std::uint16_t>(file, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
  kind.Colours = Tag<std::uint16_t>(file, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  kind.Planes = Tag<std::uint16_t>(file, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  kind.Orientation = Tag<std::uint16_t>(file, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
  return kind;
}

int TypeOf(const Kind& kind)
{
  static const std::map<std::pair<int, int>, int> types = { { { SAMPLEFORMAT_UINT, 1 },
                                                              VTK_UNSIGNED_CHAR },
    { { SAMPLEFORMAT_UINT, 2 }, VTK_UNSIGNED_CHAR },
    { { SAMPLEFORMAT_UINT, 4 }, VTK_UNSIGNED_CHAR },
    { { SAMPLEFORMAT_UINT, 8 }, VTK_UNSIGNED_CHAR }, { { SAMPLEFORMAT_INT, 8 }, VTK_SIGNED_CHAR },
    { { SAMPLEFORMAT_UINT, 16 }, VTK_UNSIGNED_SHORT }, { { SAMPLEFORMAT_INT, 16 }, VTK_SHORT },
    { { SAMPLEFORMAT_UINT, 32 }, VTK_UNSIGNED_INT }, { { SAMPLEFORMAT_INT, 32 }, VTK_INT },
    { { SAMPLEFORMAT_IEEEFP, 16 }, VTK_UNSIGNED_SHORT }, { { SAMPLEFORMAT_IEEEFP, 32 }, VTK_FLOAT },
    { { SAMPLEFORMAT_IEEEFP, 64 }, VTK_DOUBLE } };
  const int format = kind.Format == SAMPLEFORMAT_VOID ? SAMPLEFORMAT_UINT : kind.Format;
  const bool isSmall = kind.Bits < 8;
  FailIf(isSmall && kind.Samples > 1, "pixels of this kind are not read: " + kind.Text());
  return EntryOf(types, { format, kind.Bits }, "pixels of this kind are not read: " + kind.Text());
}

std::uint64_t ValueBytes(BinaryFile& file, std::uint64_t first, std::uint64_t count, bool isWide)
{
  static const std::uint64_t typeBytes[] = { 0, 1, 1, 2, 4, 8, 1, 1, 2, 4, 8, 4, 8, 4, 0, 0, 8, 8,
    8 };
  const std::uint64_t entry = isWide ? 20 : 12;
  std::uint64_t bytes = 0;
  for (std::uint64_t i = 0; i < count; ++i)
  {
    const std::uint64_t type = file.Number(first + i * entry + 2, 2);
    const std::uint64_t each = type < std::size(typeBytes) ? typeBytes[type] : 0;
    bytes += std::min(Times(each, file.Number(first + i * entry + 4, isWide ? 8 : 4)), file.Size());
  }
  return bytes;
}

std::uint64_t AddParts(TIFF* file, std::vector<Part>& parts)
{
  const std::uint32_t count =
    TIFFIsTiled(file) != 0 ? TIFFNumberOfTiles(file) : TIFFNumberOfStrips(file);
  std::uint64_t all = 0;
  for (std::uint32_t i = 0; i < count; ++i)
  {
    const std::uint64_t begin = TIFFGetStrileOffset(file, i);
    const std::uint64_t bytes = TIFFGetStrileByteCount(file, i);
    const std::uint64_t most = std::numeric_limits<std::uint64_t>::max() / 2;
    FailIf(begin > most || bytes > most || all > most, "its header is damaged");
    parts.emplace_back(begin, begin + bytes);
    all += bytes;
  }
  return all;
}

Description::Description(TIFF* file)
{
  const char* text = nullptr;
  if (TIFFGetField(file, TIFFTAG_IMAGEDESCRIPTION, &text) == 1 && text)
  {
    this->Text = text;
  }
  this->IsOme = this->Text.find("<OME") != std::string::npos;
  this->IsKnown = this->IsOme || this->Text.compare(0, 7, "ImageJ=") == 0;
}

std::string Description::Value(const std::string& ofImageJ, const std::string& ofOme) const
{
  const std::string mark = this->IsOme ? " " + ofOme + "=\"" : "\n" + ofImageJ + "=";
  const std::size_t at = this->IsKnown ? this->Text.find(mark) : std::string::npos;
  if (at == std::string::npos)
  {
    return "";
  }
  const std::size_t begin = at + mark.size();
  return this->Text.substr(begin, this->Text.find_first_of("\"\r\n", begin) - begin);
}

double Description::Number(
  const std::string& ofImageJ, const std::string& ofOme, double otherwise) const
{
  const double value = AsNumber<double>(this->Value(ofImageJ, ofOme)).value_or(otherwise);
  return value > 0.0 && value < 1e9 ? value : otherwise;
}

std::uint64_t Description::Count(const std::string& ofImageJ, const std::string& ofOme) const
{
  return static_cast<std::uint64_t>(this->Number(ofImageJ, ofOme, 1.0));
}

bool TakeZeiss(TIFF* file, Vector3& spacing)
{
  constexpr std::uint32_t zeiss = 34412;
  std::uint32_t count = 0;
  void* data = nullptr;
  if (TIFFGetField(file, zeiss, &count, &data) != 1 || !data || count < 64)
  {
    return false;
  }
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    double metres = 0.0;
    std::memcpy(&metres, static_cast<const char*>(data) + 40 + 8 * axis, sizeof(metres));
    spacing[axis] = metres > 0.0 && metres < 1.0 ? 1e6 * metres : 1.0;
  }
  return true;
}
}
