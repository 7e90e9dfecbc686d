"""Compiles the C++ parts of the package on demand into the cache."""
import hashlib
import os
import subprocess

from mien_training.paths import cache

FLAGS = ["-std=c++20", "-O3", "-march=native", "-fno-math-errno", "-fno-trapping-math", "-fno-signed-zeros",
         "-fassociative-math", "-freciprocal-math", "-shared", "-fPIC"]


def library(main, others=()):
    """Path of the shared library built from the current source file `main`, which includes `others`."""
    key = hashlib.sha256(b"".join(p.read_bytes() for p in (*others, main)) + " ".join(FLAGS).encode()).hexdigest()[:12]
    path = cache() / f"{main.stem}_{key}.so"
    if not path.exists():
        path.parent.mkdir(parents=True, exist_ok=True)
        fresh = path.with_suffix(f".{os.getpid()}")
        subprocess.run(["g++", *FLAGS, main, "-o", fresh], check=True)
        fresh.rename(path)
    return path
