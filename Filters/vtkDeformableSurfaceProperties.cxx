// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// The properties of vtkDeformableSurface: its Set and Get methods write to and read from one
// volumic::SegmentationSettings, and PrintSelf() prints them.

#include "vtkDeformableSurface.h"

#include "vtkDeformableSurfaceInternals.h"

#include <vtkMath.h>

#include <algorithm>
#include <string>
#include <type_traits>
#include <vector>

namespace
{
/** Whether the enumerations of the class, for its users, are those of the settings. */
template <typename Ours>
constexpr bool AreEqual(int theirs, Ours ours)
{
  return theirs == static_cast<int>(ours);
}

using Class = vtkDeformableSurface;

using volumic::InitializationType;
static_assert(
  AreEqual(Class::EnclosingIcosahedron, InitializationType::EnclosingIcosahedron) &&
  AreEqual(Class::Seeds, InitializationType::Seeds) &&
  AreEqual(Class::IsoSurface, InitializationType::IsoSurface) &&
  AreEqual(Class::InputSurface, InitializationType::InputSurface));
static_assert(AreEqual(Class::Voxels, volumic::Metric::Voxels) &&
  AreEqual(Class::World, volumic::Metric::World));
static_assert(AreEqual(Class::Background, volumic::Border::Background) &&
  AreEqual(Class::Replicate, volumic::Border::Replicate));
using volumic::RecoveryType;
static_assert(AreEqual(Class::NoRecovery, RecoveryType::NoRecovery) &&
  AreEqual(Class::RecoverObjects, RecoveryType::RecoverObjects) &&
  AreEqual(Class::RecoverObjectsAndCavities, RecoveryType::RecoverObjectsAndCavities));
using volumic::KeepComponentsType;
static_assert(AreEqual(Class::AllComponents, KeepComponentsType::AllComponents) &&
  AreEqual(Class::LargestComponent, KeepComponentsType::LargestComponent) &&
  AreEqual(Class::ComponentsAtPoints, KeepComponentsType::ComponentsAtPoints) &&
  AreEqual(Class::LargeComponents, KeepComponentsType::LargeComponents));

/** The filter has changed, but what is kept of its last run stays. */
void ModifyEnd(vtkDeformableSurface* filter, volumic::SegmentationCache& cache)
{
  const vtkMTimeType before = filter->GetMTime();
  filter->Modified();
  cache.IgnoreChange(before, filter->GetMTime());
}

/** Changes a property that decides on the end of a run and its outputs only. */
template <typename T>
void ChangeEnd(
  vtkDeformableSurface* filter, volumic::SegmentationCache& cache, T& property, const T& value)
{
  if (property != value)
  {
    property = value;
    ModifyEnd(filter, cache);
  }
}

void CopyPosition(const std::vector<volumic::Point>& positions, int index, double position[3])
{
  if (index >= 0 && index < static_cast<int>(positions.size()))
  {
    std::copy_n(positions[index].begin(), 3, position);
    return;
  }
  std::fill(position, position + 3, vtkMath::Nan());
}
}

