"""Faces at run-time: labial.Rig, whose servos keep their limits and close in p, b, m; labial.Face, whose servos come to
rest whatever becomes of their source, as the C library moves them."""

from __future__ import annotations

import io
import itertools
import json
import math
import zlib
from pathlib import Path
from typing import Dict, List, NamedTuple, Optional

import numpy as np
import pytest

import labial
from labial.__main__ import main
from labial.commands.common import Limited
from labial.errors import LabialError
from labial.fit.solve import read_sentences
from labial.rig.animation import FORMATS
from labial.rig.description import read
from labial.runtime.rig import Rig
from labial.runtime.stream import Frame
from packages import SOURCE, needs_runtime
from test_rig import CLOSING, played

JAW = '[output.jaw]\nfrom = "opening"\nclosed = 1400\nfull = 1900\nslew = 60\nacceleration = 20\n'
HOLD, EASE = 5, 6
REST = [0] * 13


@pytest.fixture
def face(tmp_path: Path) -> labial.Face:
    return face_of(tmp_path, JAW)


def face_of(folder: Path, description: str, ahead: int = 0) -> labial.Face:
    (folder / "face.toml").write_text(description)
    return labial.Face(str(folder / "face.toml"), ahead=ahead)


@needs_runtime
def test_it_rests_after_its_source(face: labial.Face) -> None:
    """No pulse changes by more than its limits, whatever the frames do, and the last one is that of rest."""
    assert face.rests and face.tick() == {"jaw": 1400}
    wide = [0, 0, 0, 0, -600, *[0] * 8]
    pulses = [1400, 1400]
    for frame in [wide] * 20 + [REST] + [wide] * 7:
        face.frame(frame)
        assert not face.rests
        pulses.append(int(face.tick()["jaw"]))
    late = 0
    while not face.rests:
        pulses.append(int(face.tick()["jaw"]))
        late += 1
    assert pulses[-1] == 1400 and max(pulses) == 1900 and HOLD + EASE < late < 40
    steps = [after - before for before, after in zip(pulses, pulses[1:])]
    assert max(map(abs, steps)) <= 60
    assert max(abs(after - before) for before, after in zip(steps, steps[1:])) <= 20


@needs_runtime
def test_values_skip_and_cancel(tmp_path: Path) -> None:
    """Values have the same limits; what is late is passed over, what waits is dropped."""
    face = face_of(tmp_path, JAW.replace("acceleration = 20\n", ""))
    pulses: List[float] = []
    for wanted in (1900, 1e300, -math.inf):
        face.values({"jaw": wanted})
        pulses.append(face.tick()["jaw"])
    assert pulses == [1460, 1520, 1460]
    weights = labial.Face("arkit")
    weights.values({name: 0.25 for name in weights.rig.outputs})
    assert set(weights.tick().values()) == {0.25}
    face, pulses = face_of(tmp_path, JAW.replace("slew = 60\nacceleration = 20\n", ""), ahead=5), []
    for wanted in range(1500, 1506):
        face.values({"jaw": wanted})
    for skip in (lambda: face.skip(0), face.skip, lambda: face.skip(2), lambda: face.skip(10**9)):
        skip()
        pulses.append(face.tick()["jaw"])
    assert pulses == [1500, 1502, 1505, 1505]
    face = face_of(tmp_path, JAW, ahead=3)
    for number in range(4):
        assert face.tick() == {"jaw": 1400}, "frames wait until enough are there"
        face.frame(Frame(number, (0, 0, 0, 0, -600, *[0] * 8)))
    assert face.tick()["jaw"] > 1400
    face.cancel()
    pulses = [face.tick()["jaw"] for _ in range(30)]
    assert max(pulses) <= 1460 and pulses[-1] == 1400 and face.rests


