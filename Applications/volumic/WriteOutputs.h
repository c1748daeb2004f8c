// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicWriteOutputs_h
#define volumicWriteOutputs_h

#include "LabelMap.h"
#include "Messages.h"
#include "WorldSpace.h"

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <string>
#include <vector>

namespace tool
{
class Failures;
struct ReportInput;
class SolidMaker;
struct ToolOptions;

/**
 * All that can be known to be wrong with the files before the work begins, and, of labels, before
 * the names of their surfaces are known.
 * @throws Failure or UsageError that says what.
 */
void CheckFiles(const ToolOptions& options);

/**
 * Write all that the options ask for, but the volume. @param results sizes of levels are set here
 * @throws Failure if not all could be written, with a line for each file.
 */
void WriteOutputs(const ToolOptions& options, ReportInput& results, ProgressStyle style);

/**
 * What a printer asks of surfaces for which a .3mf was asked: their size, and the thinnest wall
 * where
 * --thin-parts has measured it. Empty without a .3mf, or without surfaces.
 */
std::string TextOfPrint(
  const ToolOptions& options, const std::vector<vtkPolyData*>& surfaces, const WorldSpace& world);

// ---- Labels -------------------------------------------------------------------------------------

/** A surface about a label, or, with --merge, about several. */
struct LabelSurface
{
  std::vector<KnownLabel> Labels;       ///< of the surface, at least one
  std::string Name;                     ///< of its block
  std::string FileName;                 ///< in a folder, without suffix
  vtkSmartPointer<vtkPolyData> Surface; ///< may have no points
  std::vector<std::string> Files;       ///< that were written of it alone
  double Seconds = 0.0;                 ///< that the work on it took

  /** Whether something stopped it on its way, or before it began. */
  bool IsUnfinished() const;
};

/** What a name on the command line asks for. */
enum class LabelOutput
{
  Folder,     ///< it ends with a slash, is one, or has no suffix
  Blocks,     ///< .vtm and .glb: one file of all
  Interfaces, ///< one mesh of all, for meshers of solids or, where interfaces are shared, .vtp,
              ///< .vtk
  File        ///< of one surface
};

LabelOutput OutputOf(const ToolOptions& options, const std::string& name);

/** Whether a file of tetrahedra is asked for. */
bool MakesSolids(const ToolOptions& options);

/** Whether the options ask for shared interfaces, or a file that needs them. */
bool SharesInterfaces(const ToolOptions& options);

/** @throws UsageError if a surface of labels cannot be written to such a name. */
void CheckLabelOutput(const ToolOptions& options, const std::string& name);

/** A folder that was made before the work begins, and goes if nothing comes into it. */
class MadeFolders
{
public:
  MadeFolders() = default;
  ~MadeFolders();
  MadeFolders(const MadeFolders&) = delete;
  MadeFolders& operator=(const MadeFolders&) = delete;

  void Make(const std::string& name);

private:
  std::vector<std::string> Names; ///< that were not there, each before those in it
};

/**
 * As CheckFiles, now that the surfaces are known; makes the folders.
 * @throws Failure if a file is to hold several of them, too.
 */
void CheckLabelSurfaces(
  const ToolOptions& options, const std::vector<LabelSurface>& surfaces, MadeFolders& folders);

/**
 * Write the surfaces that have points, as the options ask for.
 * @param surfaces get their Files here
 * @param interfaces what they share, if they do
 * @param solids of files of tetrahedra of these
 * @param failures given what could not be written
 */
void WriteLabelSurfaces(const ToolOptions& options, std::vector<LabelSurface>& surfaces,
  vtkPolyData* interfaces, SolidMaker& solids, ProgressStyle style, Failures& failures);
}

#endif
