#!/bin/sh
# SPDX-License-Identifier: MIT OR Apache-2.0
# C header, page (Markdown) and IP-XACT file (IEEE 1685-2014) of a design's register bank, by PeakRDL from the SystemRDL in its generated folder.
#   tools/registers.sh FOLDER/control/NAME.rdl OUT
set -eu
rdl=$1
out=$2
here=$(cd "$(dirname "$0")/.." && pwd)
[ -f "$rdl" ] || { echo "registers: $rdl is not there; set control = true under [hardware] of the design" >&2; exit 1; }
mkdir -p "$out"
peakrdl=${SPTFRA_TOOLS:-$here/.venv}/bin/peakrdl
"$peakrdl" c-header "$rdl" -o "$out/sptfra_registers.h"
"$peakrdl" markdown "$rdl" -o "$out/registers.md"
"$peakrdl" ip-xact "$rdl" -o "$out/registers.xml" --vendor user.org --library tactile --name "$(basename "$rdl" .rdl)"
echo "registers: $out/sptfra_registers.h, $out/registers.md, $out/registers.xml"
