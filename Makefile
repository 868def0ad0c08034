# make demo, make test: everything from a fresh clone. The build itself is CMake's (CMakePresets.json).
.DEFAULT_GOAL := help
.PHONY: help demo test build format lint clean packages lint-packages

JOBS ?= $(shell nproc)
TOILE := build/bin/toile

help: ## Show this list
	@sed -nE 's/^([a-z]+):.*## (.*)/  make \1\t\2/p' $(MAKEFILE_LIST) | expand -t 18

demo: build ## Drape a tablecloth and a skirt; pictures and caches go to out/
	@cmake/setup/demo.sh $(TOILE)

test: build ## Build and run every test
	@ctest --preset default -j $(JOBS)

build: packages build/build.ninja ## Build into build/
	@cmake --build --preset default -j $(JOBS)

format: lint-packages ## Rewrite the sources in the project's format
	@git ls-files -co --exclude-standard '*.cpp' '*.h' '*.cu' '*.cuh' | xargs -r clang-format -i

lint: packages lint-packages build/build.ninja ## Check format and clang-tidy on what changed (LINT_BASE=ref)
	@cmake/setup/lint.sh build

clean: ## Remove build/; out/ stays
	rm -rf build

packages:
	@cmake/setup/install_packages.sh build

lint-packages:
	@cmake/setup/install_packages.sh lint

# Ninja calls CMake again by itself when a CMakeLists.txt changes.
build/build.ninja: | packages
	@cmake --preset default
