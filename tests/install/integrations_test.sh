#!/usr/bin/env bash
# A project that follows the integrations' pages: it finds an installed gpgp, adds integrations/ from the sources, and
# is made of the pages' own programs. The window's runs on a virtual display, and the validation layer has nothing to say.
#
#   integrations_test.sh PREFIX SOURCE_DIR SCRATCH_DIR CMAKE CXX XVFB_RUN
set -euo pipefail
prefix=$1 source=$2 scratch=$3 cmake=$4 cxx=$5 xvfb=$6
rm -rf "$scratch"
mkdir -p "$scratch"
# block PAGE N: the page's Nth block of C++
block() { awk -v n="$2" '/^```/ { inside = /^```cpp/ && ++count == n; next } inside' "$source/integrations/$1/README.md"; }
# As it is, but that it says when a frame is on its way to the window.
block sdl2 1 | sed 's/swapchain.present(\*image);/& std::puts("shown"), std::fflush(stdout);/' >"$scratch/window.cpp"
sed -i '1i #include <cstdio>' "$scratch/window.cpp"
# The same in a window that is larger than a canvas is where nothing is said.
sed 's/{"tool", 960, 540}/{"tool", 2400, 1300}/' "$scratch/window.cpp" >"$scratch/large.cpp"
if cmp -s "$scratch/window.cpp" "$scratch/large.cpp"; then
  echo "FAILED: the page's window has another size" >&2
  exit 1
fi
{
  cat <<END
#include <gpgp_imgui.hpp>
#include <imgui.h>
using namespace gpgp;
GpgpResult frameOf(GpgpContext context, VkPhysicalDevice physicalDevice, VkDevice device, uint32_t queueFamily,
                   VkRenderPass renderPass, VkCommandBuffer commands, GpgpFrame frame, GpgpAsset gauge, GpgpLayout layout,
                   VkImageView view, VkSampler sampler) {
  VkRenderPassBeginInfo passBegin{};
END
  block imgui 1
  block imgui 2
  echo 'const uint32_t width = 1, height = 1;'
  block imgui 3
  block imgui 4
  echo 'return GPGP_SUCCESS; }'
  # Without a device it says what it needs.
  echo 'int main() { try { imgui::Renderer renderer({}); } catch (const std::exception&) { return 0; } return 1; }'
} >"$scratch/widgets.cpp"
block qt 1 >"$scratch/quick.cpp"
cat >"$scratch/CMakeLists.txt" <<END
cmake_minimum_required(VERSION 3.25)
project(tool LANGUAGES CXX)
find_package(gpgp REQUIRED)
add_subdirectory($source/integrations gpgp-integrations)
foreach(program window large widgets)
  add_executable(\${program} \${program}.cpp)
  target_compile_options(\${program} PRIVATE -Wall -Werror)
endforeach()
target_link_libraries(window PRIVATE gpgp::sdl2)
target_link_libraries(large PRIVATE gpgp::sdl2)
target_link_libraries(widgets PRIVATE gpgp::imgui)
if(TARGET gpgp::qt)
  add_executable(quick quick.cpp)
  target_compile_options(quick PRIVATE -Wall -Werror)
  target_link_libraries(quick PRIVATE gpgp::qt)
  add_dependencies(window quick)
endif()
END
launcher=()
if command -v ccache >/dev/null; then launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
"$cmake" -S "$scratch" -B "$scratch/build" -G Ninja -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_BUILD_TYPE=None \
  -DCMAKE_CXX_COMPILER="$cxx" "${launcher[@]}"
"$cmake" --build "$scratch/build" --target window large widgets
"$scratch/build/widgets"
# They go on until their window is closed, which SDL takes a signal for, and then end well.
run='"$1" >"$2" 2>&1 & program=$!
  for ((i = 0; i < 1200; ++i)); do
    if grep -q shown "$2" || ! kill -0 $program; then break; fi
    sleep 0.1
  done
  sleep 1; kill -TERM $program; wait $program && grep -q shown "$2"'
for program in window large; do
  if ! SDL_VIDEODRIVER=x11 VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation "$xvfb" -a -s "-screen 0 2600x1400x24" \
    bash -c "$run" "$program" "$scratch/build/$program" "$scratch/$program.log"; then
    cat "$scratch/$program.log"
    echo "FAILED: the program of the $program window did not end well" >&2
    exit 1
  fi
  if grep -i "validation" "$scratch/$program.log"; then
    echo "FAILED: validation messages" >&2
    exit 1
  fi
done
