"""Hearing in the npm package against the exporter's integers: the same sound, the same frames and stretches."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path

import hears
import numpy as np
import pytest

from labial.hearing import integer
from labial.hearing.model import load
from labial.hearing.quantise import quantise
from npm import MISSING, package
from packages import SOURCE
from test_hearing import voice

NODE = shutil.which("node")

#: Reads a list of { sampleRate, channels, model, blocks }; of each the frames, the stretches and the latency.
SCRIPT = r"""
const [, url] = process.argv;
const { Labial } = await import(url);
let input = "";
for await (const piece of process.stdin) input += piece;
const labial = await Labial.load({ hearing: () => import(url.replace(/\/index\.js$/, "-hearing/index.js")) });
const found = [];
for (const { blocks, ...options } of JSON.parse(input)) {
    const hearing = await labial.hear(null, options);
    for (const block of blocks) hearing.push(Int16Array.from(block));
    hearing.end();
    found.push([Array.from(hearing, (faps) => Array.from(faps)), hearing.segments(), hearing.latency]);
    hearing.close();
}
process.stdout.write(JSON.stringify(found));
"""


@pytest.mark.skipif(not NODE, reason="needs node: install the Debian package nodejs")
@pytest.mark.skipif(bool(MISSING), reason=MISSING)
def test_frames_are_the_exporters(tmp_path: Path) -> None:
    """Catches another model in the package, a rate that is converted otherwise, and frames that are lost between
    blocks."""
    rng = np.random.default_rng(3)
    sounds, asked = [], []
    for number, rate in enumerate((8000, 12000, 16000, 22050, 24000, 32000, 44100, 48000)):
        sound = voice(1.7, number, rate)
        if number % 2:
            sound = np.stack([sound, -(sound // 3)], axis=1)
        model = ("small", "large")[number // 2 % 2]
        cuts = np.sort(rng.integers(0, len(sound), 12))
        sounds.append((model, rate, sound))
        asked.append({"sampleRate": rate, "channels": sound.ndim, "model": model,
                      "blocks": [block.ravel().tolist() for block in np.split(sound, cuts)]})  # fmt: skip
    url = (package(tmp_path / "npm") / "index.js").as_uri()
    done = subprocess.run([str(NODE), "--input-type=module", "-e", SCRIPT, url], input=json.dumps(asked),
                          capture_output=True, encoding="utf-8", check=False, timeout=120)  # fmt: skip
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert len(found) == len(sounds)
    for (model, rate, sound), (frames, segments, latency) in zip(sounds, found):
        trained = load(SOURCE / "export" / "models" / f"hear_{model}.npz")
        heard = integer.delivered(quantise(trained, f"hear_{model}"), sound, rate)
        assert frames == heard.faps.tolist(), (model, rate)
        rows = [
            (trained.classes[shown], first / 50, (first + length) / 50)
            for shown, first, length in hears.stretches(heard.scores)
        ]
        assert [row["label"] for row in segments] == [label for label, _, _ in rows]
        assert [row["start"] for row in segments] == pytest.approx([start for _, start, _ in rows])
        assert [row["end"] for row in segments] == pytest.approx([end for _, _, end in rows])
        assert 0.1 < latency < 0.2
