# shellcheck shell=bash
# Sourced in the repository's root: runs compilers through ccache, if it is installed and works. Results of one checkout
# or build folder are reused in others.
if ccache --show-stats >/dev/null 2>&1; then
  export CMAKE_C_COMPILER_LAUNCHER=ccache CMAKE_CXX_COMPILER_LAUNCHER=ccache
  export CCACHE_BASEDIR=${CCACHE_BASEDIR:-$PWD} CCACHE_NOHASHDIR=1
  export CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime  # required for precompiled headers
fi
