"""From a corpus to a model: the whole training, in the order of the method (docs/method.md)."""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from typing import Any, Dict, List, Optional, Sequence, Tuple

import numpy as np
from threadpoolctl import threadpool_limits

from labial.corpus.apex import told
from labial.corpus.episode import Episode, with_even_sides
from labial.corpus.phonesets import PHONE_SETS, PhoneSet
from labial.defaults import CODEBOOK, COMPONENTS, FPS, KINDS, LOOK_AHEAD, METHODS, SEARCH_STRIDE, SIZES
from labial.errors import LabialError
from labial.files.faps import CHANNELS, FAP_COLUMNS
from labial.files.frames import spans
from labial.reference.contact import FRAMES, raised
from labial.reference.shape import ShapeTables, choose
from labial.tables.followers import FAP_17, columns, every, mirrored, solved
from labial.tables.model import Model, widened
from labial.tables.quantise import LIMITS
from labial.train import kernels as regressions
from labial.train import talkers as effects
from labial.train.codebook import Codebook, Division, lbg, train_channel
from labial.train.expression import FIRMNESS, deviation_of, floors, gains, shared_gains, with_protrusion
from labial.train.kernels import PAIR_KNOTS, REACH, Kernels, Penalties, lags
from labial.train.recordings import Occurrences, Recording, occurrences, recordings, taught, with_pauses_cut
from labial.train.shapes import Mixture, Plan, back_off, corpus_scale, fit_context, fit_mixture, shape_tables
from labial.train.states import (
    SCALES,
    ChannelTask,
    Scales,
    StateTables,
    balance_states,
    chain,
    chain_tables,
    codebook_tables,
    decode,
    match_states,
)
from labial.train.workers import Workers

#: Utterances that are decoded at once.
BATCH = 40


@dataclass(frozen=True)
class _Setting:
    """The options of a training."""

    phone_set: PhoneSet
    extended: bool  #: whether to add to the published method
    fps: int
    codebook: int  #: Q
    components: int  #: C
    seed: int
    look_ahead: float  #: seconds
    stride: int  #: frames that share a state
    divide: Division
    normalised: bool  #: features are divided by their standard deviations before they are clustered
    penalties: Penalties
    scales: Scales
    talker_variance: Optional[float]  #: variance of talkers as random effects; None: talkers are not distinguished
    symmetric: bool  #: whether both sides of the mouth move alike

    @property
    def source(self) -> np.ndarray:
        """(13,) int64: the model's, as long as FAP 17 is a channel."""
        return mirrored() if self.symmetric else every()

    @property
    def computing(self) -> bool:
        """Whether FAP 17 is to be computed of the corners if it can be."""
        return self.talker_variance is not None or self.tracking

    @property
    def tracking(self) -> bool:
        """Whether states track the motion: in laughter, whose smile is slower than kernels reach."""
        return self.extended and self.phone_set.kind == "laughter"

    @property
    def silence(self) -> int:
        """Its number."""
        return self.phone_set.phonemes.index(self.phone_set.silence)

    @property
    def boundary(self) -> np.ndarray:
        """(P,) bool: phonemes at which units end."""
        return np.array(self.phone_set.boundary, dtype=bool)

    @property
    def viseme_class(self) -> np.ndarray:
        """(P,) int64 viseme classes."""
        return np.array(self.phone_set.viseme_class, dtype=np.int64)


@dataclass(frozen=True)
class _Shapes:
    """The parameters of targets, and the targets of the training material if states are matched to them."""

    kernels: Kernels
    floor: np.ndarray  #: (P, 13) FAP
    contact: np.ndarray  #: (P, 13) bool
    targets: Optional[List[np.ndarray]] = None  #: (T, 13) each, FAP


#: Vectors, previous and next classes of a phoneme's samples; scale, components, seed, and classes, 0 without context.
_MixtureTask = Tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, int, int, int]


def _mixture(task: _MixtureTask) -> Mixture:
    vectors, previous, following, scale, components, seed, classes = task
    mixture = fit_mixture(vectors, scale, components, seed)
    return fit_context(mixture, vectors, scale, previous, following, classes) if classes else mixture


