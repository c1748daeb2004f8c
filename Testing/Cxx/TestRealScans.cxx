// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Surfaces of real scans at all levels. Quality bounds are measured values with a small margin.
#include "SupportVtkConversions.h"
#include "SurfaceTestTools.h"

#include <vtkXMLImageDataReader.h>

#include <cstdlib>
#include <fstream>

using namespace volumic;
using namespace volumic::support;

namespace
{
struct Scan
{
  const char* Name;
  std::string File;
  double IsoValue;
  double MinimumReach;       ///< ReachedShare()
  double MaximumDistance;    ///< mean distance of vertices to the isosurface, voxels
  double MinimumRatio = 0.7; ///< radius ratio of all triangles
  double Tolerance = 0.0;    ///< of graded surfaces, world units
};

const std::string Shared = VOLUMIC_SHARED_DATA;

vtkSmartPointer<vtkImageData> Read(const std::string& file)
{
  vtkNew<vtkXMLImageDataReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  return reader->GetOutput();
}

class RealScans : public ::testing::TestWithParam<Scan>
{
  /** Skip the test without the scan; fail in continuous integration. */
  void SetUp() override
  {
    const std::string& file = GetParam().File;
    if (!std::ifstream(file))
    {
      ASSERT_FALSE(std::getenv("CI")) << file << " is missing";
      GTEST_SKIP() << file << " is missing";
    }
  }
};
}

TEST_P(RealScans, GiveValidSurfacesAtAllLevels)
{
  const Scan& scan = GetParam();
  const vtkSmartPointer<vtkImageData> image = Read(scan.File);
  vtkNew<vtkDeformableSurface> filter;
  filter->SetInputData(image);
  filter->SetIsoValue(scan.IsoValue);
  filter->SetTolerance(scan.Tolerance);
  EXPECT_FALSE(Has(MessagesOfUpdate(filter, vtkCommand::WarningEvent), "error of Volumic"));

  const unsigned int levels = filter->GetLevels()->GetNumberOfBlocks();
  ASSERT_GT(levels, 1u);
  for (unsigned int h = 0; h < levels; ++h)
  {
    SCOPED_TRACE("level " + std::to_string(h));
    vtkPolyData* surface = SurfaceAt(filter, h);
    ASSERT_TRUE(surface);
    if (surface->GetNumberOfPoints() == 0)
    {
      // The object is too thin for the coarsest level.
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
    EXPECT_EQ(lengths.EdgesTooShort, 0u);
    const ShapeVerdict shapes = JudgeShapes(inWorld);
    EXPECT_GT(shapes.Mean, 0.95);
    EXPECT_GT(shapes.Quantile01, 0.8);
    EXPECT_GT(shapes.Least, scan.MinimumRatio);
  }

  vtkPolyData* finest = filter->GetOutput();
  EXPECT_EQ(FieldOf(finest, "Level"), 0);
  EXPECT_EQ(StopReason(finest), "converged");
  // At the border of the image the surface is a fraction of a voxel outside.
  const auto padded = Padded(image);
  const JudgedVolume volume = ToJudgedVolume(padded, scan.IsoValue);
  const TriangleSurface indexed = ToTriangleSurface(finest, padded);
  EXPECT_GT(ReachedShare(indexed, volume), scan.MinimumReach);
  EXPECT_LT(JudgeIsoDistance(indexed, volume).MeanAtVertices, scan.MaximumDistance);
  filter->SetFinestLevel(1);
  filter->SetKeepComponentsToLargestComponent();
  filter->Update();
  EXPECT_EQ(FieldOf(filter->GetOutput(), "Genus"), FieldOf(filter->GetOutput(), "ComponentGenus"));
}

INSTANTIATE_TEST_SUITE_P(Of, RealScans,
  ::testing::Values(Scan{ "SkullCT", VOLUMIC_SKULL, 226.5, 0.996, 0.0095 },
    Scan{ "HeadCT", Shared + "/headsq_quarter_u16.vti", 1150.5, 0.989, 0.021 },
    Scan{ "Tooth", Shared + "/tooth_ct_u16.vti", 600.5, 0.999, 0.0015 },
    Scan{ "GradedTooth", Shared + "/tooth_ct_u16.vti", 600.5, 0.995, 0.0015, 0.7, 0.2 },
    Scan{ "Engine", Shared + "/engine_ct_u8.vti", 75.5, 0.999, 0.021 },
    Scan{ "GradedEngine", Shared + "/engine_ct_u8.vti", 75.0, 0.95, 0.021, 0.7, 0.2 },
    Scan{ "VisibleMaleHead", Shared + "/vismale_head_ct_u8.vti", 95.5, 0.993, 0.008, 0.6 },
    Scan{ "SmallHeadMR", Shared + "/head_mr_small_u8.vti", 30.5, 0.885, 0.06 }),
  [](const ::testing::TestParamInfo<Scan>& instance) { return instance.param.Name; });
