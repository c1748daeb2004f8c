// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BinaryFile.h"

#include "ToolErrors.h"

#include <vtkDataArray.h>
#include <vtk_zlib.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <limits>
#include <system_error>
#include <type_traits>
#include <utility>

#include <archive.h>
#include <archive_entry.h>
#include <unistd.h>

namespace tool
{
void NeedFile(const std::string& name)
{
  std::error_code failed;
  const std::filesystem::file_status status = std::filesystem::status(name, failed);
  FailIf(std::filesystem::is_other(status), name + ": a pipe or a device; files are read");
  FailIf(std::filesystem::exists(status) && access(name.c_str(), R_OK) != 0,
    name + ": cannot be read: " + std::generic_category().message(errno));
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

// ---- Packed data --------------------------------------------------------------------------------

namespace
{
constexpr std::size_t Piece = 1 << 18; ///< bytes at a time

/** @throws Failure if packed data have given `done` bytes, and give more than they may. */
void NeedNoMore(std::uint64_t got, std::uint64_t done, std::uint64_t most)
{
  FailIf(got > most - done,
    "the packed data give more than the " + std::to_string(most) +
      " bytes that the header tells of");
}

/** @throws Failure unless packed data gave as many bytes as are needed. */
void NeedUnpacked(std::uint64_t got, std::uint64_t needed)
{
  FailIf(got < needed,
    "the packed data give " + std::to_string(got) + " bytes, " + std::to_string(needed) +
      " are needed");
}
}

UnpackedSink Without(std::uint64_t before, const UnpackedSink& sink)
{
  return [sink, before](const char* bytes, std::size_t count) mutable
  {
    const std::size_t skipped = static_cast<std::size_t>(std::min<std::uint64_t>(before, count));
    before -= skipped;
    sink(bytes + skipped, count - skipped);
  };
}

std::uint64_t Inflate(std::istream& packed, const UnpackedSink& sink, std::uint64_t most)
{
  z_stream stream = {};
  // 32: zlib or gzip, by its head; 15: the largest window
  FailIf(inflateInit2(&stream, 47) != Z_OK, "what unpacks the data cannot be used");
  const std::unique_ptr<z_stream, int (*)(z_stream*)> end(&stream, inflateEnd);
  std::vector<char> input(Piece);
  std::vector<char> output(Piece);
  const auto refill = [&]
  {
    if (stream.avail_in == 0)
    {
      packed.read(input.data(), static_cast<std::streamsize>(input.size()));
      stream.next_in = reinterpret_cast<Bytef*>(input.data());
      stream.avail_in = static_cast<uInt>(packed.gcount());
    }
    return stream.avail_in > 0;
  };
  const auto hasMore = [&]
  {
    return refill() && stream.next_in[0] == 0x1f &&
      (stream.avail_in == 1 || stream.next_in[1] == 0x8b);
  };
  std::uint64_t done = 0;
  for (bool isAtEnd = false; !isAtEnd;)
  {
    const bool isThere = refill();
    stream.next_out = reinterpret_cast<Bytef*>(output.data());
    stream.avail_out = static_cast<uInt>(output.size());
    const int status = inflate(&stream, Z_NO_FLUSH);
    const std::size_t got = output.size() - stream.avail_out;
    FailIf(status != Z_STREAM_END && status != Z_OK && status != Z_BUF_ERROR,
      "the packed data are damaged: their checksum or code is wrong");
    NeedNoMore(got, done, most);
    FailIf(status != Z_STREAM_END && got == 0 && !isThere,
      "the packed data are cut off: they give " + std::to_string(done) + " of " +
        std::to_string(most) + " bytes");
    sink(output.data(), got);
    done += got;
    isAtEnd = status == Z_STREAM_END && !(hasMore() && inflateReset(&stream) == Z_OK);
  }
  return done;
}

void InflateJust(std::istream& packed, const UnpackedSink& sink, std::uint64_t count)
{
  NeedUnpacked(Inflate(packed, sink, count), count);
}

void BunzipJust(std::istream& packed, const UnpackedSink& sink, std::uint64_t count)
{
  Archive archive(Archive::Kind::Bzip2,
    [&packed](char* bytes, std::size_t most) -> std::int64_t
    {
      packed.read(bytes, static_cast<std::streamsize>(most));
      return packed.gcount();
    });
  std::vector<char> output(Piece);
  std::uint64_t done = 0;
  for (std::size_t got = archive.Next() ? output.size() : 0; got == output.size(); done += got)
  {
    got = archive.Read(output.data(), output.size());
    NeedNoMore(got, done, count);
    sink(output.data(), got);
  }
  NeedUnpacked(done, count);
}

bool IsGzip(const std::string& name)
{
  std::ifstream file(name, std::ios::binary);
  return file.get() == 0x1f && file.get() == 0x8b;
}

std::string HeadOf(const std::string& name, std::size_t count)
{
  std::string bytes(count, '\0');
  using Closing = int (*)(gzFile);
  const std::unique_ptr<std::remove_pointer_t<gzFile>, Closing> file(
    gzopen(name.c_str(), "rb"), gzclose);
  const int there = file ? gzread(file.get(), bytes.data(), static_cast<unsigned int>(count)) : 0;
  bytes.resize(static_cast<std::size_t>(std::max(there, 0)));
  return bytes;
}

// ---- Archives -----------------------------------------------------------------------------------

Archive::Archive(Kind kind, Source source)
  : Packed(std::move(source)), Piece(1 << 18), Reader(archive_read_new(), archive_read_free)
{
  const bool isTar = kind == Kind::Tar;
  this->Need(isTar ? archive_read_support_format_tar(this->Reader.get())
                   : archive_read_support_format_raw(this->Reader.get()));
  // One layer; who asks which it is unpacks as many as there are. Not by a program: that warns.
  FailIf(
    !isTar && archive_read_append_filter(this->Reader.get(), ARCHIVE_FILTER_BZIP2) != ARCHIVE_OK,
    "what unpacks the data cannot be used");
  const auto feed = [](archive*, void* self, const void** bytes) -> la_ssize_t
  {
    auto* own = static_cast<Archive*>(self);
    *bytes = own->Piece.data();
    return static_cast<la_ssize_t>(own->Packed(own->Piece.data(), own->Piece.size()));
  };
  this->Need(archive_read_open(this->Reader.get(), this, nullptr, feed, nullptr));
}

Archive::Source Archive::TarIn(const std::string& name)
{
  const std::shared_ptr<std::remove_pointer_t<gzFile>> file(
    gzopen(name.c_str(), "rb"), [](gzFile opened) { return opened ? gzclose(opened) : Z_OK; });
  FailIf(!file, "cannot be opened");
  return [file](char* bytes, std::size_t count) -> std::int64_t
  {
    const int got = gzread(file.get(), bytes, static_cast<unsigned int>(count));
    int error = Z_OK;
    gzerror(file.get(), &error);
    return error == Z_OK || error == Z_STREAM_END ? got : -1;
  };
}

std::int64_t Archive::Need(std::int64_t result) const
{
  // Of a name that cannot be shown it only warns.
  if (result < ARCHIVE_WARN)
  {
    const char* reason = archive_error_string(this->Reader.get());
    throw Failure("the packed data are cut off, damaged or not of this kind" +
      (reason ? " (" + std::string(reason) + ")" : std::string()));
  }
  return result;
}

bool Archive::Next()
{
  archive_entry* head = nullptr;
  while (this->Need(archive_read_next_header(this->Reader.get(), &head)) != ARCHIVE_EOF)
  {
    // A file with holes gives more bytes than it has.
    if (archive_entry_filetype(head) == AE_IFREG && !archive_entry_hardlink(head) &&
      archive_entry_sparse_count(head) == 0)
    {
      const char* path = archive_entry_pathname(head);
      const std::string name = path ? path : "";
      this->MemberName = name.substr(name.find_last_of('/') + 1);
      this->MemberSize = static_cast<std::uint64_t>(archive_entry_size(head));
      this->MemberDone = 0;
      this->BlockLeft = 0;
      return true;
    }
  }
  return false;
}

std::size_t Archive::Read(char* bytes, std::size_t count)
{
  std::size_t done = 0;
  while (done < count)
  {
    if (this->BlockLeft == 0)
    {
      const void* block = nullptr;
      la_int64_t place = 0;
      const auto result =
        archive_read_data_block(this->Reader.get(), &block, &this->BlockLeft, &place);
      if (result == ARCHIVE_EOF)
      {
        break;
      }
      FailIf(this->Need(result) != ARCHIVE_OK, "the packed data are damaged");
      FailIf(this->BlockLeft > 0 && static_cast<std::uint64_t>(place) != this->MemberDone,
        "the packed data have holes");
      this->Block = static_cast<const char*>(block);
    }
    const std::size_t some = std::min(this->BlockLeft, count - done);
    std::copy_n(this->Block, some, bytes + done);
    this->Block += some;
    this->BlockLeft -= some;
    this->MemberDone += some;
    done += some;
  }
  return done;
}

void Archive::Finish()
{
  std::int64_t got = 1;
  while (got > 0)
  {
    got = this->Packed(this->Piece.data(), this->Piece.size());
  }
  FailIf(got < 0, "the packed data are cut off or damaged");
}
}
