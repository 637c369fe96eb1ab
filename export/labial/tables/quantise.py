"""Converts the float model to the library's integer tables, which ``include/labial/model.h`` defines."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any, Dict, List, Optional, Tuple

import numpy as np

from labial.corpus.labels import entries
from labial.corpus.phonesets import LABEL_SETS
from labial.defaults import PREDECESSORS
from labial.errors import ModelError, expect
from labial.files.faps import CHANNELS
from labial.tables import fixed
from labial.tables.fixed import POSITION_MAX, POSITION_SCALE, weight_code, weight_code_below, weight_value
from labial.tables.followers import every, integer_range, solved
from labial.tables.model import Model
from labial.tables.phones import phone_set

#: Version of the format.
FORMAT = 7
#: The library's limits.
LIMITS = {"phonemes": 128, "classes": 32, "components": 8, "states": 64, "taps": 32, "reach": 20, "stride": 8}
#: Steps after which a chain's state frequencies count as stationary.
STATIONARY_STEPS = 2000
#: Least standard deviation of a phoneme's duration, seconds, so that the gain fits its 16 bits.
_DURATION_DEVIATION_MIN = 0.003


@dataclass(frozen=True)
class ExportedModel:
    """The tables of ``labial_model_t``. P phonemes, N components, V classes, Q states, 4 K predecessors, L taps, C
    channels, those of a frame that are their own `source` (:func:`labial.tables.followers.solved`); all arrays int64
    that fit the C types; `contexts`, `slopes` and `protrusion` are None where the model has no use for them."""

    name: str
    kind: str
    method: str
    attribution: str
    fps: int
    phonemes: Tuple[str, ...]
    names: Tuple[Tuple[str, int, Tuple[str, ...]], ...]  #: labels and aliases, phoneme numbers, sets of labels
    silence: int
    soft: bool
    first_component: np.ndarray  #: (P,)
    component_count: np.ndarray  #: (P,)
    viseme_class: np.ndarray  #: (P,)
    classes: Tuple[str, ...]
    boundary: np.ndarray  #: (P,)
    cost: np.ndarray  #: (N,)
    duration_mean: np.ndarray  #: (N,) ms
    duration_gain: np.ndarray  #: (N,)
    contexts: Optional[np.ndarray]  #: (N, 2, V) 1/2 nat, 0 .. 15
    shapes: np.ndarray  #: (N, C)
    slopes: Optional[np.ndarray]  #: (N, C)
    kernels: np.ndarray  #: (P, L, C)
    kernel_stride: int
    kernel_behind: int
    pair_keys: np.ndarray  #: (R,) ascending
    pairs: np.ndarray  #: (R, K', C)
    floor: np.ndarray  #: (P,) row of `floors`
    floors: np.ndarray  #: (1 + F, C); row 0, which the C tables leave out, is NO_FLOOR throughout
    contacts: np.ndarray  #: (1 + F,), bit k: channel k's floor is contact
    centre: np.ndarray  #: (C,)
    firm: np.ndarray  #: (C,) codes
    shape_scale: np.ndarray  #: (C,)
    slope_scale: np.ndarray  #: (C,)
    kernel_scale: np.ndarray  #: (C,)
    pair_scale: np.ndarray  #: (C,)
    emission_mean: np.ndarray  #: (C, Q)
    emission_gain: np.ndarray  #: (C, Q) codes
    emission_cost: np.ndarray  #: (C, Q)
    initial: np.ndarray  #: (C, Q)
    state_mean: np.ndarray  #: (C, Q)
    state_motion: np.ndarray  #: (C, Q, 2) steps
    motion_scale: np.ndarray  #: (C, 2)
    state_hold: np.ndarray  #: (C, Q) codes of the hold: the weights of static feature and anchor together
    state_share: np.ndarray  #: (C, Q) codes of the anchor's share of the hold
    state_weight: np.ndarray  #: (C, Q, 2) codes of a quarter of delta's and of delta-delta's weight
    search_stride: int
    transitions: np.ndarray  #: (C, Q, 4 K, 2), predecessor and cost
    protrusion: Optional[np.ndarray] = None  #: (19,) low, gain and values of ``labial_protrusion_t``
    source: np.ndarray = field(default_factory=every)  #: (13,) as of :class:`labial.tables.model.Model`

    def means(self) -> np.ndarray:
        """(C, Q, 3) the states' means of m, delta and delta-delta, in positions."""
        return np.concatenate([self.state_mean[..., None], scaled(self.state_motion, self.motion_scale)], axis=-1)

    def dense_transitions(self) -> np.ndarray:
        """(C, Q, Q) costs [from, to], inf where there is none."""
        states = self.transitions.shape[1]
        dense = np.full((len(self.transitions), states, states), np.inf)
        channel, to, _ = np.indices(self.transitions.shape[:3])
        np.minimum.at(dense, (channel, self.transitions[..., 0], to), self.transitions[..., 1])
        return dense


