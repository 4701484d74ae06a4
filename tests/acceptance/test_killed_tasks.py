"""Tasks that are killed with -9 and given again make what they make without it (`killed_tasks` does it 20 times)."""

from __future__ import annotations

import importlib.util

import pytest

from tests.acceptance.killed_tasks import kill_tasks


@pytest.mark.slow
@pytest.mark.skipif(importlib.util.find_spec("bpy") is None, reason="baking and rendering need bpy")
def test_killed_tasks_make_the_same(tmp_path):
    tallies = kill_tasks(tmp_path, 3)
    assert [tally.task for tally in tallies] == ["simulate", "bake", "render"]
    for tally in tallies:
        assert tally.equal == tally.kills == 3, tally.line()
