// Images beside cairo's, which mixes texels premultiplied and as they are encoded: in both ways of mixing, whatever an
// image holds and however it is turned.
#include "cairo_fixture.h"
#include "ui_fixture.h"

namespace {
using namespace gpgp;
using namespace gpgp::test;

/// A texture of several levels, of one format and filter, clamped to its edges.
struct LevelledTexture {
  LevelledTexture(host::HeadlessDevice& owner, VkFormat format, uint32_t width, uint32_t height,
                  const std::vector<std::vector<uint8_t>>& levels, VkFilter filter = VK_FILTER_LINEAR)
      : device(owner), image(owner, {.format = format,
                                     .width = width,
                                     .height = height,
                                     .usage = VK_IMAGE_USAGE_SAMPLED_BIT,
                                     .levels = static_cast<uint32_t>(levels.size())}) {
    VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    info.magFilter = info.minFilter = filter;
    info.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
    info.addressModeU = info.addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    info.maxLod = VK_LOD_CLAMP_NONE;
    EXPECT_EQ(device.vk().vkCreateSampler(device.device(), &info, nullptr, &sampler), VK_SUCCESS);
    std::vector<uint8_t> bytes;
    for (const auto& level : levels) bytes.insert(bytes.end(), level.begin(), level.end());
    host::uploadImage(device, image, bytes, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  }
  ~LevelledTexture() { device.vk().vkDestroySampler(device.device(), sampler, nullptr); }
  LevelledTexture(const LevelledTexture&) = delete;

  host::HeadlessDevice& device;
  host::Image image;
  VkSampler sampler = VK_NULL_HANDLE;
};

enum class Holds { linear, encoded, srgbFormat };
constexpr const char* kHolds[] = {"linear light in UNORM", "sRGB in UNORM", "sRGB in SRGB"};

struct ImageTest : CairoTest {
  ImageTest() { exactArea = true; }

