# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The reader Volumic Volume: positions, directions, names of labels, series and errors."""

import gzip
import importlib
import os
import re
import shutil
import sys
import unittest.mock

import numpy
from paraview import simple

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.path.join(os.path.dirname(HERE), "Python")]
import label_maps
import medical_files
import plugin_testing as testing

SPACING, ORIGIN = (0.5, 0.75, 2.0), (10.0, -20.0, 30.0)
# Rotation by 90 degrees about z.
TURN = numpy.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
SEGMENTS = ("Segment0_ID:=a", "Segment0_Name:=liver", "Segment0_LabelValue:=3",
            "Segment0_Color:=0.8 0.2 0.2", "Segment1_ID:=b", "Segment1_Name:=spleen",
            "Segment1_LabelValue:=12", "Segment1_Color:=0.2 0.2 0.8", "Segment2_ID:=c",
            "Segment2_Name:=left kidney", "Segment2_LabelValue:=7", "Segment2_Color:=0.2 0.8 0.2")


def shown_of(message):
    """Return the part of a message that ParaView's box shows: for messages in VTK's form with one line the
    text after the class, otherwise the first line."""
    of_vtk = re.fullmatch(r"(?:error|warning): In .*, line \d+\n[^:]*: ?(.*)", message.strip(), re.I)
    return of_vtk[1] if of_vtk else message.strip().splitlines()[0]


def write(name, content):
    path = testing.output_path(name)
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "wb") as file:
        file.write(content)
    return path


def voxels():
    return label_maps.values()[:20, :24, :]  # of three sizes


def ramp():
    """Return values that decrease with the distance from the centre."""
    z, y, x = numpy.mgrid[0:20, 0:24, 0:28]
    return (1000 - 90 * numpy.sqrt((x - 14)**2 + (y - 12)**2 + (z - 10)**2)).astype("i2")


def nifti(name="turned.nii.gz", data=None):
    sform = numpy.column_stack([TURN * SPACING, ORIGIN])
    content = medical_files.nifti(voxels() if data is None else data, SPACING, sform)
    return write(name, gzip.compress(content) if name.endswith("gz") else content)


def segmentation():
    header = medical_files.nrrd_header(label_maps.values(), SPACING, ORIGIN, TURN, "gzip", "little")
    content = "\n".join([*SEGMENTS, ""]).encode()
    return write("organs.seg.nrrd",
                 header + content + b"\n" + gzip.compress(label_maps.values().tobytes()))


def dicom(name="series"):
    """Write a file for each slice, and return their folder."""
    for number, pixels in enumerate(voxels()):
        path = write(f"{name}/{number:03}.dcm", medical_files.dicom_slice(
            pixels, number, SPACING, ORIGIN, TURN))
    return os.path.dirname(path)


