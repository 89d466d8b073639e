# What is exported, installed and found again. Runs after all targets of src/ exist.
#
#   shared libraries   export gpgp* and nothing else; soname is the major version
#   install            headers, libraries, gpgpConfig.cmake, gpgp.pc, the gpgp command; relocatable
#
# GPGP_INSTALL is off where gpgp is a part of another project: what that installs is its own affair.
option(GPGP_INSTALL "Make install rules" ${PROJECT_IS_TOP_LEVEL})

foreach(target gpgp gpgp_compiler)
  if(TARGET ${target})
    target_link_options(${target} PRIVATE -Wl,--version-script=${CMAKE_CURRENT_LIST_DIR}/exports.map)
    set_property(TARGET ${target} APPEND PROPERTY LINK_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/exports.map)
  endif()
endforeach()
if(NOT GPGP_INSTALL)
  return()
endif()
include(CMakePackageConfigHelpers)

set(installed)
foreach(target gpgp gpgp_compiler)
  if(GPGP_BUILD_SHARED AND TARGET ${target})
    list(APPEND installed ${target})
  endif()
  if(GPGP_BUILD_STATIC AND TARGET ${target}_static)
    list(APPEND installed ${target}_static)
    # The objects come from other targets, so CMake does not see by itself that C programs need the C++ run time.
    target_link_libraries(${target}_static INTERFACE $<INSTALL_INTERFACE:stdc++>)
  endif()
endforeach()
install(TARGETS ${installed} EXPORT gpgpTargets)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/gpgp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING
  PATTERN "*.h" PATTERN "*.hpp")
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

# The packages and linker flags behind each static library's private dependencies.
set(GPGP_PACKAGES)
foreach(target gpgp gpgp_compiler)
  set(${target}_flags)
  if(TARGET ${target}_static)
    get_target_property(libraries ${target}_static LINK_LIBRARIES)
    foreach(library IN LISTS libraries)
      if(library MATCHES "^gpgp|^Vulkan::|INTERFACE" OR NOT library)
        continue()
      elseif(library MATCHES "^([A-Za-z0-9_]+)::")
        list(APPEND GPGP_PACKAGES ${CMAKE_MATCH_1})
      endif()
      if(library STREQUAL "ZLIB::ZLIB")
        string(APPEND ${target}_flags " -lz")
      else()
        string(REGEX REPLACE "^.*::" "" name ${library})
        string(TOLOWER ${name} name)
        string(APPEND ${target}_flags " -l${name}")
      endif()
    endforeach()
  endif()
endforeach()
list(REMOVE_DUPLICATES GPGP_PACKAGES)

set(cmake_directory ${CMAKE_INSTALL_LIBDIR}/cmake/gpgp)
install(EXPORT gpgpTargets NAMESPACE gpgp:: DESTINATION ${cmake_directory})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/gpgpConfig.cmake.in ${PROJECT_BINARY_DIR}/package/gpgpConfig.cmake
  INSTALL_DESTINATION ${cmake_directory} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/package/gpgpConfigVersion.cmake COMPATIBILITY SameMajorVersion)
install(FILES ${PROJECT_BINARY_DIR}/package/gpgpConfig.cmake ${PROJECT_BINARY_DIR}/package/gpgpConfigVersion.cmake
  DESTINATION ${cmake_directory})

# pkg-config: paths are relative to the .pc file, so that a prefix can be moved.
file(RELATIVE_PATH GPGP_PC_PREFIX /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
set(gpgp_description "${PROJECT_DESCRIPTION}")
set(gpgp_compiler_description "Compilers for gpgp: grammars and SVG to baked assets")
foreach(target gpgp gpgp_compiler)
  if(NOT TARGET ${target} AND NOT TARGET ${target}_static)
    continue()
  endif()
  set(GPGP_PC_NAME ${target})
  set(GPGP_PC_DESCRIPTION "${${target}_description}")
  set(GPGP_PC_PUBLIC "-l${target}")
  set(GPGP_PC_PRIVATE "${${target}_flags} -lstdc++")
  if(target STREQUAL "gpgp_compiler")
    string(PREPEND GPGP_PC_PRIVATE " -lgpgp")
  endif()
  if(NOT GPGP_BUILD_SHARED)
    string(APPEND GPGP_PC_PUBLIC "${GPGP_PC_PRIVATE}")
    set(GPGP_PC_PRIVATE "")
  endif()
  configure_file(${CMAKE_CURRENT_LIST_DIR}/gpgp.pc.in ${PROJECT_BINARY_DIR}/package/${target}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/package/${target}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endforeach()
