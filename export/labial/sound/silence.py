"""Silent stretches of a sound contain no phoneme, except for stops: they begin in their silence."""

from __future__ import annotations

from typing import List, Sequence, Tuple

from labial.corpus.episode import Segment

#: Longest closure of a stop before it is heard, seconds; a longer silence is a pause. The same as for espeak-ng's stops
#: (tools/speak/closure.c).
LONGEST_CLOSURE = 0.1
#: A recogniser's pause in sound that is not silent counts if it is longer, in seconds.
LONGEST_PAUSE_UNHEARD = 0.15
#: Shorter gaps between phonemes are closed, in seconds.
_SHORTEST_PAUSE = 0.05

_STOPS = ("P", "B", "T", "D", "K", "G", "CH", "JH")


def with_silences(
    segments: Sequence[Segment], silences: Sequence[Tuple[float, float]], length: float, silence: str = "SIL"
) -> List[Segment]:
    """`segments` of ARPABET phonemes brought to the sound's own silences (begin and end, seconds): they end where a
    silence begins and begin where it ends, a stop `LONGEST_CLOSURE` before. `length` is the sound's, in seconds.

    Silence in the segments remains only where the sound is silent. The result has no gaps.
    """
    sounding = [segment for segment in segments if segment.label != silence]
    times = [[segment.start, segment.end] for segment in sounding]
    for begin, end in silences:
        middle = (begin + end) / 2
        after = next((i for i, (a, b) in enumerate(times) if (a + b) / 2 >= middle), len(times))
        if after < len(times):
            stop = sounding[after].label in _STOPS
            onset = max(begin, end - LONGEST_CLOSURE) if stop else end
            heard = times[after][0] < end + _SHORTEST_PAUSE  # the silence is right before it
            if times[after][0] < onset or (stop and heard):
                times[after][0] = onset
        for time in times[:after]:
            time[0], time[1] = min(time[0], begin), min(time[1], begin)
        for time in times[after:]:
            time[0], time[1] = max(time[0], times[after][0]), max(time[1], times[after][0])
    return _closed(sounding, times, silences, length, silence)


def _closed(
    sounding: Sequence[Segment], times: Sequence[Sequence[float]], silences: Sequence[Tuple[float, float]],
    length: float, silence: str,
) -> List[Segment]:
    """The segments at `times`, without gaps: a gap is silence where the sound is silent for long enough; else the stop
    behind it begins there, or the phoneme before it goes on."""
    result: List[Segment] = []
    moment = 0.0
    for segment, (start, end) in zip(sounding, times):
        if end <= start:
            continue
        if start > moment:
            silent = any(a < start and b > moment for a, b in silences)
            if not result or (silent and start - moment >= _SHORTEST_PAUSE):
                result.append(Segment(moment, start, silence))
            elif segment.label in _STOPS:
                start = moment
            else:
                result[-1] = Segment(result[-1].start, start, result[-1].label, word=result[-1].word)
        start = max(start, moment)
        if end > start:
            result.append(Segment(start, end, segment.label, word=segment.word))
            moment = end
    if length > moment:
        result.append(Segment(moment, length, silence))
    return result
