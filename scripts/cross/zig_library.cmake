# iOS and Android by Zig's clang for the triple MIEN_TRIPLE, without their SDKs (scripts/cross/zig_library_cc.sh): for libraries, not programs.
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES MIEN_TRIPLE)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_SYSTEM_NAME Generic)
string(REGEX REPLACE "-.*" "" CMAKE_SYSTEM_PROCESSOR "${MIEN_TRIPLE}")
set(CMAKE_C_COMPILER ${CMAKE_CURRENT_LIST_DIR}/zig_library_cc.sh cc ${MIEN_TRIPLE})
set(CMAKE_CXX_COMPILER ${CMAKE_CURRENT_LIST_DIR}/zig_library_cc.sh c++ ${MIEN_TRIPLE})
set(CMAKE_AR llvm-ar)
set(CMAKE_RANLIB llvm-ranlib)
