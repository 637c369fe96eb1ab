"""README.md and every page of docs/ do what they say; pages.py has the conventions that make them checkable."""

from __future__ import annotations

import dataclasses
import os
import re
import shutil
import time
from pathlib import Path
from typing import Dict, List

import numpy as np
import pytest

import pages
from models import write_episode
from packages import SOURCE, copy_sources
from pages import LINK, Given, MissingTool, PageError, Runner, headings
from test_evaluate import law, planted
from test_record import seen
from test_see import wav

PAGES = [SOURCE / "README.md", *sorted((SOURCE / "docs").glob("*.md"))]
#: Pages that build packages or programs, simulate boards, train or draw.
SLOW = ("README.md", "arduino.md", "browser.md", "hearing.md", "install.md", "kiosk.md", "laughing.md", "packages.md",
        "porting.md", "record.md", "see.md", "servos.md", "streams.md", "words.md")

#: Lines of pages that are not run, and why.
NOT_RUN: Dict[str, Dict[str, str]] = {
    "README.md": {
        "cmake --workflow --preset demo": ".ci/bare runs it",
        "cmake --workflow --preset test": "this test is a part of it",
        "pip install '.[train,evaluate]'": "fetches; test_wheel.py installs the package without",
        "labial evaluate export/corpora/grid_s1 --splits 20 -o report/":
            "takes too long; test_evaluate.py runs it on less",
    },
    "arduino.md": {
        "sudo apt-get install -y python3-venv build-essential gcc-avr avr-libc avrdude": "installs",
        "python3 -m venv tools": "what it makes is there already, with the tests' own packages",
        'tools/bin/pip install "$LABIAL[align]"': "fetches; test_wheel.py installs the package without",
        "avrdude -c arduino -p m328p -P /dev/ttyACM0 -U flash:w:jaw.elf": "needs a board; the page simulates one",
    },
    "figures.md": {"cmake --workflow --preset bench": "needs every board's tools; a workflow of its own"},
    "hearing.md": {
        "labial train-hear speech/ -o hear.npz": "needs PyTorch and speech; tests/hearing trains on less",
        "labial evaluate-hear hear.npz judge/ -o table.md": "needs the model above; another test judges one",
        "labial export hear.npz --name hear_mine -o .": "likewise",
        'sh "$LABIAL/export/hearing/train.sh" talkers/ lj/ kathleen/ out/': "takes hours and needs speech",
    },
    "install.md": {
        "sudo apt-get install -y build-essential cmake python3-venv flite flite1-dev": "installs",
        "python3 -m venv ~/labial-venv": "what it makes is there already, with the tests' own packages",
        ". ~/labial-venv/bin/activate": "likewise",
        "pip install '.[tools]'": "fetches; test_wheel.py installs the package without",
    },
    "method.md": {
        'labial train "$LABIAL/export/corpora/grid_s1" --method paper -o paper.npz': "takes a minute",
        'labial plot speech_en paper.npz --phones "$LABIAL/examples/demo/sentence.flite" '
        "--channels opening,stretch,fap17,fap16 -o sentence.svg": "needs the model above; test_see.py draws others",
        'cmake -S "$LABIAL" -B letter -D LABIAL_METHOD=paper -D LABIAL_BUILD_TESTS=OFF':
            "test_published.py has such a library",
        "cmake --build letter --target labial-python": "likewise",
        "LABIAL_RUNTIME=letter/flat/labial_runtime.so labial check paper.npz --predecessors 13 phones.lab":
            "needs the model above; test_published.py checks others",
        'git clone -q "$LABIAL" copy': "needs the model above and a board's tools",
        "labial export paper.npz --name speech_en --predecessors 13 -o copy/lib/models": "likewise",
        "cd copy": "likewise",
        "cmake --preset m0 -D LABIAL_METHOD=paper -D LABIAL_BUILD_BENCH=ON -D LABIAL_BUILD_TESTS=OFF": "likewise",
        "cmake --build --preset m0 --target run_bench_speech": "likewise",
        'python -m labial.evaluate.departures "$LABIAL/export/corpora/grid_s1" --splits 2 -o departures.md':
            "takes minutes; test_published.py runs it on less",
    },
    "python.md": {
        "pip install .": "fetches what builds it; test_wheel.py installs the package without",
    },
    "streams.md": {
        "pip install . websockets": "fetches what builds it; test_wheel.py installs the package without",
        "python3 examples/voices/stand_in.py &": "test_voice_examples.py runs both",
        'python3 examples/voices/follow_websocket.py "Maybe people hum by the pool."': "likewise",
    },
    "words.md": {
        "labial train-words cmudict.dict -o words.npz --held-out": "needs the dictionary; test_words.py trains on less",
    },
    "reproduction.md": {
        "python3 -m venv build/reproduce && build/reproduce/bin/pip install -r export/requirements-reproduce.txt":
            "takes minutes; test_reproduce.py runs it",
        "build/reproduce/bin/python export/reproduce.py": "likewise",
        "labial train export/corpora/grid_s1 --method paper -o paper.npz": "takes a minute",
        "labial synth paper.npz examples/demo/sentence.flite -o frames.csv":
            "needs the model above; test_published.py has another",
        "labial laughter-corpus LAUGHTER": "takes half a minute; test_laughter.py makes a smaller one",
        "python -m labial.evaluate.choices export/corpora/grid_s1 --splits 4 -o speech.md":
            "takes minutes; test_published.py runs it on less",
        "python -m labial.evaluate.choices LAUGHTER --kind laughter --splits 2 -o laughter.md": "likewise",
    },
    "record.md": {
        "labial landmarks recordings/s01.mp4 -o recordings/s01.npz": "needs MediaPipe; tests/tracking runs it",
        "labial align recordings/s01.mp4 --text-file recordings/s01.txt -o recordings/s01.lab": "likewise",
        "labial evaluate corpus/ --splits 5 -o report/": "takes too long; test_evaluate.py runs it on less",
        'labial train "$LABIAL/export/corpora/addresses" -o addresses.npz': "README.md trains it",
        'cd "$LABIAL/export/corpora" && labial train grid_s1 addresses grid_singles grid_more --talker-variance 1 '
        "-o ~/shared.npz": "takes a minute; test_talkers.py trains on less",
        "labial train corpus/ --adapt ~/shared.npz -o mine.npz": "needs the model above; test_talkers.py adapts",
    },
}


