# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Chart of an evolution: the four curves of figure 5 of the paper, with one colour per level.

Lachaud and Montanvert, "Volumic Segmentation using Hierarchical Representation and Triangulated
Surface", ECCV 1996.
"""

import numpy as np
import vtkmodules.vtkRenderingContextOpenGL2  # noqa: F401, registers 2D rendering
import render
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkChartsCore import vtkAxis, vtkChart, vtkChartMatrix, vtkChartXY
from vtkmodules.vtkCommonCore import vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkTable, vtkVector2f, vtkVector2i
from vtkmodules.vtkRenderingContext2D import vtkPen
from vtkmodules.vtkRenderingCore import vtkRenderWindow
from vtkmodules.vtkViewsContext2D import vtkContextView

# Column of the history, title, factor, logarithmic axis.
CURVES = (("Seconds", "Time since the previous iteration (ms)", 1000, True),
          ("KineticEnergy", "Mean kinetic energy along the normals", 1, True),
          ("MeanEdgeLength", "Mean length of the edges (world units)", 1, False),
          ("Vertices", "Number of vertices", 1, False))
# From the coarsest level to the finest.
COLORS = ((102, 194, 245), (250, 176, 77), (122, 214, 134), (238, 120, 130), (190, 150, 240),
          (232, 222, 100), (150, 210, 205), (240, 150, 210))
OTHER_COLOR = (150, 156, 165)
SCALE = render.OVERSAMPLING


def read_history(path):
    """Return the columns of a .csv history by name."""
    table = np.genfromtxt(path, delimiter=",", names=True)
    return {name: np.atleast_1d(table[name]) for name in ("Level", *(c[0] for c in CURVES))}


def history_chart(history, size=(1480, 900)):
    """Return the chart of one evolution, pixels as in render.py."""
    cells = [(number % 2, number // 2, curve, history) for number, curve in enumerate(CURVES)]
    names = legend(history, size[0], 18, history["Level"].max(), " iterations")
    return np.concatenate([render.blank(14, size[0]), names, draw_charts(cells, None, size)])


def legend(history, width, size, coarsest, unit=""):
    """Return a strip with the number of iterations of each level."""
    levels, counts = np.unique(history["Level"], return_counts=True)
    step = width // len(levels)
    return render.line_strip(
        [(step // 2 + i * step, f"Level {level:.0f}: {count}{unit}", True,
          tuple(c / 255 for c in color_of(level, coarsest)))
         for i, (level, count) in enumerate(zip(levels[::-1], counts[::-1]))],
        width, size, centred=True)


def color_of(level, coarsest):
    return COLORS[int(coarsest - level) % len(COLORS)]


def draw_charts(cells, reference, size):
    """Draw charts in a grid. cells: (column, row from the top, curve, history); charts of a curve
    share their axes. reference: history of the dashed line, or None."""
    coarsest = max(history["Level"].max() for *_, history in cells)
    columns, rows = (1 + max(cell[axis] for cell in cells) for axis in (0, 1))
    matrix = vtkChartMatrix()
    matrix.SetSize(vtkVector2i(columns, rows))
    matrix.SetGutter(vtkVector2f(90 * SCALE, 95 * SCALE))
    matrix.SetBorders(85 * SCALE, 60 * SCALE, 30 * SCALE, 35 * SCALE)
    for column, row, (name, title, factor, logarithmic), history in cells:
        chart = vtkChartXY()
        matrix.SetChart(vtkVector2i(column, rows - 1 - row), chart)
        if reference:
            values = reference[name] * factor
            add_line(chart, np.arange(1.0, len(values) + 1), values, OTHER_COLOR, 1.5, True)
        for level in np.unique(history["Level"])[::-1]:
            at = np.flatnonzero(history["Level"] == level)
            at = np.arange(max(at[0] - 1, 0), at[-1] + 1)  # starts at the end of the previous level
            add_line(chart, at + 1.0, history[name][at] * factor, color_of(level, coarsest), 2.0)
        style_chart(chart, title)
        shown = [table[name] for *_, table in cells] + ([reference[name]] if reference else [])
        fix_axis(chart.GetAxis(vtkAxis.BOTTOM), max(map(len, shown)))
        values = np.concatenate(shown) * factor
        if logarithmic and (values > 0).any():
            fix_logarithmic_axis(chart.GetAxis(vtkAxis.LEFT), values[values > 0])
        else:
            fix_axis(chart.GetAxis(vtkAxis.LEFT), values.max())
    view = vtkContextView()
    view.GetRenderer().SetBackground(render.BACKGROUND)
    view.GetScene().AddItem(matrix)
    window = vtkRenderWindow()
    view.SetRenderWindow(window)
    return render.pixels_of_window(window, size)


def add_line(chart, iterations, values, color, width, dashed=False):
    table = vtkTable()
    for name, data in (("Iteration", iterations), ("Value", values)):
        column = numpy_to_vtk(data, deep=True)
        column.SetName(name)
        table.AddColumn(column)
    line = chart.AddPlot(vtkChart.LINE)
    line.SetInputData(table, 0, 1)
    line.SetColor(*color, 255)
    line.SetWidth(width * SCALE)
    if dashed:
        line.GetPen().SetLineType(vtkPen.DASH_LINE)


def style_chart(chart, title):
    chart.SetTitle(title)
    style = chart.GetTitleProperties()
    style.SetColor(render.INK)
    style.SetFontSize(17 * SCALE)
    style.SetBold(True)
    for number in (vtkAxis.BOTTOM, vtkAxis.LEFT):
        axis = chart.GetAxis(number)
        axis.SetTitle("Iteration" if number == vtkAxis.BOTTOM else "")
        axis.GetPen().SetColorF(*render.SOFT_INK)
        axis.GetGridPen().SetColorF(0.22, 0.235, 0.26)
        for style in (axis.GetLabelProperties(), axis.GetTitleProperties()):
            style.SetColor(render.SOFT_INK)
            style.SetFontSize(14 * SCALE)
            style.SetBold(False)


def fix_axis(axis, largest):
    """Set the range to 0 to slightly above the largest value, with about five round ticks."""
    largest = largest if largest > 0 and np.isfinite(largest) else 1
    power = 10 ** np.floor(np.log10(largest / 5))
    step = next(f * power for f in (1, 2, 2.5, 5, 10) if largest / (f * power) <= 6)
    ticks, labels = np.arange(0, 1.0001 * largest, step), vtkStringArray()
    for tick in ticks:
        labels.InsertNextValue(f"{tick:,.10g}")
    axis.SetBehavior(vtkAxis.FIXED)
    axis.SetRange(0, 1.03 * largest)
    axis.SetCustomTickPositions(numpy_to_vtk(ticks, deep=True), labels)


def fix_logarithmic_axis(axis, values):
    """Set the range to powers of ten around the values."""
    low, high = np.floor(np.log10(values.min())), np.ceil(np.log10(values.max()))
    axis.LogScaleOn()
    axis.SetBehavior(vtkAxis.FIXED)
    axis.SetUnscaledRange(10.0 ** low, 10.0 ** max(high, low + 1))
