"""Renders heads in sentences and tells whether their sounds can be told apart.

    readable.py THREE HEAD.glb ... [--sheet SHEET.webp]

prints for each head and method the share of sounds that a nearest-picture rule names right, of nine (docs/avatar.md):
oo, oh, ee, ah, m, f, th, s, sh, in the middle of up to TOKENS phonemes of each, from sentences.flite of the tests. The
rule compares pictures of PIXELS by PIXELS around the mouth. *Learned*: with the mean picture of each sound in the same
method's motion, of every second token, the others being judged. *Own*: with the head's own visemes at full. Methods are
Labial's rigs, with the sounds and by FAPs alone; the head's own visemes, each for its phoneme with ramps of 80 ms; and
TalkingHead's animation of them (its version 1.7: from two thirds of a phoneme's length before it to half of it behind,
.6 at the middle, .9 in PP and FF). --sheet writes a picture of heads by sounds in words.

THREE is the folder of the npm package three. It needs chromium, numpy, and the exporter with its run-time.
"""

from __future__ import annotations

import argparse
import base64
import json
import shutil
import sys
import tempfile
from pathlib import Path
from typing import Any, Dict, List, Mapping, Optional, Sequence, Tuple

import numpy as np

from labial.corpus.phonesets import SPEECH
from labial.errors import LabialError
from labial.fit.avatar import read as read_avatar
from labial.fit.kinds import shapes_for
from labial.fit.landmarks import read_head
from labial.fit.solve import Motion, read_sentences
from labial.rig.animation import face, outputs
from labial.runtime.stream import Stream
from labial.tables.visemes import ONE, VISEME_OF

TESTS = Path(__file__).resolve().parent.parent / "tests" / "python"
sys.path.insert(0, str(TESTS))
from browser import THREE_D, Browser, served  # noqa: E402

TOKENS, PIXELS, FPS = 12, 48, 50
#: Pictures that are asked for at a time: a slow machine answers within a minute.
_PIECE = 10
#: The sounds that must be told apart, and their visemes.
SOUNDS: Mapping[str, str] = {"oo": "ou", "oh": "oh", "ee": "ih", "ah": "aa", "m": "PP", "f": "FF", "th": "TH",
                             "s": "SS", "sh": "CH"}
#: The sheet: words, their phonemes, and which of them are drawn under which name.
WORDS: Sequence[Tuple[str, Mapping[int, str]]] = (
    ("M AA M AA", {0: "m", 1: "ah"}), ("F AE N", {0: "f"}), ("TH IH N", {0: "th"}), ("S IY", {0: "s", 1: "ee"}),
    ("SH UW", {0: "sh", 1: "oo"}), ("N OW", {1: "oh"}),
)
ORDER = ("rest", *("m f th s sh ah ee oh oo".split()))

PAGE = """<!doctype html><link rel="icon" href="data:,"><script type="importmap">
{"imports": {"three": "./three/build/three.module.js", "three/addons/": "./three/examples/jsm/"}}</script>
<script type="module">
import * as THREE from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
const renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
const scene = new THREE.Scene();
scene.background = new THREE.Color(0xd8dde4);
const light = new THREE.DirectionalLight(0xffffff, 2.2);
scene.add(light, new THREE.HemisphereLight(0xffffff, 0x888888, 1.6));
const camera = new THREE.PerspectiveCamera(20, 1);
const canvas = document.createElement("canvas");
let model = null;
const all = (wanted) => {
    const found = [];
    model.traverse((one) => { if (wanted(one)) found.push(one); });
    return found;
};
/** Loads a head and looks at its mouth: vertices of the mesh `name` at the nose, the inner lips. */
window.load = async (address, name, vertices, back) => {
    if (model) scene.remove(model);
    model = (await new GLTFLoader().loadAsync(address)).scene;
    scene.add(model);
    model.updateMatrixWorld(true);
    const moving = all((one) => one.morphTargetDictionary);
    for (const mesh of moving) mesh.frustumCulled = false;
    for (const mesh of all((one) => one.isMesh && !one.morphTargetDictionary)) mesh.visible = false; // clothes, hair
    const named = moving.filter((one) => one.name === name || one.parent.name === name);
    const [nose, upper, lower] = vertices.map((vertex) => {
        for (const mesh of named.length ? named : moving) {
            const count = mesh.geometry.attributes.position.count;
            const place = new THREE.Vector3();
            if (vertex < count) return mesh.getVertexPosition(vertex, place).applyMatrix4(mesh.matrixWorld);
            vertex -= count;
        }
    });
    const high = Math.abs(nose.y - upper.y);
    const away = (back ? -1 : 1) * 2.4 * high / Math.tan(Math.PI / 18);
    camera.position.set(nose.x, (upper.y + lower.y) / 2 - 0.3 * high, upper.z + away);
    camera.near = Math.abs(away) / 4;
    camera.far = 4 * Math.abs(away);
    camera.lookAt(nose.x, camera.position.y, upper.z);
    camera.updateProjectionMatrix();
    light.position.set(back ? -0.4 : 0.4, 1.2, back ? -2 : 2);
};
const draw = (weights, size) => {
    renderer.setSize(size, size, false);
    for (const mesh of all((one) => one.morphTargetDictionary)) {
        mesh.morphTargetInfluences.fill(0);
        for (const [name, weight] of Object.entries(weights)) {
            const place = mesh.morphTargetDictionary[name];
            if (place !== undefined) mesh.morphTargetInfluences[place] = weight;
        }
    }
    renderer.render(scene, camera);
};
/** The pixels of each of these weights, RGB, as base64. */
window.pictures = (list, size) => list.map((weights) => {
    draw(weights, size);
    canvas.width = canvas.height = size;
    const context = canvas.getContext("2d", { willReadFrequently: true });
    context.drawImage(renderer.domElement, 0, 0);
    const pixels = context.getImageData(0, 0, size, size).data.filter((_, i) => i % 4 < 3);
    return btoa(String.fromCharCode(...pixels));
});
const sheet = document.createElement("canvas");
window.begin = (rows, names, size) => {
    sheet.width = 90 + names.length * size;
    sheet.height = 20 + rows * size;
    const context = sheet.getContext("2d");
    context.fillStyle = "white";
    context.fillRect(0, 0, sheet.width, sheet.height);
    context.fillStyle = "black";
    context.font = "14px sans-serif";
    names.forEach((name, i) => context.fillText(name, 90 + (i + 0.5) * size - 4 * name.length, 15));
};
window.row = (row, name, list, size) => {
    const context = sheet.getContext("2d");
    name.split(" ").forEach((word, i) => context.fillText(word, 4, 20 + (row + 0.4) * size + 16 * i));
    list.forEach((weights, i) => {
        draw(weights, size);
        context.drawImage(renderer.domElement, 90 + i * size, 20 + row * size);
    });
};
window.picture = () => sheet.toDataURL("image/webp", 0.8);
window.ready = true;
</script>"""


