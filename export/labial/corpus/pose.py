"""Removes head motion from tracked faces."""

from __future__ import annotations

import numpy as np


def align_head(markers: np.ndarray, reference: np.ndarray, weights: np.ndarray, scale: bool = False) -> np.ndarray:
    """Rotates and shifts each frame of `markers` (T, M, D) so that its head fits `reference` (M, D) best; D is 2 or 3.

    Weighted least squares over the markers with `weights` (M,) above 0 (Kabsch), with `scale` also a scale for each
    frame (Umeyama); frames with fewer than three such markers, or with all on a line, become NaN.
    """
    present = np.isfinite(markers).all(axis=2) & np.isfinite(reference).all(axis=1)  # (T, M)
    weight = present * weights
    usable = (present & (weights > 0)).sum(axis=1) >= 3
    total = np.where(usable, weight.sum(axis=1), 1.0)[:, None]
    points, target = np.where(present[..., None], markers, 0.0), np.where(np.isfinite(reference), reference, 0.0)
    centre = np.einsum("tm,tmi->ti", weight, points) / total
    target_centre = np.einsum("tm,mi->ti", weight, target) / total
    a, b = points - centre[:, None], target[None] - target_centre[:, None]
    u, s, vt = np.linalg.svd(np.einsum("tm,tmi,tmj->tij", weight, a, b))
    usable &= s[:, 1] > 1e-6 * np.maximum(s[:, 0], 1e-12)
    flip = np.ones_like(s)
    flip[:, -1] = np.sign(np.linalg.det(u) * np.linalg.det(vt))
    rotation = np.einsum("tij,tj,tjk->tik", u, flip, vt)  # row vectors: aligned = (m - centre) @ rotation
    factor = np.ones(len(markers))
    if scale:
        spread = np.einsum("tm,tmi->t", weight, a**2)
        factor = (s * flip).sum(axis=1) / np.where(spread > 0, spread, 1.0)
    turned = np.einsum("tmi,tij->tmj", markers - centre[:, None], rotation)
    aligned = factor[:, None, None] * turned + target_centre[:, None]
    aligned[~usable] = np.nan
    result: np.ndarray = aligned
    return result
