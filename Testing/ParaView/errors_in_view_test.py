# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""After an error no view shows old data: good runs before and after each kind of error."""

import numpy
from paraview import simple

import plugin_testing as testing
import view_testing as views

SIZE, RADIUS = 24, 7.0
# An invalid value of properties that different stages of a run find. C++ tests have the others.
FILTERS = {"ImagePyramid": {"ReductionFactor": 3.0, "NumberOfLevels": 20},
           "DeformableSurface": {"IsoValue": float("nan"), "CoarsestLevel": 9, "SeedRadius": -2.0},
           "VolumetoSurface": {"IsoValue": 1000.0, "MinimumLevelSize": 0, "Initialization": 3}}


def ball(contrast=100, name="density"):
    inside = numpy.clip(0.5 + 0.5 * (RADIUS - testing.distances(SIZE)), 0, 1)
    return testing.make_image((contrast * inside).astype(numpy.float32), name=name)


def no_arrays():
    image = ball()
    image.GetPointData().Initialize()
    return image


# Invalid files, and the filters for which they are invalid.
BAD_FILES = {
    "no-arrays": (no_arrays, FILTERS),
    "empty": (lambda: testing.make_image(numpy.zeros((0, 0, 0), numpy.float32)), FILTERS),
    "too-small": (lambda: testing.make_image(numpy.ones((24, 24, 5), numpy.float32),
                                             name="density"),
                  ("DeformableSurface", "VolumetoSurface")),
    "nothing-bright": (lambda: ball(0), ("DeformableSurface", "VolumetoSurface")),
}


class ErrorsInViewTest(testing.PluginTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.good_file = testing.write_volume("volume-good.vti", ball())

    def setUp(self):
        self.view = views.new_view("RenderView")

    def show(self, kind):
        """Show a filter with a reader in the view."""
        reader = simple.XMLImageDataReader(FileName=self.good_file)
        reader.UpdatePipeline()
        self.filter = getattr(simple, kind)(reader)
        self.display = simple.Show(self.filter, self.view)
        if kind == "ImagePyramid":
            self.display.Representation = "Surface"

    def set_number(self, name, value):
        """Set a property without the check of Python's properties."""
        self.filter.SMProxy.GetProperty(name).SetElement(0, value)
        self.filter.SMProxy.UpdateVTKObjects()

    def rendered(self, name):
        pixels = views.picture_of(self.view, f"errors-{name}.png")
        return pixels if views.drawn(pixels) else None

    def check_run(self, is_good, expected=None, first=False):
        """Check the view, the client and the object after a run."""
        with testing.CapturedMessages() as messages:
            self.filter.UpdatePipeline()
            if first:
                simple.ResetCamera(self.view)
            pixels = self.rendered("good" if is_good else "bad")
        self.assertEqual("ERROR" in messages.text, not is_good, messages.text)
        self.assertNotIn("vtkInformation", messages.text, "VTK's own error message")
        for port in range(self.filter.GetNumberOfOutputPorts()):
            # Snapshots are off.
            has_data = is_good and port < 3
            self.assertEqual(self.size_of(port) > 0, has_data, port)
        output = self.filter.GetClientSideObject().GetOutputDataObject(0)
        self.assertEqual(output.GetNumberOfPoints() > 0, is_good)
        self.assertEqual(self.filter.GetClientSideObject().GetErrorCode() == 0, is_good)
        self.assertEqual(self.display.GetRepresentedDataInformation().GetNumberOfPoints() > 0,
                         is_good)
        self.assertEqual(pixels is not None, is_good)
        if expected is not None:
            numpy.testing.assert_array_equal(pixels, expected)
        return pixels

    def size_of(self, port):
        """Return the size in the data information of the client."""
        information = self.filter.GetDataInformation(port)
        return information.GetNumberOfPoints() + information.GetNumberOfRows()

    def test_invalid_properties(self):
        for kind, numbers in FILTERS.items():
            self.show(kind)
            expected = self.check_run(True, first=True)
            for name, value in numbers.items():
                good = self.filter.SMProxy.GetProperty(name).GetElement(0)
                with self.subTest(filter=kind, name=name, value=value):
                    self.set_number(name, value)
                    self.check_run(False)
                    self.set_number(name, good)
                    self.check_run(True, expected)
            simple.Delete(self.filter)

    def test_second_inputs(self):
        self.show("VolumetoSurface")
        expected = self.check_run(True, first=True)
        for initialization, source in (
                (3, simple.Plane(Origin=(5, 5, 11), Point1=(18, 5, 11), Point2=(5, 18, 11))),
                (1, simple.PointSource(Center=(99, 0, 0), NumberOfPoints=1))):
            with self.subTest(initialization=initialization):
                self.filter.InitialSurface = source
                self.set_number("Initialization", initialization)
                self.check_run(False)
                self.filter.InitialSurface = None
                self.set_number("Initialization", 0)
                self.check_run(True, expected)

    def change_file(self, path):
        """Replace the reader, as File > Change File does."""
        simple.ReplaceReaderFileName(self.filter.Input, [path], "FileName")
        self.filter.Input.UpdatePipeline()

    def test_change_of_file(self):
        for name, (image, kinds) in BAD_FILES.items():
            bad_file = testing.write_volume(f"volume-{name}.vti", image())
            for kind in kinds:
                with self.subTest(file=name, filter=kind):
                    self.show(kind)
                    expected = self.check_run(True, first=True)
                    self.change_file(bad_file)
                    self.check_run(False)
                    self.change_file(self.good_file)
                    self.check_run(True, expected)
                    self.assertEqual(list(self.filter.Voxels), ["POINTS", "density"])
                    simple.Delete(self.filter)

    def test_another_array(self):
        """In the next file, after an invalid one."""
        bad_file = testing.write_volume("volume-none.vti", no_arrays())
        renamed = testing.write_volume("volume-renamed.vti", ball(1000, "voxels"))
        self.show("VolumetoSurface")
        self.check_run(True, first=True)
        iso_value = self.filter.IsoValue
        for path in (bad_file, renamed):
            self.change_file(path)
            self.check_run(path == renamed)
        self.assertEqual(list(self.filter.Voxels), ["POINTS", "voxels"])
        self.assertAlmostEqual(self.filter.IsoValue, 10 * iso_value, delta=1)
