#include "cli/visibility/atlas.h"

#include "cli/shared/command.h"
#include "cli/shared/progress.h"
#include "cli/visibility/atlas_picture.h"

#include <sstream>

namespace gpgp::cli {
namespace {

/// One visible triangle in 64 less, with the one that may share its block: between both, so many blocks are new or
/// gone.
std::vector<uint32_t> thinned(std::vector<uint32_t> bits) {
  uint32_t seen = 0;
  for (uint32_t& word : bits)
    for (uint32_t pair = 3; pair; pair <<= 2)
      if (word & pair && ++seen % 64 == 0) word &= ~pair;
  return bits;
}

/// The engine's buffers, an atlas and its recorder.
class AtlasRun {
public:
  AtlasRun(Session& session, const VisibilityOptions& options, SampledModel& scene, const Model& model)
      : session_(session), options_(options), scene_(scene) {
    host::HeadlessDevice& device = session.device();
    const auto make = [&](uint64_t words, const char* name) {
      return host::Buffer(device, std::max<uint64_t>(words, 1) * 4,
                          VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT,
                          host::Memory::device, name);
    };
    blocks = make(model.triangleCount, "blocks");
    tiles = make(uint64_t{options.atlas.width} * options.atlas.height / 8, "tiles");
    dispatches_ = make(5, "dispatches");
    for (host::Buffer* list : {&new_, &changed_, &gone_}) *list = make(model.triangleCount, "blocks listed");
    counts_ = make(4, "counts");
    thinned_ = host::makeBuffer(device, thinned(scene.bits()), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, "thinned bits");
    GpgpAtlasCreateInfo atlas = GPGP_ATLAS_CREATE_INFO_INIT;
    atlas.width = options.atlas.width;
    atlas.height = options.atlas.height;
    atlas.maxTriangles = std::max(model.triangleCount, 1u);
    atlas_ = session.take(Atlas::create(session.context(), atlas), "gpgpCreateAtlas");
    GpgpAtlasRecorderCreateInfo info = GPGP_ATLAS_RECORDER_CREATE_INFO_INIT;
    info.base = session.recorderInfo("atlas recorder");
    info.maxTriangles = atlas.maxTriangles;
    const Progress progress("making pipelines");
    recorder_ = session.take(AtlasRecorder::create(session.context(), info), "gpgpCreateAtlasRecorder");
    session.check(recorder_.prewarm(), "gpgpPrewarm");
    session.upload();
  }

  /// alternate: every other recording is of fewer triangles.
  Measured<GpgpAtlasReport> record(uint32_t repeat, bool pairs, bool alternate) {
    const GpgpAccess after{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT,
                           VK_IMAGE_LAYOUT_UNDEFINED};
    uint32_t count = 0;
    return session_.measure(recorder_, "allocating", repeat,
                            [&](VkCommandBuffer commands, const GpgpFrame& frame, const GpgpRecordingInfo& base) {
                              GpgpAtlasInfo info = GPGP_ATLAS_INFO_INIT;
                              info.base = base;
                              info.atlas = atlas_;
                              info.texelsPerPixel = options_.texelsPerPixel;
                              scene_.describe(info, pairs);
                              if (alternate && count++ % 2 == 0) info.visibleBits = thinned_.range();
                              info.blocks = blocks.range({}, after);
                              info.tiles = tiles.range({}, after);
                              info.dispatches = dispatches_.range({}, after);
                              info.newBlocks = new_.range({}, after);
                              info.changedBlocks = changed_.range({}, after);
                              info.goneBlocks = gone_.range({}, after);
                              info.counts = counts_.range({}, after);
                              return recorder_.recordPrepare(commands, frame, info);
                            });
  }

