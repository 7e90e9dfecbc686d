#!/usr/bin/env python3
"""Writes the whole library as mien.h, mien.hpp, mien.cpp and one mien_TIER.cpp a tier, to be dropped into any project.

usage: scripts/package/amalgamate.py [-o FOLDER]      default: build/amalgamation

`g++ -std=c++20 -O3 app.cpp mien*.cpp` compiles them: each file selects its instruction set, and is empty if the machine or the compiler lacks
it. Results have the same bits as those of the library (tests/package/amalgamated_test.sh).
"""

import argparse
import re
from collections import Counter, defaultdict
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FORMATS = ["bundle", "error_detail", "mien_file", "mien_layers", "mien_open", "mien_open_networks", "neutral_file", "packed_file", "text", "xxhash64", "vocabulary/visemes"]  # the others: programs'

# Tiers of this machine and compiler, by macros instead of the checks of kernels/CMakeLists.txt.
TIERS_HERE = """\
#if defined(__x86_64__)
#define MIEN_HAVE_AVX2
#define MIEN_HAVE_AVX2INT16
#if defined(__clang__) ? __clang_major__ >= 12 : __GNUC__ >= 11
#define MIEN_HAVE_AVXVNNI
#endif
#define MIEN_HAVE_AVX512
#define MIEN_HAVE_AVX512VNNI
// clang 14 has these types only where -mavx512fp16 says so.
#if defined(__AVX512FP16__) || (defined(__clang__) ? __clang_major__ >= 15 : __GNUC__ >= 12)
#define MIEN_HAVE_AVX512FP16
#endif
#elif defined(__aarch64__)
#define MIEN_HAVE_NEON
// clang before 17 has their intrinsics only where -march says so.
#if defined(__ARM_FEATURE_FP16_VECTOR_ARITHMETIC) || !defined(__clang__) || __clang_major__ >= 17
#define MIEN_HAVE_NEONFP16
#if defined(__ARM_FEATURE_DOTPROD) || !defined(__clang__) || __clang_major__ >= 17
#define MIEN_HAVE_NEONDOT
#endif
#if defined(__ARM_FEATURE_MATMUL_INT8) || !defined(__clang__) || __clang_major__ >= 17
#define MIEN_HAVE_NEONI8MM
#endif
#endif
#elif defined(__arm__) && defined(__ARM_FEATURE_FMA) && defined(__ARM_FP16_FORMAT_IEEE)
#define MIEN_HAVE_NEON32  // -march=armv7-a -mfpu=neon-vfpv4 -mfp16-format=ieee
#elif defined(__wasm_simd128__)
#define MIEN_HAVE_WASM  // -msimd128
#define MIEN_HAVE_WASMINT16
#endif
"""

AVX512 = "avx512f,avx512bw,avx512vl,avx512dq,fma,f16c"
GCC_ONLY = ",prefer-vector-width=512"


class Tier:
    """The properties of the file of a tier."""

    def __init__(self, name, target="", gcc_target=None, defines=(), pragmas=()):
        self.name, self.stem = name, name.removesuffix("32")
        self.condition = "!defined(MIEN_TRIM_REF)" if name == "ref" else f"defined(MIEN_HAVE_{name.upper()})"
        self.target, self.gcc_target = target, target if gcc_target is None else gcc_target
        self.defines, self.pragmas = defines, pragmas

    def sources(self):
        stems = [self.stem, f"{self.stem}_product"] + ["simd"] * (self.stem in ("avx2", "neon", "wasm"))
        found = [path for stem in stems for path in (ROOT / "kernels").glob(f"*/{stem}.cpp")]
        if self.name == "neonfp16":
            found += [ROOT / "kernels" / family / "neon.cpp" for family in ("causal_conv", "fully_connected", "lstm")]
        if self.name == "neoni8mm":
            found.append(ROOT / "kernels/quantize_to_int8/neondot.cpp")
        return sorted(found)


# gcc's scheduling before register allocation stretches the lives of the sums until they spill.
NEON_PRAGMA = '#if defined(__GNUC__) && !defined(__clang__)\n#pragma GCC optimize("no-schedule-insns")\n#endif'
# gcc 12 moves the sums of a tile back and forth, and spills them, in two ways (kernels/CMakeLists.txt).
INTEGER_TILE_PRAGMA = '#if defined(__GNUC__) && !defined(__clang__)\n#pragma GCC optimize("no-tree-coalesce-vars", "no-tree-pre")\n#endif'
def ignored(condition, compiler, warnings):
    return [f"#if {condition}", *(f'#pragma {compiler} diagnostic ignored "-W{name}"' for name in warnings), "#endif"]


