"""The reference of all commands in docs/command_line.md, made from the parser: `python -m ski_addon.manual`."""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Iterable
from pathlib import Path

from . import atomic, environment
from .parser import EXIT_CODES, build_parser

PAGE = Path(__file__).resolve().parents[1] / "docs" / "command_line.md"
BEGIN, END = "<!-- made from the parser by python -m ski_addon.manual: begin -->\n", "<!-- end -->\n"
PROGRAM = "ski"
"""What the page calls the program, whichever way it is started."""
MANY = 3
"""Commands that an argument is shared by, from which on it is explained once for all."""


def reference() -> str:
    """Return the part of the page that is made: commands, exit codes and environment variables, as Markdown."""
    commands = _commands(build_parser(PROGRAM))
    shared = _shared(commands)
    parts = ["## Commands\n", *(_section(name, parser, shared) for name, parser in commands.items())]
    parts.append("\n".join(["## Arguments that many commands have\n", *_table(shared.values())]))
    codes = [f"| {code} | {meaning} |" for code, meaning in EXIT_CODES.items()]
    parts.append("\n".join(["## Exit codes\n", "| code | meaning |", "|---|---|", *codes]) + "\n")
    variables = [f"| `{name}` | {meaning} |" for name, meaning in environment.VARIABLES.items()]
    parts.append("\n".join(["## Environment\n", "| variable | does |", "|---|---|", *variables]) + "\n")
    return "\n".join(parts)


def renewed(page: str) -> str:
    """Return `page` with its made part as it should be."""
    before, rest = page.split(BEGIN)
    return f"{before}{BEGIN}\n{reference()}\n{END}{rest.split(END)[1]}"


def _commands(parser: argparse.ArgumentParser) -> dict[str, argparse.ArgumentParser]:
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            return dict(action.choices)
    return {}


def _shown(parser: argparse.ArgumentParser) -> list[argparse.Action]:
    return [action for action in parser._actions if not isinstance(action, argparse._HelpAction)]


def _shared(commands: dict[str, argparse.ArgumentParser]) -> dict[str, argparse.Action]:
    """Return the arguments that mean the same for `MANY` commands or more, by how they are written and explained."""
    every = [action for parser in commands.values() for action in _shown(parser)]
    count = Counter(map(_row, every))
    return {_row(action): action for action in every if count[_row(action)] >= MANY}


def _section(name: str, parser: argparse.ArgumentParser, shared: dict[str, argparse.Action]) -> str:
    shown = _shown(parser)
    own = [action for action in shown if _row(action) not in shared]
    others = ", ".join(f"`{_name(action)}`" for action in shown if _row(action) in shared)
    text, _, examples = (parser.description or "").replace("%(prog)s", parser.prog).partition("\n\n")
    lines = [f"### {name}\n", f"    {' '.join([PROGRAM, name, *map(_word, _needed(shown)), '[OPTION ...]'])}\n"]
    lines += [text + "\n"]
    if examples:
        lines += [*(f"    {line.strip()}" for line in examples.splitlines() if line), ""]
    lines += _table(own) if own else []
    return "\n".join([*lines, f"And {others}: see [below](#arguments-that-many-commands-have).\n"])


def _table(actions: Iterable[argparse.Action]) -> list[str]:
    return ["| argument | meaning |", "|---|---|", *map(_row, actions), ""]


def _row(action: argparse.Action) -> str:
    return f"| {_written(action)} | {action.help} |"


def _name(action: argparse.Action) -> str:
    return action.option_strings[0] if action.option_strings else _word(action)


def _needed(actions: list[argparse.Action]) -> list[argparse.Action]:
    """Return what must be given: positional arguments first."""
    needed = [action for action in actions if action.required or not action.option_strings]
    return sorted(needed, key=lambda action: bool(action.option_strings))


def _word(action: argparse.Action) -> str:
    metavar = str(action.metavar or action.dest.upper())
    if action.option_strings:
        return f"{action.option_strings[0]} {metavar}"
    return {"*": f"[{metavar} ...]", "+": f"{metavar} ..."}.get(str(action.nargs), metavar)


def _written(action: argparse.Action) -> str:
    """Return how an argument is written, for a cell of a table."""
    if not action.option_strings:
        return f"`{_cell(_word(action))}`"
    value = ""
    if action.nargs != 0 and not isinstance(action, argparse.BooleanOptionalAction):
        choices = "{" + ",".join(map(str, action.choices)) + "}" if action.choices else ""
        value = str(action.metavar or choices or action.dest.upper())
        value = f" [{value}]" if action.nargs == "?" else f" {value}"
    return ", ".join(f"`{option}{_cell(value)}`" for option in action.option_strings)


def _cell(text: str) -> str:
    return text.replace("|", "\\|")


if __name__ == "__main__":
    atomic.write_text(PAGE, renewed(PAGE.read_text(encoding="utf-8")))
