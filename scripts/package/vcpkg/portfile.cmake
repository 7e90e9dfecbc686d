# An overlay port for the checkout that contains it: vcpkg install mien --overlay-ports=scripts/package/vcpkg
get_filename_component(SOURCE_PATH ${CURRENT_PORT_DIR}/../../.. ABSOLUTE)

vcpkg_cmake_configure(SOURCE_PATH ${SOURCE_PATH}
  OPTIONS -DMIEN_BUILD_TESTS=OFF -DMIEN_BUILD_APPS=OFF -DMIEN_BUILD_CONFORMANCE=OFF)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(PACKAGE_NAME mien CONFIG_PATH lib/cmake/mien)
vcpkg_fixup_pkgconfig()

# Installs both kinds of library; mien::mien is the one that the triplet selects.
file(REMOVE_RECURSE ${CURRENT_PACKAGES_DIR}/debug/include ${CURRENT_PACKAGES_DIR}/debug/share)
vcpkg_install_copyright(FILE_LIST ${SOURCE_PATH}/LICENSE)
