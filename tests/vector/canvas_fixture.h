// A canvas that tests raster with: pixels read back, validation messages as failures, and the CPU reference.
#pragma once
#include "../device_test.h"
#include "host/frames.h"
#include "host/memory.h"
#include "host/picture.h"
#include "oracle.h"
#include "vector/cpu_reference/cpu_reference.h"
#include "vector/patch/drawing.h"
#include "vector/raster/place.h"
#include "vector/raster/segments.h"

#include <gpgp/vector.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

namespace gpgp::test {

inline float fromHalf(uint16_t h) {
  const int exponent = (h >> 10) & 31;
  const float mantissa = static_cast<float>(h & 1023);
  const float value = exponent ? std::ldexp(1024 + mantissa, exponent - 25) : std::ldexp(mantissa, -24);
  return h >> 15 ? -value : value;
}

struct Rgba {
  float r = 0, g = 0, b = 0, a = 0;
};

struct CanvasTest : DeviceTest {
  GpgpRecorder canvas = nullptr;
  bool exactArea = false, blendSrgb = false, encodeSrgb = false;
  std::vector<GpgpCanvasImage> images;
  GpgpDrawingMethods drawingMethods = 0;                        ///< of the drawings that are made
  GpgpCanvasMethod canvasMethod = GPGP_CANVAS_FLATTENED;        ///< of the canvases
  GpgpCanvasTargets canvasTargets = GPGP_CANVAS_TARGET_RGBA16F; ///< of the canvases that are made

  void makeCanvas(uint32_t size = 512, uint32_t entries = 0, uint32_t paths = 0,
                  const GpgpTargetInfo* target = nullptr) {
    GpgpCanvasCreateInfo info = GPGP_CANVAS_CREATE_INFO_INIT;
    info.base = {"canvas", device.graphics().family, 0, VK_FALSE};
    info.maxWidth = info.maxHeight = size;
    info.maxTileEntries = entries;
    info.maxPaths = paths ? paths : 65536;
    info.targets = canvasTargets;
    info.method = canvasMethod;
    canvas = recorder(gpgpCreateCanvas, info, target);
  }
  GpgpAsset makeDrawing(const std::vector<GpgpPath>& paths) {
    GpgpDrawingCreateInfo info = GPGP_DRAWING_CREATE_INFO_INIT;
    info.paths = paths.data();
    info.pathCount = static_cast<uint32_t>(paths.size());
    info.methods = drawingMethods;
    GpgpAsset drawing = nullptr;
    EXPECT_EQ(gpgpCreateDrawing(context, &info, &drawing), GPGP_SUCCESS) << lastMessage();
    return drawing;
  }
  GpgpAsset makeDrawing(const std::vector<GpgpPath>& paths, const std::vector<GpgpPathGroup>& groups,
                        GpgpResult expected = GPGP_SUCCESS) {
    GpgpDrawingCreateInfo info = GPGP_DRAWING_CREATE_INFO_INIT;
    info.paths = paths.data();
    info.pathCount = static_cast<uint32_t>(paths.size());
    info.groups = groups.data();
    info.groupCount = static_cast<uint32_t>(groups.size());
    info.methods = drawingMethods;
    GpgpAsset drawing = nullptr;
    EXPECT_EQ(gpgpCreateDrawing(context, &info, &drawing), expected) << lastMessage();
    return drawing;
  }
  GpgpHistory makeView(uint32_t width, uint32_t height) {
    GpgpCanvasHistoryCreateInfo info = GPGP_CANVAS_HISTORY_CREATE_INFO_INIT;
    info.width = width;
    info.height = height;
    GpgpHistory view = nullptr;
    EXPECT_EQ(gpgpCreateCanvasHistory(context, &info, &view), GPGP_SUCCESS) << lastMessage();
    return view;
  }
  static GpgpCanvasItem place(GpgpAsset drawing, float scale = 1, float x = 0, float y = 0) {
    return {drawing, {scale, 0, 0, scale, x, y}, 1};
  }

