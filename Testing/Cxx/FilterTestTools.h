// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicFilterTestTools_h
#define volumicFilterTestTools_h

#include "ForVoxels.h"
#include "TestPrelude.h"
#include "vtkImagePyramid.h"

#include <vtkAlgorithm.h>
#include <vtkCallbackCommand.h>
#include <vtkCellData.h>
#include <vtkCommand.h>
#include <vtkDataArray.h>
#include <vtkErrorCode.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkWeakPointer.h>

/** Tools for tests of VTK classes. */
namespace volumic
{
/** Calls a function with the data of each event of an object until destruction. */
class EventHook
{
public:
  EventHook(vtkObject* sender, unsigned long event, std::function<void(void*)> call)
    : Sender(sender), Call(std::move(call))
  {
    this->Command->SetClientData(this);
    this->Command->SetCallback([](vtkObject*, unsigned long, void* client, void* data)
      { static_cast<EventHook*>(client)->Call(data); });
    sender->AddObserver(event, this->Command);
  }
  ~EventHook()
  {
    if (this->Sender)
    {
      this->Sender->RemoveObserver(this->Command);
    }
  }
  EventHook(const EventHook&) = delete;
  EventHook& operator=(const EventHook&) = delete;

private:
  vtkWeakPointer<vtkObject> Sender;
  std::function<void(void*)> Call;
  vtkNew<vtkCallbackCommand> Command;
};

/** Collects the messages of an event (errors, warnings) without printing them. */
class MessagesOf
{
public:
  explicit MessagesOf(vtkObject* sender, unsigned long event = vtkCommand::ErrorEvent)
    : Hook(
        sender, event, [this](void* message) { this->Text += static_cast<const char*>(message); })
  {
  }

  const std::string& Get() const { return this->Text; }
  bool Has(const std::string& part) const { return this->Text.find(part) != std::string::npos; }

private:
  std::string Text;
  EventHook Hook;
};

/** Update a filter and return its messages of an event. */
inline std::string MessagesOfUpdate(
  vtkAlgorithm* filter, unsigned long event = vtkCommand::ErrorEvent)
{
  const MessagesOf messages(filter, event);
  filter->Update();
  return messages.Get();
}

/** Return the number of points and rows. */
inline vtkIdType SizeOfOutput(vtkAlgorithm* filter, int port = 0)
{
  vtkDataObject* output = filter->GetOutputDataObject(port);
  return output->GetNumberOfElements(vtkDataObject::POINT) +
    output->GetNumberOfElements(vtkDataObject::ROW);
}

/** A setting or input that is invalid, and parts of the error. */
template <typename Filter>
struct ErrorCase
{
  std::function<void(Filter*)> Spoil;
  std::vector<std::string> Parts;
};

/** Update a filter. Expect an error that contains these parts, and an empty output. */
inline void ExpectErrorOf(vtkAlgorithm* filter, const std::vector<std::string>& parts)
{
  const std::string errors = MessagesOfUpdate(filter);
  for (const std::string& part : parts)
  {
    EXPECT_TRUE(Has(errors, part));
  }
  EXPECT_EQ(SizeOfOutput(filter), 0) << "the output must be empty";
  EXPECT_EQ(filter->GetErrorCode(), static_cast<unsigned long>(vtkErrorCode::UserError));
}

/** Count the occurrences of a part in a text. */
inline int CountOf(const std::string& text, const std::string& part)
{
  int count = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
  {
    ++count;
  }
  return count;
}

inline vtkImageData* Level(vtkMultiBlockDataSet* pyramid, unsigned int h)
{
  return vtkImageData::SafeDownCast(pyramid->GetBlock(h));
}

inline vtkDataArray* Voxels(vtkImageData* image)
{
  return image->GetPointData()->GetScalars();
}

/** Return the field data `StopReason`; empty if there is none. */
inline std::string StopReason(vtkDataObject* output)
{
  auto* reason =
    vtkStringArray::SafeDownCast(output->GetFieldData()->GetAbstractArray("StopReason"));
  return reason ? reason->GetValue(0) : "";
}

/** Return the unit U_h of a level. */
inline double UnitOf(vtkImageData* level)
{
  return level->GetFieldData()->GetArray("Unit")->GetComponent(0, 0);
}

/** Settings of a filter. The type is not deducible, so calls name the filter class. */
template <typename Filter>
struct ChoiceFor
{
  using Type = std::function<void(Filter*)>;
};
template <typename Filter>
using ChoiceOf = typename ChoiceFor<Filter>::Type;

/** Return an updated filter with these settings. */
template <typename Filter>
vtkSmartPointer<Filter> Updated(
  vtkDataObject* input, const ChoiceOf<Filter>& choose = [](Filter*) {})
{
  auto filter = vtkSmartPointer<Filter>::New();
  filter->SetInputDataObject(input);
  choose(filter);
  filter->Update();
  return filter;
}

inline vtkSmartPointer<vtkImagePyramid> PyramidOf(vtkImageData* image, int levels = 0)
{
  return Updated<vtkImagePyramid>(
    image, [levels](vtkImagePyramid* pyramid) { pyramid->SetNumberOfLevels(levels); });
}

/** Calls a function at each progress event of an algorithm. */
struct ProgressHook : EventHook
{
  using Callback =
    std::function<void(vtkAlgorithm* filter, const std::string& text, double progress)>;

