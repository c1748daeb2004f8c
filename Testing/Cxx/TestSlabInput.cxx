// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// With a limit of memory a filter asks for its image slab by slab; what it makes of it is the same
// bits.
#include "SameOutputs.h"
#include "SlabSource.h"
#include "vtkVolumeToSurface.h"

#include <vtkImageFlip.h>
#include <vtkImageShiftScale.h>
#include <vtkMatrix3x3.h>

using namespace volumic;

namespace
{
void ExpectSamePyramids(vtkMultiBlockDataSet* a, vtkMultiBlockDataSet* b)
{
  ASSERT_EQ(a->GetNumberOfBlocks(), b->GetNumberOfBlocks());
  for (unsigned int h = 0; h < a->GetNumberOfBlocks(); ++h)
  {
    SCOPED_TRACE(h);
    auto* one = vtkImageData::SafeDownCast(a->GetBlock(h));
    auto* two = vtkImageData::SafeDownCast(b->GetBlock(h));
    for (int i = 0; i < 6; ++i)
    {
      EXPECT_EQ(one->GetExtent()[i], two->GetExtent()[i]);
      EXPECT_EQ(one->GetSpacing()[i / 2], two->GetSpacing()[i / 2]);
      EXPECT_EQ(one->GetOrigin()[i / 2], two->GetOrigin()[i / 2]);
      EXPECT_EQ(one->GetDirectionMatrix()->GetData()[i], two->GetDirectionMatrix()->GetData()[i]);
    }
    ExpectSameArrays(one->GetPointData(), two->GetPointData());
    vtkDataArray* ghosts = one->GetCellData()->GetArray(vtkDataSetAttributes::GhostArrayName());
    if (ghosts)
    {
      ExpectSameArrays(one->GetCellData(), two->GetCellData());
    }
    EXPECT_STREQ(one->GetPointData()->GetScalars()->GetName(),
      two->GetPointData()->GetScalars()->GetName());
  }
}

/** Pyramids of what the source, or a filter behind it, gives, with a limit and without. */
void ExpectSamePyramids(const SlabScene& scene, int component,
  const std::function<vtkSmartPointer<vtkAlgorithm>(vtkAlgorithm*)>& behind = {})
{
  std::array<vtkSmartPointer<vtkImagePyramid>, 2> pyramids;
  for (int limited = 0; limited < 2; ++limited)
  {
    const auto source = SourceOf(scene);
    const vtkSmartPointer<vtkAlgorithm> last = behind ? behind(source) : source.Get();
    auto& pyramid = pyramids[limited];
    pyramid = vtkSmartPointer<vtkImagePyramid>::New();
    pyramid->SetInputConnection(last->GetOutputPort());
    pyramid->SetSelectedComponent(component);
    pyramid->SetMemoryLimit(limited ? Limit : 0);
    const MessagesOf warnings(pyramid, vtkCommand::WarningEvent);
    pyramid->Update();
    EXPECT_EQ(pyramid->GetErrorCode(), vtkErrorCode::NoError);
    EXPECT_EQ(warnings.Has("NaN"), scene.HasNaNs) << warnings.Get();
    EXPECT_FALSE(warnings.Has("whole"));
    if (!limited)
    {
      EXPECT_EQ(source->Slices.size(), 1u);
      continue;
    }
    EXPECT_GT(source->Slices.size(), 3u);
    // Each slice once, but where what is between two matters.
    const int shared = scene.HasGhosts || scene.AreCells ? 0 : 1;
    std::vector<std::array<int, 2>> slices = source->Slices;
    std::sort(slices.begin(), slices.end());
    for (std::size_t n = 1; n < slices.size(); ++n)
    {
      EXPECT_EQ(slices[n][0], slices[n - 1][1] + shared);
    }
    EXPECT_EQ(slices.front()[0], Whole[4]);
    EXPECT_EQ(slices.back()[1], Whole[5]);
  }
  ExpectSamePyramids(pyramids[0]->GetOutput(), pyramids[1]->GetOutput());
}
}

