// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRankTestTools_h
#define volumicRankTestTools_h

#include "PieceSource.h"
#include "SameOutputs.h"
#include "TestPrelude.h"

#include <vtkAlgorithm.h>
#include <vtkCommunicator.h>
#include <vtkDataArray.h>
#include <vtkDummyController.h>
#include <vtkMultiProcessController.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkSmartPointer.h>

#include <condition_variable>
#include <cstring>
#include <deque>
#include <mutex>
#include <thread>

/** Tests of filters that several ranks update at once: threads of the test, with controllers of
 * VTK. */
namespace volumic
{
using RankController = vtkMultiProcessController;

/** Of a rank that is a thread; sends to the others by queues in memory. */
class ThreadCommunicator : public vtkCommunicator
{
public:
  struct Queues
  {
    std::mutex Lock;
    std::condition_variable Arrived;
    std::map<std::pair<int, int>, std::deque<std::vector<char>>> Sent; ///< from, to
  };

  static ThreadCommunicator* New() { VTK_STANDARD_NEW_BODY(ThreadCommunicator); }
  void Begin(const std::shared_ptr<Queues>& queues, int rank, int count)
  {
    this->All = queues;
    this->SetNumberOfProcesses(count);
    this->LocalProcessId = rank;
  }

  int SendVoidArray(const void* values, vtkIdType count, int type, int to, int) override
  {
    const char* bytes = static_cast<const char*>(values);
    const std::lock_guard<std::mutex> lock(this->All->Lock);
    this->All->Sent[{ this->LocalProcessId, to }].emplace_back(
      bytes, bytes + count * vtkDataArray::GetDataTypeSize(type));
    this->All->Arrived.notify_all();
    return 1;
  }
  int ReceiveVoidArray(void* values, vtkIdType count, int type, int from, int) override
  {
    std::unique_lock<std::mutex> lock(this->All->Lock);
    auto& queue = this->All->Sent[{ from, this->LocalProcessId }];
    this->All->Arrived.wait(lock, [&queue] { return !queue.empty(); });
    const std::vector<char> message = std::move(queue.front());
    queue.pop_front();
    EXPECT_EQ(
      message.size(), static_cast<std::size_t>(count * vtkDataArray::GetDataTypeSize(type)));
    std::memcpy(values, message.data(), message.size());
    return 1;
  }

private:
  std::shared_ptr<Queues> All;
};

/** Calls work on each of so many threads; it must not throw. Each makes filters of its own. */
inline void RunRanks(int count, const std::function<void(RankController*)>& work)
{
  vtkObjectFactory::GetRegisteredFactories(); // Made once, not by many at a time.
  const auto queues = std::make_shared<ThreadCommunicator::Queues>();
  std::vector<std::thread> threads;
  for (int rank = 0; rank < count; ++rank)
  {
    threads.emplace_back(
      [&, rank]
      {
        vtkNew<ThreadCommunicator> communicator;
        communicator->Begin(queues, rank, count);
        vtkNew<vtkDummyController> controller;
        controller->SetCommunicator(communicator);
        controller->SetRMICommunicator(communicator);
        work(controller);
      });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
}

/** As ParaView's processes do it: each asks for its piece. */
inline void UpdatePiece(vtkAlgorithm* filter, RankController* ranks, int ghostLevels = 0)
{
  filter->UpdatePiece(ranks->GetLocalProcessId(), ranks->GetNumberOfProcesses(), ghostLevels);
}

/**
 * Has each rank make a filter of its own, of a source that gives it a piece of an image, and do
 * something with it. @return the filters, when all are through
 */
template <typename Filter>
std::vector<vtkSmartPointer<Filter>> OnRanks(int count,
  const std::function<vtkSmartPointer<vtkImageData>()>& image,
  const std::function<void(Filter*, RankController*)>& work)
{
  std::vector<vtkSmartPointer<Filter>> filters(static_cast<std::size_t>(count));
  RunRanks(count,
    [&](RankController* ranks)
    {
      vtkNew<PieceSource> source;
      source->Whole = image();
      const auto filter = vtkSmartPointer<Filter>::New();
      filter->SetController(ranks);
      filter->SetInputConnection(source->GetOutputPort());
      filter->SetNumberOfThreads(1);
      work(filter, ranks);
      filter->SetController(nullptr);
      filters[static_cast<std::size_t>(ranks->GetLocalProcessId())] = filter;
    });
  return filters;
}

inline vtkIdType IdOf(vtkPolyData* piece, vtkIdType point)
{
  return static_cast<vtkIdType>(piece->GetPointData()->GetGlobalIds()->GetTuple1(point));
}

inline std::vector<vtkIdType> CornersOf(vtkPolyData* surface, vtkIdType triangle)
{
  vtkNew<vtkIdList> corners;
  surface->GetCellPoints(triangle, corners);
  return { corners->begin(), corners->end() };
}

inline bool IsGhost(vtkDataSetAttributes* attributes, vtkIdType tuple)
{
  vtkDataArray* types = attributes->GetArray(vtkDataSetAttributes::GhostArrayName());
  return types && types->GetTuple1(tuple) != 0.0;
}

/** Values of all arrays of a tuple, but for what only pieces have. */
inline std::vector<double> ValuesOf(vtkDataSetAttributes* attributes, vtkIdType tuple)
{
  std::vector<double> values;
  for (int i = 0; i < attributes->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* array = attributes->GetArray(i);
    const std::string name = array->GetName();
    for (int c = 0;
         name != "GlobalIds" && name != "vtkGhostType" && c < array->GetNumberOfComponents(); ++c)
    {
      values.push_back(array->GetComponent(tuple, c));
    }
  }
  return values;
}

/** Each triangle of the whole is one of one piece, and all is as it is there, bit by bit. */
inline void ExpectPiecesOf(vtkPolyData* whole, const std::vector<vtkPolyData*>& pieces)
{
  std::map<std::vector<vtkIdType>, vtkIdType> triangles;
  for (vtkIdType t = 0; t < whole->GetNumberOfCells(); ++t)
  {
    triangles[CornersOf(whole, t)] = t;
  }
  std::set<vtkIdType> found;
  for (vtkPolyData* piece : pieces)
  {
    ASSERT_TRUE(piece->GetPointData()->GetGlobalIds());
    ExpectSameArrays(whole->GetFieldData(), piece->GetFieldData());
    EXPECT_EQ(piece->GetPointData()->GetNormals() != nullptr,
      whole->GetPointData()->GetNormals() != nullptr);
    std::set<vtkIdType> own;
    for (vtkIdType t = 0; t < piece->GetNumberOfCells(); ++t)
    {
      std::vector<vtkIdType> ids;
      for (const vtkIdType corner : CornersOf(piece, t))
      {
        ids.push_back(IdOf(piece, corner));
      }
      ASSERT_EQ(triangles.count(ids), 1u);
      const vtkIdType triangle = triangles[ids];
      ASSERT_EQ(ValuesOf(piece->GetCellData(), t), ValuesOf(whole->GetCellData(), triangle));
      if (!IsGhost(piece->GetCellData(), t))
      {
        EXPECT_EQ(triangle, static_cast<vtkIdType>(found.size())) << "they follow each other";
        found.insert(triangle);
        own.insert(ids.begin(), ids.end());
      }
    }
    for (vtkIdType p = 0; p < piece->GetNumberOfPoints(); ++p)
    {
      const vtkIdType id = IdOf(piece, p);
      std::array<double, 3> here;
      std::array<double, 3> there;
      piece->GetPoint(p, here.data());
      whole->GetPoint(id, there.data());
      ASSERT_EQ(here, there) << id;
      ASSERT_EQ(ValuesOf(piece->GetPointData(), p), ValuesOf(whole->GetPointData(), id));
      ASSERT_EQ(IsGhost(piece->GetPointData(), p), own.count(id) == 0) << id;
    }
  }
  EXPECT_EQ(found.size(), triangles.size());
}

/** The same of all blocks of surfaces. */
inline void ExpectBlocksOf(
  vtkMultiBlockDataSet* whole, const std::vector<vtkMultiBlockDataSet*>& ranks)
{
  ASSERT_GT(whole->GetNumberOfBlocks(), 0u);
  for (unsigned int block = 0; block < whole->GetNumberOfBlocks(); ++block)
  {
    std::vector<vtkPolyData*> pieces;
    for (vtkMultiBlockDataSet* of : ranks)
    {
      ASSERT_EQ(of->GetNumberOfBlocks(), whole->GetNumberOfBlocks());
      EXPECT_STREQ(of->GetMetaData(block)->Get(vtkCompositeDataSet::NAME()),
        whole->GetMetaData(block)->Get(vtkCompositeDataSet::NAME()));
      pieces.push_back(vtkPolyData::SafeDownCast(of->GetBlock(block)));
      ASSERT_EQ(pieces.back() != nullptr, whole->GetBlock(block) != nullptr);
    }
    if (whole->GetBlock(block))
    {
      ExpectPiecesOf(vtkPolyData::SafeDownCast(whole->GetBlock(block)), pieces);
    }
  }
}
}

#endif
