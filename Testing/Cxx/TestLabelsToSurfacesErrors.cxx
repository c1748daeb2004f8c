// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LabelImages.h"
#include "SurfaceTestTools.h"

using namespace volumic;

namespace
{
/** A valid filter. Each test makes something invalid, expects an error, and restores it. */
class LabelsToSurfacesErrors : public ::testing::Test
{
protected:
  void SetUp() override { this->Filter->SetInputData(Balls()); }
  void TearDown() override
  {
    this->Filter->SetInputData(Balls());
    this->Filter->ClearLabels();
    this->Filter->SetTimeLimit(0.);
    this->Filter->SetKeepComponents(0);
    this->Filter->SetMinimumComponentVolume(0.);
    this->Filter->Update();
    EXPECT_EQ(this->Filter->GetErrorCode(), vtkErrorCode::NoError);
    ASSERT_EQ(this->Filter->GetOutput()->GetNumberOfBlocks(), 2u) << "works again";
    EXPECT_GT(BlockOf(this->Filter, 1)->GetNumberOfCells(), 100);
  }

  static vtkSmartPointer<vtkImageData> Balls() { return LabelImageOf(34, 28, 28, TwoBalls); }

  void ExpectError(const std::vector<std::string>& parts)
  {
    ExpectErrorOf(this->Filter, parts);
    EXPECT_EQ(this->Filter->GetOutput()->GetNumberOfBlocks(), 0u) << "no output half made";
  }

  vtkNew<vtkLabelsToSurfaces> Filter;
};
}

TEST_F(LabelsToSurfacesErrors, ReportsMissingLabels)
{
  this->Filter->AddLabel(3);
  this->Filter->AddLabel(4);
  this->ExpectError({ "Labels", "'Labels'", "no label 4", "0, 3, 7" });
}

TEST_F(LabelsToSurfacesErrors, ReportsImagesThatAreNotLabelMaps)
{
  const auto map = [](int slices, const std::function<double(int)>& at, int type = VTK_SHORT)
  {
    return LabelImageOf(
      9, 9, slices, [&](int i, int, int) { return at(i); }, type);
  };
  vtkNew<vtkImageData> colours;
  colours->SetDimensions(9, 9, 9);
  colours->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  const auto flat = Balls();
  flat->SetSpacing(1., 2000., 1.);
  const std::vector<std::pair<vtkSmartPointer<vtkImageData>, std::vector<std::string>>> cases = {
    { map(9, [](int) { return 0.; }), { "Input port 0", "no label except Background Label, 0" } },
    { map(
        9, [](int i) { return 0.5 * i; }, VTK_DOUBLE),
      { "Input port 0", "'Labels' has the value 0.5", "integers", "Volume to Surface" } },
    { map(
        9, [](int i) { return i > 4 ? 1e30 : 0.; }, VTK_DOUBLE),
      { "'Labels' has the value 1e+30" } },
    { map(
        9, [](int i) { return i > 4 ? std::nan("") : 0.; }, VTK_DOUBLE),
      { "no label except Background Label, 0" } },
    { map(1, [](int i) { return std::floor(i / 4.); }),
      { "Input port 0", "9 x 9 x 1", "at least 2" } },
    { colours.Get(), { "Input port 0", "components" } },
    { flat, { "spacing of the image is 1 x 2000 x 1" } },
  };
  for (const auto& [image, parts] : cases)
  {
    this->Filter->SetInputData(image);
    this->ExpectError(parts);
  }
}

TEST_F(LabelsToSurfacesErrors, ReportsTooManyLabels)
{
  const auto manyFrom = [](double first, int type)
  {
    return LabelImageOf(
      17, 17, 17, [first](int i, int j, int k) { return first + i + 17 * (j + 17 * k); }, type);
  };
  this->Filter->SetInputData(manyFrom(1e10, VTK_LONG_LONG));
  this->ExpectError({ "more than 4096 different values outside the range of int", "10000000000" });
  this->Filter->SetInputData(manyFrom(0., VTK_INT));
  this->ExpectError({ "4913 different values", "4096", "not a label map", "Volume to Surface" });
  // Some of them can be selected.
  this->Filter->AddLabel(100);
  this->Filter->SetTimeLimit(1e-9); // not to mesh the others
  this->Filter->Update();
  EXPECT_EQ(this->Filter->GetErrorCode(), vtkErrorCode::NoError);
}

TEST_F(LabelsToSurfacesErrors, WarnsOfScansBeforeMeshing)
{
  const auto warningOf = [this](const std::function<double(int, int, int)>& at)
  {
    this->Filter->SetInputData(LabelImageOf(28, 28, 28, at));
    this->Filter->SetTimeLimit(1e-9);
    const MessagesOf warnings(this->Filter, vtkCommand::WarningEvent);
    bool isFirst = false;
    const ProgressHook hook(this->Filter,
      [&](vtkAlgorithm*, const std::string& text, double)
      { isFirst = isFirst || (text.find("Fields") == 0 && !warnings.Get().empty()); });
    this->Filter->Update();
    EXPECT_TRUE(warnings.Get().empty() || isFirst);
    return warnings.Get();
  };
  const std::string noisy =
    warningOf([](int i, int j, int k) { return (7919 * (i + 28 * (j + 28 * k))) % 301; });
  EXPECT_TRUE(Has(noisy, "'Labels' has 300 labels"));
  EXPECT_TRUE(Has(noisy, "looks like a scan"));
  EXPECT_TRUE(Has(noisy, "--iso"));
  EXPECT_EQ(
    warningOf([](int i, int j, int k) { return (7919 * (i + 28 * (j + 28 * k))) % 250; }), "")
    << "not many labels";
  EXPECT_EQ(warningOf([](int i, int j, int k) { return i / 4 + 7 * (j / 4 + 7 * (k / 4)); }), "")
    << "blocks of 4 x 4 x 4 voxels";
}

