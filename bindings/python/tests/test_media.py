import csv
import os
import shutil
import subprocess
import wave

import mien
import numpy as np
import pytest
from mien._library import MODELS, PROGRAM


def test_a_video(clip):
    rows = list(mien.track_file(clip))
    assert len(rows) > 60 and set(rows[0]) < set(mien.Row.__annotations__)
    assert set(mien.CONTROL_NAMES) < set(mien.Row.__annotations__)
    assert sum(row["status"] == "tracking" for row in rows) > 0.9 * len(rows)
    table = mien.columns(rows)
    assert set(table) == set(mien.Row.__annotations__)
    assert table["jawOpen"].shape == (len(rows),) and table["jawOpen"].max() > 0.1
    assert (np.diff(table["t_ms"]) > 0).all()
    assert "cheekSquintLeft" not in rows[0] and np.isnan(table["cheekSquintLeft"]).all()
    assert table["status"].dtype.kind == "U"


def test_required_keys_are_always_there(clip, tmp_path):
    black = tmp_path / "black.mp4"
    ffmpeg("-f", "lavfi", "-i", "color=black:size=64x64:rate=30:duration=0.1", black)
    row = next(mien.track_file(black, lod=1))
    assert set(row) == mien.Row.__required_keys__
    assert np.isnan([row["x"], row["w"], row["yaw_rad"], row["tz_m"]]).all() and row["jawOpen"] == 0


def test_the_file_is_read_while_rows_are_taken(clip):
    rows = mien.track_file(clip, lod=1, sound=False)
    assert next(rows)["t_ms"] == 0
    rows.close()


