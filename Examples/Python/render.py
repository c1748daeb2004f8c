# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Off-screen pictures of surfaces and slices, as numpy arrays [row, column, RGB] from the top.

Panels are drawn one by one at twice their size and averaged down, which smooths edges on every
driver, then laid out with captions by compose(). Needs a display; xvfb-run gives one.
"""

import numpy as np
import vtkmodules.vtkRenderingFreeType  # noqa: F401, the factory of text
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401, the factory of windows
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import (
    vtkActor, vtkImageSlice, vtkImageSliceMapper, vtkLight, vtkPolyDataMapper, vtkRenderer,
    vtkRenderWindow, vtkTextProperty, vtkTextRenderer, vtkWindowToImageFilter)
from vtkmodules.vtkRenderingOpenGL2 import vtkRenderStepsPass, vtkSSAOPass

from output_files import check_end, write_with
from volume_image import OPPOSITE, direction_of, world_axes

BACKGROUND = (0.085, 0.092, 0.105)
BONE = (0.93, 0.87, 0.75)
CUT_FACE = (0.72, 0.36, 0.27)
INK, SOFT_INK = (0.95, 0.95, 0.95), (0.66, 0.69, 0.73)
OVERSAMPLING = 2


class Frame:
    """Where left, posterior and superior lie among three coordinate axes.

    axes: letters of x, y, z; None is taken as LPS, DICOM's frame.
    """

    def __init__(self, axes=None):
        letters = axes if axes and sorted(map(canonical, axes)) == ["L", "P", "S"] else "LPS"
        self.directions = {}
        for axis, letter in zip(np.eye(3), letters):
            self.directions[letter] = axis
            self.directions[OPPOSITE[letter]] = -axis
        self.letters = letters
        # In a left-handed frame a renderer shows the mirror image.
        self.mirrored = np.linalg.det([self.directions[c] for c in "LPS"]) < 0

    def vector(self, letters):
        """Unit vector towards the letters, weighted by how often each occurs, as in "AAL"."""
        total = sum(self.directions[letter] for letter in letters)
        return total / np.linalg.norm(total)


def canonical(letter):
    return letter if letter in "LPS" else OPPOSITE.get(letter, letter)


def world_frame(image):
    """The frame of the image's world coordinates."""
    return Frame(world_axes(image))


def index_frame(image):
    """The frame of the image's index axes: for each the nearest world axis."""
    direction, letters = direction_of(image), world_axes(image) or "LPS"
    nearest = [int(np.argmax(np.abs(direction[:, c]))) for c in range(3)]
    return Frame("".join(letters[w] if direction[w, c] > 0 else OPPOSITE[letters[w]]
                         for c, w in enumerate(nearest)))


def surface_actor(surface, color=BONE, edges=False):
    """Matt actor of polygons; edges draws the triangles' sides as well."""
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(surface)
    mapper.ScalarVisibilityOff()
    actor = vtkActor()
    actor.SetMapper(mapper)
    look = actor.GetProperty()
    look.SetColor(color)
    look.SetInterpolationToPhong()
    look.SetAmbient(0.14)
    look.SetDiffuse(0.88)
    look.SetSpecular(0.12)
    look.SetSpecularPower(18)
    if edges:
        look.EdgeVisibilityOn()
        look.SetEdgeColor(0.16, 0.15, 0.14)
        look.SetLineWidth(1.0)
        look.SetInterpolationToFlat()
    return actor


def slice_actor(image, axis, index, window):
    """Grey actor of one slice across an index axis, index counted from the first voxel.

    Coordinates are such indices times the spacing. window: the values shown black and white.
    """
    plain = vtkImageData()
    plain.ShallowCopy(image)
    plain.SetOrigin([-image.GetExtent()[2 * c] * image.GetSpacing()[c] for c in range(3)])
    plain.SetDirectionMatrix(1, 0, 0, 0, 1, 0, 0, 0, 1)
    mapper = vtkImageSliceMapper()
    mapper.SetInputData(plain)
    mapper.SetOrientation(axis)
    mapper.SetSliceNumber(image.GetExtent()[2 * axis] + index)
    actor = vtkImageSlice()
    actor.SetMapper(mapper)
    look = actor.GetProperty()
    look.SetInterpolationTypeToNearest()
    look.SetColorWindow(window[1] - window[0])
    look.SetColorLevel((window[0] + window[1]) / 2)
    return actor


