"""Avatars: the meshes of a .glb, .gltf or .vrm file that have shapes, as they rest in the bind pose."""

from __future__ import annotations

import os
import shlex
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Dict, List, Mapping, Sequence, Tuple

import numpy as np

from labial.errors import DataError, PathLike
from labial.files import limits
from labial.fit.gltf import Gltf, objects

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


def read(path: PathLike, everything: bool = False) -> List[Mesh]:
    """The meshes of a file that have shapes, each once, at the first node that has it. A .vrm file's expressions aa,
    ih, ou, ee, oh are shapes of the mesh that they move, beside the mesh's own. Raises DataError for other files,
    compressed files, files without shapes, and files beyond the limits of :mod:`labial.files.limits`; with `everything`
    these hold for all that a program decodes which shows the file."""
    where = os.fspath(path)
    try:
        file = Gltf(path, everything)
        _check(where, file)
        meshes = _meshes(where, file)
    except (DataError, MemoryError):
        raise
    except Exception as error:  # any error of Python and numpy on malformed content
        detail = " ".join(str(error).split())[:80] or type(error).__name__
        if isinstance(error, (KeyError, IndexError, TypeError, AttributeError)):
            detail = f"{type(error).__name__}: {detail}"
        raise DataError(where, None, f"is not a whole .glb, .gltf or .vrm file ({detail})") from None
    if not meshes:
        raise DataError(where, None, "has no mesh with shapes (morph targets)")
    return meshes


def _check(where: str, file: Gltf) -> None:
    required = [str(name) for name in file.document.get("extensionsRequired") or []]
    packed = [name for name in required if name in _COMPRESSED]
    if packed:
        path = Path(where)
        copy = shlex.join([str(path), str(path.with_name(f"{path.stem}-plain{path.suffix}"))])
        raise DataError(where, None, f"its meshes are compressed ({', '.join(packed)}); unpack them first: "
                        f"npx @gltf-transform/cli copy {copy}")
    strange = [name for name in required if not name.startswith(_HARMLESS)]
    if strange:
        raise DataError(where, None, f"needs extensions that are not known here: {', '.join(strange)}")


def _meshes(where: str, file: Gltf) -> List[Mesh]:
    extensions = file.document.get("extensions") or {}
    turn = np.diag([-1.0, 1.0, -1.0]) if "VRM" in extensions else np.eye(3)  # VRM 0 faces away from z
    nodes: Dict[int, List[int]] = {}
    for number, node in enumerate(file.nodes):
        if node.get("mesh") is not None:
            nodes.setdefault(node["mesh"], []).append(number)
    moving = [number for number in nodes if _parts(file, number)]
    limits.refuse(where, "it has", len(moving), limits.AVATAR_MESHES, "meshes with shapes")
    found = []
    for number in moving:
        node = file.nodes[nodes[number][0]]
        # A skinned mesh ignores its node; assume that it is bound in the pose in which it was modelled.
        world = np.eye(4) if node.get("skin") is not None else file.transform(nodes[number][0])
        mesh = _mesh(where, file, number, str(node.get("name") or file.meshes[number].get("name") or f"mesh_{number}"),
                     turn @ world[:3, :3], turn @ world[:3, 3])
        names, mouths = list(mesh.shapes), _mouths(extensions, number, nodes[number])
        own = {mouth: [(names[index], share) for index, share in parts.items()] for mouth, parts in mouths.items()}
        made = {mouth: _mixed(mesh, parts) for mouth, parts in own.items()}
        found.append(Mesh(mesh.name, mesh.vertices, mesh.triangles, {**mesh.shapes, **made}, own))
    return found


def _parts(file: Gltf, number: int) -> List[Dict[str, Any]]:
    """The parts of a mesh that have shapes and triangles."""
    return [part for part in objects(file.meshes[number], "primitives")
            if part.get("targets") and part.get("mode") in (None, 4)]


