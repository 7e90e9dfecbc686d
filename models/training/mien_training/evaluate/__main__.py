"""Measures mien and writes docs/results: tables, plots, and README.md with every figure and its goal.

Needs the built program, the data packs (MIEN_DATA) and the cache (MIEN_CACHE). Parts without their data are skipped and
reported, and the exit status is then 3. Images are rendered into the cache once. See docs/training.md.
"""
import argparse
import importlib
import json
import sys
import time
from pathlib import Path

from mien_training.evaluate import model_card, summary
from mien_training.evaluate import report as out
from mien_training.evaluate.inputs import PARTS, Missing, Setting
from mien_training.evaluate.program import Program
from mien_training.paths import ROOT

SKIPPED = 3  # exit status


def evaluate(part, setting):
    """Measures one part and writes its results."""
    module = importlib.import_module(f"mien_training.evaluate.evaluate_{part}")
    print(f"== {part}", flush=True)
    began = time.time()
    results = module.measure(setting)
    seconds = time.time() - began
    (setting.out / f"{part}.json").write_text(out.dump({"seconds": round(seconds), "results": results}))
    write_page(part, results, setting.out)
    print(f"{part}: {seconds:.0f} s", flush=True)


def write_page(part, results, folder):
    module = importlib.import_module(f"mien_training.evaluate.evaluate_{part}")
    if hasattr(module, "markdown"):
        note = f"\n[All figures]({part}.json)\n"
        (folder / f"{part}.md").write_text(module.markdown(results).rstrip() + "\n" + note)
    if hasattr(module, "plot"):
        module.plot(results, folder)


def write_summary(folder, skipped, has_hifinet):
    summary.write(folder, skipped, has_hifinet)
    if folder == ROOT / "docs/results":
        model_card.write(folder)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("parts", nargs="*", metavar="PART", help=f"some of {', '.join(PARTS)}; default: all")
    parser.add_argument("--mien", type=Path, default=ROOT / "build/release/apps/mien/mien", help="the built program")
    parser.add_argument("--models", type=Path, default=ROOT / "models")
    parser.add_argument("--out", type=Path, default=ROOT / "docs/results")
    parser.add_argument("--pages-only", action="store_true",
                        help="write the pages anew from the JSON files; measure nothing")
    args = parser.parse_args()
    if unknown := set(args.parts) - set(PARTS):
        parser.error(f"no such part: {', '.join(sorted(unknown))}")
    if args.pages_only:
        for part in args.parts or [p for p in PARTS if (args.out / f"{p}.json").exists()]:
            write_page(part, json.loads((args.out / f"{part}.json").read_text())["results"], args.out)
        return write_summary(args.out, [], has_hifinet=True)
    if not args.mien.exists():
        parser.error(
            f"{args.mien} is not built: cmake --preset release && cmake --build --preset release --target mien")
    args.out.mkdir(parents=True, exist_ok=True)
    setting = Setting(Program(args.mien, args.models), args.out)
    for part in args.parts or PARTS:
        try:
            evaluate(part, setting)
        except Missing as missing:
            setting.skip(part, missing)
    write_summary(args.out, setting.skipped, setting.program.has_hifinet)
    for skipped in setting.skipped:
        print(f"SKIPPED {skipped}", file=sys.stderr)
    return SKIPPED if setting.skipped else 0


if __name__ == "__main__":
    sys.exit(main())