class Stage:
    def __init__(self, page: Any, folder: Path, path: str) -> None:
        """Loads the head of the file `path`; `folder` is served."""
        found = read_head(read_avatar(path), path, {})
        self.name, self.head, self.mesh = Path(path).stem, found.head, found.mesh
        self._page = page
        shutil.copy(path, folder / "head.glb")
        vertices = [int(found.vertices[point]) for point in ("nose", "inner_upper", "inner_lower")]
        page.evaluate(f"load('head.glb?{self.name}', {json.dumps(self.mesh.name)}, {vertices}, "
                      f"{json.dumps(path.endswith('.vrm'))})")

    def shapes(self, kind: str) -> Dict[str, str]:
        """The head's shape of each output of a rig; empty for a head of another kind."""
        found = shapes_for(self.head, kind, [output.name for output in face(kind).outputs])
        return found if len(found) >= {"arkit": 10, "oculus": 10, "vrm": 5}[kind] else {}

    def on(self, weights: Mapping[str, float], shapes: Mapping[str, str]) -> Dict[str, float]:
        """Weights by the names of the mesh's own shapes, of which a file's expressions may have several."""
        total: Dict[str, float] = {}
        for name, value in {shapes[name]: float(value) for name, value in weights.items() if name in shapes}.items():
            for part, share in self.mesh.parts.get(name, [(name, 1.0)]):
                total[part] = total.get(part, 0.0) + share * value
        return total

    def pictures(self, weights: Sequence[Mapping[str, float]]) -> np.ndarray:
        """(n, 3 PIXELS PIXELS) float, what the head looks like."""
        found = [np.frombuffer(base64.b64decode(item), np.uint8) for first in range(0, len(weights), _PIECE)
                 for item in self._page.evaluate(f"pictures({json.dumps(weights[first:first + _PIECE])}, {PIXELS})")]
        return np.stack(found).astype(np.float64)


def timed(motion: Motion) -> List[Tuple[str, float, float]]:
    """The viseme of each phoneme with its first frame and its end; Motion has them a frame wider on either side."""
    found = []
    for label, begin, end in motion.phonemes:
        viseme = VISEME_OF.get(SPEECH.nearest(label), "sil")
        found.append((viseme, begin + 1.0, max(end - 1.0, begin + 2.0)))
    return found


def own(phonemes: Sequence[Tuple[str, float, float]], at: int, talking_head: bool) -> Dict[str, float]:
    """The weights of the head's own visemes in a frame."""
    weights: Dict[str, float] = {}
    for viseme, begin, end in phonemes:
        length = end - begin
        if talking_head:
            most = 0.9 if viseme in ("PP", "FF") else 0.6
            points = ([begin - 2 * length / 3, (begin + end) / 2, end + length / 2], [0.0, most, 0.0])
        else:
            points = ([begin - 2, begin + 2, max(end - 2, begin + 2), end + 2], [0.0, 1.0, 1.0, 0.0])
        weights[viseme] = max(weights.get(viseme, 0.0), float(np.interp(at + 0.5, *points)))
    return weights


def nearest(seen: np.ndarray, models: np.ndarray) -> np.ndarray:
    """(n,) the nearest of (m, k) models to each of (n, k) pictures."""
    return ((seen[:, None, :] - models[None]) ** 2).sum(axis=2).argmin(axis=1)


