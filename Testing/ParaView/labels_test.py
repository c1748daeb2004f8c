# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The Labels to Surfaces filter of the installed plugin, in scripts of pvbatch and pvpython."""

import math

import numpy
from paraview import simple
from paraview.vtk.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkMultiBlockDataSet

import label_maps
import plugin_testing as testing
from label_maps import BALLS, COLORS, NAMES


def labels_of(surface):
    """Return the labels of the triangles."""
    return set(vtk_to_numpy(surface.GetCellData().GetArray("Label")).tolist())


class LabelsTestCase(testing.PluginTestCase):
    def blocks(self, filter_):
        """Return {name: surface}; no message is expected."""
        with testing.CapturedMessages() as messages:
            output = testing.fetch(filter_)
        self.assertEqual(messages.text, "")
        return dict(zip(testing.names(output), testing.levels(output)))

    def check_ball(self, surface, label):
        centre, radius = BALLS[label]
        self.assertEqual(testing.field(surface, "StopReason"), "converged")
        self.assertEqual(testing.field(surface, "Label"), label)
        self.assertEqual(testing.field(surface, "NumberOfComponents"), 1)
        self.assertEqual(testing.field(surface, "EulerCharacteristic"), 2)
        self.assertEqual(labels_of(surface), {label})
        voxels = testing.field(surface, "LabelVoxels")
        self.assertEqual(voxels, int((label_maps.values() == label).sum()))
        self.assertLess(testing.field(surface, "WrongVoxels"), 0.03 * voxels)
        self.assertEqual(testing.field(surface, "MissedVoxels"), 0)
        self.assertAlmostEqual(testing.field(surface, "Volume") / voxels, 1.0, delta=0.01)
        distance = numpy.linalg.norm(testing.points(surface) - centre, axis=1)
        self.assertLess(numpy.abs(distance - radius).max(), 0.8)


class LabelsTest(LabelsTestCase):
    def test_selected_labels(self):
        filter_ = simple.LabelstoSurfaces(testing.produce(label_maps.image()), Labels=[12, 3])
        self.assertEqual(list(self.blocks(filter_)), ["Label 3", "Label 12"])
        filter_.Labels = [7]
        self.check_ball(self.blocks(filter_)["Label 7"], 7)
        filter_.Labels = []
        self.assertEqual(list(self.blocks(filter_)), ["Label 3", "Label 7", "Label 12"])
        filter_.BackgroundLabel = 7
        self.assertEqual(list(self.blocks(filter_)), ["Label 0", "Label 3", "Label 12"])

    def test_cells(self):
        filter_ = simple.LabelstoSurfaces(testing.produce(label_maps.cells()))
        self.assertEqual(list(filter_.Voxels), ["CELLS", "labels"])
        for label, surface in zip(BALLS, self.blocks(filter_).values()):
            self.check_ball(surface, label)

    def test_names_and_colors(self):
        source = testing.produce(label_maps.add_names(label_maps.image()))
        filter_ = simple.LabelstoSurfaces(source)
        blocks = self.blocks(filter_)
        self.assertEqual(list(blocks), list(NAMES.values()))
        for label, surface in zip(BALLS, blocks.values()):
            self.check_ball(surface, label)
            color = surface.GetFieldData().GetArray("LabelColor").GetTuple(0)
            numpy.testing.assert_allclose(color, COLORS[label], atol=1e-6)
        filter_.LabelNames = ["7", "ren sinister"]
        blocks = self.blocks(filter_)
        self.assertEqual(list(blocks), ["liver", "ren sinister", "spleen"])
        filter_.LabelNames = []
        self.assertEqual(list(self.blocks(filter_)), list(NAMES.values()))

    def test_accepted_inputs(self):
        """In the menu; a composite dataset with one image is accepted."""
        bare = label_maps.image()
        bare.GetPointData().Initialize()
        vectors = label_maps.image()
        vectors.GetPointData().Initialize()
        testing.add_array(vectors, numpy.zeros(1), "colours")
        array = vectors.GetPointData().GetArray("colours")
        array.SetNumberOfComponents(3)
        array.SetNumberOfTuples(label_maps.SIZE**3)
        nested = vtkMultiBlockDataSet()
        nested.SetBlock(1, label_maps.image())
        for data, expected in ((label_maps.image(), True), (label_maps.cells(), True),
                               (nested, True), (bare, False), (vectors, False)):
            with self.subTest(data=data.GetClassName()), testing.CapturedMessages():
                filter_ = simple.LabelstoSurfaces(testing.produce(data))
                offered = filter_.SMProxy.GetProperty("Input").IsInDomains()
                self.assertEqual(bool(offered), expected)
        filter_ = simple.LabelstoSurfaces(testing.produce(nested), Labels=[7])
        self.check_ball(self.blocks(filter_)["Label 7"], 7)

    def test_stop_and_restart(self):
        filter_ = simple.LabelstoSurfaces(testing.produce(label_maps.image()))
        algorithm = filter_.GetClientSideObject()
        # As by the cross beside the progress bar.
        tag = algorithm.AddObserver("ProgressEvent", lambda caller, _: caller.SetAbortExecute(1))
        stopped = testing.levels(testing.fetch(filter_))
        reasons = [testing.field(surface, "StopReason") for surface in stopped]
        self.assertEqual(reasons, ["cancelled"] * 3)
        algorithm.RemoveObserver(tag)
        filter_.SMProxy.InvokeCommand("GoOn")
        for label, surface in zip(BALLS, self.blocks(filter_).values()):
            self.check_ball(surface, label)


