#!/usr/bin/env bash
# A real Slurm of one node on the loopback, without systemd:
#   start_slurm.sh FOLDER
# Starts munged, slurmctld and slurmd with all their files in FOLDER, as the
# user who calls it (root or not); those that run already are left alone. Then
#   source FOLDER/env.sh
# points sbatch and the others to it, and stop_slurm.sh FOLDER ends it.
# SLURM_PORT: the first of two free TCP ports (26817).
# SLURM_CPUS: CPUs that the node claims to have (those of the machine).
set -euo pipefail

fail() { echo "start_slurm.sh: $*" >&2; exit 1; }

if [ "$#" -ne 1 ]; then
  echo "usage: $0 FOLDER" >&2
  exit 2
fi
PATH="${PATH}:/usr/sbin:/sbin"
for program in munged slurmctld slurmd sinfo scontrol; do
  command -v "${program}" >/dev/null ||
    fail "no ${program} on this system; scripts/install_workflow.sh installs it"
done
mkdir -p "$1"
folder="$(cd "$1" && pwd -P)"
[[ "${folder}" =~ ^[A-Za-z0-9_./-]+$ ]] ||
  fail "${folder}: slurm.conf can hold only letters, digits and _ . / -"
# The path of a Unix socket has 107 characters at most.
[ "${#folder}" -le 80 ] || fail "${folder}: path longer than 80 characters"
port="${SLURM_PORT:-26817}"
node="$(uname -n)"
node="${node%%.*}"
user="$(id -un)"

# is_running NAME: the process that FOLDER/NAME.pid names. One that has ended
# and that nobody waited for (Z), as in a container, does not count.
is_running() {
  local pid
  pid="$(cat "${folder}/$1.pid" 2>/dev/null)" &&
    awk -v name="$1" '$1 == "Name:" { n = $2 } $1 == "State:" { s = $2 }
      END { exit !(n == name && s != "Z") }' "/proc/${pid}/status" 2>/dev/null
}

# start NAME COMMAND...: a daemon that leaves NAME.pid, unless it runs.
start() {
  local name="$1"
  shift
  if is_running "${name}"; then
    echo "${name} runs"
    return
  fi
  rm -f "${folder}/${name}.pid"
  "$@" >"${folder}/${name}.out" 2>&1 9>&- ||
    fail "${name} does not start:" "$(tail -n 3 "${folder}/${name}.out")"
  for _ in $(seq 100); do
    is_running "${name}" && break
    sleep 0.1
  done
  is_running "${name}" || fail "${name} ended at once:" \
    "$(tail -n 3 "${folder}/${name}.out" "${folder}/${name}.log")"
  echo "${name} started"
}

# One start at a time in a folder.
exec 9>"${folder}/start.lock"
flock 9

mkdir -p "${folder}/state" "${folder}/spool"
chmod 755 "${folder}"
if [ ! -s "${folder}/munge.key" ]; then
  (umask 077 && head -c 1024 /dev/urandom >"${folder}/munge.key.part")
  mv "${folder}/munge.key.part" "${folder}/munge.key"
fi
if ! is_running slurmctld && ! is_running slurmd; then
  for p in "${port}" "$((port + 1))"; do
    if (exec 3<>"/dev/tcp/127.0.0.1/${p}") 2>/dev/null; then
      fail "port ${p} is in use; set SLURM_PORT to the first of two free ones"
    fi
  done
  memory_mb="$(awk '$1 == "MemTotal:" { print int($2 / 1024) }' /proc/meminfo)"
  cat >"${folder}/slurm.conf.part" <<CONF
ClusterName=loopback
SlurmctldHost=${node}(127.0.0.1)
SlurmctldPort=${port}
SlurmdPort=$((port + 1))
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny
SlurmUser=${user}
SlurmdUser=${user}
AuthType=auth/munge
AuthInfo=socket=${folder}/munge.socket
CryptoType=crypto/munge
StateSaveLocation=${folder}/state
SlurmdSpoolDir=${folder}/spool
SlurmctldPidFile=${folder}/slurmctld.pid
SlurmdPidFile=${folder}/slurmd.pid
SlurmctldLogFile=${folder}/slurmctld.log
SlurmdLogFile=${folder}/slurmd.log
# Without cgroups, which a container seldom lets one change.
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
ReturnToService=2
KillWait=5
SlurmctldTimeout=30
SlurmdTimeout=30
NodeName=${node} NodeAddr=127.0.0.1 CPUs=${SLURM_CPUS:-$(nproc)} RealMemory=${memory_mb} State=UNKNOWN
PartitionName=local Nodes=ALL Default=YES MaxTime=INFINITE State=UP OverSubscribe=NO
CONF
  mv "${folder}/slurm.conf.part" "${folder}/slurm.conf"
fi
printf 'export SLURM_CONF=%s/slurm.conf\n' "${folder}" >"${folder}/env.sh"
export SLURM_CONF="${folder}/slurm.conf"

start munged munged --key-file="${folder}/munge.key" \
  --socket="${folder}/munge.socket" --pid-file="${folder}/munged.pid" \
  --log-file="${folder}/munged.log" --seed-file="${folder}/munged.seed"
start slurmctld slurmctld
start slurmd slurmd -N "${node}"

for _ in $(seq 300); do
  state="$(sinfo -h -o %T 2>/dev/null || true)"
  case "${state}" in
    idle | mixed | allocated) break ;;
    # As after a crash of the node: back to work.
    down* | drained*)
      scontrol update "NodeName=${node}" State=RESUME 2>/dev/null || true ;;
  esac
  sleep 0.1
done
case "${state}" in
  idle | mixed | allocated) ;;
  *) fail "the node is '${state}' after 30 s; see ${folder}/slurmd.log and" \
          "${folder}/slurmctld.log" ;;
esac
echo "Slurm is up: node ${node}, ${state}; source ${folder}/env.sh"
