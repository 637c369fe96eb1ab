"""What the Python tests share with pytest: which of them are left to .ci/run, since they take long."""

from __future__ import annotations

import os
from typing import List

import pytest


def pytest_configure(config: pytest.Config) -> None:
    """Declares the marker."""
    config.addinivalue_line("markers", "slow: takes long; runs where LABIAL_REQUIRE_ALL is set, as in .ci/run")


def pytest_collection_modifyitems(config: pytest.Config, items: List[pytest.Item]) -> None:
    """Leaves the slow tests out, but where LABIAL_REQUIRE_ALL is set in the environment."""
    if os.environ.get("LABIAL_REQUIRE_ALL", "").upper() in ("ON", "1", "TRUE", "YES"):
        return
    slow = [item for item in items if item.get_closest_marker("slow")]
    config.hook.pytest_deselected(items=slow)
    items[:] = [item for item in items if not item.get_closest_marker("slow")]
