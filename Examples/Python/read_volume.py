#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Read a volume of one of the usual medical formats as vtkImageData.

As a module: `image = read_volume("scan.nii.gz")`. On the command line it converts to VTK's format:

    read_volume.py IN OUT.vti

IN: .vti; .mha, .mhd; .nrrd, .nhdr; .nii, .nii.gz; .inv3 (an InVesalius project, such as
Cranium.inv3 of Debian's package invesalius-examples); or a folder with the slices of one DICOM
series. Spacing, origin and the directions of the axes are kept. Whatever cannot be read as a
volume of one scalar component raises VolumeError with the reason.
"""

import argparse
import os
import re
import sys

import numpy as np
from vtkmodules.util.misc import calldata_type
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.util.vtkConstants import VTK_STRING
from vtkmodules.vtkIOImage import vtkMetaImageReader, vtkNIFTIImageReader
from vtkmodules.vtkIOXML import vtkXMLImageDataReader, vtkXMLImageDataWriter

from check_volume import check_meta, check_nifti, meta_fields, meta_files
from output_files import check_end, check_output, write_with
from read_dicom import is_dicom, read_dicom
from read_inv3 import read_inv3
from read_nrrd import nrrd_files, read_nrrd
from terminal import caught_output, plain_message
from volume_image import VolumeError, make_image, place_image


def read_volume(path):
    """vtkImageData with one active scalar component; see the module's text for the formats."""
    path = os.fspath(path)
    if not os.path.exists(path):
        raise VolumeError(f"{path}: no such file or folder")
    try:
        image = choose_reader(path)(path)
    except OSError as error:
        raise VolumeError(f"{path}: {error.strerror or error}") from error
    except VolumeError as error:
        if str(error).startswith(path):
            raise
        raise VolumeError(f"{path}: {error}") from error
    check_scalars(image, path)
    return image


def choose_reader(path):
    """The function that reads this kind of file."""
    if os.path.isdir(path):
        return read_dicom
    lower = path.lower()
    for suffix, reader in READERS.items():
        if lower.endswith(suffix):
            return reader
    raise VolumeError(f"{path}: unknown suffix; known are {', '.join(READERS)} and folders with"
                      " DICOM slices")


def check_scalars(image, path):
    """Make the volume's only array the active one; an error unless it has one component."""
    points = image.GetPointData()
    if image.GetNumberOfPoints() == 0:
        raise VolumeError(f"{path}: the image is empty")
    if points.GetScalars() is None:
        names = [points.GetArrayName(i) for i in range(points.GetNumberOfArrays())]
        if len(names) != 1 or points.GetArray(0) is None:
            raise VolumeError(f"{path}: no active point scalars (arrays: {', '.join(names)})"
                              if names else f"{path}: no values at the points of the image")
        points.SetActiveScalars(names[0])
    components = points.GetScalars().GetNumberOfComponents()
    if components != 1:
        raise VolumeError(f"{path}: {components} components per voxel; one is needed")


def run_reader(reader, path, trust_warnings=True):
    """The output of a VTK reader; what it reports or prints becomes a VolumeError.

    Its warnings too, unless they are not trusted: they are about data that it lacked and made up.
    """
    messages = []

    @calldata_type(VTK_STRING)
    def keep(_caller, _event, text):
        messages.append(plain_message(text))

    reader.AddObserver("ErrorEvent", keep)
    reader.AddObserver("WarningEvent", keep if trust_warnings else lambda *_: None)
    reader.SetFileName(path)
    try:
        with caught_output() as printed:  # by objects within the reader
            reader.Update()
    except MemoryError as error:
        raise VolumeError(f"{path}: not enough memory to read it; crop it, or resample it to fewer"
                          " voxels") from error
    if messages or printed.GetOutput() or reader.GetErrorCode():
        messages = messages or [plain_message(printed.GetOutput()) or "damaged file"]
        raise VolumeError(f"{path}: cannot be read ({'; '.join(messages)})")
    return reader.GetOutput()


def files_of_volume(path):
    """The files that read_volume would read, those that a header names included."""
    if os.path.isdir(path):
        return [entry.path for entry in os.scandir(path) if is_dicom(entry.path)]
    names = meta_files(path) if path.lower().endswith((".mha", ".mhd")) else nrrd_files(path)
    return [path, *names]


def read_vti(path):
    reader = vtkXMLImageDataReader()
    if not reader.CanReadFile(path):
        raise VolumeError(f"{path}: not VTK XML image data")
    return run_reader(reader, path)


def read_meta(path):
    """MetaImage; VTK's reader drops the directions of the axes, which are in the header's text."""
    reader = vtkMetaImageReader()
    if not reader.CanReadFile(path):
        raise VolumeError(f"{path}: not a MetaImage file")
    check_meta(path)
    image = run_reader(reader, path)
    fields = meta_fields(path)
    matrix = next((fields[name] for name in ("TransformMatrix", "Rotation", "Orientation")
                   if name in fields), None)
    direction = None
    if matrix is not None:
        numbers = [float(n) for n in matrix.split()]
        if len(numbers) != 9:
            raise VolumeError(f"{path}: {len(numbers)} numbers for the directions, not 9")
        direction = np.reshape(numbers, (3, 3)).T  # the file lists axis after axis
    known = re.fullmatch("[LRAPSI]{3}", fields.get("AnatomicalOrientation", ""))
    return place_image(image, image.GetSpacing(), image.GetOrigin(), direction,
                       "LPS" if known else None)


def read_nifti(path):
    """NIfTI in its own world coordinates (RAS, mm): the sform, or the qform where that fails."""
    reader = vtkNIFTIImageReader()
    if not reader.CanReadFile(path):
        raise VolumeError(f"{path}: not a NIfTI file")
    check_nifti(path)
    # It warns where sform and qform differ in handedness, of which both are served below.
    image = run_reader(reader, path, trust_warnings=False)
    if reader.GetTimeDimension() > 1:
        raise VolumeError(f"{path}: {reader.GetTimeDimension()} time points; one volume is needed")
    check_scalars(image, path)
    voxels = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(image.GetDimensions()[::-1])
    slope, shift = reader.GetRescaleSlope() or 1.0, reader.GetRescaleIntercept()
    if (slope, shift) != (1.0, 0.0):
        voxels = (voxels * slope + shift).astype(np.float32)

    failure = None
    for matrix in (reader.GetSFormMatrix(), reader.GetQFormMatrix()):
        if matrix is None:
            continue
        affine = np.array([[matrix.GetElement(r, c) for c in range(4)] for r in range(3)])
        edges = affine[:, :3] * image.GetSpacing()
        lengths = np.linalg.norm(edges, axis=0)
        try:
            return make_image(voxels, lengths, affine[:, 3],
                              edges / np.where(lengths > 0, lengths, 1), "RAS")
        except VolumeError as error:
            failure = failure or error
    if failure is not None:
        raise failure
    return make_image(voxels, image.GetSpacing())


READERS = {
    ".vti": read_vti, ".mha": read_meta, ".mhd": read_meta, ".nrrd": read_nrrd, ".nhdr": read_nrrd,
    ".nii": read_nifti, ".nii.gz": read_nifti, ".inv3": read_inv3,
}


def write_image(image, path):
    """A .vti file."""
    write_with(vtkXMLImageDataWriter(), image, path,
               lambda written: check_end(written, b"</VTKFile>"))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("input", help="volume file, or folder of one DICOM series")
    parser.add_argument("output", help="file to write, .vti")
    arguments = parser.parse_args()
    if not arguments.output.endswith(".vti"):
        parser.error("the output must end in .vti")
    try:
        check_output(arguments.output, files_of_volume(arguments.input))
        image = read_volume(arguments.input)
        write_image(image, arguments.output)
    except (VolumeError, OSError) as error:
        sys.exit(f"read_volume.py: {error}")
    scalars = image.GetPointData().GetScalars()
    print(f"{arguments.output}: {' x '.join(map(str, image.GetDimensions()))} voxels,"
          f" {scalars.GetDataTypeAsString()}, {scalars.GetRange()[0]:g} to"
          f" {scalars.GetRange()[1]:g}")


if __name__ == "__main__":
    main()
