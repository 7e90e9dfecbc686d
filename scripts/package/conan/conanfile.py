"""Conan 2 recipe for the checkout that contains it: conan create scripts/package/conan"""

import os
import re

from conan import ConanFile
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy, load


class Mien(ConanFile):
    name = "mien"
    license = "Apache-2.0"
    description = "Facial animation from a camera and a microphone, in real time, on the CPU"
    topics = ("face-tracking", "animation", "arkit", "inference")
    package_type = "library"
    settings = "os", "arch", "compiler", "build_type"
    options = {"shared": [True, False], "fPIC": [True, False], "with_audio": [True, False], "with_hifinet": [True, False]}
    default_options = {"shared": False, "fPIC": True, "with_audio": True, "with_hifinet": True}
    implements = ["auto_shared_fpic"]

    @property
    def _repository(self):
        return os.path.join(self.recipe_folder, "..", "..", "..")

    def set_version(self):
        text = load(self, os.path.join(self._repository, "CMakeLists.txt"))
        self.version = re.search(r"^project\(mien VERSION ([0-9.]+)", text, re.M)[1]

    def export_sources(self):
        for part in ("kernels", "formats", "engine", "audio", "tracker", "include", "models", "scripts/package"):
            copy(self, f"{part}/*", self._repository, self.export_sources_folder, excludes="models/training/*")
        for name in ("CMakeLists.txt", "LICENSE"):
            copy(self, name, self._repository, self.export_sources_folder)

    def layout(self):
        cmake_layout(self)

    def generate(self):
        CMakeDeps(self).generate()
        toolchain = CMakeToolchain(self)
        for part in ("TESTS", "APPS", "CONFORMANCE"):
            toolchain.cache_variables[f"MIEN_BUILD_{part}"] = False
        toolchain.cache_variables["MIEN_WITH_AUDIO"] = bool(self.options.with_audio)
        toolchain.cache_variables["MIEN_WITH_HIFINET"] = bool(self.options.with_hifinet)
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()
        copy(self, "LICENSE", self.source_folder, os.path.join(self.package_folder, "licenses"))

    def package_info(self):
        # Uses mien's own files for find_package instead of those that Conan generates, because they define mien_embed and the weights.
        self.cpp_info.set_property("cmake_find_mode", "none")
        self.cpp_info.builddirs = [os.path.join("lib", "cmake", "mien")]
        self.cpp_info.libs = ["mien"]
        if self.settings.os in ("Linux", "Android"):
            self.cpp_info.system_libs = ["m"]
