# Headers of CLI11 and stb only: the whole of /usr/include would hide those of the target's C library.
file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/headers)
foreach(folder CLI stb)
  file(CREATE_LINK /usr/include/${folder} ${CMAKE_BINARY_DIR}/headers/${folder} SYMBOLIC)
endforeach()
add_library(CLI11::CLI11 INTERFACE IMPORTED)
target_include_directories(CLI11::CLI11 INTERFACE ${CMAKE_BINARY_DIR}/headers)