  ProgressHook(vtkAlgorithm* filter, const Callback& call)
    : EventHook(filter, vtkCommand::ProgressEvent,
        [filter, call](void* progress)
        {
          const char* text = filter->GetProgressText();
          call(filter, text ? text : "", *static_cast<double*>(progress));
        })
  {
  }
};

/** Records the progress and aborts the filter at StopAt. */
struct ProgressListener
{
  std::vector<double> Shares;
  std::set<std::string> Texts;
  double StopAt = 2.0;

  explicit ProgressListener(vtkAlgorithm* algorithm)
    : Hook(algorithm,
        [this](vtkAlgorithm* filter, const std::string& text, double progress)
        {
          this->Shares.push_back(progress);
          if (!text.empty())
          {
            this->Texts.insert(text);
          }
          if (progress >= this->StopAt)
          {
            filter->SetAbortExecute(1);
          }
        })
  {
  }

  ProgressHook Hook;
};

/** Aborts a filter at the n-th progress event whose text contains a part. */
struct StopAtText
{
  int Left;
  int After = 0; ///< progress events after the request

  StopAtText(vtkAlgorithm* algorithm, const std::string& part, int left)
    : Left(left), Hook(algorithm,
                    [this, part](vtkAlgorithm* filter, const std::string& text, double progress)
                    {
                      // VTK 9.2 reports progress 1 after an abort, too.
                      this->After += this->Left <= 0 && progress < 1.0;
                      if (text.find(part) != std::string::npos && --this->Left == 0)
                      {
                        filter->SetAbortExecute(1);
                      }
                    })
  {
  }

  ProgressHook Hook;
};

/** Expect the error of a filter whose memory ends at a progress text, and an empty output. */
inline void ExpectErrorWithoutMemory(
  vtkAlgorithm* filter, const std::string& at, const std::string& error)
{
  bool hasThrown = false;
  const ProgressHook hook(filter,
    [&](vtkAlgorithm*, const std::string& text, double)
    {
      if (text == at && !std::exchange(hasThrown, true))
      {
        throw std::bad_alloc();
      }
    });
  EXPECT_TRUE(Has(MessagesOfUpdate(filter), error));
  EXPECT_TRUE(hasThrown);
  EXPECT_EQ(SizeOfOutput(filter), 0) << "the output must be empty";
  EXPECT_EQ(filter->GetErrorCode(), static_cast<unsigned long>(vtkErrorCode::UnknownError));
}

/** Return an image with valueAt(i, j, k) at each voxel, first voxel at extent 0. */
inline vtkSmartPointer<vtkImageData> ImageOf(const std::array<int, 3>& size,
  const std::function<double(int, int, int)>& valueAt, int scalarType = VTK_FLOAT,
  const char* name = "Voxels")
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(size.data());
  image->AllocateScalars(scalarType, 1);
  Voxels(image)->SetName(name);
  vtkIdType index = 0;
  ForVoxels(
    size, [&](int i, int j, int k) { Voxels(image)->SetComponent(index++, 0, valueAt(i, j, k)); });
  return image;
}

/** Return an image with random voxels in [0, 100]. */
inline vtkSmartPointer<vtkImageData> RandomImage(int nx, int ny, int nz, int scalarType = VTK_FLOAT)
{
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> value(0.0, 100.0);
  return ImageOf(
    { nx, ny, nz }, [&](int, int, int) { return value(generator); }, scalarType);
}

/**
 * Return a bright ball (100) on background (0) with a ramp of two voxels; iso-value 50.
 * @param radiusShare radius relative to the shortest side
 */
inline vtkSmartPointer<vtkImageData> BallImage(int nx, int ny, int nz, double radiusShare = 0.3)
{
  const double radius = radiusShare * std::min({ nx, ny, nz });
  return ImageOf({ nx, ny, nz },
    [=](int i, int j, int k)
    {
      const double x = i - 0.5 * (nx - 1);
      const double y = j - 0.5 * (ny - 1);
      const double z = k - 0.5 * (nz - 1);
      const double inside = radius - std::sqrt(x * x + y * y + z * z);
      return 100.0 * std::clamp(0.5 + 0.4 * inside, 0.0, 1.0);
    });
}

/** Return the image with its voxels as cells, at the same positions. */
inline vtkSmartPointer<vtkImageData> AsCells(vtkImageData* image)
{
  auto cells = vtkSmartPointer<vtkImageData>::New();
  int extent[6];
  image->GetExtent(extent);
  const double corner[3] = { -0.5, -0.5, -0.5 };
  double origin[3];
  image->TransformContinuousIndexToPhysicalPoint(corner, origin);
  cells->SetExtent(extent[0], extent[1] + 1, extent[2], extent[3] + 1, extent[4], extent[5] + 1);
  cells->SetOrigin(origin);
  cells->SetSpacing(image->GetSpacing());
  cells->SetDirectionMatrix(image->GetDirectionMatrix());
  cells->GetCellData()->SetScalars(image->GetPointData()->GetScalars());
  return cells;
}

/** Set the voxels in [first, end) of an image whose extent begins at 0. */
inline void FillBox(vtkImageData* image, const std::array<int, 3>& first,
  const std::array<int, 3>& end, double value = 100.0)
{
  ForBox(first, end,
    [&](int i, int j, int k) { image->SetScalarComponentFromDouble(i, j, k, 0, value); });
}
}

#endif
