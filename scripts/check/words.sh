#!/usr/bin/env bash
# Checks spelling (cspell), terms (textlint), prose (write-good), and that files and tests named in the pages exist. Phrases to avoid come
# from scripts/check/avoid.txt, known words from docs/glossary.md and scripts/check/words.txt.
# usage: scripts/check/words.sh            the pages and sources that COVERED names
#        scripts/check/words.sh FILE...    these pages, and the comments and messages of these sources
set -euo pipefail
cd "$(dirname "$0")/../.."
. scripts/check/npm.sh

# Patterns of git ls-files, of pages and of sources, whose comments and messages count. soak.md has a table of a test program.
COVERED=('*.md' '*.h' '*.hpp' '*.inc' '*.c' '*.cpp' '*.py' '*.sh' '*.js' '*.mjs' '*.ts' '*.cs' '*.java' '*.kt' '*.rs' '*.swift'
  '*.cmake' '*CMakeLists.txt' :!docs/results/soak.md)

files=("$@")
[ $# -gt 0 ] || mapfile -t files < <(git ls-files "${COVERED[@]}")
mapfile -t pages < <(printf '%s\n' "${files[@]}" | grep '\.md$')
[ ${#pages[@]} -eq 0 ] || scripts/check/page_names.py "${pages[@]}"

if ! install_check_tools; then
  echo "SKIPPED: words: cspell, textlint and write-good could not be installed from npm" >&2
  exit 0
fi

work=build/words
modules=$PWD/scripts/check/npm/node_modules
rm -rf "$work"
scripts/check/words.py "$work" "${files[@]}"
mapfile -t copies < <(cd "$work" && find text -type f)
ln -s "$modules" "$work/node_modules"  # where textlint looks for its rules
cd "$work"

run() {  # tool, files
  case $1 in
    cspell) node node_modules/cspell/bin.mjs lint --config cspell.json --no-progress --no-summary --no-must-find-files --dot "${@:2}" ;;
    textlint) node node_modules/textlint/bin/textlint.js --config .textlintrc.json --format unix "${@:2}" ;;
    # Its other checks forbid words that technical text needs, such as several, multiple and most adverbs.
    write-good) node node_modules/write-good/bin/write-good.js --parse --illusion --so --thereIs --cliches "${@:2}" ;;
  esac
}

# A check that accepts these errors does not work.
printf 'A pictuer.\n' >cspell.md
printf 'A film.\n' >textlint.md
printf 'So %s is.\n' 'it it' >write-good.md
for tool in cspell textlint write-good; do
  if run $tool $tool.md >/dev/null 2>&1; then
    echo "check/words.sh: $tool: no error reported in: $(cat $tool.md)" >&2
    exit 1
  fi
done

failed=0
for tool in cspell textlint write-good; do
  run $tool "${copies[@]}" >findings || failed=1
  sed -n "s|^$PWD/||; s|^text/||; s|\.txt:|:|; /:/p" findings | tee listed
  [ ! -s listed ] || failed=1  # write-good's exit status is that of the last file
done
[ $failed -eq 1 ] || echo "words: ${#files[@]} files are clean"
exit $failed
