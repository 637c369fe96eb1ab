"""Makes small changes of the library, of the Python package or of the npm packages, and reports those that no test
detects.

    python3 tests/mutation/mutate.py --build build/mutate [--count 300] [--seed 1] [--jobs 2] [--survivors] [--list]
                                     [--kinds argument constant reset] [--files units.c] [--suites test_units]
    python3 tests/mutation/mutate.py --build build/mutate --packages build/test [--files web/stream.js] ...

Each mutant is one change of one of the kinds that mutants.py names, chosen by a seed. One of lib/ is compiled with
sanitizers, and the C suites, the conformance streams and the device tests run on it, the file's own suite first and
then the fastest first, until one fails or hangs: then it is killed. A mutant whose optimised code equals that of the
library is replaced by another. One of Python or JavaScript (--packages, with the build of the preset `test`) is killed
by the tests that COVERED names for its file. survivors.txt must list exactly those that survive, each with a
reason; of those that are not equivalent at least 95 % must be killed. With --survivors only those in survivors.txt are
tried, for instance after a new test for one of them. The library needs gcc or clang with sanitizers, cmocka and Unity.
"""

from __future__ import annotations

import argparse
import ast
import concurrent.futures
import itertools
import json
import math
import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, List, Optional, Sequence, Tuple, Union

from mutants import KINDS, Mutant, chosen, mutants

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
LIB = ROOT / "lib"
SURVIVORS = HERE / "survivors.txt"
#: The mutation score, the share of killed mutants among those that are not equivalent to the library.
REQUIRED = 0.95
#: A test hangs if it takes this many times the processor time of the unchanged sources, and at least so long.
PATIENCE, LEAST_SECONDS = 5.0, 20.0
#: Builds of the library that every mutant is tried in, in this order: name, definitions.
BUILDS = {"default": [], "lag": ["-DLABIAL_LAG=40", "-DLABIAL_WINDOW=15"],
          "word": ["-DLABIAL_LAG=9", "-DLABIAL_WINDOW=21"]}
#: Suites whose verdict depends on the limits, for all builds but the first.
LIMITED = ("test_units", "test_contact", "test_viterbi", "test_trajectory", "test_stream", "test_stream_delay",
           "test_stream_errors", "test_stream_steps")
#: With fewer rounds of what repeats with other numbers (tests/c/fixture.h); a mutant of other types is none.
FLAGS = ["-Werror=int-conversion", "-Werror=incompatible-pointer-types",
         "-std=c99", "-O1", "-g0", "-fPIC", "-fsanitize=address,undefined", "-fno-sanitize-recover=all",
         "-DLABIAL_TEST_SHARE=10"]
INCLUDES = [f"-I{ROOT / folder}" for folder in ("include", "lib/models", "lib/words", "lib", "tests/c",
                                                "tests/conformance", "tests/device", "boards")]
#: Runs the compiler for what no mutant changes: ccache, where the environment names it (.ci/run).
LAUNCHER = os.environ.get("CMAKE_C_COMPILER_LAUNCHER", "").split()
TABLES = sorted([*(LIB / "models").glob("*.c"), *(LIB / "words").glob("*.c")])


@dataclass
class Test:
    """A command, the build of the library that it is for, and the seconds of the processor that it takes."""

    name: str
    command: List[str]
    build: str = ""
    seconds: float = 0.0

    def is_of(self, step: str) -> bool:
        """Whether the program is the suite of a step of the library, which is most likely to detect a change."""
        return self.name.startswith(f"test_{step}") and self.seconds < 5


def run(command: Sequence[object], **options: object) -> subprocess.CompletedProcess:
    """Runs a command of the build itself, which must succeed."""
    return subprocess.run([str(part) for part in command], check=True, capture_output=True, **options)  # type: ignore


