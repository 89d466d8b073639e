// Hit tests against winding numbers, closed forms and what is drawn; lists under budgets, wrong and random calls.
#include "ui_fixture.h"

#include <map>

namespace {
using namespace gpgp;
using namespace gpgp::test;

TEST_F(CanvasTest, HitTestsFindThePathThatWindingNumbersSay) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> pixel(-10, 110);
  size_t hits = 0, asked = 0;
  for (const bool editable : {false, true}) {
    std::vector<TestPath> shapes;
    for (uint32_t i = 0; i < 12; ++i) {
      shapes.push_back(randomShape(100 + i, 90));
      shapes.back().rule = i % 2 ? GPGP_FILL_EVEN_ODD : GPGP_FILL_NON_ZERO;
    }
    TestPath window = rectanglePath(10, 20, 70, 60);
    const GpgpPath clip = window.view();
    const GpgpPathGroup group{0, 0.5f, &clip, 1};
    std::vector<GpgpPath> views;
    for (const TestPath& shape : shapes) views.push_back(shape.view());
    views[10].group = views[11].group = 1; // the topmost are clipped
    GpgpStroke stroke{};
    stroke.width = 5;
    views[9].stroke = &stroke;
    GpgpDrawingCreateInfo info = GPGP_DRAWING_CREATE_INFO_INIT;
    info.paths = views.data();
    info.pathCount = 12;
    info.groups = &group;
    info.groupCount = 1;
    info.editable = editable;
    info.hitTestable = !editable;
    GpgpAsset drawing = nullptr;
    ASSERT_EQ(gpgpCreateDrawing(context, &info, &drawing), GPGP_SUCCESS) << lastMessage();
    std::vector<PathOracle> oracles;
    for (const TestPath& shape : shapes) oracles.emplace_back(shape.view());
    for (const auto& map : kMaps) {
      GpgpCanvasItem item{drawing, {}, 1};
      std::copy_n(map.data(), 6, item.transform);
      std::copy_n(map.data() + 6, 3, item.perspective);
      for (int i = 0; i < 1500; ++i) {
        const float x = pixel(random), y = pixel(random);
        const GpgpHit hit = hitAt(context, {item}, x, y);
        // The hit says where it is; that point must map back.
        const vector::Map m = vector::toMap(item.transform, item.perspective);
        if (hit.item == 0) {
          const double u = hit.x, v = hit.y, w = m.p * u + m.q * v + m.r;
          ASSERT_GT(w, 0);
          ASSERT_NEAR((m.a * u + m.c * v + m.e) / w, x, 0.01 + 1e-4 / w);
          ASSERT_NEAR((m.b * u + m.d * v + m.f) / w, y, 0.01 + 1e-4 / w);
        }
        const double a = m.a - m.p * x, c = m.c - m.q * x, e = m.r * x - m.e;
        const double b = m.b - m.p * y, d = m.d - m.q * y, f = m.r * y - m.f;
        const double u = (e * d - c * f) / (a * d - c * b), v = (a * f - e * b) / (a * d - c * b);
        uint32_t expected = GPGP_HIT_NONE;
        bool certain = true, shown = m.p * u + m.q * v + m.r > 0;
        for (uint32_t k = 12; k > 0 && shown && expected == GPGP_HIT_NONE; --k) {
          if (k == 10) continue; // the stroke: below, by distance
          const bool in = oracles[k - 1].inside(u, v) && (k < 11 || (u > 10 && u < 70 && v > 20 && v < 60));
          certain = certain && oracles[k - 1].certain(u, v, 1e-3);
          if (in) expected = k - 1;
        }
        if (hit.item == 0 && hit.path == 9 && (expected == GPGP_HIT_NONE || expected < 9)) continue;
        if (!certain || std::abs(u - 10) < 1e-3 || std::abs(u - 70) < 1e-3) continue;
        ++asked;
        if (expected == GPGP_HIT_NONE || (expected < 9 && hit.item == GPGP_HIT_NONE)) {
          ASSERT_EQ(hit.item, expected == GPGP_HIT_NONE ? GPGP_HIT_NONE : 0u) << x << " " << y;
        } else {
          ASSERT_EQ(hit.item, 0u) << x << " " << y << " path " << expected;
          ASSERT_EQ(hit.path, expected) << x << " " << y;
          ++hits;
        }
      }
    }
    gpgpDestroyAsset(drawing);
  }
  EXPECT_GT(hits, 5000u);
  std::printf("%zu points, %zu hits\n", asked, hits);
}

