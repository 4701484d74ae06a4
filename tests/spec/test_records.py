"""Records: frozen dataclasses with shared methods behave as those that `dataclasses` writes."""

from __future__ import annotations

import copy
import dataclasses
import pickle
from typing import Any

import pytest

from ski_addon.spec import CourseSpec, RunSpec, SlopeSpec
from ski_addon.spec.records import record


@record(frozen=True)
class Place:
    """A place with a name."""

    x: float
    y: float = 1.5
    names: list[str] = dataclasses.field(default_factory=list)


@dataclasses.dataclass(frozen=True)
class Written:
    """The same as `dataclasses` has it."""

    x: float
    y: float = 1.5
    names: list[str] = dataclasses.field(default_factory=list)


def test_values_and_defaults_are_as_in_a_dataclass() -> None:
    for given, named in (((1.0,), {}), ((), {"x": 1.0}), ((1.0, 2.0, ["a"]), {}), ((1.0,), {"names": ["b"]})):
        assert dataclasses.asdict(Place(*given, **named)) == dataclasses.asdict(Written(*given, **named))
    assert Place(1.0).names is not Place(1.0).names, "a default that can be changed is made for each"
    assert repr(Place(1.0)) == "Place(x=1.0, y=1.5, names=[])"


@pytest.mark.parametrize(
    ("given", "named"), [((), {}), ((1.0, 2.0, [], 4), {}), ((1.0,), {"x": 2.0}), ((1.0,), {"z": 2.0})]
)
def test_wrong_values_are_refused_as_in_a_dataclass(given: Any, named: Any) -> None:
    for cls in (Written, Place):
        with pytest.raises(TypeError):
            cls(*given, **named)


def test_records_are_equal_and_hash_by_their_values() -> None:
    assert Place(1.0) == Place(1.0) != Place(2.0)
    assert Place(1.0) != Written(1.0)
    assert hash(SlopeSpec(angle_deg=20.0)) == hash(SlopeSpec(angle_deg=20.0)) != hash(SlopeSpec())
    assert {RunSpec(): 1}[RunSpec()] == 1


def test_records_cannot_be_changed_but_replaced() -> None:
    place = Place(1.0)
    with pytest.raises(dataclasses.FrozenInstanceError):
        place.x = 2.0  # type: ignore[misc]
    with pytest.raises(dataclasses.FrozenInstanceError):
        del place.x  # type: ignore[misc]
    assert dataclasses.replace(place, x=2.0) == Place(2.0)
    assert place == Place(1.0)


def test_records_can_be_copied_and_sent_to_other_processes() -> None:
    spec = RunSpec(course=CourseSpec(turn_count=3))
    assert copy.deepcopy(spec) == pickle.loads(pickle.dumps(spec)) == spec


def test_a_record_says_that_it_is_frozen() -> None:
    with pytest.raises(TypeError, match="frozen"):
        record(frozen=False)
