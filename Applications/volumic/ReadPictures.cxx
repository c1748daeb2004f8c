// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ReadVolume.h"

#include "CheckInputs.h"
#include "Messages.h"
#include "SlabReader.h"
#include "Texts.h"
#include "ToolErrors.h"

#include <vtkBMPReader.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkImageReader2.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnsignedCharArray.h>
#include <vtk_png.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <iterator>
#include <memory>
#include <set>

namespace tool
{
namespace
{
bool IsDigit(char c)
{
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

/** The number that starts at `at`, without leading zeros; `at` moves behind it. */
std::string TakeDigits(const std::string& text, std::size_t& at)
{
  while (at < text.size() && text[at] == '0')
  {
    ++at;
  }
  const std::size_t start = at;
  while (at < text.size() && IsDigit(text[at]))
  {
    ++at;
  }
  return text.substr(start, at - start);
}

/** Whether a comes before b where runs of digits count as numbers. */
bool IsBefore(const std::string& a, const std::string& b)
{
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size())
  {
    if (IsDigit(a[i]) && IsDigit(b[j]))
    {
      const std::string m = TakeDigits(a, i);
      const std::string n = TakeDigits(b, j);
      if (m != n)
      {
        return m.size() != n.size() ? m.size() < n.size() : m < n;
      }
    }
    else if (a[i] != b[j])
    {
      return a[i] < b[j];
    }
    else
    {
      ++i;
      ++j;
    }
  }
  const bool isEndOfA = i == a.size();
  return isEndOfA == (j == b.size()) ? a < b : isEndOfA;
}

/** The length of "%d", "%03d" and the like, if one begins here; 0 else. */
std::size_t NumberMark(const std::string& pattern, std::size_t at)
{
  const std::size_t end =
    pattern[at] == '%' ? pattern.find_first_not_of("0123456789", at + 1) : std::string::npos;
  const bool isMark =
    end != std::string::npos && (pattern[end] == 'd' || pattern[end] == 'i' || pattern[end] == 'u');
  return isMark ? end + 1 - at : 0;
}

/**
 * Whether a name is as a pattern with '*' and '%d' has it. A pattern may come out of a file: the
 * time is that of its length times the name's, whatever it is.
 */
bool Matches(const std::string& name, const std::string& pattern)
{
  // Where in the name one may be by now: behind so many of its characters.
  std::vector<bool> reached(name.size() + 1, false);
  reached[0] = true;
  for (std::size_t at = 0; at < pattern.size(); ++at)
  {
    const std::size_t mark = NumberMark(pattern, at);
    std::vector<bool> next(name.size() + 1, false);
    next[0] = pattern[at] == '*' && reached[0];
    for (std::size_t i = 0; i < name.size(); ++i)
    {
      next[i + 1] = pattern[at] == '*' ? reached[i + 1] || next[i]
        : mark > 0                     ? IsDigit(name[i]) && (reached[i] || next[i])
                                       : name[i] == pattern[at] && reached[i];
    }
    reached.swap(next);
    at += mark > 0 ? mark - 1 : 0;
  }
  return reached.back();
}

/** The pixels of a picture, whose rows VTK's readers turn upside down. */
struct Picture
{
  std::array<int, 2> Size = { 0, 0 };
  vtkSmartPointer<vtkDataArray> Pixels;
  bool IsTurned = true;
};

/** Whether the pixels of a PNG are numbers of a palette. */
bool IsOfPalette(const std::string& file)
{
  BinaryFile bytes(file);
  return bytes.Size() > 25 && bytes.Text(1, 3) == "PNG" && bytes.Number(25, 1) == 3;
}

/** Those numbers; VTK's reader gives their colours alone. */
Picture ReadIndices(const std::string& file)
{
  png_image image = {};
  image.version = PNG_IMAGE_VERSION;
  Picture picture;
  picture.IsTurned = false;
  bool isRead = png_image_begin_read_from_file(&image, file.c_str()) != 0;
  if (isRead)
  {
    image.format = PNG_FORMAT_RGBA_COLORMAP;
    picture.Size = { static_cast<int>(image.width), static_cast<int>(image.height) };
    const vtkNew<vtkUnsignedCharArray> pixels;
    pixels->SetName("PNGImage"); // as VTK's reader calls them
    pixels->SetNumberOfValues(static_cast<vtkIdType>(image.width) * image.height);
    picture.Pixels = pixels;
    std::vector<png_byte> colours(PNG_IMAGE_COLORMAP_SIZE(image));
    isRead = png_image_finish_read(&image, nullptr, pixels->GetPointer(0), 0, colours.data()) != 0;
  }
  png_image_free(&image);
  FailIf(!isRead, file + ": cannot be read (" + image.message + ")");
  return picture;
}

/** Whether the palette of a BMP is that of grey values, which scanners write. */
bool IsOfGreys(const std::string& file)
{
  std::string greys;
  for (int i = 0; i < 256; ++i)
  {
    greys += std::string(3, static_cast<char>(i)) + '\0';
  }
  BinaryFile bytes(file);
  const std::uint64_t place = 14 + bytes.Number(14, 4);
  return bytes.Size() > place + greys.size() && bytes.Text(place, greys.size()) == greys;
}

/** @param areLabels numbers of a palette are wanted, not their colours */
vtkSmartPointer<vtkImageReader2> PictureReader(const std::string& file, bool areLabels)
{
  const vtkSmartPointer<vtkImageReader2> reader = ReaderOf(file);
  if (auto* bitmap = vtkBMPReader::SafeDownCast(reader))
  {
    bitmap->SetAllow8BitBMP(areLabels || IsOfGreys(file));
  }
  return reader;
}

Picture ReadPicture(const std::string& file, bool areLabels)
{
  if (areLabels && IsOfPalette(file))
  {
    return ReadIndices(file);
  }
  Picture picture;
  if (IsTiff(file))
  {
    const std::unique_ptr<SlabReader> pages = Named(file, [&file] { return OpenTiff(file, {}); });
    picture.Size = { pages->Size[0], pages->Size[1] };
    picture.Pixels = Named(file, [&pages] { return pages->Read(0, 1); });
    picture.IsTurned = false;
    return picture;
  }
  const vtkSmartPointer<vtkImageReader2> reader = PictureReader(file, areLabels);
  reader->SetDataSpacing(1.0, 1.0, 1.0);
  VtkMessages messages;
  messages.UpdateReader(reader, file);
  vtkImageData* image = reader->GetOutput();
  picture.Size = { image->GetDimensions()[0], image->GetDimensions()[1] };
  picture.Pixels = image->GetPointData()->GetScalars();
  FailIf(!picture.Pixels, file + ": holds no picture");
  return picture;
}

/** Width, height, components and type of what one page holds. @throws Failure for damaged ones */
std::array<int, 4> CheckPicture(const std::string& file, bool areLabels)
{
  if (IsTiff(file))
  {
    const std::unique_ptr<SlabReader> pages = OpenTiff(file, {});
    FailIf(pages->Size[2] > 1 || pages->Components > 4,
      std::to_string(pages->Size[2]) + " pages; give it by its name, it is a volume");
    return { pages->Size[0], pages->Size[1], pages->Components, pages->Type };
  }
  CheckPixels(file);
  const vtkSmartPointer<vtkImageReader2> reader = PictureReader(file, areLabels);
  CheckChosen(reader, file);
  VtkMessages().AskReader(reader, file);
  const int* extent = reader->GetDataExtent();
  const bool areIndices = areLabels && IsOfPalette(file);
  return { extent[1] - extent[0] + 1, extent[3] - extent[2] + 1,
    areIndices ? 1 : reader->GetNumberOfScalarComponents(),
    areIndices ? VTK_UNSIGNED_CHAR : reader->GetDataScalarType() };
}

/** Those of files beside which lie lists and logs; or all, where none is named as a picture. */
std::vector<std::string> PicturesAmong(const std::vector<std::string>& files)
{
  static const std::set<std::string> known = { ".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp",
    ".pgm", ".ppm", ".pnm" };
  std::vector<std::string> pictures;
  std::copy_if(files.begin(), files.end(), std::back_inserter(pictures),
    [](const std::string& file) { return known.count(SuffixOf(file)) > 0; });
  if (!pictures.empty() && pictures.size() < files.size())
  {
    TellOfFile(std::to_string(files.size() - pictures.size()) +
      " files that are not named as "
      "pictures are left out");
  }
  return pictures.empty() ? files : pictures;
}

/** @throws Failure unless they are pictures of one kind and size. */
void CheckPictures(const std::vector<std::string>& files, bool areLabels)
{
  FailIf(files.empty(), "no pictures and no DICOM slices there");
  std::set<std::string> suffixes;
  for (const std::string& file : files)
  {
    suffixes.insert(SuffixOf(file));
  }
  if (suffixes.size() > 1)
  {
    throw Failure("files of several kinds (" + *suffixes.begin() + ", " + *suffixes.rbegin() +
      "); choose with a pattern, such as '*" + *suffixes.rbegin() + "'");
  }
  std::array<int, 4> size = { 0, 0, 0, 0 };
  for (const std::string& file : files)
  {
    const std::array<int, 4> own = Named(file, [&] { return CheckPicture(file, areLabels); });
    size = file == files.front() ? own : size;
    FailIf(own != size,
      file + ": its " +
        (std::equal(own.begin(), own.begin() + 2, size.begin()) ? "kind of values" : "size") +
        " differs from the first picture's");
  }
}

/** A slice per picture, whose rows follow each other downwards, as in TIFF of several pages. */
class PictureSlabs : public SlabReader
{
public:
  PictureSlabs(const std::vector<std::string>& files, bool areLabels)
    : Files(files), AreLabels(areLabels)
  {
    const Picture first = ReadPicture(files.front(), areLabels);
    this->Size = { first.Size[0], first.Size[1], static_cast<int>(files.size()) };
    this->Type = first.Pixels->GetDataType();
    this->Components = first.Pixels->GetNumberOfComponents();
    this->ArrayName = first.Pixels->GetName() ? first.Pixels->GetName() : "";
  }

