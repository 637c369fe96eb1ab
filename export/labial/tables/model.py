"""The trained float model: its contents, the .npz file in which it is stored, and the same model with wider motion.

Shapes use P phonemes, N mixture components (of all phonemes), V viseme classes, Q states, L kernel taps, K knots of a
pair and the 13 channels of :mod:`labial.files.faps`. Positions are FAP units, durations seconds, probabilities natural
logarithms, precisions inverse variances.
"""

from __future__ import annotations

import json
import os
from dataclasses import dataclass, field, fields, replace
from typing import Any, BinaryIO, Dict, Optional, Tuple, Union

import numpy as np

from labial.core.library import BLOB_MAGIC
from labial.defaults import KINDS, METHODS
from labial.errors import ModelError, PathLike, expect
from labial.files import limits
from labial.files.arrays import ArrayError, array, read_zip, write_model
from labial.files.faps import CHANNELS
from labial.tables.bundled import model_file
from labial.tables.followers import FAP_17, FROM_CORNERS, VALUES, every

#: Version of the .npz layout, readable versions, and new names of arrays that were renamed in version 4.
FORMAT = 5
_FORMATS = (3, 4, FORMAT)
_NAMES_SINCE = {"phoneme_class.npy": "viseme_class.npy", "decode_mean.npy": "emission_mean.npy",
                "decode_variance.npy": "emission_variance.npy"}

_TEXT = ("kind", "method", "phonemes", "classes", "silence", "fps", "soft", "search_stride", "aliases", "substitutes",
         "attribution", "training")

_POSITION, _LOGARITHM, _PRECISION = (-1e5, 1e5), (-1e5, 1e-9), (1e-15, 1e15)
#: The least and the largest value of each array; the library's tables hold no others, however scaled.
_BOUNDS: Dict[str, Tuple[float, float]] = {
    "viseme_class": (0, 255), "boundary": (0, 1), "component_count": (1, 255), "log_weight": _LOGARITHM,
    "duration_mean": (0, 3600), "duration_variance": (1e-15, 1e7), "shape": _POSITION, "slope": (-1e7, 1e7),
    "log_previous": _LOGARITHM, "log_next": _LOGARITHM, "kernel": _POSITION, "kernel_lag": (-1000, 1000),
    "pair_key": (0, 65535), "pair_shape": _POSITION, "floor": _POSITION, "contact": (0, 1), "firm": (0, 1e15),
    "emission_mean": _POSITION, "emission_variance": _PRECISION, "state_mean": _POSITION, "state_precision": _PRECISION,
    "state_anchor": (0, 1e15), "log_transition": _LOGARITHM, "log_initial": _LOGARITHM, "protrusion": _POSITION,
    "protrusion_range": _POSITION, "source": (FROM_CORNERS, CHANNELS - 1),
}
#: Arrays of whole numbers; those that may hold -inf; and those from which others' sizes are taken, with their axes.
_WHOLE = ("viseme_class", "boundary", "component_count", "kernel_lag", "pair_key", "contact", "source")
#: What is not there in some files.
_OPTIONAL = ("protrusion", "protrusion_range", "source")
_MAY_BE_NONE = ("floor", "log_transition", "log_initial")
_AXES = {"component_count": 1, "kernel_lag": 1, "pair_key": 2, "pair_shape": 3, "log_previous": 2, "log_initial": 2,
         "protrusion": 1}


