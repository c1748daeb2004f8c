// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FileBuffer.h"

#include "ToolErrors.h"

#include <algorithm>

namespace tool
{
FileBuffer::FileBuffer(const std::string& path)
  : File(path, O_WRONLY | O_CREAT | O_TRUNC), Buffer(1 << 20)
{
  this->KeepError(this->File.IsOpen());
  this->setp(this->Buffer.data(), this->Buffer.data() + this->Buffer.size());
}

void FileBuffer::Finish()
{
  this->Empty();
  this->KeepError(this->File.Close());
  if (this->Error != 0)
  {
    throw Failure("cannot be written (" + SystemReason(this->Error) + ")");
  }
}

FileBuffer::int_type FileBuffer::overflow(int_type character)
{
  this->Empty();
  if (!traits_type::eq_int_type(character, traits_type::eof()))
  {
    *this->pptr() = traits_type::to_char_type(character);
    this->pbump(1);
  }
  return traits_type::not_eof(character);
}

int FileBuffer::sync()
{
  this->Empty();
  return 0;
}

FileBuffer::pos_type FileBuffer::seekoff(
  off_type distance, std::ios_base::seekdir from, std::ios_base::openmode)
{
  const off_type here = this->Start + (this->pptr() - this->pbase());
  if (from == std::ios_base::cur && distance == 0) // where are we: nothing moves
  {
    return here;
  }
  this->Empty();
  this->Start = distance +
    (from == std::ios_base::cur       ? here
        : from == std::ios_base::end ? this->End
                                     : 0);
  if (this->Error == 0)
  {
    this->KeepError(this->File.Seek(this->Start));
  }
  return this->Start;
}

FileBuffer::pos_type FileBuffer::seekpos(pos_type place, std::ios_base::openmode which)
{
  return this->seekoff(place, std::ios_base::beg, which);
}

void FileBuffer::Empty()
{
  const off_type count = this->pptr() - this->pbase();
  if (this->Error == 0)
  {
    this->KeepError(this->File.Write(this->pbase(), static_cast<std::size_t>(count)));
  }
  this->Start += count;
  this->End = std::max(this->End, this->Start);
  this->setp(this->Buffer.data(), this->Buffer.data() + this->Buffer.size());
}

void FileBuffer::KeepError(bool isWell)
{
  if (!isWell && this->Error == 0)
  {
    this->Error = errno;
  }
}
}
