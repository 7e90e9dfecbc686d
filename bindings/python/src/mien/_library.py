"""The C library in ctypes: structs and functions of mien.h. tests/test_abi.py compares them with the header."""

from __future__ import annotations

import ctypes
import os
import sys
from ctypes import POINTER, Structure, c_char_p, c_double, c_float, c_int32, c_int64, c_size_t, c_uint32, c_uint64, c_void_p
from pathlib import Path
from typing import Any, Callable, Optional, Sequence, cast

from ._numbers import Check, check_of, with_checked_arguments

CONTROL_COUNT = 52
LANDMARK_COUNT = 175
NEUTRAL_BYTES = 448

PACKAGE = Path(__file__).resolve().parent
MODELS = PACKAGE / "models"
PROGRAM = PACKAGE / ("mien.exe" if sys.platform == "win32" else "mien")


class Struct(Structure):
    """Checks that every assigned number fits its field. Assign arrays as a whole, because elements are not checked."""

    _checks: dict[str, Check] = {}
    _array_checks: dict[str, Check] = {}

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        kinds = {field[0]: field[1] for field in cls._fields_}
        cls._checks = {name: check for name, kind in kinds.items() if (check := check_of(kind))}
        cls._array_checks = {name: check for name, kind in kinds.items() if (check := check_of(getattr(kind, "_type_", None)))}

    def __setattr__(self, name: str, value: Any) -> None:
        if name in self._checks:
            value = self._checks[name](value, name)
        elif name in self._array_checks:
            check = self._array_checks[name]
            value = tuple(check(one, name) for one in value)
        super().__setattr__(name, value)


class Image(Struct):
    _fields_ = [
        ("struct_size", c_uint32),
        ("format", c_int32),
        ("width", c_int32),
        ("height", c_int32),
        ("planes", c_void_p * 3),
        ("row_stride_bytes", c_int32 * 3),
        ("chroma_pixel_stride_bytes", c_int32),
        ("rotation", c_int32),
        ("mirrored", c_int32),
        ("full_range", c_int32),
        ("focal_length_px", c_float),
        ("principal_x", c_float),
        ("principal_y", c_float),
        ("yuv_matrix", c_int32),
        ("region", c_int32 * 4),
        ("pixel_aspect", c_float),
        ("reserved", c_uint32 * 2),
    ]


class Audio(Struct):
    _fields_ = [
        ("struct_size", c_uint32),
        ("format", c_int32),
        ("sample_rate", c_int32),
        ("channels", c_int32),
        ("planar", c_int32),
        ("frames", c_size_t),
        ("samples", c_void_p * 8),
        ("reserved", c_uint32 * 8),
    ]


class Allocator(Struct):
    _fields_ = [("allocate", c_void_p), ("release", c_void_p), ("user", c_void_p)]


class ErrorDetail(Struct):
    _fields_ = [
        ("struct_size", c_uint32),
        ("status", c_int32),
        ("known", c_uint32),
        ("file", c_int32),
        ("network", c_int32),
        ("layer", c_int32),
        ("field", c_char_p),
        ("offset", c_uint64),
        ("got", c_double),
        ("expected_min", c_double),
        ("expected_max", c_double),
        ("name", ctypes.c_char * 64),
        ("reserved", c_uint32 * 8),
    ]


class WeightsConfig(Struct):
    _fields_ = [
        ("struct_size", c_uint32),
        ("copy", c_int32),
        ("files", c_void_p * 8),
        ("file_bytes", c_size_t * 8),
        ("allocator", Allocator),
        ("reserved", c_uint32 * 8),
    ]


class TrackerConfig(Struct):
    _fields_ = [
        ("struct_size", c_uint32),
        ("cpu_mask", c_uint32),
        ("weights", c_void_p),
        ("allocator", Allocator),
        ("clock_ns", c_void_p),
        ("clock_user", c_void_p),
        ("lod", c_int32),
        ("max_lod", c_int32),
        ("horizontal_fov", c_float),
        ("accept_probability", c_float),
        ("lose_probability", c_float),
        ("lose_after_frames", c_int32),
        ("proposal_size", c_int32),
        ("proposal_threshold", c_float),
        ("refine_threshold", c_float),
        ("search_interval", c_int32),
        ("budget_ms", c_float),
        ("smoothing", c_int32),
        ("max_faces", c_int32),
        ("audio", c_int32),
        ("voice_attack_ms", c_float),
        ("voice_release_ms", c_float),
        ("audio_queue_samples", c_int32),
        ("voice_strength", c_float),
        ("reserved", c_uint32 * 8),
    ]