def _mesh(where: str, file: Gltf, number: int, name: str, rotation: np.ndarray, move: np.ndarray) -> Mesh:
    parts, mesh = _parts(file, number), file.meshes[number]
    names = _names(mesh, parts)
    vertices, triangles, first = [], [], 0
    for part in parts:
        if len(objects(part, "targets")) != len(names):
            raise ValueError(f"the parts of mesh {number} differ in their shapes")
        own = file.vectors(part["attributes"]["POSITION"])
        faces = file.indices(part["indices"]) if part.get("indices") is not None else np.arange(len(own))
        if len(faces) % 3 or (len(faces) and faces.max() >= len(own)):
            raise ValueError(f"the triangles of mesh {number} are broken")
        vertices.append(own)
        triangles.append(faces.reshape(-1, 3).astype(np.int32) + first)
        first += len(own)
    for size, most, unit in ((len(names), limits.AVATAR_SHAPES, "shapes"), (first, limits.AVATAR_VERTICES, "vertices"),
                             (sum(map(len, triangles)), limits.AVATAR_TRIANGLES, "triangles")):
        limits.refuse(where, f"the mesh {name[:60]!r} has", size, most, unit)

    def shape(place: int) -> np.ndarray:
        """(V, 3) float32: what this shape adds."""
        added = []
        for part, own in zip(parts, vertices):
            at = part["targets"][place].get("POSITION")
            added.append(np.zeros_like(own) if at is None else file.vectors(at))
            if added[-1].shape != own.shape:
                raise ValueError(f"shape {names[place]!r} of mesh {number} has another size than the mesh")
        return _placed(np.concatenate(added), rotation, np.zeros(3)).astype(np.float32)

    shapes = {shape_name: shape(place) for place, shape_name in enumerate(names)}
    return Mesh(name, _placed(np.concatenate(vertices), rotation, move), np.concatenate(triangles), shapes)


def _placed(points: np.ndarray, rotation: np.ndarray, move: np.ndarray) -> np.ndarray:
    result: np.ndarray = points @ rotation.T + move
    if not (np.abs(result) <= limits.AVATAR_COORDINATE).all():
        raise ValueError(f"a coordinate is beyond {limits.AVATAR_COORDINATE:g}")
    return result


def _names(mesh: Dict[str, Any], parts: List[Dict[str, Any]]) -> List[str]:
    """The names of a mesh's shapes; a name that is there twice gets its number, too."""
    count = len(parts[0]["targets"])
    names = (mesh.get("extras") or {}).get("targetNames") or (parts[0].get("extras") or {}).get("targetNames")
    if names is None or len(names) != count or not all(isinstance(name, str) for name in names):
        return [f"shape_{place}" for place in range(count)]
    first = {name: place for place, name in reversed(list(enumerate(names)))}
    return [name if first[name] == place else f"{name}_{place}" for place, name in enumerate(names)]


def _mouths(extensions: Dict[str, Any], mesh: int, nodes: Sequence[int]) -> Dict[str, Dict[int, float]]:
    """VRM's five mouths, of either version, as far as this mesh has a part in them: shares by the shapes' numbers."""
    mouths: Dict[str, Dict[int, float]] = {}

    def add(mouth: str, bind: Dict[str, Any], weight: float) -> None:
        shares = mouths.setdefault(mouth, {})
        index = int(bind["index"])
        shares[index] = shares.get(index, 0.0) + weight

    for group in objects((extensions.get("VRM") or {}).get("blendShapeMaster") or {}, "blendShapeGroups"):
        name = _VRM.get(str(group.get("presetName", "")).lower())
        if name:
            mouths.pop(name, None)
            for bind in objects(group, "binds"):
                if bind.get("mesh") == mesh:
                    add(name, bind, float(bind.get("weight", 100.0)) / 100.0)
    preset = ((extensions.get("VRMC_vrm") or {}).get("expressions") or {}).get("preset") or {}
    for name in _VRM.values():
        if name in preset:
            mouths.pop(name, None)
            for bind in objects(preset[name], "morphTargetBinds"):
                if bind.get("node") in nodes:
                    add(name, bind, float(bind.get("weight", 1.0)))
    return mouths


def _mixed(mesh: Mesh, parts: Sequence[Tuple[str, float]]) -> np.ndarray:
    """(V, 3) that shares of the mesh's own shapes add."""
    total = sum((share * mesh.shapes[name] for name, share in parts), np.zeros_like(mesh.vertices))
    return _placed(total, np.eye(3), np.zeros(3)).astype(np.float32)
