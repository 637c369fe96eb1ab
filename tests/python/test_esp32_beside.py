"""examples/esp32-beside on stubs of ESP-IDF's interfaces: a simulated loudspeaker, the servo, and the lines that its
patches, and those of examples/esp32-hear, put into other projects."""

from __future__ import annotations

import asyncio
import base64
import ctypes
import functools
import importlib.util
import json
import os
import re
import subprocess
import sys
import tempfile
import types
from pathlib import Path
from typing import Any, AsyncIterator, Dict, List, Tuple

import pytest

import labial
import test_esp32_hear
from labial.rig.description import read
from packages import SOURCE, needs_runtime
from test_beside import HELLO, parse
from test_esp32_hear import CC, CXX, FRAME, MS, STUBS, WARNINGS, fill, hunks, stub_options, value

pytestmark = [needs_runtime, pytest.mark.skipif(not CC or not CXX, reason="LABIAL_CC or LABIAL_CXX names no compiler")]

EXAMPLE = SOURCE / "examples" / "esp32-beside"
JAW = SOURCE / "examples" / "faces" / "jaw.toml"
INCLUDES = [f"-I{SOURCE / 'include'}", f"-I{EXAMPLE}"]
RATE, BLOCK = 24000, 1440  # 60 ms
HELD, EASED = 5, 6  #: calls, as in labial/beside.h
OK, STARVED = 0, 2  #: of labial/result.h: lips of a frame, and the way to rest


@functools.cache
def mouth(*options: str) -> bytes:
    """mouth.c as it is compiled for an ESP32, with the stubs, whose assertions end the process."""
    with tempfile.TemporaryDirectory(prefix="labial-") as name:
        folder = Path(name)
        (folder / "none.c").write_text("void lips_render_step(void);\nvoid lips_render_step(void)\n{\n}\n")
        sources = (EXAMPLE / "mouth.c", SOURCE / "lib/beside.c", SOURCE / "lib/clock.c", STUBS / "esp32.c")
        subprocess.run([CC, "-std=c11", "-O1", "-shared", "-fPIC", *WARNINGS, *INCLUDES, *stub_options(folder),
                        *options, *sources, folder / "none.c", "-o", folder / "mouth.so"], check=True, timeout=120)
        return (folder / "mouth.so").read_bytes()


@pytest.fixture()
def board(request: pytest.FixtureRequest, tmp_path: Path) -> ctypes.CDLL:
    """A mouth of each test's own, for a servo without a limit of speed, or with that of the parameter."""
    library = tmp_path / "mouth.so"
    library.write_bytes(mouth(*getattr(request, "param", ["-DMOUTH_CHANGE=500"])))
    loaded = ctypes.CDLL(str(library))
    loaded.mouth_receive.restype = ctypes.c_int64
    loaded.mouth_receive.argtypes = [ctypes.c_size_t]
    loaded.mouth_playing.argtypes = [ctypes.c_int64, ctypes.c_size_t, ctypes.c_int64]
    loaded.mouth_values.argtypes = [ctypes.c_int64, ctypes.c_char_p]
    return loaded


def shown(board: ctypes.CDLL, now: int) -> Tuple[int, int]:
    values = ctypes.create_string_buffer(1)
    result = board.mouth_values(now, values)
    return result, values.raw[0]


def send(board: ctypes.CDLL, sample: int) -> List[int]:
    """Packets of a word whose sound begins with a sample; the bytes of its frames."""
    lips, rows = labial.Beside(labial.Rig.of(read(str(JAW), "jaw")), session=1), []
    for packet in lips.packets(labial.render(HELLO), sample=sample, sample_rate=RATE):
        assert board.mouth_packet(packet.data, len(packet.data)) == 0
        rows += [row[0] for row in parse(packet.data).frames]
    return rows


