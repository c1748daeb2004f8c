// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// The properties of vtkDeformableSurface: its Set and Get methods write to and read from one
// volumic::SegmentationSettings, and PrintSelf() prints them, by the lines of PropertyTable.h.

#include "vtkDeformableSurface.h"

#include "Settings/PropertyTable.h"
#include "vtkDeformableSurfaceInternals.h"

#include <vtkMath.h>

#include <algorithm>
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
  AreEqual(Class::LargeComponents, KeepComponentsType::LargeComponents) &&
  AreEqual(Class::ComponentsNotAtSeeds, KeepComponentsType::ComponentsNotAtSeeds));

/** What a property decides on, see PropertyTable.h. */
enum class Change
{
  Run,
  End
};

/** The filter has changed. What is kept of its last run stays where only the end of one has. */
void Modify(vtkDeformableSurface* filter, volumic::SegmentationCache& cache, Change what)
{
  const vtkMTimeType before = filter->GetMTime();
  filter->Modified();
  if (what == Change::End)
  {
    cache.IgnoreChange(before, filter->GetMTime());
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
#define VolumicSetting(name, type, field, change)                                                  \
  VOLUMIC_SET_AND_GET(vtkDeformableSurface, name, type, Internals->Settings.field,                            \
    Modify(this, this->Internals->Cache, Change::change))
#define VolumicWritten(name, type, field, change)
VOLUMIC_SURFACE_PROPERTIES(VolumicSetting, VolumicWritten)

int vtkDeformableSurface::GetNumberOfThreads()
{
  return this->Internals->Settings.End.NumberOfThreads;
}

void vtkDeformableSurface::SetNumberOfThreads(int number)
{
  int& threads = this->Internals->Settings.End.NumberOfThreads;
  if (threads != std::max(number, 0))
  {
    threads = std::max(number, 0);
    Modify(this, this->Internals->Cache, Change::End);
  }
}

//------------------------------------------------------------------------------
bool vtkDeformableSurface::GetResume()
{
  return this->Internals->Resume;
}

void vtkDeformableSurface::SetResume(bool resume)
{
  if (resume && !this->Internals->Resume)
  {
    vtkWarningMacro(
      "Resume is deprecated and has no effect: no run resumes one of another process.");
  }
  this->Internals->Resume = resume;
}

//------------------------------------------------------------------------------
// A list of positions: names of one and of all, where it is, and what it decides on.
#define VolumicPositions(one, all, field, change)                                                  \
  void vtkDeformableSurface::Add##one(double x, double y, double z)                                \
  {                                                                                                \
    this->Internals->Settings.field.push_back({ x, y, z });                                        \
    Modify(this, this->Internals->Cache, change);                                                  \
  }                                                                                                \
  void vtkDeformableSurface::Clear##all()                                                          \
  {                                                                                                \
    this->Internals->Settings.field.clear();                                                       \
    Modify(this, this->Internals->Cache, change);                                                  \
  }                                                                                                \
  int vtkDeformableSurface::GetNumberOf##all()                                                     \
  {                                                                                                \
    return static_cast<int>(this->Internals->Settings.field.size());                               \
  }                                                                                                \
  void vtkDeformableSurface::Get##one(int index, double position[3])                               \
  {                                                                                                \
    CopyPosition(this->Internals->Settings.field, index, position);                                \
  }
VolumicPositions(SeedPosition, SeedPositions, End.SeedPositions,
  this->GetInitialization() == Seeds ? Change::Run : Change::End)
VolumicPositions(AttractingPosition, AttractingPositions, AttractingPositions, Change::Run)

//------------------------------------------------------------------------------
void vtkDeformableSurface::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
#define VolumicPrint(name, type, field, change)                                                    \
  volumic::PrintSetting(os << indent << #name ": ", this->Internals->Settings.field);              \
  os << endl;
  VOLUMIC_SURFACE_PROPERTIES(VolumicPrint, VolumicPrint)
  os << indent << "Resume: " << this->Internals->Resume << endl;
}

// Files may be compiled together.
#undef VolumicSetting
#undef VolumicWritten
#undef VolumicPositions
#undef VolumicPrint
