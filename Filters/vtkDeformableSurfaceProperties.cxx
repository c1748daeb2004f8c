// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// The Set and Get methods of vtkDeformableSurface, which write and read a
// volumic::SegmentationSettings, and PrintSelf(). All are generated from PropertyTable.h.

#include "vtkDeformableSurface.h"

#include "Host/LargeArrays.h"
#include "Settings/PropertyTable.h"
#include "vtkDeformableSurfaceInternals.h"

#include <vtkMath.h>

#include <algorithm>
#include <vector>

namespace
{
/** Return whether a value of a public enumeration has the same number in the settings. */
template <typename Ours>
constexpr bool AreEqual(int theirs, Ours ours)
{
  return theirs == static_cast<int>(ours);
}

using Class = vtkDeformableSurface;

using volumic::InitializationType;
static_assert(AreEqual(Class::EnclosingIcosahedron, InitializationType::EnclosingIcosahedron) &&
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
#define VolumicSetting(name, type, field, needsRun)                                \
  VOLUMIC_SET_AND_GET(vtkDeformableSurface, name, type, Internals->Settings.field, \
    this->Internals->Modify(needsRun))
#define VolumicWritten(name, type, field, needsRun)
VOLUMIC_SURFACE_PROPERTIES(VolumicSetting, VolumicWritten)

//------------------------------------------------------------------------------
VOLUMIC_DEPRECATED(vtkDeformableSurface, MemoryLimit, int, VOLUMIC_MEMORY_LIMIT_WARNING)
VOLUMIC_DEPRECATED(vtkDeformableSurface, Resume, bool, "The filter keeps its last run by itself.")
VOLUMIC_DEPRECATED(vtkDeformableSurface, Profile, bool, "The history has no more columns.")

//------------------------------------------------------------------------------
// The methods of a list of positions: names of an entry and of the list, member of the settings,
// and whether a change needs a new run.
#define VolumicPositions(one, all, field, needsRun)                  \
  void vtkDeformableSurface::Add##one(double x, double y, double z)  \
  {                                                                  \
    this->Internals->Settings.field.push_back({ x, y, z });          \
    this->Internals->Modify(needsRun);                               \
  }                                                                  \
  void vtkDeformableSurface::Clear##all()                            \
  {                                                                  \
    this->Internals->Settings.field.clear();                         \
    this->Internals->Modify(needsRun);                               \
  }                                                                  \
  int vtkDeformableSurface::GetNumberOf##all()                       \
  {                                                                  \
    return static_cast<int>(this->Internals->Settings.field.size()); \
  }                                                                  \
  void vtkDeformableSurface::Get##one(int index, double position[3]) \
  {                                                                  \
    CopyPosition(this->Internals->Settings.field, index, position);  \
  }
VolumicPositions(SeedPosition, SeedPositions, End.SeedPositions, this->GetInitialization() == Seeds)
  VolumicPositions(AttractingPosition, AttractingPositions, AttractingPositions, true)

  //------------------------------------------------------------------------------
  void vtkDeformableSurface::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
#define VolumicPrint(name, type, field, needsRun)                                     \
  volumic::PrintSetting(os << indent << #name ": ", this->Internals->Settings.field); \
  os << endl;
  VOLUMIC_SURFACE_PROPERTIES(VolumicPrint, VolumicPrint)
  os << indent << "MemoryLimit: " << this->Internals->MemoryLimit << endl;
  os << indent << "Resume: " << this->Internals->Resume << endl;
  os << indent << "Profile: " << this->Internals->Profile << endl;
}

// The source files may be compiled as one (UNITY_BUILD).
#undef VolumicSetting
#undef VolumicWritten
#undef VolumicPositions
#undef VolumicPrint
