"""``labial landmarks``: MediaPipe's face landmarks of a video.

MediaPipe up to 0.10.21 contains its Face Mesh in its wheel (Python 3.9 to 3.12). With the model file of its Face
Landmarker, which is a separate download, any release tracks with that, and also scores how the lips are puckered.
"""

from __future__ import annotations

import os
from contextlib import closing
from typing import Any, Dict, Iterable, List, Optional, Tuple

import mediapipe
import numpy as np
from tqdm import tqdm

from labial.capture.faces import talker
from labial.errors import DataError, LabialError, PathLike
from labial.files.frames import spans_told
from labial.files.outputs import writing
from labial.sound.video import length, pictures

#: Landmarks (478, 3) in pixels and mouthPucker score, NaN where unknown, of each face of a picture.
Faces = List[Tuple[np.ndarray, float]]
#: Faces that are looked for in a picture.
MOST_FACES = 4


def landmarks(video: PathLike, output: PathLike, face: Optional[str] = None, task: Optional[PathLike] = None,
              progress: bool = False) -> str:
    """Writes the landmarks of a video's talker as the .npz that ``labial record`` takes; returns a summary. `face` says
    which face, one of `labial.defaults.WHICH_FACE`, where there is more than one; `task` is the model file of
    MediaPipe's Face Landmarker, without which its Face Mesh is used. Raises DataError and LabialError."""
    tracker = FaceLandmarker(task) if task is not None else FaceMesh()
    times: List[float] = []
    seen: List[Faces] = []
    with closing(tracker), tqdm(pictures(video), total=round(length(video)) or None, unit=" frames",
                                disable=not progress) as frames:
        for time, picture in frames:
            if times and time <= times[-1]:
                raise DataError(video, None, f"frame {len(times)}: time {time:g} does not follow {times[-1]:g}")
            times.append(time)
            seen.append(tracker.find(time, picture))
    if len(times) < 2:
        raise DataError(video, None, "fewer than two frames")
    moments = np.array(times)
    points = talker(video, moments, [[points for points, _ in faces] for faces in seen], face)
    arrays: Dict[str, Any] = {"landmarks": points, "times": moments}
    if task is not None:
        arrays["pucker"] = _scores(points, seen)
    output = os.fspath(output)
    output += "" if output.endswith(".npz") else ".npz"
    with writing(output) as file:
        np.savez(file, **arrays)
    lost = ~np.isfinite(points[:, 0, 0])
    return (f"{output}: {len(times)} frames, {1.0 / float(np.median(np.diff(moments))):.4g} a second"
            + (f"; {int(lost.sum())} without the face, from {spans_told(moments, lost, 6)}" if lost.any() else ""))


class FaceMesh:
    """The tracker that MediaPipe up to 0.10.21 brings with it."""

    def __init__(self) -> None:
        """Raises LabialError where this MediaPipe has none."""
        if not hasattr(mediapipe, "solutions"):
            raise LabialError("this MediaPipe brings no face model: give --task face_landmarker.task, or type "
                              "pip install mediapipe==0.10.21 (Python 3.9 to 3.12)")
        self._mesh = mediapipe.solutions.face_mesh.FaceMesh(max_num_faces=MOST_FACES, refine_landmarks=True)

    def find(self, _: float, picture: np.ndarray) -> Faces:
        """The faces of the next picture (height, width, 3), uint8 RGB."""
        found = self._mesh.process(picture).multi_face_landmarks or []
        return [(_points(face.landmark, picture), np.nan) for face in found]

    def close(self) -> None:
        """Ends the tracker."""
        self._mesh.close()


class FaceLandmarker:
    """The tracker whose model is a file of its own, and which also scores blendshapes."""

    def __init__(self, task: PathLike) -> None:
        """Raises DataError for what is no model."""
        from mediapipe.tasks.python import BaseOptions, vision

        if not os.path.isfile(task):
            raise DataError(task, None, "no such file")
        options = vision.FaceLandmarkerOptions(
            base_options=BaseOptions(model_asset_path=os.fspath(task)), running_mode=vision.RunningMode.VIDEO,
            num_faces=MOST_FACES, output_face_blendshapes=True)
        try:
            self._landmarker = vision.FaceLandmarker.create_from_options(options)
        except (RuntimeError, ValueError) as error:
            raise DataError(task, None, f"not a model of MediaPipe's Face Landmarker: {str(error).split(chr(10))[0]}"
                            ) from None

    def find(self, time: float, picture: np.ndarray) -> Faces:
        """The faces of the picture (height, width, 3), uint8 RGB, at `time`, seconds."""
        image = mediapipe.Image(image_format=mediapipe.ImageFormat.SRGB, data=picture)
        found = self._landmarker.detect_for_video(image, round(1000 * time))
        pucker = [next((score.score for score in scores if score.category_name == "mouthPucker"), np.nan)
                  for scores in found.face_blendshapes]
        return [(_points(face, picture), score) for face, score in zip(found.face_landmarks, pucker)]

    def close(self) -> None:
        """Ends the tracker."""
        self._landmarker.close()


def _points(face: Iterable[Any], picture: np.ndarray) -> np.ndarray:
    height, width = picture.shape[:2]
    return np.array([(p.x, p.y, p.z) for p in face], np.float32) * np.array([width, height, width], np.float32)


def _scores(points: np.ndarray, seen: List[Faces]) -> np.ndarray:
    """(T,) scores of the faces that have landmarks."""
    scores = np.full(len(points), np.nan)
    for number, faces in enumerate(seen):
        for own, score in faces:
            if np.array_equal(own, points[number]):
                scores[number] = score
    return scores
