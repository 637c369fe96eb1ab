"""Figures that take longer than a check may: what commands printed, kept in bench/records.json.

A record says when it was made and of what: a digest of the bundled models and of the conformance frames, one of which
changes with everything that changes the motion. Sections of export/RESULTS.md have records without figures; their
tables are in the page itself.
"""

from __future__ import annotations

import datetime
import hashlib
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Callable, Dict, List, Mapping, Sequence, Tuple

from measure.sources import cells, number, rows, tables

FILE = Path("bench") / "records.json"
RESULTS = Path("export") / "RESULTS.md"
#: What the motion of the bundled models depends on, below the folder of the sources. Of the streams of FRAMES these are
#: speech or laughter as it is measured; others change models, are cancelled, mumble or end before they begin.
FRAMES = "tests/conformance/frames.txt"
MOTION = ("export/models/speech_en.npz", "export/models/laughter_synthetic.npz", FRAMES)
STREAMS = ("sentence", "phonemes", "laugh", "vowels", "consonants", "long_vowel", "short_stops", "pauses", "graded")
#: Voices whose closures are counted, and one to which nothing was fitted.
VOICES = ("flite:kal", "flite:slt", "flite:rms", "espeak:en-us", "espeak:en-gb-x-rp", "espeak:en-gb-scotland",
          "espeak:en-us+f2", "espeak:en-us+m3")
OTHER_VOICE = "flite:awb"

Figures = Dict[str, float]
#: What hearing depends on besides.
HEARD = (*(f"export/models/hear_{name}.npz" for name in ("ahead", "host", "large", "small")), "tests/c/hears.h")


@dataclass(frozen=True)
class Command:
    """A command whose output holds figures; `{}` in it is an empty folder. The last of several prints them."""

    lines: Tuple[str, ...]
    read: Callable[[str], Figures]
    of: Tuple[str, ...] = MOTION  #: files that the figures depend on


def _search(text: str) -> Figures:
    table = [cells(line) for line in text.splitlines() if re.match(r"\| \d", line)]
    return {f"{lag} {width} {what}": float(value) for lag, width, *both in table
            for what, value in zip(("states", "motion"), both)}


def _side_by_side(text: str) -> Figures:
    found: Figures = {}
    for name, distances in re.findall(r"^(\w+): least opening in each p, b, m: (.*)$", text, re.MULTILINE):
        values = [float(value) for value in distances.split()[1::2]]
        found.update({f"{name} least": min(values), f"{name} most": max(values), f"{name} count": len(values)})
    return found


def _closures(text: str) -> Figures:
    found: Figures = {}
    for names, pattern in (
        (("stops", "sentences", "stops: most"), r"(\d+) p, b, m in (\d+) sentences: at most (\d+)"),
        (("f, v", "f, v: 95 %", "f, v: half"), r"(\d+) f, v: at least (-?\d+) in 95 %, (-?\d+) in half"),
        (("short", "reach"), r"(-?\d+) us short in the median, (\d+) % reach")):
        found.update(zip(names, map(float, re.findall(pattern, text)[0])))
    for slew, acceleration, values in re.findall(r"^ +(\d+|-) +(\d+|-) \| (.*)$", text, re.MULTILINE):
        for sight, pair in zip(("1", "6", "10", "32"), re.findall(r"(\S+) (\S+)", values)):
            found[f"{slew} {acceleration} {sight}: closed"], found[f"{slew} {acceleration} {sight}: opening"] = \
                map(float, pair)
    return found


def _laughs(text: str) -> Figures:
    found: Figures = {"speech": float(re.findall(r"^speech: (\d+)$", text, re.MULTILINE)[0])}
    for intensity, values in re.findall(r"^intensity (\d+): (.*)$", text, re.MULTILINE):
        found.update({f"{intensity} {name}": float(value) for name, value in
                      zip(("largest", "least", "most", "jaw", "corner"), values.split())})
    return found


def _window(text: str) -> Figures:
    values = re.findall(r"\d+\.\d+|^\d+(?= s$)", text, re.MULTILINE)
    return dict(zip(("least", "most", "mean", "difference", "seconds"), map(float, values)))


def _split(text: str) -> Figures:
    (table,) = tables(text)
    return {f"{method}: {measure}": number(value) for method, row in table.items() for measure, value in row.items()
            if measure != "method" and value != "-"}