@needs_runtime
def test_soft_start_and_place(tmp_path: Path) -> None:
    face = face_of(tmp_path, JAW + JAW.replace("jaw", "chin"))
    assert face.attached == ("jaw", "chin")
    face.soft_start(2)
    attached = []
    for _ in range(4):
        attached.append(face.attached)
        face.tick()
    assert attached == [("jaw",), ("jaw",), ("jaw", "chin"), ("jaw", "chin")]
    face.place({"jaw": 1500, "chin": 1400})
    assert not face.rests
    assert face.tick() == {"jaw": 1480, "chin": 1400}


@needs_runtime
def test_what_is_wrong_is_said(face: labial.Face) -> None:
    """Nothing of it changes the face."""
    for frame, wrong in (([0] * 12, "13 FAPs, not 12"), ([70000] + [0] * 12, "16 bits")):
        with pytest.raises(LabialError, match=wrong):
            face.frame(frame)
    for values, wrong in (({}, "not none"), ({"jaw": 1, "lip": 2}, "not jaw, lip"),
                          ({"jaw": math.nan}, "not a number")):
        with pytest.raises(LabialError, match=wrong):
            face.values(values)
        with pytest.raises(LabialError, match=wrong):
            face.place(values)
    for ahead in (-1, 1001):
        with pytest.raises(LabialError, match="0 to 1,000 frames ahead"):
            labial.Face(face.rig, ahead=ahead)
    for ticks in (0, 256):
        with pytest.raises(LabialError, match="1 to 255 ticks"):
            face.soft_start(ticks)
    with pytest.raises(TypeError, match="a number of frames is a whole number"):
        labial.Face(face.rig, ahead=1.5)  # type: ignore[arg-type]
    assert face.rests and face.tick() == {"jaw": 1400} and "jaw" in repr(face)


# ---- Rigs at run-time ------------------------------------------------------------------------------------------------


@needs_runtime
def test_a_jaw_closes_in_p_b_m(tmp_path: Path) -> None:
    """In 32 sentences: within 10 us of `closed` where lips touch, and opening, at a common servo's limits with ten
    frames in sight, at a slow one's with more; without sight of what comes most closures are lost, which is why it
    looks. Limits are kept, and with all in sight a servo that needs time to brake goes never beyond what is wanted."""
    motion = read_sentences(Path(__file__).with_name("sentences.flite"))
    frames, path = motion.frames.astype(np.int64), tmp_path / "face.toml"
    path.write_text(CLOSING)
    meant = played(path, frames)[:, 0]
    others = [span for name, *span in motion.phonemes if name in ("aa", "ae", "ow", "ey")]
    assert np.mean([meant[begin:end].max() >= 1550 for begin, end in others]) >= 0.98  # vowels are left as they are
    assert len(motion.closures) > 100
    for slew, acceleration, ahead, least, most, wide in (
            (500, 0, 1, 0.98, 1.0, 1.0), (40, 0, len(frames), 0.98, 1.0, 0.7), (40, 0, 10, 0.9, 1.0, 0.7),
            (40, 0, 1, 0.0, 0.5, 0.7), (90, 30, 10, 0.98, 1.0, 0.9), (60, 20, 10, 0.98, 1.0, 0.84),
            (40, 10, 10, 0.9, 1.0, 0.74), (40, 10, 32, 0.98, 1.0, 0.7), (60, 20, 1, 0.2, 0.6, 0.9)):
        path.write_text(CLOSING + f"slew = {slew}\n" + (f"acceleration = {acceleration}\n" if acceleration else ""))
        values = played(path, frames, ahead)[:, 0]
        changes = np.diff(values, prepend=[1400])
        assert np.abs(changes).max() <= slew
        assert not acceleration or np.abs(np.diff(changes, prepend=[0])).max() <= acceleration
        assert not acceleration or ahead < 32 or (values - meant).max() <= 0
        closed = np.mean([values[begin:end].min() <= 1410 for begin, end in motion.closures])
        assert least <= closed <= most, (slew, ahead, closed)
        assert np.percentile(values, 95) - 1400 >= wide * (np.percentile(meant, 95) - 1400)


ACCELERATION = "slew = {slew}\nacceleration = {acceleration}\n"


