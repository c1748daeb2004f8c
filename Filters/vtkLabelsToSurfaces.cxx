// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkLabelsToSurfaces.h"

#include "Core/Common/FreeMemory.h"
#include "Core/Common/Refuse.h"
#include "Host/Errors.h"
#include "Host/HostThreads.h"
#include "Host/LimitedMemory.h"
#include "Host/Pipeline.h"
#include "Host/ProgressMonitor.h"
#include "Input/InputImage.h"
#include "Input/Workspace.h"
#include "Labels/LabelBlocks.h"
#include "Labels/LabelImage.h"
#include "Labels/LabelInterfaces.h"
#include "Labels/LabelNames.h"
#include "Output/SurfaceOutput.h"
#include "Ranks/Ranks.h"
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
#include <vtkMultiProcessController.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <algorithm>
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
  int NumberOfThreads = 0;
  double TimeLimit = 0.0; ///< seconds; 0: none
  volumic::Deadline Limit; ///< of the run that is under way
  int MemoryLimit = 0;
  std::string ScratchDirectory;
  volumic::LabelNames Names;
  vtkSmartPointer<vtkMultiProcessController> Controller;
  volumic::LimitedMemory Memory;
  bool IsRunning = false;

  /** Choose the labels, and check the properties. Errors are thrown. */
  volumic::LabelChoice Read(vtkDataObject* input, vtkInformation* selection,
    std::optional<volumic::LabelImage>& image, volumic::HostThreads& threads) const;
};

//------------------------------------------------------------------------------
vtkLabelsToSurfaces::vtkLabelsToSurfaces() : Internals(std::make_unique<vtkInternals>())
{
  this->SetNumberOfOutputPorts(2);
  this->SetInputArrayToProcess(
    0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, vtkDataSetAttributes::SCALARS);
  this->Internals->Controller = vtkMultiProcessController::GetGlobalController();
}

vtkLabelsToSurfaces::~vtkLabelsToSurfaces() = default;

//------------------------------------------------------------------------------
// The properties, a line each: name, type for Set and Get, where vtkInternals has it. Set and Get
// are made of them but for those that are written out, and all of PrintSelf().
#define VOLUMIC_LABEL_PROPERTIES(MADE, WRITTEN)                         \
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
  WRITTEN(NumberOfThreads, int, NumberOfThreads)                        \
  MADE(MemoryLimit, int, MemoryLimit)                                   \
  MADE(ScratchDirectory, const char*, ScratchDirectory)

#define VolumicSetting(name, type, field)                                                          \
  VOLUMIC_SET_AND_GET(vtkLabelsToSurfaces, name, type, Internals->field, this->Modified())
#define VolumicWritten(name, type, field)
VOLUMIC_LABEL_PROPERTIES(VolumicSetting, VolumicWritten)

int vtkLabelsToSurfaces::GetNumberOfThreads()
{
  return this->Internals->NumberOfThreads;
}

void vtkLabelsToSurfaces::SetNumberOfThreads(int number)
{
  if (this->Internals->NumberOfThreads != std::max(number, 0))
  {
    this->Internals->NumberOfThreads = std::max(number, 0);
    this->Modified();
  }
}

//------------------------------------------------------------------------------
void vtkLabelsToSurfaces::SetController(vtkMultiProcessController* controller)
{
  if (this->Internals->Controller != controller)
  {
    this->Internals->Controller = controller;
    this->Modified();
  }
}

vtkMultiProcessController* vtkLabelsToSurfaces::GetController()
{
  return this->Internals->Controller;
}

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
  // Whatever it is: VTK's pipeline would run once per leaf of a composite dataset.
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
  volumic::Ranks(this->Internals->Controller, { this, request, input, output }).AskForInputs();
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
bool vtkLabelsToSurfaces::ShowProgress(double share, const std::string& text)
{
  this->SetProgressText(text.c_str());
  this->UpdateProgress(share);
  return !volumic::IsAbortRequested(this) && !this->Internals->Limit.IsOver();
}

