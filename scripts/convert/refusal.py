"""What the converter says when it cannot go on."""


class Refused(Exception):
    """`progress`: how many nodes were taken before, to tell which of several attempts came furthest."""

    def __init__(self, message, progress=0):
        super().__init__(message)
        self.progress = progress


def require(condition, message):
    if not condition:
        raise Refused(message)
