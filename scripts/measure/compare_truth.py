#!/usr/bin/env python3
"""Prints the error of tracked controls compared with true ones, with the standard library only.

usage: compare_truth.py TRACKED.csv TRUTH.csv
The FACS error is the mean absolute difference over the supported controls, printed beside that of the best constant:
each control's mean over the clip, which an untrained tracker could output.
"""
import csv
import sys


def columns(path):
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    return {name: [float(row[name]) if row[name] else None for row in rows]
            for name in rows[0] if name not in ("status",)}


def mean(values):
    return sum(values) / len(values)


def correlation(a, b):
    ma, mb = mean(a), mean(b)
    va, vb = sum((x - ma) ** 2 for x in a), sum((x - mb) ** 2 for x in b)
    cov = sum((x - ma) * (y - mb) for x, y in zip(a, b))
    return cov / (va * vb) ** 0.5 if va > 1e-9 and vb > 1e-9 else None


def main():
    tracked, truth = columns(sys.argv[1]), columns(sys.argv[2])
    supported = [name for name in truth if name in tracked and name not in ("frame", "t_ms")
                 and any(v is not None for v in tracked[name])]
    errors, constants, correlations = [], [], {}
    for name in supported:
        pairs = [(a, b) for a, b in zip(tracked[name], truth[name]) if a is not None]
        answers, wanted = [a for a, _ in pairs], [b for _, b in pairs]
        errors.append(mean([abs(a - b) for a, b in pairs]))
        constants.append(mean([abs(mean(wanted) - b) for b in wanted]))
        correlations[name] = correlation(answers, wanted)
    if not supported:
        print("no supported control: nothing to compare")
        return
    moving = {name: r for name, r in correlations.items() if r is not None}
    print(f"{len(supported)} supported controls: FACS error {mean(errors):.4f} "
          f"(best constant {mean(constants):.4f}), mean correlation {mean(list(moving.values())):.2f}")
    for name in ("jawOpen", "eyeBlinkLeft", "eyeBlinkRight", "mouthSmileLeft", "browInnerUp"):
        if name in moving:
            print(f"  {name}: correlation {moving[name]:.2f}")


if __name__ == "__main__":
    main()
