# The commands of this repository; `make help` lists them.
#
# Everything is installed into .venv beside this file. A stamp in .venv/stamps stands for one set of
# requirements, and is renewed when pyproject.toml changes; the stamp `core` stands for the compiled
# core, and is renewed when a Rust source changes. So a second call of a target builds and installs
# nothing. `make PYTHON=python3.12 ...` chooses the interpreter.
#
# The core is built with the profile `dev` of Cargo.toml, in a minute; what is measured and published
# is built with `release`, which takes several.

# Compiled modules are kept: two processes that test compile 400 files each otherwise, and a program
# that a test starts the whole package.
unexport PYTHONDONTWRITEBYTECODE

PYTHON ?= $(shell for p in python3 python3.14 python3.13 python3.12 python3.11 python; do \
	$$p -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null && { echo $$p; break; }; done)
RUST_MINOR := 89
FUZZ_SECONDS ?= 20
BENCH ?=
COUNTS ?=
MUTANTS ?=
# The order of the tests; any number, at random by default.
SEED ?=
# A part of what only the deep tier of the tests has, for `make test`: 2/5.
PART ?=
# What `make check` compares with; the last commit by default.
SINCE ?=
DEMO_DATA := examples/data/ahn3_crop_100m.laz

VENV := .venv
BIN := $(VENV)/bin
STAMPS := $(VENV)/stamps
SOURCES := pyproject.toml Cargo.toml $(wildcard Cargo.lock) $(wildcard crates/*/Cargo.toml) \
	$(shell find crates -name '*.rs' 2>/dev/null)
PYTHON_SOURCES := $(shell find python -name '*.py' -o -name '*.pyi')
# All crates, though that of the bindings has no tests: so the features of the packages below are those
# with which maturin builds, and nothing is compiled twice.
CARGO_TEST := cargo test --quiet --workspace --lib --tests
CARGO_DOCTEST := cargo test --quiet --workspace --doc
# One process for each processor; those that are done take tests from the others.
PYTEST := $(VENV)/bin/pytest -n auto --dist worksteal
# Docstrings and pages, whose code runs in order; the programs that draw the pages are no part of them.
DOCTEST = $(PYTEST) -p no:randomly --doctest-modules --doctest-glob='*.rst' \
	$(addprefix --ignore-glob=,docs/*.py docs/*/*.py docs/*/*/*.py) python/delone docs

# As Python writes it: 0.1.0a1 where Cargo has 0.1.0-alpha.1.
VERSION := $(shell sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -n 1 | \
	sed 's/-alpha\./a/; s/-beta\./b/; s/-rc\./rc/')

# What each environment needs, as extras (-E) and dependency groups (-G) of pyproject.toml.
NEEDS_build :=
DEMO_EXTRAS := cli,las,mesh,plot
NEEDS_demo := -E $(DEMO_EXTRAS)
EXTRAS := cli,dxf,explore,fem,geo,globe,graph,landxml,las,mesh,plot,pyvista,raster,xarray,dask,learn
NEEDS_test := -E $(EXTRAS) -G test
NEEDS_docs := -E $(EXTRAS) -G test,docs
NEEDS_bench := --release -E $(EXTRAS) -G bench
# Tests and lint use the environment of the documentation where there is one: it has all that they need.
ENVIRONMENT ?= $(if $(wildcard $(STAMPS)/docs),docs,test)

.PHONY: help need need-python build demo demo-says wheel release-check web site check test test-deep lint docs linkcheck bench counts fuzz mutants map clean
.DEFAULT_GOAL := help

