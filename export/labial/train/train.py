"""From a corpus to a model: the whole training, in the order of the method."""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from typing import Dict, List, Tuple
from typing import Sequence as SequenceOf

import numpy as np
from threadpoolctl import threadpool_limits

from labial.corpus.episode import Episode
from labial.errors import LabialError
from labial.faps import CHANNELS, FAP_COLUMNS
from labial.model import KINDS, METHODS, Model
from labial.phonesets import PHONE_SETS, PhoneSet
from labial.quantise import LIMITS
from labial.reference.contact import FRAMES, raised
from labial.train.closures import FIRMNESS, floors
from labial.train.codebook import Codebook, Division, lbg, train_channel
from labial.train.context import fit_context
from labial.train.expression import restored
from labial.train.kernels import LOOK_AHEAD, PAIR_KNOTS, REACH, Kernels, Penalties, add_kernels, fit_kernels, lags
from labial.train.selection import Choice, choose, shapes
from labial.train.sequences import Occurrences, Sequence, occurrences, sequences, with_pauses_cut
from labial.train.shapes import Mixture, Plan, ShapeTables, back_off, corpus_scale, fit_mixture, shape_tables
from labial.train.states import SEARCH_STRIDE, Scales, StateTables, codebook_tables, decode, match_states
from labial.train.workers import Workers

#: Utterances whose paths are decoded at once.
BATCH = 40


@dataclass(frozen=True)
class _MixtureTask:
    vectors: np.ndarray
    previous: np.ndarray
    next: np.ndarray
    scale: np.ndarray
    components: int
    classes: int  # 0: without context
    seed: int


def _mixture(task: _MixtureTask) -> Mixture:
    mixture = fit_mixture(task.vectors, task.scale, task.components, task.seed)
    if task.classes:
        mixture = fit_context(mixture, task.vectors, task.scale, task.previous, task.next, task.classes)
    return mixture


def _mixture_tasks(
    items: Occurrences, plan: Plan, classes: int, components: int, seed: int
) -> List[_MixtureTask]:
    """The mixtures to fit. Their samples count once each, whatever they weigh: what they say, and the regression that
    follows does not, is how durations and neighbours go together, which weights did not better."""
    vectors, learnt = items.vectors(), items.learnt
    scale = corpus_scale(vectors[learnt])
    tasks = []
    for members in plan.members:
        if members is not None:
            rows = np.flatnonzero(np.isin(items.phoneme, members) & learnt)
            tasks.append(
                _MixtureTask(vectors[rows], items.previous[rows], items.next[rows], scale, components, classes, seed)
            )
    return tasks


def _tables(plan: Plan, fitted: List[Mixture], conditional: bool) -> ShapeTables:
    """The tables of all phonemes from the mixtures of those that have one of their own."""
    own = iter(fitted)
    mixtures: Dict[int, Mixture] = {p: next(own) for p, members in enumerate(plan.members) if members is not None}
    return shape_tables([mixtures[other] for other in plan.stand_in], conditional=conditional)


def _channel(task: Tuple[List[np.ndarray], List[np.ndarray], int, int, Division]) -> Codebook:
    return train_channel(*task)


def _decode(task: Tuple[List[np.ndarray], List[np.ndarray], StateTables]) -> List[np.ndarray]:
    return decode(*task)


def _unit_ends(item: Sequence, boundary: np.ndarray) -> np.ndarray:
    """(T,) bool: the frames that end a unit, the last ones of boundary phonemes and of the utterance."""
    ends = np.zeros(len(item.frames), dtype=bool)
    ends[np.cumsum(item.length)[boundary[item.phoneme]] - 1] = True
    ends[-1] = True
    return ends


def _unit_starts(item: Sequence, boundary: np.ndarray) -> np.ndarray:
    """Frames at which boundary phonemes, and so units, begin; the utterance's first and last phoneme are some too."""
    starts = np.cumsum(item.length) - item.length
    begins = boundary[item.phoneme].copy()
    begins[[0, -1]] = True
    return starts[begins & (item.length > 0)]


def _stretches(
    material: SequenceOf[Sequence], starts: SequenceOf[np.ndarray], channel: int
) -> Tuple[List[np.ndarray], List[np.ndarray]]:
    """The stretches of one channel's motion (T,) that are learnt from, and the frames at which units begin in each."""
    motion, begins = [], []
    for item, start in zip(material, starts):
        learnt = np.concatenate([[False], item.weights[:, channel] > 0, [False]])
        edges = np.flatnonzero(learnt[1:] != learnt[:-1]).reshape(-1, 2)
        for first, end in edges:
            motion.append(item.frames[first:end, channel])
            begins.append(start[(start >= first) & (start < end)] - first)
    return motion, begins