def _mixtures(setting: _Setting, items: Occurrences, plan: Plan, workers: Workers) -> ShapeTables:
    """The tables of all phonemes. All samples count alike, since weights did not improve the relation of durations and
    neighbours, which only the mixtures determine."""
    vectors, learnt = items.vectors(), items.learnt
    scale = corpus_scale(vectors[learnt])
    classes = len(setting.phone_set.classes) if setting.extended else 0
    own = {p: np.flatnonzero(np.isin(items.phoneme, members) & learnt)
           for p, members in enumerate(plan.members) if members is not None}
    tasks = [(vectors[rows], items.previous[rows], items.next[rows], scale, setting.components, setting.seed, classes)
             for rows in own.values()]
    fitted = dict(zip(own, workers.run("lip shapes", _mixture, tasks)))
    return shape_tables([fitted[other] for other in plan.stand_in], conditional=setting.extended)


def _channel(task: Tuple[List[np.ndarray], List[np.ndarray], int, int, Division, bool]) -> Codebook:
    return train_channel(*task)


def _decode(task: Tuple[List[np.ndarray], List[np.ndarray], StateTables]) -> List[np.ndarray]:
    return [path.astype(np.int16) for path in decode(*task)]


def _unit_ends(item: Recording, boundary: np.ndarray) -> np.ndarray:
    """(T,) bool: the frames that end a unit, the last ones of boundary phonemes and of the utterance."""
    ends = np.zeros(len(item.frames), dtype=bool)
    ends[np.cumsum(item.length)[boundary[item.phoneme]] - 1] = True
    ends[-1] = True
    return ends


def _unit_starts(item: Recording, boundary: np.ndarray) -> np.ndarray:
    """Frames at which boundary phonemes, and so units, begin; the utterance's first and last phoneme are some too."""
    begins = boundary[item.phoneme].copy()
    begins[[0, -1]] = True
    return (np.cumsum(item.length) - item.length)[begins]


def _stretches(material: Sequence[Recording], starts: Sequence[np.ndarray],
               channel: int) -> Tuple[List[np.ndarray], List[np.ndarray]]:
    """The stretches of one channel's motion (T,) for training, and the frames at which units begin in each."""
    motion, begins = [], []
    for item, start in zip(material, starts):
        for first, end in spans(item.weights[:, channel] > 0):
            motion.append(item.frames[first:end, channel])
            begins.append(start[(start >= first) & (start < end)] - first)
    return motion, begins


def _setting(kind: str, method: str, fps: int, codebook: Optional[int], components: Optional[int], seed: int = 0,
             look_ahead: float = LOOK_AHEAD, search_stride: int = SEARCH_STRIDE, divide: Division = lbg,
             normalise: bool = False, talker_variance: Optional[float] = None, symmetric: bool = True) -> _Setting:
    if kind not in KINDS:
        raise LabialError(f"kind is {kind!r}, not one of {', '.join(KINDS)}")
    if method not in METHODS:
        raise LabialError(f"method is {method!r}, not one of {', '.join(METHODS)}")
    usual = SIZES[kind] if method == "labial" else (CODEBOOK, COMPONENTS)
    codebook, components = (own if given is None else given for given, own in zip((codebook, components), usual))
    for name, value, most in (("fps", fps, 250), ("codebook", codebook, LIMITS["states"]),
                              ("components", components, LIMITS["components"]),
                              ("search stride", search_stride, LIMITS["stride"])):
        if not 1 <= value <= most:
            raise LabialError(f"{name} is {value}, not within 1 .. {most}")
    if not 0.0 <= look_ahead <= REACH:
        raise LabialError(f"look-ahead is {look_ahead} s, not within 0 .. {REACH}")
    effects.check_variance(talker_variance)
    extended = method == "labial"
    talker_variance = talker_variance if extended else None
    return _Setting(PHONE_SETS[kind], extended, fps, codebook, components, seed, look_ahead,
                    search_stride if extended else 1, divide, extended or normalise,
                    Penalties() if talker_variance is None else effects.PENALTIES,
                    SCALES if kind == "laughter" else Scales(), talker_variance, symmetric and extended)


def check_options(*, jobs: int, engine: Optional[str] = None, **options: Any) -> None:
    """Raises LabialError for options that :func:`train` would refuse; call it before reading a corpus."""
    _setting(**options)
    check_jobs(jobs)
    Workers(jobs, False, engine)


