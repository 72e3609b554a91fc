#!/bin/sh
# Verification in one line for any CI system:
#
#     sh examples/ci/verify.sh build/verification --suite ci --jobs 2
#
# First word: folder of the results. All others: options of `contact-verify run`.
# Where accepted numbers are kept (folder BASELINES, default baselines), the finished run is compared with them.
# With AGAINST=REVISION every method is then timed alternately with that revision, on the case AGAINST_CASE; that needs
# the project's own folder as the current one.
# Exit code: that of contact-verify (0 passed, 1 a check failed, 2 interrupted, 3 internal error, 4 usage, 5 nothing ran,
# 6 open verdicts with --strict).
# Keep these files of the folder as artefacts: report.html (open it in a browser), summary.md, junit.xml, run.json and
# answers.jsonl.
set -u
out=${1:?"usage: verify.sh FOLDER [options of contact-verify run]"}
shift
baselines=${BASELINES:-baselines}

contact-verify run --quiet --out "$out" "$@"
code=$?

if [ "$code" -le 1 ] && [ -d "$baselines" ]; then
    contact-verify gate "$out" --quiet --baseline "$baselines"
    code=$?
fi
if [ "$code" -eq 0 ] && [ -n "${AGAINST:-}" ]; then
    python -m benchmarks.race "$AGAINST" "${AGAINST_CASE:-truncated_cone}"
    code=$?
fi

# On GitHub the summary appears on the page of the job.
if [ -n "${GITHUB_STEP_SUMMARY:-}" ] && [ -f "$out/summary.md" ]; then
    cat "$out/summary.md" >> "$GITHUB_STEP_SUMMARY"
fi
exit $code