# GCC 12 warns of undefined operands inside its own intrinsics (GCC bug 105593), and does not apply the target to functions that lambdas
# generate and nothing calls. clang warns of unused functions of headers.
QUIET = [*ignored("defined(__GNUC__) && !defined(__clang__)", "GCC", ["uninitialized", "maybe-uninitialized", "psabi"]),
         *ignored("defined(__clang__)", "clang", ["unused-const-variable"])]
TIERS = [
    Tier("ref"),
    Tier("avx2", "avx2,fma,f16c", defines=["MIEN_TIER avx2"]),
    Tier("avx2int16", "avx2,fma,f16c", pragmas=[INTEGER_TILE_PRAGMA]),
    Tier("avxvnni", "avx2,fma,f16c,avxvnni", pragmas=[INTEGER_TILE_PRAGMA]),
    Tier("avx512", AVX512, AVX512 + GCC_ONLY),
    Tier("avx512fp16", AVX512 + ",avx512fp16", AVX512 + ",avx512fp16" + GCC_ONLY),
    Tier("avx512vnni", AVX512 + ",avx512vnni", AVX512 + ",avx512vnni" + GCC_ONLY, pragmas=[INTEGER_TILE_PRAGMA]),
    Tier("neon", defines=["MIEN_TIER neon"], pragmas=[NEON_PRAGMA]),
    Tier("neonfp16", "fullfp16", "arch=armv8.2-a+fp16", ["MIEN_TIER neonfp16", "MIEN_HALF_TIER"], [NEON_PRAGMA]),
    Tier("neondot", "fullfp16,dotprod", "arch=armv8.2-a+fp16+dotprod", ["MIEN_TIER neondot"], [NEON_PRAGMA]),
    Tier("neoni8mm", "fullfp16,i8mm", "arch=armv8.2-a+fp16+i8mm", ["MIEN_TIER neoni8mm"], [NEON_PRAGMA]),
    Tier("neon32", defines=["MIEN_TIER neon32"], pragmas=[NEON_PRAGMA]),
    Tier("wasm", defines=["MIEN_TIER wasm"]),
    Tier("wasmint16"),
]

INCLUDE = re.compile(r'^#include ([<"])([^>"]+)[>"]')


class Text:
    """Concatenated sources. Each of our headers appears in place once; unconditional system headers move to the front.

    An include under #if stays there, and so do the includes of the header that it names: `<cpuid.h>` exists on x86 only. Such a header
    gets an include guard, because it may be needed again under another condition or under none.
    """

    def __init__(self, root=ROOT, replaced=None):
        self.root, self.replaced, self.system, self.lines = root, replaced or {}, [], []  # replaced: headers by those that they replace
        self.seen, self.guarded = set(), set()

    def add(self, path, rename, conditional=False):
        """Appends the file at `path`. `rename` (or None) maps each line of code."""
        self.lines.append(f"// {path.relative_to(self.root)}")
        conditions = 0
        for line in path.read_text().splitlines():
            conditions += bool(re.match(r"\s*#\s*if", line))
            conditions -= bool(re.match(r"\s*#\s*endif", line))
            include = INCLUDE.match(line)
            if include:
                self.include(line, *include.groups(), conditional or conditions > 0)
            elif line != "#pragma once":
                self.lines.append(rename(line) if rename else line)

    def include(self, line, kind, name, conditional):
        if name == "mien/mien.h":
            return  # at the front of every file
        if kind == "<" and not name.startswith("mien/"):
            if conditional:
                self.lines.append(line)
            elif line not in self.system:
                self.system.append(line)
            return
        path = self.root / "include" / name if kind == "<" else self.root / self.replaced.get(name, name)
        if path.suffix == ".inc":  # a list, which may be included several times
            self.add(path, None, conditional)
        elif path not in self.seen:
            self.add_header(path, conditional)

    def add_header(self, path, conditional):
        if not conditional:
            self.seen.add(path)
        if conditional or path in self.guarded:
            self.guarded.add(path)
            guard = "MIEN_" + re.sub(r"\W", "_", str(path.relative_to(self.root))).upper()
            self.lines += [f"#ifndef {guard}", f"#define {guard}"]
            self.add(path, None, conditional)
            self.lines.append(f"#endif  // {guard}")
        else:
            self.add(path, None)


# Definitions in unnamed namespaces, on lines as clang-format formats them.
DEFINITION = re.compile(
    r"(?:template <.*> ?)?(?:inline |constexpr |static |\[\[\w+\]\] )*"
    r"(?:(?:struct|class|union|enum class) (?P<type>\w+)|using (?P<alias>\w+) =|[A-Za-z_][\w:<>,*& ]*?[ *&](?P<value>\w+)(?: = |\(|\{|\[|;))")


