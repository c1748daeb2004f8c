# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Where the example scripts lie, seen from the tests."""

import os

EXAMPLES = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", "..", "Examples", "Python"))
