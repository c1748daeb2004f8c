// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSameOutputs_h
#define volumicSameOutputs_h

#include "SurfaceTestTools.h"

#include <vtkAbstractArray.h>
#include <vtkCellData.h>
#include <vtkCompositeDataSet.h>
#include <vtkInformation.h>
#include <vtkTable.h>
#include <vtkVariant.h>

/** Tests that compare runs of vtkDeformableSurface to the bit. */
namespace volumic
{
inline void ExpectSameArrays(vtkFieldData* a, vtkFieldData* b)
{
  ASSERT_EQ(a->GetNumberOfArrays(), b->GetNumberOfArrays());
  for (int i = 0; i < a->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* one = a->GetAbstractArray(i);
    vtkAbstractArray* other = b->GetAbstractArray(one->GetName());
    ASSERT_TRUE(other) << one->GetName();
    ASSERT_EQ(one->GetNumberOfValues(), other->GetNumberOfValues()) << one->GetName();
    for (vtkIdType v = 0; v < one->GetNumberOfValues(); ++v)
    {
      ASSERT_EQ(one->GetVariantValue(v), other->GetVariantValue(v)) << one->GetName() << ' ' << v;
    }
  }
}

inline void ExpectSameSurfaces(vtkPolyData* a, vtkPolyData* b)
{
  ASSERT_EQ(a != nullptr, b != nullptr);
  if (a)
  {
    ASSERT_TRUE(AreSameSurfaces(a, b));
    ExpectSameArrays(a->GetPointData(), b->GetPointData());
    ExpectSameArrays(a->GetCellData(), b->GetCellData());
    ExpectSameArrays(a->GetFieldData(), b->GetFieldData());
  }
}

inline void ExpectSameBlocks(vtkMultiBlockDataSet* a, vtkMultiBlockDataSet* b)
{
  ASSERT_EQ(a->GetNumberOfBlocks(), b->GetNumberOfBlocks());
  for (unsigned int block = 0; block < a->GetNumberOfBlocks(); ++block)
  {
    SCOPED_TRACE(block);
    EXPECT_STREQ(a->GetMetaData(block)->Get(vtkCompositeDataSet::NAME()),
      b->GetMetaData(block)->Get(vtkCompositeDataSet::NAME()));
    ExpectSameSurfaces(
      vtkPolyData::SafeDownCast(a->GetBlock(block)), vtkPolyData::SafeDownCast(b->GetBlock(block)));
  }
}

/** All outputs, but for the seconds. */
inline void ExpectSameOutputs(vtkDeformableSurface* a, vtkDeformableSurface* b)
{
  ExpectSameSurfaces(a->GetOutput(), b->GetOutput());
  ExpectSameBlocks(a->GetLevels(), b->GetLevels());
  ExpectSameBlocks(a->GetSnapshots(), b->GetSnapshots());
  vtkTable* one = a->GetHistory();
  vtkTable* other = b->GetHistory();
  ASSERT_EQ(one->GetNumberOfRows(), other->GetNumberOfRows());
  ASSERT_EQ(one->GetNumberOfColumns(), other->GetNumberOfColumns());
  for (vtkIdType c = 0; c < one->GetNumberOfColumns(); ++c)
  {
    const std::string name = one->GetColumnName(c);
    for (vtkIdType r = 0; r < one->GetNumberOfRows(); ++r)
    {
      if (name.find("Seconds") == std::string::npos)
      {
        ASSERT_EQ(one->GetValue(r, c), other->GetValue(r, c)) << name << ' ' << r;
      }
    }
  }
}
}

#endif
