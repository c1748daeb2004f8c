// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Host/HostThreads.h"
#include "LabelImages.h"
#include "RankTestTools.h"

#include <vtkErrorCode.h>

#include <atomic>
#include <chrono>
#include <new>

using namespace volumic;

namespace
{
using Filter = vtkSmartPointer<vtkLabelsToSurfaces>;
using Change = std::function<void(vtkLabelsToSurfaces*)>;
using Work = std::function<void(vtkLabelsToSurfaces*, RankController*)>;

/** Many that meet by threes, and two large ones; of two more there are three voxels each. */
double CellAt(int i, int j, int k)
{
  if (i == 36 && j > 24)
  {
    return k == 2 ? 30. : k == 20 ? 31. : 0.;
  }
  return i < 20 ? 1 + i / 10 + 2 * (j / 14) + 4 * (k / 14) : j < 14 ? 20 : 0;
}

/** The filters of all ranks, when they are through; of an image that the first one has. */
std::vector<Filter> OnMap(int count, const Change& change, const Work& work)
{
  std::vector<Filter> filters(static_cast<std::size_t>(count));
  volumic::RunRanks(count,
    [&](RankController* controller)
    {
      const int rank = controller->GetLocalProcessId();
      auto filter = Filter::New();
      filter->SetController(controller);
      filter->SetInputDataObject(
        rank == 0 ? LabelImageOf(40, 28, 28, CellAt) : vtkSmartPointer<vtkImageData>::New());
      filter->SetNumberOfThreads(1);
      change(filter);
      work(filter, controller);
      filter->SetController(nullptr);
      filters[static_cast<std::size_t>(rank)] = filter;
    });
  return filters;
}

std::vector<Filter> Update(int count, const Change& change)
{
  return OnMap(count, change,
    [](vtkLabelsToSurfaces* filter, RankController* ranks) { UpdatePiece(filter, ranks); });
}

/** The blocks of one rank alone are those of the first, and the others have them empty. */
void ExpectBlocksOf(vtkLabelsToSurfaces* one, const std::vector<Filter>& ranks)
{
  ExpectSameBlocks(ranks.front()->GetOutput(), one->GetOutput());
  for (std::size_t rank = 1; rank < ranks.size(); ++rank)
  {
    EXPECT_EQ(BlockNames(ranks[rank]->GetOutput()), BlockNames(one->GetOutput()));
    for (unsigned int block = 0; block < ranks[rank]->GetOutput()->GetNumberOfBlocks(); ++block)
    {
      EXPECT_EQ(BlockOf(ranks[rank], block)->GetNumberOfPoints(), 0);
    }
  }
}

/** Labels 3 and 7, which do not touch. */
void TakeTwoBalls(vtkLabelsToSurfaces* filter)
{
  if (vtkImageData::SafeDownCast(filter->GetInputDataObject(0, 0))->GetNumberOfPoints() > 0)
  {
    filter->SetInputDataObject(LabelImageOf(40, 24, 24,
      [](int i, int j, int k)
      {
        return std::hypot(i - 11., j - 12., k - 12.) < 9. ? 3
          : std::hypot(i - 30., j - 12., k - 12.) < 8.    ? 7
                                                          : 0;
      }));
  }
}

/** While it lives, work on a label takes a third of a second or more: it is told of, and can be
 * stopped. */
class Slowness : public Executor
{
public:
  Slowness() { HostThreads::UseInstead(this); }
  ~Slowness() { HostThreads::UseInstead(nullptr); }
  Slowness(const Slowness&) = delete;
  Slowness& operator=(const Slowness&) = delete;

