"""How much of a file from a stranger is read. A larger one is refused before memory is allocated for it.

The limits bound what a small file can ask for: an archive is unpacked to at most `SPARE` bytes and `RATIO` times its
own size, an avatar's accessors to `AVATAR_UNPACKED` bytes however few bytes describe them. SECURITY.md lists the limits
by kind of file.
"""

from __future__ import annotations

import os

from labial.errors import DataError, PathLike

#: Most bytes of a text file: timings, frames, tables; of a TOML file; of a binary model for the run-time.
TEXT = 256_000_000
TOML = 1_000_000
BLOB = 64_000_000
#: Most bytes of what an archive (.npz, .zip) holds, unpacked: of a model, of tables of words, of a model of hearing, of
#: landmarks, of a corpus's files.
MODEL = 64_000_000
WORDS = 16_000_000
HEARING = 4_000_000
LANDMARKS = 1_000_000_000
CORPUS = 512_000_000
#: An archive holds at most `SPARE` bytes and `RATIO` bytes per byte of its file. Frames and models are at most a tenth
#: of their size when packed; a file of zeros is a thousandth.
SPARE, RATIO = 16_000_000, 20
#: Most bytes of an avatar's file, its buffers included, and of what its accessors have unpacked, as floats and vertex
#: numbers of 4 bytes, each as often as it is used.
AVATAR = 256_000_000
AVATAR_UNPACKED = 160_000_000
#: Most values of its JSON, lists and objects included.
AVATAR_VALUES = 5_000_000
#: Most nodes, levels of nodes, and meshes with shapes; shapes, vertices and triangles of a mesh.
AVATAR_NODES, AVATAR_LEVELS, AVATAR_MESHES = 20_000, 200, 200
AVATAR_SHAPES, AVATAR_VERTICES, AVATAR_TRIANGLES = 1_000, 1_000_000, 500_000
#: Largest coordinate of a vertex, in the file's unit.
AVATAR_COORDINATE = 1e6
#: Most outputs of a rig, and of one that is drawn.
OUTPUTS, DRAWN = 256, 64
#: Most bytes of a sound, or of an avatar, in a page: there it is a third longer, and Firefox stops at 32 MB.
PAGE = 24_000_000
#: Most bytes of a sound's samples, of 16 bits or floats: hours. A sound has at most `SPARE` bytes of them, and
#: `SOUND_RATIO` per byte of its file: four times as many as the best coder of speech makes of it.
SOUND, SOUND_RATIO = 1_000_000_000, 100
#: Samples per second, and channels, of a sound that is read.
SOUND_RATES, SOUND_CHANNELS = (1_000, 768_000), 64
#: Largest sample of a sound of floats; full scale is 1.
SOUND_PEAK = 1e6
#: Of a service's message: levels of lists and objects, documents in it, items that it times, fields of an object of a
#: client library; characters of a text, also of one that `labial say` says. The services' table has the same limits for
#: JavaScript.
MESSAGE_NESTING, MESSAGE_DOCUMENTS, MESSAGE_ITEMS, MESSAGE_FIELDS, MESSAGE_TEXT = 64, 10_000, 10_000, 200, 1_000
#: Bytes of a phoneme's label that are read, as in C (LABIAL_NAME_MAX).
LABEL = 64


def refuse(path: PathLike, what: str, size: float, most: float, unit: str = "bytes") -> None:
    """Raises DataError if `size` is beyond `most`; its sentence begins with `what`, such as "it has"."""
    if not size <= most:
        raise DataError(path, None, f"{what} {size:,.0f} {unit}, more than the {most:,.0f} that are read")


class Samples:
    """Counts the samples of a sound while it is read."""

    def __init__(self, path: PathLike, rate: int) -> None:
        """Of floats of 4 bytes, `rate` per second."""
        self._path, self._rate, self._count = path, rate, 0
        self._most = unpacked(os.path.getsize(path), SOUND, SOUND_RATIO) // 4

    def add(self, count: int) -> None:
        """Raises DataError where the samples are too many for the size of the file."""
        self._count += count
        if self._count > self._most:
            refuse(self._path, "it lasts at least", self._count / self._rate, self._most / self._rate, "seconds")


def unpacked(packed: int, most: int, ratio: int = RATIO) -> int:
    """Most bytes that a file of `packed` bytes may hold, where `most` is the limit of its kind."""
    return min(most, SPARE + ratio * packed)