def line_actor(lines, color, width):
    """Unlit lines of the given colour, as wide as that many pixels of the finished picture."""
    actor = surface_actor(lines, color)
    actor.GetProperty().LightingOff()
    actor.GetProperty().SetLineWidth(width * OVERSAMPLING)
    return actor


def draw(actors, size, frame, look_from, up, bounds, zoom=1.0, shaded=True, focus=None):
    """Picture of the actors, size = (width, height) in pixels.

    look_from and up are letters as Frame.vector takes them. The bounds, not the actors, decide
    about the scale, so that panels with the same bounds can be compared. focus: the point in the
    middle, that of the bounds by default.
    """
    renderer = vtkRenderer()
    renderer.SetBackground(BACKGROUND)
    for actor in actors:
        renderer.AddViewProp(actor)
    place_camera(renderer, size, frame.vector(look_from), frame.vector(up), bounds, zoom, focus)
    if shaded:
        add_lights(renderer)
        add_occlusion(renderer, bounds, zoom)
    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetSize(size[0] * OVERSAMPLING, size[1] * OVERSAMPLING)
    window.AddRenderer(renderer)
    window.Render()
    grab = vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    grab.Update()
    pixels = pixels_of(grab.GetOutput())
    window.Finalize()
    if frame.mirrored:
        pixels = pixels[:, ::-1]
    n = OVERSAMPLING
    return pixels.reshape(size[1], n, size[0], n, 3).mean(axis=(1, 3)).astype(np.uint8)


def place_camera(renderer, size, towards, up, bounds, zoom, focus):
    """Parallel projection in which the bounds fill the picture."""
    half_width, half_height = projected(towards, up, bounds)
    bounds = np.reshape(bounds, (3, 2))
    centre = bounds.mean(axis=1) if focus is None else np.asarray(focus, dtype=float)
    radius = np.linalg.norm(bounds[:, 1] - bounds[:, 0])
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(centre)
    camera.SetPosition(centre + towards * 2 * radius)
    camera.SetViewUp(up)
    camera.SetParallelScale(1.04 * max(half_height, half_width * size[1] / size[0]) / zoom)
    camera.SetClippingRange(0.5 * radius, 3.5 * radius)


def projected(towards, up, bounds):
    """Half width and half height of the bounds as seen from there."""
    bounds = np.reshape(bounds, (3, 2))
    up = up - towards * (up @ towards)
    up /= np.linalg.norm(up)
    corners = np.array(np.meshgrid(*bounds)).reshape(3, -1).T - bounds.mean(axis=1)
    return np.abs(corners @ np.cross(up, towards)).max(), np.abs(corners @ up).max()


def fitting_height(width, frame, look_from, up, bounds):
    """Height in pixels at which a picture of this width shows the bounds without waste."""
    half_width, half_height = projected(frame.vector(look_from), frame.vector(up), bounds)
    return int(np.clip(width * half_height / half_width, 0.5 * width, 1.4 * width))


def add_lights(renderer):
    """A key light from the upper left of the camera, a weak fill and a light from behind."""
    renderer.AutomaticLightCreationOff()
    for position, intensity, color in (
            ((-0.7, 0.9, 1.2), 0.95, (1.0, 0.985, 0.95)),
            ((1.0, -0.1, 0.9), 0.26, (0.90, 0.95, 1.0)),
            ((0.3, 1.0, -0.6), 0.22, (1.0, 1.0, 1.0))):
        light = vtkLight()
        light.SetLightTypeToCameraLight()
        light.SetPosition(position)
        light.SetFocalPoint(0, 0, 0)
        light.SetIntensity(intensity)
        light.SetColor(color)
        renderer.AddLight(light)