@pytest.fixture(scope="session")
def given(tmp_path_factory: pytest.TempPathFactory) -> Given:
    """The library and all bundled models, and a PATH without tools."""
    libraries = os.environ.get("LABIAL_LIBRARIES")
    if not libraries:
        pytest.skip("LABIAL_LIBRARIES names no build of the library and its models")
    return Given(libraries.split(os.pathsep), pages.path_without_tools(tmp_path_factory.mktemp("path")))


def table_rows_amiss(text: str) -> List[int]:
    """Numbers of the lines of a page's tables that have more or fewer cells than the header, or stand apart."""
    def cells(line: str) -> int:
        return len(re.split(r"(?<!\\)\|", re.sub(r"`[^`]*`", "", line).strip().strip("|")))

    amiss, width, fenced = [], 0, False
    lines = text.splitlines()
    for number, line in enumerate(lines, 1):
        fenced ^= line.startswith("```")
        if fenced or not line.startswith("|"):
            width = 0
        elif width == 0:
            width = cells(line)
            if number == len(lines) or not re.fullmatch(r"\|(\s*:?-+:?\s*\|)+", lines[number]):
                amiss.append(number)
        elif cells(line) != width or not line.rstrip().endswith("|"):
            amiss.append(number)
    return amiss


def test_rows_of_tables_are_found_amiss() -> None:
    """The check below can fail: on a lost row, a row that is broken over lines, a cell too few."""
    table = "| a | b |\n|---|---|\n| 1 | `x | y` |\n| 2 | 3 \\| 4 |\n"
    assert table_rows_amiss(table) == []
    assert table_rows_amiss(table + "| 5 | 6 | | 7 | 8 |\n") == [5]
    assert table_rows_amiss(table + "| 5 | 6\n7 |\n") == [5]
    assert table_rows_amiss(table + "\n| 5 | 6 |\n") == [6]


@pytest.mark.parametrize("page", sorted(item for item in SOURCE.rglob("*.md") if "build" not in item.parts
                                        and "node_modules" not in item.parts), ids=lambda item: item.name)
def test_every_row_of_a_table_has_the_cells_of_its_header(page: Path) -> None:
    """Would catch a formatter that joins or breaks rows."""
    assert table_rows_amiss(page.read_text(encoding="utf-8")) == []


def prepare(page: Path, folder: Path) -> None:
    """Makes what a page's reader has before its first command, or makes with commands that are not run."""
    if page.name == "README.md":
        copy_sources(folder)
        return
    folder.mkdir()
    if page.name == "record.md":
        write_recordings(folder)
        shutil.copyfile(SOURCE / "export" / "models" / "speech_en.npz", folder / "addresses.npz")
    if page.name == "arduino.md":
        (folder / "tools" / "bin").mkdir(parents=True)
        pages.write_program(folder / "tools" / "bin" / "labial", " -m labial")