def _targets(
    choice: Choice,
    fitted: Kernels,
    material: SequenceOf[Sequence],
    silence: int,
    floor: np.ndarray,
    contact: np.ndarray,
) -> List[np.ndarray]:
    """The target (T, 13) of every sequence, FAP; `choice` is that of the occurrences of `material`."""
    selected = np.split(shapes(fitted.tables, choice), np.cumsum([len(item.phoneme) for item in material])[:-1])
    result = []
    for shape, item in zip(selected, material):
        held = np.repeat(shape, item.length, axis=0) + fitted.pairs_at(item, silence)
        moving = add_kernels(held, item.phoneme_at(), fitted.kernel, fitted.lag, silence)
        result.append(raised(moving, item.phoneme_at(), item.length, item.rest, silence, floor, contact)[0])
    return result


def _check(
    corpus: SequenceOf[Episode], kind: str, method: str, fps: int, codebook: int, components: int, jobs: int
) -> None:
    if kind not in KINDS:
        raise LabialError(f"kind is {kind!r}, not one of {', '.join(KINDS)}")
    if method not in METHODS:
        raise LabialError(f"method is {method!r}, not one of {', '.join(METHODS)}")
    for name, value, most in (
        ("fps", fps, 250),
        ("codebook", codebook, LIMITS["states"]),
        ("components", components, LIMITS["components"]),
        ("jobs", jobs, 1024),
    ):
        if not 1 <= value <= most:
            raise LabialError(f"{name} is {value}, not within 1 .. {most}")
    if not corpus:
        raise LabialError("the corpus is empty")


def _own(penalties: Penalties, kind: str) -> Penalties:
    """The penalties of a kind. Where the mouth rests in an utterance is the talker's in speech; in laughter it is how
    hard somebody laughs, which the phonemes' grades tell, and no intercept must take that from them."""
    return penalties if kind == "speech" else replace(penalties, intercept=np.inf)


def _check_taught(material: SequenceOf[Sequence]) -> None:
    untaught = ~np.any([item.weights.any(axis=0) for item in material], axis=0)
    if untaught.any():
        names = ", ".join(np.array(FAP_COLUMNS)[untaught])
        raise LabialError(f"nothing is left to learn {names} from: every corpus leaves this out")


def _extent(material: SequenceOf[Sequence], silence: int) -> Dict[str, object]:
    """How far the channels reach, from their 1st to their 99th percentile, and their mean pose outside silence."""
    everything = np.concatenate([item.frames for item in material])
    weight = np.concatenate([item.weights for item in material])
    reach = [np.ptp(np.percentile(values[of > 0], [1, 99])) for values, of in zip(everything.T, weight.T)]
    sounding = np.concatenate([item.phoneme_at() != silence for item in material])
    if sounding.any():
        everything, weight = everything[sounding], weight[sounding]
    pose = np.average(everything, axis=0, weights=weight)
    return {"channel_range": np.round(reach, 3).tolist(), "mean_pose": np.round(pose, 3).tolist()}


def _report(plan: Plan, phone_set: PhoneSet, counts: np.ndarray) -> None:
    """Says which phonemes had too few samples, and what they use instead."""
    for label, name in plan.pooled.items():
        print(f"{label}: {counts[phone_set.phonemes.index(label)]} samples, uses those of its viseme class {name}")
    for label, other in plan.substitutes.items():
        print(f"{label}: {counts[phone_set.phonemes.index(label)]} samples, uses the shapes of {other}")


