# A target whose own SDK is not at hand: clang for the triple MIEN_TRIPLE, with Debian's libc++ and musl headers standing in
# for the target's. Good for compiling and looking at symbols, not for linking programs. scripts/cross/compile_only.sh
set(CMAKE_SYSTEM_NAME Generic)
string(REGEX REPLACE "-.*" "" CMAKE_SYSTEM_PROCESSOR "${MIEN_TRIPLE}")
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES MIEN_TRIPLE MIEN_FLAGS MIEN_LLVM MIEN_HEADERS)
set(CMAKE_C_COMPILER clang)
set(CMAKE_CXX_COMPILER clang++)
set(CMAKE_C_COMPILER_TARGET ${MIEN_TRIPLE})
set(CMAKE_CXX_COMPILER_TARGET ${MIEN_TRIPLE})
set(CMAKE_AR ${MIEN_LLVM}/bin/llvm-ar)
set(CMAKE_RANLIB ${MIEN_LLVM}/bin/llvm-ranlib)
set(CMAKE_C_FLAGS_INIT "${MIEN_FLAGS} -nostdlibinc -idirafter ${MIEN_HEADERS}")
# No locales and no threads: what the library uses needs neither, and their headers are the system's own.
set(CMAKE_CXX_FLAGS_INIT "${MIEN_FLAGS} -nostdinc++ -nostdlibinc -isystem ${MIEN_LLVM}/include/c++/v1 \
-idirafter ${MIEN_HEADERS} -D_LIBCPP_HAS_MUSL_LIBC")
