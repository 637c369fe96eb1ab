"""What the run-time in Python is given and gives back: models from files, rigs, timings of every kind, plain types;
calls within calls, by signal handlers and callbacks, and in forked processes."""

from __future__ import annotations

import gc
import io
import os
import signal
import subprocess
import sys
import threading
import time
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Callable, Iterator, List, Tuple

import numpy as np
import pytest

import labial
from labial.__main__ import main
from labial.errors import DataError, LabialError, ModelError, StreamError
from labial.rig.animation import arkit
from labial.tables.layout import blob
from labial.tables.model import load, save
from labial.tables.phones import read_stream
from labial.tables.quantise import ExportedModel, quantise
from messages import SAMPLES
from models import random_model
from packages import SOURCE, needs_runtime

pytestmark = needs_runtime

WORD: List[Tuple[Any, float]] = [("M", 70), ("AY", 160), ("B", 60), ("EY", 110), ("SIL", 100)]


@pytest.fixture(scope="module")
def exported() -> ExportedModel:
    return quantise(load(str(SOURCE / "export" / "models" / "speech_en.npz")), "speech_en")


@pytest.fixture(scope="module")
def voice(exported: ExportedModel, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The bundled speech model as a file."""
    path = tmp_path_factory.mktemp("voice") / "voice.lbm"
    path.write_bytes(blob(exported))
    return path


# ---- Models


def test_own_model_is_read_and_lives_with_its_stream(voice: Path) -> None:
    """The same frames as compiled in; the file's bytes stay for as long as the stream, not only as the Model."""
    wanted = labial.render(WORD * 20)
    stream = labial.Stream(labial.Model(voice))
    gc.collect()
    trash = [bytearray(70000) for _ in range(50)]  # would lie where the model lay
    for timing in WORD * 20:
        stream.push(*timing)
    stream.end()
    assert [frame.faps for frame in stream] == wanted and trash
    model = labial.Model(str(voice))
    assert (model.fps, model.silence, len(model.phonemes), model.name) == (50, 0, 40, str(voice))
    assert model.phonemes == labial.speech_en.phonemes and not model.is_laughter
    assert labial.laughter_synthetic.is_laughter and labial.laughter_synthetic.phonemes[0] == "silence"


def test_damaged_models_are_refused(voice: Path, tmp_path: Path) -> None:
    """Every cut and a flip in every part; the file is named, nothing is overrun."""
    good = voice.read_bytes()
    path = tmp_path / "bad.lbm"
    bad = [good[:size] for size in (0, 3, 31, 32, 1000, len(good) - 1)] + [good + b"\0", b"RIFF" + good[4:]]
    bad += [good[:at] + bytes([good[at] ^ 1]) + good[at + 1:] for at in range(4, len(good), 1499)]
    for content in bad:
        path.write_bytes(content)
        with pytest.raises(ModelError, match=f"bad.lbm: {'the' if content[:4] == b'LBM1' else 'not a'} model"):
            labial.Model(path)
    for missing in (tmp_path / "missing.lbm", ""):
        with pytest.raises(FileNotFoundError):
            labial.Model(missing)
    save(random_model(1), tmp_path / "me.npz")
    with pytest.raises(ModelError, match="me.npz: a model that training wrote; labial export .* --blob"):
        labial.Model(tmp_path / "me.npz")
    with pytest.raises(ModelError, match="voice.lbm: exported for the library; name the .npz"):
        load(voice)
    for other in (None, 3, b"x"):
        with pytest.raises(TypeError):
            labial.Model(other)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="a model is a labial.Model, not str"):
        labial.Stream("speech_en")  # type: ignore[arg-type]


