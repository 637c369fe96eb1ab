"""Arrays of NumPy files (.npy, and .npz, a zip of them): of untrusted ones sizes are checked before reading.

The format is that of https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html; objects are not read.
"""

from __future__ import annotations

import io
import json
import math
import os
import zipfile
from contextlib import nullcontext
from typing import Any, BinaryIO, ContextManager, Dict, Iterable, Mapping, Optional, Tuple, Union

import numpy as np

from labial.errors import LabialError, PathLike
from labial.files import limits
from labial.files.outputs import writing

#: Most bytes of an array's header, and most axes.
_LONGEST_HEADER = 10_000
_MOST_AXES = 8


class ArrayError(LabialError):
    """A file's content is damaged, encrypted or too large; the message names the array, not the file."""


def write_model(path: Union[PathLike, BinaryIO], about: Mapping[str, Any],
                arrays: Iterable[Tuple[str, np.ndarray]]) -> None:
    """Writes an .npz with the member ``model.json``, which has `about`, and the arrays by their names, to a path or to
    a file that is open. The same content gives the same bytes: times are fixed, members are in order."""
    opened: ContextManager[Any] = writing(path) if isinstance(path, (str, os.PathLike)) else nullcontext(path)
    with opened as file, zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:

        def add(name: str, data: bytes) -> None:
            info = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
            info.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(info, data, compresslevel=9)

        add("model.json", json.dumps(about, indent=1, sort_keys=True, ensure_ascii=False).encode())
        for name, value in arrays:
            buffer = io.BytesIO()
            np.lib.format.write_array(buffer, np.ascontiguousarray(value), allow_pickle=False)
            add(name + ".npy", buffer.getvalue())


def read_zip(path: PathLike, names: Optional[Iterable[str]], most: int) -> Dict[str, bytes]:
    """Members of a zip file by name: those of `names` that exist, or all of them. Raises OSError for a file that cannot
    be opened; ArrayError for a file that is not a zip, is encrypted or damaged, or whose members, unpacked, exceed
    `most` bytes together, or too many times the size of the file (`limits`)."""
    found: Dict[str, bytes] = {}
    name, wanted = "", None if names is None else set(names)
    with open(path, "rb") as file:
        try:
            with zipfile.ZipFile(file) as archive:
                members = [item for item in archive.infolist() if wanted is None or item.filename in wanted]
                size = sum(item.file_size for item in members)
                most = limits.unpacked(file.seek(0, os.SEEK_END), most)
                if size > most:
                    raise ArrayError(f"unpacked, it has {size:,} bytes, more than the {most:,} that are read")
                for item in members:
                    name = item.filename
                    if item.flag_bits & 1:
                        raise ArrayError(f"{name} is encrypted")
                    if name in found:
                        raise ArrayError(f"{name} is there twice")
                    if item.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):  # others have no limit
                        raise ArrayError(f"{name} is packed by method {item.compress_type}, which is not read")
                    with archive.open(item) as member:
                        found[name] = member.read(item.file_size)  # without a size, as much as there is
                        if len(found[name]) != item.file_size or member.read(1):
                            raise ArrayError(f"{name} is damaged (it has another size than its head says)")
        except ArrayError:
            raise
        except Exception as error:  # any error of zipfile, zlib and others in a damaged file
            raise ArrayError(f"{name or 'the zip file'} is damaged ({' '.join(str(error).split())[:80]})") from None
    return found


def array(name: str, data: bytes) -> np.ndarray:
    """The array of a .npy file with the bytes `data`; raises ArrayError, which calls it `name`, for other data or a
    number of bytes that does not match the shape."""
    try:
        header = io.BytesIO(data[: _LONGEST_HEADER + 12])
        version = np.lib.format.read_magic(header)
        if version not in ((1, 0), (2, 0)):
            raise ArrayError(f"{name} has version {version} of the format, which is not read")
        length = int.from_bytes(data[8 : 10 if version == (1, 0) else 12], "little")
        if length > _LONGEST_HEADER:
            raise ArrayError(f"{name} has a description of {length} bytes")
        read = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
        shape, fortran, kind = read(header)
    except ArrayError:
        raise
    except Exception as error:  # the header is text that Python parses
        raise ArrayError(f"{name} is no array ({type(error).__name__})") from None
    if kind.kind not in "biuf" or len(shape) > _MOST_AXES or any(size < 0 for size in shape):
        raise ArrayError(f"{name} has the type {kind} and the shape {shape}, not real numbers")
    content = memoryview(data)[header.tell() :]
    if math.prod(shape) * kind.itemsize != len(content):
        raise ArrayError(f"{name} has {len(content)} bytes, not those of its shape {shape}")
    return np.frombuffer(content, dtype=kind).reshape(shape, order="F" if fortran else "C")
