// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// What DICOM files tell (PS3.3), by GDCM, which comes with ITK.
#include "DicomFiles.h"

#include "BinaryFile.h"
#include "Texts.h"
#include "ToolErrors.h"

#include <vtkDataArray.h>

#include <gdcmImage.h>
#include <gdcmMediaStorage.h>
#include <gdcmReader.h>
#include <gdcmSequenceOfItems.h>
#include <gdcmTrace.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>

namespace tool
{
namespace
{
using gdcm::Tag;

const Tag PixelData(0x7FE0, 0x0010);

/** The items of a sequence; empty for other elements. */
std::vector<gdcm::DataSet> ItemsOf(const gdcm::DataElement& element)
{
  std::vector<gdcm::DataSet> items;
  if (const gdcm::SmartPointer<gdcm::SequenceOfItems> sequence = element.GetValueAsSQ())
  {
    for (std::size_t i = 1; i <= sequence->GetNumberOfItems(); ++i)
    {
      items.push_back(sequence->GetItem(i).GetNestedDataSet());
    }
  }
  return items;
}

std::vector<gdcm::DataSet> ItemsAt(const gdcm::DataSet& set, const Tag& tag)
{
  return set.FindDataElement(tag) ? ItemsOf(set.GetDataElement(tag)) : std::vector<gdcm::DataSet>();
}

/** What is told of a frame: by itself, by what all frames share, or by the file. */
class Attributes
{
public:
  explicit Attributes(const gdcm::DataSet& file) : Sets{ file } {}

  /** Go before what there is: each is a sequence of one item. */
  void Add(const gdcm::DataSet& groups)
  {
    std::vector<gdcm::DataSet> found;
    for (const gdcm::DataElement& element : groups.GetDES())
    {
      const std::vector<gdcm::DataSet> items = ItemsOf(element);
      found.insert(found.end(), items.begin(), items.size() == 1 ? items.end() : items.begin());
    }
    this->Sets.insert(this->Sets.begin(), found.begin(), found.end());
  }

  std::string Bytes(const Tag& tag) const
  {
    for (const gdcm::DataSet& set : this->Sets)
    {
      const gdcm::ByteValue* value =
        set.FindDataElement(tag) ? set.GetDataElement(tag).GetByteValue() : nullptr;
      if (value && value->GetPointer())
      {
        return { value->GetPointer(), value->GetLength() };
      }
    }
    return "";
  }

  /** Without the blanks or the zero that make its length even. */
  std::string Text(const Tag& tag) const
  {
    std::string text = this->Bytes(tag);
    text.resize(std::min(text.size(), text.find('\0')));
    return Trimmed(text);
  }

  /** A binary number of two bytes or more. */
  int Number(const Tag& tag, int otherwise) const
  {
    const std::string bytes = this->Bytes(tag);
    return bytes.size() < 2 ? otherwise : static_cast<int>(NumberOf(bytes.substr(0, 4), false));
  }

  /** The decimal numbers between backslashes. @throws Failure if one is none. */
  std::vector<double> Decimals(const Tag& tag, const char* name) const
  {
    const std::string text = this->Text(tag);
    std::istringstream parts(text);
    std::vector<double> numbers;
    for (std::string part; std::getline(parts, part, '\\');)
    {
      const std::optional<double> number = AsNumber<double>(Trimmed(part));
      FailIf(!number, std::string("its header is damaged: ") + name + " '" + text + "'");
      numbers.push_back(*number);
    }
    return numbers;
  }

