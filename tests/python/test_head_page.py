"""``labial page --head``: an avatar speaks on a page that has everything within it."""

from __future__ import annotations

import base64
import json
import re
from pathlib import Path

import numpy as np
import pytest

from avatars import document_of, glb, made_head
from browser import CHROMIUM, REASON, THREE_D, Browser
from bundlers import NPM, tools
from labial.__main__ import main
from labial.rig.animation import face, outputs
from models import write_motion

BROWSER = THREE_D
#: Frames of which the third is wide open.
OPENING = (0, 200, 600, 200, 0)
FAPS = np.zeros((5, 13))
FAPS[:, 0], FAPS[:, 4] = [x // 2 for x in OPENING], [-x for x in OPENING]


@pytest.fixture
def frames(tmp_path: Path) -> Path:
    """A mouth that opens and closes."""
    return write_motion(tmp_path / "opens.csv", np.arange(5) / 50, FAPS)


@pytest.fixture
def avatar(tmp_path: Path) -> Path:
    """The made head, below a node that moves it."""
    document, binary = document_of(*made_head(), node={"translation": [0.3, 1.5, -0.2]})
    path = tmp_path / "head.glb"
    path.write_bytes(glb(document, binary))
    return path


@pytest.fixture
def stand_in(tmp_path: Path) -> Path:
    """What looks like the npm package three."""
    files = {"build/three.core.js": "export const core = 1;",
             "build/three.module.js": "import { core } from './three.core.js';\nexport { core };",
             "examples/jsm/loaders/GLTFLoader.js": "import { a } from '../utils/BufferGeometryUtils.js';\n"
                                                   "import { b } from '../utils/SkeletonUtils.js';",
             "examples/jsm/utils/BufferGeometryUtils.js": "import { core } from 'three';",
             "examples/jsm/utils/SkeletonUtils.js": ""}
    for name, text in files.items():
        (tmp_path / "three" / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "three" / name).write_text(text)
    return tmp_path / "three"


@pytest.mark.parametrize("core", [True, False])
def test_everything_is_in_the_page(tmp_path: Path, frames: Path, avatar: Path, stand_in: Path, core: bool) -> None:
    """The avatar's bytes, the rig's weights by the avatar's names, and modules that ask for nothing outside. Before
    0.172 three had no three.core.js."""
    out = tmp_path / "page.html"
    if not core:
        (stand_in / "build" / "three.core.js").unlink()
        (stand_in / "build" / "three.module.js").write_text("export const core = 1;")
    assert main(["page", str(frames), "--head", str(avatar), "--three", str(stand_in), "-o", str(out)]) == 0
    text = out.read_text(encoding="utf-8")
    data = json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', text, re.DOTALL)[1])
    assert base64.b64decode(data["head"]) == avatar.read_bytes()
    expected = outputs(face("arkit"), FAPS)
    weights = np.array(data["weights"])
    assert "jawOpen" in data["shapes"] and set(data["shapes"]) <= set(made_head()[2])
    for name, column in zip(data["shapes"], weights.T):
        assert column == pytest.approx(expected[name], abs=0.0006)
    assert np.mean(data["corners"], axis=0)[1] == pytest.approx(1.5, abs=0.01)
    imports = json.loads(re.search(r'<script type="importmap">(.*?)</script>', text, re.DOTALL)[1])["imports"]
    for address in imports.values():
        kind, _, content = address.partition(",")
        assert kind == "data:text/javascript;base64"
        for module in re.findall(r"from '(.*?)'", base64.b64decode(content).decode()):
            assert module in imports


@pytest.mark.parametrize(("jaw", "told"), [(1.0, ""), (0.25, "its mouth opens 0."), (3.0, "its mouth opens 2.")])
def test_heads_that_the_built_in_weights_do_not_suit_are_told(tmp_path: Path, frames: Path, stand_in: Path, jaw: float,
                                                              told: str, capsys: pytest.CaptureFixture[str]) -> None:
    """A jaw that goes a quarter as far as the made head's, or three times; of a rig of one's own nothing is said."""
    vertices, triangles, shapes = made_head()
    for name in ("jawOpen", "mouthClose"):
        shapes[name] = jaw * shapes[name]
    path, out = tmp_path / "odd.glb", str(tmp_path / "page.html")
    path.write_bytes(glb(*document_of(vertices, triangles, shapes)))
    command = ["page", str(frames), "--head", str(path), "--three", str(stand_in), "-o", out]
    assert main(command) == 0
    said = capsys.readouterr().err
    assert told in said and (f"warning: {path}: with the built-in weights" in said) == bool(told), said
    (tmp_path / "mine.toml").write_text('unit = "weight"\n[output.jawOpen]\nfrom = "opening"\nneutral = 0\nfull = 1\n')
    assert main([*command, "--rig", str(tmp_path / "mine.toml")]) == 0 and capsys.readouterr().err == ""


def test_expressions_of_vrm_move_their_shapes(tmp_path: Path, frames: Path, stand_in: Path) -> None:
    """three.js knows the mesh's shapes alone, not the expressions that are made of them."""
    vertices, triangles, shapes = made_head(mouth="vrm")
    document, binary = document_of(vertices, triangles, {f"M_{name}": 2.0 * move for name, move in shapes.items()})
    document["extensions"] = {"VRMC_vrm": {"expressions": {"preset": {
        name: {"morphTargetBinds": [{"node": 0, "index": place, "weight": 0.5}]}
        for place, name in enumerate(("aa", "ou", "ih"))}}}}
    (tmp_path / "a.vrm").write_bytes(glb(document, binary))
    out = tmp_path / "page.html"
    assert main(["page", str(frames), "--head", str(tmp_path / "a.vrm"), "--three", str(stand_in), "-o", str(out)]) == 0
    text = out.read_text(encoding="utf-8")
    data = json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', text, re.DOTALL)[1])
    assert set(data["shapes"]) == {"M_A", "M_U", "M_I"} and data["facing"] == 1.0
    opened = np.array(data["weights"])[:, data["shapes"].index("M_A")]
    assert opened == pytest.approx(0.5 * outputs(face("vrm"), FAPS)["aa"], abs=0.001) and opened.max() > 0.2


def test_errors_say_what_to_do(tmp_path: Path, frames: Path, avatar: Path, stand_in: Path,
                               monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """One line each, and no page."""
    monkeypatch.chdir(tmp_path)
    out = str(tmp_path / "page.html")
    (tmp_path / "rig.toml").write_text('unit = "weight"\n[output.beak]\nfrom = "jaw"\nneutral = 0\nfull = 1\n')
    three = ["--three", str(stand_in)]
    for options, message in (
        (["--head", str(avatar)], "`npm install three` brings it"),
        (["--head", str(avatar), "--three", str(tmp_path)], "is not the npm package three"),
        (["--head", str(frames), *three], "is not a whole .glb"),
        (["--head", str(avatar), "--rig", str(tmp_path / "rig.toml"), *three], "none of the rig's shapes, beak"),
        (three, "--rig and --three go with --head"),
    ):
        assert main(["page", str(frames), "-o", out, *options]) == 1
        error = capsys.readouterr().err
        assert message in error and error.count("\n") == 1, error
    assert not Path(out).exists()


@pytest.mark.slow
@pytest.mark.skipif(not NPM, reason="needs npm: install the Debian package npm")
@pytest.mark.skipif(not CHROMIUM, reason=REASON)
def test_the_head_moves_in_a_browser(tmp_path: Path, frames: Path, avatar: Path, browser: Browser) -> None:
    """With the real three.js: no error, the camera looks at the mouth, weights reach the mesh, and what is drawn
    changes where the mouth opens and is the same again where it closes."""
    out, three = tmp_path / "page.html", tools() / "node_modules" / "three"
    assert main(["page", str(frames), "--head", str(avatar), "--three", str(three), "-o", str(out)]) == 0
    page = browser.page(out.as_uri())
    page.wait_for("!!window.labialHead", 60)
    assert not page.errors()
    middle = page.evaluate("labialHead.middle.toArray()")
    assert middle[0] == pytest.approx(0.3, abs=0.003) and middle[1] == pytest.approx(1.5, abs=0.003)
    drawn = []
    for frame in range(len(OPENING)):
        page.evaluate(f"labialHead.show({frame})")
        drawn.append(page.evaluate("document.querySelector('canvas').toDataURL()"))
        jaw = page.evaluate("(([mesh]) => mesh.morphTargetInfluences[mesh.morphTargetDictionary.jawOpen])"
                            "(labialHead.meshes[0])")
        assert (jaw > 0.05) == (OPENING[frame] > 100)
    assert drawn[0] == drawn[4] and drawn[1] == drawn[3] and len(set(drawn)) == 3
    page.evaluate("document.querySelector('button').click()")
    page.wait_for("document.querySelector('input').value === '4'", 20)
