# Snakemake workflow of `testbench sweep`: one job a point, then the report. Started by `make sweep-cluster`; the
# machines of a cluster need the same folder and the same program. Points that are there are not computed again, whoever
# made them.
import os
import subprocess

TESTBENCH = os.environ.get("TESTBENCH", "target/debug/testbench")
FOLDER = os.environ.get("SWEEP_FOLDER", "target/sweep")
DESIGNS = os.environ["SWEEP_DESIGNS"].split()
SCENES = os.environ.get("SWEEP_SCENES", "").split()
OPTIONS = os.environ.get("SWEEP_OPTIONS", "").split()

SWEEP = [TESTBENCH, "sweep", *DESIGNS, *(["--scene", *SCENES] if SCENES else []), *OPTIONS, "--out", FOLDER]
# The keys change with designs, scenes and program: results of others stay where they are and are not asked for.
KEYS = subprocess.run([*SWEEP, "--list"], check=True, stdout=subprocess.PIPE, text=True).stdout.split()


# Snakemake knows only whether a file is there. With --simulate a point that is there without the RTL has to be made
# anew, which `testbench sweep` does in the last rule.
rule report:
    input:
        points=expand(FOLDER + "/points/{key}.json", key=KEYS),
        scenes=SCENES,
        designs=DESIGNS,
    output:
        page=FOLDER + "/report.html",
        table=FOLDER + "/sweep.csv",
        points=FOLDER + "/sweep.json",
    params:
        command=SWEEP,
    shell:
        "{params.command:q}"


rule point:
    output:
        FOLDER + "/points/{key}.json",
    params:
        command=SWEEP,
    threads: 1
    resources:
        mem_mb=1000,
        runtime=10,
    shell:
        "RAYON_NUM_THREADS={threads} {params.command:q} --point {wildcards.key}"
