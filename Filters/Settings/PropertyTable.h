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
 * SegmentationSettings has it with its default, and
 * - what a Set changes: the Run, which must begin anew; or its End and its outputs only, so that
 *   what is kept of the last run serves;
 * - its part in the fingerprint of a run: Told with both values where another run had another one;
 *   Hidden, where such values would tell nobody anything; or Free to be another one when a run is
 *   resumed.
 *
 * Of the lines PrintSelf(), RunFingerprint and, but for those that are WRITTEN out, Set and Get are
 * MADE. That all Set methods have a line is tested (Testing/Python/test_reference.py).
 */
#define VOLUMIC_SURFACE_PROPERTIES(MADE, WRITTEN)                                    \
  MADE(SelectedComponent, int, SelectedComponent, Run, Free)                         \
  MADE(NaNIsBackground, bool, NaNIsBackground, Run, Told)                            \
  MADE(Metric, int, Metric, Run, Hidden)                                             \
  MADE(EdgeLength, double, EdgeLength, Run, Told)                                    \
  MADE(Tolerance, double, Grading.Tolerance, Run, Told)                              \
  MADE(MaximumEdgeLength, double, Grading.MaximumEdgeLength, Run, Told)              \
  MADE(Gradation, double, Grading.Gradation, Run, Told)                              \
  MADE(ThinParts, bool, Grading.ThinParts, Run, Told)                                \
  MADE(IsoValue, double, Options.IsoValue, Run, Told)                                \
  MADE(UpperValue, double, UpperValue, Run, Told)                                    \
  MADE(UseUpperValue, bool, UseUpperValue, Run, Told)                                \
  MADE(ObjectIsBright, bool, Options.ObjectIsBright, Run, Told)                      \
  MADE(Initialization, int, Initialization, Run, Hidden)                             \
  WRITTEN(SeedPositions, list, End.SeedPositions, End, Hidden)                       \
  MADE(SeedRadius, double, Options.SeedRadius, Run, Hidden)                          \
  MADE(CoarsestLevel, int, CoarsestLevel, Run, Told)                                 \
  MADE(FinestLevel, int, End.FinestLevel, End, Free)                                 \
  MADE(SamplingRatio, double, Options.SamplingRatio, Run, Told)                      \
  MADE(TensionWeight, double, Options.TensionWeight, Run, Told)                      \
  MADE(ElasticityWeight, double, Options.ElasticityWeight, Run, Told)                \
  MADE(IsopotentialWeight, double, Options.IsopotentialWeight, Run, Told)            \
  MADE(GradientWeight, double, Options.GradientWeight, Run, Told)                    \
  MADE(PointAttractionWeight, double, Options.PointAttractionWeight, Run, Told)      \
  WRITTEN(AttractingPositions, list, AttractingPositions, Run, Hidden)               \
  MADE(EdgeAttractionWeight, double, Options.EdgeAttractionWeight, Run, Told)        \
  MADE(Friction, double, Options.Friction, Run, Told)                                \
  MADE(BorderValue, int, Options.BorderValue, Run, Hidden)                           \
  MADE(Recovery, int, Recovery, Run, Hidden)                                         \
  MADE(MinimumPartSize, int, Options.MinimumPartSize, Run, Told)                     \
  MADE(KeepComponents, int, End.KeepComponents, End, Hidden)                         \
  MADE(MinimumComponentVolume, double, End.MinimumComponentVolume, End, Told)        \
  MADE(TopologyChanges, bool, Options.TopologyChanges, Run, Told)                    \
  MADE(MaximumNumberOfIterations, int, Options.MaximumNumberOfIterations, Run, Told) \
  MADE(ConvergenceTolerance, double, Options.ConvergenceTolerance, Run, Told)        \
  MADE(FreezeMotionlessVertices, bool, Options.FreezeMotionlessVertices, Run, Told)  \
  MADE(SnapToIsoValue, bool, Options.SnapToIsoValue, Run, Told)                      \
  WRITTEN(NumberOfThreads, int, End.NumberOfThreads, End, Free)                      \
  MADE(MemoryLimit, int, End.MemoryLimit, End, Free)                                 \
  MADE(ScratchDirectory, const char*, End.ScratchDirectory, End, Free)               \
  MADE(Resume, bool, End.Resume, End, Free)                                          \
  MADE(TimeLimit, double, End.TimeLimit, End, Free)                                  \
  MADE(Preview, bool, End.Preview, End, Free)                                        \
  MADE(ShowLevels, bool, End.ShowLevels, End, Free)                                  \
  WRITTEN(Profile, bool, Profile, End, Free)                                         \
  MADE(SnapshotInterval, int, SnapshotInterval, Run, Told)

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
