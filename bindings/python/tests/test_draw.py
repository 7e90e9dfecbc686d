"""Drawing with OpenCV and matplotlib, where they are installed, and what users read where they are not."""
import mien
import numpy as np
import pytest


@pytest.fixture(scope="module")
def result(frames):
    return mien.track_image(frames[20])


def changed(before, after):
    return np.argwhere((before != after).any(-1))[:, ::-1]


def test_opencv(frames, result):
    pytest.importorskip("cv2")
    image = frames[20].copy()
    mien.draw(image, result, controls=0)
    points = changed(frames[20], image)
    distances = np.linalg.norm(result.landmarks[:, None] - points, axis=-1)
    assert (distances.min(1) < 1.5).all(), "each landmark is drawn"
    labelled = image.copy()
    mien.draw(labelled, result)
    assert len(changed(image, labelled)) > 100, "the controls are drawn"


def test_matplotlib(frames, result):
    pytest.importorskip("matplotlib").use("agg")
    from matplotlib.figure import Figure
    axes = Figure().subplots()
    axes.imshow(frames[20][..., ::-1])
    mien.draw(axes, result)
    np.testing.assert_array_equal(axes.lines[0].get_xydata(), result.landmarks)
    arrows = [text for text in axes.texts if getattr(text, "arrow_patch", None)]
    expected = result.pose.project(np.eye(3) * 0.1, 640, 480)
    np.testing.assert_allclose([arrow.xy for arrow in arrows], expected)
    assert "jawOpen" in axes.texts[-1].get_text() or len(axes.texts[-1].get_text().splitlines()) == 8


def test_no_face(frames):
    image = np.zeros((48, 64, 3), np.uint8)
    mien.draw(image, mien.track_image(image))
    assert not image.any()


def test_without_opencv(frames, result, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "cv2", None)
    with pytest.raises(ImportError, match="mien.draw: drawing into an array needs OpenCV; pip install opencv-python"):
        mien.draw(frames[20].copy(), result)
