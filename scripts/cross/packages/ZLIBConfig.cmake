# The headers of zlib alone: /usr/include as a whole would hide those of the target's C library.
file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/headers)
foreach(header zlib.h zconf.h)
  file(CREATE_LINK /usr/include/${header} ${CMAKE_BINARY_DIR}/headers/${header} SYMBOLIC)
endforeach()
add_library(ZLIB::ZLIB INTERFACE IMPORTED)
target_include_directories(ZLIB::ZLIB INTERFACE ${CMAKE_BINARY_DIR}/headers)