class LabelErrorsTest(LabelsTestCase):
    def check_error(self, filter_, *words):
        output, printed = self.check_one_error(filter_)
        for word in words:
            self.assertIn(word, printed)
        self.assertEqual(output.GetNumberOfBlocks(), 0)

    def test_interfaces(self):
        filter_ = simple.LabelstoSurfaces(testing.produce(label_maps.image()), FinestLevel=1)
        self.assertEqual([filter_.SMProxy.GetOutputPortName(port) for port in (0, 1)],
                         ["Surfaces", "Interfaces"])
        blocks = self.blocks(filter_)
        self.assertEqual(list(blocks), ["Label 3", "Label 7", "Label 12"])
        interfaces = testing.fetch(filter_, 1)
        sides = vtk_to_numpy(interfaces.GetCellData().GetArray("BoundaryLabels"))
        self.assertEqual({tuple(sorted(pair)) for pair in sides.tolist()},
                         {(0, 0), (0, 3), (0, 7), (0, 12), (3, 7)})
        for label, block in zip(BALLS, blocks.values()):
            numbers = vtk_to_numpy(block.GetPointData().GetArray("GlobalIds"))
            numpy.testing.assert_allclose(testing.points(block),
                                          testing.points(interfaces)[numbers], atol=1e-6)
            self.assertEqual(block.GetNumberOfPolys(), (sides == label).any(1).sum())
        # Arrays that ParaView's filters offer.
        threshold = simple.Threshold(filter_)
        arrays = threshold.SMProxy.GetProperty("SelectInputScalars").FindDomain(
            "vtkSMArrayListDomain")
        offered = [arrays.GetString(i) for i in range(arrays.GetNumberOfStrings())]
        if "Normals" in offered: # ParaView 6 offers vectors, too.
            offered.remove("Normals")
        else:
            self.assertEqual(list(threshold.Scalars), ["CELLS", "Label"])
        self.assertEqual(offered, ["Label"])
        # One label: the mesh is that of all labels, and labels not selected are outside.
        filter_.Labels = [7]
        one = self.blocks(filter_)["Label 7"]
        numpy.testing.assert_array_equal(testing.points(one), testing.points(blocks["Label 7"]))
        sides = vtk_to_numpy(testing.fetch(filter_, 1).GetCellData().GetArray("BoundaryLabels"))
        self.assertEqual({tuple(sorted(pair)) for pair in sides.tolist()}, {(0, 0), (0, 7)})

    def test_state_of_earlier_version(self):
        """It has removed properties, and properties without effect."""
        reader = simple.XMLImageDataReader(FileName=testing.write_volume(
            "labels-earlier.vti", label_maps.image()))
        simple.LabelstoSurfaces(reader, registrationName="Earlier", FinestLevel=1)
        path = testing.output_path("labels-earlier.pvsm")
        simple.SaveState(path)
        with open(path, encoding="utf-8") as file:
            state = file.read()
        here = state.index('<Property name="SharedInterfaces"')
        removed = "".join(f"""<Property name="{name}" id="1.{name}" number_of_elements="1">
            <Element index="0" value="1"/></Property>""" for name in ("Gap", "ThinParts", "GoOn"))
        with open(path, "w", encoding="utf-8") as file:
            file.write(state[:here] + removed + state[here:])
        self.tearDown()
        simple.LoadState(path)
        filter_ = simple.FindSource("Earlier")
        self.assertEqual((len(self.blocks(filter_)), filter_.FinestLevel), (3, 1))

    def test_error_between_good_runs(self):
        filter_ = simple.LabelstoSurfaces(testing.produce(label_maps.image()), FinestLevel=1)
        self.assertEqual(len(self.blocks(filter_)), 3)
        for name, bad, good, words in (
                ("Labels", [3, 9], [], ("9", "3", "7", "12")),
                ("Smoothing", -0.5, 2.0, ("-0.5",)),
                ("Smoothing", math.nan, 2.0, ("nan",)),
                ("VoxelTolerance", 1.5, -1.0, ("1.5", "to 1 voxels", "-1")),
                ("EdgeLength", -1.0, 0.0, ("-1",)),
                ("Tolerance", -1.0, 0.0, ("Tolerance", "-1")),
                ("Gradation", 0.6, 0.2, ("Gradation", "0.6", "at most 0.3")),
                ("FinestLevel", -2, 1, ("-2",))):
            with self.subTest(property=name, value=bad):
                setattr(filter_, name, bad)
                self.check_error(filter_, *words)
                setattr(filter_, name, good)
                self.assertEqual(len(self.blocks(filter_)), 3)
