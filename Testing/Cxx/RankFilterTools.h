// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRankFilterTools_h
#define volumicRankFilterTools_h

#include "PieceSource.h"
#include "SameOutputs.h"
#include "ThreadControllers.h"

#include <functional>
#include <map>
#include <set>
#include <vector>

/** Tests of filters that several ranks update at once. */
namespace volumic
{
/**
 * Has each rank make a filter of its own, of a source that gives it a piece of an image, and do
 * something with it. @return the filters, when all are through
 */
template <typename Filter>
std::vector<vtkSmartPointer<Filter>> OnRanks(int count,
  const std::function<vtkSmartPointer<vtkImageData>()>& image,
  const std::function<void(Filter*, vtkMultiProcessController*)>& work)
{
  std::vector<vtkSmartPointer<Filter>> filters(static_cast<std::size_t>(count));
  ThreadControllers::Run(count,
    [&](vtkMultiProcessController* controller)
    {
      vtkNew<PieceSource> source;
      source->Whole = image();
      const auto filter = vtkSmartPointer<Filter>::New();
      filter->SetController(controller);
      filter->SetInputConnection(source->GetOutputPort());
      filter->SetNumberOfThreads(1);
      work(filter, controller);
      filter->SetController(nullptr);
      filters[static_cast<std::size_t>(controller->GetLocalProcessId())] = filter;
    });
  return filters;
}

inline vtkIdType IdOf(vtkPolyData* piece, vtkIdType point)
{
  return static_cast<vtkIdType>(piece->GetPointData()->GetGlobalIds()->GetTuple1(point));
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
    vtkNew<vtkIdList> corners;
    whole->GetCellPoints(t, corners);
    triangles[{ corners->begin(), corners->end() }] = t;
  }
  std::set<vtkIdType> found;
  for (vtkPolyData* piece : pieces)
  {
    ASSERT_TRUE(piece->GetPointData()->GetGlobalIds());
    ExpectSameArrays(whole->GetFieldData(), piece->GetFieldData());
    EXPECT_EQ(piece->GetPointData()->GetNormals() != nullptr,
      whole->GetPointData()->GetNormals() != nullptr);
    for (vtkIdType p = 0; p < piece->GetNumberOfPoints(); ++p)
    {
      const vtkIdType id = IdOf(piece, p);
      double own[3];
      double of[3];
      piece->GetPoint(p, own);
      whole->GetPoint(id, of);
      ASSERT_TRUE(std::equal(own, own + 3, of)) << id;
      ASSERT_EQ(ValuesOf(piece->GetPointData(), p), ValuesOf(whole->GetPointData(), id));
    }
    for (vtkIdType t = 0; t < piece->GetNumberOfCells(); ++t)
    {
      vtkNew<vtkIdList> corners;
      piece->GetCellPoints(t, corners);
      std::vector<vtkIdType> ids;
      for (const vtkIdType corner : *corners)
      {
        ids.push_back(IdOf(piece, corner));
      }
      ASSERT_EQ(triangles.count(ids), 1u);
      const vtkIdType triangle = triangles[ids];
      ASSERT_EQ(ValuesOf(piece->GetCellData(), t), ValuesOf(whole->GetCellData(), triangle));
      EXPECT_TRUE(IsGhost(piece->GetCellData(), t) || found.insert(triangle).second);
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
