"""What the converter says when it cannot go on."""


class Refused(Exception):
    """`progress`: how many nodes were taken before, -1 before the first, to tell which of several attempts came furthest."""

    def __init__(self, message, progress=-1):
        super().__init__(message)
        self.progress = progress


def require(condition, message):
    if not condition:
        raise Refused(message)
