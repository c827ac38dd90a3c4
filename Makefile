# Every target makes its own environment first: a fresh machine needs only Python 3.11+ and make.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
READY := $(VENV)/.ready
export OMP_NUM_THREADS ?= 1
export MKL_NUM_THREADS ?= 1
export OPENBLAS_NUM_THREADS ?= 1

.PHONY: run test check bench validate docs clean help

run: $(READY)  ## the main job: a worn work shoe on a floor with glycerol
	$(BIN)/underfoot run examples/work_shoe_untreaded_glycerol.toml --out out/work_shoe_untreaded_glycerol --overwrite

test: check  ## static checks, then every test
	$(BIN)/pytest -n 2 --dist loadfile

check: $(READY)  ## ruff, pyright, import-linter
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/pyright
	$(BIN)/lint-imports

validate: $(READY)  ## closed-form checks, printed with their errors
	$(BIN)/underfoot validate

bench: $(READY)  ## measured cost, memory and scaling
	$(BIN)/python -m benchmarks

docs: $(READY)  ## the documentation as an offline site in out/docs
	$(BIN)/sphinx-build -q -W --keep-going -b html docs out/docs
	@echo "open out/docs/index.html"

clean:  ## remove the environment and everything that was made
	rm -rf $(VENV) out .pytest_cache .ruff_cache .hypothesis .import_linter_cache

help:  ## this list
	@grep -hE '^[a-z]+:.*##' Makefile | sed 's/:.*##/\t/'

$(READY): requirements.lock pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "Underfoot needs Python 3.11 or newer; set PYTHON=python3.11 (or newer)")'
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -r requirements.lock
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps -e .
	@touch $(READY)
