"""``labial train-hear``: from folders of speech to a model of hearing. Needs PyTorch, which is imported with this
module.

Each batch has random crops of the folders' takes, in the folders' shares. The loss is the cross-entropy of the lip
classes and of closed lips, and the squared error of the frames and of their differences, so that lips move as smoothly
as Labial's. In the last tenth of the steps the weights are rounded as in the library.
"""

from __future__ import annotations

import os
import time
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Callable, Dict, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np
import torch
from torch import nn

from labial.errors import LabialError
from labial.files.faps import CHANNELS, FAP_NUMBERS
from labial.hearing import targets
from labial.hearing.distort import augmented, noises, white
from labial.hearing.features import BANDS, FLOOR, HOPS, normalise_crops
from labial.hearing.measures import Choice, choose
from labial.hearing.model import CLASSES, CLOSED, INPUTS, PLANS, HearingModel, Memory, Plan, save, with_even_sides
from labial.hearing.prepared import Prepared, lesson
from labial.hearing.targets import Closure

#: The largest shift and magnitude of an int8 weight in the library.
_SHIFT_MAX, _MOST = 15, 127


def rounded(weight: torch.Tensor) -> torch.Tensor:
    """A weight (rows, n) as the library rounds it, q / 2^s with one s for each row; its gradient stays the weight's."""
    with torch.no_grad():
        most = weight.abs().amax(dim=1, keepdim=True).clamp(min=1e-9)
        scale = torch.exp2(torch.floor(torch.log2(_MOST / most)).clamp(max=_SHIFT_MAX))
        difference = torch.round(weight * scale).clamp(-_MOST, _MOST) / scale - weight
    return weight + difference


class Remembered(torch.autograd.Function):  # type: ignore[misc, unused-ignore]
    """A memory (H, K) over y (B, T, H), zeros before and after it, as of :func:`labial.hearing.network.remembered`.
    What autograd would make of its sums takes twice as long."""

    @staticmethod
    def forward(ctx: Any, y: torch.Tensor, weight: torch.Tensor, reach: Memory) -> torch.Tensor:
        """(B, T, H)."""
        padded = nn.functional.pad(y, (0, 0, reach.past * reach.dilation, reach.ahead * reach.dilation))
        ctx.save_for_backward(padded, weight)
        ctx.reach = reach
        count, taps = y.shape[1], weight.t().contiguous()
        z = torch.zeros_like(y)
        for k in range(reach.taps):
            z.addcmul_(padded[:, k * reach.dilation :][:, :count], taps[k])
        return z

    @staticmethod
    def backward(ctx: Any, gradient: torch.Tensor) -> Tuple[torch.Tensor, torch.Tensor, None]:
        """Gradients of y and of the weights."""
        (padded, weight), reach = ctx.saved_tensors, ctx.reach
        count, taps = gradient.shape[1], weight.t().contiguous()
        mirrored = nn.functional.pad(gradient, (0, 0, reach.ahead * reach.dilation, reach.past * reach.dilation))
        of_y, of_weight = torch.zeros_like(gradient), torch.empty_like(weight)
        for k in range(reach.taps):
            of_y.addcmul_(mirrored[:, (reach.taps - 1 - k) * reach.dilation :][:, :count], taps[k])
            of_weight[:, k] = (padded[:, k * reach.dilation :][:, :count] * gradient).sum(dim=(0, 1))
        return of_y, of_weight, None


def _through(layer: nn.Linear, x: torch.Tensor, integer: bool) -> torch.Tensor:
    """What a layer makes of x; with `integer` its weights are rounded."""
    return nn.functional.linear(x, rounded(layer.weight) if integer else layer.weight, layer.bias)


class Block(nn.Module):  # type: ignore[misc, unused-ignore]
    """A dense layer, relu, and a memory; with `skip` the input is added."""

    def __init__(self, inputs: int, units: int, memory: Memory, skip: bool) -> None:
        super().__init__()
        self.dense = nn.Linear(inputs, units)
        self.reach, self.skip = memory, skip
        self.memory = nn.Parameter(0.05 * torch.randn(units, memory.taps))
        with torch.no_grad():
            self.memory[:, memory.past] += 1.0

    def forward(self, x: torch.Tensor, integer: bool) -> torch.Tensor:
        """(B, T, inputs) to (B, T, units); with `integer` all weights are rounded."""
        y = torch.relu(_through(self.dense, x, integer))
        z: torch.Tensor = Remembered.apply(y, rounded(self.memory) if integer else self.memory, self.reach)
        return z + x if self.skip else z


