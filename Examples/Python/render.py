# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Off-screen rendering of surfaces and slices to numpy arrays [row, column, RGB], top row first.

draw() renders a panel at twice its size and averages pixels, which antialiases with every driver.
compose() arranges panels with captions. Rendering requires a display, for example by xvfb-run.
"""

import numpy as np
import vtkmodules.vtkRenderingFreeType  # noqa: F401, registers text rendering
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401, registers windows
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import (
    vtkActor, vtkImageSlice, vtkImageSliceMapper, vtkLight, vtkPolyDataMapper, vtkRenderer,
    vtkRenderWindow, vtkTextProperty, vtkTextRenderer, vtkWindowToImageFilter)
from vtkmodules.vtkRenderingOpenGL2 import vtkRenderStepsPass, vtkSSAOPass
from volumic.writing.files import replace_file

BACKGROUND = (0.085, 0.092, 0.105)
BONE = (0.93, 0.87, 0.75)
CUT_FACE = (0.72, 0.36, 0.27)
INK, SOFT_INK = (0.95, 0.95, 0.95), (0.66, 0.69, 0.73)
OVERSAMPLING = 2
OPPOSITE = dict(zip("LRAPSI", "RLPAIS"))  # sides of the body
# Position relative to the camera, intensity, colour: key light, fill light, back light.
LIGHTS = (((-0.7, 0.9, 1.2), 0.95, (1.0, 0.985, 0.95)),
          ((1.0, -0.1, 0.9), 0.26, (0.90, 0.95, 1.0)),
          ((0.3, 1.0, -0.6), 0.22, (1.0, 1.0, 1.0)))


class Frame:
    """Directions of left, posterior and superior in world coordinates.

    axes: directions of x, y, z, such as "RAS"; "" is LPS, as in DICOM.
    """

    def __init__(self, axes=""):
        self.axes = axes or "LPS"
        self.directions = {}
        for axis, letter in zip(np.eye(3), self.axes):
            self.directions[letter] = axis
            self.directions[OPPOSITE[letter]] = -axis
        # Renderings of left-handed frames are mirrored.
        self.mirrored = np.linalg.det([self.directions[c] for c in "LPS"]) < 0

    def vector(self, letters):
        """Return the unit vector towards letters, weighted by their counts, such as "AAL"."""
        total = sum(self.directions[letter] for letter in letters)
        return total / np.linalg.norm(total)

    def of_indices(self, direction):
        """Return the frame of the index axes, by the nearest world axes."""
        nearest = np.abs(direction).argmax(axis=0)
        return Frame("".join(self.axes[w] if direction[w, c] > 0 else OPPOSITE[self.axes[w]]
                             for c, w in enumerate(nearest)))


# ---- Actors ------------------------------------------------------------------------------------

def surface_actor(surface, color=BONE, edges=False):
    """Return a matte actor of polygons, optionally with edges."""
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(surface)
    mapper.ScalarVisibilityOff()
    actor = vtkActor()
    actor.SetMapper(mapper)
    style = actor.GetProperty()
    style.SetColor(color)
    style.SetInterpolationToPhong()
    style.SetAmbient(0.14)
    style.SetDiffuse(0.88)
    style.SetSpecular(0.12)
    style.SetSpecularPower(18)
    if edges:
        style.EdgeVisibilityOn()
        style.SetEdgeColor(0.16, 0.15, 0.14)
        style.SetInterpolationToFlat()
    return actor


def line_actor(lines, color, width):
    """Return an actor of unlit lines of this width in pixels of the final picture."""
    actor = surface_actor(lines, color)
    actor.GetProperty().LightingOff()
    actor.GetProperty().SetLineWidth(width * OVERSAMPLING)
    return actor


def slice_actor(image, axis, index, window):
    """Return a grey actor of a slice across an index axis.

    Coordinates are indices, counted from the first voxel, times the spacing. window: values shown
    as black and white.
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
    actor.GetProperty().SetInterpolationTypeToNearest()
    actor.GetProperty().SetColorWindow(window[1] - window[0])
    actor.GetProperty().SetColorLevel((window[0] + window[1]) / 2)
    return actor


# ---- Panels ------------------------------------------------------------------------------------

def draw(actors, size, frame, look_from, up, bounds, zoom=1.0, shaded=True, focus=None):
    """Return a picture of actors, size = (width, height) in pixels.

    look_from, up: letters for Frame.vector. bounds: determine the scale, so that panels with equal
    bounds can be compared. focus: centre of the picture (default: centre of the bounds).
    """
    renderer = vtkRenderer()
    renderer.SetBackground(BACKGROUND)
    for actor in actors:
        renderer.AddViewProp(actor)
    place_camera(renderer, size, frame.vector(look_from), frame.vector(up), bounds, zoom, focus)
    if shaded:
        add_lights(renderer, np.linalg.norm(np.diff(np.reshape(bounds, (3, 2)))) / zoom)
    window = vtkRenderWindow()
    window.AddRenderer(renderer)
    pixels = pixels_of_window(window, size)
    return pixels[:, ::-1] if frame.mirrored else pixels


