"""A release's bill of materials, in the format CycloneDX 1.5: its packages, their contents, optional dependencies and
build tools."""

from __future__ import annotations

import hashlib
import re
import uuid
from datetime import datetime, timezone
from pathlib import Path
from typing import Any, Dict, List

from notices import notice

Item = Dict[str, Any]


def bill(tree: Path, packages: List[Path], moment: int) -> Item:
    """The document for the packages that were built from the sources in `tree`; `moment` is the time of the release in
    seconds since 1970. The same packages give the same document."""
    version = _found(tree / "export/labial/__init__.py", r'^__version__ = "(.*)"$')[0]
    files = [_file(path) for path in packages]
    components = [*files, *_corpora(tree), *_python_packages(tree)]
    name = "".join(item["hashes"][0]["content"] for item in files)
    return {
        "bomFormat": "CycloneDX",
        "specVersion": "1.5",
        "serialNumber": f"urn:uuid:{uuid.uuid5(uuid.NAMESPACE_URL, name)}",
        "version": 1,
        "metadata": {
            "timestamp": datetime.fromtimestamp(moment, timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ"),
            "component": {"type": "library", "bom-ref": "labial", "name": "labial", "version": version,
                          "licenses": [{"expression": "MIT AND CC-BY-4.0 AND BSD-2-Clause"}]},
        },
        "components": components,
        "dependencies": [{"ref": "labial", "dependsOn": [item["bom-ref"] for item in components
                                                         if item["type"] == "data"]}],
    }  # fmt: skip


def _file(path: Path) -> Item:
    digest = hashlib.sha256(path.read_bytes()).hexdigest()
    return {"type": "file", "bom-ref": path.name, "name": path.name, "hashes": [{"alg": "SHA-256", "content": digest}]}


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
    for name, version in _found(tree / "packaging/wheels.txt", r"^([\w-]+)==(.*)$"):
        found[f"build:{name}"] = {"type": "application", "bom-ref": f"build:{name}", "name": name, "version": version,
                                  "scope": "excluded", "purl": f"pkg:pypi/{name.replace('_', '-')}@{version}"}
    return list(found.values())


def _found(path: Path, pattern: str) -> List[Any]:
    return re.findall(pattern, path.read_text(encoding="utf-8"), re.MULTILINE)