class Told(NamedTuple):
    """What a network makes of features (B, T, 48)."""

    scores: torch.Tensor  #: (B, T, 26)
    closed: torch.Tensor  #: (B, T), the score of closed lips
    faps: torch.Tensor  #: (B, T, 13) of mean 0 and scale 1
    excess: torch.Tensor  #: () the penalty of activations that come near the library's limit of 64


class Learner(nn.Module):  # type: ignore[misc, unused-ignore]
    """The network."""

    def __init__(self, plan: Plan) -> None:
        super().__init__()
        self.plan = plan
        self.blocks = nn.ModuleList(
            Block(plan.units if k else INPUTS, plan.units, memory, k > 0) for k, memory in enumerate(plan.memories))
        self.last = nn.Linear(plan.units, plan.units)
        self.classes = nn.Linear(plan.units, len(CLASSES))
        self.closed = nn.Linear(plan.units, 1)
        self.faps = nn.Linear(plan.units, CHANNELS)

    def forward(self, x: torch.Tensor, integer: bool = False) -> Told:
        """What it makes of features (B, T, 48); with `integer` all weights are rounded."""
        excess = x.new_zeros(())
        for block in self.blocks:
            x = block(x, integer)
            excess = excess + (x.abs() - 32.0).clamp(min=0).square().mean()
        x = torch.relu(_through(self.last, x, integer))
        return Told(_through(self.classes, x, integer), _through(self.closed, x, integer)[..., 0],
                    _through(self.faps, x, integer), excess)


def restore(learner: Learner, model: HearingModel, mean: np.ndarray, scale: np.ndarray) -> None:
    """Gives a network what a model hears; its frames become those of `mean` and `scale` (13,). A network with more
    units has the model's in front; the others begin at random, and nothing hears them yet. Of memories that reach
    elsewhere the taps count that both have. Raises LabialError for more units or another number of blocks."""
    units, own = len(model.last_bias), learner.plan.units
    if units > own or len(model.memories) != len(learner.plan.memories):
        raise LabialError(f"a network of {own} units in {len(learner.plan.memories)} blocks cannot begin with a model "
                          f"of {units} units in {len(model.memories)} blocks")
    blocks: List[Any] = list(learner.blocks)
    given: List[Tuple[Any, np.ndarray, np.ndarray]] = [
        (learner.last, model.last, model.last_bias), (learner.classes, model.class_weight, model.class_bias),
        (learner.closed, model.closed_weight[None], model.closed_bias),
        (learner.faps, model.fap_weight * (model.fap_scale / scale)[:, None],
         (model.fap_bias * model.fap_scale + model.fap_mean - mean) / scale),
        *((block.dense, dense, bias) for block, dense, bias in zip(blocks, model.dense, model.bias))]
    with torch.no_grad():
        for parameter, value in (pair for layer, *pairs in given for pair in zip((layer.weight, layer.bias), pairs)):
            rows = torch.from_numpy(np.asarray(value, np.float32))
            if rows.ndim == 2:
                parameter[: len(rows)] = 0.0
            parameter[tuple(map(slice, rows.shape))] = rows
        for block, weight, memory in zip(blocks, model.memory, model.memories):
            block.memory[:units] = 0.0
            for tap in range(memory.taps):
                at, rest = divmod((tap - memory.past) * memory.dilation, block.reach.dilation)
                if rest == 0 and -block.reach.past <= at <= block.reach.ahead:
                    block.memory[:units, at + block.reach.past] = torch.from_numpy(weight[:, tap].copy())


