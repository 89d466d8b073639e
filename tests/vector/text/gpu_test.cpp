// Text on the GPU: ten thousand glyphs whose string changes every frame, and what that may cost; fonts baked by the
// command beside the same glyphs added live, bit for bit; and seven scripts and emoji as `gpgp text` draws them beside
// pictures that HarfBuzz and cairo make here.
//
// Where GPGP_TEXT_PICTURES names a folder, the scripts are written there, gpgp's above cairo's.
#include "../../api/aligned.h"
#include "../../api/counting_new.h"
#include "../../api/vulkan_proxy.h"
#include "../../cli/files.h"
#include "../../cli/run.h"
#include "fonts.h"
#include "host/frames.h"
#include "host/memory.h"
#include "host/picture.h"
#include "tiny_font.h"

#include <gpgp/vector.h>

#include <algorithm>
#include <array>
#include <cairo-ft.h>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <hb.h>
#include <random>
#include <sstream>
#include FT_COLOR_H
#include FT_OUTLINE_H

namespace gpgp::test {
namespace {

/// A glyph's paths, kept.
struct KeptGlyph {
  std::vector<std::vector<GpgpPathVerb>> verbs;
  std::vector<std::vector<float>> points;
  std::vector<GpgpPath> paths;
  std::vector<VkBool32> foreground;
  static void GPGP_CALL take(void* user, const GpgpGlyphOutline* from) {
    auto& self = *static_cast<KeptGlyph*>(user);
    for (uint32_t i = 0; i < from->pathCount; ++i) {
      const GpgpPath& path = from->paths[i];
      self.verbs.emplace_back(path.verbs, path.verbs + path.verbCount);
      self.points.emplace_back(path.points, path.points + size_t{path.pointCount} * 2);
      self.paths.push_back(path);
      self.foreground.push_back(from->foreground[i]);
    }
    for (size_t i = 0; i < self.paths.size(); ++i)
      self.paths[i].verbs = self.verbs[i].data(), self.paths[i].points = self.points[i].data();
  }
};

struct TextGpu : testing::Test {
  inline static std::unique_ptr<host::HeadlessDevice> shared;
  static void SetUpTestSuite() {
    shared = std::make_unique<host::HeadlessDevice>(host::DeviceOptions{.validation = true});
  }
  static void TearDownTestSuite() { shared.reset(); }

  host::HeadlessDevice& device = *shared;
  VulkanProxy proxy{device};
  std::string message;
  uint64_t hostAllocations = 0;
  GpgpHostAllocator allocator{&hostAllocations,
                              [](void* user, size_t size, size_t alignment) {
                                ++*static_cast<uint64_t*>(user);
                                return allocateAligned(size, alignment);
                              },
                              [](void*, void* memory, size_t, size_t) { freeAligned(memory); }};
  GpgpContext context = nullptr;
  std::unique_ptr<host::FrameRing> ring;
  void SetUp() override {
    GpgpContextCreateInfo info = device.contextCreateInfo();
    info.messageUserData = &message;
    info.messageFn = [](void* user, const GpgpMessage* m) { *static_cast<std::string*>(user) = m->text; };
    info.getInstanceProcAddr = VulkanProxy::getInstanceProcAddr();
    info.hostAllocator = &allocator;
    ASSERT_EQ(gpgpCreateContext(&info, &context), GPGP_SUCCESS);
    ring = std::make_unique<host::FrameRing>(device, 2);
  }
  void TearDown() override {
    ring.reset();
    device.waitIdle();
    gpgpDestroyContext(context);
    for (const std::string& words : device.takeValidationMessages()) ADD_FAILURE() << words;
  }

