# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Volume to Surface in ParaView's window: panel, undo and redo, stop and resume."""

import re

import numpy

import gui_session as gui
import plugin_testing as testing
import window_testing as window
from window_testing import (
    APPLY, ISO_VALUE, PROPERTIES, SHOW_ADVANCED, choose, edit, filter_of_the_menu,
    iso_of_the_wavelet, opened, range_of_the_wavelet, set_iso_value, source)
from paraview import simple

VOLUME = source("RTAnalyticSource")
FILTER = filter_of_the_menu("VolumeToSurface")
BASIC = ("SetInputArrayToProcess", "IsoValue", "UseUpperValue", "Preview", "KeepComponents",
         "Initialization", "EdgeLength", "Result")
ADVANCED = ("ObjectIsBright", "BorderValue", "ShowLevels", "FinestLevel", "CoarsestLevel", "Recovery",
            "Metric", "Tolerance", "ThinParts", "TopologyChanges", "TensionWeight",
            "EdgeAttractionWeight", "AttractingPositions", "TimeLimit", "NumberOfThreads",
            "ScratchDirectory", "SnapshotInterval")

# Runs in the window: stops the first run of a filter when its progress text contains WHERE, and reports
# each run.
STOP_THE_FIRST_RUN = window.WATCH_FILTERS + """
def attend(proxy, algorithm):
    runs = []
    def start(caller, event):
        runs.append(1)
        print("Run", len(runs), "begins")
    def progress(caller, event):
        text = caller.GetProgressText() or ""
        if ", iteration" in text:
            print("Run", len(runs), text)
        if len(runs) == 1 and WHERE in text:
            caller.SetAbortExecute(1)
    def end(caller, event):
        surface = caller.GetOutputDataObject(0)
        reason = surface.GetFieldData().GetAbstractArray("StopReason")
        print("Run", len(runs), "ended:", reason.GetValue(0) if reason else "",
              "with triangles:", surface.GetNumberOfPolys(), "points:", surface.GetNumberOfPoints(),
              "in", surface.GetBounds())
    algorithm.AddObserver("StartEvent", start)
    algorithm.AddObserver("ProgressEvent", progress)
    algorithm.AddObserver("EndEvent", end)
"""

def stop_the_first_run(where):
    return STOP_THE_FIRST_RUN.replace("WHERE", repr(where))


