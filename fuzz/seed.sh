#!/usr/bin/env bash
# Makes the seed corpora from the repository's programs, right and wrong ones: fuzz/corpus/<target>.
set -euo pipefail
cd "$(dirname "$0")"

mkdir -p corpus/{parse,format,check,compile}
find ../examples ../compiler/std ../tests ../grammar/tests -name '*.tex' -size -16k -not -path '*/node_modules/*' |
    sort | while read -r file; do
    name=$(echo "${file#../}" | tr '/' '-')
    for target in parse format check compile; do
        cp "$file" "corpus/$target/$name"
    done
done
# The same bytes again as the decisions of a well-typed program (see targets/input.rs).
for file in ../tests/golden/*.tex ../tests/design/*.tex; do
    name=$(basename "$file" .tex)
    for target in check compile; do
        { printf '\xff'; cat "$file"; } >"corpus/$target/decisions-$name"
    done
done
echo "$(find corpus -type f | wc -l) seeds"