def check_jobs(jobs: int) -> None:
    """Raises LabialError for an invalid number of processes."""
    if not 1 <= jobs <= 1024:
        raise LabialError(f"jobs is {jobs}, not within 1 .. 1024")


def _extent(material: Sequence[Recording], silence: int) -> Dict[str, object]:
    """The channels' range, from their 1st to their 99th percentile, and their mean pose outside silence."""
    reach = [np.ptp(np.percentile(taught(material, channel), [1, 99])) for channel in range(CHANNELS)]
    sounding = [item.sounds(silence) for item in material]
    if not any(of.any() for of in sounding):
        sounding = [~of for of in sounding]
    total = weight = np.zeros((0, CHANNELS))
    for item, of in zip(material, sounding):  # row by row, as a sum of all would go
        counts = item.weights[of]
        total = np.concatenate([total, item.frames[of] * counts]).sum(axis=0, keepdims=True)
        weight = np.concatenate([weight, counts]).sum(axis=0, keepdims=True)
    return {"channel_range": np.round(reach, 3).tolist(), "mean_pose": np.round(total[0] / weight[0], 3).tolist()}


def _deviation(material: Sequence[Recording], silence: int) -> np.ndarray:
    """(13,) FAP: the standard deviation of each channel outside silence, of what is learnt from."""
    return deviation_of(np.concatenate([item.frames for item in material]),
                        np.concatenate([item.learnt_sounds(silence) for item in material]))


def _material(corpus: Sequence[Episode], setting: _Setting) -> Tuple[List[Recording], Dict[str, float]]:
    """The recordings, and the weights of talkers if they are random effects."""
    material = recordings(corpus, setting.phone_set, setting.fps)
    if setting.extended:
        ahead = max(int(lags(setting.fps, setting.look_ahead)[-1]), FRAMES)
        material = [with_pauses_cut(item, setting.silence, ahead, setting.fps) for item in material]
    counts = effects.weights_of(material)
    if setting.talker_variance is not None:
        material = [effects.counted_once(item) for item in material]
    untaught = ~np.any([item.weights.any(axis=0) for item in material], axis=0)
    if untaught.any():
        names = ", ".join(np.array(FAP_COLUMNS)[untaught])
        raise LabialError(f"nothing is left to learn {names} from: every corpus leaves this out")
    return material, counts


def _fit_shapes(setting: _Setting, material: Sequence[Recording], talkers: Dict[str, float], items: Occurrences,
                plan: Plan, workers: Workers) -> _Shapes:
    """Mixtures, and beyond the published method kernels, pairs, floors and contact."""
    phonemes = len(setting.phone_set.phonemes)
    tables = _mixtures(setting, items, plan, workers)
    if not setting.extended:
        none = Kernels(np.zeros((phonemes, 0, CHANNELS)), np.zeros(0, dtype=np.int64), tables,
                       np.zeros((0, 3), dtype=np.int64), np.zeros((0, 1, CHANNELS)))
        return _Shapes(none, np.full((phonemes, CHANNELS), -np.inf), np.zeros((phonemes, CHANNELS), dtype=bool))
    floor, contact = floors(material, setting.phone_set, setting.fps, free_corners=setting.talker_variance is not None)
    choice = choose(tables, items.phoneme, items.duration, items.previous, items.next, soft=True)
    penalties, variance = setting.penalties, setting.talker_variance
    if setting.phone_set.kind != "speech":
        # Where lips rest depends on the talker in speech, but in laughter on its intensity, which the phonemes' grades
        # express, so that intercepts must not absorb it.
        penalties = replace(penalties, intercept=np.inf)
    asked = regressions.regression(material, tables, setting.viseme_class, plan.stand_in, setting.silence, setting.fps,
                                   penalties, setting.look_ahead, PAIR_KNOTS,
                                   regressions.PAIR_COUNT if variance is None else effects.PAIR_COUNT_SHARED)
    if variance is None:
        kernels = regressions.fit_kernels(asked, material, choice)
        own = [kernels] * len(material)
    else:
        kernels, of = effects.fit_talkers(asked, material, choice, variance, talkers)
        own = [of[item.talker] for item in material]
    moving = regressions.targets_without_floors(choice, own, material, setting.silence)
    targets = [raised(target, item.phoneme_at(), item.length, item.rest, setting.silence, floor, contact)[0]
               for target, item in zip(moving, material)]
    return _Shapes(kernels, floor, contact, targets)


