"""The network of :mod:`labial.hearing.network` in PyTorch, to be trained; and back as a model.

PyTorch is imported by whoever imports this module, which only training does.
"""

from __future__ import annotations

from typing import Any, Dict, List, NamedTuple, Tuple

import numpy as np
import torch
from torch import nn

from labial.errors import LabialError
from labial.files.faps import CHANNELS
from labial.hearing.model import CLASSES, INPUTS, HearingModel, Memory, Plan
from labial.hearing.targets import Closure

#: The largest shift and magnitude of an int8 weight in the library.
_SHIFT_MAX, _MOST = 15, 127


def rounded(weight: torch.Tensor) -> torch.Tensor:
    """A weight (rows, n) as the library rounds it, w = q / 2^s with one s for each row; its gradient is that of the
    weight itself."""
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


class Block(nn.Module):  # type: ignore[misc, unused-ignore]
    """A dense layer, relu, and a memory; with `skip` the input is added."""

    def __init__(self, inputs: int, units: int, memory: Memory, skip: bool) -> None:
        super().__init__()
        self.dense = nn.Linear(inputs, units)
        self.reach = memory
        self.memory = nn.Parameter(0.05 * torch.randn(units, memory.taps))
        with torch.no_grad():
            self.memory[:, memory.past] += 1.0
        self.skip = skip

    def forward(self, x: torch.Tensor, integer: bool) -> torch.Tensor:
        """(B, T, inputs) to (B, T, units); with `integer` all weights are rounded."""
        weight, memory = self.dense.weight, self.memory
        if integer:
            weight, memory = rounded(weight), rounded(memory)
        y = torch.relu(nn.functional.linear(x, weight, self.dense.bias))
        z: torch.Tensor = Remembered.apply(y, memory, self.reach)
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
        x = torch.relu(self._dense(self.last, x, integer))
        return Told(self._dense(self.classes, x, integer), self._dense(self.closed, x, integer)[..., 0],
                    self._dense(self.faps, x, integer), excess)

    @staticmethod
    def _dense(layer: nn.Linear, x: torch.Tensor, integer: bool) -> torch.Tensor:
        return nn.functional.linear(x, rounded(layer.weight) if integer else layer.weight, layer.bias)


def restore(learner: Learner, model: HearingModel, mean: np.ndarray, scale: np.ndarray) -> None:
    """Gives a network what a model hears; its frames become those of `mean` and `scale` (13,).

    A network with more units has the model's in front; the others begin at random, and nothing hears them yet. Of
    memories that reach elsewhere the taps count that both have. Raises LabialError for a model with more units or
    another number of blocks.
    """
    units, own = len(model.last_bias), learner.plan.units
    if units > own or len(model.memories) != len(learner.plan.memories):
        raise LabialError(f"a network of {own} units in {len(learner.plan.memories)} blocks cannot begin with a model "
                          f"of {units} units in {len(model.memories)} blocks")
    given: List[Tuple[Any, np.ndarray]] = [
        (learner.last.weight, model.last), (learner.last.bias, model.last_bias),
        (learner.classes.weight, model.class_weight), (learner.classes.bias, model.class_bias),
        (learner.closed.weight, model.closed_weight[None]), (learner.closed.bias, model.closed_bias),
        (learner.faps.weight, model.fap_weight * (model.fap_scale / scale)[:, None]),
        (learner.faps.bias, (model.fap_bias * model.fap_scale + model.fap_mean - mean) / scale)]
    blocks: List[Any] = list(learner.blocks)
    for block, dense, bias in zip(blocks, model.dense, model.bias):
        given += [(block.dense.weight, dense), (block.dense.bias, bias)]
    with torch.no_grad():
        for parameter, value in given:
            rows = torch.from_numpy(np.asarray(value, np.float32))
            if rows.ndim == 1:
                parameter[: len(rows)] = rows
            else:
                parameter[: len(rows), : rows.shape[1]] = rows
                parameter[: len(rows), rows.shape[1] :] = 0.0
        for block, weight, memory in zip(blocks, model.memory, model.memories):
            block.memory[:units] = 0.0
            for tap in range(memory.taps):
                at, rest = divmod((tap - memory.past) * memory.dilation, block.reach.dilation)
                if rest == 0 and -block.reach.past <= at <= block.reach.ahead:
                    block.memory[:units, at + block.reach.past] = torch.from_numpy(weight[:, tap].copy())


def model_of(
    learner: Learner, mean: np.ndarray, scale: np.ndarray, closure: Closure, edges: Tuple[float, float],
    attribution: str, training: Dict[str, object],
) -> HearingModel:
    """The model of a trained network. `mean` and `scale` (13,) are those of the frames that it learned, `edges` the
    scores at which lips begin to close and are closed. The weights are those that the library rounds to."""

    def weights(layer: Any) -> np.ndarray:
        return _array(rounded(layer if isinstance(layer, nn.Parameter) else layer.weight))

    blocks: List[Any] = list(learner.blocks)
    return HearingModel(
        memories=learner.plan.memories, dense=tuple(weights(block.dense) for block in blocks),
        bias=tuple(_array(block.dense.bias) for block in blocks),
        memory=tuple(weights(block.memory) for block in blocks), last=weights(learner.last),
        last_bias=_array(learner.last.bias), class_weight=weights(learner.classes),
        class_bias=_array(learner.classes.bias), closed_weight=weights(learner.closed)[0],
        closed_bias=_array(learner.closed.bias), fap_weight=weights(learner.faps),
        fap_bias=_array(learner.faps.bias), classes=CLASSES, fap_mean=np.asarray(mean, np.float32),
        fap_scale=np.asarray(scale, np.float32), closed=closure.pose, closing=closure.share, close_from=edges[0],
        close_to=edges[1], attribution=attribution, training=training)


def _array(value: torch.Tensor) -> np.ndarray:
    result: np.ndarray = value.detach().numpy().astype(np.float32)
    return result
