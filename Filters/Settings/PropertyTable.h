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
 * SegmentationSettings with the default, and whether a change needs a new run. Other changes affect
 * the finest level or the outputs only, and reuse the kept run.
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
/**
 * What a setting has of a value that Set gets: an int may stand for an enumeration. An unsigned
 * setting is 0 for negative values.
 */
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

/** What Get returns of a setting. */
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

/** As PrintSelf() tells it: of a list only how many there are. */
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

// As vtkGetMacro() and vtkSetMacro() of vtkSetGet.h, but for where the value is: a member of the
// class, or of what it holds. When it has changed, `modified` is called.
#define VOLUMIC_SET_AND_GET(Class, name, type, setting, modified)                   \
  type Class::Get##name()                                                           \
  {                                                                                 \
    const auto value = volumic::ValueOf<type>(this->setting);                       \
    vtkDebugMacro(<< "returning " #name " of " << value);                           \
    return value;                                                                   \
  }                                                                                 \
  void Class::Set##name(type value)                                                 \
  {                                                                                 \
    auto& now = this->setting;                                                      \
    const auto requested = volumic::SettingOf<std::decay_t<decltype(now)>>(value);  \
    vtkDebugMacro(<< "setting " #name " to " << volumic::ValueOf<type>(requested)); \
    if (now != requested)                                                           \
    {                                                                               \
      now = requested;                                                              \
      modified;                                                                     \
    }                                                                               \
  }

// Set and Get of a deprecated property without effect. Set reports a warning.
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
