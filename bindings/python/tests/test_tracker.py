import copy
import ctypes
import json
import threading

import mien
import numpy as np
import pytest
from mien import errors
from conftest import REPOSITORY
from mien._library import MODELS
from mien.tracker import Tracker

RATE = 30


def tracked(pictures, lod=1, **options):
    with mien.Tracker(lod, sound=False) as tracker:
        return [tracker.track(picture, i / RATE, **options) for i, picture in enumerate(pictures)]


@pytest.fixture(scope="module")
def bgr(frames):
    return tracked(frames[:20])


def test_a_face_is_tracked(bgr, frames):
    result = bgr[-1]
    assert result.status is mien.FaceStatus.TRACKING and result.has_face
    assert result.face_id == 1 and result.lod == 1
    assert result.time_s == pytest.approx(19 / RATE)
    assert result.face_probability > 0.9
    x, y, width, height = result.box
    assert 0 < x < 640 and 0 < y < 480 and width > 50 and height > 50
    assert result.landmarks.shape == (mien.LANDMARK_COUNT, 2)
    assert (result.landmarks > 0).all()
    assert np.linalg.norm(result.pose.rotation) == pytest.approx(1, abs=1e-4)
    assert abs(result.pose.yaw) < 1 and result.pose.translation[2] < 0
    assert len({tuple(r.controls.array) for r in bgr}) > 10, "it moves"


def test_controls_are_a_mapping_an_array_and_attributes(bgr):
    controls = bgr[-1].controls
    jaw = mien.Control.JAW_OPEN
    assert mien.CONTROL_NAMES[jaw] == "jawOpen" and controls["jawOpen"] == controls[jaw] == controls.array[jaw] == controls.jawOpen
    assert controls.array.dtype == np.float32 and controls.array.shape == (52,)
    assert dict(controls)["eyeBlinkLeft"] == controls["eyeBlinkLeft"]
    assert "jawOpen" in controls.supported and "eyeLookUpLeft" not in controls.supported
    assert "jawOpen" in dir(controls) and copy.copy(controls).jawOpen == controls.jawOpen
    with pytest.raises(KeyError):
        controls["nothing"]
    with pytest.raises(AttributeError, match="nothing: no such control"):
        controls.nothing


def test_controls_that_are_not_predicted(bgr):
    controls = bgr[-1].controls
    assert len(controls) == 29 and set(controls) == controls.supported
    assert list(controls) == [name for name in mien.CONTROL_NAMES if name in controls.supported]
    undriven = np.isnan(controls.array)
    assert {name for name, nan in zip(mien.CONTROL_NAMES, undriven) if not nan} == set(controls)
    assert "eyeLookUpLeft" not in controls and controls.get("eyeLookUpLeft") is None
    with pytest.raises(KeyError, match="eyeLookUpLeft: not predicted"):
        controls[mien.Control.EYE_LOOK_UP_LEFT]
    with pytest.raises(AttributeError, match="eyeLookUpLeft: not predicted"):
        controls.eyeLookUpLeft


def test_other_vocabularies(bgr):
    controls = bgr[-1].controls
    assert controls.to("arkit") == pytest.approx(dict(controls))
    assert controls.to("roblox")["JawDrop"] == pytest.approx(controls["jawOpen"])
    assert controls.to("mediapipe")["mouthPucker"] == pytest.approx(controls["mouthPucker"])
    assert "eyeLookUpLeft" not in controls.to("mediapipe") and "aa" in controls.to("vrm1") and "lookUp" not in controls.to("vrm1")
    assert [len(mien.vocabulary_names(name)) for name in mien.VOCABULARIES] == [52, 52, 50, 11, 11, 15]
    with pytest.raises(ValueError, match=r"vocabulary: unknown \(got 'klingon', expected one of arkit"):
        controls.to("klingon")


