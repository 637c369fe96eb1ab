"""Adapts a voice to a talker: what talkers share, from a model, plus his deviation, from half a minute of his speech.

The model is one that was trained with talkers as random effects (:mod:`labial.train.talkers`). Its kernels, shapes,
slopes and pairs are b; those of the talker are b + u, with u by its posterior mean given his motion and the variance of
talkers. How far they move is measured on him anew, in his own units. Everything else of the model, its mixtures, floors
and states, stays.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Dict, List, Sequence

import numpy as np
from threadpoolctl import threadpool_limits

from labial.corpus.episode import Episode, with_even_sides
from labial.corpus.phonesets import PHONE_SETS
from labial.corpus.talkers import brought_to
from labial.errors import LabialError
from labial.files.faps import CHANNELS
from labial.reference.contact import FRAMES
from labial.reference.shape import ShapeTables, choose
from labial.tables.followers import is_symmetric
from labial.tables.model import Model, mean_pose, widened
from labial.train.expression import HALF, shared_gains
from labial.train.kernels import Kernels, Regression, code_of, columns_alike, targets_without_floors
from labial.train.recordings import Recording, occurrences, recordings, with_pauses_cut
from labial.train.talkers import (
    LARGEST_VARIANCE,
    counted_once,
    covariance_of,
    deviation_of,
    equations_of,
    penalties_of,
)
from labial.train.workers import Workers

#: A model's statistics of its training talkers; (13,) each but the variance.
KEYS = ("variance", "deviation", "gain", "middle")


def about_talkers(
    variance: float, deviation: np.ndarray, gain: np.ndarray, middle: np.ndarray
) -> Dict[str, object]:
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


def _deviation(
    model: Model, material: List[Recording], about: Dict[str, np.ndarray], order: np.ndarray
) -> Kernels:
    """The deviation to add to the model, which is not widened, with pairs in ascending `order` (R,)."""
    silence = model.phonemes.index(model.silence)
    key = model.pair_key[order]
    tables = ShapeTables(**{name: getattr(model, name) for name in ShapeTables.__dataclass_fields__})
    shared = Kernels(model.kernel, model.kernel_lag, tables, key, model.pair_shape[order])
    items = occurrences(material, PHONE_SETS[model.kind])
    choice = choose(tables, items.phoneme, items.duration, items.previous, items.next, soft=True)
    asked = Regression(
        tables, model.viseme_class, range(len(model.phonemes)), silence, model.fps, model.kernel_lag,
        code_of(key[:, 0], key[:, 1], key[:, 2], len(model.phonemes)),
        penalties_of(float(about["variance"])), model.pair_shape.shape[1],
    )
    made = targets_without_floors(choice, [shared] * len(material), material, silence)
    left = [replace(item, frames=item.frames - motion) for item, motion in zip(material, made)]
    covariance = covariance_of(asked.prior(), float(about["variance"]))
    zero = np.zeros((len(covariance), CHANNELS))
    own, equations = zero.copy(), equations_of(asked, left, choice, zero[0])
    for channels in columns_alike(left):
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
    """The model of the one talker of `corpus`, whose labels are phonemes of the model's kind.

    `attribution` is added to the model's. Raises LabialError for a model that was not trained with talkers as random
    effects, and for a corpus of several talkers.
    """
    about = _known(model)
    material = _material(model, corpus, about)
    order = np.argsort(code_of(model.pair_key[:, 0], model.pair_key[:, 1], model.pair_key[:, 2], len(model.phonemes)))
    with threadpool_limits(1):  # the same bits for any number of cores
        plain = widened(model, 1.0 / about["gain"], about["middle"], contacts=False)
        own = _deviation(plain, material, about, order)
        back = np.argsort(order)
        plain = replace(
            plain,
            shape=plain.shape + own.tables.shape,
            slope=plain.slope + own.tables.slope,
            kernel=plain.kernel + own.kernel,
            pair_shape=plain.pair_shape + own.pair_shape[back],
        )
        gain = _gain(plain, material, about)
    frames = sum(len(item.frames) for item in material)
    return replace(
        widened(plain, gain, about["middle"], contacts=False),
        attribution=" ".join(filter(None, [model.attribution, attribution])),
        training={
            **model.training,
            "adapted": {"episodes": len(material), "frames": frames},
            "talkers": {"variance": float(about["variance"]), **{name: about[name].tolist() for name in KEYS[1:]},
                        "gain": gain.tolist()},
        },
    )
