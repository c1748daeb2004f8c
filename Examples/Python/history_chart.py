# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The picture of an evolution: the four curves of the paper's figure 5, a colour for each level,
and those of a second evolution, such as one without the pyramid, dashed beside them; or of two
evolutions side by side at the same scale.

Lachaud and Montanvert, "Volumic Segmentation using Hierarchical Representation and Triangulated
Surface", ECCV 1996.
"""

import numpy as np
import vtkmodules.vtkRenderingContextOpenGL2  # noqa: F401, the factory of 2D drawing
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkChartsCore import vtkAxis, vtkChart, vtkChartMatrix, vtkChartXY
from vtkmodules.vtkCommonCore import vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkTable, vtkVector2f, vtkVector2i
from vtkmodules.vtkRenderingContext2D import vtkPen
from vtkmodules.vtkRenderingCore import vtkRenderWindow, vtkWindowToImageFilter
from vtkmodules.vtkViewsContext2D import vtkContextView

import render

# Column of the history, title, factor, whether the axis is logarithmic.
CURVES = (
    ("Seconds", "Duration of an iteration (ms)", 1000, False),
    ("KineticEnergy", "Mean kinetic energy along the normals", 1, True),
    ("MeanEdgeLength", "Mean length of the edges (world units)", 1, False),
    ("Vertices", "Number of vertices", 1, False),
)
# From the coarsest level to the finest.
COLORS = ((102, 194, 245), (250, 176, 77), (122, 214, 134), (238, 120, 130), (190, 150, 240),
          (232, 222, 100), (150, 210, 205), (240, 150, 210))
OTHER_COLOR = (150, 156, 165)


def history_chart(history, other=None, size=(1480, 900), scale=render.OVERSAMPLING):
    """Picture, an array of pixels as in render.py, of a vtkTable with a row per iteration.

    other: the name and the table of the second evolution.
    """
    columns = columns_of(history)
    beside = columns_of(other[1]) if other else None
    cells = [(number % 2, number // 2, curve, columns) for number, curve in enumerate(CURVES)]
    names = legend(columns, other, size[0], 18, columns["Level"].max())
    return np.concatenate([render.blank(14, size[0]), names,
                           draw_charts(cells, beside, size, scale)])


def comparison_chart(evolutions, other, size=(1240, 1240), scale=render.OVERSAMPLING):
    """Picture of the curves of two evolutions, a column for each, at the same scale.

    evolutions: name and table of each; other: those of a third one, dashed in both columns.
    """
    tables = [columns_of(history) for _, history in evolutions]
    coarsest = max(columns["Level"].max() for columns in tables)
    width = size[0] // len(tables)
    heads = [np.concatenate([
        render.blank(10, width),
        render.line_strip([(width // 2, name, True, render.INK)], width, 19, centred=True),
        legend(columns, None, width, 15, coarsest, "")])
        for (name, _), columns in zip(evolutions, tables)]
    dashed = (f"Iterations on each level. Dashed: {other[0]},"
              f" {other[1].GetNumberOfRows()} iterations")
    cells = [(column, row, curve, columns)
             for column, columns in enumerate(tables) for row, curve in enumerate(CURVES)]
    return np.concatenate([np.concatenate(heads, axis=1),
                           render.line_strip([(size[0] // 2, dashed, False, render.SOFT_INK)],
                                             size[0], 15, centred=True),
                           draw_charts(cells, columns_of(other[1]), size, scale)])


def draw_charts(cells, beside, size, scale):
    """Picture of chart_matrix()."""
    view = vtkContextView()
    view.GetRenderer().SetBackground(render.BACKGROUND)
    view.GetScene().AddItem(chart_matrix(cells, beside, scale))
    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    view.SetRenderWindow(window)
    window.SetSize(size[0] * scale, size[1] * scale)
    window.Render()
    grab = vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    grab.Update()
    pixels = render.pixels_of(grab.GetOutput())
    return pixels.reshape(size[1], scale, size[0], scale, 3).mean(axis=(1, 3)).astype(np.uint8)


def chart_matrix(cells, beside, scale):
    """Charts in a grid: place along x, place along y from the top, curve, columns of each.

    All charts of one curve have the same axes. beside: the columns of the dashed line, or None.
    """
    rows = 1 + max(row for _, row, _, _ in cells)
    coarsest = max(columns["Level"].max() for *_, columns in cells)
    matrix = vtkChartMatrix()
    matrix.SetSize(vtkVector2i(1 + max(column for column, *_ in cells), rows))
    matrix.SetGutter(vtkVector2f(90 * scale, 95 * scale))
    matrix.SetBorders(85 * scale, 60 * scale, 30 * scale, 35 * scale)
    for column, row, (name, title, factor, logarithmic), columns in cells:
        chart = vtkChartXY()
        matrix.SetChart(vtkVector2i(column, rows - 1 - row), chart)
        if beside:
            add_other(chart, beside[name] * factor, scale)
        fill_chart(chart, columns[name] * factor, columns["Level"].astype(int), coarsest, scale)
        style_chart(chart, title, scale)
        shown = [table[name] for *_, table in cells] + ([beside[name]] if beside else [])
        fix_axis(chart.GetAxis(vtkAxis.BOTTOM), max(map(len, shown)))
        values = np.concatenate(shown) * factor
        if logarithmic and (values > 0).any():
            fix_logarithmic_axis(chart.GetAxis(vtkAxis.LEFT), values[values > 0])
        else:
            fix_axis(chart.GetAxis(vtkAxis.LEFT), values.max())
    return matrix


def columns_of(history):
    """The columns that are drawn, as arrays of floats."""
    return {name: vtk_to_numpy(history.GetColumnByName(name)).astype(float)
            for name in ("Level",) + tuple(curve[0] for curve in CURVES)}


def fill_chart(chart, values, levels, coarsest, scale):
    """A line for each level; each starts where the one before ended."""
    for level in dict.fromkeys(levels):  # as they were visited
        rows = np.flatnonzero(levels == level)
        if rows[0] > 0:
            rows = np.concatenate([[rows[0] - 1], rows])
        line = add_line(chart, rows + 1.0, values[rows], f"Level {level}")
        line.SetColor(*color_of(level, coarsest), 255)
        line.SetWidth(2.0 * scale)


def color_of(level, coarsest):
    return COLORS[int(coarsest - level) % len(COLORS)]


def add_other(chart, values, scale):
    """The dashed line of the other evolution, behind the rest."""
    line = add_line(chart, np.arange(1.0, len(values) + 1), values, "Other")
    line.SetColor(*OTHER_COLOR, 255)
    line.SetWidth(1.5 * scale)
    line.GetPen().SetLineType(vtkPen.DASH_LINE)


def add_line(chart, iterations, values, title):
    table = vtkTable()
    for name, data in (("Iteration", iterations), (title, values)):
        column = numpy_to_vtk(data, deep=True)
        column.SetName(name)
        table.AddColumn(column)
    line = chart.AddPlot(vtkChart.LINE)
    line.SetInputData(table, 0, 1)
    return line


def style_chart(chart, title, scale):
    chart.SetTitle(title)
    look = chart.GetTitleProperties()
    look.SetColor(render.INK)
    look.SetFontSize(17 * scale)
    look.SetBold(True)
    for place in (vtkAxis.BOTTOM, vtkAxis.LEFT):
        axis = chart.GetAxis(place)
        axis.SetTitle("Iteration" if place == vtkAxis.BOTTOM else "")
        axis.GetPen().SetColorF(*render.SOFT_INK)
        axis.GetGridPen().SetColorF(0.22, 0.235, 0.26)
        for look in (axis.GetLabelProperties(), axis.GetTitleProperties()):
            look.SetColor(render.SOFT_INK)
            look.SetFontSize(14 * scale)
            look.SetBold(False)


def fix_axis(axis, largest):
    """From 0 to a little over the largest value, with some five round numbers on the way."""
    largest = largest if largest > 0 and np.isfinite(largest) else 1
    power = 10 ** np.floor(np.log10(largest / 5))
    step = next(f * power for f in (1, 2, 2.5, 5, 10) if largest / (f * power) <= 6)
    ticks = np.arange(0, 1.0001 * largest, step)
    labels = vtkStringArray()
    for tick in ticks:
        labels.InsertNextValue(f"{tick:,.10g}")
    axis.SetBehavior(vtkAxis.FIXED)
    axis.SetRange(0, 1.03 * largest)
    axis.SetCustomTickPositions(numpy_to_vtk(ticks, deep=True), labels)


def fix_logarithmic_axis(axis, values):
    """Whole powers of ten about the values."""
    low, high = np.floor(np.log10(values.min())), np.ceil(np.log10(values.max()))
    axis.LogScaleOn()
    axis.SetBehavior(vtkAxis.FIXED)
    axis.SetUnscaledRange(10.0 ** low, 10.0 ** max(high, low + 1))


def legend(columns, other, width, size, coarsest, unit=" iterations"):
    """Strip that names the lines in their colours and tells their iterations."""
    levels = columns["Level"].astype(int)
    names = [(f"Level {level}: {int((levels == level).sum())}{unit}",
              color_of(level, coarsest)) for level in dict.fromkeys(levels)]
    if other:
        names.append((f"{other[0]}: {other[1].GetNumberOfRows()}", OTHER_COLOR))
    step = width // max(len(names), 1)
    entries = [(step // 2 + number * step, name, True, tuple(c / 255 for c in color))
               for number, (name, color) in enumerate(names)]
    return render.line_strip(entries, width, size, centred=True)
