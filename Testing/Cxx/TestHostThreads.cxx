// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// How many threads there are, and another executor in their place, for measurements.
#include "FilterTestTools.h"
#include "Host/HostThreads.h"
#include "vtkDeformableSurface.h"

#include <vtkPolyData.h>
#include <vtkSMPTools.h>

#include <chrono>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <thread>

using namespace volumic;

namespace
{
/** Sequential; counts the calls, and notes the phases. */
class CountingExecutor final : public Executor
{
public:
  void For(std::size_t n, std::size_t,
    const std::function<void(std::size_t begin, std::size_t end)>& body) override
  {
    ++this->Calls;
    body(0, n);
  }
  void EndPhase(const char* name) override { this->Phases.push_back(name); }

  int Calls = 0;
  std::vector<std::string> Phases;
};

/** How many threads work where each item takes some time. */
std::size_t ThreadsAtWork(int numberOfThreads)
{
  std::mutex mutex;
  std::set<std::thread::id> ids;
  HostThreads threads(numberOfThreads);
  threads.Run(
    [&]
    {
      threads.For(200, 1,
        [&](std::size_t begin, std::size_t end)
        {
          std::this_thread::sleep_for(std::chrono::milliseconds(end - begin));
          const std::lock_guard<std::mutex> lock(mutex);
          ids.insert(std::this_thread::get_id());
        });
    });
  return ids.size();
}

/** A variable of the environment; as before when it goes. */
class Variable
{
public:
  Variable(const char* name, const char* value)
    : Name(name)
  {
    const char* before = std::getenv(name);
    this->Before = before ? std::optional<std::string>(before) : std::nullopt;
    setenv(name, value, 1);
  }
  ~Variable()
  {
    this->Before ? setenv(this->Name, this->Before->c_str(), 1) : unsetenv(this->Name);
  }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

private:
  const char* Name;
  std::optional<std::string> Before;
};

/** Gives the threads back whatever happens. */
class HostThreadsInstead : public testing::Test
{
protected:
  ~HostThreadsInstead() override { HostThreads::UseInstead(nullptr); }
};
}

TEST(HostThreads, AreSeveralWithoutASetting)
{
  if (std::thread::hardware_concurrency() < 2 || std::getenv("VTK_SMP_MAX_THREADS") ||
    std::getenv("VTK_SMP_BACKEND_IN_USE"))
  {
    GTEST_SKIP() << "one processor, or a setting";
  }
  EXPECT_GT(ThreadsAtWork(0), 1u) << "in ParaView, too, whose backend may be sequential";
  EXPECT_EQ(ThreadsAtWork(2), 2u);
}

TEST(HostThreads, AreFewerIfAsked)
{
  EXPECT_EQ(ThreadsAtWork(1), 1u);
  {
    const Variable most("VTK_SMP_MAX_THREADS", "1");
    EXPECT_EQ(ThreadsAtWork(0), 1u);
  }
  if (std::string(vtkSMPTools::GetBackend()) == "Sequential")
  {
    const Variable backend("VTK_SMP_BACKEND_IN_USE", "Sequential");
    EXPECT_EQ(ThreadsAtWork(0), 1u) << "the choice of the user";
  }
}

TEST(HostThreads, WaitForRoomEveryFewItemsHoweverManyThereAre)
{
  constexpr std::size_t grain = 2048; // As of vertices.
  constexpr std::size_t most = std::size_t(1) << 20;
  for (const int number : { 1, 2 })
  {
    HostThreads threads(number);
    const auto largestPiece = [&threads](std::size_t n)
    {
      std::mutex mutex;
      std::size_t largest = 0;
      std::size_t items = 0;
      threads.Run(
        [&]
        {
          threads.For(n, grain,
            [&](std::size_t begin, std::size_t end)
            {
              const std::lock_guard<std::mutex> lock(mutex);
              largest = std::max(largest, end - begin);
              items += end - begin;
            });
        });
      EXPECT_EQ(items, n);
      return largest;
    };
    EXPECT_GE(largestPiece(most), grain) << "there is nothing to wait for";
    vtkNew<vtkImagePyramid> limited; // Until its end there is a limit.
    limited->SetInputData(BallImage(16, 16, 16));
    limited->SetMemoryLimit(4000);
    limited->Update();
    // Each may look at voxels of its own, which bring in 16 pages: 64 KiB.
    constexpr std::size_t ofAnItem = std::size_t(64) << 10;
    EXPECT_LE(largestPiece(most) * ofAnItem, std::size_t(16) << 20);
    EXPECT_LE(largestPiece(grain) * ofAnItem, std::size_t(16) << 20);
  }
}

TEST_F(HostThreadsInstead, DoesAllThatFiltersHaveToShare)
{
  const vtkSmartPointer<vtkImageData> ball = BallImage(32, 32, 32);
  const auto run = [&ball](int threads)
  {
    auto filter = vtkSmartPointer<vtkDeformableSurface>::New();
    filter->SetInputData(ball);
    filter->SetIsoValue(50.0);
    filter->SetNumberOfThreads(threads);
    filter->Update();
    return filter->GetOutput()->GetNumberOfPoints();
  };
  const vtkIdType points = run(0);
  CountingExecutor counting;
  HostThreads::UseInstead(&counting);
  for (const int threads : { 0, 1 })
  {
    SCOPED_TRACE(threads);
    counting = CountingExecutor();
    EXPECT_EQ(run(threads), points);
    EXPECT_GT(counting.Calls, 100);
    for (const char* phase : { "Voxels", "Visits", "Division", "Output" })
    {
      EXPECT_GT(std::count(counting.Phases.begin(), counting.Phases.end(), phase), 0) << phase;
    }
    vtkNew<vtkImagePyramid> pyramid;
    pyramid->SetInputData(ball);
    pyramid->SetNumberOfThreads(threads);
    counting = CountingExecutor();
    pyramid->Update();
    EXPECT_GT(counting.Calls, 0);
  }
  counting = CountingExecutor();
  HostThreads::UseInstead(nullptr);
  EXPECT_EQ(run(0), points);
  EXPECT_EQ(counting.Calls, 0);
  EXPECT_TRUE(counting.Phases.empty());
}

TEST_F(HostThreadsInstead, IsLeftAloneOutsideOfRun)
{
  CountingExecutor counting;
  HostThreads::UseInstead(&counting);
  HostThreads threads(0);
  int items = 0;
  const auto count = [&items](std::size_t begin, std::size_t end)
  { items += static_cast<int>(end - begin); };
  threads.For(10, 1, count);
  EXPECT_EQ(counting.Calls, 0);
  threads.Run([&] { threads.For(10, 1, count); });
  EXPECT_EQ(counting.Calls, 1);
  threads.For(10, 1, count);
  EXPECT_EQ(counting.Calls, 1);
  EXPECT_EQ(items, 30);
}
