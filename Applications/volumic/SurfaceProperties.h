// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceProperties_h
#define volumicSurfaceProperties_h

#include <functional>
#include <string>
#include <vector>

class vtkDeformableSurface;
class vtkImagePyramid;
class vtkLabelsToSurfaces;

namespace tool
{
/** The three filters that the options set properties of. */
struct FilterTrio
{
  vtkImagePyramid* Pyramid = nullptr;
  vtkDeformableSurface* Surface = nullptr;
  vtkLabelsToSurfaces* Labels = nullptr; ///< what it shares with the surface is set there
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
  std::function<std::string(const FilterTrio&)> Get;
  /** @throws UsageError if the text (empty for an option without argument) is no value for it. */
  std::function<void(const FilterTrio&, const std::string& text)> Set;
  bool Given = true; ///< what an option without argument makes of the property
};

/** All of them, in the order of the help. A test holds the list to the filters' Set methods. */
const std::vector<PropertyOption>& SurfaceProperties();

/**
 * A message of a filter, which names properties and inputs as ParaView's panel does, with the
 * options in their place: "Finest Level" becomes "--finest", and "Object Is Bright was on and is
 * off" that --dark "was not given and is".
 */
std::string InWordsOfOptions(const std::string& message);

/** Whether the property means something for the surfaces of labels (--labels). */
bool IsOfLabels(const PropertyOption& option);

/** Whether it means nothing for others. */
bool IsOfLabelsOnly(const PropertyOption& option);

/** Give the labels' filter what it shares with that of the surface. */
void ShareProperties(const FilterTrio& filters);

/** Give a pyramid what it shares with the surface's filter. */
void ShareWithPyramid(vtkDeformableSurface* filter, vtkImagePyramid* pyramid);
}

#endif
