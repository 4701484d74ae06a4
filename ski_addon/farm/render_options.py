"""Options of `render` that a job passes on: `--render engine=workbench --render size=960x540`."""

from __future__ import annotations

import difflib
import re
from collections.abc import Mapping, Sequence
from types import MappingProxyType

from ..errors import SpecError

YES, NO = "true", "false"
OPTIONS: Mapping[str, tuple[str, str]] = MappingProxyType(
    {
        "engine": ("cycles|workbench", "cycles or workbench"),
        "device": ("CPU|CUDA|OPTIX|HIP|METAL|ONEAPI", "CPU, CUDA, OPTIX, HIP, METAL or ONEAPI"),
        "samples": ("[1-9][0-9]{0,4}", "a whole number, for instance 64"),
        "size": ("[1-9][0-9]{0,4}x[1-9][0-9]{0,4}", "pixels, for instance 1920x1080"),
        "motion-blur": (r"[0-2](\.[0-9]{1,6})?", "0..2 frames, for instance 0.5"),
        "denoise": (f"{YES}|{NO}", f"{YES} or {NO}"),
    }
)
"""Option -> the form of its value, and that in words."""


def read_render_options(written: Sequence[str]) -> dict[str, str]:
    """Return the options by name, each given once; raises `SpecError` naming `--render` and the option."""
    options: dict[str, str] = {}
    for text in written:
        name, _, value = (part.strip() for part in text.partition("="))
        if name not in OPTIONS:
            near = difflib.get_close_matches(name[:30], OPTIONS, n=1, cutoff=0.0)[0]
            raise SpecError(f"--render {name}", problem="is no option of render", hint=f"did you mean {near}?")
        if name in options:
            raise SpecError(f"--render {name}", problem="is given twice", hint="give it once")
        form, words = OPTIONS[name]
        if not re.fullmatch(form, value):
            raise SpecError(f"--render {name}", value, hint=f"give {words}", problem="is not one of its values")
        options[name] = value
    return options


def render_arguments(options: Mapping[str, str]) -> list[str]:
    """Return the options as arguments of `render`."""
    arguments = []
    for name, value in options.items():
        switch = {YES: [f"--{name}"], NO: [f"--no-{name}"]}
        arguments += switch.get(value, [f"--{name}", value])
    return arguments
