"""The code of docs/adapters.md in Chromium, with the real packages: TalkingHead, three-vrm and three.js move avatars
that are made here, and what reaches the meshes is compared with what labial-say writes."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any, Callable, Dict, Iterator, List

import numpy as np
import pytest

import labial
from avatars import add_skeleton, document_of, glb, made_head
from browser import CHROMIUM, REASON, THREE_D, Browser, Page, served
from labial.__main__ import main
from labial.rig import description_of
from messages import answers
from models import lab, write_wav
from npm import TOOLS_MISSING, install, package, tools
from packages import SOURCE
from pages import parse
from test_animation import APPLE, SAY, say

PAGE = SOURCE / "docs" / "adapters.md"
BROWSER = THREE_D
pytestmark = [pytest.mark.slow, pytest.mark.skipif(bool(TOOLS_MISSING), reason=TOOLS_MISSING),
              pytest.mark.skipif(not CHROMIUM, reason=REASON),
              pytest.mark.skipif(not SAY, reason="LABIAL_SAY does not name the built labial-say")]  # fmt: skip

#: Rounded, spread and closed lips for five seconds, in which TalkingHead's mouth would move by itself.
PHONEMES = [("sil", 300), *(("m", 90), ("AA", 160), ("b", 90), ("UW", 180), ("f", 90), ("IY", 140)) * 6, ("sil", 200)]
SECONDS = sum(milliseconds for _, milliseconds in PHONEMES) / 1000
WORDS = "Papa may. Mama saw."
VISEMES = "sil PP FF TH DD kk CH SS nn RR aa E I O U".split()

#: The weights of a frame that is drawn, by name, from the first mesh that has shapes.
READ = """(meshes) => Object.fromEntries(Object.entries(meshes[0].morphTargetDictionary)
    .map(([name, place]) => [name, meshes[0].morphTargetInfluences[place]]))"""


def avatar(arkit: bool = True) -> bytes:
    """The made head on a body, with all shapes of a Ready Player Me avatar, or its visemes alone, and teeth that have
    some of them."""
    vertices, triangles, shapes = made_head()
    zero = np.zeros_like(vertices)
    visemes = {"viseme_" + name: zero for name in VISEMES}
    visemes["viseme_aa"] = 0.6 * shapes["jawOpen"]
    own = {**dict.fromkeys(APPLE, zero), **shapes} if arkit else {}
    document, binary = document_of(vertices, triangles, {**own, **visemes})
    document["meshes"].append({**document["meshes"][0], "name": "teeth"})
    document["nodes"][0]["children"] = [1]
    document["nodes"].append({"mesh": 1, "name": "teeth"})
    add_skeleton(document)
    return glb(document, binary)


def vrm() -> bytes:
    """The made head as VRM 1.0, whose expressions move each of its mouths by half."""
    vertices, triangles, shapes = made_head(mouth="vrm")
    document, binary = document_of(vertices, triangles, shapes)
    numbers = add_skeleton(document)
    bones = {"hips": "Hips", "spine": "Spine", "head": "Head"}
    for side in ("Left", "Right"):
        bones.update({side.lower() + bone: side + name for bone, name in (
            ("UpperArm", "Arm"), ("LowerArm", "ForeArm"), ("Hand", "Hand"), ("UpperLeg", "UpLeg"), ("LowerLeg", "Leg"),
            ("Foot", "Foot"))})  # fmt: skip
    preset = {name: {"morphTargetBinds": [{"node": 0, "index": place, "weight": 0.5}]}
              for place, name in enumerate(("aa", "ou", "ih"))}
    document["extensionsUsed"] = ["VRMC_vrm"]
    document["extensions"] = {"VRMC_vrm": {
        "specVersion": "1.0",
        "meta": {"name": "made", "authors": ["made"], "licenseUrl": "https://vrm.dev/licenses/1.0/"},
        "humanoid": {"humanBones": {bone: {"node": numbers[name]} for bone, name in bones.items()}},
        "expressions": {"preset": preset}}}
    return glb(document, binary)


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Callable[[str], str]]:
    """Serves the page's code, the packages, avatars, a sound and its timings; the address of a page that runs a
    script."""
    folder = tmp_path_factory.mktemp("site") / "site"
    install(package(tmp_path_factory.mktemp("npm") / "build"), folder)
    for name in ("@met4citizen", "@pixiv", "three"):
        (folder / "node_modules" / name).symlink_to(tools() / "node_modules" / name)
    for block in parse(PAGE):
        if block.name:
            (folder / block.name).write_text(block.text, encoding="utf-8")
    (folder / "avatar.glb").write_bytes(avatar())
    (folder / "avatar.vrm").write_bytes(vrm())
    (folder / "hello.lab").write_text(lab(PHONEMES))
    write_wav(folder / "hello.wav", 3000 * np.sin(np.arange(16000 * SECONDS) / 8))
    imports = {"three": "three/build/three.module.js", "three/addons/": "three/examples/jsm/",
               "@pixiv/three-vrm": "@pixiv/three-vrm/lib/three-vrm.module.js", "labial": "labial/index.js",
               "labial/": "labial/", "labial-words": "labial-words/index.js",
               "@met4citizen/talkinghead": "@met4citizen/talkinghead/modules/talkinghead.mjs"}
    numbers = iter(range(1000))

    def address(script: str) -> str:
        name = f"page-{next(numbers)}.html"
        table = json.dumps({"imports": {key: f"./node_modules/{path}" for key, path in imports.items()}})
        (folder / name).write_text(
            f'<!doctype html><link rel="icon" href="data:,"><script type="importmap">{table}</script>'
            f'<div id="avatar" style="width: 200px; height: 200px"></div><script type="module">\n'
            f"const read = {READ};\n{script}</script>")
        return f"{served_at}/{name}"

    address.folder = folder  # type: ignore[attr-defined]
    with served(folder) as served_at:
        yield address


def expected(folder: Path, face: str) -> Dict[str, np.ndarray]:
    """The weights of every frame as labial-say has them; the file that it writes, hello_FACE.jsonl, is served, too."""
    text = say((folder / "hello.lab").read_text(), face)
    (folder / f"hello_{face}.jsonl").write_text(text)
    rows = [json.loads(line)[face] for line in text.splitlines()]
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}


def between(values: np.ndarray, seconds: np.ndarray) -> np.ndarray:
    """The weight at these times of the sound."""
    return np.interp(50 * seconds, np.arange(len(values)), values)


def differ(seen: List[float], values: np.ndarray) -> float:
    """The largest difference."""
    return float(np.abs(np.array(seen) - values).max())


def test_shapes_of_every_mesh(site: Any, browser: Browser) -> None:
    """A head and its teeth, by ARKit's names and by Ready Player Me's of visemes, at times that are looked at."""
    arkit, oculus = (expected(site.folder, face) for face in ("arkit", "oculus"))
    (site.folder / "visemes.glb").write_bytes(avatar(arkit=False))
    page = browser.page(site("""
        import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
        import { head, labial } from "./head.js";
        import { readFrames } from "./frames.js";
        import { attach } from "labial/attach.js";
        const other = attach((await new GLTFLoader().loadAsync("visemes.glb")).scene);
        other.source = labial.render(labial.read(await (await fetch("hello.lab")).text()), { output: other.output });
        window.outputs = [head.output, other.output];
        window.seen = [];
        for (let frame = 0; frame < 200; frame++) {
            const seconds = frame / 50;
            head.update(seconds);
            other.update(seconds);
            seen.push([seconds, ...head.meshes.map((mesh) => read([mesh])), read(other.meshes)]);
        }
        head.audio.currentTime = 0;
        head.update();
        head.source = null;
        await new Promise((resolve) => setTimeout(resolve, 250));
        const rest = Math.max(...Object.values(read(head.meshes)));
        const file = await readFrames("hello_arkit.jsonl", "arkit");
        head.source = file;
        head.update(1.005);
        window.file = [read(head.meshes).jawOpen, file.frames[50].jawOpen, file.at(1e9) === file.frames.at(-1), rest];
        """))  # fmt: skip
    page.wait_for("window.file")
    assert page.errors() == []
    assert page.evaluate("outputs") == ["arkit", "oculus"]
    seen = page.evaluate("seen")
    times = np.array([row[0] for row in seen])
    for name, values in arkit.items():
        for mesh in (1, 2):
            assert differ([row[mesh][name] for row in seen], between(values, times)) <= 0.0015, name
    for name, values in oculus.items():
        shape = "viseme_" + {"ih": "I", "oh": "O", "ou": "U"}.get(name, name)
        assert differ([row[3][shape] for row in seen], between(values, times)) <= 0.0015, name
    drawn, frame, last, rest = page.evaluate("file")
    assert drawn == pytest.approx(frame) and drawn > 0 and last and rest == 0


def test_rig_of_ones_own(site: Any, browser: Browser) -> None:
    """The file that `labial rig --json` writes, in the place of "arkit", on the avatar's own shapes."""
    shutil.copyfile(description_of("arkit"), site.folder / "mine.toml")
    assert main(["rig", str(site.folder / "mine.toml"), "--json", "-o", str(site.folder)]) == 0
    page = browser.page(site("""
        import { head, track } from "./mine.js";
        head.update(0.5);
        Object.assign(window, { frames_: [...track], moved: read(head.meshes), wanted: track.at(0.5) });
        """))  # fmt: skip
    page.wait_for("!!window.moved")
    assert page.errors() == []
    drawn = page.evaluate("frames_")
    for name, values in expected(site.folder, "arkit").items():
        assert [frame[name] for frame in drawn] == values.tolist(), name
        assert page.evaluate(f"moved.{name}") == pytest.approx(page.evaluate(f"wanted.{name}"))


