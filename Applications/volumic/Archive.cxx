// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Archive.h"

#include "ToolErrors.h"

#include <vtk_zlib.h>

#include <archive.h>
#include <archive_entry.h>

#include <type_traits>
#include <utility>

namespace tool
{
Archive::Archive(Kind kind, Source source)
  : Packed(std::move(source)), Piece(1 << 18), Reader(archive_read_new(), archive_read_free)
{
  const bool isTar = kind == Kind::Tar;
  this->Need(isTar ? archive_read_support_format_tar(this->Reader.get())
                   : archive_read_support_format_raw(this->Reader.get()));
  this->Need(isTar ? ARCHIVE_OK : archive_read_support_filter_bzip2(this->Reader.get()));
  const auto feed = [](archive*, void* self, const void** bytes) -> la_ssize_t
  {
    auto* own = static_cast<Archive*>(self);
    *bytes = own->Piece.data();
    return static_cast<la_ssize_t>(own->Packed(own->Piece.data(), own->Piece.size()));
  };
  this->Need(archive_read_open(this->Reader.get(), this, nullptr, feed, nullptr));
  if (!isTar && archive_filter_code(this->Reader.get(), 0) != ARCHIVE_FILTER_BZIP2)
  {
    throw Failure("the packed data are damaged: they do not begin as those of bzip2 do");
  }
}

Archive::Source Archive::TarIn(const std::string& name)
{
  const std::shared_ptr<std::remove_pointer_t<gzFile>> file(gzopen(name.c_str(), "rb"),
    [](gzFile opened) { return opened ? gzclose(opened) : Z_OK; });
  if (!file)
  {
    throw Failure("cannot be opened");
  }
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
      return true;
    }
  }
  return false;
}

std::size_t Archive::Read(char* bytes, std::size_t count)
{
  std::size_t done = 0;
  for (std::size_t got = 1; done < count && got > 0; done += got)
  {
    got = static_cast<std::size_t>(
      this->Need(archive_read_data(this->Reader.get(), bytes + done, count - done)));
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
  if (got < 0)
  {
    throw Failure("the packed data are cut off or damaged");
  }
}
}
