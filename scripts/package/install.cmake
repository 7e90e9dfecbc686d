# Files of `cmake --install`: both libraries, headers, programs and weights, and files for
# find_package and pkg-config. All paths in them are relative, so that the prefix can move.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

set(models_dir ${CMAKE_INSTALL_DATADIR}/mien/models)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/mien)
set(pkgconfig_dir ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

install(TARGETS mien_static mien_shared EXPORT mien)
install(DIRECTORY include/mien DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
set(left_out PATTERN training EXCLUDE)
if(NOT MIEN_WITH_HIFINET)
  list(APPEND left_out PATTERN hifinet.mien EXCLUDE)
endif()
if(NOT MIEN_WITH_AUDIO)
  list(APPEND left_out PATTERN audionet.mien EXCLUDE)
endif()
install(DIRECTORY models/ DESTINATION ${models_dir} ${left_out})
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/mien RENAME copyright)
install(EXPORT mien NAMESPACE mien:: FILE mienTargets.cmake DESTINATION ${package_dir})

if(TARGET mien_program OR TARGET mien_conformance_program)
  install(FILES apps/third_party.txt DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/mien)
endif()
get_target_property(default_target mien ALIASED_TARGET)
if(TARGET mien_program)
  # A statically linked program needs no RPATH, and the padding that CMake reserves for one would mean the current folder.
  if(default_target STREQUAL mien_shared)
    file(RELATIVE_PATH libraries_from_program
      ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR})
    set_target_properties(mien_program PROPERTIES INSTALL_RPATH $ORIGIN/${libraries_from_program})
  endif()
  install(TARGETS mien_program)
  include(scripts/package/install_texts.cmake)
endif()
if(TARGET mien_conformance_program)
  install(TARGETS mien_conformance_program)
endif()

# Binary files of the Python wheel: one library under one name, which the program beside it loads too, both with the C++ library linked
# statically, and packed weights.
if(MIEN_PYTHON_WHEEL)
  include(scripts/package/wheel_models.cmake)
  target_link_options(mien_shared PRIVATE -static-libstdc++ -static-libgcc -s)
  set_property(TARGET mien_shared PROPERTY SOVERSION)
  set_property(TARGET mien_shared PROPERTY VERSION)
  install(FILES $<TARGET_FILE:mien_shared> DESTINATION mien COMPONENT python)
  target_link_options(mien_program PRIVATE -static-libstdc++ -static-libgcc -s
    $<IF:$<PLATFORM_ID:Darwin>,-Wl$<COMMA>-dead_strip,-Wl$<COMMA>--gc-sections>)
  set_target_properties(mien_program PROPERTIES INSTALL_RPATH $<IF:$<PLATFORM_ID:Darwin>,@loader_path,$ORIGIN>
    BUILD_WITH_INSTALL_RPATH ${CMAKE_CROSSCOMPILING})  # a change at installation would invalidate the signature for macOS
  install(TARGETS mien_program DESTINATION mien COMPONENT python)  # what track_file runs
  install(FILES apps/third_party.txt DESTINATION mien COMPONENT python)
  install(DIRECTORY apps/convert/mien_convert/ DESTINATION mien/_convert COMPONENT python FILES_MATCHING PATTERN *.py)
endif()

configure_package_config_file(scripts/package/mienConfig.cmake.in mienConfig.cmake
  INSTALL_DESTINATION ${package_dir} PATH_VARS models_dir)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/mienConfigVersion.cmake
  COMPATIBILITY SameMajorVersion)
install(FILES
  ${CMAKE_CURRENT_BINARY_DIR}/mienConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/mienConfigVersion.cmake
  scripts/package/embed.cmake scripts/package/embed_weights.cmake scripts/package/pack_weights.py
  DESTINATION ${package_dir})

file(RELATIVE_PATH prefix_from_pkgconfig
  ${CMAKE_INSTALL_PREFIX}/${pkgconfig_dir} ${CMAKE_INSTALL_PREFIX})
list(TRANSFORM MIEN_CXX_RUNTIME PREPEND -l OUTPUT_VARIABLE cxx_runtime_flags)
list(JOIN cxx_runtime_flags " " cxx_runtime_flags)
string(REGEX REPLACE "/$" "" prefix_from_pkgconfig ${prefix_from_pkgconfig})
configure_file(scripts/package/mien.pc.in mien.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/mien.pc DESTINATION ${pkgconfig_dir})
