"""The speed to hold: the lower of what the course and the skier want."""

from __future__ import annotations

import math

import pytest

from ski_addon.course import speed_to_hold
from ski_addon.spec import RunSpec


@pytest.mark.parametrize(
    ("target", "limit", "held"),
    [("free", "unlimited", math.inf), (9, "unlimited", 9), ("free", 7, 7), (9, 7, 7), (6, 7, 6)],
)
def test_speed_to_hold_is_the_lower_of_target_and_limit(target, limit, held):
    spec = RunSpec.from_dict({"course": {"target_speed": target}, "technique": {"speed_limit": limit}})
    assert speed_to_hold(spec) == held
