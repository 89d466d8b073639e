# Windows on x86-64, cross-compiled with Debian's g++-mingw-w64-x86-64-posix (docs/guide/platforms.md).
#
#   cmake --preset mingw                                                       gpgp itself
#   cmake -DCMAKE_TOOLCHAIN_FILE=.../mingw.cmake -DCMAKE_PREFIX_PATH=PREFIX    what finds a gpgp installed in PREFIX
#
# Libraries for Windows are where dependencies.sh beside this file has put them, or where GPGP_DEPENDENCIES in the
# environment says. Programs and libraries contain the compiler's run time: nothing has to be copied beside them.
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR x86_64)
set(CMAKE_C_COMPILER x86_64-w64-mingw32-gcc-posix)
set(CMAKE_CXX_COMPILER x86_64-w64-mingw32-g++-posix)
set(CMAKE_RC_COMPILER x86_64-w64-mingw32-windres)
foreach(kind EXE SHARED MODULE)
  set(CMAKE_${kind}_LINKER_FLAGS_INIT -static)
endforeach()

set(dependencies "$ENV{GPGP_DEPENDENCIES}")
if(NOT dependencies)
  cmake_path(ABSOLUTE_PATH CMAKE_CURRENT_LIST_DIR NORMALIZE OUTPUT_VARIABLE dependencies)
  cmake_path(APPEND dependencies ../../../build/mingw-dependencies)
  cmake_path(NORMAL_PATH dependencies)
endif()
list(APPEND CMAKE_FIND_ROOT_PATH ${CMAKE_PREFIX_PATH} ${dependencies} /usr/x86_64-w64-mingw32)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER) # programs run here
foreach(kind LIBRARY INCLUDE PACKAGE)
  set(CMAKE_FIND_ROOT_PATH_MODE_${kind} ONLY)
endforeach()
set(ENV{PKG_CONFIG_LIBDIR} ${dependencies}/lib/pkgconfig)
