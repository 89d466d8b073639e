# Debian packages by CPack: `cpack -G DEB` in a build folder that was configured with -DCMAKE_INSTALL_PREFIX=/usr.
#
#   libgpgpN             libgpgp and libgpgp_evaluator          the run time, for games
#   libgpgp-compilerN    libgpgp_compiler                       grammars, SVG and Lottie to baked assets
#   libgpgp-textN        libgpgp_text                           fonts, shaping, layout
#   libgpgp-dev          headers, static libraries, CMake package, pkg-config
#   gpgp                 the command
#
# N is the soname's version: the major one, and while that is 0 the minor one as well (0.1). Packages of two such versions
# are installed side by side; libgpgp-dev and gpgp are of one version at a time. CPack finds what the libraries link. None
# of the libraries links another one of them, nor a Vulkan loader.
if(NOT UNIX OR APPLE OR CMAKE_CROSSCOMPILING)
  return()
endif()
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME gpgp)
set(CPACK_PACKAGE_VENDOR "gpgp")
set(CPACK_PACKAGE_CONTACT "gpgp <gpgp@localhost>" CACHE STRING "The maintainer that packages name")
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE zstd)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)

# gpgp_package(COMPONENT NAME SECTION DESCRIPTION [DEPENDS components] [NEEDS "packages"] [SUGGESTS "packages"])
macro(gpgp_package component name section description)
  cmake_parse_arguments(package "" "NEEDS;SUGGESTS" "DEPENDS" ${ARGN})
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name})
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${section})
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "${description}")
  set(CPACK_DEBIAN_${upper}_PACKAGE_DEPENDS "${package_NEEDS}")
  set(CPACK_DEBIAN_${upper}_PACKAGE_SUGGESTS "${package_SUGGESTS}")
  list(APPEND CPACK_COMPONENTS_ALL ${component})
  install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/${name} RENAME copyright
    COMPONENT ${component} EXCLUDE_FROM_ALL) # of packages alone
  string(TOUPPER "CPACK_COMPONENT_${component}_DEPENDS" depends)
  set(${depends} ${package_DEPENDS})
endmacro()

set(CPACK_COMPONENTS_ALL)
set(libraries)
set(private_directories)
if(GPGP_BUILD_SHARED)
  gpgp_package(runtime libgpgp${GPGP_SOVERSION} libs "Geometry processing middleware for Vulkan game engines
 Derives grammars, rasterises vector graphics and finds visible triangles on
 the GPU, in the command buffers of an engine.")
  list(APPEND libraries runtime)
  if(TARGET gpgp_compiler)
    gpgp_package(runtime_compiler libgpgp-compiler${GPGP_SOVERSION} libs "Asset compilers of gpgp
 Turns grammars, SVG and Lottie files into the baked assets that libgpgp loads.")
    list(APPEND libraries runtime_compiler)
  endif()
  if(TARGET gpgp_text)
    gpgp_package(runtime_text libgpgp-text${GPGP_SOVERSION} libs "Text for gpgp
 Opens fonts, shapes and lays out text for canvases of libgpgp.")
    list(APPEND libraries runtime_text)
  endif()
endif()
# What the .pc files require (Requires.private), and what only static libraries link.
set(needs "libvulkan-dev")
if(TARGET gpgp_text OR TARGET gpgp_text_static)
  string(APPEND needs ", libfreetype-dev, libharfbuzz-dev, libfribidi-dev, libicu-dev")
endif()
gpgp_package(dev libgpgp-dev libdevel "Development files of gpgp
 Headers, static libraries, a CMake package and pkg-config files."
  DEPENDS ${libraries} NEEDS "${needs}" SUGGESTS "libzstd-dev, glslang-dev, libpugixml-dev, zlib1g-dev")
if(TARGET gpgp_cli)
  gpgp_package(tools gpgp graphics "The command of gpgp
 Derives grammars, draws SVG and Lottie, samples visibility and bakes assets.")
endif()
# Packages of this build are found by their libraries' own entries, not by dpkg's.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/src)
include(CPack)
