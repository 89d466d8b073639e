// Recordings that keep what did not change: pictures are those of whole recordings, bit for bit, and less is drawn.
#include "random_record.h"
#include "vector/raster/kept.h"

#include <memory>

namespace {
using namespace gpgp;
using namespace gpgp::test;

constexpr uint32_t kSide = 128, kTiles = 32, kGlyphs = 6;

// ---------------------------------------------------------------- which tiles change, by themselves

struct Boxed {
  uint64_t hash;
  vector::TileBox box;
};
GpgpCanvasRedraw compare(vector::KeptRecording& kept, const std::vector<Boxed>& things, std::vector<uint32_t>& bits) {
  static uint32_t number = 0;
  kept.begin(kTiles, kTiles, bits);
  for (const Boxed& thing : things) kept.add(thing.hash, [&] { return thing.box; });
  const vector::KeptRecording::Whole whole{1, 1, 0, ++number, true};
  const auto redraw = kept.compare(whole, 0);
  kept.commit(whole, redraw != GPGP_CANVAS_REDRAW_NONE);
  return redraw;
}
/// What a tile shows: the things that touch it, in order.
std::vector<uint64_t> shownIn(const std::vector<Boxed>& things, uint32_t x, uint32_t y) {
  std::vector<uint64_t> shown;
  for (const Boxed& t : things)
    if (x >= t.box.left && x < t.box.right && y >= t.box.top && y < t.box.bottom) shown.push_back(t.hash);
  return shown;
}

TEST(KeptRecording, TilesThatShowOtherThingsAreDamagedAndFewOthers) {
  Dice dice(5);
  uint32_t next = 1;
  const auto make = [&] {
    const auto left = static_cast<uint16_t>(dice.upTo(kTiles)), top = static_cast<uint16_t>(dice.upTo(kTiles));
    const auto right = static_cast<uint16_t>(std::min(left + dice.upTo(5), kTiles)),
               bottom = static_cast<uint16_t>(std::min(top + 1 + dice.upTo(4), kTiles));
    return Boxed{next++, {left, top, right, bottom}};
  };
  vector::KeptRecording kept(400, std::pmr::get_default_resource());
  std::vector<uint32_t> bits(vector::KeptRecording::damageWords(kTiles, kTiles));
  std::vector<Boxed> things;
  for (int i = 0; i < 200; ++i) things.push_back(make());
  for (int i = 0; i < 20; ++i) things.push_back(things[static_cast<size_t>(i)]); // equal ones, too
  EXPECT_EQ(compare(kept, things, bits), GPGP_CANVAS_REDRAW_FIRST);
  uint32_t kinds[5] = {};
  for (int frame = 0; frame < 400; ++frame) {
    const std::vector<Boxed> before = things;
    const uint32_t edits = dice.upTo(4);
    for (uint32_t e = 0; e < edits && things.size() > 2; ++e) {
      const size_t at = dice.upTo(static_cast<uint32_t>(things.size())), kind = dice.upTo(4);
      ++kinds[kind];
      if (kind == 0 && things.size() < 380) {
        things.insert(things.begin() + static_cast<ptrdiff_t>(at), make());
      } else if (kind == 1) {
        things.erase(things.begin() + static_cast<ptrdiff_t>(at));
      } else if (kind == 2) {
        things[at] = make();
      } else { // to another place in the order
        const Boxed thing = things[at];
        things.erase(things.begin() + static_cast<ptrdiff_t>(at));
        things.insert(things.begin() + static_cast<ptrdiff_t>(dice.upTo(static_cast<uint32_t>(things.size()))), thing);
      }
    }
    ASSERT_EQ(compare(kept, things, bits), GPGP_CANVAS_REDRAW_NONE) << frame;
    const bool any = kept.damagedTiles() != 0; // else the bits are not written
    // Each edit leaves one thing out of the longest common sequence, two where there are equal ones, in two places.
    ASSERT_LE(kept.damagedTiles(), 16 * 4 * edits) << frame;
    for (uint32_t y = 0; y < kTiles; ++y)
      for (uint32_t x = 0; x < kTiles; ++x) {
        if (shownIn(before, x, y) == shownIn(things, x, y)) continue;
        ASSERT_TRUE(any && (bits[y * ((kTiles + 31) / 32) + x / 32] >> (x % 32) & 1))
            << "frame " << frame << ", tile " << x << " " << y;
      }
  }
  for (int k = 0; k < 4; ++k) EXPECT_GT(kinds[k], 50u);
}

// ---------------------------------------------------------------- pictures

/// A thing of a scene that is edited from frame to frame.
struct Node {
  enum Kind : uint32_t { drawing, text, list } kind = drawing;
  uint32_t which = 0; ///< drawing
  float x = 0, y = 0, scale = 1, degrees = 0, opacity = 1;
  bool projective = false, cut = false;
  std::vector<GpgpGlyphInstance> glyphs;
  std::vector<GpgpListShape> shapes;
  std::array<float, 4> clip{}, radii{};
  bool clipped = false, layer = false;
  float group = 1;
  std::shared_ptr<TestList> made;
};

struct KeepTest : CanvasTest {
  static constexpr uint32_t kDrawings = 5;
  Dice dice{1};
  Kinds kinds{true, true, true, true, true, true, true};
  std::deque<RandomPaths> paths;
  std::vector<GpgpAsset> drawings;
  GpgpAsset glyphSet = nullptr;
  std::array<uint32_t, kGlyphs> glyphs{};
  std::deque<Texture> textures;
  std::vector<Node> nodes;
  GpgpListImage pattern{0, {0, 0, 1, 1}, {}, {}};
  uint64_t version = 0;
  uint32_t layers = 0;
  std::array<float, 4> background{0.1f, 0.2f, 0.3f, 1};
  uint32_t side = kSide, width = kSide, height = kSide, samples = 16; ///< side: of the canvas and its images