  GpgpRecorder makeCanvas(uint32_t size, uint32_t maxGlyphs) {
    GpgpCanvasCreateInfo info = GPGP_CANVAS_CREATE_INFO_INIT;
    info.base = {"canvas", device.graphics().family, 0, VK_FALSE};
    info.maxWidth = info.maxHeight = size;
    info.maxPaths = 1u << 20;
    info.maxTileEntries = 1u << 18;
    info.maxGlyphs = maxGlyphs;
    info.targets = GPGP_CANVAS_TARGET_RGBA8;
    GpgpRecorder made = nullptr;
    EXPECT_EQ(gpgpCreateCanvas(context, &info, &made), GPGP_SUCCESS) << message;
    const GpgpPrewarmInfo prewarm = GPGP_PREWARM_INFO_INIT;
    EXPECT_EQ(gpgpPrewarm(made, &prewarm), GPGP_SUCCESS) << message;
    return made;
  }
  GpgpAsset makeSet(const char* file = nullptr) {
    GpgpGlyphSetCreateInfo info = GPGP_GLYPH_SET_CREATE_INFO_INIT;
    info.filePath = file;
    GpgpAsset set = nullptr;
    EXPECT_EQ(gpgpCreateGlyphSet(context, &info, &set), GPGP_SUCCESS) << message;
    return set;
  }
  static GpgpGlyphSetInfo setInfo(GpgpAsset set) {
    GpgpGlyphSetInfo info = GPGP_GLYPH_SET_INFO_INIT;
    EXPECT_EQ(gpgpGetGlyphSetInfo(set, &info), GPGP_SUCCESS);
    return info;
  }
  /// Adds a font's glyphs with their numbers as keys, as `gpgp bake` does, or their outlines.
  void add(GpgpAsset set, GpgpFont font, const std::vector<uint32_t>& glyphs, const GpgpStroke* stroke = nullptr) {
    std::vector<KeptGlyph> kept(glyphs.size());
    std::vector<GpgpGlyph> added;
    for (size_t i = 0; i < glyphs.size(); ++i) {
      GpgpGlyphOutlineInfo info = GPGP_GLYPH_OUTLINE_INFO_INIT;
      info.glyph = glyphs[i];
      info.stroke = stroke;
      ASSERT_EQ(gpgpGetGlyphOutline(font, &info, KeptGlyph::take, &kept[i]), GPGP_SUCCESS);
      added.push_back({uint64_t{stroke != nullptr} << 32 | glyphs[i], kept[i].paths.data(),
                       static_cast<uint32_t>(kept[i].paths.size()), kept[i].foreground.data()});
    }
    std::vector<uint32_t> indices(added.size());
    ASSERT_EQ(gpgpAddGlyphs(set, added.data(), static_cast<uint32_t>(added.size()), indices.data()), GPGP_SUCCESS)
        << message;
  }
  static GpgpCanvasItem item(GpgpAsset set, const std::vector<GpgpGlyphInstance>& glyphs) {
    GpgpCanvasItem item{nullptr, {1, 0, 0, 1, 0, 0}, 1};
    item.glyphSet = set;
    item.glyphs = glyphs.data();
    item.glyphCount = static_cast<uint32_t>(glyphs.size());
    return item;
  }
  static GpgpCanvasInfo canvasInfo(const GpgpCanvasItem& item, const host::Image& image, uint32_t size) {
    GpgpCanvasInfo info = GPGP_CANVAS_INFO_INIT;
    info.width = info.height = size;
    info.items = &item;
    info.itemCount = 1;
    info.exactArea = VK_TRUE;
    info.target =
        image.target({}, {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT, VK_IMAGE_LAYOUT_GENERAL});
    return info;
  }
  /// Uploads and draws, and reads back.
  std::vector<uint8_t> picture(GpgpRecorder canvas, const GpgpCanvasItem& item, uint32_t size) {
    const host::Image image(device, {.format = VK_FORMAT_R8G8B8A8_UNORM, .width = size, .height = size});
    const VkCommandBuffer commands = ring->begin();
    EXPECT_EQ(gpgpAdvance(context, &ring->frame()), GPGP_SUCCESS) << message;
    EXPECT_EQ(gpgpRecordUpload(context, commands, &ring->frame(), 0, nullptr), GPGP_SUCCESS) << message;
    const GpgpCanvasInfo info = canvasInfo(item, image, size);
    EXPECT_EQ(gpgpRecordPrepareCanvas(canvas, commands, &ring->frame(), &info), GPGP_SUCCESS) << message;
    ring->submit();
    ring->waitAll();
    return host::downloadImage(device, image, VK_IMAGE_LAYOUT_GENERAL);
  }
};

/// All glyphs that a text of these characters may need.
std::vector<uint32_t> closure(GpgpFont font, const std::vector<GpgpCharacterRange>& ranges) {
  uint32_t count = 0;
  const auto rangeCount = static_cast<uint32_t>(ranges.size());
  EXPECT_EQ(gpgpGetGlyphClosure(font, ranges.data(), rangeCount, &count, nullptr), GPGP_SUCCESS);
  std::vector<uint32_t> glyphs(count);
  EXPECT_EQ(gpgpGetGlyphClosure(font, ranges.data(), rangeCount, &count, glyphs.data()), GPGP_SUCCESS);
  return glyphs;
}

constexpr uint32_t kSize = 1024;

/// What an engine does with a changed text, once its vectors have grown: keys, indices, instances.
struct Placer {
  std::vector<uint64_t> keys;
  std::vector<uint32_t> indices;
  std::vector<GpgpGlyphInstance> instances;
  GpgpResult place(const GpgpLayoutInfo& layout, GpgpAsset set) {
    keys.clear();
    for (uint32_t i = 0; i < layout.glyphCount; ++i) keys.push_back(layout.glyphs[i].glyph);
    indices.resize(keys.size());
    const GpgpResult found = gpgpFindGlyphs(set, keys.data(), layout.glyphCount, indices.data());
    instances.clear();
    for (uint32_t i = 0; i < layout.glyphCount; ++i) {
      const GpgpTextGlyph& from = layout.glyphs[i];
      instances.push_back(
          {indices[i], from.x, from.y, from.size, {from.color[0], from.color[1], from.color[2], from.color[3]}});
    }
    return found;
  }
};

TEST_F(TextGpu, TenThousandGlyphsWhoseStringChangesEachFrame) {
  GPGP_NEEDS_FONTS();
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "a sanitizer's operator new counts nothing";
#endif
  const FontHandle font = openFont("DejaVuSans.ttf");
  const std::vector<GpgpFont> fonts = {font.get()};
  const GpgpRecorder canvas = makeCanvas(kSize, 13000);
  const GpgpAsset set = makeSet();
  const auto glyphs = closure(font.get(), {{' ', '~'}, {0x400, 0x44f}, {0x2010, 0x2026}, {0x20ac, 0x20ac}});
  add(set, font.get(), glyphs);
  const host::Image image(device, {.format = VK_FORMAT_R8G8B8A8_UNORM, .width = kSize, .height = kSize});

  // Lines of words, of which each frame has others in another order; "ffi" and "fl" are ligatures.
  std::mt19937 random(11);
  const auto word = [&random] {
    static const char* const kWords[] = {"office", "waffles", "score", "gold",  "AVATAR", "fjord", "42",
                                         "1200",   "x=y",     "don’t", "“5 €”", "wait…",  "– —",   "Золото"};
    return std::string(kWords[random() % std::size(kWords)]) + std::to_string(random() % 1000) + ' ';
  };
  std::vector<std::string> pool;
  for (int i = 0; i < 150; ++i) {
    std::string line;
    while (line.size() < 128) line += word();
    pool.push_back(line);
  }
  const auto stringOf = [&] {
    std::string text;
    for (int i = 0; i < 110; ++i) text += pool[random() % pool.size()] + '\n';
    return text;
  };
  Paper paper(size_t{4} << 20);
  Placer placer;
  const auto styled = [&](const std::string& text) {
    GpgpTextInfo info = textInfo(text, fonts, 9);
    return info;
  };
  for (const std::string& line : pool) ASSERT_EQ(paper.set(styled(line)), GPGP_SUCCESS); // shaped, and kept
  std::string text;
  for (const std::string& line : pool) text += line + '\n'; // longer than what comes, so that all vectors grow
  ASSERT_EQ(paper.set(styled(text)), GPGP_SUCCESS);
  ASSERT_EQ(placer.place(paper.info, set), GPGP_SUCCESS);
  GpgpCanvasItem warm = item(set, placer.instances);
  warm.glyphCount = 12000;
  (void)picture(canvas, warm, kSize);
  const GpgpGlyphSetInfo before = setInfo(set);

  std::string last;
  std::vector<uint8_t> seen, lastSeen;
  for (int frame = 0; frame < 5; ++frame) {
    // Two strings of lines that are known, then a line that is new; its shaping is the engine's affair.
    text = stringOf();
    if (frame >= 3) text += "new in frame " + std::to_string(frame);
    ASSERT_NE(text, last);
    last = text;
    const VkCommandBuffer commands = ring->begin();
    const GpgpTextInfo info = styled(text);
    proxy.clear();
    const uint64_t hostBefore = hostAllocations, newBefore = countingNewCalls();
    const GpgpResult laid = gpgpSetLayoutText(paper.layout.get(), &info);
    const uint64_t forLayout = countingNewCalls() - newBefore;
    GpgpLayoutInfo layout = GPGP_LAYOUT_INFO_INIT;
    const GpgpResult known = gpgpGetLayoutInfo(paper.layout.get(), &layout);
    const uint64_t restBefore = countingNewCalls();
    const GpgpResult found = placer.place(layout, set);
    const GpgpResult advanced = gpgpAdvance(context, &ring->frame());
    VkDeviceSize pending = 1;
    const GpgpResult uploaded = gpgpRecordUpload(context, commands, &ring->frame(), 0, &pending);
    const size_t uploads = proxy.calls.size();
    const GpgpCanvasItem placed = item(set, placer.instances);
    const GpgpCanvasInfo canvasRecord = canvasInfo(placed, image, kSize);
    const GpgpResult recorded = gpgpRecordPrepareCanvas(canvas, commands, &ring->frame(), &canvasRecord);
    const uint64_t forRest = countingNewCalls() - restBefore;
    ASSERT_EQ(laid, GPGP_SUCCESS);
    ASSERT_EQ(known, GPGP_SUCCESS);
    ASSERT_EQ(found, GPGP_SUCCESS) << "a glyph is not in the set";
    ASSERT_EQ(advanced, GPGP_SUCCESS);
    ASSERT_EQ(uploaded, GPGP_SUCCESS);
    ASSERT_EQ(recorded, GPGP_SUCCESS) << message;
    ring->submit();
    ring->waitAll();

    // Real glyphs: blanks are not counted among them.
    GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT;
    const std::vector<LoggedCall> calls = proxy.calls;
    ring->begin();
    EXPECT_EQ(gpgpAdvance(context, &ring->frame()), GPGP_SUCCESS) << message;
    ring->submit();
    ring->waitAll();
    while (gpgpGetCanvasReport(canvas, &report) == GPGP_SUCCESS) {
    }
    EXPECT_EQ(report.base.status, GPGP_SUCCESS);
    EXPECT_GE(report.glyphs, 10000u);
    EXPECT_EQ(report.pathsDropped, 0u);

    if (frame < 3) {
      EXPECT_EQ(forLayout, 0u) << "runs that are known";
    } else {
      EXPECT_GT(forLayout, 0u) << "the counter counts: a run is shaped and kept";
    }
    EXPECT_EQ(forRest, 0u) << "allocated behind the callbacks";
    EXPECT_EQ(hostAllocations, hostBefore) << "allocated by the callbacks";
    // Nothing is converted: the set is as it was, and has nothing to upload.
    const GpgpGlyphSetInfo now = setInfo(set);
    EXPECT_EQ(now.glyphs, before.glyphs);
    EXPECT_EQ(now.bytes, before.bytes);
    EXPECT_EQ(now.evicted, before.evicted);
    EXPECT_EQ(pending, 0u);
    EXPECT_EQ(uploads, 0u);
    // The text itself goes up once: written by the record into memory that its passes read. No memory is made or
    // mapped, and all that is copied is the report, the other way.
    size_t copies = 0;
    for (const LoggedCall& call : calls) {
      EXPECT_TRUE(call.name.starts_with("vkCmd") || call.name == "vkUpdateDescriptorSets") << call.name;
      copies += call.name.starts_with("vkCmdCopy") || call.name == "vkCmdUpdateBuffer";
    }
    EXPECT_EQ(copies, 1u);
    seen = host::downloadImage(device, image, VK_IMAGE_LAYOUT_GENERAL);
    EXPECT_NE(seen, lastSeen) << "another picture each frame";
    lastSeen = seen;
  }
  // The last picture is the one of a set that never saw another text.
  const GpgpAsset fresh = makeSet();
  add(fresh, font.get(), glyphs);
  ASSERT_EQ(placer.place(
                [&] {
                  GpgpLayoutInfo layout = GPGP_LAYOUT_INFO_INIT;
                  gpgpGetLayoutInfo(paper.layout.get(), &layout);
                  return layout;
                }(),
                fresh),
            GPGP_SUCCESS);
  EXPECT_TRUE(seen == picture(canvas, item(fresh, placer.instances), kSize));
}

TEST_F(TextGpu, ABakedFontIsDrawnAsTheLiveOneWithoutConversion) {
  GPGP_NEEDS_FONTS();
  struct Case {
    const char *font, *text, *language;
    std::vector<std::string> chosen;
  };
  const std::vector<Case> cases = {
      {"DejaVuSans.ttf",
       "The office: 3 fluffy waffles & é, naïve “AVAT”",
       "en",
       {"--ranges", "U+0020-007E, U+00A0-00FF", "--characters", "“”é"}},
      {"NotoNaskhArabic-Regular.ttf", "الأبواب مفتوحة في الصباح", "ar", {"--characters", "الأبواب مفتوحة في الصباح"}},
      {"NotoSansDevanagari-Regular.ttf", "सुबह खिड़की क्षत्रिय श्रृंखला", "hi", {"--ranges", "U+0900-097F"}}};
  const GpgpRecorder canvas = makeCanvas(512, 1024);
  for (const Case& one : cases) {
    SCOPED_TRACE(one.font);
    const FontHandle font = openFont(one.font);
    const TemporaryFile baked("font.gpgpf");
    std::vector<std::string> arguments = {"bake", fontPath(one.font), "-o", baked.path(), "--outline", "0.125"};
    arguments.insert(arguments.end(), one.chosen.begin(), one.chosen.end());
    const json told = gpgpJson(arguments);
    const GpgpAsset set = makeSet(baked.path().c_str()), live = makeSet();
    const GpgpGlyphSetInfo info = setInfo(set);
    EXPECT_EQ(told["baked"][0]["type"], "font");
    EXPECT_EQ(info.glyphs, told["baked"][0]["glyphs"].get<uint32_t>() * 2) << "and their outlines";
    EXPECT_EQ(told["baked"][0]["missing"], json::array());
    EXPECT_LT(info.glyphs / 2, infoOf(font.get()).glyphCount * 9 / 10);

    // A text of those characters, turned and in two colours: its outlines below it.
    const std::vector<GpgpFont> fonts = {font.get()};
    Paper paper;
    const std::string text = one.text;
    ASSERT_EQ(paper.set(textInfo(text, fonts, 21.5f, 440)), GPGP_SUCCESS);
    ASSERT_EQ(paper.info.missingCount, 0u);
    std::vector<uint32_t> used;
    for (uint32_t i = 0; i < paper.info.glyphCount; ++i) used.push_back(paper.info.glyphs[i].glyph);
    GpgpStroke stroke{};
    stroke.width = 0.125f;
    stroke.join = GPGP_JOIN_ROUND;
    stroke.scale = 256;
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    add(live, font.get(), used);
    add(live, font.get(), used, &stroke);
    const auto placed = [&](GpgpAsset from) {
      std::vector<GpgpGlyphInstance> glyphs;
      for (const uint64_t line : {1u, 0u})
        for (uint32_t i = 0; i < paper.info.glyphCount; ++i) {
          const GpgpTextGlyph& at = paper.info.glyphs[i];
          const uint64_t key = line << 32 | at.glyph;
          uint32_t index = 0;
          EXPECT_EQ(gpgpFindGlyphs(from, &key, 1, &index), GPGP_SUCCESS) << "glyph " << at.glyph;
          glyphs.push_back({index, at.x, at.y, at.size, {line ? 0.1f : 1, 0.2f, line ? 0.9f : 0, 1}});
        }
      return glyphs;
    };
    const auto draw = [&](GpgpAsset from) {
      const std::vector<GpgpGlyphInstance> glyphs = placed(from);
      GpgpCanvasItem turned = item(from, glyphs);
      const float map[6] = {0.96f, 0.21f, -0.21f, 0.96f, 60, 20};
      std::copy_n(map, 6, turned.transform);
      return picture(canvas, turned, 512);
    };
    const std::vector<uint8_t> shown = draw(set);
    EXPECT_GT(std::count_if(shown.begin(), shown.end(), [](uint8_t value) { return value > 0; }), 4000);
    EXPECT_TRUE(shown == draw(live));
    EXPECT_EQ(setInfo(set).glyphs, info.glyphs) << "nothing was added";
    EXPECT_EQ(setInfo(set).evicted, 0u);
    gpgpDestroyAsset(live);
    gpgpDestroyAsset(set);
  }
}

// ---------------------------------------------------------------- alpha

TEST(TextAlpha, CountsOnceForEachLayerOfAColourFont) {
  // A square of the palette, and before it a triangle in the text's colour.
  const std::vector<char> bytes = tinyFont();
  const TemporaryFile file("tiny.ttf", {bytes.data(), bytes.size()}), picture("tiny.png");
  const auto drawn = [&](const char* color) {
    gpgpJson({"text", file.path(), "C", picture.path(), "--size", "80", "--color", color, "--background", "white"});
    const host::Picture shown = host::readPng(picture.path());
    std::array<int, 6> found{}; // in the square alone, and where the triangle lies on it
    for (size_t k = 0; k < 2; ++k) {
      const size_t x = k == 0 ? 42 : 18, y = 60;
      std::copy_n(&shown.rgba[(y * shown.width + x) * 4], 3, &found[k * 3]);
    }
    return found;
  };
  const std::array<int, 6> opaque = drawn("black"), half = drawn("rgb(0 0 0 / 50%)");
  EXPECT_NE(opaque[0] + opaque[1] + opaque[2], 3 * 255);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(opaque[3 + i], 0);
    EXPECT_NEAR(half[i], (opaque[i] + 255) / 2, 1) << "the font's colours fade as well";
    EXPECT_NEAR(half[3 + i], half[i] / 2, 1) << "black, half of it, over them";
  }
}

// ---------------------------------------------------------------- beside HarfBuzz and cairo

struct Face {
  FT_Library library = nullptr;
  FT_Face face = nullptr;
  explicit Face(const std::string& file, long index = 0) {
    EXPECT_EQ(FT_Init_FreeType(&library), 0);
    EXPECT_EQ(FT_New_Face(library, file.c_str(), index, &face), 0) << file;
  }
  ~Face() {
    FT_Done_Face(face);
    FT_Done_FreeType(library);
  }
  Face(const Face&) = delete;
};

/// HarfBuzz's glyphs of a sample, as a line from (0, 0) on to the right; y down.
struct Shaped {
  struct Glyph {
    uint32_t id;
    double x, y;
  };
  std::vector<Glyph> glyphs;
  double ascent = 0; ///< to the baseline, with half of the line gap
  Shaped(const Sample& sample, double size) {
    hb_blob_t* blob = hb_blob_create_from_file(fontPath(sample.font).c_str());
    hb_face_t* face = hb_face_create(blob, sample.face);
    hb_font_t* font = hb_font_create(face);
    const int units = static_cast<int>(hb_face_get_upem(face)) * 64;
    const double scale = size / units;
    hb_font_set_scale(font, units, units);
    hb_buffer_t* buffer = hb_buffer_create();
    hb_buffer_add_utf8(buffer, sample.text, -1, 0, -1);
    hb_buffer_guess_segment_properties(buffer);
    hb_buffer_set_language(buffer, hb_language_from_string(sample.language, -1));
    hb_shape(font, buffer, nullptr, 0);
    unsigned count = 0;
    const hb_glyph_info_t* infos = hb_buffer_get_glyph_infos(buffer, &count);
    const hb_glyph_position_t* places = hb_buffer_get_glyph_positions(buffer, &count);
    double pen = 0;
    for (unsigned i = 0; i < count; ++i) {
      glyphs.push_back({infos[i].codepoint, (pen + places[i].x_offset) * scale, -places[i].y_offset * scale});
      pen += places[i].x_advance;
    }
    hb_font_extents_t extents{};
    hb_font_get_h_extents(font, &extents);
    ascent = (extents.ascender + extents.line_gap / 2.0) * scale;
    hb_buffer_destroy(buffer);
    hb_font_destroy(font);
    hb_face_destroy(face);
    hb_blob_destroy(blob);
  }
};

/// What a glyph is painted of, from below: layers of COLR version 0 as FreeType reads them, or its outline in black.
struct Layer {
  FT_UInt glyph;
  double color[4]; ///< sRGB, straight alpha
};
std::vector<Layer> layersOf(FT_Face face, uint32_t glyph) {
  std::vector<Layer> layers;
  FT_Color* palette = nullptr;
  FT_LayerIterator next{};
  FT_UInt layer = 0, entry = 0;
  if (FT_HAS_COLOR(face) && FT_Palette_Select(face, 0, &palette) == 0 && palette)
    while (FT_Get_Color_Glyph_Layer(face, glyph, &layer, &entry, &next)) {
      const FT_Color color = entry == 0xffff ? FT_Color{0, 0, 0, 255} : palette[entry];
      layers.push_back({layer, {color.red / 255., color.green / 255., color.blue / 255., color.alpha / 255.}});
    }
  if (layers.empty()) layers.push_back({glyph, {0, 0, 0, 1}});
  return layers;
}

/// On white, as large as gpgp's picture: HarfBuzz's glyphs at its places, drawn by cairo. From FreeType's outlines,
/// layer by layer: as unhinted paths, since cairo draws glyphs at whole pixels only, and four times as large, since it
/// counts in 15 rows a pixel. Or from its bitmaps.
host::Picture byCairo(const Sample& sample, double size, uint32_t width, uint32_t height, bool bitmaps) {
  const Face open(fontPath(sample.font), static_cast<long>(sample.face));
  const Shaped shaped(sample, size);
  const int fine = bitmaps ? 1 : 4;
  cairo_surface_t* surface =
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(width) * fine, static_cast<int>(height) * fine);
  cairo_t* cairo = cairo_create(surface);
  cairo_scale(cairo, fine, fine);
  cairo_set_source_rgb(cairo, 1, 1, 1);
  cairo_paint(cairo);
  cairo_set_source_rgb(cairo, 0, 0, 0);
  cairo_set_antialias(cairo, CAIRO_ANTIALIAS_BEST);
  cairo_set_tolerance(cairo, 0.01);
  cairo_font_face_t* type = cairo_ft_font_face_create_for_ft_face(open.face, FT_LOAD_NO_HINTING);
  cairo_font_options_t* options = cairo_font_options_create();
  cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
  cairo_set_font_options(cairo, options);
  cairo_font_options_destroy(options);
  constexpr double kLarge = 64; // FreeType rounds paths to 1/64 of a pixel of the size that they are made at
  // The page begins at a margin, or at ink that reaches beyond.
  double left = 0, top = 0;
  if (!bitmaps) {
    cairo_set_font_face(cairo, type);
    cairo_set_font_size(cairo, size * kLarge);
    const double em = size / open.face->units_per_EM;
    for (const Shaped::Glyph& glyph : shaped.glyphs)
      for (const Layer& layer : layersOf(open.face, glyph.id)) {
        EXPECT_EQ(FT_Load_Glyph(open.face, layer.glyph, FT_LOAD_NO_SCALE), 0);
        FT_BBox box{};
        FT_Outline_Get_CBox(&open.face->glyph->outline, &box);
        if (open.face->glyph->outline.n_points == 0) continue;
        left = std::min(left, glyph.x + static_cast<double>(box.xMin) * em);
        top = std::min(top, shaped.ascent + glyph.y - static_cast<double>(box.yMax) * em);
      }
  }
  const double margin = std::ceil(std::max(2.0, size / 8));
  constexpr double kNothing = 1. / 64;
  cairo_translate(cairo, margin - std::floor(left + kNothing), margin - std::floor(top + kNothing) + shaped.ascent);
  for (const Shaped::Glyph& glyph : shaped.glyphs) { // one after the other, as any text is composited
    cairo_save(cairo);
    cairo_translate(cairo, glyph.x, glyph.y);
    if (bitmaps) {
      EXPECT_EQ(FT_Select_Size(open.face, 0), 0);
      EXPECT_EQ(FT_Load_Glyph(open.face, glyph.id, FT_LOAD_COLOR), 0);
      const FT_GlyphSlot slot = open.face->glyph;
      const double shrink = size / open.face->size->metrics.y_ppem;
      cairo_scale(cairo, shrink, shrink);
      cairo_surface_t* image = cairo_image_surface_create_for_data(
          slot->bitmap.buffer, CAIRO_FORMAT_ARGB32, static_cast<int>(slot->bitmap.width),
          static_cast<int>(slot->bitmap.rows), slot->bitmap.pitch);
      cairo_set_source_surface(cairo, image, slot->bitmap_left, -slot->bitmap_top);
      cairo_paint(cairo);
      cairo_surface_destroy(image);
    } else {
      cairo_scale(cairo, 1 / kLarge, 1 / kLarge);
      for (const Layer& layer : layersOf(open.face, glyph.id)) {
        const cairo_glyph_t one{layer.glyph, 0, 0};
        cairo_set_source_rgba(cairo, layer.color[0], layer.color[1], layer.color[2], layer.color[3]);
        cairo_new_path(cairo);
        cairo_glyph_path(cairo, &one, 1);
        cairo_fill(cairo);
      }
    }
    cairo_restore(cairo);
  }
  cairo_surface_flush(surface);
  host::Picture picture{width, height, std::vector<uint8_t>(size_t{width} * height * 4, 255)};
  const auto stride = static_cast<size_t>(cairo_image_surface_get_stride(surface)), step = static_cast<size_t>(fine);
  const uint8_t* data = cairo_image_surface_get_data(surface);
  for (uint32_t row = 0; row < height; ++row)
    for (uint32_t column = 0; column < width; ++column)
      for (size_t k = 0; k < 3; ++k) {
        size_t sum = 0;
        for (size_t at = 0; at < step * step; ++at)
          sum += data[(row * step + at / step) * stride + (column * step + at % step) * 4 + 2 - k];
        picture.rgba[(size_t{row} * width + column) * 4 + k] =
            static_cast<uint8_t>((sum + step * step / 2) / (step * step));
      }
  cairo_destroy(cairo);
  cairo_font_face_destroy(type);
  cairo_surface_destroy(surface);
  return picture;
}

