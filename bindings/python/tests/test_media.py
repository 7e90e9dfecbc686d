import shutil
import wave

import mien
import numpy as np
import pytest


def test_a_film(clip):
    rows = list(mien.track_file(clip))
    assert len(rows) > 60 and set(mien.CONTROL_NAMES) < set(rows[0])
    assert sum(row["status"] == "tracking" for row in rows) > 0.9 * len(rows)
    table = mien.columns(rows)
    assert table["jawOpen"].shape == (len(rows),) and table["jawOpen"].max() > 0.1
    assert (np.diff(table["time_s"]) > 0).all()
    assert table["status"].dtype.kind == "U"


def test_it_is_read_while_rows_are_taken(clip):
    rows = mien.track_file(clip, lod=1, sound=False)
    assert next(rows)["time_s"] == 0
    rows.close()


def test_a_voice(tmp_path):
    path = tmp_path / "voice.wav"
    with wave.open(str(path), "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(16000)
        t = np.arange(16000) / 16000
        file.writeframes((8000 * np.sign(np.sin(2 * np.pi * 130 * t)) * (t % 0.25 < 0.15)).astype(np.int16).tobytes())
    rows = list(mien.track_file(path))
    assert len(rows) == 30 and all(row["status"] == "searching" for row in rows)


def test_what_is_no_film(tmp_path, monkeypatch):
    with pytest.raises(FileNotFoundError, match="nowhere"):
        mien.track_file(tmp_path / "nowhere.mp4")
    (tmp_path / "text.mp4").write_text("no film")
    with pytest.raises(mien.MienError, match="neither pictures nor sound"):
        list(mien.track_file(tmp_path / "text.mp4"))
    assert mien.columns([]) == {}
    monkeypatch.setattr(shutil, "which", lambda name: None)
    with pytest.raises(mien.MienError, match="ffmpeg is not installed"):
        mien.track_file(tmp_path / "text.mp4")
