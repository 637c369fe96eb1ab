"""``labial record``: landmark files and phoneme timings to a corpus folder; how late the picture is, from the lips."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Dict, List, Sequence, Tuple

import numpy as np
from scipy.ndimage import gaussian_filter1d

from labial.capture.faces import facing
from labial.capture.landmarks import Given, Landmarks, read_landmarks
from labial.capture.mouth import Recording, faps, fill
from labial.corpus.apex import told, with_apexes
from labial.corpus.episode import Episode, Segment
from labial.corpus.folder import check_span
from labial.corpus.formats import SOUNDS, VIDEOS, read_timings, suffixes
from labial.corpus.phonesets import PhoneSet
from labial.corpus.timings import phoneme_segments
from labial.errors import DataError, LabialError, PathLike, SilentError, needs
from labial.files.faps import FAP_NUMBERS
from labial.files.frames import even, write_csv
from labial.files.outputs import check_folder
from labial.files.outputs import folder as whole_folder

_LANDMARKS = (".npz", ".npy", ".csv")
#: Slower recordings lose closures: half of GRID's /b/ last 70 ms or less, and the lips touch for a part of that.
_SLOW = 24.0
_MOST_OFFSET = 5.0  # seconds


def record(sources: Sequence[PathLike], output: PathLike, phone_set: PhoneSet, given: Given, cutoff: float,
           offset: float = 0.0) -> str:
    """Writes the corpus folder `output` from one talker's landmark files or folders of them; returns a summary. The
    picture is assumed to be `offset` seconds later than its sound; the summary of speech reports the remaining offset.
    Recordings in which the face is lost or turned away for too long are omitted with a warning. Raises DataError for
    malformed files, before anything is written."""
    if not -_MOST_OFFSET <= offset <= _MOST_OFFSET:
        raise LabialError(f"an offset of {1000 * offset:g} ms is not within {-1000 * _MOST_OFFSET:g} .. "
                          f"{1000 * _MOST_OFFSET:g}")
    if not 0.0 <= cutoff <= 1000.0:
        raise LabialError(f"a cutoff of {cutoff:g} Hz is not within 0 .. 1000")
    folder = Path(output)
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise DataError(folder, None, "not a folder that is new or empty")
    check_folder(folder)
    recordings = [_read(path, phone_set, given, offset) for path in _files(sources)]
    kinds = {item.landmarks.points.shape[2] for item in recordings}
    if len(kinds) > 1:
        flat = next(item for item in recordings if item.landmarks.points.shape[2] == 2)
        raise DataError(flat.landmarks.path, None, "no depth (z), which other recordings have")
    finished: List[Tuple[Recording, np.ndarray, float]] = []
    for item, values in zip(recordings, faps(recordings, phone_set.silence)):
        try:
            fps, frames = even(item.landmarks.times, fill(item.landmarks.times, values))
        except ValueError as error:
            warnings.warn(f"{item.landmarks.path}: left out: {error}", stacklevel=1)
            continue
        finished.append((item, _smooth(frames, fps, cutoff), fps))
    if not finished:
        raise LabialError("no recording can be used")
    with whole_folder(folder) as made:
        for item, frames, fps in finished:
            name = item.landmarks.path.stem
            with open(made / f"{name}.csv", "w", encoding="ascii", newline="\n") as out:
                write_csv(out, frames, fps, start=float(item.landmarks.times[0]))
            with open(made / f"{name}.lab", "w", encoding="utf-8", newline="\n") as out:
                out.writelines(map(_line, item.segments))
    seconds = sum(len(frames) / fps for _, frames, fps in finished)
    left_out = len(recordings) - len(finished)
    lines = [f"{folder}: {len(finished)} recordings, {int(seconds // 60)} min {seconds % 60:.0f} s"
             + (f"; {left_out} left out" if left_out else "")]
    phonemes = [segment for item, _, _ in finished for segment in item.segments]
    lines.append(f"apex: the loudest moment of {told(phonemes)} of {len(phonemes)} phonemes"
                 + ("" if told(phonemes) == len(phonemes) else "; of the others, whose sound is not known, the middle"))
    if phone_set.kind == "speech":
        lines += advice(estimate([
            Episode(item.landmarks.path.stem, item.landmarks.times[0] + np.arange(len(frames)) / fps, frames,
                    item.segments) for item, frames, fps in finished]), offset)
    return "\n".join(lines)


def _files(sources: Sequence[PathLike]) -> List[Path]:
    """The landmark files, sorted by name; names are what episodes are called, so each may occur once."""
    files: List[Path] = []
    for source in map(Path, sources):
        found = [source] if not source.is_dir() else [
            file for file in sorted(source.iterdir())
            if file.suffix.lower() in _LANDMARKS and file.is_file() and not file.name.startswith(".")]
        if not found:
            raise DataError(source, None, "no landmarks (.npz, .npy or .csv)")
        files += found
    seen: Dict[str, Path] = {}
    for file in files:
        if file.stem in seen:
            raise DataError(file, None, f"there is also {seen[file.stem]}, and episodes are called by these names")
        seen[file.stem] = file
    return sorted(files, key=lambda file: file.stem)


def _read(path: Path, phone_set: PhoneSet, given: Given, offset: float) -> Recording:
    landmarks = _earlier(read_landmarks(path, given), offset)
    landmarks, turned = facing(landmarks)
    if turned:
        warnings.warn(f"{path}: {turned}", stacklevel=1)
    timings = _timings(path)
    segments = _with_sound(path, phoneme_segments(timings, read_timings(timings), phone_set))
    if not segments:
        raise DataError(timings, None, "no phonemes")
    check_span(timings, Episode(path.stem, landmarks.times, np.empty((len(landmarks.times), 0)), segments))
    rate = 1.0 / float(np.median(np.diff(landmarks.times)))
    if rate < _SLOW:
        warnings.warn(f"{path}: {rate:.3g} frames per second are too few to see lips close", stacklevel=1)
    return Recording(landmarks, segments)


def _earlier(landmarks: Landmarks, offset: float) -> Landmarks:
    """The landmarks `offset` seconds earlier, without those before the sound begins."""
    if not offset:
        return landmarks
    times = landmarks.times - offset
    kept = times >= 0 if landmarks.times[0] >= 0 else np.ones(len(times), bool)
    if kept.sum() < 2:
        raise DataError(landmarks.path, None, f"shorter than the offset of {1000 * offset:g} ms")
    pucker = landmarks.pucker
    return replace(landmarks, times=times[kept], points=landmarks.points[kept],
                   pucker=None if pucker is None else pucker[kept])


def _timings(path: Path) -> Path:
    """The timings beside a landmark file."""
    found = [file for file in sorted(path.parent.iterdir())
             if file.stem == path.stem and file.suffix.lower() in suffixes() and file.is_file()]
    if not found:
        others = ", ".join(suffixes())
        raise DataError(path, None, f"no phoneme timings beside it: {path.stem}.lab or another of {others}")
    if len(found) > 1:
        raise DataError(found[1], None, f"there is also {found[0].name}; which of them to use is not clear")
    return found[0]


def _with_sound(path: Path, segments: Sequence[Segment]) -> Tuple[Segment, ...]:
    """The segments of a landmark file with their apexes in its sound: a sound file beside it, else the video. Unchanged
    without sound, or without the packages that read it."""
    beside = [file for file in sorted(path.parent.iterdir()) if file.stem == path.stem and file.is_file()]
    found = [file for suffixes in (SOUNDS, VIDEOS) for file in beside if file.suffix.lower() in suffixes]
    if not found or told(segments) == len(segments):
        return tuple(segments)
    try:
        with needs(f"the sound of {found[0]}", "record"):
            from labial.sound.samples import RATE, read_sound
        return with_apexes(segments, read_sound(found[0]), RATE)
    except SilentError:
        return tuple(segments)
    except DataError:
        raise
    except LabialError as error:
        warnings.warn(f"{error}; the middle of each phoneme counts as its apex", stacklevel=1)
        return tuple(segments)


def _smooth(frames: np.ndarray, fps: float, cutoff: float) -> np.ndarray:
    """Gaussian smoothing, without delay, that halves the power at `cutoff` Hz; 0 smooths nothing."""
    if cutoff == 0.0 or len(frames) < 2:
        return frames
    sigma = np.sqrt(np.log(2.0)) / (2.0 * np.pi * cutoff)  # seconds
    return gaussian_filter1d(frames, sigma * fps, axis=0, mode="nearest")


def _line(segment: Segment) -> str:
    text = f"{segment.start:.4f} {segment.end:.4f} {segment.label}"
    if segment.apex is not None or segment.word is not None:
        apex = (segment.start + segment.end) / 2 if segment.apex is None else segment.apex
        text += f" {apex:.4f}" + (f" {segment.word}" if segment.word is not None else "")
    return text + "\n"


# ---- How much later the picture of a recording is than its sound, from what lips do in its phonemes ------------------

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
    closures: int  #: p, b and m that it was measured on


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
    return np.asarray(np.add.reduceat(products, np.arange(0, len(times), round(_PIECE / _STEP)), axis=0))


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
    """The lines that report a lag that was found after a correction of `offset` seconds."""
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
