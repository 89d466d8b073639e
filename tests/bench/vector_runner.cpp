#include "vector_runner.h"

#include "host/memory.h"

namespace gpgp::bench {

VectorRunner::VectorRunner(host::HeadlessDevice& device) : device_(device), busy_(device) {
  GpgpContextCreateInfo info = device.contextCreateInfo();
  info.uploadRingBytes = 128 << 20;
  info.messageFn = [](void*, const GpgpMessage* m) { std::fprintf(stderr, "%s\n", m->text); };
  expect(gpgpCreateContext(&info, &context_), "gpgpCreateContext");
}

VectorRunner::~VectorRunner() {
  closeCanvas();
  gpgpDestroyContext(context_);
}

void VectorRunner::closeCanvas() {
  device_.waitIdle();
  device_.vk().vkDestroyQueryPool(device_.device(), queries_, nullptr);
  if (history_) gpgpDestroyHistory(history_);
  if (canvas_) gpgpDestroyRecorder(canvas_);
  history_ = nullptr;
  queries_ = VK_NULL_HANDLE;
  canvas_ = nullptr;
}

VectorMade VectorRunner::makeDrawing(const Scene& scene) {
  VectorMade made;
  std::vector<GpgpPath> paths;
  for (const Shape& s : scene.shapes) paths.push_back(s.view());
  GpgpDrawingCreateInfo info = GPGP_DRAWING_CREATE_INFO_INIT;
  info.paths = paths.data();
  info.pathCount = static_cast<uint32_t>(paths.size());
  info.groups = scene.groups.data();
  info.groupCount = static_cast<uint32_t>(scene.groups.size());
  const auto begin = Clock::now();
  expect(gpgpCreateDrawing(context_, &info, &made.item.drawing), "gpgpCreateDrawing");
  made.milliseconds = milliseconds(Clock::now() - begin);
  made.asset.reset(made.item.drawing);
  expect(gpgpGetDrawingInfo(made.item.drawing, &made.facts), "gpgpGetDrawingInfo");
  return made;
}

VectorMade VectorRunner::makeText(const Scene& scene) {
  VectorMade made;
  std::vector<GpgpPath> paths;
  std::vector<GpgpGlyph> glyphs;
  for (const Shape& s : scene.glyphs) paths.push_back(s.view());
  for (const GpgpPath& path : paths) glyphs.push_back({glyphs.size(), &path, 1, nullptr});
  const GpgpGlyphSetCreateInfo info = GPGP_GLYPH_SET_CREATE_INFO_INIT;
  expect(gpgpCreateGlyphSet(context_, &info, &made.item.glyphSet), "gpgpCreateGlyphSet");
  made.asset.reset(made.item.glyphSet);
  made.glyphs.resize(glyphs.size());
  const auto begin = Clock::now();
  expect(gpgpAddGlyphs(made.item.glyphSet, glyphs.data(), static_cast<uint32_t>(glyphs.size()), made.glyphs.data()),
         "gpgpAddGlyphs");
  made.milliseconds = milliseconds(Clock::now() - begin);
  made.text = scene.text;
  for (GpgpGlyphInstance& g : made.text) g.glyph = made.glyphs[g.glyph - 1];
  made.item.glyphs = made.text.data();
  made.item.glyphCount = static_cast<uint32_t>(made.text.size());
  made.facts.paths = made.item.glyphCount;
  made.facts.curves = static_cast<uint32_t>(curvesOf(scene));
  made.facts.patches = made.facts.curves; // enough
  return made;
}

void VectorRunner::openCanvas(uint32_t largest, uint32_t maxPaths, uint32_t maxGlyphs) {
  closeCanvas();
  GpgpCanvasCreateInfo info = GPGP_CANVAS_CREATE_INFO_INIT;
  info.base = {"bench", device_.graphics().family, 0, VK_FALSE};
  info.maxWidth = info.maxHeight = largest;
  info.maxPaths = maxPaths;
  info.maxGlyphs = maxGlyphs;
  info.maxTileEntries = 1 << 19;
  expect(gpgpCreateCanvas(context_, &info, &canvas_), "gpgpCreateCanvas");
  GpgpCanvasHistoryCreateInfo keeps = GPGP_CANVAS_HISTORY_CREATE_INFO_INIT;
  keeps.maxKept = maxPaths + maxGlyphs;
  expect(gpgpCreateCanvasHistory(context_, &keeps, &history_), "gpgpCreateCanvasHistory");
  const GpgpPrewarmInfo prewarm = GPGP_PREWARM_INFO_INIT;
  expect(gpgpPrewarm(canvas_, &prewarm), "gpgpPrewarm");
  uint32_t passes = 0;
  expect(gpgpGetPasses(canvas_, &passes, nullptr), "gpgpGetPasses");
  names_.resize(passes);
  expect(gpgpGetPasses(canvas_, &passes, names_.data()), "gpgpGetPasses");
  const VkQueryPoolCreateInfo query{
      VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO, nullptr, 0, VK_QUERY_TYPE_TIMESTAMP, passes + 3, 0};
  host::check(device_.vk().vkCreateQueryPool(device_.device(), &query, nullptr, &queries_), "vkCreateQueryPool");
}

VectorDrawn VectorRunner::draw(VectorMade& made, const Scene& scene, uint32_t width, uint32_t height,
                               const Settings& settings, int repeat) {
  const host::Image target(device_, {.width = width, .height = height}, "picture");
  const uint32_t passes = static_cast<uint32_t>(names_.size());
  GpgpCanvasItem& item = made.item;
  item.transform[0] = item.transform[3] = static_cast<float>(std::min(width / scene.width, height / scene.height));
  item.opacity = 1;
  const VolkDeviceTable& vk = device_.vk();
  const double period = static_cast<double>(device_.properties().limits.timestampPeriod) * 1e-6;
  VectorDrawn result;
  std::vector<double> totals, recording;
  std::vector<std::vector<double>> each(passes);
  busy_.warmUp();                            // converting may have taken seconds
  for (int i = 0; i < 2 * repeat + 2; ++i) { // records timed as a whole and by pass, in turn; the first of each are not
    const bool split = i % 2 == 0;
    for (size_t k = 0; scene.changes && k < made.text.size(); ++k) // another string of the same glyphs
      made.text[k].glyph = made.glyphs[(k * 7 + k / 11 + static_cast<size_t>(i)) % made.glyphs.size()];
    for (size_t k = 0; k < std::min<size_t>(settings.edits, made.text.size()); ++k)
      made.text[k].glyph = made.glyphs[(k + static_cast<size_t>(i)) % made.glyphs.size()];
    frame_ += 2;
    const GpgpFrame frame{frame_ - 1, frame_ - 2}, done{frame_, frame_ - 1};
    expect(gpgpAdvance(context_, &frame), "gpgpAdvance");
    device_.submitAndWait([&](VkCommandBuffer cmd) {
      expect(gpgpRecordUpload(context_, cmd, &frame, 0, nullptr), "gpgpRecordUpload");
      busy_.record(cmd);
      vk.vkCmdResetQueryPool(cmd, queries_, 0, passes + 3);
      GpgpCanvasInfo info = GPGP_CANVAS_INFO_INIT;
      if (split) info.base.timestamps = {queries_, 0, passes + 1};
      info.width = width;
      info.height = height;
      info.items = &item;
      info.itemCount = 1;
      info.samples = settings.samples;
      info.exactArea = settings.exactArea;
      std::fill_n(info.background, 4, 1.0f);
      if (settings.keep) info.history = history_;
      info.keep = settings.keep && i > 0;
      const GpgpAccess drawn{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT,
                             VK_IMAGE_LAYOUT_GENERAL};
      info.target = target.target(info.keep ? drawn : GpgpAccess{}, drawn);
      info.encodeSrgb = VK_TRUE;
      info.blendSrgb = settings.blendSrgb;
      vk.vkCmdWriteTimestamp(cmd, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, queries_, passes + 1);
      const auto start = Clock::now();
      expect(gpgpRecordPrepareCanvas(canvas_, cmd, &frame, &info), "gpgpRecordPrepareCanvas");
      if (i >= 2 && !split) recording.push_back(milliseconds(Clock::now() - start) * 1000);
      vk.vkCmdWriteTimestamp(cmd, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, queries_, passes + 2);
    });
    expect(gpgpAdvance(context_, &done), "gpgpAdvance");
    GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT;
    expect(gpgpGetCanvasReport(canvas_, &report), "gpgpGetCanvasReport");
    if (report.pathsDropped) {
      std::fprintf(stderr, "%s: %u paths dropped, %u entries needed\n", scene.name.c_str(), report.pathsDropped,
                   report.tileEntries);
      std::exit(1);
    }
    result.entries = report.tileEntries;
    result.tiles = report.tiles;
    result.tilesDrawn = report.tilesDrawn;
    const uint32_t count = split ? passes + 1 : 2;
    std::vector<uint64_t> times(count);
    host::check(vk.vkGetQueryPoolResults(device_.device(), queries_, split ? 0 : passes + 1, count, count * 8,
                                         times.data(), 8, VK_QUERY_RESULT_64_BIT),
                "vkGetQueryPoolResults");
    if (i < 2) continue;
    if (!split) totals.push_back(static_cast<double>(times[1] - times[0]) * period);
    for (uint32_t k = 0; split && k < passes; ++k)
      each[k].push_back(static_cast<double>(times[k + 1] - times[k]) * period);
  }
  const auto one = [&](const std::vector<double>& times) {
    return settings.least ? *std::min_element(times.begin(), times.end()) : median(times);
  };
  result.milliseconds = one(totals);
  result.microseconds = one(recording);
  for (uint32_t k = 0; k < passes; ++k) result.passes.emplace_back(names_[k], one(each[k]));
  result.pixels = host::downloadImage(device_, target, VK_IMAGE_LAYOUT_GENERAL);
  return result;
}

} // namespace gpgp::bench