class Trials:
    passing: Tuple[int, ...] = (0,)

    def environment(self, folder: Path) -> Dict[str, str]:
        raise NotImplementedError

    def fails(self, test: Test, folder: Path, limit: float = 0.0) -> bool:
        """Whether a test fails, or hangs: `limit` seconds of the processor and more."""
        limit = limit or max(LEAST_SECONDS, PATIENCE * test.seconds)
        command = ["sh", "-c", f'ulimit -t {math.ceil(limit)} && exec "$0" "$@"', *test.command]
        done = subprocess.run(command, env={**os.environ, **self.environment(folder)}, cwd=folder, timeout=limit * 10,
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        return done.returncode not in self.passing

    def measure(self, test: Test, folder: Path) -> None:
        """Notes the seconds of a test, which must pass on the sources as they are."""
        began = resource.getrusage(resource.RUSAGE_CHILDREN)
        if self.fails(test, folder, 600):
            raise SystemExit(f"{test.name} fails on the sources as they are")
        ended = resource.getrusage(resource.RUSAGE_CHILDREN)
        test.seconds = ended.ru_utime + ended.ru_stime - began.ru_utime - began.ru_stime


class Bench(Trials):
    """The library and the tests, built once; mutants replace one object of the library."""

    def __init__(self, folder: Path, compiler: str, cmocka: Sequence[str], unity: Path, suites: Sequence[str]) -> None:
        self.folder, self.compiler, self.cmocka, self.suites = folder, compiler, list(cmocka), suites
        self.unity = [f"-I{unity / 'src'}", "-include", "unity_on_board.h", unity / "src" / "unity.c"]
        self.sources = sorted(LIB.glob("*.c"))
        self.reference: Dict[str, bytes] = {}
        self.tests: List[Test] = []
        folder.mkdir(parents=True, exist_ok=True)
        for build in BUILDS:
            (folder / build).mkdir(exist_ok=True)
            for source in self.sources:
                run(self.compile(build, source, folder / build / f"{source.stem}.o"))
            self.link(build, folder / build, {})
            self.build_tests(build)

    def compile(self, build: str, source: Path, target: Path) -> List[object]:
        """The command that compiles a file of the library, from wherever it lies."""
        return [*LAUNCHER, self.compiler, *FLAGS, *BUILDS[build], *INCLUDES, "-c", source, "-o", target]

    def optimised(self, source: Path, target: Path) -> bytes:
        """The optimised code of a file in all builds, for comparison."""
        code = b""
        for build, definitions in BUILDS.items():
            run([self.compiler, "-std=c99", "-O2", "-g0", *definitions, *INCLUDES, "-c", source, "-o", target])
            code += build.encode() + target.read_bytes()
        return code

    def link(self, build: str, folder: Path, replaced: Dict[str, Path]) -> None:
        """Links liblabial.so in `folder`, some of its objects being replaced."""
        objects = [replaced.get(source.stem, self.folder / build / f"{source.stem}.o") for source in self.sources]
        run([self.compiler, *FLAGS, "-shared", *objects, "-o", folder / "liblabial.so"])

    def build_tests(self, build: str) -> None:
        """Compiles and links the tests of a build, and measures them."""
        suites = ROOT / "tests" / "c"
        helpers = [path for path in sorted(suites.glob("*.c")) if not path.name.startswith("test_")]
        archive = self.folder / build / "helpers"
        archive.mkdir(exist_ok=True)
        for path in helpers + TABLES * (build == "default"):
            run(self.compile(build, path, archive / f"{path.stem}.o"))
        objects = sorted(archive.glob("*.o"))
        if build != "default":  # tables depend on no limit
            objects += [self.folder / "default" / "helpers" / f"{path.stem}.o" for path in TABLES]
        programs: Dict[str, List[object]] = {
            path.stem: [path, *objects, *self.cmocka] for path in sorted(suites.glob("test_*.c"))
            if build == "default" or path.stem in LIMITED}
        if build == "default":
            streams = [ROOT / "tests" / "conformance" / name for name in ("player.c", "vectors.c")]
            boards = ["text.c", "uncounted.c", "host/host.c"]
            board = ['-DBOARD_NAME="host"', *(ROOT / "boards" / name for name in boards)]
            device = ROOT / "tests" / "device"
            programs["conformance"] = [ROOT / "tests/conformance/conformance.c", *streams, *board, *objects]
            programs["device_tests"] = [*sorted(device.glob("test_*.c")), device / "device_tests.c", device / "main.c",
                                        *self.unity, *streams, *board, *objects]
        if self.suites:
            programs = {name: parts for name, parts in programs.items() if name in self.suites}
        for name, parts in programs.items():
            program = self.folder / build / name
            libraries = [f"-L{self.folder / build}", "-llabial", "-lm"]
            run([self.compiler, *FLAGS, *BUILDS[build], *INCLUDES, *parts, *libraries, "-o", program])
            self.tests.append(Test(name, [str(program)], build))
            self.measure(self.tests[-1], self.folder / build)
        self.tests.sort(key=lambda test: test.seconds)

    def environment(self, folder: Path) -> Dict[str, str]:
        return {"LD_LIBRARY_PATH": str(folder), "ASAN_OPTIONS": "detect_leaks=0"}

    def verdict(self, mutant: Mutant) -> Optional[str]:
        """What kills a mutant: the name of a test, or `compiler`. Empty for a survivor; None if nothing changed."""
        source = LIB / mutant.file
        with tempfile.TemporaryDirectory(dir=self.folder) as name:
            folder = Path(name)
            changed = folder / mutant.file
            changed.write_text(mutant.apply(source.read_text(encoding="utf-8")), encoding="utf-8")
            for build in BUILDS:
                if all(test.build != build for test in self.tests):
                    continue
                (folder / build).mkdir()
                target = folder / build / f"{source.stem}.o"
                try:
                    run(self.compile(build, changed, target))
                    self.link(build, folder / build, {source.stem: target})
                except subprocess.CalledProcessError:
                    return "compiler"
                for test in sorted(self.tests, key=lambda test: not test.is_of(source.stem)):
                    if test.build == build and self.fails(test, folder / build):
                        return test.name
                if build == "default" and self.optimised(changed, folder / "code.o") == self.original(mutant.file):
                    return None
            return ""

    def original(self, file: str) -> bytes:
        """The optimised code of a file of the library, compiled under the same name as its mutants."""
        if file not in self.reference:
            with tempfile.TemporaryDirectory(dir=self.folder) as name:
                copy = Path(name) / file
                shutil.copy(LIB / file, copy)
                self.reference[file] = self.optimised(copy, Path(name) / "code.o")
        return self.reference[file]


# ---- The Python package and the npm packages

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
    "export/labial/corpus/formats.py": ("test_services.py", "test_timings.py"),
    "export/labial/corpus/messages.py": ("test_messages.py", "test_services.py", "test_voice.py"),
    "export/labial/rig/table.py": ("test_rig.py", "test_outputs.py"),
    "export/labial/rig/description.py": ("test_rig.py", "test_outputs.py"),
    "web/hearing/index.js": ("hearing.test.mjs", "test_runtime_hearing.py", "test_browser_hearing.py"),
    "web/hearing/tap.js": ("hearing.test.mjs", "test_browser_hearing.py"),
    "web/labial-face.js": ("mouth.test.mjs", "test_browser_elements.py"),
    "web/track.js": ("streams.test.mjs", "test_npm.py"),
    "web/stream.js": ("streams.test.mjs", "conformance.test.mjs", "test_npm.py"),
    "web/memory.js": ("streams.test.mjs", "conformance.test.mjs", "test_npm.py"),
    "web/entries.js": ("words.test.mjs", "test_words_runtime.py", "test_services.py"),
    "web/services.js": ("words.test.mjs", "test_words_runtime.py", "test_services.py"),
    "web/words/voice.js": ("voices.test.mjs", "test_words_runtime.py", "test_voice_sessions.py"),
    "web/words/messages.js": ("voices.test.mjs", "words.test.mjs", "test_words_runtime.py"),
    "web/words/readers.js": ("words.test.mjs", "test_words_runtime.py"),
}
#: The packages of npm that have scripts, and the folders of their sources.
PACKAGES = {"npm": "web", "npm-words": "web/words", "npm-hearing": "web/hearing"}


