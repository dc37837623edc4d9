# Everything in one word: `make run`, `make test`. CMake does the building (CMakePresets.json).

SHELL := bash
.SHELLFLAGS := -euo pipefail -c
.DELETE_ON_ERROR:
.DEFAULT_GOAL := help

PRESET ?= release
JOBS   ?= $(shell nproc)
MINUTES ?= 1
VFPLAN := build/$(PRESET)/vfplan

# For programs of the presets asan and tsan that are not started by ctest.
export LSAN_OPTIONS ?= suppressions=$(CURDIR)/configs/sanitizers/lsan.supp:print_suppressions=0
export UBSAN_OPTIONS ?= print_stacktrace=1
export TSAN_OPTIONS ?= suppressions=$(CURDIR)/configs/sanitizers/tsan.supp:second_deadlock_stack=1

SOURCES = $(shell find kernels io engine tests bench -name '*.cpp' -o -name '*.h' | LC_ALL=C sort)

.PHONY: help setup build configure program run test sanitized fuzz golden random-sites random-networks kills tampered limits bench-build bench bench-check bench-counts plans \
        scaling area hard-scenes check-format format tidy clean

help:  ## this list
	@sed -nE 's/^([a-z-]+):.*  ## (.*)/\1|\2/p' Makefile | \
	    while IFS='|' read -r name text; do printf '  make %-13s %s\n' "$$name" "$$text"; done
	@echo "  PRESET=release|debug|asan|tsan chooses what build and test use; JOBS=$(JOBS) compilers at once"

setup:  ## install the missing Debian packages (needs root, or says what to ask for)
	@configs/packages/setup.sh

configure: setup
	@cmake --preset $(PRESET)

build: configure  ## compile build/$PRESET/vfplan and its tests
	@cmake --build --preset $(PRESET) -j $(JOBS)

program: configure
	@cmake --build --preset $(PRESET) -j $(JOBS) --target vfplan

run: program runs/town.geojson  ## plan a generated town of 637 buildings; ends with where map.png is
	@$(VFPLAN) run configs/town.toml --out runs/town
	@echo "The picture: runs/town/map.png"

runs/town.geojson: | program
	@mkdir -p runs
	@$(VFPLAN) generate town --seed 1 --out $@

test: build  ## build, then run every test
	@ctest --preset $(PRESET) -j $(JOBS)

sanitized:  ## kernels and readers under address and undefined-behaviour sanitizers (CI)
	@configs/packages/setup.sh
	@cmake --preset asan
	@cmake --build --preset asan -j $(JOBS) --target test_kernels test_io
	@ctest --preset asan -j $(JOBS) -L '^(kernels|io)$$'

random-sites: build  ## 10,000 hostile little sites of each kind, read and held against their drawing
	@VFPLAN_RANDOM_SITES=10000 build/$(PRESET)/test_io --gtest_filter='RandomSites.*'

random-networks: build  ## 400 little sites of each kind: as many networks as over all free cells
	@VFPLAN_RANDOM_SITES=400 build/$(PRESET)/test_engine --gtest_filter='RandomNetworks.*'

kills: program  ## end vfplan at random KILLS=1000 times, with 1 and 3 processes, and look at what is left
	@/usr/bin/python3 -B tests/e2e/kills.py $(VFPLAN) --kills $(or $(KILLS),1000) --ranks 1,3

tampered: program  ## change run directories, 500 bytes and 1,000 tables sealed again, and look what is made of them
	@/usr/bin/python3 -B tests/e2e/tampered.py $(VFPLAN) --bytes 500 --resealed 1000

limits: program  ## memory in steps of 10 MB, threads, file sizes, descriptors, disk: how a job ends
	@/usr/bin/python3 -B tests/e2e/limits.py $(VFPLAN) --step 10

fuzz: setup  ## MINUTES=1: any bytes as job files and sites, under sanitizers (clang); finds go to runs/fuzz
	@cmake --preset fuzz
	@cmake --build --preset fuzz -j $(JOBS) --target fuzz_job fuzz_site
	@tests/fuzz/run.sh build/fuzz $(MINUTES)

golden: program  ## after a change of results that is meant: new hashes for tests/golden
	@/usr/bin/python3 -B tests/golden/golden.py renew $(VFPLAN)

bench-build:
	@configs/packages/setup.sh
	@cmake --preset bench
	@cmake --build --preset bench -j $(JOBS)

bench: bench-build  ## time kernels and stages beside their peers; one table
	@bench/table.py --out runs/bench/table.md

bench-check: bench-build  ## fail when benchmarks got worse than bench/baseline.json
	@bench/check.py

bench-counts: bench-build  ## the same without times: answers and counts of operations (CI)
	@bench/check.py --counts

scaling: bench-build  ## threads, crops, city windows: runs/scaling/summary.md, CSV, plot (ten minutes)
	@bench/scaling.py --program build/bench/vfplan

area: program  ## windows of a city and a county: memory and time by stage (a quarter of an hour)
	@bench/area.py --program $(VFPLAN)

hard-scenes: program  ## a star, a comb, pillars, a long outline, a long line: time, memory, verify (half an hour)
	@bench/hard_scenes.py --program $(VFPLAN)

plans: program  ## Algorithm 1, refined and certified plans and bounds on every site (two hours)
	@bench/plans.py --program $(VFPLAN)

check-format:  ## fail when clang-format would change a source
	@clang-format --dry-run -Werror $(SOURCES)
	@echo "check-format: all sources are in shape."

format:  ## let clang-format change the sources
	@clang-format -i $(SOURCES)

tidy: build  ## run clang-tidy over our sources
	@printf '%s\n' $(filter %.cpp,$(SOURCES)) | xargs -r -n 1 -P $(JOBS) clang-tidy -p build/$(PRESET) --quiet

clean:  ## remove build/; runs/ stays
	@rm -rf build