def model_of(learner: Learner, mean: np.ndarray, scale: np.ndarray, closure: Closure, edges: Tuple[float, float],
             attribution: str, training: Dict[str, object]) -> HearingModel:
    """The model of a trained network. `mean` and `scale` (13,) are those of the frames that it learned, `edges` the
    scores at which lips begin to close and are closed. The weights are those that the library rounds to."""

    def array(value: torch.Tensor) -> np.ndarray:
        return value.detach().numpy().astype(np.float32)

    def both(layer: nn.Linear) -> Tuple[np.ndarray, np.ndarray]:
        return array(rounded(layer.weight)), array(layer.bias)

    blocks: List[Any] = list(learner.blocks)
    dense, bias = zip(*(both(block.dense) for block in blocks))
    last, classes, lips, faps = map(both, (learner.last, learner.classes, learner.closed, learner.faps))
    return HearingModel(
        learner.plan.memories, dense, bias, tuple(array(rounded(block.memory)) for block in blocks), *last, *classes,
        lips[0][0], lips[1], *faps, CLASSES, np.asarray(mean, np.float32), np.asarray(scale, np.float32),
        closure.pose, closure.share, *edges, attribution, training)


#: Frames of a crop, and crops of a batch.
LENGTH, BATCH = 200, 24
#: Frames at a crop's begin and end that are not learned: they lack history, or what the network looks ahead to, and so
#: many more.
_BEGIN, _END = 12, 2
#: The steps over which the learning rate rises, and its least share at the end.
_WARM, _LEAST = 200, 0.006
#: Weights of the squared error, of the entropy of closed lips and of the activations' excess.
_FRAMES, _LIPS, _EXCESS = 2.5, 1.0, 0.01
#: Channels that count twice: the jaw, the lips' middles and the corners. Frames of closures count so many times.
_IMPORTANT, _CLOSURE = (3, 51, 52, 53, 54), 3.0
#: Rare classes count more, by this power of their rarity; so much of each frame's likelihood belongs to all classes.
_RARITY, _SMOOTHED = 0.4, 0.03
#: Share of the steps with rounded weights.
_ROUNDED = 0.1
#: Share of the crops that are noise alone, where lips rest, and its level, log2 energy.
_ALONE, _LEVELS = 0.05, (3.0, 21.0)
#: Seconds of white noise that all noise is made of.
_NOISE = 600.0
#: Steps between two reports, and between two checkpoints.
REPORT, CHECKPOINT = 100, 2000


@dataclass(frozen=True)
class Options:
    """What decides a training besides its data. The same options, data and version of PyTorch give the same model."""

    model: str = "small"  #: of `PLANS`
    steps: int = 20000
    rate: float = 3e-3  #: of learning, its highest
    smoothness: float = 6.0  #: the weight of the squared error of the frames' second differences
    seed: int = 0
    shares: Tuple[float, ...] = ()  #: of each folder in a batch; without them the square roots of the lengths
    attribution: str = ""
    start: str = ""  #: SHA-256 of the model that it begins with, if it does not begin anew
    teacher: str = ""  #: and of the one that teaches, if any
    taught: float = 0.0  #: the teacher's share in what is learned of takes that have a truth


class _Batch(NamedTuple):
    """B crops of T frames."""

    classes: torch.Tensor  #: (B, T) int64
    heard: torch.Tensor  #: (B, T, 48) features
    frames: torch.Tensor  #: (B, T, 13) of mean 0 and scale 1
    likely: torch.Tensor  #: (B, T, 26)
    closed: torch.Tensor  #: (B, T)
    weight: torch.Tensor  #: (B, T) of `closed`