class Packages(Trials):
    """The Python package and the npm packages, of which each mutant replaces a file in a copy."""

    passing = (0, 5)  # pytest: no test of this name

    def __init__(self, folder: Path, build: Path, files: List[str], suites: List[str]) -> None:
        self.folder, self.calls = folder, {}  # type: Path, Dict[str, List[Test]]
        folder.mkdir(parents=True, exist_ok=True)
        command = ["ctest", "--test-dir", str(build), "--show-only=json-v1"]
        described = subprocess.run(command, check=True, capture_output=True)
        tests = {test["name"]: test for test in json.loads(described.stdout)["tests"]}
        values = next(item["value"] for item in tests["pytest"]["properties"] if item["name"] == "ENVIRONMENT")
        self.variables = dict(value.split("=", 1) for value in values)
        made = build / "python" / "bin" / "python"  # by a test; else another one that has all that tests need
        self.python = str(made) if made.exists() else sys.executable
        self.npm = Path(self.variables.get("LABIAL_NPM_PACKAGE", ""))
        known: Dict[str, Test] = {}
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
            place = folder / mutant.file
            if place.suffix == ".js":
                package = next(name for name, source in PACKAGES.items() if source == str(Path(mutant.file).parent))
                place = folder / package / place.name
            place.unlink()
            place.write_text(changed, encoding="utf-8")
            if place.suffix == ".js" and subprocess.run(["node", "--check", place], capture_output=True).returncode:
                return "compiler"
            for call in self.calls[mutant.file]:
                if self.fails(call, folder):
                    return call.name
            return ""

    def _measured(self, test: str, folder: Path) -> Test:
        if test.endswith(".mjs"):
            call = Test(test, ["node", "--expose-gc", str(ROOT / "tests" / "npm" / test)])
        else:
            call = Test(test, [self.python, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider", "-p", "no:xdist",
                               "--rootdir", str(ROOT), str(ROOT / "tests" / "python" / test)])
        place = folder / test
        self._lay_out(place, "export/")
        self._lay_out(place, "web/")
        self.measure(call, place)
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

    def environment(self, folder: Path) -> Dict[str, str]:
        found = {**self.variables, "PYTHONDONTWRITEBYTECODE": "1", "LABIAL_REQUIRE_ALL": "ON"}
        for variable, place in (("PYTHONPATH", folder / "export"), ("LABIAL_NPM_PACKAGE", folder / "npm")):
            if place.exists():
                found[variable] = str(place)
        return found


