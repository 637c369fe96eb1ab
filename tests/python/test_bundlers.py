"""The npm packages as projects use them: bundled by vite, esbuild, webpack and rollup as these come, or not at all; in
pages, workers and AudioWorklets of Chromium and in two versions of node. Everywhere the frames are labial-say's."""

from __future__ import annotations

import gzip
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any, List

import pytest

from browser import Browser, served
from bundlers import FOLDER, MISSING, install, node, tools
from npm import package
from packages import run
from test_npm import SAY, said

BUNDLERS = ("esbuild", "rollup", "vite", "webpack")
WORD = "0 .1 sil\n.1 .2 m\n.2 .5 AA\n.5 .6 p\n.6 1.4 <laugh:0.7>\n1.4 1.5 sil\n"

pytestmark = [pytest.mark.slow, pytest.mark.skipif(bool(MISSING), reason=MISSING),
              pytest.mark.skipif(not SAY, reason="LABIAL_SAY does not name the built labial-say"),
              pytest.mark.skipif(sys.platform != "linux" or os.uname().machine != "x86_64",
                                 reason="needs x86-64 Linux: npm has node as a package of each platform")]  # fmt: skip


@pytest.fixture(scope="module")
def app(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The app, with the packages installed."""
    folder = tmp_path_factory.mktemp("app") / "app"
    shutil.copytree(FOLDER / "app", folder)
    install(package(tmp_path_factory.mktemp("npm") / "build"), folder)
    return folder


@pytest.fixture(scope="module")
def frames() -> List[int]:
    """What labial-say makes of the word and the laugh, 13 FAPs after 13 FAPs."""
    return [value for row in said(WORD, "faps") for value in row]


@pytest.fixture(scope="module", params=BUNDLERS)
def bundle(request: pytest.FixtureRequest, app: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The app as a bundler bundles it."""
    out = tmp_path_factory.mktemp(request.param)
    run(node(22), tools() / "build.mjs", request.param, app, out)
    return out


def results(browser: Browser, folder: Path) -> Any:
    """What the page of `folder` finds in each place."""
    with served(folder) as site:
        page = browser.page(f"{site}/index.html")
        page.wait_for("Object.keys(window.results ?? {}).length === 4")
        assert page.errors() == []
        return page.evaluate("results")


def printed(program: Path, script: Path) -> Any:
    """The JSON that a script prints under a node."""
    done = subprocess.run([str(program), str(script)], capture_output=True, encoding="utf-8", timeout=60, check=False,
                          env={**os.environ, "WORD": WORD, "NODE_OPTIONS": ""}, cwd=script.parent)  # fmt: skip
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_bundles_run_in_chromium(bundle: Path, browser: Browser, frames: List[int]) -> None:
    """Catches a file that a bundler does not emit, and what a worker or an AudioWorklet lacks."""
    found = results(browser, bundle / "page")
    assert found.pop("element") > 3
    assert found == {place: frames for place in ("page", "worker", "worklet")}


def test_bundles_run_on_servers(bundle: Path, frames: List[int]) -> None:
    """ES modules and CommonJS, under the oldest node that is supported and a newer one."""
    scripts = sorted((bundle / "server").glob("*.[mc]js"))
    own = [path for path in scripts if path.stem in ("server", "required")]
    assert own
    for version in (18, 22):
        for script in own:
            assert printed(node(version), script) == frames, (version, script)


def test_bundles_name_the_source_of_the_data(bundle: Path) -> None:
    """The licence of the speech model's data wants it named wherever the model goes."""
    texts = [path.read_text(encoding="utf-8") for path in (bundle / "page").rglob("*") if path.is_file()]
    assert any("GRID audio-visual speech corpus" in text and "CC BY 4.0" in text for text in texts)


def test_unbundled_in_node(app: Path, frames: List[int]) -> None:
    """``import`` and ``require()`` of the packages themselves."""
    for version in (18, 22):
        for script in ("server.js", "server.cjs"):
            assert printed(node(version), app / script) == frames, (version, script)


def test_unbundled_in_chromium(app: Path, browser: Browser, frames: List[int], tmp_path: Path) -> None:
    """A page with an import map, workers and worklets that name the files."""
    folder = tmp_path / "page"
    shutil.copytree(app, folder)
    html = folder / "index.html"
    paths = {"labial": "./node_modules/labial/index.js", "labial/": "./node_modules/labial/",
             "labial-laughter": "./node_modules/labial-laughter/index.js"}  # fmt: skip
    html.write_text(html.read_text().replace(
        "<script type", f'<script type="importmap">{json.dumps({"imports": paths})}</script><script type'))  # fmt: skip
    for path in folder.glob("*.js"):
        if path.name != "page.js":  # workers have no import maps
            text = path.read_text()
            for name in ("labial", "labial-laughter"):
                text = text.replace(f'"{name}"', f'"{paths[name]}"')
            path.write_text(text)
    found = results(browser, folder)
    assert found.pop("element") > 3
    assert found == {place: frames for place in ("page", "worker", "worklet")}


def test_a_page_that_only_speaks_is_small(app: Path) -> None:
    """70 KB compressed, file by file; without what draws the mouth. Catches laughter that comes along."""
    folder = app / "node_modules" / "labial"
    names = ["index.js"]
    for name in names:
        text = (folder / name).read_text(encoding="utf-8")
        names += [found for found in _imports(text) if found not in names]
    assert "speech.js" in names and "mouth.js" not in names
    assert sum(len(gzip.compress((folder / name).read_bytes(), 9)) for name in names) <= 70_000


def _imports(text: str) -> List[str]:
    return re.findall(r'^import .* from "\./(.*)";$', text, re.MULTILINE)
