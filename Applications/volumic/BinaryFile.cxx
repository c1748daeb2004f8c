// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BinaryFile.h"

#include "ToolErrors.h"

#include <vtkDataArray.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <string>

namespace tool
{
void NeedFile(const std::string& name)
{
  std::error_code failed;
  const std::filesystem::file_status status = std::filesystem::status(name, failed);
  FailIf(std::filesystem::is_other(status), name + ": a pipe or a device; files are read");
}

BinaryFile::BinaryFile(const std::string& name)
{
  NeedFile(name);
  this->File.open(name, std::ios::binary);
  std::error_code failed;
  this->Bytes = std::filesystem::file_size(name, failed);
  FailIf(failed || !this->File, "cannot be opened");
}

void BinaryFile::Need(std::uint64_t at, std::uint64_t count) const
{
  if (at > this->Bytes || count > this->Bytes - at)
  {
    throw Failure("the file is cut off: it ends at byte " + std::to_string(this->Bytes) +
      ", which is before what its header tells of; copy it again");
  }
}

std::string BinaryFile::Text(std::uint64_t at, std::uint64_t count)
{
  this->Need(at, count);
  std::string text(count, '\0');
  this->File.seekg(static_cast<std::streamoff>(at));
  this->File.read(text.data(), static_cast<std::streamsize>(count));
  return text;
}

std::uint64_t BinaryFile::Number(std::uint64_t at, int bytes)
{
  return NumberOf(this->Text(at, static_cast<std::uint64_t>(bytes)), this->IsBig);
}

std::int64_t BinaryFile::Signed(std::uint64_t at, int bytes)
{
  const std::uint64_t number = this->Number(at, bytes);
  return bytes == 2 ? static_cast<std::int16_t>(number) : static_cast<std::int32_t>(number);
}

std::uint64_t NumberOf(const std::string& bytes, bool isBig)
{
  std::uint64_t number = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i)
  {
    number = number << 8 | static_cast<unsigned char>(bytes[isBig ? i : bytes.size() - 1 - i]);
  }
  return number;
}

// ---- How many bytes a file may ask for ----------------------------------------------------------

std::uint64_t Times(std::uint64_t a, std::uint64_t b)
{
  constexpr std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
  return a != 0 && b > most / a ? most : a * b;
}

std::uint64_t BytesOfVoxels(int type, int components, const std::array<int, 3>& size)
{
  std::uint64_t bytes = Times(static_cast<std::uint64_t>(vtkDataArray::GetDataTypeSize(type)),
    static_cast<std::uint64_t>(components));
  for (const int count : size)
  {
    bytes = Times(bytes, static_cast<std::uint64_t>(count));
  }
  return bytes;
}

std::uint64_t MostUnpacked(std::uint64_t voxels, std::uint64_t before)
{
  FailIf(before > LargestHeader,
    "its header is damaged: the voxels begin at byte " + std::to_string(before) +
      " of what is packed, where no header is that long");
  return voxels + std::min(before, std::numeric_limits<std::uint64_t>::max() - voxels);
}

void NeedPackedBytes(std::uint64_t there, std::uint64_t most, std::uint64_t needed)
{
  if (Times(there, most) < needed)
  {
    NeedBytes(there, needed);
  }
}

void NeedBytes(std::uint64_t there, std::uint64_t needed)
{
  FailIf(there < needed,
    "the file is cut off: it has " + std::to_string(there) +
      " bytes of voxels, its header asks for " + std::to_string(needed) + "; copy it again");
}

void NeedJustBytes(std::uint64_t there, std::uint64_t needed)
{
  NeedBytes(there, needed);
  FailIf(there > needed,
    "the file is too long: it has " + std::to_string(there) +
      " bytes of voxels, its header asks for " + std::to_string(needed) +
      "; copy it again, or, if what is too much is its end, cut that off (truncate -s -" +
      std::to_string(there - needed) + ")");
}
}
