# Coaxial. `make help` lists the targets; `make run` and `make test` do their own set-up.
# All build output is in .venv, dist, web/node_modules, web/dist, web/src/api and docs/site; `make clean` deletes it.
# The home folder is neither read nor written. With the stamps in .venv a second start needs no network.
# Cases are in .coaxial unless COAXIAL_HOME names another folder; no target deletes them.

.DEFAULT_GOAL := help
.DELETE_ON_ERROR:
.SUFFIXES:
MAKEFLAGS += --no-builtin-rules --no-print-directory
SHELL := /bin/sh

PYTHON_IN_VENV := .venv/bin/python
STAMPS := .venv/stamps
STEP := sh .make/step
PIP := $(PYTHON_IN_VENV) -m pip
NPM := sh .make/with-node web npm

# Packages and caches go into .venv regardless of the settings of the calling shell.
unexport PYTHONPATH PYTHONHOME PIP_TARGET PIP_PREFIX NODE_ENV
# Byte code is cached; otherwise each process of a server or of the tests would compile the packages again.
unexport PYTHONDONTWRITEBYTECODE PYTHONPYCACHEPREFIX
export PIP_USER := 0
export PIP_NO_CACHE_DIR := 1
export PIP_NO_INPUT := 1
export PIP_DISABLE_PIP_VERSION_CHECK := 1
export npm_config_cache := $(CURDIR)/.venv/cache/npm
export npm_config_update_notifier := false
export npm_config_fund := false
export npm_config_audit := false
# The page's lock must not contain registry addresses.
export npm_config_omit_lockfile_registry_resolved := true

# Number of test files in parallel, one more than processors: tests wait for their servers about as long as they compute.
# Each additional worker collects all tests again, and slows down the servers, which run in real time.
WORKERS ?= 3

