# Linux on aarch64, cross-compiled with Debian's g++-aarch64-linux-gnu (docs/guide/platforms.md).
#
#   cmake --preset aarch64
#
# Libraries are where aarch64_sysroot.sh beside this file has unpacked them, or where GPGP_SYSROOT in the environment
# says. Programs run under qemu-user where that is installed.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)

set(sysroot "$ENV{GPGP_SYSROOT}")
if(NOT sysroot)
  cmake_path(ABSOLUTE_PATH CMAKE_CURRENT_LIST_DIR NORMALIZE OUTPUT_VARIABLE sysroot)
  cmake_path(APPEND sysroot ../../../build/aarch64-sysroot)
  cmake_path(NORMAL_PATH sysroot)
endif()
list(APPEND CMAKE_FIND_ROOT_PATH ${CMAKE_PREFIX_PATH} ${sysroot} ${sysroot}/usr)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER) # programs run here
foreach(kind LIBRARY INCLUDE PACKAGE)
  set(CMAKE_FIND_ROOT_PATH_MODE_${kind} ONLY)
endforeach()
set(ENV{PKG_CONFIG_LIBDIR} ${sysroot}/usr/lib/aarch64-linux-gnu/pkgconfig:${sysroot}/usr/share/pkgconfig)
set(ENV{PKG_CONFIG_SYSROOT_DIR} ${sysroot})
foreach(language C CXX) # headers of the sysroot behind the compiler's own
  set(CMAKE_${language}_STANDARD_INCLUDE_DIRECTORIES ${sysroot}/usr/include ${sysroot}/usr/include/aarch64-linux-gnu)
endforeach()
foreach(kind EXE SHARED MODULE) # what libraries link in turn
  set(CMAKE_${kind}_LINKER_FLAGS_INIT "-L${sysroot}/usr/lib/aarch64-linux-gnu -Wl,-rpath-link,${sysroot}/usr/lib/aarch64-linux-gnu:${sysroot}/lib/aarch64-linux-gnu")
endforeach()
find_program(GPGP_QEMU qemu-aarch64)
if(GPGP_QEMU)
  set(CMAKE_CROSSCOMPILING_EMULATOR
    ${GPGP_QEMU} -L /usr/aarch64-linux-gnu -E LD_LIBRARY_PATH=${sysroot}/usr/lib/aarch64-linux-gnu:${sysroot}/lib/aarch64-linux-gnu)
endif()