@dataclass(frozen=True)
class Model:
    """A trained model. Arrays are float64 unless stated otherwise; all are finite, except that `log_transition`,
    `log_initial` and `floor` may contain -inf."""

    kind: str  #: "speech" or "laughter"
    method: str  #: "paper" or "labial"
    fps: int  #: frames per second
    phonemes: Tuple[str, ...]  #: P labels
    classes: Tuple[str, ...]  #: V names of viseme classes
    silence: str  #: the label before and after an utterance
    soft: bool  #: shapes are the mixture's conditional mean, not the mean of its best component
    search_stride: int  #: frames from one state of a path to the next
    viseme_class: np.ndarray  #: (P,) int64, index into `classes`
    boundary: np.ndarray  #: (P,) bool, units begin and end here
    component_count: np.ndarray  #: (P,) int64, sums to N; components are stored phoneme by phoneme
    log_weight: np.ndarray  #: (N,) log a_c, normalised per phoneme
    duration_mean: np.ndarray  #: (N,) seconds
    duration_variance: np.ndarray  #: (N,) seconds squared
    shape: np.ndarray  #: (N, 13) mean shape at duration_mean, FAP
    slope: np.ndarray  #: (N, 13) FAP per second of duration beyond the mean; zero in the published method
    log_previous: np.ndarray  #: (N, V) log P(class of the previous phoneme | c), or (N, 0) without context
    log_next: np.ndarray  #: (N, V) log P(class of the next phoneme | c), or (N, 0) without context
    kernel: np.ndarray  #: (P, L, 13) FAP that a phoneme at a tap's lag adds to the target; L = 0 without kernels
    kernel_lag: np.ndarray  #: (L,) int64, frames from the target to the phoneme (negative: before), evenly spaced
    pair_key: np.ndarray  #: (R, 3) int64: phoneme; 0 for its previous, 1 for its next neighbour; the neighbour
    pair_shape: np.ndarray  #: (R, K, 13) FAP that such a neighbour adds to the phoneme's shape: all through (K = 1), or
    #: at its start and at its end, between which frames interpolate (K = 2)
    floor: np.ndarray  #: (P, 13) FAP, lowest target in the phoneme; -inf where none
    contact: np.ndarray  #: (P, 13) bool, where the floor is contact, as of the lips in p, b, m
    firm: np.ndarray  #: (13,) least precision of the target of a frame in contact
    emission_mean: np.ndarray  #: (13, Q) mean of the static feature that a state emits in the Viterbi search, FAP
    emission_variance: np.ndarray  #: (13, Q) and its variance, FAP^2
    state_mean: np.ndarray  #: (13, Q, 3) of m, delta m, delta-delta m for equation 3, FAP (per frame, per frame^2)
    state_precision: np.ndarray  #: (13, Q, 3) their precisions, > 0
    state_anchor: np.ndarray  #: (13, Q) precision that ties a frame to its target; 0 in the published method
    log_transition: np.ndarray  #: (13, Q, Q) [from, to]
    log_initial: np.ndarray  #: (13, Q)
    protrusion: np.ndarray = field(default_factory=lambda: np.zeros(0))  #: (17,) FAP 17, at even distances over the
    #: range (2,) of the mean of FAP 53 and 54, of which it is computed then and not a channel; else both (0,)
    protrusion_range: np.ndarray = field(default_factory=lambda: np.zeros(0))
    source: np.ndarray = field(default_factory=every)  #: (13,) int64, the channel of a frame that each one's motion is
    #: (:mod:`labial.tables.followers`); what other arrays say of one that is not its own source counts for nothing
    aliases: Dict[str, str] = field(default_factory=dict)  #: labels of its own -> label in `phonemes`
    substitutes: Dict[str, str] = field(default_factory=dict)  #: phoneme without samples -> its substitute
    attribution: str = ""  #: attribution that redistribution requires
    training: Dict[str, object] = field(default_factory=dict)  #: options and counts of the training, JSON values

    def __post_init__(self) -> None:
        check(self)

    def first_component(self) -> np.ndarray:
        """(P + 1,) int64: the components of phoneme p are first[p] .. first[p + 1] - 1."""
        return np.concatenate([[0], np.cumsum(self.component_count)]).astype(np.int64)


def check(model: Model) -> None:
    """Raises ModelError unless every array has its shape, is finite, within bounds and consistent with the others."""
    p, v = len(model.phonemes), len(model.classes)
    expect(model.kind in KINDS, f"kind is {model.kind!r:.40}, not one of {', '.join(KINDS)}")
    expect(model.method in METHODS, f"method is {model.method!r:.40}, not one of {', '.join(METHODS)}")
    expect(isinstance(model.fps, int) and 1 <= model.fps <= 250, "fps is not a whole number from 1 to 250")
    expect(isinstance(model.search_stride, int) and 1 <= model.search_stride <= 8,
            "search_stride is not a whole number from 1 to 8")
    expect(p > 0 and len(set(model.phonemes)) == p, "phoneme labels are missing or not unique")
    expect(all(label and label.isprintable() for label in (*model.phonemes, *model.classes)),
            "a label is not printable")
    expect(model.silence in model.phonemes, f"the silence phoneme {model.silence!r:.40} is not a phoneme")
    for name, shape in _shapes(model).items():
        value = np.asarray(getattr(model, name))
        expect(value.shape == shape, f"{name} has shape {value.shape}, not {shape}")
        _check_values(name, value)
    key = np.asarray(model.pair_key)
    expect(bool(((key >= 0) & (key < [p, 2, p])).all()), "a pair names a phoneme or a side that does not exist")
    expect(len(np.unique(key, axis=0)) == len(key), "duplicate pair")
    expect(bool(((model.viseme_class >= 0) & (model.viseme_class < v)).all()),
            "a phoneme's viseme class does not exist")
    rests = np.asarray(model.contact, dtype=bool)[model.phonemes.index(model.silence)]
    expect(not (rests & np.isneginf(model.floor[model.phonemes.index(model.silence)])).any(),
           "silence has a channel at rest without a floor")
    expect(bool((np.diff(model.emission_mean, axis=1) >= 0).all()),
            "emission_mean is not ascending, states are not in order")
    expect(np.isfinite(model.log_initial).any(axis=1).all(), "a channel has no state to start in")
    expect(np.isfinite(model.log_transition).any(axis=1).all(), "a state has no predecessor")
    expect(bool((np.diff(model.protrusion_range) > 0).all()), "protrusion_range does not ascend")
    _check_source(np.asarray(model.source), computed=len(model.protrusion) > 0)
    lag = np.asarray(model.kernel_lag)
    expect(len(lag) < 2 or (len(np.unique(np.diff(lag))) == 1 and lag[1] > lag[0]),
            "kernel lags are not evenly spaced and increasing")
    for alias, label in model.aliases.items():
        expect(label in model.phonemes, f"alias {alias!r:.40} names the unknown phoneme {label!r:.40}")
    for missing, label in model.substitutes.items():
        known = missing in model.phonemes and label in model.phonemes
        expect(known, f"substitute {missing!r:.40} -> {label!r:.40} is not known")