def _fit_states(setting: _Setting, material: Sequence[Recording], shaped: _Shapes, workers: Workers) -> StateTables:
    """Codebooks, and beyond the published method states matched to what is decoded from the targets. Those of channels
    that follow others are theirs."""
    own = solved(setting.source)
    if setting.computing:  # FAP 17 takes no turn
        own = np.concatenate([own[own != FAP_17], [FAP_17]])
    states = _fit_solved(setting, material, shaped, workers, own)
    place = np.argsort(own)[columns(setting.source)]
    tables = {name: getattr(states, name)[place] for name in StateTables.__dataclass_fields__ if name != "stride"}
    return replace(states, **tables)


def _fit_solved(setting: _Setting, material: Sequence[Recording], shaped: _Shapes, workers: Workers,
                own: np.ndarray) -> StateTables:
    """The states of the channels `own` (C,), in the order in which they take turns in the run-time."""
    starts = [_unit_starts(item, setting.boundary) for item in material]
    if shaped.targets is not None and setting.tracking:
        aimed = [replace(item, frames=target) for item, target in zip(material, shaped.targets)]
        chains = [ChannelTask(motion, _stretches(aimed, starts, c)[0], begins, setting.codebook, setting.stride,
                              setting.divide)
                  for c in own for motion, begins in [_stretches(material, starts, c)]]
        states = chain_tables(workers.run("codebooks", chain, chains), setting.stride)
    else:
        motion = [(*_stretches(material, starts, c), setting.codebook, setting.stride, setting.divide,
                   setting.normalised) for c in own]
        states = codebook_tables(workers.run("codebooks", _channel, motion), setting.stride)
    if shaped.targets is None:
        return states
    targets = [target[:, own] for target in shaped.targets]
    ends = [_unit_ends(item, setting.boundary) for item in material]
    batches = [slice(first, first + BATCH) for first in range(0, len(material), BATCH)]
    decoded = workers.run("matched states", _decode, [(targets[batch], ends[batch], states) for batch in batches])
    counts = [item.rest == 0 if shaped.contact[setting.silence].any() else np.ones(len(item.frames), dtype=bool)
              for item in material]  # not where targets rest and people part their lips
    weights = [np.broadcast_to(1.0 * of[:, None], (len(of), len(own))) if item.weight is None  # without memory for each
               else item.weight[:, own] * of[:, None] for of, item in zip(counts, material)]
    paths = [path for batch in decoded for path in batch]
    match = balance_states if setting.tracking else match_states
    return match(states, paths, targets, [item.frames[:, own] for item in material], weights, setting.scales)


def _training(setting: _Setting, material: Sequence[Recording], counts: np.ndarray, plan: Plan) -> Dict[str, object]:
    """The model's record of its training."""
    occurring = {label: int(count) for label, count in zip(setting.phone_set.phonemes, counts)}
    training: Dict[str, object] = {
        **_extent(material, setting.silence), "codebook": setting.codebook, "components": setting.components,
        "seed": setting.seed, "episodes": len(material), "frames": int(sum(len(item.frames) for item in material)),
        "occurrences": occurring, "pooled": dict(plan.pooled)}
    if setting.extended:
        training.update(penalties=asdict(setting.penalties), scales=asdict(setting.scales),
                        look_ahead=setting.look_ahead)
    else:
        training.update(normalised_features=setting.normalised)
    return training


def _model(setting: _Setting, shaped: _Shapes, states: StateTables, plan: Plan, attribution: str,
           training: Dict[str, object]) -> Model:
    phone_set, kernels = setting.phone_set, shaped.kernels
    hold = np.median(states.state_precision[..., 0] + states.state_anchor, axis=1)
    tables = {**vars(kernels.tables), **vars(states)}
    model = Model(kind=phone_set.kind, method="labial" if setting.extended else "paper", fps=setting.fps,
                  phonemes=phone_set.phonemes, classes=phone_set.classes, silence=phone_set.silence,
                  soft=setting.extended, search_stride=tables.pop("stride"), viseme_class=setting.viseme_class,
                  boundary=setting.boundary, kernel=kernels.kernel, kernel_lag=kernels.lag, pair_key=kernels.pair_key,
                  pair_shape=kernels.pair_shape, floor=shaped.floor, contact=shaped.contact,
                  firm=FIRMNESS * hold * shaped.contact.any(axis=0), substitutes=dict(plan.substitutes),
                  attribution=attribution, training=training, **tables)
    same = {name: getattr(model, name)[..., setting.source]  # but for rounding, where both sides learnt the same
            for name in ("shape", "slope", "kernel", "pair_shape", "floor", "contact", "firm")}
    return replace(model, **same, source=setting.source)


