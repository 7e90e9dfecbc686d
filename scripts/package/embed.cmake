# mien_embed(TARGET [PACKED] WEIGHTS...): embeds weight files in the target, for machines without a file system or for distribution as
# one file. WEIGHTS: basenet and proposal, which every tracker needs, hifinet, audionet. Sources of the target may then
#   #include <mien_weights.h>
#   mien_use_embedded_weights(&config);     // a mien_weights_config, before mien_weights_create
# PACKED: 70 % of the size. mien_weights_create unpacks them. Python packs them when the target is built.
set(MIEN_EMBED_SCRIPT ${CMAKE_CURRENT_LIST_DIR}/embed_weights.cmake CACHE INTERNAL "")
set(MIEN_PACK_SCRIPT ${CMAKE_CURRENT_LIST_DIR}/pack_weights.py CACHE INTERNAL "")
if(DEFINED mien_MODELS_DIR)  # installed
  set(MIEN_EMBED_FOLDER ${mien_MODELS_DIR} CACHE INTERNAL "")
else()
  set(MIEN_EMBED_FOLDER ${PROJECT_SOURCE_DIR}/models CACHE INTERNAL "")
endif()

function(mien_embed target)
  cmake_parse_arguments(ARG "PACKED" "" "" ${ARGN})
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/${target}_weights)
  if(ARG_PACKED)
    find_package(Python3 REQUIRED COMPONENTS Interpreter)
  endif()
  set(files)
  foreach(name IN LISTS ARG_UNPARSED_ARGUMENTS)
    set(file ${MIEN_EMBED_FOLDER}/${name}.mien)
    if(NOT name MATCHES "^(basenet|proposal|hifinet|audionet)$" OR NOT EXISTS ${file})
      message(FATAL_ERROR "mien_embed(${target}): no weights '${name}' in ${MIEN_EMBED_FOLDER}")
    endif()
    if(ARG_PACKED)
      set(packed ${folder}/${name}.packed)
      add_custom_command(OUTPUT ${packed} COMMAND ${Python3_EXECUTABLE} ${MIEN_PACK_SCRIPT} ${file} ${packed}
        DEPENDS ${file} ${MIEN_PACK_SCRIPT} VERBATIM COMMENT "Packing ${name} for ${target}")
      set(file ${packed})
    endif()
    list(APPEND files ${file})
  endforeach()
  file(MAKE_DIRECTORY ${folder})
  get_property(languages GLOBAL PROPERTY ENABLED_LANGUAGES)
  set(source ${folder}/mien_weights.c)
  if(NOT C IN_LIST languages)
    set(source ${folder}/mien_weights.cpp)
  endif()
  add_custom_command(OUTPUT ${source} ${folder}/mien_weights.h
    COMMAND ${CMAKE_COMMAND} -DSOURCE=${source} -DHEADER=${folder}/mien_weights.h "-DFILES=${files}" -DPACKED=${ARG_PACKED}
      -P ${MIEN_EMBED_SCRIPT}
    DEPENDS ${files} ${MIEN_EMBED_SCRIPT} VERBATIM COMMENT "Embedding weights in ${target}")
  target_sources(${target} PRIVATE ${source} ${folder}/mien_weights.h)
  target_include_directories(${target} PRIVATE ${folder})
endfunction()
