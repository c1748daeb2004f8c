// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "LabelBenchmarkOptions.h"

#include "SurfaceBenchmarkOptions.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <sstream>

namespace volumic
{
namespace bench
{
namespace
{

double ToNumber(const std::string& option, const std::string& text)
{
  std::size_t used = 0;
  double value = 0.0;
  try
  {
    value = std::stod(text, &used);
  }
  catch (const std::exception&)
  {
  }
  if (text.empty() || used != text.size() || !std::isfinite(value))
  {
    throw UsageError(option + " needs a number, not \"" + text + "\"");
  }
  return value;
}

int ToInteger(const std::string& option, const std::string& text, int least)
{
  const double value = ToNumber(option, text);
  if (value != std::rint(value) || value < least || value > 1e9)
  {
    throw UsageError(option + " needs a whole number of at least " + std::to_string(least) +
      ", not \"" + text + "\"");
  }
  return static_cast<int>(value);
}

std::vector<std::string> ToList(const std::string& text)
{
  std::vector<std::string> list;
  std::istringstream stream(text);
  for (std::string item; std::getline(stream, item, ',');)
  {
    list.push_back(item);
  }
  return list;
}

std::vector<double> ToNumbers(const std::string& option, const std::string& text)
{
  std::vector<double> numbers;
  for (const std::string& item : ToList(text))
  {
    numbers.push_back(ToNumber(option, item));
  }
  return numbers;
}

std::vector<int> ToIntegers(const std::string& option, const std::string& text, int least)
{
  std::vector<int> numbers;
  for (const std::string& item : ToList(text))
  {
    numbers.push_back(ToInteger(option, item, least));
  }
  return numbers;
}

std::vector<std::string> ToNames(const std::string& option, const std::string& text,
  const std::vector<std::string>& known)
{
  const std::vector<std::string> names = ToList(text);
  for (const std::string& name : names)
  {
    if (std::count(known.begin(), known.end(), name) == 0)
    {
      std::string all;
      for (const std::string& one : known)
      {
        all += (all.empty() ? "" : ", ") + one;
      }
      throw UsageError(option + ": no \"" + name + "\" in this build; there are " + all);
    }
  }
  return names;
}

std::vector<std::string> ShapeNames()
{
  std::vector<std::string> names;
  for (const support::LabelShapeKind kind : support::AllLabelShapeKinds())
  {
    names.push_back(support::LabelShapeName(kind));
  }
  return names;
}

using Taker = std::function<void(const std::string&, const std::string&)>;

std::map<std::string, Taker> Takers(LabelBenchmarkOptions& o)
{
  std::map<std::string, Taker> takers;
  takers["--map"] = [&o](const auto&, const auto& text) { o.Map = text; };
  takers["--scan"] = [&o](const auto&, const auto& text) { o.Scan = text; };
  takers["--csv"] = [&o](const auto&, const auto& text) { o.Csv = text; };
  takers["--thresholds"] = [&o](const auto& name, const auto& text)
  { o.Thresholds = ToNumbers(name, text); };
  takers["--body"] = [&o](const auto& name, const auto& text)
  {
    const std::vector<int> size = ToIntegers(name, text, 16);
    if (size.size() != 3)
    {
      throw UsageError(name + " needs three numbers, such as 512,512,400");
    }
    std::copy(size.begin(), size.end(), o.Body.begin());
  };
  takers["--body-labels"] = [&o](const auto& name, const auto& text)
  { o.BodyLabels = ToInteger(name, text, 1); };
  takers["--shapes"] = [&o](const auto& name, const auto& text)
  { o.Shapes = ToNames(name, text, ShapeNames()); };
  takers["--sizes"] = [&o](const auto& name, const auto& text)
  { o.Sizes = ToIntegers(name, text, 32); };
  takers["--stretches"] = [&o](const auto& name, const auto& text)
  { o.Stretches = ToNumbers(name, text); };
  takers["--labels"] = [&o](const auto& name, const auto& text)
  { o.Labels = ToIntegers(name, text, -32768); };
  takers["--least"] = [&o](const auto& name, const auto& text)
  { o.LeastVoxels = ToInteger(name, text, 1); };
  takers["--runs"] = [&o](const auto& name, const auto& text)
  { o.Runs = ToNames(name, text, LabelRunNames()); };
  takers["--threads"] = [&o](const auto& name, const auto& text)
  { o.Settings.Threads = ToInteger(name, text, 1); };
  takers["--repetitions"] = [&o](const auto& name, const auto& text)
  { o.Settings.Repetitions = ToInteger(name, text, 1); };
  takers["--finest"] = [&o](const auto& name, const auto& text)
  { o.Settings.FinestLevel = ToInteger(name, text, -8); };
  takers["--smoothing"] = [&o](const auto& name, const auto& text)
  { o.Settings.Smoothing = ToNumber(name, text); };
  takers["--voxel-tolerance"] = [&o](const auto& name, const auto& text)
  { o.Settings.VoxelTolerance = ToNumber(name, text); };
  return takers;
}

void Check(const LabelBenchmarkOptions& o)
{
  if (!o.Map.empty() + !o.Scan.empty() + (o.Body[0] > 0) > 1)
  {
    throw UsageError("--map, --scan and --body each go alone");
  }
  if (o.Scan.empty() != o.Thresholds.empty())
  {
    throw UsageError("--scan and --thresholds need each other");
  }
  if (!std::all_of(o.Stretches.begin(), o.Stretches.end(), [](double s) { return s >= 1.0; }))
  {
    throw UsageError("--stretches needs numbers of at least 1");
  }
  if (o.Mask && o.Map.empty())
  {
    throw UsageError("--mask needs --map");
  }
}

} // namespace

const char* const LabelBenchmarkUsage =
  "Usage: BenchmarkLabels [--shapes LIST] [--sizes LIST] [--stretches LIST] [OPTION]...\n"
  "       BenchmarkLabels --map FILE [--mask] [OPTION]...\n"
  "       BenchmarkLabels --scan FILE --thresholds LIST [OPTION]...\n"
  "       BenchmarkLabels --body X,Y,Z [--body-labels N] [OPTION]...\n"
  "vtkLabelsToSurfaces and its peers on digitised shapes, on a label map (.vti, .nii, .nii.gz),\n"
  "on one made of a scan, or on one of ellipsoids and tubes.\n"
  "  --labels LIST      these labels (default: all but 0)\n"
  "  --least N          only labels of at least N voxels (default 64)\n"
  "  --runs LIST        these runs (default: all that this build has): us, of all labels at once;\n"
  "                     us-gap, with a Gap of .3 voxel; us-alone, each label cut out; windowed,\n"
  "                     windowed-more: vtkDiscreteFlyingEdges3D, vtkWindowedSincPolyDataFilter;\n"
  "                     nets: vtkSurfaceNets3D; antialiased: ITK; remeshed: windowed and CGAL\n"
  "  --threads N        of us; peers have one (default 1)\n"
  "  --smoothing S --voxel-tolerance T --finest LEVEL   of us\n"
  "  --repetitions N    of which the fastest counts (default 1)\n"
  "  --csv FILE.csv     all figures; targets in FILE-targets.csv\n"
  "  --mask             all labels of the map as one\n";

bool LabelBenchmarkOptions::Has(const std::string& run) const
{
  return this->Runs.empty() || std::count(this->Runs.begin(), this->Runs.end(), run) > 0;
}

LabelBenchmarkOptions ParseLabelOptions(int argc, char** argv)
{
  LabelBenchmarkOptions options;
  const std::map<std::string, Taker> takers = Takers(options);
  for (int i = 1; i < argc; ++i)
  {
    const std::string name = argv[i];
    const auto taker = takers.find(name);
    if (name == "--help" || name == "-h")
    {
      options.Help = true;
    }
    else if (name == "--mask")
    {
      options.Mask = true;
    }
    else if (taker == takers.end())
    {
      throw UsageError("unknown option " + name);
    }
    else if (i + 1 == argc)
    {
      throw UsageError(name + " needs a value");
    }
    else
    {
      taker->second(name, argv[++i]);
    }
  }
  Check(options);
  return options;
}

} // namespace bench
} // namespace volumic
