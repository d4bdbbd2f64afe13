# What the jobs share; sourced by them.

# The tools of PFVOX_BIN, or those on PATH.
tool() { echo "${PFVOX_BIN:+$PFVOX_BIN/}$1"; }

probe_file=$PFVOX_OUT/${PFVOX_SCENE%.*}.pf_probe
shards=$PFVOX_OUT/.cluster/shards-of-$PFVOX_TASKS

# run <command>...: what another attempt may cure puts the task back into the queue, up to PFVOX_RETRIES times; other failures
# end it. A lost node does the same without us (--requeue). When Slurm announces the end of the time (--signal), the command is
# asked to stop: a bake keeps its finished probes and goes on with them in the next attempt.
run() {
  local child code=0
  "$@" &
  child=$!
  trap 'kill -TERM $child 2>/dev/null' TERM
  wait "$child" || code=$?
  # A signal ends `wait` before the command has ended.
  while kill -0 "$child" 2>/dev/null; do
    code=0
    wait "$child" || code=$?
  done
  trap - TERM
  case $code in
    0) return 0 ;;
    3 | 6 | 70 | 1[2-9][0-9]) ;; # files, GPU, our fault, signals
    *) echo "exit code $code: another attempt would end the same" >&2; exit "$code" ;;
  esac
  local attempt=$((${SLURM_RESTART_COUNT:-0} + 1))
  if [ "$attempt" -gt "$PFVOX_RETRIES" ]; then
    echo "exit code $code in attempt $attempt, the last" >&2
    exit "$code"
  fi
  echo "exit code $code in attempt $attempt: back into the queue" >&2
  scontrol requeue "${SLURM_ARRAY_JOB_ID:-$SLURM_JOB_ID}${SLURM_ARRAY_TASK_ID:+_$SLURM_ARRAY_TASK_ID}"
  exit "$code"
}
