# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Documentation/reference.md has exactly the properties and arrays of the filters."""

import os
import re
import sys
import unittest

import numpy as np
import volumic
from vtkmodules.vtkCommonDataModel import vtkCompositeDataSet

from sample_volumes import RING_ISO, RING_SPACING, ROOT, make_image, ring_voxels

sys.path.insert(0, os.path.join(ROOT, "Documentation"))
import reference_tables  # pylint: disable=wrong-import-position


def read_page():
    with open(reference_tables.PAGE, encoding="utf-8") as file:
        return file.read()


def tables():
    """Return the rows of the first table below each heading: {name: second column}."""
    sections = re.split(r"^#+ (.*)$", read_page(), flags=re.MULTILINE)
    found = {}
    for heading, text in zip(sections[1::2], sections[2::2]):
        rows = re.findall(r"^\| *([^|]+?) *\| *([^|]*?) *\|", text, flags=re.MULTILINE)
        found[heading] = {name: value for names, value in rows[2:]  # below the titles and the line
                          for name in re.findall(r"`([^`]+)`", names) or [names]}
    return found


def arrays_of(attributes):
    """Return {name: type as in the reference}."""
    arrays = [attributes.GetAbstractArray(i) for i in range(attributes.GetNumberOfArrays())]
    return {a.GetName(): a.GetDataTypeAsString() + (f", {a.GetNumberOfComponents()}"
                                                    if a.GetNumberOfComponents() > 1 else "")
            for a in arrays}


def blocks_of(data):
    blocks = [data.GetBlock(b) for b in range(data.GetNumberOfBlocks())]
    return [block for block in blocks if block is not None]


class ReferenceTest(unittest.TestCase):
    maxDiff = None

    @classmethod
    def setUpClass(cls):
        if cls is not ReferenceTest:  # one run for all classes
            if not hasattr(ReferenceTest, "tables"):
                ReferenceTest.setUpClass()
            return
        cls.tables = tables()
        cls.image = make_image(ring_voxels(), RING_SPACING)
        cls.pyramid = volumic.vtkImagePyramid()
        cls.pyramid.SetInputData(cls.image)
        cls.pyramid.Update()
        cls.surface = volumic.vtkDeformableSurface()
        cls.surface.SetInputConnection(cls.pyramid.GetOutputPort())
        cls.surface.SetIsoValue(RING_ISO)
        cls.surface.SetSnapshotInterval(20)
        cls.surface.Update()

    def compare(self, heading, arrays):
        self.assertEqual(self.tables[heading], arrays)


class PropertiesTest(ReferenceTest):
    def test_tables_are_up_to_date(self):
        """If this fails, run Documentation/reference_tables.py."""
        self.assertEqual(read_page(), reference_tables.updated(read_page()))

    def test_print_self_has_all_properties(self):
        for kind in (volumic.vtkImagePyramid, volumic.vtkDeformableSurface,
                     volumic.vtkVolumeToSurface, volumic.vtkLabelsToSurfaces):
            algorithm = kind()
            printed = dict(re.findall(r"^ +(\w+): ?(.*)$", str(algorithm), re.MULTILINE))
            names = reference_tables.property_names(algorithm)
            self.assertEqual(set(names) - set(printed), set(), kind.__name__)
            for name in names:
                value = getattr(algorithm, "Get" + name)()
                if isinstance(value, str):
                    self.assertEqual(printed[name], value, name)
                else:
                    np.testing.assert_allclose(float(printed[name]), value, 1e-5, 0, name)

    def test_all_classes_are_documented(self):
        classes = [name for name in dir(volumic) if re.fullmatch(r"vtk[A-Z]\w+", name)
                   and hasattr(getattr(volumic, name), "GetOutputPort")]
        self.assertGreater(len(classes), 3)
        for name in classes:
            self.assertIn(name, self.tables)
            if reference_tables.property_names(getattr(volumic, name)()):
                self.assertIn(f"<!-- properties of {name} -->", read_page())


class PyramidTest(ReferenceTest):
    def test_arrays(self):
        finest, *coarser = blocks_of(self.pyramid.GetOutput())
        self.assertEqual(list(arrays_of(finest.GetPointData())), ["Voxels"])
        for block in coarser:
            self.assertEqual(arrays_of(block.GetPointData()),
                             {"Voxels": self.tables["Point arrays of a level"]["the input's"]})

    def test_field_data(self):
        pyramid = self.pyramid.GetOutput()
        self.compare("Field data of the pyramid", arrays_of(pyramid.GetFieldData()))
        for block in blocks_of(pyramid):
            self.compare("Field data of a level", arrays_of(block.GetFieldData()))


