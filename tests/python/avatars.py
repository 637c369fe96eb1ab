"""A head made by hand, and .glb files written by hand: a writer that knows nothing of the reader.

The face is a sheet in millimetres, y up, facing z: a bowl with a nose, two lips and a chin. Its seam lies at y = 0 and
ends in corners at x = -25 and 25, where the upper and the lower half are one.
"""

from __future__ import annotations

import json
import struct
from typing import Dict, List, Mapping, Optional, Tuple

import numpy as np

#: Where the points of the made head are, mm.
TRUE = {"inner_upper": (0.0, 0.3), "inner_lower": (0.0, -0.3), "corner_left": (25.0, 0.0),
        "corner_right": (-25.0, 0.0), "outer_upper": (0.0, 7.0), "outer_lower": (0.0, -8.0), "nose": (0.0, 20.0)}


def _bump(value: np.ndarray, middle: float, width: float) -> np.ndarray:
    return np.exp(-(((value - middle) / width) ** 2))


def _depth(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    lips = np.clip(1.0 - (x / 26.0) ** 2, 0.0, 1.0)
    nose = np.clip((y - 19.0) / 4.0, 0.0, 1.0) * np.clip((48.0 - y) / 20.0, 0.0, 1.0) * _bump(x, 0.0, 9.0)
    return (90.0 - 0.008 * x * x - 0.002 * (y - 10.0) ** 2 + 6.0 * lips * _bump(y, 7.0, 4.5)
            + 6.0 * lips * _bump(y, -8.0, 4.5) + 16.0 * nose + 7.0 * _bump(y, -38.0, 11.0) * _bump(x, 0.0, 16.0)
            - np.clip(-46.0 - y, 0.0, None) * 2.0)


def made_head(prefix: str = "", mouth: str = "arkit") -> Tuple[np.ndarray, np.ndarray, Dict[str, np.ndarray]]:
    """Vertices (V, 3) and triangles (F, 3) in millimetres, and the shapes, with `prefix` before their names: ARKit's,
    or `mouth` ``vrm`` for VRM's five."""
    xs = np.linspace(-60.0, 60.0, 49)
    halves: List[np.ndarray] = []
    for sign in (1.0, -1.0):
        ys = sign * np.concatenate([[0.3], np.linspace(1.5, 24.0, 16), np.linspace(26.0, 64.0, 20)])
        x, y = np.meshgrid(xs, ys, indexing="ij")
        y = np.where((np.abs(y) < 0.5) & (np.abs(x) > 24.9), 0.0, y)
        halves.append(np.stack([x, y, _depth(x, y)], axis=2))
    upper, lower = (half.reshape(-1, 3) for half in halves)
    vertices = np.concatenate([upper, lower])
    rows, columns = halves[0].shape[1], len(xs)
    triangles = []
    for first, turn in ((0, 1), (len(upper), -1)):
        for i in range(columns - 1):
            for j in range(rows - 1):
                a, b, c, d = (first + (i + p) * rows + j + q for p, q in ((0, 0), (1, 0), (1, 1), (0, 1)))
                triangles += [[a, b, c][::turn], [a, c, d][::turn]]
    below = (np.arange(len(vertices)) >= len(upper)).astype(float)
    x, y, _ = vertices.T
    inside = np.clip(1.0 - (x / 25.0) ** 2, 0.0, 1.0)  # how much of the lips' opening is at this place
    lip = below * _bump(y, -4.0, 8.0)
    up, out, ahead = np.eye(3)[1], np.eye(3)[0], np.eye(3)[2]
    hang = below * np.maximum(inside, np.clip(-y / 20.0, 0.0, 1.0)) * np.clip((60.0 - np.abs(x)) / 20.0, 0.0, 1.0)

    def along(amount: np.ndarray, direction: np.ndarray) -> np.ndarray:
        return amount[:, None] * direction

    raised = (1.0 - below) * inside * _bump(y, 4.0, 9.0)
    shapes = {"jawOpen": along(-32.0 * hang, up), "mouthClose": along(30.0 * lip * inside, up),
              "mouthPucker": along(-np.sign(x) * 8.0 * _bump(np.abs(x), 25.0, 14.0) * _bump(y, 0.0, 14.0), out)
              + along(7.0 * inside * _bump(y, 0.0, 14.0), ahead)}
    for side, sign in (("Left", 1.0), ("Right", -1.0)):
        here = (sign * x > 0.0).astype(float)
        corner = here * _bump(np.abs(x), 25.0, 12.0) * _bump(y, 0.0, 14.0)
        shapes["mouthSmile" + side] = along(8.0 * corner, up) + along(sign * 6.0 * corner, out)
        shapes["mouthStretch" + side] = along(sign * 6.0 * corner, out) - along(2.0 * corner, up)
        shapes["mouthUpperUp" + side] = along(8.0 * raised * (0.5 + 0.5 * np.clip(sign * x / 10.0, -1, 1)), up)
    if mouth == "vrm":
        shapes = {"A": 0.55 * shapes["jawOpen"] + shapes["mouthUpperUpLeft"],
                  "U": 0.2 * shapes["jawOpen"] + 1.3 * shapes["mouthPucker"],
                  "I": shapes["mouthUpperUpLeft"] + shapes["mouthUpperUpRight"] + 0.1 * shapes["jawOpen"]}
    return vertices, np.array(triangles), {prefix + name: move for name, move in shapes.items()}


def glb(document: Mapping, binary: bytes) -> bytes:
    """A container of both."""
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    size = 12 + 8 + len(text) + 8 + len(binary)
    return (struct.pack("<4sII", b"glTF", 2, size) + struct.pack("<I4s", len(text), b"JSON") + text
            + struct.pack("<I4s", len(binary), b"BIN\0") + binary)


def document_of(vertices: np.ndarray, triangles: np.ndarray, shapes: Mapping[str, np.ndarray], *, unit: float = 0.001,
                sparse: bool = False, node: Optional[Mapping] = None) -> Tuple[Dict, bytes]:
    """A document with one mesh, whose unit is so many of the file's per millimetre, and its binary part. With `sparse`
    shapes list only the vertices that they move."""
    parts, views, accessors = [], [], []

    def view(data: bytes) -> int:
        views.append({"buffer": 0, "byteOffset": sum(map(len, parts)), "byteLength": len(data)})
        parts.append(data + b"\0" * (-len(data) % 4))
        return len(views) - 1

    def vectors(values: np.ndarray) -> int:
        accessors.append({"bufferView": view(values.astype("<f4").tobytes()), "componentType": 5126, "type": "VEC3",
                          "count": len(values)})
        return len(accessors) - 1

    def few(values: np.ndarray) -> int:
        moved = np.flatnonzero(np.abs(values).max(axis=1) > 1e-9)
        accessors.append({"componentType": 5126, "type": "VEC3", "count": len(values), "sparse": {
            "count": len(moved), "indices": {"bufferView": view(moved.astype("<u2").tobytes()), "componentType": 5123},
            "values": {"bufferView": view(values[moved].astype("<f4").tobytes())}}})
        return len(accessors) - 1

    position = vectors(vertices * unit)
    accessors.append({"bufferView": view(triangles.astype("<u4").tobytes()), "componentType": 5125, "type": "SCALAR",
                      "count": triangles.size})
    faces = len(accessors) - 1
    targets = [{"POSITION": (few if sparse else vectors)(move * unit)} for move in shapes.values()]
    mesh = {"name": "face", "extras": {"targetNames": list(shapes)},
            "primitives": [{"attributes": {"POSITION": position}, "indices": faces, "targets": targets}]}
    document = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
                "nodes": [{"mesh": 0, "name": "head", **(node or {})}], "meshes": [mesh], "accessors": accessors,
                "bufferViews": views, "buffers": [{"byteLength": sum(map(len, parts))}]}
    return document, b"".join(parts)


