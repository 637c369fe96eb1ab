"""Videos of a photographed face whose mouth, turn and place are drawn frame by frame.

The photograph is scikit-image's astronaut (NASA, public domain). MediaPipe's landmarks of it are a mesh in depth, which
is turned, whose lower lip and chin are moved, and on which the photograph is drawn again triangle by triangle.
"""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache
from pathlib import Path
from typing import Sequence, Tuple

import av
import cv2
import mediapipe
import numpy as np
import skimage
from scipy.spatial import Delaunay

SIZE = 512  # pixels of a picture's sides
_LOWER_INNER = (95, 88, 178, 87, 14, 317, 402, 318, 324)
_UPPER = 13


@lru_cache(maxsize=1)
def mesh() -> Tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Photograph, (N, 3) vertices in pixels of which 468 are landmarks, (M, 3) triangles, and (N,) how far a vertex
    goes with the jaw, 0 .. 1."""
    picture = cv2.imread(str(Path(skimage.__file__).parent / "data" / "astronaut.png"))[0:256, 128:384]
    picture = cv2.resize(picture, (SIZE, SIZE), interpolation=cv2.INTER_CUBIC)
    with mediapipe.solutions.face_mesh.FaceMesh(static_image_mode=True) as tracker:
        found = tracker.process(cv2.cvtColor(picture, cv2.COLOR_BGR2RGB)).multi_face_landmarks[0]
    points = np.array([(p.x, p.y, p.z) for p in found.landmark]) * SIZE
    middle = points.mean(axis=0)
    angles = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    ring = [(middle[0] + 1.0 * 130 * np.cos(a), middle[1] + 1.25 * 130 * np.sin(a), middle[2] + 60) for a in angles]
    edge = [(x, y, 0) for x in np.linspace(0, SIZE - 1, 5) for y in np.linspace(0, SIZE - 1, 5)
            if x in (0, SIZE - 1) or y in (0, SIZE - 1)]
    vertices = np.concatenate([points, ring, edge])
    left, right = points[78], points[308]
    line = left[1] + (vertices[:, 0] - left[0]) / (right[0] - left[0]) * (right[1] - left[1])
    across = (vertices[:, 0] - (left[0] + right[0]) / 2) / (right[0] - left[0])
    jaw = np.clip((vertices[:, 1] - line - 4) / 12, 0, 1) * np.exp(-(across**2) / 0.5)
    profile = np.clip(1 - (2 * across) ** 2, 0, 1)
    jaw[list(_LOWER_INNER)] = profile[list(_LOWER_INNER)]
    jaw[468:] = 0
    return picture, vertices, Delaunay(vertices[:, :2]).simplices, jaw


def draw(opening: float, yaw: float = 0.0, pitch: float = 0.0) -> np.ndarray:
    """(SIZE, SIZE, 3) BGR: the face with its lips `opening` pixels apart, 0 closed, turned by degrees."""
    picture, rest, triangles, jaw = mesh()
    moved = rest.copy()
    moved[:, 1] += jaw * (opening - (rest[14, 1] - rest[_UPPER, 1]))
    head = slice(0, len(rest) - 16)
    a, b = np.radians([yaw, pitch])
    about_y = np.array([[np.cos(a), 0, np.sin(a)], [0, 1, 0], [-np.sin(a), 0, np.cos(a)]])
    about_x = np.array([[1, 0, 0], [0, np.cos(b), -np.sin(b)], [0, np.sin(b), np.cos(b)]])
    pivot = rest[:468].mean(axis=0) + (0, 0, 80)
    moved[head] = (moved[head] - pivot) @ (about_y @ about_x).T + pivot
    result = picture.copy()
    for corners in triangles[np.argsort(-moved[triangles, 2].mean(axis=1))]:  # the farthest first
        source, target = rest[corners, :2].astype(np.float32), moved[corners, :2].astype(np.float32)
        x, y, width, height = cv2.boundingRect(target)
        x, y = max(x, 0), max(y, 0)
        width, height = min(width, SIZE - x), min(height, SIZE - y)
        if width <= 0 or height <= 0:
            continue
        shift = np.float32([x, y])
        matrix = cv2.getAffineTransform(source, target - shift)
        patch = cv2.warpAffine(picture, matrix, (width, height), borderMode=cv2.BORDER_REPLICATE)
        mask = np.zeros((height, width), np.uint8)
        cv2.fillConvexPoly(mask, np.int32(np.round((target - shift) * 16)), 1, shift=4)
        result[y : y + height, x : x + width][mask > 0] = patch[mask > 0]
    return result


def write(path: Path, pictures: Sequence[np.ndarray], fps: int) -> Path:
    """A video of these pictures (BGR)."""
    path.parent.mkdir(exist_ok=True)
    with av.open(str(path), "w") as out:
        stream = out.add_stream("mpeg4", rate=Fraction(fps))
        stream.height, stream.width = pictures[0].shape[:2]
        stream.bit_rate, stream.pix_fmt = 8_000_000, "yuv420p"
        for picture in pictures:
            out.mux(stream.encode(av.VideoFrame.from_ndarray(np.ascontiguousarray(picture), format="bgr24")))
        out.mux(stream.encode())
    return path
