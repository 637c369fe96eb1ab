"""packaging/release.py: packages of a tag, and no release of what is not one."""

from __future__ import annotations

import hashlib
import re
import shutil
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest

import labial
from packages import SOURCE

pytestmark = pytest.mark.skipif(not shutil.which("git"), reason="no git")


@pytest.fixture(scope="module")
def repository(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The sources as a repository of their own, whose change log says that they are released."""
    root = tmp_path_factory.mktemp("repository") / "labial"
    shutil.copytree(SOURCE, root, ignore=shutil.ignore_patterns("build", ".git", "__pycache__", "corpora", "docs"))
    log = root / "CHANGELOG.md"
    log.write_text(re.sub(r"^(## [\d.]+).*unreleased.*$", r"\1, 2026", log.read_text(encoding="utf-8"), flags=re.M),
                   encoding="utf-8")  # fmt: skip
    git(root, "init", "-q")
    git(root, "add", "-A")
    git(root, "-c", "user.name=n", "-c", "user.email=e", "commit", "-qm", "all")
    git(root, "tag", f"v{labial.__version__}")
    return root


def git(root: Path, *arguments: str) -> None:
    """Runs git in `root`."""
    subprocess.run(["git", *arguments], cwd=root, check=True, capture_output=True)


def release(root: Path, *arguments: object) -> subprocess.CompletedProcess[str]:
    """Runs the script of `root`."""
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
    assert {path.name for path in out.iterdir()} == {
        "SHA256SUMS", f"{name}-source.tar.gz", *(f"{name}-{kind}.zip" for kind in kinds)}  # fmt: skip
    for line in (out / "SHA256SUMS").read_text().splitlines():
        digest, package = line.split("  ")
        assert hashlib.sha256((out / package).read_bytes()).hexdigest() == digest
    with tarfile.open(out / f"{name}-source.tar.gz") as sources:
        assert b"no C at all" != sources.extractfile(f"{name}/lib/stream.c").read()
    with zipfile.ZipFile(out / f"{name}-amalgamation.zip") as files:
        assert b"labial_tick" in files.read(f"{name}-amalgamation/labial.c")


@pytest.mark.slow
def test_what_is_no_release_is_refused(repository: Path, tmp_path: Path) -> None:
    """Catches packages of another version than their tag's, of no tag, and of a version that is still being made."""
    git(repository, "tag", "-f", "v9.9.9")
    git(repository, "branch", "-f", "v8.8.8")
    for tag, reason in (("v9.9.9", "whose tag is v"), ("v8.8.8", "v8.8.8"), ("v7.7.7", "v7.7.7")):
        done = release(repository, tag, "-o", tmp_path / tag, "--without", "python", "npm")
        assert done.returncode == 1 and reason in done.stderr and "Traceback" not in done.stderr
        assert done.stderr.count("\n") == 1
    shutil.copyfile(SOURCE / "CHANGELOG.md", repository / "CHANGELOG.md")
    log = repository / "CHANGELOG.md"
    log.write_text(f"# Changes\n\n## {labial.__version__}, unreleased\n", encoding="utf-8")
    git(repository, "-c", "user.name=n", "-c", "user.email=e", "commit", "-qam", "unreleased")
    git(repository, "tag", "-f", f"v{labial.__version__}")
    done = release(repository, f"v{labial.__version__}", "-o", tmp_path / "unreleased")
    assert done.returncode == 1 and "unreleased" in done.stderr
