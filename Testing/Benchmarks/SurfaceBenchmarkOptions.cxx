// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "SurfaceBenchmarkOptions.h"

#include "RunFigures.h"
#include "SurfaceRuns.h"

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

const std::vector<int> DefaultSizes = { 64, 96, 128, 192, 256, 384, 512 };

double ToNumber(const std::string& option, const std::string& text)
{
  std::size_t used = 0;
  double value = std::numeric_limits<double>::quiet_NaN();
  try
  {
    value = std::stod(text, &used);
  }
  catch (const std::exception&)
  {
  }
  if (used != text.size() || !std::isfinite(value))
  {
    throw UsageError(option + " needs a number, not \"" + text + "\"");
  }
  return value;
}

int ToCount(const std::string& option, const std::string& text, int least, int most)
{
  const double value = ToNumber(option, text);
  if (value != std::rint(value) || value < least || value > most)
  {
    throw UsageError(option + " needs a whole number from " + std::to_string(least) + " to " +
      std::to_string(most) + ", not \"" + text + "\"");
  }
  return static_cast<int>(value);
}

std::vector<std::string> ToList(const std::string& option, const std::string& text)
{
  std::vector<std::string> list;
  std::istringstream stream(text);
  for (std::string item; std::getline(stream, item, ',');)
  {
    list.push_back(item);
  }
  if (list.empty() || std::count(list.begin(), list.end(), "") > 0)
  {
    throw UsageError(option + " needs a list with commas and without blanks");
  }
  return list;
}

void CheckRun(const std::string& option, const std::string& name)
{
  if (!IsSurfaceRun(name))
  {
    std::string known;
    for (const SurfaceRunKind& kind : SurfaceRunKinds())
    {
      known += (known.empty() ? "" : ", ") + kind.Name;
    }
    throw UsageError(
      option + ": no run \"" + name + "\" in this build; there are " + known + ", and us-N");
  }
}

void Check(const SurfaceBenchmarkOptions& options)
{
  if (options.Help)
  {
    return;
  }
  if (options.Volume.empty() == options.Scene.empty())
  {
    throw UsageError("--volume FILE.vti or --scene NAME is needed, one of the two");
  }
  if (options.Scene.empty() && std::isnan(options.IsoValue))
  {
    throw UsageError("--iso VALUE is needed with --volume");
  }
  for (const std::string& name : options.Runs)
  {
    CheckRun("--runs", name);
  }
  if (!options.Run.empty())
  {
    CheckRun("--run", options.Run);
  }
  const int modes = options.Growth + options.Model + !options.Threads.empty() + options.Peaks;
  if (options.Growth && std::count(options.Sizes.begin(), options.Sizes.end(), 0) > 0)
  {
    throw UsageError("--growth has no size 0");
  }
  if (modes > 1)
  {
    throw UsageError("--growth, --model, --threads and --memory each go alone");
  }
  if (modes > 0 && (!options.Runs.empty() || options.Slow || options.NoRecovery))
  {
    throw UsageError("--growth, --model, --threads and --memory run us-N only: they go without "
                     "--runs, --slow and --no-recovery");
  }
}

/** Options with and without a value. */
struct OptionTable
{
  std::map<std::string, std::function<void()>> Flags;
  std::map<std::string, std::function<void(const std::string&)>> Values;

