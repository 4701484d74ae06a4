"""Benchmarks: `python -m benchmarks` runs all and prints one table.

Importing this package keeps numeric libraries to one thread.
"""

import os

for _name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_name, "1")