  /// The items as the test mixes them. They must outlive it.
  GpgpCanvasInfo infoOf(const std::vector<GpgpCanvasItem>& items, uint32_t width, uint32_t height) const {
    GpgpCanvasInfo info = GPGP_CANVAS_INFO_INIT;
    info.width = width;
    info.height = height;
    info.items = items.data();
    info.itemCount = static_cast<uint32_t>(items.size());
    info.exactArea = exactArea;
    info.blendSrgb = blendSrgb;
    info.encodeSrgb = encodeSrgb;
    info.images = images.data();
    info.imageCount = static_cast<uint32_t>(images.size());
    return info;
  }
  /// Rasterises into a half-float image and reads it back.
  std::vector<Rgba> raster(const std::vector<GpgpCanvasItem>& items, uint32_t width, uint32_t height, uint32_t samples,
                           GpgpCanvasReport* report = nullptr) {
    const host::Image image(device, {.format = VK_FORMAT_R16G16B16A16_SFLOAT, .width = width, .height = height});
    const GpgpAccess after{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT, VK_IMAGE_LAYOUT_GENERAL};
    const GpgpFrame frame = advance();
    device.submitAndWait([&](VkCommandBuffer commands) {
      EXPECT_EQ(gpgpRecordUpload(context, commands, &frame, 0, nullptr), GPGP_SUCCESS);
      GpgpCanvasInfo info = infoOf(items, width, height);
      info.samples = samples;
      info.target = image.target({}, after);
      EXPECT_EQ(gpgpRecordPrepareCanvas(canvas, commands, &frame, &info), GPGP_SUCCESS) << lastMessage();
    });
    advance();
    GpgpCanvasReport taken = GPGP_CANVAS_REPORT_INIT;
    EXPECT_EQ(gpgpGetCanvasReport(canvas, &taken), GPGP_SUCCESS);
    if (report) *report = taken;
    const std::vector<uint8_t> bytes = host::downloadImage(device, image, VK_IMAGE_LAYOUT_GENERAL);
    std::vector<Rgba> pixels(size_t(width) * height);
    for (size_t i = 0; i < pixels.size(); ++i) {
      uint16_t h[4];
      std::memcpy(h, bytes.data() + i * 8, 8);
      pixels[i] = {fromHalf(h[0]), fromHalf(h[1]), fromHalf(h[2]), fromHalf(h[3])};
    }
    return pixels;
  }
};

inline TestPath randomShape(uint32_t seed, float size) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> at(-0.1f * size, 1.1f * size);
  TestPath path;
  path.move(at(random), at(random));
  for (int i = 0; i < 8; ++i) {
    const float a = at(random), b = at(random), c = at(random), d = at(random), e = at(random), f = at(random);
    if (i % 3 == 0) path.line(a, b);
    if (i % 3 == 1) path.quad(a, b, c, d);
    if (i % 3 == 2) path.cubic(a, b, c, d, e, f);
  }
  path.close();
  path.color = {1, 1, 1, 1};
  return path;
}

/// An image with one level that canvases can paint with, made of 8-bit RGBA.
struct Texture {
  host::HeadlessDevice& device;
  host::Image image;
  VkSampler sampler = VK_NULL_HANDLE;
  VkFilter filter;

  Texture(host::HeadlessDevice& owner, uint32_t width, uint32_t height, std::span<const uint32_t> texels,
          VkFilter filtering, VkSamplerAddressMode mode)
      : device(owner), image(owner, {.format = VK_FORMAT_R8G8B8A8_UNORM,
                                     .width = width,
                                     .height = height,
                                     .usage = VK_IMAGE_USAGE_SAMPLED_BIT}),
        filter(filtering) {
    VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    info.magFilter = info.minFilter = filter;
    info.addressModeU = info.addressModeV = mode;
    EXPECT_EQ(device.vk().vkCreateSampler(device.device(), &info, nullptr, &sampler), VK_SUCCESS);
    const host::Buffer staging(device, texels.size_bytes(), 0, host::Memory::host);
    std::memcpy(staging.mapped(), texels.data(), texels.size_bytes());
    device.submitAndWait([&](VkCommandBuffer commands) {
      VkImageMemoryBarrier barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
      barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
      barrier.dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
      barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
      barrier.image = image.handle();
      barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
      const auto place = [&](VkPipelineStageFlags from, VkPipelineStageFlags to) {
        device.vk().vkCmdPipelineBarrier(commands, from, to, 0, 0, nullptr, 0, nullptr, 1, &barrier);
      };
      place(VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT);
      VkBufferImageCopy copy{};
      copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
      copy.imageExtent = {width, height, 1};
      device.vk().vkCmdCopyBufferToImage(commands, staging.handle(), image.handle(),
                                         VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
      barrier.oldLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
      barrier.newLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
      barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
      barrier.dstAccessMask = VK_ACCESS_SHADER_READ_BIT;
      place(VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT);
    });
  }
  ~Texture() { device.vk().vkDestroySampler(device.device(), sampler, nullptr); }
  Texture(const Texture&) = delete;
  GpgpCanvasImage view(bool premultiplied = false, GpgpImageEncoding encoding = GPGP_IMAGE_LINEAR) const {
    return {image.view(),  sampler,  VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
            premultiplied, encoding, filter == VK_FILTER_LINEAR ? GPGP_IMAGE_FILTER_LINEAR : GPGP_IMAGE_FILTER_NEAREST};
  }
};

/// The samples that each path of a drawing covers, pixel by pixel, as the CPU reference has them.
struct CpuReference {
  CpuReference(const vector::Drawing& drawing, const shader::ItemRecord& item, uint32_t w, uint32_t h, uint32_t n)
      : width(w), paths(drawing.paths.size(), std::vector<vector::CpuCoverage>(size_t(w) * h)) {
    const vector::Outlines outlines = vector::makeOutlines(drawing, std::pmr::get_default_resource());
    const shader::Grid grid{n, static_cast<int>(h * n), static_cast<int>(w)};
    for (const shader::SegmentRecord& segment : outlines.segments)
      vector::coverSegment(grid, item, segment, paths[segment.path]);
    for (auto& path : paths) vector::closeCoverage(grid, path);
  }
  const vector::CpuCoverage& at(size_t path, uint32_t x, uint32_t y) const { return paths[path][y * width + x]; }

  uint32_t width;
  std::vector<std::vector<vector::CpuCoverage>> paths;
};

} // namespace gpgp::test
