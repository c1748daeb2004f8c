// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicToolOptions_h
#define volumicToolOptions_h

#include "Messages.h"
#include "ReadVolume.h"
#include "SurfaceEnds.h"
#include "SurfaceProperties.h"
#include "Tetrahedra.h"
#include "WorldSpace.h"

#include <array>
#include <iostream>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <unistd.h>

namespace tool
{
/** What the command line asks for. */
struct ToolOptions
{
  using Positions = std::vector<std::array<double, 3>>; ///< world coordinates
  enum class Task
  {
    Segment,
    ShowHelp,
    ShowVersion,
    ListProperties,
    ListFiles,
    ListSeries
  };
  Task Task = Task::Segment;

  std::string Volume;                ///< file, folder or pattern
  VolumeChoice Choice;               ///< what of it is read
  std::vector<std::string> Surfaces; ///< files to write, at least one, unless the rest is asked for
  std::string Array;                 ///< point array of the volume; empty: the active one
  WorldChoice World;                 ///< where the volume is to lie
  std::optional<std::array<double, 3>> ResampledSpacing; ///< world units
  std::optional<std::array<int, 6>> Region;       ///< voxel indices, first and last of each axis
  std::optional<std::array<double, 6>> RegionBox; ///< the same in the world
  bool IsIsotropic = false;                       ///< resampled to the smallest spacing
  std::string Seeds;                              ///< file of points
  std::string InitialSurface;                     ///< file of a closed surface
  std::string AttractingPoints;                   ///< file of points
  Positions SeedPositions;                        ///< beside those of the file
  Positions AttractingPositions;                  ///< beside those of the file
  std::string Edges;               ///< point array of the volume, or file of a volume
  enum Ends Ends = Ends::Closed;   ///< of a surface at the border of the image
  int Triangles = 0;               ///< that the surface is to have, about; 0: as many as it gets
  std::vector<std::string> Probes; ///< files of volumes whose values surfaces get
  double ProbeDepth = 0.0;         ///< over which their mean is taken, world units
  std::vector<std::string> Labels; ///< which of them get surfaces; empty: it is no label map
  bool ListsLabels = false;        ///< to tell them, and make no surfaces
  std::string NamesOfLabels;       ///< file of names; empty: as the volume has them
  std::string Format;              ///< suffix of surfaces in a folder, without its dot
  std::string History;             ///< .csv
  std::string Levels;              ///< .vtm, or a folder
  std::string Snapshots;           ///< .vtm, or a folder
  std::string Report;              ///< .json
  std::string WrittenVolume;       ///< .vti
  SolidChoice Solids;              ///< of files of tetrahedra
  int PieceSize = 1 << 20;         ///< triangles of a piece of a .pvtp
  int Ranks = 1;                   ///< that mpirun has started
  bool Quiet = false;
  bool Progress = false; ///< also where stderr is no terminal

  /** The properties that were chosen, in the order of the command line, with their texts. */
  std::vector<std::pair<const PropertyOption*, std::string>> Properties;

  bool HasProperty(const std::string& property) const;

  /** The options of the command line, without dashes. */
  std::set<std::string> Given;
  bool Has(const std::string& option) const { return this->Given.count(option) > 0; }

  /** Whether a surface is wanted, or something that tells of it, or of the labels. */
  bool WantsSurface() const;
};

/** @throws UsageError if the command line is not understood or lacks something. */
ToolOptions ParseOptions(int argc, const char* const argv[]);

/** @throws UsageError if something is missing, or options are given that make no sense together. */
void CheckOptions(const ToolOptions& options);

/** Set the chosen properties. @throws UsageError if a text is no value of its property. */
void ApplyProperties(const ToolOptions& options, const FilterTrio& filters);

/** The text of --help; the defaults of the properties are the filters' own. */
void PrintHelp(std::ostream& out, const FilterTrio& filters);

/** A line per property: class, property, option, default; separated by tabs. */
void PrintProperties(std::ostream& out, const FilterTrio& filters);

/** What is told on stderr, unless --quiet. */
class Announcer
{
public:
  explicit Announcer(const ToolOptions& options) : IsQuiet(options.Quiet)
  {
    const bool isTerminal = isatty(STDERR_FILENO) != 0;
    this->Style = options.Quiet ? ProgressStyle::None
      : isTerminal              ? ProgressStyle::OneLine
      : options.Progress        ? ProgressStyle::Lines
                                : ProgressStyle::None;
  }

  void Say(const std::string& text) const
  {
    if (!this->IsQuiet && !text.empty())
    {
      std::cerr << "volumic: " << text << "\n";
    }
  }

  /** Does the work, and says what TellOfFile() tells meanwhile, of that file if it has a name. */
  template <class Work>
  void Follow(const std::string& name, const Work& work) const
  {
    VtkMessages told;
    told.Catch(work);
    for (const std::string& text : told.Warnings)
    {
      this->Say("warning: " + (name.empty() ? "" : name + ": ") + text);
    }
    told.ThrowErrors(name);
  }

  ProgressStyle Style;

private:
  bool IsQuiet;
};
}

#endif
