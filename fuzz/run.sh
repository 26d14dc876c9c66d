#!/usr/bin/env bash
# Builds the fuzz targets and runs each for so many seconds, or those that are named:
#
#     fuzz/run.sh [SECONDS] [TARGET...]
#
# The corpus grows in fuzz/corpus, findings go to fuzz/artifacts; the first one ends the run.
set -euo pipefail
cd "$(dirname "$0")"

seconds=${1:-60}
targets=("${@:2}")
((${#targets[@]})) || targets=(parse format check compile)

./seed.sh
cargo build --release --locked
mkdir -p artifacts
for target in "${targets[@]}"; do
    printf '\n== %s\n' "$target"
    "target/x86_64-unknown-linux-gnu/release/$target" "corpus/$target" -artifact_prefix="artifacts/$target-" \
        -max_total_time="$seconds" -timeout=10 -verbosity=0 -print_final_stats=1
done
