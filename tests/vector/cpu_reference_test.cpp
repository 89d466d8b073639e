// The canvas beside its CPU reference, for random records of all that it draws: what the passes leave in scratch
// (items, boxes of tiles, tile words, masks and areas in entries) bit for bit, and the picture within what the CPU
// reference derives.
//
// GPGP_TEST_SEEDS: how many records, GPGP_TEST_FIRST_SEED: from which one on.
#include "api/items.h"
#include "random_record.h"
#include "vector/cpu_reference/cpu_reference.h"
#include "vector/passes/names.h"
#include "vector/patch/patches.h"
#include "vector/raster/canvas.h"
#include "vector/shared/entry.h"

#include <cstdlib>

namespace {
using namespace gpgp;
using namespace gpgp::test;
using shader::CanvasCounters;
using shader::CanvasHeader;
using shader::ItemRecord;
using shader::kTileSize;
using shader::PlacedPath;
using shader::TileWord;
using shader::vec4;
using vector::CpuColor;
using vector::CpuCoverage;
using vector::CpuPlaces;

uint32_t numberFrom(const char* variable, uint32_t otherwise) {
  const char* const value = std::getenv(variable);
  return value ? static_cast<uint32_t>(std::atoi(value)) : otherwise;
}

constexpr uint32_t kWidth = 72, kHeight = 56; // canvases, at most
constexpr uint32_t kEntries = 8192, kItems = 64, kGlyphs = 256, kShapes = 256, kPatches = 16384;
constexpr uint32_t kGlyphKinds = 8;

struct CpuTest : CanvasTest {
  uint32_t maxWidth = kWidth, maxHeight = kHeight;
  host::Buffer scratch;
  std::deque<std::vector<uint32_t>> texels;
  std::deque<Texture> textures;
  std::vector<vector::CpuImage> cpuImages;
  GpgpAsset glyphSet = nullptr;
  std::array<uint32_t, kGlyphKinds> glyphs{};
  RandomPaths glyphPaths;
  std::map<const core::Resident*, std::vector<vec4>> tables; ///< what lies in the device's buffers

  /// Whether the canvas has the passes of software devices.
  bool software() const { return ownContext().device.software && canvasMethod == GPGP_CANVAS_FLATTENED; }
  core::Context& ownContext() const { return *reinterpret_cast<core::Context*>(context); }

