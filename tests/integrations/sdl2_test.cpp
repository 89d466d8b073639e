// gpgp::sdl2 in a window: frames in flight have semaphores of their own, however many there are.
#include "gpgp_sdl2.hpp"

#include <gtest/gtest.h>

#include <set>

using namespace gpgp;

TEST(Sdl2Window, EachFrameInFlightHasItsOwnSemaphore) {
  sdl2::Window window({"frames", 160, 120});
  sdl2::DeviceInfo info;
  info.validate = true;
  info.instanceExtensions = window.instanceExtensions();
  info.deviceExtensions = {VK_KHR_SWAPCHAIN_EXTENSION_NAME};
  sdl2::Device device(info);
  for (const uint32_t inFlight : {1u, 2u, 3u, 5u}) {
    sdl2::Swapchain swapchain(device, window);
    sdl2::ColorPass pass(device, swapchain);
    sdl2::Frames frames(device, inFlight);
    std::vector<VkSemaphore> used;
    while (used.size() < 4 * inFlight) {
      VkCommandBuffer commands = frames.begin();
      std::optional<sdl2::Swapchain::Acquired> image;
      while (!(image = swapchain.acquire(frames.slot()))) {
        swapchain.resize();
        pass.attach();
      }
      used.push_back(image->available);
      pass.begin(commands, image->index, {0, 0, 0, 1});
      vkCmdEndRenderPass(commands);
      frames.submit(image->available, swapchain.images()[image->index].rendered);
      swapchain.present(*image);
    }
    // As many as frames in flight, and each again only when the frame that waited for it has finished.
    EXPECT_EQ(std::set<VkSemaphore>(used.begin(), used.end()).size(), inFlight);
    for (size_t i = inFlight; i < used.size(); ++i) EXPECT_EQ(used[i], used[i - inFlight]);
  }
  EXPECT_EQ(device.validationMessages(), 0u);
}

TEST(Sdl2Window, BecomesNoLargerThanItsSwapchain) {
  sdl2::Window window({"large", 900, 500});
  sdl2::DeviceInfo info;
  info.instanceExtensions = window.instanceExtensions();
  info.deviceExtensions = {VK_KHR_SWAPCHAIN_EXTENSION_NAME};
  sdl2::Device device(info);
  sdl2::SwapchainInfo swapchainInfo;
  swapchainInfo.maxExtent = {320, 200};
  const sdl2::Swapchain swapchain(device, window, swapchainInfo);
  EXPECT_EQ(swapchain.maxExtent().width, 320u);
  EXPECT_EQ(swapchain.maxExtent().height, 200u);
  EXPECT_LE(swapchain.extent().width, 320u);
  EXPECT_LE(swapchain.extent().height, 200u);
}
