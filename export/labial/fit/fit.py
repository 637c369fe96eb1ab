"""From avatars to a description: reads avatars, solves, writes the text, reads it back and judges it."""

from __future__ import annotations

import os
import re
import tempfile
from pathlib import Path
from typing import List, Mapping, NamedTuple, Optional, Sequence, Tuple

import numpy as np

from labial.errors import LabialError
from labial.fit.avatar import read as read_avatar
from labial.fit.head import Head, read_table
from labial.fit.kinds import KINDS, kind_of, prepare
from labial.fit.landmarks import Found, read_head
from labial.fit.meaning import judge, matrix
from labial.fit.sentences import read_sentences
from labial.fit.solve import FEATURES, Solution, solve
from labial.program import one_line
from labial.rig.animation import outputs
from labial.rig.description import Rig, read

#: Intensities of the laughs that are solved for, in addition to the sentences.
_LAUGHS = (0.5, 1.0)


class Fitted(NamedTuple):
    """A rig for an avatar."""

    text: str  #: of the description
    rig: Rig
    found: Optional[Found]  #: where the avatar's lips are; None for a table of lip points
    report: List[str]  #: its accuracy, as lines of text


def fit(paths: Sequence[str], points: Mapping[str, int], shapes: Optional[str], name: str) -> Fitted:
    """The rig of one avatar, or of several alike.

    `points` are vertices by point, which need not be found; `shapes` a kind or names separated by commas; `name` the
    rig's name. Raises DataError for a file that cannot be used and LabialError for what cannot be solved.
    """
    heads: List[Head] = []
    founds: List[Optional[Found]] = []
    report: List[str] = []
    for path in paths:
        head, found = _read(path, points)
        heads.append(head)
        founds.append(found)
        report.append(f"{path}: {head.mns:.1f} mm from nose to mouth, {head.mw:.1f} mm wide"
                      + (f", the mesh {found.mesh.name!r}" if found else ""))
        if found:
            report += [f"  in doubt: {doubt}" for doubt in found.doubts]
            report.append("  vertices: " + ", ".join(f"{point}={vertex}" for point, vertex in found.vertices.items()))
    kind, only = _kind(shapes, heads[0])
    prepared = [prepare(head, kind, len(heads) == 1, only) for head in heads]
    order = prepared[0][0].shapes
    solution = solve([head.only(order) for head, _, _ in prepared], read_sentences(laughs=_LAUGHS), prepared[0][2])
    files = prepared[0][1]  # the avatar's own names
    remarks = [f"Solved by `labial fit` for {', '.join(Path(path).name for path in paths)}."]
    own = [files[shape] for shape in order]
    strange = {shape: f"in the file: {shape}" for shape in own if output_name(shape) != shape}
    if len({output_name(shape) for shape in own}) < len(own):
        raise LabialError("two shapes have the same name but for what a description cannot spell: name those to use "
                          "with --shapes")
    text = describe(solution, own, remarks, strange)
    rig = _read_back(text, name)
    report.append(f"{len(rig.outputs)} of {len(order)} shapes are used, of the kind {kind}")
    motion = read_sentences()
    weights = outputs(rig, motion.frames)
    for head, (_, names, _) in zip(heads, prepared):
        # Judges the written description, on the head's own shapes.
        by_shape = {names[canonical]: weights[output_name(files[canonical])] for canonical in names
                    if output_name(files.get(canonical, "")) in weights}
        report.append(f"{head.name}: {judge(head, matrix(head, by_shape), motion.frames, motion.closures).text()}")
    return Fitted(text, rig, founds[0] if len(founds) == 1 else None, report)


def _read(path: str, points: Mapping[str, int]) -> Tuple[Head, Optional[Found]]:
    if path.lower().endswith(".csv"):
        if points:
            raise LabialError("--point goes with an avatar, not with a table of lip points")
        return read_table(path), None
    found = read_head(read_avatar(path), path, points)
    return found.head, found


def _kind(shapes: Optional[str], head: Head) -> Tuple[str, Sequence[str]]:
    if shapes is None:
        return kind_of(head), ()
    if shapes in KINDS or shapes == "other":
        return shapes, ()
    return "other", [shape.strip() for shape in shapes.split(",")]


def _read_back(text: str, name: str) -> Rig:
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, f"{name}.toml")
        Path(path).write_text(text, encoding="utf-8")
        return read(path, name)


# ---- A solution as a description that labial rig reads ---------------------------------------------------------------

_CORNERS = {"left": ("stretch_l_cornerlip_o", "raise_l_cornerlip_o"),
            "right": ("stretch_r_cornerlip_o", "raise_r_cornerlip_o")}
#: Coefficients of an output below this share of its largest are omitted.
_LEAST = 0.002


def output_name(shape: str) -> str:
    """The name of a shape in a description: without the part before the last dot, with underscores for characters that
    C does not allow."""
    name = re.sub(r"[^0-9A-Za-z_]", "_", shape.rsplit(".", 1)[-1].strip())
    return (name if re.match(r"[A-Za-z]", name) else "shape_" + name)[:32]


def _sources(side: str, slopes: np.ndarray) -> List[Tuple[str, float]]:
    named: List[Tuple[str, float]] = []
    for feature, slope in zip(FEATURES, slopes):
        if feature == "spread":
            named.append((feature if side == "middle" else _CORNERS[side][0], slope))
        elif feature == "corner" and side == "middle":
            named += [(_CORNERS["left"][1], slope / 2.0), (_CORNERS["right"][1], slope / 2.0)]
        elif feature == "corner":
            named.append((_CORNERS[side][1], slope))
        else:
            named.append((feature, slope))
    return named


def describe(solution: Solution, shapes: Sequence[str], remarks: Sequence[str], notes: Mapping[str, str],
             keep: Sequence[str] = ()) -> str:
    """The text of a description. `remarks` are its first lines, `notes` a remark beside a shape; shapes that never move
    are left out, except those of `keep`."""
    lines = [f"# {one_line(remark)}".rstrip() for remark in remarks]
    lines.append('unit = "weight"')
    for number, group in enumerate(solution.groups):
        for place, side in group.members:
            named = _sources(side, solution.slopes[number])
            largest = max(abs(slope) for _, slope in named)
            if largest == 0.0:
                continue
            mixed = ", ".join(f"{name} = {slope / largest:.3f}" for name, slope in named
                              if abs(slope) >= _LEAST * largest)
            note = notes.get(shapes[place], notes.get(group.name, "")) if side != "right" else ""
            neutral = min(round(float(solution.offsets[number]), 4), 0.0)
            cap = float(solution.caps[number])
            lines += ["", f"[output.{output_name(shapes[place])}]" + (f"    # {one_line(note)}" if note else ""),
                      f"from = {{ {mixed} }}", f"neutral = {neutral:g}", "full = 1",
                      f"reach = {(1.0 - neutral) * 1024.0 / largest:.1f}", "minimum = 0"]
            if cap < 1.0:
                lines.append(f"maximum = {cap:g}")
    return "\n".join(lines) + "\n"
