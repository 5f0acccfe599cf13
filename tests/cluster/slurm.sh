#!/usr/bin/env bash
# A study as an array of Slurm: a controller and two node daemons on this machine, of which one is killed with all that runs on
# it; its cases are queued again. In the end every case is there once, and the tables are those of a local study.
#
#   tests/cluster/slurm.sh STRANDSNAP FOLDER
#
# FOLDER must not exist; everything lies in it. Needs root, as daemons of Slurm do. Prints what happens; ends with 0 when all holds, with 75
# where the daemons cannot run.
set -euo pipefail
program=$(realpath "$1")
mkdir "$2"
folder=$(realpath "$2")
host=$(hostname -s)
pids=()

end() {
    for pid in "${pids[@]}"; do kill -9 "$pid" 2>/dev/null || true; done
    pkill -9 -f "slurmstepd.*$folder" 2>/dev/null || true
}
trap end EXIT

port=$((20000 + RANDOM % 20000))
mkdir "$folder"/{state,spool.n1,spool.n2,munge}
chmod 700 "$folder/munge"
dd if=/dev/urandom of="$folder/munge/key" bs=1024 count=1 status=none
chmod 400 "$folder/munge/key"
munged --foreground --force --key-file="$folder/munge/key" --socket="$folder/munge/socket" \
    --pid-file="$folder/munge/pid" --log-file="$folder/munge/log" --seed-file="$folder/munge/seed" \
    >"$folder/munge/out" 2>&1 &
pids+=($!)
cat >"$folder/slurm.conf" <<CONF
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
AuthType=auth/munge
AuthInfo=socket=$folder/munge/socket
CryptoType=crypto/munge
SlurmUser=root
SlurmdUser=root
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
SlurmdTimeout=5
InactiveLimit=0
KillWait=2
SchedulerParameters=sched_interval=1,sched_min_interval=100000,batch_sched_delay=0
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool.%n
SlurmdPidFile=$folder/slurmd.%n.pid
SlurmctldPidFile=$folder/slurmctld.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.%n.log
SlurmdParameters=config_overrides
NodeName=n1 NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + 1)) CPUs=1 RealMemory=4000
NodeName=n2 NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + 2)) CPUs=1 RealMemory=4000
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
export SLURM_CONF=$folder/slurm.conf
for _ in $(seq 50); do [ -S "$folder/munge/socket" ] && break || sleep 0.1; done
slurmctld -D -i -f "$SLURM_CONF" >"$folder/slurmctld.out" 2>&1 &
pids+=($!)
for node in n1 n2; do
    setsid slurmd -D -N "$node" -f "$SLURM_CONF" >"$folder/slurmd.$node.out" 2>&1 &
    pids+=($!)
done
idle() { sinfo -h -N -o '%t' 2>/dev/null | grep -cx idle || true; }
for _ in $(seq 100); do [ "$(idle)" = 2 ] && break || sleep 0.2; done
[ "$(idle)" = 2 ] || { echo "the daemons of Slurm do not come up here"; cat "$folder"/*.out "$folder"/*.log; exit 75; }
echo "two nodes are up"

cat >"$folder/many.toml" <<'TOML'
about = "Many short wires."
base = "single-wire"
set = ["output.checkpoint=300", "wire.0.to=[\"0 mm\", \"0 mm\", \"10 mm\"]", "grip.length=2 mm", "bond.rupture.strain=20 %", "stop.stress_fraction=", "stop.strain_after_drop=2 %"]
seeds = 25

[[axis]]
key = "grip.speed"
values = ["10 m/s", "20 m/s"]
TOML
mkdir "$folder/here" "$folder/there"
(cd "$folder/here" && "$program" study ../many.toml >/dev/null 2>&1)
cd "$folder/there"
"$program" study ../many.toml --emit slurm
cd out/study/many/cluster
array=$(sbatch --parsable cases.sbatch)
collect=$(sbatch --parsable --dependency=afterany:"$array" collect.sbatch)
cases=$folder/there/out/study/many/cases
is_on_n2() {
    { cat "/proc/$1/environ" "/proc/$1/cmdline" 2>/dev/null || true; } | tr '\0' '\n' | grep -qx 'SLURMD_NODENAME=n2\|.*spool\.n2.*'
}
count() { find "$cases" -name case.json 2>/dev/null | wc -l; }

# The second node dies in the middle, with all that runs on it.
for _ in $(seq 600); do [ "$(count)" -ge 12 ] && break || sleep 0.1; done
before=$(count)
for pid in $(pgrep -f 'slurmstepd' || true); do
    ! is_on_n2 "$pid" || kill -9 "$pid" 2>/dev/null || true
done
kill -9 "${pids[3]}"
for pid in $(pgrep -f "$program study" || true); do
    ! is_on_n2 "$pid" || kill -9 "$pid" 2>/dev/null || true
done
echo "node n2 was killed when $before cases were there"
for _ in $(seq 1200); do
    [ -z "$(squeue -h -j "$array" 2>/dev/null)" ] && [ -z "$(squeue -h -j "$collect" 2>/dev/null)" ] && break
    sleep 0.25
done
cd "$folder"
echo "$(count) cases of 50 are there; jobs left: $(squeue -h 2>/dev/null | wc -l)"
grep -h "requeue\|Requeue" slurmctld.log | tail -3 || true
[ "$(count)" = 50 ] || { tail -30 slurmctld.log; tail -5 there/out/study/many/log/*.log; exit 1; }
# Every case once in the tables, and these are the local ones but for what a case took.
for table in here/out/study/many/*.csv; do
    name=$(basename "$table")
    for place in here there; do
        python3 -c '
import csv, sys
rows = list(csv.reader(sys.stdin))
kept = [k for k, name in enumerate(rows[0]) if not name.endswith("[s]")]
csv.writer(sys.stdout).writerows([row[k] for k in kept] for row in rows)
' <"$place/out/study/many/$name" >"$place/$name"
    done
    cmp "here/$name" "there/$name"
    echo "$name: $(($(wc -l <"$table") - 1)) rows, the same to the byte but for run times"
done
