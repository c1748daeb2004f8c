// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// With a ScratchDirectory the filters map large arrays from files, and their outputs are the same.
#include "Core/Common/ScratchMemory.h"
#include "LabelImages.h"
#include "SameOutputs.h"
#include "TemporaryFolder.h"
#include "vtkVolumeToSurface.h"

using namespace volumic;

namespace
{
constexpr int Size = 112;
constexpr std::size_t MiB = std::size_t(1) << 20;

/** Bytes mapped from the files of a folder, which have no name there. */
std::size_t BytesFrom(const TemporaryFolder& folder)
{
  std::size_t bytes = 0;
  for (const auto& [begin, end] : folder.Mapped())
  {
    bytes += end - begin;
  }
  EXPECT_EQ(folder.Names(), std::set<std::string>());
  return bytes;
}

/** Updates a filter. @return the most bytes that are mapped on the way. */
std::size_t MostOf(vtkAlgorithm* filter, const TemporaryFolder& folder)
{
  std::size_t most = 0;
  const ProgressHook hook(filter,
    [&](vtkAlgorithm*, const std::string&, double) { most = std::max(most, BytesFrom(folder)); });
  filter->Update();
  EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  return std::max(most, BytesFrom(folder));
}

vtkSmartPointer<vtkLabelsToSurfaces> LabelsOf()
{
  auto filter = vtkSmartPointer<vtkLabelsToSurfaces>::New();
  filter->SetInputData(LabelImageOf(Size, Size, Size,
    [](int i, int j, int k)
    { return std::hypot(i - 55.3, j - 54.8, k - 55.) < 50. ? (i < 60 ? 1. : 2.) : 0.; }));
  return filter;
}

/** Tests errors of a directory, after each of which the filter works again. */
template <typename Filter>
void ExpectErrors(Filter* filter, const std::function<vtkIdType()>& elements)
{
  const TemporaryFolder folder;
  std::ofstream(folder.File("file")) << "no directory";
  const auto expect = [&](const std::string& directory, const char* reason, const char* mend)
  {
    filter->SetScratchDirectory(directory.c_str());
    filter->Modified(); // The last run would serve.
    {
      const LimitedFileSize limit(MiB); // As if the disk were full.
      const MessagesOf errors(filter);
      filter->Update();
      EXPECT_NE(filter->GetErrorCode(), vtkErrorCode::NoError);
      EXPECT_TRUE(Has(errors.Get(), "Scratch Directory " + directory + " "));
      EXPECT_TRUE(Has(errors.Get(), reason));
      EXPECT_TRUE(Has(errors.Get(), mend));
      EXPECT_EQ(elements(), 0);
    }
    filter->SetScratchDirectory("");
    filter->Update();
    EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
    EXPECT_GT(elements(), 0);
  };
  expect(folder.File("none"), "No such file", "Choose a directory that exists");
  expect(folder.File("file"), "Not a directory", "Choose a directory that exists");
  expect("/proc", "cannot be used", "in which you may create files");
  expect(folder.Path(), "lacks space for a file of", "choose another directory");
  EXPECT_EQ(folder.Names(), std::set<std::string>{ "file" });
}
}

TEST(ScratchDirectory, HoldsTheArraysOfASurface)
{
  const TemporaryFolder folder;
  const auto image = BallImage(Size, Size, Size, 0.4);
  const auto usual = SurfaceOf<vtkVolumeToSurface>(image);
  {
    const auto filter = FilterOf<vtkVolumeToSurface>(
      image, [&](vtkVolumeToSurface* f) { f->SetScratchDirectory(folder.Path().c_str()); });
    EXPECT_GT(MostOf(filter, folder), 3 * MiB) << "levels and the mesh";
    ExpectSameSurfaces(usual->GetOutput(), filter->GetOutput());
  }
  EXPECT_EQ(BytesFrom(folder), 0u);
}

TEST(ScratchDirectory, HoldsTheLevelsOfAPyramidWhoseLevel0IsTheInput)
{
  const TemporaryFolder folder;
  const auto image = BallImage(Size, Size, Size);
  const auto usual = PyramidOf(image);
  vtkNew<vtkImagePyramid> filter;
  filter->SetInputData(image);
  filter->SetScratchDirectory(folder.Path().c_str());
  MostOf(filter, folder);
  EXPECT_GT(BytesFrom(folder), MiB);
  const auto voxels = [](vtkImagePyramid* pyramid, unsigned int level)
  { return Level(pyramid->GetOutput(), level)->GetPointData(); };
  EXPECT_EQ(voxels(filter, 0)->GetScalars(), image->GetPointData()->GetScalars());
  ExpectSameArrays(voxels(usual, 1), voxels(filter, 1));
  ExpectSameArrays(voxels(usual, 2), voxels(filter, 2));
}

TEST(ScratchDirectory, HoldsTheArraysOfLabels)
{
  const TemporaryFolder folder;
  const auto usual = LabelsOf();
  const auto filter = LabelsOf();
  filter->SetScratchDirectory(folder.Path().c_str());
  usual->Update();
  EXPECT_GT(MostOf(filter, folder), 4 * MiB);
  ExpectSameSurfaces(usual->GetInterfaces(), filter->GetInterfaces());
}

TEST(ScratchDirectory, ReportsAnInvalidDirectory)
{
  const auto image = BallImage(Size, Size, Size);
  vtkNew<vtkImagePyramid> pyramid;
  pyramid->SetInputData(image);
  ExpectErrors<vtkImagePyramid>(
    pyramid, [&] { return vtkIdType(pyramid->GetOutput()->GetNumberOfBlocks()); });
  const auto surface =
    FilterOf<vtkDeformableSurface>(image, [](vtkDeformableSurface* f) { f->SetFinestLevel(2); });
  ExpectErrors<vtkDeformableSurface>(
    surface, [&] { return surface->GetOutput()->GetNumberOfPoints(); });
  const auto labels = LabelsOf();
  labels->SetFinestLevel(1);
  ExpectErrors<vtkLabelsToSurfaces>(
    labels, [&] { return labels->GetInterfaces()->GetNumberOfPoints(); });
}

TEST(ScratchDirectory, IsNamedByTheWarningOfMemoryLimit)
{
  const auto expectOneWarning = [](auto filter)
  {
    const MessagesOf warnings(filter, vtkCommand::WarningEvent);
    const vtkMTimeType before = filter->GetMTime();
    filter->SetMemoryLimit(0);
    EXPECT_EQ(warnings.Get(), "");
    filter->SetMemoryLimit(2000);
    filter->SetMemoryLimit(3000);
    EXPECT_TRUE(Has(warnings.Get(), "ScratchDirectory"));
    EXPECT_EQ(CountOf(warnings.Get(), "has no effect"), 1);
    EXPECT_EQ(filter->GetMemoryLimit(), 3000);
    EXPECT_EQ(filter->GetMTime(), before);
  };
  expectOneWarning(vtkSmartPointer<vtkImagePyramid>::New());
  expectOneWarning(vtkSmartPointer<vtkVolumeToSurface>::New());
  expectOneWarning(vtkSmartPointer<vtkLabelsToSurfaces>::New());
}
