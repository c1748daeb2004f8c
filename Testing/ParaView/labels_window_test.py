# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Labels to Surfaces in ParaView's window: table of labels, Apply, errors, another input; File > Open with
the readers of Volumic."""

import os
import re

import numpy

import gui_session as gui
import label_maps
import plugin_testing as testing
import volume_reader_test as files
import window_testing as window
from label_maps import NAMES
from window_testing import (
    APPLY, PROPERTIES, SHOW_ADVANCED, choose, edit, filter_of_the_menu, opened)

FILTER = filter_of_the_menu("LabelsToSurfaces")
TABLE = f"{PROPERTIES}/Labels"
BASIC = ("SetInputArrayToProcess", "Labels", "Smoothing", "EdgeLength", "Tolerance", "Merge")
ADVANCED = ("FinestLevel", "BoxFaces", "VoxelTolerance", "BackgroundLabel", "MaximumEdgeLength",
            "Gradation", "KeepComponents", "Metric", "TimeLimit", "NumberOfThreads",
            "ScratchDirectory")
UNCHECKED = 0

PRINT_RESULT = """
from paraview import servermanager, simple
filter_ = simple.FindSource("LabelstoSurfaces1")
filter_.UpdatePipeline()
blocks = servermanager.Fetch(filter_)
legend = simple.GetRepresentation(filter_, simple.GetActiveView()).LookupTable.Annotations
# ParaView 6.1's Fetch puts "Block 0_" before the names.
print("Result:", list(filter_.Labels), [blocks.GetMetaData(b).Get(blocks.NAME()).split("_")[-1]
                                      for b in range(blocks.GetNumberOfBlocks())],
      list(legend)[1::2])
