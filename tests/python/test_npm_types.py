"""The npm packages' types, under TypeScript's `strict`: what they allow and refuse, and the code of the pages and of
the kiosk against them."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from pathlib import Path
from typing import Dict, List

import pytest

from bundlers import FOLDER, MISSING, install, node, tools
from npm import package
from packages import SOURCE
from pages import parse

pytestmark = [pytest.mark.slow, pytest.mark.skipif(bool(MISSING), reason=MISSING)]

#: The pages whose JavaScript is compiled.
PAGES = ("browser.md", "adapters.md", "kiosk.md", "timings.md")
#: What the code of pages takes from elsewhere: the elements that scripts find by their ids, and what the reader has.
AROUND = """\
declare const mouth: SVGElement;
declare const face: import("labial/labial-mouth.js").LabialMouth;
declare module "*/labial/index.js" { export * from "labial"; }
declare module "*/labial/labial-mouth.js" { export * from "labial/labial-mouth.js"; }
declare module "three/*";
declare module "@pixiv/three-vrm";
declare module "@met4citizen/talkinghead";
"""


@pytest.fixture(scope="module")
def project(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the packages installed and node's types."""
    folder = tmp_path_factory.mktemp("types") / "project"
    install(package(tmp_path_factory.mktemp("npm") / "build"), folder)
    (folder / "node_modules" / "@types").symlink_to(tools() / "node_modules" / "@types")
    (folder / "node_modules" / "undici-types").symlink_to(tools() / "node_modules" / "undici-types")
    (folder / "package.json").write_text('{ "type": "module" }')
    return folder


def compiled(project: Path, files: List[str], module: str = "nodenext", **options: object) -> str:
    """What the compiler complains of."""
    settings: Dict[str, object] = {
        "strict": True, "noEmit": True, "target": "es2022", "module": module, "types": ["node"],
        "lib": ["es2023", "dom", "dom.iterable"], **options}  # fmt: skip
    (project / "tsconfig.json").write_text(json.dumps({"compilerOptions": settings, "files": files}))
    program = tools() / "node_modules" / "typescript" / "bin" / "tsc"
    done = subprocess.run([str(node(22)), str(program), "-p", str(project)], capture_output=True, encoding="utf-8",
                          timeout=120, check=False)  # fmt: skip
    assert done.returncode in (0, 1, 2), done.stderr
    return done.stdout + done.stderr


@pytest.mark.parametrize("module", ["nodenext", "node16", "esnext", "preserve"])
def test_types_allow_and_refuse(project: Path, module: str) -> None:
    """Catches weights that any name fits, and packages whose types some setting of the compiler does not find."""
    names = ["types.ts"] + (["types.cts"] if module.startswith("node") else [])
    for name in names:
        shutil.copyfile(FOLDER / name, project / name)
    resolution = {} if module.startswith("node") else {"moduleResolution": "bundler"}
    assert compiled(project, names, module, **resolution) == ""


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
