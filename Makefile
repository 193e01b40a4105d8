# Each target sets up .venv by itself, with the versions of constraints.txt; `make` alone lists them.

PYTHON ?= python3
CONSTRAINTS ?= constraints.txt

# Another interpreter or other versions, where named, have an environment of their own beside .venv: .venv-3.12,
# .venv-lowest, .venv-3.12-lowest.
VERSION := 'import sys; print("%d.%d" % sys.version_info[:2])'
OF_PYTHON := $(if $(filter file,$(origin PYTHON)),,-$(shell $(PYTHON) -c $(VERSION)))
OF_VERSIONS := $(patsubst constraints%,%,$(basename $(notdir $(CONSTRAINTS))))
VENV := .venv$(OF_PYTHON)$(OF_VERSIONS)
# JAX and Robotics Toolbox, which poekin is measured against, need NumPy 2.
EXTRAS := $(if $(filter -lowest,$(OF_VERSIONS)),dev,dev,peers)
PY := $(VENV)/bin/python
# What is imported is compiled then: to compile all of it here would take a third of the set-up.
PIP := $(PY) -m pip install -qq --disable-pip-version-check --no-compile -c $(CONSTRAINTS)
SHELL := /bin/bash
RECENT := 'import sys; sys.exit(sys.version_info < (3, 11))'
USABLE := 'import sys, pip; sys.exit(sys.version_info < (3, 11))'

# A sourced ROS workspace or a user site would put its own packages before those of .venv.
unexport PYTHONPATH
unexport PYTHONHOME
# Without compiled modules beside the sources each of the many processes would compile the package anew.
unexport PYTHONDONTWRITEBYTECODE
export PYTHONNOUSERSITE = 1

# The stamp .venv/dev holds the directory that was set up: in a copied tree, or when the interpreter is gone,
# the environment is made anew.
SETUP_OF := $(shell $(PY) -c $(USABLE) 2>/dev/null && cat $(VENV)/dev 2>/dev/null)
ifneq ($(SETUP_OF),$(CURDIR))
.PHONY: $(VENV)/dev
endif

.DEFAULT_GOAL := help
.PHONY: help setup report test test-all test-deep test-processors lint style types readable wheel-check release-check docs mutate fuzz

help:
	@echo "make test         run all tests but the slow ones (5 minutes); ONLY=tests/groups runs all of those"
	@echo "make test-all     run all tests"
	@echo "make test-deep    run them with forty times as many new examples (hours); ONLY=tests/groups runs those alone"
	@echo "make test-processors  run the numeric tests as older processors would; ONLY='nehalem haswell' takes those"
	@echo "make report       validate every robot, count, measure, and print where the page is"
	@echo "make lint         check style (ruff), docstrings (numpydoc) and types (pyright)"
	@echo "make readable     measure how the code reads: tokens a line, assignments, ternaries, beside the bars"
	@echo "make docs         build the pages of docs/ and print where they are"
	@echo "make mutate       plant each of 137 000 errors and say which the tests catch (days); SAMPLE=300 WITHIN=600 plants that many, or as ten minutes allow"
	@echo "make fuzz         give the readers 10⁶ broken files; COUNT=10000 gives the URDF reader that many, others a tenth"
	@echo "make release-check build the source distribution and the wheel twice, check them and leave them in dist/"
	@echo "make wheel-check  build the wheel and use it where the source tree cannot be imported"
	@echo "make setup        set up $(VENV) and do nothing else"
	@echo "Each sets up $(VENV) first if need be. With another interpreter: make test PYTHON=python3.12"
	@echo "With the lowest versions that poekin takes: make test CONSTRAINTS=constraints-lowest.txt"

PYTEST = $(PY) -m pytest -n 2 --dist worksteal --durations=10

setup: $(VENV)/dev

# Slow are the files that tests/conftest.py lists: browsers, notebooks, processes, compilers, searches.
test: $(VENV)/dev
	@$(PYTEST) $(or $(ONLY),-m "not slow")

test-all: $(VENV)/dev
	@$(PYTEST)

# A test may take forty times as long as in make test, which is far less than ten minutes there.
test-deep: $(VENV)/dev
	@seed=$(or $(SEED),$$RANDOM$$RANDOM); echo "The same examples again: make test-deep SEED=$$seed"; \
	HYPOTHESIS_PROFILE=deep $(PYTEST) --timeout=12000 --hypothesis-seed=$$seed $(ONLY)

test-processors: $(VENV)/dev
	@$(PY) -m tools.processors $(ONLY)

report: $(VENV)/dev
	@$(PY) -m benchmarks

lint: style types

style: $(VENV)/lint
	$(PY) -m ruff check
	$(PY) -m ruff format --check
	$(PY) -m tools.check_docstrings

types: $(VENV)/lint
	$(PY) -m pyright --threads 2 --pythonpath $(PY)

readable: $(VENV)/dev
	$(PY) -m tools.readable

docs: $(VENV)/docs
	@$(PY) -m sphinx -q -W --keep-going -E -a -j 2 -b html docs docs/_build
	@echo "The pages: $(CURDIR)/docs/_build/index.html"

mutate: $(VENV)/dev
	@$(PY) -m tools.mutate $(if $(SAMPLE),--sample $(SAMPLE) --afresh) $(if $(WITHIN),--seconds $(WITHIN)) $(if $(SEED),--seed $(SEED)) $(if $(ROOM),--room $(ROOM)) \
	  $(addprefix --module ,$(MODULES))

fuzz: $(VENV)/dev
	@$(PY) -m tools.fuzz $(if $(COUNT),--count $(COUNT))

wheel-check: $(VENV)/dev
	@$(PY) tools/wheel_check.py

release-check: $(VENV)/release
	@$(PY) tools/release_check.py

$(VENV)/dev: pyproject.toml $(CONSTRAINTS)
	@$(PYTHON) -c $(RECENT) || { \
	  echo "poekin needs Python 3.11 or newer; $(PYTHON) is $$($(PYTHON) --version 2>&1)." \
	       "Name another one: make $(firstword $(MAKECMDGOALS)) PYTHON=python3.12" >&2; exit 1; }
	@if [ -n "$(SETUP_OF)" -a "$(SETUP_OF)" != "$(CURDIR)" ] || ! $(PY) -c $(USABLE) 2>/dev/null; then \
	  echo "Setting up: a new environment in $(VENV), $$($(PYTHON) --version)"; $(PYTHON) -m venv --clear $(VENV); fi
	@echo "Setting up: the packages of $(CONSTRAINTS) into $(VENV) (the first time takes minutes)"
	@$(PIP) hatchling setuptools wheel
	@$(PIP) --no-build-isolation -e '.[$(EXTRAS)]'
	@echo $(CONSTRAINTS) > $(VENV)/constraints
	@pwd > $@

$(VENV)/lint: $(VENV)/dev
	@echo "Setting up: ruff and pyright into $(VENV)"
	@$(PIP) --no-build-isolation -e '.[lint]'
	@touch $@

$(VENV)/docs: $(VENV)/dev
	@echo "Setting up: Sphinx into $(VENV)"
	@$(PIP) --no-build-isolation -e '.[docs]'
	@touch $@

$(VENV)/release: $(VENV)/dev
	@echo "Setting up: twine into $(VENV)"
	@$(PIP) --no-build-isolation -e '.[release]'
	@touch $@
