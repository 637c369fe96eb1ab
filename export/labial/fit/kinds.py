"""The shapes of an avatar that a rig uses, and the features that each may follow.

ARKit's, Oculus LipSync's and VRM's shapes have known names. For them a list of sensible pairs keeps a rig readable,
such as that mouthPucker follows the corners: solved freely, shapes come to work against each other. Shapes with other
names may follow everything.
"""

from __future__ import annotations

import re
import warnings
from typing import Dict, Iterator, List, Mapping, NamedTuple, Sequence, Tuple

import numpy as np

from labial.errors import LabialError
from labial.fit.head import Head, of_head, plain, sided
from labial.fit.solve import FEATURES, Wishes
from labial.rig.animation import LIVE_LINK
from labial.tables.visemes import VISEMES

#: What raises the lower lip further than the jaw carries it while the upper lip stays: f and v. Weight per FAP / 1024.
_TO_THE_TEETH = {"jaw": 4.3, "lower_lip": -4.3, "upper_lip": 6.0, "offset": -0.28}
#: A somewhat open mouth that is not round, in which a tongue shows: TH, DD, kk, nn.
_TONGUE = {"lower_lip": 1.5, "jaw": -0.8, "push_t_lip": -4.0, "spread": 4.0, "offset": -0.12}


class Kind(NamedTuple):
    """A common set of shapes."""

    allowed: Mapping[str, Sequence[str]]  #: features by group; the keys are all shapes that are used
    caps: Mapping[str, float]
    costs: Mapping[str, float]
    fixed: Mapping[str, Mapping[str, float]]


_PRESSING = ("mouthPress", "mouthRollUpper", "mouthShrugUpper", "mouthShrugLower")
_ARKIT = Kind(
    {
        **dict.fromkeys(("jawOpen", "mouthClose", *_PRESSING), ("jaw", "upper_lip", "lower_lip")),
        "mouthFunnel": ("push_t_lip", "upper_lip", "lower_lip", "spread"),
        "mouthPucker": ("push_t_lip", "push_b_lip", "spread"),
        "mouthSmile": ("jaw", "spread", "corner"),
        "mouthFrown": ("jaw", "corner"),
        "mouthStretch": ("spread", "corner"),
        "mouthUpperUp": ("upper_lip", "lower_lip"),
        "mouthLowerDown": ("jaw", "lower_lip"),
        "mouthRollLower": (),
    },
    {"mouthRollLower": 0.4, **dict.fromkeys(_PRESSING, 0.6)},
    dict.fromkeys((*_PRESSING, "mouthSmile", "mouthFrown"), 4.0),
    {"mouthRollLower": _TO_THE_TEETH},
)
_OCULUS = Kind(
    {
        "PP": ("upper_lip", "lower_lip"), "FF": (), "TH": (), "DD": (), "kk": (), "nn": (),
        "SS": ("jaw", "upper_lip", "spread"), "aa": ("jaw", "upper_lip", "lower_lip"),
        "E": ("upper_lip", "lower_lip", "spread"), "I": ("upper_lip", "spread"),
        "O": ("push_t_lip", "spread", "lower_lip"), "U": ("push_t_lip", "push_b_lip", "spread", "lower_lip"),
    },
    {"FF": 0.25, **dict.fromkeys(("TH", "DD", "kk", "nn"), 0.05)}, {},
    {"FF": _TO_THE_TEETH, **dict.fromkeys(("TH", "DD", "kk", "nn"), _TONGUE)},
)
_VRM = Kind(dict.fromkeys(("aa", "ih", "ou", "ee", "oh"), FEATURES), {}, {}, {})
KINDS: Dict[str, Kind] = {"arkit": _ARKIT, "oculus": _OCULUS, "vrm": _VRM}
#: Other names of the same shapes, as `plain` returns them.
_ALSO = {"fclmtha": "aa", "fclmthi": "ih", "fclmthu": "ou", "fclmthe": "ee", "fclmtho": "oh", "visemeih": "I",
         "visemeoh": "O", "visemeou": "U"}
#: Millimetres by which a shape of another name must move a lip to be used.
_LEAST = 1.0
#: Shapes beyond which solving takes more than some seconds, and fits less well; and the most that are solved for.
_MANY, _MOST = 40, 200


def _names(kind: str) -> Dict[str, str]:
    """The kind's names of shapes, ``Left`` and ``Right`` included, by every plain name that they have."""
    names = {}
    for group in KINDS[kind].allowed:
        for ending in ("", "Left", "Right"):
            names[plain(group + ending)] = group + ending
            if kind == "arkit" and ending:  # mouthSmile_L, as Face Cap and Character Creator spell it
                names[plain(group + ending[0])] = group + ending
            if kind == "oculus":
                names["viseme" + plain(group)] = group
    for other, name in _ALSO.items():
        if name in KINDS[kind].allowed:
            names[other] = name
    return names


