"""A small part of what `make fuzz` tries, the same every time; and that it would notice."""

from __future__ import annotations

import pickle
import time

import pytest

from ski_addon.errors import SpecError
from ski_addon.spec import field_table
from tests.fuzz import campaign, mutations, trying
from tests.fuzz.random_specs import FIXED, random_spec
from tests.fuzz.trying import BAD

SEEDS = [*range(1000, 1036), 963, 2122, 2144, 3860, 20082, 24736]
"""The last ones found: a start that friction holds, a path that no smoothing helps, leans that no speed would
mend, and flat ground without friction, from rest."""


@pytest.fixture
def stock(tmp_path):
    """Whole files to be damaged, in a folder that is looked at afterwards."""
    (tmp_path / "stock").mkdir()
    campaign.begin(tmp_path / "stock")
    yield tmp_path / "stock"
    assert campaign.strangers(tmp_path / "stock") == []


def bad(outcomes):
    return [outcome for outcome in outcomes if outcome.what in BAD]


def test_random_runs_finish_or_say_why_not():
    outcomes = [trying.try_run(seed) for seed in SEEDS]
    assert bad(outcomes) == []
    assert sum(outcome.what == "finished" for outcome in outcomes) >= 5


@pytest.mark.parametrize("kind", ["document", "recording", "heights"])
def test_damaged_files_are_read_or_refused(kind, stock):
    outcomes = [campaign.one((kind, seed)) for seed in range(150)]
    assert bad(outcomes) == []
    assert {outcome.what for outcome in outcomes} >= {"refused"}


def test_zip_bombs_are_refused_at_once(stock):
    from ski_addon.errors import RecordingError
    from ski_addon.simulation import Recording

    path = stock / "out" / "bomb.npz"
    path.write_bytes(mutations.zip_bomb(size=2**30))
    begun = time.process_time()
    with pytest.raises(RecordingError):
        Recording.load(path)
    assert time.process_time() - begun < 5.0


def test_every_key_is_tried():
    tried = set()
    one_word = {key for key, info in field_table().items() if len(info.choices) == 1}
    default = {key: info.default for key, info in field_table().items()}
    for seed in range(400):
        spec = random_spec(seed)
        if spec is None:
            continue
        for key in default.keys() - set(FIXED):
            section, _, name = key.rpartition(".")
            value = getattr(getattr(spec, section) if section else spec, name)
            if value != default[key]:
                tried.add(key)
    assert default.keys() - set(FIXED) - one_word - tried == set()


def test_a_crash_a_hang_and_silence_would_be_noticed(monkeypatch):
    monkeypatch.setattr(trying, "SECONDS", 1)

    def crash():
        raise KeyError("what")

    def mumble():
        raise SpecError("a", hint="b\nc") from None

    def hang():
        while True:
            time.sleep(0.01)

    assert trying.attempt("run", 1, crash).what == "traceback"
    assert trying.attempt("run", 1, hang).what == "hang"
    assert trying.attempt("run", 1, mumble).what in ("refused", "mumble")  # SpecError makes one line of it


def test_the_bomb_would_go_off(tmp_path):
    pickle.loads(pickle.dumps(mutations.Bomb(tmp_path / "code_was_run"))).close()
    (tmp_path / "out").mkdir()
    assert campaign.strangers(tmp_path) == ["code_was_run"]