TEST_F(CanvasTest, HitTestsOfListsFindWhatIsSeen) {
  makeCanvas(128);
  // Each entry in a colour of its own, so that the picture says which one lies on top.
  uint32_t index = 0;
  const GpgpAsset set = makeGlyphSet(context, index);
  const auto tone = [](uint32_t i) { return std::array{static_cast<float>(i) / 64, 0.5f, 1.0f, 1.0f}; };
  TestPath triangle;
  triangle.move(0, 0).line(50, 10).line(20, 60).close();
  std::copy_n(tone(60).data(), 4, triangle.color.data());
  const GpgpPath path = triangle.view();
  GpgpDrawingCreateInfo info = GPGP_DRAWING_CREATE_INFO_INIT;
  info.paths = &path;
  info.pathCount = 1;
  info.hitTestable = VK_TRUE;
  GpgpAsset drawing = nullptr;
  ASSERT_EQ(gpgpCreateDrawing(context, &info, &drawing), GPGP_SUCCESS);
  std::mt19937 random(9);
  std::uniform_real_distribution<float> at(0, 100), size(5, 40), turn(0, 360);
  std::uniform_int_distribution<int> choice(0, 9);
  size_t compared = 0, hits = 0;
  TestList list(context);
  for (int round = 0; round < 6; ++round) {
    list.reset();
    uint32_t entries = 0;
    for (int depth = 0; entries < 40;) {
      const int what = choice(random);
      if (depth && what == 0) list.pop(), --depth;
      if (depth < 3 && what == 1) list.push(turned(turn(random), 1, at(random), at(random) / 2)), ++depth;
      if (depth < 3 && what == 2) list.push({0.8f, 0, 0, 0.8f, 5, 6}), ++depth;
      if (depth < 3 && what == 3) {
        const float x = at(random) / 2, y = at(random) / 2;
        const float r = choice(random) < 5 ? 0.0f : 10.0f;
        list.clip({x, y, x + 60, y + 60}, {r, r, r, r}), ++depth;
      }
      if (what < 4) continue;
      const float x = at(random) - 20, y = at(random) - 20, w = size(random), h = size(random);
      GpgpListShape shape = rectangle(x, y, x + w, y + h, tone(entries));
      shape.id = 1000 + entries;
      if (what == 5) shape = rounded(shape, 4, 8, 2, 9, 3);
      if (what == 6) shape = ellipse(shape, what % 2 ? 4.0f : 0.0f);
      if (what == 7) {
        shape = line(x, y, x + h, y + w, 6, GPGP_CAP_ROUND);
        std::copy_n(tone(entries).data(), 4, shape.color);
        shape.id = 1000 + entries;
      }
      if (what < 8) list.add(shape);
      if (what == 8) {
        GpgpGlyphInstance glyphs{index, x, y, w, {}};
        std::copy_n(tone(entries).data(), 4, glyphs.color);
        list.add(set, {glyphs}, 1000 + entries);
      }
      if (what == 9) list.add(drawing, 1000 + entries);
      ++entries;
      if (entries == 40) list.pop(depth);
    }
    for (const size_t k : {size_t(0), size_t(1), size_t(4)}) {
      GpgpCanvasItem item = list.item();
      std::copy_n(kMaps[k].data(), 6, item.transform);
      std::copy_n(kMaps[k].data() + 6, 3, item.perspective);
      const auto pixels = raster({item}, 100, 90, 16);
      for (int i = 0; i < 1500; ++i) {
        const auto px = static_cast<uint32_t>(random() % 100), y = static_cast<uint32_t>(random() % 90);
        const Rgba& p = pixels[y * 100 + px];
        const GpgpHit hit = hitAt(context, {item}, static_cast<float>(px) + 0.5f, static_cast<float>(y) + 0.5f);
        bool flat = true; // the same all around: no edge is near
        for (uint32_t n = 0; n < 9 && flat; ++n) {
          const uint32_t u = px + n % 3 - 1, v = y + n / 3 - 1;
          flat = u < 100 && v < 90 && pixels[v * 100 + u].r == p.r && pixels[v * 100 + u].a == p.a;
        }
        if (!flat || (p.a != 0 && p.a != 1)) continue;
        ++compared;
        if (p.a == 0) {
          ASSERT_EQ(hit.item, GPGP_HIT_NONE) << px << " " << y << ", round " << round << ", map " << k;
          continue;
        }
        ++hits;
        ASSERT_EQ(hit.item, 0u) << px << " " << y << ", round " << round << ", map " << k;
        ASSERT_EQ(hit.id, 1000 + hit.entry);
        const uint32_t seen = static_cast<uint32_t>(std::lround(p.r * 64));
        if (seen == 60) continue; // a drawing, of which there are several
        ASSERT_EQ(hit.entry, seen) << px << " " << y << ", round " << round << ", map " << k;
      }
      if (round == 0 && k == 4) show("hits", pixels, 100, 90);
    }
  }
  std::printf("%zu points, %zu hits\n", compared, hits);
  EXPECT_GT(hits, 3000u);
  // The point is in the space of the entry.
  list.reset().push({2, 0, 0, 2, 10, 20}).push({0, 1, -1, 0, 5, 5}).push({3, 0, 0, 3, 1, 2}).add(rectangle(0, 0, 9, 9));
  const GpgpHit hit = hitAt(context, {list.pop(3).item()}, 10, 60);
  ASSERT_EQ(hit.item, 0u); // (0, 20) -> (15, 5) turned back -> (14 / 3, 3 / 3)
  EXPECT_NEAR(hit.x, 14.0f / 3, 1e-4f);
  EXPECT_NEAR(hit.y, 1, 1e-4f);
  // Decoration is passed over, a drawing that hit tests cannot ask included.
  info.hitTestable = VK_FALSE;
  GpgpAsset decoration = nullptr;
  ASSERT_EQ(gpgpCreateDrawing(context, &info, &decoration), GPGP_SUCCESS);
  GpgpListShape button = rectangle(0, 0, 90, 90), frame = button;
  button.id = 5;
  frame.id = GPGP_ID_NOT_HIT;
  list.reset()
      .add(button)
      .add(frame)
      .add(decoration, GPGP_ID_NOT_HIT)
      .add(set, {{index, 0, 40, 90, {}}}, GPGP_ID_NOT_HIT);
  for (const float p : {8.0f, 20.0f, 45.0f}) EXPECT_EQ(hitAt(context, {list.item()}, p, p).id, 5u);
  EXPECT_EQ(hitAt(context, {list.item()}, 95, 95).item, GPGP_HIT_NONE);
}

