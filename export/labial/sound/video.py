"""Pictures and sound of a video on one clock, the file's own, by PyAV."""

from __future__ import annotations

import os
from typing import Iterator, List, Tuple

import av
import numpy as np

from labial.errors import DataError, PathLike, SilentError
from labial.files import limits


def pictures(path: PathLike) -> Iterator[Tuple[float, np.ndarray]]:
    """Time in seconds and picture (height, width, 3), uint8 RGB, of every frame of a video's first picture stream.
    Times are the file's times of its frames, from its start on, like those of `sound`. Pictures of a camera that was
    held upright are rotated. Raises DataError for a file that is not a video."""
    try:
        with av.open(os.fspath(path)) as container:
            if not container.streams.video:
                raise DataError(path, None, "no picture, only sound")
            stream = container.streams.video[0]
            stream.thread_type = "AUTO"
            start = container.start_time / av.time_base if container.start_time else 0.0
            for frame in container.decode(stream):
                if frame.time is not None:
                    quarters = round(getattr(frame, "rotation", 0) / 90)  # of 90 degrees, counter-clockwise
                    yield frame.time - start, np.ascontiguousarray(np.rot90(frame.to_ndarray(format="rgb24"), quarters))
    except av.FFmpegError as error:
        raise DataError(path, None, f"not a video that can be read: {error.strerror or error}") from None


def sound(path: PathLike, rate: int) -> np.ndarray:
    """(N,) float32 samples at `rate` of the first sound stream, the mean of its channels, from the file's start on;
    full scale is 1. Raises SilentError for a file without sound, DataError for what cannot be read."""
    blocks: List[np.ndarray] = []
    first = 0.0
    try:
        with av.open(os.fspath(path)) as container:
            if not container.streams.audio:
                raise SilentError(path, None, "no sound in it")
            start = container.start_time / av.time_base if container.start_time else 0.0
            resampler, limit = av.AudioResampler(format="fltp", rate=rate), limits.Samples(path, rate)
            for frame in container.decode(container.streams.audio[0]):
                if not blocks and frame.time is not None:
                    first = frame.time - start
                for part in resampler.resample(frame):
                    blocks.append(part.to_ndarray().mean(axis=0))
                    limit.add(len(blocks[-1]))
            blocks += [part.to_ndarray().mean(axis=0) for part in resampler.resample(None)]
    except av.FFmpegError as error:
        raise DataError(path, None, f"not a sound that can be read: {error.strerror or error}") from None
    limit.add(max(round(first * rate), 0))
    samples = np.concatenate([np.zeros(max(round(first * rate), 0), np.float32), *blocks]).astype(np.float32)
    return samples[max(-round(first * rate), 0) :]


def length(path: PathLike) -> float:
    """The number of frames of a video according to its header; 0 if unknown."""
    try:
        with av.open(os.fspath(path)) as container:
            stream = container.streams.video[0]
            if stream.frames:
                return float(stream.frames)
            seconds = (container.duration or 0) / av.time_base
            return float(seconds) * float(stream.average_rate or 0)
    except (av.FFmpegError, IndexError):
        return 0
