// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CheckInputs.h"

#include "ByteBudget.h"
#include "Inflate.h"
#include "InputFiles.h"
#include "ParseNumbers.h"
#include "Texts.h"
#include "ToolErrors.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
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

/** How many slices a MetaImage has, which may be in as many files. */
std::uint64_t SlicesOf(const std::string& name)
{
  std::istringstream sizes(HeaderValue(name, "DimSize"));
  std::uint64_t slices = 1;
  for (std::uint64_t size = 0; sizes >> size;)
  {
    slices = std::max<std::uint64_t>(size, 1);
  }
  return slices;
}

/**
 * The files of "slice%03d.raw [FIRST [LAST [STEP]]]". MetaIO gives the first word to printf, whatever
 * it is, and divides by the step. @throws Failure for what is no such pattern.
 */
std::vector<std::string> FilesOfMetaPattern(const std::string& name, const std::string& text)
{
  std::istringstream words(text);
  std::string pattern;
  words >> pattern;
  std::vector<long> numbers;
  for (std::string word; numbers.size() < 4 && words >> word;)
  {
    numbers.push_back(ParseNumber<int>(word));
  }
  const std::uint64_t slices = SlicesOf(name);
  const std::size_t begin = std::min(pattern.find('%'), pattern.size());
  const std::size_t end =
    std::min(pattern.find_first_not_of("0123456789", begin + 1), pattern.size());
  const std::string width = pattern.substr(std::min(begin + 1, end), end - begin - 1);
  const long most = 100000; // files; a damaged header may ask for any number
  const long steps = static_cast<long>(std::min<std::uint64_t>(slices, most)) - 1;
  const long first = numbers.empty() ? 1 : numbers[0];
  const long last = numbers.size() > 1 ? numbers[1] : first + steps;
  const long step = numbers.size() == 3 ? numbers[2]
    : numbers.size() == 2               ? (last - first) / (steps + 1)
                                        : 1;
  if (end == pattern.size() || pattern.find_first_of("diu", end) != end || width.size() > 3 ||
    pattern.find('%', end) != std::string::npos || numbers.size() > 3 || slices > most ||
    first < 0 || step < 1 || first + steps * step > last)
  {
    throw Failure("its header is damaged: the ElementDataFile '" + text.substr(0, 80) +
      "' gives no " + std::to_string(slices) + " files, as 'slice%03d.raw 1 100 1' gives 100");
  }
  std::vector<std::string> files;
  for (long i = 0; i <= steps; ++i)
  {
    std::string digits = std::to_string(first + i * step);
    const auto wanted = static_cast<std::size_t>(std::atoi(width.c_str()));
    digits.insert(0, wanted - std::min(wanted, digits.size()), width[0] == '0' ? '0' : ' ');
    files.push_back((std::filesystem::path(name).parent_path() /
      (pattern.substr(0, begin) + digits + pattern.substr(end + 1)))
                      .string());
  }
  return files;
}

/** The files in the lines behind the header: one for each slice, or one if there is but one. */
void CheckMetaList(const std::string& name, std::uint64_t needed)
{
  const std::vector<std::string> files = FilesOfVolume(name);
  std::uint64_t slices = SlicesOf(name);
  const std::string words = HeaderValue(name, "ElementDataFile");
  if (words.find('3') != std::string::npos)
  {
    slices = 1; // "LIST 3D"
  }
  if (files.size() - 1 < slices) // the header is one of them
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
  const std::size_t most = 10; // for which MetaIO has room
  if (HeaderValue(name, "NDims") != std::to_string(words.size()) || words.size() > most)
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
    CheckMetaFiles(
      FilesOfMetaPattern(name, dataFile), isPacked ? 0 : needed, SkippedBytes(name));
    return !isPacked;
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
    InflateJust(file, Nowhere, needed);
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
}
