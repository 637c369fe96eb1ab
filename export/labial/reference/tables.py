"""The two kinds of tables that the reference runs on, behind one interface.

Positions are FAP units as float64 with :class:`FloatTables`, integers in 1/16 FAP unit relative to each channel's
centre with :class:`ExportedTables`; costs are nats or 1/32 nat. Only `to_fap`, `equation` and `complete` leave these
units. C channels are searched and solved, those of a frame that do not follow others.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Optional, Union

import numpy as np

from labial.reference.contact import FRAMES, PARTED
from labial.reference.shape import ShapeTables, choose, pairs_beside, shapes
from labial.reference.viterbi import LAG, Chains, decode, normal_chains
from labial.tables import fixed
from labial.tables.followers import complete, in_integers, interpolated, solved
from labial.tables.model import Model
from labial.tables.quantise import ExportedModel


@dataclass(frozen=True)
class Equation:
    """The terms of equation 3 in each frame. Weights are precisions, all in one channel's free scale; (T, C, 3) for
    static, delta and delta-delta, (T, C) for the anchor; means and targets are FAP units."""

    weight: np.ndarray
    mean: np.ndarray
    anchor: np.ndarray
    target: np.ndarray


class FloatTables:
    """The trained model."""

    dtype = np.float64  #: of positions

    def __init__(self, model: Model) -> None:
        self.model = model
        self.fps = model.fps
        self.phonemes = model.phonemes
        self.silence = model.phonemes.index(model.silence)
        self.boundary = np.asarray(model.boundary, dtype=bool)
        self.viseme_class = np.asarray(model.viseme_class)
        self.lags = np.asarray(model.kernel_lag, dtype=np.int64)
        self.solved = solved(model.source)  #: (C,) the channels of a frame
        own = self.solved
        self.floor = np.asarray(model.floor)[:, own]  #: (P, C)
        self.contact = np.asarray(model.contact)[:, own]  #: (P, C) bool
        self.parted = PARTED[own]  #: (C,)
        self.ahead = _look_ahead(self.lags, bool(np.isfinite(self.floor).any()))
        self.stride = model.search_stride
        self.chains = normal_chains(model.emission_mean[own], model.emission_variance[own], model.log_transition[own],
                                    model.log_initial[own])
        mixtures = {name: getattr(model, name) for name in ShapeTables.__dataclass_fields__}
        self._mixtures = ShapeTables(**{**mixtures, "shape": model.shape[:, own], "slope": model.slope[:, own]})
        self._kernel, self._pair_shape = model.kernel[..., own], model.pair_shape[..., own]
        self.knots = model.pair_shape.shape[1]  #: K, of the shapes of a phoneme

    def select(self, phoneme: np.ndarray, milliseconds: np.ndarray, previous: np.ndarray,
               following: np.ndarray) -> np.ndarray:
        """(S, K, C) shapes of phonemes (S,) of these durations between these neighbours: one for the whole phoneme, or
        one at its start and one at its end."""
        model, classes = self.model, self.viseme_class
        choice = choose(self._mixtures, phoneme, milliseconds / 1000.0, classes[previous], classes[following],
                        soft=bool(model.soft))
        selected = np.repeat(shapes(self._mixtures, choice)[:, None], self.knots, axis=1)
        return selected + pairs_beside(model.pair_key, self._pair_shape, phoneme, previous, following)

    @staticmethod
    def interpolated(knots: np.ndarray, share: np.ndarray) -> np.ndarray:
        """(T, C) the shapes of frames between knots (T, K, C) of `share` (T, K)."""
        return np.einsum("tk,tkc->tc", share, knots)

    def targets(self, shapes: np.ndarray, neighbours: np.ndarray) -> np.ndarray:
        """(T, C) targets before floors: `shapes` (T, C) plus the kernels of `neighbours` (T, L), phonemes."""
        return shapes + self._kernel[neighbours, np.arange(neighbours.shape[1])].sum(axis=1)

    def search(self, targets: np.ndarray, ends: np.ndarray, lag: int = LAG, begin: int = 0,
               searched: int = fixed.SEARCHED) -> np.ndarray:
        """(T, C) int64: the state path for targets (T, C), given the frames (T,) that end units; the first is
        frame `begin` of the stream. A step considers `searched` states."""
        return decode(self.chains, [targets], [ends], self.stride, lag=lag, begin=begin, searched=searched)[0]

    def equation(self, path: np.ndarray, targets: np.ndarray, contact: Optional[np.ndarray] = None) -> Equation:
        """Equation 3's terms for `path` (T, C); frames in `contact` (T, C) follow their target alone."""
        own = self.solved, path
        return _in_contact(Equation(weight=self.model.state_precision[own], mean=self.model.state_mean[own],
                                    anchor=self.model.state_anchor[own],
                                    target=targets), contact, self.model.firm[self.solved])

    def complete(self, motion: np.ndarray) -> np.ndarray:
        """(T, 13) frames of the motion (T, C) that was solved, FAP."""
        model = self.model
        return complete(motion, model.source,
                        lambda corners: interpolated(corners, model.protrusion_range, model.protrusion))

    @staticmethod
    def to_fap(positions: np.ndarray) -> np.ndarray:
        """Positions in FAP units."""
        return positions