//------------------------------------------------------------------------------
void vtkLabelsToSurfaces::MakeSurfaces(volumic::Ranks& ranks, const volumic::FilterCall& call)
{
  auto* output = vtkMultiBlockDataSet::GetData(call.Outputs, 0);
  auto* interfaces = vtkPolyData::GetData(call.Outputs, 1);
  const vtkInternals& internals = *this->Internals;
  if (!(internals.TimeLimit >= 0.0))
  {
    volumic::Refuse("Time Limit is ", internals.TimeLimit, "; it must be 0 (none) or more.");
  }
  this->Internals->Limit = volumic::Deadline(volumic::Deadline::Clock::now(), internals.TimeLimit);
  this->Internals->Memory.Set(internals.MemoryLimit, internals.ScratchDirectory);
  this->ShowProgress(0.0, "Reading the labels");
  volumic::HostThreads threads(internals.NumberOfThreads);
  std::optional<volumic::LabelImage> image;
  const vtkSmartPointer<vtkDataObject> input = volumic::PrefixErrors(
    "Input port 0: ", [&] { return ranks.TakeImages(0); });
  const volumic::LabelChoice choice =
    internals.Read(input, this->GetInputArrayInformation(0), image, threads);
  const std::string aboutScans = image->ScanWarning(internals.BackgroundLabel);
  if (!aboutScans.empty()) // Now: the mesh may take very long.
  {
    vtkWarningMacro("Input port 0: " << aboutScans);
  }
  std::vector<int> objects;
  volumic::LabelMap map = image->MakeMap(
    choice.Labels, choice.IsMerged, internals.BackgroundLabel, objects, threads);
  volumic::LabelInterfaceMaker maker(
    std::move(map), objects, image->Image(), internals.Settings, threads);
  maker.Make(threads,
    [&ranks](double share, const std::string& text) { return ranks.GoOn(share, text); });
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
  // Another process may have stopped it, too.
  const bool isLate = internals.Limit.IsOver() && !volumic::IsAbortRequested(this);
  const std::string stopped =
    isLate ? volumic::TimeLimitReason : Describe(volumic::StopReason::Cancelled);
  const std::string warning = volumic::FillBlocks(
    choice, *image, internals.Settings, maker.Surfaces(threads), output, stopped);
  // At the end: ParaView's message box would cover the progress bar.
  if (!image->Warning().empty())
  {
    vtkWarningMacro("Input port 0: " << image->Warning());
  }
  if (!warning.empty())
  {
    vtkWarningMacro(<< warning);
  }
}

//------------------------------------------------------------------------------
int vtkLabelsToSurfaces::RequestData(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  this->SetErrorCode(vtkErrorCode::NoError);
  const auto show = [this](double share, const std::string& text)
  { return this->ShowProgress(share, text); };
  const volumic::FilterCall call{ this, request, inputVector, outputVector };
  volumic::Ranks ranks(this->Internals->Controller, call, show);
  if (!ranks.AreMany() && !volumic::IsFirstProcess(request, outputVector))
  {
    return 1;
  }
  this->Internals->IsRunning = true;
  // ParaView leaves the flag of an earlier run as it is.
  volumic::ForgetAbort(this);
  volumic::RankWork work;
  work.Deals = volumic::Dealing::FirstHasAll;
  work.OfFirst = [&]
  {
    this->MakeSurfaces(ranks, call);
    for (const std::string& warning : this->Internals->Memory.TakeWarnings())
    {
      vtkWarningMacro(<< warning);
    }
  };
  const volumic::AlgorithmError error = ranks.Run(
    []
    {
      return "Input port 0: the memory does not suffice for the surfaces. Set Finest Level to a "
             "coarser level, or choose fewer Labels.";
    },
    work);
  if (error.Code != vtkErrorCode::NoError)
  {
    this->SetErrorCode(error.Code);
    vtkErrorMacro(<< error.Text);
  }
  volumic::ForgetAbort(this);
  this->Internals->Limit = volumic::Deadline();
  this->Internals->IsRunning = false;
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
#define VolumicPrint(name, type, field)                                                            \
  volumic::PrintSetting(os << indent << #name ": ", this->Internals->field);                       \
  os << endl;
  VOLUMIC_LABEL_PROPERTIES(VolumicPrint, VolumicPrint)
}

// Files may be compiled together.
#undef VolumicSetting
#undef VolumicWritten
#undef VolumicPrint
