#!/bin/sh
# SPDX-License-Identifier: MIT OR Apache-2.0
# Synthesises each of the designs with Yosys, as tools/synth.sh does, unless its Verilog and ROM files are those of the
# last time. The cells by block are then in target/synth/NAME.cells.json, which `cargo xtask bench --cells` reads.
# Usage: tools/bench.sh DESIGN.toml …    (make tools and make build first; PROFILE=release for the release build)
set -eu
cd "$(dirname "$0")/.."
target=${CARGO_TARGET_DIR:-target}
bin=$target/${PROFILE:-debug}
mkdir -p "$target/synth"
for design in "$@"; do
    work=$target/synth/$(basename "$design" .toml)
    "$bin/sptfra" generate "$design" --out "$work" > /dev/null
    name=$(sed -n 's/^name = "\(.*\)"/\1/p' "$work/design.toml")
    stamp=$target/synth/$name.stamp
    wish=$(cat "$work"/rtl/* "$work"/rom/* tools/synth.sh tools/requirements.txt | cksum)
    if [ "$(cat "$stamp" 2> /dev/null)" = "$wish" ] && [ -s "$target/synth/$name.netlist.json" ]; then
        "$bin/xtask" cells "$design" "$work" "$target/synth/$name.stat.json" \
            --netlist "$target/synth/$name.netlist.json" --json > "$target/synth/$name.cells.json"
        echo "bench: $name is as Yosys saw it last"
    else
        rm -f "$stamp"
        tools/synth.sh "$design"
        echo "$wish" > "$stamp"
    fi
done