def voice(folder):
    path = folder / "voice.wav"
    with wave.open(str(path), "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(16000)
        t = np.arange(16000) / 16000
        file.writeframes((8000 * np.sign(np.sin(2 * np.pi * 130 * t)) * (t % 0.25 < 0.15)).astype(np.int16).tobytes())
    return path


def ffmpeg(*options):
    subprocess.run(["ffmpeg", "-v", "error", *map(str, options)], check=True)


def test_an_audio_file(tmp_path):
    rows = list(mien.track_file(voice(tmp_path)))
    assert len(rows) == 30 and all(row["status"] == "searching" for row in rows)
    with pytest.raises(mien.MienError, match="no video"):
        list(mien.track_file(tmp_path / "voice.wav", sound=False))


def test_cover_art_is_not_a_video(tmp_path):
    song = tmp_path / "song.flac"
    cover = ["-f", "lavfi", "-i", "color=red:size=64x64:rate=1:duration=1"]
    ffmpeg("-i", voice(tmp_path), *cover, "-map", "0", "-map", "1", "-c:v", "png", "-disposition:v", "attached_pic", song)
    assert len(list(mien.track_file(song))) == 30


def test_audio_that_starts_late(tmp_path, clip):
    speech, film = tmp_path / "speech.wav", tmp_path / "late.mp4"
    ffmpeg("-i", clip, "-vn", "-t", "2", speech)
    black = ["-f", "lavfi", "-i", "color=black:size=64x64:rate=30:duration=3"]
    ffmpeg(*black, "-itsoffset", "1", "-i", speech, "-c:a", "aac", film)
    heard = [[row["vad"] for row in mien.track_file(path)] for path in (speech, film)]
    assert len(heard[0]) == 60 and max(heard[0]) > 0.9
    assert np.abs(np.subtract(heard[1][:90], [0] * 30 + heard[0])).max() < 0.2


def test_damaged_videos(tmp_path, clip):
    for container in ("mp4", "mkv"):
        whole, damaged = tmp_path / f"whole.{container}", tmp_path / f"damaged.{container}"
        ffmpeg("-i", clip, "-c", "copy", "-movflags", "faststart", whole)
        damaged.write_bytes(whole.read_bytes()[:80000])
        rows = mien.track_file(damaged, lod=1, sound=False)
        times = []
        with pytest.raises(mien.MienError, match=r"truncated after \d+ frames"):
            for row in rows:
                times.append(row["t_ms"])
        assert len(times) > 30 and np.abs(np.diff(times) - 1000 / 30).max() < 1.1
    cut = tmp_path / "cut.mp4"  # contains images before the cut, which players skip
    ffmpeg("-ss", "1.5", "-i", clip, "-t", "1", "-c", "copy", cut)
    assert len(list(mien.track_file(cut, lod=1))) >= 30


def test_decoding_errors_are_warnings(tmp_path, clip):
    whole, damaged = tmp_path / "whole.mp4", tmp_path / "damaged.mp4"
    ffmpeg("-i", clip, "-an", "-t", "2", "-c", "copy", whole)
    data = bytearray(whole.read_bytes())
    for i in range(len(data) // 3, len(data) // 2, 97):
        data[i] ^= 0x5A
    damaged.write_bytes(data)
    with pytest.warns(UserWarning, match="decoding error"):
        rows = []
        try:
            for row in mien.track_file(damaged, lod=1):
                rows.append(row)
        except mien.MienError as error:
            assert "could not be decoded" in str(error)
    assert len(rows) > 40


def test_messages_of_ffmpeg_are_passed_on(tmp_path, clip, monkeypatch):
    program = tmp_path / "ffmpeg"
    program.write_text(f'#!/bin/sh\n{shutil.which("ffmpeg")} "$@"\necho "it fell ill" >&2\nexit 3\n')
    program.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=os.pathsep)
    with pytest.raises(mien.MienError, match="truncated after 240 frames: it fell ill"):
        list(mien.track_file(clip, lod=1, sound=False))
    with pytest.raises(mien.MienError, match="damaged or truncated: it fell ill"):
        list(mien.track_file(clip, lod=1))


ODD = {
    "vfr.webm": ["-vf", "select='lt(n,10)+eq(n,17)+gt(n,25)'", "-vsync", "vfr", "-c:v", "libvpx", "-an"],
    "late.mkv": ["-output_ts_offset", "5", "-c:v", "libx264"],
    "late.ts": ["-output_ts_offset", "5", "-c:v", "libx264"],
    "slow.avi": ["-r", "7", "-c:v", "mpeg4"],
    "anamorphic.mp4": ["-vf", "scale=480:480,setsar=4/3", "-c:v", "libx264"],
    "ntsc.mov": ["-r", "30000/1001", "-c:v", "mjpeg"],
}


@pytest.mark.parametrize("name", ODD)
def test_rows_match_the_program(tmp_path, clip, name):
    film, curves = tmp_path / name, tmp_path / "curves.csv"
    ffmpeg("-t", "1", "-i", clip, *ODD[name], film)
    subprocess.run([PROGRAM, "track", "--quiet", "--models", MODELS, film, "-o", curves], check=True)
    with curves.open(newline="") as file:
        expected = list(csv.DictReader(file))
    rows = list(mien.track_file(film))
    assert len(rows) == len(expected) > 5
    for row, other in zip(rows, expected):
        assert abs(row["t_ms"] - float(other["t_ms"])) < 1e-5 and row["status"] == other["status"]
        for name, cell in other.items():  # the same names, units and gaps
            if name not in ("t_ms", "status"):
                assert row.get(name, np.nan) == pytest.approx(float(cell or "nan"), abs=1e-3, nan_ok=True), name


@pytest.mark.parametrize("backward", [True, False])
def test_a_face_that_appears_late(tmp_path, clip, backward):
    film, curves = tmp_path / "late.mp4", tmp_path / "curves.csv"
    gray = "drawbox=enable='lt(n,10)':color=gray:t=fill"
    ffmpeg("-t", "1.5", "-i", clip, "-an", "-vf", gray, "-c:v", "libx264", film)
    options = [] if backward else ["--no-backward"]
    subprocess.run([PROGRAM, "track", "--quiet", "--models", MODELS, *options, "--lod", "1", film, "-o", curves], check=True)
    with curves.open(newline="") as file:
        expected = list(csv.DictReader(file))
    rows = list(mien.track_file(film, lod=1, backward=backward))
    assert [row["status"] for row in rows] == [row["status"] for row in expected]
    assert (rows[12]["status"] == "tracking") == backward and rows[-1]["status"] == "tracking"
    for row, other in zip(rows, expected):
        assert row["jawOpen"] == pytest.approx(float(other["jawOpen"] or 0), abs=1e-6)


def test_the_video_may_be_rotated(tmp_path, clip):
    turned = tmp_path / "turned.mp4"
    ffmpeg("-t", "1", "-i", clip, "-vf", "transpose=cclock", "-c:v", "libx264", turned)
    rows = list(mien.track_file(turned, rotation=90, sound=False))
    assert sum(row["status"] == "tracking" for row in rows) > 25
    with pytest.raises(mien.MienError, match="expected 1 to 1"):
        list(mien.track_file(clip, audio_track=2))


def test_a_name_is_a_name(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    voice(tmp_path).rename("10:30.wav")
    assert len(list(mien.track_file("10:30.wav"))) == 30


def test_files_without_video_are_rejected(tmp_path, monkeypatch):
    with pytest.raises(FileNotFoundError, match="nowhere"):
        mien.track_file(tmp_path / "nowhere.mp4")
    with pytest.raises(mien.errors.UnsupportedLodError, match="lod: unknown level .got 'high'"):
        mien.track_file(__file__, lod="high")
    (tmp_path / "text.mp4").write_text("no film")
    with pytest.raises(mien.MienError, match="neither video nor audio"):
        list(mien.track_file(tmp_path / "text.mp4"))
    assert mien.columns([]) == {}
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(mien.MienError, match="cannot run 'ffprobe': not on PATH; install ffmpeg, for example with `apt install ffmpeg`"):
        list(mien.track_file(tmp_path / "text.mp4"))


def test_an_image(tmp_path, clip):
    picture, pixels = tmp_path / "face.png", tmp_path / "face.bgr"
    ffmpeg("-ss", "4", "-i", clip, "-frames:v", "1", "-vf", "scale=320:240", picture)
    ffmpeg("-i", picture, "-f", "rawvideo", "-pix_fmt", "bgr24", pixels)
    array = np.frombuffer(pixels.read_bytes(), np.uint8).reshape(240, 320, 3)
    result = mien.track_image(picture)
    assert result.has_face and result.lod == 4 and result.controls.jawOpen > 0.3 and result.controls.eyeBlinkLeft > 0.7
    np.testing.assert_array_equal(mien.track_image(array).landmarks, result.landmarks)
    np.testing.assert_array_equal(mien.track_image(array[..., ::-1].copy(), color="rgb").landmarks, result.landmarks)
    assert mien.track_image(array, lod=1).lod == 1
    assert not mien.track_image(np.zeros((48, 64, 3), np.uint8)).has_face


def test_files_that_are_no_images_are_rejected(tmp_path, monkeypatch):
    with pytest.raises(FileNotFoundError, match="nowhere"):
        mien.track_image(tmp_path / "nowhere.jpg")
    (tmp_path / "text.jpg").write_text("no picture")
    with pytest.raises(mien.MienError, match="text.jpg: cannot be read as an image: .+"):
        mien.track_image(tmp_path / "text.jpg")
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(mien.MienError, match="cannot run 'ffmpeg': not on PATH; install ffmpeg, for example with `apt install ffmpeg`"):
        mien.track_image(tmp_path / "text.jpg")