/// One above the other.
host::Picture stacked(const std::vector<host::Picture>& pictures) {
  host::Picture all{0, 0, {}};
  for (const host::Picture& picture : pictures)
    all.width = std::max(all.width, picture.width), all.height += picture.height;
  for (const host::Picture& picture : pictures)
    for (uint32_t row = 0; row < picture.height; ++row) {
      const auto from = picture.rgba.begin() + static_cast<std::ptrdiff_t>(size_t{row} * picture.width * 4);
      all.rgba.insert(all.rgba.end(), from, from + static_cast<std::ptrdiff_t>(picture.width) * 4);
      all.rgba.resize(all.rgba.size() + size_t{all.width - picture.width} * 4, 255);
    }
  return all;
}

/// A line as `gpgp text` draws it beside cairo's. Returns both.
std::array<host::Picture, 2> compareToCairo(const Sample& line, double size, bool bitmaps = false,
                                            double leastInk = 10) {
  SCOPED_TRACE(line.name);
  const TemporaryFile file("script.png");
  std::ostringstream pixels;
  pixels << size;
  const json told = gpgpJson({"text", fontPath(line.font), line.text, file.path(), "--size", pixels.str(), "--language",
                              line.language, "--background", "white"});
  EXPECT_EQ(told["missing"], json::array());
  const host::Picture ours = host::readPng(file.path());
  const host::Picture theirs = byCairo(line, size, ours.width, ours.height, bitmaps);
  const host::PictureDifference off = host::compare(ours, theirs);
  double ink = 0, sum = 0;
  for (size_t i = 0; i < theirs.rgba.size(); ++i) {
    if (i % 4 == 3) continue;
    ink += 255 - theirs.rgba[i];
    sum += std::abs(int{ours.rgba[i]} - int{theirs.rgba[i]});
  }
  std::printf("%s: mean difference %.3f of 255, %.3f %% of the ink, largest %u\n", line.name,
              sum / static_cast<double>(ours.rgba.size()) * 4 / 3, 100 * sum / ink, off.largest);
  EXPECT_GT(ink / static_cast<double>(theirs.rgba.size()), leastInk);
  EXPECT_LT(sum, 0.02 * ink);
  EXPECT_LE(off.largest, bitmaps ? 64u : 32u);
  return {ours, theirs};
}

