// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicPropertyTable_h
#define volumicPropertyTable_h

#include "Core/Common/IndexedSurface.h"
#include "Settings/SegmentationSettings.h"

#include <ostream>
#include <string>
#include <type_traits>
#include <vector>

/**
 * The properties of vtkDeformableSurface, a line each: its name, its type for Set and Get, where
 * SegmentationSettings has it with its default, and what a Set changes: the Run, which must begin
 * anew; or its End and its outputs only, so that what is kept of the last run serves.
 *
 * Of the lines PrintSelf() and, but for those that are WRITTEN out, Set and Get are MADE. That all
 * Set methods have a line is tested (Testing/Python/test_reference.py).
 */
#define VOLUMIC_SURFACE_PROPERTIES(MADE, WRITTEN)                              \
  MADE(SelectedComponent, int, SelectedComponent, Run)                         \
  MADE(NaNIsBackground, bool, NaNIsBackground, Run)                            \
  MADE(Metric, int, Metric, Run)                                               \
  MADE(EdgeLength, double, EdgeLength, Run)                                    \
  MADE(Tolerance, double, Grading.Tolerance, Run)                              \
  MADE(MaximumEdgeLength, double, Grading.MaximumEdgeLength, Run)              \
  MADE(Gradation, double, Grading.Gradation, Run)                              \
  MADE(ThinParts, bool, Grading.ThinParts, Run)                                \
  MADE(IsoValue, double, Options.IsoValue, Run)                                \
  MADE(UpperValue, double, UpperValue, Run)                                    \
  MADE(UseUpperValue, bool, UseUpperValue, Run)                                \
  MADE(ObjectIsBright, bool, Options.ObjectIsBright, Run)                      \
  MADE(Initialization, int, Initialization, Run)                               \
  WRITTEN(SeedPositions, list, End.SeedPositions, End)                         \
  MADE(SeedRadius, double, Options.SeedRadius, Run)                            \
  MADE(CoarsestLevel, int, CoarsestLevel, Run)                                 \
  MADE(FinestLevel, int, End.FinestLevel, End)                                 \
  MADE(SamplingRatio, double, Options.SamplingRatio, Run)                      \
  MADE(TensionWeight, double, Options.TensionWeight, Run)                      \
  MADE(ElasticityWeight, double, Options.ElasticityWeight, Run)                \
  MADE(IsopotentialWeight, double, Options.IsopotentialWeight, Run)            \
  MADE(GradientWeight, double, Options.GradientWeight, Run)                    \
  MADE(PointAttractionWeight, double, Options.PointAttractionWeight, Run)      \
  WRITTEN(AttractingPositions, list, AttractingPositions, Run)                 \
  MADE(EdgeAttractionWeight, double, Options.EdgeAttractionWeight, Run)        \
  MADE(Friction, double, Options.Friction, Run)                                \
  MADE(BorderValue, int, Options.BorderValue, Run)                             \
  MADE(Recovery, int, Recovery, Run)                                           \
  MADE(MinimumPartSize, int, Options.MinimumPartSize, Run)                     \
  MADE(KeepComponents, int, End.KeepComponents, End)                           \
  MADE(MinimumComponentVolume, double, End.MinimumComponentVolume, End)        \
  MADE(TopologyChanges, bool, Options.TopologyChanges, Run)                    \
  MADE(MaximumNumberOfIterations, int, Options.MaximumNumberOfIterations, Run) \
  MADE(ConvergenceTolerance, double, Options.ConvergenceTolerance, Run)        \
  MADE(FreezeMotionlessVertices, bool, Options.FreezeMotionlessVertices, Run)  \
  MADE(SnapToIsoValue, bool, Options.SnapToIsoValue, Run)                      \
  WRITTEN(NumberOfThreads, int, End.NumberOfThreads, End)                      \
  MADE(ScratchDirectory, const char*, End.ScratchDirectory, End)               \
  MADE(TimeLimit, double, End.TimeLimit, End)                                  \
  MADE(Preview, bool, End.Preview, End)                                        \
  MADE(ShowLevels, bool, End.ShowLevels, End)                                  \
  MADE(Profile, bool, Profile, Run)                                            \
  MADE(SnapshotInterval, int, SnapshotInterval, Run)

namespace volumic
{
/** What a setting has of a value that Set gets: an int may stand for an enumeration. */
template <typename Setting, typename Value>
Setting SettingOf(Value value)
{
  if constexpr (std::is_same_v<Setting, std::string>)
  {
    return value ? value : "";
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
#define VOLUMIC_SET_AND_GET(Class, name, type, setting, modified)                \
  type Class::Get##name()                                                        \
  {                                                                              \
    const auto value = volumic::ValueOf<type>(this->setting);                    \
    vtkDebugMacro(<< "returning " #name " of " << value);                        \
    return value;                                                                \
  }                                                                              \
  void Class::Set##name(type value)                                              \
  {                                                                              \
    auto& now = this->setting;                                                   \
    const auto wanted = volumic::SettingOf<std::decay_t<decltype(now)>>(value);  \
    vtkDebugMacro(<< "setting " #name " to " << volumic::ValueOf<type>(wanted)); \
    if (now != wanted)                                                           \
    {                                                                            \
      now = wanted;                                                              \
      modified;                                                                  \
    }                                                                            \
  }

#endif
