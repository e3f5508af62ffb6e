#!/usr/bin/env bash
# status.sh JOB: prints running, success or failed, as snakemake asks for it.
# Needs no accounting database; uses one for jobs that the controller forgot.
set -uo pipefail

job="${1%%;*}"  # sbatch --parsable may append ";cluster"
if answer="$(scontrol show job -o "${job}" 2>&1)"; then
  state="$(sed -n 's/.* JobState=\([A-Z_]*\).*/\1/p' <<<"${answer}")"
elif [[ "${answer}" == *"Invalid job id"* ]]; then
  state="$(sacct -nPX -o State -j "${job}" 2>/dev/null | head -n 1)"
  # Forgotten, and no accounting. Another attempt finds the row of a case that
  # finished and computes nothing.
  state="${state:-UNKNOWN}"
else
  echo "status.sh: ${answer}" >&2
  state=UNREACHABLE  # the controller restarts: the job is none the worse
fi
case "${state%% *}" in
  COMPLETED) echo success ;;
  PENDING | CONFIGURING | RUNNING | COMPLETING | SUSPENDED | STOPPED | \
    SIGNALING | STAGE_OUT | RESIZING | REQUEUED | REQUEUE_HOLD | \
    UNREACHABLE) echo running ;;
  *) echo failed ;;
esac