  void For(
    std::size_t n, std::size_t, const std::function<void(std::size_t, std::size_t)>& body) override
  {
    thread_local int left = 30; // Each label is on a thread of its own here.
    this->Threads += left == 30 ? 1 : 0;
    if (left > 0)
    {
      --left;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    if (n > 0)
    {
      body(0, n);
    }
  }

  std::atomic<int> Threads{ 0 };
};

int CountStopped(vtkLabelsToSurfaces* filter)
{
  int stopped = 0;
  for (unsigned int block = 0; block < filter->GetOutput()->GetNumberOfBlocks(); ++block)
  {
    stopped += StopReason(BlockOf(filter, block)) == "cancelled";
  }
  return stopped;
}
}

TEST(RankLabels, AreTheSameBitsOnAnyNumberOfRanks)
{
  const std::vector<Change> changes = { [](vtkLabelsToSurfaces*) {},
    [](vtkLabelsToSurfaces* filter)
    {
      filter->SetGap(0.05);
      filter->SetVoxelTolerance(0.0); // so that some meet
    },
    [](vtkLabelsToSurfaces* filter) { filter->SetMerge(true); },
    [](vtkLabelsToSurfaces* filter)
    {
      filter->AddLabel(2);
      filter->AddLabel(30);
      filter->SetFinestLevel(1);
    } };
  for (std::size_t c = 0; c < changes.size(); ++c)
  {
    SCOPED_TRACE(c);
    const std::vector<Filter> one = Update(1, changes[c]);
    EXPECT_GT(BlockOf(one[0], 0)->GetNumberOfPoints(), 100);
    std::set<std::string> texts;
    const std::vector<Filter> ranks = OnMap(c % 2 == 0 ? 2 : 5, changes[c],
      [&texts](vtkLabelsToSurfaces* filter, RankController* controller)
      {
        const ProgressListener listener(filter);
        UpdatePiece(filter, controller);
        if (controller->GetLocalProcessId() == 0)
        {
          texts = listener.Texts;
        }
      });
    ExpectBlocksOf(one[0], ranks);
    const bool anyApart = std::any_of(texts.begin(), texts.end(),
      [](const std::string& text) { return text.find("apart: ") == 0; });
    EXPECT_EQ(anyApart, c == 1) << "surfaces were made again";
    for (int block = 0; block < static_cast<int>(one[0]->GetOutput()->GetNumberOfBlocks()); ++block)
    {
      EXPECT_GT(ranks[0]->GetSeconds(block), 0.0);
    }
  }
}

TEST(RankLabels, WorkOnLabelsOfTheirOwnAndTellOfAll)
{
  const std::vector<Filter> one = Update(1, TakeTwoBalls);
  const Slowness slowness;
  std::vector<std::set<std::string>> texts(2);
  const std::vector<Filter> ranks = OnMap(2, TakeTwoBalls,
    [&](vtkLabelsToSurfaces* filter, RankController* controller)
    {
      const ProgressListener listener(filter);
      UpdatePiece(filter, controller);
      EXPECT_TRUE(std::is_sorted(listener.Shares.begin(), listener.Shares.end()))
        << ::testing::PrintToString(listener.Shares);
      texts[static_cast<std::size_t>(controller->GetLocalProcessId())] = listener.Texts;
    });
  ExpectBlocksOf(one[0], ranks);
  EXPECT_EQ(slowness.Threads, 6) << "those of the ranks, and some of each for a label";
  EXPECT_EQ(texts[0].count("0 of 2, Label 3"), 1u) << "the largest goes to the first";
  EXPECT_EQ(texts[1].count("0 of 2, Label 3"), 1u) << "the others hear of it";
}

TEST(RankLabels, StopWhereAnyRankIsAskedToAndGoOn)
{
  const std::vector<Filter> one = Update(1, TakeTwoBalls);
  const Slowness slowness;
  for (const int asked : { 0, 1 })
  {
    const std::vector<Filter> ranks = OnMap(2, TakeTwoBalls,
      [asked](vtkLabelsToSurfaces* filter, RankController* controller)
      {
        const int rank = controller->GetLocalProcessId();
        {
          const StopAtText stop(filter, "0 of 2, ", rank == asked ? 1 : 1000);
          UpdatePiece(filter, controller);
        }
        EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
        EXPECT_EQ(CountStopped(filter), rank == 0 ? 2 : 0) << "labels of both";
        filter->GoOn();
        UpdatePiece(filter, controller);
      });
    ExpectBlocksOf(one[0], ranks);
  }
}

TEST(RankLabels, EndOnAllRanksWithTheErrorOfOneAndWorkAgain)
{
  const std::vector<Filter> one = Update(1, TakeTwoBalls);
  const Slowness slowness;
  const std::vector<Filter> ranks = OnMap(3, TakeTwoBalls,
    [](vtkLabelsToSurfaces* filter, RankController* controller)
    {
      bool isBad = controller->GetLocalProcessId() == 2;
      {
        const ProgressHook hook(filter,
          [&isBad](vtkAlgorithm*, const std::string& text, double)
          {
            if (std::exchange(isBad, isBad && text.find(" of 2, ") == std::string::npos) && !isBad)
            {
              throw std::bad_alloc();
            }
          });
        const MessagesOf errors(filter);
        UpdatePiece(filter, controller);
        EXPECT_TRUE(errors.Has("the memory does not suffice for the surfaces")) << errors.Get();
        EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::UnknownError);
        EXPECT_EQ(filter->GetOutput()->GetNumberOfBlocks(), 0u);
      }
      filter->AddLabel(99); // which only the first one looks for
      const MessagesOf errors(filter);
      UpdatePiece(filter, controller);
      EXPECT_TRUE(errors.Has("'Labels' has no label 99; it has 0, 3, 7")) << errors.Get();
      EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::UserError);
      filter->ClearLabels();
      UpdatePiece(filter, controller);
    });
  ExpectBlocksOf(one[0], ranks);
}
