"""Trackers: images and audio in, results out."""

from __future__ import annotations

import ctypes
from ctypes import byref, c_uint32, c_void_p
from typing import Any, Literal, Optional, Union

import numpy as np
import numpy.typing as npt

from ._handle import Handle
from ._library import MODELS, NEUTRAL_BYTES, Audio, Image, TrackerConfig, TrackerResult, function
from ._numbers import nanoseconds, unit_fraction
from .errors import ImageRotationError, UnsupportedLodError, check, check_detail, new_detail
from .result import Result
from .vocabulary import CONTROL_NUMBERS
from .weights import Model, Weights, opened

Frame = npt.NDArray[np.uint8]
Samples = Union[npt.NDArray[np.float32], npt.NDArray[np.int16]]
Color = Literal["bgr", "rgb", "nv12", "nv21", "i420"]
Lod = Literal["auto", 1, 2, 3, 4]

# mien_image_format by color and bytes per pixel.
_PACKED = {("gray", 1): 0, ("rgb", 3): 1, ("bgr", 3): 2, ("rgb", 4): 3, ("bgr", 4): 4}
_YUV = {"nv12": 5, "nv21": 6, "i420": 7}
_COLORS = ("bgr", "rgb", *_YUV)


class Tracker(Handle):
    """Tracks faces in a stream of images and audio. One thread at a time may use it, except for queue_audio.

    lod: level of detail, 1 (fastest) to 4 (most accurate), or "auto": the highest within budget_ms per frame.
    budget_ms: average time budget of a frame with a face for "auto", ms, 0.01 to 1e6.
    max_faces: 1..8. sound: whether to use audio. smoothing: smooths small changes of controls, landmarks and pose.
    horizontal_fov: horizontal field of view of the upright image, radians, 0.01 to 3.1; default 60 degrees.
    audio_queue_samples: capacity of the audio queue (queue_audio), in samples of one channel, 0 to 2^22; 0: no queue.
    voice_strength: factor of the controls predicted from audio, 0 to 4.
    models: other weights than the package's own: Weights, which trackers may share, or a folder or bundle.
    """

    _kind = "tracker"

    def __init__(
        self,
        lod: Lod = "auto",
        max_faces: int = 1,
        *,
        sound: bool = True,
        smoothing: bool = True,
        budget_ms: float = 10.0,
        horizontal_fov: Optional[float] = None,
        audio_queue_samples: int = 0,
        voice_strength: float = 1.0,
        models: Union[Model, Weights, None] = None,
    ) -> None:
        super().__init__()
        config = TrackerConfig()
        function("mien_tracker_config_default")(byref(config))
        self._weights = opened(MODELS if models is None else models)  # kept: the files must outlive the tracker
        config.weights = self._weights._open()
        config.lod = level(lod)
        config.max_lod = 1 if lod == 1 else 4
        config.audio = int(sound)
        config.max_faces = max_faces
        config.smoothing = int(smoothing)
        config.budget_ms = budget_ms
        config.audio_queue_samples = audio_queue_samples
        config.voice_strength = voice_strength
        if horizontal_fov is not None:
            config.horizontal_fov = horizontal_fov
        if lod == "auto":  # needs a clock to measure frames
            self._clock = _CLOCK
            config.clock_ns = ctypes.cast(_CLOCK, c_void_p)
        detail = new_detail()
        check_detail(function("mien_tracker_create")(byref(config), byref(self._handle), byref(detail)), detail, self._weights.names)
        self._push_video = function("mien_tracker_push_video")
        self._get_result = function("mien_tracker_get_result")
        self._facts: tuple[Any, ...] = ()  # of the images described by self._image
        self._image = Image()
        function("mien_image_default")(byref(self._image))

    def track(
        self,
        frame: Frame,
        time_s: float,
        *,
        color: Color = "bgr",
        rotation: Literal[0, 90, 180, 270] = 0,
        mirrored: bool = False,
        full_range: bool = True,
        bt709: bool = False,
        region: Optional[tuple[int, int, int, int]] = None,
        focal_length_px: float = 0.0,
        principal_point: tuple[float, float] = (0.0, 0.0),
        pixel_aspect: float = 1.0,
    ) -> Result:
        """Tracks one image and returns the result of the face with the lowest id.

        frame: uint8, [height, width] grey, [height, width, 3 or 4] in the order `color` ("bgr" or "rgb"), or, in
            OpenCV's layout of YUV, [height * 3 / 2, width] of "nv12", "nv21" or "i420". Read without a copy. Rows may have
            gaps (a part of a larger image) or be bottom-up (frame[::-1]); pixels of a row must be contiguous.
        time_s: timestamp of the image in seconds, on any clock.
        rotation: clockwise rotation to upright, degrees. mirrored: the image mirrors the scene (selfie camera).
        full_range: grey and YUV: luma 0..255, otherwise 16..235. bt709: YUV uses BT.709, otherwise BT.601.
        focal_length_px: pixels of the upright image; 0: unknown, horizontal_fov applies.
        principal_point: x, y in pixels of the upright image; 0, 0: the centre.
        region: x, y, width, height in pixels of the frame; nothing outside it is read.
        pixel_aspect: width of a pixel / its height, 0.1 to 10; results are in square pixels: the upright image keeps its height.
        """
        image = self._image
        _describe(image, frame, color)
        place = _NOWHERE if region is None else tuple(region)
        facts = (rotation, mirrored, full_range, bt709, place, focal_length_px, *principal_point, pixel_aspect)
        if facts != self._facts:  # most frames have equal facts, and comparing is faster than checking
            self._facts = ()
            image.rotation = rotation
            if rotation not in (0, 90, 180, 270):
                raise ImageRotationError(f"rotation: unsupported angle (got {rotation!r}, expected 0, 90, 180 or 270)")
            image.mirrored = bool(mirrored)
            image.full_range = bool(full_range)
            image.yuv_matrix = bool(bt709)
            image.region, image.focal_length_px, image.principal_x, image.principal_y, image.pixel_aspect = facts[4:]
            self._facts = facts
        status = self._push_video(self._open(), image, nanoseconds(time_s))
        if status != 0:
            check(status)
        return self.result()

    def advance(self, time_s: float) -> Result:
        """Outputs a frame without an image, for audio without video. time_s: seconds, on the clock of the images."""
        check(function("mien_tracker_advance")(self._open(), nanoseconds(time_s)))
        return self.result()

    def result(self) -> Result:
        """The result of the latest frame, of the face with the lowest id."""
        raw = TrackerResult(_RESULT_BYTES)
        status = self._get_result(self._open(), raw)
        if status != 0:
            check(status)
        return Result(raw)

    def faces(self) -> list[Result]:
        """The results of all known faces on the latest frame."""
        count = function("mien_tracker_face_count")(self._open())
        return [self._face(i) for i in range(count)]

    def _face(self, index: int) -> Result:
        raw = TrackerResult(_RESULT_BYTES)
        check(function("mien_tracker_get_face")(self._open(), index, byref(raw)))
        return Result(raw)

    def push_audio(self, samples: Samples, time_s: float, sample_rate: int = 48000) -> None:
        """Processes float32 (-1..1) or int16 samples, [n] or [n, channels of 1..8]; time_s is the timestamp of the first, in seconds.

        sample_rate: 8000..192000 Hz.
        """
        check(function("mien_tracker_push_audio")(self._open(), byref(_audio(samples, sample_rate)), nanoseconds(time_s)))

    def queue_audio(self, samples: Samples, time_s: float, sample_rate: int = 48000) -> None:
        """Queues audio, as for push_audio, from another thread for the next frame; AudioQueueFullError if the queue is full."""
        check(function("mien_tracker_queue_audio")(self._open(), byref(_audio(samples, sample_rate)), nanoseconds(time_s)))

    def set_audio_offset(self, seconds: float) -> None:
        """Delays audio relative to the images by `seconds`, for audio pushed from now on."""
        check(function("mien_tracker_set_audio_offset")(self._open(), nanoseconds(seconds, "seconds")))

    def set_mix(self, control: str, audio: float, video: float) -> None:
        """Weights of audio and video for a control during speech, each 0..1."""
        if control not in CONTROL_NUMBERS:
            raise ValueError(f"control: unknown (got {control!r}, expected one of mien.CONTROL_NAMES)")
        check(function("mien_tracker_set_mix")(self._open(), CONTROL_NUMBERS[control], unit_fraction(audio, "audio"), unit_fraction(video, "video")))

    def set_lod(self, lod: Lod) -> None:
        """Sets the level of detail, 1..4 or "auto", from the next image on."""
        check(function("mien_tracker_set_lod")(self._open(), level(lod)))

    def calibrate(self) -> None:
        """Captures a person's neutral controls over the next 55 frames with a face, and removes them from later frames."""
        check(function("mien_tracker_capture_neutral")(self._open()))

    def save_neutral(self) -> bytes:
        """The captured neutral values as a file of 448 bytes."""
        data = (ctypes.c_char * NEUTRAL_BYTES)()
        captured = c_uint32()
        check(function("mien_tracker_save_neutral")(self._open(), data, NEUTRAL_BYTES, byref(captured)))
        return bytes(data)

    def load_neutral(self, data: bytes) -> None:
        """Restores saved neutral values."""
        check(function("mien_tracker_load_neutral")(self._open(), data, len(data)))

    def reset(self) -> None:
        """Resets the tracker to its state after creation."""
        check(function("mien_tracker_reset")(self._open()))


