"""packaging/release.py: packages of a tag, and no release of what is not one."""

from __future__ import annotations

import hashlib
import json
import re
import shutil
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path
from typing import Dict

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

import labial
from bill import bill
from packages import SOURCE

pytestmark = pytest.mark.skipif(not shutil.which("git"), reason="no git")


@pytest.fixture(scope="module")
def repository(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The sources as a repository of their own, whose change log says that they are released."""
    root = tmp_path_factory.mktemp("repository") / "labial"
    shutil.copytree(SOURCE, root, ignore=shutil.ignore_patterns("build", ".git", "__pycache__", "corpora", "docs"))
    log = root / "CHANGELOG.md"
    log.write_text(re.sub(r"^(## [\d.]+).*unreleased.*$", r"\1, 2026", log.read_text("utf-8"), flags=re.M), "utf-8")
    git(root, "init", "-q")
    git(root, "add", "-A")
    git(root, "-c", "user.name=n", "-c", "user.email=e", "commit", "-qm", "all")
    git(root, "tag", f"v{labial.__version__}")
    return root


def git(root: Path, *arguments: str) -> None:
    subprocess.run(["git", *arguments], cwd=root, check=True, capture_output=True)


def release(root: Path, *arguments: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, root / "packaging" / "release.py", *map(str, arguments)],
                          capture_output=True, encoding="utf-8", check=False)


@pytest.mark.slow
def test_a_tag_becomes_its_packages(repository: Path, tmp_path: Path) -> None:
    """Catches a package that is built from the working folder, that lacks the library, or whose sum is wrong."""
    (repository / "lib" / "stream.c").write_text("no C at all", encoding="utf-8")  # not what was tagged
    version, out = labial.__version__, tmp_path / "out"
    done = release(repository, f"v{version}", "-o", out, "--without", "python", "npm")
    git(repository, "checkout", "-q", "lib/stream.c")
    assert (done.returncode, done.stderr) == (0, "")
    name = f"labial-{version}"
    kinds = ("amalgamation", "arduino", "esp-idf", "platformio", "zephyr")
    assert {path.name for path in out.iterdir()} == {"SHA256SUMS", f"{name}.cdx.json", f"{name}-source.tar.gz",
                                                     *(f"{name}-{kind}.zip" for kind in kinds)}
    for line in (out / "SHA256SUMS").read_text().splitlines():
        digest, package = line.split("  ")
        assert hashlib.sha256((out / package).read_bytes()).hexdigest() == digest
    with tarfile.open(out / f"{name}-source.tar.gz") as sources:
        assert b"no C at all" != sources.extractfile(f"{name}/lib/stream.c").read()
    with zipfile.ZipFile(out / f"{name}-amalgamation.zip") as files:
        assert b"labial_tick" in files.read(f"{name}-amalgamation/labial.c")

    # The bill names every package with its sum, the data with its licence, and everything only once.
    whole = json.loads((out / f"{name}.cdx.json").read_text(encoding="utf-8"))
    assert (whole["bomFormat"], whole["specVersion"]) == ("CycloneDX", "1.5")
    assert whole["metadata"]["component"]["version"] == labial.__version__
    components = {item["bom-ref"]: item for item in whole["components"]}
    assert len(components) == len(whole["components"])
    files = {name: item["hashes"] for name, item in components.items() if item["type"] == "file"}
    others = ("SHA256SUMS", f"labial-{labial.__version__}.cdx.json")
    assert files == {path.name: [{"alg": "SHA-256", "content": hashlib.sha256(path.read_bytes()).hexdigest()}]
                     for path in out.iterdir() if path.name not in others}
    speech = components["model:speech_en"]
    assert "GRID audio-visual speech corpus" in speech["description"]
    assert speech["licenses"] == [{"license": {"id": "CC-BY-4.0"}}]
    assert "synthetic" in components["model:laughter_synthetic"]["description"]
    assert {"pypi:numpy", "pypi:scipy", "pypi:mediapipe", "pypi:distributed", "build:ziglang"} <= set(components)
    data = ["model:hear_ahead", "model:hear_host", "model:hear_large", "model:hear_small", "model:laughter_synthetic",
            "model:speech_en", "words:words_en"]
    contents = {item["ref"]: item["dependsOn"] for item in whole["dependencies"]}
    assert set(contents) == {"labial", *files}
    for package, inside in contents.items():
        assert inside == data or package.endswith("-npm.tgz"), package


def test_the_bill_says_what_is_in_each_package(tmp_path: Path) -> None:
    """Of npm packages, which LICENSE lists what they contain, and of wheels."""
    names = {"labial": "speech_en", "labial-words": "words_en", "labial-hearing": "hear_small, hear_large"}
    for name, data in names.items():
        with tarfile.open(tmp_path / f"{name}-1.0.0-npm.tgz", "w:gz") as packed:
            for file, text in (("package.json", json.dumps({"name": name})),
                               ("LICENSE", f"What the package contains besides that code: {data}.\n")):
                (tmp_path / file).write_text(text)
                packed.add(tmp_path / file, f"package/{file}")
    with zipfile.ZipFile(tmp_path / "labial-1.0.0-py3-none-any.whl", "w") as wheel:
        wheel.writestr("labial/models/speech_en.npz", "")
        wheel.writestr("labial/models/words_en.npz", "")
    packages = sorted(tmp_path.glob("labial*"))
    made = bill(SOURCE, packages, 0)
    assert {item["ref"]: item["dependsOn"] for item in made["dependencies"][1:]} == {
        "labial-1.0.0-npm.tgz": ["model:speech_en"], "labial-words-1.0.0-npm.tgz": ["words:words_en"],
        "labial-hearing-1.0.0-npm.tgz": ["model:hear_large", "model:hear_small"],
        "labial-1.0.0-py3-none-any.whl": ["model:speech_en", "words:words_en"]}
    version = labial.__version__
    assert [item["purl"] for item in made["components"] if item["type"] == "file"] == [
        f"pkg:npm/labial@{version}", f"pkg:pypi/labial@{version}", f"pkg:npm/labial-hearing@{version}",
        f"pkg:npm/labial-words@{version}"]


def test_what_ci_takes_from_elsewhere_is_pinned() -> None:
    """A tag can be moved to another commit or image; a digest cannot."""
    texts = [path.read_text(encoding="utf-8") for path in (SOURCE / ".github" / "workflows").glob("*.yml")]
    uses = [use for text in texts for use in re.findall(r"^ +(?:- )?(?:uses|container|image): (\S+)", text, re.M)]
    assert len(uses) >= 3
    assert [use for use in uses if not re.search(r"@([0-9a-f]{40}|sha256:[0-9a-f]{64})$", use)] == []


def test_what_pip_and_npm_install_has_hashes() -> None:
    """Catches a package that CI installs and nobody pinned, and a lock file that is not made anew."""
    locks = {name: locked(SOURCE / name) for name in ("tests/requirements.lock", "tests/tracking/requirements.lock",
                                                      "packaging/wheels.txt")}
    assert all(len(lock) >= 5 for lock in locks.values())
    for name in ("tests/requirements", "tests/tracking/requirements"):
        for line in (SOURCE / f"{name}.txt").read_text(encoding="utf-8").splitlines():
            wanted = Requirement(line.split("#")[0]) if line.split("#")[0].strip() else None
            if wanted and (not wanted.marker or wanted.marker.evaluate()):
                assert wanted.specifier.contains(locks[f"{name}.lock"][canonicalize_name(wanted.name)]), (name, line)
    packages = json.loads((SOURCE / "tests/npm/bundlers/package-lock.json").read_text(encoding="utf-8"))["packages"]
    assert [name for name, item in packages.items() if name and not item["integrity"].startswith("sha512-")] == []


def locked(path: Path) -> Dict[str, str]:
    """The versions that a lock file of pip names for this Python, by name; each must have a hash."""
    found = {}
    for entry in re.split(r"\n(?! )", re.sub(r"^#.*\n", "", path.read_text(encoding="utf-8"), flags=re.M).strip()):
        requirement, *hashes = entry.split("\\\n")
        assert hashes and all(re.fullmatch(r" +--hash=sha256:[0-9a-f]{64} ?", text) for text in hashes), requirement
        named = Requirement(requirement)
        if not named.marker or named.marker.evaluate():
            (pinned,) = named.specifier
            assert pinned.operator == "=="
            found[canonicalize_name(named.name)] = pinned.version
    return found


def test_manifests_name_the_licence_of_the_data() -> None:
    """The speech model is in every package but that of laughter."""
    for name in ("pyproject.toml", "library.json", "idf_component.yml", "web/packages.json", "packaging/arduino.py"):
        assert "MIT AND CC-BY-4.0" in (SOURCE / name).read_text(encoding="utf-8"), name


@pytest.mark.slow
def test_what_is_no_release_is_refused(repository: Path, tmp_path: Path) -> None:
    """Catches packages of another version than their tag's, of no tag, and of a version that is still being made."""
    git(repository, "tag", "-f", "v9.9.9")
    git(repository, "branch", "-f", "v8.8.8")
    for tag, reason in (("v9.9.9", "whose tag is v"), ("v8.8.8", "v8.8.8"), ("v7.7.7", "v7.7.7")):
        done = release(repository, tag, "-o", tmp_path / tag, "--without", "python", "npm")
        assert done.returncode == 1 and reason in done.stderr and "Traceback" not in done.stderr
        assert done.stderr.count("\n") == 1
    (repository / "CHANGELOG.md").write_text(f"# Changes\n\n## {labial.__version__}, unreleased\n", encoding="utf-8")
    git(repository, "-c", "user.name=n", "-c", "user.email=e", "commit", "-qam", "unreleased")
    git(repository, "tag", "-f", f"v{labial.__version__}")
    done = release(repository, f"v{labial.__version__}", "-o", tmp_path / "unreleased")
    assert done.returncode == 1 and "unreleased" in done.stderr
