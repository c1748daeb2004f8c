#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Draw the pictures of data in README.md and Documentation/ with one command:

    xvfb-run -a /usr/bin/python3 Testing/Benchmarks/figures.py --vessels aneurism.vti 100.5

    levels     the surface of each level                                     Cranium.inv3
    views      the surface from outside, and cut open                        Cranium.inv3
    graded     uniform triangles, and fewer within a tolerance               Cranium.inv3
    thin       uniform triangles, and smaller ones at thin parts             Cranium.inv3
    history    the curves of the paper's figure 5, with and without pyramid, Cranium.inv3
               with the paper's settings and with the defaults
    evolution  the paper's figures 3 and 4, and the same with the defaults   Cranium.inv3
    vessels    the paper's figure 6, with recovery and without               --vessels
    labels     surfaces of a label map                                       --label-map
    interfaces one mesh of labels that touch                                 generated grains
    tetrahedra a tetrahedral mesh of labels, cut open                        --tetrahedra

The paper's settings are four levels and no recovery.

Cranium.inv3 is the CT of a skull of Debian's package invesalius-examples. --vessels names a scan of
bright vessels and its iso-value. --label-map names the atlas JHU-WhiteMatter-labels-1mm.nii.gz of
Debian's package mricron-data, --tetrahedra a .vtu of labels that the command has written. A picture
whose option is missing is not drawn. Each picture has less than 300 kB.
"""

import argparse
import functools
import os
import sys

import numpy as np
import volumic
from volumic.errors import Failure
from volumic.messages import update
from vtkmodules.util.numpy_support import vtk_to_numpy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "Examples",
                                "Python"))
# pylint: disable=wrong-import-position
import history_chart
import pictures
import render
from label_pictures import interface_picture, label_picture, tetrahedra_picture
from pictures import blocks_of, close_view, main_component, number, surface_row, visited_levels

SKULL = os.environ.get(
    "VOLUMIC_CRANIUM", "/usr/share/doc/invesalius-examples/examples/Cranium.inv3")
SKULL_ISO = 226.5
PAPERS_COARSEST = 3  # the paper starts at G3, the fourth of its levels
EDGE_OF_THE_REST = .3, .5, .5  # of the head rest, a thin sheet behind the skull; relative to the bounds
STARTS_ONLY = 10 ** 6  # iterations between snapshots: only the start of each level
ROW_WIDTH = 1240  # pixels of a picture, about the width of a repository's page
GAP = 10  # pixels between panels, as in render.compose
LARGEST = 300000  # bytes of a picture, limit
GREY_STEP = 5  # colours are rounded to multiples: halves the file size
SNAPSHOTS = (0, 50, 100, 250)  # iterations that are shown, before the converged surface
AS_PAPER = "As in the paper: {} levels, no recovery"


class Scan(pictures.Scan):
    """A volume, its pyramid and the runs on it, each made at first use."""

    def __init__(self, path, iso):
        super().__init__(volumic.read(path), iso)
        self.pyramid = volumic.vtkImagePyramid()
        self.pyramid.SetInputData(self.image)

    @functools.cache
    def run(self, **properties):
        """Return the filter after a run with these properties; others have their defaults.

        Its snapshots contain at least the start of every level.
        """
        print(f"  {', '.join(f'{n} {v}' for n, v in properties.items()) or 'default properties'}")
        surface = volumic.vtkDeformableSurface()
        surface.SetInputConnection(self.pyramid.GetOutputPort())
        surface.SetIsoValue(self.iso)
        for name, value in {"SnapshotInterval": STARTS_ONLY, **properties}.items():
            getattr(surface, "Set" + name)(value)
        errors, _ = update(surface)
        if errors or surface.GetOutput().GetNumberOfPolys() == 0:
            raise Failure(errors[0] if errors else f"no surface at the iso-value {self.iso:g}")
        return surface

    def coarsest(self):
        """Return the coarsest level where a voxel is above the iso-value."""
        self.pyramid.Update()
        return max(h for h, image in enumerate(pictures.blocks_of(self.pyramid.GetOutput()))
                   if image.GetScalarRange()[1] > self.iso)

    @functools.cache
    def run_as_paper(self):
        """Run without recovery from level 3, or from the first finer level that shows the object.
        Return the filter and that level."""
        for level in range(min(PAPERS_COARSEST, self.coarsest()), 0, -1):
            try:
                return self.run(Recovery=0, Metric=0, CoarsestLevel=level), level
            except Failure as error:
                print(f"  from level {level}: {error}")
        return self.run(Recovery=0, Metric=0, CoarsestLevel=0), 0


def iterations(surface):
    """Return (level, number of iterations) of a run, in the order of the levels."""
    levels = vtk_to_numpy(surface.GetHistory().GetColumnByName("Level"))
    return [(int(level), int((levels == level).sum())) for level in dict.fromkeys(levels.tolist())]


def starts(surface):
    """Return {level: surface before the first iteration}."""
    return {field(block, "Level"): block for block in pictures.blocks_of(surface.GetSnapshots())
            if field(block, "Iterations") == 0}


def field(surface, name):
    return int(pictures.number(surface, name))


def panel_width(columns):
    return (ROW_WIDTH - GAP) // columns - GAP


def levels(skull):
    surfaces = [(f"Level {level}", surface)
                for level, surface in visited_levels(skull.run().GetLevels())]
    row, captions = surface_row(surfaces, skull.frame, surfaces[-1][1].GetBounds(),
                                panel_width(len(surfaces)))
    return render.compose([row], [captions])


def views(skull):
    surface, _ = main_component(skull.run().GetOutput())
    frame, width = skull.frame, panel_width(4)
    views_outside, bounds = pictures.OUTSIDE[1:], surface.GetBounds()
    size = width, render.fitting_height(width, frame, views_outside, bounds)
    row = [render.draw([render.surface_actor(surface)], size, frame, *view, bounds)
           for view in views_outside]
    row += [render.draw([pictures.cut_open(surface, -frame.vector(view[0]))], size, frame, *view,
                        bounds) for view in pictures.INSIDE]
    names = (*pictures.NAMES[0][1:], *pictures.NAMES[1][:2])
    return render.compose([row], [[(name,) for name in names]])


def graded(skull):
    return beside_uniform(skull, "Within a tolerance of 0.5 mm", {"Tolerance": 0.5})


def thin(skull):
    return beside_uniform(skull, "Thin parts", {"ThinParts": True}, lambda surface: (surface, None),
                          towards="P", at=EDGE_OF_THE_REST)


def beside_uniform(scan, name, properties, shown_of=main_component, **view):
    """Draw the triangles of a run beside those of uniform edge length."""
    width, uniform = panel_width(2), scan.run().GetOutput()
    surfaces = {"Uniform edge length": uniform, name: scan.run(**properties).GetOutput()}
    row = [close_view(shown_of(surface)[0], scan.frame, (width, width * 3 // 10),
                      delta=number(uniform, "Delta"), **view) for surface in surfaces.values()]
    return render.compose([row], [[(f"{name}: {surface.GetNumberOfPoints()} vertices",)
                                   for name, surface in surfaces.items()]])


def without_pyramid(skull):
    """Run on the image alone, with snapshots."""
    return skull.run(CoarsestLevel=0, SnapshotInterval=50)


def history(skull):
    as_paper, start = skull.run_as_paper()
    return comparison_chart(((AS_PAPER.format(start + 1), columns(as_paper)),
                             ("With the default properties", columns(skull.run()))),
                            ("without the pyramid", columns(without_pyramid(skull))))


def comparison_chart(evolutions, other, size=(1240, 1240)):
    """Draw the curves of several evolutions (name, history), a column for each, at the same scale.
    The curves of `other` (name, history) are dashed in all columns."""
    coarsest = max(history["Level"].max() for _, history in evolutions)
    width = size[0] // len(evolutions)
    heads = [np.concatenate([
        render.blank(10, width),
        render.line_strip([(width // 2, name, True, render.INK)], width, 19, centred=True),
        history_chart.legend(history, width, 15, coarsest)]) for name, history in evolutions]
    dashed = f"Iterations on each level. Dashed: {other[0]}, {len(other[1]['Level'])} iterations"
    cells = [(column, row, curve, history) for column, (_, history) in enumerate(evolutions)
             for row, curve in enumerate(history_chart.CURVES)]
    return np.concatenate([np.concatenate(heads, axis=1),
                           render.line_strip([(size[0] // 2, dashed, False, render.SOFT_INK)],
                                             size[0], 15, centred=True),
                           history_chart.draw_charts(cells, other[1], size)])


def columns(surface):
    """Return the columns of a history that are drawn."""
    return {name: vtk_to_numpy(surface.GetHistory().GetColumnByName(name)).astype(float)
            for name in ("Level", *(curve[0] for curve in history_chart.CURVES))}


def evolution(skull):
    direct = without_pyramid(skull)
    taken = {field(block, "Iterations"): block for block in blocks_of(direct.GetSnapshots())}
    stages = [(f"Iteration {n}", taken[n]) for n in SNAPSHOTS if n in taken]
    stages.append((f"Converged, iteration {iterations(direct)[0][1]}", direct.GetOutput()))
    as_paper, start = skull.run_as_paper()
    rows = [stages, stages_by_level(as_paper), stages_by_level(skull.run())]
    # Initial surfaces enclose the image, with a wider margin on coarser levels.
    bounds = np.array([surface.GetBounds() for row in rows for _, surface in row])
    bounds = np.where([True, False] * 3, bounds.min(axis=0), bounds.max(axis=0))
    width = panel_width(max(map(len, rows)))
    panels, captions = zip(*(surface_row(row, skull.frame, bounds, width, zoom=1)
                             for row in rows))
    return render.compose(panels, captions, None,
                          ["Without the pyramid (the paper's figure 3)",
                           AS_PAPER.format(start + 1) + " (its figure 4, and level 0)",
                           "With the default properties"])


def stages_by_level(surface):
    """Return the initial surface and the converged surface of each level, with iterations so far."""
    blocks = dict(visited_levels(surface.GetLevels()))
    counts = iterations(surface)
    stages = [(f"Level {counts[0][0]}, iteration 0", starts(surface)[counts[0][0]])]
    total = 0
    for level, count in counts:
        total += count
        if level in blocks:  # the object did not vanish
            stages.append((f"Level {level}, iteration {total}", blocks[level]))
    return stages


def vessels(scan):
    without, start = scan.run_as_paper()
    coarsest, recovered = scan.coarsest(), scan.run(Recovery=2)
    rows, captions = zip(*(all_levels_row(surface, coarsest, scan.frame,
                                          recovered.GetOutput().GetBounds())
                           for surface in (without, recovered)))
    return render.compose(rows, captions, None,
                          [f"No recovery, as in the paper, from level {start}",
                           "With recovery of objects and cavities, from the coarsest level"])


def labels(path):
    return label_picture(path, panel_width(4))


def interfaces(_):
    return interface_picture(panel_width(2))


def tetrahedra(path):
    return tetrahedra_picture(path, panel_width(2))


def all_levels_row(surface, coarsest, frame, bounds):
    """Return panels and captions of all levels from the coarsest, empty where there is no surface."""
    counts = dict(iterations(surface))
    existing = {level: (f"Level {level}, {counts[level]} iterations", block)
             for level, block in visited_levels(surface.GetLevels())}
    panels, captions = surface_row(existing.values(), frame, bounds, panel_width(coarsest + 1), zoom=1)
    for column, level in enumerate(range(coarsest, -1, -1)):
        if level not in existing:
            panels.insert(column, render.blank(*panels[0].shape[:2]))
            captions.insert(column, (f"Level {level}", f"vanished after {counts[level]} iterations"
                                     if level in counts else "not visited"))
    return panels, captions


def compact(picture):
    """Reduce the number of colours, for a smaller file; the background does not change."""
    background = render.blank(1, 1)[0, 0]
    is_background = (np.abs(picture.astype(int) - background).max(axis=2) < 3)
    rounded = np.minimum(np.round(picture / GREY_STEP) * GREY_STEP, 255).astype(np.uint8)
    rounded[is_background] = background
    return rounded


SKULL_PICTURES = (levels, views, graded, thin, history, evolution)


def write_picture(draw, scan, folder):
    """Draw and write a picture; raise OSError if the file is too large."""
    path = os.path.join(folder, draw.__name__ + ".png")
    print(f"Drawing {path}", flush=True)
    render.write_png(compact(draw(scan)), path)
    size = os.path.getsize(path)
    print(f"  {size:,} bytes")
    if size > LARGEST:
        raise OSError(f"{path} has {size:,} bytes, more than {LARGEST:,}")


def main():
    folder = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../Documentation")
    known = [draw.__name__ for draw in SKULL_PICTURES] + ["vessels", "labels", "interfaces",
                                                             "tetrahedra"]
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--output", default=os.path.normpath(folder), help="default: Documentation")
    parser.add_argument("--only", nargs="+", choices=known, default=known, metavar="PICTURE",
                        help=", ".join(known))
    parser.add_argument("--vessels", nargs=2, metavar=("VOLUME", "ISO"), help="for vessels.png")
    parser.add_argument("--label-map", metavar="FILE", help="for labels.png")
    parser.add_argument("--tetrahedra", metavar="FILE.vtu", help="for tetrahedra.png")
    parser.add_argument("--skull", nargs=2, metavar=("VOLUME", "ISO"), default=(SKULL, SKULL_ISO),
                        help="volume used instead of the skull")
    arguments = parser.parse_args()
    try:
        os.makedirs(arguments.output, exist_ok=True)
        of_skull = [draw for draw in SKULL_PICTURES if draw.__name__ in arguments.only]
        skull = of_skull and Scan(arguments.skull[0], float(arguments.skull[1]))
        for draw in of_skull:
            write_picture(draw, skull, arguments.output)
        for draw, source in ((vessels, arguments.vessels), (labels, arguments.label_map),
                             (tetrahedra, arguments.tetrahedra), (interfaces, "made grains")):
            if source and draw.__name__ in arguments.only:
                write_picture(draw, Scan(source[0], float(source[1])) if draw is vessels else source,
                              arguments.output)
    except (Failure, ValueError, OSError) as error:
        sys.exit(f"figures.py: {error}")


if __name__ == "__main__":
    main()
