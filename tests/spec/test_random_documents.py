"""Any valid document: it validates, is written and read back the same, and keeps its hash."""

from __future__ import annotations

import dataclasses
import random
import tomllib

import pytest

from ski_addon.spec import RunSpec, field_table
from ski_addon.spec.fields import NUMBER, TEXT
from ski_addon.spec.table import get_value
from tests.spec.random_documents import KEYS, ROW_KEYS, held, nested, random_flat

SEEDS = range(150)


@pytest.fixture(scope="module")
def documents():
    """Flat documents that name every key."""
    return [random_flat(random.Random(seed)) for seed in SEEDS]


@pytest.fixture(scope="module")
def specs(documents):
    return [RunSpec.from_dict(nested(flat)) for flat in documents]


def test_every_value_arrives_under_its_key(documents, specs):
    for flat, spec in zip(documents, specs, strict=True):
        for key, value in flat.items():
            assert held(spec, key) == value, key


def test_written_text_reads_back_equal_and_is_written_the_same_again(specs):
    for spec in specs:
        text = spec.to_toml()
        again = RunSpec.from_text(text)
        assert again == spec
        assert again.to_toml() == text
        assert again.content_hash() == spec.content_hash()


def test_file_reads_back_the_same_bytes(specs, tmp_path):
    path = tmp_path / "läufe 1.toml"
    for spec in specs[:20]:
        path.write_bytes(spec.to_toml().encode())
        assert RunSpec.from_toml(path).to_toml().encode() == path.read_bytes()


def test_text_is_toml_with_the_same_values_for_any_reader(documents, specs):
    for flat, spec in zip(documents, specs, strict=True):
        assert tomllib.loads(spec.to_toml()) == nested({key: flat[key] for key in (*KEYS, *ROW_KEYS)})


def test_order_of_keys_does_not_matter(documents, specs):
    for flat, spec in zip(documents, specs, strict=True):
        backwards = dict(reversed(flat.items()))
        assert RunSpec.from_dict(nested(backwards)).content_hash() == spec.content_hash()


def test_overrides_of_every_key_are_the_document_itself(documents, specs):
    for flat, spec in zip(documents[:60], specs, strict=False):
        values = {k: v for k, v in flat.items() if field_table()[k].kind != TEXT}  # text may look like a TOML string
        built = RunSpec(name=flat["name"], description=flat["description"]).with_overrides(values)
        action = dataclasses.replace(built.bake, action=flat["bake.action"])
        ground = dataclasses.replace(built.slope, grid_file=flat["slope.grid_file"])
        assert dataclasses.replace(built, bake=action, slope=ground) == spec


def test_written_override_is_the_value_itself(specs):
    """What `to_toml` writes for a value may be given after `--set key=`."""
    for spec in specs[:60]:
        rows = {key: getattr(spec, key) for key in ROW_KEYS}
        bare = dataclasses.replace(spec, **dict.fromkeys(ROW_KEYS, ()))
        lines = [line for line in bare.to_toml().split("\n") if " = " in line]
        written = dict(zip(KEYS, (line.partition(" = ")[2] for line in lines), strict=True))
        assert RunSpec(**rows).with_overrides(written) == spec


def test_partial_documents_take_defaults_for_the_rest():
    default = RunSpec()
    for seed in SEEDS:
        flat = random_flat(random.Random(seed), share=0.2)
        spec = RunSpec.from_dict(nested(flat))
        for key in (*KEYS, *ROW_KEYS):
            assert held(spec, key) == flat.get(key, held(default, key)), key


def test_two_overrides_after_each_other_are_one():
    for seed in SEEDS[:40]:
        flat = random_flat(random.Random(seed), share=0.3)
        values = {k: v for k, v in flat.items() if not isinstance(v, str)}
        first = dict(list(values.items())[: len(values) // 2])
        rest = {k: v for k, v in values.items() if k not in first}
        assert RunSpec().with_overrides(first).with_overrides(rest) == RunSpec().with_overrides(rest | first)


def test_hash_tells_apart_every_change_of_one_key(documents):
    base = RunSpec()
    for key in (*KEYS, *ROW_KEYS):
        values = {str(flat[key]): flat[key] for flat in documents}
        specs = {RunSpec.from_dict(nested({key: value})) for value in values.values()} | {base}
        assert len({spec.content_hash() for spec in specs}) == len(specs), key


def test_numbers_are_floats_whether_written_with_a_point_or_not(specs):
    numbers = [info for info in field_table().values() if info.kind == NUMBER]
    for spec in specs:
        for info in numbers:
            value = get_value(spec, info.key)
            assert type(value) is float or value == info.word, info.key