  double Decimal(const Tag& tag, const char* name, double otherwise) const
  {
    const std::vector<double> numbers = this->Decimals(tag, name);
    return numbers.empty() ? otherwise : numbers[0];
  }

private:
  std::vector<gdcm::DataSet> Sets;
};

/** Between columns and between rows; the file has that of the rows first. */
std::optional<std::array<double, 2>> SpacingAt(
  const Attributes& all, const Tag& tag, const char* name)
{
  const std::vector<double> numbers = all.Decimals(tag, name);
  FailIf(!numbers.empty() && (numbers.size() < 2 || !(numbers[0] > 0.0 && numbers[1] > 0.0)),
    std::string("its header is damaged: ") + name + " '" + all.Text(tag) + "'");
  return numbers.empty() ? std::nullopt
                         : std::optional<std::array<double, 2>>({ numbers[1], numbers[0] });
}

void TakePlace(const Attributes& all, DicomSlice& slice)
{
  const std::vector<double> position = all.Decimals(Tag(0x0020, 0x0032), "position");
  if (position.size() == 3)
  {
    slice.Position = Vector3{ position[0], position[1], position[2] };
  }
  const std::vector<double> axes = all.Decimals(Tag(0x0020, 0x0037), "orientation");
  if (axes.size() == 6)
  {
    slice.Axes = { { { axes[0], axes[1], axes[2] }, { axes[3], axes[4], axes[5] } } };
  }
  slice.Spacing = SpacingAt(all, Tag(0x0028, 0x0030), "spacing");
  slice.ImagerSpacing = SpacingAt(all, Tag(0x0018, 0x1164), "imager spacing");
  slice.Thickness = all.Decimal(Tag(0x0018, 0x0050), "thickness", 0.0);
}

/** Of a frame, or of the only one. */
DicomSlice SliceOf(const std::string& file, std::size_t frame, const Attributes& all)
{
  DicomSlice slice;
  slice.File = file;
  slice.Frame = frame;
  slice.Size = { all.Number(Tag(0x0028, 0x0011), 0), all.Number(Tag(0x0028, 0x0010), 0) };
  TakePlace(all, slice);
  slice.Slope = all.Decimal(Tag(0x0028, 0x1053), "slope", 1.0);
  slice.Shift = all.Decimal(Tag(0x0028, 0x1052), "intercept", 0.0);
  const std::string padding = all.Bytes(Tag(0x0028, 0x0120));
  if (padding.size() == 2)
  {
    const auto number = static_cast<std::uint16_t>(NumberOf(padding, false));
    const bool isSigned = all.Number(Tag(0x0028, 0x0103), 0) == 1;
    slice.Padding = isSigned ? static_cast<std::int16_t>(number) : number;
  }
  // Temporal position, trigger, echo; what orders the rest.
  slice.Time = { static_cast<double>(all.Number(Tag(0x0020, 0x9128), 0)),
    all.Decimal(Tag(0x0018, 0x1060), "trigger time", 0.0),
    all.Decimal(Tag(0x0018, 0x0081), "echo time", 0.0),
    all.Decimal(Tag(0x0020, 0x0013), "number", 0.0) };
  slice.Segment = all.Number(Tag(0x0062, 0x000B), 0);
  return slice;
}

/** Of a frame that tells no place of its own: one behind the other. */
void PlaceFrame(const Attributes& all, DicomSlice& slice)
{
  const double between = all.Decimal(Tag(0x0018, 0x0088), "spacing between slices", 0.0);
  const double distance = between > 0.0 ? between : slice.Thickness > 0.0 ? slice.Thickness : 1.0;
  slice.Axes = slice.Axes.value_or(std::array<Vector3, 2>{ { { 1, 0, 0 }, { 0, 1, 0 } } });
  slice.Position = slice.Position.value_or(Vector3{ 0, 0, 0 });
  const Vector3 normal = Cross((*slice.Axes)[0], (*slice.Axes)[1]);
  for (std::size_t c = 0; c < 3; ++c)
  {
    (*slice.Position)[c] += distance * static_cast<double>(slice.Frame) * normal[c];
  }
  slice.IsGuessed = true;
}

std::size_t FramesOf(const Attributes& all)
{
  const std::string text = all.Text(Tag(0x0028, 0x0008));
  const std::optional<int> frames = AsNumber<int>(text.empty() ? "1" : text);
  FailIf(!frames || *frames < 1, "its header is damaged: the number of frames is '" + text + "'");
  return static_cast<std::size_t>(*frames);
}

/** Without a table of colours: CIELab as DICOM scales it, to sRGB. */
std::optional<Vector3> ColorOf(const std::string& lab)
{
  if (lab.size() != 6)
  {
    return std::nullopt;
  }
  const auto at = [&lab](std::size_t i)
  { return static_cast<double>(NumberOf(lab.substr(2 * i, 2), false)) / 65535.0; };
  const double l = (100.0 * at(0) + 16.0) / 116.0;
  const auto curve = [](double t)
  { return t > 6.0 / 29.0 ? t * t * t : 3.0 * 36.0 / 841.0 * (t - 4.0 / 29.0); };
  const double x = 0.9505 * curve(l + (255.0 * at(1) - 128.0) / 500.0);
  const double y = curve(l);
  const double z = 1.089 * curve(l - (255.0 * at(2) - 128.0) / 200.0);
  const auto gamma = [](double c)
  {
    c = std::min(1.0, std::max(0.0, c));
    c = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055;
    return std::round(255.0 * c) / 255.0;
  };
  return Vector3{ gamma(3.2406 * x - 1.5372 * y - 0.4986 * z),
    gamma(-0.9689 * x + 1.8758 * y + 0.0415 * z), gamma(0.0557 * x - 0.2040 * y + 1.0570 * z) };
}

LabelNames SegmentsOf(const gdcm::DataSet& file)
{
  LabelNames segments;
  for (const gdcm::DataSet& item : ItemsAt(file, Tag(0x0062, 0x0002)))
  {
    const Attributes all(item);
    segments.push_back({ all.Number(Tag(0x0062, 0x0004), 0),
      PlainName(all.Text(Tag(0x0062, 0x0005))), ColorOf(all.Bytes(Tag(0x0062, 0x000D))) });
  }
  return segments;
}

/** @throws Failure, without the name, unless GDCM can read so much of the file. */
template <class Work>
void NeedDicom(const Work& work, const char* what)
{
  gdcm::Trace::WarningOff(); // Their reasons are told here.
  gdcm::Trace::ErrorOff();
  bool isRead = false;
  try
  {
    isRead = work();
  }
  catch (const std::bad_alloc&)
  {
    throw;
  }
  catch (const std::exception&)
  {
    // As if it had said so.
  }
  FailIf(!isRead, what);
}

/** Reads what comes before the pixels, and adds the slices to their series. */
void AddFile(const std::string& file, std::vector<DicomSeries>& all)
{
  CheckDicom(file);
  gdcm::Reader reader;
  reader.SetFileName(file.c_str());
  NeedDicom([&reader] { return reader.ReadUpToTag(PixelData); },
    "is cut off within its header, or that is damaged; copy it again");
  const gdcm::DataSet& set = reader.GetFile().GetDataSet();
  const Attributes ofFile(set);
  if (!set.FindDataElement(Tag(0x0028, 0x0010)))
  {
    gdcm::MediaStorage kind;
    const bool isKnown = kind.SetFromFile(reader.GetFile());
    FailIf(!isKnown || gdcm::MediaStorage::IsImage(kind),
      "has no pixels: it is cut off, or no slice; replace it, or take it out of the folder");
    return; // a directory, a report
  }
  const std::string identifier = ofFile.Text(Tag(0x0020, 0x000E));
  const auto found = std::find_if(all.begin(), all.end(),
    [&identifier](const DicomSeries& each) { return each.Identifier == identifier; });
  DicomSeries& series = found != all.end() ? *found : all.emplace_back();
  if (series.Slices.empty())
  {
    series.Identifier = identifier;
    series.Description = PlainName(ofFile.Text(Tag(0x0008, 0x103E)));
    const std::string date = ofFile.Text(Tag(0x0008, 0x0021));
    series.Date = date.empty() ? ofFile.Text(Tag(0x0008, 0x0020)) : date;
    series.Modality = ofFile.Text(Tag(0x0008, 0x0060));
    series.Segments = SegmentsOf(set);
  }
  const std::size_t frames = FramesOf(ofFile);
  FailIf(frames > std::max<std::uint64_t>(1, std::filesystem::file_size(file) / 8),
    "its header is damaged, or the file is cut off: " + std::to_string(frames) + " frames");
  const std::vector<gdcm::DataSet> shared = ItemsAt(set, Tag(0x5200, 0x9229));
  const std::vector<gdcm::DataSet> own = ItemsAt(set, Tag(0x5200, 0x9230));
  FailIf(!own.empty() && own.size() != frames,
    "its header is damaged: it tells of " + std::to_string(own.size()) + " of " +
      std::to_string(frames) + " frames");
  Attributes common = ofFile;
  if (!shared.empty())
  {
    common.Add(shared.front());
  }
  for (std::size_t frame = 0; frame < frames; ++frame)
  {
    Attributes ofFrame = common;
    if (!own.empty())
    {
      ofFrame.Add(own[frame]);
    }
    series.Slices.push_back(SliceOf(file, frame, ofFrame));
    if (own.empty() && frames > 1)
    {
      PlaceFrame(ofFile, series.Slices.back());
    }
  }
}

/** What unpacks the pixels, if they are such as it can. */
gdcm::Image ImageOf(const gdcm::File& file, const DicomSlice& slice, std::size_t frames)
{
  const Attributes all(file.GetDataSet());
  const int samples = all.Number(Tag(0x0028, 0x0002), 1);
  const int bits = all.Number(Tag(0x0028, 0x0100), 0);
  FailIf(samples != 1, NumberText(samples) + " components per pixel; one is needed");
  FailIf(bits != 1 && bits != 8 && bits != 16 && bits != 32,
    NumberText(bits) + " bits per pixel; 1, 8, 16 and 32 are read");
  const int stored = std::min(bits, std::max(1, all.Number(Tag(0x0028, 0x0101), bits)));
  const int high =
    std::min(bits - 1, std::max(stored - 1, all.Number(Tag(0x0028, 0x0102), bits - 1)));
  gdcm::Image image;
  image.SetNumberOfDimensions(frames > 1 ? 3 : 2);
  image.SetDimension(0, static_cast<unsigned int>(slice.Size[0]));
  image.SetDimension(1, static_cast<unsigned int>(slice.Size[1]));
  if (frames > 1)
  {
    image.SetDimension(2, static_cast<unsigned int>(frames));
  }
  image.SetPixelFormat(
    gdcm::PixelFormat(static_cast<unsigned short>(samples), static_cast<unsigned short>(bits),
      static_cast<unsigned short>(stored), static_cast<unsigned short>(high),
      static_cast<unsigned short>(bits > 1 && all.Number(Tag(0x0028, 0x0103), 0) == 1 ? 1 : 0)));
  image.SetPhotometricInterpretation(gdcm::PhotometricInterpretation::MONOCHROME2);
  const gdcm::TransferSyntax& syntax = file.GetHeader().GetDataSetTransferSyntax();
  image.SetTransferSyntax(syntax);
  image.SetNeedByteSwap(syntax == gdcm::TransferSyntax::ImplicitVRBigEndianPrivateGE);
  image.SetDataElement(file.GetDataSet().GetDataElement(PixelData));
  return image;
}
}

std::string DicomSeries::Text(std::size_t number) const
{
  std::string text = NumberText(static_cast<int>(number)) + ": " +
    (this->Description.empty() ? "unnamed" : this->Description);
  for (const std::string& more : { this->Modality, this->Date })
  {
    text += more.empty() ? "" : ", " + more;
  }
  // Phases, echoes or times; segments lie at one place, too.
  std::map<Vector3, int> places;
  int most = 0;
  for (const DicomSlice& slice : this->Slices)
  {
    most = slice.Position ? std::max(most, ++places[*slice.Position]) : most;
  }
  const DicomSlice& first = this->Slices.front();
  return text + ", " + std::to_string(this->Slices.size()) +
    (this->Slices.size() == 1 ? " slice of " : " slices of ") + NumberText(first.Size[0]) + " x " +
    NumberText(first.Size[1]) +
    (most > 1 && this->Segments.empty() ? ", " + NumberText(most) + " at each place (--time)"
                                        : "") +
    ", from " + std::filesystem::path(first.File).filename().string();
}

std::vector<DicomSeries> DicomSeriesOf(const std::vector<std::string>& files)
{
  std::vector<DicomSeries> series;
  for (const std::string& file : files)
  {
    Named(file, [&] { AddFile(file, series); });
  }
  return series;
}

vtkSmartPointer<vtkDataArray> DicomPixels::Read(const DicomSlice& slice)
{
  const auto area =
    static_cast<std::uint64_t>(slice.Size[0]) * static_cast<std::uint64_t>(slice.Size[1]);
  if (this->File != slice.File)
  {
    Named(slice.File, [&] { this->Load(slice); });
    this->File = slice.File;
  }
  auto values = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(this->Type));
  values->SetNumberOfTuples(static_cast<vtkIdType>(area));
  char* to = static_cast<char*>(values->GetVoidPointer(0));
  if (this->AreBits)
  {
    for (std::uint64_t i = 0; i < area; ++i)
    {
      const std::uint64_t bit = area * slice.Frame + i;
      to[i] = static_cast<char>(static_cast<unsigned char>(this->Bytes[bit / 8]) >> bit % 8 & 1);
    }
    return values;
  }
  const std::uint64_t bytes = area * static_cast<std::uint64_t>(values->GetDataTypeSize());
  std::copy_n(this->Bytes.data() + bytes * slice.Frame, bytes, to);
  return values;
}

