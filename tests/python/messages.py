"""Messages of speech services, for tests of their readers: the samples of services.json, messages about words, drawn
at random, and a service that sends them."""

from __future__ import annotations

import base64
import json
import random
import struct
import threading
import time
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, Dict, Iterator, List, NamedTuple, Tuple

from websockets.exceptions import ConnectionClosed
from websockets.sync.server import ServerConnection, serve

#: What stands in texts.
PIECES = ["Maybe", "people", "hum.", "2024", "$5.50", "1,234", "[laughs]", "<b>", "</b>", "[", "]", "Zürich", "it's",
          "Kokoro!", "HTTP", "U.S.", "naïve", "日本語", "👍", "—", "-", "…", "iPhone", "", "x\u0000y", "\ud800",
          "\U0010ffff", "e.g.", "twenty-one", "don’t", "a" * 300, "\u00a0", "\u0085", "a\u3000b", "ﬁ", "ß", "[Click",
          "here](a.b/c)", "[1](x)", "[a][2]",
          "妈妈爸爸，朋友,我用Python。", "今日はパンを食べました！", "すごーいバナナ・マンゴー", "แม่และพ่อ", "o" * 130]
#: The services, as `labial timings --from` calls them.
NAMES = ("words", "azure", "cartesia", "kokoro-fastapi", "fish", "minimax", "polly", "google", "elevenlabs", "soniox",
         "inworld", "hume")  # fmt: skip


def drawn_messages(rng: random.Random) -> Tuple[str, str]:
    """Messages of any service about words, mostly well-formed, in any of their spellings."""
    service = rng.choice(NAMES)
    messages: List[Any] = []
    moment = 0.0

    def texts() -> List[Tuple[str, float, float]]:
        nonlocal moment
        moment = rng.choice([moment, moment, 0.0])
        found = []
        for _ in range(rng.randrange(0, 6)):
            start = moment + rng.choice([0, 0, 0.0625, 0.1, 0.15, 0.4, rng.random()])  # half a millisecond, too
            moment = start + rng.choice([0, 0.0625, 0.1, 0.35, rng.random() / 2])
            found.append((rng.choice(PIECES), start, moment))
        return found

    def plain(word: str) -> List[Dict[str, Any]]:
        return [{word: text, "start": start, "end": end} for text, start, end in texts()]

    def lists(names: Tuple[str, str, str], spelt: bool, scale: float = 1, lengths: bool = False) -> Dict[str, Any]:
        found = texts()
        if spelt:
            found = [(character, start, end) for text, start, end in found for character in text + " "]
        ends = [scale * (end - start if lengths else end) for _, start, end in found]
        return dict(zip(names, ([text for text, _, _ in found], [scale * start for _, start, _ in found], ends)))

    for _ in range(rng.randrange(1, 5)):
        if service == "words":
            messages += plain(rng.choice(["word", "text"]))
        elif service == "azure":
            ticks = rng.choice(["audio_offset", "AudioOffset", "offset", "privAudioOffset"])
            messages += [{ticks: round(1e7 * start), "text": text, "duration": round(1e7 * (end - start)),
                          **rng.choice([{}, {"type": "WordBoundary"}, {"boundary_type": "Punctuation"},
                                        {"type": "SentenceBoundary"}])} for text, start, end in texts()]
        elif service == "polly":
            messages += [{"time": round(1000 * start), "type": rng.choice(["word", "word", "sentence"]), "value": text}
                         for text, start, _ in texts()]
        elif service == "google":
            messages += [{"markName": text, "timeSeconds": start} for text, start, _ in texts()]
        elif service == "cartesia":
            stamps = lists(("words", "start", "end"), False)
            messages += [{"type": "timestamps", "context_id": "c", "word_timestamps": stamps}]
            if rng.random() < 0.3:
                messages += [{"phoneme_timestamps": lists(("phonemes", "start", "end"), False)}]
        elif service == "kokoro-fastapi":
            messages += [{"audio_format": "wav", "timestamps": [
                {"word": text, "start_time": start, "end_time": end} for text, start, end in texts()]}]
        elif service == "fish":
            messages += [{"chunk_seq": rng.randrange(4), "chunk_audio_offset_sec": rng.choice([0, 1.5]),
                          "alignment": {"segments": plain("text")}}]
        elif service == "minimax":
            place, parts = 0, []
            for text, start, end in texts():
                parts.append({"word": text, "time_begin": 1000 * start, "time_end": 1000 * end, "word_begin": place,
                              "word_end": place + len(text)})
                place += len(text) + rng.choice([0, 0, 1])
            messages += [{"text": "", "timestamped_words": parts}]
        elif service == "elevenlabs":
            http = ("characters", "character_start_times_seconds", "character_end_times_seconds")
            socket = ("chars", "charStartTimesMs", rng.choice(["charDurationsMs", "charsDurationsMs"]))
            one = lists(socket, True, 1000, True) if rng.random() < 0.5 else lists(http, True)
            key = rng.choice(["alignment", "normalizedAlignment"])
            messages += [{"audio": "", key: rng.choice([one, one, None, {}])}]
        elif service == "soniox":
            one = lists(("characters", "starts", "ends"), rng.random() < 0.5)
            messages += [rng.choice([{"stream_id": "s", **one}, {"stream_id": "s", "timestamps": one}])]
        elif service == "inworld":
            words = lists(("words", "wordStartTimeSeconds", "wordEndTimeSeconds"), False)
            phones = [{"phoneSymbol": rng.choice(["m", "AH0", "eɪ", " b"]), "startTimeSeconds": start,
                       "durationSeconds": end - start} for _, start, end in texts()]
            spelt = lists(("characters", "characterStartTimeSeconds", "characterEndTimeSeconds"), True)
            info = rng.choice([{"wordAlignment": words}, {"characterAlignment": spelt},
                               {"wordAlignment": {**words, "phoneticDetails": [{"phones": phones}]}}])
            messages += [rng.choice([{"timestampInfo": info}, {"result": {"timestampInfo": info}}])]
        else:
            kind = rng.choice(["word", "word", "phoneme"])
            marks = [{"text": text, "type": kind, "time": {"begin": round(1000 * start), "end": round(1000 * end)}}
                      for text, start, end in texts()]
            messages += [{"type": "timestamp", "snippet_id": "a", "timestamp": mark} for mark in marks]
    if rng.random() < 0.2:
        spoil(rng, messages)
    if rng.random() < 0.3 and len(messages) > 1:
        return service, "\n".join(map(json.dumps, messages))
    text = json.dumps(messages, ensure_ascii=False)
    return service, json.dumps(messages) if "\ud800" in text else text