def _lips(text: str) -> Figures:
    return {f"{row['lips of']} {row['method']}: {head}": number(value) for table in rows(text) for row in table
            for head, value in row.items() if head not in ("lips of", "method")}


#: Evaluates a model of hearing against real lips.
_BY_LIPS = ("python -m labial evaluate-hear export/models/{}.npz --lips export/corpora/grid_singles "
            "export/corpora/grid_more --lips export/corpora/addresses --methods "
            "'integers,loudness,phonemes,phonemes and sound'")
_SENTENCES = "tests/python/sentences.txt"
COMMANDS: Dict[str, Command] = {
    "search": Command(("python -m labial.evaluate.search speech_en export/corpora/grid_s1",), _search),
    "side by side": Command((
        "python -m labial train export/corpora/grid_s1 --method paper -o {}/paper.npz --quiet",
        "python -m labial plot speech_en {}/paper.npz --phones examples/demo/sentence.flite "
        "--channels opening,stretch,fap17,fap16 -o docs/images/demo_paper_and_labial.svg",
    ), _side_by_side),
    "closures": Command((f"python bench/closures.py {_SENTENCES} {' '.join(VOICES)}",), _closures),
    "closures of awb": Command((f"python bench/closures.py {_SENTENCES} {OTHER_VOICE}",), _closures),
    "window": Command(("python bench/window.py tests/python/sentences.flite",), _window),
    "laughs": Command(("python bench/laughs.py tests/python/sentences.flite",), _laughs),
    **{f"real lips, {model}": Command((_BY_LIPS.format(model),), _lips, MOTION + HEARD)
       for model in ("hear_ahead", "hear_host", "hear_large", "hear_small")},
    "first split": Command(("python export/reproduce.py split",), _split),
}


def read(root: Path) -> Dict[str, Dict[str, object]]:
    path = root / FILE
    return json.loads(path.read_text(encoding="utf-8")) if path.is_file() else {}


def write(root: Path, records: Mapping[str, Mapping[str, object]]) -> None:
    text = json.dumps(dict(sorted(records.items())), indent=2, ensure_ascii=False)
    (root / FILE).write_text(text + "\n", encoding="utf-8")


def digest(root: Path, record: str = "") -> str:
    """Of everything that the motion, or the figures of a record, depend on; of FRAMES these are the STREAMS. A stream
    begins with its name; its lines have numbers, or "and" and how often the line before comes again."""
    streams = rb"^(?:%s)\n(?:[-\d].*\n|and .*\n)*" % "|".join(STREAMS).encode()
    found = hashlib.sha256()
    for name in COMMANDS[record].of if record in COMMANDS else MOTION:
        content = (root / name).read_bytes()
        found.update(b"".join(re.findall(streams, content, re.MULTILINE)) if name == FRAMES else content)
    return found.hexdigest()[:16]


def section_commands(text: str) -> Dict[str, List[str]]:
    """The commands of `labial evaluate` in RESULTS.md by the heading above them, with those before them."""
    found: Dict[str, List[str]] = {}
    title = ""
    for line in text.splitlines():
        heading = re.match(r"#{2,3} (.*)", line)
        if heading:
            title = heading[1]
        elif line.startswith("    labial "):
            found.setdefault(title, []).append(line.strip())
    return {title: lines for title, lines in found.items() if lines[-1].startswith("labial evaluate ")}


def names(root: Path) -> List[str]:
    """All records: the commands' and RESULTS.md's sections."""
    return [*COMMANDS, *section_commands((root / RESULTS).read_text(encoding="utf-8"))]


def outdated(root: Path, records: Mapping[str, Mapping[str, object]]) -> List[str]:
    """The records that were made with other models or another library, and those that are missing."""
    return [name for name in names(root) if records.get(name, {}).get("of") != digest(root, name)]


