// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "WorldSpace.h"

#include "Texts.h"
#include "ToolErrors.h"
#include "VolumeImage.h"

#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkMatrix3x3.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace tool
{
namespace
{
/** Powers of ten of a metre. */
const std::map<std::string, int>& Units()
{
  static const std::map<std::string, int> units = { { "m", 0 }, { "cm", -2 }, { "mm", -3 },
    { "um", -6 }, { "nm", -9 }, { "A", -10 } };
  return units;
}

/** How many of a unit another one is. */
double FactorBetween(const std::string& from, const std::string& to)
{
  return std::pow(10.0, Units().at(from) - Units().at(to));
}

/** What the unit is after lengths were multiplied by a factor; empty: it has no name. */
std::string UnitAfter(const std::string& unit, double factor)
{
  const auto found = std::find_if(Units().begin(), Units().end(),
    [&](const auto& other) { return !unit.empty() && FactorBetween(unit, other.first) == factor; });
  return found == Units().end() ? "" : found->first;
}

void ScaleImage(vtkImageData* image, double scale)
{
  Vector3 spacing;
  Vector3 origin;
  image->GetSpacing(spacing.data());
  image->GetOrigin(origin.data());
  for (std::size_t k = 0; k < 3; ++k)
  {
    spacing[k] *= scale;
    origin[k] *= scale;
  }
  image->SetSpacing(spacing.data());
  image->SetOrigin(origin.data());
}

/** What turns coordinates whose axes point to some sides into those of others. */
vtkSmartPointer<vtkMatrix3x3> TurnBetween(const std::string& from, const std::string& to)
{
  static const std::string sides = "LRAPSI"; // Opposite ones stand side by side.
  auto turn = vtkSmartPointer<vtkMatrix3x3>::New();
  turn->Zero();
  for (int row = 0; row < 3; ++row)
  {
    for (int column = 0; column < 3; ++column)
    {
      const std::size_t wanted = sides.find(to[static_cast<std::size_t>(row)]);
      const std::size_t there = sides.find(from[static_cast<std::size_t>(column)]);
      turn->SetElement(row, column, wanted == there ? 1.0 : wanted / 2 == there / 2 ? -1.0 : 0.0);
    }
  }
  return turn;
}

void TurnImage(vtkImageData* image, vtkMatrix3x3* turn)
{
  vtkNew<vtkMatrix3x3> direction;
  vtkMatrix3x3::Multiply3x3(turn, image->GetDirectionMatrix(), direction);
  double origin[3];
  turn->MultiplyPoint(image->GetOrigin(), origin);
  for (double& place : origin)
  {
    place += 0.0; // No -0, which other writers would show.
  }
  image->SetOrigin(origin);
  image->SetDirectionMatrix(direction);
}

/** The factor that the options ask for. */
double ScaleOf(const WorldChoice& choice, const std::string& unit)
{
  if (choice.Unit.empty())
  {
    return choice.Scale.value_or(1.0);
  }
  FailIf(unit.empty(),
    "--unit " + choice.Unit +
      ": the file does not tell the unit that it has; give the factor by --scale instead, such as "
      "--scale 0.001 for millimetres of a file in micrometres");
  return FactorBetween(unit, choice.Unit);
}
}

std::string LengthUnitOf(const std::string& name)
{
  static const std::map<std::string, std::string> others = { { "metre", "m" }, { "meter", "m" },
    { "metres", "m" }, { "meters", "m" }, { "centimetre", "cm" }, { "centimeter", "cm" },
    { "millimetre", "mm" }, { "millimeter", "mm" }, { "millimetres", "mm" },
    { "millimeters", "mm" }, { "micrometre", "um" }, { "micrometer", "um" },
    { "micrometres", "um" }, { "micrometers", "um" }, { "micron", "um" }, { "microns", "um" },
    { "\xC2\xB5m", "um" }, { "\xCE\xBCm", "um" }, { "\xB5m", "um" }, { "\\u00b5m", "um" },
    { "nanometre", "nm" }, { "nanometer", "nm" }, { "angstrom", "A" }, { "\xC3\x85", "A" } };
  if (Units().count(name) > 0)
  {
    return name;
  }
  const auto found = others.find(Lower(name));
  return found == others.end() ? "" : found->second;
}

std::string WorldSpace::Text() const
{
  const auto told = [](const std::string& what, const std::string& is, const std::string& was)
  {
    return (is.empty() ? "" : (what + is)) +
      (is == was || was.empty() ? "" : " (of the file: " + was + ")");
  };
  const std::string axes = told("space ", this->Axes, this->FileAxes);
  const std::string unit = told("unit ", this->Unit, this->FileUnit);
  const std::string scale =
    this->Scale == 1.0 ? "" : "lengths of the file times " + NumberText(this->Scale);
  std::string text;
  for (const std::string& part : { axes, unit, scale })
  {
    text += part.empty() ? "" : (text.empty() ? "; " : ", ") + part;
  }
  return text;
}

WorldSpace PlaceInWorld(vtkImageData* image, const WorldChoice& choice)
{
  WorldSpace space;
  space.FileAxes = space.Axes = GetFact(image, "Axes");
  space.FileUnit = space.Unit = LengthUnitOf(GetFact(image, "LengthUnit"));
  if (choice.Spacing)
  {
    image->SetSpacing(choice.Spacing->data());
  }
  space.Scale = ScaleOf(choice, space.Unit);
  if (space.Scale != 1.0)
  {
    ScaleImage(image, space.Scale);
    space.Unit = UnitAfter(space.Unit, space.Scale);
    SetFact(image, "LengthUnit", space.Unit);
  }
  if (!choice.Axes.empty())
  {
    FailIf(space.Axes.empty(),
      "--space " + choice.Axes +
        ": the file does not tell which sides of the body its axes point to");
    TurnImage(image, TurnBetween(space.Axes, choice.Axes));
    space.Axes = choice.Axes;
    SetWorldAxes(image, space.Axes);
  }
  return space;
}

namespace
{
constexpr const char* SpaceField = "SPACE";
constexpr const char* UnitField = "LengthUnit";
}

void MarkSpace(vtkPolyData* surface, const WorldSpace& space)
{
  for (const auto& [field, text] :
    { std::make_pair(SpaceField, space.Axes), std::make_pair(UnitField, space.Unit) })
  {
    if (!text.empty())
    {
      SetFact(surface, field, text);
    }
  }
}

void MarkSpace(vtkMultiBlockDataSet* surfaces, const WorldSpace& space)
{
  for (unsigned int block = 0; block < surfaces->GetNumberOfBlocks(); ++block)
  {
    if (auto* surface = vtkPolyData::SafeDownCast(surfaces->GetBlock(block)))
    {
      MarkSpace(surface, space);
    }
  }
}

std::string SpaceRemark(vtkPolyData* surface)
{
  const std::string space = GetFact(surface, SpaceField);
  const std::string unit = GetFact(surface, UnitField);
  return (space.empty() ? "" : ", SPACE=" + space) + (unit.empty() ? "" : ", unit " + unit);
}
}
