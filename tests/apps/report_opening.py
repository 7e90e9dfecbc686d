#!/usr/bin/env python3
"""How long a report takes to open, in Chromium without a window.

usage: report_opening.py [--times N] PAGE.html...        the median of N openings (default: 5), all of the clock, in ms from the navigation on

`curves` is when curves are drawn, `seen` when the browser puts the picture with them on the screen, `face` when the face is drawn, too,
which takes long where WebGL is drawn by the processor, `whole` when the clip plays; `pause` is the longest time from `seen` to `whole` in
which the page does not move. These depend on what else the machine does; `processor`, which the page's main thread needs until curves are
drawn and everything is parsed, hardly does.
"""
import argparse
import json
import statistics
import sys
import time

import chromium

# Notes when the browser makes pictures of the page.
FRAMES = """{
  const made = window.picturesMade = [];
  const note = () => { made.push(performance.now()); requestAnimationFrame(note); };
  requestAnimationFrame(note);
}"""
# The page stops when its curves are there: what follows waits for a timer of no time.
STOP = "window.setTimeout = (real => (work, ms, ...more) => ms === undefined && !window.goesOn ? (window.stopped = work) : real(work, ms, ...more))(setTimeout);"
TIMES = """(() => {
  const {curves_ms: curves, opened_ms: face, whole_ms: whole} = report;
  const moves = [...picturesMade.filter(t => t >= curves && t < whole), whole], pauses = moves.slice(1).map((t, i) => t - moves[i]);
  return JSON.stringify({curves, seen: moves[0], face, whole, pause: Math.max(...pauses)});
})()"""


def wait(browser, condition):
    while not browser.evaluate(f"typeof report !== 'undefined' && !!({condition})"):
        time.sleep(0.1)


def opened(page, script, condition, ask):
    """What is asked of a new browser that has opened the page with a script before it, when the condition holds."""
    browser = chromium.Chromium(chromium.find())
    try:
        browser.send("Performance.enable", timeDomain="threadTicks")
        browser.send("Page.addScriptToEvaluateOnNewDocument", source=script)
        browser.open(page)
        wait(browser, condition)
        return ask(browser)
    finally:
        browser.close()


def clock_ms(page):
    return opened(page, FRAMES, "report.whole_ms", lambda browser: json.loads(browser.evaluate(TIMES)))


def processor_ms(page):
    metrics = opened(page, STOP, "window.stopped && report.curves_ms", lambda browser: browser.send("Performance.getMetrics")["metrics"])
    return 1000 * next(metric["value"] for metric in metrics if metric["name"] == "TaskDuration")


def measure(page, times):
    runs = [{**clock_ms(page), "processor": processor_ms(page)} for _ in range(times)]
    return {name: [round(pick(run[name] for run in runs)) for pick in (min, statistics.median, max)] for name in runs[0]}


parser = argparse.ArgumentParser(usage=__doc__)
parser.add_argument("--times", type=int, default=5)
parser.add_argument("pages", nargs="+")
options = parser.parse_args(sys.argv[1:])
for page in options.pages:
    print(page)
    for name, figures in measure(page, options.times).items():
        print(f"  {name:10}" + "".join(f"{word} {figure:6} ms   " for word, figure in zip(("least", "median", "most"), figures)))
