# Names the compiler that is missing when pip builds the wheel.
set(MIEN_WHEEL_ADVICE "pip compiles mien. On Debian and Ubuntu, as root:
  apt install g++ libcli11-dev nlohmann-json3-dev zlib1g-dev
Or build a wheel on another machine of the same kind with 'pip wheel bindings/python', and install that file here.")

# Names the compilers that CMake would look for: scikit-build-core sets CC and CXX to those that built Python.
function(mien_require_compiler language variable)
  separate_arguments(names UNIX_COMMAND "$ENV{${variable}}")
  if(names)
    list(GET names 0 names)
  else()
    set(names ${ARGN})
  endif()
  find_program(MIEN_${variable} NAMES ${names})
  if(NOT MIEN_${variable})
    list(JOIN names ", " names)
    message(FATAL_ERROR "${language} compiler: missing (expected in PATH: ${names}; ${variable} names another)\n${MIEN_WHEEL_ADVICE}")
  endif()
endfunction()
if(NOT CMAKE_HOST_WIN32)  # Visual Studio is found in another way
  mien_require_compiler(C++ CXX c++ g++ clang++)
  mien_require_compiler(C CC cc gcc clang)
endif()
