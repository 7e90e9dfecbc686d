# Packed weights of the Python wheel. Without the table of landmarks, which nothing in the package reads: mien.LANDMARK_NAMES has its names.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
set(packer ${PROJECT_SOURCE_DIR}/scripts/package/pack_weights.py)
file(GLOB models CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/models/*.mien)
set(packed_models)
foreach(model IN LISTS models)
  get_filename_component(name ${model} NAME)
  set(packed ${CMAKE_CURRENT_BINARY_DIR}/packed_models/${name})
  add_custom_command(OUTPUT ${packed}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${CMAKE_CURRENT_BINARY_DIR}/packed_models
    COMMAND Python3::Interpreter ${packer} ${model} ${packed}
    DEPENDS ${model} ${packer} VERBATIM)
  list(APPEND packed_models ${packed})
endforeach()
add_custom_target(mien_packed_models ALL DEPENDS ${packed_models})
install(FILES ${packed_models} models/README.md DESTINATION mien/models COMPONENT python)
