# SPDX-License-Identifier: MIT OR Apache-2.0
# Snakemake workflow of `sptfra sweep`: `sptfra run --json` for each point, one a job, then the report. Started by
# `make sweep-cluster`; the machines of a cluster need the same folder and the same program. Runs that are there are not
# made again.
import os
from pathlib import Path

SPTFRA = os.environ.get("SPTFRA", "target/debug/sptfra")
FOLDER = os.environ.get("SWEEP_FOLDER", "target/sweep")
DESIGNS = os.environ["SWEEP_DESIGNS"].split()
SCENES = os.environ.get("SWEEP_SCENES", "").split()
OPTIONS = os.environ.get("SWEEP_OPTIONS", "").split()

JOBS = f"{FOLDER}/jobs"
SWEEP = [SPTFRA, "sweep", *DESIGNS, *(["--scene", *SCENES] if SCENES else []), *OPTIONS, "--out", FOLDER]


def reports(wildcards):
    """A report for each point that has hardware: known once they are prepared."""
    jobs = Path(checkpoints.prepare.get().output[0])
    return sorted(f"{FOLDER}/runs/{design.parent.name}.json" for design in jobs.glob("*/design.toml"))


# Points without hardware have no job; the f64 solver answers for them here.
rule report:
    input:
        runs=reports,
        scenes=SCENES,
        designs=DESIGNS,
    output:
        page=f"{FOLDER}/report.html",
        table=f"{FOLDER}/sweep.csv",
        points=f"{FOLDER}/sweep.json",
    params:
        command=SWEEP,
        runs=f"{FOLDER}/runs",
    shell:
        "{params.command:q} --runs {params.runs:q}"


# Keys, and so the names of the jobs, change with designs, scenes and program.
checkpoint prepare:
    input:
        scenes=SCENES,
        designs=DESIGNS,
        program=SPTFRA,
    output:
        directory(JOBS),
    params:
        command=SWEEP,
    shell:
        "{params.command:q} --prepare"


rule run:
    input:
        design=JOBS + "/{key}/design.toml",
        frames=JOBS + "/{key}/frames.csv",
        forces=JOBS + "/{key}/frames.forces.csv",
    output:
        FOLDER + "/runs/{key}.json",
    params:
        sptfra=SPTFRA,
    threads: 1
    resources:
        mem_mb=2000,
        runtime=30,
    shell:
        "{params.sptfra:q} run {input.design:q} --frames {input.frames:q} --reference {input.forces:q} --json"
        " > {output:q}"
