// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicJudgedLabels_h
#define volumicJudgedLabels_h

#include "LabelJudge.h"
#include "SupportVtkConversions.h"
#include "TestPrelude.h"
#include "vtkLabelsToSurfaces.h"

#include <vtkMultiBlockDataSet.h>

/** What tests share that have surfaces of labels judged. */
namespace volumic::support
{
using Filter = vtkSmartPointer<vtkLabelsToSurfaces>;

inline Filter FilterOf(vtkDataObject* image)
{
  auto filter = Filter::New();
  filter->SetInputDataObject(image);
  return filter;
}

inline vtkPolyData* BlockOf(vtkLabelsToSurfaces* filter, unsigned int block = 0)
{
  filter->Update();
  auto* blocks = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  return vtkPolyData::SafeDownCast(blocks->GetBlock(block));
}

inline double FieldOf(vtkPolyData* surface, const char* name)
{
  return surface->GetFieldData()->GetArray(name)->GetComponent(0, 0);
}

/** Q1 to Q3 in world units; of Q3's .97 for the mean radius ratio .95 is asked for here. */
inline void ExpectGoodTriangles(vtkPolyData* block, double quantile01 = 0.8)
{
  const SurfaceVerdict verdict = JudgeSurface(ToTriangleSurface(block), FieldOf(block, "Delta"));
  EXPECT_TRUE(verdict.Topology.Closed);
  EXPECT_TRUE(verdict.Topology.Manifold);
  EXPECT_TRUE(verdict.Topology.Outward);
  EXPECT_EQ(verdict.Topology.UnusedPoints, 0u);
  EXPECT_EQ(verdict.Intersections.Pairs, 0u);
  EXPECT_EQ(verdict.Intersections.FlatTriangles, 0u);
  EXPECT_EQ(verdict.Lengths.ShareOutside, 0.0) << Describe(verdict);
  EXPECT_GT(verdict.Shapes.Least, 0.5) << Describe(verdict);
  EXPECT_GT(verdict.Shapes.Quantile01, quantile01) << Describe(verdict);
  EXPECT_GT(verdict.Shapes.Mean, 0.95) << Describe(verdict);
}
} // namespace volumic::support

#endif
