# SPDX-License-Identifier: MIT OR Apache-2.0
# The menu: `make help`.

.DEFAULT_GOAL := help
MAKEFLAGS += --no-builtin-rules

CARGO  ?= cargo
TARGET := $(or $(CARGO_TARGET_DIR),target)
# The development profile: what computes in it is optimised, a frame is simulated by compiled C++ in any profile, and
# `make test` builds on what `make run` has built. A release build would take minutes more to save under a second.
BIN    := $(TARGET)/debug
# What only developers run, in a crate that no other target builds.
XTASK         := $(CARGO) run --quiet -p xtask --
XTASK_RELEASE := $(CARGO) run --quiet --release -p xtask --
PIP_INSTALL := .venv/bin/pip install --quiet --disable-pip-version-check --no-compile

DESIGN ?= designs/sensor1-fast.toml
SCENE  ?= scenes/sensor1-hertz.toml
FRAMES := $(TARGET)/run/$(basename $(notdir $(SCENE))).csv
FORCES := $(FRAMES:.csv=.forces.csv)

.PHONY: help
help: ## This menu
	@echo 'make TARGET, for example `make run`:'
	@echo
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "  %-13s %s\n", $$1, $$2 }' $(firstword $(MAKEFILE_LIST))
	@echo
	@echo 'make run DESIGN=designs/sensor2-wide.toml SCENE=scenes/sensor2-disc.toml  for another design and scene'

.PHONY: run
run: tools build ## Design to Verilog to simulation: 36 frames through the RTL, with a table of the results
	@mkdir -p $(dir $(FRAMES))
	@$(BIN)/sptfra generate $(DESIGN)
	@$(BIN)/sptfra scene $(SCENE) --out $(FRAMES)
	@echo
	@$(BIN)/sptfra run $(DESIGN) --frames $(FRAMES) --reference $(FORCES)

.PHONY: run-mat
run-mat: tools build ## The same for a mat of 1,728 taxels, on recordings of a lying person
	@$(BIN)/sptfra generate designs/bed-mat.toml
	@echo
	@$(BIN)/sptfra run designs/bed-mat.toml --frames data/bed_mat_64x27.csv --labels 2

# What fails soonest comes first: formatting and lints, then the crates in the order in which they use each other.
.PHONY: test
test: lint-and-tools ## Formatting, lints, all tests of all crates
	$(CARGO) test --workspace

.PHONY: test-long
test-long: lint-and-tools ## As test, with every design and broken copy (three quarters of an hour)
	SPTFRA_TEST_ALL=1 $(CARGO) test --workspace
	$(CARGO) test -p sptfra-golden --test suite -- --ignored six_geometries 4096_taxels
	$(CARGO) test -p sptfra-hdl-gen -p sptfra-testbench -p xtask --test suite -- --ignored

.PHONY: test-times
test-times: test-tools ## All tests, one topic after the other, and the slowest ten (CONTRIBUTING.md)
	@tools/test_times.py

.PHONY: formal
formal: tools ## Prove the stream rules and the frame handshake with Yosys and z3 (part of `make test`)
	SPTFRA_TEST_ALL=1 $(CARGO) test -p sptfra-testbench --test suite formal:: -- --nocapture

# Designs that only developers need.
TEST_DESIGNS  := golden/tests/designs
# The 4 x 3 design by either plan.
SMALL_DESIGNS := $(addprefix $(TARGET)/trust/small-,paper.toml reduced.toml)
FRAMES_COUNT  ?= 1000000
MUTANTS_COUNT ?= 110

$(TARGET)/trust/small-%.toml: $(TEST_DESIGNS)/small.toml
	@mkdir -p $(dir $@)
	@sed 's/^name = .*/name = "small_$*"/; s/^\[algorithm\]/&\nplan = "$*"/' $< > $@

.PHONY: stress
stress: tools $(SMALL_DESIGNS) ## A million frames, good and bad, with pauses and resets, through either plan, the grid search's stages, with banks written among them (an hour)
	@set -e; for design in $(SMALL_DESIGNS) $(TEST_DESIGNS)/small-joint.toml $(TEST_DESIGNS)/small-scanner.toml; do \
		$(XTASK_RELEASE) stress $$design --frames $(FRAMES_COUNT); done

