# Thin commands over CMake's presets. Each installs the Debian packages that it needs and lacks, builds what is out of
# date, and asks nothing.
SHELL := /bin/bash
JOBS ?= $(shell nproc)
FILTER ?= .
FUZZ_SECONDS ?= 60
# A server that sets CI gets warnings as errors in every build.
CONFIGURE := $(if $(CI),-DSELVEDGE_WERROR=ON)
SOURCES = git ls-files '*.cpp' '*.hpp'
PROGRAM := build/release/selvedge

PACKAGES_release := build suitesparse fcl viewer test python
ADDED_release := cmake/add-python.sh build/release
PACKAGES_dev := $(PACKAGES_release)
PACKAGES_asan := $(PACKAGES_release)
PACKAGES_asan-core := $(PACKAGES_release)
PACKAGES_tsan := $(PACKAGES_release) tsan
PACKAGES_minimal := build viewer test

.PHONY: help program demo blender with-blender with-python test everything validate bench stress stability wardrobe compare tutorials fuzz dev long check-install wheel asan asan-core tsan minimal torch mpi format check-format tidy docs clean
.DEFAULT_GOAL := help

help:  ## This list
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "make %-13s %s\n", $$1, $$2 }' Makefile

program:
	@cmake/install-packages.sh build suitesparse fcl viewer
	@$(MAKE) --no-print-directory build/release/configured
	@cmake --build --preset release --parallel $(JOBS) --target selvedge

DEMO := $(PROGRAM) simulate configs/demo.yaml --no-cache --weights configs/weights/contourcraft_shown.h5
demo: program  ## Build the program, simulate configs/demo.yaml by three steppers, make the page that shows them
	@$(PROGRAM) simulate configs/demo.yaml --no-cache --out out/demo/conventional
	@$(DEMO) --stepper learned --out out/demo/learned || [ $$? -eq 1 ]  # 1: its cloth intersects; the page shows where
	@$(DEMO) --stepper hybrid --out out/demo/hybrid
	@$(PROGRAM) view out/demo/conventional out/demo/learned out/demo/hybrid --out out/demo/view.html

validate: program  ## Physics with known answers: a table and plots, and out/validate/*
	@$(PROGRAM) validate --out out/validate

bench: program  ## Run the benchmark family: a table, and out/bench/*.json
	@$(PROGRAM) bench --out out/bench

stress: program  ## Run every stress scene ten times: a table, and out/stress/*; goes on where it was stopped
	@$(PROGRAM) stress --out out/stress

stability: program  ## Stiff and extreme cases, pass or fail each: a table, and out/stability/*
	@$(PROGRAM) stability --out out/stability

# A process does some cells of a clip in turn, which share its body.
WARDROBE := configs/work/wardrobe.yaml
wardrobe: program  ## Every garment by code through every clip: a table, and out/wardrobe/*; goes on where it was stopped
	@$(PROGRAM) cells $(WARDROBE) --names | OMP_NUM_THREADS=1 xargs -P $(JOBS) -n 8 \
	  sh -c '$(PROGRAM) cell $(WARDROBE) "$$@" --out out/wardrobe || [ $$? -eq 1 ]' cell  # 1: a row failed
	@$(PROGRAM) gather $(WARDROBE) --out out/wardrobe

compare: program  ## Compare the conventional stepper's settings: tables and plots of error against run time, and out/compare/*
	@$(PROGRAM) compare configs/compare/conventional.yaml --out out/compare

test: test-release  ## Build and run every test (FILTER=regular expression on test files)
everything: with-blender with-python test long check-install minimal wheel asan fuzz torch mpi tutorials  ## Every test in the builds release, minimal and asan, long ones, of the wheel, fuzzers, those with libtorch and Open MPI and the tutorials too; CI runs a part
# Blender and a display for it, so that tests and tutorials do not leave out what needs them.
with-blender:
	@cmake/install-packages.sh blender
# Adds the Python packages for tests of exports, of clusters and of the type stub.
with-python:
	@cmake/install-packages.sh $(PACKAGES_release)
	@$(MAKE) --no-print-directory build/release/configured
	@$(ADDED_release)
	@cmake/add-test-packages.sh build/release