help:
	@echo 'make demo    triangulate the lidar tile in examples/data: report, picture, mesh file'
	@echo 'make check   after each change: what it touches, layers, lint; a minute and a half'
	@echo 'make test    before each commit: Rust, Python, doctests, pages, layers; ten minutes'
	@echo 'make test-deep  before a release, and every night: all seeds, sizes, combinations, examples; an hour'
	@echo 'make lint    clippy, rustdoc, rustfmt, ruff, mypy, codespell, and the stub against the built module'
	@echo 'make docs    the documentation, into docs/_build/html'
	@echo 'make site    the same with the core for its figures, as it is published'
	@echo 'make linkcheck  the links of the documentation to other sites (needs a network)'
	@echo 'make bench   the tables of benchmarks/README.md (BENCH="--n 100000 --runs 3")'
	@echo 'make counts  instructions of fixed jobs beside the stored counts (COUNTS=--update stores them)'
	@echo 'make fuzz    each fuzz target for FUZZ_SECONDS ($(FUZZ_SECONDS)) seconds'
	@echo 'make mutants seed bugs, each of which the tests must find (MUTANTS="proof-*" for some)'
	@echo 'make wheel   a wheel for this machine, optimized as in a release, into dist'
	@echo 'make release-check  sdist and wheels for Linux as published, installed and tested; 15 minutes'
	@echo 'make web     the core as a module for pages, into target/web (crates/web/build.sh says how)'
	@echo 'make map     the charts and tables of modules in architecture/map.md'
	@echo 'make stub    the types of the compiled module, from the source of the bindings'
	@echo 'make build   the package alone, installed into .venv in development mode'
	@echo 'make clean   remove everything that these made'

