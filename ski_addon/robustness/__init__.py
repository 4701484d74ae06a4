"""How hard a skier can be pushed: a table of pushes, each a run of its own, and what became of them."""

from .cases import Case, PushTable, Row, read_table
from .running import RunResult, run_table
from .summary import summarise_table, write_results

__all__ = ["Case", "PushTable", "Row", "RunResult", "read_table", "run_table", "summarise_table", "write_results"]
