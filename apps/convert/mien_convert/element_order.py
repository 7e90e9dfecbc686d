"""Reads arbitrarily ordered elements of a layer as parts of its map, each in some order of its axes."""
import itertools

import numpy as np

from .errors import Refused

MAX_PIECES = 256  # maximum per tensor: each needs one or two layers
ORDERS = {"".join("chw"[axis] for axis in order): order for order in itertools.permutations(range(3))}


class Piece:
    """A part of a layer: channels [(first, last)...], rows and columns (first, last), read in an order of ORDERS."""

    def __init__(self, layer, channels, rows, columns, order):
        self.layer, self.channels, self.rows, self.columns, self.order = layer, channels, rows, columns, order


def pieces_of(layer, elements):
    """elements: [n], numbers in (c, h, w)."""
    whole = piece_of(layer, elements)
    if whole:
        return [whole]
    for count in range(2, min(MAX_PIECES, len(elements)) + 1):
        if len(elements) % count:
            continue
        parts = elements.reshape(count, -1)
        if piece_of(layer, parts[0]):
            found = [piece_of(layer, part) for part in parts]
            if all(found):
                return found
    raise Refused(
        "it reads a map whose rows, columns or channels have been rearranged in a way that no few slices undo")


def piece_of(layer, elements):
    """Returns None unless they are all elements of a range of channels, rows and columns, in an order of these axes."""
    h, w, c = layer.shape
    # Numbers grow along every axis. This rejects most other orders before the sorting below.
    if elements[0] != elements.min() or elements[-1] != elements.max():
        return None
    channels, rows, columns = (np.unique(place) for place in np.unravel_index(elements, (c, h, w)))
    if len(channels) * len(rows) * len(columns) != len(elements) or not (is_range(rows) and is_range(columns)):
        return None
    runs = np.split(channels, np.flatnonzero(np.diff(channels) != 1) + 1)
    if len(runs) > MAX_PIECES:
        return None
    wanted = (channels[:, None, None] * h + rows[:, None]) * w + columns
    for name, order in sorted(ORDERS.items(), key=lambda one: one[0] != "hwc"):
        if (elements == wanted.transpose(order).reshape(-1)).all():
            return Piece(layer, [ends(run) for run in runs], ends(rows), ends(columns), name)
    return None


def is_range(numbers):
    return numbers[-1] - numbers[0] + 1 == len(numbers)


def ends(numbers):
    return int(numbers[0]), int(numbers[-1]) + 1
