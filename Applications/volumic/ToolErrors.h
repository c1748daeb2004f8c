// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicToolErrors_h
#define volumicToolErrors_h

#include <exception>
#include <new>
#include <stdexcept>
#include <string>

namespace tool
{
/** Exit codes of the program; the manual page lists them. */
enum ExitCode
{
  Success = 0,
  RuntimeFailure = 1, ///< a file, the image or the filter; nothing or not everything was written
  UsageFailure = 2,   ///< the command line
  Unfinished = 3 ///< interrupted, at the time or the iteration limit; what there was is written
};

/** A file that cannot be read or written, or a volume without a surface. */
struct Failure : std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/** A command line that makes no sense. */
struct UsageError : std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/** @throws Failure, or another error, of these words if it is so. */
template <class Error = Failure>
void FailIf(bool isSo, const std::string& words)
{
  if (isSo)
  {
    throw Error(words);
  }
}

/** What the work gives; of an error of this kind that it throws, the words begin with the name. */
template <class Error = Failure, class Work>
auto Named(const std::string& name, const Work& work) -> decltype(work())
{
  try
  {
    return work();
  }
  catch (const Error& error)
  {
    throw Error(name + ": " + error.what());
  }
}

/** What an error says; one of memory, which says nothing, these words. */
inline std::string ReasonOf(const std::exception& error, const std::string& ofMemory)
{
  return dynamic_cast<const std::bad_alloc*>(&error) ? ofMemory : error.what();
}

/** What a table has under a key. @throws Failure of these words if it has nothing there. */
template <class Table>
const typename Table::mapped_type& EntryOf(
  const Table& table, const typename Table::key_type& key, const std::string& words)
{
  const auto found = table.find(key);
  return found != table.end() ? found->second : throw Failure(words);
}

/** The same, or what it is otherwise. */
template <class Table>
typename Table::mapped_type EntryOr(const Table& table, const typename Table::key_type& key,
  const typename Table::mapped_type& otherwise)
{
  const auto found = table.find(key);
  return found != table.end() ? found->second : otherwise;
}

/** Of things that are tried one after the other, what failed: it must not take the others with it.
 */
class Failures
{
public:
  template <class Work>
  void Try(const Work& work)
  {
    try
    {
      work();
    }
    catch (const Failure& failure)
    {
      this->Words += (this->Words.empty() ? "" : "\nvolumic: ") + std::string(failure.what());
    }
  }

  /** @throws Failure with all that failed, if anything did. */
  void Throw() const
  {
    if (!this->Words.empty())
    {
      throw Failure(this->Words);
    }
  }

private:
  std::string Words;
};
}

#endif
