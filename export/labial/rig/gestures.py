"""Inputs of outputs: the 13 FAPs by name, and a few named gestures."""

from __future__ import annotations

from typing import Dict, Mapping, NamedTuple, Optional, Tuple

from labial.files.faps import CHANNELS, FAP_COLUMNS, FAP_NAMES

#: A weight or a value for each of the 13 channels. Not an array, since the run-time reads rigs without numpy.
Row = Tuple[float, ...]


class Gesture(NamedTuple):
    """A weighted sum of FAPs, and how far it goes in ordinary speech and laughter."""

    weights: Row
    reach: Optional[float]  #: FAP units of the sum at its full extent; None without a usual one


def _weights(**named: float) -> Row:
    return tuple(float(named.get(name, 0.0)) for name in FAP_COLUMNS)


def _alone(channel: int) -> Row:
    return tuple(float(k == channel) for k in range(CHANNELS))


#: Named sums. The reaches are round numbers near the extremes of a spoken sentence and a laugh. The corners of a mouth
#: sink as its jaw opens; `smile` compensates for this, so that open vowels do not look sad.
GESTURES: Dict[str, Gesture] = {
    "opening": Gesture(_weights(fap51=-1, fap52=-1), 600.0),
    "jaw": Gesture(_weights(fap3=1), 400.0),
    "upper_lip": Gesture(_weights(fap51=-1), 90.0),
    "lower_lip": Gesture(_weights(fap52=-1), 560.0),
    "smile": Gesture(_weights(fap53=0.25, fap54=0.25, fap59=0.25, fap60=0.25, fap3=0.2), 120.0),
    "spread": Gesture(_weights(fap53=0.5, fap54=0.5), 100.0),
    "rounding": Gesture(_weights(fap17=1, fap53=-0.5, fap54=-0.5), 200.0),
}

#: All names for ``from``: gestures, MPEG-4's names of FAPs, columns of a frames file.
SOURCES: Mapping[str, Gesture] = {
    **{name: Gesture(_alone(k), None) for names in (FAP_NAMES, FAP_COLUMNS) for k, name in enumerate(names)},
    **GESTURES,
}

#: Faces to draw a rig with, FAP units: an open vowel, a rounded one, a smile that shows the teeth, and lips pressed on
#: each other over a jaw that is half open, which shows whether a face can close in p, b, m.
POSES: Dict[str, Row] = {
    "mouth open": _weights(fap3=400, fap16=-240, fap52=-600, fap53=-15, fap54=-15, fap57=-490, fap58=-490, fap59=-120,
                           fap60=-120),
    "lips rounded": _weights(fap3=180, fap16=-100, fap17=150, fap51=50, fap52=-250, fap53=-55, fap54=-55, fap55=65,
                             fap56=65, fap57=-210, fap58=-210, fap59=-150, fap60=-150),
    "smile": _weights(fap3=40, fap16=-35, fap17=-35, fap51=-50, fap52=-30, fap53=105, fap54=105, fap55=-65, fap56=-65,
                      fap59=130, fap60=130),
    "lips closed": _weights(fap3=250, fap16=-130, fap51=85, fap52=-125, fap55=60, fap56=60, fap57=-105, fap58=-105,
                            fap59=-50, fap60=-50),
}
