#!/usr/bin/env bash
# Runs a campaign on a cluster with Slurm: sbatch examples/19_campaign/slurm.sh [CAMPAIGN.toml] [FILE.db]
# FILE.db must be on a disk of the first node or on a file system with locks that work; only rank 0 writes it.
# After the time limit, the same command continues where the campaign stopped.
#SBATCH --job-name=flexura
#SBATCH --ntasks=32
#SBATCH --cpus-per-task=1
#SBATCH --time=01:00:00
#SBATCH --output=campaign-%j.log
set -euo pipefail
campaign=${1:-examples/19_campaign/campaign.toml}
results=${2:-results/19_campaign.db}
# Runs render pictures in threads of their own: one per task is enough.
export OMP_NUM_THREADS=1
srun --mpi=pmix flexura campaign "$campaign" --out "$results"
flexura report "$results"
