# An overlay port that builds the sources it lies in:
#   vcpkg install gpgp --overlay-ports=gpgp/src/cmake/packages/vcpkg
# For a registry, replace SOURCE_PATH by vcpkg_from_git or vcpkg_from_github with the version's tag.
get_filename_component(SOURCE_PATH "${CURRENT_PORT_DIR}/../../../../.." ABSOLUTE)

vcpkg_check_features(OUT_FEATURE_OPTIONS options
  FEATURES
    compiler GPGP_WITH_COMPILER
    text     GPGP_WITH_TEXT)
string(COMPARE EQUAL "${VCPKG_LIBRARY_LINKAGE}" dynamic shared)
string(COMPARE EQUAL "${VCPKG_LIBRARY_LINKAGE}" static static)

vcpkg_find_acquire_program(PKGCONFIG)
vcpkg_add_to_path("${CURRENT_HOST_INSTALLED_DIR}/tools/glslang")
vcpkg_add_to_path("${CURRENT_HOST_INSTALLED_DIR}/tools/spirv-tools")
vcpkg_add_to_path("${CURRENT_HOST_INSTALLED_DIR}/tools/zstd")
vcpkg_cmake_configure(
  SOURCE_PATH "${SOURCE_PATH}"
  OPTIONS
    ${options}
    -DGPGP_BUILD_SHARED=${shared}
    -DGPGP_BUILD_STATIC=${static}
    -DGPGP_BUILD_CLI=OFF
    -DGPGP_BUILD_SAMPLES=OFF
    -DGPGP_BUILD_INTEGRATIONS=OFF
    -DGPGP_BUILD_TESTS=OFF
    -DGPGP_INSTALL=ON
    -DGPGP_WERROR=OFF
    "-DPKG_CONFIG_EXECUTABLE=${PKGCONFIG}")
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH lib/cmake/gpgp)
vcpkg_fixup_pkgconfig()
vcpkg_copy_pdbs()
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include" "${CURRENT_PACKAGES_DIR}/debug/share")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