def known_survivors() -> Dict[str, str]:
    """Reasons by mutants, from survivors.txt: a line for the mutant, then one, indented, for the reason."""
    pairs = re.findall(r"^([^#\s].*)\n    (.*)$", SURVIVORS.read_text(encoding="utf-8"), re.MULTILINE)
    return dict(pairs)


def tried(bench: Union[Bench, Packages], candidates: Sequence[Mutant], count: int, jobs: int) -> Dict[Mutant, str]:
    """The verdicts on the first `count` candidates that are mutants."""
    verdicts: Dict[Mutant, str] = {}
    rest = iter(candidates)
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool, (bench.folder / "verdicts.txt").open("w") as log:
        while len(verdicts) < count:
            batch = list(itertools.islice(rest, min(count - len(verdicts), 8 * jobs)))
            if not batch:
                break
            for mutant, verdict in zip(batch, pool.map(bench.verdict, batch)):
                if verdict is None or verdict == "compiler":
                    continue
                verdicts[mutant] = verdict
                print(f"{verdict or 'survives'}: {mutant.file}:{mutant.line}: {mutant.key}", file=log, flush=True)
                if not verdict:
                    print(f"survives: {mutant.file}:{mutant.line}\n  {mutant.key}", flush=True)
            print(f"{len(verdicts)} of {count}", flush=True)
    return verdicts


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--build", type=Path, required=True, help="folder for what is built")
    parser.add_argument("--count", type=int, default=300, help="mutants (300)")
    parser.add_argument("--seed", type=int, default=1, help="which ones (1)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="mutants at a time")
    parser.add_argument("--compiler", default=os.environ.get("CC", "cc"))
    parser.add_argument("--cmocka", nargs=2, metavar=("INCLUDE", "LIBRARY"), help="where cmocka is, if not installed")
    parser.add_argument("--unity", type=Path, help="folder of Unity, which holds src/unity.c")
    parser.add_argument("--packages", type=Path, metavar="BUILD", help="change Python and JavaScript; BUILD's tests")
    parser.add_argument("--kinds", nargs="*", choices=KINDS, help="of changes, instead of all")
    parser.add_argument("--files", nargs="*", help="of lib/ or of packages, instead of all")
    parser.add_argument("--suites", nargs="*", default=[], help="of tests/c or of packages, instead of all")
    parser.add_argument("--survivors", action="store_true", help="only the mutants in survivors.txt")
    parser.add_argument("--list", action="store_true", help="print the mutants and do nothing")
    options = parser.parse_args()
    sources = {name: ROOT / name for name in COVERED} if options.packages else {
        path.name: path for path in sorted(LIB.glob("*.c"))}
    files = [name for name in sources if not options.files or name in options.files]
    candidates = chosen([mutant for name in files for mutant in mutants(sources[name], name)
                         if not options.kinds or mutant.kind in options.kinds], options.seed)
    known = known_survivors()
    if options.survivors:
        candidates = [mutant for mutant in candidates if mutant.key in known]
    if options.list:
        for mutant in candidates[: options.count]:
            print(f"{mutant.line}: {mutant.key}")
        return 0
    cmocka = [f"-I{options.cmocka[0]}", options.cmocka[1]] if options.cmocka else ["-lcmocka"]
    bench: Union[Bench, Packages]
    if options.packages:
        bench = Packages(options.build.resolve(), options.packages.resolve(), files, options.suites)
    elif options.unity:
        bench = Bench(options.build.resolve(), options.compiler, cmocka, options.unity, options.suites)
    else:
        parser.error("the library's mutants need --unity")
    verdicts = tried(bench, candidates, min(options.count, len(candidates)), options.jobs)
    survivors = [mutant for mutant, verdict in verdicts.items() if not verdict]
    unknown = [mutant for mutant in survivors if mutant.key not in known]
    equivalent = [mutant for mutant in survivors if known.get(mutant.key, "").startswith("Equivalent")]
    killed = len(verdicts) - len(survivors)
    score = killed / max(1, len(verdicts) - len(equivalent))
    print(f"{killed} of {len(verdicts)} mutants are killed; {len(survivors)} survive, of which {len(equivalent)} are "
          f"equivalent: a mutation score of {score:.1%}.")
    for mutant in unknown:
        print(f"No reason in survivors.txt: {mutant.file}:{mutant.line}\n{mutant.key}")
    listed = [mutant for mutant, verdict in verdicts.items() if verdict and mutant.key in known]
    for mutant in listed:
        print(f"Killed by {verdicts[mutant]}, though in survivors.txt: {mutant.file}:{mutant.line}\n{mutant.key}")
    return 1 if unknown or listed or (score < REQUIRED and not options.survivors) else 0


if __name__ == "__main__":
    sys.exit(main())