  vtkSmartPointer<vtkDataArray> Read(int first, int count) override
  {
    auto stack = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(this->Type));
    stack->SetNumberOfComponents(this->Components);
    const vtkIdType area = static_cast<vtkIdType>(this->Size[0]) * this->Size[1];
    stack->SetNumberOfTuples(area * count);
    for (int i = 0; i < count; ++i)
    {
      const std::string& file = this->Files[static_cast<std::size_t>(first + i)];
      const Picture picture = ReadPicture(file, this->AreLabels);
      FailIf(picture.Size[0] != this->Size[0] || picture.Size[1] != this->Size[1] ||
          picture.Pixels->GetDataType() != this->Type ||
          picture.Pixels->GetNumberOfComponents() != this->Components,
        file + ": its values are of another type than the first picture's");
      for (int row = 0; row < this->Size[1]; ++row)
      {
        const vtkIdType width = this->Size[0];
        stack->InsertTuples(area * i + row * width, width,
          (picture.IsTurned ? this->Size[1] - 1 - row : row) * width, picture.Pixels);
      }
    }
    return stack;
  }

private:
  std::vector<std::string> Files;
  bool AreLabels;
};
}

std::vector<std::string> FilesOf(const std::string& folder, bool isNested)
{
  std::vector<std::string> files;
  const auto add = [&files](const std::filesystem::directory_entry& entry)
  {
    if (entry.is_regular_file() && entry.path().filename().string()[0] != '.')
    {
      files.push_back(entry.path().string());
    }
  };
  if (isNested)
  {
    const std::filesystem::recursive_directory_iterator all(
      folder, std::filesystem::directory_options::skip_permission_denied);
    std::for_each(begin(all), end(all), add);
  }
  else
  {
    const std::filesystem::directory_iterator all(folder);
    std::for_each(begin(all), end(all), add);
  }
  std::sort(files.begin(), files.end(), IsBefore);
  return files;
}

