# make demo, make test: everything from a fresh clone. The build itself is CMake's (CMakePresets.json).
.DEFAULT_GOAL := help
.PHONY: help demo gallery test test-dcc bench sanitize fuzz build install format lint clean packages scene-packages lint-packages fuzz-packages

JOBS ?= $(shell nproc)
PREFIX ?= /usr/local
TOILE := build/bin/toile

# Kernels are compiled for the card that is here; without one only what must work on any machine is.
CARD := $(shell nvidia-smi -L 2>/dev/null | head -n 1)
ARCHITECTURES := $(if $(CARD),native,90-real)
# The demo runs on the CPU unless a GPU is here. GPU=1: kernels are compiled all the same.
DEMO_CUDA := $(if $(filter-out 0,$(GPU)),ON,$(if $(CARD),AUTO,OFF))

FUZZ_TARGETS := $(addprefix fuzz_,abc cache gltf msh obj pattern ply scene usd_frames vtk)
# What ships; research and the tests of GPUs would double the time.
SANITIZED_TESTS := $(addprefix test_,core quadrature2d volume garment collision avatars export garment_format scenes preview) gltf_poses $(FUZZ_TARGETS)

configure = cmake --preset $(1) --log-level=WARNING --no-warn-unused-cli -DCMAKE_CUDA_ARCHITECTURES=$(ARCHITECTURES) $(2)

help: ## Show this list
	@sed -nE 's/^([a-z-]+):.*## (.*)/  make \1\t\2/p' $(MAKEFILE_LIST) | expand -t 18

demo: packages ## Drape a table, and a mannequin that walks; pictures and caches go to out/ (GPU=1: with kernels for GPUs)
	@$(call configure,default,-DTOILE_CUDA=$(DEMO_CUDA))
	@cmake --build --preset default --target toile -j $(JOBS)
	@cmake/setup/demo.sh $(TOILE)

gallery: packages ## Make the pictures of docs/guide/gallery.md again (an hour on 2 cores; reads TOILE_DATA_DIR)
	@$(call configure,default,-DTOILE_CUDA=$(DEMO_CUDA))
	@cmake --build --preset default --target toile -j $(JOBS)
	@cmake/setup/gallery.sh $(TOILE)

test: scene-packages build ## Build everything, and run every test
	@ctest --preset default -j $(JOBS)

test-dcc: packages ## Compare caches of every format, as Blender and VTK play them (Python 3.11; installs 2 GB into build/dcc)
	@$(call configure,default,-DTOILE_CUDA=AUTO)
	@cmake --build --preset default --target toile -j $(JOBS)
	@test -x build/dcc/bin/python || python3 -m venv build/dcc
	@build/dcc/bin/python -m pip install --quiet --disable-pip-version-check -r tests/dcc/requirements.txt
	@build/dcc/bin/python tests/dcc/compare_all.py $(TOILE) build/dcc/caches
	@build/dcc/bin/python tests/dcc/attributes.py $(TOILE) build/dcc/attributes

bench: packages ## Build toile-bench, which measures
	@$(call configure,default,-DTOILE_CUDA=AUTO)
	@cmake --build --preset default --target toile-bench -j $(JOBS)
	@build/bin/toile-bench --help

sanitize: packages ## Debug build with sanitizers: both demos, and the tests that are fast
	@$(call configure,sanitize,)
	@cmake --build --preset sanitize --target toile $(SANITIZED_TESTS) -j $(JOBS)
	@cmake/setup/sanitize.sh build build-sanitize $(JOBS)

fuzz: packages fuzz-packages ## Run every parser under libFuzzer for FUZZ_SECONDS (60), built by clang
	@$(call configure,fuzz,)
	@cmake --build --preset fuzz --target $(FUZZ_TARGETS) -j $(JOBS)
	@cmake/setup/fuzz.sh build-fuzz/bin $(FUZZ_TARGETS)

build: packages ## Build everything into build/
	@$(call configure,default,-DTOILE_CUDA=AUTO)
	@cmake --build --preset default -j $(JOBS)

install: packages ## Build the program and the library, and install them (PREFIX=/usr/local)
	@$(call configure,default,-DTOILE_CUDA=AUTO)
	@cmake --build --preset default --target toile -j $(JOBS)
	@cmake --install build --prefix $(PREFIX)

format: lint-packages ## Rewrite the sources in the project's format
	@git ls-files -co --exclude-standard '*.cpp' '*.h' '*.cu' '*.cuh' | xargs -r clang-format -i

lint: packages lint-packages ## Check format and clang-tidy on what changed (LINT_BASE=ref)
	@test -f build/compile_commands.json || $(call configure,default,-DTOILE_CUDA=AUTO)
	@cmake/setup/lint.sh build

clean: ## Remove the builds; out/ stays
	rm -rf build build-debug build-sanitize build-fuzz

packages:
	@cmake/setup/install_packages.sh build

scene-packages:
	@cmake/setup/install_packages.sh scenes || echo "Without them the tests of the paper's scenes are skipped."

lint-packages:
	@cmake/setup/install_packages.sh lint

fuzz-packages:
	@cmake/setup/install_packages.sh fuzz
