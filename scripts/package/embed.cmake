# mien_embed(TARGET WEIGHTS...): the target carries weight files in itself, for machines without a file system or for one file to
# ship. WEIGHTS: of basenet, proposal (a tracker needs both), hifinet, audionet. Its sources may then
#   #include <mien_weights.h>
#   mien_use_embedded_weights(&config);     // after mien_tracker_config_default
set(MIEN_EMBED_SCRIPT ${CMAKE_CURRENT_LIST_DIR}/embed_weights.cmake CACHE INTERNAL "")
if(DEFINED mien_MODELS_DIR)  # installed
  set(MIEN_EMBED_MODELS ${mien_MODELS_DIR} CACHE INTERNAL "")
else()
  set(MIEN_EMBED_MODELS ${PROJECT_SOURCE_DIR}/models CACHE INTERNAL "")
endif()

function(mien_embed target)
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/${target}_weights)
  set(files)
  foreach(name IN LISTS ARGN)
    if(NOT name MATCHES "^(basenet|proposal|hifinet|audionet)$" OR NOT EXISTS ${MIEN_EMBED_MODELS}/${name}.mien)
      message(FATAL_ERROR "mien_embed(${target}): no weights '${name}' in ${MIEN_EMBED_MODELS}")
    endif()
    list(APPEND files ${MIEN_EMBED_MODELS}/${name}.mien)
  endforeach()
  get_property(languages GLOBAL PROPERTY ENABLED_LANGUAGES)
  set(source ${folder}/mien_weights.c)
  if(NOT C IN_LIST languages)
    set(source ${folder}/mien_weights.cpp)
  endif()
  add_custom_command(OUTPUT ${source} ${folder}/mien_weights.h
    COMMAND ${CMAKE_COMMAND} -DSOURCE=${source} -DHEADER=${folder}/mien_weights.h "-DFILES=${files}" -P ${MIEN_EMBED_SCRIPT}
    DEPENDS ${files} ${MIEN_EMBED_SCRIPT} VERBATIM COMMENT "Embedding weights in ${target}")
  target_sources(${target} PRIVATE ${source} ${folder}/mien_weights.h)
  target_include_directories(${target} PRIVATE ${folder})
endfunction()
