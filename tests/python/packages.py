"""What tests share: commands run on the source tree, the mark of tests of the Python run-time, a small program, the
house's warnings, the tools of SPTK."""

from __future__ import annotations

import functools
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Dict, List, Optional

import pytest

SOURCE = Path(os.environ.get("LABIAL_SOURCE", Path(__file__).resolve().parents[2]))
CMAKE = os.environ.get("LABIAL_CMAKE") or shutil.which("cmake") or ""
CC = os.environ.get("LABIAL_CC") or "cc"
CXX = next(filter(None, map(shutil.which, (os.environ.get("LABIAL_CXX") or "g++", "g++", "clang++", "c++"))), "")

#: What programs of tests are linked with: the build's models and library, or what these are made of.
LIBRARIES = [Path(name) for name in os.environ.get("LABIAL_LIBRARIES", "").split(os.pathsep) if name] or [
    *sorted((SOURCE / "lib").glob("*.c")), *sorted((SOURCE / "lib" / "models").glob("speech_en*.c"))]

needs_runtime = pytest.mark.skipif(
    not os.environ.get("LABIAL_RUNTIME"),
    reason="LABIAL_RUNTIME names no build of the run-time: cmake --build builds it as labial-python")

#: Says a word with the bundled model and prints its frames' jaw; needs the library, the model and its names.
PROGRAM = """\
#include <stdio.h>
#include "speech_en.h"

static labial_t stream;
static uint32_t workspace[SPEECH_EN_WORKSPACE_SIZE / 4];

static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    (void)user;
    printf("%u %d\\n", (unsigned)frame, faps[0]);
}

int main(void)
{
    const int phoneme = labial_find(&speech_en_names, "AA", 2);
    labial_init(&stream, &speech_en, workspace, sizeof workspace, on_frame, NULL);
    labial_push(&stream, SPEECH_EN_M, 100);
    labial_push(&stream, (unsigned)phoneme, 300);
    labial_end(&stream);
    while (labial_tick(&stream) != LABIAL_DONE)
        continue;
    return 0;
}
"""


def attributions() -> Dict[str, str]:
    """What redistribution of each bundled model must say, in single spaces: from the trained models and from the notice
    of the dictionary, not from the headers that the packages' own notices are made of."""
    from labial.hearing.model import load as load_hearing
    from labial.tables.model import load
    from labial.words.dictionary import NOTICE

    found = {"words_en": NOTICE}
    for path in (SOURCE / "export" / "models").glob("*.npz"):
        if path.stem not in found:
            reader = load_hearing if path.stem.startswith("hear_") else load
            found[path.stem] = reader(path).attribution
    assert all(found.values())
    return {name: " ".join(text.split()) for name, text in found.items()}


def warnings(language: str) -> List[str]:
    """The compiler options of cmake/LabialTarget.cmake for "c" or "c++", as errors."""
    text = (SOURCE / "cmake" / "LabialTarget.cmake").read_text(encoding="utf-8")
    names = ["LABIAL_WARNINGS"] + (["LABIAL_C_WARNINGS"] if language == "c" else [])
    found: List[str] = []
    for name in names:
        match = re.search(rf"^set\({name}\s+([^)]*)\)", text, re.MULTILINE)
        assert match, f"{name} is not in LabialTarget.cmake"
        found += match[1].split()
    assert "-Wconversion" in found
    return [*found, "-Werror"]


def run(*command: object, cwd: Optional[Path] = None, env: Optional[Dict[str, str]] = None, status: int = 0,
        text: str = "") -> str:
    """Runs a command that must end with `status`; its standard output."""
    done = subprocess.run([str(part) for part in command], cwd=cwd, capture_output=True, encoding="utf-8", input=text,
                          timeout=300, check=False, env={**os.environ, **(env or {})})
    assert done.returncode == status, f"{command}: {done.returncode}\n{done.stdout}{done.stderr}"
    return done.stdout if status == 0 else done.stdout + done.stderr


def copy_sources(folder: Path) -> None:
    """Copies the source tree to a new folder, without what was built or fetched in it."""
    shutil.copytree(SOURCE, folder, symlinks=True,
                    ignore=shutil.ignore_patterns("build", ".git", "__pycache__", "*.egg-info", ".venv"))


def pack(*arguments: object, root: Path = SOURCE, status: int = 0) -> str:
    """Runs packaging/pack.py of the tree `root`."""
    return run(sys.executable, root / "packaging" / "pack.py", *arguments, env={"PYTHONDONTWRITEBYTECODE": "1"},
               status=status)


@functools.cache
def expected_frames() -> str:
    """What PROGRAM prints when it is compiled with the source tree's headers and library, without any package."""
    with tempfile.TemporaryDirectory(prefix="labial-") as name:
        folder = Path(name)
        (folder / "expected.c").write_text(PROGRAM)
        run(CC, "-std=c99", f"-I{SOURCE / 'include'}", f"-I{SOURCE / 'lib' / 'models'}", folder / "expected.c",
            *LIBRARIES, "-o", folder / "expected")
        frames = run(folder / "expected")
    assert len(frames.splitlines()) == 20 + 12  # 400 ms, and the way to rest
    return frames


def sptk(tool: str) -> List[str]:
    """The command of a tool of SPTK, found in the folder LABIAL_SPTK or on the path; skips the test where it is not."""
    folder = os.environ.get("LABIAL_SPTK")
    if folder and os.access(Path(folder) / tool, os.X_OK):
        return [str(Path(folder) / tool)]
    program = shutil.which("sptk")
    if not program:
        pytest.skip("SPTK is not installed (Debian package sptk)")
    return [program, tool]