def _check_source(source: np.ndarray, *, computed: bool) -> None:
    """Raises ModelError unless each channel is its own source, has the motion of one that is, or is FAP 17 of a model
    that has a table of it."""
    for channel, of in enumerate(source.tolist()):
        if of == FROM_CORNERS:
            expect(channel == FAP_17, f"source[{channel}]: only FAP 17 can be computed of the corners")
        else:
            expect(source[of] == of, f"source[{channel}] is {of}, a channel that follows another")
    expect(computed == (source[FAP_17] == FROM_CORNERS),
            "source and protrusion contradict each other on whether FAP 17 is computed of the corners")


def _shapes(model: Model) -> Dict[str, Tuple[int, ...]]:
    """The shape of each array; checks first the arrays that determine the sizes."""
    for name, axes in _AXES.items():
        shape = np.shape(getattr(model, name))
        expect(len(shape) == axes, f"{name} has shape {shape}, not {axes} axes")
    p, v = len(model.phonemes), len(model.classes)
    _check_values("component_count", np.asarray(model.component_count))
    n, q = int(np.sum(model.component_count)), np.shape(model.log_initial)[-1]
    taps, pairs, knots = len(model.kernel_lag), len(model.pair_key), np.shape(model.pair_shape)[1]
    context = np.shape(model.log_previous)[-1]
    expect(q > 0, "there are no states")
    expect(context in (0, v), f"context tables have {context} classes, the model {v}")
    computed = len(model.protrusion)
    expect(computed in (0, VALUES), f"protrusion has {computed} values, not {VALUES}")
    expect(knots in (1, 2), f"pair_shape has shape {np.shape(model.pair_shape)}, not one or two knots")
    per_state, per_component = (CHANNELS, q), (n, CHANNELS)
    return {"viseme_class": (p,), "boundary": (p,), "component_count": (p,), "log_weight": (n,), "duration_mean": (n,),
            "duration_variance": (n,), "shape": per_component, "slope": per_component, "log_previous": (n, context),
            "log_next": (n, context), "kernel": (p, taps, CHANNELS), "kernel_lag": (taps,), "pair_key": (pairs, 3),
            "pair_shape": (pairs, knots, CHANNELS), "floor": (p, CHANNELS), "contact": (p, CHANNELS),
            "firm": (CHANNELS,), "emission_mean": per_state, "emission_variance": per_state,
            "state_mean": (*per_state, 3), "state_precision": (*per_state, 3), "state_anchor": per_state,
            "log_transition": (*per_state, q), "log_initial": per_state, "protrusion": (computed,),
            "protrusion_range": (2 if computed else 0,), "source": (CHANNELS,)}


def _check_values(name: str, value: np.ndarray) -> None:
    """Raises ModelError, which names the array and the first index, for a value beyond the bounds of `name`."""
    kinds = "biu" if name in _WHOLE else "biuf"
    expect(value.dtype.kind in kinds, f"{name} has the type {value.dtype}")
    low, high = _BOUNDS[name]
    wrong = ~((value >= low) & (value <= high))
    if name in _MAY_BE_NONE:
        wrong &= ~np.isneginf(value)
    if wrong.any():
        at = tuple(int(index) for index in np.unravel_index(int(np.argmax(wrong)), value.shape))
        raise ModelError(f"{name}[{', '.join(map(str, at))}] is {float(value[at]):g}, not within {low:g} .. {high:g}")


def save(model: Model, path: Union[str, os.PathLike[str], BinaryIO]) -> None:
    """Writes the model, to a path or to a file that is open. The same model gives the same bytes."""
    values = ((item.name, getattr(model, item.name)) for item in fields(model) if item.name not in _TEXT)
    write_model(path, {"format": FORMAT, **{name: getattr(model, name) for name in _TEXT}},
                ((name, value) for name, value in values if name not in _OPTIONAL or len(value)))


