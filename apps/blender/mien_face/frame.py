"""One moment of an animation."""

from dataclasses import dataclass, field


@dataclass
class Frame:
    """`values` has the values of each vocabulary that the source contains, by name; names without a value are absent.
    `head` is the rotation (w, x, y, z) in mien's axes, None without a face."""

    time_s: float
    values: dict = field(default_factory=dict)
    head: tuple | None = None


class FaceDataError(ValueError):
    """A packet or a file that cannot be read; the message is for the user."""