TRACKER_SOURCES := $(shell find tracker -name '*.py')
# Folders are listed too, because their time changes when a file is deleted. The client of the API is generated.
PAGE_SOURCES := $(shell find web/src web/public -not -path 'web/src/api*' 2>/dev/null) \
	$(filter-out web/dist web/node_modules,$(wildcard web/*.json web/*.ts web/*.js web/*.html))

GUIDE_SOURCES := docs/zensical.toml $(shell find docs/guide 2>/dev/null)

# An environment from another folder, or whose Python no longer exists, is created again.
SOUND := $(shell [ "$$(cat $(STAMPS)/place 2>/dev/null)" = "$$(pwd)" ] \
	&& $(PYTHON_IN_VENV) -c '' 2>/dev/null && echo yes)

# ---------------------------------------------------------------- for everybody

.PHONY: help
help: ## this list
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "  make %-12s %s\n", $$1, $$2 }' Makefile

.PHONY: run
run: ready-to-run ## start Coaxial with the rehearsal theatre, and print the address to open (ARGS="..." go to coaxial run)
	@COAXIAL_HOME="$${COAXIAL_HOME:-$(CURDIR)/.coaxial}" exec $(PYTHON_IN_VENV) -m server run $(ARGS)

.PHONY: test
test: $(STAMPS)/project ## everything: format, lint, types, contracts, Python, web and browser tests
	@# Compiling takes a minute of one core. Meanwhile the rest is installed, and the static checks run.
	@$(MAKE) $(STAMPS)/warm & warm=$$!; $(MAKE) --jobs=2 $(STAMPS)/page $(STAMPS)/dev && $(MAKE) --jobs=2 judged-python judged-page; \
	checked=$$?; wait $$warm && exit $$checked
	@$(MAKE) test-python

# The core, for every commit. Only `make test` runs servers, whole scenes, CTs, calibrations, the browser, the format of
# the page, and the slowest files of these folders.
FAST_TESTS := $(addprefix tests/tracker/,geometry edges regions quads marker navigation/alarms) \
	$(addprefix tests/server/,alarms texts)
FAST_LEAVES_OUT := $(addprefix --ignore-glob=*/,test_candidates.py test_photometric_fit*.py test_stepwise_illumination.py \
	test_alarm_laws.py test_good_drilling.py test_no_contradiction.py)

.PHONY: test-fast fast-checks fast-tests
test-fast: $(STAMPS)/warm ## the core, for every commit: unit tests, lint, types, web tests
	@$(MAKE) --jobs=2 $(STAMPS)/dev $(STAMPS)/page-packages
	@$(MAKE) --jobs=2 fast-tests fast-checks
fast-checks:
	@$(MAKE) lint-python
	@$(MAKE) types-python
	@$(NPM) run --silent lint
	@$(MAKE) types-page
	@$(MAKE) test-web
fast-tests:
	@$(PYTHON_IN_VENV) -m pytest -q -m "not browser" $(FAST_TESTS) $(FAST_LEAVES_OUT)

.PHONY: check
check: ## static checks: lint and types
	@$(MAKE) lint
	@$(MAKE) types

# ---------------------------------------------------------------- for developers

.PHONY: format
format: $(STAMPS)/dev $(STAMPS)/page-packages ## format all code
	@$(PYTHON_IN_VENV) -m ruff format .
	@$(PYTHON_IN_VENV) -m ruff check --fix .
	@$(NPM) run --silent format

.PHONY: lint
lint: lint-python lint-page ## format, lint and import contracts

.PHONY: types
types: types-python types-page ## strict types, Python and TypeScript

.PHONY: lint-python
lint-python: $(STAMPS)/dev
	@$(PYTHON_IN_VENV) -m ruff format --check .
	@$(PYTHON_IN_VENV) -m ruff check .
	@.venv/bin/lint-imports --no-logo

.PHONY: lint-page
lint-page: $(STAMPS)/page-packages
	@$(NPM) run --silent format:check
	@$(NPM) run --silent lint

.PHONY: types-python
types-python: $(STAMPS)/dev
	@.venv/bin/pyrefly check

.PHONY: types-page
types-page: $(STAMPS)/page-packages
	@$(NPM) run --silent types

# The static checks of the gate, in two parts that run in parallel. Those of the page run one after the other, because
# two at once could both generate the client of the API.
.PHONY: judged-python judged-page
judged-python:
	@$(MAKE) lint-python
	@$(MAKE) types-python
judged-page:
	@$(MAKE) lint-page
	@$(MAKE) types-page
	@$(MAKE) test-web

.PHONY: test-web
test-web: $(STAMPS)/page-packages
	@$(NPM) run --silent test

.PHONY: test-python
test-python: ready $(STAMPS)/dev ## Python and browser tests alone (TESTS="tests/server -k words" narrows them)
	@COAXIAL_CHROMIUM="$$(sh .make/find-chromium)" || exit 1; export COAXIAL_CHROMIUM; sh .make/find-dicom-tools; sh .make/find-nats-server; \
	sh .make/run-tests $(PYTHON_IN_VENV) $(WORKERS) $(TESTS)

.PHONY: test-lowest
test-lowest: ready $(STAMPS)/dev ## what the packages are used for, with the lowest versions that pyproject.toml declares
	@sh .make/test-lowest

.PHONY: benchmark
benchmark: ready $(STAMPS)/dev ## accuracy and speed of the tracker, compared with its peers, and regressions
	@$(PYTHON_IN_VENV) -m tests.benchmarks $(ARGS)

.PHONY: fuzz
fuzz: ready $(STAMPS)/dev ## changed files and messages for all that reads bytes of strangers (MINUTES=10), findings into .fuzzing
	@$(PYTHON_IN_VENV) -m tests.fuzzing --minutes $(or $(MINUTES),10) $(ARGS)

.PHONY: soak
soak: ready $(STAMPS)/dev ## a server with viewers, alarms, recordings and kills for hours (HOURS=8): does anything grow?
	@$(PYTHON_IN_VENV) -m tests.procedure.soak --hours $(or $(HOURS),8) $(ARGS)

.PHONY: kills
kills: ready $(STAMPS)/dev ## kill -9 of the server's processes at random moments of a procedure (MINUTES=15): is all that was confirmed there?
	@$(PYTHON_IN_VENV) -m tests.procedure.killed --minutes $(or $(MINUTES),15) $(ARGS)

.PHONY: house
house: ready $(STAMPS)/dev ## figures on the structure: sizes, small files, circles of imports, words of the former dialect
	@$(PYTHON_IN_VENV) -m tests.house

.PHONY: docs
docs: $(STAMPS)/guide ## build the user guide, which the server shows at /docs/

.PHONY: wheel
wheel: $(STAMPS)/page $(STAMPS)/guide ## build a wheel and a source archive with page and guide, into dist
	@rm -f dist/coaxial-*
	@$(STEP) wheel "Building wheel and source archive" "Look at [tool.hatch] in pyproject.toml." \
		$(PYTHON_IN_VENV) -m hatchling build -d dist -t sdist -t wheel
	@ls dist/coaxial-*

.PHONY: image
image: ## build the container image with buildah, podman or docker
	@sh .make/image

.PHONY: sbom
sbom: $(STAMPS)/dev $(STAMPS)/page-packages ## the software bill of materials (CycloneDX) of what runs, into dist
	@$(NPM) sbom --sbom-format cyclonedx --package-lock-only >.venv/log/page.cdx.json
	@$(PYTHON_IN_VENV) .make/sbom.py .venv/log/page.cdx.json dist/coaxial.cdx.json
	@echo dist/coaxial.cdx.json

.PHONY: release
release: $(STAMPS)/dev ## test, build, sign and tag a release (VERSION=1.2.0 KEY=~/.ssh/id_ed25519, ARGS=--dry-run prints it)
	@$(PYTHON_IN_VENV) .make/release.py --version "$(VERSION)" --key "$(KEY)" $(ARGS)

.PHONY: audit
audit: $(STAMPS)/dev ## known vulnerabilities of all locked packages, looked up at PyPI and npm
	@sh .make/audit

.PHONY: lock
lock: $(STAMPS)/dev ## write the locks again (UPGRADE=--upgrade for the newest versions)
	@UPGRADE="$(UPGRADE)" sh .make/lock

.PHONY: clean
clean: ## delete all build output, but no case
	rm -rf .venv dist docs/site docs/.cache web/node_modules web/dist web/src/api web/*.tsbuildinfo .pytest_cache .ruff_cache .import_linter_cache .hypothesis
	find tracker server tests -name __pycache__ -type d -prune -exec rm -rf {} +
	@if [ -e .coaxial ]; then echo "Kept: .coaxial, the folder with the cases. Remove it by hand to lose them."; fi

# ---------------------------------------------------------------- prerequisites

# In parallel: packages and then the tracker's kernels; the page's packages and then the page.
.PHONY: ready
ready:
	@$(MAKE) --jobs=3 $(STAMPS)/project $(STAMPS)/page $(STAMPS)/warm

# The kernels are compiled in the background while the server shows its page and the progress, and then the guide is
# built. This does not use make's jobs, because make would wait for them.
.PHONY: ready-to-run
ready-to-run: $(STAMPS)/place
	@$(MAKE) --silent $(STAMPS)/page & page=$$!; \
	$(MAKE) --silent $(STAMPS)/project; installed=$$?; \
	[ $$installed -ne 0 ] || $(MAKE) --question $(STAMPS)/warm $(STAMPS)/guide || \
		nice sh .make/build-guide $(MAKE) --keep-going $(STAMPS)/warm $(STAMPS)/guide & \
	wait $$page && exit $$installed

$(STAMPS)/place: $(if $(SOUND),,anew)
	@python=$$(PYTHON="$(PYTHON)" sh .make/find-python) && rm -rf .venv && mkdir -p .venv/log && \
	$(STEP) environment "Making the environment in .venv with $$python" \
		"Check whether the disk is full or this folder is not writable." \
		"$$python" -m venv .venv && mkdir -p $(STAMPS) && pwd >$@

.PHONY: anew
anew:

$(STAMPS)/packages: requirements.lock requirements-build.lock requirements-installer.lock $(STAMPS)/place
	@$(STEP) packages "Installing Python packages" \
		"Check whether this machine reaches its package index, and whether its Python is 3.11 to 3.14." \
		sh .make/install requirements.lock requirements-build.lock
	@touch $@

$(STAMPS)/project: pyproject.toml $(STAMPS)/packages
	@$(STEP) project "Installing Coaxial itself" "Look at pyproject.toml." \
		$(PIP) install --no-index --no-deps --no-build-isolation --editable .
	@touch $@

# After the project, because two installers must not modify one environment at once.
$(STAMPS)/dev: requirements-dev.lock $(STAMPS)/project
	@$(STEP) dev "Installing what the tests need" \
		"Check whether this machine reaches its package index, and whether its Python is 3.11 to 3.14." \
		sh .make/install requirements-dev.lock
	@touch $@

# After the start, or for `make docs`, so that a start does not wait for the guide.
$(STAMPS)/docs-packages: requirements-docs.lock $(STAMPS)/project
	@$(STEP) docs-packages "Installing what builds the guide" \
		"Check whether this machine reaches its package index, and whether its Python is 3.11 to 3.14." \
		sh .make/install requirements-docs.lock
	@touch $@

$(STAMPS)/guide: $(GUIDE_SOURCES) $(STAMPS)/docs-packages
	@$(STEP) guide "Building the guide" "Look at the log; the guide's sources are in docs/guide." \
		.venv/bin/zensical build --strict --clean --config-file docs/zensical.toml
	@touch $@

$(STAMPS)/page-packages: web/package-lock.json requirements-node.lock $(STAMPS)/place
	@$(STEP) page-packages "Installing the page's packages" \
		"Check whether this machine reaches its package registry, then try again." \
		$(NPM) ci --include=dev
	@touch $@

$(STAMPS)/page: $(PAGE_SOURCES) $(STAMPS)/page-packages
	@$(STEP) page "Building the page" "Look at the log; the page's sources are in web/src." \
		$(NPM) run build
	@touch $@

# Numba's cache key contains only the file of the called function: after a change of a callee, old code would run.
$(STAMPS)/warm: $(TRACKER_SOURCES) $(STAMPS)/project
	@find tracker -name "*.nb[ic]" -delete
	@$(STEP) warm "Compiling the tracker for this machine (once)" "Look at the log." \
		$(PYTHON_IN_VENV) -m server.loop.compiling
	@touch $@