#: The bones of Mixamo's and Ready Player Me's skeletons: each one's parent, and where it lies from there, metres.
BONES = {
    "Hips": ("Armature", (0.0, 1.0, 0.0)), "Spine": ("Hips", (0.0, 0.1, 0.0)), "Spine1": ("Spine", (0.0, 0.1, 0.0)),
    "Spine2": ("Spine1", (0.0, 0.1, 0.0)), "Neck": ("Spine2", (0.0, 0.1, 0.0)), "Head": ("Neck", (0.0, 0.1, 0.0)),
    "LeftEye": ("Head", (0.03, 0.08, 0.08)), "RightEye": ("Head", (-0.03, 0.08, 0.08)),
    **{side + name: (side + parent if parent not in ("Hips", "Spine2") else parent, (sign * x, y, 0.0))
       for side, sign in (("Left", 1.0), ("Right", -1.0))
       for name, parent, x, y in (
           ("Shoulder", "Spine2", 0.05, 0.08), ("Arm", "Shoulder", 0.1, 0.0), ("ForeArm", "Arm", 0.25, 0.0),
           ("Hand", "ForeArm", 0.25, 0.0), ("UpLeg", "Hips", 0.1, -0.05), ("Leg", "UpLeg", 0.0, -0.43),
           ("Foot", "Leg", 0.0, -0.43), ("ToeBase", "Foot", 0.0, -0.05),
           *((f"Hand{finger}{joint}", f"Hand{finger}{joint - 1}" if joint > 1 else "Hand", 0.03, 0.0)
             for finger in ("Thumb", "Index", "Middle", "Ring", "Pinky") for joint in (1, 2, 3)))},
}  # fmt: skip


def add_skeleton(document: Dict) -> Dict[str, int]:
    """Puts a document's head on a body of bones, below a node ``Armature``; the nodes' numbers by name."""
    nodes = document["nodes"]
    numbers = {"Armature": len(nodes)}
    nodes.append({"name": "Armature", "children": []})
    for name, (parent, place) in BONES.items():
        numbers[name] = len(nodes)
        nodes.append({"name": name, "translation": list(place)})
        nodes[numbers[parent]].setdefault("children", []).append(numbers[name])
    nodes[numbers["Head"]]["children"].append(0)
    document["scenes"] = [{"nodes": [numbers["Armature"]]}]
    return numbers
