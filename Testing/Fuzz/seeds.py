# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Writes a small file or two of each format for the fuzzers to begin with: seeds.py FOLDER."""

import bz2
import gzip
import itertools
import os
import struct
import sys
import zlib

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkFiltersSources import vtkSphereSource
from vtkmodules.vtkIOGeometry import vtkOBJWriter, vtkSTLWriter
from vtkmodules.vtkIOImage import (
    vtkBMPWriter, vtkMetaImageWriter, vtkPNGWriter, vtkPNMWriter, vtkTIFFWriter)
from vtkmodules.vtkIOLegacy import vtkPolyDataWriter, vtkStructuredPointsWriter
from vtkmodules.vtkIOPLY import vtkPLYWriter
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter, vtkXMLPolyDataWriter

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "Python"))
import medical_files  # pylint: disable=wrong-import-position

SPACING, ORIGIN = (1.0, 1.5, 2.0), (1.0, 2.0, 3.0)
VOXELS = np.arange(5 * 4 * 3).reshape(3, 4, 5).astype("i2")
LABELS = (b'<CaretExtension><Label Key="1" Red="1" Green="0.5" Blue="0"><![CDATA[a<b]]></Label>'
          b'<Label Key="3">x &amp; &lt;y&gt;</Label></CaretExtension>').ljust(184, b"\0")


def image(voxels):
    scalars = numpy_to_vtk(np.ascontiguousarray(voxels).ravel(), deep=True)
    scalars.SetName("density")
    made = vtkImageData()
    made.SetDimensions(voxels.shape[::-1])
    made.GetPointData().SetScalars(scalars)
    return made


def meta(changes):
    header = medical_files.meta_header(VOXELS, SPACING, ORIGIN, "1 0 0 0 1 0 0 0 1")
    for old, new in changes:
        header = header.replace(old, new)
    return header


def labelled_nifti():
    content = medical_files.nifti(VOXELS, SPACING)
    head = bytearray(content[:352])
    struct.pack_into("<f", head, 108, 352 + 8 + len(LABELS))
    head[348] = 1
    return bytes(head) + struct.pack("<ii", 8 + len(LABELS), 0) + LABELS + content[352:]


def nrrd(encoding, data):
    header = medical_files.nrrd_header(VOXELS, SPACING, ORIGIN, np.eye(3), encoding, "little")
    return header + b"Segment0_Name:=liver\nSegment0_LabelValue:=1\n\n" + data


def contents():
    """Pairs of a format and a file."""
    data = VOXELS.tobytes()
    yield from (("nrrd", nrrd(*pair)) for pair in (
        ("raw", data), ("gzip", gzip.compress(data)), ("bzip2", bz2.compress(data)),
        ("text", " ".join(map(str, VOXELS.ravel())).encode())))
    yield from (("nii", content) for content in (
        medical_files.nifti(VOXELS, SPACING), labelled_nifti()))
    yield from (("nii.gz", gzip.compress(content)) for content in (
        medical_files.nifti(VOXELS, SPACING), labelled_nifti()))
    yield "mha", meta(()) + data
    yield "mha", meta([(b"CompressedData = False", b"CompressedData = True")]) + zlib.compress(data)
    yield "mhd", meta([(b"LOCAL", b"slice%03d.raw 1 3 1")])
    yield "mhd", meta([(b"LOCAL", b"LIST")]) + b"1.raw\n2.raw\n3.raw\n"
    yield "mrc", medical_files.mrc(VOXELS, (1, 1, 1))
    yield "inv3", medical_files.inv3(VOXELS, SPACING)
    for syntax in ("explicit", "implicit"):
        yield "dcm", medical_files.dicom_slice(VOXELS[0], 0, SPACING, ORIGIN, np.eye(3), syntax)
    yield "mnc", b"CDF\1" + struct.pack(
        ">10i", 0, 10, 1, 1, 0x78000000, 4, 0, 0, 11, 1) + struct.pack(
        ">10i", 5, 0x696d6167, 0x65000000, 1, 0, 0, 0, 3, 8, 88) + bytes(8)
    yield "csv", b"x,y,z,Weight,Radius\n1,2,3,1,0\n4 5 6\n"
    yield from (("json", text) for text in (
        b'{"labels": {"background": 0, "liver": 1, "both": [1, 2]}}',
        b'[{"labelValue": 1, "name": "a\\u00e9\\n", "color": [1, 2.5e1, 255]}, {"id": 2, "name":""}]',
        b'{"1": {"name": "x", "color": "#ff8000"}}'))
    yield from (("txt", text) for text in (
        b"# c\n1 red 255 0 0 255\n2 liver left 1 2 3 4\r\n", b'label,name,r,g,b\n1,"a ""b""",1,0,0\n',
        b'1 255 0 0 1 1 1 "a b"\n', b"index\tname\tcolor\n1\tx\t#ff8000\n", b"1 a\n2 b\n"))


def surface_writers(surface):
    """Each format of surfaces in each way that it can be written."""
    for suffix, made in (("ply", vtkPLYWriter), ("stl", vtkSTLWriter), ("vtk", vtkPolyDataWriter)):
        for file_type in (1, 2):  # text, binary
            writer = made()
            writer.SetFileType(file_type)
            yield suffix, writer, surface
    old = vtkPolyDataWriter()
    old.SetFileVersion(42)
    yield "vtk", old, surface
    yield "obj", vtkOBJWriter(), surface
    for mode, compressor, encodes in itertools.product((0, 1, 2), (0, 2), (0, 1)):
        writer = vtkXMLPolyDataWriter()
        writer.SetDataMode(mode)
        writer.SetCompressorType(compressor)
        writer.SetEncodeAppendedData(encodes)
        yield "vtp", writer, surface


def written(folder):
    """Those that VTK writes."""
    sphere = vtkSphereSource()
    sphere.SetThetaResolution(4)
    sphere.SetPhiResolution(3)
    sphere.Update()
    legacy, packed = vtkStructuredPointsWriter(), vtkTIFFWriter()
    legacy.SetFileTypeToBinary()
    packed.SetCompressionToDeflate()
    text = vtkXMLImageDataWriter()
    text.SetDataModeToAscii()
    bytes_of = (VOXELS % 255).astype("u1")
    for k, (suffix, writer, data) in enumerate((
            ("tif", vtkTIFFWriter(), image(VOXELS.astype("u2"))), ("tif", packed, image(bytes_of)),
            ("png", vtkPNGWriter(), image(bytes_of[:1])), ("bmp", vtkBMPWriter(), image(bytes_of[:1])),
            ("pgm", vtkPNMWriter(), image(bytes_of[:1])), ("vti", text, image(VOXELS)),
            ("vti", vtkXMLImageDataWriter(), image(VOXELS)), ("vtk", legacy, image(VOXELS)),
            ("vtk", vtkStructuredPointsWriter(), image(VOXELS)),
            ("mha", vtkMetaImageWriter(), image(VOXELS)), *surface_writers(sphere.GetOutput()))):
        os.makedirs(os.path.join(folder, suffix), exist_ok=True)
        writer.SetFileName(os.path.join(folder, suffix, f"written{k}.{suffix}"))
        writer.SetInputData(data)
        writer.Write()


def main(folder):
    for k, (suffix, content) in enumerate(contents()):
        os.makedirs(os.path.join(folder, suffix), exist_ok=True)
        with open(os.path.join(folder, suffix, f"seed{k}"), "wb") as file:
            file.write(content)
    written(folder)


if __name__ == "__main__":
    main(sys.argv[1])
