"""``labial landmarks``: the face in a video."""

from __future__ import annotations

import argparse

from labial.commands.common import add_quiet, shows_progress
from labial.defaults import WHICH_FACE
from labial.errors import needs


def add_arguments(command: argparse.ArgumentParser) -> None:
    """A video, and the face to track."""
    command.add_argument("video", metavar="VIDEO")
    command.add_argument("-o", "--output", required=True, metavar="LANDMARKS.npz")
    command.add_argument("--face", choices=WHICH_FACE, help="which is the talker's, where there is "
                         "more than one, as seen in the picture")
    command.add_argument("--task", metavar="FILE", help="the model of MediaPipe's Face Landmarker, "
                         "face_landmarker.task, for a MediaPipe that brings none")
    add_quiet(command)


def run(options: argparse.Namespace) -> int:
    """Writes the landmarks."""
    from labial.files.outputs import check

    check(options.output)
    with needs("tracking", "record"):
        from labial.capture.track import landmarks

    print(landmarks(options.video, options.output, options.face, options.task, progress=shows_progress(options)))
    return 0