class _Data:
    """The takes that are learned, and how crops are drawn from them."""

    def __init__(self, folders: Sequence[Prepared], sounds: Sequence[Prepared], teacher: Optional[HearingModel],
                 options: Options) -> None:
        taught = [(item, options.taught) for item in folders] + [(item, 1.0) for item in sounds]
        parts = [lesson(item.part(held=False), teacher, share) for item, share in taught]
        for number, part in enumerate(parts, 1):
            if len(part.classes) <= LENGTH:
                raise LabialError(f"folder {number} has no more than {LENGTH} frames to learn from")
        shares = options.shares or tuple(float(np.sqrt(len(part.classes))) for part in parts)
        if len(shares) != len(parts) or min(shares) < 0 or sum(shares) <= 0:
            raise LabialError(f"{len(shares)} shares are given for {len(parts)} folders")
        self.shares = np.array(shares) / sum(shares)
        self.parts = parts
        every = np.concatenate([part.frames for part in parts]).astype(np.float64)
        self.rest = targets.frames([], 50)[-1]
        self.mean, self.scale = every.mean(axis=0), np.maximum(every.std(axis=0), 1.0)
        count = sum(share * np.bincount(part.classes, minlength=len(CLASSES)) / len(part.classes)
                    for part, share in zip(parts, self.shares))
        self.weight = (1 / len(CLASSES) / np.maximum(count, 1e-4)) ** _RARITY

    def batch(self, random: np.random.Generator, pool: np.ndarray) -> _Batch:
        """Random crops, with noise and channels."""
        crops = []
        for k in random.choice(len(self.parts), size=BATCH, p=self.shares):
            part = self.parts[k]
            at = int(random.integers(len(part.classes) - LENGTH))
            crops.append([part.energies[HOPS * at : HOPS * (at + LENGTH)],
                          *(item[at : at + LENGTH] for item in
                            (part.frames, part.classes, part.likely, part.closed, part.weight))])
        energies, frames, classes, likely, closed, weight = (np.stack(rows) for rows in zip(*crops))
        mixed = augmented(energies.astype(np.float32), pool, random)
        silence = CLASSES.index("SIL")
        for k in np.flatnonzero(random.random(BATCH) < _ALONE):
            mixed[k] = np.maximum(noises(1, HOPS * LENGTH, pool, random)[0] + random.uniform(*_LEVELS), FLOOR)
            frames[k], classes[k], closed[k], weight[k] = self.rest, silence, 0.0, 1.0
            likely[k] = np.eye(len(CLASSES))[silence]
        wanted = (frames - self.mean) / self.scale
        found = (normalise_crops(mixed).reshape(BATCH, LENGTH, HOPS * BANDS), wanted, likely, closed, weight)
        return _Batch(torch.from_numpy(classes.astype(np.int64)),
                      *(torch.from_numpy(item.astype(np.float32)) for item in found))


class _State:
    """A training that goes on: everything that changes with its steps."""

    def __init__(self, options: Options) -> None:
        torch.manual_seed(options.seed)
        self.learner = Learner(PLANS[options.model])
        self.optimiser = torch.optim.AdamW(self.learner.parameters(), lr=options.rate, weight_decay=1e-3)
        self.random = np.random.default_rng([options.seed, 1])
        self.step = 0

    def store(self, path: str, options: Options) -> None:
        """Writes a checkpoint, atomically."""
        content = {"options": asdict(options), "step": self.step, "learner": self.learner.state_dict(),
                   "optimiser": self.optimiser.state_dict(), "random": self.random.bit_generator.state}
        torch.save(content, f"{path}.part")
        os.replace(f"{path}.part", path)

    def restore(self, path: str, options: Options) -> None:
        """Reads a checkpoint. Raises LabialError if it is none, or one of other options."""
        try:
            content: Dict[str, Any] = torch.load(path, weights_only=True)
            if content["options"] != asdict(options):
                raise LabialError(f"{path}: a checkpoint of other options; remove it to begin anew")
            self.learner.load_state_dict(content["learner"])
            self.optimiser.load_state_dict(content["optimiser"])
            self.random.bit_generator.state = content["random"]
            self.step = int(content["step"])
        except LabialError:
            raise
        except Exception as error:  # torch raises many
            raise LabialError(f"{path}: not a checkpoint of train-hear ({type(error).__name__})") from None


