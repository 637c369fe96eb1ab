"""Judges heads on sentences that no rig was solved for: with the built-in rigs, and with a fitted rig.

    heads.py SENTENCES.flite[+MORE.flite] HEAD.glb|.vrm|.csv ...

prints a table in millimetres (docs/avatar.md). A file of sentences is made by
``flite -voice awb -t SENTENCE -psdur -o none``, a line for each; two are judged as one with a + between their names. It
needs numpy, the exporter with its extra `fit`, and the run-time on the path.
"""

from __future__ import annotations

import sys
from typing import Dict, List, Mapping, Sequence

import numpy as np

from labial.errors import LabialError
from labial.fit.avatar import read as read_avatar
from labial.fit.fit import fit, output_names
from labial.fit.head import Head, read_table
from labial.fit.kinds import KINDS, kind_of, known, shapes_for
from labial.fit.landmarks import read_head
from labial.fit.meaning import judge, matrix, opening
from labial.fit.solve import Motion, read_sentences
from labial.rig.animation import face, outputs

#: Shapes that a head needs for a built-in rig.
_LEAST = {"arkit": 4, "oculus": 8, "vrm": 3}


def joined(motions: Sequence[Motion]) -> Motion:
    phonemes, first = [], 0
    for motion in motions:
        phonemes += [(label, first + begin, first + end) for label, begin, end in motion.phonemes]
        first += len(motion.frames)
    shares = [motion.shares for motion in motions if motion.shares is not None]
    return Motion(np.concatenate([motion.frames for motion in motions]), phonemes,
                  np.concatenate(shares) if len(shares) == len(motions) else None)


def row(name: str, head: Head, weights: Mapping[str, np.ndarray], motion: Motion) -> str:
    """A row of the table: weights are by the head's own names."""
    placed = matrix(head, weights)
    found, gap = judge(head, placed, motion.frames, motion.closures), opening(head, placed)

    def mean(label: str) -> float:
        return float(np.mean([gap[begin:end].mean() for name, begin, end in motion.phonemes if name == label]))

    cells = [f"{value:.2f}" for value in (found.ratio, found.opening, found.width, found.upper, found.jaw, found.closed,
                                          found.through)]
    return " | ".join([name, *cells, f"{found.deepest:.1f}", f"{mean('uw') / mean('aa'):.2f}"])


def built_in(head: Head, kind: str, motion: Motion) -> Dict[str, np.ndarray]:
    """The weights of the built-in rig of a kind, by the head's names; none if the head lacks its shapes."""
    names = known(head, kind)
    if len(names) < _LEAST[kind] or ("jawOpen" if kind == "arkit" else "aa") not in names.values():
        return {}
    values = outputs(face(kind), motion.frames, motion.shares)
    return {shape: values[name] for name, shape in shapes_for(head, kind, list(values)).items()}


def rows(path: str, motion: Motion) -> List[str]:
    head = read_table(path) if path.endswith(".csv") else read_head(read_avatar(path), path, {}).head
    found = [row(f"{kind} {head.name}", head, weights, motion) for kind in KINDS
             for weights in [built_in(head, kind, motion)] if weights]
    values = outputs(fit([path], {}, None, "fitted").rig, motion.frames)
    own = {shape: values[name] for shape, name in output_names(head.shapes).items() if name in values}
    return [*found, row(f"fitted {head.name} ({kind_of(head)})", head, own, motion)]


def main(arguments: Sequence[str]) -> int:
    if len(arguments) < 2:
        print(__doc__, file=sys.stderr)
        return 2
    motion = joined([read_sentences(path) for path in arguments[0].split("+")])
    print(f"{len(motion.closures)} p, b, m")
    print("rig, head | shown / meant | opening | width | upper lip | jaw | closed | through | deepest | oo / ah")
    for path in arguments[1:]:
        try:
            print("\n".join(rows(path, motion)), flush=True)
        except LabialError as error:
            print(error, flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