  explicit OptionTable(SurfaceBenchmarkOptions& o)
  {
    this->Flags["--help"] = this->Flags["-h"] = [&o]() { o.Help = true; };
    this->Flags["--dark"] = [&o]() { o.ObjectIsBright = false; };
    this->Flags["--slow"] = [&o]() { o.Slow = true; };
    this->Flags["--no-recovery"] = [&o]() { o.NoRecovery = true; };
    this->Flags["--profile"] = [&o]() { o.Profile = true; };
    this->Flags["--growth"] = [&o]() { o.Growth = true; };
    this->Flags["--model"] = [&o]() { o.Model = true; };
    this->Flags["--memory"] = [&o]() { o.Peaks = true; };
    this->Flags["--no-judge"] = [&o]() { o.Judge = false; };

    this->Values["--metric"] = [&o](const std::string& text)
    {
      if (text != "voxels" && text != "world")
      {
        throw UsageError("--metric needs voxels or world, not \"" + text + "\"");
      }
      o.Metric = text == "world" ? LengthMetric::World : LengthMetric::Voxels;
    };
    this->Text("--volume", o.Volume);
    this->Text("--scene", o.Scene);
    this->Text("--csv", o.Csv);
    this->Text("--output", o.Output);
    this->Text("--run", o.Run);
    this->Text("--write-volume", o.WriteVolume);
    this->Number("--iso", o.IsoValue);
    this->Number("--delta", o.Delta);
    this->Number("--edge-length", o.EdgeLength);
    this->Number("--radius", o.Radius);
    this->Count("--size", o.SceneSize, 16, 1024);
    this->Count("--repetitions", o.Repetitions, 1, 1000);
    this->Count("--initialization", o.Initialization, 0, 2);
    this->Count("--coarsest", o.CoarsestLevel, 0, 30);
    this->Count("--resample", o.ResampleTo, 16, 1024);
    this->Values["--vertices"] = [&o](const std::string& text)
    { o.Vertices = ToCount("--vertices", text, 4, std::numeric_limits<int>::max()); };
    this->Values["--runs"] = [&o](const std::string& text) { o.Runs = ToList("--runs", text); };
    this->Values["--sizes"] = [&o](const std::string& text)
    {
      o.Sizes.clear();
      for (const std::string& size : ToList("--sizes", text))
      {
        o.Sizes.push_back(size == "0" ? 0 : ToCount("--sizes", size, 16, 1024));
      }
    };
    this->Values["--threads"] = [&o](const std::string& text)
    {
      for (const std::string& number : ToList("--threads", text))
      {
        o.Threads.push_back(ToCount("--threads", number, 1, 999));
      }
    };
    this->Values["--max-size"] = [&o](const std::string& text)
    {
      const int most = ToCount("--max-size", text, DefaultSizes.front(), 1024);
      o.Sizes.clear();
      std::copy_if(DefaultSizes.begin(), DefaultSizes.end(), std::back_inserter(o.Sizes),
        [most](int size) { return size <= most; });
    };
  }

private:
  void Text(const std::string& name, std::string& place)
  {
    this->Values[name] = [&place](const std::string& text) { place = text; };
  }
  void Number(const std::string& name, double& place)
  {
    this->Values[name] = [name, &place](const std::string& text) { place = ToNumber(name, text); };
  }
  void Count(const std::string& name, int& place, int least, int most)
  {
    this->Values[name] = [=, &place](const std::string& text)
    { place = ToCount(name, text, least, most); };
  }
};

} // namespace

//------------------------------------------------------------------------------
SurfaceBenchmarkOptions ParseSurfaceOptions(int argc, char** argv)
{
  SurfaceBenchmarkOptions options;
  const OptionTable table(options);
  for (int i = 1; i < argc; ++i)
  {
    const std::string name = argv[i];
    if (const auto flag = table.Flags.find(name); flag != table.Flags.end())
    {
      flag->second();
      continue;
    }
    const auto value = table.Values.find(name);
    if (value == table.Values.end())
    {
      throw UsageError("unknown option " + name);
    }
    if (++i == argc)
    {
      throw UsageError(name + " needs a value");
    }
    value->second(argv[i]);
  }
  Check(options);
  if (options.Sizes.empty())
  {
    options.Sizes = options.Growth ? DefaultSizes
      : options.Peaks              ? std::vector<int>{ 512, 1024 }
                                   : std::vector<int>{ 0 };
  }
  if (options.Repetitions == 0)
  {
    options.Repetitions = options.Threads.empty() ? 1 : 5;
  }
  return options;
}

std::vector<std::string> ArgumentsOfRun(const SurfaceBenchmarkOptions& options)
{
  std::vector<std::string> arguments = { "--run", options.Run };
  const auto add = [&arguments](const char* name, const std::string& value)
  {
    arguments.push_back(name);
    arguments.push_back(value);
  };
  const auto addNumber = [&add](const char* name, double value)
  {
    std::ostringstream text;
    text.precision(17);
    text << value;
    add(name, text.str());
  };
  if (options.Scene.empty())
  {
    add("--volume", options.Volume);
  }
  else
  {
    add("--scene", options.Scene);
    add("--size", std::to_string(options.SceneSize));
  }
  if (!std::isnan(options.IsoValue))
  {
    addNumber("--iso", options.IsoValue);
  }
  if (!options.ObjectIsBright)
  {
    arguments.push_back("--dark");
  }
  if (!options.Judge)
  {
    arguments.push_back("--no-judge");
  }
  if (options.Profile)
  {
    arguments.push_back("--profile");
  }
  if (options.Model)
  {
    arguments.push_back("--model");
  }
  if (!options.Output.empty())
  {
    add("--output", options.Output);
  }
  if (options.ResampleTo > 0)
  {
    add("--resample", std::to_string(options.ResampleTo));
  }
  if (!options.WriteVolume.empty())
  {
    add("--write-volume", options.WriteVolume);
  }
  if (options.Vertices > 0)
  {
    add("--vertices", std::to_string(options.Vertices));
  }
  if (options.CoarsestLevel >= 0)
  {
    add("--coarsest", std::to_string(options.CoarsestLevel));
  }
  add("--metric", options.Metric == LengthMetric::World ? "world" : "voxels");
  add("--initialization", std::to_string(options.Initialization));
  addNumber("--delta", options.Delta);
  addNumber("--edge-length", options.EdgeLength);
  addNumber("--radius", options.Radius);
  return arguments;
}

