"""Runs the tests of the Python package and of the npm packages on mutants."""

from __future__ import annotations

import ast
import json
import math
import os
import resource
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, List, Optional, Tuple

from mutants import Mutant

ROOT = Path(__file__).resolve().parents[2]
#: The tests that must notice changes of a file, the quickest first: modules of tests/python, suites of tests/npm.
COVERED: Dict[str, Tuple[str, ...]] = {
    "export/labial/tables/quantise.py": ("test_quantise.py", "test_model.py", "test_runtime_models.py"),
    "export/labial/tables/fixed.py": ("test_quantise.py", "test_model.py", "test_runtime_models.py"),
    "export/labial/hearing/quantise.py": ("test_hearing.py", "test_runtime_hearing.py"),
    "export/labial/runtime/hearing.py": ("test_runtime_hearing.py", "test_hear_program.py"),
    "export/labial/runtime/rig.py": ("test_rig.py", "test_face.py", "test_beside.py"),
    "export/labial/runtime/face.py": ("test_face.py", "test_esp32_hear.py"),
    "export/labial/runtime/beside.py": ("test_beside.py", "test_esp32_beside.py"),
    "export/labial/runtime/voice.py": ("test_voice.py", "test_voice_sessions.py"),
    "export/labial/corpus/services.py": ("test_services.py", "test_messages.py"),
    "export/labial/corpus/service_files.py": ("test_services.py", "test_timings.py"),
    "export/labial/corpus/messages.py": ("test_messages.py", "test_services.py", "test_voice.py"),
    "export/labial/rig/table.py": ("test_rig.py", "test_outputs.py"),
    "export/labial/rig/description.py": ("test_rig.py", "test_outputs.py"),
    "web/hearing/index.js": ("hearing.test.mjs", "test_runtime_hearing.py", "test_browser_hearing.py"),
    "web/hearing/tap.js": ("hearing.test.mjs", "test_browser_hearing.py"),
    "web/labial-face.js": ("mouth.test.mjs", "test_browser_elements.py"),
    "web/track.js": ("streams.test.mjs", "test_npm.py"),
    "web/stream.js": ("streams.test.mjs", "conformance.test.mjs", "test_npm.py"),
    "web/memory.js": ("streams.test.mjs", "conformance.test.mjs", "test_npm.py"),
    "web/entries.js": ("words.test.mjs", "test_npm_words.py", "test_services.py"),
    "web/services.js": ("words.test.mjs", "test_npm_words.py", "test_services.py"),
    "web/words/voice.js": ("voices.test.mjs", "test_npm_words.py", "test_voice_sessions.py"),
    "web/words/messages.js": ("voices.test.mjs", "words.test.mjs", "test_npm_words.py"),
    "web/words/readers.js": ("words.test.mjs", "test_npm_words.py"),
}
#: The packages of npm that have scripts, and the folders of their sources.
PACKAGES = {"npm": "web", "npm-words": "web/words", "npm-hearing": "web/hearing"}
#: A test hangs if it takes this many times the processor time of the unchanged sources.
PATIENCE, LEAST_SECONDS = 5.0, 20.0


@dataclass
class _Call:
    """A test on a copy of the sources in a folder; `variables` are the environment's."""

    name: str
    command: List[str]
    seconds: float = 0.0


