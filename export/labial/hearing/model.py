"""The trained model of hearing: its contents, and the .npz file in which it is stored; the sizes and the classes of the
networks that Labial comes with.

Shapes use H units, B blocks, K taps of a block's memory, C lip classes, and the 13 channels of
:mod:`labial.files.faps`. The network (:mod:`labial.hearing.network`) hears 48 features in each frame.
"""

from __future__ import annotations

import json
import os
from dataclasses import dataclass, field, replace
from typing import Any, BinaryIO, Dict, List, NamedTuple, Tuple, Union

import numpy as np

from labial.errors import ModelError, PathLike, expect
from labial.files import limits
from labial.files.arrays import ArrayError, array, read_zip, write_model
from labial.files.faps import CHANNELS, SIDES
from labial.hearing.features import BANDS, HOPS

#: Version of the .npz layout, and what tells such a file from a model of speech or laughter.
FORMAT = 2
KIND = "hearing"
#: Features of a frame.
INPUTS = HOPS * BANDS
#: Limits of `lib/hear_network.c`, the first where it is built for it: units, a multiple of four; blocks; frames that a
#: memory reaches back and ahead, times its dilation; classes.
UNITS_MAX, BLOCKS_MAX, REACH_MAX, CLASSES_MAX = 252, 8, 64, 64
#: Most frames that a network may look ahead.
AHEAD_MAX = 25
#: The largest weight, bias, score; the largest FAP.
_WEIGHT, _FAP = 64.0, 2000.0


class Memory(NamedTuple):
    """How far a block's memory reaches: `past` and `ahead` frames of `dilation` frames each, besides the present."""

    past: int
    ahead: int
    dilation: int

    @property
    def taps(self) -> int:
        """Taps of the memory, the oldest first; tap `past` is the present."""
        return self.past + self.ahead + 1


class Plan(NamedTuple):
    """The sizes of a network: its units and the memories of its blocks."""

    units: int
    memories: Tuple[Memory, ...]

    @property
    def ahead(self) -> int:
        """Frames that a frame waits for."""
        return sum(memory.ahead * memory.dilation for memory in self.memories)


#: The first three know a frame 80 ms after its end, and have smoothed it 20 ms later, 120 ms after its begin; the last
#: one, for sound that is there before it is played, 280 ms after its begin.
PLANS: Dict[str, Plan] = {
    "small": Plan(68, (Memory(5, 1, 1), Memory(5, 1, 1), Memory(5, 1, 2))),
    "large": Plan(76, (Memory(5, 1, 1), Memory(5, 1, 1), Memory(5, 1, 1), Memory(5, 1, 1))),
    "host": Plan(192, (Memory(5, 1, 1), Memory(5, 1, 1), Memory(5, 1, 1), Memory(5, 1, 1))),
    "ahead": Plan(192, (Memory(5, 3, 1), Memory(5, 3, 1), Memory(5, 3, 1), Memory(5, 3, 1))),
}
#: The lip classes, each named by the ARPABET phoneme that stands for it.
CLASSES = ("SIL", "M", "F", "TH", "T", "L", "S", "SH", "K", "HH", "R", "ER", "W", "IY", "IH", "EH", "AE", "AH", "AA",
           "AO", "OW", "UW", "UH", "AY", "AW", "EY")
#: The classes of the phonemes that stand for no class of their own.
MEMBERS = {"P": "M", "B": "M", "V": "F", "DH": "TH", "D": "T", "N": "T", "Z": "S", "ZH": "SH", "CH": "SH", "JH": "SH",
           "G": "K", "NG": "K", "Y": "IY", "OY": "AO"}
#: The class in which lips are closed.
CLOSED = "M"


def class_of(phoneme: str) -> str:
    """The lip class of an ARPABET phoneme without stress."""
    return MEMBERS.get(phoneme, phoneme)