  void SetUp() override {
    CanvasTest::SetUp();
    GpgpCanvasCreateInfo info = GPGP_CANVAS_CREATE_INFO_INIT;
    info.base = {"canvas", device.graphics().family, 0, VK_TRUE};
    info.maxWidth = maxWidth;
    info.maxHeight = maxHeight;
    info.maxTileEntries = kEntries;
    info.maxPaths = kPatches;
    info.maxDrawings = kItems;
    info.maxGlyphs = kGlyphs;
    info.maxShapes = kShapes;
    info.targets = GPGP_CANVAS_TARGET_RGBA8 | GPGP_CANVAS_TARGET_RGBA16F;
    info.method = canvasMethod;
    canvas = recorder(gpgpCreateCanvas, info);
    VkDeviceSize bytes = 0;
    ASSERT_EQ(gpgpGetScratchSize(canvas, &bytes, nullptr, nullptr), GPGP_SUCCESS);
    scratch = host::Buffer(device, bytes, core::Recorder::kScratchUsage);
    Dice dice(1);
    const auto add = [&](uint32_t width, uint32_t height, VkFilter filter, VkSamplerAddressMode mode) {
      std::vector<uint32_t>& image = texels.emplace_back();
      for (uint32_t i = 0; i < width * height; ++i) {
        const uint32_t alpha = dice.oneIn(3) ? dice.upTo(256) : 255;
        image.push_back(alpha << 24 | dice.upTo(alpha + 1) << 16 | dice.upTo(alpha + 1) << 8 | dice.upTo(alpha + 1));
      }
      textures.emplace_back(device, width, height, image, filter, mode);
      images.push_back(textures.back().view(dice.oneIn(2), dice.oneIn(2) ? GPGP_IMAGE_SRGB : GPGP_IMAGE_LINEAR));
      cpuImages.push_back({width, height, image, filter, mode});
    };
    add(5, 3, VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_REPEAT);
    add(4, 4, VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
    add(3, 6, VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT);
    add(8, 8, VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER);
    makeGlyphs(dice);
  }
  void TearDown() override {
    gpgpDestroyAsset(glyphSet);
    CanvasTest::TearDown();
  }

  /// Some of one path in the text's colour, some of several and with gradients.
  void makeGlyphs(Dice& dice) {
    const GpgpGlyphSetCreateInfo info = GPGP_GLYPH_SET_CREATE_INFO_INIT;
    ASSERT_EQ(gpgpCreateGlyphSet(context, &info, &glyphSet), GPGP_SUCCESS);
    for (uint32_t k = 0; k < kGlyphKinds; ++k) {
      const Kinds kinds{k >= 6, false, false, false, false, false, false};
      RandomPaths one;
      for (uint32_t i = k < 4 ? 1 : 2 + k % 2; i > 0; --i) one.path(dice, kinds, 1, 0, 0);
      std::vector<VkBool32> foreground;
      for (size_t i = 0; i < one.paths.size(); ++i) foreground.push_back(k < 4 || i == 0);
      const GpgpGlyph glyph{k + 1, one.paths.data(), static_cast<uint32_t>(one.paths.size()), foreground.data()};
      ASSERT_EQ(gpgpAddGlyphs(glyphSet, &glyph, 1, &glyphs[k]), GPGP_SUCCESS) << lastMessage();
    }
    const core::Context* owner = nullptr;
    const auto& set = static_cast<const vector::GlyphSet&>(*api::objectOf(glyphSet, &owner));
    std::vector<vec4>& table = tables[&set];
    for (const uint32_t index : glyphs) {
      const vector::GlyphSet::Glyph& glyph = *set.glyph(index);
      const auto block = set.block(glyph);
      table.resize(std::max(table.size(), size_t(glyph.first) + glyph.size));
      std::memcpy(&table[glyph.first], block.data(), block.size());
    }
  }

  GpgpAsset makeRandomDrawing(Dice& dice, const Kinds& kinds, RandomPaths& from, uint32_t fading) {
    from.add(dice, kinds, dice.between(30, 70), kinds.images ? 2 : 0, 0, fading, 0);
    return keep(makeDrawing(from.paths, from.groups), from);
  }
  /// Notes what lies in a drawing's buffer.
  GpgpAsset keep(GpgpAsset drawing, const RandomPaths& from) {
    const auto memory = std::pmr::get_default_resource();
    const auto converted = vector::makeDrawing(from.paths, from.groups, memory);
    EXPECT_TRUE(converted);
    const auto packed = vector::packDrawing(*converted, vector::makeOutlines(*converted, memory), memory);
    const core::Context* owner = nullptr;
    std::vector<vec4>& table = tables[static_cast<const vector::DrawingAsset*>(api::objectOf(drawing, &owner))];
    table.assign(packed.bytes.size() / sizeof(vec4), {});
    std::memcpy(table.data(), packed.bytes.data(), packed.bytes.size());
    const auto append = [&](const auto& records) {
      const auto* first = reinterpret_cast<const vec4*>(records.data());
      table.insert(table.end(), first, first + records.size() * sizeof records[0] / sizeof(vec4));
    };
    if (drawingMethods & GPGP_DRAWING_PATCHES) {
      const auto patches = vector::makeTilePatches(*converted, memory);
      EXPECT_TRUE(patches);
      append(patches->patches);
      append(patches->curves);
    }
    append(packed.segments);
    return drawing;
  }

  std::vector<GpgpGlyphInstance> makeText(Dice& dice, bool small) {
    std::vector<GpgpGlyphInstance> text;
    float x = dice.between(-5, 30), y = dice.between(5, 50);
    for (uint32_t i = 1 + dice.upTo(12); i > 0; --i) {
      const float size = small ? dice.between(4, 12) : dice.between(4, 30);
      const auto c = dice.color();
      const uint32_t which = small ? dice.upTo(4) : dice.upTo(kGlyphKinds);
      text.push_back({dice.oneIn(9) ? uint32_t(GPGP_GLYPH_NONE) : glyphs[which], x, y, size, {c[0], c[1], c[2], c[3]}});
      x += 0.6f * size;
      if (x > kWidth) x = dice.between(-5, 10), y = dice.between(5, 50);
    }
    return text;
  }

  /// A strip in a box, some of it turned over.
  static std::vector<GpgpListVertex> makeTriangles(Dice& dice, float x, float y, float w, float h) {
    std::vector<GpgpListVertex> corners(5);
    for (GpgpListVertex& v : corners) {
      v.x = x + dice.between(0, w), v.y = y + dice.between(0, h);
      v.u = dice.between(-0.5f, 1.5f), v.v = dice.between(-0.5f, 1.5f);
      v.color[3] = static_cast<uint8_t>(dice.oneIn(2) ? 255 : dice.upTo(256));
      for (int k = 0; k < 3; ++k) v.color[k] = static_cast<uint8_t>(dice.upTo(v.color[3] + 1u));
    }
    std::vector<GpgpListVertex> strip;
    for (size_t i = 0; i + 3 <= corners.size(); ++i)
      strip.insert(strip.end(), {corners[i], corners[i + 1], corners[i + 2]});
    return strip;
  }

  void fillList(Dice& dice, const Kinds& kinds, TestList& list, RandomPaths& paints,
                const std::vector<GpgpAsset>& drawings) {
    uint32_t depth = 0, fades = 0, clips = 0;
    std::vector<int> pushed; // 1: a clip, 2: a group
    for (uint32_t entries = 3 + dice.upTo(10); entries > 0;) {
      const float x = dice.between(-10, 50), y = dice.between(-10, 40), w = dice.between(4, 40),
                  h = dice.between(4, 40);
      GpgpListShape shape = rectangle(x, y, x + w, y + h, dice.color());
      const uint32_t action = dice.upTo(18);
      const auto push = [&](int what) { pushed.push_back(what), ++depth; };
      if (action < 2 && depth < 6) {
        if (kinds.projective && dice.oneIn(3))
          list.push({1, 0, 0.2f, 1, 0, 0, dice.between(0, 0.004f), dice.between(0, 0.004f), 0.9f});
        else if (dice.oneIn(3))
          list.push({-1, 0, 0, 1.25f, 70, -5});
        else
          list.push(turned(dice.between(0, 360), dice.between(0.6f, 1.4f), dice.between(10, 40), dice.between(10, 40)));
        push(0);
        continue;
      }
      if (action == 2 && depth < 6) {
        list.fade(dice.between(0.2f, 1));
        push(0);
        continue;
      }
      if (action < 5 && depth < 6 && clips < 4) {
        if (kinds.groups && dice.oneIn(2))
          list.clip({x - 10, y - 10, x + w + 10, y + h + 10}, {5, 10, 20, 0});
        else
          list.clip({x - 10, y - 10, x + w + 10, y + h + 10});
        push(1);
        ++clips;
        continue;
      }
      if (action == 5 && depth < 6 && fades < 2 && kinds.groups) {
        list.group(dice.oneIn(6) ? 1 : dice.between(0.1f, 0.9f));
        push(2);
        ++fades;
        continue;
      }
      if (action < 8 && depth > 0) {
        list.pop();
        clips -= pushed.back() == 1;
        fades -= pushed.back() == 2;
        pushed.pop_back();
        --depth;
        continue;
      }
      --entries;
      if (action == 8 && kinds.texts) {
        list.add(glyphSet, makeText(dice, dice.oneIn(2)));
        continue;
      }
      if (action == 9 && kinds.severalDrawings) {
        list.add(drawings[dice.upTo(static_cast<uint32_t>(drawings.size()))]);
        continue;
      }
      if (action >= 16) {
        const bool textured = kinds.images && dice.oneIn(2);
        if (!textured && !kinds.gradients) continue;
        list.add(makeTriangles(dice, x, y, w, h), !dice.oneIn(3), textured ? dice.upTo(2) : GPGP_IMAGE_NONE,
                 dice.oneIn(2) ? GPGP_IMAGE_SRGB : GPGP_IMAGE_LINEAR);
        continue;
      }
      if (action == 10) shape = rounded(shape, 4, 8, 2, 6, dice.oneIn(2) ? 3.0f : 0.0f);
      if (action == 11) shape = ellipse(shape, dice.oneIn(2) ? 2.0f : 0.0f);
      if (action == 12) {
        const GpgpListShape from = shape;
        shape = line(x, y, x + h, y + w, dice.between(1, 6), static_cast<GpgpCap>(dice.upTo(3)));
        std::copy_n(from.color, 4, shape.color);
      }
      GpgpListImage image{dice.upTo(2), {0, 0, 1, 1}, {}, {}};
      if (dice.oneIn(2)) { // a nine-slice
        image.source[2] = dice.between(0.5f, 2);
        for (int k = 0; k < 4; ++k)
          image.sourceBorders[k] = dice.between(0, 0.25f), image.borders[k] = dice.between(0.5f, 6);
        for (auto& tile : image.tiles) tile = static_cast<GpgpListTile>(dice.upTo(2));
        image.tileSize[0] = dice.between(3, 9), image.tileSize[1] = dice.between(3, 9);
      }
      if (kinds.gradients && dice.oneIn(3))
        shape.gradient = paints.gradient(dice, 40);
      else if (kinds.images && shape.kind != GPGP_LIST_LINE && dice.oneIn(3))
        shape.image = &image;
      list.add(shape);
    }
    list.pop(static_cast<int>(depth));
  }

  /// Different kinds from seed to seed, so that all shaders have their turn.
  void makeRecord(uint32_t seed, RandomRecord& record) {
    Dice dice(seed);
    const bool alone = seed % 8 == 7; // small glyphs
    const Kinds kinds{!alone && dice.oneIn(2), !alone && dice.oneIn(4), !alone && dice.oneIn(2),
                      !alone && dice.oneIn(4), !alone && dice.oneIn(3), alone || dice.oneIn(3),
                      !alone && dice.oneIn(2)};
    record.width = dice.oneIn(4) ? 1 + dice.upTo(kWidth) : 64;
    record.height = dice.oneIn(4) ? 1 + dice.upTo(kHeight) : 48;
    constexpr std::array<uint32_t, 6> kSamples = {16, 1, 16, 4, 8, 16};
    record.samples = kSamples[dice.upTo(6)];
    record.exactArea = dice.oneIn(2);
    record.blendSrgb = dice.oneIn(2);
    record.encodeSrgb = dice.oneIn(2);
    record.wide = dice.oneIn(2);
    if (dice.oneIn(2)) record.background = {0.25f, 0.5f, 0.125f, 0.75f};
    record.what = "seed " + std::to_string(seed) + ": " + std::to_string(record.width) + " x " +
                  std::to_string(record.height) + ", samples " + std::to_string(record.samples) +
                  (kinds.gradients ? ", gradients" : "") + (kinds.images ? ", images" : "") +
                  (kinds.groups ? ", groups" : "") + (kinds.projective ? ", projective" : "") +
                  (kinds.lists ? ", lists" : "") + (kinds.texts ? ", texts" : "") +
                  (record.exactArea ? ", exactArea" : "") + (record.blendSrgb ? ", blendSrgb" : "") +
                  (record.encodeSrgb ? ", encodeSrgb" : "") + (record.wide ? ", half floats" : ", 8 bits");
    std::deque<RandomPaths> paths;
    for (uint32_t i = kinds.severalDrawings ? 3 : 1; i > 0; --i)
      record.drawings.push_back(makeRandomDrawing(dice, kinds, paths.emplace_back(), kinds.lists ? 2 : 4));
    for (uint32_t i = 1 + dice.upTo(4); i > 0; --i) {
      GpgpCanvasItem item = place(nullptr);
      item.opacity = dice.oneIn(3) ? dice.between(0.1f, 1) : 1;
      const bool text = alone || (kinds.texts && dice.oneIn(2));
      if (text) {
        item.glyphSet = glyphSet;
        const auto& glyphsOfText = record.texts.emplace_back(makeText(dice, alone || dice.oneIn(2)));
        item.glyphs = glyphsOfText.data();
        item.glyphCount = static_cast<uint32_t>(glyphsOfText.size());
      } else if (kinds.lists && dice.oneIn(2)) {
        TestList& list = record.lists.emplace_back(context);
        fillList(dice, kinds, list, record.listPaints.emplace_back(), record.drawings);
        item.list = list.list;
      } else {
        item.drawing = record.drawings[dice.upTo(static_cast<uint32_t>(record.drawings.size()))];
      }
      if (kinds.images) item.firstImage = dice.upTo(3);
      if (!alone && !dice.oneIn(3)) {
        const auto map = kinds.projective && dice.oneIn(2)
                             ? kMaps[4 + dice.upTo(3)]
                             : turned(dice.oneIn(3) ? 90.0f * static_cast<float>(dice.upTo(4)) : dice.between(0, 360),
                                      dice.between(0.3f, 1.5f), dice.between(0, 60), dice.between(0, 50));
        std::copy_n(map.data(), 6, item.transform);
        std::copy_n(map.data() + 6, 3, item.perspective);
        if (dice.oneIn(4)) item.transform[0] = -item.transform[0], item.transform[1] = -item.transform[1];
      }
      if (!alone && dice.oneIn(5)) {
        const float x = dice.between(-5, 40), y = dice.between(-5, 30);
        std::copy_n(std::array{x, y, x + dice.between(5, 50), y + dice.between(5, 40)}.data(), 4, item.scissor);
      }
      record.items.push_back(item);
    }
  }

  /// What a record has left.
  struct Left {
    std::vector<vec4> picture;
    CanvasHeader header;
    CanvasCounters counters;
  };
  template <class T> std::vector<T> read(const char* name, size_t count, VkDeviceSize offset = 0) {
    const core::Context* owner = nullptr;
    const core::PassList& passes = static_cast<const core::Recorder*>(api::objectOf(canvas, &owner))->passes();
    for (size_t i = 0; i < passes.resources.size(); ++i)
      if (passes.resources[i].kind == core::ResourceKind::scratch && !std::strcmp(passes.resources[i].name, name))
        return host::download<T>(device, scratch, count, passes.scratchOffsets[i] + offset);
    ADD_FAILURE() << name;
    return {};
  }
  GpgpCanvasInfo infoOf(const RandomRecord& record) {
    exactArea = record.exactArea;
    blendSrgb = record.blendSrgb;
    encodeSrgb = record.encodeSrgb;
    GpgpCanvasInfo info = CanvasTest::infoOf(record.items, record.width, record.height);
    info.samples = record.samples;
    std::copy_n(record.background.data(), 4, info.background);
    return info;
  }
  Left draw(const RandomRecord& record) {
    Left left{};
    const host::Image image(device, {.format = record.wide ? VK_FORMAT_R16G16B16A16_SFLOAT : VK_FORMAT_R8G8B8A8_UNORM,
                                     .width = record.width,
                                     .height = record.height});
    const GpgpAccess after{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT, VK_IMAGE_LAYOUT_GENERAL};
    host::fill(device, scratch, 0xabababab);
    const GpgpFrame frame = advance();
    device.submitAndWait([&](VkCommandBuffer commands) {
      EXPECT_EQ(gpgpRecordUpload(context, commands, &frame, 0, nullptr), GPGP_SUCCESS);
      GpgpCanvasInfo info = infoOf(record);
      info.base.scratch = scratch.range();
      info.target = image.target({}, after);
      EXPECT_EQ(gpgpRecordPrepareCanvas(canvas, commands, &frame, &info), GPGP_SUCCESS) << lastMessage();
    });
    advance();
    GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT;
    EXPECT_EQ(gpgpGetCanvasReport(canvas, &report), GPGP_SUCCESS);
    EXPECT_EQ(report.pathsDropped, 0u);
    const std::vector<uint8_t> bytes = host::downloadImage(device, image, VK_IMAGE_LAYOUT_GENERAL);
    for (size_t i = 0; i < size_t(record.width) * record.height; ++i) {
      vec4& color = left.picture.emplace_back();
      uint16_t halves[4];
      std::memcpy(halves, &bytes[record.wide ? i * 8 : 0], 8);
      for (int k = 0; k < 4; ++k)
        color[k] = record.wide ? fromHalf(halves[k]) : static_cast<float>(bytes[i * 4 + static_cast<size_t>(k)]) / 255;
    }
    left.header = read<CanvasHeader>("items", 1)[0];
    left.counters = read<CanvasCounters>("counters", 1)[0];
    return left;
  }

  /// What the shaders were given, worked out once more.
  struct Given {
    vector::ItemTables itemTables{{kItems, kGlyphs, kShapes, kPatches}, std::pmr::get_default_resource()};
    std::vector<shader::PlacementRecord> placements{kItems + kGlyphs + kShapes};
    std::vector<vec4> shapes;
    vector::CpuInput input;
    bool alone = false; ///< small glyphs, for which most passes are left out
  };
  void gather(const RandomRecord& record, const CanvasHeader& header, Given& given) {
    const GpgpCanvasInfo info = infoOf(record);
    const bool onSoftware = software();
    vector::Gather gather(ownContext(), {kItems, kGlyphs, kShapes, kPatches}, given.itemTables, given.placements.data(),
                          info, onSoftware ? 0 : kEntries / 2, canvasMethod == GPGP_CANVAS_PATCHES);
    for (uint32_t i = 0; i < info.itemCount; ++i) {
      api::Call call{"cpu"};
      const auto asset = api::resolveItem(call, info.items[i], i, ownContext());
      ASSERT_TRUE(asset);
      ASSERT_TRUE(gather.add(i, *asset));
    }
    CanvasHeader counts{};
    gather.finish(counts);
    ASSERT_EQ(counts.itemCount, header.itemCount);
    ASSERT_EQ(counts.segmentCount, header.segmentCount);
    ASSERT_EQ(counts.pathCount, header.pathCount);
    ASSERT_EQ(counts.sourceCount, header.sourceCount);
    ASSERT_EQ(counts.shapeTables, header.shapeTables);
    const auto add = [&](const auto& records, uint32_t count) {
      const auto* from = reinterpret_cast<const vec4*>(records.data());
      given.shapes.insert(given.shapes.end(), from, from + count * sizeof records[0] / sizeof(vec4));
    };
    add(given.itemTables.shapes, gather.shapes);
    add(given.itemTables.paints, gather.paints);
    add(given.itemTables.stops, gather.stops);
    add(given.itemTables.clips, gather.clips);
    add(given.itemTables.layers, gather.layers);
    gather.placePatchTable(2 * kEntries);
    add(given.itemTables.slots, gather.slots());
    add(given.itemTables.patchItems, gather.patchItems);
    vector::CpuInput& input = given.input;
    input.header = header;
    input.assets.push_back({given.itemTables.slots[0], given.shapes});
    for (const core::Resident* asset : gather.assets())
      input.assets.push_back(
          {given.itemTables.slots[input.assets.size()], tables.at(asset), asset->offset() / sizeof(vec4)});
    input.placements = std::span(given.placements).first(gather.placements());
    input.sources = std::span(given.itemTables.sources).first(gather.sources);
    input.images = cpuImages;
    const bool rich = header.flags & shader::kSplitRich;
    given.alone = gather.smallGlyphs() > 0 && gather.smallGlyphs() == gather.placements() && !gather.gradients && !rich;
  }

  void checkItems(const Given& given, const CpuPlaces& places) {
    const auto items =
        read<ItemRecord>("items", places.items.size(),
                         sizeof(CanvasHeader) + shader::kSlots * sizeof(shader::SlotRecord) + shader::kFirstItems * 4);
    for (size_t i = 0; i < items.size(); ++i) {
      ItemRecord gpu = items[i];
      const ItemRecord& cpu = places.items[i];
      // What leads back into the drawing is as exact as the device divides.
      const shader::PlacementRecord& p = given.input.placements[i];
      const ItemRecord& source = given.input.sources[p.source & ((1u << shader::kSlotBit) - 1)];
      const float unit = 1e-6f / p.size, eye = std::abs(source.eye.x) + std::abs(source.eye.y) + std::abs(source.eye.z);
      const float far = std::abs(p.x) + std::abs(p.y);
      for (int k = 0; k < 4; ++k)
        ASSERT_NEAR(gpu.inverse[k], cpu.inverse[k], unit * (std::abs(source.inverse[k]) + far * eye)) << "item " << i;
      for (int k = 0; k < 2; ++k)
        ASSERT_NEAR(gpu.offsets[k], cpu.offsets[k], unit * (std::abs(source.offsets[k]) + far * (1 + eye)))
            << "item " << i;
      gpu.inverse = cpu.inverse;
      gpu.offsets.x = cpu.offsets.x, gpu.offsets.y = cpu.offsets.y;
      ASSERT_EQ(std::memcmp(&gpu, &cpu, sizeof gpu - 4), 0) << "item " << i; // the last word is nothing
    }
  }

  /// Boxes and colours; and the paths as the GPU has them, which know where their words are.
  void checkPaths(const Given& given, const CpuPlaces& places, std::vector<PlacedPath>& paths) {
    paths = read<PlacedPath>("paths", places.paths.size());
    const bool encoded = given.input.header.flags & shader::kBlendSrgb;
    for (size_t i = 0; i < paths.size(); ++i) {
      PlacedPath gpu = paths[i];
      const PlacedPath& cpu = places.paths[i];
      for (int k = 0; k < 4; ++k) {
        ASSERT_NEAR(gpu.color[k], cpu.color[k], encoded && k < 3 ? 2e-5f * cpu.color[k] : 0) << "path " << i;
        gpu.color[k] = cpu.color[k];
      }
      gpu.firstWord = cpu.firstWord;
      ASSERT_EQ(std::memcmp(&gpu, &cpu, sizeof gpu), 0)
          << "path " << i << ": " << gpu.left << " " << gpu.top << " " << gpu.right << " " << gpu.bottom << ", cpu "
          << cpu.left << " " << cpu.top << " " << cpu.right << " " << cpu.bottom;
    }
  }

  /// What pixel x of row y of an entry's tile says.
  CpuCoverage decode(std::span<const uint32_t> entry, uint32_t x, uint32_t y, uint32_t whole) const {
    const uint32_t* row = entry.data() + y * (kTileSize / 2);
    const auto four = [](const uint32_t* words) { return shader::uvec4(words[0], words[1], words[2], words[3]); };
    if (!software())
      return {shader::foldRow(four(row), x) ^ whole, shader::differenceAt(four(row + shader::kEntryWords / 2), x)};
    CpuCoverage found{whole, static_cast<int>(entry[y * kTileSize + x]) >> 16};
    for (uint32_t k = 0; k <= x; ++k) found.mask ^= entry[y * kTileSize + k] & 0xffff;
    return found;
  }

  /// Tile words, and what they and entries say of every pixel.
  void checkTiles(const Given& given, const CpuPlaces& places, std::span<const PlacedPath> paths, const Left& left) {
    const CanvasHeader& header = given.input.header;
    const auto words = read<TileWord>("tile words", left.counters.words);
    const auto entries = read<uint32_t>("entries", size_t(kEntries) * shader::kEntryWords);
    ASSERT_EQ(left.counters.words, places.words.size());
    ASSERT_EQ(left.counters.entries, places.entries);
    ASSERT_EQ(left.counters.smallGlyph, places.smallGlyphEntries);
    const uint32_t every = (1u << header.samples) - 1;
    const bool areas = header.flags & shader::kExactArea;
    std::vector<bool> taken(kEntries);
    for (size_t i = 0; i < paths.size(); ++i) {
      const PlacedPath& p = paths[i];
      const std::string path = "path " + std::to_string(i);
      const uint32_t inRow = (p.right - p.left + 31) / 32;
      for (uint32_t y = 0; y < header.tilesY; ++y)
        for (uint32_t x = 0; x < header.tilesX; ++x) {
          const std::string where = path + ", tile " + std::to_string(x) + " " + std::to_string(y);
          const bool within = x >= p.left && x < p.right && y >= p.top && y < p.bottom;
          uint32_t whole = 0;
          std::span<const uint32_t> entry;
          if (within) {
            const uint32_t at = (y - p.top) * inRow + (x - p.left) / 32, bit = 1u << ((x - p.left) & 31);
            const TileWord &gpu = words[p.firstWord + at], &cpu = places.words[places.paths[i].firstWord + at];
            ASSERT_EQ(gpu.edges & bit, cpu.edges & bit) << where;
            ASSERT_EQ(gpu.inside & bit, cpu.inside & bit) << where;
            whole = gpu.inside & bit ? every : 0;
            if (gpu.edges & bit) {
              const size_t which = gpu.firstEntry + static_cast<uint32_t>(shader::bitCount(gpu.edges & (bit - 1)));
              ASSERT_LT(which, kEntries) << where;
              ASSERT_FALSE(taken[which]) << where;
              taken[which] = true;
              entry = std::span(entries).subspan(which * shader::kEntryWords, shader::kEntryWords);
            }
          }
          for (uint32_t k = 0; k < kTileSize * kTileSize; ++k) {
            const uint32_t px = x * kTileSize + k % kTileSize, py = y * kTileSize + k / kTileSize;
            if (px >= header.width || py >= header.height) continue;
            CpuCoverage cpu = places.at(header, i, px, py);
            if (!areas) cpu.difference = 0;
            const CpuCoverage gpu =
                entry.empty() ? CpuCoverage{whole, 0} : decode(entry, k % kTileSize, k / kTileSize, whole);
            ASSERT_EQ(gpu.mask, cpu.mask) << where << ", pixel " << px << " " << py;
            ASSERT_EQ(gpu.difference, cpu.difference) << where << ", pixel " << px << " " << py;
          }
        }
    }
  }

  /// Bins' paths, and for each tile its list or whether the general shader takes it.
  void checkLists(const Given& given, const CpuPlaces& places, const Left& left) {
    const CanvasHeader& header = given.input.header;
    const uint32_t tiles = header.tilesX * header.tilesY,
                   binsEnd = shader::kFirstBin + header.binCount * header.binWords;
    const bool onSoftware = software();
    const uint32_t firstList = (binsEnd + 3) & ~3u;
    const auto bins = read<uint32_t>("bins", onSoftware ? firstList + tiles * (header.listWords + 3)
                                                        : binsEnd + 2 * tiles + left.counters.listed);
    const auto binned = vector::binOnCpu(given.input, places);
    for (uint32_t bin = 0; bin < header.binCount; ++bin) {
      const uint32_t* head = &bins[shader::kFirstBin + bin * header.binWords];
      std::vector<uint32_t> found;
      for (uint32_t i = header.pathCount; i > 0; --i)
        if (head[shader::kBinHead + (i - 1) / 32] >> ((i - 1) & 31) & 1) found.push_back(i - 1);
      ASSERT_EQ(found, binned[bin]) << "bin " << bin;
      if (onSoftware || head[0] == 0) continue;
      const std::vector<uint32_t> listed(&bins[head[1]], &bins[head[1]] + head[0] - 1);
      ASSERT_EQ(listed, binned[bin]) << "list of bin " << bin;
    }
    if (!onSoftware) {
      if ((header.flags & shader::kSplitRich) == 0) return;
      const std::vector<bool> rich = vector::splitOnCpu(given.input, places);
      for (uint32_t tile = 0; tile < tiles; ++tile)
        ASSERT_EQ(bins[binsEnd + tiles + tile] == 2, rich[tile]) << "tile " << tile; // kRich of lists.glsl
      return;
    }
    const auto lists = vector::listOnCpu(given.input, places, (header.listWords - 2) / 2);
    std::vector<int> kinds(tiles, vector::CpuList::solid); // by the lists of tiles that passes take
    const uint32_t painted = firstList + tiles * header.listWords, crowded = painted + tiles, rows = crowded + tiles;
    for (uint32_t i = 0; i < bins[shader::kPaintedArguments + 3]; ++i)
      kinds[bins[painted + i]] = vector::CpuList::pixels;
    for (uint32_t i = 0; i < bins[shader::kRichArguments + 3]; ++i)
      kinds[bins[painted + tiles - 1 - i]] = vector::CpuList::rich;
    for (uint32_t i = 0; i < bins[shader::kCrowdedArguments + 3]; ++i)
      kinds[bins[crowded + i]] = vector::CpuList::crowded;
    for (uint32_t i = 0; i < bins[shader::kRichCrowdedArguments + 3]; ++i)
      kinds[bins[crowded + tiles - 1 - i]] = vector::CpuList::crowded;
    for (uint32_t i = 0; i < left.counters.listed; ++i) kinds[bins[rows + i]] = vector::CpuList::rows;
    for (uint32_t tile = 0; tile < tiles; ++tile) {
      ASSERT_EQ(kinds[tile], lists[tile].kind) << "tile " << tile;
      const uint32_t* list = &bins[firstList + tile * header.listWords];
      ASSERT_EQ(list[0] == ~0u, lists[tile].kind == vector::CpuList::solid) << "tile " << tile;
      if (list[0] == ~0u) continue;
      ASSERT_EQ(list[0], lists[tile].paths.size()) << "tile " << tile;
      for (uint32_t k = 0; k < list[0]; ++k) {
        const vector::CpuList::Listed& expected = lists[tile].paths[k];
        const uint32_t code = list[2 + 2 * k];
        ASSERT_EQ(list[3 + 2 * k], expected.path) << "tile " << tile << ", path " << k << " of its list";
        ASSERT_EQ(code > 1, expected.edges) << "tile " << tile << ", path " << k << " of its list";
        ASSERT_EQ(code & 1, expected.inside) << "tile " << tile << ", path " << k << " of its list";
      }
    }
  }

  /// How far rounding to the format may lead. Of 8 bits Vulkan lets a device take either neighbour and only prefers the
  /// nearer one; hardware keeps within what Direct3D tolerates, 0.6 of a step.
  float roundingAt(float value, bool wide) const {
    if (!wide) return (ownContext().device.software ? 0.5f : 0.6f) / 255;
    return std::ldexp(1.0f, std::max(std::ilogb(std::max(std::abs(value), 1e-30f)), -14) - 10);
  }
  void checkPicture(const RandomRecord& record, const Given& given, const CpuPlaces& places, const Left& left) {
    const std::vector<CpuColor> picture = vector::paintOnCpu(given.input, places);
    for (size_t i = 0; i < picture.size(); ++i) {
      bool doubtful = false;
      for (int k = 0; k < 4; ++k) {
        const float most = record.wide ? 65504.0f : 1.0f, expected = std::clamp(picture[i].color[k], 0.0f, most);
        const float found = left.picture[i][k], doubt = picture[i].doubt[k];
        doubtful = doubtful || doubt > 0.02f;
        ASSERT_NEAR(found, expected, doubt + roundingAt(expected, record.wide))
            << "pixel " << i % record.width << " " << i / record.width << ", channel " << k << ", doubt " << doubt;
      }
      doubted += doubtful;
      ++compared;
    }
  }
  size_t doubted = 0, compared = 0, patched = 0; ///< pixels, and records with items that patches draw

  /// All of that for one record, whose drawings it destroys.
  void check(const RandomRecord& record) {
    SCOPED_TRACE(record.what);
    const Left left = draw(record);
    Given given;
    gather(record, left.header, given);
    if (HasFatalFailure()) return;
    patched += left.header.patchTable != 0;
    const CpuPlaces places = vector::placeOnCpu(given.input);
    std::vector<PlacedPath> paths;
    if (!given.alone) {
      checkItems(given, places);
      if (!HasFatalFailure()) checkPaths(given, places, paths);
      if (!HasFatalFailure()) checkTiles(given, places, paths, left);
      if (!HasFatalFailure()) checkLists(given, places, left);
    }
    if (!HasFatalFailure()) checkPicture(record, given, places, left);
    for (const GpgpAsset drawing : record.drawings) gpgpDestroyAsset(drawing);
  }
};

/// The same where patches draw the drawings, beside texts and lists that are flattened.
struct PatchCpuReferenceTest : CpuTest {
  PatchCpuReferenceTest() {
    canvasMethod = GPGP_CANVAS_PATCHES;
    drawingMethods = GPGP_DRAWING_FLATTENED | GPGP_DRAWING_PATCHES;
  }
};

/// The same on canvases as wide and tall as pages are, of paths along their edges.
struct PageCpuReferenceTest : CpuTest {
  PageCpuReferenceTest() { maxWidth = 2048, maxHeight = 1024; }

