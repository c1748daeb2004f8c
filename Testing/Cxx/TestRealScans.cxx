// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// The surface on real scans, at every level. What must always hold is asserted as it is; qualities
// that are a matter of degree are asserted well below what is reached (Documentation/measured.md),
// so that a failure means that something broke.
#include "SupportVtkConversions.h"
#include "TestPrelude.h"
#include "vtkDeformableSurface.h"

#include <vtkImageCast.h>
#include <vtkImageConstantPad.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkStringArray.h>
#include <vtkXMLImageDataReader.h>

#include <cstdlib>
#include <fstream>

using namespace volumic::support;

namespace
{
struct Scan
{
  const char* Name;
  std::string File;
  double IsoValue;
  double LeastReach;      ///< share of the boundary that air reaches and the surface must reach too
  double LargestDistance; ///< to the isopotential, mean over the vertices, voxels
  double Tolerance = 0.0; ///< of a graded surface, world units
};

const std::string Shared = VOLUMIC_SHARED_DATA;

double FieldOf(vtkPolyData* surface, const char* name)
{
  return surface->GetFieldData()->GetArray(name)->GetComponent(0, 0);
}

std::string StopReason(vtkPolyData* surface)
{
  return vtkStringArray::SafeDownCast(surface->GetFieldData()->GetAbstractArray("StopReason"))
    ->GetValue(0);
}

vtkSmartPointer<vtkImageData> Read(const std::string& file)
{
  vtkNew<vtkXMLImageDataReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  return reader->GetOutput();
}

/** Skip the test where a scan is missing. In continuous integration (.ci/run) that is a failure. */
void Need(const std::string& file)
{
  if (!std::ifstream(file))
  {
    ASSERT_FALSE(std::getenv("CI")) << file << " is missing";
    GTEST_SKIP() << file << " is missing";
  }
}

class RealScans : public ::testing::TestWithParam<Scan>
{
  void SetUp() override { Need(GetParam().File); }
};

class LongBox : public ::testing::Test
{
protected:
  const std::string File = Shared + "/../repro/seed60158.vti";
  void SetUp() override { Need(this->File); }
};
}

TEST_P(RealScans, GiveATrustworthySurfaceAtEveryLevel)
{
  const Scan& scan = GetParam();
  const vtkSmartPointer<vtkImageData> image = Read(scan.File);
  vtkNew<vtkDeformableSurface> filter;
  filter->SetInputData(image);
  filter->SetIsoValue(scan.IsoValue);
  filter->SetTolerance(scan.Tolerance);
  filter->Update();

  vtkMultiBlockDataSet* levels = filter->GetLevels();
  ASSERT_GT(levels->GetNumberOfBlocks(), 1u);
  for (unsigned int h = 0; h < levels->GetNumberOfBlocks(); ++h)
  {
    SCOPED_TRACE("level " + std::to_string(h));
    auto* surface = vtkPolyData::SafeDownCast(levels->GetBlock(h));
    ASSERT_TRUE(surface);
    if (surface->GetNumberOfPoints() == 0)
    {
      // Too thin for the coarsest level; a finer one must have found it.
      EXPECT_GT(h, 0u);
      EXPECT_EQ(StopReason(surface), "vanished");
      continue;
    }
    const TriangleSurface inWorld = ToTriangleSurface(surface);
    const TopologyVerdict topology = JudgeTopology(inWorld);
    EXPECT_TRUE(topology.Closed && topology.Manifold && topology.Oriented);
    EXPECT_EQ(JudgeIntersections(inWorld).Pairs, 0u);
    const LengthVerdict lengths = JudgeLengths(inWorld, DeltasOf(surface));
    EXPECT_EQ(lengths.EdgesTooLong, 0u);
    EXPECT_LE(lengths.EdgesTooShort, 2u);
    const ShapeVerdict shapes = JudgeShapes(inWorld);
    EXPECT_GT(shapes.Mean, 0.94);
    EXPECT_GT(shapes.Quantile01, 0.75);
    EXPECT_GT(shapes.Least, 0.4);
  }

  vtkPolyData* finest = filter->GetOutput();
  EXPECT_EQ(FieldOf(finest, "Level"), 0);
  EXPECT_EQ(StopReason(finest), "converged");
  // Where the object is cut by the border the surface closes it a fraction of a voxel outside.
  vtkNew<vtkImageConstantPad> pad;
  pad->SetInputData(image);
  const int* extent = image->GetExtent();
  pad->SetOutputWholeExtent(
    extent[0] - 1, extent[1] + 1, extent[2] - 1, extent[3] + 1, extent[4] - 1, extent[5] + 1);
  pad->SetConstant(image->GetScalarRange()[0]);
  vtkNew<vtkImageCast> cast;
  cast->SetInputConnection(pad->GetOutputPort());
  cast->SetOutputScalarTypeToFloat();
  cast->Update();
  vtkImageData* padded = cast->GetOutput();
  JudgedVolume volume;
  volume.Values = static_cast<const float*>(padded->GetScalarPointer());
  for (int axis = 0; axis < 3; ++axis)
  {
    volume.Size[axis] = padded->GetDimensions()[axis];
  }
  volume.IsoValue = scan.IsoValue;
  const TriangleSurface indexed = ToTriangleSurface(finest, padded);
  EXPECT_GT(JudgeReach(indexed, volume).Share, scan.LeastReach);
  EXPECT_LT(JudgeIsoDistance(indexed, volume).MeanAtVertices, scan.LargestDistance);
}

INSTANTIATE_TEST_SUITE_P(Of, RealScans,
  ::testing::Values(Scan{ "SkullCT", VOLUMIC_SKULL, 226.5, 0.97, 0.04 },
    Scan{ "HeadCT", Shared + "/headsq_quarter_u16.vti", 1150.5, 0.95, 0.04 },
    Scan{ "Tooth", Shared + "/tooth_ct_u16.vti", 600.5, 0.97, 0.04 },
    Scan{ "GradedTooth", Shared + "/tooth_ct_u16.vti", 600.5, 0.97, 0.04, 0.2 },
    Scan{ "Engine", Shared + "/engine_ct_u8.vti", 75.5, 0.97, 0.04 },
    Scan{ "VisibleMaleHead", Shared + "/vismale_head_ct_u8.vti", 95.5, 0.97, 0.04 },
    Scan{ "SmallHeadMR", Shared + "/head_mr_small_u8.vti", 30.5, 0.80, 0.1 }),
  [](const ::testing::TestParamInfo<Scan>& instance) { return instance.param.Name; });

TEST_F(LongBox, IsFreeOfIntersectionsHoweverManyIterations)
{
  // Blobs with voxels of 1 : 7.4, as a random campaign made them: the icosahedron that was pressed
  // onto their box intersected itself while it shrank, 44 to 396 times.
  const vtkSmartPointer<vtkImageData> image = Read(this->File);
  for (const int iterations : { 1, 7, 70 })
  {
    SCOPED_TRACE(std::to_string(iterations) + " iterations");
    vtkNew<vtkDeformableSurface> filter;
    filter->SetInputData(image);
    filter->SetIsoValue(2001.1629);
    filter->SetFinestLevel(2);
    filter->SetMaximumNumberOfIterations(iterations);
    filter->Update();
    ASSERT_GT(filter->GetOutput()->GetNumberOfPoints(), 0);
    EXPECT_LT(filter->GetOutput()->GetNumberOfPoints(), 10000) << "of 43,000 and more";
    EXPECT_EQ(JudgeIntersections(ToTriangleSurface(filter->GetOutput())).Pairs, 0u);
  }
}
