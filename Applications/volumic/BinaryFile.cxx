// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BinaryFile.h"

#include "ToolErrors.h"

#include <filesystem>

namespace tool
{
void NeedFile(const std::string& name)
{
  std::error_code failed;
  const std::filesystem::file_status status = std::filesystem::status(name, failed);
  if (std::filesystem::is_other(status))
  {
    throw Failure(name + ": a pipe or a device; files are read");
  }
}

BinaryFile::BinaryFile(const std::string& name)
{
  NeedFile(name);
  this->File.open(name, std::ios::binary);
  std::error_code failed;
  this->Bytes = std::filesystem::file_size(name, failed);
  if (failed || !this->File)
  {
    throw Failure("cannot be opened");
  }
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
}