@needs_runtime
@pytest.mark.parametrize("limits", ["", "slew = 90\nacceleration = 30\n"])
def test_outputs_follow_sounds(tmp_path: Path, limits: str) -> None:
    """A tongue that stays at rest, or that a face and a rig move otherwise, though frames bring the shares of their
    sounds. What sounds mean is in sight like what FAPs mean."""
    description = f"[output.tongue]\nneutral = 1500\nvisemes = {{ TH = 300 }}\nfull = 1800\n{limits}"
    frames = labial.render([("TH", 200), ("IH", 200), ("TH", 200)])
    face, shown = face_of(tmp_path, description, ahead=5), []
    for frame in frames:
        face.frame(frame)
        shown.append(face.tick()["tongue"])
    while not face.rests:
        shown.append(face.tick()["tongue"])
    rig = Rig(tmp_path / "face.toml")
    assert shown[5:5 + len(frames)] == [values["tongue"] for values in rig.ahead(frames, 5)]
    assert max(shown) > 1740 and min(shown[20:25]) < 1600 and shown[-1] == 1500
    rig.rest()
    known = [rig.apply(tuple(frame), visemes=frame.visemes)["tongue"] for frame in frames]
    rig.rest()
    assert [rig.apply(frame)["tongue"] for frame in frames] == known
    blind = face_of(tmp_path, description)
    blind.frame(tuple(frames[8]))
    assert blind.tick() == {"tongue": 1500}


@needs_runtime
def test_a_stream_looks_ahead(tmp_path: Path) -> None:
    """labial.Rig.ahead() is apply() with the frames that follow, and shows all of them."""
    (tmp_path / "face.toml").write_text(CLOSING + ACCELERATION.format(slew=60, acceleration=20))
    frames = np.zeros((30, 13), dtype=np.int64)
    frames[5:20, 4] = -400
    expected = played(tmp_path / "face.toml", frames, 9)[:, 0].tolist()
    face = Rig(tmp_path / "face.toml")
    assert [values["jaw"] for values in face.ahead(frames.tolist(), 8)] == expected and max(expected) > 1600
    face.rest()
    stream = (Frame(k, tuple(row)) for k, row in enumerate(frames.tolist()))
    assert [values["jaw"] for values in face.ahead(stream, 8)] == expected
    face.rest()
    kept = [Frame(k, tuple(row)) for k, row in enumerate(frames.tolist())]
    assert [face.apply(kept[k], kept[k + 1 : k + 9])["jaw"] for k in range(30)] == expected
    face.rest()
    assert [face.apply(frames[k], frames[k + 1 : k + 9])["jaw"] for k in range(30)] == expected
    with pytest.raises(LabialError, match="a frame has 13 FAPs, not 12"):
        face.apply(frames[0], frames[1:3, :12])
    for mixed in ([kept[1], 5], [5, kept[1]]):
        with pytest.raises(TypeError, match="FAPs are whole numbers"):
            face.apply(frames[0], mixed)
    arkit, frame = Rig("arkit"), Frame(0, tuple(frames[10].tolist()))
    assert arkit.apply(frame) == arkit.apply(frame.faps)
    with pytest.raises(LabialError, match="looks 0 to 65,534 frames ahead, not -1"):
        next(face.ahead(frames.tolist(), -1))


