// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Another executor in the place of the host's threads, for measurements.
#include "FilterTestTools.h"
#include "HostThreads.h"
#include "vtkDeformableSurface.h"
#include "vtkImagePyramid.h"

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

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

/** Gives the threads back whatever happens. */
class HostThreadsInstead : public testing::Test
{
protected:
  ~HostThreadsInstead() override { HostThreads::UseInstead(nullptr); }
};
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
    for (const char* phase : { "Voxels", "Forces", "Division", "Output" })
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
