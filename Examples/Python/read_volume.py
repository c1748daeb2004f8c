#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Read a volume of one of the usual medical formats as vtkImageData.

As a module: `image = read_volume("scan.nii.gz")`, or `read_labels("labels.nii.gz")` for label maps.
On the command line it converts to VTK's format:

    read_volume.py IN OUT.vti

IN is what the command `volumic` reads (see FORMATS in `man volumic`), which does the work: .vti;
.mha, .mhd; .nrrd, .nhdr; .nii, .nii.gz; .inv3 (an InVesalius project, such as Cranium.inv3 of
Debian's package invesalius-examples); a folder with the slices of one DICOM series; and more.
Spacing, origin and the directions of the axes are kept. Whatever cannot be read as a volume of one
scalar component raises VolumeError with the reason.
"""

import argparse
import os
import sys
import tempfile

from vtkmodules.vtkIOXML import vtkXMLImageDataReader, vtkXMLImageDataWriter

from output_files import check_end, write_with
from terminal import caught_output
from volume_command import run_command
from volume_image import VolumeError


def read_volume(path):
    """vtkImageData with one active scalar component; see the module's text for the formats.

    The volume is on the disk for a moment, in the system's folder for temporary files, or TMPDIR.
    """
    path = os.fspath(path)
    with tempfile.TemporaryDirectory(prefix="volumic-") as folder:
        written = os.path.join(folder, "volume.vti")
        run_command("--write-volume", written, "--", path)
        image = read_vti(written, path)
    components = image.GetPointData().GetScalars().GetNumberOfComponents()
    if components != 1:
        raise VolumeError(f"{path}: {components} components per voxel; one is needed")
    return image


def read_labels(path, names=None):
    """vtkImageData with labels as its active scalars, those of the points, or else of the cells.

    names: a file of names of labels, see LABEL MAPS in `man volumic`. These, or those that the
    volume has or that lie beside it, are field data then, as vtkLabelsToSurfaces takes them.
    """
    path = os.fspath(path)
    with tempfile.TemporaryDirectory(prefix="volumic-") as folder:
        written = os.path.join(folder, "volume.vti")
        run_command("--labels", "all", "--write-volume", written,
                    *(["--label-names", os.fspath(names)] if names else []), "--", path)
        image = read_vti(written, path)
    scalars = image.GetPointData().GetScalars() or image.GetCellData().GetScalars()
    if scalars.GetNumberOfComponents() != 1:
        raise VolumeError(f"{path}: {scalars.GetNumberOfComponents()} components per voxel; one is"
                          " needed. The command volumic takes them by its --component")
    return image


def read_vti(written, path):
    """The image of a .vti file that the command has written of the volume `path`."""
    reader = vtkXMLImageDataReader()
    reader.SetFileName(written)
    try:
        with caught_output():
            reader.Update()
    except MemoryError as error:
        raise VolumeError(f"{path}: not enough memory to read it; crop it, or resample it to fewer"
                          " voxels") from error
    image = reader.GetOutput()
    scalars = image.GetPointData().GetScalars() or image.GetCellData().GetScalars()
    if reader.GetErrorCode() or scalars is None:
        raise VolumeError(f"{path}: cannot be read again from {written}")
    return image


def files_of_volume(path):
    """The files that read_volume would read, those that a header names included."""
    return run_command("--list-files", "--", os.fspath(path)).splitlines()


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
        run_command("--write-volume", arguments.output, "--", arguments.input)
    except VolumeError as error:
        sys.exit(f"read_volume.py: {error}")
    print(f"Written: {arguments.output}")


if __name__ == "__main__":
    main()
