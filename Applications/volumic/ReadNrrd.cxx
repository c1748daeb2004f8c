// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// vtkNrrdReader keeps neither the directions of the axes nor compressed data, so the format is read
// here: https://teem.sourceforge.net/nrrd/format.html.
#include "SlabReader.h"

#include "LabelNames.h"
#include "Texts.h"

#include <vtkType.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <locale>
#include <map>
#include <set>
#include <sstream>

namespace tool
{
namespace
{
using Fields = std::map<std::string, std::string>;

/** As much as a header may have. */
std::string FirstText(const std::string& name)
{
  BinaryFile file(name);
  return file.Text(0, std::min(LargestText, file.Size()));
}

/** The field of this name, one of two of some. @throws Failure for what is no field of NRRD. */
std::string FieldOf(const std::string& name)
{
  static const std::map<std::string, std::string> others = { { "datafile", "data file" },
    { "lineskip", "line skip" }, { "byteskip", "byte skip" } };
  static const std::set<std::string> known = { "dimension", "type", "block size", "blocksize",
    "encoding", "endian", "content", "old min", "oldmin", "old max", "oldmax", "min", "max",
    "data file", "line skip", "byte skip", "number", "sample units", "sampleunits", "sizes",
    "spacings", "thicknesses", "axis mins", "axismins", "axis maxs", "axismaxs", "centers",
    "centerings", "labels", "units", "kinds", "space", "space dimension", "space units",
    "space origin", "space directions", "measurement frame" };
  const std::string lower = Lower(name);
  const std::string field = EntryOr(others, lower, lower);
  FailIf(known.count(field) == 0,
    "the header is damaged: '" + AsUtf8(name.substr(0, 80)) + "' is no field of NRRD");
  return field;
}

/**
 * Fields by lower-case name; `dataStart` is where the data of an attached file begin.
 * @param pairs given the header's own pairs of keys and values
 */
Fields ParseHeader(const std::string& content, std::size_t& dataStart, Fields& pairs)
{
  FailIf(content.compare(0, 7, "NRRD000") != 0, "does not start as a NRRD file does");
  Fields fields;
  std::size_t at = content.find('\n');
  dataStart = content.size();
  while (at < content.size())
  {
    const std::size_t end = std::min(content.find('\n', at + 1), content.size());
    const std::string line = Trimmed(content.substr(at + 1, end - at - 1));
    at = end;
    if (line.empty())
    {
      dataStart = std::min(end + 1, content.size());
      break;
    }
    const std::size_t colon = line.find(':');
    if (line[0] == '#')
    {
      continue;
    }
    if (colon != std::string::npos && line.compare(colon, 2, ":=") == 0)
    {
      pairs[line.substr(0, colon)] = line.substr(colon + 2);
    }
    else
    {
      const std::string field = FieldOf(Trimmed(line.substr(0, colon)));
      fields[field] = colon == std::string::npos ? "" : Trimmed(line.substr(colon + 1));
    }
  }
  return fields;
}

int TypeOf(const std::string& name)
{
  static const std::map<std::string, int> types = { { "signed char", VTK_SIGNED_CHAR },
    { "int8", VTK_SIGNED_CHAR }, { "int8_t", VTK_SIGNED_CHAR }, { "uchar", VTK_UNSIGNED_CHAR },
    { "unsigned char", VTK_UNSIGNED_CHAR }, { "uint8", VTK_UNSIGNED_CHAR },
    { "uint8_t", VTK_UNSIGNED_CHAR }, { "short", VTK_SHORT }, { "short int", VTK_SHORT },
    { "signed short", VTK_SHORT }, { "signed short int", VTK_SHORT }, { "int16", VTK_SHORT },
    { "int16_t", VTK_SHORT }, { "ushort", VTK_UNSIGNED_SHORT },
    { "unsigned short", VTK_UNSIGNED_SHORT }, { "unsigned short int", VTK_UNSIGNED_SHORT },
    { "uint16", VTK_UNSIGNED_SHORT }, { "uint16_t", VTK_UNSIGNED_SHORT }, { "int", VTK_INT },
    { "signed int", VTK_INT }, { "int32", VTK_INT }, { "int32_t", VTK_INT },
    { "uint", VTK_UNSIGNED_INT }, { "unsigned int", VTK_UNSIGNED_INT },
    { "uint32", VTK_UNSIGNED_INT }, { "uint32_t", VTK_UNSIGNED_INT }, { "longlong", VTK_LONG_LONG },
    { "long long", VTK_LONG_LONG }, { "int64", VTK_LONG_LONG }, { "int64_t", VTK_LONG_LONG },
    { "ulonglong", VTK_UNSIGNED_LONG_LONG }, { "unsigned long long", VTK_UNSIGNED_LONG_LONG },
    { "uint64", VTK_UNSIGNED_LONG_LONG }, { "uint64_t", VTK_UNSIGNED_LONG_LONG },
    { "float", VTK_FLOAT }, { "double", VTK_DOUBLE } };
  return EntryOf(types, name, "the type '" + name + "' is missing or not a number type");
}

/** "(1,0,0) (0,1,0) (0,0,1)" as vectors. */
std::vector<Vector3> ParseVectors(const std::string& text)
{
  std::vector<Vector3> vectors;
  for (std::size_t open = text.find('('); open != std::string::npos;
       open = text.find('(', open + 1))
  {
    const std::size_t close = text.find(')', open);
    FailIf<UsageError>(close == std::string::npos, "'" + text + "' does not end");
    const std::vector<double> numbers = ParseNumbers(text.substr(open + 1, close - open - 1), 3);
    vectors.push_back({ numbers[0], numbers[1], numbers[2] });
  }
  return vectors;
}

/** @param hasComponents Whether the first axis is none of space */
VolumePlacement PlacementOf(const Fields& fields, bool hasComponents)
{
  VolumePlacement placement;
  const std::string origin = EntryOr(fields, "space origin", "(0,0,0)");
  const std::string directions = EntryOr(fields, "space directions", "");
  const std::vector<Vector3> origins = ParseVectors(origin);
  FailIf<UsageError>(origins.size() != 1, "'" + origin + "' is no origin");
  placement.Origin = origins[0];
  if (!directions.empty())
  {
    const std::vector<Vector3> steps = ParseVectors(directions);
    FailIf<UsageError>(steps.size() != 3, "'" + directions + "' are not three vectors");
    placement.SetSteps({ steps[0], steps[1], steps[2] });
    return placement;
  }
  std::istringstream spacings(EntryOr(fields, "spacings", hasComponents ? "nan 1 1 1" : "1 1 1"));
  std::string none;
  if (hasComponents)
  {
    spacings >> none;
  }
  for (double& spacing : placement.Spacing)
  {
    std::string word;
    spacings >> word;
    spacing = Lower(word) == "nan" ? 1.0 : ParseNumber<double>(word);
  }
  return placement;
}

/** The sides of the body that the axes of a `space` point to; empty for other spaces. */
std::string WorldAxesOf(const std::string& space)
{
  static const std::map<std::string, std::string> axes = { { "right-anterior-superior", "RAS" },
    { "ras", "RAS" }, { "left-anterior-superior", "LAS" }, { "las", "LAS" },
    { "left-posterior-superior", "LPS" }, { "lps", "LPS" } };
  return EntryOr(axes, Lower(space), "");
}

/** That of all axes in space: the last word in quotes. */
std::string UnitOf(const Fields& fields)
{
  const std::string units = EntryOr(fields, "space units", EntryOr(fields, "units", ""));
  const std::size_t end = units.rfind('"');
  const std::size_t begin = end > 0 && end != std::string::npos ? units.rfind('"', end - 1) : end;
  return begin == std::string::npos ? "" : units.substr(begin + 1, end - begin - 1);
}

/** What a header tells. */
struct Header
{
  Fields All;
  Fields Pairs; ///< what programs tell each other
  /** Where the voxels are, but for what is to be skipped, and what is known of them. */
  std::unique_ptr<RawSlabs> Slabs = std::make_unique<RawSlabs>();
};

RawSlabs::Packing PackingOf(const std::string& encoding)
{
  using Packing = RawSlabs::Packing;
  static const std::map<std::string, Packing> packings = { { "raw", Packing::None },
    { "gzip", Packing::Zlib }, { "gz", Packing::Zlib }, { "bzip2", Packing::Bzip2 },
    { "bz2", Packing::Bzip2 }, { "text", Packing::Text }, { "txt", Packing::Text },
    { "ascii", Packing::Text } };
  return EntryOf(packings, encoding,
    "the encoding '" + encoding + "' is not read: raw, gzip, bzip2 and text are");
}

/** Where the data are when so many lines are behind. */
std::uint64_t BehindLines(const std::string& file, std::uint64_t start, int lines)
{
  std::ifstream data = OpenData(file, start);
  for (; lines > 0 && data; --lines)
  {
    data.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  }
  return data.good() ? static_cast<std::uint64_t>(data.tellg()) : std::filesystem::file_size(file);
}

/** What the numbers along the first axis are. */
std::string FirstKind(const Fields& fields)
{
  std::istringstream stream(Lower(EntryOr(fields, "kinds", "")));
  std::string kind;
  stream >> kind;
  return kind;
}

/** Whether each voxel has several numbers, one behind the other, as the layers of segmentations. */
bool FirstAxisIsComponents(const Fields& fields)
{
  static const std::vector<std::string> ofSpace = { "", "domain", "space", "none", "???" };
  const std::string kind = FirstKind(fields);
  return EntryOr(fields, "dimension", "") == "4" &&
    std::find(ofSpace.begin(), ofSpace.end(), kind) == ofSpace.end();
}

Header ReadHeader(const std::string& name)
{
  Header header;
  RawSlabs& slabs = *header.Slabs;
  std::size_t start = 0;
  header.All = ParseHeader(FirstText(name), start, header.Pairs);
  std::array<int, 3>& size = slabs.Size;
  std::istringstream sizes(EntryOr(header.All, "sizes", ""));
  std::string more;
  const bool hasComponents = FirstAxisIsComponents(header.All);
  FailIf((hasComponents && !(sizes >> slabs.Components)) ||
      !(sizes >> size[0] >> size[1] >> size[2]) || sizes >> more || slabs.Components < 1 ||
      *std::min_element(size.begin(), size.end()) < 1,
    "sizes '" + EntryOr(header.All, "sizes", "") +
      "'; a volume with one scalar component has three, one with several a list of them first");
  slabs.Type = TypeOf(Lower(EntryOr(header.All, "type", "")));
  const std::string dimension = EntryOr(header.All, "dimension", "");
  FailIf(dimension != (hasComponents ? "4" : "3"),
    "dimension '" + dimension + "', which has not as many sizes");
  const std::string endian = Lower(EntryOr(header.All, "endian", "little"));
  FailIf(
    endian != "little" && endian != "big", "endian '" + endian + "'; little and big are known");
  slabs.IsBig = endian == "big";
  const std::string file = EntryOr(header.All, "data file", "");
  FailIf(file.compare(0, 4, "LIST") == 0 || file.find('%') != std::string::npos,
    "data spread over several files are not read");
  slabs.Files = { file.empty() ? name
                               : (std::filesystem::path(name).parent_path() / file).string() };
  slabs.Start = file.empty() ? start : 0;
  slabs.Placement = PlacementOf(header.All, hasComponents);
  slabs.WorldAxes = WorldAxesOf(EntryOr(header.All, "space", ""));
  slabs.LengthUnit = UnitOf(header.All);
  return header;
}

// ---- Segments -----------------------------------------------------------------------------------

// As 3D Slicer tells of them in the headers of .seg.nrrd:
//   Segment0_Name:=liver
//   Segment0_LabelValue:=1
//   Segment0_Color:=0.86 0.51 0.4
//   Segment0_Layer:=0
// Older files have a component per segment, and neither label nor layer.

/** A whole number; what is none counts as missing. */
int NumberAt(const Fields& pairs, const std::string& key, int otherwise)
{
  return AsNumber<int>(EntryOr(pairs, key, "")).value_or(otherwise);
}

std::optional<Vector3> ColorAt(const Fields& pairs, const std::string& key)
{
  std::istringstream words(EntryOr(pairs, key, ""));
  words.imbue(std::locale::classic());
  Vector3 color;
  words >> color[0] >> color[1] >> color[2];
  return words ? std::optional<Vector3>(color) : std::nullopt;
}

/** Without the marks of NRRD for line ends and backslashes. */
std::string Unmarked(const std::string& text)
{
  std::string plain;
  for (std::size_t at = 0; at < text.size(); ++at)
  {
    const bool isMark =
      text[at] == '\\' && at + 1 < text.size() && (text[at + 1] == 'n' || text[at + 1] == '\\');
    plain += !isMark ? text[at] : (text[at + 1] == 'n' ? ' ' : '\\');
    at += isMark ? 1 : 0;
  }
  return plain;
}

LabelNames NamesOfSegments(const Fields& pairs, int components)
{
  LabelNames names;
  for (const auto& [key, text] : pairs)
  {
    const std::string start = key.substr(0, key.find('_') + 1);
    if (key.compare(0, 7, "Segment") != 0 || start.size() < 9 || key != start + "Name")
    {
      continue;
    }
    const std::optional<int> number = AsNumber<int>(start.substr(7, start.size() - 8));
    if (!number || *number == std::numeric_limits<int>::max())
    {
      continue; // Segmentation_..., which is about all of them
    }
    const bool isOld = components > 1 && pairs.count(start + "Layer") == 0;
    LabelName name;
    name.Name = PlainName(Unmarked(text));
    name.Label = NumberAt(pairs, start + "LabelValue", isOld ? 1 : *number + 1);
    name.Layer = NumberAt(pairs, start + "Layer", isOld ? *number : 0);
    name.Color = ColorAt(pairs, start + "Color");
    names.push_back(name);
  }
  return names;
}
}

LabelNames NamesInNrrd(const std::string& name)
{
  const Header header = ReadHeader(name);
  return NamesOfSegments(header.Pairs, header.Slabs->Components);
}

std::unique_ptr<SlabReader> OpenNrrd(const std::string& name, const Opening& opening)
{
  Header header = ReadHeader(name);
  std::unique_ptr<RawSlabs>& slabs = header.Slabs;
  slabs->Code = PackingOf(Lower(EntryOr(header.All, "encoding", "raw")));
  slabs->Start = BehindLines(
    slabs->Files.front(), slabs->Start, ParseNumber<int>(EntryOr(header.All, "line skip", "0")));
  // -1: the voxels are the last bytes.
  const int skip = ParseNumber<int>(EntryOr(header.All, "byte skip", "0"));
  const bool isRaw = slabs->Code == RawSlabs::Packing::None;
  slabs->AreLast = isRaw && skip < 0;
  (isRaw ? slabs->Start : slabs->Before) += static_cast<std::uint64_t>(std::max(skip, 0));
  slabs->Prepare(opening);
  const std::string kind = FirstKind(header.All);
  const bool isOfParts =
    kind == "list" || kind == "time" || kind == "rgba-color" || kind == "4-color";
  if (slabs->Components > 1 && isOfParts &&
    NamesOfSegments(header.Pairs, slabs->Components).empty())
  {
    NeedComponent(slabs->Components, kind, opening);
  }
  return std::move(slabs);
}
}