class ExportedTables:
    """The exported model; shapes, targets and costs are the library's integers, computed independently of it."""

    dtype = np.int64  #: of positions

    def __init__(self, exported: ExportedModel) -> None:
        self.exported = exported
        self.fps = exported.fps
        self.phonemes = exported.phonemes
        self.silence = exported.silence
        self.boundary = exported.boundary.astype(bool)
        self.viseme_class = exported.viseme_class
        taps = exported.kernels.shape[1]
        self.lags = (np.arange(taps) - exported.kernel_behind) * exported.kernel_stride
        self.solved = solved(exported.source)
        self._channel = np.arange(len(self.solved))
        self.floor = exported.floors[exported.floor]
        self.contact = ((exported.contacts[exported.floor][:, None] >> self._channel) & 1).astype(bool)
        self.parted = PARTED[self.solved] * fixed.POSITION_SCALE
        self.ahead = _look_ahead(self.lags, len(exported.floors) > 1)
        self.stride = exported.search_stride
        self.chains = Chains(exported.emission_mean, exported.dense_transitions(), exported.initial, fixed.LEAP,
                             self.emission)
        self.knots = exported.pairs.shape[1]

    def select(self, phoneme: np.ndarray, milliseconds: np.ndarray, previous: np.ndarray,
               following: np.ndarray) -> np.ndarray:
        """Like :meth:`FloatTables.select`, in positions."""
        each = zip(phoneme.tolist(), milliseconds.tolist(), previous.tolist(), following.tolist())
        selected = np.array([self._select_one(*one) for one in each], dtype=self.dtype)
        return selected.reshape(len(phoneme), self.knots, len(self.solved))

    def _select_one(self, phoneme: int, milliseconds: int, previous: int, following: int) -> np.ndarray:
        """(K, C) shapes of one phoneme, in the library's integer arithmetic."""
        model = self.exported
        first = int(model.first_component[phoneme])
        own = slice(first, first + int(model.component_count[phoneme]))
        distance = milliseconds - model.duration_mean[own]
        z = np.minimum((np.abs(distance) * model.duration_gain[own]) >> 12, fixed.DURATION_Z_MAX)
        cost = model.cost[own] + fixed.z_cost(z)
        if model.contexts is not None:
            before, after = self.viseme_class[previous], self.viseme_class[following]
            cost = cost + 16 * (model.contexts[own, 0, before] + model.contexts[own, 1, after])
        best = int(np.argmin(cost))
        share = np.zeros(len(cost), dtype=np.int64)
        if model.soft:
            likelihood = _likelihood(cost - cost[best])
            share = likelihood * 4096 // likelihood.sum()
        share[best] += 4096 - share.sum()
        deviation = (share * np.clip(np.where(distance < 0, -z, z), -136, 136)) >> 6
        position = fixed.rounded_shift(((share @ model.shapes[own]) >> 4) * model.shape_scale, 16)
        if model.slopes is not None:
            position = position + fixed.rounded_shift(((deviation @ model.slopes[own]) >> 4) * model.slope_scale, 16)
        position = np.repeat(np.clip(position, -fixed.POSITION_MAX, fixed.POSITION_MAX)[None], self.knots, axis=0)
        for key in (phoneme * 256 + previous, phoneme * 256 + 128 + following):
            row = int(np.searchsorted(model.pair_keys, key))
            if row < len(model.pair_keys) and model.pair_keys[row] == key:
                added = fixed.rounded_shift(model.pairs[row] * model.pair_scale, 8)
                position = np.clip(position + added, -fixed.POSITION_MAX, fixed.POSITION_MAX)
        return position

    @staticmethod
    def interpolated(knots: np.ndarray, share: np.ndarray) -> np.ndarray:
        """As :meth:`FloatTables.interpolated`."""
        share = np.floor(share[:, -1:] * 16384.0 + 1e-9).astype(np.int64)  # of the later knot, Q14
        return knots[:, 0] + fixed.rounded_shift((knots[:, -1] - knots[:, 0]) * share, 14)

    def targets(self, shapes: np.ndarray, neighbours: np.ndarray) -> np.ndarray:
        """Like :meth:`FloatTables.targets`, in positions."""
        model = self.exported
        taps = np.arange(neighbours.shape[1])
        added = fixed.rounded_shift(model.kernels[neighbours, taps].sum(axis=1) * model.kernel_scale, 8)
        return np.clip(shapes + added, -fixed.POSITION_MAX, fixed.POSITION_MAX)

    def emission(self, targets: np.ndarray, states: np.ndarray) -> np.ndarray:
        """(..., C, W) costs of states (..., C, W) for targets (..., C), in 1/32 nat."""
        model, own = self.exported, (self._channel[:, None], states)
        distance = np.abs(targets[..., None] - model.emission_mean[own])
        z = np.minimum(fixed.short_gain_z(distance, model.emission_gain[own]), fixed.EMISSION_Z_MAX)
        return fixed.z_cost(z) + model.emission_cost[own]

    def search(self, targets: np.ndarray, ends: np.ndarray, lag: int = LAG, begin: int = 0,
               searched: int = fixed.SEARCHED) -> np.ndarray:
        """As :meth:`FloatTables.search`."""
        return decode(self.chains, [targets], [ends], self.stride, lag=lag, begin=begin, searched=searched)[0]

    def equation(self, path: np.ndarray, targets: np.ndarray, contact: Optional[np.ndarray] = None) -> Equation:
        """Like :meth:`FloatTables.equation`; weights are the integers of the tables."""
        model, own = self.exported, (self._channel, path)
        hold, share = fixed.weight_value(model.state_hold[own]), fixed.share_value(model.state_share[own]) / 256.0
        moving = fixed.weight_value(model.state_weight[own]) * np.array([4, 1])  # the tables hold a quarter of delta's
        return _in_contact(Equation(
            weight=np.concatenate([(hold * (1.0 - share))[..., None], moving], axis=-1),
            mean=model.means()[own] / 16.0 + np.array([1.0, 0.0, 0.0]) * (model.centre / 16.0)[:, None],
            anchor=hold * share, target=self.to_fap(targets)
        ), contact, fixed.weight_value(model.firm))

    def complete(self, motion: np.ndarray) -> np.ndarray:
        """As :meth:`FloatTables.complete`; FAP 17 is the library's integers."""
        table = self.exported.protrusion

        def computed(corners: np.ndarray) -> np.ndarray:
            assert table is not None
            rounded = np.floor(16.0 * corners + 0.5).astype(np.int64)
            return in_integers(rounded, int(table[0]), int(table[1]), table[2:]) / 16.0

        return complete(motion, self.exported.source, computed)

    def to_fap(self, positions: np.ndarray) -> np.ndarray:
        """Positions in FAP units."""
        return (positions + self.exported.centre) / 16.0