def add_occlusion(renderer, bounds, zoom):
    """Darken what lies in hollows: it makes openings and cavities readable."""
    radius = np.linalg.norm(np.diff(np.reshape(bounds, (3, 2)))) / zoom
    occlusion = vtkSSAOPass()
    occlusion.SetDelegatePass(vtkRenderStepsPass())
    occlusion.SetRadius(0.12 * radius)
    occlusion.SetBias(0.012 * radius)
    occlusion.SetKernelSize(64)
    occlusion.BlurOn()
    renderer.SetPass(occlusion)


def pixels_of(image):
    """Array [row, column, channel] of a VTK picture, from the top."""
    scalars = vtk_to_numpy(image.GetPointData().GetScalars())
    width, height, _ = image.GetDimensions()
    return scalars.reshape(height, width, -1)[::-1]


def text_picture(text, size, color=INK, bold=False):
    """Picture of one line of text on the background, as large as it needs to be."""
    look = vtkTextProperty()
    look.SetFontFamilyToArial()
    look.SetFontSize(size)
    look.SetBold(bold)
    look.SetColor(color)
    look.SetBackgroundColor(BACKGROUND)
    look.SetBackgroundOpacity(1)
    image = vtkImageData()
    extent = [0, 0]
    vtkTextRenderer.GetInstance().RenderString(look, text, image, extent, 72)
    return pixels_of(image)[-extent[1]:, :extent[0], :3]


def compose(rows, captions=None, title=None, headings=None, gap=10):
    """One picture of panels.

    rows: lists of equally large panels. captions: for each row a list of tuples of lines, drawn
    under the panels, the first line bold. headings: a line above each row.
    """
    height, width = rows[0][0].shape[:2]
    columns = max(len(row) for row in rows)
    total = columns * (width + gap) + gap
    size = max(15, min(22, width // 21))
    strips = [blank(gap, total)]
    if title:
        strips += [line_strip([(gap, title, True, INK)], total, size + 6)]
    for number, row in enumerate(rows):
        if headings and headings[number]:
            strips += [line_strip([(gap, headings[number], False, SOFT_INK)], total, size)]
        strip = blank(row[0].shape[0], total)
        for column, panel in enumerate(row):
            left = gap + column * (width + gap)
            strip[:, left:left + panel.shape[1]] = panel
        strips += [strip, blank(gap // 2, total)]
        lines = captions[number] if captions else []
        for level in range(max(map(len, lines), default=0)):
            entries = [(gap + c * (width + gap) + width // 2, text[level], level == 0,
                        SOFT_INK if level else INK)
                       for c, text in enumerate(lines) if level < len(text)]
            strips.append(line_strip(entries, total, size, centred=True))
        strips.append(blank(gap, total))
    return np.concatenate(strips)


def blank(height, width):
    strip = np.empty((height, width, 3), np.uint8)
    strip[:] = np.round(np.array(BACKGROUND) * 255)
    return strip


def line_strip(entries, width, size, centred=False):
    """Strip with texts on one line; entries: (place from the left, text, bold, colour)."""
    strip = blank(int(size * 1.6), width)
    for place, text, bold, color in entries:
        picture = text_picture(text, size, color, bold)
        left = max(0, place - picture.shape[1] // 2 if centred else place)
        picture = picture[:strip.shape[0], :width - left]
        top = (strip.shape[0] - picture.shape[0]) // 2
        strip[top:top + picture.shape[0], left:left + picture.shape[1]] = picture
    return strip


def write_png(pixels, path):
    image = vtkImageData()
    image.SetDimensions(pixels.shape[1], pixels.shape[0], 1)
    image.GetPointData().SetScalars(
        numpy_to_vtk(np.ascontiguousarray(pixels[::-1]).reshape(-1, 3), deep=True))
    writer = vtkPNGWriter()
    writer.SetCompressionLevel(9)
    write_with(writer, image, path, lambda written: check_end(written, b"IEND"))
