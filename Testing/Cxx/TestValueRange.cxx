// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Objects with values between IsoValue and UpperValue.
#include "SameOutputs.h"
#include "vtkVolumeToSurface.h"

using namespace volumic;

namespace
{
constexpr double Lower = 100.0;
constexpr double Upper = 400.0;
constexpr double Outer = 11.0;
constexpr double Inner = 6.0;

/** A material of value 150 around another one of value 600, with borders of a voxel. */
vtkSmartPointer<vtkImageData> TwoMaterials(int type = VTK_SHORT)
{
  return ImageOf(
    { 30, 31, 32 },
    [](int i, int j, int k)
    {
      const double r = std::hypot(i - 14.5, j - 15.0, k - 15.5);
      return std::floor(150.0 * std::clamp(Outer - r + 0.5, 0.0, 1.0) +
        450.0 * std::clamp(Inner - r + 0.5, 0.0, 1.0));
    },
    type);
}

/** Fold the image outside the filter. */
vtkSmartPointer<vtkImageData> Folded(vtkImageData* image)
{
  return ImageOf({ 30, 31, 32 },
    [image](int i, int j, int k)
    {
      const double value = image->GetScalarComponentAsDouble(i, j, k, 0);
      return std::min(value, Lower + Upper - value);
    });
}

void SetRange(vtkDeformableSurface* filter)
{
  filter->SetIsoValue(Lower);
  filter->SetUpperValue(Upper);
}

vtkSmartPointer<vtkDeformableSurface> InRange(
  vtkDataObject* image, const Choice& choose = [](vtkDeformableSurface*) {})
{
  return SurfaceOf(image,
    [&](vtkDeformableSurface* filter)
    {
      SetRange(filter);
      choose(filter);
    });
}
}

TEST(ValueRange, SelectsOneOfTwoMaterials)
{
  const auto filter = InRange(TwoMaterials());
  vtkPolyData* surface = filter->GetOutput();
  EXPECT_EQ(StopReason(surface), "converged");
  ASSERT_EQ(FieldOf(surface, "NumberOfComponents"), 2);
  EXPECT_EQ(FieldOf(surface, "Genus"), 0);
  // 100 lies a sixth of a voxel within the outer border, 400 a twentieth within the inner one.
  EXPECT_NEAR(FieldOf(surface, "ComponentVolume", 0) / VolumeOfBall(Outer - 1.0 / 6), 1.0, 0.04);
  EXPECT_NEAR(-FieldOf(surface, "ComponentVolume", 1) / VolumeOfBall(Inner - 0.05), 1.0, 0.06);
  vtkDataArray* residual = surface->GetPointData()->GetArray("Residual");
  EXPECT_LT(std::max(-residual->GetRange()[0], residual->GetRange()[1]), 25.0)
    << "in units of the image";
}

TEST(ValueRange, IsTheIsosurfaceOfTheFoldedImage)
{
  for (const int type : { VTK_SHORT, VTK_UNSIGNED_SHORT, VTK_FLOAT })
  {
    const auto image = TwoMaterials(type);
    const auto byHand = SurfaceOf(Folded(image),
      [](vtkDeformableSurface* filter)
      {
        filter->SetIsoValue(Lower);
        filter->SetRecovery(vtkDeformableSurface::RecoverObjectsAndCavities);
      });
    ExpectSameSurfaces(InRange(image)->GetOutput(), byHand->GetOutput());
  }
}

TEST(ValueRange, IsBitIdenticalForImagesAndPyramids)
{
  const auto image = TwoMaterials(VTK_INT);
  const auto one = InRange(image);
  ASSERT_GT(one->GetOutput()->GetNumberOfPoints(), 500);
  const auto expectSame = [&](vtkDeformableSurface* filter)
  { ExpectSameSurfaces(one->GetOutput(), filter->GetOutput()); };
  expectSame(InRange(image, [](vtkDeformableSurface* f) { f->SetNumberOfThreads(3); }));
  expectSame(InRange(PyramidOf(image)->GetOutput()));
  expectSame(SurfaceOf<vtkVolumeToSurface>(image, SetRange));
  const auto unused = InRange(image, [](vtkDeformableSurface* f) { f->UseUpperValueOff(); });
  const auto plain = SurfaceOf(image, [](vtkDeformableSurface* f) { f->SetIsoValue(Lower); });
  ExpectSameSurfaces(plain->GetOutput(), unused->GetOutput());
  EXPECT_EQ(FieldOf(plain->GetOutput(), "NumberOfComponents"), 1) << "the ball as a whole";
}

TEST(ValueRange, CanBeTheBackground)
{
  const auto filter = InRange(TwoMaterials(),
    [](vtkDeformableSurface* f)
    {
      f->ObjectIsBrightOff();
      f->SetKeepComponentsToComponentsAtPoints();
      f->AddSeedPosition(14.5, 15.0, 15.5);
    });
  EXPECT_EQ(FieldOf(filter->GetOutput(), "NumberOfComponents"), 1);
  EXPECT_NEAR(FieldOf(filter->GetOutput(), "Volume") / VolumeOfBall(Inner - 0.05), 1.0, 0.06);
}

TEST(ValueRange, ReportsInvalidRanges)
{
  struct Case
  {
    double Iso, Upper;
    std::vector<std::string> Parts;
  };
  const double infinite = std::numeric_limits<double>::infinity();
  for (const Case& is :
    { Case{ 300, 200, { "Upper Value is 200, but Iso Value is 300. Set Upper Value to more" } },
      Case{ 300, 300, { "Upper Value is 300, but Iso Value is 300" } },
      Case{ std::nan(""), 200, { "Upper Value is 200, but Iso Value is not set" } },
      Case{ -infinite, 200, { "Iso Value is -inf", "switch Object Is Bright off" } },
      Case{ 100, std::nan(""),
        { "Upper Value is nan, but Iso Value is 100. Set Upper Value to more" } },
      Case{ 610, 700, { "no voxel is between Iso Value, 610, and Upper Value, 700" } },
      Case{ -10, 700, { "all voxels are between Iso Value, -10, and Upper Value, 700" } } })
  {
    SCOPED_TRACE(is.Parts.front());
    for (const auto& filter : { vtkSmartPointer<vtkDeformableSurface>::New(),
           vtkSmartPointer<vtkDeformableSurface>(vtkSmartPointer<vtkVolumeToSurface>::New()) })
    {
      filter->SetInputDataObject(TwoMaterials());
      filter->SetIsoValue(is.Iso);
      filter->SetUpperValue(is.Upper);
      ExpectErrorOf(filter, is.Parts);
    }
  }
}
