// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicJudgedLabels_h
#define volumicJudgedLabels_h

#include "LabelJudge.h"
#include "SupportVtkConversions.h"
#include "TestPrelude.h"
#include "vtkLabelsToSurfaces.h"

#include <vtkMultiBlockDataSet.h>

/** Tools for tests that judge label surfaces. */
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

/** Closed, manifold, free of intersections, with well-shaped triangles (mean radius ratio). */
inline void ExpectGoodTriangles(vtkPolyData* block, double meanShape = 0.9)
{
  const SurfaceVerdict verdict = JudgeSurface(ToTriangleSurface(block), FieldOf(block, "Delta"));
  EXPECT_TRUE(verdict.IsSound()) << Describe(verdict);
  EXPECT_GT(verdict.Shapes.Mean, meanShape) << Describe(verdict);
}
} // namespace volumic::support

#endif
