#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The job array of docs/studies.md on a separate Slurm with one controller and one node. One task is
# killed during its run; submitting the array again completes it. The merged table has the same
# bytes as that of a single command.
#   study_test.sh BIN_DIR SOURCE_DIR; ends with 77 where Slurm is not installed, or without root
set -euo pipefail
bin=$1 source=$2
for program in slurmctld slurmd sbatch; do
  PATH=$PATH:/usr/sbin type -P "$program" >/dev/null || { echo "no $program here"; exit 77; }
done
[ "$(id -u)" = 0 ] || { echo "a Slurm of one's own needs root"; exit 77; }
export PATH=$bin:$PATH:/usr/sbin

# A separate network and host name, so that no other Slurm is reached.
if [ -z "${ERGOCAST_SLURM_INSIDE:-}" ]; then
  ERGOCAST_SLURM_INSIDE=1 exec unshare --net --uts --pid --fork --mount-proc "$0" "$@"
fi
hostname node
ip link set lo up
ip address add 10.77.0.1/32 dev lo  # Slurm resolves no name if 127.0.0.1 is the only address
work=$(mktemp -d /tmp/ergocast-slurm-XXXXXX)
finish() {
  local status=$?
  [ "$status" = 0 ] || tail -n 30 "$work"/*.log
  rm -rf "$work"
  exit "$status"
}
trap finish EXIT
mkdir "$work/state" "$work/spool" "$work/study"
chmod 755 "$work"
cat >"$work/slurm.conf" <<CONF
ClusterName=test
SlurmctldHost=node(10.77.0.1)
SlurmUser=root
SlurmctldPort=36817
SlurmdPort=36818
AuthType=auth/none
CredType=cred/none
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SwitchType=switch/none
MpiDefault=none
ReturnToService=2
NodeName=node NodeAddr=10.77.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes=node Default=YES State=UP
CONF
export SLURM_CONF=$work/slurm.conf
slurmctld -D -i >"$work/slurmctld.out.log" 2>&1 &
controller=$!
slurmd -D -N node >"$work/slurmd.out.log" 2>&1 &
node=$!
slurm_runs() { kill -0 "$controller" && kill -0 "$node" || { echo 'Slurm has ended'; exit 1; }; }
until sinfo --noheader --format=%t 2>/dev/null | grep -q idle; do slurm_runs; sleep 0.2; done

cd "$work"
study=("$source/scenarios/quadrimodal_corners.textproto" --duration 100
  --vary "law.noise_ceiling=1,20" --seeds 1:60)
submit() {
  sbatch --parsable --array=1-3 "$@" "$source/examples/slurm/study.sbatch" study "${study[@]}"
}
queued() { squeue --noheader --jobs="$1" 2>/dev/null; }
ended() { while [ -n "$(queued "$1")" ]; do slurm_runs; sleep 0.2; done; }
rows() { cat study/shard-2/study.csv 2>/dev/null | wc -l; }

job=$(submit --no-requeue)
until [ "$(rows)" -gt 2 ]; do
  [ -n "$(queued "${job}_2")" ] || [ "$(rows)" -gt 2 ] || { cat slurm-*.out; echo 'the task has written no rows'; exit 1; }
  sleep 0.05
done
scancel --signal=KILL --full "${job}_2"
ended "$job"
[ "$(rows)" -lt 41 ] || { echo "the task had ended before it was killed"; exit 1; }
if ergocast study merge study/shard-* --out early; then echo "an incomplete shard was merged"; exit 1; fi

ended "$(submit)"
ergocast study merge study/shard-* --out merged
ergocast study "${study[@]}" --out whole >/dev/null
cmp merged/study.csv whole/study.csv
cmp merged/study.json whole/study.json