def rows(stage: Stage, motion: Motion) -> List[str]:
    phonemes = timed(motion)
    tokens = []
    for sound, viseme in enumerate(SOUNDS.values()):
        place = [number for number, item in enumerate(phonemes) if item[0] == viseme and item[2] - item[1] >= 3]
        tokens += [(sound, number) for number in place[:: max(len(place) // TOKENS, 1)][:TOKENS]]
    truth = np.array([sound for sound, _ in tokens])
    frames = [int((phonemes[number][1] + phonemes[number][2]) / 2) for _, number in tokens]
    visemes = stage.shapes("oculus")
    full = stage.pictures([stage.on({viseme: 1.0}, visemes) for viseme in SOUNDS.values()]) if visemes else None
    methods: Dict[str, List[Dict[str, float]]] = {}
    for kind in ("arkit", "oculus", "vrm"):
        shapes = stage.shapes(kind)
        for name, shares in (("sounds", motion.shares), ("FAPs alone", None)) if shapes else ():
            values = outputs(face(kind), motion.frames, shares)
            methods[f"Labial, {kind}, {name}"] = [
                stage.on({key: column[at] for key, column in values.items()}, shapes) for at in frames]
    for name, talking_head in (("its own visemes", False), ("TalkingHead", True)) if visemes else ():
        methods[name] = [stage.on(own(phonemes[max(number - 3, 0):number + 4], at, talking_head), visemes)
                         for at, (_, number) in zip(frames, tokens)]
    found = []
    for name, weights in methods.items():
        seen = stage.pictures(weights)
        train = np.arange(len(tokens)) % 2 == 0
        right = []
        for learned in (train, ~train):
            models = np.stack([seen[learned & (truth == sound)].mean(axis=0) for sound in range(len(SOUNDS))])
            right.append(nearest(seen[~learned], models) == truth[~learned])
        by_own = f"{np.mean(nearest(seen, full) == truth):.2f}" if full is not None else "-"
        found.append(f"{stage.name} | {name} | {np.concatenate(right).mean():.2f} | {by_own}")
    return found


def posed(kind: str) -> Dict[str, Dict[str, float]]:
    found: Dict[str, Dict[str, float]] = {}
    for text, marks in WORDS:
        lengths = [100 if VISEME_OF[label] in ("PP", "FF", "TH", "SS", "CH", "nn") else 200 for label in text.split()]
        with Stream(exact=True) as stream:
            for label, length in [("SIL", 200), *zip(text.split(), lengths), ("SIL", 300)]:
                stream.push(label, length)
            stream.end()
            frames = list(stream)
        shares = np.array([frame.visemes for frame in frames]) / ONE
        values = outputs(face(kind), np.array([frame.faps for frame in frames]), shares)
        ends = 200 + np.cumsum(lengths)
        for number, sound in {**marks, -1: "rest"}.items():
            at = 0 if number < 0 else int((ends[number] - lengths[number] / 2) * FPS / 1000)
            found[sound] = {name: float(column[at]) for name, column in values.items()}
    return found


def draw_sheet(page: Any, folder: Path, heads: Sequence[str], size: int = 112) -> bytes:
    """A picture of each head, by each rig that fits it, in each sound."""
    pairs: List[Tuple[str, str]] = []
    for path in heads:
        stage = Stage(page, folder, path)
        pairs += [(path, kind) for kind in ("arkit", "oculus", "vrm") if stage.shapes(kind)]
    page.evaluate(f"begin({len(pairs)}, {json.dumps(ORDER)}, {size})")
    stage: Optional[Stage] = None
    for number, (path, kind) in enumerate(pairs):
        stage = stage if stage and stage.name == Path(path).stem else Stage(page, folder, path)
        poses = posed(kind)
        weights = [stage.on(poses[sound], stage.shapes(kind)) for sound in ORDER]
        page.evaluate(f"row({number}, {json.dumps(f'{stage.name} {kind}')}, {json.dumps(weights)}, {size})")
    return base64.b64decode(page.evaluate("picture()").split(",")[1])


def main(arguments: Sequence[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("three", metavar="THREE", help="folder of the npm package three")
    parser.add_argument("heads", metavar="HEAD", nargs="+", help=".glb or .vrm")
    parser.add_argument("--sheet", metavar="SHEET.webp", help="write a picture in place of the table")
    options = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory() as made:
        folder = Path(made) / "site"
        folder.mkdir()
        (folder / "three").symlink_to(Path(options.three).resolve())
        (folder / "page.html").write_text(PAGE, encoding="utf-8")
        with served(folder) as address, Browser(Path(made) / "profile", THREE_D) as browser:
            page = browser.page(f"{address}/page.html")
            page.wait_for("window.ready")
            if options.sheet:
                Path(options.sheet).write_bytes(draw_sheet(page, folder, options.heads))
                return 0
            motion = read_sentences(TESTS / "sentences.flite")
            print("head | method | learned | own", flush=True)
            for path in options.heads:
                try:
                    print("\n".join(rows(Stage(page, folder, path), motion)), flush=True)
                except LabialError as error:
                    print(error, flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