fuzz:  ## Readers of files given what a fuzzer makes of files, FUZZ_SECONDS each, with clang (FORMATS="obj ply": only these)
	@cmake/install-packages.sh build fuzz
	@$(MAKE) --no-print-directory build/fuzz/configured
	@cmake --build --preset fuzz --parallel $(JOBS)
	@tests/fuzz/run-fuzzers.sh $(FUZZ_SECONDS) $(FORMATS)
dev: test-dev  ## The same with assertions on and warnings as errors
asan: test-asan  ## The same under the address and undefined-behaviour sanitizers
asan-core: test-asan-core  ## Kernels and readers under these sanitizers
check-install: program  ## The libraries alone, installed and found from elsewhere
	@cmake/check-install.sh build/check-install
wheel:  ## pip install . into an empty environment, its source moved away, and the Python tests on that
	@cmake/install-packages.sh build viewer python
	@JOBS=$(JOBS) cmake/test-wheel.sh build/wheel-test build/minimal/selvedge
long: test  ## The tests that are too long for every change, after all others
	@build/release/selvedge_tests '[.long]'
tsan: test-tsan  ## The same under the thread sanitizer, with clang
minimal: test-minimal  ## The same without SuiteSparse, FCL and OpenMP

torch:  ## libtorch's library beside the program in build/release, and the tests that compare the kernels with it
	@cmake/install-packages.sh $(PACKAGES_release) torch
	@cmake --preset release -DSELVEDGE_TORCH=ON $(CONFIGURE)
	@cmake --build --preset release --parallel $(JOBS) --target selvedge_torch selvedge_tests
	@build/release/selvedge_tests "[torch]"

mpi:  ## Open MPI's library beside the program in build/release, for mpirun, and the tests of training on several processes
	@cmake/install-packages.sh $(PACKAGES_release) mpi
	@cmake --preset release -DSELVEDGE_MPI=ON $(CONFIGURE)
	@cmake --build --preset release --parallel $(JOBS) --target selvedge_mpi selvedge selvedge_tests
	@build/release/selvedge_tests "[mpi]"

test-%:
	@cmake/install-packages.sh $(PACKAGES_$*)
	@$(MAKE) --no-print-directory build/$*/configured
	@grep -q '^Catch2_DIR:PATH=/' build/$*/CMakeCache.txt || cmake --preset $* $(CONFIGURE)  # configured before it was here
	@$(ADDED_$*)
	@cmake --build --preset $* --parallel $(JOBS)
	@cmake/run-tests.sh $* $(JOBS) --tests-regex '$(FILTER)'

# CMake looks after its own files by itself; the presets it reads only here.
build/%/configured: CMakePresets.json
	cmake --preset $* $(CONFIGURE)
	@touch $@

format:  ## Format every source file
	@cmake/install-packages.sh format
	@$(SOURCES) | xargs clang-format -i

check-format:  ## Fail if a source file is not formatted
	@cmake/install-packages.sh format
	@$(SOURCES) | xargs clang-format --dry-run -Werror

tidy:  ## clang-tidy over the sources of the release build
	@cmake/install-packages.sh build suitesparse fcl viewer test tidy
	@$(MAKE) --no-print-directory build/release/configured
	@git ls-files '*.cpp' ':!tests' | xargs -P $(JOBS) -n 1 clang-tidy -p build/release --quiet --warnings-as-errors='*'

tutorials: program  ## Every command and picture of docs/tutorials and docs/gallery.md, in empty folders below out/tutorials (PAGES=docs/tutorials/farm.md: only these)
	@cmake/install-packages.sh $(PACKAGES_release)
	@$(ADDED_release)
	@! grep -q '^SELVEDGE_PYTHON:BOOL=ON' build/release/CMakeCache.txt || \
	  cmake --build --preset release --parallel $(JOBS) --target _selvedge
	@python=build/release/venv/bin/python; [ -x $$python ] || python=/usr/bin/python3; \
	  $$python docs/tutorials/run.py $(PROGRAM) build/release/python $(PAGES)

blender:  ## The add-on for Blender: out/blender/selvedge_cloth.zip
	@python3 pipeline/blender/pack.py out/blender/selvedge_cloth.zip

docs:  ## The site of docs/, with references of Python and C++: out/site
	@cmake/install-packages.sh docs
	@docs/site/build.sh

clean:  ## Remove what was built; results in out/ stay
	rm -rf build