void writeRows(const std::string& name, const std::vector<host::Picture>& rows) {
  if (const char* folder = std::getenv("GPGP_TEXT_PICTURES"))
    host::writePng(std::string(folder) + "/" + name, stacked(rows));
}

TEST(TextBesideCairo, SevenScriptsAndEmoji) {
  GPGP_NEEDS_FONTS();
  std::vector<Sample> lines = samples();
  lines[2].text = "החלון פתוח בבוקר ואנשים הולכים לאט בדרך הארוכה"; // the font has no stops
  std::vector<host::Picture> rows;
  for (const Sample& line : lines)
    for (host::Picture& picture : compareToCairo(line, 26.5)) rows.push_back(std::move(picture));
  const Sample emoji{"emoji", "NotoColorEmoji.ttf", "en", "\U0001F98A\U0001F680\u2764\uFE0F\U0001F469\u200D\U0001F4BB"};
  for (host::Picture& picture : compareToCairo(emoji, 96, true)) rows.push_back(std::move(picture));
  writeRows("scripts.png", rows);
}

TEST(TextBesideCairo, ColourLayers) {
  const Sample line{"Quran", "AmiriQuranColored.ttf", "ar", "ٱلۡحَمۡدُ لِلَّهِ رَبِّ ٱلۡعَٰلَمِينَ ٱلرَّحۡمَٰنِ ٱلرَّحِيمِ"};
  if (!std::filesystem::exists(fontPath(line.font))) GTEST_SKIP() << "needs tests/data/fetch.sh --only fonts";
  const auto [ours, theirs] = compareToCairo(line, 64, false, 5); // small letters between tall marks
  writeRows("layers.png", {ours, theirs});
}

} // namespace
} // namespace gpgp::test
