# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Options of the command: names, arguments and help.

PROPERTIES lists the options that set properties of filters, INPUT and OUTPUT the others.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from typing import Any, NamedTuple

from .errors import UsageError
from .messages import number_text

Parse = Callable[[str], Any]


# ---- Parsers of values; they raise UsageError ---------------------------------------------------

def number(text: str) -> float:
    if not re.fullmatch(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", text) \
            or not math.isfinite(float(text)):
        raise UsageError(f"'{text}' is not a number")
    return float(text)


def integer(text: str) -> int:
    """Return an integer that fits a C int."""
    if not re.fullmatch(r"[+-]?\d+", text) or abs(int(text)) >= 2 ** 31:
        raise UsageError(f"'{text}' is not an integer")
    return int(text)


def at_least(bound: int, parse: Parse = integer) -> Parse:
    """Return a parser of numbers that are not less than a bound."""
    def parse_limited(text: str) -> Any:
        if parse(text) < bound:
            raise UsageError(f"{text} is less than {bound}")
        return parse(text)
    return parse_limited


def positive(text: str) -> float:
    if number(text) <= 0:
        raise UsageError(f"{text} is not greater than 0")
    return number(text)


def numbers(count: int, parse: Parse = number) -> Callable[[str], tuple[Any, ...]]:
    """Return a parser of `count` numbers separated by commas."""
    def parse_all(text: str) -> tuple[Any, ...]:
        parts = text.split(",")
        if len(parts) != count:
            raise UsageError(f"'{text}' has {len(parts)} numbers instead of {count}")
        return tuple(parse(part.strip()) for part in parts)
    return parse_all


def box(parse: Parse) -> Callable[[str], tuple[Any, ...]]:
    """Return a parser of bounds: minimum and maximum along each axis."""
    def parse_box(text: str) -> tuple[Any, ...]:
        found = numbers(6, parse)(text)
        if any(found[i] > found[i + 1] for i in (0, 2, 4)):
            raise UsageError(f"'{text}': a minimum exceeds its maximum")
        return found
    return parse_box


def one_of(*values: str, separator: str = ", ") -> Callable[[str], str]:
    """Return a parser that accepts the given values only."""
    def parse(text: str) -> str:
        if text not in values:
            raise UsageError(f"'{text}' is not one of {separator.join(values)}")
        return text
    return parse


def unit(text: str) -> str:
    """Return a unit of length, a key of METERS."""
    from .reading.volume import METERS, unit_of
    return unit_of(text) or one_of(*METERS)(text)


# ---- Properties of the filters -----------------------------------------------------------------

SURFACE, PYRAMID, LABELS = "vtkDeformableSurface", "vtkImagePyramid", "vtkLabelsToSurfaces"


class Property(NamedTuple):
    """An option that sets a property of a filter. With an empty metavar it takes no argument and
    sets the property to `value`. A metavar such as `a|b` lists the values of an enumeration."""
    option: str
    metavar: str
    name: str
    help: str
    cls: str = SURFACE
    value: Any = None

    def get(self, filters: Any) -> str:
        value = getattr(filters.by_class(self.cls), "Get" + self.name)()
        if "|" in self.metavar:
            return self.metavar.split("|")[value]
        if isinstance(value, bool):
            return "on" if value else "off"
        return value if isinstance(value, str) else number_text(value)

    def set(self, filters: Any, text: str) -> None:
        """Set the property. Raise UsageError if the value is invalid."""
        owner, value = filters.by_class(self.cls), self.value
        if "|" in self.metavar:
            names = self.metavar.split("|")
            value = names.index(one_of(*names, separator="|")(text))
        elif self.metavar:
            kind = type(getattr(owner, "Get" + self.name)())
            value = {str: str, int: integer, float: number}[kind](text)
        getattr(owner, "Set" + self.name)(value)
        if getattr(owner, "Get" + self.name)() != value:
            raise UsageError(f"'{text}' is out of range")


class Filters:
    """The filters that the options configure. `surface` is a vtkVolumeToSurface if it builds the
    pyramid itself, otherwise a vtkDeformableSurface."""

    def __init__(self, chooses_levels: bool = False) -> None:
        from . import vtkFiltersVolumic as vtk
        self.pyramid = vtk.vtkImagePyramid()
        self.surface = vtk.vtkVolumeToSurface() if chooses_levels else vtk.vtkDeformableSurface()
        self.labels = vtk.vtkLabelsToSurfaces()

    def by_class(self, name: str) -> Any:
        return {SURFACE: self.surface, PYRAMID: self.pyramid, LABELS: self.labels}[name]

    def copy_common_properties(self) -> None:
        """Copy properties common to several filters from `surface` to the others."""
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
    Property("iso", "VALUE", "IsoValue", "iso-value: image value at the surface (default: Otsu's "
             "threshold, printed)"),
    Property("upper", "VALUE", "UpperValue", "the object is where image values are between --iso "
             "and this value"),
    Property("dark", "", "ObjectIsBright", "the object is where image values are below --iso; with "
             "--upper: not between --iso and --upper", value=False),
    Property("component", "N", "SelectedComponent", "component of multi-component voxels, counted "
             "from 0; -1: magnitude"),
    Property("refuse-nan", "", "NaNIsBackground", "fail if voxels are NaN; without this option, "
             "they are background", value=False),
    Property("levels", "N", "NumberOfLevels", "number of pyramid levels, including the image; 0: "
             "as many as --minimum-level-size allows", PYRAMID),
    Property("reduction-factor", "T", "ReductionFactor", "reduction factor between two consecutive "
             "pyramid levels along each axis, 1 < T < 2", PYRAMID),
    Property("minimum-level-size", "N", "MinimumLevelSize", "minimum number of voxels of a level "
             "along its smallest axis; ignored with --levels", PYRAMID),
    Property("coarsest", "LEVEL", "CoarsestLevel", "first level; -1: the coarsest"),
    Property("finest", "LEVEL", "FinestLevel", "last level; 0: the image; -1: one level finer"),
    Property("preview", "", "Preview", "stop at the finest level of at most a million voxels, to "
             "test a value of --iso", value=True),
    Property("initialization", "icosahedron|seeds|iso-surface|input-surface", "Initialization",
             "initial surface: icosahedron around the image; seeds at --seed-position and --seeds, "
             "by default on a grid; isosurface of the coarsest level; or --initial-surface"),
    Property("seed-radius", "LENGTH", "SeedRadius", "radius of the seeds in world units; 0: 1.2 "
             "times the minimum edge length of the coarsest level"),
    Property("recovery", "none|objects|objects-and-cavities", "Recovery", "which features missed "
             "by coarser levels to recover"),
    Property("minimum-part-size", "N", "MinimumPartSize", "minimum voxels per recovered part"),
    Property("border", "background|replicate", "BorderValue", "values outside the image: "
             "background (surfaces close at the border) or value of the nearest voxel"),
    Property("metric", "voxels|world", "Metric", "units in which edge lengths are uniform: voxels "
             "or world units; they differ for anisotropic voxels"),
    Property("edge-length", "LENGTH", "EdgeLength", "mean edge length in world units; 0: one voxel "
             "of the finest level"),
    Property("tolerance", "LENGTH", "Tolerance", "coarsen the mesh where it stays within this "
             "distance of the isosurface, in world units; 0: uniform edges"),
    Property("maximum-edge-length", "LENGTH", "MaximumEdgeLength", "with --tolerance: maximum edge "
             "length in world units, at most 5 times the uniform length; 0: automatic"),
    Property("gradation", "SLOPE", "Gradation", "with --tolerance or --thin-parts: maximum growth "
             "of the edge length per length along the surface, at most 0.3"),
    Property("thin-parts", "", "ThinParts", "refine the mesh where the object or a gap is thinner "
             "than two voxels", value=True),
    Property("sampling-ratio", "RATIO", "SamplingRatio", "minimum edge length in voxels of the "
             "level, 0.693 to 1; the maximum is 2.5 times as long"),
    Property("tension", "WEIGHT", "TensionWeight", "weight of the force towards the barycentre of "
             "the neighbouring vertices"),
    Property("elasticity", "WEIGHT", "ElasticityWeight", "weight of the spring forces along edges"),
    Property("isopotential", "WEIGHT", "IsopotentialWeight", "weight of the force along the normal "
             "towards the isosurface"),
    Property("gradient", "WEIGHT", "GradientWeight", "weight of the image gradient force"),
    Property("point-attraction", "WEIGHT", "PointAttractionWeight", "weight of "
             "--attracting-points; 0: no attraction"),
    Property("edge-attraction", "WEIGHT", "EdgeAttractionWeight", "weight of the edge map --edges; "
             "0: no attraction; above --isopotential, edges stop the surface"),
    Property("friction", "VALUE", "Friction", "friction coefficient, greater than 0"),
    Property("no-topology-changes", "", "TopologyChanges", "disable merges and cuts: the surface "
             "stops at contacts", value=False),
    Property("iterations", "N", "MaximumNumberOfIterations", "maximum number of iterations per "
             "level"),
    Property("convergence", "FRACTION", "ConvergenceTolerance", "a level has converged if the "
             "relative change of the enclosed volume is less than this value"),
    Property("no-freeze", "", "FreezeMotionlessVertices", "also update converged vertices (slower)",
             value=False),
    Property("no-snap", "", "SnapToIsoValue", "do not move vertices onto the isosurface at the end "
             "of a level", value=False),
    Property("keep", "all|largest|at-points|large|not-at-seeds", "KeepComponents", "components to "
             "write: all; the largest by area; those at seeds or attracting points; those of at "
             "least --minimum-component-volume; all but those at seeds"),
    Property("minimum-component-volume", "VOLUME", "MinimumComponentVolume", "with --keep large: "
             "minimum enclosed volume in cubic world units"),
    Property("time-limit", "SECONDS", "TimeLimit", "stop after this time and write the current "
             "surface; 0: no limit"),
    Property("scratch", "DIR", "ScratchDirectory", "store large arrays in memory-mapped files in "
             "this folder; they are deleted when the process ends"),
    Property("threads", "N", "NumberOfThreads", "number of threads; 0: all processors; the result "
             "does not depend on it"),
    Property("snapshot-interval", "N", "SnapshotInterval", "number of iterations between "
             "--snapshots; 0: no snapshots"),
    Property("background", "LABEL", "BackgroundLabel", "with --labels: label that denotes "
             "background", LABELS),
    Property("merge", "", "Merge", "with --labels: one surface around the union of all labels",
             LABELS, value=True),
    Property("smoothing", "VOXELS", "Smoothing", "with --labels: smoothing distance in units of "
             "the smallest voxel spacing, at most 10; 0: none", LABELS),
    Property("voxel-tolerance", "VOXELS", "VoxelTolerance", "with --labels: maximum distance of a "
             "misclassified voxel centre from the surface, in units of the smallest voxel spacing, "
             "at most 1; 0: no misclassified voxels; -1: a quarter of --smoothing, at most 1",
             LABELS),
    Property("box-faces", "rounded|flat|periodic", "BoxFaces", "with --labels: shape at the border "
             "of the volume: rounded; flat, in the planes of its faces; or periodic, flat with "
             "equal triangles on opposite faces", LABELS),
    Property("shared-interfaces", "", "SharedInterfaces", "deprecated, no effect: adjacent labels "
             "always share their interface", LABELS, value=True),
)


