"""For every test: one thread for linear algebra, set before numpy is loaded, and Ctrl+C as a user has it."""

from __future__ import annotations

import os
import signal

for _name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_name, "1")

# A shell starts its background jobs deaf to interrupts; tests of interrupts run there too.
signal.signal(signal.SIGINT, signal.default_int_handler)
