// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/CheckedFile.h"
#include "Core/Common/ContentHash.h"
#include "TemporaryFolder.h"

#ifndef _WIN32
#include <sys/stat.h>
#include <unistd.h>
#endif

using namespace volumic;

namespace
{
/** More than a buffer. */
std::vector<int> LongList()
{
  std::vector<int> list(700001);
  std::iota(list.begin(), list.end(), -5);
  return list;
}

void WriteSome(const std::string& name)
{
  CheckedWriter file(name);
  file.Put(2.5);
  file.PutText("a text");
  file.PutList(LongList());
  file.PutText("");
  file.Commit();
}

void ExpectSome(const std::string& name)
{
  CheckedReader file(name);
  EXPECT_EQ(file.Get<double>(), 2.5);
  EXPECT_EQ(file.GetText(), "a text");
  std::vector<int> list;
  file.GetList(list);
  EXPECT_EQ(list, LongList());
  EXPECT_EQ(file.GetText(), "");
}

void SetBytes(const std::string& name, const std::string& bytes)
{
  std::ofstream(name, std::ios::binary) << bytes;
}

/** What work says of a file as it fails; nothing where it does not. */
template <typename Work>
std::string FailureOf(const Work& work)
{
  try
  {
    work();
    return "";
  }
  catch (const FileError& error)
  {
    return error.what();
  }
}

void ExpectDamaged(const std::string& name)
{
  EXPECT_EQ(FailureOf([&] { ExpectSome(name); }), name + " is damaged");
}
}

TEST(CheckedFile, GivesBackWhatWasWritten)
{
  const TemporaryFolder folder;
  const std::string name = folder.File("some");
  WriteSome(name);
  ExpectSome(name);
  EXPECT_EQ(folder.Names(), std::set<std::string>{ "some" });
}

TEST(CheckedFile, IsThereWhenItIsCommittedAndTheOldOneUntilThen)
{
  const TemporaryFolder folder;
  const std::string name = folder.File("some");
  WriteSome(name);
  {
    CheckedWriter file(name);
    file.PutList(LongList());
    EXPECT_EQ(folder.Names(), (std::set<std::string>{ "some", "some.new" }));
  }
  EXPECT_EQ(folder.Names(), std::set<std::string>{ "some" });
  ExpectSome(name);
  CheckedWriter file(name);
  file.Put(1);
  file.Commit();
  EXPECT_EQ(CheckedReader(name).Get<int>(), 1);
}

TEST(CheckedFile, DoesNotBelieveWhatIsDamaged)
{
  const TemporaryFolder folder;
  const std::string name = folder.File("some");
  WriteSome(name);
  const std::string bytes = BytesOf(name);
  ASSERT_GT(bytes.size(), std::size_t(2) << 20);
  for (std::size_t place = 0; place < bytes.size(); place += 200003)
  {
    std::string damaged = bytes;
    damaged[place] = static_cast<char>(damaged[place] ^ 4);
    SetBytes(name, damaged);
    ExpectDamaged(name);
    SetBytes(name, bytes.substr(0, place)); // Cut off.
    ExpectDamaged(name);
  }
  // Two whole buffers that have changed places.
  const std::size_t buffer = 16 + (std::size_t(1) << 20);
  SetBytes(name, bytes.substr(buffer, buffer) + bytes.substr(0, buffer) + bytes.substr(2 * buffer));
  ExpectDamaged(name);
  SetBytes(name, bytes);
  ExpectSome(name);
}

TEST(CheckedFile, TakesNoMemoryForMoreThanItHas)
{
  const TemporaryFolder folder;
  const std::string name = folder.File("some");
  // Their sums are right: who made them knows the format.
  for (const std::uint64_t count : { ~std::uint64_t(0), std::uint64_t(1) << 60,
         std::uint64_t(1) << 40, std::uint64_t(100) })
  {
    CheckedWriter file(name);
    file.Put(count);
    file.Put(1.0);
    file.Commit();
    const auto expectRefused = [&](const auto& read)
    {
      CheckedReader reader(name);
      EXPECT_EQ(FailureOf([&] { read(reader); }), name + " is damaged") << count;
    };
    expectRefused([](CheckedReader& reader) { reader.GetText(); });
    expectRefused([](CheckedReader& reader) { reader.GetCount(8); });
    expectRefused(
      [](CheckedReader& reader)
      {
        std::vector<double> list;
        reader.GetList(list);
      });
  }
}

#ifndef _WIN32
TEST(CheckedFile, IsNoneOfAnotherUserNorALinkNorAPipe)
{
  const TemporaryFolder folder;
  WriteSome(folder.File("some"));
  ASSERT_EQ(symlink(folder.File("some").c_str(), folder.File("link").c_str()), 0);
  ASSERT_EQ(mkfifo(folder.File("pipe").c_str(), 0600), 0);
  EXPECT_THROW(CheckedReader(folder.File("link")), FileError);
  EXPECT_THROW(CheckedReader(folder.File("pipe")), FileError) << "it would be waited for";
  if (geteuid() != 0)
  {
    GTEST_SKIP() << "only root can give a file to another user";
  }
  ASSERT_EQ(chown(folder.File("some").c_str(), 12345, 12345), 0);
  EXPECT_EQ(FailureOf([&] { CheckedReader file(folder.File("some")); }),
    folder.File("some") + " is no file of yours");
}
#endif

TEST(CheckedFile, TellsWhichFileAndWhy)
{
  const TemporaryFolder folder;
  const std::string missing = folder.File("none/some");
  EXPECT_EQ(FailureOf([&] { CheckedWriter file(missing); }),
    missing + " cannot be written (No such file or directory)");
  EXPECT_EQ(FailureOf([&] { CheckedReader file(missing); }),
    missing + " cannot be read (No such file or directory)");
}

TEST(CheckedFile, LeavesNothingOnAFullDisk)
{
  const TemporaryFolder folder;
  const LimitedFileSize limit(1500000);
  EXPECT_TRUE(Has(
    FailureOf([&] { WriteSome(folder.File("some")); }), "cannot be written (File too large)"));
  EXPECT_EQ(folder.Names(), std::set<std::string>());
}

TEST(ContentHash, IsAnotherOneForAnyOtherContent)
{
  std::set<std::uint64_t> found;
  std::vector<unsigned char> bytes(3 << 20, 0);
  std::size_t tried = 0;
  const auto expectNew = [&](std::size_t count)
  {
    ++tried;
    EXPECT_TRUE(found.insert(ContentHash(bytes.data(), count)).second) << tried;
  };
  for (std::size_t count = 0; count < 100; ++count)
  {
    expectNew(count);
  }
  expectNew(1 << 20);
  expectNew((1 << 20) + 1);
  for (std::size_t place = 0; place < bytes.size(); place += 99991)
  {
    bytes[place] = 1;
    expectNew(bytes.size());
    bytes[place] = 0;
  }
  expectNew(bytes.size());
  for (std::size_t place = 0; place < 37; ++place)
  {
    bytes[place] = 1;
    expectNew(37);
    bytes[place] = 0;
  }
}
