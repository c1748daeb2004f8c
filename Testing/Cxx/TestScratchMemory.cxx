// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/ScratchMemory.h"
#include "Core/Mesh/SurfaceMesh.h"
#include "TemporaryFolder.h"

using namespace volumic;

namespace
{
constexpr std::size_t n = ScratchMemory::LargeBytes;

/** Whether the system maps an array to a file of a directory. */
bool IsIn(const TemporaryFolder& folder, const LargeVector<char>& array)
{
  const auto address = reinterpret_cast<std::uintptr_t>(array.data());
  const auto mapped = folder.Mapped();
  return std::any_of(mapped.begin(), mapped.end(),
    [address](const auto& range) { return range.first <= address && address < range.second; });
}
}

TEST(ScratchMemory, StoresLargeArraysInUnnamedFiles)
{
  const TemporaryFolder folder;
  const TemporaryFolder other;
  const LargeVector<char> before(n, 'b');
  LargeVector<char> large;
  {
    const ScratchMemory scratch(folder.Path());
    LargeVector<char> small(n - 1);
    MakeZeroed(large, n + 1);
    EXPECT_FALSE(IsIn(folder, small));
    EXPECT_TRUE(IsIn(folder, large));
    EXPECT_EQ(std::count(large.begin(), large.end(), 0), static_cast<std::ptrdiff_t>(n + 1));
    large.back() = 'x';
    {
      const ScratchMemory last(other.Path());
      EXPECT_TRUE(IsIn(other, LargeVector<char>(n)));
      EXPECT_FALSE(IsIn(folder, before));
    }
    EXPECT_TRUE(IsIn(folder, LargeVector<char>(n)));
    EXPECT_TRUE(folder.Names().empty() && other.Names().empty());
  }
  EXPECT_TRUE(IsIn(folder, large)) << "arrays outlive the object";
  EXPECT_EQ(large.back(), 'x');
  const LargeVector<char> copy = large;
  EXPECT_FALSE(IsIn(folder, copy));
  EXPECT_EQ(copy, large);
}

TEST(ScratchMemory, ReservesDiskSpace)
{
  const TemporaryFolder folder;
  const ScratchMemory scratch(folder.Path());
  const std::size_t before = std::filesystem::space(folder.Path()).available;
  const auto allocate = [](std::size_t bytes) -> std::string
  {
    try
    {
      FreeLarge(AllocateLarge(bytes), bytes);
    }
    catch (const ScratchFull& full)
    {
      return full.what();
    }
    return "";
  };
  EXPECT_TRUE(Has(allocate(before + before / 2), "Scratch Directory " + folder.Path() + " lacks"));
  EXPECT_TRUE(Has(allocate(before + before / 2), "Free space there, or choose another"));
  EXPECT_GT(std::filesystem::space(folder.Path()).available, before / 2);
  const LimitedFileSize limit(2 * n);
  EXPECT_TRUE(Has(allocate(3 * n), "Allow larger files (ulimit -f)"));
  EXPECT_EQ(allocate(2 * n), "");
}

TEST(ScratchMemory, ReservesCapacity)
{
  LargeVector<Vector> values;
  MakeRoom(values, n);
  values.resize(n);
  const Vector* const data = values.data();
  values[n - 1].X = 1.f;
  values.resize(2 * n);
  EXPECT_EQ(values.data(), data);
  MakeRoom(values, 3 * n);
  EXPECT_EQ(values.size(), 2 * n) << "the capacity suffices";
  EXPECT_EQ(values[n - 1].X, 1.f);
  MakeRoom(values, 3 * n + 1);
  EXPECT_TRUE(values.empty());
}
