"""Runs what a page of the documentation tells its reader to do.

A page is Markdown. Its code lies in fences with one of these labels; the blocks of a page are taken in order, in one
folder that is the page's own:

- ``sh``: run by ``sh -eu``, with labial, labial-say and the other programs on PATH and $LABIAL naming the source tree;
- ``c``, ``cpp``: compiled with warnings as errors; what has a main() is linked with the library, the bundled models and
  the page's other files of the same language; .ino files get the stub of Arduino.h;
- ``python``: run, or only compiled when it has a name;
- ``js``: compiled as a module;
- ``html``: a page, which an ``sh`` block below it looks at;
- ``cmake``: a CMakeLists.txt, which an ``sh`` block below it hands to cmake;
- ``toml``, ``ini``, ``json``, ``yaml``: parsed;
- ``ts``, ``tsx``: read here; test_bundlers.py compiles them;
- ``csharp``, ``gdscript``, ``unreal``, ``svelte``, ``vue``: code for engines and compilers that no test has; only read;
- ``text``: what programs print, drawings; no commands.

A block whose first line is a comment that begins with a file's name is saved under that name before anything else;
``sh`` blocks excepted. Fences without a label and indented code are errors of the page, so that nothing escapes.

Each block runs in a session of its own, for LONGEST seconds at most; then the whole session ends, and a process that
the block left behind is an error. Of TOOLS a page sees only those that its blocks name, or the programs that these
start. So a page that needs another one fails on every machine, not only on one that lacks it.
"""

from __future__ import annotations

import configparser
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Callable, Dict, Iterable, List, NamedTuple, Optional, Sequence, Set

from packages import CC, CXX, SOURCE

#: Seconds that a block may take, and that its processes have to end after it.
LONGEST = 240.0
GRACE = 2.0

#: Labels of blocks that are only read.
READ = ("text", "csharp", "gdscript", "unreal", "svelte", "vue")
#: Labels of blocks that are compiled elsewhere.
COMPILED = ("ts", "tsx")
LABELS = ("sh", "c", "cpp", "python", "js", "cmake", "html", "toml", "ini", "json", "yaml", *COMPILED, *READ)

#: Tools that a page may use and a machine may lack, and what installs each.
TOOLS: Dict[str, str] = {
    **{name: f"the Debian package {name}" for name in (
        "chromium", "clang", "cmake", "espeak-ng", "flite", "g++", "npm", "qemu-system-arm", "valgrind")},
    **{name: "a build with LABIAL_BUILD_EXAMPLES" for name in (
        "labial-bench", "labial-demo", "labial-hear", "labial-rig-sprites", "labial-say")},
    "arm-none-eabi-gcc": "the Debian package gcc-arm-none-eabi",
    "arm-none-eabi-g++": "the Debian package libstdc++-arm-none-eabi-newlib",
    "avr-gcc": "the Debian packages gcc-avr and avr-libc",
    "labial-say-espeak": "the Debian package libespeak-ng-dev, before the build",
    "labial-say-flite": "the Debian package flite1-dev, before the build",
    "node": "the Debian package nodejs",
    "pkg-config": "the Debian package pkgconf",
    "simavr": "the Debian packages simavr and libsimavr-dev",
    "wasm-ld": "the Debian package lld",
}

#: Commands that are never run: they fetch toolchains or frameworks when they are first used, or need a board.
EXTERNAL = ("arduino-cli", "idf.py", "pio", "west")

_FENCE = re.compile(r"^( {0,3})(`{3,}|~{3,})\s*(.*)$")
_NAME = re.compile(r"^(?:#|//|/\*|;|<!--)\s*((?:[\w.-]+/)*[\w-]+\.[A-Za-z]{1,6})(?=[\s,:]|$)")
_HEADING = re.compile(r"^#+ +(.*?) *#*$", re.MULTILINE)
_MAIN = re.compile(r"^int main\(", re.MULTILINE)
_COMMAND = re.compile(r"^\s*(?:\$ |sudo |(?:labial(?:-\w+)?|cmake|ctest|pip|pio|west|idf\.py|arduino-cli|cc|gcc|git) )")
_WORD = re.compile(r"[\w./+-]+")
_PROGRAM = (".py", ".sh", ".js", ".mjs")


#: The address in each link and picture of a page.
LINK = re.compile(r"\]\(([^()\s]+)\)")


class PageError(Exception):
    """A page that breaks the conventions or tells something that does not work; the text names file and line."""


class MissingTool(Exception):
    """A page needs something that this machine does not have."""