def own_names(path):
    """Each with the line that begins its definition."""
    names, inside, depth = {}, False, 0
    for line in path.read_text().splitlines():
        if line == "namespace {":
            inside, depth = True, 0
        elif inside:
            found = DEFINITION.match(line) if depth == 0 and not line.startswith((" ", "//", "#", "}", "return")) else None
            if found:
                names[found["type"] or found["alias"] or found["value"]] = line
            depth += line.count("{") - line.count("}")
            inside = depth >= 0
    return names


def renaming(path, names):
    """Renames file-local names so that they contain the file's name, and files with equal names can be joined. None if nothing changes."""
    if not names:
        return None
    stem = "_".join(path.relative_to(ROOT).with_suffix("").parts[-2:])
    word = re.compile(r'(?P<text>"(?:\\.|[^"\\])*")|(?P<before>\.|->)?(?P<scope>(?:\w+::)*)\b(?P<name>' + "|".join(sorted(names)) + r")\b")

    def renamed(match):
        of_another = match["text"] or match["before"] or (match["scope"] and not match["scope"].startswith("mien::"))
        return match[0] if of_another else f"{match['scope']}{stem}_{match['name']}"

    def rename(line):
        code, slashes, comment = line.partition("//")
        return word.sub(renamed, code) + slashes + comment

    return rename


def joined(sources, replaced=None):
    """Joins sources into one file in which each compiles as before; renames file-local names that occur in several sources."""
    plain = Text(replaced=replaced)
    for source in sources:
        plain.add(source, None)
    known = Counter(re.findall(r"\w+", "\n".join(plain.lines)))
    names = {source: own_names(source) for source in sources}
    lines = defaultdict(set)
    for own in names.values():
        for name, line in own.items():
            lines[name].add(line)
    text = Text(replaced=replaced)
    for source, own in names.items():
        alone = Counter(re.findall(r"\w+", source.read_text()))
        # Equal aliases may occur twice.
        apart = [name for name, line in own.items()
                 if known[name] > alone[name] and not (line.startswith("using ") and len(lines[name]) == 1)]
        text.add(source, renaming(source, apart))
    return text


def core_sources():
    """The sources that do not belong to a tier."""
    sources = [ROOT / "formats" / f"{name}.cpp" for name in FORMATS]
    sources += [path for part in ("kernels", "engine", "audio") for path in sorted((ROOT / part).glob("*.cpp"))]
    sources += sorted((ROOT / "tracker").rglob("*.cpp"))
    return [path for path in sources if path.name != "audio_disabled.cpp"]


def banner(version, what):
    return [f"// mien {version}: {what} Apache-2.0.", "// Generated by scripts/package/amalgamate.py. Read and change the sources instead."]


def core_file(version):
    text = joined(core_sources())
    return banner(version, "the library without its kernels.") + [
        f'#define MIEN_VERSION "{version}"', "#define MIEN_BUILDING", TIERS_HERE, '#include "mien.h"', "", *text.system, "", *QUIET, *text.lines]


def tier_file(version, tier):
    text = joined(tier.sources(), {"kernels/common/simd.h": f"kernels/common/{tier.stem}_simd.h"})
    lines = banner(version, f"the kernels of the tier {tier.name}.") + [TIERS_HERE, f"#if {tier.condition}", '#include "mien.h"', ""]
    lines += [f"#define {define}" for define in tier.defines] + text.system + QUIET + list(tier.pragmas)
    if tier.target:
        lines += ["#ifdef __clang__", f'#pragma clang attribute push(__attribute__((target("{tier.target}"))), apply_to = function)',
                  "#else", f'#pragma GCC target("{tier.gcc_target}")', "#endif"]
    lines += text.lines
    if tier.target:
        lines += ["#ifdef __clang__", "#pragma clang attribute pop", "#endif"]
    return lines + ["#endif"]


def headers():
    """The public headers as mien/NAME, which find each other without an include path, and mien.h and mien.hpp, which include them."""
    files = {}
    for path in sorted((ROOT / "include/mien").iterdir()):
        files[f"mien/{path.name}"] = re.sub(r"#include <mien/(.*)>", r'#include "\1"', path.read_text()).splitlines()
    return files | {name: [f'#include "mien/{name}"'] for name in ("mien.h", "mien.hpp")}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "build/amalgamation", metavar="FOLDER")
    folder = parser.parse_args().output
    version = re.search(r"^project\(mien VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text(), re.M)[1]
    files = headers() | {"mien.cpp": core_file(version)}
    files |= {f"mien_{tier.name}.cpp": tier_file(version, tier) for tier in TIERS}
    (folder / "mien").mkdir(parents=True, exist_ok=True)
    for name, lines in files.items():
        text = "\n".join(lines) + "\n"
        if not (folder / name).exists() or (folder / name).read_text() != text:  # compilers skip unchanged files
            (folder / name).write_text(text)
    print(f"{folder}: {len(files)} files, {sum((folder / name).stat().st_size for name in files)} bytes")


if __name__ == "__main__":
    main()
