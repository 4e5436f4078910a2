# SPDX-License-Identifier: Apache-2.0
# A thin door to the CMake presets. `make run` and `make test` set up a bare Debian 12 by themselves.
.DEFAULT_GOAL := help
.PHONY: help setup setup-test build run demo test fast bench format format-check tidy coverage clean
SHELL := /bin/sh
JOBS ?= $(shell nproc)
PROGRAM ?= examples/programs/rib-pocket.mpf
MACHINE ?= examples/machines/vmc-840d.toml
REPORT ?= out/$(basename $(notdir $(PROGRAM)))

help:
	@echo "make run     cut $(PROGRAM) on the simulated machine every way, and tell the best"
	@echo "make demo    the page of a layer at work on the simulated machine"
	@echo "              PORT=linuxcnc make demo: on LinuxCNC's simulator"
	@echo "make fast    the fast tests (under two minutes once built)"
	@echo "make test    everything: format, house, both compilers, sanitizers, clang-tidy, web, all tests"
	@echo "make bench   the benchmarks"
	@echo "make format  clang-format over all sources;  make tidy  clang-tidy over all of them, tests too"
	@echo "make clean   remove what was built"

setup:
	@sh scripts/setup.sh

setup-test:
	@sh scripts/setup.sh --test

# CMake configures once; after that Ninja calls it when a CMake file changed.
build/%/build.ninja: CMakePresets.json
	@cmake --preset $* --log-level=WARNING -Wno-dev
	@touch $@

build: setup
	@$(MAKE) --no-print-directory build/release/build.ninja
	@# A library that was missing may have been installed since: then its port is built.
	@! grep -qsE '^(LINUXCNC_[A-Z_]*:.*-NOTFOUND|hdf5_FOUND:INTERNAL=$$)' build/release/CMakeCache.txt || cmake --preset release --log-level=WARNING -Wno-dev
	@cmake --build --preset release -j $(JOBS) --target steadyrest

run: build
	@build/release/bin/steadyrest cut $(PROGRAM) --machine $(MACHINE) --report $(REPORT)
	@echo "Report: $(REPORT)/report.html"

demo:
	@[ "$(PORT)" != linuxcnc ] || sh scripts/setup.sh --linuxcnc
	@$(MAKE) --no-print-directory build
	@sh scripts/demo.sh

fast: setup-test
	@sh scripts/check.sh fast

test: setup-test
	@sh scripts/check.sh all

bench: setup
	@$(MAKE) --no-print-directory build/release/build.ninja
	@cmake --build --preset release -j $(JOBS) --target bench

format:
	@sh scripts/format.sh

format-check:
	@sh scripts/format.sh --check

tidy: setup-test
	@sh scripts/tidy.sh --tests

coverage: setup-test
	@sh scripts/coverage.sh

clean:
	rm -rf build out web/dist web/node_modules web/.npm.lock
