"""What ``lib/hear*.c`` computes, bit by bit, over a whole sound: the oracle of its tests.

The steps are those of :mod:`labial.hearing.convert`, :mod:`labial.hearing.features` and
:mod:`labial.hearing.network`; here they are in the library's integers.
"""

from __future__ import annotations

from typing import NamedTuple, Tuple

import numpy as np

from labial.hearing import features as front
from labial.hearing.convert import RATES, converted_count, extended, mixed, taps
from labial.hearing.features import BANDS, FLOOR, FRAME, HOP, HOPS, WINDOW, frames_of
from labial.hearing.network import SMOOTHING, Heard
from labial.hearing.quantise import Dense, HearingTables
from labial.reference.fade import EASE, FADE
from labial.tables.visemes import ONE, VISEME_OF, VISEMES

#: log2 is in 1/256; the level in 1/64 of the sum of the bands' log2.
LOG = 256
LEVEL_ONE = 64 * BANDS * LOG
#: The first and the last bin that belong to a band.
FIRST_BIN, LAST_BIN = 2, 121
#: The level before any sound, and more than any level, in 1 / `LEVEL_ONE`.
BEGIN, _NONE = round(front.LEVEL_BEGIN * LEVEL_ONE), 64 * LEVEL_ONE
#: Points of the transform: pairs of samples.
COUNT = WINDOW // 2
#: The largest difference of samples in silence, the silent frames before a frame that rests, and frames to rest.
SILENT, SILENT_BEFORE, RESTING = 32, 2, 5


def sine_table() -> np.ndarray:
    """(256,) Q15, the sine of 256 points of a turn; the cosine is 64 points further on."""
    return np.rint(32767 * np.sin(2 * np.pi * np.arange(WINDOW) / WINDOW)).astype(np.int64)


