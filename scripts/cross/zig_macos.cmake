# What CMake only sets on macOS. Without it, programs do not find libraries beside them.
set(CMAKE_SHARED_LIBRARY_RUNTIME_C_FLAG "-Wl,-rpath,")
