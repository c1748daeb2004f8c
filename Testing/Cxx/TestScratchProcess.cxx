// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// What becomes of scratch memory where the disk is full, a process is forked, or killed.

#include "ScratchTestTools.h"

#include <csignal>

#include <pthread.h>
#include <sys/resource.h>
#include <sys/wait.h>

using namespace volumic;
using namespace volumic::test;

namespace
{
using ScratchProcess = ScratchTest;

std::string WhyItIsFull(std::size_t bytes)
{
  try
  {
    FreeLarge(AllocateLarge(bytes));
  }
  catch (const ScratchFull& full)
  {
    return full.what();
  }
  return {};
}

/** Runs it in a child of the process. @return its status as of waitpid. */
int StatusOf(const std::function<bool()>& isRight)
{
  const pid_t child = fork();
  if (child == 0)
  {
    _exit(isRight() ? 0 : 1);
  }
  int status = -1;
  waitpid(child, &status, 0);
  return status;
}
}

TEST_F(ScratchProcess, FilesMayHaveALimitOfTheSystem)
{
  const ScratchMemory scratch(Allowing(144 * MiB, this->Directory.Path));
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  rlimit small = before;
  small.rlim_cur = 4 * MiB;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string message = WhyItIsFull(5 * MiB);
  const std::string fits = WhyItIsFull(4 * MiB);
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_TRUE(Has(message, "ulimit -f"));
  EXPECT_EQ(fits, "");
  EXPECT_EQ(scratch.Statistics().Mapped, 0u);
}

TEST_F(ScratchProcess, WithoutAThreadThereIsNoLimitAndTheNextOneWorks)
{
#if defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "ThreadSanitizer wants no threads in the child";
#endif
  const int status = StatusOf(
    [&]
    {
      // A stack that no address space has room for: a limit of threads would not hold for root.
      pthread_attr_t huge;
      pthread_attr_init(&huge);
      pthread_attr_setstacksize(&huge, std::size_t(1) << 46);
      pthread_attr_t usual;
      pthread_getattr_default_np(&usual);
      if (pthread_setattr_default_np(&huge) != 0)
      {
        return false;
      }
      std::string message;
      try
      {
        const ScratchMemory scratch(Allowing(144 * MiB, this->Directory.Path));
      }
      catch (const std::runtime_error& error)
      {
        message = error.what();
      }
      pthread_setattr_default_np(&usual);
      const bool hasNone = !HasMemoryLimit();
      const ScratchMemory scratch(Allowing(144 * MiB, this->Directory.Path));
      const LargeVector<char> values(8 * MiB, 'x');
      return message.find("needs a thread of its own") != std::string::npos && hasNone &&
        IsInFile(values.data());
    });
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
}

TEST_F(ScratchProcess, MoreThanTheDiskHasIsRefusedAndNothingRemains)
{
  const ScratchMemory scratch(Allowing(144 * MiB, this->Directory.Path));
  const std::size_t before = FreeRoom(this->Directory.Path);
  ASSERT_GT(before, 0u);
  EXPECT_THROW(FreeLarge(AllocateLarge(before + before / 2)), ScratchFull);
  EXPECT_EQ(scratch.Statistics().Mapped, 0u);
  EXPECT_GT(FreeRoom(this->Directory.Path), before / 2);
  EXPECT_TRUE(this->Directory.IsEmpty());
}

TEST_F(ScratchProcess, NothingIsLeftOfAProcessThatIsKilled)
{
  int tell[2];
  ASSERT_EQ(pipe(tell), 0);
  const pid_t child = fork();
  if (child == 0)
  {
    const ScratchMemory scratch(Allowing(144 * MiB, this->Directory.Path));
    const LargeVector<char> values(8 * MiB, 'x');
    const char done = IsInFile(values.data()) ? 'y' : 'n';
    static_cast<void>(write(tell[1], &done, 1));
    for (;;)
    {
      pause();
    }
  }
  char done = 0;
  EXPECT_EQ(read(tell[0], &done, 1), 1);
  EXPECT_EQ(done, 'y');
  EXPECT_TRUE(this->Directory.IsEmpty()) << "files have names";
  kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_TRUE(this->Directory.IsEmpty());
  close(tell[0]);
  close(tell[1]);
}

TEST_F(ScratchProcess, AChildReadsAndFreesArraysAndMakesItsOwn)
{
#ifdef __SANITIZE_THREAD__
  GTEST_SKIP() << "ThreadSanitizer wants no threads in the child";
#endif
  constexpr std::size_t n = 2 * MiB / sizeof(std::uint64_t);
  auto scratch = std::make_unique<ScratchMemory>(Allowing(144 * MiB, this->Directory.Path));
  LargeVector<std::uint64_t> values(n);
  FillWithNumbers(values.data(), 0, n);
  const int status = StatusOf(
    [&]
    {
      bool isRight = CountWrongNumbers(values.data(), 0, n) == 0;
      LargeVector<std::uint64_t> own = values;
      own[0] = 5;
      isRight = isRight && !IsInFile(own.data());
      LargeVector<std::uint64_t>().swap(values);
      scratch.reset();
      const ScratchMemory ownScratch(Allowing(144 * MiB, this->Directory.Path));
      own.resize(2 * n, 7);
      return isRight && IsInFile(own.data()) && own[2 * n - 1] == 7;
    });
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  EXPECT_EQ(CountWrongNumbers(values.data(), 0, n), 0u);
  EXPECT_TRUE(IsInFile(values.data()));
  // What the parent does afterwards is as before.
  LargeVector<std::uint64_t> more(16 * n, 1);
  EXPECT_TRUE(IsInFile(more.data()));
}

TEST_F(ScratchProcess, AChildThatWritesToItsParentsArraysIsEnded)
{
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers catch the signal";
#endif
  const ScratchMemory scratch(Allowing(144 * MiB, this->Directory.Path));
  LargeVector<char> values(2 * MiB, 'x');
  const int status = StatusOf(
    [&]
    {
      const rlimit none{};
      setrlimit(RLIMIT_CORE, &none);
      static_cast<volatile char*>(values.data())[100] = 'y';
      return true;
    });
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGSEGV) << status;
  EXPECT_EQ(values[100], 'x');
}
