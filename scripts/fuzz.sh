#!/usr/bin/env bash
# Feeds random bytes to everything that reads them from outside, so many seconds each: scripts/fuzz.sh SECONDS [TARGET...]
# Needs a nightly Rust, a C++ compiler, and `cargo install cargo-fuzz`.
set -euo pipefail
cd "$(dirname "$0")/../fuzz"
seconds=${1:?seconds for each target}
shift
targets=("$@")
[ ${#targets[@]} -gt 0 ] || mapfile -t targets < <(cargo +nightly fuzz list)
for target in "${targets[@]}"; do
    mkdir -p "corpus/$target"
    case $target in
        program) cp ../tests/conformance/*/*.arl "corpus/$target/" ;;
        data_file) cp ../tests/conformance/*/*_data.arl "corpus/$target/" 2>/dev/null || true ;;
        scenario) cp ../tests/conformance/*/*.io.toml "corpus/$target/" ;;
        cell) cp ../examples/*/cell*.toml "corpus/$target/" 2>/dev/null || true ;;
    esac
    cargo +nightly fuzz run "$target" -- -max_total_time="$seconds" -max_len=65536 -rss_limit_mb=4096 -timeout=30
done