  static void frame(TestPath& path, float left, float top, float right, float bottom, float thick) {
    path.rule = GPGP_FILL_EVEN_ODD;
    for (const float in : {0.0f, thick})
      path.move(left + in, top + in)
          .line(right - in, top + in)
          .line(right - in, bottom - in)
          .line(left + in, bottom - in)
          .close();
  }
  /// Frames as thin as hairlines, along the page or a multiple of 32 tiles from its right edge on, lines that lean over
  /// its edges, its whole area, and anything.
  void makePage(uint32_t seed, RandomRecord& record) {
    Dice dice(seed);
    constexpr std::array<uint32_t, 9> kWidths = {256, 512, 768, 1024, 2048, 264, 320, 500, 40};
    record.width = dice.oneIn(4) ? 8 * (1 + dice.upTo(128)) : kWidths[dice.upTo(9)];
    record.height = record.width >= 1024 ? 16 + 8 * dice.upTo(8) : record.width > 64 ? 16 * (1 + dice.upTo(24)) : 1024;
    constexpr std::array<uint32_t, 6> kSamples = {16, 1, 16, 4, 8, 16};
    record.samples = kSamples[dice.upTo(6)];
    record.exactArea = dice.oneIn(2);
    record.background = {1, 1, 1, 1};
    record.what = "page " + std::to_string(seed) + ": " + std::to_string(record.width) + " x " +
                  std::to_string(record.height) + ", samples " + std::to_string(record.samples) +
                  (record.exactArea ? ", exactArea" : "");
    const auto w = static_cast<float>(record.width), h = static_cast<float>(record.height);
    const auto one = [&](std::initializer_list<float> of) { return of.begin()[dice.upTo(uint32_t(of.size()))]; };
    for (uint32_t drawings = 1 + dice.upTo(2); drawings > 0; --drawings) {
      RandomPaths from;
      for (uint32_t paths = 1 + dice.upTo(3); paths > 0; --paths) {
        TestPath& path = from.shapes.emplace_back();
        path.color = dice.color();
        const float d = one({0, 0, 0.018f, 0.25f, -0.25f, 0.9f}), thick = one({0.036f, 0.1f, 0.25f, 0.5f, 3});
        switch (dice.upTo(5)) {
        case 0: frame(path, d, d, w - d, h - d, thick); break;
        case 1: {
          const float left = w - 256 * std::max(std::floor(w / 256) - static_cast<float>(dice.upTo(2)), 1.0f);
          frame(path, left + d, d, w + one({0, -0.3f, 7, 300}), h + one({0, -0.3f, 7}), thick);
          break;
        }
        case 2: { // down the right edge, or along the bottom
          const float lean = dice.between(-2, 2), x = w - dice.between(-1, 2), y = h - dice.between(-1, 2);
          if (dice.oneIn(2))
            path.move(x, -1).line(x + thick, -1).line(x + lean + thick, h + 1).line(x + lean, h + 1).close();
          else
            path.move(-1, y).line(-1, y + thick).line(w + 1, y + lean + thick).line(w + 1, y + lean).close();
          break;
        }
        case 3: path.move(d, d).line(w - d, d).line(w - d, h - d).line(d, h - d).close(); break;
        default:
          from.shapes.pop_back();
          from.path(dice, {}, std::max(w, h), 0, 0);
          continue;
        }
        from.paths.push_back(path.view());
      }
      record.drawings.push_back(keep(makeDrawing(from.paths, from.groups), from));
      GpgpCanvasItem item = place(record.drawings.back());
      if (dice.oneIn(3)) { // along tiles, words or the page
        const float right = dice.oneIn(2) ? w : w - 8 * static_cast<float>(dice.upTo(record.width / 8));
        std::copy_n(std::array{d0(dice), d0(dice), right + d0(dice), h + d0(dice)}.data(), 4, item.scissor);
      }
      record.items.push_back(item);
    }
  }
  static float d0(Dice& dice) { return dice.oneIn(2) ? 0.0f : dice.between(-1, 1); }
};

/// Patches that are asked by squares of tiles.
struct PatchPageCpuReferenceTest : PageCpuReferenceTest {
  PatchPageCpuReferenceTest() {
    canvasMethod = GPGP_CANVAS_PATCHES;
    drawingMethods = GPGP_DRAWING_FLATTENED | GPGP_DRAWING_PATCHES;
  }
};

TEST_F(CpuTest, RandomRecordsAreWhatTheCpuReferenceSays) {
  const uint32_t first = numberFrom("GPGP_TEST_FIRST_SEED", 0), count = numberFrom("GPGP_TEST_SEEDS", 64);
  for (uint32_t seed = first; seed < first + count && !HasFatalFailure(); ++seed) {
    RandomRecord record;
    makeRecord(seed, record);
    check(record);
  }
  // Where gradients begin anew or nearest texels meet, a pixel's colour is open.
  EXPECT_LT(doubted * 50, compared);
}

TEST_F(PatchCpuReferenceTest, RandomRecordsAreWhatTheCpuReferenceSays) {
  const uint32_t first = numberFrom("GPGP_TEST_FIRST_SEED", 0), count = numberFrom("GPGP_TEST_SEEDS", 10);
  for (uint32_t seed = first; seed < first + count && !HasFatalFailure(); ++seed) {
    RandomRecord record;
    makeRecord(seed, record);
    check(record);
  }
  EXPECT_GT(patched, count / 2);
}

TEST_F(PatchPageCpuReferenceTest, PagesAreWhatTheCpuReferenceSays) {
  const uint32_t first = numberFrom("GPGP_TEST_FIRST_SEED", 0), count = numberFrom("GPGP_TEST_SEEDS", 6);
  uint32_t squares = 0;
  for (uint32_t seed = first; seed < first + count && !HasFatalFailure(); ++seed) {
    RandomRecord record;
    makePage(seed, record);
    check(record);
    squares += read<CanvasCounters>("counters", 1)[0].patchBlocks;
  }
  EXPECT_GT(squares, 10u);
}

TEST_F(PageCpuReferenceTest, PagesAreWhatTheCpuReferenceSays) {
  const uint32_t first = numberFrom("GPGP_TEST_FIRST_SEED", 0), count = numberFrom("GPGP_TEST_SEEDS", 64);
  for (uint32_t seed = first; seed < first + count && !HasFatalFailure(); ++seed) {
    RandomRecord record;
    makePage(seed, record);
    check(record);
  }
}

} // namespace
