// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Messages and texts do not depend on the locale.
#include "CommaLocale.h"
#include "SurfaceTestTools.h"

#include <clocale>
#include <filesystem>

using namespace volumic;

namespace
{
/**
 * Sets locales with a decimal comma: by std::locale::global for streams, and by setlocale for
 * printf, std::to_string and strtod. Without localedef only the first.
 */
class FilterLocale : public ::testing::Test
{
protected:
  void SetUp() override
  {
    const std::string folder = ::testing::TempDir() + "volumic-locales";
    std::filesystem::create_directories(folder);
    setenv("LOCPATH", folder.c_str(), 1);
    // The C library caches missing locales: set the locale only after creating it.
    const std::string command =
      "localedef -i de_DE -f UTF-8 '" + folder + "/de_DE.UTF-8' > /dev/null 2>&1";
    if (std::filesystem::exists(folder + "/de_DE.UTF-8/LC_NUMERIC") ||
      std::system(command.c_str()) == 0)
    {
      ASSERT_TRUE(std::setlocale(LC_NUMERIC, "de_DE.UTF-8"));
      ASSERT_EQ(std::to_string(0.5), "0,500000");
    }
    this->Filter->SetInputDataObject(BallImage(40, 40, 40));
    this->Filter->SetIsoValue(50.0);
  }
  void TearDown() override { std::setlocale(LC_NUMERIC, "C"); }

  void ExpectError(const std::string& part) { ExpectErrorOf(this->Filter, { part }); }

  const CommaLocale Streams;
  vtkNew<vtkDeformableSurface> Filter;
};
}

TEST_F(FilterLocale, SettingsOutOfRange)
{
  this->Filter->SetIsoValue(1234.5);
  this->ExpectError("Iso Value is 1234.5, outside the range of the voxels");
  this->Filter->SetIsoValue(50.0);
  this->Filter->SetSamplingRatio(0.25);
  this->ExpectError("Sampling Ratio is 0.25, it must lie in [0.692819, 1]");
  this->Filter->SetSamplingRatio(0.85);
  this->Filter->SetTensionWeight(1e300);
  this->ExpectError("Tension Weight is 1e+300, it must lie in [0, 1000000]");
}

TEST_F(FilterLocale, PositionsOutsideImage)
{
  const auto seeds = PointsAt({ { 20, 20, 1234.5 } });
  this->Filter->SetInitializationToSeeds();
  this->Filter->SetInitialSurfaceData(seeds);
  this->ExpectError(
    "Seed 0 lies outside the image: 1234.5 voxel distances along axis 2, the image has 40");
  this->Filter->SetAttractingPointsData(seeds);
  this->ExpectError("point 0 (20, 20, 1234.5) is outside the image");
}

TEST_F(FilterLocale, Progress)
{
  ProgressListener listener(this->Filter);
  this->Filter->Update();
  ASSERT_GT(this->Filter->GetOutput()->GetNumberOfPoints(), 1000) << "too few for a separator";
  EXPECT_GT(listener.Texts.size(), 10u);
  for (const std::string& text : listener.Texts)
  {
    EXPECT_FALSE(Has(text, "."));
  }
}