class Packages:
    """The Python package and the npm packages, of which each mutant replaces a file in a copy."""

    def __init__(self, folder: Path, build: Path, files: List[str], suites: List[str]) -> None:
        self.folder, self.calls = folder, {}  # type: Path, Dict[str, List[_Call]]
        folder.mkdir(parents=True, exist_ok=True)
        command = ["ctest", "--test-dir", str(build), "--show-only=json-v1"]
        described = subprocess.run(command, check=True, capture_output=True)
        tests = {test["name"]: test for test in json.loads(described.stdout)["tests"]}
        values = next(item["value"] for item in tests["pytest"]["properties"] if item["name"] == "ENVIRONMENT")
        self.variables = dict(value.split("=", 1) for value in values)
        made = build / "python" / "bin" / "python"  # by a test; else another one that has all that tests need
        self.python = str(made) if made.exists() else sys.executable
        self.npm = Path(self.variables.get("LABIAL_NPM_PACKAGE", ""))
        known: Dict[str, _Call] = {}
        with tempfile.TemporaryDirectory(dir=self.folder) as name:
            for file in files:
                for test in COVERED[file]:
                    if test not in known and (not suites or test in suites):
                        known[test] = self._measured(test, Path(name))
                self.calls[file] = [known[test] for test in COVERED[file] if test in known]

    def verdict(self, mutant: Mutant) -> Optional[str]:
        """What kills a mutant: the name of a test, or `compiler`. Empty for a survivor; None if nothing changed."""
        source = (ROOT / mutant.file).read_text(encoding="utf-8")
        changed = mutant.apply(source)
        with tempfile.TemporaryDirectory(dir=self.folder) as name:
            folder = Path(name)
            if mutant.file.endswith(".py"):
                try:
                    if ast.dump(ast.parse(changed)) == ast.dump(ast.parse(source)):
                        return None
                except SyntaxError:
                    return "compiler"
            self._lay_out(folder, mutant.file)
            for place in self._places(folder, mutant.file):
                place.unlink()
                place.write_text(changed, encoding="utf-8")
                if place.suffix == ".js" and subprocess.run(["node", "--check", place], capture_output=True).returncode:
                    return "compiler"
            for call in self.calls[mutant.file]:
                if self._fails(call, folder, max(LEAST_SECONDS, PATIENCE * call.seconds)):
                    return call.name
            return ""

    def _measured(self, test: str, folder: Path) -> _Call:
        """A test, which must pass on the sources as they are."""
        if test.endswith(".mjs"):
            call = _Call(test, ["node", "--expose-gc", str(ROOT / "tests" / "npm" / test)])
        else:
            call = _Call(test, [self.python, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider", "-p", "no:xdist",
                                "--rootdir", str(ROOT), str(ROOT / "tests" / "python" / test)])
        place = folder / test
        self._lay_out(place, "export/")
        self._lay_out(place, "web/")
        began = resource.getrusage(resource.RUSAGE_CHILDREN)
        if self._fails(call, place, 600):
            raise SystemExit(f"{test} fails on the sources as they are")
        ended = resource.getrusage(resource.RUSAGE_CHILDREN)
        call.seconds = ended.ru_utime + ended.ru_stime - began.ru_utime - began.ru_stime
        return call

    def _lay_out(self, folder: Path, file: str) -> None:
        """Copies, as links, what holds a file."""
        if file.startswith("export/") and not (folder / "export").exists():
            shutil.copytree(ROOT / "export" / "labial", folder / "export" / "labial", copy_function=os.symlink,
                            ignore=shutil.ignore_patterns("__pycache__"))
            (folder / "export" / "models").symlink_to(ROOT / "export" / "models")
        elif file.startswith("web/"):
            for package in (*PACKAGES, "npm-hearing-host", "npm-laughter"):
                shutil.copytree(self.npm.with_name(package), folder / package)

    def _places(self, folder: Path, file: str) -> List[Path]:
        """Where a file is in the copy."""
        if file.startswith("export/"):
            return [folder / file]
        package = next(name for name, source in PACKAGES.items() if source == str(Path(file).parent))
        return [folder / package / Path(file).name]

    def _fails(self, call: _Call, folder: Path, limit: float) -> bool:
        """Whether a test fails on a copy, or hangs: `limit` seconds of the processor and more."""
        environment = {**os.environ, **self.variables, "PYTHONDONTWRITEBYTECODE": "1", "LABIAL_REQUIRE_ALL": "ON"}
        if (folder / "export").exists():
            environment["PYTHONPATH"] = str(folder / "export")
        if (folder / "npm").exists():
            environment["LABIAL_NPM_PACKAGE"] = str(folder / "npm")
        limited = ["sh", "-c", f'ulimit -t {math.ceil(limit)} && exec "$0" "$@"', *call.command]
        done = subprocess.run(limited, env=environment, cwd=folder, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL, timeout=limit * 10)
        return done.returncode not in (0, 5)
