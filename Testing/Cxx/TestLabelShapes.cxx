// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// What vtkLabelsToSurfaces promises, on shapes that are known by formula, by the judge that shares
// no code with it.
#include "JudgedLabels.h"

#include <vtkCellData.h>

#include <ostream>

using namespace volumic::support;

namespace
{
/** How well shapes are found; lengths in smallest distances of voxels. */
struct Promise
{
  LabelShapeKind Kind;
  int Size;
  double Stretch;
  double Smoothing;
  double Distance;    ///< mean, of vertices and centroids
  double Angle;       ///< mean, of normals, degrees
  double VolumeError; ///< as a share
  double Wrong;       ///< voxels, as a share of the label's
};

void PrintTo(const Promise& promise, std::ostream* stream)
{
  *stream << LabelShapeName(promise.Kind) << promise.Size << "x" << promise.Stretch;
}

class LabelPromises : public testing::TestWithParam<Promise>
{
};
} // namespace

//------------------------------------------------------------------------------
TEST_P(LabelPromises, AreKept)
{
  const Promise& promise = GetParam();
  const DigitisedShapes shapes = Digitise(promise.Kind, promise.Size, promise.Stretch);
  const Filter filter = FilterOf(ToImage(shapes.Map));
  filter->SetSmoothing(promise.Smoothing);
  for (std::size_t s = 0; s < shapes.Shapes.size(); ++s)
  {
    const LabelShape& shape = shapes.Shapes[s];
    SCOPED_TRACE("label " + std::to_string(shape.Label));
    vtkPolyData* block = BlockOf(filter, static_cast<unsigned int>(s));
    ASSERT_EQ(FieldOf(block, "Label"), shape.Label);
    ExpectGoodTriangles(block, promise.Stretch > 1.0 ? 0.77 : 0.8);
    const TriangleSurface surface = ToTriangleSurface(block);
    const WrongVoxelVerdict voxels = JudgeVoxels(surface, shapes.Map, shape.Label);
    EXPECT_EQ(FieldOf(block, "LabelVoxels"), voxels.Label);
    EXPECT_EQ(FieldOf(block, "WrongVoxels"), voxels.Wrong()) << "judge and filter differ";
    EXPECT_LE(voxels.Wrong(), promise.Wrong * voxels.Label)
      << voxels.Outside << " outside, " << voxels.Inside << " inside";
    if (shape.Distance)
    {
      const TruthVerdict truth = JudgeTruth(surface, shape);
      EXPECT_LT(truth.MeanAtVertices, promise.Distance);
      EXPECT_LT(truth.MeanAtCentroids, promise.Distance);
      EXPECT_LT(truth.MeanAngle, promise.Angle);
      EXPECT_NEAR(truth.VolumeError, 0.0, promise.VolumeError);
    }
  }
}

// The targets are .1, 3 degrees, .002 and 0; where a bound is more, it is what is reached.
INSTANTIATE_TEST_SUITE_P(Of, LabelPromises,
  testing::Values(Promise{ LabelShapeKind::Sphere, 64, 1.0, 2.0, 0.1, 3.0, 0.002, 1e-4 },
    Promise{ LabelShapeKind::Torus, 64, 1.0, 2.0, 0.1, 3.1, 0.002, 3e-4 },
    Promise{ LabelShapeKind::Torus, 112, 1.0, 2.0, 0.1, 3.0, 0.002, 1e-4 },
    Promise{ LabelShapeKind::Gyroid, 64, 1.0, 2.0, 0.1, 4.8, 0.002, 1e-3 },
    Promise{ LabelShapeKind::TouchingBalls, 64, 1.0, 2.0, 0.1, 3.0, 0.005, 3e-4 },
    Promise{ LabelShapeKind::CutBall, 64, 1.0, 2.0, 0.1, 3.5, 0.015, 3e-3 },
    Promise{ LabelShapeKind::Sphere, 64, 3.0, 2.0, 0.1, 3.0, 0.012, 6e-4 },
    Promise{ LabelShapeKind::Torus, 64, 3.0, 2.0, 0.11, 4.5, 0.02, 1e-3 }),
  [](const testing::TestParamInfo<Promise>& info)
  {
    return LabelShapeName(info.param.Kind) + std::to_string(info.param.Size) +
      (info.param.Stretch > 1.0 ? "Stretched" : "");
  });

