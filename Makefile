# make demo     the paper's impact, from the mesh to the figures
# make test     every test
# make study    what accuracy costs in time: tables and plots of docs/cost.md
# make hard-cases   shocks, corners, long runs and other hard cases: docs/hard_cases.md and its pictures
# make validation   cases with exact or independent values: docs/validation.md and its pictures (three minutes)
# make effects  what each effect costs the standard scene: docs/effects.md
# make proof    that effects which a scene does not ask for cost nothing (half an hour)
# make faults   kills, full disks, corrupted bytes: the table of docs/reliability.md (some minutes)
# make paraview   all kinds of exported files in the real ParaView: docs/img/paraview.png
# make bench    the speed of the step on this machine: tables and roofline of docs/performance.md
.PHONY: help setup build demo test study hard-cases validation effects proof faults paraview bench clean

help:
	@echo "make demo    install what is missing, build, run the paper's impact with all methods, draw its figures"
	@echo "make test    install what is missing, run every test"
	@echo "make study   measure what accuracy costs in time: the tables and plots of docs/cost.md, again"
	@echo "make hard-cases   run all hard cases (twenty minutes) and write docs/hard_cases.md and docs/hard/, again"
	@echo "make validation   run the cases with exact or independent values (three minutes) and write docs/validation.md, again"
	@echo "make effects  measure what each effect costs (some minutes): src/effects/measured.csv, docs/effects.md"
	@echo "make proof   show that what a scene does not ask for costs nothing (half an hour)"
	@echo "make faults  kill runs, fill disks, corrupt files (some minutes) and write docs/reliability.md again"
	@echo "make paraview   open all kinds of exported files in the real ParaView (installs it), and draw docs/img/paraview.png"
	@echo "make bench   measure the speed (ten minutes): runs/bench/, docs/performance.md, docs/img/roofline.svg"
	@echo "make build   the program; its last line says where cargo has put it"
	@echo "make setup   only install what is missing (Debian packages, .venv)"
	@echo "make clean   remove build results and runs; .venv stays"

setup:
	@tools/setup.sh

build: setup
	DGMPM_COMMIT="$$(tools/commit.sh)" cargo build --release
	@echo "the program: $$(DGMPM= tools/program.sh)"

demo: build
	@tools/demo.sh

test:
	@tools/test.sh

study: build
	@tools/study.sh

hard-cases: build
	@tools/hard_cases.sh

validation: build
	@.venv/bin/python tools/validation --page

effects: build
	@tools/effects.sh

proof: setup
	@tools/proof.sh

faults: build
	@DGMPM="$$(tools/program.sh)" python3 tools/faults.py

paraview: build
	@tools/paraview.sh

bench: build
	@tools/bench.sh

clean:
	cargo clean
	rm -rf runs
