"""The samples of services.json, by their names."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, Dict, List, NamedTuple


class Sample(NamedTuple):
    """Messages of a service, and the phonemes that they tell."""

    service: str
    messages: List[Dict[str, Any]]
    phonemes: str

    @property
    def text(self) -> str:
        """The messages as a file has them, one on each line."""
        return "".join(json.dumps(message, ensure_ascii=False) + "\n" for message in self.messages)


SAMPLES = {item["name"]: Sample(item["service"], item["messages"], item.get("phonemes", "SIL M EY B IY SIL G OW"))
           for item in json.loads(Path(__file__).with_suffix(".json").read_text(encoding="utf-8"))["samples"]}
