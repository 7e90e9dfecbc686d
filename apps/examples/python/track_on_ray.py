#!/usr/bin/env python3
"""Tracks every recording of a folder on the machines of a Ray cluster: `mien track DIR --out DIR` for archives beyond
one machine.

usage: track_on_ray.py DIR --out DIR [--format NAME]... [--address ADDRESS] [--mien PROGRAM] [--cpus N] [--json]
       [-- OPTIONS OF mien track]

Needs `ray` (PyPI), and folders and program under the same names on all machines. ADDRESS is that of a cluster (`auto`:
the one this machine belongs to); without it Ray starts on this machine alone. As with `mien track`: a/b.mp4 becomes
OUT/a/b.mp4.csv, a file with newer outputs is skipped, outputs appear under their names when they are complete, and
failed files are listed at the end (exit code 12) without stopping the others. If a worker dies, another one tracks its
file again.
"""
import argparse
import contextlib
import json
import os
import subprocess
import sys
import time

# As in apps/mien/tracking/batch.cpp and apps/animation/animation.h.
RECORDINGS = (".3gp .aac .avi .flac .flv .m4a .m4v .mkv .mov .mp3 .mp4 .mpeg .mpg .mts .oga .ogg .ogv .opus .ts .wav "
              ".webm .wma .wmv .y4m").split()
ENDINGS = {"csv": ".csv", "jsonl": ".jsonl", "llf": ".llf.csv", "gltf": ".gltf", "glb": ".glb", "bvh": ".bvh",
           "roblox": ".roblox.csv", "visemes": ".visemes.csv", "rhubarb": ".tsv", "rhubarb-json": ".rhubarb.json",
           "rhubarb-xml": ".xml", "rhubarb-dat": ".dat"}
RETRIES = 5  # of a file whose worker died
SOME_FAILED = 12
# Ends the program together with its worker, because another worker tracks the file again.
DIE_WITH_WORKER = ["setpriv", "--pdeathsig", "KILL"] if sys.platform == "linux" else []


def recordings(folder, out):
    """Names within the folder, sorted, without the content of `out`."""
    names = []
    for path, folders, files in os.walk(folder):
        folders[:] = [name for name in folders if os.path.realpath(os.path.join(path, name)) != os.path.realpath(out)]
        names += [os.path.relpath(os.path.join(path, name), folder) for name in files
                  if os.path.splitext(name)[1].lower() in RECORDINGS]
    return sorted(names)


def is_done(job):
    made = os.stat(job["input"]).st_mtime_ns
    return all(os.path.exists(output) and os.stat(output).st_mtime_ns >= made for output in job["outputs"])


def track(job, program, options):
    """Runs on a worker. Looks again whether the file is done: the worker before may have died after it was."""
    begin = time.monotonic()
    if is_done(job):
        return job | {"outcome": "done before"}
    os.makedirs(os.path.dirname(job["outputs"][0]), exist_ok=True)
    outputs = [word for output, name in zip(job["outputs"], job["formats"])
               for word in ("-o", output, "--format", name)]
    command = [*DIE_WITH_WORKER, program, "track", job["input"], *outputs, "--quiet", *options]
    done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    if done.returncode != 0:
        return job | {"outcome": "failed", "failure": done.stderr.strip() or f"mien ended with {done.returncode}"}
    return job | {"outcome": "done", "seconds": round(time.monotonic() - begin, 3)}


def run_all(jobs, arguments):
    import ray  # the functions above need no cluster

    ray.init(address=arguments.address, log_to_driver=False)
    # The task of a dead worker runs again; a failure of mien is a result and is not repeated.
    remote = ray.remote(max_retries=RETRIES, num_cpus=arguments.cpus)(track)
    pending = {remote.remote(job, arguments.mien, arguments.options): job for job in jobs}
    finished = []
    while pending:
        (ready,), _ = ray.wait(list(pending), num_returns=1)
        job = pending.pop(ready)
        try:
            finished.append(ray.get(ready))
        except ray.exceptions.RayError as error:
            finished.append(job | {"outcome": "failed", "failure": f"{job['input']}: {str(error).splitlines()[0]}"})
        print(f"\r{len(finished)} of {len(jobs)} files", end="", file=sys.stderr)
    print(file=sys.stderr)
    ray.shutdown()
    return sorted(finished, key=lambda job: job["file"])


def parse(words):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder")
    parser.add_argument("--out", required=True)
    parser.add_argument("--format", action="append", choices=ENDINGS)
    parser.add_argument("--address")
    parser.add_argument("--mien", default=os.environ.get("MIEN_PROGRAM", "mien"))
    parser.add_argument("--cpus", type=float, default=1, help="of a machine that one file keeps busy")
    parser.add_argument("--json", action="store_true")
    own, options = (words[:words.index("--")], words[words.index("--") + 1:]) if "--" in words else (words, [])
    arguments = parser.parse_args(own)
    arguments.options = options
    return arguments


def main(words):
    arguments = parse(words)
    formats = arguments.format or ["csv"]
    folder, out = os.path.abspath(arguments.folder), os.path.abspath(arguments.out)
    jobs = [{"file": name, "input": os.path.join(folder, name), "formats": formats,
             "outputs": [os.path.join(out, name + ENDINGS[each]) for each in formats]}
            for name in recordings(folder, out)]
    if not jobs:
        sys.exit(f"{folder}: no video and no audio in this folder")
    before = [job | {"outcome": "done before"} for job in jobs if is_done(job)]
    waiting = [job for job in jobs if not is_done(job)]
    with contextlib.redirect_stdout(sys.stderr):  # Ray reports dead workers there; standard output has the table
        finished = sorted(before + (run_all(waiting, arguments) if waiting else []), key=lambda job: job["file"])
    if arguments.json:
        print(json.dumps([{key: value for key, value in job.items() if key not in ("input", "formats")}
                          for job in finished], indent=1))
    else:
        for job in finished:
            print(f"{job['outcome']:12} {job['file']}")
    failed = [job["failure"] for job in finished if job["outcome"] == "failed"]
    if failed:
        print(f"{len(failed)} of {len(finished)} files failed:", *failed, sep="\n  ", file=sys.stderr)
        return SOME_FAILED
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
