// The headless device, its transfers, its frames and its pictures do what every other test relies on.
#include "host/device.h"
#include "host/files.h"
#include "host/frames.h"
#include "host/kernel.h"
#include "host/memory.h"
#include "host/picture.h"
#include "host/select.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <numeric>

namespace gpgp::host {
namespace {

std::filesystem::path scratchFile(const std::string& name) {
  return std::filesystem::path(testing::TempDir()) / ("gpgp_host_test_" + name);
}

class HostDevice : public testing::Test {
protected:
  HeadlessDevice device{DeviceOptions{.validation = true}};
  void TearDown() override {
    for (const std::string& message : device.validationMessages()) ADD_FAILURE() << message;
  }
};

TEST_F(HostDevice, HasQueuesAndAName) {
  EXPECT_NE(device.device(), VK_NULL_HANDLE);
  EXPECT_FALSE(device.name().empty());
  EXPECT_TRUE(device.graphics().flags & VK_QUEUE_COMPUTE_BIT);
  EXPECT_GE(device.properties().apiVersion, VK_API_VERSION_1_2);
}

TEST_F(HostDevice, FillAndReadBack) {
  const Buffer buffer(device, 4096, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, Memory::device, "fill");
  fill(device, buffer, 0xdeadbeef);
  const auto words = download<uint32_t>(device, buffer, 1024);
  EXPECT_EQ(words, std::vector<uint32_t>(1024, 0xdeadbeef));
}

TEST_F(HostDevice, UploadAtAnOffsetLeavesTheRest) {
  const Buffer buffer(device, 64, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  fill(device, buffer, 7);
  const std::vector<uint32_t> values = {1, 2, 3};
  upload(device, buffer, std::span<const uint32_t>(values), 8);
  const auto words = download<uint32_t>(device, buffer, 16);
  EXPECT_EQ(words[1], 7u);
  EXPECT_EQ(words[2], 1u);
  EXPECT_EQ(words[4], 3u);
  EXPECT_EQ(words[5], 7u);
  EXPECT_THROW(upload(device, buffer, std::span<const uint32_t>(values), 60), std::runtime_error);
}

TEST_F(HostDevice, ImageClearAndReadBack) {
  const Image image(device, {.width = 5, .height = 3});
  device.submitAndWait([&](VkCommandBuffer commands) {
    imageBarrier(device, commands, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    const VkClearColorValue colour = {{1.0f, 0.0f, 0.2f, 1.0f}};
    const VkImageSubresourceRange range{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    device.vk().vkCmdClearColorImage(commands, image.handle(), VK_IMAGE_LAYOUT_GENERAL, &colour, 1, &range);
  });
  const auto bytes = downloadImage(device, image, VK_IMAGE_LAYOUT_GENERAL);
  ASSERT_EQ(bytes.size(), 5u * 3 * 4);
  EXPECT_EQ(bytes[4 * 14], 255);
  EXPECT_EQ(bytes[4 * 14 + 1], 0);
  EXPECT_EQ(bytes[4 * 14 + 2], 51);
}

TEST_F(HostDevice, FramesCountWhatIsSafe) {
  const Buffer buffer(device, 256, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  FrameRing ring(device, 2);
  uint64_t safe = 0;
  for (uint32_t i = 1; i <= 7; ++i) {
    VkCommandBuffer commands = ring.begin();
    EXPECT_EQ(ring.frame().current, i);
    EXPECT_GE(ring.frame().safe, safe);
    EXPECT_LT(ring.frame().safe, ring.frame().current);
    EXPECT_LE(ring.frame().current - ring.frame().safe, 2u);
    safe = ring.frame().safe;
    fullBarrier(device, commands);
    device.vk().vkCmdFillBuffer(commands, buffer.handle(), 0, VK_WHOLE_SIZE, i);
    if (i == 7)
      ring.drop();
    else
      ring.submit();
  }
  ring.waitAll();
  EXPECT_EQ(ring.frame().safe, 7u);
  EXPECT_EQ(download<uint32_t>(device, buffer, 1)[0], 6u) << "the dropped frame must not have run";
}

TEST_F(HostDevice, ASecondDeviceLivesBesideTheFirst) {
  HeadlessDevice second{DeviceOptions{.features = 0}}; // without validation: other instance extensions
  EXPECT_EQ(second.features(), 0u);
  const Buffer buffer(second, 16, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  fill(second, buffer, 3);
  EXPECT_EQ(download<uint32_t>(second, buffer, 4), std::vector<uint32_t>(4, 3u));
}

TEST(HostValidation, MistakesAreHeard) {
  HeadlessDevice device{DeviceOptions{.validation = true}};
  const Buffer buffer(device, 1024, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  device.submitAndWait(
      [&](VkCommandBuffer commands) { // two writes without a barrier: only synchronisation validation sees it
        device.vk().vkCmdFillBuffer(commands, buffer.handle(), 0, VK_WHOLE_SIZE, 1);
        device.vk().vkCmdFillBuffer(commands, buffer.handle(), 0, VK_WHOLE_SIZE, 2);
      });
  const auto messages = device.takeValidationMessages();
  ASSERT_FALSE(messages.empty());
  EXPECT_NE(messages[0].find("HAZARD"), std::string::npos) << messages[0];
  EXPECT_TRUE(device.validationMessages().empty());
}

TEST(HostSelect, ByIndexNameAndDefault) {
  const std::vector<DeviceSummary> devices = {
      {0, "Some GPU", "driver", VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU, VK_API_VERSION_1_3},
      {1, "llvmpipe (LLVM)", "llvmpipe Mesa", VK_PHYSICAL_DEVICE_TYPE_CPU, VK_API_VERSION_1_3}};
  EXPECT_EQ(selectDevice(devices, ""), 1u);
  EXPECT_EQ(selectDevice(devices, "0"), 0u);
  EXPECT_EQ(selectDevice(devices, "some gpu"), 0u);
  EXPECT_EQ(selectDevice(devices, "LLVMPIPE"), 1u);
  EXPECT_EQ(selectDevice({devices[0]}, ""), 0u);
  for (const char* wrong : {"2", "99999999999999", "nothing like it"}) {
    try {
      selectDevice(devices, wrong);
      ADD_FAILURE() << wrong;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find("Some GPU"), std::string::npos) << "the message lists what there is";
    }
  }
  EXPECT_THROW(selectDevice({}, ""), std::runtime_error);
}

TEST(HostPicture, PngRoundTrip) {
  Picture picture{17, 5, std::vector<uint8_t>(17 * 5 * 4)};
  std::iota(picture.rgba.begin(), picture.rgba.end(), uint8_t{0});
  const auto file = scratchFile("picture.png");
  writePng(file, picture);
  const Picture again = readPng(file);
  EXPECT_EQ(again.width, 17u);
  EXPECT_EQ(again.height, 5u);
  EXPECT_EQ(again.rgba, picture.rgba);
  std::filesystem::remove(file);
  EXPECT_THROW(readPng(file), std::runtime_error);
}

TEST(HostPicture, ColourConversions) {
  for (int i = 0; i <= 255; ++i) {
    const float v = static_cast<float>(i) / 255.0f;
    EXPECT_NEAR(srgbFromLinear(linearFromSrgb(v)), v, 1e-5f);
  }
  const float halfRed[] = {0.25f, 0.0f, 0.0f, 0.5f}; // premultiplied: straight linear red is 0.5
  EXPECT_EQ(fromLinearPremultiplied(1, 1, halfRed).rgba, (std::vector<uint8_t>{188, 0, 0, 128}));
  const uint8_t encoded[] = {94, 0, 0, 128, 9, 8, 7, 255}; // 187 at half alpha, and one opaque pixel
  EXPECT_EQ(fromPremultiplied(2, 1, encoded).rgba, (std::vector<uint8_t>{187, 0, 0, 128, 9, 8, 7, 255}));
  Picture a{1, 1, {1, 2, 3, 4}}, b{1, 1, {1, 7, 3, 4}};
  EXPECT_EQ(compare(a, b).largest, 5u);
  EXPECT_EQ(compare(a, b).pixelsDifferent, 1u);
  EXPECT_EQ(compare(a, a).pixelsDifferent, 0u);
}

TEST(HostFiles, RoundTripAndErrors) {
  const auto file = scratchFile("file.bin");
  const std::string bytes(100000, 'x');
  writeFile(file, bytes);
  EXPECT_EQ(readText(file), bytes);
  EXPECT_EQ(readFile(file).size(), bytes.size());
  std::filesystem::remove(file);
  EXPECT_THROW(readFile(file), std::runtime_error);
  EXPECT_THROW(readFile(testing::TempDir()), std::runtime_error);
}

TEST(HostFiles, AreReplacedWhole) {
  namespace fs = std::filesystem;
  const fs::path folder = scratchFile("replaced"), file = folder / "file", link = folder / "link",
                 other = folder / "other";
  fs::remove_all(folder);
  const auto count = [&] { return std::distance(fs::directory_iterator(folder), fs::directory_iterator()); };
  writeFile(file, "one"); // makes the folder
  const fs::perms usual = fs::status(file).permissions(), own = fs::perms::owner_read | fs::perms::owner_write;
  fs::permissions(file, own);
  fs::create_symlink("file", link);
  writeFile(link, "two");
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(readText(file), "two");
  EXPECT_EQ(fs::status(file).permissions(), own);
  fs::create_hard_link(file, other);
  writeFile(other, "three");
  EXPECT_EQ(readText(file), "three");
  fs::remove(other);
  fs::remove(file);
  writeFile(link, "four"); // makes what it leads to
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(readText(file), "four");
  EXPECT_EQ(fs::status(file).permissions(), usual);
  writeFile(file, "five");
  EXPECT_EQ(count(), 2);
  // What does not fit leaves all as it was, nothing beside it.
  rlimit limit{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &limit), 0);
  const rlimit small{4096, limit.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  EXPECT_THROW(writeFile(file, std::string(10000, 'x')), std::runtime_error);
  EXPECT_THROW(writeFile(folder / "new", std::string(10000, 'x')), std::runtime_error);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(readText(file), "five");
  EXPECT_EQ(count(), 2);
  EXPECT_THROW(writeFile("/dev/full", "six"), std::runtime_error);
  writeFile("/dev/null", "seven");
  fs::remove_all(folder);
}

} // namespace
} // namespace gpgp::host
