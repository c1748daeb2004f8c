// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceProperties_h
#define volumicSurfaceProperties_h

#include <functional>
#include <string>
#include <vector>

class vtkDeformableSurface;
class vtkImagePyramid;

namespace tool
{
/** The two filters that the options set properties of. */
struct FilterPair
{
  vtkImagePyramid* Pyramid = nullptr;
  vtkDeformableSurface* Surface = nullptr;
};

/** An option of the command line that stands for a property of a filter. */
struct PropertyOption
{
  std::string Option;   ///< without dashes
  std::string Argument; ///< its name in the help; empty for an option without argument
  std::string Class;    ///< the filter's
  std::string Property; ///< as in Set..., Get...
  std::string Help;
  /** The value of the property as text that Set would take. */
  std::function<std::string(const FilterPair&)> Get;
  /** @throws UsageError if the text (empty for an option without argument) is no value for it. */
  std::function<void(const FilterPair&, const std::string& text)> Set;
};

/** All of them, in the order of the help. A test holds the list to the filters' Set methods. */
const std::vector<PropertyOption>& SurfaceProperties();
}

#endif