def test_vrm_moves(site: Any, browser: Browser) -> None:
    """Expressions move the mesh's own shapes by their shares."""
    page = browser.page(site("""
        import { draw, head } from "./vrm.js";
        window.seen = [];
        for (let frame = 0; frame < 200; frame++) {
            const seconds = frame / 50;
            draw(seconds, 0.02);
            seen.push([seconds, read(head.meshes)]);
        }
        window.done = head.output;
        """))  # fmt: skip
    page.wait_for("window.done")
    assert page.errors() == [] and page.evaluate("done") == "vrm"
    seen = page.evaluate("seen")
    times = np.array([row[0] for row in seen])
    weights = expected(site.folder, "vrm")
    for name, shape in {"aa": "A", "ou": "U", "ih": "I"}.items():  # the others are not this avatar's
        values = weights[name]
        assert differ([row[1][shape] for row in seen], 0.5 * between(values, times)) <= 0.0015, name
        assert values.max() > 0.1, name


#: Notes the time since the sound began, by TalkingHead's clock, and the weights after each picture that it draws.
WATCH = """
    function watch(head) {
        Object.assign(window, { watched: head, seen: [], seconds: () => (head.animClock - window.beginning) / 1000 });
        const render = head.render.bind(head);
        head.render = () => {
            render();
            if (window.beginning !== undefined) seen.push([seconds(), read(head.morphs)]);
        };
    }
    const start = AudioBufferSourceNode.prototype.start;
    AudioBufferSourceNode.prototype.start = function (when) {
        if (this.buffer?.duration > 1) {
            window.beginning = watched.animClock + 1000 * Math.max(0, when - this.context.currentTime);
        }
        start.call(this, when);
    };
"""