void DicomPixels::Load(const DicomSlice& slice)
{
  gdcm::Reader reader;
  reader.SetFileName(slice.File.c_str());
  NeedDicom([&reader] { return reader.Read(); },
    "is cut off or damaged: it does not end behind its pixels; copy it again");
  const gdcm::File& file = reader.GetFile();
  const gdcm::DataSet& set = file.GetDataSet();
  FailIf(!set.FindDataElement(PixelData),
    "has no pixels: it is cut off, or no slice; replace it, or take it out of the folder");
  const std::size_t frames = FramesOf(Attributes(set));
  const gdcm::Image image = ImageOf(file, slice, frames);
  static const std::map<int, int> types = { { gdcm::PixelFormat::UINT8, VTK_UNSIGNED_CHAR },
    { gdcm::PixelFormat::INT8, VTK_SIGNED_CHAR }, { gdcm::PixelFormat::UINT16, VTK_UNSIGNED_SHORT },
    { gdcm::PixelFormat::INT16, VTK_SHORT }, { gdcm::PixelFormat::UINT32, VTK_UNSIGNED_INT },
    { gdcm::PixelFormat::INT32, VTK_INT }, { gdcm::PixelFormat::SINGLEBIT, VTK_UNSIGNED_CHAR } };
  this->AreBits = image.GetPixelFormat().GetBitsAllocated() == 1;
  const gdcm::PixelFormat::ScalarType kind =
    this->AreBits ? gdcm::PixelFormat::SINGLEBIT : image.GetPixelFormat().GetScalarType();
  this->Type = EntryOf(types, kind, "its pixels are no numbers");
  const std::uint64_t pixels = Times(
    Times(static_cast<std::uint64_t>(slice.Size[0]), static_cast<std::uint64_t>(slice.Size[1])),
    frames);
  FailIf(pixels == 0, "lacks its rows or columns: it is damaged, or no slice");
  const std::uint64_t needed = this->AreBits
    ? (pixels + 7) / 8
    : Times(pixels, static_cast<std::uint64_t>(vtkDataArray::GetDataTypeSize(this->Type)));
  const gdcm::DataElement& element = set.GetDataElement(PixelData);
  const std::uint64_t all = std::filesystem::file_size(slice.File);
  if (const gdcm::ByteValue* plain = element.GetByteValue())
  {
    const std::uint64_t there = plain->GetLength();
    FailIf(there < needed,
      "the pixels are cut off: " + std::to_string(there) + " bytes, " + std::to_string(needed) +
        " needed; copy the file again");
    // Odd numbers of bytes are made even.
    if (there > needed + needed % 2)
    {
      NeedJustBytes(there, needed);
    }
  }
  // As most as RLE or a code of images packs what is all alike; sizes are what a header says.
  NeedPackedBytes(all, this->AreBits ? 1 : 10000, needed);
  this->File.clear();
  this->Bytes.assign(
    std::max<std::uint64_t>(needed, this->AreBits ? 0 : image.GetBufferLength()), 0);
  if (this->AreBits)
  {
    const gdcm::ByteValue* plain = element.GetByteValue();
    FailIf(!plain, "its pixels of one bit are packed, which is not read");
    std::copy_n(plain->GetPointer(), needed, this->Bytes.data());
    return;
  }
  NeedDicom([&] { return image.GetBuffer(this->Bytes.data()); },
    ("its pixels cannot be unpacked (" + std::string(image.GetTransferSyntax().GetString()) +
      "): they are damaged, or packed in a way that is not read; try gdcmconv --raw")
      .c_str());
}
}
