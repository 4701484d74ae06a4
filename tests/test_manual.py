"""The page of the command line agrees with the parser, and its examples can be typed."""

from __future__ import annotations

import argparse
import re
import shlex
from pathlib import Path

import pytest

from ski_addon import environment
from ski_addon.manual import PAGE, reference, renewed
from ski_addon.parser import EXIT_CODES, build_parser

TEXT = PAGE.read_text(encoding="utf-8")
PARSER = build_parser("ski")
COMMANDS = next(action for action in PARSER._actions if isinstance(action, argparse._SubParsersAction)).choices


def examples(text):
    """The commands in a text: lines that begin with `ski`, without the words beside them."""
    found = re.findall(r"^ +(ski [a-z]+ .*?)(?:   .*)?$", text, re.MULTILINE)
    return [shlex.split(line)[1:] for line in found if "[OPTION ...]" not in line]


def test_the_page_in_the_repository_is_up_to_date():
    assert renewed(TEXT) == TEXT, "run: python -m ski_addon.manual"


def test_every_command_and_every_option_is_on_the_page():
    for name, parser in COMMANDS.items():
        section = reference().split(f"### {name}\n")[1].split("\n### ")[0]
        for action in parser._actions[1:]:
            assert (action.option_strings or [str(action.metavar).replace("|", "\\|")])[0] in section, (
                name,
                action.dest,
            )


def test_every_variable_and_exit_code_is_on_the_page_and_in_the_help():
    help_text = PARSER.format_help()
    for word in (*environment.VARIABLES, *map(str, EXIT_CODES)):
        assert word in TEXT and word in help_text


def test_no_variable_is_read_that_is_not_documented():
    sources = Path(environment.__file__).parent.rglob("*.py")
    named = {name for path in sources for name in re.findall(r"\bSKI_ADDON_[A-Z]+(?:_[A-Z]+)*", path.read_text())}
    assert named - {"SKI_ADDON_APART"} <= set(environment.VARIABLES), "SKI_ADDON_APART is between our own processes"


@pytest.mark.parametrize("name", COMMANDS)
def test_help_teaches_by_an_example_that_can_be_typed(name):
    typed = examples(COMMANDS[name].format_help())
    assert typed and all(words[0] == name for words in typed)
    for words in typed:
        assert PARSER.parse_args(words).command.__name__ == f"{name}_command"


def test_examples_on_the_page_can_be_typed_and_name_presets_that_are_there():
    typed = examples(TEXT)
    runs = {path.stem for kind in ("runs", "crowds") for path in (PAGE.parents[1] / "presets" / kind).glob("*.toml")}
    assert len(typed) > 20
    for words in typed:
        spec = getattr(PARSER.parse_args(words), "spec", "my_run.toml")
        assert spec.endswith(".toml") or spec in runs, words