@needs_runtime
def test_lines_of_json_keep_the_limits_of_speed(tmp_path: Path) -> None:
    """`labial synth --to jsonl --rig` moves servos no faster than a baked track does, and closes them in p, b, m; an
    output that follows sounds has its own limit beside them."""
    (tmp_path / "a.lab").write_text("0 0.1 SIL\n0.1 0.3 AA\n0.3 0.38 M\n0.38 0.6 AA\n0.6 0.7 TH\n0.7 0.9 AA\n")
    (tmp_path / "slow.toml").write_text('unit = "quarter_us"\n' + CLOSING
                                        + ACCELERATION.format(slew=40, acceleration=10)
                                        + "[output.tongue]\nvisemes = { TH = 300 }\nneutral = 1500\nfull = 1800\n"
                                          "slew = 20\n")
    out = tmp_path / "a.jsonl"
    assert main(["synth", "speech_en", str(tmp_path / "a.lab"), "--to", "jsonl", "--rig", str(tmp_path / "slow.toml"),
                 "-o", str(out)]) == 0
    rows = [json.loads(line) for line in out.read_text().splitlines()]
    jaw, tongue = (np.array([row["slow"][name] for row in rows]) for name in ("jaw", "tongue"))
    faps = np.rint([list(row["faps"].values()) for row in rows]).astype(np.int64)
    assert np.abs(np.diff(jaw, prepend=[1400])).max() <= 40 and jaw.max() > 1500
    assert np.abs(np.diff(jaw, 2, prepend=[1400, 1400])).max() <= 10
    assert jaw[15:20].min() <= 1402
    assert np.abs(jaw - played(tmp_path / "slow.toml", faps, len(faps))[:, 0] / 4).max() <= 4  # faps are rounded
    assert np.abs(np.diff(tongue)).max() == 20 and tongue.max() > 1540
    slow = read(tmp_path / "slow.toml", "slow")
    form = FORMATS["jsonl"].of_rig(slow, Limited(slow))
    for parts in ([faps], [faps[:12], faps[12:12], faps[12:]]):  # a motion that comes in parts goes on; each is new
        text = io.StringIO()
        form.write(text, parts, 50, "slow", len(faps))
        moves = np.array([json.loads(line)["slow"]["jaw"] for line in text.getvalue().splitlines()])
        assert moves[0] == 1400 and np.abs(np.diff(moves, 2)).max() <= 10 and moves.max() > 1450


# ---- The face of the boards, written anew ----------------------------------------------------------------------------

AHEAD, SIGHT = 6, 32


class Servo(NamedTuple):
    """An output of tests/device/motion_works.c; weights in 1/4096, the gain in 1/65536."""

    weights: Dict[int, int]
    invert: bool
    closed: Optional[int]
    gain: int
    neutral: int
    minimum: int
    maximum: int
    slew: int = 0
    deadband: int = 0
    acceleration: int = 0

    @property
    def rest(self) -> int:
        return self.neutral if self.closed is None else self.closed

    def limited(self, value: int) -> int:
        return max(self.minimum, min(value, self.maximum))

    def meant(self, faps: List[int]) -> int:
        move = (sum(weight * faps[place] for place, weight in self.weights.items()) * self.gain + (1 << 27)) >> 28
        value = self.limited(self.neutral + (-move if self.invert else move))
        if self.closed is not None:
            contact = max(0, min(136 + faps[3] + faps[4], 64))
            value = math.floor(value + (self.closed - value) * contact / 64 + 0.5)
        return value

    def next(self, last: int, change: int, sight: List[int]) -> int:
        """The value after `last`, which came by `change`, with what is wanted from now on in sight."""
        if not self.acceleration:
            wanted = sight[0]
            if self.closed is not None and self.slew and self.closed in sight:
                room = self.slew * sight.index(self.closed)
                wanted = max(self.closed - room, min(wanted, self.closed + room))
            step = wanted - last if wanted == self.rest or abs(wanted - last) >= self.deadband else 0
            return last + (max(-self.slew, min(step, self.slew)) if self.slew else step)
        speed = min(self.slew, SIGHT * self.acceleration)
        sign = -1 if last < self.rest else 1
        least, most = sorted((sign * change - self.acceleration, sign * change + self.acceleration))
        least, most = max(least, -speed), min(most, speed)
        step = sign * (sight[0] - last)
        step = max(least, min(0 if sight[0] != self.rest and abs(step) < self.deadband else step, most))
        while step > least and not self.stops(sign, last, step, sight[:SIGHT], speed):
            step -= 1
        while step < most and not self.stops(-sign, last, -step, sight[:SIGHT], speed):
            step += 1
        return self.limited(last + sign * step)

    def stops(self, sign: int, value: int, step: int, sight: List[int], speed: int) -> bool:
        """Whether it can brake from a step so that it is never further, in that direction, than it can still come back
        from in time for each frame in sight."""
        value, frames = sign * value, [max(sign * wanted, sign * self.rest) for wanted in sight]
        rooms = [0]
        for k in range(len(frames)):
            rooms.append(rooms[-1] + min(speed, (k + 1) * self.acceleration))
        for k in itertools.count():
            value += step
            first = min(k, len(frames) - 1)
            if value > min(wanted + rooms[j] for j, wanted in enumerate(frames[first:])):
                return False
            if k + 1 >= len(frames) and step <= 0:
                return True
            step = max(step - self.acceleration, -speed)
        raise AssertionError


