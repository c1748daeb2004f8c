// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceProperties.h"

#include "Texts.h"
#include "ToolErrors.h"

#include <vtkDeformableSurface.h>
#include <vtkImagePyramid.h>
#include <vtkLabelsToSurfaces.h>

#include <algorithm>
#include <map>

namespace tool
{
namespace
{
std::string JoinNames(const std::vector<std::string>& names)
{
  std::string joined;
  for (const std::string& name : names)
  {
    joined += (joined.empty() ? "" : "|") + name;
  }
  return joined;
}

int FindName(const std::vector<std::string>& names, const std::string& name)
{
  const auto found = std::find(names.begin(), names.end(), name);
  FailIf<UsageError>(found == names.end(), "'" + name + "' is none of " + JoinNames(names));
  return static_cast<int>(found - names.begin());
}

// A line per property. FILTER is Surface, Pyramid or Labels; the type of a number is its getter's.
#define VOLUMIC_NUMBER(FILTER, CLASS, PROPERTY, OPTION, ARGUMENT, HELP)                            \
  PropertyOption                                                                                   \
  {                                                                                                \
    OPTION, ARGUMENT, CLASS, #PROPERTY, HELP,                                                      \
      [](const FilterTrio& filters) { return NumberText(filters.FILTER->Get##PROPERTY()); },       \
      [](const FilterTrio& filters, const std::string& text)                                       \
    {                                                                                              \
      filters.FILTER->Set##PROPERTY(ParseNumber<decltype(filters.FILTER->Get##PROPERTY())>(text)); \
    }                                                                                              \
  }
#define SURFACE_NUMBER(PROPERTY, OPTION, ARGUMENT, HELP) \
  VOLUMIC_NUMBER(Surface, "vtkDeformableSurface", PROPERTY, OPTION, ARGUMENT, HELP)
#define PYRAMID_NUMBER(PROPERTY, OPTION, ARGUMENT, HELP) \
  VOLUMIC_NUMBER(Pyramid, "vtkImagePyramid", PROPERTY, OPTION, ARGUMENT, HELP)
#define LABELS_NUMBER(PROPERTY, OPTION, ARGUMENT, HELP) \
  VOLUMIC_NUMBER(Labels, "vtkLabelsToSurfaces", PROPERTY, OPTION, ARGUMENT, HELP)

// An option without argument that gives a boolean property the value that is not its default.
#define VOLUMIC_SWITCH(FILTER, CLASS, PROPERTY, VALUE, OPTION, HELP)                               \
  PropertyOption                                                                                   \
  {                                                                                                \
    OPTION, "", CLASS, #PROPERTY, HELP,                                                            \
      [](const FilterTrio& filters)                                                                \
    { return std::string(filters.FILTER->Get##PROPERTY() ? "on" : "off"); },                       \
      [](const FilterTrio& filters, const std::string&) { filters.FILTER->Set##PROPERTY(VALUE); }, \
      VALUE                                                                                        \
  }
#define SURFACE_SWITCH(PROPERTY, VALUE, OPTION, HELP) \
  VOLUMIC_SWITCH(Surface, "vtkDeformableSurface", PROPERTY, VALUE, OPTION, HELP)
#define LABELS_SWITCH(PROPERTY, VALUE, OPTION, HELP) \
  VOLUMIC_SWITCH(Labels, "vtkLabelsToSurfaces", PROPERTY, VALUE, OPTION, HELP)

// An enumeration; its names in the order of its values.
template <class Getter, class Setter>
PropertyOption Menu(const char* filter, const char* property, const char* option, const char* help,
  const std::vector<std::string>& names, Getter get, Setter set)
{
  return PropertyOption{ option, JoinNames(names), filter, property, help,
    [=](const FilterTrio& filters) { return names.at(get(filters)); },
    [=](const FilterTrio& filters, const std::string& text)
    { set(filters, FindName(names, text)); } };
}

#define VOLUMIC_MENU(FILTER, CLASS, PROPERTY, OPTION, HELP, ...)               \
  Menu(                                                                        \
    CLASS, #PROPERTY, OPTION, HELP, { __VA_ARGS__ },                           \
    [](const FilterTrio& filters) { return filters.FILTER->Get##PROPERTY(); }, \
    [](const FilterTrio& filters, int value) { filters.FILTER->Set##PROPERTY(value); })
#define SURFACE_MENU(PROPERTY, OPTION, HELP, ...) \
  VOLUMIC_MENU(Surface, "vtkDeformableSurface", PROPERTY, OPTION, HELP, __VA_ARGS__)
#define LABELS_MENU(PROPERTY, OPTION, HELP, ...) \
  VOLUMIC_MENU(Labels, "vtkLabelsToSurfaces", PROPERTY, OPTION, HELP, __VA_ARGS__)

std::vector<PropertyOption> MakeProperties()
{
  return {
    SURFACE_NUMBER(IsoValue, "iso", "VALUE",
      "the value of the image at the surface that is searched, in the units of the voxels; without "
      "this option Otsu's threshold of the image, which is told"),
    SURFACE_NUMBER(UpperValue, "upper", "VALUE",
      "the object is where the image is between --iso and this: marrow in bone, one of two "
      "materials"),
    SURFACE_SWITCH(ObjectIsBright, false, "dark",
      "the object is where the image is below --iso, or, with --upper, not between the two"),
    SURFACE_NUMBER(SelectedComponent, "component", "N",
      "the component to use of voxels that have several, counted from 0; -1: their magnitude"),
    SURFACE_SWITCH(NaNIsBackground, false, "refuse-nan",
      "refuse voxels that are NaN, which are background otherwise"),
    PYRAMID_NUMBER(NumberOfLevels, "levels", "N",
      "levels of the pyramid, the image itself included; 0: as many as --minimum-level-size "
      "allows"),
    PYRAMID_NUMBER(ReductionFactor, "reduction-factor", "T",
      "how many times fewer voxels a level has along each axis than the one below; 1 < T < 2"),
    PYRAMID_NUMBER(MinimumLevelSize, "minimum-level-size", "N",
      "no level whose smallest axis has fewer voxels, unless --levels asks for it"),
    SURFACE_NUMBER(CoarsestLevel, "coarsest", "LEVEL", "level to begin with; -1: the last"),
    SURFACE_NUMBER(FinestLevel, "finest", "LEVEL",
      "level to end with; 0: the image itself; -1: once more divided, finer than the image"),
    SURFACE_SWITCH(Preview, true, "preview",
      "end at a coarse level of at most a million voxels, to try a value of --iso"),
    SURFACE_MENU(Initialization, "initialization",
      "what to start from: a rounded box about the image; seeds, at --seed-position and the "
      "points of --seeds, or on a grid; the iso-surface of the coarsest level; or "
      "--initial-surface",
      "icosahedron", "seeds", "iso-surface", "input-surface"),
    SURFACE_NUMBER(SeedRadius, "seed-radius", "LENGTH",
      "radius of the seeds in world units; 0: 1.2 times the shortest edge of the coarsest level"),
    SURFACE_MENU(Recovery, "recovery",
      "what to find again that a coarser level has lost: nothing; parts of the object; those and "
      "the cavities in it",
      "none", "objects", "objects-and-cavities"),
    SURFACE_NUMBER(MinimumPartSize, "minimum-part-size", "N",
      "voxels of the level that a part needs to be recovered"),
    SURFACE_MENU(BorderValue, "border",
      "what is outside the image: background, so that surfaces close at the border, or the nearest "
      "voxel",
      "background", "replicate"),
    SURFACE_MENU(Metric, "metric",
      "which lengths are uniform where voxels are not cubes: those in which each voxel is one, or "
      "those of the world",
      "voxels", "world"),
    SURFACE_NUMBER(EdgeLength, "edge-length", "LENGTH",
      "mean edge that is wanted, in world units; 0: as --finest and --sampling-ratio have it"),
    SURFACE_NUMBER(Tolerance, "tolerance", "LENGTH",
      "longer edges where the surface stays so near to the iso-value, in world units: fewer "
      "triangles; 0: all edges of one length"),
    SURFACE_NUMBER(MaximumEdgeLength, "maximum-edge-length", "LENGTH",
      "with --tolerance: no edge is to be longer, in world units; 0: automatic, about six times "
      "the mean without; five times what edges may be without at most"),
    SURFACE_NUMBER(Gradation, "gradation", "SLOPE",
      "with --tolerance or --thin-parts: by how much edges grow per length walked, at most 0.3"),
    SURFACE_SWITCH(ThinParts, true, "thin-parts",
      "shorter edges where the object, or the air in it, is thinner than two voxels, and nowhere "
      "else: holds walls, gaps and vessels that are a voxel thin"),
    SURFACE_NUMBER(SamplingRatio, "sampling-ratio", "RATIO",
      "shortest edge of the surface in voxels of the level, 0.693 to 1; edges are up to 2.5 times "
      "as long"),
    SURFACE_NUMBER(TensionWeight, "tension", "WEIGHT",
      "weight of the force to the barycentre of a vertex's neighbours"),
    SURFACE_NUMBER(
      ElasticityWeight, "elasticity", "WEIGHT", "weight of the springs along the edges"),
    SURFACE_NUMBER(IsopotentialWeight, "isopotential", "WEIGHT",
      "weight of the force along the normal to the iso-value"),
    SURFACE_NUMBER(
      GradientWeight, "gradient", "WEIGHT", "weight of the force along the image's gradient"),
    SURFACE_NUMBER(PointAttractionWeight, "point-attraction", "WEIGHT",
      "how much the points of --attracting-points make what is around them a part of the object; "
      "0: not at all"),
    SURFACE_NUMBER(EdgeAttractionWeight, "edge-attraction", "WEIGHT",
      "how much the edges of the map --edges attract the surface; 0: not at all; more than "
      "--isopotential: they stop it"),
    SURFACE_NUMBER(Friction, "friction", "VALUE", "little oscillates, much is slow; more than 0"),
    SURFACE_SWITCH(TopologyChanges, false, "no-topology-changes",
      "no merges and cuts: the surface keeps its topology, contacts stop it"),
    SURFACE_NUMBER(MaximumNumberOfIterations, "iterations", "N", "iterations per level at most"),
    SURFACE_NUMBER(ConvergenceTolerance, "convergence", "SHARE",
      "a level rests when the enclosed volume changes by less than this share of it"),
    SURFACE_SWITCH(
      FreezeMotionlessVertices, false, "no-freeze", "compute vertices at rest too (slower)"),
    SURFACE_SWITCH(SnapToIsoValue, false, "no-snap",
      "don't move vertices onto the iso-value at the end of a level"),
    SURFACE_MENU(KeepComponents, "keep",
      "which components are written: all; the one of the largest area; those at seeds or "
      "points known to belong to the object (--seeds, --attracting-points and so on); "
      "those of --minimum-component-volume; or all but those at seeds; cavities stay with theirs",
      "all", "largest", "at-points", "large", "not-at-seeds"),
    SURFACE_NUMBER(MinimumComponentVolume, "minimum-component-volume", "VOLUME",
      "what a component must enclose to be large, in world units cubed"),
    SURFACE_NUMBER(TimeLimit, "time-limit", "SECONDS",
      "write the surface as it is so long after its evolution began, with --labels those that are "
      "finished; 0: no limit"),
    { "memory", "SIZE", "vtkDeformableSurface", "MemoryLimit",
      "memory that the process may have, such as 2G or 1500M; what does not fit waits in files of "
      "--scratch; 0: no limit; the result does not depend on it",
      [](const FilterTrio& filters) { return MebibytesText(filters.Surface->GetMemoryLimit()); },
      [](const FilterTrio& filters, const std::string& text)
      { filters.Surface->SetMemoryLimit(ParseMebibytes(text)); } },
    { "scratch", "DIR", "vtkDeformableSurface", "ScratchDirectory",
      "with --memory: the folder for these files, on a disk with room for all of them; they vanish "
      "with the process; empty: TMPDIR of the environment, or /var/tmp",
      [](const FilterTrio& filters) { return std::string(filters.Surface->GetScratchDirectory()); },
      [](const FilterTrio& filters, const std::string& text)
      { filters.Surface->SetScratchDirectory(text.c_str()); } },
    SURFACE_SWITCH(Resume, true, "resume",
      "go on from the checkpoint that a run with the same volume and options, which was killed or "
      "stopped, has left in --scratch; where there is none, begin anew"),
    SURFACE_NUMBER(NumberOfThreads, "threads", "N", "0: all; the result does not depend on it"),
    SURFACE_SWITCH(Profile, true, "profile", "put into --history where the time goes"),
    SURFACE_NUMBER(SnapshotInterval, "snapshot-interval", "N",
      "iterations from one of the --snapshots to the next; 0: none"),
    LABELS_NUMBER(BackgroundLabel, "background", "LABEL",
      "with --labels: the label that is nothing, and not one of all"),
    LABELS_SWITCH(Merge, true, "merge", "with --labels: one surface about all of them together"),
    LABELS_NUMBER(Smoothing, "smoothing", "VOXELS",
      "with --labels: how far the stairs between voxels are smoothed, in smallest distances of "
      "voxels or 5/8 of the longest; 0: not at all"),
    LABELS_NUMBER(VoxelTolerance, "voxel-tolerance", "VOXELS",
      "with --labels: how far the centre of a voxel may be on the wrong side, in "
      "smallest distances of voxels: .5 (default) makes noise and stairs smooth, 0 keeps each voxel"),
    LABELS_NUMBER(Gap, "gap", "LENGTH",
      "with --labels: the space between the surfaces of neighbours, in world units"),
    LABELS_SWITCH(SharedInterfaces, true, "shared-interfaces",
      "with --labels: one mesh, in which neighbours have the same triangles between them; a file "
      "of solids or for their meshers, .vtu, .inp, .msh, .smesh or .poly, implies it"),
    LABELS_MENU(BoxFaces, "box-faces",
      "with --labels as one mesh: what surfaces are where labels reach the border of the volume; "
      "flat: in its planes, with edges and corners, for boundary conditions of a box; periodic: "
      "with "
      "the same triangles on opposite sides, too",
      "rounded", "flat", "periodic"),
  };
}
}

const std::vector<PropertyOption>& SurfaceProperties()
{
  static const std::vector<PropertyOption> properties = MakeProperties();
  return properties;
}

bool IsOfLabelsOnly(const PropertyOption& option)
{
  return option.Class == "vtkLabelsToSurfaces";
}

// What the labels' filter has of the surface's, and how it gets it.
#define SHARED(PROPERTY)                                                                        \
  {                                                                                             \
#PROPERTY, [](const FilterTrio& f) { f.Labels->Set##PROPERTY(f.Surface->Get##PROPERTY()); } \
  }
static const std::map<std::string, std::function<void(const FilterTrio&)>> Shared = { SHARED(
                                                                                        Metric),
  SHARED(EdgeLength), SHARED(Tolerance), SHARED(MaximumEdgeLength), SHARED(Gradation),
  SHARED(ThinParts), SHARED(FinestLevel), SHARED(KeepComponents), SHARED(MinimumComponentVolume),
  SHARED(TimeLimit), SHARED(NumberOfThreads), SHARED(MemoryLimit), SHARED(ScratchDirectory) };

bool IsOfLabels(const PropertyOption& option)
{
  // The component is taken out of the volume before.
  return IsOfLabelsOnly(option) || option.Property == "SelectedComponent" ||
    Shared.count(option.Property) > 0;
}

void ShareProperties(const FilterTrio& filters)
{
  for (const auto& [property, share] : Shared)
  {
    share(filters);
  }
}

void ShareWithPyramid(vtkDeformableSurface* filter, vtkImagePyramid* pyramid)
{
  pyramid->SetSelectedComponent(filter->GetSelectedComponent());
  pyramid->SetNaNIsBackground(filter->GetNaNIsBackground());
  pyramid->SetNumberOfThreads(filter->GetNumberOfThreads());
  pyramid->SetMemoryLimit(filter->GetMemoryLimit());
  pyramid->SetScratchDirectory(filter->GetScratchDirectory());
}
}