TEST(SlabInput, GivesTheSamePyramidWhateverTheImageHas)
{
  SlabScene scenes[4];
  scenes[1].HasNaNs = true;
  scenes[2].HasGhosts = true; // Also between slabs.
  scenes[3].IsNamed = false;
  const int components[4] = { 2, -1, 2, 3 };
  for (int i = 0; i < 4; ++i)
  {
    SCOPED_TRACE(i);
    ExpectSamePyramids(scenes[i], components[i]);
  }
}

TEST(SlabInput, ComesThroughFiltersThatStream)
{
  SlabScene scene;
  scene.HasOther = false; // Filters pass other arrays with the whole only.
  ExpectSamePyramids(scene, 2,
    [](vtkAlgorithm* source) -> vtkSmartPointer<vtkAlgorithm>
    {
      auto filter = vtkSmartPointer<vtkImageShiftScale>::New();
      filter->SetInputConnection(source->GetOutputPort());
      filter->SetScale(10.0);
      filter->SetOutputScalarTypeToInt();
      return filter;
    });
  ExpectSamePyramids(scene, 2,
    [](vtkAlgorithm* source) -> vtkSmartPointer<vtkAlgorithm>
    {
      auto filter = vtkSmartPointer<vtkImageFlip>::New(); // from its other end
      filter->SetInputConnection(source->GetOutputPort());
      filter->SetFilteredAxis(2);
      return filter;
    });
}

TEST(SlabInput, IsTheWholeWhereTheSourceGivesNoParts)
{
  SlabScene scene;
  scene.GivesParts = false;
  const auto source = SourceOf(scene);
  vtkNew<vtkImagePyramid> limited;
  limited->SetInputConnection(source->GetOutputPort());
  limited->SetSelectedComponent(2);
  limited->SetMemoryLimit(Limit);
  const MessagesOf warnings(limited, vtkCommand::WarningEvent);
  limited->Update();
  EXPECT_TRUE(warnings.Has("Input port 0: the image is in memory as a whole (")) << warnings.Get();
  EXPECT_TRUE(warnings.Has("MiB), which counts to Memory Limit: BallSource cannot give it slab"));
  const std::string first = warnings.Get();
  limited->Modified();
  limited->Update();
  EXPECT_EQ(warnings.Get(), first) << "it is told once";
  EXPECT_EQ(source->Slices.size(), 1u);
  vtkImageData* level0 = Level(limited->GetOutput(), 0);
  EXPECT_EQ(level0->GetPointData()->GetArray("Other"),
    source->GetOutput()->GetPointData()->GetArray("Other"))
    << "it is shared";
  vtkNew<vtkImagePyramid> usual;
  usual->SetInputData(source->GetOutput());
  usual->SetSelectedComponent(2);
  usual->Update();
  ExpectSamePyramids(usual->GetOutput(), limited->GetOutput());
  // Where it may be let go, it goes to scratch memory.
  source->ReleaseDataFlagOn();
  limited->Modified();
  limited->Update();
  EXPECT_EQ(source->GetOutput()->GetNumberOfPoints(), 0);
  ExpectSamePyramids(usual->GetOutput(), limited->GetOutput());
}

TEST(SlabInput, IsNotAskedForAgainWhereItIsAtHand)
{
  const auto source = SourceOf(SlabScene());
  source->Update();
  vtkNew<vtkImagePyramid> pyramid;
  pyramid->SetInputData(source->GetOutput());
  pyramid->SetMemoryLimit(Limit);
  const MessagesOf warnings(pyramid, vtkCommand::WarningEvent);
  pyramid->Update();
  EXPECT_EQ(warnings.Get(), "") << "who gives data knows that they are in memory";
  EXPECT_EQ(Level(pyramid->GetOutput(), 0)->GetPointData()->GetArray("Other"),
    source->GetOutput()->GetPointData()->GetArray("Other"));
  pyramid->SetInputConnection(source->GetOutputPort());
  pyramid->Update();
  EXPECT_EQ(source->Slices.size(), 1u);
}

