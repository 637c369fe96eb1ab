"""Avatars' files, .glb, .gltf and .vrm: the meshes that have shapes, as they rest in the bind pose.

pygltflib reads the container; this module decodes the accessors. Files are not trusted: any inconsistency is a
DataError.
"""

from __future__ import annotations

import base64
import binascii
import os
import warnings
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Dict, List, Mapping, Sequence, Tuple, Union

import numpy as np

from labial.errors import DataError, needs

_TYPES = {5120: "i1", 5121: "u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_SIZES = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
#: Extensions that change neither where vertices lie nor how they are written down, as far as they are read here.
_HARMLESS = ("KHR_mesh_quantization", "KHR_texture_", "KHR_materials_", "EXT_texture_", "MSFT_texture_", "VRM",
             "KHR_lights_", "KHR_xmp")
_COMPRESSED = ("KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression")
#: VRM 0's names of the five mouths, and VRM 1's.
_VRM = {"a": "aa", "i": "ih", "u": "ou", "e": "ee", "o": "oh"}


@dataclass(frozen=True)
class Mesh:
    """A mesh with shapes, in the file's unit, y up, facing z, its left towards x."""

    name: str
    vertices: np.ndarray  #: (V, 3)
    triangles: np.ndarray  #: (F, 3) of vertex numbers
    shapes: Mapping[str, np.ndarray]  #: (V, 3) that weight 1 adds
    #: Of the shapes that are VRM's expressions: the mesh's own shapes that each is made of, with their shares.
    parts: Mapping[str, Sequence[Tuple[str, float]]] = field(default_factory=dict)


def read(path: Union[str, os.PathLike[str]]) -> List[Mesh]:
    """The meshes of a file that have shapes. A .vrm file's expressions aa, ih, ou, ee, oh are shapes of the mesh that
    they move, beside the mesh's own. Raises DataError for other files, compressed files, and files without shapes;
    LabialError if pygltflib is missing."""
    with needs("reading avatars", "fit"):
        import pygltflib

    where = os.fspath(path)
    if not os.path.isfile(where):
        raise DataError(where, None, "no such file")
    try:
        with open(where, "rb") as opened:
            binary = opened.read(4) == b"glTF"  # whatever the file is called
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # about chunks that it does not know
            file = pygltflib.GLTF2.load_binary(where) if binary else pygltflib.GLTF2.load_json(where)
        if file is None:
            raise ValueError("no glTF")
        _check(where, file)
        meshes = _Reader(file, Path(where)).meshes()
    except DataError:
        raise
    except Exception as error:  # any error of pygltflib and numpy on a broken file
        raise DataError(where, None, f"is not a whole .glb, .gltf or .vrm file ({error or type(error).__name__})"
                        ) from None
    if not meshes:
        raise DataError(where, None, "has no mesh with shapes (morph targets)")
    return meshes


def _check(where: str, file: Any) -> None:
    required = list(file.extensionsRequired or [])
    packed = [name for name in required if name in _COMPRESSED]
    if packed:
        stem = Path(where)
        raise DataError(where, None, f"its meshes are compressed ({', '.join(packed)}); unpack them first: "
                        f"npx @gltf-transform/cli copy {stem.name} {stem.stem}-plain{stem.suffix}")
    strange = [name for name in required if not name.startswith(_HARMLESS)]
    if strange:
        raise DataError(where, None, f"needs extensions that are not known here: {', '.join(strange)}")


class _Reader:
    """A file that is being read."""

    def __init__(self, file: Any, path: Path) -> None:
        self.file, self.path = file, path
        self.buffers: Dict[int, bytes] = {}
        self.parents = {child: number for number, node in enumerate(file.nodes) for child in node.children or []}

    def buffer(self, number: int) -> bytes:
        if number not in self.buffers:
            uri = self.file.buffers[number].uri
            if not uri:
                data = self.file.binary_blob()
                if data is None:
                    raise ValueError("the binary part is missing")
            elif uri.startswith("data:"):
                try:
                    data = base64.b64decode(uri.split(",", 1)[1], validate=True)
                except (IndexError, binascii.Error):
                    raise ValueError(f"buffer {number} is no base64") from None
            else:
                beside = (self.path.parent / uri).resolve()
                if self.path.parent.resolve() not in beside.parents:
                    raise ValueError(f"buffer {number} lies outside the file's folder")
                data = beside.read_bytes()
            self.buffers[number] = data
        return self.buffers[number]

    def view(self, number: int, offset: int, kind: str, width: int, count: int) -> np.ndarray:
        view = self.file.bufferViews[number]
        data = self.buffer(view.buffer)
        item = np.dtype(kind)
        stride = view.byteStride or item.itemsize * width
        begin = (view.byteOffset or 0) + offset
        if count < 0 or begin < 0 or stride < item.itemsize * width or (
                count and begin + (count - 1) * stride + item.itemsize * width > len(data)):
            raise ValueError(f"buffer view {number} goes beyond its buffer")
        raw = np.frombuffer(data, np.uint8)
        rows = np.lib.stride_tricks.as_strided(raw[begin:], (count, item.itemsize * width), (stride, 1))
        return np.ascontiguousarray(rows).view(item).reshape(count, width)

    def accessor(self, number: int) -> np.ndarray:
        """(N, width) float64."""
        found = self.file.accessors[number]
        kind, width = _TYPES[found.componentType], _SIZES[found.type]
        if not 0 <= found.count <= 1 << 24:
            raise ValueError(f"accessor {number} has {found.count} items")
        if found.bufferView is None:
            values = np.zeros((found.count, width), kind)
        else:
            values = self.view(found.bufferView, found.byteOffset or 0, kind, width, found.count)
        sparse = found.sparse
        if sparse is not None and sparse.count:
            at = self.view(sparse.indices.bufferView, sparse.indices.byteOffset or 0,
                           _TYPES[sparse.indices.componentType], 1, sparse.count)[:, 0]
            values = values.copy()
            values[at] = self.view(sparse.values.bufferView, sparse.values.byteOffset or 0, kind, width, sparse.count)
        out = values.astype(np.float64)
        if found.normalized and values.dtype.kind in "iu":
            out = np.maximum(out / np.iinfo(values.dtype).max, -1.0)
        if not np.isfinite(out).all():
            raise ValueError(f"accessor {number} has values that are not finite")
        return out

    def transform(self, number: int) -> np.ndarray:
        """(4, 4) from a node to the world."""
        total, steps = np.eye(4), 0
        place: Any = number
        while place is not None:
            total = _local(self.file.nodes[place]) @ total
            place, steps = self.parents.get(place), steps + 1
            if steps > len(self.file.nodes):
                raise ValueError("the nodes are no tree")
        return total

    def meshes(self) -> List[Mesh]:
        extensions = self.file.extensions or {}
        rotation = np.diag([-1.0, 1.0, -1.0]) if "VRM" in extensions else np.eye(3)  # VRM 0 faces away from z
        found = []
        for number, node in enumerate(self.file.nodes):
            if node.mesh is None:
                continue
            # A skinned mesh ignores its node; it is taken to be bound in the pose in which it was modelled.
            world = np.eye(4) if node.skin is not None else self.transform(number)
            mesh = self.mesh(node.mesh, node.name, rotation @ world[:3, :3], rotation @ world[:3, 3])
            if mesh is not None:
                whole, moves = mesh
                names, binds = list(whole.shapes), self.mouths(number, node.mesh)
                mouths = {name: sum(weight * moves[index] for index, weight in parts) for name, parts in binds.items()}
                own = {name: [(names[index], weight) for index, weight in parts] for name, parts in binds.items()}
                found.append(Mesh(whole.name, whole.vertices, whole.triangles, {**whole.shapes, **mouths}, own))
        return found

    def mesh(self, number: int, node_name: Any, rotation: np.ndarray, move: np.ndarray) -> Any:
        mesh = self.file.meshes[number]
        parts = [part for part in mesh.primitives if part.targets and (part.mode is None or part.mode == 4)]
        if not parts:
            return None
        names = (mesh.extras or {}).get("targetNames") or (parts[0].extras or {}).get("targetNames")
        count = len(parts[0].targets)
        if names is None or len(names) != count or not all(isinstance(name, str) for name in names):
            names = [f"shape_{place}" for place in range(count)]
        vertices, triangles, first = [], [], 0
        moves: List[List[np.ndarray]] = [[] for _ in range(count)]
        for part in parts:
            if len(part.targets) != count:
                raise ValueError(f"the parts of mesh {number} differ in their shapes")
            own = self.accessor(part.attributes.POSITION)
            faces = (self.accessor(part.indices).astype(np.int64).reshape(-1) if part.indices is not None
                     else np.arange(len(own)))
            if own.shape[1] != 3 or len(faces) % 3 or (len(faces) and (faces.min() < 0 or faces.max() >= len(own))):
                raise ValueError(f"the triangles of mesh {number} are broken")
            vertices.append(own)
            triangles.append(faces.reshape(-1, 3) + first)
            first += len(own)
            for place, target in enumerate(part.targets):
                at = target.get("POSITION") if isinstance(target, dict) else getattr(target, "POSITION", None)
                added = np.zeros_like(own) if at is None else self.accessor(at)
                if added.shape != own.shape:
                    raise ValueError(f"shape {names[place]!r} of mesh {number} has another size than the mesh")
                moves[place].append(added)
        whole = [np.concatenate(part) @ rotation.T for part in moves]
        name = str(node_name or mesh.name or f"mesh_{number}")
        return (Mesh(name, np.concatenate(vertices) @ rotation.T + move, np.concatenate(triangles),
                     dict(zip(names, whole))), whole)

    def mouths(self, node: int, mesh: int) -> Dict[str, List[Tuple[int, float]]]:
        """VRM's five mouths, of either version, as far as this mesh has a part in them: its shapes by number, and their
        shares."""
        extensions = self.file.extensions or {}
        binds: Dict[str, List[Tuple[int, float]]] = {}
        for group in ((extensions.get("VRM") or {}).get("blendShapeMaster") or {}).get("blendShapeGroups") or []:
            name = _VRM.get(str(group.get("presetName", "")).lower())
            if name:
                binds[name] = [(int(bind["index"]), float(bind.get("weight", 100.0)) / 100.0)
                               for bind in group.get("binds") or [] if bind.get("mesh") == mesh]
        preset = ((extensions.get("VRMC_vrm") or {}).get("expressions") or {}).get("preset") or {}
        for name in _VRM.values():
            if name in preset:
                binds[name] = [(int(bind["index"]), float(bind.get("weight", 1.0)))
                               for bind in preset[name].get("morphTargetBinds") or [] if bind.get("node") == node]
        return {name: parts for name, parts in binds.items() if parts}


def _local(node: Any) -> np.ndarray:
    if node.matrix is not None:
        return np.array(node.matrix, dtype=np.float64).reshape(4, 4).T
    out = np.eye(4)
    x, y, z, w = node.rotation or (0.0, 0.0, 0.0, 1.0)
    out[:3, :3] = np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]) * np.array(node.scale or (1.0, 1.0, 1.0))
    out[:3, 3] = node.translation or (0.0, 0.0, 0.0)
    return out
