# shellcheck shell=bash
# Sourced in the repository's root: compilers run behind ccache where it is there and works. What was compiled in one checkout or
# build folder serves in another.
if ccache --show-stats >/dev/null 2>&1; then
  export CMAKE_C_COMPILER_LAUNCHER=ccache CMAKE_CXX_COMPILER_LAUNCHER=ccache
  export CCACHE_BASEDIR=${CCACHE_BASEDIR:-$PWD} CCACHE_NOHASHDIR=1
  export CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime  # as precompiled headers need it
fi
