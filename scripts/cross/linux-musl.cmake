# x86-64 Linux with musl: static programs by Zig's clang, which has musl and its C++ library as sources (scripts/cross/musl.sh installs it).
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR x86_64)
set(CMAKE_C_COMPILER $ENV{MIEN_ZIG} cc -target x86_64-linux-musl)
set(CMAKE_CXX_COMPILER $ENV{MIEN_ZIG} c++ -target x86_64-linux-musl)
set(CMAKE_ASM_COMPILER $ENV{MIEN_ZIG} cc -target x86_64-linux-musl)
set(CMAKE_AR /usr/bin/ar)
set(CMAKE_RANLIB /usr/bin/ranlib)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)  # programs are hardened: static, and position-independent
