// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CheckInputs.h"

#include "BinaryFile.h"
#include "Inflate.h"
#include "InputFiles.h"
#include "Texts.h"
#include "ToolErrors.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
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
  for (std::string word; there <= values && file >> word;)
  {
    char* end = nullptr;
    std::strtod(word.c_str(), &end);
    if (*end != '\0')
    {
      throw Failure(
        "the file is damaged: its value " + std::to_string(there + 1) + " is no number");
    }
    ++there;
  }
  if (there != values)
  {
    throw Failure((there < values ? "the file is cut off" : "the file is too long") +
      std::string(": it has ") + std::to_string(there) + (there > values ? " or more" : "") +
      " values, its header asks for " + std::to_string(values));
  }
}

/** How many bytes of a file are before its voxels; less than 0: all but these. */
long long SkippedBytes(const std::string& name)
{
  return std::atoll(HeaderValue(name, "HeaderSize").c_str());
}

/**
 * Files that hold the data together, as much each.
 * @param needed 0: any number of bytes
 */
void CheckMetaFiles(
  const std::vector<std::string>& files, std::uint64_t needed, long long skipped)
{
  const std::uint64_t before = static_cast<std::uint64_t>(std::max(skipped, 0LL));
  for (const std::string& file : files)
  {
    std::error_code failed;
    const std::uintmax_t size = std::filesystem::file_size(file, failed);
    if (failed)
    {
      throw Failure("its data file " + file + " cannot be opened");
    }
    const std::uint64_t all = before + needed / files.size();
    if (size < all || (needed > 0 && skipped >= 0 && size > all))
    {
      throw Failure("its data file " + file + " is " + (size < all ? "cut off" : "too long") +
        ": it has " + std::to_string(size) + " bytes, " + std::to_string(all) + " are needed");
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
  CheckMetaFiles(
    { first, first + static_cast<std::ptrdiff_t>(slices) }, needed, SkippedBytes(name));
}
}

void CheckMetaHeader(const std::string& name)
{
  std::istringstream sizes(HeaderValue(name, "DimSize"));
  const std::vector<std::string> words{ std::istream_iterator<std::string>(sizes), {} };
  if (HeaderValue(name, "NDims") != std::to_string(words.size()))
  {
    throw Failure("its header is damaged: it has no NDims, or not as many sizes");
  }
  const std::string type = HeaderValue(name, "ElementType");
  if (MetaTypeBytes(type) == 0)
  {
    throw Failure("its header is damaged: the ElementType '" + type + "' is no number's");
  }
  for (const char* key :
    { "BinaryData", "BinaryDataByteOrderMSB", "ElementByteOrderMSB", "CompressedData" })
  {
    const std::string value = Lower(HeaderValue(name, key));
    static const std::set<std::string> known = { "", "true", "false", "t", "f", "1", "0" };
    if (known.count(value) == 0)
    {
      throw Failure(std::string("its header is damaged: ") + key + " is '" + value + "'");
    }
  }
}

bool CheckMeta(const std::string& name)
{
  CheckMetaHeader(name);
  const std::string dataFile = HeaderValue(name, "ElementDataFile");
  const bool isLocal = dataFile == "LOCAL" || dataFile == "Local" || dataFile == "local";
  const std::uint64_t bytes = MetaTypeBytes(HeaderValue(name, "ElementType"));
  const std::uint64_t values = MetaValues(name);
  const std::uint64_t needed = Times(values, bytes);
  const bool isPacked = IsTrue(HeaderValue(name, "CompressedData"));
  if (dataFile.empty())
  {
    return false;
  }
  if (dataFile.find('%') != std::string::npos)
  {
    const std::vector<std::string> files = FilesOfMetaPattern(name, dataFile);
    CheckMetaFiles(files, isPacked ? 0 : needed, SkippedBytes(name));
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
    const long long skipped = SkippedBytes(name);
    const std::uint64_t size = std::filesystem::file_size(path);
    const std::uint64_t begin = skipped < 0
      ? size - std::min(size, needed)
      : start + static_cast<std::uint64_t>(skipped);
    NeedJustBytes(size - std::min(size, begin), needed);
  }
  return true;
}

void CheckNesting(std::istream& text)
{
  constexpr int deepest = 100;
  constexpr auto end = std::numeric_limits<std::streamsize>::max();
  int depth = 0;
  std::string element;
  while (text.ignore(end, '<') && std::getline(text, element, '>'))
  {
    if (element.compare(0, 12, "AppendedData") == 0)
    {
      return;
    }
    const char first = element.empty() ? '!' : element.front();
    const bool isAlone = first == '?' || first == '!' || element.back() == '/';
    depth += first == '/' ? -1 : isAlone ? 0 : 1;
    if (depth > deepest)
    {
      throw Failure("it is damaged: elements within elements without end");
    }
  }
}

void CheckNesting(const std::string& name)
{
  std::ifstream file(name, std::ios::binary);
  CheckNesting(file);
}
}
