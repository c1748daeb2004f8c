// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "TarFile.h"

#include "ByteBudget.h"
#include "ToolErrors.h"

#include <vtk_zlib.h>

#include <algorithm>
#include <array>
#include <vector>

namespace tool
{
namespace
{
constexpr std::uint64_t BlockSize = 512;
using Block = std::array<char, BlockSize>;

std::uint64_t FilledUp(std::uint64_t size)
{
  if (size > std::uint64_t(1) << 62)
  {
    throw Failure("the archive is damaged: a size is no number");
  }
  return (size + BlockSize - 1) / BlockSize * BlockSize;
}

/** The text of a field, up to its end or a zero. */
std::string FieldOf(const Block& block, std::size_t at, std::size_t length)
{
  const char* begin = block.data() + at;
  return std::string(begin, std::find(begin, begin + length, '\0'));
}

/** An octal number, or, where it would be too long, one of the bytes behind a mark. */
std::uint64_t NumberIn(const Block& block, std::size_t at, std::size_t length)
{
  const auto first = static_cast<unsigned char>(block[at]);
  std::uint64_t number = 0;
  if (first == 0x80)
  {
    for (std::size_t i = at + length - 8; i < at + length; ++i)
    {
      number = number * 256 + static_cast<unsigned char>(block[i]);
    }
    return number;
  }
  for (const char digit : FieldOf(block, at, length))
  {
    if (digit != ' ' && (digit < '0' || digit > '7'))
    {
      throw Failure("the archive is damaged: a head holds no number");
    }
    number = digit == ' ' ? number : number * 8 + static_cast<std::uint64_t>(digit - '0');
  }
  return number;
}

/** Whether the sum of a head's bytes is what it says, itself counted as blanks. */
bool HasItsSum(const Block& block)
{
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < BlockSize; ++i)
  {
    sum += i >= 148 && i < 156 ? ' ' : static_cast<unsigned char>(block[i]);
  }
  return NumberIn(block, 148, 8) == sum;
}

/** The value of an attribute in a table of `length key=value\n`; empty if it is not there. */
std::string AttributeOf(const std::string& table, const std::string& key)
{
  const std::size_t at = table.find(" " + key + "=");
  return at == std::string::npos
    ? ""
    : table.substr(at + key.size() + 2, table.find('\n', at) - at - key.size() - 2);
}

std::uint64_t Decimal(const std::string& text)
{
  std::uint64_t number = 0;
  for (const char digit : text)
  {
    if (digit < '0' || digit > '9' || text.size() > 18)
    {
      throw Failure("the archive is damaged: a size is no number");
    }
    number = number * 10 + static_cast<std::uint64_t>(digit - '0');
  }
  return number;
}

std::string WithoutFolders(const std::string& name)
{
  return name.substr(name.find_last_of('/') + 1);
}
}

TarFile::TarFile(const std::string& name) : File(gzopen(name.c_str(), "rb"))
{
  if (!this->File)
  {
    throw Failure("cannot be opened");
  }
}

TarFile::~TarFile()
{
  gzclose(static_cast<gzFile>(this->File));
}

std::uint64_t TarFile::ReadSome(char* bytes, std::uint64_t count)
{
  std::uint64_t done = 0;
  while (done < count)
  {
    const std::uint64_t piece = std::min<std::uint64_t>(count - done, 1 << 24);
    const int got =
      gzread(static_cast<gzFile>(this->File), bytes + done, static_cast<unsigned int>(piece));
    int error = Z_OK;
    gzerror(static_cast<gzFile>(this->File), &error);
    if (got < 0 || (error != Z_OK && error != Z_STREAM_END))
    {
      throw Failure("the packed data are damaged or cut off");
    }
    if (got == 0)
    {
      break;
    }
    done += static_cast<std::uint64_t>(got);
  }
  return done;
}

void TarFile::ReadAll(char* bytes, std::uint64_t count)
{
  if (this->ReadSome(bytes, count) < count)
  {
    throw Failure("the archive is cut off");
  }
}

void TarFile::Skip(std::uint64_t count)
{
  std::vector<char> piece(std::min<std::uint64_t>(count, 1 << 20));
  for (std::uint64_t left = count; left > 0;)
  {
    const std::uint64_t length = std::min<std::uint64_t>(left, piece.size());
    this->ReadAll(piece.data(), length);
    left -= length;
  }
}

std::string TarFile::ReadText()
{
  if (this->MemberSize > LargestText)
  {
    throw Failure("the archive is damaged: a name is too long");
  }
  std::string text(this->MemberSize, '\0');
  this->Read(text.data());
  return text;
}

bool TarFile::Next()
{
  std::string longName;
  std::string longSize;
  Block head;
  for (;;)
  {
    this->Skip(this->Unread);
    this->Unread = 0;
    if (this->ReadSome(head.data(), BlockSize) < BlockSize)
    {
      throw Failure("the archive is cut off, or is none");
    }
    if (std::all_of(head.begin(), head.end(), [](char c) { return c == '\0'; }))
    {
      return false;
    }
    if (!HasItsSum(head))
    {
      throw Failure("the archive is damaged, or is none: the sum of a head is wrong");
    }
    this->MemberSize = NumberIn(head, 124, 12);
    this->Unread = FilledUp(this->MemberSize);
    const char kind = head[156];
    if (kind == 'L')
    {
      longName = this->ReadText();
      longName.erase(std::find(longName.begin(), longName.end(), '\0'), longName.end());
    }
    else if (kind == 'x')
    {
      const std::string attributes = this->ReadText();
      longName = AttributeOf(attributes, "path");
      longSize = AttributeOf(attributes, "size");
    }
    else if (kind == '0' || kind == '\0' || kind == '7')
    {
      if (!longSize.empty())
      {
        this->MemberSize = Decimal(longSize);
        this->Unread = FilledUp(this->MemberSize);
      }
      this->MemberName = WithoutFolders(longName.empty() ? FieldOf(head, 0, 100) : longName);
      return true;
    }
    else
    {
      longName.clear(); // of a folder or a link
      longSize.clear();
    }
  }
}

void TarFile::Read(char* bytes)
{
  this->ReadAll(bytes, this->MemberSize);
  this->Skip(this->Unread - this->MemberSize);
  this->Unread = 0;
}

void TarFile::Finish()
{
  std::vector<char> piece(1 << 20);
  while (this->ReadSome(piece.data(), piece.size()) == piece.size())
  {
  }
}
}