//------------------------------------------------------------------------------
// As vtkGetMacro() and vtkSetMacro() of vtkSetGet.h, but for where the value is: `field` of the
// settings. An int may stand for an enumeration there.
#define VolumicGetProperty(name, type, field)                                                      \
  type vtkDeformableSurface::Get##name()                                                           \
  {                                                                                                \
    const auto value = static_cast<type>(this->Internals->Settings.field);                         \
    vtkDebugMacro(<< "returning " #name " of " << value);                                          \
    return value;                                                                                  \
  }
#define VolumicProperty(name, type, field)                                                         \
  VolumicGetProperty(name, type, field)                                                            \
  void vtkDeformableSurface::Set##name(type value)                                                 \
  {                                                                                                \
    vtkDebugMacro(<< "setting " #name " to " << value);                                            \
    auto& property = this->Internals->Settings.field;                                              \
    const auto wanted = static_cast<std::decay_t<decltype(property)>>(value);                      \
    if (property != wanted)                                                                        \
    {                                                                                              \
      property = wanted;                                                                           \
      this->Modified();                                                                            \
    }                                                                                              \
  }
// A property that decides on the end of a run and its outputs only.
#define VolumicEndProperty(name, type)                                                             \
  VolumicGetProperty(name, type, End.name)                                                         \
  void vtkDeformableSurface::Set##name(type value)                                                 \
  {                                                                                                \
    auto& property = this->Internals->Settings.End.name;                                           \
    ChangeEnd(this, this->Internals->Cache, property,                                              \
      static_cast<std::decay_t<decltype(property)>>(value));                                       \
  }
// A list of positions: names of one and of all, and what is called when it has changed.
#define VolumicPositions(one, all, field, modified)                                                \
  void vtkDeformableSurface::Add##one(double x, double y, double z)                                \
  {                                                                                                \
    this->Internals->Settings.field.push_back({ x, y, z });                                        \
    modified;                                                                                      \
  }                                                                                                \
  void vtkDeformableSurface::Clear##all()                                                          \
  {                                                                                                \
    this->Internals->Settings.field.clear();                                                       \
    modified;                                                                                      \
  }                                                                                                \
  int vtkDeformableSurface::GetNumberOf##all()                                                     \
  {                                                                                                \
    return static_cast<int>(this->Internals->Settings.field.size());                               \
  }                                                                                                \
  void vtkDeformableSurface::Get##one(int index, double position[3])                               \
  {                                                                                                \
    CopyPosition(this->Internals->Settings.field, index, position);                                \
  }

VolumicProperty(SelectedComponent, int, SelectedComponent)
VolumicProperty(NaNIsBackground, bool, NaNIsBackground)
VolumicProperty(Metric, int, Metric)
VolumicProperty(EdgeLength, double, EdgeLength)
VolumicProperty(IsoValue, double, Options.IsoValue)
VolumicProperty(ObjectIsBright, bool, Options.ObjectIsBright)
VolumicProperty(Initialization, int, Initialization)
VolumicProperty(SeedRadius, double, Options.SeedRadius)
VolumicProperty(CoarsestLevel, int, CoarsestLevel)
VolumicProperty(SamplingRatio, double, Options.SamplingRatio)
VolumicProperty(TensionWeight, double, Options.TensionWeight)
VolumicProperty(ElasticityWeight, double, Options.ElasticityWeight)
VolumicProperty(IsopotentialWeight, double, Options.IsopotentialWeight)
VolumicProperty(GradientWeight, double, Options.GradientWeight)
VolumicProperty(PointAttractionWeight, double, Options.PointAttractionWeight)
VolumicProperty(EdgeAttractionWeight, double, Options.EdgeAttractionWeight)
VolumicProperty(Friction, double, Options.Friction)
VolumicProperty(BorderValue, int, Options.BorderValue)
VolumicProperty(Recovery, int, Recovery)
VolumicProperty(MinimumPartSize, int, Options.MinimumPartSize)
VolumicProperty(TopologyChanges, bool, Options.TopologyChanges)
VolumicProperty(MaximumNumberOfIterations, int, Options.MaximumNumberOfIterations)
VolumicProperty(ConvergenceTolerance, double, Options.ConvergenceTolerance)
VolumicProperty(FreezeMotionlessVertices, bool, Options.FreezeMotionlessVertices)
VolumicProperty(SnapToIsoValue, bool, Options.SnapToIsoValue)
VolumicProperty(Profile, bool, Profile)
VolumicProperty(SnapshotInterval, int, SnapshotInterval)

VolumicPositions(SeedPosition, SeedPositions, End.SeedPositions,
  this->GetInitialization() == Seeds
    ? this->Modified()
    : ModifyEnd(this, this->Internals->Cache))
VolumicPositions(AttractingPosition, AttractingPositions, AttractingPositions, this->Modified())

VolumicEndProperty(KeepComponents, int)
VolumicEndProperty(MinimumComponentVolume, double)
VolumicEndProperty(FinestLevel, int)
VolumicEndProperty(TimeLimit, double)
VolumicEndProperty(MemoryLimit, int)
VolumicEndProperty(Resume, bool)
VolumicEndProperty(Preview, bool)
VolumicEndProperty(ShowLevels, bool)
VolumicGetProperty(NumberOfThreads, int, End.NumberOfThreads)
void vtkDeformableSurface::SetNumberOfThreads(int number)
{
  vtkInternals& internals = *this->Internals;
  ChangeEnd(this, internals.Cache, internals.Settings.End.NumberOfThreads, std::max(number, 0));
}
void vtkDeformableSurface::SetScratchDirectory(const char* directory)
{
  vtkInternals& internals = *this->Internals;
  ChangeEnd(this, internals.Cache, internals.Settings.End.ScratchDirectory,
    std::string(directory ? directory : ""));
}
const char* vtkDeformableSurface::GetScratchDirectory()
{
  return this->Internals->Settings.End.ScratchDirectory.c_str();
}

//------------------------------------------------------------------------------
void vtkDeformableSurface::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "SelectedComponent: " << this->GetSelectedComponent() << endl;
  os << indent << "NaNIsBackground: " << this->GetNaNIsBackground() << endl;
  os << indent << "Metric: " << this->GetMetric() << endl;
  os << indent << "EdgeLength: " << this->GetEdgeLength() << endl;
  os << indent << "IsoValue: " << this->GetIsoValue() << endl;
  os << indent << "ObjectIsBright: " << this->GetObjectIsBright() << endl;
  os << indent << "Initialization: " << this->GetInitialization() << endl;
  os << indent << "SeedPositions: " << this->GetNumberOfSeedPositions() << endl;
  os << indent << "SeedRadius: " << this->GetSeedRadius() << endl;
  os << indent << "CoarsestLevel: " << this->GetCoarsestLevel() << endl;
  os << indent << "FinestLevel: " << this->GetFinestLevel() << endl;
  os << indent << "SamplingRatio: " << this->GetSamplingRatio() << endl;
  os << indent << "TensionWeight: " << this->GetTensionWeight() << endl;
  os << indent << "ElasticityWeight: " << this->GetElasticityWeight() << endl;
  os << indent << "IsopotentialWeight: " << this->GetIsopotentialWeight() << endl;
  os << indent << "GradientWeight: " << this->GetGradientWeight() << endl;
  os << indent << "PointAttractionWeight: " << this->GetPointAttractionWeight() << endl;
  os << indent << "AttractingPositions: " << this->GetNumberOfAttractingPositions() << endl;
  os << indent << "EdgeAttractionWeight: " << this->GetEdgeAttractionWeight() << endl;
  os << indent << "Friction: " << this->GetFriction() << endl;
  os << indent << "BorderValue: " << this->GetBorderValue() << endl;
  os << indent << "Recovery: " << this->GetRecovery() << endl;
  os << indent << "MinimumPartSize: " << this->GetMinimumPartSize() << endl;
  os << indent << "KeepComponents: " << this->GetKeepComponents() << endl;
  os << indent << "MinimumComponentVolume: " << this->GetMinimumComponentVolume() << endl;
  os << indent << "TopologyChanges: " << this->GetTopologyChanges() << endl;
  os << indent << "MaximumNumberOfIterations: " << this->GetMaximumNumberOfIterations() << endl;
  os << indent << "ConvergenceTolerance: " << this->GetConvergenceTolerance() << endl;
  os << indent << "FreezeMotionlessVertices: " << this->GetFreezeMotionlessVertices() << endl;
  os << indent << "SnapToIsoValue: " << this->GetSnapToIsoValue() << endl;
  os << indent << "NumberOfThreads: " << this->GetNumberOfThreads() << endl;
  os << indent << "MemoryLimit: " << this->GetMemoryLimit() << endl;
  os << indent << "ScratchDirectory: " << this->GetScratchDirectory() << endl;
  os << indent << "Resume: " << this->GetResume() << endl;
  os << indent << "TimeLimit: " << this->GetTimeLimit() << endl;
  os << indent << "Preview: " << this->GetPreview() << endl;
  os << indent << "ShowLevels: " << this->GetShowLevels() << endl;
  os << indent << "Profile: " << this->GetProfile() << endl;
  os << indent << "SnapshotInterval: " << this->GetSnapshotInterval() << endl;
}
