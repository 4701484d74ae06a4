# What a user or developer runs. Needs only git, make and a Python 3.11 or 3.13; everything else goes into .venv.
#   make env     the environment .venv          make build      the extension's zips, in dist/
#   make test    every test without a display   make build-dev  a zip for this computer only, any Python: PYTHON_TAG=cp314
#   make demo    out/demo/: skier.blend, ...    make lint types acceptance benchmark fuzz clean
SHELL := /bin/bash
PY := .venv/bin/python
PYTHON_TAG ?= cp314

# One thread for linear algebra: the matrices are small, and a run is the same on any number of cores.
export OMP_NUM_THREADS := 1
export OPENBLAS_NUM_THREADS := 1
export MKL_NUM_THREADS := 1

CORE_TESTS := tests --ignore=tests/blender --ignore=tests/gui
# One process a core; the tests of a file stay together, for they share what their fixtures have made.
SIDE_BY_SIDE := -n auto --dist loadfile

.PHONY: env test test-core test-blender acceptance benchmark fuzz demo build build-dev lint format types clean
.DEFAULT_GOAL := env

env: .venv/.complete

# An environment that is there already is brought up to date, never thrown away.
.venv/.complete: pyproject.toml
	@if test -x $(PY); then \
	  PYTHON=$(PY) .ci/find-python >/dev/null 2>&1 || { echo ".venv was made with a Python that no bpy wheel fits:" \
	    "remove it and run make env with Python 3.11 or 3.13" >&2; exit 1; }; \
	else python=$$(.ci/find-python) && echo "making .venv with $$python" && "$$python" -m venv .venv; fi
	@$(PY) -m pip --version >/dev/null 2>&1 || $(PY) -m ensurepip
	$(PY) -m pip install -qq --disable-pip-version-check --editable '.[blender,dev]'
	@touch $@

test: test-core test-blender

test-core: env
	$(PY) -m pytest -q $(SIDE_BY_SIDE) $(CORE_TESTS) -m "not slow"

test-blender: env
	@if $(PY) -c 'import importlib.util as u, sys; sys.exit(u.find_spec("bpy") is None)'; then \
	  .ci/bpy-run 900 $(PY) -m pytest -q tests/blender; \
	else echo "no bpy in .venv: the Blender tests were not run"; fi

# The papers' whole grid of runs: minutes.
acceptance: env
	$(PY) -m tests.acceptance.full_matrix
	$(PY) -m pytest -q -n auto --dist worksteal $(CORE_TESTS) -m slow

# How long everything takes: docs/performance.md. With other arguments: make benchmark ARGUMENTS="--only step --quick"
benchmark: env
	$(PY) -m benchmarks $(ARGUMENTS)

# Ten thousand random runs and damaged files; with other arguments: make fuzz ARGUMENTS="--runs 500 --seed 7"
fuzz: env
	$(PY) -m tests.fuzz $(ARGUMENTS)

demo: env
	$(PY) -m ski_addon demo -o out/demo

build: env
	$(PY) .ci/build.py

build-dev: env
	$(PY) .ci/build.py --development $(PYTHON_TAG)

lint: env
	$(PY) -m ruff check .
	$(PY) -m ruff format --check .

format: env
	$(PY) -m ruff check --fix .
	$(PY) -m ruff format .

types: env
	.ci/types

# Keeps .venv and the downloaded wheels.
clean:
	rm -rf build dist out .mypy_cache .pytest_cache .ruff_cache *.egg-info
	find . -name __pycache__ -not -path './.venv*' -prune -exec rm -rf {} +
