// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkLabelsToSurfaces.h"

#include "Core/Common/FreeMemory.h"
#include "Core/Common/ThrowInvalidArgument.h"
#include "Host/Errors.h"
#include "Host/HostThreads.h"
#include "Host/LargeArrays.h"
#include "Host/Pipeline.h"
#include "Host/RunObserver.h"
#include "Input/ComputationalSpace.h"
#include "Input/InputImage.h"
#include "Labels/LabelBlocks.h"
#include "Labels/LabelImage.h"
#include "Labels/LabelInterfaces.h"
#include "Labels/LabelNames.h"
#include "Output/SurfaceOutput.h"
#include "Settings/PropertyTable.h"

#include <vtkCellData.h>
#include <vtkDataObject.h>
#include <vtkDataSetAttributes.h>
#include <vtkErrorCode.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkIntArray.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <algorithm>
#include <exception>
#include <optional>
#include <string>
#include <utility>
#include <vector>

vtkStandardNewMacro(vtkLabelsToSurfaces);

//------------------------------------------------------------------------------
class vtkLabelsToSurfaces::vtkInternals
{
public:
  volumic::LabelSettings Settings;
  std::vector<int> Labels;
  int BackgroundLabel = 0;
  bool Merge = false;
  bool SharedInterfaces = true; ///< has no effect
  unsigned NumberOfThreads = 0;
  double TimeLimit = 0.0; ///< seconds; 0: none
  int MemoryLimit = 0;    ///< has no effect
  std::string ScratchDirectory;
  volumic::LabelNames Names;
  bool IsRunning = false;

  /** Choose the labels, and check the properties. Throw an exception on error. */
  volumic::LabelChoice Read(vtkDataObject* input, vtkInformation* selection,
    std::optional<volumic::LabelImage>& image, volumic::HostThreads& threads) const;
};

//------------------------------------------------------------------------------
vtkLabelsToSurfaces::vtkLabelsToSurfaces() : Internals(std::make_unique<vtkInternals>())
{
  this->SetNumberOfOutputPorts(2);
  this->SetInputArrayToProcess(
    0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, vtkDataSetAttributes::SCALARS);
}

vtkLabelsToSurfaces::~vtkLabelsToSurfaces() = default;

//------------------------------------------------------------------------------
// The properties: name, type of Set and Get, member of vtkInternals. Set, Get and PrintSelf() are
// generated from them.
#define VOLUMIC_LABEL_PROPERTIES(MADE)                                  \
  MADE(BackgroundLabel, int, BackgroundLabel)                           \
  MADE(Merge, bool, Merge)                                              \
  MADE(Smoothing, double, Settings.Smoothing)                           \
  MADE(VoxelTolerance, double, Settings.VoxelTolerance)                 \
  MADE(SharedInterfaces, bool, SharedInterfaces)                        \
  MADE(BoxFaces, int, Settings.BoxFaces)                                \
  MADE(Metric, int, Settings.Metric)                                    \
  MADE(EdgeLength, double, Settings.EdgeLength)                         \
  MADE(Tolerance, double, Settings.Grading.Tolerance)                   \
  MADE(MaximumEdgeLength, double, Settings.Grading.MaximumEdgeLength)   \
  MADE(Gradation, double, Settings.Grading.Gradation)                   \
  MADE(FinestLevel, int, Settings.FinestLevel)                          \
  MADE(KeepComponents, int, Settings.KeepComponents)                    \
  MADE(MinimumComponentVolume, double, Settings.MinimumComponentVolume) \
  MADE(TimeLimit, double, TimeLimit)                                    \
  MADE(NumberOfThreads, int, NumberOfThreads)                           \
  MADE(ScratchDirectory, const char*, ScratchDirectory)

#define VolumicSetting(name, type, field) \
  VOLUMIC_SET_AND_GET(vtkLabelsToSurfaces, name, type, Internals->field, this->Modified())
VOLUMIC_LABEL_PROPERTIES(VolumicSetting)

VOLUMIC_DEPRECATED(vtkLabelsToSurfaces, MemoryLimit, int, VOLUMIC_MEMORY_LIMIT_WARNING)

//------------------------------------------------------------------------------
void vtkLabelsToSurfaces::AddLabel(int label)
{
  this->Internals->Labels.push_back(label);
  this->Modified();
}