@dataclass(frozen=True)
class HearingModel:
    """A network and what its outputs mean. All arrays are float32 and finite."""

    memories: Tuple[Memory, ...]  #: of the B blocks
    dense: Tuple[np.ndarray, ...]  #: (H, 48), then (H, H): what a block makes of its input
    bias: Tuple[np.ndarray, ...]  #: (H,) for each block
    memory: Tuple[np.ndarray, ...]  #: (H, K) of each block, the oldest tap first, as in a torch Conv1d (H, 1, K)
    last: np.ndarray  #: (H, H) the dense layer after the blocks
    last_bias: np.ndarray  #: (H,)
    class_weight: np.ndarray  #: (C, H)
    class_bias: np.ndarray  #: (C,)
    closed_weight: np.ndarray  #: (H,) of the score of closed lips
    closed_bias: np.ndarray  #: (1,)
    fap_weight: np.ndarray  #: (13, H)
    fap_bias: np.ndarray  #: (13,)
    classes: Tuple[str, ...]  #: C names
    fap_mean: np.ndarray  #: (13,) FAP units: a frame is fap_mean + fap_scale * head
    fap_scale: np.ndarray  #: (13,) FAP units, positive
    closed: np.ndarray  #: (13,) FAP units, the pose of closed lips
    closing: np.ndarray  #: (13,) 0 .. 1, how far each channel follows that pose when the lips are closed
    close_from: float  #: the score of closed lips at which they begin to close
    close_to: float  #: and at which they are closed
    attribution: str = ""  #: attribution that redistribution requires
    training: Dict[str, object] = field(default_factory=dict)  #: options and counts of the training, JSON values

    def __post_init__(self) -> None:
        check(self)

    @property
    def plan(self) -> Plan:
        """The sizes of the network."""
        return Plan(len(self.last_bias), self.memories)


_TEXT = ("memories", "classes", "close_from", "close_to", "attribution", "training")
#: Arrays with their shapes, F standing for channels; and those of which each block has one: ``dense_0`` and so on.
_ARRAYS = {"last": "HH", "last_bias": "H", "class_weight": "CH", "class_bias": "C", "closed_weight": "H",
           "closed_bias": "1", "fap_weight": "FH", "fap_bias": "F", "fap_mean": "F", "fap_scale": "F", "closed": "F",
           "closing": "F"}
_OF_BLOCKS = ("dense", "bias", "memory")


def check(model: HearingModel) -> None:
    """Raises ModelError unless every array has its shape and is finite, and every size is within the library's."""
    blocks, units, classes = len(model.memories), len(np.atleast_1d(model.last_bias)), len(model.classes)
    expect(1 <= blocks <= BLOCKS_MAX, f"there are {blocks} blocks, not 1 to {BLOCKS_MAX}")
    expect(units % 4 == 0 and 4 <= units <= UNITS_MAX,
            f"there are {units} units, not a multiple of 4 up to {UNITS_MAX}")
    expect(2 <= classes <= CLASSES_MAX and len(set(model.classes)) == classes,
            f"there are not 2 to {CLASSES_MAX} classes with different names")
    expect(all(name and name.isprintable() for name in model.classes), "a class has a name that is not printable")
    for past, ahead, dilation in model.memories:
        expect(past >= 0 and ahead >= 0 and dilation >= 1 and (past + ahead) * dilation <= REACH_MAX,
                f"a memory reaches {past} back and {ahead} ahead, times {dilation}")
    expect(model.plan.ahead <= AHEAD_MAX, f"the network looks {model.plan.ahead} frames ahead, not up to {AHEAD_MAX}")
    for name in _OF_BLOCKS:
        count = len(getattr(model, name))
        expect(count == blocks, f"{name} has {count} arrays, not one for each of {blocks} blocks")
    for name, value, shape in _shapes(model, units, classes):
        expect(value.shape == shape, f"{name} has shape {value.shape}, not {shape}")
        expect(value.dtype.kind == "f", f"{name} has the type {value.dtype}, not that of real numbers")
        most = _FAP if name in ("fap_mean", "fap_scale", "closed") else _WEIGHT
        expect(bool((np.abs(value) <= most).all()), f"{name} has a value that is not within {-most:g} .. {most:g}")
    expect(bool((model.fap_scale > 0).all()), "fap_scale has a value that is not positive")
    expect(bool(((model.closing >= 0) & (model.closing <= 1)).all()), "closing has a value that is not within 0 .. 1")
    low, high = model.close_from, model.close_to
    expect(-_WEIGHT <= low < high <= _WEIGHT, f"close_from {low:g} and close_to {high:g} are not in order")


def _shapes(model: HearingModel, units: int, classes: int) -> List[Tuple[str, np.ndarray, Tuple[int, ...]]]:
    """Name, value and shape of each array."""
    result: List[Tuple[str, Any, Tuple[int, ...]]] = []
    for k, memory in enumerate(model.memories):
        result += [(f"dense_{k}", model.dense[k], (units, units if k else INPUTS)),
                   (f"bias_{k}", model.bias[k], (units,)), (f"memory_{k}", model.memory[k], (units, memory.taps))]
    sizes = {"H": units, "C": classes, "F": CHANNELS, "1": 1}
    result += [(name, getattr(model, name), tuple(sizes[axis] for axis in shape)) for name, shape in _ARRAYS.items()]
    return [(name, np.asarray(value), shape) for name, value, shape in result]


