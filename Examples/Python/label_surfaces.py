# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""From a label map to a surface of each label, as segment.py --labels does it."""

import fnmatch
import os
import re

from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkDataSetAttributes

from output_files import check_output
from pipeline import set_property, volumic
from read_volume import files_of_volume, read_labels
from surface_results import SURFACE_WRITERS, write_blocks, write_surface
from terminal import FilterError, Interrupted, run_filter

UNSAFE = r"""[\x00-\x20\x7f/\\:*?"<>|'`$&;!%]"""  # in names of files, on the systems of others, too


def label_filter(kind, image):
    """A filter of labels, vtkLabelsToSurfaces or vtkLabelTable, on the scalars of the image."""
    algorithm = getattr(volumic(), kind)()
    algorithm.SetInputData(image)
    if image.GetPointData().GetScalars() is None:
        algorithm.SetInputArrayToProcess(0, 0, 0, vtkDataObject.FIELD_ASSOCIATION_CELLS,
                                         vtkDataSetAttributes.SCALARS)
    return algorithm


def labels_of(image):
    """{label: name} of all labels in the image; a label without a name is `Label 3`."""
    table = label_filter("vtkLabelTable", image)
    run_filter(table)
    columns = table.GetOutput()
    names = columns.GetColumnByName("Name")
    return {int(label): names.GetValue(i)
            for i, label in enumerate(vtk_to_numpy(columns.GetColumnByName("Label")))}


def choose_labels(text, names, background=0):
    """The labels that a text asks for: `all`, or numbers, ranges as 7-9 and names, in which *
    stands for any text, with commas between. ValueError if there is none of what it asks for.

    names: as labels_of gives them.
    """
    chosen = set()
    for part in [text] if text in names.values() else text.split(","):
        found = labels_of_part(part.strip(), names, background)
        if not found:
            known = ", ".join(f"{label} {name}" for label, name in list(names.items())[:20])
            raise ValueError(f"there is no label '{part.strip()}'; there are {known}"
                             f"{', ...' if len(names) > 20 else ''}")
        chosen |= found
    return sorted(chosen)


def labels_of_part(text, names, background):
    if re.fullmatch(r"[-+]?\d+", text):
        return {int(text)} & set(names)
    named = ({label for label, name in names.items() if name == text}
             or {label for label, name in names.items() if name.lower() == text.lower()})
    if named:
        return named
    objects = set(names) - {background}
    if text.lower() == "all":
        return objects
    ends = re.fullmatch(r"(-?\d+)-(-?\d+)", text)
    if ends:
        return {label for label in objects if int(ends[1]) <= label <= int(ends[2])}
    pattern = text.lower().replace("[", "[[]").replace("?", "[?]")
    return {label for label in objects if "*" in text and names[label] != f"Label {label}"
            and fnmatch.fnmatchcase(names[label].lower(), pattern)}


def file_names(names):
    """{label: name of a file without its suffix}, no two the same, whatever the case of letters."""
    safe = {label: re.sub(UNSAFE, "_", name).lstrip("._-~").rstrip("._")[:120]
            if name != f"Label {label}" else "" for label, name in names.items()}
    safe = {label: name or f"label-{label}" for label, name in safe.items()}
    lower = [name.lower() for name in safe.values()]
    return {label: name if lower.count(name.lower()) == 1 else f"{name}-{label}"
            for label, name in safe.items()}


def is_folder(path):
    return path.endswith(os.sep) or os.path.isdir(path) or not os.path.splitext(path)[1]


def check_label_output(path, suffix, is_merged):
    """ValueError for an output that no surface of labels can be written to."""
    if is_folder(path):
        if is_merged:
            raise ValueError(f"{path}: --merge makes one surface: give it a file, not a folder")
        if "." + suffix not in SURFACE_WRITERS:
            raise ValueError(f"--format {suffix}: it must be one of"
                             f" {', '.join(known[1:] for known in SURFACE_WRITERS)}")
    elif not path.lower().endswith((*SURFACE_WRITERS, ".vtm")):
        raise ValueError(f"{path}: a folder is wanted, a file that ends in .vtm, or of one surface,"
                         f" in {', '.join(SURFACE_WRITERS)}")


def plan_files(output, suffix, labels, names, is_merged):
    """The file of each surface, or the one of all blocks."""
    if is_folder(output):
        stems = file_names(names)
        return [os.path.join(output, f"{stems[label]}.{suffix}") for label in labels]
    if len(labels) > 1 and not is_merged and not output.lower().endswith(".vtm"):
        raise ValueError(f"{output}: {len(labels)} labels have as many surfaces: give a folder, a"
                         " .vtm, or --merge")
    return [output]


def make_surfaces(image, labels, properties):
    """vtkLabelsToSurfaces after its run, and whether Ctrl-C stopped it."""
    surfaces = label_filter("vtkLabelsToSurfaces", image)
    for label in labels:
        surfaces.AddLabel(label)
    for name, value in properties.items():
        set_property(surfaces, name, value)
    try:
        run_filter(surfaces, "Making surfaces")
    except Interrupted:
        return surfaces, True
    return surfaces, False


def write_all(blocks, files):
    """Each surface that has triangles to its file, or all of them to one .vtm; returns how many."""
    surfaces = [blocks.GetBlock(i) for i in range(blocks.GetNumberOfBlocks())]
    there = [surface for surface in surfaces if surface.GetNumberOfPolys() > 0]
    if not there:
        raise FilterError("none of the labels has a surface (--set FinestLevel=-1)")
    if files[0].lower().endswith(".vtm"):
        write_blocks(blocks, files[0])
        return len(there)
    for surface, file in zip(surfaces, files):
        if surface.GetNumberOfPolys() > 0:
            write_surface(surface, file)
    return len(there)


def wrong_voxels(blocks):
    """Voxel centres that are on the wrong side of a surface."""
    surfaces = [blocks.GetBlock(i) for i in range(blocks.GetNumberOfBlocks())]
    return sum(int(surface.GetFieldData().GetArray("WrongVoxels").GetValue(0))
               for surface in surfaces)


def segment_labels(volume, output, text, properties, names_file=None, suffix="vtp"):
    """Read, segment, write; returns whether all was finished. Prints what it does.

    properties: those of vtkLabelsToSurfaces, by their names; text: as choose_labels has it.
    """
    is_merged = properties.get("Merge") == "on"
    check_label_output(output, suffix, is_merged)
    print(f"Reading {volume}")
    image = read_labels(volume, names_file)
    names = labels_of(image)
    background = int(properties.get("BackgroundLabel", 0))
    labels = choose_labels(text, names, background)
    print(f"  {' x '.join(map(str, image.GetDimensions()))} points,"
          f" {len(set(names) - {background})} labels, {len(labels)} chosen")
    files = plan_files(output, suffix, labels, names, is_merged)
    if is_folder(output):
        os.makedirs(output, exist_ok=True)
    inputs = [*files_of_volume(volume), *([names_file] if names_file else [])]
    for file in files:
        check_output(file, inputs)
    surfaces, is_interrupted = make_surfaces(image, labels, properties)
    count = write_all(surfaces.GetOutput(), files)
    print(f"  voxel centres on the wrong side: {wrong_voxels(surfaces.GetOutput())}")
    print(f"Written: {output}, {count} {'surface' if count == 1 else 'surfaces'}"
          f"{' (not finished)' if is_interrupted else ''}")
    return not is_interrupted
