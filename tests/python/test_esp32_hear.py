"""examples/esp32-hear on the host: lips against a simulated loudspeaker, the renderer and the servo on stubs of their
interfaces, and what the lines that its patches put into other projects stand in, for test_esp32_beside.py."""

from __future__ import annotations

import bisect
import ctypes
import os
import re
import shutil
import subprocess
import threading
import time
from pathlib import Path
from typing import Any, Dict, List, Optional, Sequence, Tuple

import numpy as np
import pytest

import labial
from packages import SOURCE, needs_runtime
from test_hearing import voice

CC, CXX = os.environ.get("LABIAL_CC", ""), os.environ.get("LABIAL_CXX", "")
pytestmark = [needs_runtime, pytest.mark.skipif(not CC or not CXX, reason="LABIAL_CC or LABIAL_CXX names no compiler")]

EXAMPLE = SOURCE / "examples" / "esp32-hear"
STUBS = SOURCE / "tests" / "packages"
#: The headers that esp32.h stands in for.
HEADERS = ("esp_log.h", "esp_timer.h", "driver/ledc.h", "freertos/FreeRTOS.h", "freertos/stream_buffer.h",
           "freertos/task.h", "mbedtls/base64.h", "audio_render.h", "cJSON.h", "PitchShift.h", "mcp_server.h",
           "mqtt_protocol.h")
WARNINGS = ["-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Werror"]
INCLUDES = [f"-I{SOURCE / folder}" for folder in ("include", "lib/models", "examples/esp32-hear")]
MS = 1000  #: microseconds
GRACE, EASE, FRAME = 40 * MS, 120 * MS, 20 * MS
AHEAD = 6  #: frames of sound that must be heard until a frame is known
Faps = List[int]


def build(folder: Path, *sources: Path, options: Sequence[str] = ()) -> Path:
    """The example as a shared library."""
    library = folder / "lips.so"
    hearing = [*sorted((SOURCE / "lib").glob("hear*.c")), SOURCE / "lib/models/hear_small.c",
               *(SOURCE / f"lib/{name}.c" for name in ("fade", "fixed", "clock"))]
    subprocess.run([CC, "-std=c11", "-O1", "-shared", "-fPIC", *WARNINGS, *INCLUDES, *options, *map(str, sources),
                    *map(str, hearing), "-o", str(library)], check=True, timeout=300)
    return library


def load(library: Path) -> ctypes.CDLL:
    loaded = ctypes.CDLL(str(library))
    loaded.lips_feed.restype = ctypes.c_uint64
    loaded.lips_playing.argtypes = [ctypes.c_uint64, ctypes.c_size_t, ctypes.c_int64]
    return loaded


def stub_options(folder: Path) -> List[str]:
    """Options that let a compiler find the headers of an ESP32, which are made in `folder`."""
    for name in HEADERS:
        path = folder / "esp32" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text('#include "esp32.h"\n', encoding="ascii")
    return [f"-I{folder / 'esp32'}", f"-I{STUBS}"]


@pytest.fixture(scope="module")
def lips(tmp_path_factory: pytest.TempPathFactory) -> ctypes.CDLL:
    return load(build(tmp_path_factory.mktemp("lips"), EXAMPLE / "lips.c"))


def heard(samples: np.ndarray, rate: int, *ends: int) -> List[Faps]:
    """The frames of labial.Hearing; at samples `ends` the sound has ended, and another one begins."""
    found: List[Faps] = []
    with labial.Hearing(rate, 1 if samples.ndim == 1 else samples.shape[1], model="hear_small", exact=True) as hearing:
        for part in np.split(samples, ends):
            found += [list(frame.faps) for frame in hearing.push(part) + hearing.end()]
            hearing.restart()
    return found


def feed(lips: ctypes.CDLL, samples: np.ndarray) -> int:
    data = np.ascontiguousarray(samples, dtype=np.int16).tobytes()
    return int(lips.lips_feed(data, ctypes.c_size_t(len(samples))))


