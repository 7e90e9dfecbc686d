"""A copy of the sources that mutants are built in."""
import hashlib
import json
import os
import pathlib
import subprocess

OPTIONS = ["-G", "Ninja", "-DCMAKE_BUILD_TYPE=None", "-DCMAKE_C_FLAGS=-O1", "-DCMAKE_CXX_FLAGS=-O1", "-DMIEN_BUILD_TESTS=ON",
           "-DMIEN_UNITY_BUILD=OFF", "-DMIEN_WITH_AVX512=OFF", "-DMIEN_BUILD_CONFORMANCE=OFF", "-DMIEN_FUZZ_REPLAY=OFF",
           "-DCMAKE_GTEST_DISCOVER_TESTS_DISCOVERY_MODE=PRE_TEST"]


def digest(path):
    return hashlib.sha256(pathlib.Path(path).read_bytes()).hexdigest()[:32]


class Tree:
    def __init__(self, root, folder):
        self.root, self.source, self.build_folder = pathlib.Path(root), folder / "source", folder / "build"

    def prepare(self):
        """Brings the copy to the state of the root, and configures it. Optimized little, so that changes build fast; without the
        AVX-512 kernels, which take long to build and are not mutated."""
        listed = subprocess.run(["git", "ls-files", "-z"], cwd=self.root, check=True, capture_output=True, text=True).stdout
        names = {name for name in listed.split("\0") if name and (self.root / name).is_file()}
        for name in names:
            self._copy(name)
        for path in self.source.rglob("*"):
            if path.is_file() and str(path.relative_to(self.source)) not in names:
                path.unlink()
        subprocess.run(["cmake", "-S", self.source, "-B", self.build_folder, *OPTIONS], check=True, stdout=subprocess.DEVNULL)
        commands = subprocess.run(["ninja", "-C", self.build_folder, "-t", "compdb"], check=True, stdout=subprocess.PIPE, text=True).stdout
        self._objects = {}
        for command in json.loads(commands):
            if command["output"].endswith(".o"):
                name = os.path.relpath(os.path.join(self.build_folder, command["file"]), self.source)
                self._objects.setdefault(name, []).append(command["output"])

    def _copy(self, name):
        from_path, to_path = self.root / name, self.source / name
        content = from_path.read_bytes()
        if not to_path.is_file() or to_path.read_bytes() != content:
            to_path.parent.mkdir(parents=True, exist_ok=True)
            to_path.write_bytes(content)
            to_path.chmod(from_path.stat().st_mode)

    def objects(self, file):
        """Of a source file; none for a header."""
        return self._objects.get(file, [])

    def build(self, targets, keep_in_cache):
        """Whether they could be built."""
        environment = dict(os.environ) if keep_in_cache else dict(os.environ, CCACHE_READONLY="1")
        done = subprocess.run(["ninja", "-C", self.build_folder, *targets], env=environment, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True, check=False)
        (self.build_folder / "mutation_build.log").write_text(done.stdout)
        return done.returncode == 0

    def read(self, file):
        return (self.source / file).read_text()

    def write(self, file, text):
        (self.source / file).write_text(text)