TEST_F(LabelsToSurfacesErrors, ReportsAMissingArray)
{
  this->Filter->SetInputArrayToProcess(
    0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "segmentation");
  this->ExpectError({ "Input port 0", "'segmentation'", "'Labels'" });
  this->Filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Labels");
}

TEST_F(LabelsToSurfacesErrors, PropertiesOutOfRange)
{
  using Labels = vtkLabelsToSurfaces;
  const double infinite = std::numeric_limits<double>::infinity();
  const auto expect = [this](auto set, auto good, auto bad, const std::vector<std::string>& parts)
  {
    (this->Filter->*set)(bad);
    this->ExpectError(parts);
    (this->Filter->*set)(good);
  };
  expect(&Labels::SetSmoothing, 2., -1., { "Smoothing is -1" });
  expect(&Labels::SetSmoothing, 2., 11., { "Smoothing is 11", "at most 10" });
  expect(&Labels::SetSmoothing, 2., std::nan(""), { "Smoothing is nan" });
  expect(&Labels::SetVoxelTolerance, 0., -0.5, { "Voxel Tolerance is -0.5" });
  expect(&Labels::SetVoxelTolerance, 0., 1.5, { "Voxel Tolerance is 1.5", "to 1 voxels" });
  expect(&Labels::SetMetric, 0, 2, { "Metric is 2" });
  expect(&Labels::SetGradation, 0.2, 0.7, { "Gradation is 0.7" });
  expect(&Labels::SetEdgeLength, 0., -2., { "Edge Length is -2" });
  expect(&Labels::SetEdgeLength, 0., 1e-3, { "Edge Length is 0.001" });
  expect(&Labels::SetTimeLimit, 0., -1., { "Time Limit is -1" });
  expect(&Labels::SetFinestLevel, 0, -2, { "Finest Level is -2" });
  expect(&Labels::SetFinestLevel, 0, 8, { "Finest Level is 8", "not longer than the image" });
  expect(&Labels::SetKeepComponents, 0, 2, { "Keep Components is 2" });
  expect(&Labels::SetMinimumComponentVolume, 0., infinite, { "Minimum Component Volume is inf" });
}

TEST_F(LabelsToSurfacesErrors, ReportsAWrongNumberOfNames)
{
  const auto image = Balls();
  AddNames(image);
  this->Filter->SetInputData(image);
  image->GetFieldData()->GetAbstractArray("LabelNames")->SetNumberOfTuples(0);
  this->ExpectError({ "Input port 0", "'LabelNames' has 0 entries", "'LabelValues' has 2" });
  AddNames(image);
  image->GetFieldData()->GetArray("LabelColors")->SetNumberOfComponents(1);
  image->GetFieldData()->GetArray("LabelColors")->SetNumberOfTuples(2);
  image->Modified();
  this->ExpectError({ "'LabelColors' has 1 components", "3" });
}

TEST_F(LabelsToSurfacesErrors, MemoryThatEndsWhileTheMeshIsMade)
{
  ExpectErrorWithoutMemory(
    this->Filter, "Interfaces of the labels", "not enough memory for the surfaces");
  EXPECT_EQ(this->Filter->GetOutput()->GetNumberOfBlocks(), 0u) << "no output half made";
}

TEST_F(LabelsToSurfacesErrors, NamesLabelsRemovedByKeepComponents)
{
  const auto smallPart = [](int i, int j, int k)
  { return i == 30 && j == 3 && k == 3 ? 9. : TwoBalls(i, j, k); };
  this->Filter->SetInputData(LabelImageOf(34, 28, 28, smallPart));
  this->Filter->SetKeepComponents(3);
  this->Filter->SetMinimumComponentVolume(2.);
  const MessagesOf warnings(this->Filter, vtkCommand::WarningEvent);
  this->Filter->Update();
  EXPECT_EQ(this->Filter->GetErrorCode(), vtkErrorCode::NoError);
  ASSERT_EQ(BlockNames(this->Filter->GetOutput()),
    (std::vector<std::string>{ "Label 3", "Label 7", "Label 9" }));
  EXPECT_GT(BlockOf(this->Filter, 0)->GetNumberOfCells(), 20);
  EXPECT_EQ(BlockOf(this->Filter, 2)->GetNumberOfCells(), 0);
  EXPECT_EQ(StopReason(BlockOf(this->Filter, 2)), "vanished");
  EXPECT_EQ(FieldOf(BlockOf(this->Filter, 2), "WrongVoxels"), 1.);
  auto* missed = vtkStringArray::SafeDownCast(
    this->Filter->GetOutput()->GetFieldData()->GetAbstractArray("LostLabels"));
  ASSERT_TRUE(missed);
  EXPECT_TRUE(Has(missed->GetValue(0), "These labels have no surface: Label 9"));
  EXPECT_TRUE(Has(missed->GetValue(0), "removed by Keep Components"));
  EXPECT_EQ(warnings.Get(), "") << "no warning for a small part beside balls";
}
