"""``labial page``: an HTML file that plays motion and sound, drawn or on an avatar. It needs no network."""

from __future__ import annotations

import base64
import json
import math
import os
import warnings
from pathlib import Path
from typing import Any, Dict, List, Mapping, Optional, Sequence, Tuple

import numpy as np

from labial.errors import DataError, LabialError, PathLike
from labial.files import limits
from labial.files.frames import even
from labial.files.grammar import read_bytes
from labial.fit.avatar import read as read_avatar
from labial.fit.fit import output_names
from labial.fit.kinds import KINDS, kind_of, shapes_for
from labial.fit.landmarks import Found, read_head
from labial.fit.meaning import fap, matrix, opening
from labial.rig.animation import face, outputs
from labial.rig.description import Rig, read
from labial.see.motion import Band, Motion, laughs
from labial.see.player import player, script_data


def page(motion: Motion, bands: Sequence[Band], audio: Optional[PathLike] = None, title: Optional[str] = None) -> str:
    """The page as text; `title` is the motion's name unless given. `audio` is a sound file that browsers play (WAV,
    MP3, Ogg, FLAC, AAC, M4A, WebM), of at most `limits.PAGE` bytes, whose time 0 is that of the motion's file. Raises
    DataError, which names it, when it is none, and LabialError for frames that are too uneven in time."""
    fps, frames = _even(motion)
    start = float(motion.times[0])
    return player(title or motion.name, fps, np.rint(frames).astype(int).tolist(),
                  _phonemes(bands, start, fps, len(frames)), start, audio)


def _even(motion: Motion) -> Tuple[float, np.ndarray]:
    try:
        return even(motion.times, motion.frames)
    except ValueError as error:
        raise LabialError(f"{motion.name}: {error}") from None


def _phonemes(bands: Sequence[Band], start: float, fps: float, count: int) -> List[Dict[str, Any]]:
    """The bands in frames of the page, cut to the motion; bands shorter than a frame are omitted."""
    def frame(seconds: float) -> int:
        return min(max(math.floor((seconds - start) * fps + 0.5 + 1e-6), 0), count)  # halves up, as the library does

    sounding = "laughter" if laughs(bands) else "speech"
    phonemes = []
    for band in bands:
        first, last = frame(band.start), frame(band.end)
        if last > first:
            phonemes.append({"label": band.label, "start_frame": first, "frames": last - first,
                             "kind": "silence" if band.kind == "silence" else sounding})
    return phonemes


#: Acceptable range of the opening shown by the opening meant, and the millimetres of opening needed to judge it.
_RIGHT, _LEAST = (0.8, 1.25), 2.0
HEAD_PLAYER = Path(__file__).with_name("head.html")
#: Modules of the npm package three, their names on a page, and their names for each other.
_THREE: Dict[str, str] = {
    "three": "build/three.module.js",
    "labial-gltf": "examples/jsm/loaders/GLTFLoader.js",
    "labial-buffers": "examples/jsm/utils/BufferGeometryUtils.js",
    "labial-skeletons": "examples/jsm/utils/SkeletonUtils.js",
}
#: A part of `three` from 0.172 on.
_CORE = {"labial-core": "build/three.core.js"}
_IMPORTS = {"./three.core.js": "labial-core", "../utils/BufferGeometryUtils.js": "labial-buffers",
            "../utils/SkeletonUtils.js": "labial-skeletons"}


def find_three(given: Optional[PathLike]) -> Path:
    """The folder of the npm package three: the given one, or node_modules/three here or above. Raises LabialError."""
    places = [Path(given)] if given is not None else [folder / "node_modules" / "three"
                                                      for folder in (Path.cwd(), *Path.cwd().parents)]
    for place in places:
        if all((place / file).is_file() for file in _THREE.values()):
            return place
    where = f"{given} is not" if given is not None else "there is no node_modules/three with"
    raise LabialError(f"{where} the npm package three (0.170 or later): `npm install three` brings it, and --three "
                      "names its folder")


def _imports(three: Path) -> str:
    """An import map whose modules are data: no network."""
    modules = {}
    core = {name: file for name, file in _CORE.items() if (three / file).is_file()}
    for name, file in {**core, **_THREE}.items():
        text = (three / file).read_text(encoding="utf-8")
        for path, other in _IMPORTS.items():
            for quote in "\"'":
                text = text.replace(f"{quote}{path}{quote}", f"{quote}{other}{quote}")
        modules[name] = "data:text/javascript;base64," + base64.b64encode(text.encode()).decode("ascii")
    return json.dumps({"imports": modules})


