"""A skeleton and a synthetic recording of it."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from ski_addon.body import Skeleton, build_skeleton
from ski_addon.spec import RunSpec
from tests.synthetic_motion import synthetic_motion


@pytest.fixture(scope="session")
def skeleton() -> Skeleton:
    return build_skeleton(RunSpec().skier)


@pytest.fixture(scope="session")
def recording(skeleton: Skeleton) -> SimpleNamespace:
    return synthetic_motion(skeleton, RunSpec())
