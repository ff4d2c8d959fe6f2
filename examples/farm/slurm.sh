#!/bin/sh
#SBATCH --array=1-8
#SBATCH --cpus-per-task=4
#SBATCH --output=part-%a.log
# One part of a sweep for each task of the array. Programs are compiled once, in a folder that all nodes see.
set -eu
export ARL2RS_CACHE="${ARL2RS_CACHE:-$PWD/arl2rs-cache}"
part=$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT
arl2rs sweep sweep.toml --shard "$part" --jobs "$SLURM_CPUS_PER_TASK" > "part-$SLURM_ARRAY_TASK_ID.jsonl"
arl2rs test tests --shard "$part" --format jsonl > "tests-$SLURM_ARRAY_TASK_ID.jsonl"