.PHONY: mutants
mutants: tools $(SMALL_DESIGNS) ## 280 copies with a fault each: which does the comparison not notice? (half an hour)
	@set -e; for design in $(SMALL_DESIGNS); do $(XTASK) mutants $$design --count $(MUTANTS_COUNT) \
		--explained xtask/survivors.toml; done
	@$(XTASK) mutants $(TEST_DESIGNS)/small-joint.toml --count 60 --explained xtask/survivors.toml

.PHONY: lint
lint: ## Formatting and clippy, warnings are errors
	$(CARGO) fmt --all --check
	$(CARGO) clippy --workspace --all-targets -- -D warnings

# Installing is work for one core, and lints need nothing of it. Both end before this does.
.PHONY: lint-and-tools
lint-and-tools:
	@$(MAKE) --no-print-directory test-tools & tools=$$!; trap 'kill $$tools' INT TERM; \
	$(MAKE) --no-print-directory lint; linted=$$?; wait $$tools && exit $$linted

.PHONY: format
format: ## Format the Rust sources
	$(CARGO) fmt --all

.PHONY: build
build: ## The command, target/debug/sptfra
	$(CARGO) build -p sptfra

.PHONY: doc
doc: ## The crates' documentation, in target/doc
	$(CARGO) doc --workspace --no-deps

.PHONY: wheel
wheel: wheel-tools ## The Python package as a wheel, in target/wheels (docs/how-to/python.md)
	@rm -f $(TARGET)/wheels/*.whl
	@.venv/bin/maturin build --release --strip --manifest-path python/Cargo.toml --out $(TARGET)/wheels

.PHONY: wheel-tools
wheel-tools: tools ## Install maturin and matplotlib into .venv, for the Python package and its test
	@$(PIP_INSTALL) -r tools/requirements-python.txt

.PHONY: book
book: book-tools ## README and docs as a site with a search, in target/book
	@.venv/bin/python tools/book.py

.PHONY: book-tools
book-tools: tools ## Install MkDocs into .venv, for the site and its test
	@$(PIP_INSTALL) -r tools/requirements-book.txt

.PHONY: cocotb-tools
cocotb-tools: tools ## Install cocotb into .venv, for the test of the generated example
	@$(PIP_INSTALL) -r tools/requirements-cocotb.txt

.PHONY: dist
dist: wheel ## A release: command, manual pages, completions, designs in an archive, and the wheel, in target/dist (minutes)
	@rm -rf $(TARGET)/dist
	@mkdir -p $(TARGET)/dist/commands
	$(CARGO) build --release -p sptfra
	@cp $(TARGET)/release/sptfra $(TARGET)/dist/commands
	@strip $(TARGET)/dist/commands/*
	@cp $(TARGET)/wheels/*.whl $(TARGET)/dist
	@.venv/bin/python tools/dist.py $(TARGET)/dist/commands $(TARGET)/dist
	@rm -r $(TARGET)/dist/commands

.PHONY: man
man: build ## Manual pages of the command, in target/man
	@$(BIN)/sptfra man --out $(TARGET)/man

.PHONY: registers
registers: tools build ## C header, page and IP-XACT file of a register bank, by PeakRDL, for a design with control = true
	@$(BIN)/sptfra generate $(DESIGN)
	@name=$$(sed -n 's/^name *= *"\(.*\)".*/\1/p' $(DESIGN)); \
	    tools/registers.sh "rtl-out/$$name/control/$$name.rdl" "$(TARGET)/registers/$$name"

.PHONY: tools
tools: ## Install Verilator and Yosys where they are missing
	@tools/install.sh

.PHONY: test-tools
test-tools: ## What `tools` installs, and what only tests need: Icarus, Tcl, dtc, Arm compilers, a browser, Python packages
	@tools/install.sh tests
	@$(PIP_INSTALL) $(patsubst %,-r tools/requirements-%.txt,python book cocotb sweep)

.PHONY: synth
synth: tools build ## Yosys' count of multipliers, memories, LUT and FF beside the predicted ones (minutes)
	@$(CARGO) build --quiet -p xtask
	@tools/synth.py $(DESIGN)

# Times are measured with a release build. tools/results.py writes its files in results/.
BENCH_FOLDER  := $(TARGET)/bench
BENCH_SOLVER  := $(addprefix designs/,paper.toml sensor1-reduced.toml sensor1-resultants.toml sensor1-fast.toml \
	bed-mat.toml) xtask/designs/sensor1-fast-two.toml