SERVOS = (Servo({3: -4096, 4: -4096}, False, 5600, 2000 * 65536 // 600, 5600, 5600, 7600, slew=240),
          Servo({4: -4096}, False, 5600, 218453, 5600, 5600, 7600, slew=360, acceleration=120),
          Servo({0: 3277, 5: 4096, 6: 4096, 11: 4096, 12: 4096}, True, None, 136533, 6000, 5200, 7120, deadband=24))


def test_what_boards_move() -> None:
    """Catches a number in tests/device/motion_works.c that the library itself made."""
    seed, moved, now = 1, bytearray(), 0
    due = shown_at = None
    waiting: List[List[int]] = []
    wanted, values, changes = [servo.rest for servo in SERVOS], [servo.rest for servo in SERVOS], [0, 0, 0]
    plays, waited, quiet, left, ticks = False, 0, HOLD + 1, 0, 0

    def draw(below: int) -> int:
        nonlocal seed
        seed = (seed * 1664525 + 1013904223) % 2**32
        return (seed >> 8) % below

    for call in range(1000):
        what = draw(60)
        if what == 0:
            waiting, waited, quiet = [], 0, max(quiet, HOLD)
            left = 10 if left else 0  # 181 ms
        for _ in range(draw(12) if what == 1 else 0 if what == 2 or call % 250 > 200 else 1):
            if draw(4):
                touches, faps = draw(3), [draw(301) - 150 for _ in range(13)]
                faps[4] = faps[4] - 300 if touches else 0
                frame = [servo.meant(faps) for servo in SERVOS]
            else:
                frame = [servo.limited(5000 + draw(3001)) for servo in SERVOS]
            waiting = [*waiting, frame][-AHEAD - 1:]
        now += 15 + draw(11) + (draw(200) if what == 3 else 0)
        while due is None or now >= due:
            if shown_at is None or due is None:
                due, shown_at = now, now - 20
            due += 20
            moves = now - shown_at >= 10
            shown_at = now if moves else shown_at
            result = 0
            if waiting and (plays or len(waiting) > AHEAD or waited >= AHEAD):
                wanted, *waiting = waiting
                plays, quiet, left, waited = True, 0, EASE, 0
            else:
                plays, quiet = False, min(quiet + 1, HOLD + 1)
                result, waited = (1, waited + 1) if waiting else (3, 0)
                if quiet > HOLD and left:
                    for k, servo in enumerate(SERVOS):
                        start = min(wanted[k], values[k], key=lambda value, rest=servo.rest: abs(value - rest))
                        step = abs(servo.rest - start) // left
                        wanted[k] = start + (step if start < servo.rest else -step)
                    left -= 1
            for k, servo in enumerate(SERVOS):
                rests = left == 0 or ticks < 10 * (k + 1)
                sight = [servo.rest] if rests else [wanted[k], *(row[k] for row in waiting if plays)]
                if moves:
                    value = servo.next(values[k], changes[k], sight)
                    values[k], changes[k] = value, value - values[k]
                if result == 3 and (left or values[k] != servo.rest or changes[k]):
                    result = 2
            ticks += 1
            moved += bytes([result, *(byte for value in values for byte in (value & 255, value >> 8)),
                            min(1 + ticks // 10, 3)])
    device = (SOURCE / "tests" / "device" / "motion_works.c").read_text(encoding="utf-8")
    assert f"#define MOVED {zlib.crc32(moved):#010x}u\n" in device
    assert {0, 1, 2, 3} == set(moved[::8])