def spoil(rng: random.Random, value: Any) -> None:
    """Replaces something in a message by something that may not stand there."""
    while True:
        keys = list(value) if isinstance(value, dict) else range(len(value)) if isinstance(value, list) else []
        if not keys:
            return
        key = rng.choice(list(keys))
        if isinstance(value[key], (dict, list)) and value[key] and rng.random() < 0.7:
            value = value[key]
            continue
        if isinstance(value, dict) and rng.random() < 0.3:
            del value[key]
        else:
            value[key] = rng.choice([None, -1, 1e9, 1e307, "x", True, [], {}, [1], {"a": 1}, 7, "__proto__"])
        return


class Sample(NamedTuple):
    """Messages of a service, and the phonemes that they tell."""

    service: str
    messages: List[Dict[str, Any]]
    phonemes: str

    @property
    def text(self) -> str:
        """The messages as a file has them, one on each line."""
        return "".join(json.dumps(message, ensure_ascii=False) + "\n" for message in self.messages)


#: The samples of services.json, by their names.
SAMPLES = {item["name"]: Sample(item["service"], item["messages"], item.get("phonemes", "SIL M EY B IY SIL G OW"))
           for item in json.loads(Path(__file__).with_name("services.json").read_text(encoding="utf-8"))["samples"]}


# ---- A stand-in for ElevenLabs' stream of sound and characters over a WebSocket, on this machine ---------------------


#: Samples per second of its sound.
RATE = 16000


def answers(text: str, pace: int = 70) -> List[Dict[str, Any]]:
    """The answers to a text: for each sentence a message with its sound, 16 bits in base64, a hum as long as its
    characters, each of which lasts `pace` milliseconds; times begin at 0 in each, and the last one says ``isFinal``."""
    found = []
    for sentence in (f"{part.strip()}." for part in text.split(".") if part.strip()):
        characters = [*sentence, " "]
        length = pace * len(characters)
        samples = [round(3000 * ((n * 110 // RATE) % 2 * 2 - 1)) for n in range(RATE * length // 1000)]
        alignment = {"chars": characters, "charStartTimesMs": [pace * n for n in range(len(characters))],
                     "charsDurationsMs": [pace] * len(characters)}
        found.append({"audio": base64.b64encode(struct.pack(f"<{len(samples)}h", *samples)).decode(),
                      "isFinal": None, "alignment": alignment, "normalizedAlignment": alignment})
    return [*found, {"audio": None, "isFinal": True, "alignment": None, "normalizedAlignment": None}]


@contextmanager
def elevenlabs(wait: float = 0.25) -> Iterator[str]:
    """Serves any number of clients, `wait` seconds before each message; the address. A client connects, sends its text
    in pieces, as JSON, and an empty text at the end."""
    def speak(client: ServerConnection) -> None:
        with suppress(ConnectionClosed):  # it went away
            for message in answers("".join(iter(lambda: json.loads(client.recv())["text"], ""))):
                time.sleep(wait)
                client.send(json.dumps(message))

    with serve(speak, "127.0.0.1", 0, compression=None) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"ws://127.0.0.1:{server.socket.getsockname()[1]}"
