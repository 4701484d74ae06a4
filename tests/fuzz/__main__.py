"""Try random runs and damaged files: `python -m tests.fuzz --runs 10000 --seed 1`, or `make fuzz`.

Ends with 1 if anything crashed, hung, said nothing, ran code or wrote elsewhere. `--only run:SEED` repeats one try.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

from tests.fuzz import campaign
from tests.fuzz.trying import BAD


def main() -> int:
    """Run the campaign that the command line asks for."""
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz", description=__doc__)
    parser.add_argument("--runs", type=int, default=10_000, help="how many tries (10000)")
    parser.add_argument("--seed", type=int, default=1, help="seed of the first one (1)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="processes (one a core)")
    parser.add_argument("--only", metavar="KIND:SEED", help="one try again: run, document, recording or heights")
    arguments = parser.parse_args()
    if arguments.only:
        kind, _, seed = arguments.only.partition(":")
        with TemporaryDirectory() as folder:
            campaign.begin(Path(folder))
            print(campaign.one((kind, int(seed))))
        return 0
    begun = time.monotonic()

    def tell(done: int) -> None:
        if done % 500 == 0:
            print(f"{done} tries, {time.monotonic() - begun:.0f} s", flush=True)

    outcomes = list(campaign.in_processes(campaign.tasks(arguments.runs, arguments.seed), arguments.jobs, tell))
    bad = [outcome for outcome in outcomes if outcome.what in BAD]
    for outcome in bad[:20]:
        print(f"\n{outcome.kind}:{outcome.seed} {outcome.what}\n{outcome.detail}")
    elsewhere = campaign.clean_up()
    print(campaign.table(outcomes))
    seconds = time.monotonic() - begun
    print(f"{len(outcomes)} tries in {seconds:.0f} s; {len(bad)} bad; written elsewhere: {elsewhere or 'nothing'}")
    return 1 if bad or elsewhere else 0


if __name__ == "__main__":
    sys.exit(main())
