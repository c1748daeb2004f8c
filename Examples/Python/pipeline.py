# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The way from a file to a surface that the example scripts have in common."""

import importlib
import os

from read_volume import read_volume
from terminal import FilterError, run_filter

# Where Debian's package invesalius-examples has it; quickstart.sh says so where it lies elsewhere.
SKULL = os.environ.get(
    "VOLUMIC_CRANIUM", "/usr/share/doc/invesalius-examples/examples/Cranium.inv3")
SKULL_ISO = 226.5  # bone; between two integers, so that no voxel equals it
SWITCH = {"on": True, "true": True, "1": True, "off": False, "false": False, "0": False}


def load_volume(path, iso=None):
    """The image and the iso-value: the given one, else bone for the skull, else Otsu's threshold.

    Prints what it found. VolumeError or FilterError where there is nothing to be found.
    """
    print(f"Reading {path}")
    image = read_volume(path)
    scalars = image.GetPointData().GetScalars()
    print(f"  {' x '.join(map(str, image.GetDimensions()))} voxels of"
          f" {' x '.join(f'{s:.4g}' for s in image.GetSpacing())}, {scalars.GetDataTypeAsString()},"
          f" values {scalars.GetRange()[0]:g} to {scalars.GetRange()[1]:g}")
    if iso is not None:
        print(f"  iso-value {iso:g}")
    elif os.path.basename(path) == os.path.basename(SKULL):
        iso = SKULL_ISO
        print(f"  iso-value {iso:g} (bone)")
    else:
        iso = otsu_iso_value(image)
        print(f"  iso-value {iso:g} by Otsu's threshold, a guess")
    return image, iso


def otsu_iso_value(image):
    """Otsu's threshold: the value that separates the voxels best into two classes."""
    threshold = volumic().vtkOtsuThreshold()
    threshold.SetInputData(image)
    run_filter(threshold)
    return threshold.GetThreshold()


def pyramid_levels(pyramid):
    """The images of a vtkMultiBlockDataSet from vtkImagePyramid, level 0 first."""
    return [pyramid.GetBlock(h) for h in range(pyramid.GetNumberOfBlocks())]


def level_unit(image):
    """U_h, the smallest distance of two voxels, in world units."""
    return image.GetFieldData().GetArray("Unit").GetTuple1(0)


def volumic():
    """The Python package, or a FilterError that tells how it is found."""
    try:
        return importlib.import_module("volumic")
    except ImportError as error:
        raise FilterError(f"{error}. Where Volumic was installed into a prefix, set"
                          " PYTHONPATH=<prefix>/lib/python3/dist-packages") from error


def build_pyramid(image):
    """The filter with the levels, and the seconds it took."""
    pyramid = volumic().vtkImagePyramid()
    pyramid.SetInputData(image)
    seconds, _ = run_filter(pyramid, "Building the pyramid")
    for number, level in enumerate(pyramid_levels(pyramid.GetOutput())):
        print(f"  level {number}: {' x '.join(map(str, level.GetDimensions()))} voxels,"
              f" unit {level_unit(level):.4g}")
    return pyramid, seconds


def prepare_surface(source, iso, properties=None):
    """vtkDeformableSurface, not yet run, on a vtkImagePyramid or an image.

    properties: names of vtkDeformableSurface without Set, and their values.
    """
    surface = volumic().vtkDeformableSurface()
    if source.IsA("vtkAlgorithm"):
        surface.SetInputConnection(source.GetOutputPort())
    else:
        surface.SetInputData(source)
    surface.SetIsoValue(iso)
    for name, value in (properties or {}).items():
        set_property(surface, name, value)
    return surface


def check_properties(properties, kind="vtkDeformableSurface"):
    """ValueError where a filter of this class would refuse them: before anything has been read."""
    surface = getattr(volumic(), kind)()
    for name, value in properties.items():
        set_property(surface, name, value)


def run_surface(surface):
    """Run what prepare_surface gave: the seconds it took, and its warnings.

    An empty result is a FilterError.
    """
    seconds, warnings = run_filter(surface, "Evolving the surface")
    if surface.GetOutput().GetNumberOfPolys() == 0:
        side = "brighter" if surface.GetObjectIsBright() else "darker"
        raise FilterError(f"the surface vanished: is the object {side} than its surroundings, and"
                          f" is {surface.GetIsoValue():g} between the two?")
    return seconds, warnings


def property_names(algorithm):
    """What the filter's own class lets one set to a number, a switch or a text."""
    names = [name[3:] for name in vars(type(algorithm)) if name.startswith("Set")]
    return sorted(name for name in names
                  if isinstance(value_of(algorithm, name), (int, float, str)))


def value_of(algorithm, name):
    """Of a property; None of what is no single value, such as the names of labels."""
    try:
        return getattr(algorithm, "Get" + name, lambda: None)()
    except TypeError:
        return None


def set_property(algorithm, name, value):
    """Set a property to a number or to what a user typed; ValueError where that cannot be."""
    if name not in property_names(algorithm):
        raise ValueError(f"{algorithm.GetClassName()} has no property {name}; it has"
                         f" {', '.join(property_names(algorithm))}")
    kind = type(getattr(algorithm, "Get" + name)())
    try:
        value = SWITCH[str(value).lower()] if kind is bool else kind(value)
    except (KeyError, ValueError) as error:
        wanted = {bool: "on or off", int: "a whole number", float: "a number"}[kind]
        raise ValueError(f"{name} is to be {wanted}, not '{value}'") from error
    getattr(algorithm, "Set" + name)(value)