class TrackerResult(Struct):
    _fields_ = [
        ("struct_size", c_uint32),
        ("status", c_int32),
        ("pts_ns", c_int64),
        ("supported_controls", c_uint64),
        ("face_probability", c_float),
        ("voice_activity", c_float),
        ("lod", c_int32),
        ("flags", c_uint32),
        ("box", c_float * 4),
        ("rotation", c_float * 4),
        ("pitch", c_float),
        ("yaw", c_float),
        ("roll", c_float),
        ("translation", c_float * 3),
        ("controls", c_float * CONTROL_COUNT),
        ("landmarks", c_float * (2 * LANDMARK_COUNT)),
        ("frames", c_uint64),
        ("face_frames", c_uint64),
        ("proposal_runs", c_uint64),
        ("encoder_runs", c_uint64),
        ("stage_ns", c_uint64 * 16),
        ("face_id", c_uint32),
        ("reserved", c_uint32 * 15),
    ]


class NetworkShape(Struct):
    _fields_ = [("height", c_int32), ("width", c_int32), ("channels", c_int32)]


class NetworkConfig(Struct):
    _fields_ = [
        ("struct_size", c_uint32),
        ("cpu_mask", c_uint32),
        ("weights", c_void_p),
        ("name", c_char_p),
        ("height", c_int32),
        ("width", c_int32),
        ("allocator", Allocator),
        ("reserved", c_uint32 * 8),
    ]


class NetworkInfo(Struct):
    _fields_ = [
        ("struct_size", c_uint32),
        ("file", c_int32),
        ("name", ctypes.c_char * 64),
        ("input", NetworkShape),
        ("any_size", c_int32),
        ("layers", c_int32),
        ("outputs", c_int32),
        ("parameters", c_uint64),
        ("macs", c_uint64),
        ("weight_bytes", c_uint64),
        ("session_bytes", c_uint64),
        ("arena_bytes", c_uint64),
        ("reserved", c_uint32 * 8),
    ]


class LayerInfo(Struct):
    _fields_ = [
        ("struct_size", c_uint32),
        ("input", c_int32),
        ("second_input", c_int32),
        ("output", NetworkShape),
        ("op", c_char_p),
        ("activation", c_char_p),
        ("kernel", c_int32 * 2),
        ("stride", c_int32 * 2),
        ("padding", c_int32 * 4),
        ("first_channel", c_int32),
        ("input_bound", c_float),
        ("parameters", c_uint64),
        ("macs", c_uint64),
        ("reserved", c_uint32 * 8),
    ]


class MetadataInfo(Struct):
    _fields_ = [
        ("struct_size", c_uint32),
        ("file", c_int32),
        ("key", ctypes.c_char * 64),
        ("value", c_void_p),
        ("value_bytes", c_size_t),
        ("reserved", c_uint32 * 8),
    ]


class ConstantInfo(Struct):
    _fields_ = [
        ("struct_size", c_uint32),
        ("file", c_int32),
        ("name", ctypes.c_char * 64),
        ("type", c_char_p),
        ("rank", c_int32),
        ("dims", c_uint32 * 4),
        ("reserved", c_uint32 * 8),
    ]


STRUCTS = {
    "mien_error_detail": ErrorDetail,
    "mien_weights_config": WeightsConfig,
    "mien_network_info": NetworkInfo,
    "mien_layer_info": LayerInfo,
    "mien_metadata_info": MetadataInfo,
    "mien_constant_info": ConstantInfo,
    "mien_image": Image,
    "mien_audio": Audio,
    "mien_allocator": Allocator,
    "mien_tracker_config": TrackerConfig,
    "mien_result": TrackerResult,
    "mien_shape": NetworkShape,
    "mien_network_config": NetworkConfig,
}