class VolumeWindowTest(window.WindowTestCase):
    def test_menu_panel_and_apply(self):
        path, save = self.saved_state("volume.pvsm")
        edge_length = f"{PROPERTIES}/EdgeLength/DoubleLineEdit0"
        self.play(VOLUME + [
            # The first entry of the menu.
            *window.open_menu_of_volumic(), gui.pause(500),
            gui.event(f"{window.FILTERS}/Volumic", "keyEvent", "6,16777220,0,,0,1"),
            gui.pause(500),
            gui.check(ISO_VALUE, "text", iso_of_the_wavelet()),
            *[window.shown(name, True) for name in BASIC],
            *[window.shown(name, False) for name in ADVANCED],
            window.as_wide_as_the_panel(), window.value_range(*range_of_the_wavelet()),
            # Also without advanced properties.
            window.shown("MinimumComponentVolume", False),
            choose("KeepComponents", "Large Ones"), gui.pause(300),
            window.shown("MinimumComponentVolume", True), choose("KeepComponents", "All"),
            APPLY, *save, SHOW_ADVANCED, gui.pause(500),
            *[window.shown(name, True) for name in BASIC + ADVANCED],
            *[window.shown(name, False) for name in ("SeedRadius", "MaximumEdgeLength", "Gradation")],
            window.shown("ScratchDirectory/FileChooser", True),
            # Properties that cannot be combined are disabled.
            gui.event(edge_length, "set_string", "2"), gui.pause(300),
            *[gui.check(f"{PROPERTIES}/{name}", "enabled", "false")
              for name in ("FinestLevel", "Tolerance", "ThinParts")],
            gui.event(edge_length, "set_string", "0"), window.set_box("ThinParts", True),
            gui.pause(300), window.shown("Gradation", True),
            gui.check(f"{PROPERTIES}/EdgeLength", "enabled", "false")], "volume-applied")
        state = window.proxies_of(path)
        self.assertEqual(state.count("VolumicSurfaceRepresentation"), 1)
        surface = testing.fetch(window.open_state(path, "VolumetoSurface1"))
        self.assertEqual(testing.field(surface, "StopReason"), "converged")

    def test_links_of_value_range(self):
        z, y, x = numpy.mgrid[0:40, 0:40, 0:40]
        distance = numpy.sqrt((x - 20.0)**2 + (y - 20.0)**2 + (z - 20.0)**2)
        voxels = numpy.clip(1500 - 150 * distance, -1000, 1500).astype(numpy.int16)
        path = testing.write_volume("ct.vti", testing.make_image(voxels, name="HU"))
        label = f"{PROPERTIES}/IsoValue/ValueRange"
        self.play(opened(path) + [
            FILTER, gui.pause(500),
            gui.check(label, "text", "<b>Value Range:</b> [-1000, 1500]<br>CT: "
                      "<a href='226'>bone 226</a>, <a href='-300'>skin -300</a>"),
            # The first link of the last row: the second row or, in a narrow panel, the third one.
            *[gui.event(label, f"mouse{what}", f"1,{buttons},0,50,{y}")
              for y in (21, 38) for what, buttons in (("Press", 1), ("Release", 0))], gui.pause(500),
            gui.check(ISO_VALUE, "text", "226"),
            gui.check(f"{PROPERTIES}/IsoValue/Slider", "visible", "true"), APPLY,
            # Magnetic resonance, with some voxels below 0.
            *opened(testing.write_volume("mr.vti", testing.make_image(
                numpy.maximum(voxels, -610), name="MR"))),
            FILTER, gui.pause(300), window.value_range(-610, 1500),
            # Vessels in tissue, twice.
            *opened(self.series("vessels", numpy.select([distance < 5, distance < 17], [500, 200]))),
            FILTER, gui.pause(300),
            gui.check(label, "text", "<b>Value Range:</b> [0, 500]<br>Small part: "
                      "<a href='350'>bright 350</a><br>One value for all time steps")], "volume-ct")

    @staticmethod
    def series(name, voxels):
        """Return the path of a file with the volume at two times."""
        testing.write_volume(f"{name}.vti", testing.make_image(voxels.astype("u2")))
        path = testing.output_path(f"{name}.pvd")
        with open(path, "w", encoding="utf-8") as file:
            file.write('<VTKFile type="Collection"><Collection>' + "".join(
                f'<DataSet timestep="{time}" file="{name}.vti"/>' for time in range(2))
                + "</Collection></VTKFile>")
        return path

    def test_summary(self):
        testing.load_plugin()
        surface = testing.fetch(simple.VolumetoSurface(simple.Wavelet()))
        area, volume = (surface.GetFieldData().GetArray(name).GetValue(0)
                        for name in ("Area", "Volume"))
        limit = f"{PROPERTIES}/TimeLimit/DoubleLineEdit0"
        # The panel shows three digits.
        self.assertTrue(1000 < area < 10000 and 1000 < volume < 10000, (area, volume))
        self.play(VOLUME + [
            FILTER, gui.pause(500), gui.check(f"{PROPERTIES}/Result/Summary", "text", "none yet"),
            APPLY, gui.pause(500),
            gui.check(f"{PROPERTIES}/Result/Summary", "text",
                      f"<b>Surface</b> of level 0, started at level "
                      f"{testing.field(surface, 'StartLevel')}<br>{surface.GetNumberOfPoints():,} vertices, "
                      f"1 component, genus 0<br>area {round(area, -1):,.0f} world units²<br>"
                      f"volume {round(volume, -1):,.0f} world units³<br>"
                      "0.0 % of the boundary missing<br>no self-intersections"),
            SHOW_ADVANCED, gui.pause(500), gui.event(limit, "set_string", "1e-9"),
            set_iso_value(140), APPLY,
            gui.pause(500), gui.check(f"{PROPERTIES}/Result/Summary", "text",
                                       "<b>Unfinished</b> (time limit): no surface yet")],
            "volume-summary")

    def test_apply_resumes_after_stop(self):
        testing.load_plugin()
        whole = testing.fetch(simple.VolumetoSurface(simple.Wavelet()))
        apply = f"{gui.PANEL}/Accept"
        at_level_0 = stop_the_first_run("Level 0, iteration")
        stopped = VOLUME + [FILTER, gui.pause(300), APPLY, gui.pause(300),
                            gui.check(apply, "enabled", "true")]
        applied = [APPLY, gui.pause(300), gui.check(apply, "enabled", "false"),
                   gui.check(f"{PROPERTIES}/Result/Summary", "visible", "true")]
        self.play(stopped + applied, "volume-resumed", python=at_level_0)
        self.assertIn("Run 1 Level 1, iteration", self.session.output)
        self.assertRegex(self.session.output, r"Run 1 ended: cancelled with triangles: [1-9]")
        self.assertIn("Run 2 Level 0, iteration", self.session.output)
        self.assertNotIn("Run 2 Level 1, iteration", self.session.output)
        self.assertRegex(self.session.output, r"Run 2 ended: converged .* points: "
                         f"{whole.GetNumberOfPoints()} in {re.escape(str(whole.GetBounds()))}")
        # With another value the run restarts.
        self.play(stopped + [set_iso_value(140), *applied], "volume-restarted",
                  python=at_level_0)
        self.assertIn("Run 2 Level 1, iteration", self.session.output)

    def test_histogram(self):
        values = numpy.mgrid[0:12, 0:14, 0:16].sum(axis=0).astype(float)
        image = testing.make_image(values, name="a")
        testing.add_array(image, 100.0 - values, "b")
        path = testing.write_volume("histogram.vti", image)
        histogram = f"{PROPERTIES}/IsoValue/Histogram"

        def drag(x, to, button=1):
            """Return the events of a drag, by default with the left button."""
            return [gui.event(histogram, what, f"{button},{buttons},0,{position},9")
                    for what, buttons, position in (("mousePress", button, x),
                                                 ("mouseMove", button, to),
                                                 ("mouseRelease", 0, to))] + [gui.pause(300)]
        pixels = self.play(opened(path) + [
            FILTER, gui.pause(500), gui.check(histogram, "visible", "true"),
            *drag(9, -5), gui.check(ISO_VALUE, "text", "0"), window.value_range(0, 39),
            *drag(9, 5000), gui.check(ISO_VALUE, "text", "39"),
            *drag(9, -5, button=2), gui.check(ISO_VALUE, "text", "39"),
            choose("SetInputArrayToProcess", "b"), gui.pause(300), window.value_range(61, 100),
            *drag(9, 5000), gui.check(ISO_VALUE, "text", "100"),
            set_iso_value(80), gui.pause(300)], "volume-histogram")
        # The width of the line.
        red, green, blue = (pixels[..., colour].astype(int) for colour in range(3))
        line = numpy.nonzero(((red == 208) & (green == 32) & (blue == 32)).sum(axis=0) > 40)[0]
        self.assertEqual(len(line), 2, line)
        # The values up to Upper Value are tinted.
        pixels = self.play(opened(path) + [
            FILTER, gui.pause(500), *drag(9, -5), window.set_box("UseUpperValue", True),
            gui.pause(300), gui.check(f"{PROPERTIES}/UpperValue", "visible", "true")],
            "volume-histogram-range")
        red, green, blue = (pixels[..., colour].astype(int) for colour in range(3))
        tinted = ((red > green + 25) & (green == blue)).sum(axis=0) > 40
        self.assertGreater(tinted.sum(), 50)
        # These voxels have no threshold.
        flat = testing.write_volume("flat.vti", testing.make_image(values * 0 + 7, name="a"))
        self.assertTrue(self.session.play(opened(flat) + [
            FILTER, gui.pause(300), gui.check(histogram, "visible", "false")]),
            self.session.output)

    def test_undo_redo_and_another_range(self):
        path, save = self.saved_state("redone.pvsm")
        self.play(VOLUME + [
            FILTER, APPLY, set_iso_value(140), APPLY,
            edit("actionEditUndo"), gui.pause(500),
            gui.check(ISO_VALUE, "text", iso_of_the_wavelet()),
            edit("actionEditRedo"), gui.pause(500), gui.check(ISO_VALUE, "text", "140"), *save,
            # The range follows the source.
            window.in_the_pipeline(0), gui.pause(300),
            gui.event(f"{PROPERTIES}/Maximum/DoubleLineEdit0", "set_string", "511"),
            APPLY, gui.pause(300), window.in_the_pipeline(0, 0), gui.pause(300),
            window.value_range(*range_of_the_wavelet(Maximum=511))], "volume-redone")
        filter_ = window.open_state(path, "VolumetoSurface1")
        self.assertEqual(filter_.IsoValue, 140.0)
        self.assertGreater(testing.fetch(filter_).GetNumberOfPolys(), 0)