def save(model: HearingModel, path: Union[PathLike, BinaryIO]) -> None:
    """Writes the model, to a path or to a file that is open. The same model gives the same bytes."""
    about = {**{name: getattr(model, name) for name in _TEXT}, "kind": KIND, "format": FORMAT}
    write_model(path, about, ((name, value.astype(np.float32))
                              for name, value, _ in _shapes(model, model.plan.units, len(model.classes))))


def is_hearing(path: PathLike) -> bool:
    """Whether a file says that it holds a model of hearing; false for all other files, also those that are missing."""
    try:
        text = json.loads(read_zip(path, ["model.json"], limits.HEARING)["model.json"].decode("utf-8"))
    except (OSError, ArrayError, KeyError, ValueError, RecursionError):
        return False
    return isinstance(text, dict) and text.get("kind") == KIND


def load(path: PathLike) -> HearingModel:
    """Reads and checks a model of hearing. Raises ModelError, which names the file, for anything else."""
    try:
        members = read_zip(path, None, limits.HEARING)
        expect("model.json" in members, "it holds no model.json")
        text = _texts(members["model.json"])

        def member(name: str) -> np.ndarray:
            expect(f"{name}.npy" in members, f"it holds no {name}.npy")
            value = array(name, members[f"{name}.npy"])
            expect(value.dtype.kind == "f", f"{name} has the type {value.dtype}, not that of real numbers")
            return value.astype(np.float32)

        blocks = range(len(text["memories"]))
        values: Dict[str, Any] = {name: tuple(member(f"{name}_{k}") for k in blocks) for name in _OF_BLOCKS}
        values.update({name: member(name) for name in _ARRAYS})
        return HearingModel(**text, **values)
    except OSError as error:
        raise ModelError(f"{os.fspath(path)}: {error.strerror or error}") from None
    except (ArrayError, ModelError) as error:
        raise ModelError(f"{os.fspath(path)}: not a model of hearing: {error}") from None


def _texts(data: bytes) -> Dict[str, Any]:
    """The content of model.json, with its types checked."""
    try:
        text = json.loads(data.decode("utf-8"))
    except (ValueError, RecursionError) as error:
        raise ModelError(f"model.json: not JSON ({str(error)[:80]})") from None
    expect(isinstance(text, dict) and text.get("kind") == KIND, f"model.json: its kind is not {KIND}")
    version = text.get("format")
    expect(version == FORMAT, f"format {version!r:.40}, but this version of labial reads format {FORMAT}")
    for name in _TEXT:
        expect(name in text, f"model.json: no {name}")
    expect(isinstance(text["attribution"], str), "model.json: attribution is not text")
    for name in ("close_from", "close_to"):
        expect(type(text[name]) in (int, float), f"model.json: {name} is not a number")
    classes, memories = text["classes"], text["memories"]
    expect(isinstance(classes, list) and all(isinstance(name, str) for name in classes),
            "model.json: classes is not a list of texts")
    expect(isinstance(memories, list) and len(memories) <= BLOCKS_MAX and all(
            isinstance(row, list) and [type(item) for item in row] == [int] * 3 for row in memories),
            f"model.json: memories is not a list of up to {BLOCKS_MAX} rows of three whole numbers")
    expect(isinstance(text["training"], dict), "model.json: training is not an object")
    values = {name: text[name] for name in _TEXT}
    return {**values, "classes": tuple(classes), "memories": tuple(Memory(*row) for row in memories)}


def with_even_sides(model: HearingModel) -> HearingModel:
    """The model with both sides of the mouth at the mean of what it has for each of them, exactly: the mean of two
    linear outputs is one, which both sides have."""
    made = {name: getattr(model, name).copy() for name, shape in _ARRAYS.items() if shape[0] == "F"}
    for pair in map(list, SIDES):
        share = made["fap_scale"][pair] / made["fap_scale"][pair].sum()
        for name, value in made.items():
            value[pair] = share @ value[pair] if name in ("fap_weight", "fap_bias") else value[pair].mean()
    return replace(model, **made)
