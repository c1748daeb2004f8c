// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Inflate.h"

#include "ToolErrors.h"

#include <vtk_zlib.h>

#include <algorithm>
#include <cstring>
#include <vector>

namespace tool
{
namespace
{
constexpr std::size_t Piece = 1 << 18; ///< bytes at a time

/// A z_stream that is freed.
struct Inflater
{
  Inflater()
  {
    std::memset(&this->Stream, 0, sizeof(this->Stream));
    // 32: zlib or gzip, by its head; 15: the largest window
    if (inflateInit2(&this->Stream, 47) != Z_OK)
    {
      throw Failure("zlib cannot be used");
    }
  }
  ~Inflater() { inflateEnd(&this->Stream); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  z_stream Stream;
};

/// More to unpack, if there is any.
void Refill(std::istream& packed, std::vector<char>& input, z_stream& stream)
{
  if (stream.avail_in == 0)
  {
    packed.read(input.data(), static_cast<std::streamsize>(input.size()));
    stream.next_in = reinterpret_cast<Bytef*>(input.data());
    stream.avail_in = static_cast<uInt>(packed.gcount());
  }
}
}

void Inflate(std::istream& packed, std::uint64_t count, char* bytes)
{
  Inflater inflater;
  z_stream& stream = inflater.Stream;
  std::vector<char> input(Piece);
  std::vector<char> output(Piece);
  std::uint64_t done = 0;
  bool isAtEnd = false;
  while (!isAtEnd)
  {
    Refill(packed, input, stream);
    if (stream.avail_in == 0)
    {
      throw Failure("the packed data are cut off: they give " + std::to_string(done) + " of " +
        std::to_string(count) + " bytes");
    }
    stream.next_out = reinterpret_cast<Bytef*>(output.data());
    stream.avail_out = static_cast<uInt>(output.size());
    const int status = inflate(&stream, Z_NO_FLUSH);
    const std::size_t got = output.size() - stream.avail_out;
    if (status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR)
    {
      throw Failure("the packed data are damaged: their checksum or code is wrong");
    }
    if (done + got > count)
    {
      throw Failure("the packed data give more than the " + std::to_string(count) +
        " bytes that the header tells of");
    }
    if (bytes)
    {
      std::copy_n(output.data(), got, bytes + done);
    }
    done += got;
    isAtEnd = status == Z_STREAM_END;
    if (isAtEnd && done < count)
    {
      // Several members, one behind the other, are one gzip file.
      Refill(packed, input, stream);
      isAtEnd = stream.avail_in == 0 || inflateReset(&stream) != Z_OK;
    }
  }
  if (done < count)
  {
    throw Failure("the packed data give " + std::to_string(done) + " bytes, " +
      std::to_string(count) + " are needed");
  }
}

std::string GzipHead(const std::string& name, std::size_t count)
{
  gzFile file = gzopen(name.c_str(), "rb");
  if (!file)
  {
    throw Failure("cannot be opened");
  }
  std::string head;
  std::vector<char> piece(Piece);
  int got = 0;
  bool isPacked = true;
  while (isPacked && (got = gzread(file, piece.data(), static_cast<unsigned int>(Piece))) > 0)
  {
    head.append(
      piece.data(), std::min(static_cast<std::size_t>(got), count - std::min(count, head.size())));
    isPacked = gzdirect(file) == 0; // else the rest need not be looked at
  }
  // At the end of a file that was cut off, reading gives an error of its own, or closing does.
  if (gzclose(file) != Z_OK || got < 0)
  {
    throw Failure("the packed data are damaged or cut off");
  }
  return head;
}
}