def _spellings(shape: str) -> Iterator[str]:
    """Plain names that a shape goes by: its own, and ARKit's if it tells a side otherwise, as ``L_mouthSmile`` does."""
    yield plain(shape)
    for base, side in sided(shape):
        yield base + side


def known(head: Head, kind: str) -> Dict[str, str]:
    """The head's shapes of a kind, by the head's name for them: the kind's name, ``Left`` and ``Right`` included."""
    names = _names(kind)
    found: Dict[str, str] = {}
    for shape in head.shapes:
        known = next((names[name] for name in _spellings(shape) if name in names), None)
        if known is not None and known not in found.values():
            found[shape] = known
    return found


def unknown(head: Head) -> List[str]:
    """The shapes that move the lips, and whose names are neither ARKit's nor those of another kind."""
    names = {plain(column) for column in LIVE_LINK}.union(*map(_names, KINDS))
    names.update(prefix + plain(viseme) for viseme in VISEMES for prefix in ("", "viseme"))
    return [shape for shape in _moving(head) if names.isdisjoint(_spellings(shape))]


def shapes_for(head: Head, kind: str, outputs: Sequence[str]) -> Dict[str, str]:
    """The head's shape for each output of the built-in rig of a kind, as far as it has them."""
    named = {name: shape for shape in reversed(head.shapes) for name in _spellings(shape)}
    named.update({plain(shape): shape for shape in reversed(head.shapes)})
    found = {}
    for output in outputs:
        names = [plain(output)]
        if kind == "arkit":  # mouthSmile_L
            names.append(plain(re.sub("(Left|Right)$", lambda side: side[0][0], output)))
        else:
            own = {"ih": "I", "oh": "O", "ou": "U"}.get(output, output)
            names += ["viseme" + plain(own), "viseme" + plain(output)] if kind == "oculus" else [
                name for name, meaning in _ALSO.items() if meaning == output]
        own_names = [named[name] for name in names if name in named]
        if own_names:
            found[output] = own_names[0]
    return found


def kind_of(head: Head) -> str:
    """The kind whose shapes the head has: ``arkit`` before ``oculus`` before ``vrm``, else ``other``."""
    counts = {kind: known(head, kind) for kind in KINDS}
    if "jawOpen" in counts["arkit"].values() and len(counts["arkit"]) >= 4:
        return "arkit"
    if len(counts["oculus"]) >= 8:
        return "oculus"
    return "vrm" if "aa" in counts["vrm"].values() and len(counts["vrm"]) >= 3 else "other"


def prepare(head: Head, kind: str, single: bool, only: Sequence[str] = ()) -> Tuple[Head, Dict[str, str], Wishes]:
    """The head with the shapes that a rig of this kind uses, under the kind's names; the file's name of each; and what
    is asked of the solution for one head alone or for several. `only` names the shapes to use. Raises LabialError
    where nothing is left."""
    if kind == "other":
        names = {shape: shape for shape in _moving(head)}
        rules = Kind({}, {}, {}, {})
    else:
        names, rules = known(head, kind), KINDS[kind]
    if only:
        missing = [shape for shape in only if shape not in head.shapes]
        if missing:
            raise LabialError(f"{head.name}: no shape is called {missing[0]!r}, there are {', '.join(head.shapes)}")
        names = {shape: names.get(shape, shape) for shape in only}
    if not names:
        raise LabialError(f"{head.name}: none of its shapes is one of {kind}'s")
    if len(names) > _MOST:
        raise LabialError(f"{head.name}: {len(names)} shapes move the lips, more than the {_MOST} that are solved for: "
                          "name those to use with --shapes")
    if len(names) > _MANY:
        warnings.warn(f"{head.name}: solving for {len(names)} shapes takes long; --shapes names those to use",
                      stacklevel=2)
    picked = head.only(list(names))
    renamed = Head(head.name, tuple(names.values()), picked.rest, picked.moves)
    wishes = Wishes(shut=0.0 if single else -0.5, deep=-1.5 if single else -1.9,
                    coefficients=30 if kind == "oculus" else 24, caps=rules.caps, costs=rules.costs,
                    allowed=rules.allowed, fixed=rules.fixed, pairs=of_head(picked) if kind == "other" else None)
    return renamed, {name: shape for shape, name in names.items()}, wishes


def _moving(head: Head) -> List[str]:
    lips = [point for point in head.rest if point not in ("nose", "chin")]
    size = np.max([np.linalg.norm(head.moves[point], axis=1) for point in lips], axis=0)
    used = {shape for shape, move in zip(head.shapes, size) if move >= _LEAST}
    for pair in of_head(head):
        if not used.isdisjoint(pair):
            used.update(pair)  # one of a pair may move the lips a little less than the other
    return [shape for shape in head.shapes if shape in used]
