// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// TIFF by libtiff, which VTK comes with. vtkTIFFReader gives other bytes than those of the file for
// some kinds of pixels and takes all pages to be like the first; libtiff takes a chain of pages
// that ends early for a whole one.
#include "SlabReader.h"

#include "Texts.h"
#include "TiffTags.h"
#include "ToolErrors.h"

#include <vtkDataArray.h>

#include <algorithm>
#include <cstring>
#include <limits>

namespace tool
{
namespace
{
using namespace tiff;

class TiffPages : public SlabReader
{
public:
  TiffPages(const std::string& name, const VolumeChoice& choice);

  std::size_t Pages() const { return this->Stacked > 0 ? this->Stacked : this->Places.size(); }
  bool HasChannels() const { return this->Channels > 1; }
  bool HasHalves() const
  {
    return this->First.Format == SAMPLEFORMAT_IEEEFP && this->First.Bits == 16;
  }
  vtkSmartPointer<vtkDataArray> Read(int first, int count) override;

private:
  void TakePages(std::uint64_t images);
  void TakeStack(std::uint64_t images, std::vector<Part>& parts);
  std::uint64_t CheckPage(std::vector<Part>& parts);
  void CheckParts(std::vector<Part> parts, std::uint64_t others, std::uint64_t page) const;
  void TakeVolume(const VolumeChoice& choice, std::uint64_t times, const std::string& order);
  void TakeSpacing(const Description& told);
  void ReadPage(std::size_t page, char* pixels);
  void CopyPart(const std::vector<char>& part, std::uint32_t x, std::uint32_t y,
    std::uint32_t width, std::uint32_t height, std::uint16_t sample, char* pixels) const;
  std::size_t SampleBytes() const
  {
    return static_cast<std::size_t>(vtkDataArray::GetDataTypeSize(this->Type));
  }

