"""How the networks see a face: the part of its crop, the size, and the window that data sets store.

A crop (cx, cy, side, roll) is the square that landmarks fit (sequences.fit_crop). BaseNet sees all of it, HiFiNet the
face only.
"""
from dataclasses import dataclass


@dataclass(frozen=True)
class Framing:
    name: str
    height: int          # of the encoder's input, pixels
    width: int
    extent: float        # height of the encoder's view, crop sides
    window: int          # side of a stored window, pixels
    window_crops: float  # the same in crop sides
    looseness: float     # error of crops relative to BaseNet's

    @property
    def pixels_per_crop(self):
        """Pixels of the encoder's input that a crop's side covers."""
        return self.height / self.extent

    def to_pixels(self, points):
        """Crop coordinates [...,2] -> pixels of the encoder's input."""
        return (points - 0.5) * self.pixels_per_crop + points.new_tensor([self.width / 2, self.height / 2])

    @property
    def middle(self):
        """The crop of a window, before anything moves it."""
        return self.window / 2, self.window / 2, self.window / self.window_crops, 0.0

    def pixels_per_window(self, side):
        """Stored pixels per pixel of the image in which a crop has this side."""
        return self.window / (self.window_crops * side)

    def folder(self, kind):
        """Name of the data set of this framing."""
        return kind if self is BASENET else f"{kind}_{self.name}"


BASENET = Framing("basenet", 65, 65, 1.0, 112, 1.5, 1.0)
HIFINET = Framing("hifinet", 129, 109, 0.87, 192, 1.3, 0.4)
FRAMINGS = {f.name: f for f in (BASENET, HIFINET)}
