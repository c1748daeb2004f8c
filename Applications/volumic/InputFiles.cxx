// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ReadVolume.h"

#include "BinaryFile.h"
#include "Texts.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>

namespace tool
{
namespace
{
namespace fs = std::filesystem;

/** The lines of a text header, which comes before any voxels. */
std::vector<std::string> HeaderLines(const std::string& name)
{
  std::error_code failed;
  const std::uintmax_t size = fs::file_size(name, failed);
  std::string head(failed ? 0 : std::min<std::uintmax_t>(size, LargestText), '\0');
  std::ifstream file(name, std::ios::binary);
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  std::istringstream text(head);
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);)
  {
    lines.push_back(line);
  }
  return lines;
}

/** The place in the lines of "key = value" or "key: value". */
std::size_t FindKey(const std::vector<std::string>& lines, const std::string& key)
{
  const auto found = std::find_if(
    lines.begin(), lines.end(), [&key](const std::string& line) { return IsOfKey(line, key); });
  return static_cast<std::size_t>(found - lines.begin());
}

/**
 * The files that a text header names: one, a pattern of them, or a list in the lines that follow.
 */
void AddNamed(const std::string& name, const std::string& key, std::vector<std::string>& files)
{
  const fs::path folder = fs::path(name).parent_path();
  const std::vector<std::string> lines = HeaderLines(name);
  const std::string value = HeaderValue(name, key);
  const std::string first = value.substr(0, value.find(' '));
  if (first == "LIST")
  {
    for (std::size_t i = FindKey(lines, key) + 1; i < lines.size(); ++i)
    {
      files.push_back((folder / Trimmed(lines[i])).string());
    }
  }
  else if (first.find('%') != std::string::npos)
  {
    const std::vector<std::string> matched = MatchFiles((folder / first).string());
    files.insert(files.end(), matched.begin(), matched.end());
  }
  else if (!value.empty())
  {
    files.push_back((folder / value).string());
  }
}

/** The files that a header of one of the formats in two parts tells of. */
void AddCompanions(const std::string& name, std::vector<std::string>& files)
{
  const std::string lower = Lower(name);
  const fs::path folder = fs::path(name).parent_path();
  if (EndsWith(lower, ".mhd") || EndsWith(lower, ".mha"))
  {
    AddNamed(name, "ElementDataFile", files);
  }
  else if (EndsWith(lower, ".nhdr") || EndsWith(lower, ".nrrd"))
  {
    AddNamed(name, "data file", files);
    AddNamed(name, "datafile", files);
  }
  else if (EndsWith(lower, ".pvti"))
  {
    const std::string mark = "Source=\"";
    for (const std::string& line : HeaderLines(name))
    {
      const std::size_t at = line.find(mark);
      const std::size_t begin = at == std::string::npos ? line.size() : at + mark.size();
      const std::size_t end = line.find('"', begin);
      if (end != std::string::npos)
      {
        files.push_back((folder / line.substr(begin, end - begin)).string());
      }
    }
  }
  for (const std::string end : { ".img", ".img.gz", ".hdr", ".hdr.gz" })
  {
    if (EndsWith(lower, end))
    {
      const std::string stem = name.substr(0, name.size() - end.size());
      for (const char* other : { ".img", ".img.gz", ".hdr", ".hdr.gz" })
      {
        files.push_back(stem + other);
      }
    }
  }
}
}

std::vector<std::string> FilesOfFolder(const std::string& folder, bool isNested)
{
  const std::vector<std::string> files = FilesOf(folder);
  const auto slicesAmong = [](const std::vector<std::string>& all)
  {
    std::vector<std::string> slices;
    std::copy_if(all.begin(), all.end(), std::back_inserter(slices), IsDicom);
    return slices;
  };
  // Networks write a folder for each patient, study and series.
  std::vector<std::string> slices = slicesAmong(files);
  if (isNested && (files.empty() || !slices.empty()))
  {
    slices = slicesAmong(FilesOf(folder, true));
  }
  return slices.empty() ? files : slices;
}

std::vector<std::string> FilesBesideSlice(const std::string& slice)
{
  const std::string folder = fs::path(slice).parent_path().string();
  const bool isDirectory = Lower(fs::path(slice).filename().string()) == "dicomdir";
  return FilesOfFolder(folder.empty() ? "." : folder, isDirectory);
}

bool IsDicom(const std::string& file)
{
  // GDCM takes some other files for old DICOM without this mark.
  std::ifstream stream(file, std::ios::binary);
  char head[132];
  return stream.read(head, sizeof(head)) && std::memcmp(head + 128, "DICM", 4) == 0;
}

bool IsLikeSlice(const std::string& file, const std::vector<std::string>& slices)
{
  const auto withoutNumbers = [](const std::string& name)
  {
    std::string path = std::filesystem::path(name).filename().string();
    std::replace_if(
      path.begin(), path.end(), [](char c) { return c >= '0' && c <= '9'; }, '0');
    path.erase(
      std::unique(path.begin(), path.end(), [](char a, char b) { return a == '0' && b == '0'; }),
      path.end());
    return path;
  };
  const std::string suffix = SuffixOf(file);
  if (slices.empty() || suffix == ".dcm" || suffix == ".dicom" || suffix == ".ima")
  {
    return !slices.empty();
  }
  // A preamble of zeros, most often, and a mark; the length of the first group.
  BinaryFile bytes(file);
  const std::string head = bytes.Text(0, std::min<std::uint64_t>(bytes.Size(), 136));
  const bool isPreamble = head.find_first_not_of('\0') == std::string::npos;
  const bool isMarked = head.size() == 136 && head.compare(132, 4, "\2\0\0\0", 4) == 0;
  const std::string like = withoutNumbers(file);
  return isMarked ||
    std::any_of(slices.begin(), slices.end(),
      [&](const std::string& slice)
      { return withoutNumbers(slice) == like || (isPreamble && SuffixOf(slice) == suffix); });
}

bool IsOfKey(const std::string& line, const std::string& key)
{
  const std::size_t sign = line.find_first_of("=:");
  return sign != std::string::npos && Lower(Trimmed(line.substr(0, sign))) == Lower(key);
}

std::string HeaderValue(const std::string& name, const std::string& key)
{
  const std::vector<std::string> lines = HeaderLines(name);
  const std::size_t line = FindKey(lines, key);
  return line == lines.size() ? ""
                              : Trimmed(lines[line].substr(lines[line].find_first_of("=:") + 1));
}

std::vector<std::string> FilesOfVolume(const std::string& name)
{
  std::vector<std::string> files;
  try
  {
    if (fs::is_directory(name))
    {
      return FilesOfFolder(name);
    }
    if (!fs::exists(name))
    {
      return name.find_first_of("%*") == std::string::npos ? files : MatchFiles(name);
    }
    files.push_back(name);
    if (!fs::is_regular_file(name))
    {
      return files;
    }
    if (IsDicom(name))
    {
      const std::vector<std::string> series = FilesBesideSlice(name);
      files.insert(files.end(), series.begin(), series.end());
    }
    AddCompanions(name, files);
  }
  catch (const std::exception&)
  {
    // An unreadable folder, which ReadVolume tells of.
  }
  return files;
}

void NeedFilesOfVolume(const std::string& name)
{
  const std::vector<std::string> files = FilesOfVolume(name);
  std::for_each(files.begin(), files.end(), NeedFile);
}
}