void vtkLabelsToSurfaces::ClearLabels()
{
  if (!this->Internals->Labels.empty())
  {
    this->Internals->Labels.clear();
    this->Modified();
  }
}

int vtkLabelsToSurfaces::GetNumberOfLabels()
{
  return static_cast<int>(this->Internals->Labels.size());
}

int vtkLabelsToSurfaces::GetLabel(int index)
{
  return index >= 0 && index < this->GetNumberOfLabels()
    ? this->Internals->Labels[static_cast<std::size_t>(index)]
    : this->Internals->BackgroundLabel;
}

//------------------------------------------------------------------------------
void vtkLabelsToSurfaces::SetLabelName(int label, const char* name)
{
  if (name && *name)
  {
    this->Internals->Names.Names[label] = name;
  }
  else
  {
    this->Internals->Names.Names.erase(label);
  }
  this->Modified();
}

const char* vtkLabelsToSurfaces::GetLabelName(int label)
{
  const auto found = this->Internals->Names.Names.find(label);
  return found == this->Internals->Names.Names.end() ? "" : found->second.c_str();
}

void vtkLabelsToSurfaces::ClearLabelNames()
{
  this->Internals->Names.Names.clear();
  this->Modified();
}

void vtkLabelsToSurfaces::SetLabelColor(int label, double red, double green, double blue)
{
  this->Internals->Names.Colors[label] = { red, green, blue };
  this->Modified();
}

void vtkLabelsToSurfaces::ClearLabelColors()
{
  this->Internals->Names.Colors.clear();
  this->Modified();
}

//------------------------------------------------------------------------------
void vtkLabelsToSurfaces::SetAbortExecute(vtkTypeBool abort)
{
  this->AbortExecute = abort && this->Internals->IsRunning; // See vtkDeformableSurface.
}

//------------------------------------------------------------------------------
int vtkLabelsToSurfaces::FillInputPortInformation(int, vtkInformation* info)
{
  // Accept any type, or the pipeline would run the filter once per leaf of a composite dataset.
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataObject");
  return 1;
}

int vtkLabelsToSurfaces::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkMultiBlockDataSet" : "vtkPolyData");
  return 1;
}

vtkPolyData* vtkLabelsToSurfaces::GetInterfaces()
{
  return vtkPolyData::SafeDownCast(this->GetOutputDataObject(1));
}

//------------------------------------------------------------------------------
int vtkLabelsToSurfaces::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  // All processes need the voxels for the names of the blocks.
  volumic::RequestInputs(this, request, input, output, true);
  return 1;
}

//------------------------------------------------------------------------------
volumic::LabelChoice vtkLabelsToSurfaces::vtkInternals::Read(vtkDataObject* input,
  vtkInformation* selection, std::optional<volumic::LabelImage>& image,
  volumic::HostThreads& threads) const
{
  volumic::LabelChoice choice;
  volumic::PrefixErrors("Input port 0: ",
    [&]
    {
      image.emplace(input, selection, this->BackgroundLabel, threads);
      choice.Labels = image->Choose(this->Labels, this->BackgroundLabel);
      choice.Names = this->Names;
      choice.Names.Complete(volumic::LabelNames::Of(volumic::ImageOf(input)));
      choice.Names.Complete({ image->RenumberedLabels(), {} });
      choice.IsMerged = this->Merge;
      return 0;
    });
  this->Settings.Check(image->Image());
  return choice;
}

