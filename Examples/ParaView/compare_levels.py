# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The surface at each level side by side in ParaView, all views turned together.

As a macro: Macros > Import new macro..., choose this file; then select a Volume to Surface or a
Deformable Surface that has been applied, and press the macro's button.

As a script, which writes the picture (the plugin must be known to ParaView, or named):
    pvbatch compare_levels.py VOLUME PICTURE.png [ISO_VALUE] [--plugin=.../Volumic.so]
"""

import os
import sys

from paraview import simple

FILTERS = ("VolumeToSurface", "DeformableSurface")
LEVELS = 1  # output port
MOST = 4  # views beside each other; the coarsest levels of more are left out


def chosen_filter():
    """The active source, or what it is an output of; else the last of the filters."""
    active = simple.GetActiveSource()
    candidates = [active] if active else []
    candidates += reversed(list(simple.GetSources().values()))
    for source in candidates:
        if source.GetXMLName() in FILTERS:
            return source
    raise RuntimeError("There is no Volume to Surface and no Deformable Surface to compare.")


def visited_levels(filter_):
    """(name, selector) of the blocks that have a surface, the coarsest level first."""
    filter_.UpdatePipeline()
    tree = filter_[LEVELS].GetDataInformation().DataInformation.GetHierarchy()
    visited = []
    for node in (tree.GetChild(0, i) for i in range(tree.GetNumberOfChildren(0))):
        name = tree.GetAttributeOrDefault(node, "label", "")
        # Not the node's path, which is the same for levels 1 and -1.
        selector = f"/Root/*[@label='{name}']"
        surface = filter_.SMProxy.GetSubsetDataInformation(LEVELS, selector, "Hierarchy")
        if surface.GetNumberOfPoints() > 0:
            visited.append((name, selector))
    # "Level 2": level -1, finer than the volume, comes last among the blocks.
    visited.sort(key=lambda level: -int(level[0].split()[1]))
    return visited[-MOST:]


def side_by_side(layout, count):
    """Cells of the layout from left to right, equally wide."""
    cells, cell = [], 0
    for rest in range(count, 1, -1):
        left = layout.SplitHorizontal(cell, 1.0 / rest)
        cells.append(left)
        cell = left + 1
    return cells + [cell]


def compare_levels(filter_):
    """A new layout with a view per level; the views, from the coarsest level to the finest."""
    levels = visited_levels(filter_)
    names = [key[0] for key, source in simple.GetSources().items() if source == filter_]
    layout = simple.CreateLayout(f"Levels of {names[0] if names else 'a surface'}")
    views = []
    for (name, selector), cell in zip(levels, side_by_side(layout, len(levels))):
        view = simple.CreateView("RenderView")
        simple.AssignViewToLayout(view=view, layout=layout, hint=cell)
        view.OrientationAxesVisibility = 0
        display = simple.Show(simple.OutputPort(filter_, LEVELS), view)
        display.BlockSelectors = [selector]
        caption = simple.Text(registrationName=f"Caption of {name}", Text=name)
        simple.Show(caption, view)
        views.append(view)
    # What is seen is known once it has been drawn.
    simple.RenderAllViews()
    for number, view in enumerate(views[:-1]):
        simple.AddCameraLink(views[-1], view, f"levels {filter_.GetGlobalIDAsString()} {number}")
    simple.SetActiveView(views[-1])
    simple.SetActiveSource(filter_)
    simple.ResetCamera(views[-1])
    simple.RenderAllViews()
    return layout, views


def main(arguments):
    plugins = [a.partition("=")[2] for a in arguments if a.startswith("--plugin=")]
    plain = [a for a in arguments if not a.startswith("--")]
    if len(plain) not in (2, 3):
        sys.exit(__doc__)
    volume, picture, *iso = plain
    for plugin in plugins:
        simple.LoadPlugin(plugin, remote=False, ns=vars(simple))
    reader = simple.OpenDataFile(volume)
    reader.UpdatePipeline()
    filter_ = simple.VolumetoSurface(reader)
    if iso:
        filter_.IsoValue = float(iso[0])
    layout, views = compare_levels(filter_)
    layout.SetSize(420 * len(views), 420)
    for view in views:
        view.GetActiveCamera().Elevation(20)
        view.GetActiveCamera().Azimuth(30)
    simple.ResetCamera(views[-1])
    simple.SaveScreenshot(picture, layout)
    print(f"Written: {picture}")


# A macro runs within ParaView, whose arguments are not ours.
if sys.argv and os.path.basename(sys.argv[0]) == "compare_levels.py":
    main(sys.argv[1:])
else:
    compare_levels(chosen_filter())