//------------------------------------------------------------------------------
TEST(LabelGeometry, DoesNotMatter)
{
  const DigitisedShapes shapes = Digitise(LabelShapeKind::Torus, 48);
  const vtkSmartPointer<vtkImageData> plain = ToImage(shapes.Map);
  const Filter first = FilterOf(plain);
  const TriangleSurface expected = ToTriangleSurface(BlockOf(first), plain);

  const vtkSmartPointer<vtkImageData> turned = ToImage(shapes.Map);
  turned->SetSpacing(0.01, 0.01, 0.01);
  turned->SetOrigin(12.0, -7.0, 30.0);
  turned->SetDirectionMatrix(0, -1, 0, 0.6, 0, 0.8, -0.8, 0, 0.6);
  const Filter second = FilterOf(turned);
  const TriangleSurface found = ToTriangleSurface(BlockOf(second), turned);

  ASSERT_EQ(found.Points.size(), expected.Points.size());
  EXPECT_EQ(found.Triangles, expected.Triangles);
  double largest = 0.0;
  for (std::size_t p = 0; p < found.Points.size(); ++p)
  {
    for (int a = 0; a < 3; ++a)
    {
      largest = std::max(largest, std::abs(found.Points[p][a] - expected.Points[p][a]));
    }
  }
  EXPECT_LT(largest, 1e-3); // points are float, and 3000 voxels from the origin
  EXPECT_EQ(FieldOf(BlockOf(second), "WrongVoxels"), FieldOf(BlockOf(first), "WrongVoxels"));
}

TEST(LabelGeometry, MirroredImagesHaveOutwardSurfaces)
{
  const DigitisedShapes shapes = Digitise(LabelShapeKind::Torus, 48);
  const vtkSmartPointer<vtkImageData> mirrored = ToImage(shapes.Map);
  mirrored->SetDirectionMatrix(-1, 0, 0, 0, 1, 0, 0, 0, 1);
  ExpectGoodTriangles(BlockOf(FilterOf(mirrored)));
}

TEST(LabelGeometry, LabelsMayTouchTheBorder)
{
  // The lower half of a ball: the border cuts it.
  DigitisedShapes shapes = Digitise(LabelShapeKind::Sphere, 48);
  LabelMap& map = shapes.Map;
  map.Size[2] = 24;
  map.Values.resize(48 * 48 * 24);
  const Filter filter = FilterOf(ToImage(map));
  vtkPolyData* block = BlockOf(filter);
  ExpectGoodTriangles(block);
  const TriangleSurface surface = ToTriangleSurface(block);
  const WrongVoxelVerdict voxels = JudgeVoxels(surface, map, 1);
  EXPECT_EQ(FieldOf(block, "WrongVoxels"), voxels.Wrong());
  EXPECT_LE(voxels.Wrong(), 0.005 * voxels.Label);
  EXPECT_NEAR(JudgeTopology(surface).Volume / static_cast<double>(voxels.Label), 1.0, 0.02);
}

