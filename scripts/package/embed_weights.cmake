# Writes weight files as a source in C (and C++), and its header.
# usage: cmake -DSOURCE=mien_weights.c -DHEADER=mien_weights.h -DFILES=a.mien;b.mien [-DPACKED=ON] -P embed_weights.cmake
#   PACKED: the files were written by pack_weights.py
cmake_minimum_required(VERSION 3.22)

set(how "Sets the weight files in *config.")
if(PACKED)
  string(APPEND how " mien_weights_create unpacks them.")
endif()
file(WRITE ${HEADER} "/* Made by mien_embed. */
#ifndef MIEN_WEIGHTS_H_
#define MIEN_WEIGHTS_H_

#include <mien/mien.h>

#ifdef __cplusplus
extern \"C\" {
#endif

/* ${how} */
void mien_use_embedded_weights(mien_weights_config* config);

#ifdef __cplusplus
}
#endif

#endif
")

set(arrays "/* Made by mien_embed. Little-endian, like the files and every supported machine. */
#include \"mien_weights.h\"
")
set(settings "")
set(index 0)
foreach(file IN LISTS FILES)
  get_filename_component(name ${file} NAME_WE)
  file(SIZE ${file} bytes)
  file(READ ${file} hex HEX)
  math(EXPR rest "${bytes} % 64")
  if(NOT PACKED AND NOT rest EQUAL 0)  # the size of all weight files is a multiple
    message(FATAL_ERROR "${file}: ${bytes} bytes do not end at a multiple of 64")
  endif()
  math(EXPR missing "(8 - ${bytes} % 8) % 8")
  string(REPEAT "00" ${missing} padding)
  string(REGEX REPLACE "(..)(..)(..)(..)(..)(..)(..)(..)" "0x\\8\\7\\6\\5\\4\\3\\2\\1u," words "${hex}${padding}")
  string(APPEND arrays "
static const uint64_t ${name}[] __attribute__((aligned(MIEN_ALIGNMENT))) = {${words}};
")
  string(APPEND settings "  config->files[${index}] = ${name};
  config->file_bytes[${index}] = ${bytes};
")
  math(EXPR index "${index} + 1")
endforeach()
file(WRITE ${SOURCE} "${arrays}
void mien_use_embedded_weights(mien_weights_config* config) {
${settings}}
")
