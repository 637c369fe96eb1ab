"""From avatars to a description: reads avatars, solves, writes the text, reads it back and judges it."""

from __future__ import annotations

import os
import re
from dataclasses import replace
from pathlib import Path
from typing import Dict, List, Mapping, NamedTuple, Optional, Sequence, Tuple

import numpy as np

from labial.errors import LabialError
from labial.files.grammar import Content
from labial.fit.avatar import read as read_avatar
from labial.fit.head import Head, own, read_table
from labial.fit.kinds import KINDS, kind_of, prepare, unknown
from labial.fit.landmarks import Found, read_head
from labial.fit.meaning import crooked, judge, matrix
from labial.fit.solve import FEATURES, Solution, read_sentences, solve
from labial.program import one_line
from labial.rig.animation import outputs
from labial.rig.description import SOURCES, Rig, make_unit, read
from labial.rig.table import holds

#: Intensities of the laughs that are solved for, in addition to the sentences.
_LAUGHS = (0.5, 1.0)
#: Millimetres, beyond what FAPs mean, of motion sideways or between the corners' heights that make a mouth crooked.
_CROOKED = 1.0
#: Shapes that a line of the report names at most.
_NAMED = 6


class Fitted(NamedTuple):
    """A rig for an avatar."""

    text: str  #: of the description
    rig: Rig
    #: Where the avatar's lips are, its mesh's shapes under the names of the rig's outputs; None for a table of lip
    #: points, and for several avatars.
    found: Optional[Found]
    report: List[str]  #: its accuracy, as lines of text


def fit(paths: Sequence[str], points: Mapping[str, int], shapes: Optional[str], name: str) -> Fitted:
    """The rig of one avatar, or of several alike. `points` are vertices by point, which need not be found; `shapes` a
    kind or names separated by commas; `name` the rig's name. Raises DataError for a file that cannot be used and
    LabialError for what cannot be solved."""
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
    for head, found in zip(heads, founds):
        parts = {part for mouth in (found.mesh.parts.values() if found else ()) for part, _ in mouth}
        missed = [] if only or kind == "other" else [shape for shape in unknown(head) if shape not in parts]
        if missed:
            more = f" and {len(missed) - _NAMED} more" if len(missed) > _NAMED else ""
            report.append(f"{head.name}: not used, though they move the lips: "
                          f"{one_line(', '.join(missed[:_NAMED]) + more)}; --shapes names those to use")
    solution = solve([head.only(order) for head, _, _ in prepared], read_sentences(laughs=_LAUGHS), prepared[0][2])
    files = prepared[0][1]  # the avatar's own names
    remarks = [f"Solved by `labial fit` for {', '.join(Path(path).name for path in paths)}."]
    spelled = output_names(heads[0].shapes)
    strange = {shape: f"in the file: {shape}" for shape in files.values() if spelled[shape] != shape}
    text = describe(solution, [files[shape] for shape in order], remarks, strange, spelled)
    rig = replace(read(Content(text.encode(), f"{paths[0]}: its rig"), name), path=paths[0])
    report.append(f"{len(rig.outputs)} of {len(order)} shapes are used, of the kind {kind}")
    motion = read_sentences()
    weights = outputs(rig, motion.frames)
    for head, (_, names, _) in zip(heads, prepared):
        # Judges the written description, on the head's own shapes.
        placed = matrix(head, {names[canonical]: weights[spelled[files[canonical]]] for canonical in names
                               if canonical in files and spelled[files[canonical]] in weights})
        report.append(f"{head.name}: {judge(head, placed, motion.frames, motion.closures).text()}")
        aside, tilt = crooked(head, placed, motion.frames)
        if max(aside, tilt) > _CROOKED:
            report.append(f"  in doubt: the mouth moves up to {aside:.1f} mm sideways, and its corners differ by up to "
                          f"{tilt:.1f} mm in height: left and right shapes differ, or one of a pair is missing")
    found = founds[0] if len(founds) == 1 else None
    if found:
        mesh = found.mesh
        found = found._replace(mesh=replace(mesh, shapes={spelled[shape]: mesh.shapes[shape] for shape in mesh.shapes}))
    return Fitted(text, rig, found, report)


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