def _look_ahead(lags: np.ndarray, has_floors: bool) -> int:
    """The look-ahead of targets in frames, for kernels of these lags (L,) and for short contacts."""
    return max(int(lags[-1]) if len(lags) else 0, FRAMES if has_floors else 0, 0)


def _in_contact(terms: Equation, contact: Optional[np.ndarray], contact_weight: np.ndarray) -> Equation:
    """The terms with the frames in `contact` (T, C) tied to their targets, with weights of at least `contact_weight`
    (C,)."""
    if contact is None:
        return terms
    hold = terms.weight[..., 0] + terms.anchor
    weight = terms.weight.copy()
    weight[..., 0] = np.where(contact, 0.0, weight[..., 0])
    return replace(terms, weight=weight, anchor=np.where(contact, np.maximum(hold, contact_weight), terms.anchor))


def _likelihood(cost: np.ndarray) -> np.ndarray:
    """exp(-cost / 32) in Q15, from the products of two rounded factors; 0 beyond cost 255."""
    cost = np.asarray(cost, dtype=np.int64)
    coarse = np.rint(32768 * np.exp(-np.arange(16) / 2)).astype(np.int64)
    fine = np.rint(32768 * np.exp(-np.arange(16) / 32)).astype(np.int64)
    near = np.minimum(cost, 255)
    return np.where(cost > 255, 0, (coarse[near >> 4] * fine[near & 15]) >> 15)


Tables = Union[FloatTables, ExportedTables]
