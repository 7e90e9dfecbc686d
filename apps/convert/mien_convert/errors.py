"""Errors of the converter."""
import math

MAX_NUMBERS = 1 << 24  # per tensor: each element takes up to 24 bytes here, and a small file may declare any size
MAX_TOTAL_NUMBERS = 1 << 27  # limit for all tensors of a graph: 3 GB, and seconds per interpretation of its axes


class Refused(Exception):
    """`progress`: number of converted nodes, -1 before the first, to find the attempt that came furthest."""

    def __init__(self, message, progress=-1):
        super().__init__(message)
        self.progress = progress


def require(condition, message):
    if not condition:
        raise Refused(message)


def in_a_line(error):
    """The message of an exception on one line."""
    return " ".join(str(error).split())


def require_room(*sizes):
    require(math.prod(map(int, sizes)) <= MAX_NUMBERS,
            f"a tensor {[int(n) for n in sizes]}: at most {MAX_NUMBERS} numbers")