#: Which axis of the tables of :func:`quantise` is that of channels.
_AXIS_OF_CHANNELS = {
    "shapes": 1, "slopes": 1, "kernels": 2, "pairs": 2, "centre": 0, "firm": 0, "shape_scale": 0, "slope_scale": 0,
    "kernel_scale": 0, "pair_scale": 0, "emission_mean": 0, "emission_gain": 0, "emission_cost": 0, "initial": 0,
    "state_mean": 0, "state_motion": 0, "motion_scale": 0, "state_hold": 0, "state_share": 0, "state_weight": 0,
    "transitions": 0,
}


def quantise(model: Model, name: str, *, predecessors: int = PREDECESSORS) -> ExportedModel:
    """The exported tables of `model`, with the `predecessors` most frequent transitions into each state. Raises
    ModelError if the model exceeds the library's limits."""
    _check_limits(model)
    first, kept = _shared_components(model)
    centre = _centres(model)
    lags = np.asarray(model.kernel_lag)
    shapes, shape_scale = _steps(model.shape - centre / POSITION_SCALE, 32767, "shape")
    deviation = np.sqrt(np.maximum(model.duration_variance, _DURATION_DEVIATION_MIN**2))
    slopes, slope_scale = _steps(model.slope * deviation[:, None] * np.sqrt(2.0), 16383, "slope")
    kernels, kernel_scale = _steps(model.kernel, 65535, "kernel")
    pairs, pair_scale = _steps(model.pair_shape, 65535, "pair_shape")
    pair_keys = np.asarray(model.pair_key, dtype=np.int64) @ np.array([256, 128, 1])
    order = np.argsort(pair_keys)
    channels = solved(model.source)
    floor, floors, contacts = _floors(model, centre, channels)
    positions = _positions(model.state_mean - (centre[:, None, None] / POSITION_SCALE) * np.array([1.0, 0.0, 0.0]),
                           "state_mean")
    motion, motion_scale = _motion(model.state_mean[..., 1:] * POSITION_SCALE)
    hold, weights, firm = state_weights(model, scaled(motion, motion_scale))
    names = phone_set(model)
    exported = ExportedModel(
        name=name, kind=model.kind, method=model.method, attribution=model.attribution, fps=model.fps,
        phonemes=model.phonemes, classes=model.classes, soft=model.soft, search_stride=model.search_stride,
        names=tuple((text, model.phonemes.index(label), sets) for text, label, sets in entries(
            {labels: names.names(labels) for labels in LABEL_SETS})),
        silence=model.phonemes.index(model.silence), first_component=first,
        component_count=np.asarray(model.component_count), viseme_class=np.asarray(model.viseme_class),
        boundary=np.asarray(model.boundary).astype(np.int64), cost=_component_costs(model, deviation)[kept],
        duration_mean=np.clip(np.rint(model.duration_mean * 1000.0), 0, 65535).astype(np.int64)[kept],
        duration_gain=fixed.gain(deviation * 1000.0)[kept], contexts=_contexts(model, kept),
        shapes=shapes[kept], slopes=slopes[kept] if model.slope.any() else None, kernels=kernels,
        kernel_stride=int(lags[1] - lags[0]) if len(lags) > 1 else 1, kernel_behind=_taps_behind(lags),
        pair_keys=pair_keys[order], pairs=pairs[order], floor=floor, floors=floors, contacts=contacts,
        centre=centre, firm=firm, shape_scale=shape_scale, slope_scale=slope_scale, kernel_scale=kernel_scale,
        pair_scale=pair_scale,
        emission_mean=_positions(model.emission_mean - centre[:, None] / POSITION_SCALE, "emission_mean"),
        emission_gain=fixed.short_gain_code(np.sqrt(model.emission_variance) * POSITION_SCALE),
        emission_cost=_costs(-0.5 * np.log(model.emission_variance)), initial=_costs(model.log_initial),
        state_mean=positions[..., 0], state_motion=motion, motion_scale=motion_scale, state_hold=hold,
        state_share=fixed.share_code(model.state_anchor / (model.state_precision[..., 0] + model.state_anchor)),
        state_weight=weights, transitions=_transitions(model, predecessors), protrusion=_protrusion(model),
        source=np.asarray(model.source))
    own: Dict[str, Any] = {member: np.take(getattr(exported, member), channels, axis=axis)
                           for member, axis in _AXIS_OF_CHANNELS.items() if getattr(exported, member) is not None}
    return replace(exported, **own)


