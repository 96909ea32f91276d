#!/usr/bin/env bash
# A campaign under a Slurm of this machine alone: slurm_campaign.sh FLEXURA EXAMPLES
# Starts munged, slurmctld and slurmd with files in a new folder, submits EXAMPLES/19_campaign/slurm.sh with sbatch, and
# compares the rows with those of the threads of one process. Needs root, slurm-wlm and munge.
set -euo pipefail
flexura=$1
examples=$2

skip() {
  echo "skipped: needs $*"
  exit 0
}
for program in munged slurmctld slurmd sbatch srun scontrol; do
  command -v "$program" >/dev/null || PATH=$PATH:/usr/sbin command -v "$program" >/dev/null ||
    skip "slurm-wlm and munge ($program)"
done
[ "$(id -u)" -eq 0 ] || skip "root, to start Slurm"
export PATH=$PATH:/usr/sbin

folder=$(mktemp -d)
pids=()
stop() {
  # The youngest first: slurmd ends its steps, munged is needed until the end.
  local i
  for ((i = ${#pids[@]} - 1; i >= 0; --i)); do
    kill "${pids[i]}" 2>/dev/null || true
    wait "${pids[i]}" 2>/dev/null || true
  done
  rm -rf "$folder"
}
trap stop EXIT
fail() {
  echo "FAILED: $*"
  tail -n 30 "$folder"/*.log 2>/dev/null || true
  exit 1
}
# until_true SECONDS COMMAND...
until_true() {
  local end=$((SECONDS + $1))
  shift
  until "$@"; do
    [ $SECONDS -lt $end ] || return 1
    sleep 0.1
  done
}

host=$(hostname -s)
free_port() { python3 -c 'import socket; s = socket.socket(); s.bind(("", 0)); print(s.getsockname()[1])'; }
# Munge and Slurm refuse folders that others can write.
chmod 755 "$folder"
mkdir -m 755 "$folder/state" "$folder/spool" "$folder/munge"
head -c 1024 /dev/urandom >"$folder/munge/key"
chmod 600 "$folder/munge/key"
cat >"$folder/slurm.conf" <<END
ClusterName=one
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$(free_port)
SlurmdPort=$(free_port)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket=$folder/munge/socket
CryptoType=crypto/munge
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
ReturnToService=2
SlurmdParameters=config_overrides
NodeName=$host NodeAddr=127.0.0.1 CPUs=4 State=UNKNOWN
PartitionName=all Nodes=$host Default=YES MaxTime=INFINITE State=UP
END
sed -i '/^CryptoType/d' "$folder/slurm.conf"
export SLURM_CONF=$folder/slurm.conf

munged --foreground --force --key-file="$folder/munge/key" --socket="$folder/munge/socket" \
  --pid-file="$folder/munge/pid" --log-file="$folder/munge.log" --seed-file="$folder/munge/seed" &
pids+=($!)
until_true 20 test -S "$folder/munge/socket" || fail "munged does not start"
slurmctld -D >"$folder/slurmctld.out.log" 2>&1 &
pids+=($!)
slurmd -D -N "$host" >"$folder/slurmd.out.log" 2>&1 &
pids+=($!)
is_idle() { scontrol show node "$host" 2>/dev/null | grep -q 'State=IDLE'; }
until_true 60 is_idle || fail "the node does not become idle"

# The script calls flexura by its name.
mkdir "$folder/bin"
ln -s "$flexura" "$folder/bin/flexura"
export PATH=$folder/bin:$PATH
# Open MPI as root.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
cd "$folder"
cat >bow.toml <<'END'
[arm]
kind = "spatial"
[[arm.section]]
length = 0.3
max_bend_deg = 120
[[arm.section]]
length = 0.25
max_bend_deg = 120
[[task]]
kind = "move"
duration = 1
to.bends_deg = [[60, 0], [0, 90]]
END
cat >campaign.toml <<'END'
experiment = "bow.toml"
samples = 300
[[parameter]]
kind = "uniform"
path = "task.0.to.bends_deg.1.1"
name = "bend_deg"
low = 60
high = 130
[[measure]]
key = "tip.position.1"
name = "height"
END
flexura campaign campaign.toml --out threads.db >/dev/null || fail "the campaign with threads"
timeout 200 sbatch --wait --ntasks=2 --output="$folder/job.log" "$examples/19_campaign/slurm.sh" campaign.toml slurm.db ||
  fail "the job"
grep -q 'complete: all 300 runs are done' job.log || fail "the campaign under Slurm"
[ -s slurm.html ] || fail "there is no report"
for name in threads slurm; do
  flexura export "$name.db" --to csv --out "$name.csv" >/dev/null
  python3 -c 'import csv, sys; [print(row[:4] + row[5:]) for row in csv.reader(open(sys.argv[1]))]' "$name.csv" \
    >"$name.rows" # Without `seconds`.
done
cmp threads.rows slurm.rows || fail "the rows differ"
[ "$(wc -l <slurm.rows)" -eq 301 ] || fail "rows are missing"
echo "a campaign under Slurm has the rows of one with threads"
