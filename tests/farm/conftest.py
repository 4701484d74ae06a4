"""What the tests of farms share."""

from __future__ import annotations

import json

import pytest

from ski_addon import cli, results


@pytest.fixture
def submit(capsys):
    """The command `submit`, as a user calls it: returns exit code, stdout, stderr."""

    def call(*arguments):
        code = cli.main(["submit", *(str(argument) for argument in arguments)])
        captured = capsys.readouterr()
        return code, captured.out, captured.err

    return call


@pytest.fixture
def quick_plans(monkeypatch):
    """Planning without physics: a run lasts as many seconds as its first turn's radius has tens of metres."""
    monkeypatch.setattr(results, "plan_seconds", lambda spec: spec.course.turn_radius / 10.0)


@pytest.fixture
def refused(submit):
    """Call `submit`, check that it fails with one line and writes nothing, and return exit code and line."""

    def call(*arguments):
        code, out, err = submit(*arguments)
        assert code != 0
        assert err.count("\n") == 1
        assert "Traceback" not in err + out
        return code, err

    return call


def read_template(bundle):
    """The job template in a bundle."""
    return json.loads((bundle / "template.json").read_text(encoding="utf-8"))