def in_step(page: Page, expected: Dict[str, np.ndarray]) -> None:
    """What TalkingHead drew is the track at the sound's time, and no shape was lost on the way. TalkingHead counts from
    its last picture before the sound, by whose age its clock is early: that is not judged. Where the processors are
    busy, single pictures are late."""
    assert page.errors() == []
    seen = [row for row in page.evaluate("seen") if 0.1 < row[0] < SECONDS - 0.3]
    times = np.array([row[0] for row in seen])
    assert len(times) > 12 and np.ptp(times) > 0.7 * SECONDS

    def error(delay: float) -> float:
        return max(float(np.sqrt(np.mean((between(values, times - delay) - [row[1][name] for row in seen]) ** 2)))
                   for name, values in expected.items())

    delays = np.arange(-0.2, 0.201, 0.005)
    best = float(delays[np.argmin([error(delay) for delay in delays])])
    assert abs(best) <= 0.02 and error(best) < 0.08, (best, error(best))


def test_talkinghead_speaks(site: Any, browser: Browser) -> None:
    """``speakAudio()`` with an animation: every shape follows to the end, in step, and then comes to rest."""
    page = browser.page(site(WATCH + """
        const { TalkingHead } = await import("@met4citizen/talkinghead");
        const speakAudio = TalkingHead.prototype.speakAudio;
        TalkingHead.prototype.speakAudio = function (...all) { watch(this); speakAudio.apply(this, all); };
        await import("./speak.js");
        """))  # fmt: skip
    page.wait_for("window.beginning !== undefined", 60)
    page.wait_for(f"seconds() > {SECONDS + 1}", 60)
    in_step(page, expected(site.folder, "arkit"))
    assert max(page.evaluate("seen.at(-1)")[1][name] for name in expected(site.folder, "arkit")) < 0.05


