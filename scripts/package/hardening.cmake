# What distributions build with, so that a fault in memory ends the process rather than be used by somebody: for the library and
# the programs, checked on the files by scripts/check/hardening.sh. A parent project has its own mind, sanitizers look closer.
option(MIEN_HARDEN "Linux: build library and programs with what distributions build with; they themselves say so by flags" ON)
add_library(mien_hardening INTERFACE)
if(MIEN_HARDEN AND MIEN_TOP_LEVEL AND NOT MIEN_SANITIZE AND CMAKE_SYSTEM_NAME STREQUAL "Linux")
  include(CheckCXXCompilerFlag)
  foreach(flag -fstack-protector-strong -fstack-clash-protection -fcf-protection=full -mbranch-protection=standard)
    string(MAKE_C_IDENTIFIER "MIEN_HAS${flag}" known)
    check_cxx_compiler_flag("-Werror ${flag}" ${known})  # clang warns of what it does not know on this machine
    if(${known})
      target_compile_options(mien_hardening INTERFACE ${flag})
    endif()
  endforeach()
  # It works on what the optimizer knows of sizes.
  target_compile_options(mien_hardening INTERFACE
    "$<$<CONFIG:Release,RelWithDebInfo,MinSizeRel>:-U_FORTIFY_SOURCE;-D_FORTIFY_SOURCE=2>")
  target_link_options(mien_hardening INTERFACE -Wl,-z,relro -Wl,-z,now -Wl,-z,noexecstack)
  include(CheckPIESupported)
  check_pie_supported()
endif()