class VolumeReaderTest(testing.PluginTestCase):
    def check(self, source):
        image = testing.fetch(source)
        self.assertEqual(image.GetDimensions(), voxels().shape[::-1])
        numpy.testing.assert_allclose(image.GetOrigin(), ORIGIN)
        numpy.testing.assert_allclose(image.GetSpacing(), SPACING)
        matrix = image.GetDirectionMatrix()
        found = [[matrix.GetElement(i, j) for j in range(3)] for i in range(3)]
        numpy.testing.assert_allclose(found, TURN, atol=1e-12)
        name = image.GetPointData().GetScalars().GetName()
        numpy.testing.assert_array_equal(testing.voxels(image, name), voxels())

    def test_positions_and_voxels(self):
        self.check(simple.VolumicVolume(FileNames=[nifti()]))
        folder = dicom()
        self.check(simple.VolumicDICOM(FileName=folder))
        self.check(simple.VolumicDICOM(FileName=os.path.join(folder, "007.dcm")))

    def test_series_in_time(self):
        paths = [nifti(f"t{i}.nii.gz", voxels() + i) for i in range(3)]
        source = simple.VolumicVolume(FileNames=paths)
        source.UpdatePipelineInformation()
        self.assertEqual(list(source.TimestepValues), [0, 1, 2])
        for time in (2, 0, 1):
            source.UpdatePipeline(time)
            image = source.GetDataInformation().GetPointDataInformation()
            self.assertEqual(image.GetArrayInformation(0).GetComponentRange(0),
                             (time, 12 + time))

    def test_series_of_a_folder(self):
        folder = dicom("both")
        for number, pixels in enumerate(voxels()):
            write(f"both/B{number:03}.dcm", medical_files.dicom_slice(
                100 + pixels, number, SPACING, ORIGIN, TURN, series="1.2.9"))
        with testing.CapturedMessages() as messages:
            source = simple.VolumicDICOM(FileName=folder)
            source.UpdatePipeline()
        self.assertIn("2 series; choose one as Series: 1: ", messages.text)
        source.SMProxy.UpdatePropertyInformation()
        series = source.SMProxy.GetProperty("SeriesList")
        listed = [series.GetElement(i) for i in range(series.GetNumberOfElements())]
        self.assertEqual(len(listed), 2)
        least = set()
        for series in listed:
            source.Series = series
            least.add(testing.fetch(source).GetScalarRange()[0])
        self.assertEqual(least, {0, 100})
        of_slice = simple.VolumicDICOM(FileName=os.path.join(folder, "B003.dcm"))
        self.assertEqual(testing.fetch(of_slice).GetScalarRange()[0], 100)

    def test_a_state(self):
        path = testing.output_path("readers.pvsm")
        simple.VolumicVolume(registrationName="times", FileNames=[nifti(f"t{i}.nii.gz", voxels() + i)
                                                                  for i in range(2)])
        simple.VolumicDICOM(registrationName="slices", FileName=dicom(), Resampling=0)
        simple.SaveState(path)
        testing.delete_sources()
        simple.LoadState(path)
        times, slices = (simple.FindSource(name) for name in ("times", "slices"))
        self.assertEqual(list(times.TimestepValues), [0, 1])
        self.assertEqual(slices.Resampling, 0)
        self.check(slices)

    def test_warning_is_shown_once(self):
        with testing.CapturedMessages() as messages:
            source = simple.VolumicVolume(FileNames=[nifti(), nifti("turned.nii")])
            for time in (0, 1, 0):
                source.UpdatePipeline(time)
        self.assertEqual([shown_of(text) for text in messages.text.strip().split("\n\n")], [
            f"Sform and qform differ and the sform is used ({name})"
            for name in ("turned.nii.gz", "turned.nii")])

    def test_error_messages(self):
        def library(*_, **_more):
            raise ValueError("the library fails")
        with unittest.mock.patch("volumic.reading.read", library), \
                testing.CapturedMessages() as of_library:
            simple.VolumicVolume(FileNames=[nifti()]).UpdatePipeline()
        with testing.CapturedMessages() as of_filter:
            simple.VolumetoSurface(simple.Wavelet(), TimeLimit=-1).UpdatePipeline()
        self.assertEqual(shown_of(of_library.text), "ERROR: ValueError: the library fails")
        self.assertEqual(shown_of(of_filter.text), "Time Limit is -1. Set it to 0 (none) or more seconds.")

    def test_a_folder_of_ome_zarr(self):
        tools = importlib.import_module("test_ome_zarr")
        path = testing.output_path("organs.zarr")
        shutil.rmtree(path, ignore_errors=True)
        group = tools.zarr.open_group(path, mode="w")
        tools.add_array(group, "0", label_maps.values())
        tools.describe(group, "zyx", [("0", [{"type": "scale", "scale": [2, 0.75, 0.5]}])])
        image = testing.fetch(simple.OpenDataFile(path))
        self.assertEqual(image.GetSpacing(), (0.5, 0.75, 2))
        name = image.GetPointData().GetScalars().GetName()
        numpy.testing.assert_array_equal(testing.voxels(image, name), label_maps.values())

    def test_missing_library_and_damaged_file(self):
        with open(nifti(), "rb") as file:
            path = write("cut.nii.gz", file.read()[:200])
        for modules, file, reason in (({"nibabel": None}, nifti(), "python3-nibabel"), ({}, path, path)):
            with unittest.mock.patch.dict(sys.modules, modules), \
                    testing.CapturedMessages() as messages:
                simple.VolumicVolume(FileNames=[file]).UpdatePipeline()
            self.assertIn(reason, messages.text)
            self.assertEqual(messages.text.count("ERROR"), 1, messages.text)