def test_talkinghead_streams(site: Any, browser: Browser) -> None:
    """``streamAudio()`` with pieces of sound and phonemes that come every half second."""
    page = browser.page(site(WATCH + """
        import { TalkingHead } from "@met4citizen/talkinghead";
        import { Labial } from "labial";
        import { prepare } from "./talkinghead.js";
        import { speak } from "./stream.js";
        const head = new TalkingHead(document.getElementById("avatar"), { lipsyncModules: [], cameraView: "head" });
        prepare(head);
        await head.showAvatar({ url: "avatar.glb" });
        await head.audioCtx.resume(); // which start() began; another rate closes the context
        watch(head);
        const labial = await Labial.load();
        const phonemes = PHONEMES;
        async function* pieces() {
            for (let first = 0; first < phonemes.length; first += 5) {
                const some = phonemes.slice(first, first + 5);
                const total = some.reduce((sum, [, milliseconds]) => sum + milliseconds, 0);
                const pcm = Int16Array.from({ length: 16 * total }, (_, i) => 3000 * Math.sin(i / 8));
                yield { pcm, phonemes: some };
                await new Promise((resolve) => setTimeout(resolve, 0.7 * total));
            }
        }
        const begin = head._processStreamLipsyncQueue.bind(head);
        head._processStreamLipsyncQueue = () => { window.beginning ??= head.streamAudioStartTime; begin(); };
        await speak(head, labial, pieces(), 16000);
        """.replace("PHONEMES", json.dumps(PHONEMES))))  # fmt: skip
    page.wait_for("window.beginning !== undefined", 60)
    page.wait_for(f"seconds() > {SECONDS + 1}", 60)
    in_step(page, expected(site.folder, "arkit"))


