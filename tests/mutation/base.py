"""The original: a copy of the sources with its build, compile commands, dependencies, and the objects of each
program."""
import dataclasses
import hashlib
import json
import os
import pathlib
import re
import shlex
import subprocess

from . import mutants

FOLDERS = tuple(folder + "/" for folder in mutants.FOLDERS)
# As the release preset has them, so that ccache knows most of it.
OPTIONS = ["--preset", "release", "-DCMAKE_GTEST_DISCOVER_TESTS_DISCOVERY_MODE=PRE_TEST"]


def digest(path):
    return hashlib.sha256(pathlib.Path(path).read_bytes()).hexdigest()[:32]


@dataclasses.dataclass(frozen=True)
class Program:
    command: tuple  # that links it
    direct: frozenset  # objects that the command names
    archived: frozenset  # objects of the libraries that it names


class Base:
    def __init__(self, root, folder):
        self.root, self.source, self.build_folder = pathlib.Path(root), folder, folder / "build/release"

    def prepare(self, targets):
        """Brings the copy to the state of the root, and builds it."""
        listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=self.root,
                                check=True, capture_output=True, text=True).stdout
        names = {name for name in listed.split("\0") if name and (self.root / name).is_file()}
        for name in names:
            self._copy(name)
        for path in self.source.rglob("*"):
            built = self.source / "build" in path.parents
            if path.is_file() and not built and str(path.relative_to(self.source)) not in names:
                path.unlink()
        whole_files = f"-DCMAKE_PROJECT_INCLUDE={pathlib.Path(__file__).parent / 'whole_files.cmake'}"
        environment = dict(os.environ, CCACHE_BASEDIR=str(self.source))
        configure = [] if (self.build_folder / "build.ninja").is_file() else [["cmake", *OPTIONS, whole_files]]
        for command in (*configure, ["ninja", "-C", self.build_folder, *targets]):
            subprocess.run(command, cwd=self.source, env=environment, check=True, stdout=subprocess.DEVNULL)
        self._read_commands()
        self._read_dependencies()

    def _copy(self, name):
        from_path, to_path = self.root / name, self.source / name
        content = from_path.read_bytes()
        if not to_path.is_file() or to_path.read_bytes() != content:
            to_path.parent.mkdir(parents=True, exist_ok=True)
            to_path.write_bytes(content)
            to_path.chmod(from_path.stat().st_mode)

    def _ninja(self, tool):
        return subprocess.run(["ninja", "-C", self.build_folder, "-t", tool], check=True, stdout=subprocess.PIPE,
                              text=True).stdout

    def _read_commands(self):
        entries = json.loads(self._ninja("compdb"))
        self._commands = {entry["output"]: entry["command"] for entry in entries}
        self._sources = {}
        for entry in entries:
            if entry["output"].endswith(".o"):
                self._sources[entry["output"]] = os.path.relpath(os.path.join(self.build_folder, entry["file"]),
                                                                 self.source)

    def _read_dependencies(self):
        """Objects by the files that they are compiled from, directly or through #include."""
        self._dependents = {}
        for line in self._ninja("deps").splitlines():
            if not line.startswith(" "):
                output = line.split(":")[0]
            elif line.strip():
                name = os.path.relpath(os.path.join(self.build_folder, line.strip()), self.source)
                if output in self._sources and not name.startswith(".."):
                    self._dependents.setdefault(name, []).append(output)

    def dependents(self, file, tests_too):
        """Objects that hold the file; that with the same name as a header first. Of the library, and of tests, which
        take long to compile."""
        stem = os.path.splitext(file)[0] + ".cpp"
        folders = (*FOLDERS, "tests/") if tests_too else FOLDERS
        outputs = [output for output in self._dependents.get(file, []) if output.startswith(folders)]
        return sorted(outputs, key=lambda output: (self._sources[output] != stem, output.startswith("tests/"), output))

    def source_of(self, output):
        return self._sources[output]

    def compile_command(self, output):
        """The compile command without the paths of the source and the object."""
        words = shlex.split(self._commands[output])
        words = words[1:] if words[0].endswith("ccache") else words
        end = words.index("-MD") if "-MD" in words else words.index("-o")
        return words[:end]

    def program(self, path):
        words = shlex.split(self._commands[path].removeprefix(": && ").removesuffix(" && :"))
        archived = {name for word in words if word.endswith(".a") and word in self._commands
                    for name in re.findall(r"\S+\.o\b", self._commands[word])}
        return Program(tuple(words), frozenset(word for word in words if word.endswith(".o")), frozenset(archived))