class SurfaceTest(ReferenceTest):
    def surfaces(self):
        return [self.surface.GetOutput(), *blocks_of(self.surface.GetLevels())]

    def test_ports(self):
        rows = re.findall(r"^\| (\d) \| `\w+` \| `(\w+)` \|", read_page(), flags=re.MULTILINE)
        kinds = [(str(port), self.surface.GetOutputDataObject(port).GetClassName())
                 for port in range(self.surface.GetNumberOfOutputPorts())]
        self.assertEqual(rows, kinds)

    def test_point_and_cell_arrays(self):
        for surface in self.surfaces() + blocks_of(self.surface.GetSnapshots()):
            self.compare("Point arrays of a surface", arrays_of(surface.GetPointData()))
            self.compare("Cell arrays of a surface", arrays_of(surface.GetCellData()))

    def test_field_data(self):
        for surface in self.surfaces():
            self.compare("Field data of a surface", arrays_of(surface.GetFieldData()))

    def test_arrays_of_a_graded_surface(self):
        surface = volumic.vtkVolumeToSurface()
        surface.SetInputData(make_image(ring_voxels(), RING_SPACING))
        surface.SetIsoValue(RING_ISO)
        surface.SetTolerance(0.3)
        surface.ThinPartsOn()
        surface.Update()
        for kind, arrays in (("Point arrays", surface.GetOutput().GetPointData()),
                             ("Field data", surface.GetOutput().GetFieldData())):
            self.assertEqual({**self.tables[f"{kind} of a surface"],
                              **self.tables[f"{kind} of a graded surface"]}, arrays_of(arrays))

    def test_field_data_of_snapshots(self):
        snapshots = blocks_of(self.surface.GetSnapshots())
        self.assertGreater(len(snapshots), 3)
        expected = dict(self.tables["Field data of a surface"])
        del expected["StopReason"]
        expected.update(self.tables["Field data of a snapshot instead"])
        for snapshot in snapshots:
            self.assertEqual(arrays_of(snapshot.GetFieldData()), expected)

    def test_history(self):
        self.compare("Columns of the history",
                     arrays_of(self.surface.GetHistory().GetRowData()))


class ThresholdTest(ReferenceTest):
    def test_column(self):
        threshold = volumic.vtkOtsuThreshold()
        threshold.SetInputData(self.image)
        threshold.Update()
        self.compare("Columns of the threshold", arrays_of(threshold.GetOutput().GetRowData()))
        self.assertEqual(threshold.GetOutput().GetValueByName(0, "Threshold").ToDouble(),
                         threshold.GetThreshold())


class LabelsTest(ReferenceTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.labels = make_image((ring_voxels() > RING_ISO).astype("uint8"), RING_SPACING)

    def test_arrays(self):
        surfaces = volumic.vtkLabelsToSurfaces()
        surfaces.SetInputData(self.labels)
        surfaces.Update()
        block, = blocks_of(surfaces.GetOutput())
        self.assertEqual(surfaces.GetOutput().GetMetaData(0).Get(vtkCompositeDataSet.NAME()),
                         "Label 1")
        self.assertEqual({**self.tables["Point arrays of a surface"], "GlobalIds": "idtype"},
                         arrays_of(block.GetPointData()))
        self.assertEqual({**self.tables["Cell arrays of a surface"],
                          **self.tables["Cell arrays of a label"]},
                         arrays_of(block.GetCellData()))
        self.assertEqual({**self.tables["Field data of a surface"],
                          **self.tables["Field data of a label"]},
                         arrays_of(block.GetFieldData()))

    def test_arrays_of_interfaces(self):
        voxels = (ring_voxels() > RING_ISO).astype("uint8")
        voxels[:, :, :20] *= 2
        surfaces = volumic.vtkLabelsToSurfaces()
        surfaces.SetInputData(make_image(voxels, RING_SPACING))
        surfaces.Update()
        interfaces = surfaces.GetInterfaces()
        self.assertIs(interfaces, surfaces.GetOutputDataObject(1))
        self.compare("Arrays of the interfaces", {**arrays_of(interfaces.GetPointData()),
                                                  **arrays_of(interfaces.GetCellData())})
        self.compare("Field data of the interfaces", arrays_of(interfaces.GetFieldData()))

    def test_table(self):
        table = volumic.vtkLabelTable()
        table.SetInputData(self.labels)
        table.Update()
        self.compare("Columns of the label table", arrays_of(table.GetOutput().GetRowData()))
