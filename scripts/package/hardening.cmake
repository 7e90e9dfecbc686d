# Compile options of distributions for the library and the programs, which make memory errors harder to exploit.
# scripts/check/hardening.sh checks the files. Not used in subprojects and with sanitizers.
option(MIEN_HARDEN "Linux: build library and programs with the hardening options of distributions; set to OFF if they are in the flags" ON)
add_library(mien_hardening INTERFACE)
if(MIEN_HARDEN AND MIEN_TOP_LEVEL AND NOT MIEN_SANITIZE AND CMAKE_SYSTEM_NAME STREQUAL "Linux")
  include(CheckCXXCompilerFlag)
  foreach(flag -fstack-protector-strong -fstack-clash-protection -fcf-protection=full -mbranch-protection=standard)
    string(MAKE_C_IDENTIFIER "MIEN_HAS${flag}" known)
    check_cxx_compiler_flag("-Werror ${flag}" ${known})  # clang warns of options that it ignores on this machine
    if(${known})
      target_compile_options(mien_hardening INTERFACE ${flag})
    endif()
  endforeach()
  # It requires sizes that only the optimizer infers.
  target_compile_options(mien_hardening INTERFACE
    "$<$<CONFIG:Release,RelWithDebInfo,MinSizeRel>:-U_FORTIFY_SOURCE;-D_FORTIFY_SOURCE=2>")
  target_link_options(mien_hardening INTERFACE -Wl,-z,relro -Wl,-z,now -Wl,-z,noexecstack)
  include(CheckPIESupported)
  check_pie_supported()
endif()
