// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRankOutputTestTools_h
#define volumicRankOutputTestTools_h

#include "SameOutputs.h"
#include "ThreadControllers.h"
#include "vtkVolumeToSurface.h"

#include <vtkTriangle.h>
#include <vtkUnsignedCharArray.h>

/** Tests of filters that several ranks update at once. */
namespace volumic
{
using Filter = vtkSmartPointer<vtkDeformableSurface>;

/** Voxels along each axis of the least level that is shared. */
constexpr int SharedSize = 162;

/** A ball with a cavity, and a smaller one. */
inline vtkSmartPointer<vtkImageData> TwoBalls()
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(SharedSize, SharedSize, SharedSize);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 1);
  image->GetPointData()->GetScalars()->SetName("Voxels");
  auto* voxels = static_cast<unsigned char*>(image->GetScalarPointer());
  std::fill_n(voxels, static_cast<std::size_t>(SharedSize) * SharedSize * SharedSize, 0);
  const auto ramp = [](double inside) { return std::clamp(0.5 + 0.4 * inside, 0.0, 1.0); };
  for (int k = 40; k < 130; ++k)
  {
    for (int j = 40; j < 130; ++j)
    {
      for (int i = 40; i < 130; ++i)
      {
        const double large = std::hypot(i - 70, j - 70, k - 70);
        const double small = std::hypot(i - 108, j - 106, k - 104);
        const double value = std::max(std::min(ramp(20 - large), ramp(large - 9)), ramp(10 - small));
        voxels[(static_cast<std::size_t>(k) * SharedSize + j) * SharedSize + i] =
          static_cast<unsigned char>(std::lround(100.0 * value));
      }
    }
  }
  return image;
}

/** The filters of all ranks, when they are through. */
using Ranks = std::vector<Filter>;

/** What a rank does with its filter. */
using RankWork = std::function<void(vtkDeformableSurface*, vtkMultiProcessController*)>;

/** Has each rank make a filter and do something with it. */
inline Ranks RunRanks(int count,
  const std::function<Filter(vtkMultiProcessController*)>& make, const RankWork& work)
{
  Ranks filters(static_cast<std::size_t>(count));
  ThreadControllers::Run(count,
    [&](vtkMultiProcessController* controller)
    {
      Filter filter = make(controller);
      work(filter, controller);
      filter->SetController(nullptr);
      filters[static_cast<std::size_t>(controller->GetLocalProcessId())] = filter;
    });
  return filters;
}

inline std::vector<vtkPolyData*> SurfacesOf(const Ranks& ranks)
{
  std::vector<vtkPolyData*> surfaces;
  for (const Filter& filter : ranks)
  {
    surfaces.push_back(filter->GetOutput());
  }
  return surfaces;
}

inline vtkIdType IdOf(vtkPolyData* piece, vtkIdType point)
{
  return static_cast<vtkIdType>(piece->GetPointData()->GetGlobalIds()->GetTuple1(point));
}

/** Values of all arrays of a tuple, but for what only pieces have. */
inline std::vector<double> ValuesOf(vtkDataSetAttributes* attributes, vtkIdType tuple)
{
  std::vector<double> values;
  for (int i = 0; i < attributes->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* array = attributes->GetArray(i);
    const std::string name = array->GetName();
    for (int c = 0; name != "GlobalIds" && name != "vtkGhostType" &&
         c < array->GetNumberOfComponents();
         ++c)
    {
      values.push_back(array->GetComponent(tuple, c));
    }
  }
  return values;
}

inline bool IsGhost(vtkDataSetAttributes* attributes, vtkIdType tuple)
{
  auto* types = vtkUnsignedCharArray::SafeDownCast(
    attributes->GetArray(vtkDataSetAttributes::GhostArrayName()));
  return types && types->GetValue(tuple) != 0;
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
    EXPECT_STREQ(piece->GetPointData()->GetGlobalIds()->GetName(), "GlobalIds");
    ASSERT_TRUE(piece->GetPointData()->GetNormals());
    ExpectSameArrays(whole->GetFieldData(), piece->GetFieldData());
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
      if (!IsGhost(piece->GetCellData(), t))
      {
        EXPECT_TRUE(found.insert(triangle).second) << "twice: " << triangle;
      }
    }
  }
  EXPECT_EQ(found.size(), triangles.size());
}

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

inline std::string StopReasonOf(vtkDeformableSurface* filter)
{
  return vtkStringArray::SafeDownCast(
    filter->GetOutput()->GetFieldData()->GetAbstractArray("StopReason"))
    ->GetValue(0);
}
}

#endif