def test_landmark_names(bgr):
    group = mien.LandmarkGroup.LEFT_IRIS
    assert len(bgr[-1].landmarks_of(group)) == 5
    assert [mien.LANDMARK_NAMES[i] for i in group.landmarks] == [f"left_iris_{i}" for i in range(5)]
    points = json.loads((REPOSITORY / "models/landmarks.json").read_text())["points"]
    assert list(mien.LANDMARK_NAMES) == [point["name"] for point in points]


def test_the_head_matrix(bgr):
    pose = bgr[-1].pose
    matrix = pose.matrix
    np.testing.assert_allclose(matrix[:3, :3] @ matrix[:3, :3].T, np.eye(3), atol=1e-5)
    np.testing.assert_allclose(matrix[:, 3], [*pose.translation, 1])
    # R = Ry(yaw) Rx(pitch) Rz(roll), as docs/pose.md defines it.
    def turn(axis, angle):
        i, j = [(1, 2), (2, 0), (0, 1)][axis]
        r = np.eye(3)
        r[i, i] = r[j, j] = np.cos(angle)
        r[j, i] = np.sin(angle)
        r[i, j] = -r[j, i]
        return r
    np.testing.assert_allclose(matrix[:3, :3], turn(1, pose.yaw) @ turn(0, pose.pitch) @ turn(2, pose.roll), atol=1e-5)


def test_projection(bgr):
    pose, x, y, width, height = bgr[-1].pose, *bgr[-1].box
    column, row = pose.project([[0, 0, 0.1]], 640, 480)[0]  # the tip of the nose, roughly
    assert x < column < x + width and y < row < y + height
    origin = pose.project([[0, 0, 0]], 640, 480, 1000)[0]
    np.testing.assert_allclose(origin, [320 - 1000 * pose.translation[0] / pose.translation[2],
                                        240 + 1000 * pose.translation[1] / pose.translation[2]], rtol=1e-5)


def test_results_own_their_data(bgr):
    assert bgr[0].time_s == 0 and bgr[5].time_s == pytest.approx(5 / RATE)
    assert not np.array_equal(bgr[3].landmarks, bgr[13].landmarks)


def close(a, b, pixels, share):
    np.testing.assert_allclose(a.landmarks, b.landmarks, atol=pixels)
    np.testing.assert_allclose(a.controls.array, b.controls.array, atol=share)


def test_every_layout_gives_the_same_result(frames, bgr):
    some, last = frames[:20], bgr[-1]
    alpha = np.full((*some.shape[:3], 1), 7, np.uint8)
    close(tracked(some[..., ::-1].copy(), color="rgb")[-1], last, 1e-3, 1e-4)
    close(tracked(np.concatenate([some, alpha], -1))[-1], last, 1e-3, 1e-4)
    close(tracked(np.concatenate([some[..., ::-1], alpha], -1), color="rgb")[-1], last, 1e-3, 1e-4)
    bottom_up = some[:, ::-1].copy()
    close(tracked([picture[::-1] for picture in bottom_up])[-1], last, 0, 0)
    wide = np.zeros((len(some), 480, 700, 3), np.uint8)
    wide[:, :, 30:670] = some
    close(tracked([picture[:, 30:670] for picture in wide])[-1], last, 0, 0)
    close(tracked([np.rot90(picture).copy() for picture in some], rotation=90)[-1], last, 0.5, 0.01)
    mirrored = tracked([picture[:, ::-1].copy() for picture in some], mirrored=True)[-1]
    np.testing.assert_allclose(640 - mirrored.landmarks[:, 0], last.landmarks[:, 0], atol=0.5)


def yuv(picture, bt709=False):
    red, blue = (0.2126, 0.0722) if bt709 else (0.299, 0.114)
    b, g, r = (picture[..., i].astype(np.float64) for i in range(3))
    y = red * r + (1 - red - blue) * g + blue * b
    def chroma(difference, share):
        whole = difference / (2 - 2 * share) + 128
        return whole.reshape(240, 2, 320, 2).mean((1, 3))
    return [np.clip(np.round(plane), 0, 255).astype(np.uint8) for plane in (y, chroma(b - y, blue), chroma(r - y, red))]


