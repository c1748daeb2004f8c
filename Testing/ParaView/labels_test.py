# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The Labels to Surfaces filter of the installed plugin, in scripts of pvbatch and pvpython."""

import numpy
from paraview import simple
from vtkmodules.vtkCommonDataModel import vtkMultiBlockDataSet

import label_maps
import plugin_testing as testing


class LabelsTest(testing.PluginTestCase):
    def blocks(self, filter_):
        """Return {name: surface}; no message is expected."""
        with testing.CapturedMessages() as messages:
            output = testing.fetch(filter_)
        self.assertEqual(messages.text, "")
        return dict(zip(testing.names(output), testing.levels(output)))

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
        self.assertEqual(list(self.blocks(filter_)), ["Label 7"])

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
        reasons = [testing.field(surface, "StopReason") for surface in self.blocks(filter_).values()]
        self.assertEqual(reasons, ["converged"] * 3)

    def test_output_ports(self):
        filter_ = simple.LabelstoSurfaces(testing.produce(label_maps.image()), FinestLevel=1)
        self.assertEqual([filter_.SMProxy.GetOutputPortName(port) for port in (0, 1)],
                         ["Surfaces", "Interfaces"])
        self.assertEqual(list(self.blocks(filter_)), ["Label 3", "Label 7", "Label 12"])
        self.assertTrue(testing.fetch(filter_, 1).GetCellData().HasArray("BoundaryLabels"))
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
