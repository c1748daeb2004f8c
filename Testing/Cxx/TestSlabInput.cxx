// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// With a limit of memory a filter asks for its image slab by slab; what it makes of it is the same
// bits.
#include "SurfaceTestTools.h"
#include "vtkImagePyramid.h"
#include "vtkVolumeToSurface.h"

#include <vtkCellData.h>
#include <vtkDataSetAttributes.h>
#include <vtkErrorCode.h>
#include <vtkFloatArray.h>
#include <vtkImageAlgorithm.h>
#include <vtkImageData.h>
#include <vtkImageGaussianSmooth.h>
#include <vtkImageShiftScale.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkUnsignedCharArray.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

using namespace volumic;

namespace
{
constexpr std::array<int, 6> Whole = { -20, 123, 7, 150, 3, 130 };
/** MiB: slabs have a sixty-fourth of it. */
constexpr int Limit = 640;
/** Floats of a voxel: so many that there are several slabs. */
constexpr int Components = 4;

/** What the source makes beside the voxels. */
struct Scene
{
  bool HasNaNs = false;
  bool AreCells = false;   ///< The voxels are cells, not points.
  bool HasGhosts = false;  ///< Some points and some cells are hidden.
  bool IsNamed = true;
  bool GivesParts = true;
  int FailingSlab = -1;    ///< 0: the first
  int WrongSlab = -1;      ///< one of another type
};

/** A ball in an image that is turned, shifted and does not begin at 0, with other arrays. */
class BallSource : public vtkImageAlgorithm
{
public:
  static BallSource* New();
  vtkTypeMacro(BallSource, vtkImageAlgorithm);

  Scene Made;
  std::vector<std::array<int, 2>> Slices; ///< that were asked for

protected:
  BallSource() { this->SetNumberOfInputPorts(0); }

  int RequestInformation(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* output) override
  {
    vtkInformation* info = output->GetInformationObject(0);
    info->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), Whole.data(), 6);
    if (this->Made.GivesParts)
    {
      info->Set(vtkAlgorithm::CAN_PRODUCE_SUB_EXTENT(), 1);
    }
    return 1;
  }

  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* output) override
  {
    std::array<int, 6> extent = Whole;
    if (this->Made.GivesParts)
    {
      output->GetInformationObject(0)->Get(
        vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT(), extent.data());
    }
    const int number = static_cast<int>(this->Slices.size());
    this->Slices.push_back({ extent[4], extent[5] });
    if (number == this->Made.FailingSlab)
    {
      vtkErrorMacro("the disk has gone.");
      return 0;
    }
    this->Fill(vtkImageData::GetData(output), extent, number == this->Made.WrongSlab);
    return 1;
  }

private:
  void Fill(vtkImageData* image, const std::array<int, 6>& extent, bool isWrong);
};

vtkStandardNewMacro(BallSource);

double ValueAt(int i, int j, int k)
{
  const double x = i - 50.3;
  const double y = j - 70.1;
  const double z = k - 60.7;
  return 100.0 - std::sqrt(x * x + y * y + z * z) + 3.0 * std::sin(0.7 * i + 1.3 * j * k);
}

