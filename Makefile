# Every target makes its own environment first: a fresh machine needs only Python 3.11+ and make.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
READY := $(VENV)/.ready
# Quick tests: two workers, each takes over from the other when its own are done. Slow ones: a file
# stays with one worker, since its tests share long runs; three, since those of pages often wait.
PYTEST := $(BIN)/pytest --dist
# A page may fail beside two others for want of a processor: what failed, printed in full, is run
# once more alone; what fails again fails.
SLOW := "slow and not study"
AGAIN := --last-failed --last-failed-no-failures none
# The tests start hundreds of processes, which begin a quarter sooner from bytecode.
unexport PYTHONDONTWRITEBYTECODE
SEED := $(or $(SEED),$(shell od -An -N4 -tu4 /dev/urandom | tr -d " "))

.PHONY: run app check test test-quick test-costly test-slow test-studies fuzz fuzz-files mutants ways neighbours test-install chromium bundle bundle-check bench validate docs manual clean help

run: $(READY)  ## the main job: a worn work shoe on a floor with glycerol
	$(BIN)/underfoot run examples/work_shoe_untreaded_glycerol.toml --out out/work_shoe_untreaded_glycerol --overwrite

app: $(READY)  ## the local web app, in your browser
	$(BIN)/underfoot app

check: $(READY)  ## ruff, pyright, import-linter (a minute)
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/pyright
	$(BIN)/lint-imports

test: check test-quick  ## static checks, then every quick test (minutes)

test-quick: $(READY)  ## every test that is neither costly nor slow
	$(PYTEST) worksteal -n 2 -m "not costly and not slow and not study"

test-costly: $(READY)  ## those by which no planted fault dies alone (tests/costly.txt)
	$(PYTEST) worksteal -n 2 -m "costly and not slow and not study"

fuzz: $(READY)  ## Hypothesis with examples that no run had before; SEED=N repeats a run
	@echo "make fuzz SEED=$(SEED) repeats this run; a find becomes an @example of its test"
	$(PYTEST) worksteal -n 2 -m "hypothesis and not slow and not study" --hypothesis-profile=fuzz --hypothesis-seed=$(SEED)

fuzz-files: $(READY)  ## 100,000 damaged files through every reader; COUNT=N for fewer
	PYTHONPATH=tests $(BIN)/python tests/fuzz_files.py $(or $(COUNT),100000) $(SEED)

mutants: $(READY)  ## 20 seeded faults a room, and those that quick tests let pass; ROOM="slip shoe" for some
	PYTHONPATH=tests $(BIN)/python tests/mutants.py $(ROOM) --count $(or $(COUNT),20) --seed $(SEED)

ways: $(READY)  ## stays, files, climbs and returns of eight values on their way; WAY=trial for each stay of one
	$(BIN)/python tests/ways.py $(WAY)

neighbours:  ## what other programs do with the rows of docs/reference/other_programs.md; WRITE=--write
	python3 -m venv out/neighbours && out/neighbours/bin/pip install -q -r benchmarks/neighbours/requirements.txt
	out/neighbours/bin/python benchmarks/neighbours/rows.py docs/reference/other_programs.md $(WRITE)

test-slow: $(READY)  ## the slow tests
	$(PYTEST) loadfile $(ORDER) -n 3 -m $(SLOW) || $(BIN)/pytest $(AGAIN) -m $(SLOW)

test-studies: $(READY)  ## tests of a minute and more: the corpus, treads that none can tell apart
	$(PYTEST) loadfile -n 2 -m study

test-install: $(READY)  ## the wheel without the lock, on newest and lowest versions, runs the main job
	$(BIN)/python tests/install/wheel.py

chromium:  ## a browser for the tests of the pages, where there is none (Debian, Ubuntu; as root)
	@command -v chromium chromium-browser google-chrome chrome || { \
	apt-get update -q && apt-get install -y -q --no-install-recommends chromium; }

bundle: $(READY)  ## the program as a folder that needs no Python, in out/bundle (minutes)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check "pyinstaller>=6.11"
	$(BIN)/python packaging/bundle.py

bundle-check:  ## the bundle serves its first page and computes a case
	$(BIN)/python packaging/bundle.py --check

validate: $(READY)  ## closed-form checks, printed with their errors
	$(BIN)/underfoot validate

bench: $(READY)  ## measured cost, memory and scaling
	$(BIN)/python -m benchmarks

docs: $(READY)  ## the documentation as an offline site in out/docs
	$(BIN)/sphinx-build -q -W --keep-going -b html docs out/docs
	$(BIN)/sphinx-build -q -b manual docs out/docs
	@echo "open out/docs/index.html"

manual: docs  ## the theory on one page, printed as out/docs/theory_manual.pdf (needs Chromium)
	$(BIN)/python docs/print_manual.py out/docs/theory_manual.html out/docs/theory_manual.pdf

clean:  ## remove the environment and everything that was made
	rm -rf $(VENV) out .pytest_cache .ruff_cache .hypothesis .import_linter_cache

help:  ## this list
	@grep -hE '^[a-z-]+:.*##' Makefile | sed 's/:.*##/\t/'

$(READY): requirements.lock pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "Underfoot needs Python 3.11 or newer; set PYTHON=python3.11 (or newer)")'
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -r requirements.lock
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps -e .
	@touch $(READY)
