// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ScratchTestTools.h"

#include "Core/Mesh/SurfaceMesh.h"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <thread>

using namespace volumic;
using namespace volumic::test;

namespace volumic
{
namespace test
{
bool IsInFile(const void* address)
{
  const auto wanted = reinterpret_cast<std::uintptr_t>(address);
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);)
  {
    std::istringstream fields(line);
    std::uintptr_t begin = 0;
    std::uintptr_t end = 0;
    char dash = 0;
    std::string rights;
    fields >> std::hex >> begin >> dash >> end >> rights;
    if (wanted >= begin && wanted < end)
    {
      return rights.size() == 4 && rights[3] == 's';
    }
  }
  return false;
}
}
}

namespace
{
#ifdef __SANITIZE_THREAD__
constexpr bool IsWatched = true;
#else
constexpr bool IsWatched = false;
#endif

std::string MessageOf(const ScratchOptions& options)
{
  return RefusalOf([&] { const ScratchMemory scratch(options); });
}

using ScratchMemoryTest = ScratchTest;
}

TEST_F(ScratchMemoryTest, HoldsMoreThanTheLimit)
{
  if (IsWatched)
  {
    GTEST_SKIP() << "what ThreadSanitizer notes of each array is memory, too";
  }
  constexpr std::size_t arrays = 8;
  constexpr std::size_t bytes = 64 * MiB;
  constexpr std::size_t n = bytes / sizeof(std::uint64_t);
  const ScratchOptions options = Allowing(144 * MiB, this->Directory.Path);
  const ScratchMemory scratch(options);
  std::vector<std::uint64_t*> values(arrays);
  // Piece by piece, so that no thread runs away while the governor waits for its turn.
  constexpr std::size_t piece = n / 16;
  const auto inPieces = [](const std::uint64_t* array, const auto& body)
  {
    for (std::size_t i = 0; i < n; i += piece)
    {
      PrefetchLarge(array + i, piece * sizeof(std::uint64_t));
      body(i, i + piece);
    }
  };
  const auto onTwoThreads = [&](const auto& body)
  {
    std::thread other([&] { body(0, arrays / 2); });
    body(arrays / 2, arrays);
    other.join();
  };
  onTwoThreads(
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t a = begin; a < end; ++a)
      {
        values[a] = static_cast<std::uint64_t*>(AllocateLarge(bytes));
        inPieces(values[a],
          [&](std::size_t from, std::size_t to) { FillWithNumbers(values[a], from, to); });
      }
    });
  EXPECT_EQ(scratch.Statistics().Mapped, arrays * bytes);
  std::vector<std::size_t> wrong(arrays, 0);
  onTwoThreads(
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t a = begin; a < end; ++a)
      {
        inPieces(values[a],
          [&](std::size_t from, std::size_t to)
          { wrong[a] += CountWrongNumbers(values[a], from, to); });
      }
    });
  EXPECT_EQ(wrong, std::vector<std::size_t>(arrays, 0));
  std::for_each(values.begin(), values.end(), FreeLarge);
  const ScratchStatistics statistics = scratch.Statistics();
  EXPECT_LE(statistics.MostResident, options.Limit);
  EXPECT_GT(statistics.MostResident, options.Limit / 2) << "much of it is not used";
  EXPECT_GT(statistics.Dropped, arrays * bytes);
  EXPECT_EQ(statistics.Mapped, 0u);
  EXPECT_EQ(scratch.Warnings().size(), IsMemory(this->Directory.Path) ? 1u : 0u);
}

TEST_F(ScratchMemoryTest, KeepsSmallArraysOnTheHeap)
{
  const ScratchMemory scratch(Allowing(144 * MiB, this->Directory.Path));
  void* small = AllocateLarge(ScratchMemory::LargeBytes - 1);
  void* large = AllocateLarge(ScratchMemory::LargeBytes);
  EXPECT_FALSE(IsInFile(small));
  EXPECT_TRUE(IsInFile(large));
  EXPECT_EQ(scratch.Statistics().Mapped, ScratchMemory::LargeBytes);
  FreeLarge(small);
  FreeLarge(large);
  FreeLarge(nullptr);
  EXPECT_EQ(scratch.Statistics().Mapped, 0u);
}