_NOWHERE = (0, 0, 0, 0)
_RESULT_BYTES = ctypes.sizeof(TrackerResult)
_ClockFunction = ctypes.CFUNCTYPE(ctypes.c_uint64, c_void_p)


def _monotonic_ns(_: Any) -> int:
    import time

    return time.monotonic_ns()


_CLOCK = _ClockFunction(_monotonic_ns)


def level(lod: Lod) -> int:
    if isinstance(lod, str) and lod != "auto":
        raise UnsupportedLodError(f"lod: unknown level (got {lod!r}, expected 'auto' or 1 to 4)")
    return 0 if lod == "auto" else lod


def _describe(image: Image, frame: Frame, color: str) -> None:
    """The address and layout of the frame's pixels."""
    if not isinstance(frame, np.ndarray) or frame.dtype != np.uint8:
        kind = f"an array of {frame.dtype}" if isinstance(frame, np.ndarray) else f"a {type(frame).__name__}"
        raise TypeError(f"frame: wrong type (got {kind}, expected a numpy array of uint8)")
    if color not in _COLORS:
        raise ValueError(f"color: unknown (got {color!r}, expected one of {', '.join(_COLORS)})")
    if color in _YUV:
        _describe_yuv(image, frame, color)
        return
    strides = frame.strides
    if frame.ndim == 2:
        channels, form = 1, _PACKED["gray", 1]
    elif frame.ndim == 3 and (color, frame.shape[2]) in _PACKED:
        channels = frame.shape[2]
        form = _PACKED[color, channels]
        if frame.size > 0 and strides[2] != 1:
            raise ValueError("frame: bytes of a pixel not contiguous; pass numpy.ascontiguousarray(frame)")
    else:
        raise ValueError(f"frame: unsupported shape (got {frame.shape} with color={color!r}, expected one of Tracker.track's docstring)")
    if frame.size > 0 and frame.shape[1] > 1 and strides[1] != channels:
        raise ValueError("frame: pixels of a row not contiguous; pass numpy.ascontiguousarray(frame)")
    image.format = form
    image.height, image.width = frame.shape[0], frame.shape[1]
    image.planes[0] = frame.__array_interface__["data"][0]
    # The stride of a single row is arbitrary in NumPy.
    image.row_stride_bytes = (strides[0] if image.height > 1 else image.width * channels, 0, 0)