SurfaceBenchmarkOptions OursAt(
  const SurfaceBenchmarkOptions& options, const std::string& run, int size)
{
  SurfaceBenchmarkOptions one = options;
  one.Run = run;
  one.ResampleTo = size;
  one.Judge = false;
  one.Output.clear();
  return one;
}

std::string NameOfSize(int size)
{
  return size > 0 ? std::to_string(size) + "^3" : "as it is";
}

std::string SurfaceUsage()
{
  std::ostringstream text;
  text << R"(Usage: BenchmarkSurface --volume FILE.vti --iso VALUE [OPTION]...
       BenchmarkSurface --scene NAME [--size N] [OPTION]...
Runs vtkDeformableSurface and what else makes a surface of a volume, one after the other, each in
a process of its own, has all results judged by the same code, and prints one table and what became
of the targets.

Volume
  --volume FILE.vti     any scalar type, one component
  --iso VALUE           the isopotential; best one that no voxel equals (226.5, not 226)
  --dark                the object is darker than the iso-value
  --scene NAME          a synthetic volume of the tests instead, such as Torus; --size N voxels
                        along each axis (default 48)

Runs
  --runs LIST           only these, with commas between; default: all but us-paper and those
                        marked slow
)";
  for (const SurfaceRunKind& kind : SurfaceRunKinds())
  {
    std::string name = kind.Name;
    name.resize(std::max<std::size_t>(name.size(), 12), ' ');
    text << "      " << name << kind.Description << (kind.Slow ? " (slow)" : "") << "\n";
  }
  text << R"(      us-N        with N threads
  --slow                those marked slow too
  --no-recovery         us-paper too
  --repetitions N       of each run; the one of median processor time is told (default 1, of
                        --threads 5)
  --metric NAME         voxels or world (default): which lengths are uniform where voxels are no
                        cubes, for us and for the peers that aim at well-shaped triangles
  --initialization N    0 enclosing icosahedron (default), 1 seeds, 2 iso-surface of the coarsest
                        level
  --coarsest LEVEL      where us-N starts; default: the coarsest level at which a voxel of the
                        object is left (the filter refuses coarser ones)
  --edge-length X       mean edge, voxels, and
  --vertices N          number of vertices that the peers aim at; default: those of us-1

Instead of all other runs, one of these
  --growth              how cost grows: us-1 on the volume resampled to about the voxels of 64^3 ...
                        512^3, the same factor along all axes, with fitted exponents
  --threads LIST        what threads gain: us-N for each N by turns, as 1,2; medians of the seconds
                        and of their ratios in a round, 5 rounds or --repetitions
  --model               what more threads than there are would gain: us-1, whose parallel work is
                        measured chunk by chunk and scheduled on 2 to 64 threads, by phase
  --memory              what memory us-1 takes, resampled to 512^3 and 1024^3 voxels in a file, so
                        that only the image and the run are in the process
  --sizes LIST          for these four, the volume at other sizes; 0: as it is, which --threads and
                        --model take without this
  --max-size N          for --growth: its sizes up to N

Output
  --profile             also seconds by phase and level of us-1
  --csv FILE.csv        a row per run; also FILE-levels.csv (quality and phases by level) and
                        FILE-targets.csv. With --growth: a row per size, and FILE-exponents.csv;
                        with --threads a row per run, with --model one per size and phase, with
                        --memory one per size, and FILE-targets.csv
  --output FILE.vtp     the surface of us-1

Internal, of the processes that this program starts: --run NAME, --resample N, --write-volume FILE,
--no-judge, --delta, --radius.

Peers get the volume with a voxel of air around it; loading it is not measured, the pyramid is.
Seconds are those of the clock and of the processor, memory is the resident memory of the whole
process at its peak. Lengths and shapes are those of the metric, in which the smallest distance of
two voxels (of the level, where a level is spoken of) is 1; "voxels" and "world" name the other one
or both. Only what was reached counts in voxels, always.
Exit code: 0 all was run (targets may be missed), 1 a run failed, 2 the command line is wrong.
)";
  return text.str();
}

} // namespace bench
} // namespace volumic