# ---- A solution as a description that labial rig reads ---------------------------------------------------------------

_CORNERS = {"left": ("stretch_l_cornerlip_o", "raise_l_cornerlip_o"),
            "right": ("stretch_r_cornerlip_o", "raise_r_cornerlip_o")}
#: Coefficients of an output below this share of its largest are omitted.
_LEAST = 0.002
#: Most letters of an output's name, and names that a description refuses, in capitals.
_LONGEST, _REFUSED = 32, ("OUTPUTS", "OUTPUT_NAMES", "PCA9685_PRESCALE")


def output_name(shape: str) -> str:
    """The name of a shape in a description: without its mesh's, with underscores where C does not allow a character."""
    return _spelled(shape)[:_LONGEST]


def _spelled(shape: str) -> str:
    name = re.sub(r"[^0-9A-Za-z_]", "_", own(shape).strip())
    return name if re.match(r"[A-Za-z]", name) else "shape_" + name


def output_names(shapes: Sequence[str]) -> Dict[str, str]:
    """The names of a mesh's shapes in a description, by shape: `output_name`. Where these would be the same but for
    capitals, names that are too long lose the words that they begin with alike; others get a number."""
    alike: Dict[str, List[str]] = {}
    for shape in shapes:
        alike.setdefault(output_name(shape).upper(), []).append(_spelled(shape))
    found: Dict[str, str] = {}
    taken = set(_REFUSED)
    for shape in sorted(shapes, key=lambda shape: output_name(shape) != shape):  # what needs no change keeps its name
        name, whole = output_name(shape), _spelled(shape)
        rivals = alike[name.upper()]
        if len(rivals) > 1 and len(whole) > _LONGEST:
            name = output_name(whole[os.path.commonprefix(rivals).rfind("_") + 1:])
        first, number = name, 1
        while name.upper() in taken:
            number += 1
            name = f"{first[: _LONGEST - len(str(number)) - 1]}_{number}"
        taken.add(name.upper())
        found[shape] = name
    return found


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


def _mixed(sources: Sequence[Tuple[str, float]], neutral: float) -> Tuple[str, str]:
    """The text of `from` and that of `reach`, without the least coefficients, nor more than a table can hold."""
    largest = max(abs(slope) for _, slope in sources)
    reach = f"{(1.0 - neutral) * 1024.0 / largest:.1f}"
    shares = [(name, f"{slope / largest:.3f}") for name, slope in sources if abs(slope) >= _LEAST * largest]
    scale = make_unit("weight").scale
    while True:
        weights = np.sum([float(share) * np.array(SOURCES[name].weights) for name, share in shares], axis=0)
        least = min(abs(float(share)) for _, share in shares)
        fewer = [(name, share) for name, share in shares if abs(float(share)) > least]
        if not fewer or holds(tuple(weights.tolist()), (1.0 - neutral) / float(reach) * scale):
            return ", ".join(f"{name} = {share}" for name, share in shares), reach
        shares = fewer


def describe(solution: Solution, shapes: Sequence[str], remarks: Sequence[str], notes: Mapping[str, str],
             names: Mapping[str, str]) -> str:
    """The text of a description. `remarks` are its first lines, `notes` a remark beside a shape, `names` those of the
    outputs; shapes that never move are left out."""
    lines = [f"# {one_line(remark)}".rstrip() for remark in remarks]
    lines.append('unit = "weight"')
    for number, group in enumerate(solution.groups):
        for place, side in group.members:
            named = _sources(side, solution.slopes[number])
            if not any(slope for _, slope in named):
                continue
            note = notes.get(shapes[place], "")
            neutral = min(round(float(solution.offsets[number]), 4), 0.0)
            mixed, reach = _mixed(named, neutral)
            cap = float(solution.caps[number])
            lines += ["", f"[output.{names[shapes[place]]}]" + (f"    # {one_line(note)}" if note else ""),
                      f"from = {{ {mixed} }}", f"neutral = {neutral:g}", "full = 1", f"reach = {reach}", "minimum = 0"]
            if cap < 1.0:
                lines.append(f"maximum = {cap:g}")
    return "\n".join(lines) + "\n"
