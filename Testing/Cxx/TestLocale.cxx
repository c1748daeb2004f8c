// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Messages and texts do not depend on the locale.
#include "CommaLocale.h"
#include "SurfaceTestTools.h"

#include <clocale>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

using namespace volumic;

namespace
{
/** Functions that set the locale. */
enum class Method
{
  Global,  ///< std::locale::global, for streams
  Numeric, ///< setlocale, for printf, std::to_string and strtod
};

/** Create the German LC_NUMERIC for the tests. @return false without localedef */
bool MakeCommaForC()
{
  const std::filesystem::path folder =
    std::filesystem::path(::testing::TempDir()) / "volumic-locales";
  const std::filesystem::path made = folder / "de_DE.UTF-8";
  // The C library caches missing locales: set the locale only after creating it.
  setenv("LOCPATH", folder.c_str(), 1);
  std::filesystem::create_directories(folder);
  const std::string command =
    "localedef -i de_DE -f UTF-8 '" + made.string() + "' > /dev/null 2>&1";
  return std::filesystem::exists(made / "LC_NUMERIC") || std::system(command.c_str()) == 0;
}

/** Set the locale. @return whether printf writes 0,5 */
bool SetCommaForC()
{
  static const bool isMade = MakeCommaForC();
  char text[8] = "";
  if (isMade && std::setlocale(LC_NUMERIC, "de_DE.UTF-8"))
  {
    std::snprintf(text, sizeof(text), "%.1f", 0.5);
  }
  return std::string(text) == "0,5";
}

class FilterLocale : public ::testing::TestWithParam<Method>
{
protected:
  void SetUp() override
  {
    if (GetParam() == Method::Global)
    {
      this->Streams = std::make_unique<CommaLocale>();
    }
    else if (!SetCommaForC())
    {
      GTEST_SKIP() << "no locale with a decimal comma, and no localedef";
    }
    this->Filter->SetInputDataObject(BallImage(40, 40, 40));
    this->Filter->SetIsoValue(50.0);
  }
  void TearDown() override { std::setlocale(LC_NUMERIC, "C"); }

  void ExpectError(const std::string& part) { ExpectErrorOf(this->Filter, { part }); }

  std::unique_ptr<CommaLocale> Streams;
  vtkNew<vtkDeformableSurface> Filter;
};
}

TEST_P(FilterLocale, SettingsOutOfRange)
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

TEST_P(FilterLocale, PositionsOutsideImage)
{
  const auto seeds = PointsAt({ { 20, 20, 1234.5 } });
  this->Filter->SetInitializationToSeeds();
  this->Filter->SetInitialSurfaceData(seeds);
  this->ExpectError(
    "Seed 0 lies outside the image: 1234.5 voxel distances along axis 2, the image has 40");
  this->Filter->SetAttractingPointsData(seeds);
  this->ExpectError("point 0 (20, 20, 1234.5) is outside the image");
}

TEST_P(FilterLocale, Progress)
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

INSTANTIATE_TEST_SUITE_P(Methods, FilterLocale, ::testing::Values(Method::Global, Method::Numeric));
