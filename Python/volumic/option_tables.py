# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The options of the command: their names, arguments and help.

Options that are properties of the filters stand in PROPERTIES, all others in INPUT and OUTPUT.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from typing import Any, NamedTuple

from .errors import UsageError
from .messages import number_text

Parse = Callable[[str], Any]


# ---- Parsers of values, which throw UsageError that names the text ------------------------------

def number(text: str) -> float:
    """A finite number."""
    if not re.fullmatch(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", text) \
            or not math.isfinite(float(text)):
        raise UsageError(f"'{text}' is not a number")
    return float(text)


def whole(text: str) -> int:
    """A whole number that an int of C holds."""
    if not re.fullmatch(r"[+-]?\d+", text) or abs(int(text)) >= 2 ** 31:
        raise UsageError(f"'{text}' is not a whole number")
    return int(text)


def at_least(least: int, parse: Parse = whole) -> Parse:
    """A number that is not less than a bound."""
    def parse_limited(text: str) -> Any:
        if parse(text) < least:
            raise UsageError(f"{text} is less than {least}")
        return parse(text)
    return parse_limited


def more_than_0(text: str) -> float:
    """A positive number."""
    if number(text) <= 0:
        raise UsageError(f"{text} must be more than 0")
    return number(text)


def numbers(count: int, parse: Parse = number) -> Callable[[str], tuple[Any, ...]]:
    """So many numbers with commas between."""
    def parse_all(text: str) -> tuple[Any, ...]:
        parts = text.split(",")
        if len(parts) != count:
            raise UsageError(f"'{text}' are {len(parts)} numbers, not {count}")
        return tuple(parse(part.strip()) for part in parts)
    return parse_all


def box(parse: Parse) -> Callable[[str], tuple[Any, ...]]:
    """From and to along each axis."""
    def parse_box(text: str) -> tuple[Any, ...]:
        found = numbers(6, parse)(text)
        if any(found[i] > found[i + 1] for i in (0, 2, 4)):
            raise UsageError(f"'{text}' ends before it begins")
        return found
    return parse_box


def one_of(*words: str, separator: str = ", ") -> Callable[[str], str]:
    """One of the words."""
    def parse(text: str) -> str:
        if text not in words:
            raise UsageError(f"'{text}' is none of {separator.join(words)}")
        return text
    return parse


def unit(text: str) -> str:
    """A unit of length."""
    from .reading.volume import METERS, unit_of
    return unit_of(text) or one_of(*METERS)(text)


# ---- Properties of the filters -----------------------------------------------------------------

SURFACE, PYRAMID, LABELS = "vtkDeformableSurface", "vtkImagePyramid", "vtkLabelsToSurfaces"


class Property(NamedTuple):
    """An option that sets a property of a filter."""
    option: str
    metavar: str  # of an enumeration its words, in the order of the values, with | between;
    name: str     # empty: the option has no argument and sets the property `name` to `value`
    help: str
    cls: str = SURFACE
    value: Any = None

    def get(self, filters: Any) -> str:
        """The text of the value that the filter has."""
        value = getattr(filters.by_class(self.cls), "Get" + self.name)()
        if "|" in self.metavar:
            return self.metavar.split("|")[value]
        if isinstance(value, bool):
            return "on" if value else "off"
        return value if isinstance(value, str) else number_text(value)

    def set(self, filters: Any, text: str) -> None:
        """Set the property. Throw UsageError if the text is not a value of it."""
        owner, value = filters.by_class(self.cls), self.value
        if "|" in self.metavar:
            words = self.metavar.split("|")
            value = words.index(one_of(*words, separator="|")(text))
        elif self.metavar:
            kind = type(getattr(owner, "Get" + self.name)())
            value = {str: str, int: whole, float: number}[kind](text)
        getattr(owner, "Set" + self.name)(value)
        if getattr(owner, "Get" + self.name)() != value:
            raise UsageError(f"'{text}' is out of range")


class Filters:
    """The filters whose properties the options set; `surface` is a vtkVolumeToSurface where a
    property decides on the levels of the pyramid."""

    def __init__(self, chooses_levels: bool = False) -> None:
        from . import vtkFiltersVolumic as vtk
        self.pyramid = vtk.vtkImagePyramid()
        self.surface = vtk.vtkVolumeToSurface() if chooses_levels else vtk.vtkDeformableSurface()
        self.labels = vtk.vtkLabelsToSurfaces()

    def by_class(self, name: str) -> Any:
        """The filter of a class."""
        return {SURFACE: self.surface, PYRAMID: self.pyramid, LABELS: self.labels}[name]

    def share(self) -> None:
        """Give the other filters the properties that they have in common with the surface's."""
        for owner, names in {self.labels: SHARED_WITH_LABELS,
                             self.pyramid: SHARED_WITH_PYRAMID}.items():
            for name in names:
                getattr(owner, "Set" + name)(getattr(self.surface, "Get" + name)())


SHARED_WITH_LABELS = ("Metric", "EdgeLength", "Tolerance", "MaximumEdgeLength", "Gradation",
                      "FinestLevel", "KeepComponents", "MinimumComponentVolume", "TimeLimit",
                      "NumberOfThreads", "ScratchDirectory")
SHARED_WITH_PYRAMID = ("SelectedComponent", "NaNIsBackground", "NumberOfThreads",
                       "ScratchDirectory")

PROPERTIES = (
    Property("iso", "VALUE", "IsoValue", "value of the image at the surface (default: Otsu's "
             "threshold, which is reported)"),
    Property("upper", "VALUE", "UpperValue", "the object is where the image lies between --iso "
             "and this value"),
    Property("dark", "", "ObjectIsBright", "the object is where the image is below --iso, or, "
             "with --upper, not between the two", value=False),
    Property("component", "N", "SelectedComponent", "component of voxels that have several, "
             "counted from 0; -1: their magnitude"),
    Property("refuse-nan", "", "NaNIsBackground", "refuse voxels that are NaN; without this "
             "option they are background", value=False),
    Property("levels", "N", "NumberOfLevels", "levels of the pyramid, the image included; 0: as "
             "many as --minimum-level-size allows", PYRAMID),
    Property("reduction-factor", "T", "ReductionFactor", "reduction factor between two levels "
             "along each axis, 1 < T < 2", PYRAMID),
    Property("minimum-level-size", "N", "MinimumLevelSize", "least number of voxels of a level "
             "along its smallest axis, unless --levels requests more levels", PYRAMID),
    Property("coarsest", "LEVEL", "CoarsestLevel", "level to start with; -1: the coarsest"),
    Property("finest", "LEVEL", "FinestLevel", "level to end with; 0: the image; -1: one level "
             "finer than the image"),
    Property("preview", "", "Preview", "end at the finest level of at most a million voxels, to "
             "try a value of --iso", value=True),
    Property("initialization", "icosahedron|seeds|iso-surface|input-surface", "Initialization",
             "initial surface: a rounded box around the image; the parts at --seed-position "
             "and --seeds, or seeds on a grid; the isosurface of the coarsest level; or --initial-surface"),
    Property("seed-radius", "LENGTH", "SeedRadius", "radius of the seeds in world units; 0: 1.2 "
             "times the shortest edge of the coarsest level"),
    Property("recovery", "none|objects|objects-and-cavities", "Recovery", "which features missed "
             "by coarser levels to recover"),
    Property("minimum-part-size", "N", "MinimumPartSize", "least number of voxels of a part that "
             "is recovered"),
    Property("border", "background|replicate", "BorderValue", "values outside the image: "
             "background, so that surfaces close at the border, or the nearest voxel"),
    Property("metric", "voxels|world", "Metric", "lengths that are uniform where voxels are not "
             "cubes: those in voxels, or those in the world"),
    Property("edge-length", "LENGTH", "EdgeLength", "mean edge length in world units; 0: one "
             "voxel of the finest level"),
    Property("tolerance", "LENGTH", "Tolerance", "longer edges where the surface stays within "
             "this distance of the isosurface, in world units; 0: uniform edges"),
    Property("maximum-edge-length", "LENGTH", "MaximumEdgeLength", "with --tolerance: longest "
             "edge in world units, at most five times the uniform one; 0: automatic"),
    Property("gradation", "SLOPE", "Gradation", "with --tolerance or --thin-parts: growth of the "
             "edge length per length along the surface, at most 0.3"),
    Property("thin-parts", "", "ThinParts", "shorter edges where the object, or the space in it, "
             "is thinner than two voxels", value=True),
    Property("sampling-ratio", "RATIO", "SamplingRatio", "shortest edge in voxels of the level, "
             "0.693 to 1; the longest is 2.5 times as long"),
    Property("tension", "WEIGHT", "TensionWeight", "weight of the force towards the barycentre of "
             "a vertex's neighbours"),
    Property("elasticity", "WEIGHT", "ElasticityWeight", "weight of the springs along the edges"),
    Property("isopotential", "WEIGHT", "IsopotentialWeight", "weight of the force along the "
             "normal towards --iso"),
    Property("gradient", "WEIGHT", "GradientWeight", "weight of the force along the gradient of "
             "the image"),
    Property("point-attraction", "WEIGHT", "PointAttractionWeight", "strength of the "
             "--attracting-points; 0: none"),
    Property("edge-attraction", "WEIGHT", "EdgeAttractionWeight", "strength of the map --edges; "
             "0: none; above --isopotential its edges stop the surface"),
    Property("friction", "VALUE", "Friction", "friction of the motion, more than 0"),
    Property("no-topology-changes", "", "TopologyChanges", "no merges and cuts: contacts stop the "
             "surface", value=False),
    Property("iterations", "N", "MaximumNumberOfIterations", "most iterations per level"),
    Property("convergence", "SHARE", "ConvergenceTolerance", "a level has converged when the "
             "enclosed volume changes by less than this share"),
    Property("no-freeze", "", "FreezeMotionlessVertices", "update converged vertices too (slower)",
             value=False),
    Property("no-snap", "", "SnapToIsoValue", "do not move vertices onto the isosurface at the "
             "end of a level", value=False),
    Property("keep", "all|largest|at-points|large|not-at-seeds", "KeepComponents", "components to "
             "write: all; the one of the largest area; those at seeds or attracting points; those "
             "of --minimum-component-volume; or all but those at seeds"),
    Property("minimum-component-volume", "VOLUME", "MinimumComponentVolume", "with --keep large: "
             "least enclosed volume in world units cubed"),
    Property("time-limit", "SECONDS", "TimeLimit", "write the surface, or the mesh of labels, as "
             "it is after so many seconds; 0: no limit"),
    Property("scratch", "DIR", "ScratchDirectory", "folder for memory-mapped files of large "
             "arrays; they vanish with the process"),
    Property("threads", "N", "NumberOfThreads", "number of threads; 0: all; the result does not "
             "depend on it"),
    Property("snapshot-interval", "N", "SnapshotInterval", "iterations between two --snapshots; "
             "0: none"),
    Property("background", "LABEL", "BackgroundLabel", "with --labels: label that denotes "
             "background", LABELS),
    Property("merge", "", "Merge", "with --labels: one surface around all of them",
             LABELS, value=True),
    Property("smoothing", "VOXELS", "Smoothing", "with --labels: smoothing distance in smallest "
             "voxel distances; 0: none", LABELS),
    Property("voxel-tolerance", "VOXELS", "VoxelTolerance", "with --labels: how far a voxel "
             "centre may lie on the wrong side, in smallest voxel distances, at most 1; 0: every "
             "centre on its side; -1: a quarter of --smoothing, at most 1", LABELS),
    Property("box-faces", "rounded|flat|periodic", "BoxFaces", "with --labels: shape at the "
             "border of the volume; flat: in its planes, with edges and corners; periodic: also "
             "equal triangles on opposite sides", LABELS),
    Property("shared-interfaces", "", "SharedInterfaces", "no effect: labels always share their "
             "interfaces", LABELS, value=True),
)


def is_of_labels(item: Property) -> bool:
    """Whether label maps have this property. Their component is selected before the filter."""
    return item.cls == LABELS or item.name in (*SHARED_WITH_LABELS, "SelectedComponent")


# ---- All other options -------------------------------------------------------------------------

class Option(NamedTuple):
    """An option that is no property."""
    option: str
    metavar: str  # empty: no argument
    help: str
    parse: Parse = str
    several: bool = False  # a list of all that are given


INPUT = (
    Option("array", "NAME", "array of the volume to use (default: the active scalars)"),
    Option("spacing", "X,Y,Z", "voxel distances along the axes instead of the file's, in its unit",
           numbers(3, more_than_0)),
    Option("region", "I0,I1,J0,J1,K0,K1", "use only these voxels: first and last along each axis, "
           "as --list-labels counts them; surfaces close at the border of the region", box(whole)),
    Option("region-box", "X0,X1,Y0,Y1,Z0,Z1",
           "the same as a box in world coordinates: all voxels that it touches", box(number)),
    Option("resample", "X,Y,Z", "resample the volume to these voxel distances: linearly, a label "
           "map to the nearest voxel", numbers(3, more_than_0)),
    Option("isotropic", "", "resample the volume to the smallest of its three voxel distances"),
    Option("scale", "FACTOR", "multiply all lengths and positions of the volume by this factor",
           more_than_0),
    Option("unit", "m|mm|um", "unit of length of everything that is written and of lengths in "
           "options, where the file states its own unit (also cm, nm, A)", unit),
    Option("space", "LPS|RAS|as-file", "axes of the world of everything that is written: left, "
           "posterior, superior (DICOM), or right, anterior, superior (NIfTI), where the file "
           "states its own axes", one_of("LPS", "RAS", "as-file")),
    Option("series", "N|UID", "DICOM series to read, by its number in --list-series or its UID"),
    Option("list-series", "", "print the DICOM series of the volume: number, description, kind, "
           "date, slices, UID"),
    Option("time", "N", "which of several volumes in one file (times, phases, masks) to read, "
           "counted from 0", at_least(0)),
    Option("phase", "N", "the same as --time", at_least(0)),
    Option("raw", "X,Y,Z,TYPE[,big]", "the file has no header: sizes and type of its voxels, such "
           "as 512,512,400,uint16; x fastest, least significant byte first"),
    Option("no-resampling", "", "refuse volumes that are no regular grid (missing slices, gantry "
           "tilt, shear) instead of interpolating them linearly"),
    Option("seeds", "FILE", "surfaces of the parts at these points: those of a mesh file, or lines "
           "'x y z' of a .txt, .csv or .xyz file; world coordinates"),
    Option("seed-position", "X,Y,Z", "surface of the part at this point in the world; may be "
           "repeated", numbers(3), True),
    Option("initial-surface", "FILE", "start from this closed surface: .vtp, .vtk, .stl, .ply or "
           ".obj; world coordinates"),
    Option("attracting-points", "FILE", "points that belong to the object: those of a mesh file "
           "with its arrays Weight and Radius, or lines 'x y z [weight [radius]]' of a .txt, .csv "
           "or .xyz file; world coordinates"),
    Option("attracting-position", "X,Y,Z", "a point in the world that belongs to the object; may "
           "be repeated", numbers(3), True),
    Option("edges", "NAME|FILE", "map that is large on edges (--edge-attraction, 2 unless given): "
           "an array of the volume, or a volume of the same size"),
    Option("ends", "closed|marked|open", "surface where the object leaves the volume: a round cap "
           "(default); marked: cut in a plane and closed by flat caps that the cell array Cap "
           "numbers; open: cut and left open, for flow", one_of("closed", "marked", "open")),
    Option("triangles", "N", "find the --tolerance, or the --edge-length, with which the surface "
           "has about so many triangles, a tenth more or less", at_least(20)),
    Option("probe", "FILE", "give vertices the values of this volume as an array named as the "
           "file; it may have a grid, a space and a unit of its own; may be repeated", str, True),
    Option("probe-depth", "LENGTH", "with --probe: mean of the values from the surface so far "
           "inward, in world units", at_least(0, number)),
    Option("labels", "all|LIST", "the volume is a label map: make a surface of each of these "
           "labels: numbers, ranges and names with commas between, such as 1,7-9,liver,lung_*",
           str, True),
    Option("list-labels", "", "print the labels of the volume, or those of --labels: number, "
           "voxels, volume, box of voxel indices, name; with --report as JSON"),
    Option("label-names", "FILE", "names and colours of labels: JSON, ITK-SNAP label "
           "descriptions, a colour table or .csv (default: those of the volume, or of a file "
           "beside it)"),
)
OUTPUT = (
    Option("format", "SUFFIX", "with --labels: suffix of the files in a folder, such as stl "
           "(default: vtp)"),
    Option("history", "FILE.csv", "write a row per iteration"),
    Option("levels-output", "FILE.vtm|DIR", "write the surface of each level: as blocks, or as "
           "level-0.vtp, level-1.vtp, ... in a folder"),
    Option("snapshots", "FILE.vtm|DIR", "write the surface every --snapshot-interval iterations "
           "(10 unless given), as blocks, or as snapshot-0.vtp, ... in a folder"),
    Option("report", "FILE.json", "write components, genus, area, volume, seconds, ...; - for the "
           "standard output"),
    Option("write-volume", "FILE.vti", "write the volume as it was read"),
    Option("mesher", "tetgen|gmsh", "program that fills surfaces with tetrahedra for .vtu, .inp "
           "and, with this option, .msh (default: the first that is installed)",
           one_of("tetgen", "gmsh")),
    Option("maximum-volume", "VOLUME", "largest volume of a tetrahedron in world units cubed; "
           "approximate with gmsh", more_than_0),
    Option("quiet", "", "print errors only"),
    Option("progress", "", "print progress lines even if the standard error is no terminal"),
    Option("list-properties", "", "print the options that are properties of the filters: class, "
           "property, option, default"),
    Option("list-files", "", "print the files that the volume is read from"),
)