  std::unique_ptr<TIFF, void (*)(TIFF*)> File;
  std::uint64_t Bytes; ///< of the file
  Kind First;
  std::vector<std::uint64_t> Places;             ///< of the pages in the file
  std::size_t Stacked = 0;                       ///< images behind each other in the only page
  std::uint64_t StackBegin = 0;                  ///< of these in the file
  std::uint64_t Channels = 1;                    ///< that are pages of their own
  std::size_t FirstPage = 0;                     ///< of the time that is wanted
  std::array<std::size_t, 2> Strides = { 1, 1 }; ///< pages to the next slice, and channel
};

TiffPages::TiffPages(const std::string& name, const VolumeChoice& choice)
  : File(nullptr, TIFFClose), Bytes(BinaryFile(name).Size())
{
  const Listening listening;
  this->File.reset(TIFFOpen(name.c_str(), "rm")); // not mapped: another program may cut it off
  FailIf(!this->File, "the file is damaged or cut off" + Reason());
  const Description told(this->File.get());
  this->First = KindOf(this->File.get());
  this->Type = TypeOf(this->First);
  this->ArrayName = "Tiff Scalars"; // as VTK's reader calls them
  this->TakeSpacing(told);
  this->TakePages(told.IsOme ? 1 : told.Count("images", ""));
  this->Size = { static_cast<int>(this->First.Width), static_cast<int>(this->First.Height), 0 };
  const std::uint64_t samples = this->First.Samples;
  const std::uint64_t channels = told.Count("channels", "SizeC");
  this->Channels = told.IsOme && channels % samples == 0 ? channels / samples : channels;
  this->Components = static_cast<int>(samples * this->Channels);
  const std::string order = told.Value("", "DimensionOrder");
  this->TakeVolume(
    choice, told.Count("frames", "SizeT"), order.size() == 5 ? order.substr(2) : "CZT");
}

void TiffPages::TakeSpacing(const Description& told)
{
  Vector3& spacing = this->Placement.Spacing;
  if (TakeZeiss(this->File.get(), spacing))
  {
    this->LengthUnit = "um";
    return;
  }
  const auto distance = [this](std::uint32_t tag)
  {
    const float perUnit = Tag<float>(this->File.get(), tag, 1.0f);
    return perUnit > 0.0f ? 1.0 / static_cast<double>(perUnit) : 1.0;
  };
  if (told.IsKnown)
  {
    spacing = { told.Number("", "PhysicalSizeX", distance(TIFFTAG_XRESOLUTION)),
      told.Number("", "PhysicalSizeY", distance(TIFFTAG_YRESOLUTION)),
      told.Number("spacing", "PhysicalSizeZ", 1.0) };
    const bool isDefault = told.IsOme && !told.Value("", "PhysicalSizeX").empty();
    const std::string unit = told.Value("unit", "PhysicalSizeXUnit");
    this->LengthUnit = unit.empty() && isDefault ? "um" : unit;
  }
}

/** The page at hand is one of the volume's: like the first one, its pixels in the file. */
std::uint64_t TiffPages::CheckPage(std::vector<Part>& parts)
{
  TIFF* file = this->File.get();
  const Kind kind = KindOf(file);
  FailIf(kind.Text() != this->First.Text(),
    "it is " + kind.Text() + ", the first page " + this->First.Text() +
      "; pages of one kind are read");
  const std::uint64_t most = std::numeric_limits<int>::max();
  const std::uint64_t pixels = Times(kind.Width, kind.Height);
  const std::uint64_t bits = Times(Times(pixels, kind.Samples), kind.Bits);
  FailIf(bits == 0 || pixels > most || bits / 8 > most,
    "it has " + std::to_string(kind.Width) + " x " + std::to_string(kind.Height) + " pixels");
  const std::uint64_t packed = AddParts(file, parts);
  FailIf(packed > this->Bytes,
    "the file is cut off or damaged: its pixels have " + std::to_string(packed) + " bytes");
  const bool isPlain = Tag<std::uint16_t>(file, TIFFTAG_COMPRESSION, 1) == COMPRESSION_NONE;
  NeedPackedBytes(packed, isPlain ? 1 : 10000, bits / 8);
  return packed;
}

/** @param images of ImageJ, which may be more than pages */
void TiffPages::TakePages(std::uint64_t images)
{
  TIFF* file = this->File.get();
  std::vector<Part> parts;
  std::uint64_t pixels = 0;
  std::uint64_t others = 0; // bytes of what directories refer to
  std::size_t number = 0;
  BinaryFile bytes(TIFFFileName(file));
  bytes.IsBig = TIFFIsBigEndian(file) != 0;
  const bool isWide = bytes.Number(2, 2) == 43;
  std::uint64_t next = 0;
  std::uint64_t values = 0; // bytes of them, which pages that share them have libtiff read again
  do
  {
    ++number;
    FailIf(
      number > std::numeric_limits<std::uint16_t>::max(), "it has more pages than libtiff counts");
    const std::uint64_t place = TIFFCurrentDirOffset(file);
    const char* text = nullptr;
    const std::uint64_t entries = bytes.Number(place, isWide ? 8 : 2);
    values += ValueBytes(bytes, place + (isWide ? 8 : 2), entries, isWide);
    FailIf(values > 2 * this->Bytes,
      "the file is damaged: its pages have more values than it has bytes");
    parts.emplace_back(place, place + (isWide ? 16 + 20 * entries : 6 + 12 * entries));
    next = bytes.Number(parts.back().second - (isWide ? 8 : 4), isWide ? 8 : 4);
    others += 20 +
      (TIFFGetField(file, TIFFTAG_IMAGEDESCRIPTION, &text) == 1 && text ? std::strlen(text) : 0);
    const std::size_t before = parts.size();
    Named("page " + std::to_string(number),
      [&]
      {
        // Smaller copies, which are no slices.
        if (number > 1 && (Tag<std::uint32_t>(file, TIFFTAG_SUBFILETYPE, 0) & 1u) != 0)
        {
          AddParts(file, parts);
          return;
        }
        pixels += this->CheckPage(parts);
        this->Places.push_back(place);
      });
    others += (parts.size() - before) * (isWide ? 16 : 8);
    Complaint().clear();
  } while (TIFFReadDirectory(file) != 0);
  FailIf(
    !Complaint().empty() || next != 0, "the file is damaged: its pages form no chain" + Reason());
  if (this->Places.size() == 1 && images > 1)
  {
    this->TakeStack(images, parts);
  }
  this->CheckParts(std::move(parts), others, pixels / this->Places.size());
}

/** Of large stacks ImageJ writes one page, behind whose pixels those of the other images are. */
void TiffPages::TakeStack(std::uint64_t images, std::vector<Part>& parts)
{
  const std::uint64_t page = Times(Times(this->First.Width, this->First.Height),
    static_cast<std::uint64_t>(this->First.Samples) * this->First.Bits / 8);
  this->StackBegin = parts.at(1).first; // the directory is before the strips
  const bool isPlain = this->First.Bits >= 8 && this->First.Planes == PLANARCONFIG_CONTIG &&
    Tag<std::uint16_t>(this->File.get(), TIFFTAG_COMPRESSION, 1) == COMPRESSION_NONE;
  const std::uint64_t bytes = Times(page, images);
  const std::uint64_t told = parts.back().second - this->StackBegin;
  FailIf(!isPlain || (told != page && told != bytes),
    "ImageJ has put " + std::to_string(images) +
      " images into one page, packed, which is not read; save it there as NRRD, or as an image "
      "sequence");
  FailIf(bytes > this->Bytes - std::min(this->Bytes, this->StackBegin),
    "the file is cut off: " + std::to_string(images) + " images are told of");
  this->Stacked = static_cast<std::size_t>(images);
  parts = { parts.front(), { this->StackBegin, this->StackBegin + bytes } };
}

/**
 * @throws Failure if parts overlap, or if as much as a page is in none
 * @param others bytes that are known otherwise
 */
void TiffPages::CheckParts(std::vector<Part> parts, std::uint64_t others, std::uint64_t page) const
{
  std::sort(parts.begin(), parts.end());
  std::uint64_t used = 0;
  std::uint64_t end = 0;
  for (const auto& [begin, behind] : parts)
  {
    FailIf(begin < end && behind > begin,
      "the file is damaged: two parts of it overlap at byte " + std::to_string(begin));
    used += behind - begin;
    end = std::max(end, behind);
  }
  FailIf(end > this->Bytes,
    "the file is cut off: its pixels end at byte " + std::to_string(end) + ", the file at byte " +
      std::to_string(this->Bytes));
  std::uint16_t inner = 0;
  std::uint64_t* ofInner = nullptr;
  TIFF* file = this->File.get();
  // Smaller copies within a page are not counted.
  const bool hasInner = TIFFSetSubDirectory(file, this->Places[0]) == 1 &&
    TIFFGetField(file, TIFFTAG_SUBIFD, &inner, &ofInner) == 1;
  const std::uint64_t unused = this->Bytes - std::min(this->Bytes, used + others);
  FailIf(!hasInner && unused >= page,
    "the file is damaged, or no chain of pages: " + std::to_string(unused) +
      " bytes, among them pixels, are in none of its pages");
}

/** Which pages are the slices and channels of the time that is wanted. @param order of the pages */
void TiffPages::TakeVolume(
  const VolumeChoice& choice, std::uint64_t times, const std::string& order)
{
  const std::uint64_t each = Times(this->Channels, times);
  FailIf(this->Pages() % each != 0,
    "it tells of " + std::to_string(this->Channels) + " channels and " + std::to_string(times) +
      " times, of which its " + std::to_string(this->Pages()) + " pages are no multiple");
  const std::uint64_t slices = this->Pages() / each;
  std::size_t stride = 1;
  std::size_t toTime = 0;
  for (const char axis : order)
  {
    (axis == 'Z' ? this->Strides[0] : axis == 'C' ? this->Strides[1] : toTime) = stride;
    stride *= static_cast<std::size_t>(axis == 'Z' ? slices : axis == 'C' ? this->Channels : times);
  }
  this->FirstPage = toTime * static_cast<std::size_t>(TimeOf(choice, times));
  this->Size[2] = static_cast<int>(slices);
}

void TiffPages::CopyPart(const std::vector<char>& part, std::uint32_t x, std::uint32_t y,
  std::uint32_t width, std::uint32_t height, std::uint16_t sample, char* pixels) const
{
  const std::size_t bytes = this->SampleBytes();
  const bool isApart = this->First.Planes == PLANARCONFIG_SEPARATE && this->First.Samples > 1;
  const std::size_t all = this->First.Samples;
  const std::size_t run = (isApart ? 1 : all) * bytes; // of a pixel
  const std::uint32_t columns = std::min(width, this->First.Width - x);
  const std::uint32_t rows = std::min(height, this->First.Height - y);
  const std::size_t bits = this->First.Bits;
  const std::size_t rowBytes = bits < 8 ? (width * bits + 7) / 8 : width * run;
  for (std::uint32_t row = 0; row < rows; ++row)
  {
    const char* from = part.data() + row * rowBytes;
    const std::size_t pixel = static_cast<std::size_t>(y + row) * this->First.Width + x;
    char* to = pixels + pixel * all * bytes + (isApart ? sample * bytes : 0);
    for (std::uint32_t column = 0; column < columns; ++column)
    {
      if (bits < 8)
      {
        const std::size_t bit = column * bits;
        const unsigned int octet = static_cast<unsigned char>(from[bit / 8]);
        to[column] = static_cast<char>(octet >> (8 - bits - bit % 8) & ((1u << bits) - 1u));
      }
      else
      {
        std::memcpy(to + column * all * bytes, from + column * run, run);
      }
    }
  }
}

void TiffPages::ReadPage(std::size_t page, char* pixels)
{
  TIFF* file = this->File.get();
  if (this->Stacked > 0)
  {
    const std::size_t bytes = static_cast<std::size_t>(this->First.Width) * this->First.Height *
      this->First.Samples * this->SampleBytes();
    FailIf(!OpenData(TIFFFileName(file), this->StackBegin + page * bytes)
              .read(pixels, static_cast<std::streamsize>(bytes)),
      "it is cut off");
    return;
  }
  FailIf(
    TIFFSetSubDirectory(file, this->Places[page]) != 1, "its directory cannot be read" + Reason());
  if (Tag<std::uint16_t>(file, TIFFTAG_COMPRESSION, 1) == COMPRESSION_JPEG)
  {
    TIFFSetField(file, TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
  }
  const bool isTiled = TIFFIsTiled(file) != 0;
  const std::uint32_t width =
    isTiled ? Tag<std::uint32_t>(file, TIFFTAG_TILEWIDTH, 0) : this->First.Width;
  const std::uint32_t height = isTiled
    ? Tag<std::uint32_t>(file, TIFFTAG_TILELENGTH, 0)
    : std::min(
        Tag<std::uint32_t>(file, TIFFTAG_ROWSPERSTRIP, this->First.Height), this->First.Height);
  FailIf(width == 0 || height == 0, "its strips or tiles are none");
  const std::uint32_t across = (this->First.Width - 1) / width + 1;
  const std::uint32_t down = (this->First.Height - 1) / height + 1;
  const tmsize_t size = isTiled ? TIFFTileSize(file) : TIFFStripSize(file);
  const auto planes = static_cast<std::uint16_t>(
    this->First.Planes == PLANARCONFIG_SEPARATE ? this->First.Samples : 1);
  FailIf(size <= 0 || static_cast<std::uint64_t>(size) > std::numeric_limits<int>::max(),
    "its strips or tiles have no size" + Reason());
  std::vector<char> part(static_cast<std::size_t>(size));
  for (std::uint32_t i = 0; i < across * down * planes; ++i)
  {
    const std::uint32_t place = i % (across * down);
    const std::uint32_t y = place / across * height;
    const std::uint32_t rows = std::min(height, this->First.Height - y);
    const tmsize_t needed = isTiled ? size : TIFFVStripSize(file, rows);
    const tmsize_t got = isTiled ? TIFFReadEncodedTile(file, i, part.data(), size)
                                 : TIFFReadEncodedStrip(file, i, part.data(), needed);
    FailIf(got < needed,
      "a strip or tile gives " + std::to_string(got) + " bytes, " + std::to_string(needed) +
        " are needed: it is damaged or cut off" + Reason());
    this->CopyPart(part, place % across * width, y, width, rows,
      static_cast<std::uint16_t>(i / (across * down)), pixels);
  }
}

vtkSmartPointer<vtkDataArray> TiffPages::Read(int first, int count)
{
  const Listening listening;
  auto values = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(this->Type));
  const std::size_t area =
    static_cast<std::size_t>(this->First.Width) * static_cast<std::size_t>(this->First.Height);
  const std::size_t pixel = this->First.Samples * this->SampleBytes();
  values->SetName(this->ArrayName.c_str());
  values->SetNumberOfComponents(this->Components);
  values->SetNumberOfTuples(static_cast<vtkIdType>(area) * count);
  char* to = static_cast<char*>(values->GetVoidPointer(0));
  std::vector<char> channel(this->Channels > 1 ? area * pixel : 0);
  for (int i = 0; i < count; ++i)
  {
    char* slice = to + static_cast<std::size_t>(i) * area * pixel * this->Channels;
    for (std::size_t c = 0; c < this->Channels; ++c)
    {
      const std::size_t page = this->FirstPage +
        static_cast<std::size_t>(first + i) * this->Strides[0] + c * this->Strides[1];
      Named("page " + std::to_string(page + 1),
        [&] { this->ReadPage(page, this->Channels > 1 ? channel.data() : slice); });
      for (std::size_t k = 0; this->Channels > 1 && k < area; ++k)
      {
        std::memcpy(slice + (k * this->Channels + c) * pixel, channel.data() + k * pixel, pixel);
      }
    }
  }
  if (this->Stacked > 0)
  {
    ToNativeOrder(values, TIFFIsBigEndian(this->File.get()) != 0);
  }
  if (this->First.Colours == PHOTOMETRIC_MINISWHITE && this->First.Bits <= 16)
  {
    const double most = (1u << this->First.Bits) - 1u;
    for (vtkIdType i = 0; i < values->GetNumberOfTuples(); ++i)
    {
      values->SetComponent(i, 0, most - values->GetComponent(i, 0));
    }
  }
  return values;
}
}

bool IsTiff(const std::string& name)
{
  BinaryFile file(name);
  const std::string mark = file.Size() < 8 ? "" : file.Text(0, 2);
  file.IsBig = mark == "MM";
  const std::uint64_t version = mark == "II" || mark == "MM" ? file.Number(2, 2) : 0;
  return version == 42 || version == 43;
}

std::unique_ptr<SlabReader> OpenTiff(const std::string& name, const Opening& opening)
{
  auto pages = std::make_unique<TiffPages>(name, opening.Choice);
  if (pages->HasChannels())
  {
    NeedComponent(pages->Components, "channels", opening);
  }
  const bool areHalves = pages->HasHalves();
  return AsFloats(std::move(pages), areHalves);
}
}
