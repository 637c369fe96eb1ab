"""glTF 2.0 files, .glb, .gltf and .vrm: the document, its nodes and its accessors.

Files are not trusted. `Gltf` checks, before it decodes anything, that the nodes are trees and that what will be decoded
is within :mod:`labial.files.limits`. It raises DataError for what is too large, and ValueError and others for what is
malformed otherwise.
"""

from __future__ import annotations

import base64
import binascii
import functools
import json
import math
import struct
from itertools import chain
from pathlib import Path
from typing import Any, Dict, Iterator, List, NoReturn, Optional, Tuple

import numpy as np

from labial.errors import PathLike
from labial.files import limits
from labial.files.grammar import read_bytes

_TYPES = {5120: "i1", 5121: "u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_SIZES = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
#: Bytes of a number as it is decoded.
_DECODED = 4


class Gltf:
    """A file.

    Attributes:
        document: its JSON. content: the bytes of the file. nodes, meshes: the document's lists of them.
    """

    def __init__(self, path: PathLike, everything: bool = False) -> None:
        """Reads a file. The limit holds for the shapes, vertices and triangles of the meshes that have shapes; with
        `everything` for all that a program decodes which shows the file."""
        self._path = Path(path)
        self.content = read_bytes(path, limits.AVATAR)
        text, self._binary = _parts(self.content)
        limits.refuse(path, "its JSON has", sum(map(text.count, (b",", b"[", b"{"))), limits.AVATAR_VALUES, "values")
        self.document: Dict[str, Any] = _parsed(text)
        self._objects = functools.partial(objects, self.document)
        self.nodes, self.meshes = self._objects("nodes"), self._objects("meshes")
        self._accessors, self._views = self._objects("accessors"), self._objects("bufferViews")
        self._buffers: Dict[int, bytes] = {}
        self._read = len(self.content)
        self._transforms: Dict[int, np.ndarray] = {}
        limits.refuse(path, "it has", len(self.nodes), limits.AVATAR_NODES, "nodes")
        self._parents = self._tree()
        uses = chain(self._uses_of_shapes(), self._all_uses() if everything else ())
        size = sum(self._count(number) * self._width(number) for number in uses) * _DECODED
        limits.refuse(path, "its accessors unpack to", size, limits.AVATAR_UNPACKED)

    def _tree(self) -> Dict[int, int]:
        """The parent of each node that has one. Raises ValueError unless the nodes are trees."""
        parents: Dict[int, int] = {}
        for number, node in enumerate(self.nodes):
            for child in node.get("children") or []:
                if child in parents or not 0 <= child < len(self.nodes):
                    raise ValueError("the nodes are no tree")
                parents[child] = number
        levels = {number: 1 for number in range(len(self.nodes)) if number not in parents}
        waiting = list(levels)
        for number in waiting:  # which grows
            for child in self.nodes[number].get("children") or []:
                levels[child] = levels[number] + 1
                waiting.append(child)
        if len(levels) < len(self.nodes):
            raise ValueError("the nodes are no tree")
        limits.refuse(self._path, "its nodes are nested in", max(levels.values(), default=0), limits.AVATAR_LEVELS,
                      "levels")
        return parents

    def transform(self, number: int) -> np.ndarray:
        """(4, 4) from a node to the world."""
        if number not in self._transforms:
            own = _local(self.nodes[number])
            if number in self._parents:
                own = self.transform(self._parents[number]) @ own  # as deep as the limit of levels
            if not np.isfinite(own).all():
                raise ValueError(f"the place of node {number} is not finite")
            self._transforms[number] = own
        return self._transforms[number]

    def _count(self, number: int) -> int:
        count = self._accessors[number]["count"]
        if type(count) is not int or count < 0:
            raise ValueError(f"accessor {number} has {count} items")
        return count

    def _width(self, number: int) -> int:
        return _SIZES[self._accessors[number]["type"]]

    def _uses_of_shapes(self) -> Iterator[int]:
        """The accessors of which :mod:`labial.fit.avatar` makes arrays, each as often as it does, and twice where the
        array has 8 bytes a number. A shape without vertices counts like one that moves all of them."""
        made = 2 + 5 * any(name in (self.document.get("extensions") or {}) for name in ("VRM", "VRMC_vrm"))
        for mesh in self.meshes:
            for part in objects(mesh, "primitives"):
                shapes = part.get("targets") or []
                if shapes:
                    yield from [part["attributes"]["POSITION"]] * made  # the vertices, and VRM's mouths
                    if part.get("indices") is not None:
                        yield part["indices"]
                    for shape in shapes:
                        given = shape.get("POSITION")
                        yield part["attributes"]["POSITION"] if given is None else given

    def _all_uses(self) -> Iterator[int]:
        """Every accessor as often as something refers to it."""
        for mesh in self.meshes:
            for part in objects(mesh, "primitives"):
                for values in (part["attributes"], *(part.get("targets") or [])):
                    yield from values.values()
                if part.get("indices") is not None:
                    yield part["indices"]
        skins = self._objects("skins")
        for node in self.nodes:
            if node.get("skin") is not None and skins[node["skin"]].get("inverseBindMatrices") is not None:
                yield skins[node["skin"]]["inverseBindMatrices"]
        for animation in self._objects("animations"):
            samplers = objects(animation, "samplers")
            for channel in objects(animation, "channels"):
                yield samplers[channel["sampler"]]["input"]
                yield samplers[channel["sampler"]]["output"]

    def indices(self, number: int) -> np.ndarray:
        """(N,) of an accessor of whole numbers, unsigned."""
        values = self._values(number)
        if values.shape[1] != 1 or values.dtype.kind != "u":
            raise ValueError(f"accessor {number} has no vertex numbers")
        return values[:, 0]

    def vectors(self, number: int) -> np.ndarray:
        """(N, 3) float64 of an accessor of vectors."""
        values = self._values(number)
        if values.shape[1] != 3:
            raise ValueError(f"accessor {number} has no vectors")
        out = values.astype(np.float64)
        if self._accessors[number].get("normalized") and values.dtype.kind in "iu":
            out = np.maximum(out / np.iinfo(values.dtype).max, -1.0)
        if not np.isfinite(out).all():
            raise ValueError(f"accessor {number} has values that are not finite")
        return out

    def _values(self, number: int) -> np.ndarray:
        """(N, width) as the file has them."""
        found, count, width = self._accessors[number], self._count(number), self._width(number)
        kind = _TYPES[found["componentType"]]
        if found.get("bufferView") is None:
            values = np.zeros((count, width), kind)
        else:
            values = self._view(found, kind, width, count)
        sparse = found.get("sparse")
        if sparse and sparse["count"]:
            where = sparse["indices"]
            if sparse["count"] > count:
                raise ValueError(f"accessor {number} changes {sparse['count']} of {count} items")
            at = self._view(where, _TYPES[where["componentType"]], 1, sparse["count"])[:, 0]
            values = values.copy()
            values[at] = self._view(sparse["values"], kind, width, sparse["count"])
        return values

    def _view(self, of: Dict[str, Any], kind: str, width: int, count: int) -> np.ndarray:
        """(`count`, `width`) from the place in a buffer view that `of` tells."""
        number, offset = of["bufferView"], of.get("byteOffset") or 0
        view = self._views[number]
        data = self._buffer(view["buffer"])
        item = np.dtype(kind)
        size = item.itemsize * width
        stride = view.get("byteStride") or size
        begin = (view.get("byteOffset") or 0) + offset
        if begin < 0 or stride < size or (count and begin + (count - 1) * stride + size > len(data)):
            raise ValueError(f"buffer view {number} goes beyond its buffer")
        rows = np.lib.stride_tricks.as_strided(np.frombuffer(data, np.uint8)[begin:], (count, size), (stride, 1))
        return np.ascontiguousarray(rows).view(item).reshape(count, width)

    def _buffer(self, number: int) -> bytes:
        if number not in self._buffers:
            self._buffers[number] = self._content_of(number, self._objects("buffers")[number].get("uri"))
        return self._buffers[number]

    def _content_of(self, number: int, uri: Optional[str]) -> bytes:
        if not uri:
            if self._binary is None:
                raise ValueError("the binary part is missing")
            return self._binary
        if uri.startswith("data:"):
            try:
                return base64.b64decode(uri.split(",", 1)[1], validate=True)
            except (IndexError, binascii.Error):
                raise ValueError(f"buffer {number} is no base64") from None
        beside: Path = (self._path.parent / uri).resolve()
        if self._path.parent.resolve() not in beside.parents:
            raise ValueError(f"buffer {number} lies outside the file's folder")
        if not beside.is_file():
            raise ValueError(f"buffer {number} is no file")
        self._read += beside.stat().st_size
        limits.refuse(self._path, "it and its buffers have", self._read, limits.AVATAR)
        return beside.read_bytes()


def objects(of: Dict[str, Any], key: str) -> List[Dict[str, Any]]:
    """The list of objects that `of` has by this key; an empty one without it. Raises ValueError for anything else."""
    found = of.get(key) or []
    if not isinstance(found, list) or not all(isinstance(item, dict) for item in found):
        raise ValueError(f"{key} is not a list of objects")
    return found


def _parts(data: bytes) -> Tuple[bytes, Optional[bytes]]:
    """The JSON, and the binary part of a .glb or None."""
    if data[:4] != b"glTF":  # whatever the file is called
        if data.startswith(b"version https://git-lfs"):
            raise ValueError("it is a pointer of Git LFS: git lfs pull fetches the file")
        if not data.lstrip(b"\xef\xbb\xbf \t\r\n").startswith((b"{", b"[")):
            raise ValueError("it begins neither with glTF nor with JSON")
        return data, None
    _, version, _ = struct.unpack("<4sII", data[:12])
    if version != 2:
        raise ValueError(f"version {version} of glTF is not read")
    chunks: Dict[bytes, bytes] = {}
    at = 12
    while at + 8 <= len(data):
        size, kind = struct.unpack("<I4s", data[at : at + 8])
        if at + 8 + size > len(data):
            raise ValueError("the file ends within a part")
        if kind in (b"JSON", b"BIN\0"):
            chunks.setdefault(kind, data[at + 8 : at + 8 + size])
        at += 8 + size
    return chunks[b"JSON"], chunks.get(b"BIN\0")


def _parsed(text: bytes) -> Dict[str, Any]:
    def refused(name: str) -> NoReturn:
        raise ValueError(f"{name} is no number of JSON")

    try:
        document = json.loads(text.decode("utf-8-sig"), parse_constant=refused)
    except RecursionError:
        raise ValueError("its JSON is nested too deeply") from None
    if not isinstance(document, dict):
        raise ValueError("no glTF")
    return document


def _local(node: Dict[str, Any]) -> np.ndarray:
    """(4, 4) from a node to its parent."""
    if node.get("matrix") is not None:
        return np.array(_numbers(node["matrix"], 16)).reshape(4, 4).T
    out = np.eye(4)
    x, y, z, w = _numbers(node.get("rotation") or (0.0, 0.0, 0.0, 1.0), 4)
    out[:3, :3] = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                            [2 * (x * z - y * w), 2 * (y * z + x * w),
                             1 - 2 * (x * x + y * y)]]) * np.array(_numbers(node.get("scale") or (1.0, 1.0, 1.0), 3))
    out[:3, 3] = _numbers(node.get("translation") or (0.0, 0.0, 0.0), 3)
    return out


def _numbers(given: Any, count: int) -> List[float]:
    """`count` numbers whose products are finite."""
    values = [float(value) for value in given]
    if len(values) != count or not all(math.isfinite(value) and abs(value) <= 1e30 for value in values):
        raise ValueError("the place of a node is not finite")
    return values
