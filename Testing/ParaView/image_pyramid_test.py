# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The Image Pyramid filter of the installed plugin, as a script of pvbatch or pvpython uses it."""

import os
import sys

import numpy
from paraview import simple

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import plugin_testing as testing
from plugin_testing import SQRT3


def pyramid_of(source, **properties):
    # ParaView chooses the array from what the source is known to hold.
    source.UpdatePipeline()
    filter_ = simple.ImagePyramid(Input=source, **properties)
    result = testing.fetch(filter_)
    simple.Delete(filter_)
    return result


def field_value(image, name):
    return image.GetFieldData().GetArray(name).GetTuple1(0)


class ImagePyramidTest(testing.PluginTestCase):
    def test_levels_of_the_wavelet(self):
        # 21 voxels, floor(21 / sqrt 3) = 12, and the next level would have 6, under the 10 allowed.
        pyramid = pyramid_of(simple.Wavelet())
        self.assertEqual(pyramid.GetClassName(), "vtkMultiBlockDataSet")
        self.assertEqual(pyramid.GetNumberOfBlocks(), 2)
        self.assertEqual(testing.names(pyramid), ["Level 0", "Level 1"])
        finest, coarsest = testing.levels(pyramid)
        self.assertEqual(finest.GetExtent(), (-10, 10, -10, 10, -10, 10))
        self.assertEqual(coarsest.GetDimensions(), (12, 12, 12))
        numpy.testing.assert_allclose(coarsest.GetSpacing(), [21 / 12] * 3)
        # The extent of the wavelet begins at -10: the place of its first voxel is the new origin.
        numpy.testing.assert_allclose(coarsest.GetOrigin(), [-10] * 3)
        for h, image in enumerate((finest, coarsest)):
            self.assertEqual(field_value(image, "Level"), h)
            self.assertEqual(image.GetFieldData().GetArray("Level").GetClassName(), "vtkIntArray")
            self.assertAlmostEqual(field_value(image, "Unit"), SQRT3**h, places=12)
            self.assertIsNotNone(image.GetPointData().GetArray("RTData"))
        smooth = testing.voxels(coarsest, "RTData")
        self.assertEqual(smooth.dtype, numpy.float32)
        sharp = testing.voxels(finest, "RTData")
        self.assertLess(smooth.std(), sharp.std())
        self.assertGreaterEqual(smooth.min(), sharp.min())
        self.assertLessEqual(smooth.max(), sharp.max())

    def test_scripted_levels_and_factor(self):
        pyramid = pyramid_of(simple.Wavelet(), NumberOfLevels=4, ReductionFactor=1.5)
        sizes = [image.GetDimensions() for image in testing.levels(pyramid)]
        self.assertEqual(sizes, [(21,) * 3, (14,) * 3, (9,) * 3, (6,) * 3])

    def test_minimum_level_size(self):
        pyramid = pyramid_of(simple.Wavelet(), MinimumLevelSize=3)
        self.assertEqual([i.GetDimensions()[0] for i in testing.levels(pyramid)], [21, 12, 6, 3])

    def test_constants_stay(self):
        image = testing.make_image(numpy.full((20, 22, 24), -7.25, numpy.float32))
        pyramid = pyramid_of(testing.produce(image), NumberOfLevels=3)
        for level in testing.levels(pyramid):
            numpy.testing.assert_allclose(testing.voxels(level, "v"), -7.25, rtol=1e-6)

    def test_a_ramp_stays_that_ramp(self):
        # Anisotropic, with an origin and an extent that doesn't begin at 0: values are places.
        spacing, origin, start = (0.5, 0.5, 2.0), (3.0, -4.0, 5.0), (2, -3, 7)
        x = origin[0] + spacing[0] * (start[0] + numpy.arange(40))
        z = origin[2] + spacing[2] * (start[2] + numpy.arange(30))
        values = numpy.zeros((30, 36, 40)) + x[None, None, :] + 10.0 * z[:, None, None]
        pyramid = pyramid_of(testing.produce(testing.make_image(values, spacing, origin, start)),
                             NumberOfLevels=2)
        level = pyramid.GetBlock(1)
        self.assertEqual(level.GetDimensions(), (23, 20, 17))
        first = [o + s * e for o, s, e in zip(origin, spacing, start)]
        numpy.testing.assert_allclose(level.GetOrigin(), first)
        numpy.testing.assert_allclose(level.GetSpacing(), [0.5 * 40 / 23, 0.5 * 36 / 20, 2 * 30 / 17])
        smooth = testing.voxels(level, "v")
        self.assertEqual(smooth.dtype, numpy.float64)
        step_x, _, step_z = level.GetSpacing()
        x = first[0] + step_x * numpy.arange(23)
        z = first[2] + step_z * numpy.arange(17)
        expected = x[None, None, :] + 10.0 * z[:, None, None]
        # Two units from the border, the kernel does not see it.
        inside = (slice(2, -3), slice(3, -3), slice(3, -3))
        expected = numpy.broadcast_to(expected, smooth.shape)
        numpy.testing.assert_allclose(smooth[inside], expected[inside], rtol=1e-12)

    def test_array_selection(self):
        image = testing.make_image(numpy.full((12, 12, 12), 1, numpy.int16), name="first")
        testing.add_array(image, numpy.full((12, 12, 12), 2, numpy.uint8), "second")
        source = testing.produce(image)
        for name, value in (("first", 1), ("second", 2)):
            pyramid = pyramid_of(source, Voxels=["POINTS", name], NumberOfLevels=2)
            level = pyramid.GetBlock(1)
            numpy.testing.assert_array_equal(testing.voxels(level, name), value)
            self.assertEqual(level.GetPointData().GetNumberOfArrays(), 1)
            self.assertEqual(level.GetPointData().GetScalars().GetName(), name)

    def test_default_array_of_a_source_that_was_not_updated(self):
        # ParaView does not know its arrays then, and hands an empty name to the filter.
        pyramid = testing.fetch(simple.ImagePyramid(Input=simple.Wavelet(), NumberOfLevels=2))
        self.assertIsNotNone(pyramid.GetBlock(1).GetPointData().GetArray("RTData"))

    def test_thread_counts_agree_to_the_bit(self):
        values = numpy.random.default_rng(1).random((40, 41, 42), numpy.float32)
        source = testing.produce(testing.make_image(values))
        one, two = [pyramid_of(source, NumberOfThreads=n, NumberOfLevels=3) for n in (1, 2)]
        for a, b in zip(testing.levels(one), testing.levels(two)):
            self.assertEqual(testing.voxels(a, "v").tobytes(), testing.voxels(b, "v").tobytes())

    def test_a_flat_image(self):
        values = numpy.random.default_rng(2).random((1, 30, 30), numpy.float32)
        pyramid = pyramid_of(testing.produce(testing.make_image(values)), NumberOfLevels=2)
        self.assertEqual(pyramid.GetBlock(1).GetDimensions(), (17, 17, 1))

    def check_error(self, expected, source, **properties):
        """The message that a bad input gives, and that there is no output afterwards."""
        with testing.CapturedMessages() as messages:
            pyramid = pyramid_of(source, **properties)
        self.assertIn("vtkImagePyramid", messages.text)
        for word in expected:
            self.assertIn(word, messages.text)
        self.assertEqual(pyramid.GetNumberOfBlocks() if pyramid else 0, 0)

    def test_error_for_voxels_that_are_no_numbers(self):
        values = numpy.ones((12, 12, 12), numpy.float32)
        values[3, 4, 5] = values[6, 7, 8] = numpy.nan
        self.check_error(["2", "5", "4", "3"], testing.produce(testing.make_image(values)),
                         NaNIsBackground=0)

    def test_error_for_too_many_levels(self):
        self.check_error(["20"], simple.Wavelet(), NumberOfLevels=20)

    def test_error_for_an_array_that_is_not_there(self):
        self.check_error(["absent"], simple.Wavelet(),
                         Voxels=["POINTS", "absent"])

    def test_the_filter_works_after_an_error(self):
        source = simple.Wavelet()
        source.UpdatePipeline()
        filter_ = simple.ImagePyramid(Input=source, NumberOfLevels=20)
        with testing.CapturedMessages() as messages:
            filter_.UpdatePipeline()
        self.assertIn("vtkImagePyramid", messages.text)
        filter_.NumberOfLevels = 2
        self.assertEqual(testing.fetch(filter_).GetNumberOfBlocks(), 2)


testing.main()
