"""The npm packages as projects use them: bundled by vite, esbuild, webpack, rollup and Parcel as these come, or not at
all; in pages, workers and AudioWorklets of Chromium and in two versions of node. Everywhere the frames are
labial-say's. And their types."""

from __future__ import annotations

import gzip
import itertools
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any, Dict, List

import numpy as np
import pytest

import labial
from browser import Browser, served
from npm import FOLDER, TOOLS_MISSING, install, node, tools
from packages import SOURCE, needs_runtime, run
from pages import parse
from test_npm import SAY, said

BUNDLERS = ("esbuild", "parcel", "rollup", "vite", "webpack")
#: Bundlers that leave labial-hearing's AudioWorklet where it was: its text is loaded then.
LEAVE = ("esbuild", "rollup")
WORD = "0 .1 sil\n.1 .2 m\n.2 .5 AA\n.5 .6 p\n.6 1.4 <laugh:0.7>\n1.4 1.5 sil\n"

pytestmark = [pytest.mark.slow, needs_runtime, pytest.mark.skipif(bool(TOOLS_MISSING), reason=TOOLS_MISSING),
              pytest.mark.skipif(sys.platform != "linux" or os.uname().machine != "x86_64",
                                 reason="needs x86-64 Linux: npm has node as a package of each platform")]