def test_models_of_one_stream_have_one_rate(exported: ExportedModel, tmp_path: Path) -> None:
    path = tmp_path / "slow.lbm"
    path.write_bytes(blob(replace(exported, fps=25)))
    slow = labial.Model(path)
    with labial.Stream() as stream:
        with pytest.raises(StreamError, match="the model's frame rate or search stride is not the stream's") as raised:
            stream.use(slow)
        assert raised.value.result == -9
        stream.push("AA", 40)  # as before
    with labial.Stream(slow, exact=True) as stream:
        with pytest.raises(StreamError, match="frame rate"):
            stream.laugh(1)
        stream.push("AA", 400)
        stream.end()
        assert len(list(stream)) == 10 and stream.fps == 25


# ---- Rigs


def test_rig_moves_as_its_description_says(tmp_path: Path) -> None:
    """Against the description's own arithmetic: opening, direction, limits, and the most that a frame may change."""
    path = tmp_path / "face.toml"
    path.write_text('[output.jaw]\nfrom = "opening"\nneutral = 1400\nfull = 2000\nslew = 50\n'
                    '[output.lip]\nfrom = "fap51"\nneutral = 1500\ngain = 2\nminimum = 1400\nmaximum = 1550\n'
                    "invert = true\n")
    face = labial.Rig(path)
    assert face.values == {"jaw": 1400, "lip": 1500} and (face.name, face.unit, face.prescale) == ("face", "us", None)
    jaw = 1400
    for opening, raised in ((600, 0), (600, 10), (600, -100), (0, 100), (300, 0), (300, 0)):
        faps = [0] * 13
        faps[3], faps[4] = raised, -opening - raised
        wanted = min(max(1400 + opening, 1400), 2000)
        jaw = min(max(wanted, jaw - 50), jaw + 50)
        lip = min(max(1500 - 2 * raised, 1400), 1550)
        assert labial.Frame(0, tuple(faps)).rig(face) == {"jaw": jaw, "lip": lip} == face.values
    assert face.rest() == {"jaw": 1400, "lip": 1500}


def test_built_in_rigs() -> None:
    """Known by name, each value within its limits; a PCA9685's rig tells its prescaler."""
    assert "arkit" in labial.Rig.BUILTIN
    motion = labial.render(WORD)
    for name in labial.Rig.BUILTIN:
        for row in motion:
            values = labial.Frame(0, row).rig(name)
            assert all(isinstance(value, float) and 0 <= value <= 1 for value in values.values())
            assert values == labial.Rig(name).apply(row)  # what is kept under a name has no memory
    assert 0.1 < max(labial.Frame(0, row).rig("arkit")["jawOpen"] for row in motion) <= 1
    open_wide = [700, 0, 0, -300, -500] + [0] * 8
    values, expected = labial.Rig("arkit").apply(open_wide), arkit(np.array([open_wide], dtype=float))
    assert all(abs(values[name] - expected[name][0]) <= 0.0011 for name in expected)
    servos = labial.Rig(SOURCE / "examples" / "faces" / "servos.toml")
    assert servos.unit == "pca9685" and servos.prescale == 121


def test_what_is_no_rig(tmp_path: Path) -> None:
    path = tmp_path / "face.toml"
    path.write_text('[output.jaw]\nfrom = "opening"\nneutral = 1400\nfull = 9000\n')
    with pytest.raises(DataError, match="face.toml: output.jaw.full: 9000 is not a servo's pulse"):
        labial.Rig(path)
    with pytest.raises(DataError, match="nothing.toml: No such file"):
        labial.Rig("nothing.toml")
    frame = labial.Frame(0, (0,) * 13)
    with pytest.raises(LabialError, match="no built-in rig is called 'nothing.toml'"):
        frame.rig("nothing.toml")
    face = labial.Rig("arkit")
    for faps, error in (((0,) * 12, LabialError), ((40000,) * 13, LabialError), ((0.5,) * 13, TypeError)):
        with pytest.raises(error):
            face.apply(faps)


# ---- Timings and types

LAB = "0.00 0.12 sil\n0.12 0.20 m\n0.20 0.45 ay\n"