def load(path: PathLike) -> Model:
    """Reads and checks a model, from a file or by a bundled name. Raises ModelError, which names the file, for anything
    else."""
    path = model_file(path)
    try:
        members = read_zip(path, None, limits.MODEL)
        expect("model.json" in members, "not a labial model: it holds no model.json")
        members = {**{name: members[former] for former, name in _NAMES_SINCE.items() if former in members}, **members}
        values = _texts(members["model.json"])
        for name in (item.name for item in fields(Model) if item.name not in _TEXT):
            there = f"{name}.npy" in members
            expect(there or name in _OPTIONAL, f"not a labial model: it holds no {name}.npy")
            if there:
                values[name] = array(name, members[f"{name}.npy"])
        if "source" not in values and len(values.get("protrusion", ())):  # before format 5
            values["source"] = np.where(every() == FAP_17, FROM_CORNERS, every())
        return Model(**values)
    except OSError as error:
        raise ModelError(f"{os.fspath(path)}: {error.strerror or error}") from None
    except ArrayError as error:
        with open(path, "rb") as file:
            blob = file.read(len(BLOB_MAGIC)) == BLOB_MAGIC
        why = "exported for the library; name the .npz that it was made of" if blob else f"not a labial model: {error}"
        raise ModelError(f"{os.fspath(path)}: {why}") from None
    except ModelError as error:
        raise ModelError(f"{os.fspath(path)}: {error}") from None


def _texts(data: bytes) -> Dict[str, Any]:
    """The content of model.json, with its types checked."""
    try:
        text = json.loads(data.decode("utf-8"))
        json.dumps(text, ensure_ascii=False).encode("utf-8")  # half a pair of surrogates is no text
    except (ValueError, RecursionError) as error:
        problem = "nested too deeply" if isinstance(error, RecursionError) else str(error)
        raise ModelError(f"model.json: not JSON ({problem[:80]})") from None
    expect(isinstance(text, dict), "model.json: not an object")
    expect(text.get("format") in _FORMATS, f"format {text.get('format')!r:.40}, but this version of labial reads "
            f"formats {_FORMATS[0]} to {FORMAT}")
    for name in _TEXT:
        expect(name in text, f"model.json: no {name}")
    for name in ("kind", "method", "silence", "attribution"):
        expect(isinstance(text[name], str), f"model.json: {name} is not text")
    for name in ("phonemes", "classes"):
        expect(isinstance(text[name], list) and all(isinstance(label, str) for label in text[name]),
                f"model.json: {name} is not a list of texts")
    for name in ("fps", "search_stride"):
        expect(type(text[name]) is int, f"model.json: {name} is not a whole number")
    expect(isinstance(text["soft"], bool), "model.json: soft is neither true nor false")
    for name in ("aliases", "substitutes"):
        expect(isinstance(text[name], dict) and all(isinstance(label, str) for label in text[name].values()),
                f"model.json: {name} is not an object of texts")
    expect(isinstance(text["training"], dict), "model.json: training is not an object")
    return {**{name: text[name] for name in _TEXT}, "phonemes": tuple(text["phonemes"]),
            "classes": tuple(text["classes"])}


def mean_pose(model: Model) -> np.ndarray:
    """(13,) FAP: the pose that motion is widened about, the mean of the corpus outside silence."""
    known = model.training.get("mean_pose")
    if isinstance(known, list) and len(known) == CHANNELS:
        return np.asarray(known, dtype=np.float64)
    return model.emission_mean.mean(axis=1)


def widened(model: Model, gain: Union[float, np.ndarray], centre: Optional[np.ndarray] = None,
            contacts: bool = True) -> Model:
    """The model with its targets widened about `centre` (13,), by default the mean pose, by a factor for all channels
    or one per channel (13,). Least squares learns averages, which move less than the averaged motions: lips that follow
    them mumble. Widening the motion about its mean restores the range; the average error grows, slowly at first. All
    terms of a target are linear, so that the factor applies to the tables: shape' = c + g (shape - c); slopes, kernels
    and pairs are multiplied by g. Floors, where lips meet, stay; the search and equation 3 follow the targets. Without
    `contacts` phonemes in which lips meet keep their own shape in the channels in which they do, so that they press no
    harder where others open wider."""
    factor = np.broadcast_to(np.asarray(gain, dtype=np.float64), (CHANNELS,))
    if centre is None:
        centre = mean_pose(model)
    own = np.tile(factor, (len(model.phonemes), 1))
    if not contacts:
        meets = model.contact.copy()
        meets[model.phonemes.index(model.silence)] = False
        own[meets] = 1.0
    of_component = np.repeat(own, model.component_count, axis=0)
    return replace(model, shape=centre + (model.shape - centre) * of_component, slope=model.slope * of_component,
                   kernel=model.kernel * factor, pair_shape=model.pair_shape * factor)
