// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Each property has its own setting and an effect. The tests of the core check which one.
#include "Settings/PropertyTable.h"
#include "SurfaceTestTools.h"

#include <sstream>
#include <type_traits>

using namespace volumic;

namespace
{
/** A property as a number, and a value that is not its default. */
struct Property
{
  std::string Name;
  std::function<void(vtkDeformableSurface&)> Set;
  std::function<double(vtkDeformableSurface&)> Get;
  double Value;
};

/** Return another value than the current one that is printed exactly. */
template <typename T>
T AnotherThan(T value)
{
  if constexpr (std::is_same_v<T, double>)
  {
    return std::isnan(value) ? 7.0 : value != 0.375 ? 0.375 : 0.25;
  }
  return std::is_same_v<T, bool> ? !value : value + 1;
}

template <typename T>
Property MakeProperty(
  const char* name, void (vtkDeformableSurface::*set)(T), T (vtkDeformableSurface::*get)())
{
  const T value = AnotherThan((vtkSmartPointer<vtkDeformableSurface>::New()->*get)());
  return { name, [set, value](vtkDeformableSurface& f) { (f.*set)(value); },
    [get](vtkDeformableSurface& f) { return static_cast<double>((f.*get)()); },
    static_cast<double>(value) };
}

/** The numbers of the table; texts and lists are tested elsewhere. */
std::vector<Property> AllProperties()
{
  std::vector<Property> all;
  const auto add = [&all](const char* name, auto set, auto get)
  {
    if constexpr (!std::is_same_v<decltype(get), const char* (vtkDeformableSurface::*)()>)
    {
      all.push_back(MakeProperty(name, set, get));
    }
  };
#define VOLUMIC_MADE(name, type, member, needsRun) \
  add(#name, &vtkDeformableSurface::Set##name, &vtkDeformableSurface::Get##name);
#define VOLUMIC_WRITTEN(name, type, member, needsRun)
  VOLUMIC_SURFACE_PROPERTIES(VOLUMIC_MADE, VOLUMIC_WRITTEN)
#undef VOLUMIC_WRITTEN
#undef VOLUMIC_MADE
  add("NumberOfThreads", &vtkDeformableSurface::SetNumberOfThreads,
    &vtkDeformableSurface::GetNumberOfThreads);
  return all;
}
}

TEST(DeformableSurfaceProperties, EachHasItsOwnValue)
{
  const std::vector<Property> all = AllProperties();
  ASSERT_GT(all.size(), 35u);
  const auto usual = vtkSmartPointer<vtkDeformableSurface>::New();
  for (const Property& changed : all)
  {
    const auto filter = vtkSmartPointer<vtkDeformableSurface>::New();
    ASSERT_NE(changed.Get(*filter), changed.Value) << changed.Name;
    const vtkMTimeType before = filter->GetMTime();
    changed.Set(*filter);
    const vtkMTimeType after = filter->GetMTime();
    EXPECT_GT(after, before) << changed.Name;
    changed.Set(*filter);
    EXPECT_EQ(filter->GetMTime(), after) << changed.Name;
    for (const Property& other : all)
    {
      const double expected = other.Name == changed.Name ? changed.Value : other.Get(*usual);
      const double now = other.Get(*filter);
      EXPECT_TRUE(now == expected || (std::isnan(now) && std::isnan(expected)))
        << changed.Name << ", " << other.Name;
    }
    std::ostringstream printed;
    std::ostringstream line;
    filter->Print(printed);
    line << "  " << changed.Name << ": " << changed.Value << "\n";
    EXPECT_TRUE(Has(printed.str(), line.str())) << line.str();
  }
}

TEST(DeformableSurfaceProperties, EachReachesTheSurface)
{
  using Setter = std::function<void(vtkDeformableSurface&)>;
  const auto surfaceWith = [](const Setter& change)
  {
    const auto filter = FilterOf(BallImage(30, 30, 30));
    filter->SetCoarsestLevel(0);
    change(*filter);
    filter->Update();
    EXPECT_GT(filter->GetOutput()->GetNumberOfPoints(), 100);
    return filter;
  };
  const Setter setters[] = { [](vtkDeformableSurface&) {},
    [](vtkDeformableSurface& f) { f.SetTensionWeight(0.5); },
    [](vtkDeformableSurface& f) { f.SetElasticityWeight(0.3); },
    [](vtkDeformableSurface& f) { f.SetIsopotentialWeight(0.7); },
    [](vtkDeformableSurface& f) { f.SetGradientWeight(0.2); },
    [](vtkDeformableSurface& f) { f.SetFriction(6.); },
    [](vtkDeformableSurface& f) { f.SetMaximumNumberOfIterations(7); },
    [](vtkDeformableSurface& f) { f.FreezeMotionlessVerticesOff(); },
    [](vtkDeformableSurface& f)
    {
      f.FreezeMotionlessVerticesOff(); // Else it ends as soon as nothing moves.
      f.SetConvergenceTolerance(0.1);
    },
    [](vtkDeformableSurface& f) { f.SnapToIsoValueOff(); },
    [](vtkDeformableSurface& f) { f.SetSamplingRatio(0.7); } };
  std::vector<vtkSmartPointer<vtkDeformableSurface>> surfaces;
  for (const Setter& set : setters)
  {
    const auto surface = surfaceWith(set);
    for (std::size_t n = 0; n < surfaces.size(); ++n)
    {
      EXPECT_FALSE(AreSameSurfaces(surfaces[n]->GetOutput(), surface->GetOutput()))
        << n << ", " << surfaces.size();
    }
    surfaces.push_back(surface);
  }
}
