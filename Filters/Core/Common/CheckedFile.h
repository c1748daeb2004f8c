// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicCheckedFile_h
#define volumicCheckedFile_h

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

// Files of numbers, texts and lists for a program to read again on the same machine, after a crash
// too: each is there as a whole or not at all, and what is not as it was written is not believed.

namespace volumic
{
/** A file that cannot be written or read, or is damaged; the message has its name, and why. */
struct FileError : std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/**
 * Writes a file beside its place, `NAME.new`, and moves it there when it is whole and on the disk.
 * All throw FileError.
 */
class CheckedWriter
{
public:
  explicit CheckedWriter(const std::string& name);
  /** Where nothing was committed, no file is left. */
  ~CheckedWriter();
  CheckedWriter(const CheckedWriter&) = delete;
  CheckedWriter& operator=(const CheckedWriter&) = delete;

  void Write(const void* bytes, std::size_t count);
  template <typename T>
  void Put(const T& value)
  {
    static_assert(std::is_trivially_copyable_v<T>);
    this->Write(&value, sizeof(T));
  }
  void PutText(const std::string& text);
  template <typename T, typename Allocator>
  void PutList(const std::vector<T, Allocator>& list)
  {
    static_assert(std::is_trivially_copyable_v<T>);
    this->Put<std::uint64_t>(list.size());
    this->Write(list.data(), list.size() * sizeof(T));
  }

  /** To be called once, when all is written. */
  void Commit();

private:
  [[noreturn]] void Fail();
  void WriteBuffer();

  std::string Name;
  std::FILE* File = nullptr;
  std::vector<unsigned char> Buffer;
  std::uint64_t Hash = 0; ///< Of all buffers so far.
};

/**
 * Reads what CheckedWriter wrote, in the same order. All throw FileError. The file must be this
 * user's: in a folder that others may write to it may be anybody's. No memory is taken for more than
 * the file has.
 */
class CheckedReader
{
public:
  explicit CheckedReader(const std::string& name);
  ~CheckedReader();
  CheckedReader(const CheckedReader&) = delete;
  CheckedReader& operator=(const CheckedReader&) = delete;

  void Read(void* bytes, std::size_t count);
  template <typename T>
  T Get()
  {
    static_assert(std::is_trivially_copyable_v<T>);
    T value;
    this->Read(&value, sizeof(T));
    return value;
  }
  /** How many things follow, each of so many bytes or more. */
  std::size_t GetCount(std::size_t bytes);
  std::string GetText();
  template <typename T, typename Allocator>
  void GetList(std::vector<T, Allocator>& list)
  {
    static_assert(std::is_trivially_copyable_v<T>);
    list.resize(this->GetCount(sizeof(T)));
    this->Read(list.data(), list.size() * sizeof(T));
  }

  /** Refuses it unless so many values of so many bytes may follow. */
  void Need(std::uint64_t count, std::size_t bytes) const;

  /** The content is not what its reader expects, though it is undamaged. */
  [[noreturn]] void Refuse(const std::string& reason) const;

private:
  void ReadBuffer();
  bool Fetch(void* bytes, std::size_t count);

  std::string Name;
  std::FILE* File = nullptr;
  std::vector<unsigned char> Buffer;
  std::size_t Taken = 0;  ///< Of the buffer.
  std::uint64_t Left = 0; ///< Bytes of the file that have not been read.
  std::uint64_t Hash = 0;
};

/** Has the disk know of the names in a folder; where that cannot be asked for, nothing. */
void FlushFolder(const std::string& folder);
}

#endif
