"""Builds one mutant: the objects that hold the changed file, and programs with these objects in the place of the
original ones."""
import os
import shutil
import subprocess

from .base import digest

# Options for mutants and the originals that they are compared with. Little optimization compiles faster and shows more
# differences.
LIKE_EACH_OTHER = ["-O1", "-w", "-frandom-seed=mien"]


class NotCompiled(Exception):
    pass


class Variant:
    """One at a time in its folder."""

    def __init__(self, base, folder):
        self._base, self._folder, self._originals = base, folder, base.source / "build/originals"
        self._overlay, self._objects, self._programs = (folder / name for name in ("source", "objects", "programs"))
        self._compiled, self._file = set(), ""

    def begin(self, file, text, tests_too):
        for folder in (self._overlay, self._objects, self._programs):
            shutil.rmtree(folder, ignore_errors=True)
            folder.mkdir(parents=True)
        self._file, self._compiled = file, set()
        path = self._overlay / file
        path.parent.mkdir(parents=True)
        path.write_text(text)
        self._dependents = self._base.dependents(file, tests_too)
        if self._dependents:
            self._object(self._dependents[0])

    def _compile(self, output, to_path, overlay):
        to_path.parent.mkdir(parents=True, exist_ok=True)
        name = self._base.source_of(output)
        source = (overlay if overlay and name == self._file else self._base.source) / name
        words = self._base.compile_command(output)
        include = [f"-I{overlay}"] if overlay else []
        command = [words[0], *include, *words[1:], *LIKE_EACH_OTHER, "-o", str(to_path), "-c", str(source)]
        done = subprocess.run(command, cwd=self._base.build_folder, env=dict(os.environ, CCACHE_DISABLE="1"),
                              check=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        if done.returncode != 0:
            raise NotCompiled

    def _object(self, output):
        path = self._objects / output
        if output not in self._compiled:
            self._compile(output, path, self._overlay)
            self._compiled.add(output)
        return path

    def is_identical(self):
        """Whether the compiled objects equal the original's. Checked after the tests, because few mutants do and
        tests kill most others before the original is compiled."""
        return all(digest(self._objects / output) == self._original(output) for output in self._compiled)

    def _original(self, output):
        state = digest(self._base.build_folder / output)
        path = self._originals / output
        memory = path.with_suffix(f".{state}.digest")
        if not memory.is_file():
            self._compile(output, path, None)
            memory.write_text(digest(path))
            path.unlink()
        return memory.read_text()

    def program(self, path):
        """The program linked with the mutant; None if it does not contain the changed file."""
        program = self._base.program(path)
        parts = [output for output in self._dependents if output in program.direct or output in program.archived]
        changed = {output: str(self._object(output)) for output in parts}
        if not changed:
            return None
        linked = self._programs / path
        linked.parent.mkdir(parents=True, exist_ok=True)
        direct = {self._base.source_of(output) for output in program.direct}
        # Before all others: the linker ignores second definitions from libraries, and of inline functions from tests.
        ahead = [path for output, path in changed.items()
                 if output not in program.direct and self._base.source_of(output) not in direct]
        compiler, *words = [changed.get(word, word) for word in program.command]
        words[words.index("-o") + 1] = str(linked)
        command = [compiler, *ahead, *words, "-fuse-ld=gold"]
        done = subprocess.run(command, cwd=self._base.build_folder, check=False, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL)
        if done.returncode != 0:
            raise NotCompiled
        return linked
