# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Volume, the result of all readers; Choice, the options of read(); and checks of both."""
from __future__ import annotations

import contextlib
import dataclasses
import errno
import gzip
import os
import re
import zlib

import numpy as np

from ..errors import Failure, VolumeError
from ..messages import one_line

METERS = {"m": 1., "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "nm": 1e-9, "A": 1e-10}

_UNITS = {"metre": "m", "centimetre": "cm", "millimetre": "mm", "micrometre": "um", "micron": "um",
          "µm": "um", "μm": "um", "\ufffdm": "um", "\\u00b5m": "um", "nanometre": "nm",
          "angstrom": "A", "ångström": "A", "å": "A"}


def unit_of(name):
    """Return the key of METERS for a unit of length; "" if it is unknown."""
    name = str(name or "").strip()
    lower = name.lower().replace("meter", "metre")
    unit = _UNITS.get(lower) or _UNITS.get(lower.rstrip("s"), "")
    return name if name in METERS else lower if lower in METERS else unit


@dataclasses.dataclass
class Label:
    """A label with a name."""
    value: int
    name: str = ""
    color: tuple | None = None  # r, g, b in 0..1
    layer: int = 0              # component of the array


@dataclasses.dataclass
class Choice:
    """Options of read()."""
    series: object = None       # number or UID of a DICOM series
    time: int | None = None     # index of the volume
    component: int | None = None  # -1: magnitude
    spacing: tuple | None = None  # replaces that of the file
    raw: str | None = None      # see --raw
    labels: bool = False        # values are labels, never interpolated
    resampling: bool = True     # False: irregular grids are an error
    array: str | None = None    # name of the array
    layers: bool = False        # overlapping masks become components, see Label.layer
    times: int = 1              # number of volumes in the file, set by one_of_times()


@dataclasses.dataclass
class Volume:
    """Voxels and their positions: point(i, j, k) = origin + direction @ (spacing * (i, j, k)).

    It unpacks to array, spacing, origin of the first voxel, direction, space, unit, names.
    """
    array: np.ndarray           # [z, y, x] or [component, z, y, x]
    spacing: tuple = (1., 1., 1.)  # x, y, z
    origin: tuple = (0., 0., 0.)
    direction: np.ndarray = dataclasses.field(default_factory=lambda: np.eye(3))
    space: str = ""             # directions of the world axes, such as 'RAS'; '' unknown
    unit: str = ""              # key of METERS; '' unknown
    labels: list = dataclasses.field(default_factory=list)
    warnings: list = dataclasses.field(default_factory=list)
    components: str = ""        # kind: '', 'vector', 'color', or one that requires a choice
    times: int = 1
    resampling: str = ""        # description of the resampling; '' none
    name: str = ""              # of the array
    start: tuple = (0, 0, 0)    # index i, j, k of the first voxel

    @property
    def names(self):
        """Names of the labels by value."""
        return {label.value: label.name for label in self.labels if label.name}

    def __iter__(self):
        first = self.origin + self.direction @ (np.array(self.spacing) * self.start)
        return iter((self.array, self.spacing, tuple(first.tolist()), self.direction, self.space,
                     self.unit, self.names))

    def scalars(self, component=None):
        """Return the values [z, y, x] of a component. -1 is the magnitude; None is the magnitude of
        vectors and colours, and otherwise an error."""
        count = 1 if self.array.ndim == 3 else len(self.array)
        if component is not None and component >= count:
            raise VolumeError("component %d is out of range; the volume has %d components, 0 to %d"
                              % (component, count, count - 1))
        if self.array.ndim == 3:
            return self.array
        if component is None and self.components not in ("", "vector", "color"):
            raise VolumeError(
                "voxels have %d components (%s) that are not a vector; choose one with "
                "--component N, 0 to %d (-1: magnitude)" % (count, self.components, count - 1))
        if component is None or component < 0:
            return np.sqrt(sum(np.square(part, dtype=np.float64) for part in self.array))
        return self.array[component]


def checked(volume, choice):
    """Return the volume in native byte order, with the requested component. Raise VolumeError if
    its shape, type or position is invalid."""
    array = volume.array
    if array.dtype.kind == "c":
        array = np.stack([array.real, array.imag])
        volume.components = "vector"
    if array.ndim not in (3, 4) or not all(array.shape):
        raise VolumeError("dimensions %s are not those of a volume" % text_of(array.shape))
    if array.dtype.kind not in "uifb":
        raise VolumeError("voxels of type %s are not supported" % array.dtype)
    if array.ndim == 4 and len(array) == 1:
        array = array[0]
    volume.array = array
    if array.ndim == 4 and choice.component is not None and choice.component >= 0:
        volume.array = array = volume.scalars(choice.component)
        volume.components = ""
    kind = array.dtype.kind + str(min(array.dtype.itemsize, 8))
    kind = {"b1": "u1", "f2": "f4"}.get(kind, kind)
    if array.dtype != np.dtype(kind):  # includes byte order
        volume.array = array.view(kind) if kind == "u1" else array.astype(kind)
    volume.spacing = tuple(float(s) for s in (choice.spacing or volume.spacing))
    volume.origin = tuple(float(c) for c in volume.origin)
    volume.direction = np.asarray(volume.direction, float)
    check_positions(volume)
    return volume


def check_positions(volume):
    """Raise VolumeError unless doubles can represent the positions of all voxels."""
    if not (np.isfinite(volume.spacing).all() and min(volume.spacing) > 0
            and np.isfinite(volume.direction).all()):
        raise VolumeError("the spacing %s is not positive and finite; give --spacing X,Y,Z"
                          % text_of(volume.spacing))
    if not np.isfinite(volume.origin).all():
        raise VolumeError("the origin %s is not finite; correct the header"
                          % text_of(volume.origin))
    if max(volume.spacing) > 1000 * min(volume.spacing):
        raise VolumeError("the spacing %s differs by more than a factor of 1000 between the axes; "
                          "correct the header or set --spacing X,Y,Z" % text_of(volume.spacing))
    sizes = np.array(volume.array.shape[:-4:-1]) + np.abs(volume.start)
    far = np.abs(volume.origin) + np.abs(volume.direction) @ (np.array(volume.spacing) * sizes)
    if not np.isfinite(far).all() or np.spacing(far.max()) > 1e-3 * min(volume.spacing):
        raise VolumeError("the origin %s is too far away for a spacing of %g: neighboring voxels "
                          "have equal coordinates; correct the header"
                          % (text_of(volume.origin), min(volume.spacing)))


@contextlib.contextmanager
def prefix_errors(path):
    """Convert all errors to a VolumeError that begins with the file name and ends with advice."""
    try:
        yield
    except Exception as error:  # pylint: disable=broad-except
        text = one_line(str(failure_of(error)))
        if not re.search(r"; [a-z]|\binstall ", text):
            text += "; copy the file again, correct it or convert it"
        raise VolumeError(text if text.startswith((path + ":", path + os.sep)) else
                          "%s: %s" % (path, text)) from None


def require_file(path):
    """Raise VolumeError for pipes and devices, on which reading would block."""
    if os.path.exists(path) and not (os.path.isfile(path) or os.path.isdir(path)):
        raise VolumeError("%s: a pipe or a device; give a regular file" % path)


def failure_of(error):
    """Return a one-line VolumeError for an exception of a library."""
    if isinstance(error, VolumeError):
        return error
    text = " ".join(str(error).split())[:300] or type(error).__name__
    if isinstance(error, MemoryError) or getattr(error, "errno", 0) == errno.ENOMEM:
        text = "not enough memory to read the volume; crop it or resample it to fewer voxels"
    elif isinstance(error, EOFError):
        text = "the file is truncated; copy it again"
    elif isinstance(error, (zlib.error, gzip.BadGzipFile)) or text.startswith(
            ("Invalid data stream", "zlib error")):
        text = "the compressed data are damaged (%s); copy the file again" % text
    elif isinstance(error, ImportError) and error.name:
        module = error.name.split(".")[0]
        package = "python3-" + {"PIL": "pil", "vtkmodules": "vtk9"}.get(module, module)
        text = "install the Python package %s to read this format (Debian: %s)" % (module, package)
    elif isinstance(error, OSError) and error.strerror and error.errno != errno.EINVAL:
        text = error.strerror + (": " + str(error.filename)[:200] if error.filename else "")
        text += "; check the files and their permissions"
    elif not isinstance(error, Failure):
        text = "cannot be read: the file is truncated, damaged or invalid (%s)" % text
    return VolumeError(text)


def plain_name(text):
    """Return a label name without control characters and surrounding blanks."""
    return "".join(c if c.isprintable() else " " for c in text).strip()


def text_of(numbers, separator=" x "):
    """Return numbers as text, such as "3 x 4 x 5"."""
    return separator.join("%.15g" % n for n in numbers)
