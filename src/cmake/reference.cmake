# Target `reference`: the public headers and the guide as HTML, in <build>/reference/html. Any warning is an error.
find_program(GPGP_DOXYGEN doxygen)
if(NOT GPGP_DOXYGEN)
  return()
endif()
set(GPGP_REFERENCE_DIR ${PROJECT_BINARY_DIR}/reference)
configure_file(${PROJECT_SOURCE_DIR}/docs/reference/Doxyfile.in ${GPGP_REFERENCE_DIR}/Doxyfile @ONLY)
add_custom_target(reference COMMAND ${GPGP_DOXYGEN} ${GPGP_REFERENCE_DIR}/Doxyfile
  COMMAND ${CMAKE_COMMAND} -E copy_directory ${PROJECT_SOURCE_DIR}/docs/pictures ${GPGP_REFERENCE_DIR}/html/pictures
  WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} COMMENT "Reference in ${GPGP_REFERENCE_DIR}/html/index.html" VERBATIM)
