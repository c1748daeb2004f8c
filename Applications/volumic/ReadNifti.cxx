// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SlabReader.h"

#include "LabelNames.h"
#include "Messages.h"
#include "Texts.h"

#include <vtkMatrix4x4.h>
#include <vtkNIFTIImageReader.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

namespace tool
{
namespace
{
/**
 * The numbers of a header that say how many bytes of voxels there are, and where: of NIfTI-1, which
 * Analyze 7.5 begins like, or of NIfTI-2, which has wider numbers at other places.
 */
class NiftiHeader
{
public:
  /** @param bytes the first 540 of the file. @throws Failure if they are no such header. */
  explicit NiftiHeader(const std::string& bytes) : Bytes(bytes)
  {
    if (bytes.size() >= 348)
    {
      const bool isBig = this->Number(0, 4) > 0xFFFF;
      this->IsBig = isBig;
      this->IsWide = this->Number(0, 4) == 540;
    }
    FailIf(
      bytes.size() < (this->IsWide ? 540 : 348) || (!this->IsWide && this->Number(0, 4) != 348),
      "not a NIfTI or Analyze file, or its header is damaged or cut off");
  }

  /** Whether it and the voxels are in one file, in two ("ni1"), or it is Analyze's (""). */
  std::string Mark() const { return this->Bytes.substr(this->IsWide ? 4 : 344, 3); }

  std::uint64_t Type() const { return this->Number(this->IsWide ? 12 : 70, 2); }
  std::uint64_t Bits() const { return this->Number(this->IsWide ? 14 : 72, 2); }

  /** How many dimensions there are (0), or the size of one of them. */
  std::uint64_t Size(std::size_t axis) const
  {
    return this->IsWide ? this->Number(16 + 8 * axis, 8) : this->Number(40 + 2 * axis, 2);
  }

  /** How many volumes there are, one behind the other. */
  std::uint64_t Times() const
  {
    return this->Size(0) < 4 ? 1 : std::max<std::uint64_t>(1, this->Size(4));
  }

  /** Where the voxels begin in their file. */
  std::uint64_t Start() const
  {
    if (this->IsWide)
    {
      return this->Number(168, 8);
    }
    const auto bits = static_cast<std::uint32_t>(this->Number(108, 4));
    float start = 0.0f;
    std::memcpy(&start, &bits, sizeof(start));
    FailIf(!(start >= 0.0f && start < 1e9f) || start != std::floor(start),
      "its header is damaged: the voxels begin at byte " + std::to_string(start));
    return static_cast<std::uint64_t>(start);
  }

  /** What world units are; empty: it is not told. */
  std::string Unit() const
  {
    static const char* const units[] = { "", "metres", "millimetres", "micrometres" };
    const std::uint64_t unit = this->Number(this->IsWide ? 500 : 123, this->IsWide ? 4 : 1) % 8;
    return this->Mark()[0] != 'n' || unit > 3 ? "" : units[unit];
  }

  /** Bytes of a header before the voxels, with what tells of more of it. */
  std::uint64_t Length() const { return this->IsWide ? 544 : 352; }

private:
  std::uint64_t Number(std::size_t at, std::size_t bytes) const
  {
    return NumberOf(this->Bytes.substr(at, bytes), this->IsBig);
  }