void BallSource::Fill(vtkImageData* image, const std::array<int, 6>& extent, bool isWrong)
{
  image->SetExtent(extent[0], extent[1], extent[2], extent[3], extent[4], extent[5]);
  image->SetSpacing(0.5, 0.5, 0.75);
  image->SetOrigin(10.0, -5.0, 2.0);
  image->SetDirectionMatrix(0, 1, 0, -1, 0, 0, 0, 0, 1);
  const int isCell = this->Made.AreCells ? 1 : 0;
  const auto voxels = vtk::TakeSmartPointer(
    isWrong ? static_cast<vtkDataArray*>(vtkUnsignedCharArray::New()) : vtkFloatArray::New());
  vtkNew<vtkFloatArray> other;
  voxels->SetName(this->Made.IsNamed ? "Ball" : nullptr);
  voxels->SetNumberOfComponents(Components);
  other->SetName("Other");
  vtkNew<vtkUnsignedCharArray> ghosts;
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  const unsigned char hidden =
    isCell ? vtkDataSetAttributes::HIDDENCELL : vtkDataSetAttributes::HIDDENPOINT;
  for (int k = extent[4]; k <= extent[5] - isCell; ++k)
  {
    for (int j = extent[2]; j <= extent[3] - isCell; ++j)
    {
      for (int i = extent[0]; i <= extent[1] - isCell; ++i)
      {
        const double value = ValueAt(i, j, k);
        const bool isNaN = this->Made.HasNaNs && (i + 2 * j + 3 * k) % 97 == 0;
        voxels->InsertNextTuple4(1.0, 2.0,
          isNaN ? std::numeric_limits<float>::quiet_NaN() : value, value * 0.5);
        other->InsertNextValue(static_cast<float>(i + j + k));
        ghosts->InsertNextValue((i * j + k) % 31 == 0 ? hidden : 0);
      }
    }
  }
  vtkDataSetAttributes* attributes = image->GetPointData();
  attributes = isCell ? static_cast<vtkDataSetAttributes*>(image->GetCellData()) : attributes;
  attributes->AddArray(other);
  attributes->SetScalars(voxels);
  if (this->Made.HasGhosts)
  {
    attributes->AddArray(ghosts);
    vtkNew<vtkUnsignedCharArray> cells; // in which some lie between slabs, whatever their size
    cells->SetName(vtkDataSetAttributes::GhostArrayName());
    for (int k = extent[4]; k < extent[5] && !isCell; ++k)
    {
      for (int c = 0; c < (extent[1] - extent[0]) * (extent[3] - extent[2]); ++c)
      {
        cells->InsertNextValue(c % 900 < 300 ? vtkDataSetAttributes::HIDDENCELL : 0);
      }
    }
    image->GetCellData()->AddArray(isCell ? ghosts : cells);
  }
}

vtkSmartPointer<BallSource> SourceOf(const Scene& scene)
{
  auto source = vtkSmartPointer<BallSource>::New();
  source->Made = scene;
  return source;
}

void ExpectSameArrays(vtkDataSetAttributes* a, vtkDataSetAttributes* b)
{
  ASSERT_EQ(a->GetNumberOfArrays(), b->GetNumberOfArrays());
  for (int n = 0; n < a->GetNumberOfArrays(); ++n)
  {
    vtkDataArray* one = a->GetArray(n);
    vtkDataArray* two = one->GetName() ? b->GetArray(one->GetName()) : b->GetArray(n);
    ASSERT_TRUE(two);
    ASSERT_EQ(one->GetDataType(), two->GetDataType());
    ASSERT_EQ(one->GetNumberOfComponents(), two->GetNumberOfComponents());
    ASSERT_EQ(one->GetNumberOfTuples(), two->GetNumberOfTuples());
    const auto bytes = static_cast<std::size_t>(one->GetNumberOfValues()) *
      static_cast<std::size_t>(one->GetDataTypeSize());
    EXPECT_EQ(std::memcmp(one->GetVoidPointer(0), two->GetVoidPointer(0), bytes), 0)
      << (one->GetName() ? one->GetName() : "unnamed");
  }
}

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
void ExpectSamePyramids(const Scene& scene, int component,
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
    Listener listener(pyramid);
    pyramid->Update();
    EXPECT_EQ(pyramid->GetErrorCode(), vtkErrorCode::NoError) << listener.Text();
    if (!limited)
    {
      EXPECT_EQ(source->Slices.size(), 1u);
      continue;
    }
    EXPECT_GT(source->Slices.size(), 3u);
    // Each slice once, but where what is between two matters or a filter needs neighbours.
    const int shared = scene.HasGhosts || scene.AreCells ? 0 : 1;
    for (std::size_t n = 1; n < source->Slices.size() && !behind; ++n)
    {
      EXPECT_EQ(source->Slices[n][0], source->Slices[n - 1][1] + shared);
    }
    EXPECT_EQ(source->Slices.front()[0], Whole[4]);
    EXPECT_EQ(source->Slices.back()[1], Whole[5]);
  }
  ExpectSamePyramids(pyramids[0]->GetOutput(), pyramids[1]->GetOutput());
}
}

TEST(SlabInput, GivesTheSamePyramid)
{
  ExpectSamePyramids(Scene(), 2);
}