BENCH_DESIGNS := designs/sensor1-reduced.toml $(TEST_DESIGNS)/sensor2-reduced.toml designs/sensor1-fast.toml designs/sensor1-fast-64.toml \
	designs/bed-mat.toml
BENCH_CELLS   := sensor1-reduced sensor1-resultants sensor1-fast sensor1-fast-64 sensor1-fast-100 sensor1-wide

.PHONY: bench
bench: tools ## Measure solver, generator, simulation, cycles and cells, into results/ (Yosys: half an hour)
	@echo 'bench: a release build'
	@$(CARGO) build --quiet --release -p sptfra -p xtask --bins
	@PROFILE=release tools/synth.py $(BENCH_CELLS:%=designs/%.toml)
	@mkdir -p $(BENCH_FOLDER)
	@echo 'bench: the f64 solver (a minute)'
	@$(XTASK_RELEASE) solver --json $(BENCH_SOLVER) > $(BENCH_FOLDER)/solver.json
	@.venv/bin/python tools/bench_numpy.py --add $(BENCH_FOLDER)/solver.json
	@echo 'bench: generator, simulation, cycles (some minutes)'
	@$(XTASK_RELEASE) bench $(BENCH_DESIGNS) --solver $(BENCH_FOLDER)/solver.json \
	    $(foreach design,$(BENCH_CELLS),--cells $(TARGET)/synth/$(subst -,_,$(design)).cells.json) \
	    > $(BENCH_FOLDER)/figures.json
	@python3 tools/results.py bench $(BENCH_FOLDER)/figures.json
	@python3 tools/plots.py

.PHONY: luts
luts: tools build ## Fit the estimates of LUT and FF to the cells that Yosys counts in forty designs (hours; goes on where it stopped)
	@$(CARGO) build --quiet -p xtask
	@designs=$$($(BIN)/xtask luts --designs $(TARGET)/luts) && tools/synth.py $$designs
	@$(BIN)/xtask luts $(TARGET)/synth

# One point a job; sweeps on more than one machine: `make sweep-cluster SNAKEMAKE_OPTIONS='--executor slurm --jobs 100'`.
SWEEP_FOLDER  := $(TARGET)/sweep
SWEEP_DESIGNS ?= $(addprefix designs/,paper.toml sensor1-reduced.toml sensor1-fast.toml sensor1-wide.toml sensor2-fast.toml sensor2-wide.toml) \
	$(addprefix $(TEST_DESIGNS)/,sensor1-f3.toml sensor2-reduced.toml sensor2-f3.toml)
SWEEP_SCENES  ?= $(addprefix scenes/,sensor1-hertz.toml sensor1-tilted.toml two-contacts.toml sensor2-disc.toml \
	sensor2-punch.toml sensor2-held.toml)
SWEEP_OPTIONS ?= --simulate base --kinds
SNAKEMAKE_OPTIONS ?= --cores all

.PHONY: report
report: tools build ## Speed against error: target/sweep/report.html, a page to look at (minutes; goes on where it stopped)
	@$(BIN)/sptfra sweep $(SWEEP_DESIGNS) --scene $(SWEEP_SCENES) --out $(SWEEP_FOLDER) $(SWEEP_OPTIONS)

.PHONY: report-full
report-full: tools build ## The same over every combination of filters, plans, widths and lanes: thousands of points
	@$(BIN)/sptfra sweep $(SWEEP_DESIGNS) --scene $(SWEEP_SCENES) --out $(SWEEP_FOLDER) --full

FAST          := $(addprefix designs/,sensor1-fast.toml sensor2-fast.toml)
WIDE          := $(addprefix designs/,sensor1-wide.toml sensor2-wide.toml)
CLIPPED       := designs/sensor1-clipped-wide.toml $(TEST_DESIGNS)/sensor2-clipped-wide.toml
AT_NOISE      := $(TARGET)/at-noise

# Studies that have their own designs.
STUDIES       := contact-kinds contact-sets layers thin-layers torques clipped clipped-kinds several-contacts \
	counted-contacts dead-taxels finite-elements finite-elements-summary recordings

