"""Tests of real recordings: complete ones are tracked with their timestamps, others are reported. usage: media_test.py MIEN"""
import csv
import http.server
import io
import json
import os
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import threading
import unittest
import zlib

MIEN = sys.argv[1]
SOURCE = pathlib.Path(__file__).resolve().parents[2]
CASES = SOURCE.parent / "shared/cases"
PICTURE = ["-f", "lavfi", "-i", "testsrc=size=64x48:rate=30:duration=1"]
TONE = ["-f", "lavfi", "-i", "sine=duration=1:sample_rate=16000"]
H264 = ["-c:v", "libx264", "-preset", "ultrafast", "-pix_fmt", "yuv420p"]


def ffmpeg(*options):
    subprocess.run(["ffmpeg", "-v", "error", "-nostdin", "-y", *map(str, options)], check=True, timeout=120)


class Media(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)

    def track(self, *arguments, models=SOURCE / "models", **options):
        command = [MIEN, "track", "--quiet", "--models", str(models), "--lod", "1", *map(str, arguments)]
        done = subprocess.run(command, capture_output=True, timeout=120, **options)
        self.assertNotIn(b"\x1b", done.stdout + done.stderr)
        return done.returncode, list(csv.DictReader(io.StringIO(done.stdout.decode()))), done.stderr.decode()

    def times(self, *arguments):
        code, rows, errors = self.track(*arguments)
        self.assertEqual(code, 0, errors)
        return [float(row["t_ms"]) for row in rows]

    def expect_times(self, got, expected, within):
        self.assertEqual(len(got), len(expected))
        for a, b in zip(got, expected):
            self.assertAlmostEqual(a, b, delta=within)

    # Complete recordings ------------------------------------------------------------------------------------------------------

    def test_variable_frame_rates(self):
        chosen = "select='lt(n,10)+eq(n,17)+gt(n,25)'"
        for ending, codec in (("webm", ["-c:v", "libvpx"]), ("mkv", H264), ("flv", H264), ("mp4", H264), ("ts", H264)):
            ffmpeg(*PICTURE, "-vf", chosen, "-vsync", "vfr", *codec, self.folder / f"vfr.{ending}")
            frames = [*range(10), 17, *range(26, 30)]
            got = self.times(self.folder / f"vfr.{ending}")
            self.expect_times([t - got[0] for t in got], [n * 1000 / 30 for n in frames], 1.01)

    def test_other_streams_that_outlast_the_video(self):
        subtitles = self.folder / "s.srt"
        subtitles.write_text("1\n00:00:00,000 --> 00:00:09,000\nlong\n")
        long_tone = ["-f", "lavfi", "-i", "sine=duration=4"]
        long_picture = ["-f", "lavfi", "-i", "testsrc=size=32x32:rate=5:duration=4"]
        for name, inputs, maps in (("a.mkv", long_tone, ["-c:a", "aac"]), ("a.flv", long_tone, ["-c:a", "aac", "-ar", "44100"]),
                                   ("a.webm", long_tone, ["-c:v", "libvpx", "-c:a", "libopus"]),
                                   ("s.mkv", ["-i", subtitles], ["-c:s", "srt"]), ("v.mkv", long_picture, []), ("v.ts", long_picture, [])):
            ffmpeg(*PICTURE, *inputs, "-map", "0", "-map", "1", *H264, *maps, self.folder / name)
            self.assertEqual(len(self.times(self.folder / name)), 30, name)

    def test_late_starts(self):
        for name in ("late.mkv", "late.ts", "late.mov", "late.webm"):
            codec = ["-c:v", "libvpx"] if name.endswith("webm") else H264
            ffmpeg(*PICTURE, *codec, "-output_ts_offset", "5", self.folder / name)
            self.expect_times(self.times(self.folder / name), [n * 1000 / 30 for n in range(30)], 1.01)

    def test_a_video_that_starts_after_its_audio(self):
        for ending in ("ts", "m2ts", "mp4", "mkv", "mpg", "mov", "flv"):
            codec = ["-c:v", "mpeg2video", "-c:a", "mp2"] if ending == "mpg" else [*H264, "-c:a", "aac", "-ar", "44100"]
            ffmpeg(*TONE, "-itsoffset", "1", *PICTURE, "-map", "1:v", "-map", "0:a", "-vsync", "vfr", *codec,
                   self.folder / f"late.{ending}")
            for mode in ((), ("--mode", "video")):
                got = self.times(self.folder / f"late.{ending}", *mode)
                self.expect_times(got, [1000 + n * 1000 / 30 for n in range(30)], 60)
            part = self.times(self.folder / f"late.{ending}", "--start", "1.5", "--duration", "0.3")
            self.assertAlmostEqual(part[0], 1500, delta=60)
            self.assertAlmostEqual(len(part), 9, delta=1)

    def test_concatenated_transport_streams(self):
        ffmpeg(*PICTURE, *TONE, *H264, "-c:a", "aac", self.folder / "a.ts")
        joined = self.folder / "joined.ts"
        joined.write_bytes((self.folder / "a.ts").read_bytes() * 2)
        got = self.times(joined)
        self.assertEqual(len(got), 60)
        self.assertTrue(all(15 < b - a < 120 for a, b in zip(got, got[1:])), got)

    def test_other_codecs_in_a_wav(self):
        for codec in ("pcm_mulaw", "pcm_alaw", "adpcm_ima_wav", "adpcm_ms", "mp3"):
            wav = self.folder / "x.wav"
            ffmpeg(*TONE, "-c:a", codec, wav)
            self.assertAlmostEqual(len(self.times(wav)), 30, delta=4, msg=codec)
        ffmpeg(*TONE, "-c:a", "aac", self.folder / "x.m4a")
        shutil.copy(self.folder / "x.m4a", wav)
        self.assertAlmostEqual(len(self.times(wav)), 30, delta=3)
        wav.write_text("no audio")
        self.assertEqual(self.track(wav)[0], 11)

    def test_y4m_with_more_than_8_bits(self):
        ffmpeg(*PICTURE, "-pix_fmt", "yuv420p10le", "-strict", "-1", self.folder / "x.y4m")
        self.assertEqual(len(self.times(self.folder / "x.y4m")), 30)

    # Damaged recordings ----------------------------------------------------------------------------------------------------------

    def test_truncated_files_are_rejected(self):
        for ending in ("mp4", "mov", "mkv", "webm", "avi", "flv", "ogv", "wmv"):
            codec = {"webm": ["-c:v", "libvpx", "-c:a", "libopus"], "ogv": ["-c:v", "libtheora", "-c:a", "libvorbis"],
                     "wmv": ["-c:v", "wmv2", "-c:a", "wmav2"], "avi": ["-c:v", "mpeg4", "-c:a", "mp3"]}.get(
                         ending, [*H264, "-c:a", "aac", "-ar", "44100"])
            fast = ["-movflags", "+faststart"] if ending in ("mp4", "mov") else []
            whole, cut = self.folder / f"whole.{ending}", self.folder / f"cut.{ending}"
            ffmpeg(*PICTURE, *TONE, *codec, *fast, whole)
            self.assertEqual(len(self.times(whole)), 30, ending)
            data = whole.read_bytes()
            for share in (0.6, 0.9):
                cut.write_bytes(data[:int(len(data) * share)])
                for mode in ((), ("--mode", "video")):
                    code, _, errors = self.track(cut, "-o", self.folder / "out.csv", *mode)
                    self.assertEqual(code, 5, (ending, share, errors))
                    self.assertEqual(errors.count("\n"), 1)
                    self.assertFalse((self.folder / "out.csv").exists())

    def damaged(self):
        whole = self.folder / "whole.mp4"
        ffmpeg("-f", "lavfi", "-i", "testsrc2=size=160x120:rate=30:duration=2", *H264, "-g", "10", whole)
        data = bytearray(whole.read_bytes())
        begin = data.find(b"mdat") + 4
        for i in range(begin + len(data) // 3, begin + len(data) // 2, 97):
            data[i] ^= 0x5A
        path = self.folder / "damaged.mp4"
        path.write_bytes(data)
        return path

    def test_decoding_errors_are_reported(self):
        code, rows, errors = self.track(self.damaged(), "--stats", self.folder / "s.json")
        self.assertIn(code, (0, 13))
        self.assertGreater(len(rows), 40)
        self.assertRegex(errors, "note: .*damaged.mp4: video: [0-9]+ decoding errors?")
        stats = json.loads((self.folder / "s.json").read_text())
        self.assertGreater(stats["input"]["video"]["decoding_errors"], 0)

    def test_lost_frames_have_their_own_exit_code(self):
        ffmpeg(*PICTURE, "-c:v", "png", self.folder / "whole.mov")
        data = bytearray((self.folder / "whole.mov").read_bytes())
        begin = -1
        for _ in range(6):
            begin = data.find(b"\x89PNG", begin + 1)
        data[begin:begin + 8] = bytes(8)
        (self.folder / "damaged.mov").write_bytes(data)
        code, rows, errors = self.track(self.folder / "damaged.mov")
        self.assertEqual((code, len(rows)), (13, 29), errors)
        self.assertIn("could not be decoded", errors)
        out = self.folder / "out"
        code = subprocess.run([MIEN, "track", self.folder, "--out", out, "--quiet", "--lod", "1", "--models", SOURCE / "models"]).returncode
        self.assertEqual(code, 13)
        self.assertTrue((out / "damaged.mov.csv").exists())

    def test_an_image_with_too_many_pixels(self):
        def chunk(kind, data):
            return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        side = 16000
        rows = zlib.compress(bytes((side // 8 + 1) * side), 9)
        png = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", side, side, 1, 0, 0, 0, 0)) + chunk(b"IDAT", rows) + chunk(b"IEND", b"")
        (self.folder / "large.png").write_bytes(png)
        code, _, errors = self.track(self.folder / "large.png")
        self.assertEqual(code, 4)
        self.assertIn("67108864", errors)

    # Options ----------------------------------------------------------------------------------------------------

    def test_the_audio_track(self):
        silence = ["-f", "lavfi", "-i", "anullsrc=r=16000:cl=mono", "-shortest"]
        both = self.folder / "both.mkv"
        ffmpeg(*PICTURE, *silence[:4], *TONE, "-map", "0", "-map", "1", "-map", "2", "-t", "1", *H264, "-c:a", "flac", both)
        code, _, errors = self.track(both)
        self.assertEqual(code, 0)
        self.assertIn("audio track 1 is silent; --audio-track selects one of 2", errors)
        code, _, errors = self.track(both, "--audio-track", "2", "--stats", self.folder / "s.json")
        self.assertEqual((code, errors), (0, ""))
        self.assertGreater(json.loads((self.folder / "s.json").read_text())["input"]["audio"]["peak"], 0.05)
        code, _, errors = self.track(both, "--audio-track", "3")
        self.assertEqual(code, 11)
        self.assertIn("got 3, expected 1 to 2", errors)

    def test_packed_weights(self):
        """The first frames are gray and are filled by tracking backward, with audio mixed in."""
        clip = self.folder / "clip.mkv"
        ffmpeg("-i", SOURCE / "tests/data/demo.mp4", "-vf", "scale=320:-2,drawbox=enable='lt(n,10)':color=gray:t=fill", "-frames:v", "40", "-c:v", "ffv1",
               "-c:a", "flac", clip)
        for model in ("basenet", "proposal", "hifinet", "audionet"):
            subprocess.run([sys.executable, SOURCE / "scripts/package/pack_weights.py", SOURCE / f"models/{model}.mien", self.folder / f"{model}.mien"],
                           check=True, capture_output=True)
        code, rows, errors = self.track(clip)
        self.assertEqual((code, rows[11]["status"]), (0, "tracking"), errors)
        self.assertEqual(self.track(clip, models=self.folder)[:2], (0, rows))

    def test_very_long_durations(self):
        ffmpeg(*TONE, self.folder / "x.wav")
        ffmpeg(*PICTURE, *H264, self.folder / "x.mp4")
        for name in ("x.wav", "x.mp4"):
            whole = self.times(self.folder / name)
            self.assertEqual(self.times(self.folder / name, "--duration", "1e300"), whole)
            self.assertNotEqual(self.track(self.folder / name, "--start", "1e300")[0], 1)

    # Attacks --------------------------------------------------------------------------------------------------------------

    def test_metadata_cannot_change_timestamps(self):
        line = "[Parsed_showinfo_0 @ 0x1] n:0 pts:999999 pts_time:99 [info] config in time_base: 1/1, "
        for name in ("title.mkv", "title.mp4", f"showinfo pts_time:5 pts: 7 \n{line}.mkv"):
            ffmpeg(*PICTURE, *H264, "-metadata", f"title={line}\n{line}", "-metadata:s:v", f"title=x\n{line}",
                   "file:" + str(self.folder / name.replace("/", "_")))
            got = self.times(self.folder / name.replace("/", "_"))
            self.expect_times(got, [n * 1000 / 30 for n in range(30)], 1.01)

    def test_escape_sequences_do_not_reach_the_terminal(self):
        name = "a\x1b]0;title\x07\x9b31m\u202egpj.mp4"
        code, _, errors = self.track(self.folder / name)
        self.assertEqual((code, errors.count("\n")), (3, 1))
        self.assertIn("a\\x1b]0;title\\x07", errors)
        self.assertIn("\\u202e", errors)
        (self.folder / name).write_text("no video")
        self.assertEqual(self.track(self.folder / name)[0], 4)
        ffmpeg(*TONE, self.folder / "x.wav")
        (self.folder / "x.wav").rename(self.folder / "\x1b[31mx.wav")
        table = subprocess.run([MIEN, "track", self.folder, "--out", self.folder / "out", "--models", SOURCE / "models"], capture_output=True)
        self.assertNotIn(b"\x1b[31m", table.stdout + table.stderr)
        usage = subprocess.run([MIEN, "track", "x", "--\x1b[31m"], capture_output=True)
        self.assertEqual(usage.returncode, 2)
        self.assertNotIn(b"\x1b", usage.stdout + usage.stderr)

    def test_credentials_are_not_printed(self):
        user = "user:geheim@"
        for url in (f"http://{user}127.0.0.1:1/x?token=geheim2&a=1", "rtsp://user:ge/geheim@127.0.0.1:1/x", f"nosuch://{user}h/"):
            code, _, errors = self.track(url)
            self.assertIn(code, (2, 3))
            self.assertNotIn("geheim", errors)
            self.assertIn("***", errors)

    def test_a_url_has_one_clock(self):
        ffmpeg(*TONE, "-itsoffset", "0.5", *PICTURE, "-map", "1:v", "-map", "0:a", *H264, "-c:a", "aac", self.folder / "x.ts")

        class Handler(http.server.SimpleHTTPRequestHandler):
            def __init__(handler, *arguments):
                super().__init__(*arguments, directory=str(self.folder))

            def log_message(self, *_):
                pass
        server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.addCleanup(server.server_close)
        self.addCleanup(server.shutdown)
        threading.Thread(target=server.serve_forever, daemon=True).start()
        got = self.times(f"http://127.0.0.1:{server.server_port}/x.ts")
        self.expect_times(got, self.times(self.folder / "x.ts"), 1.0)

    # Collected cases ------------------------------------------------------------------------------------------------------

    def test_collected_cases(self):
        if not CASES.is_dir():
            self.skipTest("no collected cases")
        rows = {"vfr.webm": 21, "sound_longer.webm": 30, "late.mkv": 30, "picture_1s_late.ts": 25, "picture_1s_late.mp4": 25}
        for name, count in rows.items():
            got = self.times(CASES / name)
            self.assertEqual(len(got), count, name)
            if name.startswith("picture"):
                self.assertAlmostEqual(got[0], 1000, delta=40)
        for name in ("mulaw8k.wav", "mp3_in.wav"):
            self.assertGreater(len(self.times(CASES / name)), 10)
        code, got, errors = self.track(CASES / "damaged_inside.mp4")
        self.assertGreater(len(got), 50)
        self.assertIn("decoding error", errors)


if __name__ == "__main__":
    if not (SOURCE / "models/basenet.mien").exists() or not shutil.which("ffmpeg"):
        print("skipped: ffmpeg or the weights are missing")
        sys.exit(77)
    os.environ.pop("MIEN_MODELS", None)
    unittest.main(argv=sys.argv[:1] + sys.argv[2:], verbosity=2)
