import ctypes
import threading

import mien
import numpy as np
import pytest
from mien import errors
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


def test_controls_are_a_mapping_and_an_array(bgr):
    controls = bgr[-1].controls
    assert list(controls) == list(mien.CONTROL_NAMES) and len(controls) == 52
    jaw = mien.Control.JAW_OPEN
    assert mien.CONTROL_NAMES[jaw] == "jawOpen" and controls["jawOpen"] == controls[jaw] == controls.array[jaw]
    assert len(bgr[-1].landmarks_of(mien.LandmarkGroup.LEFT_IRIS)) == 5
    assert controls.array.dtype == np.float32 and controls.array.shape == (52,)
    assert dict(controls)["eyeBlinkLeft"] == controls["eyeBlinkLeft"]
    assert "jawOpen" in controls.supported and "eyeLookUpLeft" not in controls.supported
    with pytest.raises(KeyError):
        controls["nothing"]


def test_other_vocabularies(bgr):
    controls = bgr[-1].controls
    assert controls.to("arkit") == pytest.approx(dict(controls))
    assert controls.to("roblox")["JawDrop"] == pytest.approx(controls["jawOpen"])
    assert controls.to("mediapipe")["mouthPucker"] == pytest.approx(controls["mouthPucker"])
    assert [len(mien.vocabulary_names(name)) for name in mien.VOCABULARIES] == [52, 52, 50, 11, 11, 15]
    with pytest.raises(ValueError, match=r"vocabulary: unknown \(got 'klingon', expected one of arkit"):
        controls.to("klingon")


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
    (np.zeros((4, 8, 3), np.uint8), {"rotation": 45}, errors.ImageRotationError, "0, 90, 180 or 270"),
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
    answers = []
    for samples in (sound, stereo, np.asfortranarray(stereo), (sound * 32768).clip(-32768, 32767).astype(np.int16)):
        with mien.Tracker(1) as tracker:
            tracker.push_audio(samples, 0, 16000)
            answers.append([tracker.advance(i / RATE).controls.array for i in range(12)])
    np.testing.assert_array_equal(answers[0], answers[1])
    np.testing.assert_array_equal(answers[0], answers[2])
    np.testing.assert_allclose(answers[0], answers[3], atol=0.02)
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


def test_errors_name_the_field():
    with pytest.raises(errors.OutOfRangeError, match=r"max_faces: a value is out of range \(got 9, expected 1..8\)"):
        mien.Tracker(1, max_faces=9)


def test_many_trackers_are_created_and_closed():
    for _ in range(50):
        mien.Tracker(1, sound=False)
    assert ctypes.sizeof(ctypes.c_void_p) == 8