TEST(SlabInput, TellsOfAFailureAndWorksAgain)
{
  for (const bool isWrong : { false, true })
  {
    for (const int slab : { 1, 3 })
    {
      SlabScene scene;
      (isWrong ? scene.WrongSlab : scene.FailingSlab) = slab;
      const auto source = SourceOf(scene);
      vtkNew<vtkImagePyramid> pyramid;
      pyramid->SetInputConnection(source->GetOutputPort());
      pyramid->SetSelectedComponent(2);
      pyramid->SetMemoryLimit(Limit);
      const MessagesOf errors(pyramid);
      const MessagesOf executive(source->GetExecutive());
      pyramid->Update();
      EXPECT_EQ(pyramid->GetErrorCode(), vtkErrorCode::UserError);
      EXPECT_TRUE(errors.Has(isWrong ? "or of another name or type than in the slices before them"
                                     : "BallSource failed: the disk has gone."))
        << errors.Get();
      EXPECT_EQ(pyramid->GetOutput()->GetNumberOfBlocks(), 0u);
      source->Made = SlabScene();
      source->Modified();
      pyramid->Update();
      EXPECT_EQ(pyramid->GetErrorCode(), vtkErrorCode::NoError);
      EXPECT_GT(pyramid->GetOutput()->GetNumberOfBlocks(), 2u);
    }
  }
}

TEST(SlabInput, IsRefusedWithALimitThatIsNone)
{
  const auto source = SourceOf(SlabScene());
  vtkNew<vtkImagePyramid> pyramid;
  pyramid->SetInputConnection(source->GetOutputPort());
  const auto expectError = [&](int limit, const char* directory, const char* text)
  {
    pyramid->SetMemoryLimit(limit);
    pyramid->SetScratchDirectory(directory);
    const MessagesOf errors(pyramid);
    pyramid->Update();
    EXPECT_EQ(pyramid->GetErrorCode(), vtkErrorCode::UserError);
    EXPECT_TRUE(errors.Has(text)) << errors.Get();
    EXPECT_EQ(pyramid->GetOutput()->GetNumberOfBlocks(), 0u);
  };
  expectError(-3, "", "Memory Limit is -3; it must be 0 (none) or a number of MiB.");
  expectError(1, "", "Memory Limit is 1 MiB");
  expectError(Limit, "/no/such/folder", "Scratch Directory /no/such/folder");
  pyramid->SetScratchDirectory("");
  pyramid->Update();
  EXPECT_EQ(pyramid->GetErrorCode(), vtkErrorCode::NoError);
  EXPECT_GT(pyramid->GetOutput()->GetNumberOfBlocks(), 2u);
}

namespace
{
template <class Filter>
vtkSmartPointer<Filter> SurfaceFrom(BallSource* source, double isoValue, int limit)
{
  auto filter = vtkSmartPointer<Filter>::New();
  filter->SetInputConnection(source->GetOutputPort());
  filter->SetIsoValue(isoValue);
  filter->SetSelectedComponent(2);
  filter->SetFinestLevel(2);
  filter->SetMemoryLimit(limit);
  filter->Update();
  EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  EXPECT_GT(filter->GetOutput()->GetNumberOfPoints(), 100);
  return filter;
}
}

TEST(SlabInput, GivesTheSameSurfaces)
{
  SlabScene cells;
  cells.AreCells = true;
  cells.HasGhosts = true;
  const double otsu = std::nan("");
  for (const SlabScene& scene : { SlabScene(), cells })
  {
    const auto whole = SourceOf(scene);
    const auto slabs = SourceOf(scene);
    EXPECT_TRUE(AreSameSurfaces(SurfaceFrom<vtkVolumeToSurface>(whole, otsu, 0)->GetOutput(),
      SurfaceFrom<vtkVolumeToSurface>(slabs, otsu, Limit)->GetOutput()));
    EXPECT_GT(slabs->Slices.size(), 3u);
  }
  const auto slabs = SourceOf(SlabScene());
  EXPECT_TRUE(
    AreSameSurfaces(SurfaceFrom<vtkDeformableSurface>(SourceOf(SlabScene()), 50.0, 0)->GetOutput(),
      SurfaceFrom<vtkDeformableSurface>(slabs, 50.0, Limit)->GetOutput()));
  EXPECT_GT(slabs->Slices.size(), 3u);
}
