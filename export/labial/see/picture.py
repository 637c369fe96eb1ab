"""Pictures of a head that says phonemes, in millimetres as its rig moves it."""

from __future__ import annotations

from typing import Callable, List, Sequence, Tuple

import numpy as np

from labial.errors import PathLike, needs
from labial.fit.fit import output_name
from labial.fit.landmarks import Found
from labial.rig.animation import outputs
from labial.rig.description import Rig
from labial.runtime.render import render

#: A caption, phonemes with milliseconds, mostly of a word, and the place of the one that is drawn; a laugh has none.
Sound = Tuple[str, Tuple[Tuple[str, int], ...], int]
#: What makes frames (T, 13), FAP, 50 a second, of phonemes with milliseconds.
Speak = Callable[[List[Tuple[str, int]]], np.ndarray]
#: The drawn phonemes.
_SAID: Tuple[Sound, ...] = (
    ("rest", (("SIL", 200),), 0),
    ("m (may)", (("M", 100), ("EY", 200)), 0),
    ("f (fee)", (("F", 120), ("IY", 200)), 0),
    ("ah (father)", (("F", 100), ("AA", 250), ("DH", 70), ("ER", 150)), 1),
    ("a (cat)", (("K", 80), ("AE", 220), ("T", 80)), 1),
    ("ee (see)", (("S", 120), ("IY", 250)), 1),
    ("oo (do)", (("D", 80), ("UW", 300)), 1),
    ("o (go)", (("G", 80), ("OW", 300)), 1),
    ("s (see)", (("S", 150), ("IY", 200)), 0),
    ("laugh", (), 0),
)


def said(sounds: Sequence[Sound] = _SAID,
         speak: Speak = lambda phonemes: np.asarray(render(phonemes))) -> Tuple[List[str], np.ndarray]:
    """Captions, and (N, 13) FAPs of the middle of each phoneme; of one that shuts the lips, where they are nearest."""
    frames = []
    for _, word, place in sounds:
        if not word:
            laugh = speak([("<laugh:1>", 2000)])
            frames.append(laugh[int(np.argmin(laugh[:, 4]))])
            continue
        motion = speak([("SIL", 300), *word, ("SIL", 300)])
        begin = 300 + sum(length for _, length in word[:place])
        middle = motion[begin // 20 : (begin + word[place][1]) // 20]
        closed = word[place][0] in ("M", "F")
        frames.append(middle[int(np.argmin(-(middle[:, 3] + middle[:, 4])))] if closed else middle[len(middle) // 2])
    return [caption for caption, _, _ in sounds], np.array(frames, dtype=np.float64)


def draw(rig: Rig, found: Found, path: PathLike) -> None:
    """Writes the picture of :data:`_SAID`, PNG. Raises LabialError without matplotlib."""
    sheet(rig, found, path, *said())


def sheet(rig: Rig, found: Found, path: PathLike, captions: Sequence[str], frames: np.ndarray,
          columns: int = 5, inches: float = 2.2) -> None:
    """Writes the head in each of the frames (N, 13), FAP, in rows of `columns`, each `inches` wide and with its
    caption: PNG. Raises LabialError without matplotlib."""
    with needs("drawing (--no-figure leaves it out)", "fit"):
        from matplotlib.collections import PolyCollection

        from labial.see.plot import pyplot, style

    weights = outputs(rig, frames)
    rows = -(-len(frames) // columns)
    head, mesh = found.head, found.mesh
    middle = (head.rest["corner_left"] + head.rest["corner_right"]) / 2.0
    low, high = middle - 1.15 * head.mw, middle + 1.15 * head.mw
    # What is drawn: the triangles around the mouth, the farthest first.
    rest = mesh.vertices * found.scale
    near = ((rest[:, :2] > low[:2] - 0.5 * head.mw) & (rest[:, :2] < high[:2] + 0.5 * head.mw)).all(axis=1)
    near &= rest[:, 2] > middle[2] - 1.2 * head.mw
    triangles = mesh.triangles[near[mesh.triangles].any(axis=1)]
    light = np.array([0.25, 0.35, 0.9])
    with style():
        figure, every = pyplot.subplots(rows, columns, figsize=(columns * inches, rows * inches * 2.5 / 2.2),
                                        squeeze=False, layout="constrained")
        for number, (axes, caption) in enumerate(zip(every.flat, captions)):
            moved = rest.copy()
            for name, move in mesh.shapes.items():
                weight = float(weights.get(output_name(name), np.zeros(len(frames)))[number])
                if weight:
                    moved += weight * move * found.scale
            corners = moved[triangles]
            normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
            normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-12)
            order = np.argsort(corners[:, :, 2].mean(axis=1))
            front = normal[:, 2] > 0.0
            shade = np.where(front, 0.25 + 0.7 * np.clip(normal @ light, 0.0, 1.0), 0.12)
            colours = shade[:, None] * np.where(front[:, None], [1.0, 0.86, 0.78], [0.7, 0.3, 0.3])
            axes.add_collection(PolyCollection(corners[order][:, :, :2], facecolors=np.clip(colours[order], 0.0, 1.0),
                                               edgecolors="face", linewidths=0.3))
            axes.set_xlim(low[0], high[0])
            axes.set_ylim(low[1], high[1])
            axes.set_aspect("equal")
            axes.set_axis_off()
            axes.set_title(caption)
        figure.savefig(path, format="png", dpi=110, metadata={"Software": None})
        pyplot.close(figure)
