"""One exception for each status of the C library; all are MienError. Their messages are those of the library."""

from __future__ import annotations

from ._library import text


class MienError(Exception):
    """A status of the library that is not MIEN_OK; `status` is its number."""

    status = 0

    def __init__(self, message: str = "", status: int | None = None) -> None:
        self.status = type(self).status if status is None else status
        super().__init__(message or text("mien_status_string", self.status))


class NullArgumentError(MienError, ValueError):
    status = -1


class StructSizeError(MienError, ValueError):
    status = -2


class OutOfRangeError(MienError, ValueError):
    status = -3


class AlignmentError(MienError, ValueError):
    status = -4


class MemoryTooSmallError(MienError, ValueError):
    status = -5


class OutOfMemoryError(MienError, MemoryError):
    status = -6


class UnsupportedLodError(MienError, ValueError):
    status = -7


class SeveralFacesError(MienError):
    status = -8


class NoAudionetError(MienError):
    status = -9


class WeightsNotMienError(MienError, ValueError):
    status = -20


class WeightsVersionError(MienError, ValueError):
    status = -21


class WeightsTruncatedError(MienError, ValueError):
    status = -22


class WeightsChecksumError(MienError, ValueError):
    status = -23


class WeightsMalformedError(MienError, ValueError):
    status = -24


class WeightsIncompleteError(MienError, ValueError):
    status = -25


class WeightsShapeError(MienError, ValueError):
    status = -26


class WeightsNotPackedError(MienError, ValueError):
    status = -27


class UnsupportedCpuError(MienError):
    status = -40


class UnsupportedLayerError(MienError):
    status = -41


class InternalError(MienError, RuntimeError):
    status = -42


class LeftOutError(MienError):
    status = -43


class ImageFormatError(MienError, ValueError):
    status = -60


class ImageSizeError(MienError, ValueError):
    status = -61


class ImageStrideError(MienError, ValueError):
    status = -62


class ImagePlaneError(MienError, ValueError):
    status = -63


class ImageRotationError(MienError, ValueError):
    status = -64


class ImageCameraError(MienError, ValueError):
    status = -65


class AudioFormatError(MienError, ValueError):
    status = -66


class AudioRateError(MienError, ValueError):
    status = -67


class AudioChannelsError(MienError, ValueError):
    status = -68


class AudioSamplesError(MienError, ValueError):
    status = -69


class ImageRegionError(MienError, ValueError):
    status = -70


class AudioQueueFullError(MienError, BufferError):
    status = -71


class NeutralFormatError(MienError, ValueError):
    status = -80


class NeutralVersionError(MienError, ValueError):
    status = -81


class NeutralDamagedError(MienError, ValueError):
    status = -82


BY_STATUS: dict[int, type[MienError]] = {error.status: error for error in MienError.__subclasses__()}


def check(status: int) -> None:
    """Raises the exception of a status unless it is MIEN_OK."""
    if status != 0:
        raise BY_STATUS[status]() if status in BY_STATUS else MienError(status=status)
