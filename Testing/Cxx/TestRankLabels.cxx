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

/** While it lives, meshing takes half a second or more: other ranks hear of it. */
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
    if (this->Left > 0)
    {
      --this->Left;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    if (n > 0)
    {
      body(0, n);
    }
  }

private:
  std::atomic<int> Left{ 50 };
};

constexpr const char* Making = " of the labels";
}

TEST(RankLabels, AreTheSameBitsOnAnyNumberOfRanks)
{
  const std::vector<Change> changes = { [](vtkLabelsToSurfaces*) {},
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
    const std::vector<Filter> ranks = Update(c % 2 == 0 ? 2 : 5, changes[c]);
    ExpectBlocksOf(one[0], ranks);
    ExpectSameSurfaces(ranks[0]->GetInterfaces(), one[0]->GetInterfaces());
    EXPECT_EQ(ranks[1]->GetInterfaces()->GetNumberOfPoints(), 0);
  }
}

TEST(RankLabels, OthersHearOfTheProgress)
{
  std::vector<std::set<std::string>> texts(2);
  const Slowness slowness;
  OnMap(
    2, [](vtkLabelsToSurfaces*) {},
    [&](vtkLabelsToSurfaces* filter, RankController* controller)
    {
      const ProgressListener listener(filter);
      UpdatePiece(filter, controller);
      EXPECT_TRUE(std::is_sorted(listener.Shares.begin(), listener.Shares.end()))
        << ::testing::PrintToString(listener.Shares);
      texts[static_cast<std::size_t>(controller->GetLocalProcessId())] = listener.Texts;
    });
  for (const std::set<std::string>& ofRank : texts)
  {
    EXPECT_EQ(ofRank.count("Interfaces of the labels"), 1u);
  }
}

TEST(RankLabels, StopWhereAnyRankIsAskedToAndStartAnew)
{
  const std::vector<Filter> one = Update(1, [](vtkLabelsToSurfaces*) {});
  for (const int asked : { 0, 1 })
  {
    const Slowness slowness;
    const std::vector<Filter> ranks = OnMap(
      2, [](vtkLabelsToSurfaces*) {},
      [asked](vtkLabelsToSurfaces* filter, RankController* controller)
      {
        const int rank = controller->GetLocalProcessId();
        {
          const StopAtText stop(filter, Making, rank == asked ? 1 : 100000);
          UpdatePiece(filter, controller);
        }
        EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
        if (rank == 0)
        {
          EXPECT_EQ(StopReason(BlockOf(filter, 0)), "cancelled");
        }
        filter->Modified();
        UpdatePiece(filter, controller);
      });
    ExpectBlocksOf(one[0], ranks);
  }
}

TEST(RankLabels, EndOnAllRanksWithTheErrorOfOneAndWorkAgain)
{
  const std::vector<Filter> one = Update(1, [](vtkLabelsToSurfaces*) {});
  const Slowness slowness;
  const std::vector<Filter> ranks = OnMap(
    3, [](vtkLabelsToSurfaces*) {},
    [](vtkLabelsToSurfaces* filter, RankController* controller)
    {
      bool isBad = controller->GetLocalProcessId() == 2;
      {
        const ProgressHook hook(filter,
          [&isBad](vtkAlgorithm*, const std::string& text, double)
          {
            if (std::exchange(isBad, isBad && text.find(Making) == std::string::npos) && !isBad)
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
      EXPECT_TRUE(errors.Has("'Labels' has no label 99; it has 0, 1, 2")) << errors.Get();
      EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::UserError);
      filter->ClearLabels();
      UpdatePiece(filter, controller);
    });
  ExpectBlocksOf(one[0], ranks);
}
