"""How many processes, as a person writes it."""

from __future__ import annotations

import pytest

from ski_addon.errors import SpecError
from ski_addon.workers import read_jobs


def test_jobs_are_a_whole_number_or_the_processors():
    assert read_jobs("3") == 3 and read_jobs(None) >= 1
    for wrong in ("0", "1.5", "many", ""):
        with pytest.raises(SpecError, match="^--jobs"):
            read_jobs(wrong)
