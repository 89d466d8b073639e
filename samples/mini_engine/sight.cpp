// The same position, index and draw buffers serve gpgp's sampler and the engine's own vertex shader.
#include "sight.h"

#include "target.h"

#include "shaders/mini_model_frag.spv.h"
#include "shaders/mini_model_vert.spv.h"

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

namespace mini {

Sight::Sight(Device& device, Gpgp& gpgp, const Forward& forward, Model model)
    : device_(device), gpgp_(gpgp), model_(std::move(model)) {
  constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  positions_ = makeBuffer(device, model_.positions, kStorage);
  normals_ = makeBuffer(device, model_.normals, kStorage);
  indices_ = makeBuffer(device, model_.indices, kStorage);
  draws_ = makeBuffer(device, model_.draws, kStorage);
  const std::vector<uint32_t> none((model_.triangleCount + 31) / 32);
  visibleBits_ = makeBuffer(device, none, kStorage);

  auto geometryInfo = gpgp::init<GpgpGeometrySetCreateInfo>();
  geometryInfo.label = "model";
  geometryInfo.meshes = model_.meshes.data();
  geometryInfo.meshCount = static_cast<uint32_t>(model_.meshes.size());
  geometry_ = gpgp.take(gpgp::GeometrySet::create(gpgp.context, geometryInfo), "gpgpCreateGeometrySet");
  auto samplerInfo = gpgp::init<GpgpSamplerCreateInfo>();
  samplerInfo.base = gpgp.worker("model sampler");
  samplerInfo.maxWidth = kMaxExtent.width;
  samplerInfo.maxHeight = kMaxExtent.height;
  samplerInfo.maxDraws = static_cast<uint32_t>(model_.draws.size());
  samplerInfo.maxTriangles = model_.triangleCount;
  sampler_ = gpgp.take(gpgp::Sampler::create(gpgp.context, samplerInfo), "gpgpCreateSampler");
  gpgp.check(sampler_.prewarm(), "gpgpPrewarm");
  auto viewInfo = gpgp::init<GpgpCameraViewCreateInfo>();
  viewInfo.label = "main camera";
  viewInfo.maxTriangles = model_.triangleCount;
  view_ = gpgp.take(gpgp::CameraView::create(gpgp.context, viewInfo), "gpgpCreateCameraView");

  bindBuffers();
  PipelineInfo info;
  info.vertex.assign(std::begin(mini_model_vert), std::end(mini_model_vert));
  info.fragment.assign(std::begin(mini_model_frag), std::end(mini_model_frag));
  info.setLayout = setLayout_;
  info.pushBytes = 96;
  pipeline_ = Pipeline(device, forward.renderPass(), Forward::kSamples, info);
}

Sight::~Sight() {
  vkDestroyDescriptorPool(device_.device, pool_, nullptr);
  vkDestroyDescriptorSetLayout(device_.device, setLayout_, nullptr);
}

void Sight::bindBuffers() {
  const std::array<const Buffer*, 5> buffers = {&positions_, &normals_, &indices_, &draws_, &visibleBits_};
  std::array<VkDescriptorSetLayoutBinding, 5> bindings{};
  for (uint32_t i = 0; i < bindings.size(); ++i)
    bindings[i] = {i, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_VERTEX_BIT, nullptr};
  VkDescriptorSetLayoutCreateInfo layoutInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  layoutInfo.bindingCount = bindings.size();
  layoutInfo.pBindings = bindings.data();
  check(vkCreateDescriptorSetLayout(device_.device, &layoutInfo, nullptr, &setLayout_), "vkCreateDescriptorSetLayout");
  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, bindings.size()};
  VkDescriptorPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  poolInfo.maxSets = 1;
  poolInfo.poolSizeCount = 1;
  poolInfo.pPoolSizes = &size;
  check(vkCreateDescriptorPool(device_.device, &poolInfo, nullptr, &pool_), "vkCreateDescriptorPool");
  VkDescriptorSetAllocateInfo allocate{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
  allocate.descriptorPool = pool_;
  allocate.descriptorSetCount = 1;
  allocate.pSetLayouts = &setLayout_;
  check(vkAllocateDescriptorSets(device_.device, &allocate, &set_), "vkAllocateDescriptorSets");
  std::array<VkDescriptorBufferInfo, 5> infos{};
  std::array<VkWriteDescriptorSet, 5> writes{};
  for (uint32_t i = 0; i < writes.size(); ++i) {
    infos[i] = {buffers[i]->handle, 0, VK_WHOLE_SIZE};
    writes[i].sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    writes[i].dstSet = set_;
    writes[i].dstBinding = i;
    writes[i].descriptorCount = 1;
    writes[i].descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    writes[i].pBufferInfo = &infos[i];
  }
  vkUpdateDescriptorSets(device_.device, writes.size(), writes.data(), 0, nullptr);
}

void Sight::prepare(VkCommandBuffer commands, const GpgpFrame& frame, const Camera& camera, VkExtent2D extent) {
  auto info = gpgp::init<GpgpSampleInfo>();
  info.base.tag = frame.current;
  info.geometrySet = geometry_;
  info.view = view_;
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
  if (gpgp_.check(sampler_.recordPrepare(commands, frame, info), "gpgpRecordPrepareVisibility") == GPGP_SUCCESS)
    prepared_ = true;
}

void Sight::draw(VkCommandBuffer commands, const Camera& camera) {
  if (!prepared_) return;
  struct {
    glm::mat4 viewProjection;
    glm::vec4 eye;
    uint32_t draw, firstIndex, vertexOffset, unused;
  } push{camera.viewProjection, glm::vec4(camera.eye, 1), 0, 0, 0, 0};
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_.handle);
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_.layout, 0, 1, &set_, 0, nullptr);
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
  for (auto next = sampler_.report(); next; next = sampler_.report()) {
    report_ = *next;
    ++reports_;
  }
}

} // namespace mini