  void TearDown() override {
    for (const GpgpAsset drawing : drawings) gpgpDestroyAsset(drawing);
    gpgpDestroyAsset(glyphSet);
    nodes.clear();
    device.waitIdle();
    advance();
    GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT;
    while (gpgpGetCanvasReport(canvas, &report) == GPGP_SUCCESS) continue;
    CanvasTest::TearDown();
  }
  void makeScene(uint32_t seed, uint32_t count) {
    dice = Dice(seed);
    GpgpCanvasCreateInfo info = GPGP_CANVAS_CREATE_INFO_INIT;
    info.base = {"canvas", device.graphics().family, 0, VK_FALSE};
    info.maxWidth = info.maxHeight = side;
    info.maxPaths = 16384;
    info.maxDrawings = 512;
    info.maxGlyphs = 4096;
    info.targets = GPGP_CANVAS_TARGET_RGBA16F;
    info.maxLayerPixels = 1u << 20;
    info.method = canvasMethod;
    canvas = recorder(gpgpCreateCanvas, info);
    const GpgpGlyphSetCreateInfo setInfo = GPGP_GLYPH_SET_CREATE_INFO_INIT;
    ASSERT_EQ(gpgpCreateGlyphSet(context, &setInfo, &glyphSet), GPGP_SUCCESS);
    for (uint32_t k = 0; k < kGlyphs; ++k) {
      RandomPaths one;
      const Kinds plain{k >= 4 && kinds.gradients, false, false, false, false, false, false};
      for (uint32_t i = k < 4 ? 1 : 3; i > 0; --i) one.path(dice, plain, 1, 0, 0);
      const std::vector<VkBool32> foreground(one.paths.size(), k < 4);
      const GpgpGlyph glyph{k + 1, one.paths.data(), static_cast<uint32_t>(one.paths.size()), foreground.data()};
      ASSERT_EQ(gpgpAddGlyphs(glyphSet, &glyph, 1, &glyphs[k]), GPGP_SUCCESS) << lastMessage();
    }
    makeTexture();
    for (uint32_t i = 0; i < kDrawings; ++i) drawings.push_back(newDrawing());
    for (uint32_t i = 0; i < count; ++i) nodes.push_back(newNode());
  }
  GpgpAsset newDrawing() {
    RandomPaths& from = paths.emplace_back();
    from.add(dice, kinds, 30, kinds.images ? 1 : 0, 0, 2, 2);
    return makeDrawing(from.paths, from.groups);
  }
  void makeTexture() {
    std::vector<uint32_t> texels(16);
    for (uint32_t& t : texels) t = 0xff000000 | dice.upTo(1u << 24);
    device.waitIdle();
    textures.clear();
    textures.emplace_back(device, 4, 4, texels, VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_REPEAT);
    images = {textures.back().view()};
    images[0].version = ++version;
  }
  GpgpListShape newShape() {
    const float x = dice.between(0, 30), y = dice.between(0, 30);
    GpgpListShape shape = rectangle(x, y, x + dice.between(3, 20), y + dice.between(3, 20), dice.color());
    if (dice.oneIn(3))
      shape = rounded(shape, 2, 4, 1, 3, dice.oneIn(2) ? 1.5f : 0.0f);
    else if (dice.oneIn(3))
      shape = ellipse(shape);
    else if (dice.oneIn(3) && kinds.images)
      shape.image = &pattern;
    return shape;
  }
  Node newNode() {
    Node n;
    n.kind = static_cast<Node::Kind>(dice.upTo(3));
    if (!kinds.lists && n.kind == Node::list) n.kind = Node::text;
    if (!kinds.severalDrawings && n.kind == Node::drawing) n.kind = Node::text;
    n.which = dice.upTo(kDrawings);
    n.x = dice.between(-20, kSide), n.y = dice.between(-20, kSide);
    n.scale = dice.between(0.4f, 1.2f);
    n.degrees = dice.oneIn(2) ? 0 : dice.between(0, 360);
    n.opacity = dice.oneIn(3) ? dice.between(0.2f, 1) : 1;
    n.projective = kinds.projective && dice.oneIn(6);
    if (!kinds.severalDrawings) n.scale = 1, n.degrees = 0, n.opacity = 1;
    float at = 0;
    for (uint32_t i = 3 + dice.upTo(6); i > 0 && n.kind != Node::drawing; --i, at += 8) {
      const auto c = dice.color();
      n.glyphs.push_back({glyphs[dice.upTo(kinds.gradients ? kGlyphs : 4)], at, 8, 10, {c[0], c[1], c[2], 1}});
    }
    for (uint32_t i = 1 + dice.upTo(6); i > 0 && n.kind == Node::list; --i) n.shapes.push_back(newShape());
    n.clipped = kinds.groups && dice.oneIn(3);
    n.clip = {2, 2, dice.between(10, 40), dice.between(10, 40)};
    if (dice.oneIn(2)) n.radii = {5, 3, 8, 2};
    n.group = kinds.groups && dice.oneIn(4) ? dice.between(0.3f, 0.9f) : 1;
    return n;
  }
  /// One edit; what it was.
  void edit() {
    if (nodes.size() < 8) nodes.push_back(newNode());
    const size_t at = dice.upTo(static_cast<uint32_t>(nodes.size()));
    Node& n = nodes[at];
    switch (dice.upTo(14)) {
    case 0: nodes.insert(nodes.begin() + static_cast<ptrdiff_t>(at), newNode()); break;
    case 1: nodes.erase(nodes.begin() + static_cast<ptrdiff_t>(at)); break;
    case 2: n.x += dice.between(-9, 9), n.y += dice.between(-9, 9); break;
    case 3: n.opacity = dice.between(0.2f, 1); break;
    case 4: std::swap(nodes[at], nodes[dice.upTo(static_cast<uint32_t>(nodes.size()))]); break;
    case 5: n.cut = !n.cut; break;
    case 6:
      if (kinds.groups) n.clipped = !n.clipped;
      break;
    case 7:
      if (kinds.groups) n.group = n.group == 1 ? 0.5f : 1;
      break;
    case 8:
      if (!n.glyphs.empty()) n.glyphs[dice.upTo(static_cast<uint32_t>(n.glyphs.size()))].glyph = glyphs[dice.upTo(4)];
      break;
    case 9:
      if (!n.glyphs.empty()) n.glyphs.pop_back();
      break;
    case 10:
      if (!n.shapes.empty()) n.shapes[0] = newShape();
      break;
    case 11:
      if (!n.shapes.empty()) std::copy_n(dice.color().data(), 4, n.shapes.back().color);
      break;
    case 12: { // the same handle may come again
      GpgpAsset& one = drawings[dice.upTo(kDrawings)];
      gpgpDestroyAsset(one);
      one = newDrawing();
      break;
    }
    default: n.degrees += 5; break;
    }
  }
  std::vector<GpgpCanvasItem> items() {
    std::vector<GpgpCanvasItem> all;
    for (Node& n : nodes) {
      GpgpCanvasItem item = place(nullptr);
      const auto map = turned(n.degrees, n.scale, n.x, n.y);
      std::copy_n(map.data(), 6, item.transform);
      if (n.projective) item.perspective[0] = 0.002f, item.perspective[1] = 0.001f, item.perspective[2] = 1;
      item.opacity = n.opacity;
      if (n.cut) std::copy_n(std::array{n.x, n.y, n.x + 15, n.y + 20}.data(), 4, item.scissor);
      if (n.kind == Node::drawing) item.drawing = drawings[n.which];
      if (n.kind == Node::text) {
        item.glyphSet = glyphSet;
        item.glyphs = n.glyphs.data();
        item.glyphCount = static_cast<uint32_t>(n.glyphs.size());
      }
      if (n.kind == Node::list) {
        if (!n.made) n.made = std::make_shared<TestList>(context);
        TestList& list = n.made->reset();
        GpgpListLayer layer{};
        layer.opacity = 0.7f;
        if (n.layer) list.layer(layer);
        if (n.group < 1) list.group(n.group);
        for (size_t i = 0; i < n.shapes.size(); ++i) {
          if (i == 1 && n.clipped) list.clip(n.clip, n.radii);
          list.add(n.shapes[i]);
        }
        if (n.clipped && n.shapes.size() < 2) list.clip(n.clip, n.radii);
        list.add(glyphSet, n.glyphs);
        if (n.clipped) list.pop();
        if (n.group < 1) list.pop();
        if (n.layer) list.pop();
        item.list = n.made->list;
      }
      all.push_back(item);
    }
    return all;
  }