def train(
    corpus: SequenceOf[Episode],
    *,
    kind: str,
    method: str,
    fps: int = 50,
    codebook: int = 50,
    components: int = 5,
    seed: int = 0,
    jobs: int = 2,
    progress: bool = True,
    attribution: str = "",
    look_ahead: float = LOOK_AHEAD,
    search_stride: int = SEARCH_STRIDE,
    pair_knots: int = PAIR_KNOTS,
    penalties: Penalties = Penalties(),  # noqa: B008 - immutable
    scales: Scales = Scales(),  # noqa: B008 - immutable
    divide: Division = lbg,
) -> Model:
    """Trains a model of `kind` ("speech" or "laughter") on episodes whose labels are phonemes of that kind.

    `method` is "paper", the published one, or "labial": context-aware mixtures, temporal kernels, matched
    states and anchors on top. `codebook` is Q, the states of each channel, `components` C of each phoneme's mixture.
    `look_ahead` is how far the temporal kernels reach into what follows, seconds; less makes a stream's frames earlier.
    `pair_knots` is 2 for pairs that move from the phoneme's start to its end, 1 for such as stand still.
    `search_stride` is how many frames share a state of the decoded path. The published method has neither.
    `divide` makes the codebooks' cells; with more than one job it must be a module's own function.
    `attribution` is kept in the model for whoever passes it on. The same arguments give the same model, whatever
    `jobs`, the number of processes, is. Back-offs are printed; the corpus's counts and all options are kept in the
    model.
    """
    _check(corpus, kind, method, fps, codebook, components, jobs)
    if not 0.0 <= look_ahead <= REACH:
        raise LabialError(f"look-ahead is {look_ahead} s, not within 0 .. {REACH}")
    if not 1 <= search_stride <= LIMITS["stride"]:
        raise LabialError(f"search stride is {search_stride}, not within 1 .. {LIMITS['stride']}")
    phone_set = PHONE_SETS[kind]
    phonemes, classes = len(phone_set.phonemes), len(phone_set.classes)
    silence = phone_set.phonemes.index(phone_set.silence)
    phoneme_class = np.array(phone_set.phoneme_class, dtype=np.int64)
    boundary = np.array(phone_set.boundary, dtype=bool)
    extended = method == "labial"
    stride = search_stride if extended else 1

    material = sequences(corpus, phone_set, fps)
    if extended:
        ahead = max(int(lags(fps, look_ahead)[-1]), FRAMES)
        material = [with_pauses_cut(item, silence, ahead, fps) for item in material]
    _check_taught(material)
    items = occurrences(material, phone_set)
    counts = np.bincount(items.phoneme[items.learnt], minlength=phonemes)
    plan = back_off(counts, phone_set)
    _report(plan, phone_set, counts)

    floor, contact = np.full((phonemes, CHANNELS), -np.inf), np.zeros((phonemes, CHANNELS), dtype=bool)
    if extended:
        floor, contact = floors(material, phone_set, fps)
    with Workers(jobs, progress) as workers, threadpool_limits(1):
        tasks = _mixture_tasks(items, plan, classes if extended else 0, components, seed)
        tables = _tables(plan, workers.run("lip shapes", _mixture, tasks), extended)
        starts = [_unit_starts(item, boundary) for item in material]
        motion = [(*_stretches(material, starts, c), codebook, stride, divide) for c in range(CHANNELS)]
        states = codebook_tables(workers.run("codebooks", _channel, motion), stride)
        kernel, lag = np.zeros((phonemes, 0, CHANNELS)), np.zeros(0, dtype=np.int64)
        pair_key, pair_shape = np.zeros((0, 3), dtype=np.int64), np.zeros((0, 1, CHANNELS))
        if extended:
            choice = choose(tables, items.phoneme, items.duration, items.previous, items.next, soft=True)
            fitted = fit_kernels(
                material, choice, tables, phoneme_class, plan.stand_in, silence, fps, _own(penalties, kind), look_ahead,
                pair_knots,
            )
            kernel, lag, tables = fitted.kernel, fitted.lag, fitted.tables
            pair_key, pair_shape = fitted.pair_key, fitted.pair_shape
            targets = _targets(choice, fitted, material, silence, floor, contact)
            ends = [_unit_ends(item, boundary) for item in material]
            batches = [slice(first, first + BATCH) for first in range(0, len(material), BATCH)]
            tasks = [(targets[batch], ends[batch], states) for batch in batches]
            paths = [path for batch in workers.run("matched states", _decode, tasks) for path in batch]
            human = [item.frames for item in material]
            weights = [item.weights for item in material]
            if contact[silence].any():  # targets rest where people part their lips
                weights = [own * (item.rest == 0)[:, None] for own, item in zip(weights, material)]
            states = match_states(states, paths, targets, human, weights, scales)

    training: Dict[str, object] = {
        **_extent(material, silence),
        "codebook": codebook,
        "components": components,
        "seed": seed,
        "episodes": len(material),
        "frames": int(sum(len(item.frames) for item in material)),
        "occurrences": {label: int(count) for label, count in zip(phone_set.phonemes, counts)},
        "pooled": dict(plan.pooled),
    }
    if extended:
        training.update(penalties=asdict(penalties), scales=asdict(scales), look_ahead=look_ahead)
    model = Model(
        kind=kind,
        method=method,
        fps=fps,
        phonemes=phone_set.phonemes,
        classes=phone_set.classes,
        silence=phone_set.silence,
        soft=extended,
        search_stride=stride,
        phoneme_class=phoneme_class,
        boundary=boundary,
        component_count=tables.component_count,
        log_weight=tables.log_weight,
        duration_mean=tables.duration_mean,
        duration_variance=tables.duration_variance,
        shape=tables.shape,
        slope=tables.slope,
        log_previous=tables.log_previous,
        log_next=tables.log_next,
        kernel=kernel,
        kernel_lag=lag,
        pair_key=pair_key,
        pair_shape=pair_shape,
        floor=floor,
        contact=contact,
        firm=FIRMNESS * np.median(states.state_precision[..., 0] + states.state_anchor, axis=1) * contact.any(axis=0),
        decode_mean=states.decode_mean,
        decode_variance=states.decode_variance,
        state_mean=states.state_mean,
        state_precision=states.state_precision,
        state_anchor=states.state_anchor,
        log_transition=states.log_transition,
        log_initial=states.log_initial,
        substitutes=dict(plan.substitutes),
        attribution=attribution,
        training=training,
    )
    if not extended:
        return model
    with Workers(jobs, progress) as workers, threadpool_limits(1):
        return restored(model, material, workers)