def train(folders: Sequence[Prepared], options: Options, checkpoint: str, told: Optional[Callable[[str], None]] = None,
          early: Optional[Path] = None, start: Optional[HearingModel] = None, sounds: Sequence[Prepared] = (),
          teacher: Optional[HearingModel] = None) -> HearingModel:
    """Trains, in one thread, and chooses how lips close by the takes that are held out. The training continues from the
    file `checkpoint` if there is one; it is written every `CHECKPOINT` steps. `told` receives a line of figures every
    `REPORT` steps. The unfinished model is written to `early` with each checkpoint. With `start` it begins with what
    that model hears. Of `sounds` it learns what the `teacher` hears in them, which also has its share in what is
    learned of the `folders`. Raises LabialError for a folder with next to nothing to learn from, for shares of other
    folders, and for a `start` that is larger."""
    torch.set_num_threads(1)
    torch.use_deterministic_algorithms(True)
    data = _Data(folders, sounds, teacher, options)
    pool = white(_NOISE, np.random.default_rng([options.seed, 2]))
    state = _State(options)
    if start is not None:
        if start.classes != CLASSES:
            raise LabialError("the model to begin with has other classes")
        restore(state.learner, start, data.mean, data.scale)
    if os.path.exists(checkpoint):
        state.restore(checkpoint, options)
    figures: List[np.ndarray] = []
    begun, first = time.monotonic(), state.step
    while state.step < options.steps:
        figures.append(_step(state, data, pool, options))
        if told and (state.step % REPORT == 0 or state.step == options.steps):
            loss, right, error = np.mean(figures, axis=0)
            left = (time.monotonic() - begun) / (state.step - first) * (options.steps - state.step)
            told(f"step {state.step} of {options.steps}: loss {loss:.3f}, classes {right:.3f}, frames {error:.3f}, "
                 f"{left / 60:.0f} minutes left")
            figures = []
        if state.step % CHECKPOINT == 0 or state.step == options.steps:
            state.store(checkpoint, options)
            if early is not None and state.step < options.steps:
                save(finished(state, data, folders, options)[0], early)
    model, choice = finished(state, data, folders, options)
    if told:
        told(f"held out: {choice}")
    return model


def finished(state: _State, data: _Data, folders: Sequence[Prepared], options: Options) -> Tuple[HearingModel, Choice]:
    """The model as it is, and what was chosen for it."""
    about: Dict[str, object] = {**asdict(options), "step": state.step, "torch": str(torch.__version__),
                                "seconds": [round(len(part.classes) * targets.FRAME_MS / 1000) for part in data.parts]}
    del about["attribution"]

    def made(edges: Tuple[float, float]) -> HearingModel:
        return with_even_sides(
            model_of(state.learner, data.mean, data.scale, targets.closure(), edges, options.attribution, about))

    choice = choose(made((-1.0, 1.0)), [item.part(held=True) for item in folders], data.shares[: len(folders)])
    about["held_out"] = choice.figures()
    return made(choice.edges), choice


def _step(state: _State, data: _Data, pool: np.ndarray, options: Options) -> np.ndarray:
    """One step; its loss, the share of right classes and the mean squared error of frames."""
    batch = data.batch(state.random, pool)
    # The learning rate rises at the beginning and falls along a cosine.
    fallen = 0.5 * (1 + float(np.cos(np.pi * (state.step / options.steps))))
    for group in state.optimiser.param_groups:
        group["lr"] = options.rate * (min(1.0, (state.step + 1) / _WARM) * fallen + _LEAST)
    *told, excess = state.learner(batch.heard, state.step >= (1 - _ROUNDED) * options.steps)
    end = -state.learner.plan.ahead - _END
    scores, lips, faps = (item[:, _BEGIN:end] for item in told)
    classes, _, wanted, likely, closed, weight = (item[:, _BEGIN:end] for item in batch)
    rarity = torch.from_numpy(data.weight.astype(np.float32))
    likely = (1 - _SMOOTHED) * likely + _SMOOTHED / len(CLASSES)
    entropy = -(likely * rarity * scores.log_softmax(dim=2)).sum() / (likely * rarity).sum()
    touching = torch.nn.functional.binary_cross_entropy_with_logits(lips, closed, weight)
    channels = torch.tensor([2.0 if number in _IMPORTANT else 1.0 for number in FAP_NUMBERS])
    difference = faps - wanted
    error = difference.square() * channels
    frames = (error * (1 + (_CLOSURE - 1) * (classes == CLASSES.index(CLOSED))[..., None])).mean()
    jumps = (torch.diff(difference, n=2, dim=1).square() * channels).mean()
    loss = entropy + _FRAMES * frames + _LIPS * touching + options.smoothness * jumps + _EXCESS * excess
    state.optimiser.zero_grad()
    loss.backward()  # type: ignore[no-untyped-call, unused-ignore]
    torch.nn.utils.clip_grad_norm_(state.learner.parameters(), 1.0)
    state.optimiser.step()
    state.step += 1
    with torch.no_grad():
        right = (scores.argmax(dim=2) == classes).float().mean()
        squared = error.sum() / (channels.sum() * error.numel() / CHANNELS)
        return np.array([float(loss), float(right), float(squared)])