TEST_F(CanvasTest, ListsBeyondBudgetsLeaveOutTheLastAndSayHowMany) {
  GpgpCanvasCreateInfo info = GPGP_CANVAS_CREATE_INFO_INIT;
  info.base = {"canvas", device.graphics().family, 0, VK_FALSE};
  info.maxWidth = info.maxHeight = 64;
  info.maxPaths = 4096;
  info.maxShapes = 5;
  info.maxDrawings = 3;
  info.targets = canvasTargets;
  canvas = recorder(gpgpCreateCanvas, info);
  TestList list(context);
  for (int i = 0; i < 8; ++i) list.add(rectangle(static_cast<float>(i) * 8, 0, static_cast<float>(i) * 8 + 8, 64));
  GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT;
  const auto pixels = raster({list.item()}, 64, 64, 4, &report);
  EXPECT_EQ(report.base.status, GPGP_BUDGET_EXCEEDED);
  EXPECT_EQ(report.shapes, 8u);
  EXPECT_EQ(report.shapesGiven, 5u);
  EXPECT_EQ(report.items, 1u);
  EXPECT_EQ(report.pathsDropped, 3u);
  for (uint32_t x = 0; x < 64; ++x) ASSERT_EQ(pixels[x].a, x < 40 ? 1.0f : 0.0f);
  // Changes of transform, and clips that are no scissors, are items.
  list.reset();
  for (int i = 0; i < 5; ++i)
    list.push(turned(90, 1, static_cast<float>(i) * 10 + 10, 0)).add(rectangle(0, 0, 64, 8)).pop();
  const auto turns = raster({list.item()}, 64, 64, 4, &report);
  EXPECT_EQ(report.items, 5u);
  EXPECT_EQ(report.itemsGiven, 3u);
  EXPECT_EQ(report.shapes, 5u);
  EXPECT_EQ(report.pathsDropped, 2u);
  EXPECT_EQ(turns[25].a, 1);
  EXPECT_EQ(turns[35].a, 0);
  // Gradients with many stops count as the shapes that would bring room for them.
  std::vector<GpgpGradientStop> stops(20, {0, {1, 1, 1, 1}});
  GpgpGradient gradient{};
  gradient.transform[0] = gradient.transform[3] = gradient.end[0] = 1;
  gradient.stops = stops.data();
  gradient.stopCount = 20;
  GpgpListShape shape = rectangle(0, 0, 32, 32);
  shape.gradient = &gradient;
  list.reset().add(rectangle(32, 0, 64, 64)).add(shape);
  const auto painted = raster({list.item()}, 64, 64, 4, &report);
  EXPECT_EQ(report.shapes, 10u);
  EXPECT_EQ(report.base.status, GPGP_BUDGET_EXCEEDED);
  EXPECT_EQ(painted[10].a, 0);
  EXPECT_EQ(painted[40].a, 1);
}

