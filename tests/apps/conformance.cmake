# mien-conformance as a program.
if(NOT TARGET mien_conformance_program)  # built without it: MIEN_BUILD_CONFORMANCE
  return()
endif()

find_package(nlohmann_json REQUIRED)

mien_add_test(conformance_program_test conformance_program_test.cpp
  LIBS mien_static nlohmann_json::nlohmann_json)
add_dependencies(conformance_program_test mien_conformance_program)
target_compile_definitions(conformance_program_test PRIVATE
  MIEN_PROGRAM="$<TARGET_FILE:mien_conformance_program>")

add_test(NAME conformance.self_test COMMAND mien_conformance_program --self-test)

# The program with a library without the reference tier (MIEN_TRIM_REF): it must report an error, and
# everything else must work without it.
get_target_property(tiers mien_kernels INTERFACE_SOURCES)
list(FILTER tiers EXCLUDE REGEX mien_kernels_ref)
if(tiers)
  add_library(mien_trimmed_registry OBJECT
    ${PROJECT_SOURCE_DIR}/kernels/detect_cpu.cpp ${PROJECT_SOURCE_DIR}/kernels/registry.cpp
    ${PROJECT_SOURCE_DIR}/kernels/tier.cpp)
  target_link_libraries(mien_trimmed_registry PRIVATE mien_library_options)
  target_compile_definitions(mien_trimmed_registry PRIVATE
    MIEN_TRIM_REF $<TARGET_PROPERTY:mien_kernels,COMPILE_DEFINITIONS>)
  add_executable(mien_conformance_trimmed
    $<TARGET_OBJECTS:mien_conformance_main> $<TARGET_OBJECTS:mien_trimmed_registry> ${tiers}
    $<TARGET_OBJECTS:mien_formats> $<TARGET_OBJECTS:mien_engine> $<TARGET_OBJECTS:mien_audio>
    $<TARGET_OBJECTS:mien_tracker>)
  target_link_libraries(mien_conformance_trimmed PRIVATE mien_warnings mien_conformance)
  add_dependencies(conformance_program_test mien_conformance_trimmed)
  target_compile_definitions(conformance_program_test PRIVATE
    MIEN_TRIMMED_PROGRAM="$<TARGET_FILE:mien_conformance_trimmed>")
endif()

find_program(MIEN_BASH bash)
if(MIEN_BASH)
  add_test(NAME conformance.run_on_device
    COMMAND ${MIEN_BASH} ${CMAKE_CURRENT_SOURCE_DIR}/run_on_device_test.sh
            $<TARGET_FILE:mien_conformance_program>)
endif()

# With fewer instruction sets than this CPU has.
if(CMAKE_SYSTEM_NAME STREQUAL "Linux" AND CMAKE_SYSTEM_PROCESSOR STREQUAL "x86_64" AND NOT MIEN_SANITIZE)
  add_library(mien_mask_cpuid MODULE mask_cpuid.c)
  target_link_libraries(mien_mask_cpuid PRIVATE mien_warnings)
  mien_add_python_test(conformance.cpu_classes ${CMAKE_CURRENT_SOURCE_DIR}/cpu_classes_test.py
    $<TARGET_FILE:mien_conformance_program> $<TARGET_FILE:mien_mask_cpuid> SECONDS 300)
endif()
