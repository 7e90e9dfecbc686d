"""What ffmpeg reads of a file: which streams there are, its sound, its pictures. What it cannot read to the end is a MienError."""

from __future__ import annotations

import json
import subprocess
import tempfile
from fractions import Fraction
from pathlib import Path
from typing import IO, Any, Iterator, Optional

import numpy as np
import numpy.typing as npt

from .errors import MienError

SOUND_RATE = 16000

_FACTS = "stream=codec_type,nb_frames,duration:stream_disposition=attached_pic:stream_tags=DURATION:format=duration"


class Film:
    """The stream of a file's pictures."""

    def __init__(self, stream: dict[str, Any], file: dict[str, Any]) -> None:
        self._counted = int(stream.get("nb_frames", 0))
        tag = stream.get("tags", {}).get("DURATION")  # Matroska's: hours:minutes:seconds
        self._seconds = float(stream.get("duration") or (_seconds(tag) if tag else file.get("duration", 0)))

    def frames(self, rate: Fraction) -> int:
        """How many it has at `rate`, of what the file says the fewest; 0: it does not say."""
        said = (self._counted, int(self._seconds * rate))
        return min((frames for frames in said if frames > 0), default=0)


def streams(path: Path) -> tuple[Optional[Film], bool]:
    """The pictures of a file, of which those of a sound's cover are none, and whether there is sound."""
    command = ["ffprobe", "-v", "error", "-show_entries", _FACTS, "-of", "json", *_input(path)]
    probed = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    found = json.loads(probed.stdout) if probed.returncode == 0 else {}
    all_streams = found.get("streams", [])
    films = [stream for stream in all_streams if stream.get("codec_type") == "video" and not stream["disposition"]["attached_pic"]]
    sound = any(stream.get("codec_type") == "audio" for stream in all_streams)
    if not films and not sound:
        raise MienError(f"{path} has neither pictures nor sound that ffmpeg can read" + _because(probed.stderr))
    return (Film(films[0], found.get("format", {})) if films else None), sound


def samples(path: Path) -> npt.NDArray[np.float32]:
    """The sound of the whole file, one channel, from time 0 on: silence where it begins late or has a gap."""
    from_0 = "aresample=async=1:first_pts=0"
    with _Decoder(path, "-map", "0:a:0", "-af", from_0, "-ac", "1", "-ar", str(SOUND_RATE), "-f", "f32le") as decoder:
        data = decoder.output.read()
        if not decoder.went_well():
            raise MienError(f"{path}: the sound is damaged" + decoder.because())
    return np.frombuffer(data[: len(data) // 4 * 4], np.float32)


def pictures(path: Path, film: Film) -> Iterator[tuple[npt.NDArray[np.uint8], float]]:
    """Frames as I420 of even sizes, at a constant rate, with their times."""
    even = "scale=trunc(iw/2)*2:trunc(ih/2)*2:out_range=tv:out_color_matrix=bt601"
    with _Decoder(path, "-map", "0:V:0", "-vf", even, "-pix_fmt", "yuv420p", "-f", "yuv4mpegpipe") as decoder:
        header = decoder.output.readline().decode("ascii", "replace").split()
        if not header:
            decoder.went_well()
            raise MienError(f"{path}: the pictures cannot be decoded" + decoder.because())
        fields = {field[0]: field[1:] for field in header[1:]}
        width, height, rate = int(fields["W"]), int(fields["H"]), Fraction(fields["F"].replace(":", "/"))
        size = width * height * 3 // 2
        frames = 0
        while decoder.output.readline() and len(data := decoder.output.read(size)) == size:
            yield np.frombuffer(data, np.uint8).reshape(height * 3 // 2, width), float(frames / rate)
            frames += 1
        # Containers round their frame counts; a few frames less is not a damaged file.
        there_are = film.frames(rate)
        if not decoder.went_well() or frames + 2 + there_are // 50 < there_are:
            of = f" of {there_are}" if there_are else ""
            raise MienError(f"{path}: truncated after {frames} frames{of}" + decoder.because())


def _input(path: Path) -> list[str]:
    """Files alone, whatever their name looks like, and whatever they point to."""
    return ["-protocol_whitelist", "file,pipe", "-i", f"file:{path}"]


def _seconds(clock: str) -> float:
    hours, minutes, seconds = (float(part) for part in clock.split(":"))
    return 3600 * hours + 60 * minutes + seconds


def _because(said: bytes) -> str:
    lines = said.decode("utf-8", "replace").split("\n")
    return next((f": {line.strip()}" for line in reversed(lines) if line.strip()), "")


class _Decoder:
    """ffmpeg at work. It stops where this is left, be it because nobody wants more."""

    output: IO[bytes]

    def __init__(self, path: Path, *options: str) -> None:
        command = ["ffmpeg", "-nostdin", "-v", "error", *_input(path), *options, "-"]
        self._said = tempfile.TemporaryFile()  # a pipe that nobody reads would fill up, and hold it
        self._process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=self._said)
        assert self._process.stdout is not None
        self.output = self._process.stdout

    def __enter__(self) -> _Decoder:
        return self

    def __exit__(self, *_: object) -> None:
        self.output.close()
        self._process.kill()
        self._process.wait()
        self._said.close()

    def went_well(self) -> bool:
        """At the end of the output."""
        return self._process.wait() == 0

    def because(self) -> str:
        """Its last words."""
        self._said.seek(0)
        return _because(self._said.read())