def marked(text: str, records: Mapping[str, Mapping[str, object]], now: str) -> str:
    """RESULTS.md's text, with the line "Measured on ..." that belongs under each section's commands. Raises ValueError
    if a section has none."""
    for title in section_commands(text):
        record = records.get(title, {})
        day = datetime.date.fromisoformat(str(record.get("measured", "1970-01-01")))
        line = f"Measured on {day.day} {day:%B %Y}"
        line += "." if record.get("of") == now else ", before the latest change of the bundled models or their frames."
        begin = re.search(rf"^#+ {re.escape(title)}\n", text, re.MULTILINE)
        found = re.compile(r"^Measured on .*\.$", re.MULTILINE).search(text, begin.end() if begin else 0)
        if not found or re.search(r"^#", text[begin.end() : found.start()] if begin else "#", re.MULTILINE):
            raise ValueError(f"{RESULTS}: no line \"Measured on ...\" under the commands of {title!r}")
        text = text[: found.start()] + line + text[found.end() :]
    return text


def refresh(root: Path, write_page: bool) -> List[str]:
    """Holds the lines of :func:`marked` against the records, and writes them if asked to; returns the complaints, also
    about commands whose records are outdated."""
    page, kept = root / RESULTS, read(root)
    before = page.read_text(encoding="utf-8")
    after = marked(before, kept, digest(root))
    if write_page and after != before:
        page.write_text(after, encoding="utf-8")
    complaints = [f"{RESULTS}:{number}: {old} should be: {new}" for number, (old, new) in
                  enumerate(zip(before.splitlines(), after.splitlines()), 1) if old != new]
    complaints += [f"{FILE}: {name!r} was measured with other models or frames: python3 bench/figures.py --measure"
                   for name in outdated(root, kept) if name in COMMANDS]
    return complaints


def measure(root: Path, name: str) -> None:
    """Runs the commands of a record, and writes it; those of a section of RESULTS.md also write its tables."""
    page = root / RESULTS
    with tempfile.TemporaryDirectory(prefix="labial-figures-") as folder:
        if name in COMMANDS:
            for line in COMMANDS[name].lines:
                output = _run(root, line.replace("{}", folder))
            record: Dict[str, object] = {"command": COMMANDS[name].lines[-1], "figures": COMMANDS[name].read(output)}
        else:
            lines = section_commands(page.read_text(encoding="utf-8"))[name]
            for line in lines:
                line = re.sub(r"\bLAUGHTER\b", f"{folder}/LAUGHTER", line).replace("-o report/", f"-o {folder}/report")
                _run(root, "python -m " + line + " --quiet" * line.startswith("labial evaluate"))
            report = (Path(folder) / "report" / "report.md").read_text(encoding="utf-8")
            page.write_text(with_tables(page.read_text(encoding="utf-8"), name, report), encoding="utf-8")
            record = {"command": lines[-1]}
    record.update(of=digest(root, name), measured=datetime.date.today().isoformat())
    write(root, {**read(root), name: record})


def _run(root: Path, line: str) -> str:
    command = shlex.split(line)
    if command[0] == "python":
        command[0] = sys.executable
    print(line, flush=True)
    path = os.pathsep.join([str(root / "export"), str(root / "bench")])
    done = subprocess.run(command, cwd=root, stdout=subprocess.PIPE, text=True, check=False,
                          env={**os.environ, "PYTHONPATH": path, "OMP_NUM_THREADS": "1"})
    if done.returncode and not line.startswith("python export/reproduce.py"):  # which compares with the old table
        raise RuntimeError(f"{line} ended with {done.returncode}")
    return done.stdout


def with_tables(text: str, title: str, report: str) -> str:
    """RESULTS.md's text with the tables of a report in a section, each in the place of that with the same first column
    heads. Sections below it that have commands of their own keep theirs."""
    made = _blocks(report)
    begin = re.search(rf"^#+ {re.escape(title)}\n", text, re.MULTILINE)
    if not begin:
        raise ValueError(f"{RESULTS}: no section {title!r}")
    level, others = len(begin[0].split()[0]), section_commands(text)
    headings = re.compile(r"^(#+) (.*)$", re.MULTILINE).finditer(text, begin.end())
    end = next((one.start() for one in headings if len(one[1]) <= level or one[2] in others), len(text))
    body = text[begin.end() : end]
    for block in _blocks(body):
        new = next((one for one in made if _kind(one) == _kind(block)), None)
        if new:
            body = body.replace(block, new)
            made.remove(new)
    return text[: begin.end()] + body + text[end:]


def _blocks(text: str) -> List[str]:
    return re.findall(r"(?:^\|.*\n)+", text, re.MULTILINE)


def _kind(block: str) -> Sequence[str]:
    heads = block.splitlines()[0].split(" | ")
    return heads[1], heads[-1]
