# What `cmake --install` lays down: both libraries, headers, program and weights, and what
# find_package and pkg-config need to find them. All paths inside are relative: a prefix may move.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

set(models_dir ${CMAKE_INSTALL_DATADIR}/mien/models)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/mien)
set(pkgconfig_dir ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

install(TARGETS mien_static mien_shared EXPORT mien)
install(DIRECTORY include/mien DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(DIRECTORY models/ DESTINATION ${models_dir})
install(EXPORT mien NAMESPACE mien:: FILE mienTargets.cmake DESTINATION ${package_dir})

if(TARGET mien_program)
  file(RELATIVE_PATH libraries_from_program
    ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR})
  set_target_properties(mien_program PROPERTIES INSTALL_RPATH $ORIGIN/${libraries_from_program})
  install(TARGETS mien_program)
endif()
if(TARGET mien_conformance_program)
  install(TARGETS mien_conformance_program)
endif()

# Who links the static library with a C compiler has to name these.
set(cxx_runtime ${CMAKE_CXX_IMPLICIT_LINK_LIBRARIES})
list(REMOVE_ITEM cxx_runtime ${CMAKE_C_IMPLICIT_LINK_LIBRARIES})
list(REMOVE_DUPLICATES cxx_runtime)
get_target_property(default_target mien ALIASED_TARGET)

configure_package_config_file(scripts/package/mienConfig.cmake.in mienConfig.cmake
  INSTALL_DESTINATION ${package_dir} PATH_VARS models_dir)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/mienConfigVersion.cmake
  COMPATIBILITY SameMajorVersion)
install(FILES
  ${CMAKE_CURRENT_BINARY_DIR}/mienConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/mienConfigVersion.cmake
  DESTINATION ${package_dir})

file(RELATIVE_PATH prefix_from_pkgconfig
  ${CMAKE_INSTALL_PREFIX}/${pkgconfig_dir} ${CMAKE_INSTALL_PREFIX})
list(TRANSFORM cxx_runtime PREPEND -l OUTPUT_VARIABLE cxx_runtime_flags)
list(JOIN cxx_runtime_flags " " cxx_runtime_flags)
string(REGEX REPLACE "/$" "" prefix_from_pkgconfig ${prefix_from_pkgconfig})
configure_file(scripts/package/mien.pc.in mien.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/mien.pc DESTINATION ${pkgconfig_dir})
