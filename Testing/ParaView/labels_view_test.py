# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces of labels in views: colours that follow the data."""

import numpy
from paraview import simple

import label_maps
import plugin_testing as testing
import view_testing as views
from label_maps import COLORS, NAMES

OTHER_NAMES = {3: "pelvis", 7: "femur", 12: "sacrum"}
OTHER_COLORS = {3: (0.9, 0.8, 0.1), 7: (0.8, 0.1, 0.9), 12: (0.1, 0.9, 0.9)}


def hues(pixels):
    """Return which of the colours of the three labels (red, green, blue) are visible."""
    bright = pixels.astype(int)
    found = set()
    for name, channel in (("red", 0), ("green", 1), ("blue", 2)):
        others = numpy.delete(bright, channel, axis=2).max(axis=2)
        if int((bright[..., channel] > 2 * others + 20).sum()) > 200:
            found.add(name)
    return found


def legend(display):
    """Return {value: (text, colour)} of the current colour map."""
    colors = display.LookupTable
    texts, shown = list(colors.Annotations), list(colors.IndexedColors)
    return {int(texts[2 * i]): (texts[2 * i + 1], tuple(shown[3 * i:3 * i + 3]))
            for i in range(len(texts) // 2)}


class LabelsViewTest(testing.PluginTestCase):
    def show(self, source=None, **properties):
        source = source or testing.produce(label_maps.add_names(label_maps.image()))
        self.filter = simple.LabelstoSurfaces(source, FinestLevel=1, **properties)
        self.view = views.new_view("RenderView")
        self.display = simple.Show(self.filter, self.view)
        simple.ResetCamera(self.view)
        return self.display

    def picture(self, name):
        return views.picture_of(self.view, f"labels-{name}.png")

    def check_legend(self, labels, names=None, colors=None, display=None):
        names, colors = names or NAMES, colors or COLORS
        found = legend(display or self.display)
        self.assertEqual(list(found), labels)
        for label, (name, color) in found.items():
            self.assertEqual(name, names[label])
            numpy.testing.assert_allclose(color, colors[label], atol=1e-6)

    def check_same(self, pixels, expected):
        """Compare pictures, except for a few pixels that depend on the depth of the view."""
        difference = numpy.abs(pixels.astype(int) - expected).max(axis=2)
        self.assertLess(int((difference > 16).sum()), 20)

    def legend_is_shown(self):
        return self.display.IsScalarBarVisible(self.view)

    def test_legend_of_few_labels(self):
        """Up to twelve labels, at each Apply."""
        labels = list(range(1, 14))
        voxels = numpy.repeat(numpy.arange(14, dtype=numpy.int16), 4)[:, None, None]
        voxels = numpy.broadcast_to(voxels, (56, 12, 12)).copy()
        self.show(testing.produce(testing.make_image(voxels, name="labels")))
        for chosen, is_shown in ((labels, False), (labels[:12], True), (labels, False),
                                 (labels[:2], True)):
            self.filter.Labels = chosen
            self.picture(f"legend-of-{len(chosen)}")
            self.assertEqual(self.legend_is_shown(), is_shown)
        # A legend hidden by the user stays hidden.
        self.display.SetScalarBarVisibility(self.view, False)
        self.filter.Labels = labels[:3]
        self.picture("without-legend")
        self.assertFalse(self.legend_is_shown())

    def test_colors_follow_the_data(self):
        self.show(Labels=[3])
        self.assertEqual(hues(self.picture("one")), {"red"})
        self.filter.Labels = [7, 12]
        self.assertEqual(hues(self.picture("two")), {"green", "blue"})
        self.check_legend([7, 12])
        self.assertEqual(list(self.display.ColorArrayName), ["CELLS", "Label"])
        self.assertTrue(self.display.LookupTable.InterpretValuesAsCategories)
        other = label_maps.add_names(label_maps.image(), OTHER_NAMES, OTHER_COLORS)
        self.filter.Input = testing.produce(other)
        self.picture("other")
        self.check_legend([7, 12], OTHER_NAMES, OTHER_COLORS)

    def test_edited_colors_stay(self):
        self.show(Labels=[3, 7])
        self.picture("to-be-edited")
        self.display.LookupTable.IndexedColors = [0.1, 0.1, 1.0, *COLORS[7]]
        self.assertEqual(hues(self.picture("edited")), {"green", "blue"})
        # New labels get their colours, too.
        self.filter.Labels = [3, 7, 12]
        self.picture("edited-more")
        self.check_legend([3, 7, 12], colors={**COLORS, 3: (0.1, 0.1, 1.0)})

    def test_good_run_after_error(self):
        source = testing.produce(label_maps.add_names(label_maps.image()))
        with testing.CapturedMessages() as messages:
            self.show(source, Smoothing=-1.0)
            self.assertEqual(views.drawn(self.picture("bad")), 0)
        self.assertEqual(messages.text.count("ERROR: "), 1, messages.text)
        self.filter.Smoothing = 2.0
        self.filter.UpdatePipeline()
        simple.ResetCamera(self.view)
        self.assertEqual(hues(self.picture("good")), {"red", "green", "blue"})
        self.display.SetScalarBarVisibility(self.view, False)
        good = self.picture("good")
        with testing.CapturedMessages():
            self.filter.Labels = [3, 99]
            self.assertEqual(views.drawn(self.picture("bad")), 0)
        self.filter.Labels = []
        self.check_same(self.picture("good-again"), good)

    def clip(self, surfaces):
        """Return the display of a clip that removes the spleen."""
        clip = simple.Clip(surfaces)
        clip.ClipType.Normal = [0.0, 0.0, 1.0]
        clip.ClipType.Origin = [16.0, 16.0, 12.0]
        display = simple.Show(clip, self.view)
        simple.Hide(surfaces, self.view)
        return display

    def test_downstream_filters(self):
        """They have the names and colours of their own label map."""
        self.show()
        self.picture("to-be-clipped")
        clipped = self.clip(self.filter)
        self.display.SetScalarBarVisibility(self.view, False)
        self.assertEqual(hues(self.picture("clipped")), {"red", "green"})
        other = label_maps.add_names(label_maps.image(), OTHER_NAMES, OTHER_COLORS)
        second = simple.LabelstoSurfaces(testing.produce(other), FinestLevel=1)
        simple.Show(second, self.view)
        self.picture("another-map")
        others = self.clip(second)
        self.picture("clipped-with-another")
        self.check_legend([3, 7, 12], display=clipped)
        self.check_legend([3, 7, 12], OTHER_NAMES, OTHER_COLORS, others)
        # Changes of the input, of the names, of the array, and a second view.
        clipped.Input.Input = second
        self.check_legend([3, 7, 12], OTHER_NAMES, OTHER_COLORS, clipped)
        clipped.Input.Input = self.filter
        simple.ColorBy(self.display, None)
        self.filter.LabelNames = ["3", "hepar"]
        self.picture("renamed")
        self.check_legend([3, 7, 12], {**NAMES, 3: "hepar"}, display=clipped)
        simple.ColorBy(self.display, ("CELLS", "Label"))
        self.check_legend([3, 7, 12], {**NAMES, 3: "hepar"})
        elsewhere = simple.Show(others.Input, views.new_view("RenderView"))
        simple.ColorBy(elsewhere, ("CELLS", "Label"))
        self.check_legend([3, 7, 12], OTHER_NAMES, OTHER_COLORS, elsewhere)
        # Label 3 has different names in the two maps.
        both = simple.Show(simple.GroupDatasets(Input=[self.filter, second]), self.view)
        simple.ColorBy(both, ("CELLS", "Label"))
        self.assertEqual(legend(both), {})
        for proxy in (both.Input, clipped.Input, self.filter):
            simple.Delete(proxy)
        self.picture("one-map-deleted")
        self.check_legend([3, 7, 12], OTHER_NAMES, OTHER_COLORS, others)

    def test_saved_state(self):
        path = testing.write_volume("labels-view.vti", label_maps.image())
        reader = simple.XMLImageDataReader(FileName=path)
        reader.UpdatePipeline()
        self.show(reader, LabelNames=["3", "liver", "7", "left kidney", "12", "spleen"])
        before = self.picture("before-the-state")
        colors = {label: color for label, (_, color) in legend(self.display).items()}
        for name in ("labels-view.pvsm", "labels-view-state.py"):
            with self.subTest(name=name):
                simple.SaveState(testing.output_path(name))
                self.tearDown()
                simple.LoadState(testing.output_path(name))
                self.filter = next(source for source in simple.GetSources().values()
                                   if source.GetXMLName() == "LabelsToSurfaces")
                self.view = simple.GetViews()[0]
                self.display = simple.GetRepresentation(self.filter, self.view)
                self.check_same(self.picture("after-the-state"), before)
                self.check_legend([3, 7, 12], colors=colors)
