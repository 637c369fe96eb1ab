"""Runs exported models in the C library itself, compiled with the host's C compiler."""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import List, Optional, Sequence, Tuple

import numpy as np

from labial import emit
from labial.errors import LabialError
from labial.faps import CHANNELS
from labial.quantise import ExportedModel

#: Reads phoneme streams, "count" and then "number milliseconds" pairs, and writes each stream's frames as int16.
_DRIVER = """\
#include <stdio.h>
#include "@.h"

static labial_t stream;
static uint32_t workspace[WORKSPACE / 4];

static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    (void)frame;
    fwrite(faps, sizeof faps[0], LABIAL_CHANNELS, (FILE *)user);
}

int main(void)
{
    unsigned long count;
    while (scanf("%lu", &count) == 1) {
        int result = labial_init(&stream, &@, workspace, sizeof workspace, on_frame, stdout);
        while (result >= 0 && count > 0) {
            unsigned phoneme;
            unsigned long milliseconds;
            if (scanf("%u %lu", &phoneme, &milliseconds) != 2)
                return 2;
            while (labial_room(&stream) == 0)
                labial_tick(&stream);
            result = labial_push(&stream, phoneme, (uint32_t)milliseconds);
            count--;
        }
        if (result >= 0)
            labial_end(&stream);
        while (result >= 0 && result != LABIAL_DONE)
            result = labial_tick(&stream);
        if (result < 0) {
            fprintf(stderr, "the library answers %d: %s\\n", result, labial_result_text(result));
            return 1;
        }
    }
    return 0;
}
"""


def library_root(given: Optional[str] = None) -> Path:
    """The folder that holds ``include/labial`` and ``lib``: `given`, the source tree or what this package brings."""
    package = Path(__file__).resolve().parent
    roots = [Path(given)] if given else [package.parents[1], package / "library"]
    for root in roots:
        if (root / "include" / "labial" / "labial.h").is_file() and (root / "lib" / "stream.c").is_file():
            return root
    where = " and ".join(str(root) for root in roots)
    raise LabialError(f"{where}: not the Labial library, no include/labial/labial.h; name its folder by --library")


def compiler() -> str:
    """The host's C compiler: $CC, cc, gcc or clang."""
    for name in (os.environ.get("LABIAL_CC"), os.environ.get("CC"), "cc", "gcc", "clang"):
        if name and shutil.which(name):
            return name
    raise LabialError("no C compiler found: install one or name it in the environment variable CC")


class NativeModel:
    """An exported model compiled with the library; use it in a ``with`` statement."""

    def __init__(self, model: ExportedModel, library: Optional[str] = None, flags: Sequence[str] = ("-O2",)) -> None:
        self._model = model
        self._root = library_root(library)
        self._flags = list(flags)

    def __enter__(self) -> NativeModel:
        self._folder = tempfile.TemporaryDirectory(prefix="labial-")
        folder = Path(self._folder.name)
        try:
            emit.write(self._model, folder)
            name = self._model.name
            driver = _DRIVER.replace("@", name).replace("WORKSPACE", f"{name.upper()}_WORKSPACE_SIZE")
            (folder / "driver.c").write_text(driver)
            sources = sorted((self._root / "lib").glob("*.c"))
            self._program = folder / "driver"
            includes = [f"-I{self._root / 'include'}", f"-I{folder}"]
            files = [folder / "driver.c", folder / f"{name}.c", *sources]
            command = [compiler(), "-std=c99", *self._flags, *includes, *map(str, files), "-o", str(self._program)]
            done = subprocess.run(command, capture_output=True, text=True)
            if done.returncode:
                raise LabialError(f"the exported model does not compile:\n{done.stderr}")
        except BaseException:
            self._folder.cleanup()
            raise
        return self

    def __exit__(self, *exception: object) -> None:
        self._folder.cleanup()

    def synthesise(self, streams: Sequence[Sequence[Tuple[int, int]]]) -> List[np.ndarray]:
        """The library's frames, (T, 13) int64, of each stream of (phoneme number, milliseconds)."""
        text = "\n".join(f"{len(stream)} " + " ".join(f"{p} {ms}" for p, ms in stream) for stream in streams)
        done = subprocess.run([str(self._program)], input=text.encode(), capture_output=True)
        if done.returncode:
            raise LabialError(f"the library failed: {done.stderr.decode(errors='replace').strip() or done.returncode}")
        frames = np.frombuffer(done.stdout, dtype="=i2").reshape(-1, CHANNELS).astype(np.int64)
        ends = [self._frames(stream) for stream in streams]
        if sum(ends) != len(frames):
            raise LabialError(f"the library delivered {len(frames)} frames, not {sum(ends)}")
        return np.split(frames, np.cumsum(ends)[:-1])

    def _frames(self, stream: Sequence[Tuple[int, int]]) -> int:
        return (sum(ms for _, ms in stream) * self._model.fps + 500) // 1000
