# Writes weight files as a C (and C++) source, and the header to it.
# usage: cmake -DSOURCE=mien_weights.c -DHEADER=mien_weights.h -DFILES=a.mien;b.mien -P embed_weights.cmake
cmake_minimum_required(VERSION 3.22)

file(WRITE ${HEADER} "/* Made by mien_embed. */
#ifndef MIEN_WEIGHTS_H_
#define MIEN_WEIGHTS_H_

#include <mien/mien.h>

#ifdef __cplusplus
extern \"C\" {
#endif

/* Sets the weights in *config, which never have to be released. */
void mien_use_embedded_weights(mien_tracker_config* config);

#ifdef __cplusplus
}
#endif

#endif
")

set(arrays "/* Made by mien_embed. Little-endian, as the files are and as all machines are that mien runs on. */
#include \"mien_weights.h\"
")
set(settings "")
foreach(file IN LISTS FILES)
  get_filename_component(name ${file} NAME_WE)
  file(SIZE ${file} bytes)
  file(READ ${file} hex HEX)
  math(EXPR rest "${bytes} % 64")
  if(NOT rest EQUAL 0)  # as all weight files do
    message(FATAL_ERROR "${file}: ${bytes} bytes do not end at a multiple of 64")
  endif()
  string(REGEX REPLACE "(..)(..)(..)(..)(..)(..)(..)(..)" "0x\\8\\7\\6\\5\\4\\3\\2\\1u," words "${hex}")
  string(APPEND arrays "
static const uint64_t ${name}[] __attribute__((aligned(MIEN_ALIGNMENT))) = {${words}};
")
  string(APPEND settings "  config->${name} = ${name};
  config->${name}_bytes = sizeof ${name};
")
endforeach()
file(WRITE ${SOURCE} "${arrays}
void mien_use_embedded_weights(mien_tracker_config* config) {
${settings}}
")
