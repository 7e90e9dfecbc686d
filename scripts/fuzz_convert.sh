#!/usr/bin/env bash
# Fuzzes the converter of ONNX files with atheris: it must convert any file or reject it in one line. A file that causes a traceback, or takes more
# than 20 s or 1 GB, is stored in build/fuzz_convert/broken and should become a case of tests/convert.
# usage: scripts/fuzz_convert.sh [MINUTES]      default 2. Exit status 0 only if no file failed.
set -euo pipefail
cd "$(dirname "$0")/.."
minutes=${1:-2}
scripts/setup.sh convert-fuzz
work=build/fuzz_convert
export PYTHONPATH=apps/convert:tests/convert
mkdir -p $work/seeds $work/found $work/broken
[ -x $work/python/bin/python ] || /usr/bin/python3 -m venv --system-site-packages $work/python
$work/python/bin/pip install --quiet --disable-pip-version-check atheris==3.0.0
$work/python/bin/python fuzz/onnx_converter.py --seeds $work/seeds 2>/dev/null
code=0
$work/python/bin/python fuzz/onnx_converter.py -max_total_time=$((60 * minutes)) -max_len=20000 -timeout=20 -rss_limit_mb=1000 -print_final_stats=1 \
  -artifact_prefix=$work/broken/ $work/found $work/seeds >$work/log 2>&1 || code=$?
[ $code -eq 0 ] || tail -n 40 $work/log
echo "onnx_converter: $(sed -n 's/^stat::number_of_executed_units: *//p' $work/log) runs, $(find $work/found -type f | wc -l) inputs found"
exit $code