@pytest.mark.parametrize("color", ["nv12", "nv21", "i420"])
@pytest.mark.parametrize("bt709", [False, True])
def test_yuv_matches_bgr_up_to_chroma(frames, bgr, color, bt709):
    def laid_out(picture):
        y, u, v = yuv(picture, bt709)
        if color == "i420":
            return np.concatenate([y, u.reshape(120, 640), v.reshape(120, 640)])
        first, second = (u, v) if color == "nv12" else (v, u)
        return np.concatenate([y, np.stack([first, second], -1).reshape(240, 640)])
    close(tracked([laid_out(p) for p in frames[:20]], color=color, bt709=bt709)[-1], bgr[-1], 1.0, 0.05)


def test_only_the_region_is_read(frames, bgr):
    x, y, width, height = (int(n) for n in bgr[-1].box)
    region = (max(x - 60, 0), max(y - 60, 0), min(width + 120, 640 - max(x - 60, 0)), min(height + 120, 480 - max(y - 60, 0)))
    inside = tracked(frames[:20], region=region)[-1]
    assert inside.has_face
    np.testing.assert_allclose(inside.landmarks, bgr[-1].landmarks, atol=4)
    assert not tracked(frames[:20], region=(0, 0, 40, 40))[-1].has_face


def test_frames_are_not_copied(frames, monkeypatch):
    tracker, seen = Tracker(1, sound=False), []
    push = tracker._push_video
    monkeypatch.setattr(tracker, "_push_video", lambda handle, image, ns: seen.append(image.planes[0]) or push(handle, image, ns))
    picture = frames[0][10:400, 20:500]
    tracker.track(picture, 0)
    assert seen == [picture.ctypes.data]


@pytest.mark.parametrize("frame, options, kind, text", [
    (np.zeros((4, 4, 3), np.float32), {}, TypeError, "got an array of float32, expected .* uint8"),
    ([[0]], {}, TypeError, "got a list"),
    (np.zeros((4, 4, 2), np.uint8), {}, ValueError, r"got \(4, 4, 2\)"),
    (np.zeros((4, 8, 3), np.uint8)[:, ::2], {}, ValueError, "pixels of a row not contiguous"),
    (np.zeros((4, 8, 3), np.uint8)[..., ::-1], {}, ValueError, "bytes of a pixel not contiguous"),
    (np.zeros((5, 8), np.uint8), {"color": "nv12"}, ValueError, "expected contiguous"),
    (np.zeros((0, 8, 3), np.uint8), {}, errors.ImageSizeError, "width, height"),
    (np.zeros((4, 8, 3), np.uint8), {"rotation": 45}, errors.ImageRotationError, r"rotation: .*got 45, expected 0, 90, 180 or 270"),
    (np.zeros((4, 8, 3), np.uint8), {"color": "rbg"}, ValueError, "color: unknown .got 'rbg', expected one of bgr, rgb, nv12, nv21, i420"),
    (np.zeros((4, 8, 3), np.uint8), {"pixel_aspect": "wide"}, TypeError, "pixel_aspect: not a number .got 'wide'"),
    (np.zeros((4, 8, 3), np.uint8), {"region": (4, 0, 8, 4)}, errors.ImageRegionError, "region of interest"),
])
def test_invalid_frames_are_rejected(frame, options, kind, text):
    with Tracker(1, sound=False) as tracker:
        with pytest.raises(kind, match=text):
            tracker.track(frame, 0, **options)
        assert tracker.result().status is mien.FaceStatus.SEARCHING


