# Zig's clang and linker for the target MIEN_ZIG_TARGET, such as aarch64-macos.13.3. scripts/cross/zig_targets.sh lists the targets.
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES MIEN_ZIG_TARGET)
string(REGEX REPLACE "-.*" "" CMAKE_SYSTEM_PROCESSOR "${MIEN_ZIG_TARGET}")
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)  # static programs are also position-independent
if(MIEN_ZIG_TARGET MATCHES "macos")
  set(CMAKE_SYSTEM_NAME Darwin)
  set(CMAKE_USER_MAKE_RULES_OVERRIDE ${CMAKE_CURRENT_LIST_DIR}/zig_macos.cmake)
  find_program(CMAKE_INSTALL_NAME_TOOL NAMES llvm-install-name-tool llvm-install-name-tool-14 REQUIRED)
elseif(MIEN_ZIG_TARGET MATCHES "windows")
  set(CMAKE_SYSTEM_NAME Windows)
  set(CMAKE_RC_COMPILER ${CMAKE_CURRENT_LIST_DIR}/zig_windres.sh)
endif()
# Zig compiles its C library for each combination of these options, so the checks of CMake and the amalgamation use the same.
set(compiler ${CMAKE_CURRENT_LIST_DIR}/zig_cc.sh)
set(options -target ${MIEN_ZIG_TARGET} -s)
if(CMAKE_SYSTEM_NAME STREQUAL "Linux")
  list(APPEND options -fPIE)
endif()
set(CMAKE_C_COMPILER ${compiler} cc ${options})
set(CMAKE_CXX_COMPILER ${compiler} c++ ${options})
set(CMAKE_ASM_COMPILER ${compiler} cc ${options})
# Files of a release do not depend on the folder; these options are the same for all builds, so that they share Zig's cache of objects.
get_filename_component(root ${CMAKE_CURRENT_LIST_DIR}/../.. ABSOLUTE)
set(CMAKE_C_FLAGS_INIT "-ffile-prefix-map=${root}=.")
set(CMAKE_CXX_FLAGS_INIT "${CMAKE_C_FLAGS_INIT} -D_LIBCPP_REMOVE_TRANSITIVE_INCLUDES")  # a third less time, and finds missing includes
set(CMAKE_AR ${CMAKE_CURRENT_LIST_DIR}/zig_ar.sh)
set(CMAKE_RANLIB true)  # zig ar writes the index
set(CMAKE_EXE_LINKER_FLAGS_INIT "-s")
set(CMAKE_SHARED_LINKER_FLAGS_INIT "-s")
