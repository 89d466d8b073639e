// `gpgp visibility`: samples which triangles of a model one camera sees.
#include "cli/model.h"
#include "cli/painter.h"
#include "cli/session.h"

#include <gpgp/visibility.h>

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <array>
#include <sstream>

namespace gpgp::cli {
namespace {

struct VisibilityOptions {
  std::string model, image;
  Size size{1280, 720};
  float yaw = 35, pitch = 20;
  uint32_t repeat = 1;
  bool twoSided = false;
};

/// World-space corners of each triangle in its number's order.
std::vector<glm::vec3> worldCorners(const Model& model) {
  std::vector<glm::vec3> corners;
  corners.reserve(size_t{model.triangleCount} * 3);
  for (const GpgpVisibilityDraw& draw : model.draws) {
    const GpgpMesh& mesh = model.meshes[draw.mesh];
    for (uint32_t i = 0; i < mesh.indexCount; ++i) {
      const float* p = &model.positions[(size_t{mesh.vertexOffset} + model.indices[mesh.firstIndex + i]) * 3];
      const float* m = draw.transform;
      corners.emplace_back(m[0] * p[0] + m[1] * p[1] + m[2] * p[2] + m[3],
                           m[4] * p[0] + m[5] * p[1] + m[6] * p[2] + m[7],
                           m[8] * p[0] + m[9] * p[1] + m[10] * p[2] + m[11]);
    }
  }
  return corners;
}

/// What the camera saw, from the camera and from the side: seen triangles orange, all others grey.
void paint(const VisibilityOptions& options, const std::vector<glm::vec3>& corners, const Bounds& bounds,
           const std::vector<uint32_t>& bits) {
  const uint32_t width = options.size.width, height = options.size.height;
  host::Picture both{width * 2, height, std::vector<uint8_t>(size_t{width} * height * 8)};
  for (uint32_t side = 0; side < 2; ++side) {
    const glm::mat4 camera =
        viewAll(bounds, options.yaw + 110.0f * static_cast<float>(side), options.pitch, width, height);
    Painter painter(width, height);
    for (size_t t = 0; t < corners.size() / 3; ++t) {
      const bool seen = bits[t / 32] >> t % 32 & 1u;
      painter.triangle(camera, std::span<const glm::vec3, 3>(&corners[t * 3], 3),
                       seen ? glm::vec3(0.95f, 0.55f, 0.15f) : glm::vec3(0.62f));
    }
    const host::Picture half = painter.picture();
    for (uint32_t y = 0; y < height; ++y)
      std::copy_n(&half.rgba[size_t{y} * width * 4], width * 4, &both.rgba[(size_t{y} * 2 + side) * width * 4]);
  }
  host::writePng(options.image, both);
}

Outcome visibility(const VisibilityOptions& options, const CommonOptions& common) {
  Model model = loadModel(options.model);
  if (options.twoSided)
    for (GpgpVisibilityDraw& draw : model.draws) draw.flags |= GPGP_DRAW_TWO_SIDED;
  const std::vector<glm::vec3> corners = worldCorners(model);
  Bounds bounds;
  for (const glm::vec3& corner : corners) bounds.add(corner);

  Session session(common);
  host::HeadlessDevice& device = session.device();
  GpgpGeometrySetCreateInfo geometryInfo = GPGP_GEOMETRY_SET_CREATE_INFO_INIT;
  geometryInfo.label = options.model.c_str();
  geometryInfo.meshes = model.meshes.data();
  geometryInfo.meshCount = static_cast<uint32_t>(model.meshes.size());
  const GeometrySet geometry =
      session.take(GeometrySet::create(session.context(), geometryInfo), "gpgpCreateGeometrySet");
  GpgpSamplerCreateInfo samplerInfo = GPGP_SAMPLER_CREATE_INFO_INIT;
  samplerInfo.base = session.workerInfo("sampler");
  samplerInfo.maxWidth = options.size.width;
  samplerInfo.maxHeight = options.size.height;
  samplerInfo.maxDraws = static_cast<uint32_t>(model.draws.size());
  samplerInfo.maxTriangles = model.triangleCount;
  Sampler sampler = session.take(Sampler::create(session.context(), samplerInfo), "gpgpCreateSampler");
  session.check(sampler.prewarm(), "gpgpPrewarm");
  session.upload();

  constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  const host::Buffer positions = host::makeBuffer(device, model.positions, kStorage, "positions");
  const host::Buffer indices = host::makeBuffer(device, model.indices, kStorage, "indices");
  const host::Buffer draws = host::makeBuffer(device, model.draws, kStorage, "draws");
  const uint32_t words = (model.triangleCount + 31) / 32;
  const host::Buffer visibleBits(device, VkDeviceSize{words} * 4, kStorage, host::Memory::device, "visible bits");
  const host::Buffer visibleList(device, VkDeviceSize{model.triangleCount} * 4, kStorage, host::Memory::device,
                                 "visible list");
  const host::Buffer visibleCount(device, 16, kStorage, host::Memory::device, "visible count");
  const glm::mat4 camera = viewAll(bounds, options.yaw, options.pitch, options.size.width, options.size.height);
  const GpgpAccess after{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT, VK_IMAGE_LAYOUT_UNDEFINED};
  const auto [times, report] =
      session.measure(sampler, "sampling", options.repeat,
                      [&](VkCommandBuffer commands, const GpgpFrame& frame, const GpgpRecordInfo& base) {
                        GpgpSampleInfo info = GPGP_SAMPLE_INFO_INIT;
                        info.base = base;
                        info.geometrySet = geometry;
                        info.method = GPGP_SAMPLING_STANDARD;
                        std::copy_n(glm::value_ptr(camera), 16, info.camera.viewProjection);
                        info.width = options.size.width;
                        info.height = options.size.height;
                        info.positions = positions.range();
                        info.positionStride = 12;
                        info.indices = indices.range();
                        info.indexType = VK_INDEX_TYPE_UINT32;
                        info.draws = draws.range();
                        info.drawCount = static_cast<uint32_t>(model.draws.size());
                        info.triangleCount = model.triangleCount;
                        info.visibleBits = visibleBits.range({}, after);
                        info.visibleList = visibleList.range({}, after);
                        info.visibleCount = visibleCount.range({}, after);
                        return sampler.recordPrepare(commands, frame, info);
                      });
  if (!options.image.empty()) paint(options, corners, bounds, host::download<uint32_t>(device, visibleBits, words));
  session.checkValidation();

  const double share = 100.0 * report.visible / model.triangleCount;
  Outcome outcome;
  std::ostringstream text;
  text.precision(3);
  text << options.model << ": " << model.triangleCount << " triangles in " << model.draws.size() << " draws\n"
       << report.visible << " visible (" << share << " %), " << report.coveredPixels << " of "
       << uint64_t{options.size.width} * options.size.height << " pixels covered; GPU " << milliseconds(times.median())
       << " (median of " << times.totals.size() << ") on " << device.name() << '\n';
  if (report.listed < report.visible) text << "budget exceeded: " << report.visible - report.listed << " not listed\n";
  if (model.leftOut) text << model.leftOut << " primitives are no triangles and were left out\n";
  if (!options.image.empty())
    text << "picture: " << options.image << " (left: from the camera; right: from the side)\n";
  outcome.text = text.str();
  outcome.json = {{"model", options.model},
                  {"device", device.name()},
                  {"status", statusName(report.base.status)},
                  {"method", "standard"},
                  {"width", options.size.width},
                  {"height", options.size.height},
                  {"draws", model.draws.size()},
                  {"triangles", model.triangleCount},
                  {"facing", report.triangles},
                  {"visible", report.visible},
                  {"listed", report.listed},
                  {"coveredPixels", report.coveredPixels},
                  {"gpuMilliseconds", times.json()},
                  {"image", options.image.empty() ? Json() : Json(options.image)}};
  return outcome;
}

} // namespace

Work addVisibility(CLI::App& app) {
  auto options = std::make_shared<VisibilityOptions>();
  CLI::App* command = app.add_subcommand("visibility", "Sample which triangles of a model a camera sees");
  command->add_option("MODEL", options->model, "glTF 2 (.glb, .gltf) or Wavefront (.obj)")
      ->required()
      ->check(CLI::ExistingFile);
  addSize(*command, "--size", options->size, "Viewport in pixels (default 1280x720)");
  command->add_option("--yaw", options->yaw, "Degrees around the model")->capture_default_str();
  command->add_option("--pitch", options->pitch, "Degrees above the horizon")
      ->check(CLI::Range(-89.0f, 89.0f))
      ->capture_default_str();
  command->add_flag("--two-sided", options->twoSided, "Back faces count as well");
  command->add_option("--repeat", options->repeat, "Sample N times and report the median time")
      ->check(CLI::Range(1u, 100000u))
      ->capture_default_str();
  command->add_option("--image", options->image, "Write a picture: the camera's view, and the same from the side")
      ->type_name("FILE.png");
  command->footer(R"(
Examples:
  gpgp visibility engine.glb
  gpgp visibility bunny.obj --yaw 90 --image seen.png
  gpgp visibility engine.glb --size 1920x1080 --repeat 100 --json | jq .visible

The camera looks at the middle of the model from far enough to see all of it.)");
  return [options](const CommonOptions& common) { return visibility(*options, common); };
}

} // namespace gpgp::cli