def shown(lips: ctypes.CDLL, now: int) -> Tuple[int, Faps]:
    """What lips_frame() says and writes."""
    faps = (ctypes.c_int16 * 13)()
    return int(lips.lips_frame(ctypes.c_int64(now), faps)), list(faps)


class Loudspeaker:
    """A driver whose write blocks while its buffer of `room` samples is full; knows what is heard when."""

    def __init__(self, rate: int, room: int) -> None:
        self._rate, self._room, self._end = rate, room, 0.0
        self.begins: List[float] = []  #: of each write, microseconds
        self.writes: List[Tuple[int, int]] = []  #: first, count

    def write(self, first: int, count: int, now: float) -> float:
        begin = max(now, self._end)
        self.begins.append(begin)
        self.writes.append((first, count))
        self._end = begin + count * 1e6 / self._rate
        return max(now, self._end - self._room * 1e6 / self._rate)

    def at(self, now: float) -> Optional[int]:
        """The number of the sample that is heard, None in silence."""
        k = bisect.bisect_right(self.begins, now) - 1
        if k < 0:
            return None
        first, count = self.writes[k]
        offset = int((now - self.begins[k]) * self._rate / 1e6)
        return first + offset if offset < count else None


def play(lips: ctypes.CDLL, samples: np.ndarray, rate: int, packet: int, *, arrivals: Optional[Dict[int, int]] = None,
         start: int = 7_000_000) -> Tuple[Loudspeaker, List[Tuple[int, int, Faps]]]:
    """Plays packets of `packet` ms as xiaozhi-esp32 does: a task hears packets while less than two wait, or 120 ms, and
    another one writes them. `arrivals` says when a packet arrives, ms after `start`, others at once. Returns the
    loudspeaker and every 7 ms: the time, what lips_frame() said, the frame."""
    size = rate * packet // 1000
    packets = [samples[k : k + size] for k in range(0, len(samples), size)]
    speaker, waiting, log = Loudspeaker(rate, rate * 60 // 1000), [], []
    number, busy, now, quiet = 0, 0.0, start, 0
    written: Optional[Tuple[int, int]] = None
    while quiet < 400:
        if written and now >= busy:
            written = None
        while (len(waiting) < max(2, 120 // packet) and number < len(packets)
               and now >= start + (arrivals or {}).get(number, 0) * MS):
            waiting.append((feed(lips, packets[number]), len(packets[number])))
            number += 1
            if not written:
                break
        if not written and waiting:
            written = waiting.pop(0)
            lips.lips_playing(*written, now)
            busy = speaker.write(*written, now)
            continue
        if (now - start) // MS % 7 == 0:
            log.append((now, *shown(lips, now)))
        quiet = quiet + 1 if not written and number == len(packets) else 0
        now += MS
    return speaker, log


def in_step(speaker: Loudspeaker, log: List[Tuple[int, int, Faps]], frames: List[Faps], rate: int) -> int:
    """Asserts that every frame is that of the sample that is heard, but while the mouth eases; how many there were."""
    begins = [begin for k, begin in enumerate(speaker.begins)
              if k == 0 or begin > speaker.begins[k - 1] + speaker.writes[k - 1][1] * 1e6 / rate + GRACE]
    compared = 0
    for now, speaking, faps in log:
        late, early = speaker.at(now - 2 * MS), speaker.at(now + 2 * MS)  # within the millisecond of the simulation
        eases = any(begin - 2 * MS <= now <= begin + EASE + 8 * MS for begin in begins)
        if late is None or early is None or eases:
            continue
        assert speaking and faps in frames[late * 50 // rate : early * 50 // rate + 1], now
        compared += 1
    return compared


@pytest.mark.slow
@pytest.mark.parametrize(("rate", "packet", "channels"),
                         [(24000, 60, 1), (16000, 20, 2), (48000, 120, 1), (44100, 30, 1)])
def test_lips_are_in_step_with_the_loudspeaker(lips: ctypes.CDLL, rate: int, packet: int, channels: int) -> None:
    """Catches a clock that counts packets when they are written, not when they are heard, and another rate's."""
    samples = voice(2.4, rate=rate)
    if channels == 2:
        samples = np.stack([samples, samples // 2], axis=1)
    assert lips.lips_begin(rate, channels) == 0
    speaker, log = play(lips, samples, rate, packet, arrivals={0: 100})
    assert in_step(speaker, log, heard(samples, rate), rate) > 250
    assert log[0][1:] == (0, [0] * 13) and log[-1][1:] == (0, [0] * 13)


def test_after_an_underrun_lips_are_in_step_again(lips: ctypes.CDLL) -> None:
    """Catches a clock that runs on while no sound comes, and a mouth that stays open meanwhile."""
    samples, rate = voice(3.0, rate=24000), 24000
    assert lips.lips_begin(rate, 1) == 0
    speaker, log = play(lips, samples, rate, 60, arrivals={20: 1900, 21: 1900, 22: 1900})
    assert speaker.begins[20] - speaker.begins[19] > 600 * MS
    assert in_step(speaker, log, heard(samples, rate, rate * 6 // 5), rate) > 300
    silent = speaker.begins[19] + 60 * MS
    still = [item for item in log if silent + GRACE + EASE + 10 * MS < item[0] < speaker.begins[20]]
    assert len(still) > 50 and all(item[1:] == (0, [0] * 13) for item in still)
    steps = np.abs(np.diff([item[2] for item in log if silent - 20 * MS < item[0] < speaker.begins[20]], axis=0)).max()
    reach = np.abs([item[2] for item in log if silent - 200 * MS < item[0] < silent]).max()
    assert reach > 100 and steps < reach / 2, "it jumps"


@pytest.mark.parametrize("cut", [0.55, 1.31, 1.79])
def test_the_end_of_a_sound_is_heard(lips: ctypes.CDLL, cut: float) -> None:
    """Catches the last 120 ms of an utterance, which hearing gives only when it is told that the sound has ended."""
    rate = 16000
    samples = voice(2.0, rate=rate)[: int(cut * rate) // 320 * 320]
    assert lips.lips_begin(rate, 1) == 0
    for turn in range(3):
        speaker, log = play(lips, samples, rate, 20, start=7_000_000 + turn * 5_000_000)
        assert speaker.writes[0][0] == turn * len(samples)
        ended = speaker.begins[-1] + 20 * MS
        last = [faps for now, speaking, faps in log if speaking and ended - 2 * MS - EASE < now < ended - 2 * MS]
        frames = heard(np.tile(samples, turn + 1), rate, *(len(samples) * k for k in range(1, turn + 1)))
        assert len(last) > 15 and all(faps in frames[-8:] for faps in last)
        assert len({tuple(faps) for faps in last}) >= 5 and last[-1] == frames[-1]


def test_a_pause_of_the_network_ends_nothing(lips: ctypes.CDLL) -> None:
    """Catches hearing that is ended between two packets that come just in time."""
    samples, rate = voice(2.4, rate=24000), 24000
    frames = heard(samples, rate)
    assert lips.lips_begin(rate, 1) == 0
    found = []
    for k in range(40):  # 60 ms each, heard as they come
        now = k * 60 * MS
        lips.lips_playing(feed(lips, samples[k * 1440 : k * 1440 + 1440]), 1440, now)
        found += [shown(lips, now + step * 5 * MS)[1] for step in range(12)]
    assert {tuple(faps) for faps in found[400:]} <= {tuple(faps) for faps in frames}


def test_cancel_closes_the_mouth(lips: ctypes.CDLL) -> None:
    """Catches lips that speak on after the sound was cut off, and ones that jump; the next words begin as the first."""
    samples, rate = voice(2.0, rate=24000), 24000
    frames = heard(samples, rate)
    assert lips.lips_begin(rate, 1) == 0
    assert feed(lips, samples[: rate * 6 // 5]) == 0
    lips.lips_playing(0, rate, 0)
    now = max(range(200, 900), key=lambda ms: abs(frames[ms // 20][0])) * MS
    shown(lips, 0)
    speaking, before = shown(lips, now)
    assert speaking and before == frames[now // FRAME]
    lips.lips_cancel()
    eased = [shown(lips, now + k * 10 * MS) for k in range(14)]
    assert [item[0] for item in eased] == [0] * 14
    jaw = [abs(item[1][0]) for item in eased]
    assert jaw[0] == abs(before[0]) > 100 and jaw == sorted(jaw, reverse=True) and jaw[5] > jaw[0] / 3
    assert eased[12][1] == [0] * 13
    assert feed(lips, samples[rate * 6 // 5 :]) == rate * 6 // 5
    lips.lips_playing(rate, rate, now + 500 * MS)
    assert shown(lips, now + 500 * MS) == (1, [0] * 13)
    assert shown(lips, now + 800 * MS) == (1, frames[65])


def test_lips_follow_sound_that_comes_late(lips: ctypes.CDLL) -> None:
    """Catches frames of the ring that are not yet known, or no longer there."""
    samples, rate = voice(5.0, rate=16000), 16000
    frames = heard(samples, rate)
    assert lips.lips_begin(rate, 1) == 0
    for k in range(40):  # heard as it is played
        now = k * FRAME
        first = feed(lips, samples[k * 320 : k * 320 + 320])
        lips.lips_playing(first, 320, now)
        speaking, faps = shown(lips, now + FRAME - MS)
        known = k + 1 - AHEAD
        assert speaking == (known >= 0)
        if k > 14:
            assert faps == frames[known], "the newest frame that is known"
    assert feed(lips, samples[40 * 320 :]) == 40 * 320  # and far ahead of it: 64 frames are kept
    lips.lips_playing(40 * 320, 320, 40 * FRAME)
    assert shown(lips, 40 * FRAME + FRAME // 2) == (1, frames[len(frames) - AHEAD - 63])


def test_samples_may_begin_at_any_byte(lips: ctypes.CDLL) -> None:
    """Catches a cast of bytes to samples, which other CPUs refuse, and numbers that do not follow each other."""
    samples = voice(0.5)
    data = ctypes.create_string_buffer(b"x" + samples.tobytes())
    assert lips.lips_begin(16000, 1) == 0
    assert lips.lips_feed(ctypes.byref(data, 1), ctypes.c_size_t(3000)) == 0
    assert lips.lips_feed(ctypes.byref(data, 6001), ctypes.c_size_t(5000)) == 3000
    assert lips.lips_feed(data, ctypes.c_size_t(0)) == 8000
    lips.lips_playing(0, 8000, 0)
    shown(lips, 0)
    assert shown(lips, 200 * MS) == (1, heard(samples, 16000)[10])


def test_between_writes(lips: ctypes.CDLL) -> None:
    """Catches the next frame, of sound that is not played, and a mouth that rests between two writes."""
    samples = voice(1.2)
    frames = heard(samples, 16000)
    assert lips.lips_begin(16000, 1) == 0 and feed(lips, samples) == 0
    lips.lips_playing(0, 4800, 0)
    shown(lips, 0)
    assert [shown(lips, now * MS) for now in (150, 299, 300, 339)] == [(1, frames[7]), *[(1, frames[14])] * 3]
    assert shown(lips, 341 * MS)[0] == 0
    assert lips.lips_begin(16000, 1) == 0 and feed(lips, samples) == 0
    lips.lips_playing(0, 4800, 0)
    shown(lips, 0)
    lips.lips_playing(12800, 1600, 150 * MS)
    assert [shown(lips, now * MS) for now in (200, 299, 319)] == [(1, frames[40])] * 3
    assert shown(lips, 321 * MS) == (1, frames[41])


def test_nothing_moves_before_the_begin(lips: ctypes.CDLL) -> None:
    """Catches sound that is heard at a rate of 0."""
    assert lips.lips_begin(11025, 1) < 0
    assert feed(lips, voice(0.5)) == 0 == feed(lips, voice(0.5))
    lips.lips_playing(0, 8000, 1000 * MS)
    assert shown(lips, 1100 * MS)[0] == 0
    assert shown(lips, 2000 * MS) == (0, [0] * 13)


@pytest.mark.slow
def test_threads(lips: ctypes.CDLL) -> None:
    """Catches frames that are read while they are written: what another thread shows was heard, or eases."""
    samples, rate = voice(6.0), 16000
    known = {tuple(frame) for frame in heard(samples, rate)}
    assert lips.lips_begin(rate, 1) == 0
    clock, found, stop = [0], [], threading.Event()

    def show() -> None:
        while not stop.is_set():
            now = clock[0]
            found.append((now, *shown(lips, now)))

    reader = threading.Thread(target=show)
    reader.start()
    for k in range(0, len(samples) - 3200, 160):
        first = feed(lips, samples[k : k + 160])
        lips.lips_playing(first, 160, clock[0])
        clock[0] += 10 * MS
        time.sleep(0.0005)
    stop.set()
    reader.join()
    middle, silent = [], 0
    for now, speaking, faps in found:
        if not speaking:  # before the first frame, or so late that the frame has been overwritten: the face eases
            silent = now
        elif now > silent + 400 * MS:
            middle.append(tuple(faps))
    assert len(set(middle)) > 20 and set(middle) <= known


# ---- On the stubs ----------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The example's C as it is compiled for an ESP32, with the stubs, whose assertions end the process."""
    folder = tmp_path_factory.mktemp("board")
    sources = [*sorted(EXAMPLE.glob("*.c")), STUBS / "esp32.c", SOURCE / "lib/rig.c", SOURCE / "lib/face.c"]
    return build(folder, *sources, options=["-DESP_PLATFORM", "-DSERVO_SLEW=20", *stub_options(folder)])


@pytest.fixture()
def board(built: Path, tmp_path: Path) -> ctypes.CDLL:
    """The same, with variables of its own for each test."""
    return load(Path(shutil.copy(built, tmp_path)))


def value(board: ctypes.CDLL, name: str, kind: Any = ctypes.c_int) -> Any:
    return kind.in_dll(board, name)


@pytest.mark.slow
def test_the_renderer_holds_sound_back(board: ctypes.CDLL) -> None:
    """Catches sound that is lost, doubled or played before its lips are known, and an end that is kept back."""
    with labial.Hearing(model="hear_small") as hearing:
        assert hearing.latency == pytest.approx(AHEAD * 0.02)
    assert f"#define LIPS_RENDER_DELAY {AHEAD * 20}\n" in (EXAMPLE / "lips_render.h").read_text(encoding="ascii")
    rate, samples = 16000, np.stack([voice(1.0), voice(1.0, seed=1)], axis=1)
    frames, data = heard(samples, rate), samples.tobytes()
    board.lips_render.restype, board.lips_render.argtypes = ctypes.c_void_p, [ctypes.c_void_p]
    assert board.lips_render(None) is None
    assert board.lips_render(1) == 1 and value(board, "stub_tasks").value == 1
    assert board.stub_open(rate, 2, 24) != 0 and board.stub_open(11025, 2, 16) != 0
    assert board.stub_open(48000, 2, 16) != 0, "more than the buffer holds"
    assert board.stub_open(rate, 2, 16) == 0 and board.stub_latency() == 127
    size, now = value(board, "stub_played_size", ctypes.c_size_t), value(board, "stub_now", ctypes.c_int64)
    played = (ctypes.c_char * (1 << 20)).in_dll(board, "stub_played")
    begun = 0
    for k in range(0, len(data), 1280):  # 20 ms each
        now.value += FRAME
        assert board.stub_write(data[k : k + 1280], len(data[k : k + 1280])) == 0
        while size.value <= (now.value - begun) * 64 // MS + 2048 and (k + 1280 > size.value):  # 32 ms are buffered
            at = size.value
            board.lips_render_step()
            if size.value == at:
                break
        begun = begun or (now.value if size.value else 0)
        speaking, faps = shown(board, now.value)
        if begun and now.value > begun + EASE:
            assert speaking and faps == frames[(now.value - begun) // FRAME]
    assert begun == AHEAD * FRAME
    assert size.value < len(data)
    assert board.stub_close() == 0 and value(board, "stub_opened").value == 0
    assert played.raw[: size.value] == data
    assert board.stub_open(rate, 2, 16) == 0  # and again
    assert board.stub_write(data[:640], 640) == 0
    value(board, "stub_timeout").value = 1
    board.lips_render_step()
    assert played.raw[: size.value] == data + data[:640], "less than the delay is played after a while"


@pytest.mark.slow
def test_the_servo_follows(board: ctypes.CDLL) -> None:
    """Catches pulses outside the servo's, those that it cannot follow, and a duty of another resolution."""
    samples = voice(1.0)
    duty, now = value(board, "stub_duty", ctypes.c_uint32), value(board, "stub_now", ctypes.c_int64)
    board.stub_timer.restype = ctypes.c_uint64
    assert board.servo_begin(-1) != 0
    assert board.servo_begin(5) == 0 and duty.value == 1400 * 16384 // 20000
    assert board.lips_begin(16000, 1) == 0
    feed(board, samples)
    board.lips_playing(0, 16000, 0)
    pulses = []
    for _ in range(70):
        assert board.stub_timer() == FRAME
        pulses.append(duty.value * 20000 / 16384)
        now.value += FRAME
    assert value(board, "stub_duties", ctypes.c_uint32).value == 70
    assert min(pulses) > 1397 and 1410 < max(pulses) <= 1900 and len(set(pulses)) > 10
    assert pulses[-1] < 1401
    assert 20 - 2 < np.abs(np.diff(pulses)).max() < 20 + 2, "as fast as it may, and no faster"


# ---- The patches -----------------------------------------------------------------------------------------------------


def hunks(patch: Path) -> Dict[str, List[str]]:
    """Of each file of a patch, the lines of each hunk as patched."""
    found: Dict[str, List[str]] = {}
    for part in re.split(r"^diff --git .*\n", patch.read_text(encoding="utf-8"), flags=re.MULTILINE)[1:]:
        name = re.search(r"^\+\+\+ b/(\S+)$", part, re.MULTILINE)
        assert name
        bodies = re.split(r"^@@ -\d+(?:,\d+)? \+\d+(?:,(\d+))? @@.*\n", part, flags=re.MULTILINE)
        for count, body in zip(bodies[1::2], bodies[2::2]):
            lines = [line[1:] for line in body.splitlines() if line[:1] in ("+", " ")]
            assert len(lines) == int(count or 1), name[1]
            found.setdefault(Path(name[1]).name, []).append("\n".join(lines))
    return found


def fill(context: str, parts: Dict[str, List[str]], *suffixes: str) -> str:
    """Code in which each comment `hunk N of FILE` is that hunk; all of files with these suffixes must be used."""
    used = set()

    def patched(match: re.Match) -> str:
        used.add((match[2], int(match[1])))
        return parts[match[2]][int(match[1]) - 1]

    text = re.sub(r"(?:/\* |# )hunk (\d+) of (\S+)(?: \*/|$)", patched, context, flags=re.MULTILINE)
    assert used == {(name, k + 1) for name, bodies in parts.items() if name.endswith(suffixes)
                    for k in range(len(bodies))}
    return text


#: What the patched lines stand in.
AUDIO = """\
#include <esp_timer.h>
#include <memory>
#include <vector>
/* hunk 1 of audio_service.cc */

struct AudioTask {
    std::vector<int16_t> pcm;
/* hunk 1 of audio_service.h */

struct AudioCodec {
    void Start();
    int output_sample_rate() const;
    void OutputData(std::vector<int16_t> &data);
};
"""
XIAOZHI = AUDIO + """
class AudioService {
    AudioCodec *codec_;
    void Initialize(AudioCodec *codec);
    void AudioOutputTask(std::unique_ptr<AudioTask> task);
    std::unique_ptr<AudioTask> OpusCodecTask(bool resampled);
};

void AudioService::Initialize(AudioCodec *codec)
{
    codec_ = codec;
    /* hunk 2 of audio_service.cc */
}

void AudioService::AudioOutputTask(std::unique_ptr<AudioTask> task)
{
    /* hunk 3 of audio_service.cc */
}

std::unique_ptr<AudioTask> AudioService::OpusCodecTask(bool resampled)
{
    bool decoded = false;
    auto task = std::make_unique<AudioTask>();
    {
        if (resampled) {
            /* hunk 4 of audio_service.cc */
    }
    return decoded ? std::move(task) : nullptr;
}
"""
ELATOAI = """\
#include <esp_timer.h>
#include <stddef.h>
#define portMAX_DELAY 0xffffffffu
/* hunk 1 of Audio.cpp */

extern const int BITS_PER_SAMPLE;
/* hunk 1 of Audio.h */

extern const int CHANNELS;
extern const uint32_t SAMPLE_RATE;
extern const int I2S_SD_OUT, LOW, SPEAKING;
extern int deviceState;
extern float currentPitchFactor;
extern void *wsMutex;
void xSemaphoreTake(void *mutex, uint32_t wait);
void digitalWrite(int pin, int level);
struct WebSocketsClient {
    bool isConnected();
} extern webSocket;
struct Buffer {
    size_t writeArray(const uint8_t *data, size_t size);
} extern buffer_of_sound;
struct BufferPrint {
    Buffer &_buffer;
    size_t write(const uint8_t *buffer, size_t size);
} extern bufferPrint;
struct OpusAudioDecoder {
    void setOutput(BufferPrint &out);
} extern opusDecoder;
struct StreamCopy {
    size_t copy();
} extern copier, pitchCopier;
struct QueueStream {
    int read();
} extern queue;
extern volatile bool i2sOutputFlushScheduled;

size_t BufferPrint::write(const uint8_t *buffer, size_t size)
{
    /* hunk 2 of Audio.cpp */
    }
    return AUDIO_BUFFER_SIZE < AUDIO_CHUNK_SIZE ? 0 : size;
}

void transitionToListening()
{
    /* hunk 3 of Audio.cpp */
}

void audioStreamTask(void *)
{
    /* hunk 4 of Audio.cpp */
    /* hunk 5 of Audio.cpp */
        (void)i2sOutputFlushScheduled;
        /* hunk 6 of Audio.cpp */
        else {
        /* hunk 7 of Audio.cpp */
    }
}
"""
OPENAI_DEMO = """\
#include <stddef.h>
/* hunk 1 of media_sys.c */

typedef struct {
    void *play_handle;
} i2s_render_cfg_t;
audio_render_handle_t av_render_alloc_i2s_render(i2s_render_cfg_t *cfg);
void *get_playback_handle(void);
int build_player_system(void);
static struct {
    audio_render_handle_t audio_render;
} player_sys;

int build_player_system(void)
{
    i2s_render_cfg_t i2s_cfg = {
        .play_handle = get_playback_handle(),
        /* hunk 2 of media_sys.c */
        return -1;
}
return 0;
}
"""
