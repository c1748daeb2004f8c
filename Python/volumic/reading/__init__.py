# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Readers of volumes. read() returns a Volume or raises a VolumeError with a one-line message.

A reader is a function (path, choice) -> Volume. Its module is imported on first use.
"""
from __future__ import annotations

import importlib
import os
import re
import warnings

import numpy as np

from ..errors import VolumeError
from .grid import one_of_times
from .volume import Choice, Label, Volume, checked, prefix_errors, require_file, unit_of

__all__ = ["Choice", "Label", "SUFFIXES", "Volume", "VolumeError", "checked", "list_files",
           "list_series", "read", "unit_of"]

SUFFIXES = {suffix: reader for reader, suffixes in {
    "vtkfiles:read_xml": ".vti .pvti .vtr",
    "vtkfiles:read_by_vtk": ".vtk .vtkhdf .hdf",
    "plain:read_meta_image": ".mha .mhd",
    "plain:read_nrrd": ".nrrd .nhdr",
    "plain:read_npy": ".npy .npz",
    "plain:read_inv3": ".inv3",
    "neuro:read_nifti": ".nii .nii.gz .nii.bz2 .img .img.gz .hdr .hdr.gz .mgz .mgh",
    "neuro:read_minc": ".mnc",
    "microscopy:read_mrc": ".mrc .map .rec .ccp4 .mrc.gz .map.gz .rec.gz .ccp4.gz .mrc.bz2",
    "microscopy:read_tiff": ".tif .tiff .lsm .btf",
    "microscopy:read_pictures": ".png .jpg .jpeg .bmp .pgm .ppm .pnm",
    "dicom:read_dicom": ".dcm .dicom .ima",
}.items() for suffix in suffixes.split()}
_SIGNATURES = (  # of files with unknown suffix: offset, bytes, reader
    (128, b"DICM", "dicom:read_dicom"), (0, b"NRRD000", "plain:read_nrrd"),
    (0, b"\x93NUMPY", "plain:read_npy"), (0, b"ObjectType", "plain:read_meta_image"),
    (0, b"NDims", "plain:read_meta_image"), (0, b"# vtk DataFile", "vtkfiles:read_by_vtk"),
    (0, b"<VTKFile", "vtkfiles:read_xml"), (0, b"<?xml", "vtkfiles:read_xml"),
    (208, b"MAP ", "microscopy:read_mrc"), (0, b"II*\0", "microscopy:read_tiff"),
    (0, b"MM\0*", "microscopy:read_tiff"), (0, b"II+\0", "microscopy:read_tiff"),
    (0, b"\x89PNG", "microscopy:read_pictures"), (0, b"\xff\xd8\xff", "microscopy:read_pictures"),
    (0, b"BM", "microscopy:read_pictures"), (0, b"P5", "microscopy:read_pictures"),
    (344, b"n+1", ".nii"), (4, b"n+2", ".nii"), (0, b"\x89HDF", ".mnc or .vtkhdf"),
    (0, b"\x1f\x8b", ".nii.gz, .mgz, .mrc.gz or .inv3"), (0, b"CDF", ".mnc"))


def read(path, **choice):
    """Read a volume or a label map.

    Parameters
    ----------
    path : str or path-like
        A file, a folder (DICOM, pictures, masks, OME-Zarr), or a pattern such as "slice*.png".
    series : int or str, optional
        DICOM series, by number or UID.
    time : int, optional
        Index of the volume in a file with several ones.
    component : int, optional
        Component of the voxels; -1: magnitude.
    spacing : sequence of 3 floats, optional
        Voxel spacing x, y, z that replaces that of the file.
    raw : str, optional
        Dimensions and type of a file without header, such as "512,512,400,uint16".
    labels : bool, optional
        Read a label map, whose values are never interpolated.
    resampling : bool, optional
        Resample irregular grids (default); otherwise they are an error.
    array : str, optional
        Name of the array in a VTK or .npz file.
    layers : bool, optional
        With labels: store overlapping masks or segments in separate components.

    Returns
    -------
    Volume
        `array` [z, y, x] or [component, z, y, x], with position, unit, labels and warnings. It
        unpacks to array, spacing, origin, direction, space, unit, names.

    Raises
    ------
    VolumeError
        The file cannot be read. The message states the file, the reason and what to do.
    """
    path, choice = os.fspath(path), Choice(**choice)
    choice.times = 0
    with prefix_errors(path), warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        _need_files(path)
        volume = _read(path, choice)
        if choice.labels and choice.time is None and choice.times > 1:
            from . import masks
            volume = masks.read_times(path, choice.times, choice, _read)
        if not choice.times and choice.time is not None:
            one_of_times(1, choice)
        volume.times = max(choice.times, 1)
        return volume


def _read(path, choice):
    reader = _reader_of(path, choice)
    if isinstance(reader, str):
        if choice.series is not None and not reader.startswith("dicom"):
            raise VolumeError("there is no series %s (--series); this is not DICOM" % choice.series)
        module, name = reader.split(":")
        reader = getattr(importlib.import_module("." + module, __name__), name)
    return checked(reader(path, choice), choice)


def _reader_of(path, choice):
    """Return the reader of a path, as "module:function" or a function."""
    if choice.raw:
        return "plain:read_raw"
    if os.path.isfile(path):
        return _reader_of_file(path)
    if not os.path.isdir(path):
        if not re.search(r"[*%]", os.path.basename(path)):
            raise VolumeError("no such file or folder; check its name")
    elif {".zattrs", ".zgroup", ".zarray", "zarr.json"} & set(os.listdir(path)):
        return "microscopy:read_ome_zarr"
    from . import masks
    files = list_files(path)
    if any(_is_dicom(file) for file in files[:1]):
        return "dicom:read_dicom"
    found = masks.masks_among(files)
    if len(found) == 1 and not choice.labels:
        return lambda _, choice: _read(found[0], choice)
    if found:
        return lambda _, choice: masks.read_masks(found, choice, _read)
    if any(SUFFIXES.get(_suffix_of(file), "").startswith("microscopy:") for file in files):
        return "microscopy:read_pictures"
    return "dicom:read_dicom"


def _suffix_of(path):
    """Return the longest suffix of SUFFIXES that a name ends in; empty if there is none."""
    name = os.path.basename(path).lower()
    return max((s for s in SUFFIXES if name.endswith(s) and name != s), key=len, default="")


def _reader_of_file(path):
    """Return the reader of a file by its suffix, otherwise by its first bytes."""
    with open(path, "rb") as stream:
        head = stream.read(352)
    if _is_dicom(path):
        return "dicom:read_dicom"
    suffix = _suffix_of(path)
    if suffix:
        return SUFFIXES[suffix]
    found = next((reader for at, signature, reader in _SIGNATURES
                  if head[at:at + len(signature)] == signature), None)
    if found is None:
        raise VolumeError("unknown format; supported are %s, and --raw for voxels without header"
                          % " ".join(sorted(SUFFIXES)))
    if ":" not in found:
        raise VolumeError("probably a %s file; change its suffix" % found)
    return found


def _is_dicom(path):
    try:
        with open(path, "rb") as stream:
            return stream.read(132)[128:] == b"DICM"
    except OSError:
        return False


def list_series(path):
    """Return one line per DICOM series of a file or folder."""
    with prefix_errors(path):
        from . import dicom
        _need_files(path)
        return dicom.list_series(path)


def _need_files(path):
    for file in [path] if os.path.isdir(path) else list_files(path):
        require_file(file)


def list_files(path, choice=None):  # pylint: disable=unused-argument
    """Return all files that read() opens."""
    if os.path.isdir(path):
        return _files_of_folder(path)
    folder = os.path.dirname(path)
    if not os.path.exists(path):
        from .microscopy import names_of_pattern
        if not re.search(r"[*%]", os.path.basename(path)) or not os.path.isdir(folder or "."):
            return []
        return [os.path.join(folder, name) for name in names_of_pattern(path)[1]]
    if not os.path.isfile(path):
        return [path]
    if _is_dicom(path):
        is_directory = os.path.basename(path).lower() == "dicomdir"
        return [path] + [file for file in _files_of_folder(folder or ".", is_directory)
                         if not os.path.samefile(file, path)]
    return [path] + _companions(path)


def _files_of_folder(folder, is_nested=True):
    """Return the files of a folder; for DICOM and Zarr including subfolders."""
    from .microscopy import natural
    files = [entry.path for entry in os.scandir(folder) if entry.is_file()]
    slices = [file for file in files if _is_dicom(file)]
    is_zarr = any(os.path.basename(file) in (".zattrs", ".zgroup", "zarr.json") for file in files)
    if is_nested and (slices or not files or is_zarr):
        files = [os.path.join(top, name) for top, _, names in os.walk(folder) for name in names]
        slices = [] if is_zarr else [file for file in files if _is_dicom(file)]
    return sorted(slices or [f for f in files if os.path.isfile(f)], key=natural)


def _companions(path):
    """Return the other files that a header refers to or that belong to it."""
    suffix = _suffix_of(path)
    folder, files = os.path.dirname(path), []
    if suffix in (".img", ".img.gz", ".hdr", ".hdr.gz"):
        return [path[:-len(suffix)] + other for other in (".img", ".img.gz", ".hdr", ".hdr.gz")
                if other != suffix and os.path.exists(path[:-len(suffix)] + other)]
    with open(path, "rb") as stream:
        text = stream.read(1 << 20).decode("latin-1")
    if suffix == ".pvti":
        files = re.findall(r'Source="([^"]*)"', text)
    elif suffix in (".mha", ".mhd", ".nhdr", ".nrrd"):
        head = re.split(r"\n\s*\n|\0", text)[0]
        found = re.search(r"(?im)^(?:ElementDataFile\s*[=:]|data ?file:)[ \t]*(.*?)\s*$", head)
        name = found[1] if found and found[1].lower() != "local" else ""
        if name.startswith("LIST"):
            files = head[found.end():].split()
        elif "%" in name:
            return list_files(os.path.join(folder, name.split()[0]))
        elif name:
            files = [name]
    return [os.path.join(folder, file) for file in files]
