#!/usr/bin/env bash
# Runs the tests that take hours, continues after failures, and writes build/nightly/report.md. Exit status 0 only if all pass.
# usage: scripts/nightly.sh [HOURS]      hours of fuzzing, default 4
set -uo pipefail
cd "$(dirname "$0")/.." || exit
hours=${1:-4}
folder=build/nightly
mkdir -p $folder
report=$folder/report.md
failed=0

step() {  # name, command...
  local log=$folder/$1.log began=$SECONDS outcome=right
  "${@:2}" >"$log" 2>&1 || outcome="**failed ($?)**"
  case $outcome in
    *"(77)"*) outcome="**skipped**" ;;
    *failed*) failed=1 ;;
  esac
  # shellcheck disable=SC2016  # the ticks are Markdown's
  printf '| %s | `%s` | %s | %d | %s |\n' "$1" "${*:2}" "$outcome" $((SECONDS - began)) "$(tail -n 1 "$log" | tr '|' '/')" >>$report
}

printf '# %s, %s\n\n| what | command | outcome | seconds | its last line |\n|---|---|---|---|---|\n' \
  "$(date -u +%F)" "$(git describe --always --dirty)" >$report
step tests scripts/test.sh --all
step other_machines scripts/cross/all.sh --full
step other_compilers scripts/cross/compilers.sh
step swift scripts/cross/swift.sh
step emulated_processors scripts/cross/bochs.sh
step wheels scripts/package/wheels.sh
step sizes scripts/package/sizes.py --check
step android_package scripts/package/android.sh
step apple_package scripts/package/xcframework.sh
step made_100000_times build/release/tests/tracker/tracker_scenario_test --gtest_filter=Trackers.MayBeCreatedManyTimes --gtest_repeat=10 --gtest_brief=1
step every_allocation /usr/bin/python3 tests/apps/faults_test.py build/release/apps/mien/mien build/release/tests/apps/libmien_failing_malloc.so all
step output_safety /usr/bin/python3 tests/apps/output_safety_test.py build/release/apps/mien/mien full
step convert_time /usr/bin/python3 tests/apps/convert_size_test.py build/release/apps/mien/mien time
step media_matrix /usr/bin/python3 tests/apps/media_matrix_test.py build/release/apps/mien/mien 400
step public_models env PYTHONPATH=apps/convert /usr/bin/python3 tests/convert/public_models_test.py build/release/apps/mien/mien
step killed_training env PYTHONPATH=models/training:apps/convert /usr/bin/python3 tests/train/killed_training_test.py
step worst_frame scripts/measure/worst_frame.sh
step blender tests/blender/bpy_test.sh build/release/apps/mien/mien
step live_page /usr/bin/python3 tests/apps/live_page_latency.py build/release/apps/mien/mien . 600
step soak scripts/measure/soak.sh
step memcheck scripts/valgrind.sh 3
step realtime scripts/rtsan.sh
step coverage scripts/coverage.sh
step mutation_testing scripts/mutate.sh --workers 2
step reproducible scripts/package/check_reproducible.sh
step fuzzing_the_converter scripts/fuzz_convert.sh 10
step fuzzing scripts/fuzz.sh --tally $((hours * 60))
cat $report
exit $failed