def write_recordings(folder: Path) -> None:
    """What a face tracker and an aligner would have made of a small corpus's motion: recordings/, and a sound."""
    (folder / "recordings").mkdir()
    for number, item in enumerate(planted(law, 12, noise=3.0), 1):
        name = folder / "recordings" / f"s{number:02}"
        write_episode(name.parent, dataclasses.replace(item, name=name.name))
        name.with_suffix(".csv").unlink()
        np.savez(name.with_suffix(".npz"), landmarks=seen(item.frames), fps=50)
    (folder / "recordings" / "s01.mp4").write_bytes(wav())  # a page tells sounds by their content


@pytest.mark.parametrize("page", [pytest.param(page, marks=[pytest.mark.slow] if page.name in SLOW else [])
                                  for page in PAGES], ids=lambda page: page.name)
def test_page_works(page: Path, tmp_path: Path, given: Given) -> None:
    """A command with a wrong option, a program that does not compile, a step that was forgotten."""
    folder = tmp_path / "page"
    prepare(page, folder)
    try:
        Runner(page, folder, given, NOT_RUN.get(page.name, {})).run()
    except MissingTool as missing:
        pytest.skip(str(missing))
    except PageError as error:
        pytest.fail(str(error), pytrace=False)


def test_passed_over_lines_are_there() -> None:
    """What is not run is on the page as it stands in the list."""
    paths = {page.name: page for page in PAGES}
    for name, lines in NOT_RUN.items():
        text = paths[name].read_text(encoding="utf-8").splitlines()
        assert set(lines) <= {pages.command(line) for line in text}, name


@pytest.mark.parametrize("page", [page for page in PAGES if page.name != "install.md"], ids=lambda page: page.name)
def test_pages_say_where_their_commands_come_from(page: Path) -> None:
    """A page that uses `$LABIAL`, pip or one of Labial's programs, and does not lead to how they are installed."""
    text = page.read_text(encoding="utf-8")
    if re.search(r"\$LABIAL\b|pip install|^import labial$|^(python -m )?labial[ .-]", text, re.MULTILINE):
        assert any(address.endswith("install.md") for address in LINK.findall(text))


def test_every_extra_is_installed_somewhere() -> None:
    """An extra that a reader cannot find."""
    page = (SOURCE / "docs" / "install.md").read_text(encoding="utf-8")
    extras = re.search(r"^\[project\.optional-dependencies\]\n(.*?)\n\n", (SOURCE / "pyproject.toml").read_text(
        encoding="utf-8"), re.MULTILINE | re.DOTALL)
    assert extras
    for name in re.findall(r"^(\w+) = ", extras[1], re.MULTILINE):
        assert f"| `pip install '.[{name}]'` |" in page, name


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page: Path) -> None:
    """A page, a file or a heading that was renamed."""
    for address in LINK.findall(page.read_text(encoding="utf-8")):
        if "://" in address or address.startswith("mailto:"):
            continue
        path, _, heading = address.partition("#")
        target = page.parent / path if path else page
        assert target.exists(), f"{page.name}: {address}"
        if heading:
            assert heading in headings(target), f"{page.name}: {address}"


# ---- The checks themselves -----------------------------------------------------------------------------------------


def check(tmp_path: Path, text: str, given: Given) -> int:
    page = tmp_path / "page.md"
    (tmp_path / "page").mkdir(parents=True)
    page.write_text(text)
    return Runner(page, tmp_path / "page", given).run()


GOOD = """\
Text.

```c
/* shape.c - part of main.c's program */
int shape(void);
int shape(void) { return 3; }
```

```c
/* main.c */
#include "labial/labial.h"
int shape(void);
int main(void) { return labial_result_text(shape()) == 0; }
```

- A list:
  ```sh
  test -f main.c && test -f shape.c && test -d "$LABIAL/lib"
  labial --version > version.txt
  ```

```python
assert open("version.txt").read().startswith("labial ")
open("done", "w").close()
```

```sh
test -f done
pio run
```

```toml
# a/face.toml
x = 1
```

```ini
CONFIG_LABIAL=y
```
"""


def test_good_page_passes(tmp_path: Path, given: Given) -> None:
    assert check(tmp_path, GOOD, given) == 7
    assert (tmp_path / "page" / "a" / "face.toml").read_text().startswith("# a/face.toml")
    assert "pio" in pages.EXTERNAL


