"""Talkers as random effects: what they share, b, and the deviation u_t of each (docs/method.md, Talkers).

With P the inverse prior covariance that one talker alone would have, and v the variance of talkers, b ~ N(0, C) and u_t
~ N(0, V), C = (SHARED P)^-1, V = v C. All talkers' normal equations A_t, B_t, with u_t marginalised, give

    (sum over t of (I + A_t V)^-1 A_t  +  C^-1) b = sum over t of (I + A_t V)^-1 B_t
    u_t = V (I + A_t V)^-1 (B_t - A_t b)

Both sums count a talker by the weight of his corpus. A channel that one talker alone teaches is fitted as without
talkers, with prior P.

A voice is adapted to a talker, from half a minute of his speech, by b of a model that was trained so plus his u. How
far it moves is measured on him anew, in his own units. Its mixtures, floors and states stay.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Dict, List, Mapping, Optional, Sequence, Tuple

import numpy as np
from scipy.linalg import cho_factor, cho_solve
from threadpoolctl import threadpool_limits

from labial.corpus.episode import Episode, with_even_sides
from labial.corpus.phonesets import PHONE_SETS
from labial.corpus.talkers import brought_to
from labial.errors import LabialError
from labial.files.faps import CHANNELS
from labial.reference.contact import FRAMES
from labial.reference.shape import Choice, ShapeTables, choose
from labial.tables.followers import is_symmetric
from labial.tables.model import Model, mean_pose, widened
from labial.train import kernels
from labial.train.expression import HALF, shared_gains
from labial.train.recordings import Recording, occurrences, recordings, with_pauses_cut
from labial.train.workers import Workers

#: How many times stronger the prior of what talkers share is than that of one talker; chosen on talkers left out, where
#: 1 was the best v.
SHARED = 3.0
#: The largest v: beyond it talkers share nothing.
LARGEST_VARIANCE = 1000.0
#: Penalties with talkers, chosen on talkers left out. How one talker's slow phonemes differ from his fast ones, or what
#: single neighbours add, carries over to others least; how a phoneme looks, and its peak, most.
PENALTIES = kernels.Penalties(smoothness=0.1, shape=5.0, slope=300.0, pair=40.0)
#: Least occurrences of a pair with talkers: with 20 as without, the tables are larger and the motion no closer.
PAIR_COUNT_SHARED = 25


def check_variance(variance: Optional[float]) -> None:
    """Raises LabialError for an invalid variance of talkers."""
    if variance is not None and not 0.0 < variance <= LARGEST_VARIANCE:
        raise LabialError(f"talker variance is {variance:g}, not above 0 and at most {LARGEST_VARIANCE:g}")


def counted_once(item: Recording) -> Recording:
    """The recording with equal weights of all values for training, regardless of its corpus's weight."""
    return item if item.weight is None else replace(item, weight=(item.weight > 0).astype(np.float64))


def covariance_of(prior: np.ndarray, variance: float) -> np.ndarray:
    """V (D, D), given P (D, D) and v."""
    return variance / SHARED * np.linalg.inv(prior)


