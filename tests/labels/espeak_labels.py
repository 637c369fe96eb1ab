"""Lists the labels that espeak-ng emits: python espeak_labels.py > labels.tsv

``espeak.tsv`` lists every IPA label that espeak-ng 1.51 reports for a phoneme in 31 voices, those of the most spoken
languages and of languages with front rounded vowels. Its columns are the label, the phoneme of Labial that it must
become (`-`: none, which is an error or a warning), and the voices whose words contain it. `-` in place of a voice marks
labels of phonemes that occur only when spoken alone: each table of phonemes of espeak-ng has many that its language
never uses.

This program lists labels and voices again. It needs libespeak-ng, its data and the package babel. It speaks
babel's names of countries, languages, scripts, currencies, cities, months and days, some 2,000 words in each
language, and each phoneme alone. The phonemes of Labial were assigned by hand, by what lips and jaw do in each sound:

- front rounded vowels round: y, ø and the diphthongs that begin so are UW, ʏ and ɵ UH, œ OW; unrounded back ones do
  not, ɯ is IH; the compressed ɯᵝ of Japanese is UH;
- a diphthong is its English relative, else its first element; one that rises to an open vowel is that vowel;
- sounds that close the lips, with or without the tongue, are P, B or M (ɸ, β, pf); sounds in which the lip touches the
  teeth are F or V (ʋ);
- trills, taps and flaps are L and D, which do not move the lips; uvular sounds count as velars;
- signs that espeak-ng writes behind or before a symbol for a variant of it (`-`, `.`, `"`, ʔ) change nothing.
"""

from __future__ import annotations

import ctypes
import re
import struct
from pathlib import Path
from typing import Dict, List, Set

from babel import Locale

#: Voice of espeak-ng -> locale whose words it reads.
VOICES = {
    "en-us": "en", "en-gb": "en", "cmn": "zh", "hi": "hi", "es": "es", "fr-fr": "fr", "ar": "ar", "bn": "bn",
    "pt": "pt_PT", "pt-br": "pt", "ru": "ru", "ur": "ur", "id": "id", "de": "de", "ja": "ja", "tr": "tr", "ko": "ko",
    "vi": "vi", "it": "it", "pl": "pl", "fa": "fa", "nl": "nl", "uk": "uk", "sv": "sv", "nb": "nb", "da": "da",
    "fi": "fi", "hu": "hu", "cs": "cs", "el": "el", "ro": "ro",
}  # fmt: skip
#: Phoneme tables whose names are not the voices'.
TABLES = {"en-gb": "en", "fr-fr": "fr", "pt": "pt-pt", "pt-br": "pt", "nb": "no"}

# Of espeak-ng's speak_lib.h.
SYNCHRONOUS, PHONEME_EVENTS, PHONEME_IPA, EVENT_PHONEME = 2, 1, 2, 7
UTF8_AND_PHONEMES = 1 | 0x100


class Event(ctypes.Structure):
    """espeak_EVENT."""

    _fields_ = [("type", ctypes.c_int), ("identifier", ctypes.c_uint), ("text_position", ctypes.c_int),
                ("length", ctypes.c_int), ("audio_position", ctypes.c_int), ("sample", ctypes.c_int),
                ("user_data", ctypes.c_void_p), ("string", ctypes.c_char * 8)]  # fmt: skip


class Voice(ctypes.Structure):
    """espeak_VOICE."""

    _fields_ = [("name", ctypes.c_char_p), ("languages", ctypes.c_char_p), ("identifier", ctypes.c_char_p),
                ("kind", ctypes.c_ubyte * 4), ("score", ctypes.c_int), ("spare", ctypes.c_void_p)]  # fmt: skip


CALLBACK = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.POINTER(ctypes.c_short), ctypes.c_int, ctypes.POINTER(Event))


