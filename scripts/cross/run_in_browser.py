#!/usr/bin/env python3
"""Runs a program that Emscripten has linked to a single file in headless Chromium, with its output and exit status.
usage: run_in_browser.py PROGRAM.js [ARGUMENT...]"""
import json
import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tests" / "apps"))
import chromium  # noqa: E402

PAGE = """<!DOCTYPE html><meta charset="utf-8"><title>%(name)s</title><script>
const lines = [];
const ended = new Promise(resolve => {
  window.onerror = message => resolve({ lines, status: -1, message });
  window.Module = { arguments: %(arguments)s, print: line => lines.push(line), printErr: line => lines.push(line),
                    onExit: status => resolve({ lines, status }) };
});
</script><script src="%(name)s"></script>"""


def main():
    program, arguments = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2:]
    found = chromium.find()
    if not found:
        sys.exit("run_in_browser.py: no Chromium here")
    with tempfile.NamedTemporaryFile("w", suffix=".html", dir=program.parent) as page:
        page.write(PAGE % {"name": program.name, "arguments": json.dumps(arguments)})
        page.flush()
        browser = chromium.Chromium(found)
        try:
            browser.open(page.name)
            result = browser.evaluate("ended")
        finally:
            browser.close()
    print("\n".join(result["lines"]))
    if "message" in result:
        print(result["message"], file=sys.stderr)
    sys.exit(0 if result["status"] == 0 else 1)


if __name__ == "__main__":
    main()