# Says all that is missing at once, then stops.
need-python:
	@missing=0; say() { echo "delone: $$*" >&2; missing=1; }; \
	if [ -z "$(PYTHON)" ]; then \
		say 'Python is missing. Install Python 3.11 or later: https://www.python.org/downloads'; \
	elif ! $(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; then \
		say '$(PYTHON) is not Python 3.11 or later: https://www.python.org/downloads'; \
	elif ! $(PYTHON) -c 'import venv, ensurepip' 2>/dev/null; then \
		say "Python's venv module is missing (Debian, Ubuntu: apt install python3-venv)"; \
	fi; \
	exit $$missing

need:
	@missing=0; say() { echo "delone: $$*" >&2; missing=1; }; \
	rust=$$(rustc --version 2>/dev/null | sed -n 's/^rustc 1\.\([0-9]*\).*/\1/p'); \
	if ! command -v cargo >/dev/null || [ -z "$$rust" ]; then \
		say 'Rust is missing. Install Rust 1.$(RUST_MINOR) or later: https://rustup.rs'; \
	elif [ "$$rust" -lt $(RUST_MINOR) ]; then \
		say "Rust 1.$$rust is too old. Install 1.$(RUST_MINOR) or later: rustup update stable"; \
	fi; \
	if ! command -v cc >/dev/null; then \
		say 'A C compiler is missing: Rust links with it. Install gcc or clang' \
			'(Debian, Ubuntu: apt install gcc; macOS: xcode-select --install)'; \
	fi; \
	$(MAKE) --no-print-directory need-python || missing=1; \
	exit $$missing

# uv installs in seconds what takes pip minutes; where it has no wheel, pip does it.
$(STAMPS)/tools: | need-python
	@test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	@.ci/patiently 'Installing pip and maturin' \
		$(BIN)/python -m pip install --upgrade 'pip>=25.1' 'maturin>=1.9,<2'
	-@$(BIN)/python -m pip install --quiet --only-binary uv uv
	@mkdir -p $(STAMPS) && touch $@

MATURIN = VIRTUAL_ENV=$(abspath $(VENV)) PATH="$(abspath $(BIN)):$$PATH" $(BIN)/maturin develop
UV = $$(test -x $(BIN)/uv && echo --uv)

$(STAMPS)/%: pyproject.toml $(STAMPS)/tools | need
	$(MATURIN) $(UV) $(NEEDS_$*)
	@touch $@ $(STAMPS)/core

# The release that is measured takes the place of the core that is tested, and the other way round.
$(STAMPS)/bench: $(SOURCES) $(STAMPS)/tools | need
	$(MATURIN) $(UV) $(NEEDS_bench)
	@rm -f $(STAMPS)/core && touch $@

$(STAMPS)/core: $(SOURCES) | need
	$(MATURIN) --skip-install
	@rm -f $(STAMPS)/bench && touch $@

build: $(STAMPS)/build $(STAMPS)/core

# Linked with zig against an old glibc, a wheel made on Linux runs on all distributions since 2014.
wheel: $(STAMPS)/tools | need
	@if [ "$$(uname -s)" = Linux ]; then \
		$(BIN)/python -m pip install --quiet ziglang; \
		PATH="$(abspath $(BIN)):$$PATH" $(BIN)/maturin build --release --out dist --interpreter \
			$(abspath $(BIN))/python --zig --compatibility manylinux_2_17; \
	else \
		$(BIN)/maturin build --release --out dist --interpreter $(abspath $(BIN))/python; \
	fi

# What would be published for Linux is built, installed without a compiler and tested; nothing is
# published. The wheel for the other processor is linked with zig, and needs the standard library of
# Rust for it; that for free-threaded Python is tested where such an interpreter is found. What cannot
# be fetched is left out; the last lines say so, once. TAG=vX.Y.Z judges changelog and pages as those
# of a release.
TAG ?=
release-check: $(STAMPS)/tools | need
	@for tool in ziglang abi3audit uv; do \
		$(BIN)/python -m pip install --quiet $$tool 2> /dev/null || true; \
	done
	@$(BIN)/python -m uv python install --quiet 3.14t 2> /dev/null || true
	@rustup --quiet target add x86_64-unknown-linux-gnu aarch64-unknown-linux-gnu 2> /dev/null || true
	$(BIN)/python .github/rehearse.py $(if $(TAG),--tag $(TAG))

# A module of JavaScript over the core in WebAssembly. Without a compiler for it the tests of the
# module are skipped.
web: need
	crates/web/build.sh

demo-says:
	@echo 'make demo triangulates 212,550 lidar points: a report, a picture and a mesh file. The first' \
		'run installs everything into $(VENV): a minute with a wheel, three where Rust must compile.'

# The demo takes a wheel where there is one: of dist, unless a source is newer, or, if this version is
# released, of the package index. Otherwise, or where a package in development mode would be replaced,
# it compiles.
$(STAMPS)/demo: $(SOURCES) $(PYTHON_SOURCES) | demo-says need-python
	@$(MAKE) --no-print-directory $(STAMPS)/tools
	@wheel=$$(ls -t dist/delone-$(VERSION)-*.whl 2>/dev/null | head -n 1); \
	if ls $(addprefix $(STAMPS)/,build test docs bench) 2>/dev/null | grep -q .; then false; \
	elif [ -n "$$wheel" ] && [ -z "$$(find $^ -newer "$$wheel")" ]; then \
		echo "Installing $$wheel"; \
		$(BIN)/python -m pip install --quiet --force-reinstall --no-deps "$$wheel" && \
		$(BIN)/python -m pip install --quiet "$$wheel[$(DEMO_EXTRAS)]"; \
	elif grep -q '^## \[$(VERSION)\] - ' CHANGELOG.md; then \
		echo 'Installing the wheel of version $(VERSION)'; \
		$(BIN)/python -m pip install --quiet --only-binary delone 'delone[$(DEMO_EXTRAS)]==$(VERSION)'; \
	else false; fi || { \
		$(MAKE) --no-print-directory need && \
		.ci/patiently 'Compiling and installing delone' env $(MATURIN) $(UV) $(NEEDS_demo); }
	@touch $@

demo: $(STAMPS)/demo
	@mkdir -p demo
	$(BIN)/delone triangulate $(DEMO_DATA) -o demo/ahn3.png -o demo/ahn3.vtu
	@echo 'The picture: $(abspath demo/ahn3.png)'
	@echo 'The mesh (open it in ParaView): $(abspath demo/ahn3.vtu)'

.PHONY: environment
environment: $(STAMPS)/$(ENVIRONMENT)
	@$(MAKE) --no-print-directory $(STAMPS)/core

check: environment
	$(BIN)/python tests/check.py $(if $(SINCE),--since $(SINCE))

test: environment
	$(CARGO_TEST)
	$(CARGO_DOCTEST)
	$(DOCTEST)
	$(PYTEST) --times --tier=test$(if $(PART),+$(PART)) $(if $(SEED),--randomly-seed=$(SEED))

test-deep: environment
	DELONE_DEEP=1 $(CARGO_TEST)
	$(CARGO_DOCTEST)
	$(DOCTEST)
	$(PYTEST) --times --tier=deep $(if $(SEED),--randomly-seed=$(SEED))

lint: environment
	cargo fmt --all --check
	cargo clippy --workspace --all-targets -- -D warnings
	RUSTDOCFLAGS='-D warnings' cargo doc --workspace --exclude delone-bindings --no-deps --quiet
	cargo fmt --manifest-path benchmarks/peers/Cargo.toml --check
	cargo clippy --manifest-path benchmarks/peers/Cargo.toml -- -D warnings
	$(BIN)/codespell
	$(BIN)/python .github/licenses.py --check
	$(BIN)/python .github/check_release.py
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	cd python && ../$(BIN)/python -m mypy.stubtest delone._core

# With a core for the figures, all of them must have it.
WEB_CORE := target/web/delone_web_bg.wasm

docs: $(STAMPS)/docs
	@$(MAKE) --no-print-directory $(STAMPS)/core
	$(BIN)/sphinx-build -W --keep-going -q -b html docs docs/_build/html
	$(BIN)/python docs/check_site.py docs/_build/html $(if $(wildcard $(WEB_CORE)),--live)
	@echo 'The documentation: $(abspath docs/_build/html/index.html)'

# What is published: the documentation with the core for its figures. The workflow `docs` runs this.
site: web
	@$(MAKE) --no-print-directory docs
	$(BIN)/python docs/check_site.py docs/_build/html --live

# Needs a network: lists the links to other sites, and fails where one is broken.
linkcheck: $(STAMPS)/docs
	$(BIN)/sphinx-build -q -b linkcheck docs docs/_build/linkcheck

bench: $(STAMPS)/bench
	$(BIN)/python benchmarks/wheels.py $(BENCH)
	$(BIN)/python benchmarks/crates.py $(BENCH)
	$(BIN)/python benchmarks/constrained.py $(BENCH)
	$(BIN)/python benchmarks/refine.py $(BENCH)
	$(BIN)/python benchmarks/space.py $(BENCH)
	$(BIN)/python benchmarks/hull.py $(BENCH)
	$(BIN)/python benchmarks/threads.py $(BENCH)
	$(BIN)/python benchmarks/interpolate.py $(BENCH)
	$(BIN)/python benchmarks/voronoi.py $(BENCH)
	$(BIN)/python benchmarks/tiles.py
	$(BIN)/python benchmarks/voronoi3.py $(BENCH)
	@if [ -n "$$DELONE_LIDAR" ]; then $(BIN)/python benchmarks/lidar.py; fi

# No time, but nearly the same number on every machine; needs valgrind, and passes without.
counts: need
	@$(PYTHON) benchmarks/counts.py $(COUNTS)

mutants: environment
	$(BIN)/python tests/mutants/run.py $(foreach name,$(MUTANTS),'$(name)')

# The map needs Python alone.
map:
	$(PYTHON) tests/oracles/structure.py

stub: environment
	$(BIN)/python crates/bindings/stub.py

fuzz: need
	fuzz/run.sh $(FUZZ_SECONDS)

clean:
	rm -rf $(VENV) target demo build dist docs/_build docs/generated docs/gallery
	rm -rf benchmarks/peers/target fuzz/target .pytest_cache .mypy_cache .ruff_cache .hypothesis
	find python tests docs benchmarks -name __pycache__ -type d -exec rm -rf {} +
	rm -f python/delone/_core*.so python/delone/_core*.pyd
