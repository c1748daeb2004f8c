// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ToolOptions.h"

#include "Texts.h"
#include "ToolErrors.h"

#include <algorithm>
#include <functional>
#include <ostream>
#include <sstream>

namespace tool
{
namespace
{
/** An option of the command line. */
struct ProgramOption
{
  std::string Option;
  std::string Argument;
  std::string Help;
  std::function<void(ToolOptions&, const std::string& text)> Set;
};

// Options that take a file or name, each into its own member.
ProgramOption Text(
  const char* option, const char* argument, std::string ToolOptions::*member, const char* help)
{
  return { option, argument, help,
    [member](ToolOptions& options, const std::string& text) { options.*member = text; } };
}

// Options that add a point to a list, as often as they are given.
ProgramOption Position(
  const char* option, ToolOptions::Positions ToolOptions::*member, const char* help)
{
  return { option, "X,Y,Z", help,
    [member](ToolOptions& options, const std::string& text)
    {
      const std::vector<double> numbers = ParseNumbers(text, 3);
      (options.*member).push_back({ numbers[0], numbers[1], numbers[2] });
    } };
}

ProgramOption Switch(const char* option, bool ToolOptions::*member, const char* help)
{
  return { option, "", help,
    [member](ToolOptions& options, const std::string&) { options.*member = true; } };
}

ProgramOption Show(const char* option, enum ToolOptions::Task task, const char* help)
{
  return { option, "", help,
    [task](ToolOptions& options, const std::string&) { options.Task = task; } };
}

std::array<double, 3> ParseSpacing(const std::string& text)
{
  const std::vector<double> numbers = ParseNumbers(text, 3);
  FailIf<UsageError>(*std::min_element(numbers.begin(), numbers.end()) <= 0.0,
    "distances of voxels are more than 0");
  return { numbers[0], numbers[1], numbers[2] };
}

/** Six numbers: from and to along each axis. */
template <class Number>
std::array<Number, 6> ParseRegion(const std::string& text)
{
  const std::vector<double> numbers = ParseNumbers(text, 6);
  std::array<Number, 6> region;
  for (std::size_t i = 0; i < 6; ++i)
  {
    region[i] = static_cast<Number>(std::clamp(numbers[i], -1e9, 1e9));
    FailIf<UsageError>(region[i] != numbers[i], "voxels are counted in whole numbers");
    FailIf<UsageError>(
      i % 2 == 1 && region[i] < region[i - 1], "'" + text + "' ends before it begins");
  }
  return region;
}

void SetScale(ToolOptions& options, const std::string& text)
{
  options.World.Scale = ParseNumber<double>(text);
  FailIf<UsageError>(!(*options.World.Scale > 0.0), "lengths are multiplied by more than 0");
}

void SetUnit(ToolOptions& options, const std::string& text)
{
  options.World.Unit = LengthUnitOf(text);
  FailIf<UsageError>(options.World.Unit.empty(), "'" + text + "' is none of m, cm, mm, um, nm, A");
}

/** The text. @throws UsageError if it is none of the words */
const std::string& OneOf(const std::string& text, const std::vector<std::string>& words)
{
  std::string all;
  for (const std::string& word : words)
  {
    all += (all.empty() ? "" : ", ") + word;
  }
  FailIf<UsageError>(
    std::find(words.begin(), words.end(), text) == words.end(), "'" + text + "' is none of " + all);
  return text;
}

void SetSpace(ToolOptions& options, const std::string& text)
{
  const bool isAsFile = OneOf(text, { "LPS", "RAS", "as-file" }) == "as-file";
  options.World.Axes = isAsFile ? "" : text;
}

void SetMesher(ToolOptions& options, const std::string& text)
{
  options.Solids.Mesher = OneOf(text, { "tetgen", "gmsh" });
}

void SetEnds(ToolOptions& options, const std::string& text)
{
  OneOf(text, { "closed", "marked", "open" });
  options.Ends = text == "open" ? Ends::Open : text == "marked" ? Ends::Marked : Ends::Closed;
}

void SetTime(ToolOptions& options, const std::string& text)
{
  options.Choice.Time = ParseNumber<int>(text);
}

void SetMaximumVolume(ToolOptions& options, const std::string& text)
{
  options.Solids.MaximumVolume = ParseNumber<double>(text);
  FailIf<UsageError>(!(options.Solids.MaximumVolume > 0.0), "a volume is more than 0");
}

void SetPieceSize(ToolOptions& options, const std::string& text)
{
  options.PieceSize = ParseNumber<int>(text);
  FailIf<UsageError>(options.PieceSize < 1, "pieces have a triangle at least");
}

const std::vector<ProgramOption>& InputOptions()
{
  static const std::vector<ProgramOption> options = {
    Text("array", "NAME", &ToolOptions::Array,
      "the point array of the volume to use; without this option the active scalars"),
    { "spacing", "X,Y,Z",
      "distances of neighbouring voxels along the three axes, instead of the file's, in its unit",
      [](ToolOptions& chosen, const std::string& text)
      { chosen.World.Spacing = ParseSpacing(text); } },
    { "region", "I0,I1,J0,J1,K0,K1",
      "use these voxels of the volume only, first and last along each axis, counted as "
      "--list-labels does; surfaces close at its border",
      [](ToolOptions& chosen, const std::string& text)
      { chosen.Region = ParseRegion<int>(text); } },
    { "region-box", "X0,X1,Y0,Y1,Z0,Z1",
      "the same as a box in world coordinates: all voxels that it touches",
      [](ToolOptions& chosen, const std::string& text)
      { chosen.RegionBox = ParseRegion<double>(text); } },
    { "resample", "X,Y,Z",
      "resample the volume to these distances: linearly, a label map to the nearest voxel",
      [](ToolOptions& chosen, const std::string& text)
      { chosen.ResampledSpacing = ParseSpacing(text); } },
    Switch("isotropic", &ToolOptions::IsIsotropic,
      "resample the volume to the smallest of its three distances of voxels"),
    { "scale", "FACTOR",
      "multiply all lengths and places of the volume by this, and so all that is written",
      SetScale },
    { "unit", "m|mm|um",
      "have all that is written in this unit of length, which is also that of lengths and places "
      "in options; where the file tells its own",
      SetUnit },
    { "space", "LPS|RAS|as-file",
      "to which sides of the body the axes of what is written point (left, posterior, superior, as "
      "in DICOM; right, anterior, superior, as in NIfTI); where the file tells its own",
      SetSpace },
    { "series", "N|UID",
      "of DICOM: the series to read where there are several, by its number in --list-series, or by "
      "its identifier",
      [](ToolOptions& chosen, const std::string& text) { chosen.Choice.Series = text; } },
    Show("list-series", ToolOptions::Task::ListSeries,
      "print the DICOM series of the volume instead of making surfaces: number, description, kind, "
      "date, slices, identifier"),
    { "time", "N",
      "of several volumes in one (times, phases, masks) the one to read, counted from 0", SetTime },
    { "phase", "N", "the same as --time, of phases and echoes within a DICOM series", SetTime },
    { "raw", "X,Y,Z,TYPE[,big]",
      "the file has no header: sizes and type of its voxels, such as 512,512,400,uint16, x "
      "fastest, "
      "the least significant byte first",
      [](ToolOptions& chosen, const std::string& text) { chosen.Choice.Raw = text; } },
    { "no-resampling", "",
      "refuse what is no regular grid (a slice is missing, the gantry was tilted, shear) instead "
      "of "
      "interpolating it linearly",
      [](ToolOptions& chosen, const std::string&) { chosen.Choice.Resamples = false; } },
    Text("seeds", "FILE", &ToolOptions::Seeds,
      "start from icosahedra at these points: a mesh file's, or the lines 'x y z' (or 'x,y,z') of "
      "a .txt, .csv or .xyz file; world coordinates"),
    Position("seed-position", &ToolOptions::SeedPositions,
      "start from an icosahedron at this point too; world coordinates; may be given several times"),
    Text("initial-surface", "FILE", &ToolOptions::InitialSurface,
      "start from this closed surface: .vtp, .vtk, .stl, .ply or .obj; world coordinates"),
    Text("attracting-points", "FILE", &ToolOptions::AttractingPoints,
      "points known to belong to the object, see --point-attraction: a mesh file's, with its "
      "arrays "
      "Weight and Radius, or the lines 'x y z [weight [radius]]' of a .txt, .csv or .xyz file; "
      "world coordinates"),
    Position("attracting-position", &ToolOptions::AttractingPositions,
      "a point known to belong to the object too; world coordinates; may be given several times"),
    Text("edges", "NAME|FILE", &ToolOptions::Edges,
      "a map that is large on edges, see --edge-attraction (2 if that is not given): a point array "
      "of the volume, or a volume of the same size"),
    { "ends", "closed|marked|open",
      "where an object leaves the volume: closed by a round cap (default), or cut in a plane, a voxel "
      "within the outermost ones, marked: closed there by flat caps, numbered by a cell array Cap, or "
      "open, for flow",
      SetEnds },
    { "triangles", "N",
      "find the --tolerance with which the surface has about so many triangles, a tenth more or "
      "less",
      [](ToolOptions& chosen, const std::string& text)
      {
        chosen.Triangles = ParseNumber<int>(text);
        FailIf<UsageError>(chosen.Triangles < 20, "a surface has 20 triangles at least");
      } },
    { "probe", "FILE",
      "give vertices the values of this volume, in whatever grid, as a point array named as the "
      "file; may be given several times",
      [](ToolOptions& chosen, const std::string& text) { chosen.Probes.push_back(text); } },
    { "probe-depth", "LENGTH",
      "of --probe the mean of the values from the surface so far inward, in world units",
      [](ToolOptions& chosen, const std::string& text)
      {
        chosen.ProbeDepth = ParseNumber<double>(text);
        FailIf<UsageError>(!(chosen.ProbeDepth >= 0.0), "a depth is not less than 0");
      } },
    { "labels", "all|LIST",
      "the volume is a label map: make a surface of each of these labels, given as numbers, ranges "
      "and names with commas between, such as 1,7-9,liver,lung_*",
      [](ToolOptions& chosen, const std::string& text) { chosen.Labels.push_back(text); } },
    Switch("list-labels", &ToolOptions::ListsLabels,
      "print the labels of the volume, or those of --labels, instead of making surfaces: number, "
      "voxels, volume, the box of voxel indices that they are in, and name; with --report as JSON"),
    Text("label-names", "FILE", &ToolOptions::NamesOfLabels,
      "names and colours of labels: JSON, ITK-SNAP's label descriptions, a colour table or .csv; "
      "without this option those of the volume, or of a file beside it"),
  };
  return options;
}

const std::vector<ProgramOption>& OutputOptions()
{
  static const std::vector<ProgramOption> options = {
    Text("format", "SUFFIX", &ToolOptions::Format,
      "with --labels: what the files in a folder are, such as stl (default: vtp)"),
    Text("history", "FILE.csv", &ToolOptions::History, "write a line per iteration"),
    Text("levels-output", "FILE.vtm|DIR", &ToolOptions::Levels,
      "write the surface of each level: as blocks, or as level-0.vtp, level-1.vtp, ... in a "
      "folder"),
    Text("snapshots", "FILE.vtm|DIR", &ToolOptions::Snapshots,
      "write the surface on its way, every --snapshot-interval iterations (10 if that is not "
      "given), at the end of a sweep of five: as blocks, or as snapshot-0.vtp, ... in a folder"),
    Text("report", "FILE.json", &ToolOptions::Report,
      "write components, genus, area, volume, seconds, ...; - for the standard output"),
    Text("write-volume", "FILE.vti", &ToolOptions::WrittenVolume,
      "write the volume as it was read; without another file to write, that is all"),
    { "mesher", "tetgen|gmsh",
      "what fills surfaces with tetrahedra for .vtu and .inp (default: the first that is "
      "installed), "
      "and then for .msh, too",
      SetMesher },
    { "maximum-volume", "VOLUME", "of tetrahedra, in world units cubed; by gmsh about so much",
      SetMaximumVolume },
    { "piece-size", "N", "triangles in each piece of a .pvtp (default: 1048576)", SetPieceSize },
    Switch("quiet", &ToolOptions::Quiet, "print errors only"),
    Switch("progress", &ToolOptions::Progress,
      "print the progress even if the standard error is no terminal, then in lines"),
    Show("list-properties", ToolOptions::Task::ListProperties,
      "print the options that are properties of the filters: class, property, option, default"),
    Show("list-files", ToolOptions::Task::ListFiles,
      "print the files that the volume is read from, one per line"),
    Show("help", ToolOptions::Task::ShowHelp, "print this text"),
    Show("version", ToolOptions::Task::ShowVersion, "print the versions of Volumic and VTK"),
  };
  return options;
}

/** Properties of the filters are set when all of them are known. */
ProgramOption FindOption(const std::string& name)
{
  const auto isIt = [&name](const auto& option) { return option.Option == name; };
  for (const auto* options : { &InputOptions(), &OutputOptions() })
  {
    const auto found = std::find_if(options->begin(), options->end(), isIt);
    if (found != options->end())
    {
      return *found;
    }
  }
  const std::vector<PropertyOption>& all = SurfaceProperties();
  const auto property = std::find_if(all.begin(), all.end(), isIt);
  FailIf<UsageError>(property == all.end(), "unknown option --" + name);
  return { name, property->Argument, property->Help,
    [property](ToolOptions& chosen, const std::string& text)
    { chosen.Properties.emplace_back(&*property, text); } };
}

// ---- Help ---------------------------------------------------------------------------------------

void PrintOption(std::ostream& out, const std::string& option, const std::string& argument,
  const std::string& help)
{
  const std::size_t width = 80;
  const std::size_t indent = 8;
  out << "  --" << option << (argument.empty() ? "" : " " + argument) << "\n";
  std::istringstream words(help);
  std::string word;
  std::string line;
  while (words >> word)
  {
    if (!line.empty() && indent + line.size() + 1 + word.size() > width)
    {
      out << std::string(indent, ' ') << line << "\n";
      line.clear();
    }
    line += (line.empty() ? "" : " ") + word;
  }
  out << std::string(indent, ' ') << line << "\n";
}
}

bool ToolOptions::HasProperty(const std::string& property) const
{
  return std::any_of(this->Properties.begin(), this->Properties.end(),
    [&](const auto& chosen) { return chosen.first->Property == property; });
}

bool ToolOptions::WantsSurface() const
{
  return this->ListsLabels || !this->Surfaces.empty() || !this->Levels.empty() ||
    !this->Report.empty() || !this->History.empty() || !this->Snapshots.empty();
}

ToolOptions ParseOptions(int argc, const char* const argv[])
{
  ToolOptions options;
  bool isPlain = false;
  for (int i = 1; i < argc; ++i)
  {
    std::string word = argv[i];
    if (!isPlain && word == "--")
    {
      isPlain = true;
      continue;
    }
    word = isPlain ? word : word == "-h" ? "--help" : word == "-q" ? "--quiet" : word;
    if (isPlain || word.size() < 2 || word[0] != '-')
    {
      (options.Volume.empty() ? options.Volume : options.Surfaces.emplace_back()) = word;
      continue;
    }
    FailIf<UsageError>(word.compare(0, 2, "--") != 0, "unknown option " + word);
    const std::size_t equals = word.find('=');
    const std::string name = word.substr(2, equals == std::string::npos ? equals : equals - 2);
    const ProgramOption found = FindOption(name);
    const bool takesArgument = !found.Argument.empty();
    std::string text;
    if (equals != std::string::npos)
    {
      text = word.substr(equals + 1);
      FailIf<UsageError>(!takesArgument, "--" + name + " takes no argument");
    }
    else if (takesArgument)
    {
      FailIf<UsageError>(++i >= argc, "--" + name + " needs an argument");
      text = argv[i];
    }
    Named<UsageError>("--" + name, [&] { found.Set(options, text); });
    options.Given.insert(name);
  }
  if (options.ListsLabels && options.Labels.empty())
  {
    options.Labels = { "all" };
  }
  options.Choice.AreLabels = !options.Labels.empty();
  options.Choice.NeedsComponent =
    options.WantsSurface() && options.Labels.empty() && !options.HasProperty("SelectedComponent");
  CheckOptions(options);
  return options;
}

void ApplyProperties(const ToolOptions& options, const FilterTrio& filters)
{
  for (const auto& chosen : options.Properties)
  {
    Named<UsageError>(
      "--" + chosen.first->Option, [&] { chosen.first->Set(filters, chosen.second); });
  }
}

void PrintHelp(std::ostream& out, const FilterTrio& filters)
{
  out << "Usage: volumic [OPTION]... VOLUME SURFACE...\n"
         "\n"
         "Finds the surface of an object in a 3D image with a closed, deformable surface\n"
         "that descends a pyramid of the image from coarse to fine, and writes it.\n"
         "\n"
         "VOLUME   a file (see FORMATS in volumic(1)), a folder of DICOM slices or of\n"
         "         pictures, or a pattern of pictures such as 'slice%03d.png' or '*.tif'\n"
         "SURFACE  .vtp .pvtp .vtk .stl .ply .obj .glb .3mf; filled with tetrahedra .vtu\n"
         "         .inp; for meshers of solids .msh .smesh .poly; all are written\n"
         "         (with --labels also a folder for a file per label, OUT/, or all in one\n"
         "         .vtm, .glb or .3mf, or in one mesh: --shared-interfaces)\n"
         "\n"
         "Input:\n";
  for (const ProgramOption& option : InputOptions())
  {
    PrintOption(out, option.Option, option.Argument, option.Help);
  }
  out << "\nSegmentation:\n";
  for (const PropertyOption& option : SurfaceProperties())
  {
    const std::string value = option.Get(filters);
    const bool hasDefault = !option.Argument.empty() && !value.empty() && value != "nan";
    PrintOption(out, option.Option, option.Argument,
      option.Help + (hasDefault ? " (default: " + value + ")" : ""));
  }
  out << "\nOutput:\n";
  for (const ProgramOption& option : OutputOptions())
  {
    PrintOption(out, option.Option, option.Argument, option.Help);
  }
  out << "\n"
         "Exit codes: 0 done; 1 something failed; 2 wrong usage; 3 interrupted (Ctrl-C),\n"
         "stopped by --time-limit or the iteration limit: the surface as it was then is\n"
         "written.\n";
}

void PrintProperties(std::ostream& out, const FilterTrio& filters)
{
  for (const PropertyOption& option : SurfaceProperties())
  {
    out << option.Class << "\t" << option.Property << "\t--" << option.Option << "\t"
        << option.Get(filters) << "\n";
  }
}
}