def pixels_of_window(window, size):
    """Return the content of a window at this size in pixels."""
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetSize(size[0] * OVERSAMPLING, size[1] * OVERSAMPLING)
    window.Render()
    grab = vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    grab.Update()
    pixels = pixels_of(grab.GetOutput())
    window.Finalize()
    boxes = pixels.reshape(size[1], OVERSAMPLING, size[0], OVERSAMPLING, 3)
    return boxes.mean(axis=(1, 3)).astype(np.uint8)


def place_camera(renderer, size, towards, up, bounds, zoom, focus):
    """Set a parallel projection in which the bounds fill the picture."""
    half_width, half_height = projected(towards, up, bounds)
    bounds = np.reshape(bounds, (3, 2))
    centre = bounds.mean(axis=1) if focus is None else np.asarray(focus, float)
    radius = np.linalg.norm(bounds[:, 1] - bounds[:, 0])
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(centre)
    camera.SetPosition(centre + towards * 2 * radius)
    camera.SetViewUp(up)
    camera.SetParallelScale(1.04 * max(half_height, half_width * size[1] / size[0]) / zoom)
    camera.SetClippingRange(0.5 * radius, 3.5 * radius)


def projected(towards, up, bounds):
    """Return half the width and height of the projected bounds."""
    bounds = np.reshape(bounds, (3, 2))
    up = up - towards * (up @ towards)
    up /= np.linalg.norm(up)
    corners = np.array(np.meshgrid(*bounds)).reshape(3, -1).T - bounds.mean(axis=1)
    return np.abs(corners @ np.cross(up, towards)).max(), np.abs(corners @ up).max()


def fitting_height(width, frame, views, bounds):
    """Return the panel height in pixels at which all views (look_from, up) fit this width."""
    halves = [projected(frame.vector(look_from), frame.vector(up), bounds)
              for look_from, up in views]
    return max(int(np.clip(width * height / half, 0.5 * width, 1.4 * width))
               for half, height in halves)


def add_lights(renderer, radius):
    """Add LIGHTS and ambient occlusion, which darkens openings and cavities."""
    renderer.AutomaticLightCreationOff()
    for position, intensity, color in LIGHTS:
        light = vtkLight()
        light.SetLightTypeToCameraLight()
        light.SetPosition(position)
        light.SetFocalPoint(0, 0, 0)
        light.SetIntensity(intensity)
        light.SetColor(color)
        renderer.AddLight(light)
    occlusion = vtkSSAOPass()
    occlusion.SetDelegatePass(vtkRenderStepsPass())
    occlusion.SetRadius(0.12 * radius)
    occlusion.SetBias(0.012 * radius)
    occlusion.SetKernelSize(64)
    occlusion.BlurOn()
    renderer.SetPass(occlusion)


def pixels_of(image):
    """Return an array [row, column, channel] of a VTK image, top row first."""
    scalars = vtk_to_numpy(image.GetPointData().GetScalars())
    width, height, _ = image.GetDimensions()
    return scalars.reshape(height, width, -1)[::-1]


# ---- Layout ------------------------------------------------------------------------------------

def compose(rows, captions=None, title=None, headings=None, gap=10):
    """Return one picture of panels.

    rows: lists of panels of equal size. captions: for each row, a list of tuples of lines, the
    first one bold. headings: a line above each row.
    """
    width = rows[0][0].shape[1]
    total = max(map(len, rows)) * (width + gap) + gap
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
    return np.full((height, width, 3), np.round(np.array(BACKGROUND) * 255), np.uint8)


def line_strip(entries, width, size, centred=False):
    """Return texts on one line. entries: (position from the left, text, bold, colour)."""
    strip = blank(int(size * 1.6), width)
    for position, text, bold, color in entries:
        picture = text_picture(text, size, color, bold)
        left = max(0, position - picture.shape[1] // 2 if centred else position)
        picture = picture[:strip.shape[0], :width - left]
        top = (strip.shape[0] - picture.shape[0]) // 2
        strip[top:top + picture.shape[0], left:left + picture.shape[1]] = picture
    return strip


def text_picture(text, size, color, bold):
    """Return one line of text on the background, cropped."""
    style = vtkTextProperty()
    style.SetFontFamilyToArial()
    style.SetFontSize(size)
    style.SetBold(bold)
    style.SetColor(color)
    style.SetBackgroundColor(BACKGROUND)
    style.SetBackgroundOpacity(1)
    image, extent = vtkImageData(), [0, 0]
    vtkTextRenderer.GetInstance().RenderString(style, text, image, extent, 72)
    return pixels_of(image)[-extent[1]:, :extent[0], :3]


def image_of(pixels):
    image = vtkImageData()
    image.SetDimensions(pixels.shape[1], pixels.shape[0], 1)
    image.GetPointData().SetScalars(numpy_to_vtk(pixels[::-1].reshape(-1, 3), deep=True))
    return image


def write_png(pixels, path):
    """Write a picture. Raise OSError if it cannot be written."""
    writer = vtkPNGWriter()
    writer.WriteToMemoryOn()
    writer.SetCompressionLevel(9)
    writer.SetInputData(image_of(pixels))
    writer.Write()
    replace_file(path, memoryview(vtk_to_numpy(writer.GetResult())))