def test_levels(frames):
    for lod in (2, 3, 4):
        result = tracked(frames[:5], lod)[-1]
        assert result.lod == lod and result.has_face
    with Tracker(sound=False) as tracker:
        assert tracker.track(frames[0], 0).lod in (1, 2, 3, 4)
        tracker.set_lod(2)
        assert tracker.track(frames[1], 0.03).lod == 2
    with pytest.raises(errors.UnsupportedLodError) as caught:
        Tracker(5)
    assert caught.value.status == -7 and isinstance(caught.value, mien.MienError) and isinstance(caught.value, ValueError)


def test_several_faces(frames):
    both = np.concatenate([frames[:40], frames[:40]], axis=2)
    with mien.Tracker(1, max_faces=2, sound=False) as tracker:
        for i, picture in enumerate(both):
            tracker.track(picture, i / RATE)
        faces = tracker.faces()
    assert [face.face_id for face in faces] == [1, 2]
    assert abs(abs(faces[0].box[0] - faces[1].box[0]) - 640) < 20


def voice(seconds=2.0, rate=16000):
    """Audio similar to syllables: a buzz with varying loudness."""
    t = np.arange(int(seconds * rate)) / rate
    buzz = sum(np.sin(2 * np.pi * 120 * k * t) / k for k in range(1, 25))
    return (0.25 * buzz * np.maximum(np.sin(2 * np.pi * 4 * t), 0)).astype(np.float32)


def test_audio_moves_the_mouth_from_any_thread(clip):
    sound = voice()
    with mien.Tracker(1, audio_queue_samples=48000) as pushed, mien.Tracker(1, audio_queue_samples=48000) as queued:
        pushed.push_audio(sound, 0, 16000)
        thread = threading.Thread(target=lambda: [queued.queue_audio(sound[i:i + 1600], i / 16000, 16000) for i in range(0, 32000, 1600)])
        thread.start()
        thread.join()
        a = [pushed.advance(i / RATE) for i in range(60)]
        b = [queued.advance(i / RATE) for i in range(60)]
        np.testing.assert_array_equal([r.controls.array for r in a], [r.controls.array for r in b])
        assert max(r.voice_activity for r in a) > 0.2
        with pytest.raises(errors.AudioQueueFullError):
            queued.queue_audio(np.zeros(100000, np.float32), 0)
        pushed.set_audio_offset(0.1)
        pushed.set_mix("jawOpen", 0.0, 1.0)
        with pytest.raises(errors.OutOfRangeError):
            pushed.set_mix("jawOpen", 2.0, 1.0)


def test_audio_formats():
    sound = voice(0.5)
    stereo = np.stack([sound, sound], 1)
    runs = []
    for samples in (sound, stereo, np.asfortranarray(stereo), (sound * 32768).clip(-32768, 32767).astype(np.int16)):
        with mien.Tracker(1) as tracker:
            tracker.push_audio(samples, 0, 16000)
            runs.append([tracker.advance(i / RATE).controls.array for i in range(12)])
    np.testing.assert_array_equal(runs[0], runs[1])
    np.testing.assert_array_equal(runs[0], runs[2])
    np.testing.assert_allclose(runs[0], runs[3], atol=0.02)
    with mien.Tracker(1) as tracker:
        with pytest.raises(TypeError, match="float32 or int16"):
            tracker.push_audio(sound.astype(np.float64), 0)
        with pytest.raises(ValueError, match="not contiguous"):
            tracker.push_audio(sound[::2], 0)
        with pytest.raises(errors.AudioRateError):
            tracker.push_audio(sound, 0, 100)
    with mien.Tracker(1, sound=False) as deaf, pytest.raises(errors.NoAudionetError):
        deaf.push_audio(sound, 0)