def test_talkinghead_follows_words(site: Any, browser: Browser) -> None:
    """Messages of characters with pieces of sound: what is drawn is what the words say, in step with the sound that
    TalkingHead plays, which a recorder takes down."""
    page = browser.page(site("""
        import { TalkingHead } from "@met4citizen/talkinghead";
        import { Labial } from "labial";
        import { prepare } from "./talkinghead.js";
        import { speak } from "./voice.js";
        const head = new TalkingHead(document.getElementById("avatar"), { lipsyncModules: [], cameraView: "head" });
        prepare(head);
        head.renderer.render = () => {};  // drawing takes most of a busy machine's time, and nobody looks
        await head.showAvatar({ url: "avatar.glb" });
        const recorder = `registerProcessor("recorder", class extends AudioWorkletProcessor {
            process([[samples]]) {
                if (samples && Math.max(...samples) > 0.01) this.port.postMessage(currentTime);
                return true;
            }
        });`;
        const { addModule } = AudioWorklet.prototype;
        AudioWorklet.prototype.addModule = async function (...all) {
            await addModule.call(this, `data:text/javascript,${encodeURIComponent(recorder)}`);
            AudioWorklet.prototype.addModule = addModule;
            return addModule.apply(this, all);
        };
        const { connect } = AudioWorkletNode.prototype;
        const began = new Promise((resolve) => {
            AudioWorkletNode.prototype.connect = function (...all) {
                const node = new AudioWorkletNode(this.context, "recorder");
                node.port.onmessage = ({ data }) => resolve(window.first ??= data);
                connect.call(this, node);
                AudioWorkletNode.prototype.connect = connect;
                return connect.apply(this, all);
            };
        });
        const render = head.render.bind(head);
        window.seen = [];
        head.render = () => {
            render();
            const { currentTime, outputLatency, baseLatency } = head.audioCtx;
            seen.push([currentTime - (outputLatency || baseLatency || 0), read(head.morphs)]);
        };
        async function* messages() {
            for (const message of MESSAGES) {
                const bytes = Uint8Array.from(atob(message.audio ?? ""), (byte) => byte.charCodeAt(0));
                yield { message, pcm: bytes.length ? bytes.buffer : null };
                await new Promise((resolve) => setTimeout(resolve, 50));
            }
        }
        const labial = await Labial.load({ words: () => import("labial-words") });
        await speak(head, labial, messages(), { format: "elevenlabs", sampleRate: 16000 });
        await began;
        window.done = true;
        """.replace("MESSAGES", json.dumps(answers(WORDS)))))  # fmt: skip
    page.wait_for("window.done", 60)
    assert page.errors() == []
    frames = labial.render(labial.read_timings(answers(WORDS)))
    arkit = labial.Rig("arkit")
    rows = [arkit.apply(frame) for frame in frames]
    first, seen = page.evaluate("[first, seen]")
    times = np.array([row[0] for row in seen]) - first
    spoken = (times > 0.2) & (times < len(rows) / 50 - 0.2)
    assert spoken.sum() > 4

    def error(delay: float) -> float:
        places = np.clip(np.floor(50 * (times[spoken] - delay)), 0, len(rows) - 1).astype(int)
        drawn = [row[1] for row, one in zip(seen, spoken) if one]
        return max(float(np.median([abs(rows[place][name] - weights[name]) for place, weights in zip(places, drawn)]))
                   for name in arkit.outputs)

    delays = np.arange(-0.2, 0.201, 0.005)
    best = float(delays[np.argmin([error(delay) for delay in delays])])
    interval = float(np.median(np.diff(times[spoken])))  # a busy machine draws few frames a second
    assert abs(best) <= 0.08 + interval and error(best) < 0.02, (best, error(best), interval)
    assert max(weights["jawOpen"] for _, weights in seen) > 0.1 and seen[-1][1]["jawOpen"] < 0.05


def test_talkinghead_gives_way(site: Any, browser: Browser) -> None:
    """A shape that is set directly is drawn as it is set; null gives it back."""
    page = browser.page(site("""
        import { TalkingHead } from "@met4citizen/talkinghead";
        import { show } from "./realtime.js";
        const head = new TalkingHead(document.getElementById("avatar"), { lipsyncModules: [] });
        await head.showAvatar({ url: "avatar.glb" });
        Object.assign(window, { head, show, drawn: () => read(head.morphs).jawOpen });
        """))  # fmt: skip
    page.wait_for("!!window.head", 60)
    page.evaluate("show(head, { jawOpen: 0.625 })")
    page.wait_for("Math.abs(drawn() - 0.625) < 1e-6")
    page.evaluate("show(head, { jawOpen: null })")
    page.wait_for("drawn() < 0.05")
    assert page.errors() == []
