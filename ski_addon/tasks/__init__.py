"""Tasks by contract: keyed by everything that decides the result, skipped when that is there, whole or not at all."""

from .frame_list import read_frames
from .keys import digest_file, ground_digest, spec_inputs
from .task import Task

__all__ = ["Task", "digest_file", "ground_digest", "read_frames", "spec_inputs"]