TEST_F(ScratchMemoryTest, ArraysOutliveIt)
{
  constexpr std::size_t n = 4 * MiB / sizeof(std::uint64_t);
  LargeVector<std::uint64_t> inFile;
  const LargeVector<std::uint64_t> onHeap(n, 5);
  {
    const ScratchMemory scratch(Allowing(144 * MiB, this->Directory.Path));
    inFile.resize(n);
    EXPECT_EQ(std::count(inFile.begin(), inFile.end(), 0u), static_cast<std::ptrdiff_t>(n));
    FillWithNumbers(inFile.data(), 0, n);
  }
  EXPECT_TRUE(IsInFile(inFile.data()));
  EXPECT_EQ(CountWrongNumbers(inFile.data(), 0, n), 0u);
  const LargeVector<std::uint64_t> copy = inFile;
  EXPECT_FALSE(IsInFile(copy.data()));
  EXPECT_EQ(copy, inFile);
  const ScratchMemory again(Allowing(144 * MiB, this->Directory.Path));
  EXPECT_EQ(again.Statistics().Mapped, n * sizeof(std::uint64_t));
  LargeVector<std::uint64_t>().swap(inFile);
  EXPECT_EQ(again.Statistics().Mapped, 0u);
  EXPECT_EQ(onHeap.back(), 5u);
}

TEST_F(ScratchMemoryTest, OfTwoTheSmallerLimitCountsAndTheLastDirectory)
{
  if (IsWatched)
  {
    GTEST_SKIP() << "what ThreadSanitizer notes of each array is memory, too";
  }
  const OwnDirectory other;
  constexpr std::size_t bytes = 64 * MiB;
  constexpr std::size_t n = bytes / sizeof(std::uint64_t);
  const ScratchOptions small = Allowing(144 * MiB, this->Directory.Path);
  const ScratchMemory first(small);
  auto second = std::make_unique<ScratchMemory>(Allowing(4096 * MiB, other.Path));
  std::vector<LargeVector<std::uint64_t>> arrays;
  for (int i = 0; i < 8; ++i)
  {
    arrays.emplace_back(n, 1);
  }
  // The governor may have its turn but once in an array.
  EXPECT_LT(second->Statistics().MostResident, small.Limit + bytes);
  EXPECT_GT(second->Statistics().Dropped, bytes);
  second.reset();
  arrays.emplace_back(n, 3);
  EXPECT_EQ(first.Statistics().Mapped, 9 * bytes);
  EXPECT_EQ(arrays[8][n - 1], 3u);
}

TEST_F(ScratchMemoryTest, RefusesADirectoryThatCannotBeUsed)
{
  ScratchOptions options = Allowing(144 * MiB, this->Directory.Path + "/missing");
  EXPECT_TRUE(Has(MessageOf(options), "Scratch Directory " + options.Directory));
  EXPECT_TRUE(Has(MessageOf(options), "No such file or directory"));
  options.Directory = this->Directory.Path + "/file";
  std::ofstream(options.Directory) << "not a directory";
  EXPECT_TRUE(Has(MessageOf(options), "Not a directory"));
  options.Directory = "/proc";
  EXPECT_TRUE(Has(MessageOf(options), "/proc cannot be used"));
  // Other runs are as before.
  void* memory = AllocateLarge(2 * MiB);
  EXPECT_FALSE(IsInFile(memory));
  FreeLarge(memory);
}

TEST_F(ScratchMemoryTest, TakesTheDirectoryOfTheSystem)
{
  const char* set = std::getenv("TMPDIR");
  const std::string before = set ? set : "";
  setenv("TMPDIR", "/nowhere/at/all", 1);
  const std::string message = MessageOf(Allowing(144 * MiB, ""));
  EXPECT_TRUE(Has(message, "/nowhere/at/all (of TMPDIR)"));
  setenv("TMPDIR", this->Directory.Path.c_str(), 1);
  EXPECT_EQ(CheckedScratchDirectory(""), this->Directory.Path);
  unsetenv("TMPDIR");
  EXPECT_EQ(CheckedScratchDirectory(""), "/var/tmp");
  if (set)
  {
    setenv("TMPDIR", before.c_str(), 1);
  }
}