  host::Buffer blocks, tiles;

private:
  Session& session_;
  const VisibilityOptions& options_;
  SampledModel& scene_;
  Atlas atlas_;
  AtlasRecorder recorder_;
  host::Buffer dispatches_, new_, changed_, gone_, counts_, thinned_;
};
} // namespace

AtlasFigures allocateAtlas(Session& session, const VisibilityOptions& options, SampledModel& scene, const Model& model,
                           const std::vector<glm::vec3>& corners, const View& view) {
  AtlasRun run(session, options, scene, model);
  AtlasFigures figures;
  figures.hasPairs = model.draws.size() <= 65535;
  figures.firstMilliseconds = run.record(1, figures.hasPairs, false).times.median();
  const auto changing = run.record(options.repeat, false, true);
  figures.times = changing.times;
  figures.changing = changing.report;
  figures.report = run.record(1, false, false).report;
  if (options.out.empty() && options.display.empty()) return figures;
  const Progress painting("shading the atlas");
  host::HeadlessDevice& device = session.device();
  const auto blocks = host::download<uint32_t>(device, run.blocks, model.triangleCount);
  const auto tiles = host::download<std::array<uint32_t, 2>>(device, run.tiles, figures.report.tiles);
  const host::Picture atlas = shadeAtlas(options.atlas, blocks, tiles, corners);
  if (!options.out.empty()) host::writePng(options.out, atlas);
  if (options.display.empty()) return figures;
  const Display display = displayAtlas(options.size, view, scene.bits(), atlas, blocks, corners);
  figures.psnr = display.psnr;
  figures.shown = display.shown;
  figures.holes = display.holes;
  host::writePng(options.display, display.picture);
  return figures;
}

Json jsonOf(const VisibilityOptions& options, const AtlasFigures& atlas) {
  const GpgpAtlasReport& report = atlas.report;
  Json classes = Json::array();
  for (const uint32_t blocks : report.blocksByClass) classes.push_back(blocks);
  Json passes = Json::object();
  for (const auto& [name, time] : atlas.times.passes) passes[name] = time;
  const GpgpAtlasReport& changing = atlas.changing;
  return {{"width", options.atlas.width},
          {"height", options.atlas.height},
          {"status", statusName(report.base.status)},
          {"visibleTriangles", report.visibleTriangles},
          {"blocks", report.blocks},
          {"blocksByClass", classes},
          {"lowered", report.loweredBlocks},
          {"dropped", report.droppedBlocks},
          {"droppedTriangles", report.droppedTriangles},
          {"tiles", report.tiles},
          {"superblocks", report.superblocks},
          {"maxSuperblocks", report.maxSuperblocks},
          {"pressure", report.pressure},
          {"fill", report.fill},
          {"fragmentation", report.fragmentation},
          {"firstMilliseconds", atlas.firstMilliseconds},
          {"changing",
           {{"new", changing.newBlocks},
            {"changed", changing.changedBlocks},
            {"gone", changing.goneBlocks},
            {"kept", changing.keptBlocks},
            {"repacked", changing.repacked != 0}}},
          {"gpu_ms_median", atlas.times.median()},
          {"gpuMilliseconds", atlas.times.json()},
          {"passes", passes},
          {"out", options.out.empty() ? Json() : Json(options.out)},
          {"display", options.display.empty() ? Json() : Json(options.display)},
          {"psnr", options.display.empty() ? Json() : Json(atlas.psnr)},
          {"shownPixels", atlas.shown},
          {"holes", atlas.holes}};
}

std::string textOf(const VisibilityOptions& options, const AtlasFigures& atlas) {
  const GpgpAtlasReport& report = atlas.report;
  std::ostringstream text;
  text.setf(std::ios::fixed);
  text.precision(1);
  text << "atlas " << options.atlas.width << 'x' << options.atlas.height << ": " << report.blocks << " blocks, "
       << report.superblocks << " of " << report.maxSuperblocks << " superblocks, " << 100 * report.fill
       << " % filled; GPU " << milliseconds(atlas.times.median()) << " with " << atlas.changing.newBlocks << " new, "
       << atlas.changing.changedBlocks << " changed, " << atlas.changing.goneBlocks << " gone\n";
  if (report.loweredBlocks || report.droppedBlocks)
    text << "budget exceeded: " << report.loweredBlocks << " blocks have fewer texels than asked for, "
         << report.droppedTriangles << " visible triangles have none; a larger --atlas or fewer --texels help\n";
  if (!atlas.hasPairs) text << "more than 65535 draws: each triangle has a block of its own\n";
  if (!options.out.empty()) text << "atlas picture: " << options.out << '\n';
  if (!options.display.empty())
    text << "display: " << options.display << " (left: from the atlas; right: shaded directly), " << atlas.psnr
         << " dB, " << atlas.holes << " of " << atlas.shown << " pixels without a block\n";
  return text.str();
}

} // namespace gpgp::cli
