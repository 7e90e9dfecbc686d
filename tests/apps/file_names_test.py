"""Tests that file names are never interpreted as options, protocols or patterns of ffmpeg, and that references in files lead to files only.
usage: file_names_test.py MIEN"""
import pathlib
import shutil
import socket
import subprocess
import sys
import tempfile
import threading
import unittest

MIEN = sys.argv[1]
SOURCE = pathlib.Path(__file__).resolve().parents[2]
NAMES = ["plain.mp4", "-clip.mp4", "--help.mp4", "a:b.mp4", "http:clip.mp4", "concat:a|b.mp4", "pipe:0.mp4", "two words.mp4",
         "new\nline.mp4", "50%d.mp4", "$(touch harmed)`touch harmed`.mp4", "'\"\\.mp4", "Ünï 顔.mp4", "\x01.mp4", "[0:v],x=y;.mp4"]


class Names(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        self.clip = self.folder / "made.mp4"
        subprocess.run(["ffmpeg", "-v", "error", "-f", "lavfi", "-i", "testsrc=size=64x48:rate=30:duration=0.2", "-f", "lavfi",
                        "-i", "sine=duration=0.2", "-pix_fmt", "yuv420p", "-y", str(self.clip)], check=True, timeout=120)

    def track(self, *more, **options):
        return subprocess.run([MIEN, "track", "--quiet", "--models", str(SOURCE / "models"), "--lod", "1", *more],
                              capture_output=True, cwd=self.folder, timeout=120, **options)

    def test_any_name_can_be_read(self):
        """As a video and as its audio."""
        expected = None
        for name in NAMES:
            (self.folder / name).symlink_to(self.clip)
            done = self.track("--", name)
            self.assertEqual((done.returncode, done.stderr), (0, b""), name)
            expected = expected or done.stdout
            self.assertEqual(done.stdout, expected, name)
        self.assertEqual(expected.count(b"\n"), 7)
        self.assertFalse((self.folder / "harmed").exists())

    def test_any_name_can_be_written(self):
        for name in NAMES[1:]:
            curves = name + ".csv"
            done = self.track("made.mp4", f"--overlay={name}", "-o" + curves)
            self.assertEqual((done.returncode, done.stderr), (0, b""), name)
            for made in (name, curves):
                self.assertGreater((self.folder / made).stat().st_size, 1000, made)
        self.assertFalse((self.folder / "harmed").exists())
        self.assertEqual([path.name for path in self.folder.iterdir() if path.name.startswith(".partial")], [])

    def test_references_are_not_fetched(self):
        server = socket.create_server(("127.0.0.1", 0))
        self.addCleanup(server.close)
        asked = []

        def listen():
            while True:
                try:
                    connection, _ = server.accept()
                except OSError:
                    return
                asked.append(1)
                connection.close()
        threading.Thread(target=listen, daemon=True).start()
        url = f"http://127.0.0.1:{server.getsockname()[1]}/x.ts"
        playlist = self.folder / "playlist.m3u8"
        playlist.write_text(f"#EXTM3U\n#EXT-X-TARGETDURATION:1\n#EXTINF:1,\n{url}\n#EXT-X-ENDLIST\n")
        parts = self.folder / "parts.ffconcat"
        parts.write_text(f"ffconcat version 1.0\nfile {url}\n")
        for file in (playlist, parts):
            self.assertNotEqual(self.track(file.name).returncode, 0)
            self.assertNotEqual(self.track(file.name, "--mode", "audio").returncode, 0)
        self.assertEqual(asked, [])
        subprocess.run(["ffprobe", "-v", "quiet", "-protocol_whitelist", "file,http,tcp", "-i", str(playlist)], timeout=120)
        self.assertNotEqual(asked, [], "the server must detect requests")


if __name__ == "__main__":
    if not (SOURCE / "models/basenet.mien").exists() or not shutil.which("ffmpeg"):
        print("skipped: the weights or ffmpeg are missing")
        sys.exit(77)
    unittest.main(argv=sys.argv[:1], verbosity=2)
