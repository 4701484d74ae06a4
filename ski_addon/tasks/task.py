"""One task: its key, and the receipt that says which files are the whole result of that key.

The receipt `NAME.task.json` lies beside the main file `NAME.*`. It holds the key, the digest of each file, and for
whoever looks later: versions, seed, host and times. It is written last, so that a task that was killed has none, and a
file that was removed, cut short or edited no longer agrees with it.
"""

from __future__ import annotations

import json
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from .. import atomic
from ..errors import MissingInputError
from ..talk import Talk, json_text
from . import keys

FORMAT, FORMAT_VERSION = "ski-addon-task", 1


class Task:
    """Work called `command` that makes the file `output` (and others beside it) from `inputs` with `versions`."""

    def __init__(
        self,
        command: str,
        output: Path,
        inputs: Mapping[str, Any],
        versions: Mapping[str, str],
        *,
        seed: int | None = None,
    ) -> None:
        """Take what decides the result: anything that can be written as JSON."""
        self.command, self.output, self.versions, self.seed = command, output, dict(versions), seed
        self.key = keys.digest([command, inputs, self.versions])
        self._begun = time.time()

    @property
    def receipt_path(self) -> Path:
        """Where the receipt lies."""
        return receipt_path(self.output)

    def say_why(self, talk: Talk, why: str) -> None:
        """Say why a file that is there is made again, and note for the log what begins: key, versions, seed, host."""
        if self.output.exists():
            talk.tell(f"{self.output}: {why}, made again")
        self._begun = time.time()
        seed = "" if self.seed is None else f", seed {self.seed}"
        talk.note(f"{self.command} {self.output}: key {self.key[:16]}{seed}, {keys.one_line_of(self.versions)}")
        talk.note(f"{self.command} {self.output}: on {keys.one_line_of(keys.host())}")

    def unfinished(self, needed: Sequence[str]) -> str:
        """Return "" if the files `needed` are there as this task writes them, else why it must run, in a few words."""
        receipt = read_receipt(self.output)
        if receipt is None:
            return "not made yet" if not self.output.exists() else f"there is no receipt of {self.output.name}"
        if receipt["key"] != self.key:
            return f"{self.output.name} was made from something else"
        for name in needed:
            path = self.output.with_name(name)
            if name not in receipt["outputs"]:
                return f"{name} was not made"
            if not path.is_file():
                return f"{name} is gone"
            if keys.digest_file(path) != receipt["outputs"][name]:
                return f"{name} is not as it was written"
        return ""

    def finish(self, files: Sequence[str], talk: Talk, **more: Any) -> None:
        """Write the receipt of `files`, names beside the main one; `more` is told in it. Raises `OutputError`."""
        now = time.time()
        receipt = {
            "format": FORMAT,
            "format_version": FORMAT_VERSION,
            "command": self.command,
            "key": self.key,
            "outputs": {name: keys.digest_file(self.output.with_name(name)) for name in files},
            "seed": self.seed,
            "versions": self.versions,
            "host": keys.host(),
            "finished": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime(now)),
            "seconds": round(now - self._begun, 3),
            **more,
        }
        atomic.write_text(self.receipt_path, json_text(receipt))
        talk.note(f"{self.command} {self.output}: done in {now - self._begun:.1f} s")

    def say_up_to_date(self, talk: Talk) -> None:
        """Say that there is nothing to do."""
        talk.say(f"{self.output}: up to date")
        talk.note(f"{self.command} {self.output}: up to date, key {self.key[:16]}")


def receipt_path(output: Path) -> Path:
    """Return where the receipt of the file `output` lies."""
    return output.with_name(f"{output.stem}.task.json")


def read_receipt(output: Path) -> dict[str, Any] | None:
    """Return the receipt of a file, or None if there is none that can be read."""
    try:
        receipt = json.loads(receipt_path(output).read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return None
    if not isinstance(receipt, dict) or receipt.get("format") != FORMAT:
        return None
    whole = isinstance(receipt.get("key"), str) and isinstance(receipt.get("outputs"), dict)
    return receipt if whole and receipt.get("format_version") == FORMAT_VERSION else None


def made_by(path: Path) -> str:
    """Return what identifies the content of a file: the key of the task that made it, if it is still as that left it,
    else the digest of its bytes. Raises `MissingInputError`.

    Some files, such as Blender's, have other bytes each time they are made, and the same content.
    """
    if not path.is_file():
        raise MissingInputError(path)
    found, receipt = keys.digest_file(path), read_receipt(path)
    return receipt["key"] if receipt and receipt["outputs"].get(path.name) == found else found
