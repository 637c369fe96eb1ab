"""Temporal kernels and pairs: the ridge regression of human motion (docs/method.md, Pairs and Temporal kernels).

Shapes, slopes, pairs and kernels are fitted jointly, since a shape measured at the apex already includes what the
kernels add. Only pairs that occur often enough are kept; the classes and the kernels account for all others.

The phonemes do not determine where a talker's lips rest in an utterance: each training utterance has an intercept in
the regression, shrunk towards 0, which is dropped afterwards. Values count by their weight; penalties are multiplied by
the largest weight of the channel, so that a larger weight does not weaken the prior.

A phoneme's kernel is its viseme class's kernel plus a residual of its own, with penalties 1 : RESIDUAL_PENALTY on their
squares. Summed over both parts that is one Gaussian prior on the phonemes' kernels, with covariance M M' + I /
RESIDUAL_PENALTY between phonemes (M: P x V membership), and this is how it is solved: a phoneme that never occurs gets
its class's kernel. Along the taps the prior is a first-order process of correlation SMOOTHNESS.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Iterator, List, Sequence, Tuple, Union

import numpy as np
from scipy.linalg import block_diag, cho_factor, cho_solve
from scipy.sparse import csc_matrix, csr_matrix, diags, hstack, identity, vstack

from labial.defaults import LOOK_AHEAD
from labial.files.faps import CHANNELS
from labial.reference.shape import (
    Choice,
    ShapeTables,
    add_kernels,
    knot_shares,
    neighbours,
    pairs_beside,
    shapes,
    tapped,
)
from labial.tables.quantise import LIMITS
from labial.train.recordings import Recording

#: The taps reach this far to each side and are this far apart, in seconds.
REACH = 0.36
SPACING = 0.04
#: Limit of the reach, in frames: the device's LABIAL_REACH.
REACH_FRAMES = LIMITS["reach"]
#: Frames that the regression reads at once, some 2.5 KB each.
BLOCK = 65536
#: Least occurrences of a pair with its own correction, regardless of their weights.
PAIR_COUNT = 20
#: Knots of a pair: one for a constant shape, two for one that changes from the phoneme's start to its end.
PAIR_KNOTS = 2


@dataclass(frozen=True)
class Penalties:
    """Strength of the priors, in frames at 50 frames per second: with this many frames the estimate is halfway between
    prior and data. Chosen on held-out words."""

    kernel: float = 50.0  #: of the class kernels
    residual: float = 6.0  #: factor of the penalty of a phoneme's own residual
    smoothness: float = 0.5  #: correlation of neighbouring taps
    shape: float = 30.0  #: of a component's shape
    slope: float = 30.0  #: of a component's slope per standard deviation of its duration
    pair: float = 10.0  #: of what a neighbour adds to a phoneme's shape
    silence: float = 0.1  #: weight of a frame of silence
    intercept: float = 10.0  #: of where an utterance's motion lies, each channel


def lags(fps: int, look_ahead: float = LOOK_AHEAD) -> np.ndarray:
    """(L,) int64 frames: evenly spaced taps, one of them at 0, from REACH seconds before the frame to `look_ahead`
    seconds after it; at most REACH_FRAMES to either side."""
    spacing = max(1, round(SPACING * fps))
    behind, ahead = (min(round(reach * fps), REACH_FRAMES) // spacing for reach in (REACH, look_ahead))
    return np.arange(-behind, ahead + 1, dtype=np.int64) * spacing


def code_of(phoneme: np.ndarray, side: Union[int, np.ndarray], neighbour: np.ndarray, phonemes: int) -> np.ndarray:
    """A phoneme with its previous (`side` 0) or next neighbour (1) as one number, (2 phoneme + side) P + neighbour."""
    return (2 * phoneme + side) * phonemes + neighbour


def pair_codes(material: Sequence[Recording], phonemes: int, silence: int) -> np.ndarray:
    """(occurrences, 2): the codes of each phoneme with its previous and with its next neighbour."""
    return np.concatenate([code_of(item.phoneme[:, None], np.arange(2),
                                   np.stack(neighbours(item.phoneme, silence), axis=1), phonemes) for item in material])


def _design(material: Sequence[Recording], choice: Choice, deviation: np.ndarray, phonemes: int, lag: np.ndarray,
            silence: int, pairs: np.ndarray, knots: int) -> csr_matrix:
    """(T, P L + 2 N + R K) of all frames: one-hot taps, shares of the components, those times (d - mu_c) / sigma_c, and
    the shares of the knots of those `pairs` (R,), codes, that the phoneme and its neighbours are. `deviation` is (N,),
    sigma_c in seconds."""
    taps, components = len(lag), len(deviation)
    column = np.concatenate([tapped(item.phoneme_at(), lag, silence) for item in material]) * taps + np.arange(taps)
    rows = len(column)
    onehot = csr_matrix((np.ones(column.size), column.ravel(), np.arange(rows + 1) * taps),
                        shape=(rows, phonemes * taps))
    occurrences, width = choice.share.shape
    start = np.arange(occurrences + 1) * width

    def per_component(values: np.ndarray) -> csr_matrix:
        return csr_matrix((values.ravel(), choice.component.ravel(), start), shape=(occurrences, components))

    lengths = np.concatenate([item.length for item in material])
    segment = np.repeat(np.arange(occurrences), lengths)
    share = per_component(choice.share)[segment]
    slope = per_component(choice.share * choice.offset / deviation[choice.component])[segment]
    codes = pair_codes(material, phonemes, silence)
    at = np.minimum(np.searchsorted(pairs, codes), max(len(pairs) - 1, 0))
    known = pairs[at] == codes if len(pairs) else np.zeros(codes.shape, dtype=bool)
    occurrence, _ = np.nonzero(known)
    beside = csr_matrix((np.ones(len(occurrence)), (occurrence, at[known])), shape=(occurrences, len(pairs)))[segment]
    part = knot_shares(lengths, knots)
    between = [diags(part[:, knot]) @ beside for knot in range(knots)]
    return hstack([onehot, share, slope, *between]).tocsr()


def columns_alike(material: Sequence[Recording]) -> List[np.ndarray]:
    """Groups of channels with equal weights in every frame."""
    alike = np.ones((CHANNELS, CHANNELS), dtype=bool)
    for item in material:
        if item.weight is not None:
            alike &= np.all(item.weight[:, :, None] == item.weight[:, None, :], axis=0)
    return [np.flatnonzero(row) for channel, row in enumerate(alike) if not row[:channel].any()]


class _Sums:
    """The sums of a ridge regression over frames, for channels with the same weights. Each sum goes over the frames in
    their order, so that its last bit does not depend on the blocks."""

    def __init__(self, columns: int, channels: np.ndarray) -> None:
        self.channels = channels
        self._normal = csc_matrix((columns, columns))
        self._right = np.zeros((columns, len(channels)))
        self._of_utterances: List[Tuple[np.ndarray, np.ndarray, np.ndarray]] = []

    def add(self, design: csr_matrix, motion: np.ndarray, weight: np.ndarray, utterance: np.ndarray) -> None:
        """Adds frames: `design` (T, D), `motion` (T, C) of the channels, their weights (T,) and the numbers (T,) of
        their utterances, from 0 on."""
        weighted = (diags(weight) @ design).tocsr()
        # The previous sum precedes the frames, as rows whose product is that sum.
        before = vstack([identity(design.shape[1], format="csr"), weighted]).tocsr()
        self._normal = before.T @ vstack([self._normal.tocsr(), design]).tocsr()
        self._right = before.T @ np.concatenate([self._right, motion])
        sums = csr_matrix((np.ones(len(weight)), (utterance, np.arange(len(weight)))))
        self._of_utterances.append(((sums @ weighted).toarray(), sums @ (weight[:, None] * motion), sums @ weight))

    def equations(self, intercept: float, prior: Union[float, np.ndarray] = 0.0) -> Tuple[np.ndarray, np.ndarray]:
        """The matrix (D, D) and right sides (D, C) of the normal equations, X' W X + prior and X' W y, of which an
        intercept for each utterance, of penalty `intercept`, is solved for. With S the utterances' weighted sums of the
        design and s their weights, these are X' W X + prior - S' (s + intercept)^-1 S and X' W y - S' (s +
        intercept)^-1 (weighted sums of y)."""
        normal, right = self._normal.toarray(), self._right
        normal += prior
        if np.isfinite(intercept):
            design_sums, motion_sums, weights = (np.concatenate(items) for items in zip(*self._of_utterances))
            shrunk = design_sums / (weights + intercept)[:, None]
            normal -= design_sums.T @ shrunk
            right = right - shrunk.T @ motion_sums
        return normal, right


@dataclass(frozen=True)
class Kernels:
    """The temporal kernels, and the shapes that go with them."""

    kernel: np.ndarray  #: (P, L, 13) FAP
    lag: np.ndarray  #: (L,) int64 frames
    tables: ShapeTables  #: with shapes and slopes fitted jointly
    pair_key: np.ndarray  #: (R, 3) int64: phoneme, side, neighbour
    pair_shape: np.ndarray  #: (R, K, 13) FAP


@dataclass(frozen=True)
class Regression:
    """The regression: the columns of the design (D) - kernels, shapes, slopes and pairs - and their meaning."""

    tables: ShapeTables  #: their shapes and slopes are not used
    viseme_class: np.ndarray  #: (P,)
    stand_in: Sequence[int]  #: (P,)
    silence: int
    fps: int
    lag: np.ndarray  #: (L,) int64 frames
    pairs: np.ndarray  #: (R,) codes (:func:`code_of`)
    penalties: Penalties
    knots: int  #: K

    @property
    def deviation(self) -> np.ndarray:
        """(N,) seconds: the standard deviation of each component's durations."""
        return np.sqrt(self.tables.duration_variance)

    @property
    def sizes(self) -> Tuple[int, int, int]:
        """The numbers of columns for taps of kernels, components (shapes, and as many slopes), and knots of pairs."""
        return len(self.viseme_class) * len(self.lag), len(self.tables.shape), self.knots * len(self.pairs)

    def prior(self) -> np.ndarray:
        """(D, D) inverse prior covariance of the coefficients of a channel."""
        _, components, knots = self.sizes
        given, taps = self.penalties, np.arange(len(self.lag))
        member = self.viseme_class[:, None] == self.viseme_class
        between_phonemes = member + np.eye(len(member)) / given.residual
        along = given.smoothness ** np.abs(np.subtract.outer(taps, taps))
        kernels = given.kernel * np.kron(np.linalg.inv(between_phonemes), np.linalg.inv(along))
        others = np.repeat([given.shape, given.slope, given.pair], [components, components, knots])
        return block_diag(kernels, np.diag(others))

    def blocks(self, material: Sequence[Recording],
               choice: Choice) -> Iterator[Tuple[Sequence[Recording], Choice, np.ndarray, np.ndarray]]:
        """The material in blocks of `BLOCK` frames, which limits memory: some utterances, the components of their
        occurrences, their motion (T, 13), FAP, and the weights (T, 13) of its values."""
        first = occurrence = frames = 0
        for last, item in enumerate(material, 1):
            frames += len(item.frames)
            if frames < BLOCK and last < len(material):
                continue
            part = material[first:last]
            end = occurrence + sum(len(each.phoneme) for each in part)
            weights = [each.weights * np.where(each.sounds(self.silence), 1.0, self.penalties.silence)[:, None]
                       * 50.0 / self.fps for each in part]
            yield (part, choice.of(slice(occurrence, end)), np.concatenate([each.frames for each in part]),
                   np.concatenate(weights))
            first, occurrence, frames = last, end, 0

    def sums(self, material: Sequence[Recording], choice: Choice, base: np.ndarray) -> List[_Sums]:
        """The sums of the regression over `material`, whose motion is relative to `base` (13,) FAP; `choice` are its
        occurrences' components."""
        taps, components, knots = self.sizes
        groups = [_Sums(taps + 2 * components + knots, channels) for channels in columns_alike(material)]
        for part, own, motion, weight in self.blocks(material, choice):
            design = _design(part, own, self.deviation, len(self.viseme_class), self.lag, self.silence, self.pairs,
                             self.knots)
            utterance = np.repeat(np.arange(len(part)), [len(item.frames) for item in part])
            for sums in groups:
                of = sums.channels
                sums.add(design, motion[:, of] - base[of], weight[:, of[0]], utterance)
        return groups

    def base(self, material: Sequence[Recording], choice: Choice) -> np.ndarray:
        """(13,) FAP: the weighted mean of the motion."""
        total = weight = np.zeros((0, CHANNELS))
        for _, _, motion, own in self.blocks(material, choice):
            total = np.concatenate([total, motion * own]).sum(axis=0, keepdims=True)  # row by row, as a sum of all
            weight = np.concatenate([weight, own]).sum(axis=0, keepdims=True)
        return total[0] / weight[0]

    def kernels(self, solution: np.ndarray, base: np.ndarray) -> Kernels:
        """The result of coefficients (D, 13), for motion relative to `base` (13,) FAP. Substituted phonemes have all
        parameters of their substitutes."""
        phonemes, owner = len(self.viseme_class), np.asarray(self.stand_in, dtype=np.int64)
        taps, components, _ = self.sizes
        kernel, shape, slope, pair = np.split(solution, [taps, taps + components, taps + 2 * components])
        first = np.concatenate([[0], np.cumsum(self.tables.component_count)])
        own = np.concatenate([np.arange(first[other], first[other + 1]) for other in owner])
        tables = replace(self.tables, shape=(base + shape)[own], slope=(slope / self.deviation[:, None])[own])
        key = np.stack([self.pairs // (2 * phonemes), self.pairs // phonemes % 2, self.pairs % phonemes], axis=1)
        return Kernels(kernel=kernel.reshape(phonemes, len(self.lag), CHANNELS)[owner], lag=self.lag, tables=tables,
                       pair_key=key,
                       pair_shape=pair.reshape(self.knots, len(self.pairs), CHANNELS).transpose(1, 0, 2))


def regression(material: Sequence[Recording], tables: ShapeTables, viseme_class: np.ndarray, stand_in: Sequence[int],
               silence: int, fps: int, penalties: Penalties, look_ahead: float = LOOK_AHEAD, knots: int = PAIR_KNOTS,
               pair_count: int = PAIR_COUNT) -> Regression:
    """The columns for `material`, of whose pairs those that occur at least `pair_count` times. `viseme_class` is (P,),
    `stand_in` (P,) the phoneme whose mixture each phoneme uses, mostly itself; `look_ahead` is in seconds; `knots` is
    K."""
    learnt = np.concatenate([item.learnt() for item in material])
    code, count = np.unique(pair_codes(material, len(viseme_class), silence)[learnt], return_counts=True)
    return Regression(tables, viseme_class, stand_in, silence, fps, lags(fps, look_ahead), code[count >= pair_count],
                      penalties, knots)


def fit_kernels(asked: Regression, material: Sequence[Recording], choice: Choice) -> Kernels:
    """Fits kernels, shapes and slopes to the human motion of `material`; `choice` are its occurrences' components."""
    base, prior = asked.base(material, choice), asked.prior()
    solution = np.empty((len(prior), CHANNELS))
    for sums in asked.sums(material, choice, base):
        strength = max(float(item.weights[:, sums.channels[0]].max()) for item in material)
        weighed = prior if strength == 1.0 else strength * prior  # as large as the matrix itself
        normal, right = sums.equations(strength * asked.penalties.intercept, weighed)
        solution[:, sums.channels] = cho_solve(cho_factor(normal), right)
    return asked.kernels(solution, base)


def targets_without_floors(choice: Choice, own: Sequence[Kernels], material: Sequence[Recording],
                           silence: int) -> List[np.ndarray]:
    """The targets (T, 13) of recordings, FAP, each by kernels of its `own`, before floors and contact; `choice` is that
    of the occurrences of `material`."""
    result, first = [], 0
    for fitted, item in zip(own, material):
        rows = slice(first, first + len(item.phoneme))
        first = rows.stop
        added = pairs_beside(fitted.pair_key, fitted.pair_shape, item.phoneme, *neighbours(item.phoneme, silence))
        part = knot_shares(item.length, fitted.pair_shape.shape[1])
        held = (np.repeat(shapes(fitted.tables, choice.of(rows)), item.length, axis=0)
                + np.einsum("tk,tkc->tc", part, np.repeat(added, item.length, axis=0)))
        result.append(add_kernels(held, item.phoneme_at(), fitted.kernel, fitted.lag, silence))
    return result
