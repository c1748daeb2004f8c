// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CheckInputs.h"

#include "BinaryFile.h"
#include "Inflate.h"
#include "InputFiles.h"
#include "ToolErrors.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <vector>

namespace tool
{
namespace
{
// ---- MetaImage ----------------------------------------------------------------------------------

/** Bytes of a value, by the name of its type; 0 for what is no number. */
std::uint64_t MetaTypeBytes(const std::string& type)
{
  static const std::map<std::string, std::uint64_t> sizes = { { "MET_CHAR", 1 }, { "MET_UCHAR", 1 },
    { "MET_SHORT", 2 }, { "MET_USHORT", 2 }, { "MET_INT", 4 }, { "MET_UINT", 4 }, { "MET_LONG", 4 },
    { "MET_ULONG", 4 }, { "MET_LONG_LONG", 8 }, { "MET_ULONG_LONG", 8 }, { "MET_FLOAT", 4 },
    { "MET_DOUBLE", 8 } };
  const auto found = sizes.find(type);
  return found == sizes.end() ? 0 : found->second;
}

bool IsTrue(const std::string& value)
{
  return !value.empty() && (value[0] == 'T' || value[0] == 't' || value[0] == '1');
}

std::uint64_t MetaValues(const std::string& name)
{
  std::istringstream sizes(HeaderValue(name, "DimSize"));
  const std::string channels = HeaderValue(name, "ElementNumberOfChannels");
  std::uint64_t values = channels.empty() ? 1 : std::strtoull(channels.c_str(), nullptr, 10);
  for (std::uint64_t size = 0; sizes >> size;)
  {
    values = Times(values, size);
  }
  return values;
}

/** Where the data of a file with a header begin: behind the line that tells where they are. */
std::streamoff BehindMetaHeader(std::ifstream& file)
{
  std::string line;
  while (std::getline(file, line) && line.compare(0, 15, "ElementDataFile") != 0)
  {
  }
  return file.tellg();
}

/** Numbers in a text. */
void CheckMetaText(std::ifstream& file, std::uint64_t values)
{
  std::uint64_t there = 0;
  for (std::string word; there < values && file >> word;)
  {
    ++there;
  }
  if (there < values)
  {
    throw Failure("the file is cut off: it has " + std::to_string(there) +
      " values, its header asks for " + std::to_string(values));
  }
}

/** Files that hold the data together, as much each. */
void CheckMetaFiles(const std::vector<std::string>& files, std::uint64_t needed)
{
  for (const std::string& file : files)
  {
    std::error_code failed;
    const std::uintmax_t size = std::filesystem::file_size(file, failed);
    if (failed)
    {
      throw Failure("its data file " + file + " cannot be opened");
    }
    if (size < needed / files.size())
    {
      throw Failure("its data file " + file + " is cut off: it has " + std::to_string(size) +
        " bytes, " + std::to_string(needed / files.size()) + " are needed");
    }
  }
}

/** The files of "slice%03d.raw FIRST LAST [STEP]"; none if the pattern is another. */
std::vector<std::string> FilesOfMetaPattern(const std::string& name, const std::string& words)
{
  static const std::regex pattern(R"((\S*)%(0?)(\d*)d(\S*) +(\d+) +(\d+)(?: +(\d+))?)");
  std::smatch match;
  std::vector<std::string> files;
  if (!std::regex_match(words, match, pattern))
  {
    return files;
  }
  const auto number = [&](int part) { return std::strtol(match[part].str().c_str(), nullptr, 10); };
  const long step = match[7].matched ? std::max(number(7), 1L) : 1;
  const std::size_t most = 100000; // a damaged header's range may have no end
  for (long i = number(5); i <= number(6) && files.size() < most; i += step)
  {
    std::string digits = std::to_string(i);
    const auto width = static_cast<std::size_t>(number(3));
    digits.insert(0, width - std::min(width, digits.size()), match[2].length() > 0 ? '0' : ' ');
    files.push_back(
      (std::filesystem::path(name).parent_path() / (match[1].str() + digits + match[4].str()))
        .string());
  }
  return files;
}

/** The files in the lines behind the header: one for each slice, or one if there is but one. */
void CheckMetaList(const std::string& name, std::uint64_t needed)
{
  const std::vector<std::string> files = FilesOfVolume(name);
  std::istringstream sizes(HeaderValue(name, "DimSize"));
  std::uint64_t slices = 1;
  for (std::uint64_t size = 0; sizes >> size;)
  {
    slices = std::max<std::uint64_t>(size, 1);
  }
  const std::string words = HeaderValue(name, "ElementDataFile");
  if (words.find('3') != std::string::npos)
  {
    slices = 1; // "LIST 3D"
  }
  if (files.size() < slices + 1) // the header is one of them
  {
    throw Failure("its header lists " + std::to_string(files.size() - 1) + " files for " +
      std::to_string(slices) + " slices");
  }
  const auto first = files.begin() + 1;
  CheckMetaFiles({ first, first + static_cast<std::ptrdiff_t>(slices) }, needed);
}

// ---- NIfTI --------------------------------------------------------------------------------------

/** NIfTI in two files: the one of these that is there, for the name of either. */
std::string NiftiPart(const std::string& name, const std::string& suffix)
{
  for (const char* end : { ".img.gz", ".hdr.gz", ".img", ".hdr" })
  {
    const std::size_t length = std::string(end).size();
    if (name.size() > length && name.compare(name.size() - length, length, end) == 0)
    {
      const std::string part = name.substr(0, name.size() - length) + suffix;
      return std::filesystem::exists(part) ? part : part + ".gz";
    }
  }
  return name;
}

/** Types of VTK's reader: numbers of 8 to 64 bits, and colours. */
void CheckNiftiType(std::uint64_t type)
{
  static const std::set<std::uint64_t> known = { 2, 4, 8, 16, 32, 64, 128, 256, 512, 768, 1024,
    1280, 1792, 2304 };
  if (known.count(type) == 0)
  {
    throw Failure("its header is damaged: the data type " + std::to_string(type) +
      " is none of NIfTI's types of numbers");
  }
}
}

bool CheckMeta(const std::string& name)
{
  const std::string dataFile = HeaderValue(name, "ElementDataFile");
  const bool isLocal = dataFile == "LOCAL" || dataFile == "Local" || dataFile == "local";
  const std::uint64_t bytes = MetaTypeBytes(HeaderValue(name, "ElementType"));
  const std::uint64_t values = MetaValues(name);
  const std::uint64_t needed = Times(values, bytes);
  const bool isPacked = IsTrue(HeaderValue(name, "CompressedData"));
  if (dataFile.empty() || bytes == 0)
  {
    return false;
  }
  if (dataFile.find('%') != std::string::npos)
  {
    const std::vector<std::string> files = FilesOfMetaPattern(name, dataFile);
    CheckMetaFiles(files, isPacked ? 0 : needed);
    return !isPacked && !files.empty();
  }
  if (dataFile.compare(0, 4, "LIST") == 0)
  {
    if (!isPacked)
    {
      CheckMetaList(name, needed);
    }
    return !isPacked;
  }
  const std::string path =
    isLocal ? name : (std::filesystem::path(name).parent_path() / dataFile).string();
  std::ifstream file(path, std::ios::binary);
  if (!file)
  {
    throw Failure("its data file " + path + " cannot be opened");
  }
  const std::uint64_t start = isLocal ? static_cast<std::uint64_t>(BehindMetaHeader(file)) : 0;
  const std::string isBinary = HeaderValue(name, "BinaryData");
  if (!isBinary.empty() && !IsTrue(isBinary))
  {
    CheckMetaText(file, values);
  }
  else if (isPacked)
  {
    Inflate(file, needed, nullptr);
  }
  else
  {
    // -1: the voxels are the last bytes of the file, whatever is before.
    const long long skipped = std::atoll(HeaderValue(name, "HeaderSize").c_str());
    const std::uint64_t size = std::filesystem::file_size(path);
    NeedBytes(
      size - std::min(size, start + static_cast<std::uint64_t>(std::max(skipped, 0LL))), needed);
  }
  return true;
}

void CheckNifti(const std::string& name)
{
  const std::string headerFile = NiftiPart(name, ".hdr");
  const std::string header = GzipHead(headerFile, 540);
  if (header.size() >= 76)
  {
    const auto at = [&](std::size_t place, std::size_t bytes, bool isBig)
    { return NumberOf(header.substr(place, bytes), isBig); };
    for (const bool isBig : { false, true })
    {
      const std::uint64_t size = at(0, 4, isBig);
      if (size == 348 || size == 540)
      {
        CheckNiftiType(at(size == 348 ? 70 : 12, 2, isBig));
      }
    }
  }
  const std::string dataFile = NiftiPart(name, ".img");
  if (dataFile != headerFile)
  {
    GzipHead(dataFile, 0);
  }
}

void CheckMrc(const std::string& name)
{
  BinaryFile file(name);
  // The machine stamp: 0x11 is big-endian.
  file.IsBig = file.Number(212, 1) == 0x11;
  static const std::map<std::uint64_t, std::uint64_t> modeBytes = { { 0, 1 }, { 1, 2 }, { 2, 4 },
    { 3, 4 }, { 4, 8 }, { 6, 2 }, { 16, 3 } };
  const auto mode = modeBytes.find(file.Number(12, 4));
  if (mode == modeBytes.end())
  {
    throw Failure("its header is damaged: the mode " + std::to_string(file.Number(12, 4)) +
      " is no type of voxels");
  }
  std::uint64_t needed = mode->second;
  for (const std::uint64_t place : { 0, 4, 8 })
  {
    needed = Times(needed, file.Number(place, 4));
  }
  const std::uint64_t start = 1024 + file.Number(92, 4);
  NeedBytes(file.Size() - std::min(file.Size(), start), needed);
}
}