def _shapes(found: Found, rig: Optional[PathLike]) -> Tuple[Rig, Dict[str, str]]:
    """The rig, and the avatar's shape for each of its outputs."""
    head = found.head
    if rig is not None:
        chosen = read(rig, Path(rig).stem)
        named = {name: shape for shape, name in output_names(head.shapes).items()}
    else:
        kind = kind_of(head)
        if kind not in KINDS:
            raise LabialError(f"{head.name}: its shapes are neither ARKit's nor visemes: `labial fit` makes a rig for "
                              "it, and --rig takes that")
        chosen = face(kind)
        named = shapes_for(head, kind, [output.name for output in chosen.outputs])
    used = {output.name: named[output.name] for output in chosen.outputs if output.name in named}
    if not used:
        raise LabialError(f"{head.name}: it has none of the rig's shapes, {', '.join(o.name for o in chosen.outputs)}")
    return chosen, used


def _warn(where: str, found: Found, weights: Dict[str, np.ndarray], frames: np.ndarray) -> None:
    """Warns if the built-in weights open this head much less or more than the frames mean."""
    head = found.head
    meant = float(np.percentile(-(fap(frames, 51) + fap(frames, 52)), 95)) * head.mns / 1024.0
    ratio = float(np.percentile(opening(head, matrix(head, weights)), 95)) / max(meant, _LEAST)
    if meant > _LEAST and not _RIGHT[0] <= ratio <= _RIGHT[1]:
        warnings.warn(f"{where}: with the built-in weights its mouth opens {ratio:.2f} times as far as is meant; "
                      "`labial fit` makes a rig for it, and --rig takes that", stacklevel=3)


def head_page(motion: Motion, avatar: PathLike, rig: Optional[PathLike] = None, audio: Optional[PathLike] = None,
              title: Optional[str] = None, three: Optional[PathLike] = None,
              points: Optional[Mapping[str, int]] = None) -> str:
    """The page as text. `avatar` is a .glb or .vrm; `rig` a description, without which the built-in one of the avatar's
    kind of shapes is taken; `audio` as `labial.see.page.page` has it; `three` the folder of the npm package three;
    `points` are vertices by point, which need not be found. Raises DataError for a file that cannot be used and
    LabialError for an avatar that no rig moves."""
    where = os.fspath(avatar)
    found = read_head(read_avatar(avatar, everything=True), where, points or {})
    chosen, used = _shapes(found, rig)
    content = read_bytes(avatar)
    if content[:4] != b"glTF":
        raise DataError(where, None, "a page takes a .glb or .vrm, in which everything is in one file")
    if len(content) > limits.PAGE:
        raise DataError(where, None, f"a page takes an avatar of {limits.PAGE // 1_000_000} MB at most, and this one "
                                     f"has {len(content) / 1e6:.1f} MB")
    fps, frames = _even(motion)
    weights = outputs(chosen, frames, motion.shares if len(frames) == len(motion.frames) else None)
    if rig is None:
        _warn(where, found, {shape: weights[name] for name, shape in used.items()}, frames)
    columns: Dict[str, np.ndarray] = {}  # by the mesh's own shapes, of which VRM's expressions are made
    for name, shape in used.items():
        for own, share in found.mesh.parts.get(shape, [(shape, 1.0)]):
            columns[own] = np.round(columns.get(own, 0.0) + share * weights[name], 3)
    away = b'"VRM"' in content[:65536] and b"VRMC_vrm" not in content  # VRM 0 faces the other way
    facing = -1.0 if away else 1.0
    corners = [(found.head.rest[corner] / found.scale * (facing, 1.0, facing)).tolist()
               for corner in ("corner_left", "corner_right")]
    data: Dict[str, Any] = {
        "title": title or motion.name, "fps": fps, "start": round(float(motion.times[0]), 6), "shapes": list(columns),
        "weights": np.stack(list(columns.values()), axis=1).tolist(), "corners": corners, "facing": facing,
        "head": base64.b64encode(content).decode("ascii")}
    page = HEAD_PLAYER.read_text(encoding="utf-8").replace("@LABIAL_DATA@", script_data(data, audio))
    return page.replace("@LABIAL_IMPORTS@", _imports(find_three(three)))