@pytest.fixture(scope="module")
def app(npm_package: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("app") / "app"
    shutil.copytree(FOLDER / "app", folder)
    (folder / "package.json").write_text('{ "type": "module" }')
    install(npm_package, folder)
    return folder


@pytest.fixture(scope="module")
def wanted() -> List[Any]:
    """What a server prints: labial-say's frames, those of hearing, and what Python makes of words."""
    if not SAY:
        pytest.skip("LABIAL_SAY does not name the built labial-say")
    i = np.arange(16000)
    sound = np.where(i % 400 < 200, i * i % 8191, -(i * i % 8191)).astype(np.int16)
    heard: List[int] = []
    for name in ("hear_small", "hear_large"):
        with labial.Hearing(model=name) as hearing:
            heard += [value for frame in hearing.frames([sound]) for value in frame.faps]
    timings = labial.word_timings([("Maybe,", 100, 500), ("people!", 750, None)])
    ends = itertools.accumulate(length for _, length in timings)
    spoken = [item for (label, _), end in zip(timings, ends) for item in ("" if label == "SIL" else label, end / 1000)]
    return [[value for row in said(WORD, "faps") for value in row], heard, spoken]


@pytest.fixture(scope="module", params=BUNDLERS)
def bundle(request: pytest.FixtureRequest, app: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The app as a bundler bundles it."""
    out = tmp_path_factory.mktemp(request.param)
    run(node(22), tools() / "build.mjs", request.param, app, out)
    return out


def check_page(browser: Browser, folder: Path, wanted: List[Any], found: bool) -> None:
    """Holds what the page finds in each place to `wanted`; `found`: labial-hearing's AudioWorklet is a file there."""
    with served(folder) as site:
        page = browser.page(f"{site}/index.html")
        page.wait_for("Object.keys(window.results ?? {}).length === 7")
        assert found is False or page.errors() == []
        seen = page.evaluate("results")
        assert seen.pop("tapped") == (["http"] if found else ["http", "blob"])
    frames, heard, spoken = wanted
    assert seen.pop("element") > 3
    assert seen == {"hearing": heard, "words": spoken, "page": frames, "worker": frames, "worklet": frames + spoken}


def printed(program: Path, script: Path) -> Any:
    """The JSON that a script prints under a node."""
    done = subprocess.run([str(program), str(script)], capture_output=True, encoding="utf-8", timeout=60, check=False,
                          env={**os.environ, "WORD": WORD, "NODE_OPTIONS": ""}, cwd=script.parent)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_bundles_run_in_chromium(bundle: Path, browser: Browser, wanted: List[Any]) -> None:
    """Catches a file that a bundler does not emit, and what a worker or an AudioWorklet lacks."""
    check_page(browser, bundle / "page", wanted, bundle.name.rstrip("0123456789") not in LEAVE)


def test_bundles_run_on_servers(bundle: Path, wanted: List[Any]) -> None:
    """ES modules and CommonJS, under the oldest node that is supported and a newer one."""
    scripts = sorted((bundle / "server").glob("*.[mc]js"))
    own = [path for path in scripts if path.stem in ("server", "required")]
    assert own or bundle.name.startswith("parcel")  # which the app asks for its page alone
    for version in (20, 22):
        for script in own:
            assert printed(node(version), script) == wanted, (version, script)


def test_bundles_name_the_source_of_the_data(bundle: Path) -> None:
    """As its licence wants it. Parcel drops all comments: there the page shows labial.attribution."""
    if bundle.name.startswith("parcel"):
        return
    texts = [path.read_text(encoding="utf-8") for path in (bundle / "page").rglob("*") if path.is_file()]
    assert any("GRID audio-visual speech corpus" in text and "CC BY 4.0" in text for text in texts)


@pytest.mark.parametrize("version", [20, 22])
@pytest.mark.parametrize("script", ["server.js", "server.cjs"])
def test_unbundled_in_node(app: Path, wanted: List[Any], version: int, script: str) -> None:
    """``import`` and ``require()`` of the packages themselves."""
    assert printed(node(version), app / script) == wanted


def test_unbundled_in_chromium(app: Path, browser: Browser, wanted: List[Any], tmp_path: Path) -> None:
    """A page with an import map, workers and worklets that name the files."""
    folder = shutil.copytree(app, tmp_path / "page")
    html = folder / "index.html"
    paths = {"labial": "./node_modules/labial/index.js", "labial/": "./node_modules/labial/",
             "labial-laughter": "./node_modules/labial-laughter/index.js",
             "labial-hearing": "./node_modules/labial-hearing/index.js",
             "labial-words": "./node_modules/labial-words/index.js"}
    html.write_text(html.read_text().replace(
        "<script type", f'<script type="importmap">{json.dumps({"imports": paths})}</script><script type'))
    for path in folder.glob("*.js"):
        if path.name != "page.js":  # workers have no import maps
            text = path.read_text()
            for name in ("labial", "labial-laughter", "labial-words"):
                text = text.replace(f'"{name}"', f'"{paths[name]}"')
            path.write_text(text)
    check_page(browser, folder, wanted, True)


def test_a_page_that_only_speaks_is_small(app: Path) -> None:
    """70 KB compressed, file by file; without what draws the mouth. Catches laughter that comes along."""
    folder = app / "node_modules" / "labial"
    names = ["index.js"]
    for name in names:
        text = (folder / name).read_text(encoding="utf-8")
        names += [found for found in re.findall(r'^import .* from "\./(.*)";$', text, re.MULTILINE)
                  if found not in names]
    assert "speech.js" in names and "mouth.js" not in names
    assert sum(len(gzip.compress((folder / name).read_bytes(), 9)) for name in names) <= 70_000


# ---- Types, under TypeScript's `strict`: what they allow and refuse, and the code of the pages and the kiosk

#: The pages whose JavaScript is compiled.
PAGES = ("browser.md", "adapters.md", "kiosk.md", "streams.md", "timings.md", "words.md")
#: What the code of pages takes from elsewhere: the elements that scripts find by their ids, and what the reader has.
AROUND = """\
declare const mouth: SVGElement;
declare const face: import("labial/labial-face.js").LabialFace;
declare module "*/labial/index.js" { export * from "labial"; }
declare module "*/labial/labial-face.js" { export * from "labial/labial-face.js"; }
declare module "*/labial/labial-mouth.js" { export * from "labial/labial-mouth.js"; }
declare module "three/*";
declare module "@pixiv/three-vrm";
declare module "@echogarden/espeak-ng-emscripten";
declare module "n2words/en-US" { export function toCardinal(value: number | string | bigint): string; }
declare module "@met4citizen/talkinghead";
"""


@pytest.fixture(scope="module")
def project(npm_package: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the packages installed and node's types."""
    folder = tmp_path_factory.mktemp("types") / "project"
    install(npm_package, folder)
    for name in ("@types", "@vue", "csstype", "react", "react-dom", "scheduler", "undici-types", "vue"):
        (folder / "node_modules" / name).symlink_to(tools() / "node_modules" / name)
    (folder / "package.json").write_text('{ "type": "module" }')
    return folder


def compiled(project: Path, files: List[str], module: str = "nodenext", **options: object) -> str:
    settings: Dict[str, object] = {
        "strict": True, "noEmit": True, "target": "es2022", "module": module, "types": ["node"],
        "lib": ["es2023", "dom", "dom.iterable"], **options}
    (project / "tsconfig.json").write_text(json.dumps({"compilerOptions": settings, "files": files}))
    program = tools() / "node_modules" / "typescript" / "bin" / "tsc"
    done = subprocess.run([str(node(22)), str(program), "-p", str(project)], capture_output=True, encoding="utf-8",
                          timeout=120, check=False)
    assert done.returncode in (0, 1, 2), done.stderr
    return done.stdout + done.stderr


@pytest.mark.parametrize("module", ["nodenext", "node16", "esnext", "preserve"])
def test_types_allow_and_refuse(project: Path, module: str) -> None:
    """Catches weights that any name fits, and packages whose types some setting of the compiler does not find."""
    names = ["types.ts"] + (["types.cts"] if module == "nodenext" else [])
    for name in names:
        shutil.copyfile(FOLDER / name, project / name)
    resolution = {} if module.startswith("node") else {"moduleResolution": "bundler"}
    assert compiled(project, names, module, **resolution) == ""


#: Of each framework a file with an error that the compiler must find.
WRONG = {
    "react-wrong.tsx": 'import type {} from "labial/react";\n'
                       "// @ts-expect-error a track is no text\n"
                       'export const wrong = <labial-face track="hello" />;\n',
    "vue-wrong.ts": 'import type { GlobalComponents } from "vue";\nimport type {} from "labial/vue";\n'
                    'type Props = InstanceType<GlobalComponents["labial-face"]>["$props"];\n'
                    "// @ts-expect-error a track is no text\n"
                    'export const wrong: Props = { track: "hello" };\n',
}


@pytest.mark.parametrize("framework", ["react", "vue"])
def test_elements_of_frameworks(project: Path, framework: str) -> None:
    """The hooks of docs/frameworks.md, and elements in JSX and templates: catches a property that nothing types."""
    blocks = {**{block.name: block.text for block in parse(SOURCE / "docs" / "frameworks.md") if block.name}, **WRONG}
    files = [name for name in blocks if name.startswith(f"{framework}-")]
    assert len(files) > 1
    for name in files:
        (project / name).write_text(blocks[name])
    options: Dict[str, object] = {"jsx": "react-jsx", "moduleResolution": "bundler", "types": []}
    assert compiled(project, files, "esnext", **options) == ""


def test_react_takes_over_what_a_server_wrote(project: Path, browser: Browser) -> None:
    """The component of docs/frameworks.md: React complains of every attribute that an element adds to the server's."""
    for block in parse(SOURCE / "docs" / "frameworks.md"):
        if block.name == "react-lips.tsx":
            (project / block.name).write_text(block.text)
    speaker = '<Speaker sound="data:," segments={[{ start: 0, end: 1, label: "AA" }]} />'
    (project / "server.tsx").write_text('import { renderToString } from "react-dom/server";\n'
                                        'import { Speaker } from "./react-lips";\n'
                                        f"console.log(JSON.stringify(renderToString({speaker})));\n")
    (project / "client.tsx").write_text('import { hydrateRoot } from "react-dom/client";\n'
                                        'import { Speaker } from "./react-lips";\n'
                                        "window.errors = [];\n"
                                        "console.error = (...told) => window.errors.push(told.join(' '));\n"
                                        f"hydrateRoot(document.querySelector('main'), {speaker});\n")
    for entry, out, options in (("server.tsx", "server.cjs", ["--platform=node"]),
                                ("client.tsx", "client.js", ["--format=esm"])):
        run(tools() / "node_modules" / ".bin" / "esbuild", project / entry, "--bundle", "--jsx=automatic",
            '--define:process.env.NODE_ENV="development"', f"--outfile={project / out}", "--log-level=error", *options)
    written = printed(node(22), project / "server.cjs")
    (project / "index.html").write_text(f'<link rel="icon" href="data:,"><main>{written}</main>'
                                        '<script type="module" src="client.js"></script>')
    with served(project) as site:
        page = browser.page(f"{site}/index.html")
        page.wait_for("document.querySelector('labial-face').track?.duration > 1")
        assert page.evaluate("errors") == [] == page.errors()


def test_code_of_pages_compiles(project: Path) -> None:
    """Catches examples that only JavaScript lets pass."""
    files = ["around.d.ts"]
    (project / files[0]).write_text(AROUND)
    for name in PAGES:
        page = SOURCE / "docs" / name
        (project / page.stem).mkdir()
        for block in parse(page):
            if block.label == "js":
                codes = [block.text]
            elif block.label == "html":
                codes = re.findall(r'<script type="module">\n(.*?)</script>', block.text, re.DOTALL)
            else:
                continue
            named = block.name if block.name and block.name.endswith(".js") else f"{block.line}.js"
            for code in codes:
                files.append(f"{page.stem}/{named}")
                (project / files[-1]).write_text(code + "\nexport {};\n")
    assert len(files) > 5
    files.append("kiosk.js")
    shutil.copyfile(SOURCE / "examples" / "kiosk" / "kiosk.js", project / "kiosk.js")
    # Parameters of JavaScript have no types; all else is strict.
    assert compiled(project, files, allowJs=True, checkJs=True, noImplicitAny=False) == ""
