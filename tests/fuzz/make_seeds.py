"""Makes the seeds of the fuzz targets below ``seeds/`` anew, after a change of a model, of ``streams.txt`` or a target.

    python3 tests/fuzz/make_seeds.py [FOLDER]

needs numpy. The seeds of ``fuzz_timings`` are files that were written by hand, which stay as they are.
"""

from __future__ import annotations

import csv
import struct
import sys
from pathlib import Path
from typing import Dict, Iterator, List

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path[:0] = [str(HERE.parent / "conformance"), str(ROOT / "export")]

from labial import emit  # noqa: E402
from labial.aliases import SPEECH_LABELS  # noqa: E402
from labial.quantise import ExportedModel  # noqa: E402
from regenerate import bundled_models  # noqa: E402
from scripts import MODELS, Part, Script, read, read_frames  # noqa: E402

#: The first byte of a stream on the bundled models (fuzz_stream.c), and the calls that follow it.
BUNDLED, PUSH_LONG, PUSH_ANY, TICKS, USE, END, CANCEL, RESTART = 2, 4, 5 | 1 << 4, 9, 12, 13 | 128, 14 | 224, 15
#: The index of a model among those that the stream may use.
MODEL = {word: index for index, word in enumerate(MODELS)}
#: Frames per second of the bundled models, and ticks after which a part of a stream has been played out.
RATE, DELAY = 50, 8
#: How many labels a seed has, each ended by this byte.
LABELS, LABEL_END = 8, b"\xff"
#: Outputs and frames of the rig's seed.
OUTPUTS, FRAMES = 4, 24


def ticks(count: int) -> bytes:
    """So many ticks; pauses of an hour are played in part."""
    count = min(count, 1000)
    return b"".join(bytes([TICKS, min(255, count - done)]) for done in range(0, count, 255))


def part_calls(part: Part) -> Iterator[bytes]:
    """The calls of a part of a stream, each phoneme being followed by as many ticks as it has frames."""
    for push in part.pushes:
        yield bytes([USE | MODEL[push.model] << 4])
        if push.milliseconds < 65536:
            yield struct.pack(">BBH", PUSH_LONG, push.phoneme, push.milliseconds)
        else:
            yield struct.pack(">BBI", PUSH_ANY, push.phoneme, push.milliseconds)
        yield ticks(push.milliseconds * RATE // 1000)
    for _, milliseconds in ((part.cancel,) if part.cancel else ()) + part.again:
        yield bytes([CANCEL]) + milliseconds.to_bytes(3, "big") + ticks(3)
    yield bytes([END]) + ticks(20 * DELAY) + bytes([RESTART])


def stream_seed(script: Script) -> bytes:
    """A conformance stream for fuzz_stream.c."""
    return bytes([BUNDLED]) + b"".join(call for part in script.parts for call in part_calls(part))


def rig_seed() -> bytes:
    """Four outputs that are within their ranges, two with a slew limit, one with a deadband, two that say where they
    are closed, two with a limit of acceleration, a curve for two, and frames of a sentence (fuzz_rig.c)."""
    frames = read_frames((ROOT / "tests" / "conformance" / "frames.txt").read_text(encoding="ascii"))["sentence"]
    outputs = b"".join(
        struct.pack("<13hBB8i", *[4096 if k == channel else 0 for k in range(13)], channel % 2, channel // 2, 13430,
                    300, 260, 380, 25 * (channel % 2), 320 * (channel // 2), 3 * (channel == 3), 8 * (channel > 1))
        for channel in range(OUTPUTS))
    curve = struct.pack("<H2x24i", 2, 260, 260, 1 << 19, 320, 290, 3 << 19, *[0] * 18)
    values = struct.pack("<8i", *[300] * OUTPUTS, *[0] * OUTPUTS)
    return (outputs + curve + values + bytes([6, 31, 0, 0])
            + b"".join(struct.pack("<13h", *row) for row in frames[:FRAMES]))


def label_seeds() -> Dict[str, bytes]:
    """The labels of espeak-ng's voices and the aliases of the phone sets, some to a file (fuzz_names.c)."""
    with (ROOT / "tests" / "labels" / "espeak.tsv").open(encoding="utf-8", newline="") as file:
        labels = [row["label"] for row in csv.DictReader(file, delimiter="\t", quoting=csv.QUOTE_NONE)]
    labels += sorted({label for known in SPEECH_LABELS.values() for label in known})
    seeds = {}
    for number, start in enumerate(range(0, len(labels), LABELS)):
        seeds[f"labels_{number:02}"] = LABEL_END.join(text.encode() for text in labels[start:start + LABELS])
    return seeds


def blob_seeds(models: Dict[str, ExportedModel]) -> Dict[str, bytes]:
    """The bundled models as binary ones, and each sound model of fuzz_blob.c without a change."""
    seeds = {MODELS[word]: b"\0" + emit.blob(model) for word, model in models.items()}
    seeds.update({f"sound_{choice}": bytes([2 + 4 * choice]) for choice in range(5)})
    return seeds


def seeds() -> Dict[str, bytes]:
    """The seeds by their paths below ``seeds/``."""
    models = bundled_models()
    scripts: List[Script] = read(ROOT / "tests" / "conformance" / "streams.txt", models)
    targets = {
        "fuzz_stream": {script.name: stream_seed(script) for script in scripts},
        "fuzz_blob": blob_seeds(models),
        "fuzz_rig": {"sentence": rig_seed()},
        "fuzz_names": label_seeds(),
    }
    return {f"{target}/{name}": data for target, files in targets.items() for name, data in files.items()}


def main() -> int:
    """Runs the command; returns its exit status."""
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else HERE / "seeds"
    for name, data in seeds().items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
    return 0


if __name__ == "__main__":
    sys.exit(main())
