#!/usr/bin/env python3
"""Measures how long a report takes to open in headless Chromium.

usage: report_opening.py [--times N] PAGE.html...        the median of N runs (default: 5), in ms since the navigation

`curves`: curves are drawn; `seen`: the browser displays them; `face`: the face is drawn, which is slow with software WebGL; `whole`: the
clip can play; `pause`: the longest interval between `seen` and `whole` without a new frame. All of these depend on the load of the machine.
`processor`, the CPU time of the page's main thread until curves are drawn and everything is parsed, hardly does.
"""
import argparse
import json
import statistics
import sys
import time

import chromium

# Records when the browser draws the page.
FRAMES = """{
  const made = window.picturesMade = [];
  const note = () => { made.push(performance.now()); requestAnimationFrame(note); };
  requestAnimationFrame(note);
}"""
# Stops the page after its curves: everything that follows waits for a timer of 0 ms.
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
    """Runs a script in a new browser, opens the page, waits for a condition, and returns the value of an expression."""
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
