"""A solution as a description that ``labial rig`` reads."""

from __future__ import annotations

import re
from typing import List, Mapping, Sequence, Tuple

import numpy as np

from labial.fit.solve import FEATURES, Solution
from labial.program import one_line

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