Status = c_int32
FUNCTIONS: dict[str, tuple[Any, Sequence[Any]]] = {
    "mien_status_string": (c_char_p, [Status]),
    "mien_version": (c_char_p, []),
    "mien_control_name": (c_char_p, [c_int32]),
    "mien_landmark_group_name": (c_char_p, [c_int32]),
    "mien_landmark_group_range": (c_int32, [c_int32, POINTER(c_int32)]),
    "mien_vocabulary_size": (c_int32, [c_int32]),
    "mien_vocabulary_name": (c_char_p, [c_int32, c_int32]),
    "mien_vocabulary_values": (Status, [c_int32, c_void_p, c_void_p, c_int32]),
    "mien_vocabulary_supported": (c_uint64, [c_int32, c_uint64]),
    "mien_image_default": (None, [POINTER(Image)]),
    "mien_audio_default": (None, [POINTER(Audio)]),
    "mien_tracker_config_default": (None, [POINTER(TrackerConfig)]),
    "mien_error_detail_default": (None, [POINTER(ErrorDetail)]),
    "mien_error_message": (c_size_t, [POINTER(ErrorDetail), c_void_p, c_size_t]),
    "mien_weights_config_default": (None, [POINTER(WeightsConfig)]),
    "mien_weights_create": (Status, [POINTER(WeightsConfig), POINTER(c_void_p), POINTER(ErrorDetail)]),
    "mien_weights_destroy": (None, [c_void_p]),
    "mien_tracker_create": (Status, [POINTER(TrackerConfig), POINTER(c_void_p), POINTER(ErrorDetail)]),
    "mien_tracker_destroy": (None, [c_void_p]),
    "mien_tracker_reset": (Status, [c_void_p]),
    "mien_tracker_set_lod": (Status, [c_void_p, c_int32]),
    "mien_tracker_push_video": (Status, [c_void_p, POINTER(Image), c_int64]),
    "mien_tracker_advance": (Status, [c_void_p, c_int64]),
    "mien_tracker_push_audio": (Status, [c_void_p, POINTER(Audio), c_int64]),
    "mien_tracker_queue_audio": (Status, [c_void_p, POINTER(Audio), c_int64]),
    "mien_tracker_set_audio_offset": (Status, [c_void_p, c_int64]),
    "mien_tracker_set_mix": (Status, [c_void_p, c_int32, c_float, c_float]),
    "mien_tracker_get_result": (Status, [c_void_p, POINTER(TrackerResult)]),
    "mien_tracker_face_count": (c_int32, [c_void_p]),
    "mien_tracker_get_face": (Status, [c_void_p, c_int32, POINTER(TrackerResult)]),
    "mien_tracker_capture_neutral": (Status, [c_void_p]),
    "mien_tracker_save_neutral": (Status, [c_void_p, c_void_p, c_size_t, POINTER(c_uint32)]),
    "mien_tracker_load_neutral": (Status, [c_void_p, c_char_p, c_size_t]),
    "mien_network_config_default": (None, [POINTER(NetworkConfig)]),
    "mien_network_create": (Status, [POINTER(NetworkConfig), POINTER(c_void_p), POINTER(ErrorDetail)]),
    "mien_network_destroy": (None, [c_void_p]),
    "mien_network_input": (c_void_p, [c_void_p, POINTER(NetworkShape)]),
    "mien_network_run": (Status, [c_void_p]),
    "mien_network_output_count": (c_int32, [c_void_p]),
    "mien_network_output": (c_void_p, [c_void_p, c_int32, POINTER(NetworkShape)]),
    "mien_network_reset": (None, [c_void_p]),
}


def _path() -> Path:
    """The library of this package, or the one that MIEN_LIBRARY names."""
    name = {"win32": "libmien.dll", "darwin": "libmien.dylib"}.get(sys.platform, "libmien.so")
    return Path(os.environ.get("MIEN_LIBRARY", PACKAGE / name))


def _load() -> ctypes.CDLL:
    library = ctypes.CDLL(str(_path()))
    for name, (result, arguments) in FUNCTIONS.items():
        function = getattr(library, name)
        function.restype, function.argtypes = result, arguments
    return library


LIBRARY = _load()
_CALLS = {name: with_checked_arguments(getattr(LIBRARY, name), name, arguments) for name, (_, arguments) in FUNCTIONS.items()}


def function(name: str) -> Callable[..., Any]:
    return _CALLS[name]


def text(name: str, *arguments: int) -> Optional[str]:
    """The result of a function that returns a C string."""
    answer = cast(Optional[bytes], function(name)(*arguments))
    return None if answer is None else answer.decode("ascii")


def version() -> str:
    return text("mien_version") or ""