@dataclass
class Block:
    """One fenced block: its label, its first line's number in the page and its text; `name` when it names a file."""

    label: str
    line: int
    text: str
    name: Optional[str] = None


def parse(page: Path) -> List[Block]:
    """The fenced blocks of a page; raises PageError for code that no test would see."""
    blocks: List[Block] = []
    opened: Optional[re.Match] = None
    lines: List[str] = []
    blank = True
    for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
        fence = _FENCE.match(line)
        if opened is not None:
            if fence and fence[2].startswith(opened[2]) and not fence[3]:
                blocks.append(_block(page, opened[3].strip(), number - len(lines), lines))
                opened = None
                blank = True
            else:
                indent = len(line) - len(line.lstrip(" "))
                lines.append(line[min(len(opened[1]), indent) :])
        elif fence:
            opened, lines = fence, []
        else:
            if blank and re.match(r"(?: {4}|\t)\s*\S", line):
                raise PageError(f"{page}:{number}: an indented code block; fence it with a label")
            blank = not line.strip()
    if opened is not None:
        raise PageError(f"{page}: a fence is never closed")
    return blocks


def _block(page: Path, label: str, line: int, lines: Sequence[str]) -> Block:
    if label not in LABELS:
        raise PageError(f'{page}:{line - 1}: a fence with the label "{label}"; known are {", ".join(LABELS)}')
    match = _NAME.match(lines[0]) if lines and label not in ("sh", *READ) else None
    if match and ".." in Path(match[1]).parts:
        raise PageError(f"{page}:{line}: {match[1]} lies outside of the page's folder")
    for offset, text in enumerate(lines):
        if label == "text" and _COMMAND.match(text):
            raise PageError(f"{page}:{line + offset}: a command in a text block, where nobody would run it")
    return Block(label, line, "\n".join(lines) + "\n", match and match[1])


