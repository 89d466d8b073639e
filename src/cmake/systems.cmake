# What a target is by the system it is for.
#
#   gpgp_exports(TARGET MAP)   a shared library exports what the version script MAP names, and hides what it contains
#   gpgp_program(TARGET)       a program that takes UTF-8 and writes it (src/host/windows)
function(gpgp_exports target map)
  if(WIN32)
    return() # by __declspec(dllexport), which GPGP_API says where GPGP_SHARED_BUILD is defined
  endif()
  target_link_options(${target} PRIVATE -Wl,--version-script=${map})
  set_property(TARGET ${target} APPEND PROPERTY LINK_DEPENDS ${map})
endfunction()

function(gpgp_program target)
  if(NOT WIN32)
    return()
  endif()
  cmake_path(SET windows NORMALIZE ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/../host/windows)
  target_sources(${target} PRIVATE ${windows}/program.cpp)
  if(MSVC)
    target_sources(${target} PRIVATE ${windows}/program.manifest)
  else()
    target_sources(${target} PRIVATE ${windows}/program.rc)
    target_link_options(${target} PRIVATE -Wl,--wrap=mbrtowc)
  endif()
endfunction()
