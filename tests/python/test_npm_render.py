"""The npm package against labial-say: the same timings, the same frames and weights."""

from __future__ import annotations

import json
import os
import random
import shutil
import subprocess
from pathlib import Path
from typing import Any, List

import pytest

from labial.corpus.phonesets import ARPABET
from labial.rig import FACES
from npm import MISSING, package

SAY = os.environ.get("LABIAL_SAY", "")
NODE = shutil.which("node")
OUTPUTS = ("faps", *FACES)

#: Reads a list of .lab texts; for each and each output the frames of `labial.render()`.
SCRIPT = r"""
const [, url, outputs] = process.argv;
const { Labial } = await import(url);
const laughter = () => import(url.replace(/\/index\.js$/, "-laughter/index.js"));
let input = "";
for await (const piece of process.stdin) input += piece;
const labial = await Labial.load({ laughter });
await labial.laughter();
process.stdout.write(JSON.stringify(JSON.parse(input).map((text) => outputs.split(" ").map((output) => {
    const track = labial.render(labial.read(text), { output, unknown: "nearest" });
    return Array.from(track, (frame) => (output === "faps" ? Array.from(frame) : frame));
}))));
"""


def drawn(rng: random.Random) -> str:
    """Lines of a .lab: phonemes of every set, pauses, laughs, unknown labels, gaps, times that are no whole frames."""
    labels = [*ARPABET, "ˈɑː", "tʃ", "øː", "sil", "xyz", "<unk>", "<laugh>", "<laugh:0.9>"]
    end, rows = 0.0, []
    for _ in range(rng.randrange(1, 60)):
        start = end + rng.choice([0.0, 0.0, 0.0, 0.0004, 0.1234, 0.6])
        end = start + rng.choice([0.0, 0.0101, 0.05, rng.random() / 3, 1.7])
        rows.append(f"{start:.4f} {end:.4f} {rng.choice(labels)}\n")
    return "".join(rows)


def said(text: str, output: str) -> List[Any]:
    """What labial-say writes of each frame."""
    form = "csv" if output == "faps" else output
    done = subprocess.run([SAY, "--to", form], input=text, capture_output=True, encoding="utf-8", check=True,
                          timeout=60)
    lines = done.stdout.splitlines()
    if output == "faps":
        return [[int(value) for value in line.split(",")[1:]] for line in lines[1:]]
    return [json.loads(line)[output] for line in lines]


@pytest.mark.skipif(not SAY, reason="LABIAL_SAY does not name the built labial-say")
@pytest.mark.skipif(not NODE, reason="needs node: install the Debian package nodejs")
@pytest.mark.skipif(bool(MISSING), reason=MISSING)
def test_frames_are_those_of_labial_say(tmp_path: Path) -> None:
    """Catches times that are rounded otherwise, gaps that close, a laugh of another seed, weights of another name."""
    rng = random.Random(5)
    texts = [drawn(rng) for _ in range(25)]
    url = (package(tmp_path / "npm") / "index.js").as_uri()
    done = subprocess.run([str(NODE), "--input-type=module", "-e", SCRIPT, url, " ".join(OUTPUTS)],
                          input=json.dumps(texts), capture_output=True, encoding="utf-8", check=False, timeout=120)
    assert done.returncode == 0, done.stderr
    frames = 0
    for text, tracks in zip(texts, json.loads(done.stdout)):
        for output, track in zip(OUTPUTS, tracks):
            assert track == said(text, output), (output, text)
            frames += len(track)
    assert frames > 10000