  /// How the texels, straight and as the canvas mixes, are held.
  static std::vector<uint8_t> bytesOf(std::span<const Rgba> texels, Holds holds, bool premultiplied, bool blend) {
    std::vector<uint8_t> bytes;
    for (const Rgba& texel : texels) {
      for (float v : {texel.r, texel.g, texel.b}) {
        // Premultiplied is what the format decodes to: linear light in sRGB formats.
        const bool wanted = holds == Holds::encoded;
        if (blend && !wanted) v = host::linearFromSrgb(v);
        if (!blend && wanted) v = host::srgbFromLinear(v);
        if (premultiplied) v *= texel.a;
        if (holds == Holds::srgbFormat) v = host::srgbFromLinear(v);
        bytes.push_back(static_cast<uint8_t>(std::lround(v * 255)));
      }
      bytes.push_back(static_cast<uint8_t>(std::lround(texel.a * 255)));
    }
    return bytes;
  }
  /// A rectangle painted with an image of as many texels, by cairo; `map`: texels to pixels.
  static std::vector<Rgba> paintedByCairo(std::span<const Rgba> texels, uint32_t columns, uint32_t rows,
                                          const std::array<float, 6>& map, const GpgpPath& path, uint32_t size) {
    cairo_surface_t* image =
        cairo_image_surface_create(CAIRO_FORMAT_ARGB32, static_cast<int>(columns), static_cast<int>(rows));
    cairo_surface_flush(image);
    for (uint32_t i = 0; i < columns * rows; ++i) {
      const Rgba& t = texels[i];
      const auto byte = [](float v) { return static_cast<uint32_t>(std::lround(v * 255)); };
      const uint32_t word = byte(t.a) << 24 | byte(t.r * t.a) << 16 | byte(t.g * t.a) << 8 | byte(t.b * t.a);
      std::memcpy(cairo_image_surface_get_data(image) + i / columns * size_t(cairo_image_surface_get_stride(image)) +
                      i % columns * 4,
                  &word, 4);
    }
    cairo_surface_mark_dirty(image);
    const auto pixels = cairoPicture(size, size, [&](cairo_t* c) {
      cairo_pattern_t* pattern = cairo_pattern_create_for_surface(image);
      cairo_pattern_set_filter(pattern, CAIRO_FILTER_BILINEAR);
      cairo_pattern_set_extend(pattern, CAIRO_EXTEND_PAD);
      cairo_matrix_t matrix;
      const auto at = [&](size_t i) { return static_cast<double>(map[i]); };
      cairo_matrix_init(&matrix, at(0), at(1), at(2), at(3), at(4), at(5));
      EXPECT_EQ(cairo_matrix_invert(&matrix), CAIRO_STATUS_SUCCESS);
      cairo_pattern_set_matrix(pattern, &matrix);
      cairo_set_source(c, pattern);
      cairo_pattern_destroy(pattern);
      trace(c, path);
      cairo_clip(c);
      cairo_paint_with_alpha(c, static_cast<double>(path.color[3]));
    });
    cairo_surface_destroy(image);
    return pixels;
  }
};

TEST_F(ImageTest, TexelsMixAsCairosDoWhateverTheImageHolds) {
  constexpr uint32_t kColumns = 5, kRows = 3, kSize = 96;
  makeCanvas(kSize);
  std::mt19937 random(3);
  const auto number = [&] { return static_cast<float>(random() % 256) / 255; };
  std::vector<Rgba> texels(size_t{kColumns} * kRows);
  for (size_t i = 0; i < texels.size(); ++i) // every third one transparent, and of some colour
    texels[i] = {number(), number(), number(), i % 3 == 0 ? 0 : i % 3 == 1 ? 1 : number()};
  TestPath square;
  square.move(4, 4).line(92, 4).line(92, 92).line(4, 92).close();
  for (const float opacity : {1.0f, 0.4f})
    for (const bool blend : {false, true})
      for (const Holds holds : {Holds::linear, Holds::encoded, Holds::srgbFormat})
        for (const bool premultiplied : {false, true}) {
          SCOPED_TRACE(std::string(blend ? "blendSrgb, " : "linear light, ") + kHolds[static_cast<int>(holds)] +
                       (premultiplied ? ", premultiplied" : ", straight") + ", opacity " + std::to_string(opacity));
          blendSrgb = encodeSrgb = blend;
          const std::vector<uint8_t> bytes = bytesOf(texels, holds, premultiplied, blend);
          // What 8 bits make of premultiplied or dark linear colours is not the filter's doing.
          std::vector<Rgba> held;
          for (size_t i = 0; i < texels.size(); ++i) {
            Rgba t{0, 0, 0, static_cast<float>(bytes[i * 4 + 3]) / 255};
            float* const to[] = {&t.r, &t.g, &t.b};
            for (size_t c = 0; c < 3; ++c) {
              float v = static_cast<float>(bytes[i * 4 + c]) / 255;
              if (holds == Holds::srgbFormat) v = host::linearFromSrgb(v);
              if (premultiplied) v = t.a > 0 ? std::min(v / t.a, 1.0f) : 0;
              const bool is = holds == Holds::encoded;
              *to[c] = is == blend ? v : blend ? host::srgbFromLinear(v) : host::linearFromSrgb(v);
            }
            held.push_back(t);
          }
          const LevelledTexture texture(device,
                                        holds == Holds::srgbFormat ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM,
                                        kColumns, kRows, {bytes});
          images = {{texture.image.view(), texture.sampler, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, premultiplied,
                     holds == Holds::encoded ? GPGP_IMAGE_SRGB : GPGP_IMAGE_LINEAR, GPGP_IMAGE_FILTER_LINEAR}};
          for (const std::array<float, 6>& map : // texels to pixels
               {std::array{20.0f, 0.0f, 0.0f, 30.0f, 1.0f, 3.0f}, {11, 7, -6, 14, 20, 10}, {-3, 0, 0, 4, 60, 40}}) {
            GpgpImagePaint paint{0, {}};
            const float sides[] = {kColumns, kColumns, kRows, kRows, 1, 1};
            for (size_t i = 0; i < 6; ++i) paint.transform[i] = map[i] * sides[i];
            GpgpPath path = square.view();
            path.image = &paint;
            path.color[3] = opacity;
            const GpgpAsset drawing = makeDrawing({path});
            const auto ours = raster({place(drawing)}, kSize, kSize, 16);
            gpgpDestroyAsset(drawing);
            const auto theirs = paintedByCairo(held, kColumns, kRows, map, path, kSize);
            size_t worst = 0;
            for (size_t i = 0; i < ours.size(); ++i)
              if (differenceOf(ours[i], theirs[i]) > differenceOf(ours[worst], theirs[worst])) worst = i;
            // Cairo's weights have 7 bits along each axis, and its texels 8 premultiplied. The device's weights may be
            // rounded as well where its sampler mixes them.
            const Rgba &o = ours[worst], &t = theirs[worst];
            const float weights = std::exp2(-static_cast<float>(device.properties().limits.subTexelPrecisionBits));
            EXPECT_LE(differenceOf(o, t), 4.5f / 255 + weights)
                << "pixel " << worst % kSize << " " << worst / kSize << ", map " << map[0] << ": " << o.r << " " << o.g
                << " " << o.b << " " << o.a << ", cairo " << t.r << " " << t.g << " " << t.b << " " << t.a;
          }
        }
}

TEST_F(ImageTest, SmallImagesMixTheirLevelsTheSameWay) {
  // The left half opaque green, the right half transparent red; and black beside white. Each level is the same picture.
  constexpr uint32_t kSide = 32, kSize = 64;
  makeCanvas(kSize + 1);
  const auto levelsOf = [](std::array<uint8_t, 4> left, std::array<uint8_t, 4> right) {
    std::vector<std::vector<uint8_t>> levels;
    for (uint32_t side = kSide; side > 1; side /= 2) {
      auto& level = levels.emplace_back();
      for (uint32_t i = 0; i < side * side; ++i)
        level.insert(level.end(), i % side < side / 2 ? left.begin() : right.begin(),
                     i % side < side / 2 ? left.end() : right.end());
    }
    return levels;
  };
  const LevelledTexture fringe(device, VK_FORMAT_R8G8B8A8_UNORM, kSide, kSide,
                               levelsOf({0, 255, 0, 255}, {255, 0, 0, 0}));
  const LevelledTexture steps(device, VK_FORMAT_R8G8B8A8_UNORM, kSide, kSide,
                              levelsOf({0, 0, 0, 255}, {255, 255, 255, 255}));
  TestPath square;
  square.move(0, 0).line(kSize, 0).line(kSize, kSize).line(0, kSize).close();
  for (const bool blend : {false, true})
    for (const float shown : {300.0f, 32.0f, 21.0f, 12.0f, 5.0f}) {
      SCOPED_TRACE(std::string(blend ? "blendSrgb" : "linear light") + ", shown " + std::to_string(shown) + " wide");
      blendSrgb = encodeSrgb = blend;
      const GpgpImageEncoding own = blend ? GPGP_IMAGE_SRGB : GPGP_IMAGE_LINEAR,
                              other = blend ? GPGP_IMAGE_LINEAR : GPGP_IMAGE_SRGB;
      const auto view = [](const LevelledTexture& from, GpgpImageEncoding encoding) {
        return GpgpCanvasImage{from.image.view(), from.sampler, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                               VK_FALSE,          encoding,     GPGP_IMAGE_FILTER_LINEAR};
      };
      const float begin = 32.25f - shown / 2;
      GpgpImagePaint paint{0, {shown, 0, 0, shown, begin, begin}};
      GpgpPath path = square.view();
      path.image = &paint;
      const GpgpAsset drawing = makeDrawing({path});
      images = {view(fringe, own)};
      const auto green = raster({place(drawing)}, kSize, kSize, 16);
      images = {view(steps, other)};
      const auto grey = raster({place(drawing)}, kSize, kSize, 16);
      gpgpDestroyAsset(drawing);
      size_t between = 0;
      for (size_t i = 0; i < green.size(); ++i) {
        ASSERT_LE(green[i].r, 0.6f / 255) << i; // no red where red is transparent
        ASSERT_NEAR(green[i].g, green[i].a, 0.6f / 255) << i;
        // Black and white mix as their places do, so both pictures have the same weights.
        ASSERT_NEAR(grey[i].r, 1 - green[i].a, 1.5f / 255) << i;
        between += green[i].a > 0.1f && green[i].a < 0.9f;
      }
      EXPECT_GT(between, 20u);
    }
}

TEST_F(ImageTest, NearestTexelsStayWhatTheyAre) {
  makeCanvas(64);
  const LevelledTexture texture(device, VK_FORMAT_R8G8B8A8_UNORM, 2, 1, {{0, 0, 255, 255, 200, 100, 0, 128}},
                                VK_FILTER_NEAREST);
  TestPath square;
  square.move(0, 0).line(64, 0).line(64, 64).line(0, 64).close();
  GpgpImagePaint paint{0, {64, 0, 0, 64, 0, 0}};
  GpgpPath path = square.view();
  path.image = &paint;
  const GpgpAsset drawing = makeDrawing({path});
  images = {{texture.image.view(), texture.sampler, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_FALSE, GPGP_IMAGE_SRGB,
             GPGP_IMAGE_FILTER_NEAREST}};
  const auto pixels = raster({place(drawing)}, 64, 64, 16);
  gpgpDestroyAsset(drawing);
  for (size_t i = 0; i < pixels.size(); ++i) {
    const Rgba wanted =
        i % 64 < 32 ? Rgba{0, 0, 1, 1} : Rgba{200.0f * 128 / 65025, 100.0f * 128 / 65025, 0, 128.0f / 255};
    ASSERT_LE(differenceOf(pixels[i], wanted), 0.6f / 255) << i;
  }
}

TEST_F(ImageTest, WhatAnImageHoldsIsChecked) {
  makeCanvas(64);
  const LevelledTexture texture(device, VK_FORMAT_R8G8B8A8_UNORM, 1, 1, {{255, 255, 255, 255}});
  const GpgpCanvasImage good{
      texture.image.view(), texture.sampler,         VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_FALSE,
      GPGP_IMAGE_LINEAR,    GPGP_IMAGE_FILTER_LINEAR};
  const auto refused = [&](GpgpCanvasImage image, const char* words) {
    images = {image};
    const host::Image target(device, {.format = VK_FORMAT_R16G16B16A16_SFLOAT, .width = 8, .height = 8});
    const GpgpFrame frame = advance();
    device.submitAndWait([&](VkCommandBuffer commands) {
      const std::vector<GpgpCanvasItem> none;
      GpgpCanvasInfo info = infoOf(none, 8, 8);
      info.target = target.target({}, {});
      EXPECT_EQ(gpgpRecordPrepareCanvas(canvas, commands, &frame, &info), GPGP_ERROR_INVALID_ARGUMENT);
      EXPECT_NE(lastMessage().find(words), std::string::npos) << lastMessage();
    });
  };
  GpgpCanvasImage bad = good;
  bad.encoding = 2;
  refused(bad, "images[0].encoding is 2");
  bad = good;
  bad.filter = -1;
  refused(bad, "images[0].filter is -1");
}

} // namespace
