// The same position, index and draw buffers serve gpgp's recorder and the engine's own vertex shader.
#include "sight.h"

#include "target.h"

#include "shaders/mini_model_frag.spv.h"
#include "shaders/mini_model_vert.spv.h"

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <iterator>
#include <utility>

namespace mini {

Sight::Sight(Device& device, Gpgp& gpgp, const Forward& forward, Model model) : gpgp_(gpgp), model_(std::move(model)) {
  constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  positions_ = makeBuffer(device, model_.positions, kStorage);
  normals_ = makeBuffer(device, model_.normals, kStorage);
  indices_ = makeBuffer(device, model_.indices, kStorage);
  draws_ = makeBuffer(device, model_.draws, kStorage);
  const std::vector<uint32_t> none((model_.triangleCount + 31) / 32);
  visibleBits_ = makeBuffer(device, none, kStorage);

  geometry_ = gpgp.geometrySet("model", model_.meshes);
  auto recorderInfo = gpgp::init<GpgpVisibilityRecorderCreateInfo>();
  recorderInfo.base = gpgp.recorder("model recorder");
  recorderInfo.maxWidth = kMaxExtent.width;
  recorderInfo.maxHeight = kMaxExtent.height;
  recorderInfo.maxDraws = static_cast<uint32_t>(model_.draws.size());
  recorderInfo.maxTriangles = model_.triangleCount;
  recorder_ = gpgp.take(gpgp::VisibilityRecorder::create(gpgp.context, recorderInfo), "gpgpCreateVisibilityRecorder");
  gpgp.shareScratch(recorder_);
  gpgp.check(recorder_.prewarm(), "gpgpPrewarm");
  auto viewInfo = gpgp::init<GpgpCameraHistoryCreateInfo>();
  viewInfo.label = "main camera";
  viewInfo.maxTriangles = model_.triangleCount;
  view_ = gpgp.take(gpgp::CameraHistory::create(gpgp.context, viewInfo), "gpgpCreateCameraHistory");

  set_ = std::make_unique<BufferSet>(
      device, std::vector<const Buffer*>{&positions_, &normals_, &indices_, &draws_, &visibleBits_},
      VK_SHADER_STAGE_VERTEX_BIT);
  PipelineInfo info;
  info.vertex.assign(std::begin(mini_model_vert), std::end(mini_model_vert));
  info.fragment.assign(std::begin(mini_model_frag), std::end(mini_model_frag));
  info.setLayout = set_->layout;
  info.pushBytes = 96;
  pipeline_ = Pipeline(device, forward.renderPass(), Forward::kSamples, info);
}

void Sight::prepare(VkCommandBuffer commands, const GpgpFrame& frame, const Camera& camera, VkExtent2D extent) {
  auto info = gpgp::init<GpgpVisibilityInfo>();
  info.base.tag = frame.current;
  info.base.scratch = gpgp_.scratch();
  info.geometrySet = geometry_;
  info.history = view_;
  info.method = GPGP_SAMPLING_STANDARD;
  std::copy_n(glm::value_ptr(camera.viewProjection), 16, info.camera.viewProjection);
  info.width = extent.width;
  info.height = extent.height;
  info.positions = positions_.forGpgp(kNoAccess, kNoAccess);
  info.positionStride = 12;
  info.indices = indices_.forGpgp(kNoAccess, kNoAccess);
  info.indexType = VK_INDEX_TYPE_UINT32;
  info.draws = draws_.forGpgp(kNoAccess, kNoAccess);
  info.drawCount = static_cast<uint32_t>(model_.draws.size());
  info.triangleCount = model_.triangleCount;
  info.visibleBits = visibleBits_.forGpgp(kVertexShaderRead, kVertexShaderRead);
  if (gpgp_.check(recorder_.recordPrepare(commands, frame, info), "gpgpRecordPrepareVisibility") == GPGP_SUCCESS)
    prepared_ = true;
}

void Sight::draw(VkCommandBuffer commands, const Camera& camera) {
  if (!prepared_) return;
  struct {
    glm::mat4 viewProjection;
    glm::vec4 eye;
    uint32_t draw, firstIndex, vertexOffset, unused;
  } push{camera.viewProjection, camera.eyeAndLight(), 0, 0, 0, 0};
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_.handle);
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_.layout, 0, 1, &set_->handle, 0, nullptr);
  for (uint32_t i = 0; i < model_.draws.size(); ++i) {
    const GpgpMesh& mesh = model_.meshes[model_.draws[i].mesh];
    push.draw = i;
    push.firstIndex = mesh.firstIndex;
    push.vertexOffset = mesh.vertexOffset;
    vkCmdPushConstants(commands, pipeline_.layout, Pipeline::kStages, 0, sizeof push, &push);
    vkCmdDraw(commands, mesh.indexCount, 1, 0, 0);
  }
}

void Sight::collect() {
  for (auto next = recorder_.report(); next; next = recorder_.report()) {
    report_ = *next;
    ++reports_;
  }
}

} // namespace mini
