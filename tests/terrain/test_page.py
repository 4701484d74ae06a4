"""The page on terrain says what is so."""

from __future__ import annotations

import dataclasses
import re
import tomllib
from pathlib import Path

import numpy as np
import pytest

from ski_addon.errors import SpecError
from ski_addon.spec import RunSpec, field_table
from ski_addon.terrain import ReliefTerrain, build_terrain, check_bumps, mesh_ground
from ski_addon.terrain.grid_files import READERS
from tests.terrain.meshes import hill, sheet

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "terrain.md").read_text(encoding="utf-8")
EXAMPLES = [tomllib.loads(text) for text in re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)]


def test_the_examples_are_slopes():
    bumps, grid = (RunSpec.from_dict(example).slope for example in EXAMPLES)
    ground = build_terrain(bumps)
    assert isinstance(ground, ReliefTerrain) and len(ground.relief.crests()) == 10
    assert (grid.kind, grid.grid_file) == ("grid", "hill.npz")


def test_the_line_about_tall_bumps_is_the_one_that_is_said():
    slope = dataclasses.replace(RunSpec.from_dict(EXAMPLES[0]).slope, bump_height=3.0)
    with pytest.raises(SpecError) as caught:
        check_bumps(slope, leg_travel=0.3)
    assert str(caught.value) in " ".join(PAGE.split())


ROOF = np.array([[[40.0, -8.0, 95.0], [60.0, -8.0, 95.0], [50.0, 8.0, 95.0]]])


@pytest.mark.parametrize(
    ("mesh", "start"),
    [
        (0.1 * sheet(hill), None),
        (sheet(lambda x, y: -0.002 * x), None),
        (sheet(hill), (300.0, 0.0)),
        (np.concatenate((sheet(hill), ROOF)), None),
        (sheet(lambda x, y: hill(x, y) - 8.0 * (x > 60)), None),
    ],
    ids=["small", "flat", "beside", "roof", "cliff"],
)
def test_the_lines_about_meshes_are_those_that_are_said(mesh, start):
    with pytest.raises(SpecError) as caught:
        mesh_ground(mesh, 'object "Hill"', start)
    assert f"\n{caught.value}\n" in PAGE


def test_the_resolution_of_a_mesh_is_shown_as_the_page_says():
    assert f"# {mesh_ground(sheet(lambda x, y: -0.2 * x), 'Hill').summary}\n" in PAGE


def test_every_kind_key_and_format_is_named():
    kinds = field_table()["slope.kind"].choices
    for kind in kinds:
        assert f"| `{kind}` |" in PAGE
    for suffix in set(READERS) - {".tiff"}:
        assert f"`{suffix}`" in PAGE
    for name in (info.name for info in field_table().values() if info.section == "slope"):
        assert f"`{name}`" in PAGE or name in str(EXAMPLES), name