def _describe_yuv(image: Image, frame: Frame, color: str) -> None:
    if frame.ndim != 2 or not frame.flags.c_contiguous or frame.shape[0] % 3 or frame.shape[1] % 2:
        raise ValueError(f"frame: wrong shape for {color} (got {frame.shape}, expected contiguous [height * 3 / 2, width], even sizes)")
    height, width = frame.shape[0] * 2 // 3, frame.shape[1]
    first = frame.__array_interface__["data"][0]
    chroma = first + height * width
    image.format = _YUV[color]
    image.height, image.width = height, width
    image.chroma_pixel_stride_bytes = 0
    image.planes[:] = (first, chroma, chroma + (height // 2) * (width // 2) if color == "i420" else None)
    image.row_stride_bytes = (width, width // 2, width // 2) if color == "i420" else (width, width, 0)


def _audio(samples: Samples, sample_rate: int) -> Audio:
    formats = {np.dtype(np.float32): 0, np.dtype(np.int16): 1}
    if not isinstance(samples, np.ndarray) or samples.dtype not in formats:
        raise TypeError("samples: wrong type (expected a numpy array of float32 or int16)")
    if samples.ndim not in (1, 2):
        raise ValueError(f"samples: wrong shape (got {samples.shape}, expected [n] or [n, channels])")
    channels = 1 if samples.ndim == 1 else samples.shape[1]
    audio = Audio()
    function("mien_audio_default")(byref(audio))
    audio.format = formats[samples.dtype]
    audio.sample_rate = sample_rate
    audio.channels = channels
    audio.frames = samples.shape[0]
    if samples.flags.c_contiguous:
        audio.samples[0] = samples.ctypes.data
    elif samples.flags.f_contiguous and channels <= 8:
        audio.planar = 1
        for i in range(channels):
            audio.samples[i] = samples.ctypes.data + i * samples.strides[1]
    else:
        raise ValueError("samples: not contiguous; pass numpy.ascontiguousarray(samples)")
    return audio