//------------------------------------------------------------------------------
TEST(LabelInputs, TypesAndValuesDoNotMatter)
{
  const DigitisedShapes shapes = Digitise(LabelShapeKind::TouchingBalls, 40);
  const vtkSmartPointer<vtkImageData> plain = ToImage(shapes.Map);
  const TriangleSurface expected = ToTriangleSurface(BlockOf(FilterOf(plain)));
  ASSERT_GT(expected.Triangles.size(), 100u);
  for (const int type : { VTK_UNSIGNED_CHAR, VTK_INT, VTK_LONG_LONG, VTK_FLOAT, VTK_DOUBLE })
  {
    vtkNew<vtkImageData> image;
    image->SetDimensions(plain->GetDimensions());
    const auto values = vtk::TakeSmartPointer(vtkDataArray::CreateDataArray(type));
    values->DeepCopy(plain->GetPointData()->GetScalars());
    image->GetPointData()->SetScalars(values);
    const TriangleSurface found = ToTriangleSurface(BlockOf(FilterOf(image)));
    EXPECT_EQ(found.Points, expected.Points) << values->GetDataTypeAsString();
    EXPECT_EQ(found.Triangles, expected.Triangles) << values->GetDataTypeAsString();
  }
}

TEST(LabelInputs, LabelsMayBeNegative)
{
  DigitisedShapes shapes = Digitise(LabelShapeKind::TouchingBalls, 40);
  const TriangleSurface expected = ToTriangleSurface(BlockOf(FilterOf(ToImage(shapes.Map)), 1));
  for (std::int16_t& value : shapes.Map.Values)
  {
    value = static_cast<std::int16_t>(value == 2 ? -700 : value);
  }
  const Filter filter = FilterOf(ToImage(shapes.Map));
  vtkPolyData* block = BlockOf(filter, 0); // in the order of their values
  EXPECT_EQ(FieldOf(block, "Label"), -700.0);
  EXPECT_EQ(ToTriangleSurface(block).Points, expected.Points);
}

TEST(LabelInputs, CellsAreVoxels)
{
  const DigitisedShapes shapes = Digitise(LabelShapeKind::Sphere, 40);
  const vtkSmartPointer<vtkImageData> points = ToImage(shapes.Map);
  const TriangleSurface expected = ToTriangleSurface(BlockOf(FilterOf(points)));
  vtkNew<vtkImageData> cells;
  cells->SetDimensions(41, 41, 41);
  cells->SetOrigin(-0.5, -0.5, -0.5);
  cells->GetCellData()->SetScalars(points->GetPointData()->GetScalars());
  const Filter filter = FilterOf(cells);
  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "Labels");
  const TriangleSurface found = ToTriangleSurface(BlockOf(filter));
  EXPECT_EQ(found.Points, expected.Points);
  EXPECT_EQ(found.Triangles, expected.Triangles);
}

//------------------------------------------------------------------------------
TEST(LabelsThatAreThin, AreThereWithFinerTriangles)
{
  const DigitisedShapes shapes = Digitise(LabelShapeKind::ThinShell, 48);
  const Filter filter = FilterOf(ToImage(shapes.Map));
  filter->SetFinestLevel(-1);
  vtkPolyData* block = BlockOf(filter);
  ExpectGoodTriangles(block);
  const WrongVoxelVerdict voxels = JudgeVoxels(ToTriangleSurface(block), shapes.Map, 1);
  EXPECT_LE(voxels.Wrong(), 2e-3 * voxels.Label);
  EXPECT_EQ(JudgeTopology(ToTriangleSurface(block)).Components.size(), 2u); // both sides
}

TEST(LabelsThatAreThin, OneVoxelIsTold)
{
  LabelMap map = Digitise(LabelShapeKind::Sphere, 40).Map;
  map.Values[40 * 40 * 3 + 40 * 3 + 3] = 2;
  const Filter filter = FilterOf(ToImage(map));
  vtkPolyData* block = BlockOf(filter, 1);
  EXPECT_EQ(FieldOf(block, "Label"), 2.0);
  EXPECT_EQ(FieldOf(block, "LabelVoxels"), 1.0);
  const WrongVoxelVerdict voxels = JudgeVoxels(ToTriangleSurface(block), map, 2);
  EXPECT_EQ(FieldOf(block, "WrongVoxels"), voxels.Wrong());
  ExpectGoodTriangles(BlockOf(filter, 0)); // nothing happens to the others
}