def test_in_step_with_the_loudspeaker(board: ctypes.CDLL) -> None:
    """Catches a clock that counts sound when it is written, not when it is heard, and a number that drops count."""
    assert board.mouth_begin(RATE) == 0 and shown(board, 0)[0] < 0
    rows = send(board, 0)
    numbers = [board.mouth_receive(BLOCK) for _ in range(16)]
    assert numbers == [k * BLOCK for k in range(16)]
    played = [k for k in range(16) if k not in (7, 8)]
    begun, written = 1000 * MS, 0
    for step in range(3 * len(played)):
        now = begun + step * FRAME + 5 * MS
        while written < len(played) and begun + (60 * written - 40) * MS <= now:  # 40 ms before it is heard
            board.mouth_playing(numbers[played[written]], BLOCK, max(begun, begun + (60 * written - 40) * MS))
            written += 1
        frame = 3 * played[step // 3] + step % 3
        if frame in (19, 20):
            frame = 27  # what is heard next waits in its first frame
        assert shown(board, now) == (OK, rows[frame]), step
    silent = begun + 3 * len(played) * FRAME
    still = [shown(board, silent + k * FRAME + 5 * MS) for k in range(HELD + EASED)]
    assert [result for result, _ in still] == [OK] * HELD + [STARVED] * EASED
    assert still[HELD - 1][1] == rows[47] and still[-1][1] == 0


def test_other_sound_and_cancel(board: ctypes.CDLL) -> None:
    """Catches lips that move to a sound of the toy's own, or after it was told to be quiet."""
    assert board.mouth_begin(RATE) == 0
    rows = send(board, 0)
    board.mouth_receive(20 * BLOCK)
    board.mouth_playing(-1, BLOCK * 4, 0)
    assert [shown(board, k * FRAME)[0] for k in range(2, 12)][-3:] == [STARVED] * 3
    board.mouth_playing(0, BLOCK * 8, 240 * MS)
    assert shown(board, 240 * MS + 10 * FRAME) == (OK, rows[10])
    board.mouth_cancel()
    eased = [shown(board, 250 * MS + (11 + k) * FRAME) for k in range(EASED)]
    assert [result for result, _ in eased] == [STARVED] * EASED and eased[-1][1] == 0
    again = send(board, 20 * BLOCK)
    assert board.mouth_receive(8 * BLOCK) == 20 * BLOCK
    board.mouth_playing(20 * BLOCK, BLOCK * 8, 2000 * MS)
    assert [shown(board, 2000 * MS + k * FRAME) for k in range(1, 20)] == [(OK, row) for row in again[1:20]]
    assert board.mouth_begin(0) < 0
    board.mouth_playing(0, BLOCK, 0)
    assert [shown(board, k * FRAME) for k in range(HELD + EASED)][-1] == (STARVED, 0), "at rest"


@pytest.mark.parametrize("board", [[]], indirect=True)
def test_the_servo_has_time(board: ctypes.CDLL) -> None:
    """Catches a servo that jumps after lost packets, when sound was dropped, or when a connection begins."""
    assert board.mouth_begin(RATE) == 0
    lips, found, now = labial.Beside(labial.Rig.of(read(str(JAW), "jaw"))), [], 0
    packets = lips.packets(labial.render(HELLO * 2), sample=0, sample_rate=RATE)
    for number, packet in enumerate(packets):
        if number % 4 != 3:
            assert board.mouth_packet(packet.data, len(packet.data)) == 0
    for step in range(150):
        now = step * FRAME
        if step in (0, 60, 90):
            board.mouth_playing(board.mouth_receive(100 * FRAME), 30 * RATE // 50, now)
        if step == 100:
            assert board.mouth_begin(2 * RATE) == 0
        found.append(shown(board, now)[1])
    steps = [abs(after - before) for before, after in zip([0, *found], found)]
    assert max(found) > 150 and max(steps) == 51 and found[-1] == 0, "100 of 500 us"


def test_the_servo_follows(board: ctypes.CDLL) -> None:
    """Catches pulses before the face at rest is known, ones outside the servo's, and a duty of another resolution."""
    duties, duty = value(board, "stub_duties", ctypes.c_uint32), value(board, "stub_duty", ctypes.c_uint32)
    now = value(board, "stub_now", ctypes.c_int64)
    board.stub_timer.restype = ctypes.c_uint64
    assert board.mouth_servo(-1) != 0 and board.mouth_servo(5) == 0
    assert board.stub_timer() == FRAME and duties.value == 0
    assert board.mouth_begin(RATE) == 0
    assert board.stub_timer() == FRAME and duties.value == 0
    rows = send(board, 0)
    board.mouth_playing(board.mouth_receive(20 * BLOCK), 20 * BLOCK, 0)
    for row in rows[:50]:
        board.stub_timer()
        pulse = 1400 + 500 * row / 255
        assert abs(duty.value * 20000 / 16384 - pulse) < 2
        now.value += FRAME
    assert duties.value == 50 and max(rows) > 200


#: What the patched lines of xiaozhi-esp32 stand in.
XIAOZHI = test_esp32_hear.AUDIO + """
#include <functional>
/* hunk 1 of application.cc */
/* hunk 2 of application.cc */

struct AudioStreamPacket {
    int sample_rate = 0;
    int frame_duration = 0;
/* hunk 1 of protocol.h */
};

enum PowerSaveLevel { PERFORMANCE };
enum AbortReason { kAbortReasonNone };
enum DeviceState { kDeviceStateSpeaking };

struct Board {
    void SetPowerSaveLevel(PowerSaveLevel level);
};

struct Protocol {
    void OnIncomingAudio(std::function<void(std::unique_ptr<AudioStreamPacket> packet)> callback);
    void OnAudioChannelOpened(std::function<void()> callback);
    void SendAbortSpeaking(AbortReason reason);
};

class AudioService {
    AudioCodec *codec_;
    void AudioOutputTask(std::unique_ptr<AudioTask> task);
    std::unique_ptr<AudioTask> OpusCodecTask(std::unique_ptr<AudioStreamPacket> packet);
};

void AudioService::AudioOutputTask(std::unique_ptr<AudioTask> task)
{
    /* hunk 2 of audio_service.cc */
}

std::unique_ptr<AudioTask> AudioService::OpusCodecTask(std::unique_ptr<AudioStreamPacket> packet)
{
    auto task = std::make_unique<AudioTask>();
    /* hunk 3 of audio_service.cc */
    return task;
}

class Application {
    std::unique_ptr<Protocol> protocol_;
    DeviceState GetDeviceState() const;
    void InitializeProtocol(AudioCodec *codec, Board &board);
    void OnJson(const cJSON *root, const cJSON *type);
    void AbortSpeaking(AbortReason reason);
};

void Application::InitializeProtocol(AudioCodec *codec, Board &board)
{
    /* hunk 3 of application.cc */
        }
    });

    /* hunk 4 of application.cc */
    });
}

void Application::OnJson(const cJSON *root, const cJSON *type)
{
    if (type) {
        if (strcmp(type->valuestring, "llm") == 0) {
            if (root) {
            /* hunk 5 of application.cc */
        }
    }
}

void Application::AbortSpeaking(AbortReason reason)
{
    if (protocol_) {
        /* hunk 6 of application.cc */
}
"""


CPP = (CXX, "-std=c++17", "-x", "c++")
#: Of each patch with C or C++: what its lines stand in, what they call, and the compiler.
PATCHED = {
    "esp32-beside/xiaozhi": (XIAOZHI, "mouth_", CPP), "esp32-hear/xiaozhi": (test_esp32_hear.XIAOZHI, "lips_", CPP),
    "esp32-hear/elatoai": (test_esp32_hear.ELATOAI, "lips_", CPP),
    "esp32-hear/openai_demo": (test_esp32_hear.OPENAI_DEMO, "lips_", (CC, "-std=c11")),
}


@pytest.mark.parametrize("patch", PATCHED)
def test_patched_lines_compile(patch: str, tmp_path: Path) -> None:
    """Catches calls that the example does not have, or with other arguments: every hunk is compiled as it is."""
    context, call, compiler = PATCHED[patch]
    file = EXAMPLE.parent / f"{patch}.patch"
    text = fill(context, hunks(file), ".c", ".cc", ".cpp", ".h")
    assert call in text
    source = tmp_path / "patched.c"
    source.write_text(text, encoding="utf-8")
    folders = (SOURCE / "include", SOURCE / "lib" / "models", file.parent)
    subprocess.run([*compiler, *WARNINGS, *(f"-I{folder}" for folder in folders), *stub_options(tmp_path), "-c",
                    str(source), "-o", os.devnull], check=True, timeout=60)


@pytest.mark.parametrize("patch", [*PATCHED, "esp32-beside/xiaozhi-server"])
def test_patches_name_their_commit_and_files(patch: str) -> None:
    """Catches a patch of nobody knows which version, and a build that lacks the files it calls."""
    file = EXAMPLE.parent / f"{patch}.patch"
    text = file.read_text(encoding="utf-8")
    found = re.match(r"Lips (?:beside the sound )?for https://github\.com/\S+, commit ([0-9a-f]{40})\.\n", text)
    page = SOURCE / "docs" / ("beside.md" if file.parent == EXAMPLE else "esp32-hear.md")
    said = page.read_text(encoding="utf-8")
    assert found and found[1][:12] in said and file.name in said
    for name in re.findall(r'"(\w+\.c)"', "\n".join(line for line in text.splitlines() if line[:1] == "+")):
        assert name in ("webrtc.c", "main.c", "openai_signaling.c") or (file.parent / name).exists()


# ---- The server ------------------------------------------------------------------------------------------------------


class Base:
    """TTSProviderBase: packets of sound go into a queue."""

    def __init__(self, config: Dict[str, Any], delete_audio_file: bool) -> None:
        self.queue: List[bytes] = []

    def handle_opus(self, opus_data: bytes) -> None:
        self.queue.append(opus_data)


class Communicate:
    """edge_tts.Communicate, which says one thing."""

    def __init__(self, text: str, boundary: str = "SentenceBoundary", **_: Any) -> None:
        self.text, self.boundary = text, boundary

    async def stream(self) -> AsyncIterator[Dict[str, Any]]:
        yield {"type": "audio", "data": b"mp3"}
        for place, word in enumerate(self.text.split()):
            yield {"type": self.boundary, "offset": 1_000_000 + place * 4_000_000, "duration": 3_500_000, "text": word}
        yield {"type": "audio", "data": b"..."}


#: What the patched lines of xiaozhi-esp32-server stand in: the part of edge.py, and of sendAudioHandle.py.
SERVER = '''\
import edge_tts
# hunk 1 of edge.py

class TTSProvider(TTSProviderBase):
    def __init__(self, config, delete_audio_file):
# hunk 2 of edge.py
            pass
# hunk 3 of edge.py
            communicate = edge_tts.Communicate(
                text,
# hunk 4 of edge.py
            if output_file:
                with open(output_file, "wb") as f:
                    async for chunk in communicate.stream():
                        if chunk["type"] == "audio":
# hunk 5 of edge.py
                audio_bytes = b""
                async for chunk in communicate.stream():
                    if chunk["type"] == "audio":
# hunk 6 of edge.py
        except OSError:
            return None


class AudioRateController:
    pass


# hunk 1 of sendAudioHandle.py

async def _do_send_audio(conn, opus_packet, flow_control):
    """
# hunk 2 of sendAudioHandle.py
    flow_control["packet_count"] = packet_index + 1
    await conn.websocket.send(opus_packet)
'''


@pytest.fixture()
def provider(monkeypatch: pytest.MonkeyPatch) -> Any:
    """The module of the patched lines, on stubs of the server's."""
    text = fill(SERVER, hunks(EXAMPLE / "xiaozhi-server.patch"), "")
    for name in ("core", "core.providers", "core.providers.tts", "core.providers.tts.base", "core.utils",
                 "core.utils.audioRateController", "edge_tts"):
        monkeypatch.setitem(sys.modules, name, types.ModuleType(name))
    sys.modules["core.providers.tts.base"].TTSProviderBase = Base
    sys.modules["core.utils.audioRateController"].AudioRateController = object
    sys.modules["edge_tts"].Communicate = Communicate
    spec = importlib.util.spec_from_file_location("core.utils.lips", EXAMPLE / "lips.py")
    lips = importlib.util.module_from_spec(spec)
    monkeypatch.setitem(sys.modules, "core.utils.lips", lips)
    spec.loader.exec_module(lips)
    found = types.ModuleType("patched")
    exec(compile(text, "patched", "exec"), found.__dict__)  # noqa: S102
    return found


@pytest.mark.parametrize("to_file", [False, True])
def test_a_server_sends_lips_with_its_sound(provider: Any, to_file: bool, tmp_path: Path) -> None:
    """Catches frames that lose their packet of sound, also behind a sentence that was interrupted."""
    voice = provider.TTSProvider({}, True)
    voice.edge_pitch = "+0Hz"
    sent: List[Any] = []

    async def send(data: Any) -> None:
        sent.append(data)

    conn = types.SimpleNamespace(websocket=types.SimpleNamespace(send=send), session_id="s")
    flow: Dict[str, int] = {}
    wanted: Dict[int, bytes] = {}
    sounds = 0
    for text, made, heard in (("Mama may pop", 24, 10), ("Bob may be happy", 30, 30)):
        said = asyncio.run(voice.text_to_speak(text, str(tmp_path / "a.mp3") if to_file else None))
        assert said == (None if to_file else b"mp3...")
        for k in range(made):
            voice.handle_opus(b"opus%d" % k)
        words = [(word, 100 + 400 * k, 450 + 400 * k) for k, word in enumerate(text.split())]
        motion = labial.render(labial.word_timings(words))
        rows = labial.Beside(EXAMPLE / "face.toml").packets(motion, sample=0, sample_rate=RATE)
        frames = b"".join(b"".join(parse(packet.data).frames) for packet in rows)
        wanted.update({sounds * 3 + k: frames[k : k + 1] for k in range(len(frames))})
        for packet in voice.queue[:heard]:
            asyncio.run(provider._do_send_audio(conn, packet, flow))
        voice.queue.clear()
        sounds += heard
    asyncio.run(provider._do_send_audio(conn, b"a sound of its own", flow))
    count, shown = 0, {}
    for message in sent:
        if isinstance(message, bytes):
            count += 1
            continue
        fields = json.loads(message)
        assert fields["type"] == "lips" and fields["session_id"] == "s"
        parsed = parse(base64.b64decode(fields["data"]))
        assert parsed.first == count * 3, "before its sound"
        shown.update({parsed.first + k: row for k, row in enumerate(parsed.frames)})
    assert count == 41 and next(item for item in sent if isinstance(item, bytes)) == b"opus0"
    assert len(shown) > 80 and all(shown[k] == wanted[k] for k in shown)
    assert set(range(110)) - set(shown) == set(range(len(shown), 110)), "without a gap"


def test_a_voice_without_times_speaks_on(provider: Any, caplog: pytest.LogCaptureFixture) -> None:
    """Catches a sentence that is lost because its lips are."""
    lips = sys.modules["core.utils.lips"]
    voice = lips.Voice()
    voice.timed([])
    assert voice.sound(b"a") == b"a" and list(voice.sound(b"a").frames) == []
    voice.timed([{"type": "WordBoundary", "offset": -1, "duration": "x", "text": 3}])
    assert "no lips" in caplog.text and list(voice.sound(b"a").frames) == []