class Speaker:
    """espeak-ng, asked for nothing but the labels of its phonemes."""

    def __init__(self) -> None:
        self.library = ctypes.CDLL("libespeak-ng.so.1")
        self.rate = self.library.espeak_Initialize(SYNCHRONOUS, 0, None, PHONEME_EVENTS | PHONEME_IPA)
        self.labels: List[str] = []
        self.callback = CALLBACK(self._take)
        self.library.espeak_SetSynthCallback(self.callback)
        self.library.espeak_SetParameter(1, 400, 0)  # the rate: the fastest

    def _take(self, _samples: object, _count: int, events: ctypes.Array) -> int:
        number = 0
        while events[number].type != 0:
            if events[number].type == EVENT_PHONEME:
                self.labels.append(bytes(events[number].string).split(b"\0")[0].decode(errors="replace"))
            number += 1
        return 0

    def say(self, voice: str, text: str) -> Dict[str, Set[str]]:
        """The labels of a text, by language: words of another one are spoken in that."""
        wanted = Voice(languages=voice.encode())
        if self.library.espeak_SetVoiceByProperties(ctypes.byref(wanted)) != 0:
            raise SystemExit(f"espeak-ng has no voice {voice}")
        self.labels = []
        data = text.encode()
        self.library.espeak_Synth(data, len(data) + 1, 0, 0, 0, UTF8_AND_PHONEMES, None, None)
        self.library.espeak_Synchronize()
        language, found = voice, {}
        for label in self.labels:
            switch = re.fullmatch(r"\((.*?)\)?", label)
            if switch:
                language = voice if voice.startswith(switch.group(1)) else switch.group(1)
            elif label:
                found.setdefault(language, set()).add(label)
        return found


def phoneme_tables(data: Path) -> Dict[str, List[str]]:
    """The mnemonics of every phoneme table, with those of the tables that it builds on."""
    content = (data / "phontab").read_bytes()
    at, names, tables = 4, [], {}
    for _ in range(content[0]):
        count, base = content[at], content[at + 1]
        names.append(content[at + 4 : at + 36].split(b"\0")[0].decode())
        at += 36
        table = dict(tables[names[base - 1]]) if base else {}
        for _ in range(count):
            table[content[at + 10]] = struct.unpack("4s", content[at : at + 4])[0].split(b"\0")[0].decode("latin-1")
            at += 16
        tables[names[-1]] = table
    return {name: [mnemonic for mnemonic in table.values() if mnemonic] for name, table in tables.items()}


def words(name: str) -> List[str]:
    """Names of countries, languages, scripts, currencies, cities, months and days, and numbers: some 2,000 words."""
    locale = Locale.parse(name)
    names = [*locale.territories.values(), *locale.languages.values(), *locale.scripts.values(),
             *locale.currencies.values(), *(zone.get("city", "") for zone in locale.time_zones.values()),
             *(word for part in (*locale.months["format"].values(), *locale.days["format"].values())
               for word in part.values()),
             *map(str, [*range(120), 1000, 2345, 1000000])]  # fmt: skip
    return [word.replace("[[", "").replace("]]", "") for word in names if word]


def main() -> None:
    """Prints every label and the languages whose words have it; none where only phonemes spoken alone do."""
    speaker = Speaker()
    path = ctypes.c_char_p()
    speaker.library.espeak_Info.restype = ctypes.c_char_p
    speaker.library.espeak_Info(ctypes.byref(path))
    tables = phoneme_tables(Path((path.value or b"").decode()))
    labels: Dict[str, Set[str]] = {}
    for voice, locale in VOICES.items():
        text = words(locale)
        for start in range(0, len(text), 8):
            for language, found in speaker.say(voice, ", ".join(text[start : start + 8])).items():
                for label in found:
                    labels.setdefault(label, set()).update({language} & {*VOICES})
        for mnemonic in tables[TABLES.get(voice, voice)]:
            for label in speaker.say(voice, f"[[{mnemonic}]]").get(voice, ()):
                labels.setdefault(label, set())
    for label in sorted(labels):
        print(label, " ".join(voice for voice in VOICES if voice in labels[label]) or "-", sep="\t")


if __name__ == "__main__":
    main()
