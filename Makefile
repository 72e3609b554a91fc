# The two commands: `make verify` (both methods, all claims, a report) and `make test`. Each sets up all it needs.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
READY := $(VENV)/.ready
OUT := build/verification

# One thread for BLAS: jobs run side by side in processes, and results do not depend on a thread count.
export OMP_NUM_THREADS ?= 1
export OPENBLAS_NUM_THREADS ?= 1
# Bytecode is kept, whatever the environment says: tests are collected in half of the time.
export PYTHONDONTWRITEBYTECODE :=
export PIP_CONSTRAINT := $(CURDIR)/constraints.txt
export PIP_DISABLE_PIP_VERSION_CHECK := 1

.PHONY: help verify docs test test-slow lint types imports setup format constraints clean

help:  ## Show the targets
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed 's/:.*## /\t/' | expand -t 16

verify: $(READY)  ## Run the verification cases through all methods; report in build/verification/report.html
	$(BIN)/contact-verify run --suite ci --out $(OUT)

# Neighbouring tests share scenes: each process takes half of the tests as they stand, and what the other has left.
PYTEST := $(BIN)/python -m pytest -n 2 --dist worksteal

test: lint types imports  ## Lint, types, import contract and the fast tests
	$(PYTEST)

test-slow: $(READY)  ## The slow tests as well
	$(PYTEST) -m "slow or not slow"

lint: $(READY)  ## Format and lint rules
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .

types: $(READY)  ## Strict types
	$(BIN)/mypy

imports: $(READY)  ## Import directions
	$(BIN)/lint-imports --no-cache > build/imports.txt || { cat build/imports.txt; exit 1; }

setup: $(READY)  ## Virtual environment with pinned packages, and gmsh's system libraries

$(READY): pyproject.toml constraints.txt tools/system_libraries.sh
	@mkdir -p build
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
		{ echo "contact-verification needs Python 3.11 or newer; name one with: make PYTHON=python3.11"; exit 1; }
	@$(PYTHON) -c 'import ensurepip, venv' || \
		{ echo "Python's venv module is missing; on Debian or Ubuntu: apt-get install python3-venv"; exit 1; }
	test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --editable '.[dev,test]'
	sh tools/system_libraries.sh $(BIN)/python
	@touch $@

docs: $(READY)  ## The documentation in build/docs/index.html; warnings are errors
	$(BIN)/python -m pip install --quiet --editable '.[docs]'
	$(BIN)/python -m sphinx -W --keep-going -q -b html docs build/docs

format: $(READY)  ## Reformat the sources
	$(BIN)/ruff format .
	$(BIN)/ruff check --fix .

constraints:  ## Renew constraints.txt from the newest releases that pyproject.toml admits
	rm -rf build/constraints && $(PYTHON) -m venv build/constraints
	PIP_CONSTRAINT= build/constraints/bin/python -m pip install --quiet --upgrade '.[dev,docs,test,referees]' setuptools
	{ echo "# Exact versions of every direct and transitive dependency: the same answer on every machine."; \
	  echo "# Renewed by: make constraints"; \
	  build/constraints/bin/python -m pip freeze --all --exclude pip --exclude contact-verification | sort -f; } > constraints.txt

clean:  ## Remove everything that was built
	rm -rf build $(VENV) *.egg-info