def headings(page: Path) -> Set[str]:
    """What follows # in addresses of a page's headings: small letters, hyphens for spaces, numbers when one recurs."""
    text = re.sub(r"^( {0,3})(`{3,}).*?^\1\2\s*$", "", page.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
    found: Dict[str, int] = {}
    for title in _HEADING.findall(text):
        name = re.sub(r"[^\w -]", "", title.lower()).replace(" ", "-")
        found[name] = found.get(name, -1) + 1
    return {name if number == 0 else f"{name}-{number}" for name, last in found.items() for number in range(last + 1)}


def command(line: str) -> str:
    """A line of a shell script without the comment that ends it."""
    return re.sub(r"\s+#.*$", "", line)


class Given(NamedTuple):
    """What all pages are run with: libraries to link programs with, and a PATH without TOOLS."""

    libraries: Sequence[str]
    path: str


def search_path() -> str:
    """The folders of this build's programs, and those of PATH."""
    listed = (os.environ.get(name, "") for name in ("LABIAL_PROGRAMS", "LABIAL_RIG_EXAMPLES", "PATH"))
    return os.pathsep.join(filter(None, listed))


def path_without_tools(folder: Path) -> str:
    """The search path, with links in `folder` in the place of each of its folders that holds one of TOOLS."""
    places: List[str] = []
    for place in search_path().split(os.pathsep):
        names = os.listdir(place) if os.path.isdir(place) else []
        if TOOLS.keys().isdisjoint(names):
            places.append(place)
            continue
        links = folder / str(len(places))
        links.mkdir(parents=True)
        for name in names:
            if name not in TOOLS:
                (links / name).symlink_to(Path(place) / name)
        places.append(str(links))
    return os.pathsep.join(places)


def find_tool(tool: str) -> Optional[str]:
    """Where one of TOOLS is, on PATH or in this build."""
    return shutil.which(tool, path=search_path())


def tools_of_program(path: Path, seen: Set[Path]) -> Set[str]:
    """The TOOLS that a program names in quotes, or those that it imports from its folder; `seen` are done already."""
    seen.add(path)
    text = path.read_text(encoding="utf-8")
    found = set(re.findall(r"[\"'`]([\w+-]+)[\"'`]", text)) & TOOLS.keys()
    if path.suffix == ".sh":
        found |= set(_WORD.findall(text)) & TOOLS.keys()
    for name in re.findall(r"^(?:from|import) (\w+)", text, re.MULTILINE):
        imported = path.with_name(name + ".py")
        if imported.is_file() and imported not in seen:
            found |= tools_of_program(imported, seen)
    return found


def in_session(session: int) -> Dict[int, str]:
    """The processes of a session, each with its command line; none where there is no /proc."""
    found: Dict[int, str] = {}
    for path in Path("/proc").glob("[0-9]*"):
        try:
            state, _, _, its_session = (path / "stat").read_text(errors="replace").rpartition(")")[2].split()[:4]
            if int(its_session) == session and state not in "ZX":
                found[int(path.name)] = (path / "cmdline").read_text(errors="replace").replace("\0", " ").strip()
        except OSError:  # it has ended
            pass
    return found


def end_session(session: int, grace: float) -> List[str]:
    """Ends the processes of a session; the command lines of those that were there `grace` seconds later."""
    until = time.monotonic() + grace
    while (left := in_session(session)) and time.monotonic() < until:
        time.sleep(0.02)
    for kill, process in ((os.killpg, session), *((os.kill, process) for process in left)):
        try:
            kill(process, signal.SIGKILL)
        except ProcessLookupError:
            pass
    return list(left.values())


def write_program(path: Path, arguments: str) -> None:
    """Writes a program that is this Python with arguments before its own."""
    path.write_text(f'#!/bin/sh\nexec "{sys.executable}"{arguments} "$@"\n')
    path.chmod(0o755)


class Runner:
    """Does what the blocks of one page say.

    Args:
        page: the page.
        folder: its folder, which exists.
        given: what all pages are run with.
        not_run: commands, whole lines of ``sh`` blocks, that are passed over.
    """

    def __init__(self, page: Path, folder: Path, given: Given, not_run: Iterable[str] = ()) -> None:
        self._page = page
        self._folder = folder
        self._libraries = given.libraries
        self._not_run = set(not_run)
        self._blocks = parse(page)
        self._bin = folder.with_name(folder.name + "-bin")
        self._bin.mkdir()
        for name, arguments in (("labial", " -m labial"), ("python3", ""), ("python", "")):
            write_program(self._bin / name, arguments)
        self._env = {**os.environ, "PATH": f"{self._bin}{os.pathsep}{given.path}", "LABIAL": str(SOURCE),
                     "PYTHONPATH": str(SOURCE / "export"), "PYTHONDONTWRITEBYTECODE": "1",
                     "OPENBLAS_NUM_THREADS": "1", "HOME": str(folder)}

    def tools(self) -> Dict[str, int]:
        """The TOOLS that the page needs, each with the line of the block that first does."""
        found: Dict[str, int] = {}
        for block in self._blocks:
            for tool in self._tools_of(block):
                found.setdefault(tool, block.line)
        return found

    def _tools_of(self, block: Block) -> Set[str]:
        if block.label == "js":
            return {"node"}
        if block.label == "python":
            return set(re.findall(r"[\"']([\w+-]+)[\"']", block.text)) & TOOLS.keys()
        if block.label != "sh":
            return set()
        words = _WORD.findall(re.sub(r'"?\$LABIAL"?/', "", self._script(block)))
        found = set(words) & TOOLS.keys()
        for program in {SOURCE / word for word in words if word.endswith(_PROGRAM) and (SOURCE / word).is_file()}:
            found |= tools_of_program(program, set())
        return found

    def run(self) -> int:
        """Runs every block; the number of commands, programs and files that were checked."""
        for tool, line in self.tools().items():
            place = find_tool(tool)
            if not place:
                raise MissingTool(f"{self._page.name}:{line} needs {tool}: {TOOLS[tool]}")
            (self._bin / tool).symlink_to(place)
        blocks = self._blocks
        for i, block in enumerate(blocks):
            if block.name:
                path = self._folder / block.name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(block.text, encoding="utf-8")
            try:
                if block.label not in (*READ, *COMPILED):
                    getattr(self, f"_{block.label}")(block, blocks[i + 1 :])
            except PageError as error:
                raise PageError(f"{self._page}:{block.line}: {error}") from None
        return sum(block.label not in (*READ, *COMPILED) for block in blocks)

    def _call(self, command: Sequence[str], text: Optional[str] = None) -> None:
        with tempfile.TemporaryFile() as output:  # not a pipe, which a process that stays behind would keep open
            child = subprocess.Popen(list(command), cwd=self._folder, env=self._env, stdout=output,
                                     stderr=subprocess.STDOUT, stdin=subprocess.PIPE if text else subprocess.DEVNULL,
                                     start_new_session=True)
            problems: List[str] = []
            try:
                child.communicate(text.encode() if text else None, timeout=LONGEST)
                if child.returncode:
                    problems.append(f"status {child.returncode}")
                problems += [f"left running: {process}" for process in end_session(child.pid, GRACE)]
            except subprocess.TimeoutExpired:
                problems.append(f"not done after {LONGEST:g} s")
                end_session(child.pid, 0.0)
                child.wait()
            if problems:
                output.seek(0)
                problems += [text or " ".join(command), output.read().decode("utf-8", "replace")]
                raise PageError("\n".join(problems))

    def _script(self, block: Block) -> str:
        return "\n".join(":" if self._is_passed_over(line) else line for line in block.text.splitlines()) + "\n"

    def _sh(self, block: Block, later: Sequence[Block]) -> None:
        self._call(["sh", "-eu", "-c", self._script(block)])

    def _is_passed_over(self, line: str) -> bool:
        words = line.split()
        return command(line) in self._not_run or bool(words) and words[0] in EXTERNAL

    def _compile(self, block: Block, compiler: List[str], suffix: str) -> None:
        name = block.name or f"block-{block.line}{suffix}"
        path = self._folder / name
        path.write_text(block.text, encoding="utf-8")
        options = ["-Wall", "-Wextra", "-Werror", "-I.", f"-I{SOURCE / 'include'}", f"-I{SOURCE / 'lib' / 'models'}",
                   f"-I{SOURCE / 'lib' / 'words'}"]
        target = str(path.with_name(path.name + ".out"))
        self._call([*compiler, *options, "-c", name, "-o", target])
        if _MAIN.search(block.text):
            others = [other for other in sorted(self._folder.glob(f"*{suffix}"))
                      if other != path and not _MAIN.search(other.read_text(encoding="utf-8"))]
            tail = ["-x", "none"] if "-x" in compiler else []
            self._call([*compiler, *options, name, *(str(other) for other in others), *tail, *self._libraries, "-lm",
                        "-o", target])
        if not block.name:
            path.unlink()

    def _c(self, block: Block, later: Sequence[Block]) -> None:
        if not (block.name or "").endswith(".h"):  # which is compiled where it is included
            self._compile(block, [CC, "-std=c99"], ".c")

    def _cpp(self, block: Block, later: Sequence[Block]) -> None:
        if not CXX:
            raise MissingTool(f"{self._page.name}:{block.line} needs a C++ compiler: {TOOLS['g++']}")
        stub = SOURCE / "tests" / "packages" / "arduino_stub"
        sketch = [f"-I{stub}", "-include", "Arduino.h"] if (block.name or "").endswith(".ino") else []
        self._compile(block, [CXX, "-std=gnu++11", *sketch, "-x", "c++"], ".cpp")

    def _python(self, block: Block, later: Sequence[Block]) -> None:
        try:
            compile(block.text, block.name or "block", "exec")
        except SyntaxError as error:
            raise PageError(str(error)) from None
        if not block.name:
            if re.search(r"^import labial$", block.text, re.MULTILINE) and not os.environ.get("LABIAL_RUNTIME"):
                raise MissingTool(f"{self._page.name}:{block.line} needs the run-time: build labial-python")
            self._call([sys.executable, "-"], block.text)

    def _js(self, block: Block, later: Sequence[Block]) -> None:
        path = self._folder / f"block-{block.line}.mjs"  # which says that it is a module
        path.write_text(block.text, encoding="utf-8")
        self._call(["node", "--check", path.name])
        path.unlink()

    def _cmake(self, block: Block, later: Sequence[Block]) -> None:
        if not block.name or Path(block.name).name != "CMakeLists.txt":
            raise PageError('a cmake block begins with "# CMakeLists.txt" or "# FOLDER/CMakeLists.txt"')
        if not any(other.label == "sh" and re.search(r"\bcmake\b", other.text) for other in later):
            raise PageError("no sh block below it runs cmake")

    def _html(self, block: Block, later: Sequence[Block]) -> None:
        if not block.name or not any(other.label == "sh" for other in later):
            raise PageError('an html block begins with "<!-- NAME.html -->", and an sh block below it looks at it')

    def _parsed(self, block: Block, later: Sequence[Block]) -> None:
        import yaml

        try:
            import tomllib
        except ModuleNotFoundError:  # Python before 3.11
            import tomli as tomllib
        ini = configparser.ConfigParser(interpolation=None)
        has_section = block.label != "ini" or re.search(r"^\[", block.text, re.MULTILINE)
        read: Callable[[str], object] = {"toml": tomllib.loads, "ini": ini.read_string, "json": json.loads,
                                         "yaml": yaml.safe_load}[block.label]
        try:
            read(block.text if has_section else "[all]\n" + block.text)
        except (ValueError, configparser.Error, yaml.YAMLError) as error:  # TOMLDecodeError is a ValueError
            raise PageError(str(error)) from None

    _toml = _ini = _json = _yaml = _parsed
