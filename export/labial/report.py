"""What the exporter prints about a model that it wrote."""

from __future__ import annotations

import numpy as np

from labial import emit
from labial.faps import CHANNELS, FAP_NAMES
from labial.fixed import SEARCHED, WEIGHT_MIN, weight_value
from labial.loss import Loss
from labial.model import Model
from labial.quantise import ExportedModel
from labial.reference.trajectory import WINDOW


def workspace_bytes(stride: int) -> int:
    """LABIAL_WORKSPACE_SIZE of the library's default limits."""
    progress = 40 + 8 * (WINDOW + 1) + (3 + SEARCHED + 3) // 4 * 4
    return CHANNELS * progress + (stride * (32 + 2 * CHANNELS) + 3) // 4 * 4


def memory(exported: ExportedModel) -> str:
    """Flash by group of tables, and RAM."""
    tables = emit.table_bytes(exported)
    lines = [f"{'flash, ' + name:<32}{size:>8} bytes" for name, size in tables.items()]
    lines.append(f"{'flash, model':<32}{sum(tables.values()):>8} bytes")
    lines.append(f"{'flash, names, if used':<32}{emit.names_bytes(exported):>8} bytes")
    lines.append(f"{'RAM, workspace':<32}{workspace_bytes(exported.search_stride):>8} bytes")
    return "\n".join(lines)


def loosened(model: Model, exported: ExportedModel) -> int:
    """States whose delta-delta weight is less of what holds them than trained by more than codes are rounded."""
    trained = model.state_precision[..., 2] / (model.state_precision[..., 0] + model.state_anchor)
    kept = weight_value(exported.state_weight[..., 1]) / weight_value(exported.state_hold)
    return int((kept < 0.85 * trained).sum())


def quantisation(loss: Loss, model: Model, exported: ExportedModel) -> str:
    """The loss per channel, and what was dropped or held to a limit."""
    title = "from the published method, FAP" if loss.by_design else "quantisation loss, FAP units"
    lines = [f"{title:<32}{'rms':>8}{'max':>8}{'% of range':>12}{'nats per state':>15}"]
    for k, name in enumerate(FAP_NAMES):
        lines.append(f"{name:<32}{loss.rms[k]:>8.3f}{loss.largest[k]:>8.2f}{loss.share[k]:>12.2f}{loss.path[k]:>15.3f}")
    possible = int(np.isfinite(model.log_transition).sum())
    kept = int(np.isfinite(exported.dense_transitions()).sum())
    lines.append(f"transitions kept: {kept} of {possible}; the state paths lose {loss.path.mean():.3f} nats per state "
                 "on average")
    floor = int((weight_value(exported.state_hold) <= WEIGHT_MIN).sum())
    lines.append(f"states held by no more than the least weight: {floor} of {exported.state_hold.size}")
    lines.append(f"states that are less stiff than trained, within the solver's bounds: {loosened(model, exported)} "
                 f"of {exported.state_hold.size}")
    if loss.by_design:
        lines.append(str(loss.by_design))
    return "\n".join(lines)