TEST_F(CanvasTest, WrongCallsOfListsSayWhatIsWrong) {
  canvasTargets = 0;
  makeCanvas(128);
  TestList list(context);
  const auto refused = [&](GpgpResult result, const char* words, GpgpResult code = GPGP_ERROR_INVALID_ARGUMENT) {
    EXPECT_EQ(result, code) << words;
    EXPECT_NE(lastMessage().find(words), std::string::npos) << lastMessage();
  };
  const float nan = std::nanf("");
  const float bad[9] = {1, 0, nan, 1, 0, 0, 0, 0, 0}, one[9] = {1, 0, 0, 1, 0, 0, 0, 0, nan};
  refused(gpgpPopState(list.list), "gpgpPopState: all that was pushed has been popped");
  refused(gpgpPushTransform(list.list, bad, nullptr), "transform[2] is not finite");
  refused(gpgpPushTransform(list.list, one, one + 6), "perspective[2] is not finite");
  refused(gpgpPushTransform(list.list, nullptr, nullptr), "transform is NULL");
  const float box[4] = {0, 0, -1, 5}, radii[4] = {0, -1, 0, 0}, good[4] = {0, 0, 9, 9};
  refused(gpgpPushClip(list.list, box, nullptr), "box is 0, 0, -1, 5");
  refused(gpgpPushClip(list.list, good, radii), "a radius");
  refused(gpgpPushOpacity(list.list, nan), "opacity is nan");
  refused(gpgpPushOpacity(list.list, 1.5f), "opacity is 1.5");
  std::vector<GpgpListShape> shapes(3, rectangle(0, 0, 5, 5));
  const auto shape = [&](const char* words) {
    refused(gpgpAddShapes(list.list, shapes.data(), 3), words);
    shapes[2] = rectangle(0, 0, 5, 5);
  };
  shapes[2].box[0] = nan, shape("shapes[2].box");
  shapes[2].box[0] = 7, shape("shapes[2].box: right or bottom");
  shapes[2].kind = 9, shape("shapes[2].kind is 9");
  shapes[2].color[3] = 2, shape("shapes[2].color");
  shapes[2].radii[1] = nan, shape("shapes[2].radii");
  shapes[2].width = -1, shape("shapes[2].width is -1");
  shapes[2].kind = GPGP_LIST_LINE, shape("shapes[2].width of a line");
  GpgpListImage image{GPGP_MAX_IMAGES, {0, 0, 1, 1}, {}, {}};
  shapes[2].image = &image, shape("image.image is 1024");
  image.image = 0, image.sourceBorders[0] = 0.7f, image.sourceBorders[2] = 0.7f;
  shapes[2].image = &image, shape("image.sourceBorders are wider");
  GpgpGradient gradient{};
  shapes[2].gradient = &gradient, shape("shapes[2]: gradient: 0 stops");
  refused(gpgpAddShapes(list.list, nullptr, 1), "shapes is NULL");
  refused(gpgpAddText(list.list, nullptr, nullptr, 0, 0), "glyphSet is NULL", GPGP_ERROR_INVALID_HANDLE);
  refused(gpgpAddDrawing(list.list, nullptr, 0, 0), "drawing is NULL", GPGP_ERROR_INVALID_HANDLE);
  refused(gpgpResetList(nullptr), "", GPGP_ERROR_INVALID_HANDLE);
  // What lies within 1e7, and under a scale no longer does; the same under a turn is another matter.
  const float larger[6] = {1e4f, 0, 0, 1e4f, 0, 0}, turned[6] = {0, 1e4f, -1e4f, 0, 0, 0}, far[4] = {0, 0, 2e3f, 9};
  const float round[4] = {2e3f, 0, 0, 0};
  ASSERT_EQ(gpgpPushTransform(list.list, larger, nullptr), GPGP_SUCCESS);
  refused(gpgpPushClip(list.list, far, nullptr), "beyond 1e7 under the transforms pushed");
  refused(gpgpPushClip(list.list, good, round), "beyond 1e7 under the transforms pushed");
  shapes[2].box[2] = 2e3f, shape("shapes[2].box or width is beyond 1e7 under the transforms pushed");
  ASSERT_EQ(gpgpPopState(list.list), GPGP_SUCCESS);
  ASSERT_EQ(gpgpPushTransform(list.list, turned, nullptr), GPGP_SUCCESS);
  EXPECT_EQ(gpgpPushClip(list.list, far, round), GPGP_SUCCESS);
  list.reset();
  const float beyond[4] = {0, 0, 2e7f, 9};
  refused(gpgpPushClip(list.list, beyond, nullptr), "within 1e7");
  for (int i = 0; i < GPGP_MAX_OPACITY_DEPTH; ++i) EXPECT_EQ(gpgpPushGroup(list.list, 0.5f), GPGP_SUCCESS);
  refused(gpgpPushGroup(list.list, 0.5f), "more than 4 nested groups");
  list.reset();
  for (int i = 0; i < GPGP_MAX_LIST_DEPTH; ++i) list.fade(1);
  refused(gpgpPushOpacity(list.list, 1), "more than 64 nested pushes");
  list.reset();
  for (int i = 0; i < GPGP_MAX_CLIP_DEPTH; ++i) list.clip({0, 0, 9, 9});
  refused(gpgpPushClip(list.list, good, nullptr), "more than 16 nested clips");
  const auto record = [&](GpgpCanvasItem item) {
    const GpgpFrame frame = advance();
    GpgpResult result = GPGP_SUCCESS;
    const GpgpHistory view = makeView(64, 64);
    device.submitAndWait([&](VkCommandBuffer commands) {
      EXPECT_EQ(gpgpRecordUpload(context, commands, &frame, 0, nullptr), GPGP_SUCCESS);
      GpgpCanvasInfo info = GPGP_CANVAS_INFO_INIT;
      info.width = info.height = 64;
      info.items = &item;
      info.itemCount = 1;
      info.history = view;
      result = gpgpRecordPrepareCanvas(canvas, commands, &frame, &info);
    });
    gpgpDestroyHistory(view);
    return result;
  };
  refused(record(list.item()), "items[0].list: 16 of its pushes are not popped");
  hitAt(context, {list.item()}, 1, 1, GPGP_ERROR_INVALID_ARGUMENT);
  image = {2, {0, 0, 1, 1}, {}, {}};
  shapes[0].image = &image;
  list.reset().add(shapes[0]);
  refused(record(list.item()), "items[0].list needs 3 images from images[0] on; imageCount is 0");
  const TestPath square = rectanglePath(0, 0, 9, 9);
  const GpgpAsset drawing = makeDrawing({square.view()});
  list.reset().add(rectangle(0, 0, 9, 9)).add(drawing);
  hitAt(context, {list.item()}, 1, 1, GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_NE(lastMessage().find("items[0].list, entry 1: its drawing was made neither hitTestable nor editable"),
            std::string::npos)
      << lastMessage();
  GpgpCanvasItem both = list.item();
  both.drawing = drawing;
  refused(record(both), "both list and drawing");
  gpgpDestroyAsset(drawing);
  refused(record(list.item()), "items[0].list, entry 1: its drawing was destroyed", GPGP_ERROR_INVALID_HANDLE);
  const GpgpListCreateInfo info = GPGP_LIST_CREATE_INFO_INIT;
  GpgpList gone = nullptr;
  ASSERT_EQ(gpgpCreateList(context, &info, &gone), GPGP_SUCCESS);
  gpgpDestroyList(gone);
  GpgpCanvasItem item = list.item();
  item.list = gone;
  refused(record(item), "items[].list is destroyed", GPGP_ERROR_INVALID_HANDLE);
}

TEST_F(CanvasTest, RandomCallsOfListsAreDrawnOrRefused) {
  makeCanvas(128);
  std::mt19937 random(77);
  const float odd[] = {0, 1, -1, 0.5f, 1e-30f, 1e30f, -3e7f, 9e6f, 17, 90, std::nanf(""), INFINITY, 1e-3f, 64};
  const auto number = [&] { return odd[random() % std::size(odd)]; };
  const auto fair = [&] { return static_cast<float>(random() % 1000) * 0.15f - 20; };
  TestList list(context);
  const TestPath triangle = randomShape(5, 60);
  const GpgpPath path = triangle.view();
  GpgpDrawingCreateInfo drawingInfo = GPGP_DRAWING_CREATE_INFO_INIT;
  drawingInfo.paths = &path;
  drawingInfo.pathCount = 1;
  drawingInfo.hitTestable = VK_TRUE;
  GpgpAsset drawing = nullptr;
  ASSERT_EQ(gpgpCreateDrawing(context, &drawingInfo, &drawing), GPGP_SUCCESS);
  std::map<GpgpResult, size_t> results;
  uint64_t settled = 0;
  for (int round = 0; round < 24; ++round) {
    random.seed(static_cast<uint32_t>(round % 12)); // the second half as the first: nothing is allocated then
    list.reset();
    int depth = 0;
    for (int call = 0; call < 120; ++call) {
      const bool wild = random() % 4 == 0;
      const auto value = [&] { return wild && random() % 3 == 0 ? number() : fair(); };
      float v[12];
      for (float& x : v) x = value();
      GpgpResult result = GPGP_SUCCESS;
      switch (random() % 8) {
      case 0: {
        const bool perspective = random() % 3 == 0;
        for (int k = 6; k < 9; ++k) v[k] *= 0.0002f;
        v[8] += 1;
        for (int k = 0; k < 4; ++k) v[k] *= 0.02f;
        result = gpgpPushTransform(list.list, v, perspective ? v + 6 : nullptr);
        depth += result == GPGP_SUCCESS;
        break;
      }
      case 1: {
        v[2] = v[0] + 50, v[3] = v[1] + 60;
        for (int k = 4; k < 8; ++k) v[k] = std::abs(v[k]);
        result = gpgpPushClip(list.list, v, random() % 2 ? v + 4 : nullptr);
        depth += result == GPGP_SUCCESS;
        break;
      }
      case 2:
        result = (random() % 2 ? gpgpPushOpacity : gpgpPushGroup)(list.list, wild ? number() : 0.75f);
        depth += result == GPGP_SUCCESS;
        break;
      case 3:
        result = gpgpPopState(list.list);
        EXPECT_EQ(result == GPGP_SUCCESS, depth > 0);
        depth -= result == GPGP_SUCCESS;
        break;
      case 4: result = gpgpAddDrawing(list.list, drawing, random() % 2 ? 0u : ~0u, 1); break;
      default: {
        GpgpListShape shape = rectangle(v[0], v[1], v[0] + std::abs(v[2]), v[1] + std::abs(v[3]), {1, 0.5f, 0, 0.5f});
        shape.kind = static_cast<GpgpListShapeKind>(random() % (wild ? 4 : 3));
        shape.width = random() % 2 ? std::abs(v[4]) : 0;
        for (int k = 0; k < 4; ++k) shape.radii[k] = random() % 2 ? std::abs(v[5 + k]) : 0;
        result = gpgpAddShapes(list.list, &shape, 1);
      }
      }
      ++results[result];
    }
    for (; depth; --depth) list.pop();
    GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT;
    const auto pixels = raster({list.item()}, 100, 90, 4, &report);
    for (const Rgba& p : pixels) ASSERT_TRUE(p.a >= 0 && p.a <= 1.001f && p.r <= 1.001f) << round;
    for (int i = 0; i < 50; ++i) hitAt(context, {list.item()}, fair(), fair());
    GpgpMemoryReport memory = GPGP_MEMORY_REPORT_INIT;
    ASSERT_EQ(gpgpGetMemoryReport(context, &memory), GPGP_SUCCESS);
    if (round == 12) settled = memory.services[GPGP_SERVICE_CORE].hostBytes;
    if (round > 12) {
      ASSERT_EQ(memory.services[GPGP_SERVICE_CORE].hostBytes, settled) << round;
    }
  }
  EXPECT_GT(results[GPGP_SUCCESS], 1500u);
  EXPECT_GT(results[GPGP_ERROR_INVALID_ARGUMENT], 200u);
  EXPECT_EQ(results.size(), 2u);
}
} // namespace
