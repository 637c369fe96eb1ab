"""A release's bill of materials, in the format CycloneDX 1.5: its packages, the models and tables in each, optional
dependencies and build tools."""

from __future__ import annotations

import hashlib
import json
import re
import tarfile
import uuid
import zipfile
from datetime import datetime, timezone
from pathlib import Path
from typing import Any, Dict, List

from source import notice

Item = Dict[str, Any]


def bill(tree: Path, packages: List[Path], moment: int) -> Item:
    """The document for the packages that were built from the sources in `tree`; `moment` is the time of the release in
    seconds since 1970. The same packages give the same document."""
    version = _found(tree / "export/labial/__init__.py", r'^__version__ = "(.*)"$')[0]
    corpora = _corpora(tree)
    contents = {path.name: _contents(path) for path in packages}
    files = [_file(path, version, contents[path.name]) for path in packages]
    components = [*files, *corpora, *_python_packages(tree)]
    name = "".join(item["hashes"][0]["content"] for item in files)
    return {
        "bomFormat": "CycloneDX", "specVersion": "1.5", "version": 1,
        "serialNumber": f"urn:uuid:{uuid.uuid5(uuid.NAMESPACE_URL, name)}",
        "metadata": {
            "timestamp": datetime.fromtimestamp(moment, timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ"),
            "component": {"type": "library", "bom-ref": "labial", "name": "labial", "version": version,
                          "licenses": [{"expression": "MIT AND CC-BY-4.0 AND BSD-2-Clause"}]}},
        "components": components,
        "dependencies": [
            {"ref": "labial", "dependsOn": [item["bom-ref"] for item in corpora]},
            *({"ref": name, "dependsOn": [item["bom-ref"] for item in corpora if _has(inside, item["name"])]}
              for name, inside in contents.items())]}


def _contents(package: Path) -> Dict[str, bytes]:
    """The names of an archive's files; of LICENSE and package.json also what is in them."""
    def wanted(name: str) -> bool:
        return Path(name).name in ("LICENSE", "package.json")
    if package.suffix in (".zip", ".whl"):
        with zipfile.ZipFile(package) as archive:
            return {name: archive.read(name) if wanted(name) else b"" for name in archive.namelist()}
    with tarfile.open(package) as packed:
        return {member.name: packed.extractfile(member).read() if wanted(member.name) else b""  # type: ignore[union-attr]
                for member in packed if member.isfile()}


def _has(contents: Dict[str, bytes], name: str) -> bool:
    """Whether a package has a model or table: as a file of that name, or as LICENSE of an npm package lists it."""
    listed = b" ".join(names for text in contents.values()
                       for names in re.findall(rb"^What the package contains besides that code: (.*)\.$", text, re.M))
    return name.encode() in re.split(rb"[ ,]+", listed) or any(
        Path(file).stem == name and Path(file).suffix in (".c", ".npz") for file in contents)


def _file(path: Path, version: str, contents: Dict[str, bytes]) -> Item:
    digest = hashlib.sha256(path.read_bytes()).hexdigest()
    item = {"type": "file", "bom-ref": path.name, "name": path.name, "hashes": [{"alg": "SHA-256", "content": digest}]}
    if path.suffix == ".whl" or any(name.endswith("/PKG-INFO") for name in contents):
        item["purl"] = f"pkg:pypi/labial@{version}"
    elif path.suffix == ".tgz":
        item["purl"] = f"pkg:npm/{json.loads(contents['package/package.json'])['name']}@{version}"
    return item


def _corpora(tree: Path) -> List[Item]:
    """The training data of the bundled models, from their headers, and of the tables of words."""
    found = []
    for header in sorted((tree / "lib" / "models").glob("*.h")):
        text = notice(header)
        item: Item = {"type": "data", "bom-ref": f"model:{header.stem}", "name": header.stem, "description": text}
        if "CC BY 4.0" in text:
            item["licenses"] = [{"license": {"id": "CC-BY-4.0"}}]
        found.append(item)
    for header in sorted((tree / "lib" / "words").glob("*.h")):
        found.append({"type": "data", "bom-ref": f"words:{header.stem}", "name": header.stem,
                      "description": "Trained on the CMU Pronouncing Dictionary.",
                      "licenses": [{"license": {"id": "BSD-2-Clause"}}]})
    return found


def _python_packages(tree: Path) -> List[Item]:
    """What the Python package's extras name, which it works without, and what its wheels are built with."""
    project = (tree / "pyproject.toml").read_text(encoding="utf-8")
    section = re.findall(r"^\[project\.optional-dependencies\]$(.*?)^\[", project, re.MULTILINE | re.DOTALL)[0]
    found: Dict[str, Item] = {}
    for name, range_of in re.findall(r"""["']([a-z0-9-]+)((?:[<>=!~]=?[\w.]+,?)+)""", section):
        item = found.setdefault(name, {"type": "library", "bom-ref": f"pypi:{name}", "name": name, "scope": "optional",
                                       "purl": f"pkg:pypi/{name}", "description": range_of})
        if range_of not in item["description"]:
            item["description"] += f" or {range_of}"
    for name, version in _found(tree / "packaging/wheels.txt", r"^([\w-]+)==(\S+)"):
        found[f"build:{name}"] = {"type": "application", "bom-ref": f"build:{name}", "name": name, "version": version,
                                  "scope": "excluded", "purl": f"pkg:pypi/{name.replace('_', '-')}@{version}"}
    return list(found.values())


def _found(path: Path, pattern: str) -> List[Any]:
    return re.findall(pattern, path.read_text(encoding="utf-8"), re.MULTILINE)