def applies_to_labels(item: Property) -> bool:
    """Return whether a property applies to label maps, or selects their component."""
    return item.cls == LABELS or item.name in (*SHARED_WITH_LABELS, "SelectedComponent")


# ---- All other options -------------------------------------------------------------------------

class Option(NamedTuple):
    """An option that is not a property of a filter."""
    option: str
    metavar: str  # empty: no argument
    help: str
    parse: Parse = str
    repeatable: bool = False  # parsed to a list


INPUT = (
    Option("array", "NAME", "array of the volume to read (default: the active scalars)"),
    Option("spacing", "X,Y,Z", "voxel spacing that replaces that of the file, in its unit",
           numbers(3, positive)),
    Option("region", "I0,I1,J0,J1,K0,K1", "crop the volume to these voxels: first and last index "
           "along each axis, as in --list-labels; surfaces close at the border of the region",
           box(integer)),
    Option("region-box", "X0,X1,Y0,Y1,Z0,Z1", "crop the volume to the voxels that intersect a box "
           "in world coordinates", box(number)),
    Option("resample", "X,Y,Z", "resample the volume to this voxel spacing: linear interpolation, "
           "for label maps nearest neighbour", numbers(3, positive)),
    Option("isotropic", "", "resample the volume to the smallest of its three spacings"),
    Option("scale", "FACTOR", "multiply lengths and positions of the volume by this factor",
           positive),
    Option("unit", "m|mm|um", "unit of length of all outputs and options (also cm, nm, A); "
           "requires a file that states its unit", unit),
    Option("space", "LPS|RAS|as-file", "coordinate system of all outputs: left, posterior, "
           "superior (DICOM) or right, anterior, superior (NIfTI); requires a file that states its "
           "coordinate system", one_of("LPS", "RAS", "as-file")),
    Option("series", "N|UID", "DICOM series to read: its number in --list-series or its UID"),
    Option("list-series", "", "print the DICOM series of the volume: number, description, "
           "modality, date, slices, UID"),
    Option("time", "N", "volume to read from a file with several volumes (times, phases, masks), "
           "counted from 0", at_least(0)),
    Option("phase", "N", "synonym of --time", at_least(0)),
    Option("raw", "X,Y,Z,TYPE[,big]", "read a file without header: dimensions and voxel type, such "
           "as 512,512,400,uint16; x varies fastest, little-endian by default"),
    Option("no-resampling", "", "fail for irregular grids (missing slices, gantry tilt, shear) "
           "instead of resampling them"),
    Option("seeds", "FILE", "seed points in world coordinates, where initial surfaces are placed: "
           "points of a mesh file, or lines 'x y z' of a .txt, .csv or .xyz file"),
    Option("seed-position", "X,Y,Z", "seed point in world coordinates; may be repeated",
           numbers(3), True),
    Option("initial-surface", "FILE", "closed initial surface in world coordinates: .vtp, .vtk, "
           ".stl, .ply or .obj"),
    Option("attracting-points", "FILE", "points in world coordinates that belong to the object: "
           "points of a mesh file with optional arrays Weight and Radius, or lines 'x y z [weight "
           "[radius]]' of a .txt, .csv or .xyz file"),
    Option("attracting-position", "X,Y,Z", "point in world coordinates that belongs to the object; "
           "may be repeated", numbers(3), True),
    Option("edges", "NAME|FILE", "edge map, with large values on edges: array of the volume, or "
           "volume of equal dimensions; default of --edge-attraction: 2"),
    Option("ends", "closed|marked|open", "shape where the object leaves the volume: closed by a "
           "rounded cap (default); marked: cut by a plane and closed by flat caps, numbered in the "
           "cell array Cap; open: cut and left open", one_of("closed", "marked", "open")),
    Option("triangles", "N", "target number of triangles (within 10 %): search for the --tolerance "
           "or --edge-length that yields it", at_least(20)),
    Option("probe", "FILE", "sample this volume at the vertices, as a point array with the name of "
           "the file; its grid, coordinate system and unit may differ; may be repeated", str, True),
    Option("probe-depth", "LENGTH", "with --probe: average values from the surface to this depth "
           "inside, in world units", at_least(0, number)),
    Option("labels", "all|LIST", "read the volume as a label map and compute a surface for each of "
           "these labels: numbers, ranges and names, such as 1,7-9,liver,lung_*", str, True),
    Option("list-labels", "", "print the labels of the volume, or those of --labels: value, "
           "voxels, volume, extent, name; with --report also as JSON"),
    Option("label-names", "FILE", "names and colours of labels: JSON, ITK-SNAP label descriptions, "
           "colour table or .csv (default: those in the volume, or in a file next to it)"),
)
OUTPUT = (
    Option("format", "SUFFIX", "with --labels: suffix of files in a folder (default: vtp)"),
    Option("history", "FILE.csv", "write the history, one row per iteration"),
    Option("levels-output", "FILE.vtm|DIR", "write the surface of each level: as blocks, or as "
           "level-0.vtp, level-1.vtp, ... in a folder"),
    Option("snapshots", "FILE.vtm|DIR", "write the surface every --snapshot-interval iterations "
           "(default: 10): as blocks, or as snapshot-0.vtp, ... in a folder"),
    Option("report", "FILE.json", "write measurements as JSON: components, genus, area, volume, "
           "seconds, ...; -: standard output"),
    Option("write-volume", "FILE.vti", "write the input volume, cropped and resampled as "
           "requested"),
    Option("mesher", "tetgen|gmsh", "program that generates tetrahedral meshes; with this option "
           "also for .msh (default: the first one installed)", one_of("tetgen", "gmsh")),
    Option("maximum-volume", "VOLUME", "maximum volume of a tetrahedron in cubic world units; "
           "approximate with gmsh", positive),
    Option("quiet", "", "print errors only"),
    Option("progress", "", "print progress lines even if the standard error is not a terminal"),
    Option("list-properties", "", "print options that set properties of filters: class, property, "
           "option, default"),
    Option("list-files", "", "print the files of the volume"),
)
