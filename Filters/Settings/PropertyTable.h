// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicPropertyTable_h
#define volumicPropertyTable_h

#include "Core/Common/IndexedSurface.h"
#include "Settings/SegmentationSettings.h"

#include <algorithm>
#include <ostream>
#include <string>
#include <type_traits>
#include <vector>

/**
 * The properties of vtkDeformableSurface, one per line: name, type of Set and Get, member of
 * SegmentationSettings, and whether a change needs a new run. Other changes affect only the finest
 * level or the outputs, and reuse the kept run.
 *
 * PrintSelf() is generated from all lines, Set and Get from the lines with MADE.
 * Testing/Python/test_reference.py checks that each Set method has a line.
 */
#define VOLUMIC_SURFACE_PROPERTIES(MADE, WRITTEN)                               \
  MADE(SelectedComponent, int, SelectedComponent, true)                         \
  MADE(NaNIsBackground, bool, NaNIsBackground, true)                            \
  MADE(Metric, int, Metric, true)                                               \
  MADE(EdgeLength, double, EdgeLength, true)                                    \
  MADE(Tolerance, double, Grading.Tolerance, true)                              \
  MADE(MaximumEdgeLength, double, Grading.MaximumEdgeLength, true)              \
  MADE(Gradation, double, Grading.Gradation, true)                              \
  MADE(ThinParts, bool, Grading.ThinParts, true)                                \
  MADE(IsoValue, double, Options.IsoValue, true)                                \
  MADE(UpperValue, double, UpperValue, true)                                    \
  MADE(UseUpperValue, bool, UseUpperValue, true)                                \
  MADE(ObjectIsBright, bool, Options.ObjectIsBright, true)                      \
  MADE(Initialization, int, Initialization, true)                               \
  WRITTEN(SeedPositions, list, End.SeedPositions, false)                        \
  MADE(SeedRadius, double, Options.SeedRadius, true)                            \
  MADE(CoarsestLevel, int, CoarsestLevel, true)                                 \
  MADE(FinestLevel, int, End.FinestLevel, false)                                \
  MADE(SamplingRatio, double, Options.SamplingRatio, true)                      \
  MADE(TensionWeight, double, Options.TensionWeight, true)                      \
  MADE(ElasticityWeight, double, Options.ElasticityWeight, true)                \
  MADE(IsopotentialWeight, double, Options.IsopotentialWeight, true)            \
  MADE(GradientWeight, double, Options.GradientWeight, true)                    \
  MADE(PointAttractionWeight, double, Options.PointAttractionWeight, true)      \
  WRITTEN(AttractingPositions, list, AttractingPositions, true)                 \
  MADE(EdgeAttractionWeight, double, Options.EdgeAttractionWeight, true)        \
  MADE(Friction, double, Options.Friction, true)                                \
  MADE(BorderValue, int, Options.BorderValue, true)                             \
  MADE(Recovery, int, Recovery, true)                                           \
  MADE(MinimumPartSize, int, Options.MinimumPartSize, true)                     \
  MADE(KeepComponents, int, End.KeepComponents, false)                          \
  MADE(MinimumComponentVolume, double, End.MinimumComponentVolume, false)       \
  MADE(TopologyChanges, bool, Options.TopologyChanges, true)                    \
  MADE(MaximumNumberOfIterations, int, Options.MaximumNumberOfIterations, true) \
  MADE(ConvergenceTolerance, double, Options.ConvergenceTolerance, true)        \
  MADE(FreezeMotionlessVertices, bool, Options.FreezeMotionlessVertices, true)  \
  MADE(SnapToIsoValue, bool, Options.SnapToIsoValue, true)                      \
  MADE(NumberOfThreads, int, End.NumberOfThreads, false)                        \
  MADE(ScratchDirectory, const char*, End.ScratchDirectory, false)              \
  MADE(TimeLimit, double, End.TimeLimit, false)                                 \
  MADE(Preview, bool, End.Preview, false)                                       \
  MADE(ShowLevels, bool, End.ShowLevels, false)                                 \
  MADE(SnapshotInterval, int, SnapshotInterval, true)

namespace volumic
{
/** Convert the value of a property to its setting. A negative value of an unsigned setting is 0. */
template <typename Setting, typename Value>
Setting SettingOf(Value value)
{
  if constexpr (std::is_same_v<Setting, std::string>)
  {
    return value ? value : "";
  }
  else if constexpr (std::is_same_v<Setting, unsigned>)
  {
    return static_cast<unsigned>(std::max(value, 0));
  }
  else
  {
    return static_cast<Setting>(value);
  }
}

/** Convert a setting to the value of its property. */
template <typename Value, typename Setting>
Value ValueOf(const Setting& setting)
{
  if constexpr (std::is_same_v<Setting, std::string>)
  {
    return setting.c_str();
  }
  else
  {
    return static_cast<Value>(setting);
  }
}

/** Print a setting. Of a list print the number of entries. */
template <typename Setting>
void PrintSetting(std::ostream& os, const Setting& setting)
{
  if constexpr (std::is_same_v<Setting, std::vector<Point>>)
  {
    os << setting.size();
  }
  else if constexpr (std::is_enum_v<Setting>)
  {
    os << static_cast<int>(setting);
  }
  else
  {
    os << setting;
  }
}
}

// Define Get and Set as vtkGetMacro() and vtkSetMacro() do, for a setting that may be a member of a
// member. Set executes `modified` if the value changes.
#define VOLUMIC_SET_AND_GET(Class, name, type, setting, modified)                      \
  type Class::Get##name()                                                              \
  {                                                                                    \
    const auto value = volumic::ValueOf<type>(this->setting);                          \
    vtkDebugMacro(<< "returning " #name " of " << value);                              \
    return value;                                                                      \
  }                                                                                    \
  void Class::Set##name(type value)                                                    \
  {                                                                                    \
    auto& current = this->setting;                                                     \
    const auto requested = volumic::SettingOf<std::decay_t<decltype(current)>>(value); \
    vtkDebugMacro(<< "setting " #name " to " << volumic::ValueOf<type>(requested));    \
    if (current != requested)                                                          \
    {                                                                                  \
      current = requested;                                                             \
      modified;                                                                        \
    }                                                                                  \
  }

// Define Get and Set of a deprecated property without effect. Set reports a warning.
#define VOLUMIC_DEPRECATED(Class, name, type, text)                     \
  type Class::Get##name()                                               \
  {                                                                     \
    return this->Internals->name;                                       \
  }                                                                     \
  void Class::Set##name(type value)                                     \
  {                                                                     \
    if (value != type() && this->Internals->name == type())             \
    {                                                                   \
      vtkWarningMacro(#name " is deprecated and has no effect. " text); \
    }                                                                   \
    this->Internals->name = value;                                      \
  }

#endif
