"""How much later the picture of a recording is than its sound, from what lips do in its phonemes.

Lips close in p, b, m and are apart in open vowels. The opening that the phonemes require (-1 in p, b, m, +1 in open
vowels, 0 elsewhere) is compared with the lips' opening, both smoothed, at every lag l within `FURTHEST`, by the
correlation sum

    c(l) = sum_t expected(t) opening(t + l)

whose largest value is at the estimated lag. Its confidence comes from resampling: pieces of the recordings are drawn
with replacement, and the confidence is the share of the draws whose lag is within `AGREEMENT` of the first.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import List, Sequence

import numpy as np
from scipy.ndimage import gaussian_filter1d

from labial.corpus.episode import Episode
from labial.files.faps import FAP_NUMBERS

#: Seconds by which sound and picture may be apart to be found, and by which resamplings must agree.
FURTHEST, AGREEMENT = 0.6, 0.02
#: Confidence from which the estimate is to be believed.
SURE = 0.9
#: Fewer closures than this tell nothing.
LEAST_CLOSURES = 5

_CLOSED = ("P", "B", "M")
_OPEN = ("AA", "AE", "AH", "AO", "AW", "AY", "EH", "EY", "OW", "OY")
_STEP = 0.005  # seconds between lags
_BLUR = 0.02  # seconds, of what phonemes ask for
_DRIFT = 0.5  # seconds: what the opening does more slowly is the talker's, not the phonemes'
_PIECE = 1.0  # seconds of a piece that is drawn or not
_DRAWS = 200
_UPPER, _LOWER = FAP_NUMBERS.index(51), FAP_NUMBERS.index(52)


@dataclass(frozen=True)
class Lag:
    """By how much the picture is later than the sound."""

    seconds: float  #: negative: earlier
    confidence: float  #: 0 .. 1
    closures: int  #: p, b and m that it was told by


def estimate(episodes: Sequence[Episode]) -> Lag:
    """The lag of recordings that were made in one way; confidence 0 where they hold too few closures."""
    pieces = np.concatenate([_pieces(episode) for episode in episodes])
    closures = sum(segment.label in _CLOSED for episode in episodes for segment in episode.segments)
    found = _peak(pieces.sum(axis=0))
    if closures < LEAST_CLOSURES:
        return Lag(found, 0.0, closures)
    rng = np.random.default_rng(0)
    draws = rng.integers(0, len(pieces), (_DRAWS, len(pieces)))
    lags = np.array([_peak(pieces[draw].sum(axis=0)) for draw in draws])
    confidence = float((abs(lags - found) <= AGREEMENT).mean()) if len(pieces) > 1 else 0.0
    return Lag(found, confidence, closures)


def _pieces(episode: Episode) -> np.ndarray:
    """(P, lags) correlation sums of each piece of a recording."""
    count = round(FURTHEST / _STEP)
    times = np.arange(episode.times[0], episode.times[-1], _STEP)
    opening = np.interp(times, episode.times, -episode.frames[:, _UPPER] - episode.frames[:, _LOWER])
    opening -= gaussian_filter1d(opening, _DRIFT / _STEP)
    opening /= opening.std() or 1.0
    asked = np.zeros(len(times))
    for segment in episode.segments:
        during = (times >= segment.start) & (times < segment.end)
        asked[during] = -1.0 if segment.label in _CLOSED else 1.0 if segment.label in _OPEN else 0.0
    asked = gaussian_filter1d(asked, _BLUR / _STEP)
    asked -= asked.mean()
    later = np.lib.stride_tricks.sliding_window_view(np.pad(opening, count), 2 * count + 1)  # (T, lags)
    products = asked[:, None] * later
    starts = np.arange(0, len(times), round(_PIECE / _STEP))
    return np.asarray(np.add.reduceat(products, starts, axis=0))


def _peak(sums: np.ndarray) -> float:
    """The lag of the largest sum, between the steps by a parabola."""
    at = int(np.argmax(sums))
    place = float(at)
    if 0 < at < len(sums) - 1:
        before, top, after = sums[at - 1 : at + 2]
        bend = before - 2 * top + after
        place += float((before - after) / (2 * bend)) if bend else 0.0
    return (place - (len(sums) - 1) / 2) * _STEP


def advice(lag: Lag, offset: float) -> List[str]:
    """What is to be said of a lag that was found after the picture was taken as `offset` seconds late: lines."""
    if lag.closures < LEAST_CLOSURES:
        return [f"sound and picture: {lag.closures} p, b, m are too few to tell whether they are together"]
    when = "together" if abs(lag.seconds) < _STEP / 2 else (
        f"the picture is {abs(1000 * lag.seconds):.0f} ms {'late' if lag.seconds > 0 else 'early'}")
    text = f"sound and picture: {when}, by {lag.closures} p, b, m and the open vowels; confidence {lag.confidence:.0%}"
    if lag.confidence < SURE:
        return [text + ": not to be relied on"]
    if abs(lag.seconds) <= AGREEMENT:
        return [text]
    return [text, f"--offset {1000 * (offset + lag.seconds):.0f} brings them together"]
