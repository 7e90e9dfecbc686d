"""No arguments in Python cause invalid reads or frees in C."""
import copy
import os
import pickle

import mien
import numpy as np
import pytest
from mien import _library, errors
from mien.tracker import Tracker

PICTURE = np.zeros((48, 64, 3), np.uint8)


@pytest.fixture
def tracker():
    with Tracker(1) as made:
        yield made


@pytest.fixture
def network():
    with mien.Network(_library.MODELS / "basenet.mien", "encoder") as made:
        yield made


@pytest.mark.parametrize("stride", [2**31, 2**32, 2**32 + 192, -(2**31) - 1, 2**62])
def test_row_strides_out_of_range(tracker, stride):
    frame = np.lib.stride_tricks.as_strided(PICTURE, (2, 64, 3), (stride, 3, 1))
    with pytest.raises(errors.OutOfRangeError, match="row_stride_bytes: number out of range"):
        tracker.track(frame, 0)


def test_the_stride_of_a_single_row_does_not_matter(tracker):
    frame = np.lib.stride_tricks.as_strided(PICTURE, (1, 64, 3), (2**40, 3, 1))
    assert not tracker.track(frame, 0).has_face


@pytest.mark.parametrize("time_s", [1e10, -1e10, 2.0**63, float("inf"), float("-inf"), float("nan")])
def test_invalid_times_are_rejected(tracker, time_s):
    samples = np.zeros(160, np.float32)
    for call in (lambda: tracker.track(PICTURE, time_s), lambda: tracker.advance(time_s), lambda: tracker.push_audio(samples, time_s),
                 lambda: tracker.queue_audio(samples, time_s), lambda: tracker.set_audio_offset(time_s)):
        with pytest.raises(errors.OutOfRangeError, match=r"(time_s|seconds): number out of range \(got .*, expected -922"):
            call()
    tracker.advance(9e9)  # 285 years


@pytest.mark.parametrize("options", [
    {"max_faces": 2**32 + 1}, {"lod": 2**32 + 1}, {"audio_queue_samples": 2**32 + 16000}, {"max_faces": -(2**32) + 1}, {"budget_ms": 1e39}])
def test_options_out_of_range(options):
    with pytest.raises(errors.OutOfRangeError, match=f"{next(iter(options))}: number out of range"):
        Tracker(**options)


@pytest.mark.parametrize("options", [
    {"rotation": 2**32}, {"region": (0, 0, 2**32 + 64, 48)}, {"region": (-(2**32), 0, 64, 48)}, {"focal_length_px": 1e39},
    {"principal_point": (1e39, 0.0)}])
def test_image_fields_out_of_range(tracker, options):
    with pytest.raises(errors.OutOfRangeError, match="number out of range"):
        tracker.track(PICTURE, 0, **options)


def test_arguments_out_of_range(tracker):
    with pytest.raises(errors.OutOfRangeError, match="argument 2 of mien_tracker_set_lod"):
        tracker.set_lod(2**32 + 1)
    with pytest.raises(errors.OutOfRangeError, match="sample_rate"):
        tracker.push_audio(np.zeros(160, np.float32), 0, 2**32 + 16000)
    with pytest.raises(errors.OutOfRangeError, match="height"):
        mien.Network(_library.MODELS / "basenet.mien", "encoder", (2**32 + 65, 65))
    with pytest.raises(TypeError):
        tracker.set_lod(1.5)


def test_numpy_integers_are_accepted(tracker):
    tracker.set_lod(np.int64(1))
    assert not tracker.track(PICTURE, np.float32(0), rotation=np.int64(90), mirrored=np.bool_(True), region=np.array([0, 0, 64, 48])).has_face


def test_every_number_of_every_struct_is_checked():
    for name, struct in _library.STRUCTS.items():
        made = struct()
        for field, kind in struct._fields_:
            if kind in (_library.c_int32, _library.c_uint32, _library.c_int64, _library.c_uint64, _library.c_size_t):
                for number in (2**64, -(2**63) - 1):
                    with pytest.raises(errors.OutOfRangeError, match=field):
                        setattr(made, field, number)


@pytest.mark.parametrize("kind", ["tracker", "network"])
def test_c_objects_cannot_be_copied(request, kind):
    made = request.getfixturevalue(kind)
    for double in (copy.copy, copy.deepcopy, pickle.dumps):
        with pytest.raises(TypeError, match=f"a {kind} cannot be copied or pickled"):
            double(made)


def in_child(body):
    """The exit status of a forked child that runs `body`: 0 without an exception."""
    child = os.fork()
    if child == 0:
        try:
            body()
        except BaseException:
            os._exit(1)
        os._exit(0)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


@pytest.mark.skipif(not hasattr(os, "fork"), reason="the system has no fork")
def test_a_fork_is_an_error_in_the_child_only(tracker, network):
    def uses():
        for call in (lambda: tracker.track(PICTURE, 0), tracker.result, tracker.reset, tracker.faces,
                     lambda: network.run(np.zeros(network.input_shape, np.float32)), network.reset):
            with pytest.raises(mien.MienError, match="created before a fork"):
                call()
        tracker.close()
        network.close()
        with Tracker(1, sound=False) as own:
            own.track(PICTURE, 0)

    assert in_child(uses) == 0
    tracker.track(PICTURE, 0)
    network.run(np.zeros(network.input_shape, np.float32))


def test_results_may_be_copied(tracker):
    result = tracker.track(PICTURE, 1)
    assert copy.deepcopy(result).time_s == 1


def test_controls_cannot_be_replaced(tracker):
    controls = tracker.track(PICTURE, 0).controls
    with pytest.raises(AttributeError):
        controls.array = controls.array[:3]
    controls.array[:] = 1
    assert controls.jawOpen == 0