std::vector<std::string> MatchFiles(const std::string& pattern)
{
  const std::filesystem::path path(pattern);
  const std::string folder = path.parent_path().empty() ? "." : path.parent_path().string();
  const std::string wanted = path.filename().string();
  const std::size_t longest = 4096; // of what the system takes for a path
  std::vector<std::string> files =
    wanted.size() > longest ? std::vector<std::string>() : FilesOf(folder);
  files.erase(std::remove_if(files.begin(), files.end(),
                [&](const std::string& file)
                { return !Matches(std::filesystem::path(file).filename().string(), wanted); }),
    files.end());
  return files;
}

/** Colours or grey values with how much they cover. */
static void TellOfAlpha(const SlabReader& slabs, const Opening& opening)
{
  if (slabs.Components == 2 || slabs.Components == 4)
  {
    NeedComponent(
      slabs.Components, slabs.Components == 2 ? "grey and alpha" : "colour and alpha", opening);
  }
}

std::unique_ptr<SlabReader> OpenPictures(
  const std::vector<std::string>& all, const Opening& opening)
{
  const std::vector<std::string> files = PicturesAmong(all);
  const bool areLabels = opening.Choice.AreLabels;
  CheckPictures(files, areLabels);
  if (!areLabels && IsOfPalette(files.front()))
  {
    TellOfFile("the colours of its palette are taken; --labels takes the numbers of the palette");
  }
  auto slabs = std::make_unique<PictureSlabs>(files, areLabels);
  TellOfAlpha(*slabs, opening);
  return slabs;
}

std::unique_ptr<SlabReader> OpenByContent(const std::string& name, const Opening& opening)
{
  if (IsTiff(name))
  {
    auto pages = OpenTiff(name, opening);
    TellOfAlpha(*pages, opening);
    return pages;
  }
  CheckPixels(name); // before any reader of VTK looks at it
  const vtkSmartPointer<vtkImageReader2> reader = ReaderOf(name);
  CheckChosen(reader, name);
  if (reader->IsA("vtkNIFTIImageReader"))
  {
    return OpenNifti(name, opening);
  }
  auto slabs = std::make_unique<ReaderSlabs>(name, [name] { return ReaderOf(name); });
  slabs->HasParts = false;
  return slabs;
}
}
