# Writes weight files as a source in C (and C++), and its header.
# usage: cmake -DSOURCE=mien_weights.c -DHEADER=mien_weights.h -DFILES=a.mien;b.mien [-DPACKED=ON] -P embed_weights.cmake
#   PACKED: the files were written by pack_weights.py
cmake_minimum_required(VERSION 3.22)

set(how "Sets the weights in *config; they need not be released.")
if(PACKED)
  string(APPEND how " The first call unpacks them, and
 * has to be over before another thread calls. Damage is found by mien_tracker_create.")
endif()
file(WRITE ${HEADER} "/* Made by mien_embed. */
#ifndef MIEN_WEIGHTS_H_
#define MIEN_WEIGHTS_H_

#include <mien/mien.h>

#ifdef __cplusplus
extern \"C\" {
#endif

/* ${how} */
void mien_use_embedded_weights(mien_tracker_config* config);

#ifdef __cplusplus
}
#endif

#endif
")

# Reads a little-endian number of eight bytes at the offset `at` of a file.
function(read_number file at out)
  file(READ ${file} hex OFFSET ${at} LIMIT 8 HEX)
  string(REGEX REPLACE "(..)(..)(..)(..)(..)(..)(..)(..)" "0x\\8\\7\\6\\5\\4\\3\\2\\1" hex ${hex})
  math(EXPR number ${hex})
  set(${out} ${number} PARENT_SCOPE)
endfunction()

set(arrays "/* Made by mien_embed. Little-endian, as the files are and as all machines are that mien runs on. */
#include \"mien_weights.h\"
")
set(unpacking)
set(settings "")
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
  set(array ${name})
  if(PACKED)
    set(array ${name}_packed)
    set(packed_bytes ${bytes})
    read_number(${file} 24 bytes)  # docs/format.md
    math(EXPR count "${bytes} / 8")
    string(APPEND arrays "
static uint64_t ${name}[${count}] __attribute__((aligned(MIEN_ALIGNMENT)));")
    list(APPEND unpacking "mien_unpack(${array}, ${packed_bytes}, ${name}, ${bytes}) == MIEN_OK")
  endif()
  string(APPEND arrays "
static const uint64_t ${array}[] __attribute__((aligned(MIEN_ALIGNMENT))) = {${words}};
")
  string(APPEND settings "  config->${name} = ${name};
  config->${name}_bytes = ${bytes};
")
endforeach()
if(PACKED)
  list(JOIN unpacking " &&\n               " unpacking)
  set(settings "  static int unpacked = 0;
  if (!unpacked) {
    unpacked = ${unpacking};
  }
${settings}")
endif()
file(WRITE ${SOURCE} "${arrays}
void mien_use_embedded_weights(mien_tracker_config* config) {
${settings}}
")
