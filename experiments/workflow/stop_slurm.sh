#!/usr/bin/env bash
# Ends what start_slurm.sh started in FOLDER, jobs included:
#   stop_slurm.sh FOLDER
# Its files stay, so that logs can be read. Fine when nothing runs.
set -euo pipefail

if [ "$#" -ne 1 ]; then
  echo "usage: $0 FOLDER" >&2
  exit 2
fi
if [ ! -d "$1" ]; then
  echo "stop_slurm.sh: $1: no such folder" >&2
  exit 1
fi
folder="$(cd "$1" && pwd -P)"

# Prints the process of FOLDER/NAME.pid, if it runs. One that has ended and
# that nobody waited for (Z), as in a container, does not.
pid_of() {
  local pid
  pid="$(cat "${folder}/$1.pid" 2>/dev/null)" || return 1
  awk -v name="$1" '$1 == "Name:" { n = $2 } $1 == "State:" { s = $2 }
    END { exit !(n == name && s != "Z") }' "/proc/${pid}/status" 2>/dev/null &&
    echo "${pid}"
}

if [ -f "${folder}/slurm.conf" ] && pid_of slurmctld >/dev/null; then
  export SLURM_CONF="${folder}/slurm.conf"
  if timeout 10 scancel --state=RUNNING --state=PENDING --partition=local \
       2>/dev/null; then
    for _ in $(seq 100); do
      [ -n "$(timeout 10 squeue -h 2>/dev/null)" ] || break
      sleep 0.1
    done
  fi
fi
status=0
for name in slurmd slurmctld munged; do
  pid="$(pid_of "${name}")" || continue
  kill "${pid}"
  for _ in $(seq 100); do
    pid_of "${name}" >/dev/null || break
    sleep 0.1
  done
  if pid_of "${name}" >/dev/null; then
    echo "stop_slurm.sh: ${name} (${pid}) does not end" >&2
    status=1
  else
    echo "${name} stopped"
  fi
done
exit "${status}"
