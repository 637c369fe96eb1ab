"""How far the mouth moves: the trade between the smallest average error and motion as wide as a human's.

Least squares learns averages, which move less than the averaged motions: lips that follow them mumble. Widening the
motion about its mean restores the range; the average error grows, slowly at first.
"""

from __future__ import annotations

import dataclasses
from typing import Optional, Union

import numpy as np

from labial.files.faps import CHANNELS
from labial.tables.model import Model


def mean_pose(model: Model) -> np.ndarray:
    """(13,) FAP: the pose that motion is widened about, the mean of the corpus outside silence."""
    known = model.training.get("mean_pose")
    if isinstance(known, list) and len(known) == CHANNELS:
        return np.asarray(known, dtype=np.float64)
    result: np.ndarray = model.emission_mean.mean(axis=1)
    return result


def widened(model: Model, gain: Union[float, np.ndarray], centre: Optional[np.ndarray] = None,
            contacts: bool = True) -> Model:
    """The model with its targets widened about `centre` (13,), by default the mean pose, by a factor for all channels
    or one per channel (13,).

    All terms of a target are linear, so that the factor applies to the tables: shape' = c + g (shape - c); slopes,
    kernels and pairs are multiplied by g. Floors, where lips meet, stay; the search and equation 3 follow the targets.
    Without `contacts` phonemes in which lips meet keep their own shape in the channels in which they do, so that they
    press no harder where others open wider.
    """
    factor = np.broadcast_to(np.asarray(gain, dtype=np.float64), (CHANNELS,))
    if centre is None:
        centre = mean_pose(model)
    own = np.tile(factor, (len(model.phonemes), 1))
    if not contacts:
        meets = model.contact.copy()
        meets[model.phonemes.index(model.silence)] = False
        own[meets] = 1.0
    of_component = np.repeat(own, model.component_count, axis=0)
    return dataclasses.replace(
        model,
        shape=centre + (model.shape - centre) * of_component,
        slope=model.slope * of_component,
        kernel=model.kernel * factor,
        pair_shape=model.pair_shape * factor,
    )