def test_calibration(frames):
    with mien.Tracker(1, sound=False) as tracker:
        tracker.calibrate()
        capturing = [tracker.track(picture, i / RATE).is_capturing_neutral for i, picture in enumerate(list(frames) * 2)]
        assert 45 <= sum(capturing) <= 55 and not capturing[-1]
        neutral = tracker.save_neutral()
        assert len(neutral) == 448
        tracker.reset()
        tracker.load_neutral(neutral)
        assert tracker.save_neutral() == neutral
        with pytest.raises(errors.NeutralFormatError):
            tracker.load_neutral(bytes(448))
    with mien.Tracker(1, 2, sound=False) as several, pytest.raises(errors.SeveralFacesError):
        several.calibrate()


def test_reset_and_close(frames, bgr):
    tracker = mien.Tracker(1, sound=False)
    for picture in frames[30:40]:
        tracker.track(picture, 9)
    tracker.reset()
    again = [tracker.track(picture, i / RATE) for i, picture in enumerate(frames[:20])]
    np.testing.assert_array_equal(again[-1].landmarks, bgr[-1].landmarks)
    tracker.close()
    tracker.close()
    with pytest.raises(mien.MienError, match="closed"):
        tracker.track(frames[0], 0)
    assert again[-1].has_face, "a result outlives its tracker"


def test_other_weights(tmp_path):
    with pytest.raises(FileNotFoundError):
        mien.Tracker(1, models=tmp_path)
    for name in ("basenet", "proposal"):
        (tmp_path / f"{name}.mien").write_bytes(b"not a weight file" * 10)
    with pytest.raises(errors.WeightsNotMienError, match="basenet.mien: byte 0, magic: the weights are not a .mien file"):
        mien.Tracker(1, sound=False, models=tmp_path)


def test_trackers_share_weights(frames):
    with mien.Weights(MODELS) as weights:
        one, other = (mien.Tracker(1, models=weights) for _ in range(2))
    bundle = b"".join((MODELS / f"{name}.mien").read_bytes() for name in ("proposal", "basenet"))
    third = mien.Tracker(1, models=bundle)
    results = [tracker.track(frames[0], 0) for tracker in (one, other, third)]
    assert all(result.has_face for result in results)
    np.testing.assert_array_equal(results[0].landmarks, results[2].landmarks)


@pytest.mark.parametrize("options, kind, text", [
    ({"max_faces": 20}, errors.OutOfRangeError, r"max_faces: a value is out of range \(got 20, expected 1..8\)"),
    ({"max_faces": "two"}, TypeError, r"max_faces: not a whole number \(got 'two', expected"),
    ({"lod": "high"}, errors.UnsupportedLodError, r"lod: unknown level \(got 'high', expected 'auto' or 1 to 4\)"),
    ({"lod": 9}, errors.UnsupportedLodError, "lod"),
    ({"budget_ms": "10 ms"}, TypeError, r"budget_ms: not a number \(got '10 ms'\)"),
    ({"voice_strength": 5.0}, errors.OutOfRangeError, r"voice_strength: .*got 5, expected 0..4"),
    ({"audio_queue_samples": 0.5}, TypeError, "audio_queue_samples: not a whole number .got 0.5"),
])
def test_errors_name_field_value_and_range(options, kind, text):
    with pytest.raises(kind, match=text):
        mien.Tracker(**{"lod": 1, **options})


def test_errors_of_methods_name_field_value_and_range():
    with mien.Tracker(1) as tracker:
        with pytest.raises(errors.UnsupportedLodError, match="lod: unknown level .got 'low'"):
            tracker.set_lod("low")
        with pytest.raises(ValueError, match="control: unknown .got 'jaw', expected one of mien.CONTROL_NAMES"):
            tracker.set_mix("jaw", 0, 1)
        with pytest.raises(errors.OutOfRangeError, match="video: number out of range .got 1.5, expected 0 to 1"):
            tracker.set_mix("jawOpen", 0, 1.5)


def test_many_trackers_are_created_and_closed():
    for _ in range(50):
        mien.Tracker(1, sound=False)
    assert ctypes.sizeof(ctypes.c_void_p) == 8