  /// A target and what it shows.
  struct Kept {
    host::Image image;
    GpgpHistory history = nullptr;
    bool written = false;
    Kept(KeepTest& test, uint32_t maxKept)
        : image(test.device, {.format = VK_FORMAT_R16G16B16A16_SFLOAT, .width = test.side, .height = test.side}) {
      GpgpCanvasHistoryCreateInfo info = GPGP_CANVAS_HISTORY_CREATE_INFO_INIT;
      info.maxKept = maxKept;
      EXPECT_EQ(gpgpCreateCanvasHistory(test.context, &info, &history), GPGP_SUCCESS) << test.lastMessage();
    }
    ~Kept() { gpgpDestroyHistory(history); }
    Kept(const Kept&) = delete;
  };
  void record(VkCommandBuffer commands, const GpgpFrame& frame, const std::vector<GpgpCanvasItem>& all, Kept* kept,
              const host::Image& image, bool written, bool keep = true, const GpgpTimestamps& timestamps = {}) {
    const GpgpAccess after{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT, VK_IMAGE_LAYOUT_GENERAL};
    GpgpCanvasInfo info = infoOf(all, width, height);
    info.base.timestamps = timestamps;
    std::copy(background.begin(), background.end(), info.background);
    info.samples = samples;
    info.target = image.target(written ? after : GpgpAccess{}, after);
    info.history = kept ? kept->history : nullptr;
    info.keep = kept != nullptr && keep;
    ASSERT_EQ(gpgpRecordPrepareCanvas(canvas, commands, &frame, &info), GPGP_SUCCESS) << lastMessage();
  }
  /// Records the scene kept and whole; the pictures must be equal. The kept one's report.
  GpgpCanvasReport compareOnce(Kept& kept, const host::Image& whole, const std::string& what) {
    const std::vector<GpgpCanvasItem> all = items();
    const GpgpFrame frame = advance();
    device.submitAndWait([&](VkCommandBuffer commands) {
      EXPECT_EQ(gpgpRecordUpload(context, commands, &frame, 0, nullptr), GPGP_SUCCESS);
      record(commands, frame, all, &kept, kept.image, kept.written);
      record(commands, frame, all, nullptr, whole, false);
    });
    kept.written = true;
    advance();
    GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT, full = GPGP_CANVAS_REPORT_INIT;
    EXPECT_EQ(gpgpGetCanvasReport(canvas, &report), GPGP_SUCCESS);
    EXPECT_EQ(gpgpGetCanvasReport(canvas, &full), GPGP_SUCCESS);
    EXPECT_EQ(full.base.status, GPGP_SUCCESS) << what;
    EXPECT_EQ(full.redraw, GPGP_CANVAS_REDRAW_NOT_ASKED);
    EXPECT_EQ(full.tilesDrawn, full.tiles);
    EXPECT_EQ(report.tiles, (width + 7) / 8 * ((height + 7) / 8));
    EXPECT_TRUE(report.redraw == GPGP_CANVAS_REDRAW_NONE || report.tilesDrawn == report.tiles);
    expectEqual(kept.image, whole,
                what + ", " + std::to_string(report.tilesDrawn) + " tiles, redraw " + std::to_string(report.redraw));
    return report;
  }
  void expectEqual(const host::Image& a, const host::Image& b, const std::string& what) {
    const auto one = host::downloadImage(device, a, VK_IMAGE_LAYOUT_GENERAL);
    const auto two = host::downloadImage(device, b, VK_IMAGE_LAYOUT_GENERAL);
    for (uint32_t y = 0; y < height; ++y)
      for (uint32_t x = 0; x < width; ++x) {
        const size_t at = (size_t(y) * kSide + x) * 8;
        if (std::memcmp(&one[at], &two[at], 8) == 0) continue;
        uint16_t p[4], q[4];
        std::memcpy(p, &one[at], 8);
        std::memcpy(q, &two[at], 8);
        ADD_FAILURE() << what << ": pixel " << x << " " << y << " is " << fromHalf(p[0]) << " " << fromHalf(p[1]) << " "
                      << fromHalf(p[2]) << " " << fromHalf(p[3]) << ", whole " << fromHalf(q[0]) << " "
                      << fromHalf(q[1]) << " " << fromHalf(q[2]) << " " << fromHalf(q[3]);
        return;
      }
  }
  /// Frames of random edits, some without any.
  struct Seen {
    uint64_t tiles = 0, drawn = 0;
    uint32_t frames = 0, still = 0, partly = 0, whole = 0;
  };
  Seen run(uint32_t seed, uint32_t frames, uint32_t count) {
    makeScene(seed, count);
    Kept kept(*this, 4096);
    const host::Image whole(device, {.format = VK_FORMAT_R16G16B16A16_SFLOAT, .width = kSide, .height = kSide});
    Seen seen;
    for (uint32_t f = 0; f < frames && !HasFailure(); ++f) {
      const uint32_t edits = f == 0 || dice.oneIn(6) ? 0 : 1 + dice.upTo(2);
      for (uint32_t e = 0; e < edits; ++e) edit();
      const bool textured = f % 20 == 19 && kinds.images;
      if (textured) makeTexture();
      const auto report = compareOnce(kept, whole, "seed " + std::to_string(seed) + ", frame " + std::to_string(f));
      if (f && edits == 0 && !textured) {
        EXPECT_EQ(report.redraw, GPGP_CANVAS_REDRAW_NONE) << f;
        EXPECT_EQ(report.tilesDrawn, 0u) << f;
        EXPECT_EQ(report.paths, 0u); // nothing ran
      }
      EXPECT_EQ(report.redraw == GPGP_CANVAS_REDRAW_FIRST, f == 0);
      ++seen.frames;
      seen.still += report.tilesDrawn == 0;
      seen.partly += report.tilesDrawn > 0 && report.tilesDrawn < report.tiles;
      seen.whole += report.tilesDrawn == report.tiles;
      seen.tiles += report.tiles;
      seen.drawn += report.tilesDrawn;
    }
    RecordProperty("tiles", static_cast<int>(seen.tiles));
    RecordProperty("drawn", static_cast<int>(seen.drawn));
    return seen;
  }
};

/// All kinds of things at once.
TEST_F(KeepTest, PicturesAreThoseOfWholeRecordings) {
  const Seen seen = run(11, 105, 14);
  EXPECT_GT(seen.still, 5u);
  EXPECT_GT(seen.partly, 50u);
  EXPECT_LT(seen.whole, 25u);
  EXPECT_LT(seen.drawn * 100, seen.tiles * 35) << seen.drawn << " of " << seen.tiles;
}
/// Each of these takes other shaders.
TEST_F(KeepTest, WithoutGradientsGroupsAndImages) {
  kinds = {false, false, false, false, true, true, true};
  const Seen seen = run(12, 50, 14);
  EXPECT_GT(seen.partly, 20u);
}
TEST_F(KeepTest, WithGradients) {
  kinds = {true, false, false, false, true, true, true};
  EXPECT_GT(run(13, 40, 14).partly, 15u);
}
TEST_F(KeepTest, TextsAlone) {
  kinds = {false, false, false, false, false, true, false};
  EXPECT_GT(run(14, 40, 14).partly, 12u);
}
TEST_F(KeepTest, ByPatches) {
  canvasMethod = GPGP_CANVAS_PATCHES;
  drawingMethods = GPGP_DRAWING_FLATTENED | GPGP_DRAWING_PATCHES;
  kinds.projective = false;
  EXPECT_GT(run(15, 10, 10).partly, 3u);
}

/// Everything that makes a recording draw all tiles is said, and the picture is right.
TEST_F(KeepTest, ReasonsToDrawEverything) {
  makeScene(21, 12);
  Kept kept(*this, 512);
  const host::Image whole(device, {.format = VK_FORMAT_R16G16B16A16_SFLOAT, .width = kSide, .height = kSide});
  const auto expect = [&](GpgpCanvasRedraw redraw, const char* what) {
    EXPECT_EQ(compareOnce(kept, whole, what).redraw, redraw) << what;
    const auto again = compareOnce(kept, whole, what); // and then nothing
    EXPECT_EQ(again.redraw, GPGP_CANVAS_REDRAW_NONE) << what;
    EXPECT_EQ(again.tilesDrawn, 0u) << what;
  };
  kept.written = true; // as it has what recordings with undefined contents leave
  device.submitAndWait([&](VkCommandBuffer commands) {
    const GpgpFrame frame = advance();
    EXPECT_EQ(gpgpRecordUpload(context, commands, &frame, 0, nullptr), GPGP_SUCCESS);
    record(commands, frame, items(), nullptr, kept.image, false);
  });
  advance();
  GpgpCanvasReport taken = GPGP_CANVAS_REPORT_INIT;
  EXPECT_EQ(gpgpGetCanvasReport(canvas, &taken), GPGP_SUCCESS);
  expect(GPGP_CANVAS_REDRAW_FIRST, "first");
  background[0] = 0.7f;
  expect(GPGP_CANVAS_REDRAW_SETTINGS, "background");
  samples = 4;
  expect(GPGP_CANVAS_REDRAW_SETTINGS, "samples");
  width = 100;
  expect(GPGP_CANVAS_REDRAW_SETTINGS, "size");
  width = kSide;
  expect(GPGP_CANVAS_REDRAW_SETTINGS, "size again");
  blendSrgb = true;
  expect(GPGP_CANVAS_REDRAW_SETTINGS, "blending");
  exactArea = true;
  expect(GPGP_CANVAS_REDRAW_SETTINGS, "area");
  kept.written = false;
  expect(GPGP_CANVAS_REDRAW_SETTINGS, "contents given up");
  for (Node& n : nodes) n.x += 3, n.scale = 4;
  expect(GPGP_CANVAS_REDRAW_MOST, "everything moved");
  nodes.push_back(newNode());
  nodes.back().kind = Node::list;
  nodes.back().shapes = {rectangle(0, 0, 30, 30)};
  nodes.back().shapes[0].image = &pattern;
  nodes.back().x = nodes.back().y = 40;
  compareOnce(kept, whole, "a list with an image");
  makeTexture();
  EXPECT_GT(compareOnce(kept, whole, "image").tilesDrawn, 0u);
  Node listed = newNode();
  while (listed.kind != Node::list) listed = newNode();
  listed.layer = true;
  listed.x = listed.y = 60;
  nodes.push_back(listed);
  expect(GPGP_CANVAS_REDRAW_LAYERS, "a layer comes");
  nodes.back().x += 5;
  expect(GPGP_CANVAS_REDRAW_LAYERS, "the layer moves");
  nodes.front().y += 2;
  expect(GPGP_CANVAS_REDRAW_LAYERS, "something behind it moves");
  nodes.pop_back();
  expect(GPGP_CANVAS_REDRAW_LAYERS, "the layer goes");
  const std::vector<Node> all = nodes;
  nodes = {};
  for (const Node& n : all)
    if (n.kind == Node::text) nodes.push_back(n);
  EXPECT_EQ(compareOnce(kept, whole, "texts alone").redraw, GPGP_CANVAS_REDRAW_SHADERS);
  for (uint32_t i = 0; i < 200; ++i) nodes.push_back(nodes[i % 2]);
  EXPECT_EQ(compareOnce(kept, whole, "more than it remembers").redraw, GPGP_CANVAS_REDRAW_ROOM);
  EXPECT_EQ(compareOnce(kept, whole, "still more").redraw, GPGP_CANVAS_REDRAW_FIRST);
  nodes = all;
  expect(GPGP_CANVAS_REDRAW_FIRST, "room again");
}

/// Frames whose reports are not known yet, and two targets that take turns, each with a history.
TEST_F(KeepTest, FramesInFlight) {
  makeScene(31, 14);
  Kept first(*this, 4096), second(*this, 4096);
  const host::Image whole(device, {.format = VK_FORMAT_R16G16B16A16_SFLOAT, .width = kSide, .height = kSide});
  uint64_t drawn = 0, tiles = 0;
  for (uint32_t round = 0; round < 12 && !HasFailure(); ++round) {
    for (uint32_t k = 0; k < 4; ++k) { // all are submitted before any has ended
      for (uint32_t e = 0; e < 2; ++e) edit();
      const std::vector<GpgpCanvasItem> all = items();
      const GpgpFrame frame = advance(2);
      Kept& kept = k % 2 == round % 2 ? second : first;
      device.submitAndWait([&](VkCommandBuffer commands) {
        EXPECT_EQ(gpgpRecordUpload(context, commands, &frame, 0, nullptr), GPGP_SUCCESS);
        record(commands, frame, all, &kept, kept.image, kept.written);
        if (k == 3) record(commands, frame, all, nullptr, whole, false);
      });
      kept.written = true;
      GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT;
      while (gpgpGetCanvasReport(canvas, &report) == GPGP_SUCCESS) {
        if (report.redraw == GPGP_CANVAS_REDRAW_NOT_ASKED) continue;
        drawn += report.tilesDrawn;
        tiles += report.tiles;
      }
      if (k == 3) expectEqual((k % 2 == round % 2 ? second : first).image, whole, "round " + std::to_string(round));
    }
  }
  EXPECT_LT(drawn, tiles / 2) << drawn << " of " << tiles;
}

/// A recording that was never executed, and one that had too little room: what follows is drawn whole.
TEST_F(KeepTest, IncompleteRecordingsAreNotKept) {
  makeScene(41, 12);
  Kept kept(*this, 4096);
  const host::Image whole(device, {.format = VK_FORMAT_R16G16B16A16_SFLOAT, .width = kSide, .height = kSide});
  compareOnce(kept, whole, "first");
  EXPECT_EQ(compareOnce(kept, whole, "still").tilesDrawn, 0u);
  nodes.front().x += 4;
  VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  VkCommandPool pool = VK_NULL_HANDLE;
  VkCommandPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  poolInfo.queueFamilyIndex = device.graphics().family;
  ASSERT_EQ(device.vk().vkCreateCommandPool(device.device(), &poolInfo, nullptr, &pool), VK_SUCCESS);
  info.commandPool = pool;
  info.commandBufferCount = 1;
  VkCommandBuffer commands = VK_NULL_HANDLE;
  ASSERT_EQ(device.vk().vkAllocateCommandBuffers(device.device(), &info, &commands), VK_SUCCESS);
  const VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  ASSERT_EQ(device.vk().vkBeginCommandBuffer(commands, &begin), VK_SUCCESS);
  const GpgpFrame frame = advance();
  record(commands, frame, items(), &kept, kept.image, true);
  device.vk().vkDestroyCommandPool(device.device(), pool, nullptr);
  advance();
  advance();
  GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT;
  EXPECT_EQ(gpgpGetCanvasReport(canvas, &report), GPGP_SUCCESS);
  EXPECT_EQ(report.base.status, GPGP_NOT_EXECUTED);
  EXPECT_EQ(compareOnce(kept, whole, "after one that never ran").redraw, GPGP_CANVAS_REDRAW_INCOMPLETE);
  EXPECT_EQ(compareOnce(kept, whole, "and then").tilesDrawn, 0u);
}

/// Says what recordings of an interface cost, of which nothing or one text of a hundred changes.
TEST_F(KeepTest, AnInterfaceOfWhichLittleChanges) {
  side = width = height = 512;
  makeScene(61, 0);
  for (uint32_t i = 0; i < 100; ++i) {
    Node n;
    n.kind = Node::list;
    n.x = 50.0f * static_cast<float>(i % 10) + 8, n.y = 50.0f * static_cast<float>(i / 10) + 8;
    n.shapes = {rounded(rectangle(0, 0, 44, 44, {0.2f, 0.2f, 0.5f, 1}), 6, 6, 6, 6)};
    for (uint32_t k = 0; k < 4; ++k)
      n.glyphs.push_back({glyphs[k], 10.0f * static_cast<float>(k), 20, 9, {1, 1, 1, 1}});
    nodes.push_back(n);
  }
  Kept kept(*this, 4096);
  uint32_t passes = 0;
  ASSERT_EQ(gpgpGetPasses(canvas, &passes, nullptr), GPGP_SUCCESS);
  VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
  info.queryType = VK_QUERY_TYPE_TIMESTAMP;
  info.queryCount = passes + 1;
  VkQueryPool queries = VK_NULL_HANDLE;
  ASSERT_EQ(device.vk().vkCreateQueryPool(device.device(), &info, nullptr, &queries), VK_SUCCESS);
  std::array<std::vector<double>, 3> ticks; // whole, one text changes, nothing changes
  for (uint32_t k = 0; k < 3 * 15; ++k) {
    if (k % 3 == 1) nodes[k].glyphs[0].glyph = nodes[k].glyphs[0].glyph == glyphs[0] ? glyphs[1] : glyphs[0];
    const std::vector<GpgpCanvasItem> all = items();
    const GpgpFrame frame = advance();
    device.submitAndWait([&](VkCommandBuffer commands) {
      EXPECT_EQ(gpgpRecordUpload(context, commands, &frame, 0, nullptr), GPGP_SUCCESS);
      device.vk().vkCmdResetQueryPool(commands, queries, 0, passes + 1);
      record(commands, frame, all, &kept, kept.image, k > 0, k % 3 != 0, {queries, 0, passes + 1});
    });
    advance();
    std::vector<uint64_t> times(passes + 1);
    ASSERT_EQ(device.vk().vkGetQueryPoolResults(device.device(), queries, 0, passes + 1, times.size() * 8, times.data(),
                                                8, VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
              VK_SUCCESS);
    ticks[k % 3].push_back(static_cast<double>(times.back() - times.front()));
    GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT;
    ASSERT_EQ(gpgpGetCanvasReport(canvas, &report), GPGP_SUCCESS);
    const uint32_t drawn = report.tilesDrawn; // a glyph of 9 pixels lies in at most 16 tiles, with margins
    EXPECT_TRUE(k % 3 == 0 ? drawn == report.tiles : k % 3 == 1 ? drawn > 0 && drawn <= 16 : drawn == 0) << k;
  }
  device.vk().vkDestroyQueryPool(device.device(), queries, nullptr);
  for (auto& times : ticks) std::nth_element(times.begin(), times.begin() + 7, times.end());
  std::printf("an interface of 100 panels: one text changes %.3f, nothing changes %.4f of a whole recording's time\n",
              ticks[1][7] / ticks[0][7], ticks[2][7] / ticks[0][7]);
}

TEST_F(KeepTest, WrongCallsAreRefused) {
  makeScene(51, 2);
  GpgpCanvasHistoryCreateInfo info = GPGP_CANVAS_HISTORY_CREATE_INFO_INIT;
  GpgpHistory history = nullptr;
  EXPECT_EQ(gpgpCreateCanvasHistory(context, &info, &history), GPGP_ERROR_INVALID_ARGUMENT);
  info.maxKept = (1u << 22) + 1;
  EXPECT_EQ(gpgpCreateCanvasHistory(context, &info, &history), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_NE(lastMessage().find("maxKept"), std::string::npos);
  const GpgpHistory forgets = makeView(16, 16);
  const host::Image image(device, {.format = VK_FORMAT_R16G16B16A16_SFLOAT, .width = kSide, .height = kSide});
  const GpgpFrame frame = advance();
  device.submitAndWait([&](VkCommandBuffer commands) {
    EXPECT_EQ(gpgpRecordUpload(context, commands, &frame, 0, nullptr), GPGP_SUCCESS);
    const auto all = items();
    GpgpCanvasInfo record = infoOf(all, 16, 16);
    record.target = image.target({}, {});
    record.keep = VK_TRUE;
    EXPECT_EQ(gpgpRecordPrepareCanvas(canvas, commands, &frame, &record), GPGP_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(lastMessage().find("there is no history"), std::string::npos) << lastMessage();
    record.history = forgets;
    EXPECT_EQ(gpgpRecordPrepareCanvas(canvas, commands, &frame, &record), GPGP_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(lastMessage().find("maxKept"), std::string::npos) << lastMessage();
  });
  gpgpDestroyHistory(forgets);
}

} // namespace
