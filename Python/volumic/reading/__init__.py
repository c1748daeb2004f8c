# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Readers of volumes. read() returns one Volume or throws one VolumeError of one line."""
from __future__ import annotations

from ..errors import VolumeError
from .volume import Choice, Label, Volume, checked, unit_of

__all__ = ["Choice", "Label", "Volume", "VolumeError", "checked", "unit_of"]