TEST_F(ScratchMemoryTest, RefusesLessThanTheProcessHolds)
{
  if (IsWatched)
  {
    GTEST_SKIP() << "what ThreadSanitizer notes of each array is memory, too";
  }
  ScratchOptions options = Allowing(0, this->Directory.Path);
  options.Limit = 3 * MiB;
  const std::string message = MessageOf(options);
  EXPECT_TRUE(Has(message, "Memory Limit is 3 MiB"));
  EXPECT_TRUE(Has(message, "MiB at least; 0 is no limit."));
  // Arrays of other runs need not stay in memory, so they do not count.
  auto first = std::make_unique<ScratchMemory>(Allowing(1024 * MiB, this->Directory.Path));
  const LargeVector<char> resident(256 * MiB, 'x');
  options.Limit = ResidentMemoryMeter().Read().All - 64 * MiB;
  EXPECT_EQ(MessageOf(options), "");
}

TEST_F(ScratchMemoryTest, TellsOnceThatTheLimitWasPassed)
{
  const ScratchOptions options = Allowing(136 * MiB, this->Directory.Path);
  const ScratchMemory scratch(options);
  LargeVector<char> inFile(16 * MiB, 'x');
  std::vector<char> cannotLeave(320 * MiB, 'x');
  while (scratch.Statistics().MostResident <= options.Limit)
  {
    std::this_thread::yield();
  }
  EXPECT_EQ(std::count(inFile.begin(), inFile.end(), cannotLeave.back()), 16 * MiB);
  const std::vector<std::string> warnings = scratch.Warnings();
  ASSERT_FALSE(warnings.empty());
  EXPECT_TRUE(Has(warnings.back(), "MiB cannot be put into files"));
  EXPECT_EQ(scratch.Warnings().size(), warnings.size());
}

TEST_F(ScratchMemoryTest, TellsThatADirectoryIsMemory)
{
  if (!IsMemory("/dev/shm"))
  {
    GTEST_SKIP() << "/dev/shm is no tmpfs";
  }
  const ScratchMemory scratch(Allowing(144 * MiB, "/dev/shm"));
  ASSERT_EQ(scratch.Warnings().size(), 1u);
  EXPECT_TRUE(Has(scratch.Warnings()[0], "/dev/shm is memory itself"));
}

TEST_F(ScratchMemoryTest, ManyThreadsTakeAndGiveWhileItDrops)
{
  const ScratchOptions options = Allowing(136 * MiB, this->Directory.Path);
  const ScratchMemory scratch(options);
  std::vector<std::size_t> wrong(8, 1);
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < wrong.size(); ++t)
  {
    threads.emplace_back(
      [&wrong, t]
      {
        wrong[t] = 0;
        for (std::size_t i = 0; i < 12; ++i)
        {
          const std::size_t n = (1 + (t + i) % 5) * MiB / 4;
          LargeVector<std::uint64_t> values(n);
          FillWithNumbers(values.data(), 0, n);
          wrong[t] += CountWrongNumbers(values.data(), 0, n);
        }
      });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  EXPECT_EQ(wrong, std::vector<std::size_t>(8, 0));
  EXPECT_EQ(scratch.Statistics().Mapped, 0u);
}

TEST_F(ScratchMemoryTest, MakesRoomThatTakesNoMemory)
{
  constexpr std::size_t n = 4 * MiB;
  LargeVector<Vector> values;
  const ResidentMemoryMeter meter;
  const std::size_t before = meter.Read().All;
  MakeRoom(values, n);
#ifndef __SANITIZE_ADDRESS__ // Which keeps memory of its own for each byte.
  EXPECT_LT(meter.Read().All, before + n) << "a sixteenth of what n have";
#endif
  values.resize(n);
  const Vector* const place = values.data();
  values[n - 1].X = 1.f;
  values.resize(2 * n);
  EXPECT_EQ(values.data(), place);
  MakeRoom(values, 3 * n);
  EXPECT_EQ(values.size(), 2 * n) << "there is room already";
  EXPECT_EQ(values[n - 1].X, 1.f);
  MakeRoom(values, 3 * n + 1);
  EXPECT_TRUE(values.empty());
}
