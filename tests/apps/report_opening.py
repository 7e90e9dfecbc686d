#!/usr/bin/env python3
"""How long a report takes to open, in Chromium without a window.

usage: report_opening.py PAGE.html...
Times of the clock depend on what else the machine does; those of the processor, of the page's main thread, hardly do. `curves` is when
curves are drawn, `face` when the face is, too, which takes long where WebGL is drawn by the processor; `whole` when the clip plays.
"""
import json
import sys
import time

import chromium

# The page stops when its curves are there: what follows waits for a timer of no time.
STOP = "window.setTimeout = (real => (work, ms, ...more) => ms === undefined && !window.goesOn ? (window.stopped = work) : real(work, ms, ...more))(setTimeout);"
TIMES = """JSON.stringify({first_paint_ms: performance.getEntriesByType('paint').find(({name}) => name === 'first-contentful-paint').startTime,
  curves_ms: report.curves_ms, face_ms: report.opened_ms, whole_ms: report.whole_ms})"""


def wait(browser, condition):
    while not browser.evaluate(f"typeof report !== 'undefined' && !!({condition})"):
        time.sleep(0.1)


def measure(browser, page):
    browser.open(page)
    wait(browser, "window.stopped && report.curves_ms")
    metrics = {metric["name"]: metric["value"] for metric in browser.send("Performance.getMetrics")["metrics"]}
    browser.evaluate("window.goesOn = true; window.stopped()")
    wait(browser, "report.whole_ms")
    times = {name: round(value) for name, value in json.loads(browser.evaluate(TIMES)).items()}
    return {"processor_ms_until_curves": round(metrics["TaskDuration"] * 1000), **times}


browser = chromium.Chromium(chromium.find())
try:
    browser.send("Performance.enable", timeDomain="threadTicks")
    browser.send("Page.addScriptToEvaluateOnNewDocument", source=STOP)
    for page in sys.argv[1:]:
        print(page, json.dumps(measure(browser, page)))
finally:
    browser.close()
