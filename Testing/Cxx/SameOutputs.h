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

#include <cstring>

/** Bit-identical comparison of outputs of vtkDeformableSurface. */
namespace volumic
{
inline void ExpectSameArrays(vtkFieldData* a, vtkFieldData* b)
{
  ASSERT_EQ(a->GetNumberOfArrays(), b->GetNumberOfArrays());
  for (int i = 0; i < a->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* one = a->GetAbstractArray(i);
    const char* name = one->GetName();
    SCOPED_TRACE(name ? name : "unnamed");
    vtkAbstractArray* other = name ? b->GetAbstractArray(name) : b->GetAbstractArray(i);
    ASSERT_TRUE(other);
    ASSERT_EQ(one->GetDataType(), other->GetDataType());
    ASSERT_EQ(one->GetNumberOfComponents(), other->GetNumberOfComponents());
    const vtkIdType n = one->GetNumberOfValues();
    ASSERT_EQ(n, other->GetNumberOfValues());
    if (vtkDataArray::SafeDownCast(one))
    {
      const auto bytes = static_cast<std::size_t>(n * one->GetDataTypeSize());
      ASSERT_TRUE(bytes == 0 || // the pointer may be null
        std::memcmp(one->GetVoidPointer(0), other->GetVoidPointer(0), bytes) == 0);
      continue;
    }
    for (vtkIdType v = 0; v < n; ++v)
    {
      ASSERT_EQ(one->GetVariantValue(v), other->GetVariantValue(v)) << v;
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

/** Expect identical outputs, except for the column Seconds. */
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
      if (name != "Seconds")
      {
        ASSERT_EQ(one->GetValue(r, c), other->GetValue(r, c)) << name << ' ' << r;
      }
    }
  }
}
}

#endif