def test_timings_from_anything_that_holds_them(tmp_path: Path) -> None:
    """The same from a path, an open file, a text in memory, and JSON that a service's client has parsed."""
    path = tmp_path / "word.lab"
    path.write_text(LAB)
    expected = [("SIL", 120), ("M", 80), ("AY", 250)]
    assert labial.read_timings(path) == labial.read_timings(str(path)) == expected
    assert labial.read_timings(io.StringIO(LAB)) == labial.read_timings(io.BytesIO(LAB.encode())) == expected
    with open(path) as file:
        assert labial.read_timings(file, source="lab") == expected
    for name in ("piper", "piper_info", "kokoro", "azure", "headtts"):
        path = tmp_path / "a.json"
        path.write_text(SAMPLES[name].text, encoding="utf-8")
        assert labial.read_timings(SAMPLES[name].messages) == labial.read_timings(path)
    assert labial.read_timings(SAMPLES["elevenlabs"].messages[0]) == labial.read_timings(
        SAMPLES["elevenlabs"].messages[:1])
    for given in (3, None, object()):
        with pytest.raises(TypeError, match="timings are a path, a file, a list or a dict"):
            labial.read_timings(given)  # type: ignore[arg-type]
    with pytest.raises(DataError, match="^timings:2: "):
        labial.read_timings(io.StringIO("0 1 sil\n1 x m\n"))