@dataclass(frozen=True)
class Equations:
    """Normal equations of some channels, without the columns (D,) that the talker does not use."""

    columns: np.ndarray  #: (K,) the used columns
    normal: np.ndarray  #: (K, K)
    right: np.ndarray  #: (K, C)

    def marginal(self, covariance: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
        """(I + A V)^-1 A and (I + A V)^-1 B of a deviation's covariance V (D, D)."""
        own = covariance[np.ix_(self.columns, self.columns)]
        count = len(self.columns)
        both = np.linalg.solve(np.eye(count) + self.normal @ own, np.concatenate([self.normal, self.right], axis=1))
        return (both[:, :count] + both[:, :count].T) / 2, both[:, count:]

    def deviation(self, covariance: np.ndarray, shared: np.ndarray) -> np.ndarray:
        """(D, C) u = V (I + A V)^-1 (B - A b) beside the shared coefficients b (D, C)."""
        own = covariance[np.ix_(self.columns, self.columns)]
        left = self.right - self.normal @ shared[self.columns]
        return covariance[:, self.columns] @ np.linalg.solve(np.eye(len(own)) + self.normal @ own, left)


def equations_of(asked: kernels.Regression, material: Sequence[Recording], choice: Choice,
                 base: np.ndarray) -> Dict[int, Tuple[Equations, int]]:
    """By channel, for those that the talker of `material` teaches: his equations and which column of their right sides
    is the channel's."""
    found: Dict[int, Tuple[Equations, int]] = {}
    taught = np.any([item.weights.any(axis=0) for item in material], axis=0)
    for sums in asked.sums(material, choice, base):
        if not taught[sums.channels[0]]:
            continue
        normal, right = sums.equations(asked.penalties.intercept)
        columns = np.flatnonzero(normal.diagonal() > 0)
        equations = Equations(columns, normal[np.ix_(columns, columns)], right[columns])
        found.update({int(channel): (equations, place) for place, channel in enumerate(sums.channels)})
    return found


def deviation_of(found: Dict[int, Tuple[Equations, int]], channels: np.ndarray, covariance: np.ndarray,
                 shared: np.ndarray) -> np.ndarray:
    """(D, C) a talker's deviation from the shared coefficients (D, 13) in `channels` (C,), which have the same
    equations but for their right sides; V is `covariance` (D, D)."""
    equations = found[int(channels[0])][0]
    right = equations.right[:, [found[int(channel)][1] for channel in channels]]
    return replace(equations, right=right).deviation(covariance, shared[:, channels])


def weights_of(material: Sequence[Recording]) -> Dict[str, float]:
    """The weight of each talker: the largest weight of his recordings, which is their corpora's."""
    counts: Dict[str, float] = {}
    for item in material:
        counts[item.talker] = max(counts.get(item.talker, 0.0), float(item.weights.max(initial=0.0)))
    return counts


def fit_talkers(asked: kernels.Regression, material: Sequence[Recording], choice: Choice, variance: float,
                counts: Optional[Mapping[str, float]] = None) -> Tuple[kernels.Kernels, Dict[str, kernels.Kernels]]:
    """What all talkers of `material` share, and each talker's own, by name; `choice` are the components of the
    material's occurrences, `variance` is v, `counts` says how much each talker counts for what they share."""
    base, prior = asked.base(material, choice), asked.prior()
    covariance = covariance_of(prior, variance)
    of = np.repeat([item.talker for item in material], [len(item.phoneme) for item in material])  # each occurrence
    each = {talker: equations_of(asked, [item for item in material if item.talker == talker],
                                 choice.of(np.flatnonzero(of == talker)), base)
            for talker in dict.fromkeys(item.talker for item in material)}
    shared = np.zeros((len(prior), CHANNELS))
    own = {talker: np.zeros(shared.shape) for talker in each}
    for channels in kernels.columns_alike(material):
        first = int(channels[0])
        teachers = [talker for talker, equations in each.items() if first in equations]
        alone = len(teachers) == 1
        normal, right = prior * (1.0 if alone else SHARED), np.zeros((len(prior), len(channels)))
        for talker in teachers:
            equations, _ = each[talker][first]
            places = [each[talker][int(channel)][1] for channel in channels]
            a, b = (equations.normal, equations.right) if alone else equations.marginal(covariance)
            count = 1.0 if alone or counts is None else counts[talker]
            normal[np.ix_(equations.columns, equations.columns)] += count * a
            right[equations.columns] += count * b[:, places]
        shared[:, channels] = cho_solve(cho_factor(normal), right)
        for talker in [] if alone else teachers:
            own[talker][:, channels] = deviation_of(each[talker], channels, covariance, shared)
    return asked.kernels(shared, base), {name: asked.kernels(shared + part, base) for name, part in own.items()}


#: A model's statistics of its training talkers; (13,) each but the variance.
KEYS = ("variance", "deviation", "gain", "middle")


def about_talkers(variance: float, deviation: np.ndarray, gain: np.ndarray, middle: np.ndarray) -> Dict[str, object]:
    """For `Model.training["talkers"]`: the variance of talkers; the standard deviation of their motion outside silence,
    FAP, all being of one scale; by what gain the model was widened, about what pose, FAP."""
    return {"variance": variance, "deviation": deviation.tolist(), "gain": gain.tolist(), "middle": middle.tolist()}


def _known(model: Model) -> Dict[str, np.ndarray]:
    """The model's statistics of its talkers; raises LabialError if they are missing or invalid."""
    told = model.training.get("talkers")
    if model.method != "labial" or not isinstance(told, dict):
        raise LabialError("the model was not trained with --talker-variance, so that it does not tell what talkers "
                          "share")
    try:
        found = {name: np.asarray(told[name], dtype=np.float64) for name in KEYS}
        fits = all(found[name].shape == (CHANNELS,) and np.isfinite(found[name]).all() for name in KEYS[1:])
        fits = fits and found["variance"].shape == () and 0.0 < float(found["variance"]) <= LARGEST_VARIANCE
        fits = fits and bool((found["gain"] > 0).all() and (found["deviation"] >= 0).all())
    except (KeyError, TypeError, ValueError):
        fits = False
    if not fits:
        raise LabialError("what the model says of its talkers is damaged")
    return found


def _material(model: Model, corpus: Sequence[Episode], about: Dict[str, np.ndarray]) -> List[Recording]:
    """The talker's recordings, with the mean and the scale of the model's talkers."""
    phone_set = PHONE_SETS[model.kind]
    if model.phonemes != phone_set.phonemes:
        raise LabialError(f"the model's phonemes are not those of {model.kind}")
    talkers = sorted({item.source.talker for item in corpus})
    if len(talkers) > 1:
        raise LabialError(f"a model is adapted to one talker, but there are {', '.join(talkers)}")
    if is_symmetric(model.source):
        corpus = with_even_sides(corpus)
    scaled = brought_to(corpus, phone_set.silence, mean_pose(model), about["deviation"])
    silence, ahead = phone_set.phonemes.index(phone_set.silence), max(int(model.kernel_lag.max(initial=0)), FRAMES)
    return [counted_once(with_pauses_cut(item, silence, ahead, model.fps))
            for item in recordings(scaled, phone_set, model.fps)]


def _deviation(model: Model, material: List[Recording], about: Dict[str, np.ndarray],
               order: np.ndarray) -> kernels.Kernels:
    """The deviation to add to the model, which is not widened, with pairs in ascending `order` (R,)."""
    silence = model.phonemes.index(model.silence)
    key = model.pair_key[order]
    tables = ShapeTables(**{name: getattr(model, name) for name in ShapeTables.__dataclass_fields__})
    shared = kernels.Kernels(model.kernel, model.kernel_lag, tables, key, model.pair_shape[order])
    items = occurrences(material, PHONE_SETS[model.kind])
    choice = choose(tables, items.phoneme, items.duration, items.previous, items.next, soft=True)
    asked = kernels.Regression(tables, model.viseme_class, range(len(model.phonemes)), silence, model.fps,
                               model.kernel_lag, kernels.code_of(key[:, 0], key[:, 1], key[:, 2], len(model.phonemes)),
                               PENALTIES, model.pair_shape.shape[1])
    made = kernels.targets_without_floors(choice, [shared] * len(material), material, silence)
    left = [replace(item, frames=item.frames - motion) for item, motion in zip(material, made)]
    covariance = covariance_of(asked.prior(), float(about["variance"]))
    zero = np.zeros((len(covariance), CHANNELS))
    own, equations = zero.copy(), equations_of(asked, left, choice, zero[0])
    for channels in kernels.columns_alike(left):
        if channels[0] in equations:
            own[:, channels] = deviation_of(equations, channels, covariance, zero)
    return asked.kernels(own, zero[0])


def _gain(plain: Model, material: List[Recording], about: Dict[str, np.ndarray]) -> np.ndarray:
    """The gain (13,) with which the talker's model moves as far as he does: measured on him and, the less there is of
    him, the nearer to that of the model's talkers."""
    (talker,) = {item.talker for item in material}
    with Workers(1, progress=False) as workers:
        own, _ = shared_gains(plain, material, workers, {talker: 1.0})
    frames = sum(len(item.frames) for item in material)
    return np.asarray(about["gain"] * (own / about["gain"]) ** (frames / (frames + HALF)))


def adapted(model: Model, corpus: Sequence[Episode], attribution: str = "") -> Model:
    """The model of the one talker of `corpus`, whose labels are phonemes of the model's kind. `attribution` is added to
    the model's. Raises LabialError for a model that was not trained with talkers as random effects, and for a corpus of
    several talkers."""
    about = _known(model)
    material = _material(model, corpus, about)
    key = model.pair_key
    order = np.argsort(kernels.code_of(key[:, 0], key[:, 1], key[:, 2], len(model.phonemes)))
    with threadpool_limits(1):  # the same bits for any number of cores
        plain = widened(model, 1.0 / about["gain"], about["middle"], contacts=False)
        own = _deviation(plain, material, about, order)
        back = np.argsort(order)
        plain = replace(plain, shape=plain.shape + own.tables.shape, slope=plain.slope + own.tables.slope,
                        kernel=plain.kernel + own.kernel, pair_shape=plain.pair_shape + own.pair_shape[back])
        gain = _gain(plain, material, about)
    frames = sum(len(item.frames) for item in material)
    told = about_talkers(float(about["variance"]), about["deviation"], gain, about["middle"])
    return replace(
        widened(plain, gain, about["middle"], contacts=False),
        attribution=" ".join(filter(None, [model.attribution, attribution])),
        training={**model.training, "adapted": {"episodes": len(material), "frames": frames}, "talkers": told})