def train(corpus: Sequence[Episode], *, kind: str, method: str, fps: int = FPS, codebook: Optional[int] = None,
          components: Optional[int] = None, seed: int = 0, jobs: int = 2, engine: Optional[str] = None,
          progress: bool = True, attribution: str = "", look_ahead: float = LOOK_AHEAD,
          search_stride: int = SEARCH_STRIDE, divide: Division = lbg, normalise: bool = False,
          talker_variance: Optional[float] = None, symmetric: bool = True) -> Model:
    """Trains a model of `kind` ("speech" or "laughter") on episodes whose labels are phonemes of that kind. `method` is
    "paper", the published one, or "labial" with all additions. `codebook` is Q, the states of each channel,
    `components` C of each phoneme's mixture; None is what the method takes for the kind. `look_ahead` is how far the
    temporal kernels reach into what follows, seconds; less makes a stream's frames earlier. `search_stride` is how many
    frames share a state of the decoded path. The published method has neither; its features are clustered as they are,
    unless `normalise` divides each by its standard deviation, as Labial's always are. `talker_variance` makes talkers
    random effects (:mod:`labial.train.talkers`), in place of their corpora's weights. `symmetric` is that both sides of
    the mouth move alike, as the mean of those recorded; the published method learns each side. `divide` computes the
    codebooks' cells; with more than one job it must be a module-level function. `attribution` is stored in the model:
    redistribution requires it. The same arguments give the same model, whatever `jobs`, the number of processes, and
    `engine` are (:class:`labial.train.workers.Workers`). The model records the substitutes of phonemes
    (:func:`backed_off`), the corpus's counts and all options."""
    setting = _setting(kind, method, fps, codebook, components, seed, look_ahead, search_stride, divide, normalise,
                       talker_variance, symmetric)
    check_jobs(jobs)
    if not corpus:
        raise LabialError("the corpus is empty")
    if setting.symmetric:
        corpus = with_even_sides(corpus)
    material, talkers = _material(corpus, setting)
    items = occurrences(material, setting.phone_set)
    counts = np.bincount(items.phoneme[items.learnt], minlength=len(setting.phone_set.phonemes))
    plan = back_off(counts, setting.phone_set)
    with Workers(jobs, progress, engine) as workers, threadpool_limits(1):
        shaped = _fit_shapes(setting, material, talkers, items, plan, workers)
        states = _fit_states(setting, material, shaped, workers)
        model = _model(setting, shaped, states, plan, attribution, _training(setting, material, counts, plan))
        if not setting.extended:
            return model
        gain, middle = (gains(model, material, workers) if setting.talker_variance is None
                        else shared_gains(model, material, workers, talkers))
        if setting.talker_variance is not None:
            about = effects.about_talkers(setting.talker_variance, _deviation(material, setting.silence), gain, middle)
            model = replace(model, training={**model.training, "talkers": about})
        model = widened(model, gain, middle, contacts=setting.talker_variance is None)
        return with_protrusion(model, material, workers) if setting.computing else model


def without_apex(corpus: Sequence[Episode]) -> List[str]:
    """A message if the apex of some phonemes is unknown; training then uses their middle."""
    segments = [segment for episode in corpus for segment in episode.segments]
    unknown = len(segments) - told(segments)
    message = f"apex: not known of {unknown} of {len(segments)} phonemes, which are learnt from their middle"
    return [message] if unknown else []


def backed_off(model: Model) -> List[str]:
    """A line for each phoneme with too few samples: their number, and its substitute."""
    training: Dict[str, Any] = model.training
    counts = training["occurrences"]
    pooled = [f"{label}: {counts[label]} samples, uses those of its viseme class {name}"
              for label, name in training["pooled"].items()]
    return pooled + [f"{label}: {counts[label]} samples, uses the shapes of {other}"
                    for label, other in model.substitutes.items()]