def place_table() -> np.ndarray:
    """(129,) where each bin lies between the bands' edges, in 1/256; 0 for bins that belong to none."""
    at = np.arange(WINDOW // 2 + 1)
    return np.where((at >= FIRST_BIN) & (at <= LAST_BIN), np.rint(front.places() * 256), 0).astype(np.int64)


def log_table() -> np.ndarray:
    """(33,) log2 of 1 to 2, in 1/256."""
    return np.rint(np.log2(1 + np.arange(33) / 32) * LOG).astype(np.int64)


def tap_table() -> np.ndarray:
    """(289,) Q15, the filter of the conversion."""
    return np.rint(taps() * 32768).astype(np.int64)


def _held(value: np.ndarray) -> np.ndarray:
    return np.clip(value, -32768, 32767)


# ---- The conversion --------------------------------------------------------------------------------------------------


def convert(sound: np.ndarray, rate: int) -> np.ndarray:
    """(M,) int64, a sound (N,) or (N, 2) of int16 at `rate` as one at 16 kHz."""
    samples = mixed(sound)
    way = RATES[rate]
    if way.stride == way.step:
        return samples
    left, rest = np.divmod(np.arange(converted_count(len(samples), rate)) * way.step, way.stride)
    distance, spacing, table = (rest + 5) // 10, way.stride // 10, tap_table()
    padded = extended(samples, way.reach, way.reach)
    total = np.zeros(len(left), dtype=np.int64)
    for k in range(way.reach):
        total += padded[left + way.reach - k] * table[distance + k * spacing]
        total += padded[left + way.reach + 1 + k] * table[spacing - distance + k * spacing]
    return _held(((total >> 10) * spacing + 256) >> 9)


# ---- The features ----------------------------------------------------------------------------------------------------


def _transform(re: np.ndarray, im: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """The spectra / 128 of (n, 128) complex samples, in their own order (:func:`_order`)."""
    sine = sine_table()
    quarter, turn = COUNT // 4, 2
    while quarter:
        shape = (len(re), COUNT // 4 // quarter, 4, quarter)
        (ar, br, cr, dr), (ai, bi, ci, di) = (np.moveaxis(part.reshape(shape), 2, 0) for part in (re, im))
        er, ei, fr, fi = ar + cr, ai + ci, ar - cr, ai - ci
        gr, gi, hr, hi = br + dr, bi + di, bi - di, dr - br  # h is -j (b - d)
        parts = ((er + gr, ei + gi), (fr + hr, fi + hi), (er - gr, ei - gi), (fr - hr, fi - hi))
        out_re, out_im = [], []
        for k, (xr, xi) in enumerate(parts):
            xr, xi = (xr + 2) >> 2, (xi + 2) >> 2
            at = k * turn * np.arange(quarter)
            c, s = sine[(at + 64) & 255], sine[at & 255]
            out_re.append(np.where(at > 0, (xr * c + xi * s + 16384) >> 15, xr))
            out_im.append(np.where(at > 0, (xi * c - xr * s + 16384) >> 15, xi))
        re, im = (np.stack(part, axis=2).reshape(len(re), COUNT) for part in (out_re, out_im))
        quarter, turn = quarter // 4, turn * 4
    done = [np.stack([(part[:, ::2] + part[:, 1::2] + 1) >> 1, (part[:, ::2] - part[:, 1::2] + 1) >> 1], axis=-1)
            for part in (re, im)]
    return done[0].reshape(len(re), COUNT), done[1].reshape(len(re), COUNT)


def _order(k: np.ndarray) -> np.ndarray:
    """Where point k of a spectrum lies."""
    return (k & 3) << 5 | (k >> 2 & 3) << 3 | (k >> 4 & 3) << 1 | k >> 6


def _bits(value: np.ndarray) -> np.ndarray:
    """How many bits non-negative numbers have."""
    return np.ceil(np.log2(value.astype(np.float64) + 1)).astype(np.int64)


def _log2(value: np.ndarray) -> np.ndarray:
    """log2 of positive numbers below 2^32, in 1/256."""
    bits = _bits(value)
    top = np.where(bits > 16, value >> np.maximum(bits - 16, 0), value << np.maximum(16 - bits, 0))
    table, at, rest = log_table(), top >> 10 & 31, top & 1023
    return (bits - 1) * LOG + table[at] + (((table[at + 1] - table[at]) * rest) >> 10)


def log_energies(sound: np.ndarray) -> np.ndarray:
    """(2 T, 24) int64 log2 energies in 1/256 of a sound (N,) of int16 at 16 kHz."""
    count, before = HOPS * frames_of(len(sound)), WINDOW - HOP
    padded = extended(sound.astype(np.int64), before, count * HOP - len(sound))
    x = padded[np.arange(count)[:, None] * HOP + np.arange(WINDOW)]
    low, high = x.min(axis=1), x.max(axis=1)
    middle = (low + high) >> 1
    up = np.maximum(14 - _bits(high - middle), -1)  # high - middle is middle - low or one more
    sine = sine_table()
    window = (32768 - sine[(np.arange(WINDOW) + 64) & 255]) >> 1
    centred = x - middle[:, None]
    shaped = (np.where(up[:, None] >= 0, centred << np.maximum(up, 0)[:, None], centred >> 1) * window + 16384) >> 15
    re, im = _transform(shaped[:, 0::2], shaped[:, 1::2])
    acc = np.zeros((count, BANDS + 2), dtype=np.int64)
    place = place_table()

    def share(k: int, power: np.ndarray) -> None:
        band, part = place[k] >> 8, place[k] & 255
        above = (power >> 8) * part + (((power & 255) * part) >> 8)
        acc[:, band] += power - above
        acc[:, band + 1] += above

    for k in range(FIRST_BIN, COUNT // 2 + 1):
        p, q = (int(_order(np.array(i))) for i in (k, COUNT - k))
        ar, ai, br, bi = re[:, p] + re[:, q], im[:, p] - im[:, q], im[:, p] + im[:, q], re[:, q] - re[:, p]
        c, s = sine[k + 64], sine[k]
        tr, ti = (br * c + bi * s + 16384) >> 15, (bi * c - br * s + 16384) >> 15
        share(k, (ar + tr) ** 2 + (ai + ti) ** 2)
        if COUNT // 2 > k >= COUNT - LAST_BIN:
            share(COUNT - k, (ar - tr) ** 2 + (ai - ti) ** 2)
    energy = acc[:, 1:-1]
    logs = _log2(np.maximum(energy, 1)) + (12 - 2 * up[:, None]) * LOG
    logs = np.where((energy > 0) & (high > low)[:, None], logs, 0)
    return np.maximum(logs, int(FLOOR * LOG))


class Levels(NamedTuple):
    """The level of a sound of n hops."""

    hops: np.ndarray  #: (n,) int64, in 1/256
    voiced: np.ndarray  #: (n,) bool: not before the first voice
    last: int  #: the level at the end, in 1 / `LEVEL_ONE`


def levels(energies: np.ndarray, silent: np.ndarray, begin: int) -> Levels:
    """The level of log2 energies (n, 24) in 1/256, of which hops are `silent` (n,), from the level `begin` on, in
    1 / `LEVEL_ONE`: see :mod:`labial.hearing.features`."""
    level, waiting, fall = begin, True, round(front.SEARCH * LEVEL_ONE)
    quietest = before = _NONE
    hops, voiced = np.zeros(len(energies), dtype=np.int64), np.zeros(len(energies), dtype=bool)
    for k, total in enumerate(energies.sum(axis=1).tolist()):
        now = total * 64
        if waiting and not silent[k]:
            quietest = min(quietest, max(before, now))
            waiting = (now <= level - round(front.NEAR_LEVEL * LEVEL_ONE)
                       and now <= quietest + round(front.RISE * LEVEL_ONE))
        before = _NONE if silent[k] else now
        if not waiting:
            level = max(level - fall, round(front.LEVEL_LEAST * LEVEL_ONE))
        if now >= level:
            level, waiting, fall = now, False, round(front.DECAY * LEVEL_ONE)
        hops[k], voiced[k] = level // (64 * BANDS), not waiting
    return Levels(hops, voiced, level)


def normalise(energies: np.ndarray, level: np.ndarray) -> np.ndarray:
    """(n, 24) int64, features in Q9 of log2 energies (n, 24) at levels (n,), both in 1/256."""
    low, high = (round(end * LOG) for end in front.RANGE)
    return (np.clip(energies - level[:, None], low, high) + round(front.OFFSET * LOG)) >> 1


# ---- The network -----------------------------------------------------------------------------------------------------


def _dense(table: Dense, x: np.ndarray) -> np.ndarray:
    """(T, rows) of (T, columns), held to int16."""
    half = (1 << table.shift) >> 1
    return _held((x @ table.weight.T + table.bias * (1 << table.shift) + half) >> table.shift)


def heads(tables: HearingTables, heard: np.ndarray) -> np.ndarray:
    """(T, C + 14) Q9, the three heads for features (T, 48) in Q9."""
    x = np.asarray(heard, dtype=np.int64)
    for k, block in enumerate(tables.blocks):
        past, ahead, dilation = block.memory
        y = np.maximum(_dense(block.dense, x), 0)
        padded = np.pad(y, ((past * dilation, ahead * dilation), (0, 0)))
        total = np.zeros_like(y) + ((1 << block.shift) >> 1)
        for tap in range(past + ahead + 1):
            total += padded[tap * dilation : tap * dilation + len(y)] * block.taps[:, tap]
        x = _held((total >> block.shift) + (x if k else 0))
    return _dense(tables.heads, np.maximum(_dense(tables.last, x), 0))


def poses(tables: HearingTables, head: np.ndarray) -> np.ndarray:
    """(T, 13) poses in Q4 of heads (T, C + 14)."""
    classes = len(tables.classes)
    over = np.clip(head[:, classes] - tables.close_from, 0, tables.close_width)
    share = (over << 8) // tables.close_width
    pose = tables.mean + ((head[:, classes + 1 :] * tables.scale) >> 9)
    pose += ((tables.closed - pose) * ((share[:, None] * tables.closing) >> 8)) >> 8
    return np.clip(pose, -32767, 32767)


class _Told(NamedTuple):
    """What the network tells of T frames."""

    heard: Heard
    pose: np.ndarray  #: (T, 13) in Q4, smoothed
    still: np.ndarray  #: (T,) bool: silent, or before the first voice
    leaders: np.ndarray  #: (T + 1,) the class that leads, also in the frame after the last
    level: int  #: after the last frame and what the network looks ahead, in 1 / `LEVEL_ONE`


def hear(tables: HearingTables, sound: np.ndarray, rate: int = 16000) -> Heard:
    """Scores (T, C) and (T,) in Q9 and FAPs (T, 13), int64, of a sound (N,) or (N, 2) of int16 at `rate`, to its end:
    what the network tells, under way, from the level `BEGIN` on."""
    return _of_sound(tables, sound, rate, BEGIN).heard


def hear_energies(tables: HearingTables, energies: np.ndarray, count: int) -> Heard:
    """The first `count` frames of log2 energies (n, 24) in 1/256, int64, which reach as far as the network looks ahead
    and smoothing waits for; in digital silence and before the first voice they are at rest, as in a stream."""
    silent = energies.sum(axis=1) <= (FLOOR + 0.5) * LOG * BANDS
    told = _of_energies(tables, energies, silent, count, BEGIN)
    return told.heard._replace(faps=(_resting(told.pose, told.still, tables.ahead + SMOOTHING) + 8) >> 4)


def _of_sound(tables: HearingTables, sound: np.ndarray, rate: int, begin: int) -> _Told:
    samples = convert(np.asarray(sound), rate)
    count = frames_of(len(samples))
    frames = count + SMOOTHING + tables.ahead
    padded = extended(samples, 0, frames * FRAME - len(samples))
    silent = np.ptp(padded.reshape(-1, HOP), axis=1) <= SILENT
    return _of_energies(tables, log_energies(padded), silent, count, begin)


def _of_energies(tables: HearingTables, energies: np.ndarray, silent: np.ndarray, count: int, begin: int) -> _Told:
    known, level = count + SMOOTHING, levels(energies, silent, begin)
    head = heads(tables, normalise(energies, level.hops).reshape(len(energies) // HOPS, HOPS * BANDS))[:known]
    pose = poses(tables, head)
    before = np.concatenate([pose[:1], pose])[:count]
    smooth = (before + 2 * pose[:count] + pose[1:known] + 2) >> 2
    sounds = (level.voiced & ~silent)[: HOPS * count].reshape(count, HOPS)
    classes = len(tables.classes)
    told = Heard(head[:count, :classes], head[:count, classes], (smooth + 8) >> 4)
    return _Told(told, smooth, ~sounds.any(axis=1), head[:, :classes].argmax(axis=1), level.last)


# ---- Beginning, silence and end -------------------------------------------------------------------------------------


def delivered(tables: HearingTables, sound: np.ndarray, rate: int = 16000, exact: bool = False,
              begin: int = BEGIN) -> Heard:
    """The same as a stream delivers it: it fades in from rest, rests before the first voice, in silence and, unless it
    is to be `exact`, at the end, for which frames are added to the FAPs."""
    told = _of_sound(tables, sound, rate, begin)
    return told.heard._replace(faps=(_delivered(tables, told, exact) + 8) >> 4)


def _delivered(tables: HearingTables, told: _Told, exact: bool) -> np.ndarray:
    """(T, 13) the poses of :func:`delivered`, Q4."""
    pose = _resting(told.pose, told.still, tables.ahead + SMOOTHING)
    eases = _eases(FADE, FADE + 1)[: len(pose)]
    pose[: len(eases)] = (pose[: len(eases)] * eases[:, None] + 8192) >> 14
    if len(pose) and not exact and ((pose[-1] + 8) >> 4).any():
        pose = np.concatenate([pose, pose[-1] + ((-pose[-1] * _eases(EASE, EASE)[:, None] + 8192) >> 14)])
    return pose


def visemes(tables: HearingTables, sound: np.ndarray, rate: int = 16000, exact: bool = False,
            begin: int = BEGIN) -> np.ndarray:
    """(T, 15) int64: the shares of sounds in the frames that :func:`delivered` has (``labial_hear_visemes``), of a
    model whose classes are phonemes."""
    told = _of_sound(tables, sound, rate, begin)
    count, frames = len(told.pose), len(_delivered(tables, told, exact))
    place = {name: k for k, name in enumerate(VISEMES)}
    leaders = np.array([place[VISEME_OF[name]] if name in VISEME_OF else -1 for name in tables.classes])[told.leaders]
    parts = np.zeros((count, len(VISEMES)), dtype=np.int64)
    for part, there in ((1, np.concatenate([leaders[:1], leaders])[:count]), (2, leaders[:count]), (1, leaders[1:])):
        known = there >= 0
        parts[np.flatnonzero(known), there[known]] += part
    shown = _rests(told.still, tables.ahead + SMOOTHING) * ONE >> 14
    eased = shown[-1:] * np.maximum(np.arange(EASE - 2, -2, -1), 0) // EASE
    parts = np.concatenate([parts, parts[-1:].repeat(EASE, axis=0)])[:frames]
    whole = np.where(parts.any(axis=1), np.concatenate([shown, eased])[:frames], 0)
    total = np.maximum(parts.sum(axis=1), 1)[:, None]
    result: np.ndarray = (parts * whole[:, None] + total // 2) // total
    result[:, 0] += ONE - whole
    return result


def level_after(tables: HearingTables, sound: np.ndarray, begin: int = BEGIN) -> int:
    """The level, in 1 / `LEVEL_ONE`, when a stream has delivered a sound: that with which the next one begins."""
    return _of_sound(tables, sound, 16000, begin).level


def _resting(pose: np.ndarray, silent: np.ndarray, ahead: int) -> np.ndarray:
    """Poses (T, 13), Q4, that come to rest where a frame, SILENT_BEFORE before it and `ahead` after it are `silent`
    (T,), as all are before the first and after the last."""
    return (pose * _rests(silent, ahead).reshape(-1, 1) + 8192) >> 14


def _rests(silent: np.ndarray, ahead: int) -> np.ndarray:
    """(T,) int64, Q14: how much of each pose is left there."""
    padded = np.pad(silent, (SILENT_BEFORE, ahead), constant_values=True)
    span = SILENT_BEFORE + 1 + min(ahead, RESTING)
    eases, rest, shares = [0, *_eases(RESTING, RESTING)], RESTING, []
    for t in range(len(silent)):
        rest = min(rest + 1, RESTING) if padded[t : t + span].all() else max(rest - 1, 0)
        shares.append(eases[RESTING - rest])
    return np.array(shares, dtype=np.int64)


def _eases(count: int, length: int) -> np.ndarray:
    """(count,) the first steps of a transition of `length` steps, 3 s^2 - 2 s^3, Q14 (``labial_ease``)."""
    share = (np.arange(1, count + 1) << 14) // length
    return ((share * share >> 14) * ((3 << 14) - 2 * share)) >> 14
