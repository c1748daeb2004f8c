# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Show the surfaces of all levels side by side in ParaView, with linked cameras.

As a macro: use Macros > Import new macro... with this file, select an applied Volume to Surface or
Deformable Surface, and press the button of the macro.

As a script that writes a picture (the plugin must be loaded by ParaView or given):
    pvbatch compare_levels.py VOLUME PICTURE.png [ISO_VALUE] [--plugin=.../Volumic.so]
"""

import os
import sys

from paraview import simple

FILTERS = ("VolumeToSurface", "DeformableSurface")
LEVELS = 1  # output port
MAXIMUM_VIEWS = 4  # of the finest levels


def chosen_filter():
    """Return the active filter, or the last of the filters. Raise RuntimeError if there is none."""
    active = simple.GetActiveSource()
    candidates = [active] if active else []
    candidates += reversed(list(simple.GetSources().values()))
    for source in candidates:
        if source.GetXMLName() in FILTERS:
            return source
    raise RuntimeError("No filter found; apply Volume to Surface or Deformable Surface first.")


def visited_levels(filter_):
    """Return (name, selector) of non-empty blocks, the coarsest level first."""
    filter_.UpdatePipeline()
    tree = filter_[LEVELS].GetDataInformation().DataInformation.GetHierarchy()
    visited = []
    for node in (tree.GetChild(0, i) for i in range(tree.GetNumberOfChildren(0))):
        name = tree.GetAttributeOrDefault(node, "label", "")
        # The path of the node is the same for levels 1 and -1.
        selector = f"/Root/*[@label='{name}']"
        surface = filter_.SMProxy.GetSubsetDataInformation(LEVELS, selector, "Hierarchy")
        if surface.GetNumberOfPoints() > 0:
            visited.append((name, selector))
    # Names are such as "Level 2"; level -1 is the last block.
    visited.sort(key=lambda level: -int(level[0].split()[1]))
    return visited[-MAXIMUM_VIEWS:]


def side_by_side(layout, count):
    """Return cells of the layout of equal width, from left to right."""
    cells, cell = [], 0
    for remaining in range(count, 1, -1):
        left = layout.SplitHorizontal(cell, 1.0 / remaining)
        cells.append(left)
        cell = left + 1
    return cells + [cell]


def compare_levels(filter_):
    """Create a layout with one view per level. Return the layout and the views, the coarsest
    first."""
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
    # Bounds are known after rendering.
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


# In a macro, sys.argv is that of ParaView.
if sys.argv and os.path.basename(sys.argv[0]) == "compare_levels.py":
    main(sys.argv[1:])
else:
    compare_levels(chosen_filter())