# What `calibrate` makes of the paper's sensors at each noise, of single frames (at) and of averages (smoothed), and of a
# larger array, without further options.
.PHONY: designs-at-noise
designs-at-noise: build
	@rm -rf $(AT_NOISE) && mkdir -p $(AT_NOISE)
	@cp designs/sensor[12]-fast.* $(AT_NOISE)
	@$(BIN)/sptfra new array_16x8 --dir $(AT_NOISE) --columns 16 --rows 8 --pitch-mm 3 --depth-mm 2.5 --tension read \
	    --noise 1% > /dev/null
	@set -e; cd $(AT_NOISE); calibrate() { \
	    printf 'format = 3\nbase = "%s.toml"\n\n[sensor]\nnoise = %s\n%s\n' $$1 $$3 "$$4" > one.toml; \
	    $(abspath $(BIN))/sptfra calibrate one.toml --out $$1-$$2-$$3.toml; }; \
	for design in sensor1-fast sensor2-fast; do for noise in 0.002 0.005 0.01 0.02; do \
	    calibrate $$design at $$noise; calibrate $$design smoothed $$noise 'smoothing = 4'; done; done; \
	calibrate array_16x8 at 0.01

.PHONY: tables
tables: tools designs-at-noise ## Measure the tables of errors anew, into results/ (two hours)
	@$(CARGO) build --quiet --release -p xtask
	@$(XTASK_RELEASE) study noise $(FAST) designs/sensor1-fast-64.toml \
	    designs/sensor1-fast-100.toml $(WIDE) $(CLIPPED) --out results/noise.csv
	@$(XTASK_RELEASE) study noise $(AT_NOISE)/*-at-*.toml --out results/noise-calibrated.csv
	@$(XTASK_RELEASE) study smoothing $(FAST) $(WIDE) --out results/smoothing.csv
	@$(XTASK_RELEASE) study smoothing $(AT_NOISE)/*-smoothed-*.toml --out results/smoothing-calibrated.csv
	@$(XTASK_RELEASE) study confidence $(FAST) $(WIDE) $(CLIPPED) designs/sensor1-reduced.toml \
	    $(AT_NOISE)/sensor1-fast-smoothed-0.01.toml $(AT_NOISE)/sensor2-fast-smoothed-0.01.toml --out results/confidence.csv
	@$(XTASK_RELEASE) study drift designs/sensor1-fast.toml designs/sensor1-wide.toml --out results/drift.csv
	@set -e; for study in $(STUDIES); do $(XTASK_RELEASE) study $$study; done
	@python3 tools/plots.py

.PHONY: corner-cases
corner-cases: tools ## Sensors, contacts and frames at the limits, all through the RTL (minutes): results/corner-cases.csv
	@$(XTASK) corner-cases > $(TARGET)/corner-cases.json
	@python3 tools/results.py corner-cases $(TARGET)/corner-cases.json
	@python3 tools/plots.py

.PHONY: sweep-tools
sweep-tools: tools ## Install Snakemake into .venv, for sweeps on more than one machine
	@$(PIP_INSTALL) -r tools/requirements-sweep.txt

.PHONY: sweep-cluster
sweep-cluster: sweep-tools build ## The report by Snakemake, one `sptfra run --json` a job
	@SWEEP_DESIGNS='$(SWEEP_DESIGNS)' SWEEP_SCENES='$(SWEEP_SCENES)' SWEEP_OPTIONS='$(SWEEP_OPTIONS)' SWEEP_FOLDER='$(SWEEP_FOLDER)' \
	    SPTFRA='$(BIN)/sptfra' .venv/bin/snakemake --snakefile tools/sweep.smk $(SNAKEMAKE_OPTIONS)

# For parts that an open flow places and routes.
DESIGNS ?= xtask/designs/timing.toml
SEEDS   ?= 1

.PHONY: timing
timing: tools build ## Place and route for an ECP5, for a clock figure from an open flow (a quarter of an hour and more; DESIGNS=…, SEEDS=3)
	@set -e; for design in $(DESIGNS); do tools/timing.sh --seeds $(SEEDS) $$design; done

.PHONY: clean
clean: ## Remove what was built; the tools in .venv stay
	$(CARGO) clean

.PHONY: distclean
distclean: clean ## Remove the tools too
	rm -rf .venv
