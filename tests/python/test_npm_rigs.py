"""Faces of one's own in the npm package: `labial rig --json` and `labial.rig()`, against Python's run-time."""

from __future__ import annotations

import json
import random
import shutil
import subprocess
from pathlib import Path
from typing import Any, Dict, List

import pytest

import labial
from labial.__main__ import main
from labial.files.faps import CHANNELS, FAP_NAMES
from labial.rig import FACES, description_of
from npm import MISSING, package
from runtime import needs_runtime

NODE = shutil.which("node")

#: Reads rigs, as text, and frames; the weights of each rig in each frame, from convert() and from a stream.
SCRIPT = r"""
const [, url] = process.argv;
const { Labial } = await import(url);
let input = "";
for await (const piece of process.stdin) input += piece;
const { rigs, frames, wrong } = JSON.parse(input);
const labial = await Labial.load();
const converted = rigs.map((text) => labial.rig(text)).map((rig) => frames.map((faps) => labial.convert(faps, rig)));
const segments = [{ start: 0, end: 0.3, label: "AA" }, { start: 0.3, end: 0.4, label: "m" }];
const mine = labial.rig(JSON.parse(rigs[0]));
const track = labial.render(segments, { output: mine });
const stream = labial.stream({ output: mine });
stream.push("AA", 300);
stream.push("m", 100);
stream.end();
const refused = wrong.map((text) => {
    try {
        labial.rig(text);
        return "";
    } catch (error) {
        return error.message;
    }
});
process.stdout.write(JSON.stringify({
    converted, refused, faps: Array.from(track.faps), track: [...track], between: track.at(0.1), stream: [...stream],
    names: [mine.name, mine.outputs],
}));
"""


def description(rng: random.Random) -> str:
    """A face of weights that nobody has."""
    lines = ['unit = "weight"']
    for number in range(rng.randrange(1, 9)):
        mixed = ", ".join(f"{name} = {rng.uniform(-1, 1):.3f}" for name in rng.sample(FAP_NAMES, rng.randrange(1, 6)))
        lines += [f"[output.shape_{number}]", f"from = {{ {mixed} }}", f"neutral = {rng.uniform(-0.3, 0.3):.4f}",
                  f"full = {rng.choice([0, 1])}", f"reach = {rng.uniform(80, 900):.1f}", "minimum = 0",
                  f"maximum = {rng.uniform(0.3, 1):.2f}"]  # fmt: skip
        if rng.random() < 0.3:
            lines += ["closed = 0.1"]
        if number % 3 == 1:
            middle = [f"[{at}, {10 * at + (number + at) % 1:.2f}]" for at in (0.2, 0.4, 0.7)[: number % 4]]
            lines += [f"curve = [{', '.join(['[-0.5, -5]', *middle, '[1.1, 12.5]'])}]"]
    return "\n".join(lines) + "\n"


def ran(url: Path, given: Dict[str, Any]) -> Any:
    """What the script prints."""
    done = subprocess.run([str(NODE), "--input-type=module", "-e", SCRIPT, str(url)], input=json.dumps(given),
                          capture_output=True, encoding="utf-8", timeout=120, check=False)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@pytest.mark.slow
@needs_runtime
@pytest.mark.skipif(bool(MISSING), reason=MISSING)
@pytest.mark.skipif(not NODE, reason="needs node: install the Debian package nodejs")
def test_weights_are_those_of_python(tmp_path: Path) -> None:
    """Every rig, built-in or random, in random frames and the largest; and files that are not whole are refused."""
    rng = random.Random(20)
    paths = [description_of(name) for name in FACES]
    for number in range(20):
        paths.append(tmp_path / f"face{number}.toml")
        paths[-1].write_text(description(rng))
    for path in paths:
        assert main(["rig", str(path), "--json", "-o", str(tmp_path / "web")]) == 0
    texts = [(tmp_path / "web" / f"{path.stem}.json").read_text() for path in paths]
    frames: List[List[int]] = [[rng.randrange(-700, 700) for _ in range(CHANNELS)] for _ in range(60)]
    frames += [[0] * CHANNELS, [32767] * CHANNELS, [-32768] * CHANNELS]
    first = json.loads(texts[0])
    some = next(iter(first["outputs"]))

    def changed(**values: Any) -> str:
        return json.dumps({**first, "outputs": {some: {**first["outputs"][some], **values}}})

    wrong = ["{}", "3", "null", json.dumps({**first, "outputs": {}}), changed(weights=[1] * 12),
             changed(weights=[40000] + [0] * 12), changed(gain=0.5), changed(gain="1"), changed(neutral=None),
             changed(minimum=5, maximum=4), changed(invert=2), changed(contact=-1), changed(closed=7),
             changed(curve=3), changed(curve=[[1, 2]]), changed(curve=[[0, 0, 2**25 + 1]]),
             changed(curve=[[0, 0, "1"]]),
             changed(curve=[[5, 0, 1], [5, 0, 1]]), changed(curve=[[place, 0, 1] for place in range(9)]),
             json.dumps({**first, "outputs": {some: None}})]  # fmt: skip
    found = ran(package(tmp_path / "npm") / "index.js", {"rigs": texts, "frames": frames, "wrong": wrong})
    for path, weights in zip(paths, found["converted"]):
        rig = labial.Rig(path)
        assert weights == [rig.apply(frame) for frame in frames], path.name
    assert all(found["refused"]) and len(found["refused"]) == len(wrong), found["refused"]
    rig = labial.Rig(paths[0])
    faps = [found["faps"][at : at + CHANNELS] for at in range(0, len(found["faps"]), CHANNELS)]
    assert found["track"] == found["stream"] == [rig.apply(frame) for frame in faps] and len(faps) == 20
    assert found["between"] == found["track"][5] and found["names"] == [paths[0].stem, list(rig.outputs)]


@pytest.mark.parametrize(("text", "message"), [
    ('unit = "us"\n[output.jaw]\nfrom = "jaw"\nneutral = 1400\nfull = 1900\n', "unit: --json is for faces of weights"),
    ('unit = "weight"\n[output.jaw]\nfrom = "jaw"\nneutral = 0\nfull = 1\nslew = 0.1\n', "output.jaw.slew: is for"),
    ('unit = "weight"\n[output.jaw]\nfrom = "jaw"\nneutral = 0\nfull = 1\nacceleration = 0.05\n', "jaw.acceleration"),
])  # fmt: skip
def test_servos_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str], text: str, message: str) -> None:
    """One line that names the file, and no file."""
    (tmp_path / "face.toml").write_text(text)
    assert main(["rig", str(tmp_path / "face.toml"), "--json", "-o", str(tmp_path)]) == 1
    error = capsys.readouterr().err
    assert message in error and "face.toml" in error and not (tmp_path / "face.json").exists()
