#!/usr/bin/env bash
# Feeds random bytes to what reads programs, files and messages, so many seconds each: scripts/fuzz.sh SECONDS [TARGET...]
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
        program) seeds=(../tests/conformance '*.arl') ;;
        data_file) seeds=(../tests/conformance '*_data.arl') ;;
        scenario) seeds=(../tests/conformance '*.io.toml') ;;
        cell) seeds=(../examples 'cell*.toml') ;;
        *) seeds=() ;;
    esac
    [ ${#seeds[@]} -eq 0 ] || find "${seeds[0]}" -name "${seeds[1]}" -exec cp -f {} "corpus/$target/" \;
    cargo +nightly fuzz run "$target" -- -max_total_time="$seconds" -max_len=65536 -rss_limit_mb=4096 -timeout=30
done