@pytest.mark.parametrize(("text", "complaint"), [
    ("```\nx\n```\n", "page.md:1"),
    ("```bash\nx\n```\n", 'label "bash"'),
    ("Text:\n\n    labial train x\n", "page.md:3: an indented code block"),
    ("```sh\ntrue\n", "never closed"),
    ("```text\nlabial train x\n```\n", "page.md:2: a command in a text block"),
    ("\n```sh\ntrue\nfalse\ntrue\n```\n", "page.md:3: status 1"),
    ("```sh\necho $UNKNOWN\n```\n", "page.md:2: status 2"),
    ("```c\nint x(void) { int y; return 0; }\n```\n", "unused variable"),
    ("```c\nint labial_no(void);\nint main(void) { return labial_no(); }\n```\n", "labial_no"),
    ("```cpp\n// A.ino\nvoid setup() { Serial.prin(1); }\n```\n", "prin"),
    ("```python\nassert False\n```\n", "AssertionError"),
    ("```js\nfunction x( {\n```\n", "SyntaxError"),
    ("```python\n# a.py\nx = = 1\n```\n", "(a.py, line 2)"),
    ("```cmake\nproject(x)\n```\n", "CMakeLists.txt"),
    ("```cmake\n# CMakeLists.txt\nproject(x)\n```\n", "no sh block"),
    ("```toml\nx = \n```\n", "page.md:2"),
    ("```json\n{,}\n```\n", "page.md:2"),
    ("```yaml\na: [\n```\n", "page.md:2"),
    ("```ini\n[a\n```\n", "page.md:2"),
    ("```toml\n# ../x.toml\n```\n", "outside"),
])
def test_bad_page_fails(tmp_path: Path, given: Given, text: str, complaint: str) -> None:
    with pytest.raises((PageError, MissingTool)) as raised:
        check(tmp_path, text, given)
    if raised.type is MissingTool:
        pytest.skip(str(raised.value))
    assert complaint in str(raised.value)


def test_headings_are_addressed_as_on_the_web(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text("# One\n\n## ARKit's `jaw`, 2\n\n```sh\n# no heading\n```\n\n## One\n")
    assert headings(page) == {"one", "arkits-jaw-2", "one-1"}
    assert LINK.findall("[a](b.md#c), ![d](e.svg) and [f]( g)") == ["b.md#c", "e.svg"]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_each_hidden_tool_is_named_at_once(page: Path, tmp_path: Path, given: Given,
                                           monkeypatch: pytest.MonkeyPatch) -> None:
    """A page that would fail or wait where a tool is missing; it sees no tools that it does not name."""
    for tool in Runner(page, tmp_path / "page", given).tools():
        folder = tmp_path / f"without {tool}"
        monkeypatch.setattr(pages, "find_tool", lambda name, hidden=tool: None if name == hidden else "/bin/sh")
        with pytest.raises(MissingTool, match=rf"{page.name}:\d+ needs {re.escape(tool)}: "):
            Runner(page, folder, given).run()
        assert not folder.exists()  # it ran nothing


def test_a_page_sees_only_tools_that_it_names(tmp_path: Path, given: Given) -> None:
    """Would catch a tool that is hidden nowhere: cmake is here on every machine."""
    assert pages.find_tool("cmake")
    check(tmp_path / "named", "```sh\ncmake --version\n```\n", given)
    with pytest.raises(PageError, match="status 127"):
        check(tmp_path / "not_named", "```sh\nname=cma\n${name}ke --version\n```\n", given)


def has_ended(process: str) -> bool:
    """Whether a process has ended, within two seconds; who inherited it may not have noticed."""
    for _ in range(40):
        try:
            if Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] in "ZX":
                return True
        except (FileNotFoundError, ProcessLookupError):  # the latter if it ends while it is read
            return True
        time.sleep(0.05)
    return False


@pytest.mark.parametrize(("first", "last", "complaint"), [
    ("true", "", "left running: sleep 600"), ("set -m", "", "left running: sleep 600"),
    ("true", "wait\n", "not done after 0.3 s"),
], ids=["same group", "own group", "hangs"])
def test_a_process_that_a_block_leaves_is_an_error(first: str, last: str, complaint: str, tmp_path: Path, given: Given,
                                                   monkeypatch: pytest.MonkeyPatch) -> None:
    """And is ended, even one that holds what the block prints to, or that the block waits for; one may end after it."""
    monkeypatch.setattr(pages, "GRACE", 0.2)
    monkeypatch.setattr(pages, "LONGEST", 0.3)
    with pytest.raises(PageError, match=f"page.md:2: {complaint}"):
        check(tmp_path, f"```sh\n{first}\nsleep 0.1 &\nsleep 600 &\necho $! > left\n{last}```\n", given)
    assert has_ended((tmp_path / "page" / "left").read_text().strip())
