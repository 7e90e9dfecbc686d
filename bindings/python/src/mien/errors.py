"""One exception for each status of the C library; all are MienError. Their messages are those of the library."""

from __future__ import annotations

import ctypes
from ctypes import byref
from typing import Iterator, Sequence

from ._library import ErrorDetail, function, text


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


class WeightsIncompleteError(MienError, ValueError):
    status = -25


class WeightsShapeError(MienError, ValueError):
    status = -26


class WeightsValueError(MienError, ValueError):
    status = -27


class WeightsMalformedError(MienError, ValueError):
    """A weight file breaks a rule of its format."""


class WeightsTrailingBytesError(WeightsMalformedError):
    status = -100


class WeightsByteOrderError(WeightsMalformedError):
    status = -101


class WeightsLimitError(WeightsMalformedError):
    status = -102


class WeightsReservedError(WeightsMalformedError):
    status = -103


class WeightsGapError(WeightsMalformedError):
    status = -104


class WeightsPaddingError(WeightsMalformedError):
    status = -105


class WeightsNameError(WeightsMalformedError):
    status = -106


class WeightsDuplicateNameError(WeightsMalformedError):
    status = -107


class WeightsMetadataError(WeightsMalformedError):
    status = -108


class WeightsTensorTypeError(WeightsMalformedError):
    status = -110


class WeightsTensorDimsError(WeightsMalformedError):
    status = -111


class WeightsTensorBytesError(WeightsMalformedError):
    status = -112


class WeightsTensorValueError(WeightsMalformedError):
    status = -113


class WeightsTensorUnusedError(WeightsMalformedError):
    status = -114


class WeightsNetworkError(WeightsMalformedError):
    status = -120


class WeightsLayerOpError(WeightsMalformedError):
    status = -121


class WeightsLayerActivationError(WeightsMalformedError):
    status = -122


class WeightsLayerInputError(WeightsMalformedError):
    status = -123


class WeightsLayerShapeError(WeightsMalformedError):
    status = -124


class WeightsLayerWindowError(WeightsMalformedError):
    status = -125


class WeightsLayerTensorsError(WeightsMalformedError):
    status = -126


class WeightsPackedSizeError(WeightsMalformedError):
    status = -130


class WeightsPackedBlockError(WeightsMalformedError):
    status = -131


class WeightsPackedTableError(WeightsMalformedError):
    status = -132


class WeightsPackedStateError(WeightsMalformedError):
    status = -133


class WeightsPackedTruncatedError(WeightsMalformedError):
    status = -134


class WeightsPackedTrailingError(WeightsMalformedError):
    status = -135


class UnsupportedCpuError(MienError):
    status = -40


class UnsupportedLayerError(MienError):
    status = -41


class InternalError(MienError, RuntimeError):
    status = -42


class LeftOutError(MienError):
    status = -43


class UnsupportedLayoutError(MienError):
    status = -44


class TooLargeError(MienError, ValueError):
    status = -45


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


def _kinds(base: type[MienError]) -> Iterator[type[MienError]]:
    for kind in base.__subclasses__():
        yield kind
        yield from _kinds(kind)


BY_STATUS: dict[int, type[MienError]] = {kind.status: kind for kind in _kinds(MienError) if kind.status != 0}


def check(status: int) -> None:
    """Raises the exception of a status unless it is MIEN_OK."""
    if status != 0:
        raise BY_STATUS[status]() if status in BY_STATUS else MienError(status=status)


def check_detail(status: int, detail: ErrorDetail, sources: Sequence[str] = ()) -> None:
    """Like check, with the detail's message. `sources` name the weight files."""
    if status == 0:
        return
    line = (ctypes.c_char * 256)()
    function("mien_error_message")(byref(detail), line, len(line))
    message = line.value.decode("ascii", "replace")
    if 0 <= detail.file < len(sources):
        message = f"{sources[detail.file]}: {message}"
    raise BY_STATUS.get(status, MienError)(message, status)


def new_detail() -> ErrorDetail:
    detail = ErrorDetail()
    function("mien_error_detail_default")(byref(detail))
    return detail
