#!/usr/bin/env bash
# Writes anew what is generated and committed, but for the parser of editors/tree-sitter-arl, which its own tool makes (see
# its README). What it changed is part of the change that made it necessary: look at it.
set -euo pipefail
cd "$(dirname "$0")/.."

# The parser, first: all else is compiled with it.
cargo run --quiet --package arl-lang --example renew_grammar
# What brings arguments to the runtime for the engine.
cargo run --quiet --package arl-engine --example renew_adapters && cargo fmt --package arl-engine
# The Rust of the emitter's cases and of the examples, the pages of the reference, the words of editors; the types of the
# page of the view.
UPDATE_EMITTED=1 UPDATE_GENERATED=1 UPDATE_REFERENCE=1 UPDATE_WORDS=1 \
    cargo test --workspace --quiet --test emitter --test generated --test reference --test editor_words
UPDATE_PAGE_TYPES=1 cargo test --workspace --quiet --lib types_of_the_page
# What rustc says to mistakes in `arl!`; only that rustc whose words are kept does it (arl-macros/tests/ui.rs).
UPDATE_GENERATED=1 TRYBUILD=overwrite cargo test --workspace --quiet --test ui
# With Node.js: the grammar of the extension for VS Code, the bundle of the view.
if command -v npm >/dev/null; then
    (cd editors/vscode && npm run --silent grammar)
    (cd runs/page && npm ci --silent --no-audit --no-fund && npm run --silent bundle)
else
    echo "skipped: the grammar of editors/vscode and the bundle of runs/page need Node.js with npm"
fi
git status --short
