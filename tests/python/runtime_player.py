"""Plays conformance streams through the Python run-time, with nothing but it: also where numpy is not installed.

    python runtime_player.py < SCRIPTS.json

takes ``[{"name": ..., "parts": [{"pushes": [[model, phoneme, ms], ...], "cancel": [frames, ms] or null, "again":
[[frames, ms], ...], "articulation": [[frames, percent], ...]}, ...]}, ...]`` and prints ``{feed: {name: [frames,
crc]}}``.
"""

from __future__ import annotations

import json
import sys
import zlib
from array import array
from typing import Any, Dict, List, Tuple

import labial

Rows = List[Tuple[int, ...]]
MODELS = {"speech": "speech_en", "laughter": "laughter_synthetic"}


class Player:
    """One stream; `take` is what happens after each push."""

    def __init__(self, feed: str) -> None:
        self.stream = labial.Stream()
        self.rows: Rows = []
        self._feed = feed
        self._changes: List[Tuple[int, int]] = []  # of the articulation, after so many rows

    def keep(self, frame: labial.Frame) -> None:
        """A frame, whose number must be its place."""
        assert frame.number == len(self.rows), f"frame {frame.number} in place {len(self.rows)}"
        self.rows.append(frame.faps)
        self.articulate()

    def articulate(self) -> None:
        """Sets the articulation, if it is to change after as many frames as there are."""
        if self._changes and self._changes[0][0] == len(self.rows):
            self.stream.articulation(self._changes.pop(0)[1])

    def part(self, part: Dict[str, Any]) -> None:
        """Pushes and takes until the part's end."""
        limit = len(self.rows) + part["cancel"][0] if part["cancel"] else None
        self._changes = [(len(self.rows) + frames, min(percent, 200)) for frames, percent in part["articulation"]]
        self.articulate()
        for model, phoneme, milliseconds in part["pushes"]:
            if limit is not None and len(self.rows) == limit > 0 and self._feed != "fill":
                break
            self.stream.use(getattr(labial, MODELS[model]))
            self.stream.push(phoneme, milliseconds)
            if self._feed == "single":
                frame = self.stream.tick()
                if frame:
                    self.keep(frame)
            elif self._feed == "hungry":
                self.take(limit)
        if limit is None:
            self.stream.end()
            if self._feed == "whole" and not self._changes:
                self.whole()
            else:
                self.take(None)
        else:
            self.take(limit)
            assert len(self.rows) == limit
            self.ease(part["cancel"][1], part["again"])
        assert self.stream.done and self.stream.tick() is None

    def take(self, limit: Any) -> None:
        """Frames until there are `limit` of them, or none comes."""
        while limit is None or len(self.rows) < limit:
            frame = next(self.stream, None)
            if frame is None:
                return
            self.keep(frame)

    def whole(self) -> None:
        """All frames in one call."""
        frames = self.stream.drain()
        self.rows += [tuple(frames[k : k + 13]) for k in range(0, len(frames), 13)]

    def ease(self, milliseconds: int, again: List[List[int]]) -> None:
        """Cancels, as often as is asked for, and takes what follows."""
        self.stream.cancel(milliseconds)
        for frames, later in again:
            self.take(len(self.rows) + frames)
            self.stream.cancel(later)
        self.take(None)


def play(script: Dict[str, Any], feed: str) -> Rows:
    """The frames of one stream in one of `FEEDS`."""
    player = Player(feed)
    with player.stream:
        for number, part in enumerate(script["parts"]):
            if number:
                player.stream.restart()
            player.part(part)
    return player.rows


#: Ways of feeding: everything before the first frame; a phoneme, then a tick; a phoneme, then all it brings; as the
#: first, in one call of C.
FEEDS = ("fill", "single", "hungry", "whole")


def digest(rows: Rows) -> int:
    """CRC-32 of the frames as little-endian int16."""
    values = array("h", [value for row in rows for value in row])
    if sys.byteorder == "big":
        values.byteswap()
    return zlib.crc32(values.tobytes())


def main() -> None:
    """Plays standard input's scripts in every way."""
    scripts = json.load(sys.stdin)
    found = {feed: {script["name"]: [len(rows), digest(rows)] for script in scripts for rows in [play(script, feed)]}
             for feed in FEEDS}
    assert "numpy" not in sys.modules
    print(json.dumps(found))


if __name__ == "__main__":
    main()