"""

PRINT_LEGEND = """
from paraview import simple
view = simple.GetActiveView()
print("Legend:", simple.GetRepresentation(simple.GetActiveSource(), view).IsScalarBarVisible(view))
"""
CLIPPED = filter_of_the_menu("Clip", "Alphabetical") + "\n" + APPLY
COLORED_BY = f"{gui.WINDOW}/variableToolbar/displayColor/Variables"


def note(text):
    """Return the event that fails unless this text is below the table."""
    return gui.check(f"{TABLE}/Note", "text", text)


def rows(count):
    return gui.check(f"{TABLE}/Labels", "modelRowCount", str(count))


def press(button):
    return gui.event(f"{TABLE}/{button}", "activate") + "\n" + gui.pause(300)


def only_these_is_enabled(yes):
    return gui.check(f"{TABLE}/OnlyThese", "enabled", "true" if yes else "false")


def search(text):
    return gui.event(f"{TABLE}/Filter", "set_string", text) + "\n" + gui.pause(300)


def set_box(row, state):
    """Return the events that set the box of a row of the sorted table."""
    return gui.event(f"{TABLE}/Labels", "setCheckState", f"{row}.0,{state}") + "\n" + \
        gui.pause(300)


class LabelsWindowTest(window.WindowTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.path = testing.write_volume(
            "labels-window.vti", label_maps.add_names(label_maps.image()))

    def blocks_of(self, state):
        """Return the property Labels and the names of the blocks of the filter in a saved state."""
        filter_ = window.open_state(state, "LabelstoSurfaces1")
        return list(filter_.Labels), testing.names(testing.fetch(filter_))

    def test_panel_and_apply(self):
        path, save = self.saved_state("labels-applied.pvsm")
        pixels = self.play(opened(self.path) + [
            FILTER, gui.pause(300), rows(4), note("3 of 4 labels"),
            *[window.shown(name, True) for name in BASIC],
            *[window.shown(name, False) for name in ADVANCED], window.as_wide_as_the_panel(),
            SHOW_ADVANCED, gui.pause(300),
            *[window.shown(name, True) for name in BASIC + ADVANCED],
            # No effect without a tolerance.
            *[gui.check(f"{PROPERTIES}/{name}", "enabled", "false")
              for name in ("MaximumEdgeLength", "Gradation")],
            window.shown("MinimumComponentVolume", False),
            choose("KeepComponents", "Large Ones"), gui.pause(300),
            window.shown("MinimumComponentVolume", True), choose("KeepComponents", "All"),
            APPLY, gui.pause(300), *save], "labels-applied")
        self.assertEqual(self.blocks_of(path), ([], list(NAMES.values())))
        self.assertEqual(window.proxies_of(path).count("VolumicLabelsRepresentation"), 1)
        # All three labels in their colours.
        bright = pixels[200:, 400:].astype(int)
        for channel in range(3):
            others = numpy.delete(bright, channel, axis=2).max(axis=2)
            self.assertGreater(int((bright[..., channel] > 2 * others + 20).sum()), 300)

    def test_selection(self):
        chosen, save_chosen = self.saved_state("labels-chosen.pvsm")
        found, save_found = self.saved_state("labels-found.pvsm")
        all_, save_all = self.saved_state("labels-all.pvsm")
        background = f"{PROPERTIES}/BackgroundLabel/LineEdit0"
        self.play(opened(self.path) + [
            FILTER, gui.pause(300), set_box(1, UNCHECKED), note("2 of 4 labels"),
            APPLY, *save_chosen, only_these_is_enabled(False), search("KID"),
            only_these_is_enabled(True), press("OnlyThese"), search(""), note("1 of 4 labels"), APPLY,
            *save_found,
            # An empty list would mean all.
            set_box(2, UNCHECKED),
            note("<b>Note:</b> At least one label must be checked."),
            search("SP"), press("All"), note("2 of 4 labels"), search(""), press("All"),
            note("3 of 4 labels"), APPLY, *save_all, SHOW_ADVANCED,
            # Another background; 5 is not in the map.
            gui.event(background, "set_string", "7"), gui.pause(300), note("3 of 4 labels"),
            gui.event(background, "set_string", "5"), gui.pause(300), note("4 of 4 labels"),
            gui.event(background, "set_string", "3"), gui.pause(300), set_box(0, UNCHECKED),
            note("2 of 4 labels"), APPLY], "labels-chosen")
        self.assertEqual(self.blocks_of(chosen), ([7, 12], [NAMES[7], NAMES[12]]))
        self.assertEqual(self.blocks_of(found), ([7], [NAMES[7]]))
        # All labels are the default.
        self.assertEqual(self.blocks_of(all_), ([], list(NAMES.values())))

    def test_legend_of_downstream_filters(self):
        """Only if the surfaces have one, as up to twelve labels do."""
        voxels = numpy.repeat(numpy.arange(14, dtype=numpy.int16), 4)[:, None, None]
        many = testing.write_volume("labels-14.vti", testing.make_image(
            numpy.broadcast_to(voxels, (56, 12, 12)).copy(), name="labels"))
        print_event = self.session.add_code(PRINT_LEGEND)
        self.play([
            *opened(self.path), FILTER, APPLY, CLIPPED,
            gui.check(COLORED_BY, "currentText", "Label"), gui.pause(300), print_event,
            *opened(many), FILTER, APPLY, CLIPPED, gui.pause(300), print_event], "labels-legends")
        self.assertEqual(re.findall("Legend: (.*)", self.session.output), ["True", "False"])

    def test_undo(self):
        path, save = self.saved_state("labels-undone.pvsm")
        undo = edit("actionEditUndo")
        self.play(opened(self.path) + [
            FILTER, APPLY, gui.pause(500), set_box(2, UNCHECKED), APPLY, gui.pause(500),
            # The colour map, which follows the data, is a separate step.
            note("2 of 4 labels"), undo, undo, gui.pause(500), note("3 of 4 labels"),
            *save, gui.pause(500)], "labels-undone")
        self.assertEqual(self.blocks_of(path), ([], list(NAMES.values())))

    def test_error_and_another_file(self):
        others = label_maps.image(balls={3: ((9, 10, 11), 6.3), 40: ((20, 20, 20), 6.3)})
        others = testing.write_volume("labels-others.vti", others)
        no_map = testing.write_volume("labels-no-map.vti", testing.make_image(
            numpy.random.default_rng(1).random((12, 12, 12)), name="labels"))
        changed = self.changes_of_file("LabelstoSurfaces1", {
            "others": others, "no_map": no_map, "back": self.path})
        print_event = self.session.add_code(PRINT_RESULT)
        # Errors open a box, so not self.play().
        succeeded = self.session.play(opened(self.path) + [
            FILTER, gui.pause(500), set_box(2, UNCHECKED), APPLY, gui.pause(500), print_event,
            # The selected label 12 is missing: an error, and a row to uncheck.
            *changed["others"], rows(4), note("2 of 4 labels"), print_event,
            set_box(2, UNCHECKED), note("1 of 4 labels"), APPLY, gui.pause(500), print_event,
            *changed["no_map"], window.shown("Labels/Note", True), print_event,
            *changed["back"], rows(4), note("1 of 4 labels"), print_event,
            press("All"), APPLY, gui.pause(500), print_event, gui.pause(500)])
        self.session.screenshot(testing.output_path("labels-changed.png"))
        self.assertTrue(succeeded, self.session.output)
        runs = re.findall(r"Result: (\[.*\]) (\[.*\]) (\[.*\])", self.session.output)
        # After an error the legend is that of the previous run.
        self.assertEqual([run[:2] for run in runs], [
            ("[3, 12]", "['liver', 'spleen']"), ("[3, 12]", "[]"), ("[3]", "['Label 3']"),
            ("[3]", "[]"), ("[3]", "['liver']"), ("[]", "['liver', 'left kidney', 'spleen']")])
        self.assertEqual([run for run in runs if run[1] not in (run[2], "[]")], [])


PRINT_READER = """
from paraview import simple
reader = simple.GetActiveSource()
print("Reader:", reader.GetXMLName(), reader.GetDataInformation().GetExtent())
"""
# ParaView's dialog to select one of several readers.
DIALOG = f"{gui.WINDOW}/pqSelectReaderDialog"


def choose_reader(row):
    """Return the events that choose a reader. Volumic's is after one of ParaView, for DICOM after two."""
    return [gui.event(f"{DIALOG}/listWidget", "mousePress", f"1,1,0,20,9,/{row}:0"),
            gui.event(f"{DIALOG}/listWidget", "mouseRelease", f"1,0,0,20,9,/{row}:0"),
            gui.event(f"{DIALOG}/okButton", "activate"), gui.pause(1000)]


class VolumeReaderWindowTest(window.WindowTestCase):
    def test_files_of_each_kind(self):
        print_event = self.session.add_code(PRINT_READER)
        self.play([
            # Only Volumic reads this file.
            *opened(files.nifti("ramp.nii.gz", files.ramp())), print_event,
            filter_of_the_menu("VolumeToSurface"), APPLY,
            # Segments have names.
            *opened(files.segmentation(), choose_reader(1)), print_event,
            filter_of_the_menu("LabelsToSurfaces"),
            gui.check(f"{PROPERTIES}/Labels/Note", "text", "3 of 4 labels"), APPLY,
            # A slice opens its series.
            *opened(os.path.join(files.dicom(), "003.dcm"), choose_reader(2)), print_event], "readers")
        size = tuple(bound for n in files.voxels().shape[::-1] for bound in (0, n - 1))
        found = re.findall(r"Reader: (\w+) (.*)", self.session.output)
        self.assertEqual([name for name, _ in found],
                         ["VolumicVolumeReader", "VolumicVolumeReader", "VolumicDICOMReader"])
        self.assertEqual(found[2][1], str(size))