//------------------------------------------------------------------------------
void vtkLabelsToSurfaces::MakeSurfaces(
  vtkDataObject* input, vtkInformationVector* outputs, volumic::RunObserver& observer)
{
  auto* output = vtkMultiBlockDataSet::GetData(outputs, 0);
  auto* interfaces = vtkPolyData::GetData(outputs, 1);
  const vtkInternals& internals = *this->Internals;
  const volumic::ScratchMemory scratch(internals.ScratchDirectory);
  observer.ReportProgress(0.0, "Reading the labels");
  volumic::HostThreads threads(internals.NumberOfThreads);
  std::optional<volumic::LabelImage> image;
  const volumic::LabelChoice choice =
    internals.Read(input, this->GetInputArrayInformation(0), image, threads);
  const std::string scanWarning = image->ScanWarning(internals.BackgroundLabel);
  if (!scanWarning.empty()) // Report it before meshing, which may take very long.
  {
    vtkWarningMacro("Input port 0: " << scanWarning);
  }
  std::vector<int> objects;
  volumic::LabelMap map =
    image->MakeMap(choice.Labels, choice.IsMerged, internals.BackgroundLabel, objects, threads);
  volumic::LabelInterfaceMaker maker(
    std::move(map), objects, image->Image(), internals.Settings, threads);
  maker.Make(threads,
    [&observer](double fraction, const std::string& text)
    { return observer.ReportProgress(fraction, text); });
  interfaces->ShallowCopy(maker.Interfaces(choice.FirstLabels(), internals.BackgroundLabel));
  volumic::AddLabelFields(choice, *image, interfaces);
  if (choice.IsMerged)
  {
    vtkDataArray* sides = interfaces->GetCellData()->GetArray("BoundaryLabels");
    vtkNew<vtkIntArray> nearest;
    nearest->SetNumberOfTuples(interfaces->GetNumberOfCells());
    nearest->CopyComponent(0, sides, 0);
    image->FindNearest(interfaces, choice.Labels, nearest);
    sides->CopyComponent(0, nearest, 0);
  }
  observer.Warn(volumic::FillBlocks(
    choice, *image, internals.Settings, maker.Surfaces(threads), output, observer.StopReason()));
  if (!image->Warning().empty())
  {
    observer.Warn("Input port 0: " + image->Warning());
  }
}

//------------------------------------------------------------------------------
void vtkLabelsToSurfaces::MakeEmptyBlocks(vtkInformationVector* input, vtkMultiBlockDataSet* output)
{
  try
  {
    volumic::HostThreads threads(this->Internals->NumberOfThreads);
    std::optional<volumic::LabelImage> image;
    const volumic::LabelChoice choice = this->Internals->Read(
      volumic::WholeInput(input), this->GetInputArrayInformation(0), image, threads);
    volumic::MakeNullBlocks(output, choice.BlockNames());
  }
  catch (const std::exception&)
  {
    output->Initialize(); // The first process reports the error, and has no blocks either.
  }
}

//------------------------------------------------------------------------------
int vtkLabelsToSurfaces::RequestData(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  this->SetErrorCode(vtkErrorCode::NoError);
  auto* output = vtkMultiBlockDataSet::GetData(outputVector, 0);
  if (!volumic::IsFirstProcess(request, outputVector))
  {
    this->MakeEmptyBlocks(inputVector[0], output);
    return 1;
  }
  this->Internals->IsRunning = true;
  std::vector<std::string> warnings;
  this->SetErrorCode(volumic::RunAlgorithm(
    this, outputVector, "",
    []
    {
      return "Input port 0: not enough memory for the surfaces. Set Scratch Directory, set Finest "
             "Level to a coarser level, or crop the image.";
    },
    [&]
    {
      volumic::RunObserver observer(this, this->Internals->TimeLimit, warnings);
      vtkDataObject* input = volumic::PrefixErrors(
        "Input port 0: ", [&] { return volumic::WholeInput(inputVector[0]); });
      this->MakeSurfaces(input, outputVector, observer);
    }));
  this->Internals->IsRunning = false;
  if (this->GetErrorCode() != vtkErrorCode::NoError &&
    !volumic::IsOnlyProcess(request, outputVector))
  {
    this->MakeEmptyBlocks(inputVector[0], output);
  }
  for (const std::string& text : warnings)
  {
    vtkWarningMacro(<< text);
  }
  volumic::GiveBackFreeMemory();
  return 1;
}

//------------------------------------------------------------------------------
void vtkLabelsToSurfaces::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Labels:";
  for (const int label : this->Internals->Labels)
  {
    os << " " << label;
  }
  os << endl;
#define VolumicPrint(name, type, field)                                      \
  volumic::PrintSetting(os << indent << #name ": ", this->Internals->field); \
  os << endl;
  VOLUMIC_LABEL_PROPERTIES(VolumicPrint)
  os << indent << "MemoryLimit: " << this->Internals->MemoryLimit << endl;
}

// The source files may be compiled as one (UNITY_BUILD).
#undef VolumicSetting
#undef VolumicPrint
