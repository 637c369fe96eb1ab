"""Independent programs that results are held against."""

from __future__ import annotations

import os
import shutil
from pathlib import Path
from typing import List

import pytest


def sptk(tool: str) -> List[str]:
    """The command of a tool of SPTK, found in the folder LABIAL_SPTK or on the path; skips the test where it is not."""
    folder = os.environ.get("LABIAL_SPTK")
    if folder and os.access(Path(folder) / tool, os.X_OK):
        return [str(Path(folder) / tool)]
    program = shutil.which("sptk")
    if not program:
        pytest.skip("SPTK is not installed (Debian package sptk)")
    return [program, tool]