def _check_limits(model: Model) -> None:
    counts = {"phonemes": len(model.phonemes), "classes": len(model.classes),
              "components": int(np.max(model.component_count)), "states": model.log_initial.shape[1],
              "taps": len(model.kernel_lag), "stride": model.search_stride,
              "reach": max([*np.abs(model.kernel_lag), 0])}
    for what, count in counts.items():
        expect(count <= LIMITS[what], f"the model has {what} {count}, the library's limit is {LIMITS[what]}")
    _taps_behind(np.asarray(model.kernel_lag))


def _taps_behind(lags: np.ndarray) -> int:
    """Taps before the frame itself; the lags must be multiples of their spacing."""
    if not len(lags):
        return 0
    stride = int(lags[1] - lags[0]) if len(lags) > 1 else 1
    expect(lags[0] <= 0 <= lags[-1] and lags[0] % stride == 0,
           "kernel lags must be multiples of their spacing, from 0 or before to 0 or after")
    return int(-lags[0] // stride)


def _centres(model: Model) -> np.ndarray:
    """(13,) middle of the range of each channel's states and shapes, Q4."""
    values = np.concatenate([model.state_mean[..., 0], model.emission_mean], axis=1)
    return np.rint((values.min(axis=1) + values.max(axis=1)) / 2.0 * POSITION_SCALE).astype(np.int64)


def _positions(values: np.ndarray, what: str) -> np.ndarray:
    """Values in FAP units as positions."""
    positions = np.rint(values * POSITION_SCALE)
    far = np.abs(positions)
    if not far.max() <= POSITION_MAX:
        at = ", ".join(map(str, np.unravel_index(int(far.argmax()), far.shape)))
        raise ModelError(f"{what}[{at}] lies {np.abs(values).max():.0f} FAP units from the channel's centre, "
                         f"the library's limit is {POSITION_MAX // POSITION_SCALE}")
    return positions.astype(np.int64)


def _steps(values: np.ndarray, largest: int, what: str) -> Tuple[np.ndarray, np.ndarray]:
    """int8 steps (..., 13) of values in FAP units, and the size of a step per channel, (13,), positions in Q8."""
    if not values.size:
        return np.zeros(values.shape, dtype=np.int64), np.zeros(CHANNELS, dtype=np.int64)
    extent = np.abs(values).reshape(-1, CHANNELS).max(axis=0)
    scale = np.ceil(extent * POSITION_SCALE * 256.0 / 127.0)
    if not scale.max() <= largest:
        at = ", ".join(map(str, np.unravel_index(int(np.abs(values).argmax()), values.shape)))
        raise ModelError(f"{what}[{at}] reaches {extent.max():.0f} FAP units, which is more than the tables hold")
    scale = scale.astype(np.int64)
    return np.clip(np.rint(values * POSITION_SCALE * 256.0 / np.maximum(scale, 1)).astype(np.int64), -127, 127), scale


def _floors(model: Model, centre: np.ndarray, channels: np.ndarray) -> Tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Row (P,) of each phoneme's floor, the rows (1 + F, C), positions, and the channels in contact (1 + F,), of the
    `channels` (C,) of a frame."""
    touching = np.asarray(model.contact)[:, channels].astype(np.int64) @ (1 << np.arange(len(channels)))
    position = np.clip(np.rint(model.floor * POSITION_SCALE) - centre, -POSITION_MAX, POSITION_MAX)
    position = np.where(np.isneginf(model.floor), fixed.NO_FLOOR, position).astype(np.int64)[:, channels]
    number = {((fixed.NO_FLOOR,) * len(channels), 0): 0}  # of a row and its contacts
    index = [number.setdefault((tuple(own), of), len(number)) for own, of in zip(position.tolist(), touching.tolist())]
    rows, contacts = zip(*number)
    return np.array(index), np.array(rows), np.array(contacts)


def _protrusion(model: Model) -> Optional[np.ndarray]:
    """(19,) low, gain and values of the table of FAP 17, Q4 FAP."""
    if not len(model.protrusion):
        return None
    values = np.rint(model.protrusion * POSITION_SCALE)
    ends = np.rint(model.protrusion_range * POSITION_SCALE)
    if np.abs(values).max() > POSITION_MAX or np.abs(ends).max() > POSITION_MAX:
        raise ModelError(f"protrusion reaches beyond {POSITION_MAX // POSITION_SCALE} FAP units, the library's limit")
    low, gain = integer_range(model.protrusion_range)
    expect(gain <= 65535, "protrusion_range is narrower than 9 FAP units, which is less than the tables hold")
    return np.array([low, gain, *values], dtype=np.int64)


def _costs(log_probability: np.ndarray) -> np.ndarray:
    """Costs of log-probabilities (..., Q), less the least of their row."""
    best = log_probability.max(axis=-1, keepdims=True)
    return np.minimum(np.rint((best - log_probability) * fixed.COST_SCALE), 255).astype(np.int64)


def _beyond_least(model: Model, cost: np.ndarray) -> np.ndarray:
    """Costs of components (N, ...) less the least of their phoneme, which changes no choice among them."""
    first = model.first_component()[:-1]
    return cost - np.repeat(np.minimum.reduceat(cost, first), model.component_count, axis=0)


def _component_costs(model: Model, deviation: np.ndarray) -> np.ndarray:
    cost = _beyond_least(model, np.rint((np.log(deviation) - model.log_weight) * fixed.COST_SCALE))
    return np.minimum(cost, 65535).astype(np.int64)


def _contexts(model: Model, kept: np.ndarray) -> Optional[np.ndarray]:
    if not model.log_previous.shape[1]:
        return None
    cost = _beyond_least(model, -np.stack([model.log_previous, model.log_next], axis=1))
    return np.minimum(np.rint(2.0 * cost[kept]), 15).astype(np.int64)


def _shared_components(model: Model) -> Tuple[np.ndarray, np.ndarray]:
    """First component (P,) of each phoneme among the stored ones (N',): a substituted phoneme shares its
    substitute's."""
    tables = (model.log_weight, model.duration_mean, model.duration_variance, model.shape, model.slope,
              model.log_previous, model.log_next)
    known: Dict[bytes, int] = {}
    first: List[int] = []
    kept: List[int] = []
    bounds = model.first_component()
    for begin, end in zip(bounds[:-1], bounds[1:]):
        key = b"".join(table[begin:end].tobytes() for table in tables)
        if key not in known:
            known[key] = len(kept)
            kept.extend(range(begin, end))
        first.append(known[key])
    return np.array(first, dtype=np.int64), np.array(kept, dtype=np.int64)


def _transitions(model: Model, predecessors: int) -> np.ndarray:
    """Transitions (13, Q, 4 K, 2), predecessor and cost: for each state its most frequent predecessors, including
    itself, in ascending order; the last one is repeated where there are fewer."""
    states = model.log_initial.shape[1]
    kept_count = min(predecessors, states)
    kept_transitions = np.zeros((CHANNELS, states, kept_count + -kept_count % 4, 2), dtype=np.int64)
    for k in range(CHANNELS):
        cost = np.minimum(np.rint(-fixed.COST_SCALE * model.log_transition[k]), 1e9)
        usage = _stationary(model.log_transition[k])[:, None] * np.exp(model.log_transition[k])
        for q in range(states):
            order = np.argsort(-usage[:, q], kind="stable")
            kept = [int(p) for p in order[:kept_count] if cost[p, q] <= 255 or p == q]
            if q not in kept:
                kept = kept[: kept_count - 1] + [q]
            kept = sorted(kept) + [max(kept)] * (kept_transitions.shape[2] - len(kept))
            kept_transitions[k, q] = [(p, min(cost[p, q], 255)) for p in kept]
    return kept_transitions


def _stationary(log_transition: np.ndarray) -> np.ndarray:
    """(Q,) stationary frequencies of the states of a chain with these transitions (Q, Q)."""
    share = np.full(len(log_transition), 1.0 / len(log_transition))
    step = np.exp(log_transition)
    for _ in range(STATIONARY_STEPS):
        share = 0.5 * (share + share @ step)  # half a step, so that alternating chains converge, too
        share /= share.sum()
    return share


def _motion(means: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """Steps (13, Q, 2) of the means of delta and delta-delta, positions, and the sizes of a step, (13, 2)."""
    scale = np.ceil(np.abs(means).max(axis=1) * 256.0 / 127.0)
    scale = np.minimum(scale, POSITION_MAX * 256 // 127).astype(np.int64)
    return np.clip(np.rint(means * 256.0 / np.maximum(scale, 1)[:, None]).astype(np.int64), -127, 127), scale


def scaled(motion: np.ndarray, scale: np.ndarray) -> np.ndarray:
    """(13, Q, 2) the positions of steps of these sizes (13, 2)."""
    return fixed.rounded_shift(motion * scale[:, None], 8)


def state_weights(model: Model, motion: np.ndarray) -> Tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Codes of the states' holds (13, Q), of the weights of delta (a quarter) and delta-delta (13, Q, 2), and of the
    weight in contact (13,); `motion` (13, Q, 2) are the means of delta and delta-delta, in positions. Each channel's
    precisions are scaled as high as the largest diagonal element allows, after bringing each state within the other
    bounds of equation 3."""
    hold = np.zeros(model.state_anchor.shape, dtype=np.int64)
    moving = np.zeros((*hold.shape, 2), dtype=np.int64)
    firm = np.zeros(CHANNELS, dtype=np.int64)
    for k in range(CHANNELS):
        held = model.state_precision[k, :, 0] + model.state_anchor[k]
        tied = model.state_precision[k, :, 1:] * np.array([0.25, 1.0])
        scale = fixed.WEIGHT_SUM_MAX / float(held.max())
        while True:
            hold[k] = np.maximum(weight_code(held * scale), weight_code(np.array(fixed.WEIGHT_MIN)))
            moving[k] = _within(weight_value(hold[k]), weight_code(tied * scale), np.abs(motion[k]))
            tied_most = float(weight_value(moving[k]).max(axis=0) @ [2, 6])
            most = float(weight_value(hold[k]).max()) + tied_most  # the largest diagonal element states can make
            if most <= fixed.WEIGHT_SUM_MAX:
                break
            scale *= min(fixed.WEIGHT_SUM_MAX / most, 0.99)
        firm[k] = weight_code_below(np.array(min(model.firm[k] * scale, fixed.WEIGHT_SUM_MAX - tied_most)))
    return hold, moving, firm


def _within(hold: np.ndarray, codes: np.ndarray, mean: np.ndarray) -> np.ndarray:
    """Codes (Q, 2) of the weights of delta and delta-delta, lowered where a state is too stiff for its hold (Q,), delta
    exceeds delta-delta, or means (Q, 2), positions, pull too far."""
    codes = _lowered(codes, fixed.STIFFNESS_MAX * hold / np.maximum(weight_value(codes[:, 1]), 1))
    codes[:, 0] = np.minimum(codes[:, 0], codes[:, 1])
    pull = weight_value(codes) * mean
    excess = 4 * pull.max(axis=0).sum() / (fixed.PULL_MAX * hold.min())
    if excess <= 1.0:
        return codes
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(pull > 0, pull.max(axis=0) / excess / pull, np.inf)
    return _lowered(codes, share.min(axis=1))


def _lowered(codes: np.ndarray, share: np.ndarray) -> np.ndarray:
    """Codes (Q, 2) of the weights times a share (Q,), where it is below 1."""
    lower = weight_code_below(weight_value(codes) * np.minimum(share, 1.0)[:, None])
    return np.where(share[:, None] < 1.0, lower, codes)
