// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMDisplayInitializationHelper.h"

#include "vtkSMVolumicSurfaceRepresentationProxy.h"

#include <vtkObjectFactory.h>
#include <vtkPVXMLElement.h>
#include <vtkSMProperty.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>

#include <cstddef>
#include <iterator>
#include <locale>
#include <sstream>
#include <string>
#include <vector>

vtkStandardNewMacro(vtkSMDisplayInitializationHelper);

namespace
{
std::vector<std::string> Words(const char* text)
{
  std::istringstream stream(text ? text : "");
  return { std::istream_iterator<std::string>(stream), std::istream_iterator<std::string>() };
}

/** As in XML, whatever the locale of the program: a point, not a comma. */
double Number(const std::string& text)
{
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  double number = 0.0;
  stream >> number;
  return number;
}

void SetValues(vtkSMProperty* property, const std::vector<std::string>& values)
{
  vtkSMPropertyHelper helper(property);
  for (unsigned int i = 0; i < values.size(); ++i)
  {
    if (property->IsA("vtkSMStringVectorProperty"))
    {
      helper.Set(i, values[i].c_str());
    }
    else
    {
      helper.Set(i, Number(values[i]));
    }
  }
}

/**
 * Of the tuples that the property holds, replaces those with the same first value, a name; in the
 * place where they are, since ParaView's panel of series goes by the place.
 */
void SetTuples(vtkSMProperty* property, const std::vector<std::string>& values, unsigned int size)
{
  property->ResetToDomainDefaults();
  vtkSMPropertyHelper helper(property);
  for (std::size_t tuple = 0; tuple + size <= values.size(); tuple += size)
  {
    unsigned int place = 0;
    while (place < helper.GetNumberOfElements() && values[tuple] != helper.GetAsString(place))
    {
      place += size;
    }
    for (unsigned int i = 0; i < size; ++i)
    {
      helper.Set(place + i, values[tuple + i].c_str());
    }
  }
}
}

//------------------------------------------------------------------------------
vtkSMDisplayInitializationHelper::vtkSMDisplayInitializationHelper() = default;
vtkSMDisplayInitializationHelper::~vtkSMDisplayInitializationHelper() = default;

//------------------------------------------------------------------------------
void vtkSMDisplayInitializationHelper::PostInitializeProxy(
  vtkSMProxy* proxy, vtkPVXMLElement* xml, vtkMTimeType)
{
  for (unsigned int i = 0; i < xml->GetNumberOfNestedElements(); ++i)
  {
    vtkPVXMLElement* element = xml->GetNestedElement(i);
    const char* name = element->GetAttribute("property");
    if (vtkSMProperty* property = name ? proxy->GetProperty(name) : nullptr)
    {
      const char* text = element->GetAttribute("text");
      const char* values = element->GetAttribute("values");
      int size = 0;
      if (element->GetScalarAttribute("tuple", &size) && size > 0)
      {
        SetTuples(property, Words(values), static_cast<unsigned int>(size));
      }
      else
      {
        SetValues(property, text ? std::vector<std::string>{ text } : Words(values));
      }
    }
  }
  proxy->UpdateVTKObjects();
  if (auto* surface = vtkSMVolumicSurfaceRepresentationProxy::SafeDownCast(proxy))
  {
    surface->StartPresets();
  }
}

//------------------------------------------------------------------------------
void vtkSMDisplayInitializationHelper::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}
