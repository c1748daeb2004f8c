# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The Image Pyramid filter of the installed plugin, as a script of pvbatch or pvpython uses it."""

import numpy
from paraview import simple

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
