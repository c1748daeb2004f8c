# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Files of all formats, damaged at random: `volumic` gives their voxels, or says that it cannot.

VOLUMIC_DAMAGED_FILES is how many there are: few by default, 3000 as a campaign.
VOLUMIC_DAMAGE_SEED is the first of their numbers.
"""

import collections
import concurrent.futures
import gzip
import os
import re
import resource
import struct
import subprocess
import unittest
import zlib

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import (
    vtkBMPWriter, vtkMetaImageWriter, vtkPNGWriter, vtkPNMWriter, vtkTIFFWriter)
from vtkmodules.vtkIOLegacy import vtkStructuredPointsWriter
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

from tool_test_case import (
    META, PROGRAM, SPACING, ToolTestCase, ball, dicom_slice, make_image, nrrd_header)

import medical_files
from test_tool_structure import tiff
from vtk_files import read

COUNT = int(os.environ.get("VOLUMIC_DAMAGED_FILES", "120"))
SEED = int(os.environ.get("VOLUMIC_DAMAGE_SEED", "1"))
SECONDS, BYTES = 30, 3 << 30  # that a run may take

# volume: what is given to the program; files: those that may be damaged; packed: a byte of the data
# changes many voxels, and no checksum tells.
Kind = collections.namedtuple("Kind", "volume files packed")


def voxels():
    noise = np.random.default_rng(5).integers(0, 4, ball().shape)
    return (ball() + noise).astype("i2")


def limit():
    resource.setrlimit(resource.RLIMIT_AS, (BYTES, BYTES))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def damage(content, generator):
    """The content, damaged, and how: cut, more, less, block or flip."""
    how = generator.choice(["cut", "more", "less", "block", "flip", "flip", "flip", "field"])
    size = len(content)
    # Headers are short, but most of what may be wrong is there.
    place = int(generator.integers(min(size, 1500) if generator.random() < 0.6 else size))
    count = int(generator.choice([1, 2, 3, 4, 8, 16, 100, 512]))
    content = bytearray(content)
    if how == "cut":
        content = content[:int(generator.integers(size))]
    elif how == "more":
        content[place:place] = generator.bytes(count)
    elif how == "less":
        del content[place:place + count]
    elif how == "block":
        content[place:place + count] = bytes(len(content[place:place + count]))
    elif how == "flip":
        content[place] ^= 1 << int(generator.integers(8))
    else:
        value = int(generator.choice([0, 1, 2, 255, 32768, 65535, 2 ** 31 - 1, 2 ** 32 - 1]))
        place = min(place // 2 * 2, size - 4)
        struct.pack_into("<I", content, place, value)
    return bytes(content), str(how)


class RandomDamageTest(ToolTestCase):
    def setUp(self):
        super().setUp()
        self.kinds = {}
        data = voxels().tobytes()
        self.add("raw.mha", META + data)
        self.add("two.mhd", META.replace(b"LOCAL", b"two.raw"))
        self.add("two.mhd", data, "two.raw")
        for encoding, packed in (("raw", data), ("gzip", gzip.compress(data))):
            self.add(encoding + ".nrrd", nrrd_header(encoding) + b"\n" + packed)
        nifti = medical_files.nifti(voxels(), SPACING)
        self.add("a.nii", nifti)
        self.add("b.nii.gz", gzip.compress(nifti))
        self.add("a.mrc", medical_files.mrc(voxels(), SPACING))
        self.add("a.inv3", medical_files.inv3(voxels(), SPACING))
        pages = [page.tobytes() for page in voxels()]
        self.add("one.tif", bytes(tiff(pages, {})))
        self.add("deflate.tif", bytes(tiff([zlib.compress(page) for page in pages], {259: 8})))
        self.write_kind("packbits.tif", vtkTIFFWriter(), packed=True)
        self.write_kind("packed.mha", vtkMetaImageWriter())
        self.write_kind("a.vti", vtkXMLImageDataWriter())
        self.write_kind("text.vtk", vtkStructuredPointsWriter(), packed=True)
        legacy = vtkStructuredPointsWriter()
        legacy.SetFileTypeToBinary()
        self.write_kind("a.vtk", legacy)
        for suffix, writer in (("png", vtkPNGWriter), ("pgm", vtkPNMWriter), ("bmp", vtkBMPWriter)):
            os.makedirs(self.path(suffix))
            for k, plane in enumerate(voxels() // 5):
                kind = "u2" if suffix == "png" else "u1"
                name = f"{suffix}/{k:02}.{suffix}"
                self.write(writer(), name, make_image(plane[np.newaxis].astype(kind)))
                self.add(suffix, self.content(name), name)
        os.makedirs(self.path("dicom"))
        for k in range(len(voxels())):
            self.add("dicom", dicom_slice(k, voxels()), f"dicom/IM{k:02}")

    def add(self, volume, content, name=None, packed=False):
        """A file (name) of a volume."""
        name = name or volume
        self.write_bytes(name, content)
        self.kinds.setdefault(volume, Kind(volume, {}, packed)).files[name] = content

    def write_kind(self, name, writer, packed=False):
        self.write(writer, name, make_image(voxels().astype("u2")))
        self.add(name, self.content(name), packed=packed)

    def read(self, folder, volume, *options):
        """The finished process, and the voxels that it wrote."""
        written = os.path.join(folder, "written.vti")
        process = subprocess.run(
            [PROGRAM, os.path.join(folder, volume), "--write-volume", written, *options],
            capture_output=True, text=True, errors="replace", timeout=SECONDS, check=False,
            preexec_fn=limit)
        if process.returncode != 0:
            return process, None
        image = read(written)
        values = vtk_to_numpy(image.GetPointData().GetScalars())
        return process, values.reshape(*image.GetDimensions()[::-1], -1)

    def run_damaged(self, number):
        """What is wrong with the run of this number; None: nothing."""
        generator = np.random.default_rng(number)
        kind = self.kinds[sorted(self.kinds)[number % len(self.kinds)]]
        name = sorted(kind.files)[int(generator.integers(len(kind.files)))]
        damaged, how = damage(kind.files[name], generator)
        folder = self.path(f"run{number}")
        os.makedirs(os.path.dirname(os.path.join(folder, name)))
        for other, content in kind.files.items():
            with open(os.path.join(folder, other), "wb") as file:
                file.write(damaged if other == name else content)
        memory = ("--memory", "200M") if generator.random() < 0.3 else ()
        told = f"{number}: {name}, {how}, {len(damaged)} of {len(kind.files[name])} bytes: "
        try:
            process, there = self.read(folder, kind.volume, *memory)
        except subprocess.TimeoutExpired:
            return told + "hangs"
        wrong = self.wrong(kind, process, there, how)
        if not wrong or not os.environ.get("VOLUMIC_KEEP_DAMAGED"):
            subprocess.run(["rm", "-r", folder], check=True)
        return told + wrong if wrong else None

    def wrong(self, kind, process, there, how):
        """Why this is no proper end; empty if it is one."""
        if process.returncode == 1:
            line = process.stderr.strip().splitlines()[-1:]
            return "" if line and re.match("volumic: .*: .", line[0]) else "says " + process.stderr
        if process.returncode != 0:
            return f"ends with {process.returncode}"
        if "warning" in process.stderr:
            return ""
        expected = self.whole[kind.volume]
        if "--memory" in process.args:
            expected = expected[..., :1] # the component that is selected
        if there.shape != expected.shape:
            return f"gives {there.shape}, silently"
        different = np.count_nonzero(there != expected)
        # Bytes that are others may be those of voxels, or of a number of the header that changes all
        # voxels; bytes that are too many or too few must not move any.
        if different > 0 and not kind.packed and how in ("cut", "more", "less"):
            return f"gives {different} other voxels, silently"
        return ""

    def test_damaged_files(self):
        self.whole = {}
        for volume in self.kinds:
            process, self.whole[volume] = self.read(self.folder, volume)
            self.assertEqual(process.returncode, 0, process.stderr)
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            wrong = [text for text in pool.map(self.run_damaged, range(SEED, SEED + COUNT)) if text]
        self.assertEqual(wrong, [], "\n" + "\n".join(wrong))


if __name__ == "__main__":
    unittest.main()