  std::string Bytes;
  bool IsBig = false;
  bool IsWide = false;
};

// ---- Checks -------------------------------------------------------------------------------------

/** NIfTI in two files: the one of these that is there, for the name of either. */
std::string NiftiPart(const std::string& name, const std::string& suffix)
{
  for (const char* end : { ".img.gz", ".hdr.gz", ".img", ".hdr" })
  {
    if (EndsWith(name, end))
    {
      const std::string part = name.substr(0, name.size() - std::strlen(end)) + suffix;
      return std::filesystem::exists(part) ? part : part + ".gz";
    }
  }
  return name;
}

/** Types of VTK's reader, numbers of 8 to 64 bits and colours, and their bits. */
std::uint64_t BitsOf(std::uint64_t type)
{
  static const std::map<std::uint64_t, std::uint64_t> bits = { { 2, 8 }, { 4, 16 }, { 8, 32 },
    { 16, 32 }, { 32, 64 }, { 64, 64 }, { 128, 24 }, { 256, 8 }, { 512, 16 }, { 768, 32 },
    { 1024, 64 }, { 1280, 64 }, { 1792, 128 }, { 2304, 32 } };
  return EntryOf(bits, type,
    "its header is damaged: the data type " + std::to_string(type) +
      " is none of NIfTI's types of numbers");
}

/** Bytes of all voxels. @throws Failure for sizes that are none. */
std::uint64_t BytesOf(const NiftiHeader& header)
{
  const std::uint64_t bits = BitsOf(header.Type());
  FailIf(header.Bits() != bits,
    "its header is damaged: voxels of type " + std::to_string(header.Type()) + " have " +
      std::to_string(bits) + " bits, not " + std::to_string(header.Bits()));
  const std::uint64_t axes = header.Size(0);
  FailIf(axes < 1 || axes > 7, "its header is damaged: " + std::to_string(axes) + " dimensions");
  std::uint64_t bytes = bits / 8;
  for (std::size_t axis = 1; axis <= axes; ++axis)
  {
    const std::uint64_t size = header.Size(axis);
    // Those behind the sixth are passed over by VTK's reader.
    FailIf(size < 1 || size > (axis < 6 ? 0x7FFFFFFFu : 1u),
      "its header is damaged, or it is no volume: the size of dimension " + std::to_string(axis) +
        " is " + std::to_string(size));
    bytes = Times(bytes, size);
  }
  return bytes;
}

/**
 * The bytes that a file unpacks to, if it is packed, or has.
 * @throws Failure if it is damaged, or as soon as it gives more than `most`.
 */
std::uint64_t BytesWithin(const std::string& name, std::uint64_t most)
{
  std::ifstream packed(name, std::ios::binary);
  return IsGzip(name) ? Inflate(packed, Nowhere, most) : BinaryFile(name).Size();
}

/**
 * The type and the sizes of the voxels, the size of the data, and the checksum of a packed file:
 * VTK's reader gives what memory holds where a file has been cut off or damaged.
 * @return the bytes of the file that holds the voxels, unpacked.
 */
std::uint64_t CheckNifti(const std::string& name)
{
  const std::string headerFile = NiftiPart(name, ".hdr");
  const std::string dataFile = NiftiPart(name, ".img");
  const NiftiHeader header(HeadOf(headerFile, 540));
  const bool isOne = dataFile == headerFile;
  const std::string mark = header.Mark();
  FailIf(isOne && mark != "n+1" && mark != "n+2",
    "not a NIfTI file, or its header is damaged: its mark is not n+1 or n+2");
  if (!header.Unit().empty() && header.Unit() != "millimetres")
  {
    TellOfFile("its unit, and so that of surfaces and lengths unless --unit asks for another, is " +
      header.Unit() + ", not millimetres");
  }
  const std::uint64_t needed = BytesOf(header);
  const std::uint64_t start = header.Start();
  FailIf(isOne && start < header.Length(),
    "its header is damaged: the voxels begin at byte " + std::to_string(start) +
      ", which is within the header");
  if (!isOne)
  {
    BytesWithin(headerFile, LargestHeader);
  }
  const bool isPacked = IsGzip(dataFile);
  const std::uint64_t there = BytesWithin(dataFile, isPacked ? MostUnpacked(needed, start) : 0);
  NeedJustBytes(there - std::min(there, start), needed);
  return there;
}

// ---- Voxels -------------------------------------------------------------------------------------

/** Slope and shift that the header tells of. */
std::pair<double, double> RescalingOf(vtkNIFTIImageReader* reader)
{
  // What are no numbers scale nothing, as 0 does not: masks have such.
  const double slope = reader->GetRescaleSlope();
  const double shift = reader->GetRescaleIntercept();
  return slope == 0.0 || !std::isfinite(slope) || !std::isfinite(shift)
    ? std::pair<double, double>(1.0, 0.0)
    : std::pair<double, double>(slope, shift);
}

/**
 * The sform, or the qform where there is none; tells where they are not the same.
 * @return whether there is one.
 */
bool Place(vtkNIFTIImageReader* reader, VolumePlacement& placement)
{
  const Vector3 told = placement.Spacing;
  for (double& spacing : placement.Spacing)
  {
    spacing = std::abs(spacing);
  }
  if (told != placement.Spacing)
  {
    TellOfFile("the distance of its voxels is told as " + NumberText(told[0]) + ", " +
      NumberText(told[1]) + ", " + NumberText(told[2]) + "; it is taken without signs");
  }
  // VTK has divided the sform by the spacing; a qform is a mere rotation.
  const auto formOf = [](vtkMatrix4x4* matrix, const Vector3& spacing)
  {
    return matrix ? std::optional<VolumePlacement>(PlacementOf(matrix, spacing.data()))
                  : std::nullopt;
  };
  std::optional<VolumePlacement> sform = formOf(reader->GetSFormMatrix(), told);
  const std::optional<VolumePlacement> qform = formOf(reader->GetQFormMatrix(), placement.Spacing);
  if (qform && sform && !sform->IsSpace())
  {
    TellOfFile("its sform has axes that lie in each other, or none (" + sform->Text() +
      "); its qform is taken");
    sform = std::nullopt;
  }
  sform = sform ? sform : qform;
  const int* extent = reader->GetDataExtent();
  const int size[3] = { extent[1] + 1, extent[3] + 1, extent[5] + 1 };
  if (qform && !sform->IsLike(*qform, size))
  {
    TellOfFile(
      "its sform, which is taken, and its qform differ: " + sform->Text() + "; " + qform->Text());
  }
  placement = sform.value_or(placement);
  return sform.has_value();
}
}

std::unique_ptr<SlabReader> OpenNifti(const std::string& name, const Opening& opening)
{
  FailIf(!vtkNew<vtkNIFTIImageReader>()->CanReadFile(name.c_str()), "not a NIfTI or Analyze file");
  const std::uint64_t bytes = CheckNifti(name);
  const bool isAlone = NiftiPart(name, ".img") == NiftiPart(name, ".hdr");
  const std::uint64_t times = NiftiHeader(HeadOf(NiftiPart(name, ".hdr"), 540)).Times();
  const int time = TimeOf(opening.Choice, times);
  // Packed, it would be unpacked from its begin for each slab.
  std::shared_ptr<NamelessFile> unpacked;
  if (isAlone && (!opening.IsWhole || times > 1) && IsGzip(name))
  {
    unpacked = std::make_shared<NamelessFile>(opening.Scratch);
    std::ifstream packed(name, std::ios::binary);
    InflateJust(
      packed, [&](const char* some, std::size_t count) { unpacked->Append(some, count); }, bytes);
  }
  const std::string file = unpacked ? unpacked->Path() : name;
  const auto make = [file, unpacked, times]
  {
    auto reader = vtkSmartPointer<vtkNIFTIImageReader>::New();
    reader->SetFileName(file.c_str());
    reader->SetTimeAsVector(times > 1);
    return reader;
  };
  auto slabs = std::make_unique<ReaderSlabs>(name, make);
  if (times > 1)
  {
    slabs->Pick(time, static_cast<int>(times));
  }
  const vtkSmartPointer<vtkNIFTIImageReader> reader = make();
  VtkMessages known; // Errors have been told; of sform and qform see above.
  known.ListenTo(reader);
  reader->UpdateInformation();
  std::tie(slabs->Slope, slabs->Shift) = RescalingOf(reader);
  // It warns where sform and qform differ in handedness, of which both are served here.
  slabs->HasTrustedWarnings = false;
  slabs->HasParts = isAlone;
  slabs->IsReversed = reader->GetQFac() < 0;
  if (slabs->Slope != 1.0 || slabs->Shift != 0.0)
  {
    slabs->Type = VTK_FLOAT;
  }
  slabs->WorldAxes = Place(reader, slabs->Placement) ? "RAS" : "";
  slabs->LengthUnit = NiftiHeader(HeadOf(NiftiPart(name, ".hdr"), 540)).Unit();
  return slabs;
}

// ---- Labels -------------------------------------------------------------------------------------

// The table of labels that TotalSegmentator and Connectome Workbench put behind the header, in XML:
//   <Label Key="1" Red="1" Green="0" Blue="0.5" Alpha="1"><![CDATA[spleen]]></Label>
namespace
{
/** The bytes up to the voxels, if any lie between these and the header. */
std::string Extensions(const std::string& name)
{
  const NiftiHeader header(HeadOf(name, 540));
  return header.Start() <= header.Length() ? ""
                                           : HeadOf(name, std::min(header.Start(), LargestNames));
}

/** What stands for a text in XML. */
std::string TextOf(const std::string& content)
{
  static const std::string begin = "<![CDATA[";
  static const std::string end = "]]>";
  const std::size_t at = content.find(begin);
  if (at != std::string::npos)
  {
    const std::size_t start = at + begin.size();
    return content.substr(start, content.find(end, start) - start);
  }
  static const std::pair<const char*, const char*> entities[] = { { "&lt;", "<" }, { "&gt;", ">" },
    { "&quot;", "\"" }, { "&apos;", "'" }, { "&amp;", "&" } };
  std::string text;
  for (std::size_t next = 0; next < content.size();)
  {
    const auto found = std::find_if(std::begin(entities), std::end(entities),
      [&](const auto& each)
      { return content.compare(next, std::strlen(each.first), each.first) == 0; });
    const bool isEntity = found != std::end(entities);
    text += isEntity ? found->second : std::string(1, content[next]);
    next += isEntity ? std::strlen(found->first) : 1;
  }
  return text;
}

/** The number that an attribute of an element is; nothing if it has none. */
std::optional<double> AttributeOf(const std::string& element, const std::string& name)
{
  const std::string begin = " " + name + "=\"";
  const std::size_t at = element.find(begin);
  const std::size_t start = at == std::string::npos ? element.size() : at + begin.size();
  const std::size_t end = element.find('"', start);
  return end == std::string::npos ? std::nullopt
                                  : AsNumber<double>(element.substr(start, end - start));
}
}

LabelNames NamesInNifti(const std::string& name)
{
  const std::string text = Extensions(name);
  LabelNames names;
  const std::string begin = "<Label ";
  const std::string end = "</Label>";
  // Behind each element the next one is looked for: no byte is looked at twice.
  std::size_t behind = 0;
  for (std::size_t at = text.find(begin); at != std::string::npos; at = text.find(begin, behind))
  {
    const std::size_t open = text.find('>', at);
    const std::size_t close = text.find(end, at);
    if (open == std::string::npos || close == std::string::npos || open > close)
    {
      break;
    }
    behind = close;
    const std::string element = text.substr(at, open - at);
    const std::optional<double> key = AttributeOf(element, "Key");
    if (!key || *key != std::floor(*key) || std::abs(*key) > std::numeric_limits<int>::max())
    {
      continue;
    }
    LabelName label;
    label.Label = static_cast<int>(*key);
    label.Name = PlainName(TextOf(text.substr(open + 1, close - open - 1)));
    const std::optional<double> red = AttributeOf(element, "Red");
    const std::optional<double> green = AttributeOf(element, "Green");
    const std::optional<double> blue = AttributeOf(element, "Blue");
    if (red && green && blue)
    {
      label.Color = Vector3{ *red, *green, *blue };
    }
    names.push_back(label);
  }
  return names;
}
}