def test_laughs_are_kept_for_render(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    """Catches a laugh that becomes silence where it can be rendered, and one model that drops it without a word."""
    laugh, path = "<laugh:0.7>", tmp_path / "l.lab"
    path.write_text(f"0 .2 m\n.2 2.2 {laugh}\n2.2 2.4 m\n2.4 14.4 <laugh>\n14.4 14.6 m\n")
    expected = [("M", 200), (laugh, 2000), ("M", 200), ("<laugh>", 12000), ("M", 200)]
    assert labial.read_timings(path) == expected
    assert max(frame[0] for frame in labial.render(expected)[20:100]) > 100
    for text, found in (("m:0.2 <laugh 1.8 0.7> m:0.4\n", "<laugh:0.699>"), (f"m:0.2 {laugh}:2.0 m:2.2\n", laugh)):
        assert labial.read_timings(io.StringIO(text)) == [("M", 200), (found, 1800), ("M", 200)]
    assert main(["timings", str(path)]) == 0
    captured = capsys.readouterr()
    assert captured.out.splitlines()[1] == f"0.2000 2.2000 {laugh}" and captured.err == ""
    assert main(["synth", "speech_en", str(path), "-o", str(tmp_path / "a.csv")]) == 0
    assert capsys.readouterr().err == (f"labial: warning: {path}:2: one model alone cannot laugh, so laughs are "
                                       "silence; labial-say and labial.render() laugh\n")


def test_pipers_chunks_as_they_are() -> None:
    """Its own objects, whose numbers are NumPy's."""
    chunks = [SimpleNamespace(sample_rate=chunk["sample_rate"], audio_float_array=np.zeros(3), phoneme_alignments=[
        SimpleNamespace(phoneme=item["phoneme"], num_samples=np.int64(item["num_samples"]))
        for item in chunk["phoneme_alignments"]]) for chunk in SAMPLES["piper"].messages]
    found = labial.read_timings(chunks, source="piper")
    assert found == labial.read_timings(SAMPLES["piper"].messages) and len(labial.render(found)) > 50


def test_piper_without_alignments_says_what_to_do() -> None:
    """Whoever asked for them already is not told to ask for them alone."""
    silent = SimpleNamespace(sample_rate=22050, phoneme_alignments=None)
    with pytest.raises(DataError, match="piper.patch_voice_with_alignment VOICE.onnx adds them"):
        labial.read_timings([silent], source="piper")


def test_punctuation_is_silence() -> None:
    """Piper's characters, given as they come."""
    expected = labial.render([("m", 80), ("SIL", 200), ("m", 80)])
    for label in ("^", "$", "_", ",", ".", "...", " "):
        assert labial.render([("m", 80), (label, 200), ("m", 80)]) == expected, label


def test_the_type_is_the_same_without_numpy() -> None:
    """And is told to type checkers."""
    script = "import labial, sys\nsys.modules['numpy'] = None\nprint(labial.render([('AA', 100)]))\n"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    motion = labial.render([("AA", 100)])
    assert Path(labial.__file__).with_name("py.typed").is_file()
    assert done.stdout == f"{motion}\n" and isinstance(motion, list) and isinstance(motion[0], tuple)
    assert np.array(motion, "int16").shape == (5 + 12, 13)


@pytest.mark.slow
def test_long_silences_are_split(tmp_path: Path) -> None:
    """Silences and gaps of hours; another phoneme of such a length is named with its file and line."""
    path = tmp_path / "night.lab"
    path.write_text("0 1 AA\n1 9000 SIL\n20000 20001 AA\n")
    found = labial.read_timings(path)
    assert sum(ms for _, ms in found) == 20_001_000 and max(ms for _, ms in found) <= 3_600_000
    assert [label for label, _ in found] == ["AA", *["SIL"] * 7, "AA"]
    path.write_text("0 1 AA\n1 3700 SIL\n")  # which is two
    found = labial.read_timings(path)
    assert len(found) == 3 and len(labial.render(found, exact=True)) == 50 * 3_700
    path.write_text("0 1 P1\n1 9000 SIL\n20000 20001 P1\n")
    assert sum(ms for _, ms in read_stream(path, random_model(1))) == 20_001_000
    path.write_text("0 1 SIL\n1 3602 AA\n")
    with pytest.raises(DataError, match=r"night.lab:2: 'AA' lasts 3601 s, more than the 3600 s"):
        labial.read_timings(path)


# ---- Calls of the run-time within calls, by signal handlers and callbacks, and in forked processes -------------------


on_linux = pytest.mark.skipif(sys.platform != "linux", reason="signals and forks are those of Linux")

REFUSED = "this thread is in a call of the same object"


@pytest.fixture(autouse=True)
def patience() -> Iterator[None]:
    """A deadlock ends the process of the tests, with the line that hangs, in place of hanging it."""
    import faulthandler

    faulthandler.dump_traceback_later(60, exit=True)
    yield
    faulthandler.cancel_dump_traceback_later()


def speaking(seconds: int = 1) -> labial.Stream:
    stream = labial.Stream()
    for _ in range(10 * seconds):
        stream.push("AA", 60)
        stream.push("M", 40)
    stream.end()
    return stream


class Calling:
    """A number that calls a stream when it is read."""

    def __init__(self, call: Callable[[], object]) -> None:
        self._call = call

    def __float__(self) -> float:
        self._call()
        return 100.0


@on_linux
@pytest.mark.parametrize("call", [
    lambda stream: stream.cancel(), lambda stream: stream.push("AA", 50), lambda stream: stream.tick(),
    lambda stream: next(stream), lambda stream: stream.drain(), lambda stream: stream.latency,
    lambda stream: stream.close(), lambda stream: stream.end(), lambda stream: stream.restart(),
])  # fmt: skip
def test_an_argument_that_calls_the_stream_is_refused(call: Callable[[labial.Stream], object]) -> None:
    """It hung, and the stream is as it was."""
    with labial.Stream() as stream:
        stream.push("AA", 100)
        with pytest.raises(StreamError, match=REFUSED):
            stream.push("M", Calling(lambda: call(stream)))  # type: ignore[arg-type]
        stream.end()
        assert len(list(stream)) == 5 + 12


@on_linux
def test_another_stream_may_be_called_meanwhile() -> None:
    with labial.Stream() as first, labial.Stream() as second:
        first.push("AA", Calling(lambda: second.push("M", 100)))  # type: ignore[arg-type]
        second.end()
        assert len(list(second)) == 5 + 12


@on_linux
def test_a_signal_handler_is_refused_or_served() -> None:
    """A timer that fires hundreds of times, in calls and between them: every call of the handler ends, and the frames
    are those of a stream that nobody interrupted."""
    refused: List[str] = []
    served: List[labial.Latency] = []

    def interrupt(*_: object) -> None:
        try:
            served.append(stream.latency)
        except StreamError as error:
            refused.append(str(error))

    with speaking(20) as quiet:
        expected = list(quiet)
    before = signal.signal(signal.SIGALRM, interrupt)
    try:
        with speaking(20) as stream:
            frames = []
            signal.setitimer(signal.ITIMER_REAL, 0.0002, 0.0002)
            for frame in stream:
                frames.append(frame)
            deadline = time.monotonic() + 20
            while not refused and time.monotonic() < deadline:
                stream.push("AA", 10) if not stream.done else stream.restart()
                list(stream)
            signal.setitimer(signal.ITIMER_REAL, 0)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert frames == expected and refused and all(REFUSED in text for text in refused)


@on_linux
def test_an_exception_of_a_handler_frees_the_stream() -> None:
    """Ctrl-C in a call: whoever catches it goes on with the same stream. Would catch a call that counts as running for
    ever, at whatever instruction the signal came."""
    def interrupt(*_: object) -> None:
        raise InterruptedError

    before = signal.signal(signal.SIGALRM, interrupt)
    try:
        with labial.Stream() as stream:
            for turn in range(400):
                try:
                    signal.setitimer(signal.ITIMER_REAL, 0.00005 + 0.000001 * turn)
                    for _ in range(1000):
                        stream.push("AA", 20)
                except InterruptedError:
                    pass
                finally:
                    signal.setitimer(signal.ITIMER_REAL, 0)
                assert stream.latency.delay == 6
                stream.cancel(0)
                list(stream)
                stream.restart()
    finally:
        signal.signal(signal.SIGALRM, before)


@on_linux
def test_a_rig_in_a_handler() -> None:
    face = labial.Rig("arkit")

    class Faps(list):
        def __iter__(self) -> Iterator[int]:
            face.apply([0] * 13)
            return super().__iter__()

    assert face.apply(Faps([0] * 13)) == face.apply([0] * 13)
    face._guard.caller = 1
    with pytest.raises(StreamError, match=REFUSED):
        face.rest()


def forked(work: Callable[[], None]) -> int:
    """The exit status of a child that does `work`: 0 when it raised nothing, 99 when it hung for ten seconds."""
    child = os.fork()
    if not child:
        status = 1
        try:
            signal.signal(signal.SIGALRM, lambda *_: os._exit(99))
            signal.alarm(10)
            work()
            status = 0
        finally:
            os._exit(status)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


@on_linux
def test_a_fork_while_another_thread_is_in_a_call() -> None:
    """All twelve children hung. The stream is refused there, its memory can be freed, and all others work."""
    with labial.Stream() as busy, speaking() as idle, speaking() as calm:
        expected = list(calm)
        go_on = threading.Event()
        thread = threading.Thread(target=lambda: busy.push("AA", Calling(go_on.wait)))  # type: ignore[arg-type]
        thread.start()
        while not busy._guard.caller:
            time.sleep(0)

        def work() -> None:
            for call in (busy.tick, busy.cancel, busy.drain):
                with pytest.raises(StreamError, match="another thread was in a call"):
                    call()
            busy.close()
            assert list(idle) == expected
            with speaking() as new:
                assert list(new) == expected

        statuses = [forked(work) for _ in range(12)]
        go_on.set()
        thread.join()
        assert statuses == [0] * 12
        busy.end()
        assert len(busy.drain()) > 0 and list(idle) == expected


@on_linux
def test_a_fork_within_a_call() -> None:
    """By the thread that is in it: parent and child both end the call."""
    with labial.Stream() as stream:
        children: List[int] = []
        stream.push("AA", Calling(lambda: children.append(os.fork())))  # type: ignore[arg-type]
        stream.end()
        count = len(list(stream))
        if not children[0]:
            os._exit(count)
        assert count == 5 + 12 and os.waitstatus_to_exitcode(os.waitpid(children[0], 0)[1]) == 5 + 12
