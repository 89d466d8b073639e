// Axioms on a grid of blocks, one indirect draw per bucket, one unit box for every shape.
#include "city.h"

#include "level.h"

#include "shaders/mini_city_frag.spv.h"
#include "shaders/mini_city_vert.spv.h"
#include "shaders/mini_fading_frag.spv.h"
#include "shaders/mini_fading_vert.spv.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <iterator>

namespace mini {
namespace {

constexpr uint32_t kMaxInstances = 262144;
constexpr uint32_t kMaxBuckets = 1024; // as many as a grammar can have: the next one may have more than the first

/// What a terminal is made of, by its name; names that are not known get a colour each.
glm::vec4 materialOf(const std::string& name, uint32_t index) {
  struct Material {
    const char* part;
    glm::vec4 colour;
  };
  static const std::array<Material, 12> kMaterials = {{
      {"Glass", {0.05f, 0.10f, 0.15f, 0.0f}},
      {"Chimney", {0.24f, 0.11f, 0.08f, 0.3f}},
      {"Frame", {0.55f, 0.54f, 0.52f, 0.2f}},
      {"Sill", {0.44f, 0.42f, 0.38f, 0.3f}},
      {"Ledge", {0.46f, 0.43f, 0.38f, 0.5f}},
      {"Cornice", {0.42f, 0.39f, 0.34f, 0.5f}},
      {"Door", {0.22f, 0.11f, 0.06f, 0.2f}},
      {"Balcony", {0.34f, 0.34f, 0.34f, 0.2f}},
      {"Rail", {0.05f, 0.055f, 0.06f, 0.0f}},
      {"Roof", {0.30f, 0.085f, 0.045f, 0.4f}},
      {"Shop", {0.06f, 0.17f, 0.16f, 0.4f}},
      {"Wall", {0.46f, 0.37f, 0.27f, 1.0f}},
  }};
  for (const Material& material : kMaterials)
    if (name.find(material.part) != std::string::npos) return material.colour;
  const float hue = std::fmod(static_cast<float>(index) * 0.618034f, 1.0f) * 6.2831853f;
  return {0.45f + 0.2f * std::cos(hue), 0.45f + 0.2f * std::cos(hue + 2.1f), 0.45f + 0.2f * std::cos(hue + 4.2f), 0.3f};
}

void GPGP_CALL onCompileMessage(void*, const GpgpCompileMessage* message) {
  if (message->line) std::fprintf(stderr, "%s:%u:%u: ", message->file, message->line, message->column);
  std::fprintf(stderr, "%s\n", message->text);
}

} // namespace

City::City(Device& device, Gpgp& gpgp, const Forward& forward, const CityOptions& options) : gpgp_(gpgp) {
  const std::string& grammarFile = options.grammarFile;
  budget_.instances = options.budget;
  if (options.budget) gpgp.check(gpgpAdaptDetail(&budget_, nullptr, 0, &detail_), "gpgpAdaptDetail");
  // A shipped game would load a baked grammar; the sample compiles the text.
  const std::vector<char> text = readFile(grammarFile);
  auto source = gpgp::init<GpgpGrammarSource>();
  source.name = grammarFile.c_str();
  source.text = text.data();
  source.size = text.size();
  source.messageFn = onCompileMessage;
  const gpgp::Blob baked = gpgp.take(gpgp::compileGrammar(source), "gpgpCompileGrammar");
  auto grammarInfo = gpgp::init<GpgpGrammarCreateInfo>();
  grammarInfo.label = "city grammar";
  grammarInfo.data = baked.data();
  grammarInfo.size = baked.size();
  grammar_ = gpgp.take(gpgp::Grammar::create(gpgp.context, grammarInfo), "gpgpCreateGrammar");
  auto spawnerInfo = gpgp::init<GpgpSpawnerCreateInfo>();
  spawnerInfo.base = gpgp.recorder("city spawner");
  spawnerInfo.flags = GPGP_SPAWNER_ORDERED; // where faces coincide, the picture is the same in every run
  // Budgets as the reports say they are needed, and twice as much: the defaults are for ten times this city.
  spawnerInfo.maxShapes = 16384;
  spawnerInfo.maxTerminals = kMaxInstances;
  spawner_ = gpgp.take(gpgp::Spawner::create(gpgp.context, spawnerInfo), "gpgpCreateSpawner");
  gpgp.shareScratch(spawner_);
  gpgp.check(spawner_.prewarm(), "gpgpPrewarm");
  makeMaterials();
  if (options.watch) {
    GrammarWatchOptions watch;
    watch.files = {{grammarFile, {text.begin(), text.end()}}};
    watch.kernels = true;
    watch.say = [](const std::string& message) { std::fprintf(stderr, "%s\n", message.c_str()); };
    watch_ = std::make_unique<GrammarWatch>(gpgp.context, spawner_, watch);
  }

  // The engine's buffers. gpgp fills instances, and in each draw the count and the first instance; the rest is set
  // here.
  const std::vector<GpgpAxiom> axioms = levelAxioms();
  axiomCount_ = static_cast<uint32_t>(axioms.size());
  axioms_ = makeBuffer(device, axioms, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  instances_ = Buffer(device, VkDeviceSize{kMaxInstances} * sizeof(GpgpInstance),
                      VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
  VkDrawIndexedIndirectCommand box{};
  box.indexCount = 36;
  draws_ = makeBuffer(device, std::vector(kMaxBuckets, box),
                      VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
  std::vector<glm::vec3> corners;
  for (int i = 0; i < 8; ++i)
    corners.emplace_back(static_cast<float>(i & 1) - 0.5f, static_cast<float>(i >> 1 & 1) - 0.5f,
                         static_cast<float>(i >> 2 & 1) - 0.5f);
  corners_ = makeBuffer(device, corners, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
  const std::vector<uint16_t> indices = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                         2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  indices_ = makeBuffer(device, indices, VK_BUFFER_USAGE_INDEX_BUFFER_BIT);

  PipelineInfo info;
  info.vertex.assign(std::begin(mini_city_vert), std::end(mini_city_vert));
  info.fragment.assign(std::begin(mini_city_frag), std::end(mini_city_frag));
  info.bindings = {{0, sizeof(glm::vec3), VK_VERTEX_INPUT_RATE_VERTEX},
                   {1, sizeof(GpgpInstance), VK_VERTEX_INPUT_RATE_INSTANCE}};
  info.attributes = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0},
                     {1, 1, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(GpgpInstance, transform)},
                     {2, 1, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(GpgpInstance, transform) + 16},
                     {3, 1, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(GpgpInstance, transform) + 32},
                     {4, 1, VK_FORMAT_R32G32B32_UINT, offsetof(GpgpInstance, bucket)}};
  if (options.budget) { // an instance's attribute is the share of its pixels that it keeps
    info.vertex.assign(std::begin(mini_fading_vert), std::end(mini_fading_vert));
    info.fragment.assign(std::begin(mini_fading_frag), std::end(mini_fading_frag));
    info.attributes.push_back({5, 1, VK_FORMAT_R32_UINT, offsetof(GpgpInstance, seed)});
    info.attributes.push_back({6, 1, VK_FORMAT_R32_SFLOAT, offsetof(GpgpInstance, attribute)});
  }
  info.pushBytes = 96;
  pipeline_ = Pipeline(device, forward.renderPass(), Forward::kSamples, info);
}

void City::makeMaterials() {
  uint32_t count = 0;
  gpgp_.check(grammar_.terminals(count, nullptr), "gpgpGetGrammarTerminals");
  std::vector<GpgpGrammarTerminal> terminals(count);
  gpgp_.check(grammar_.terminals(count, terminals.data()), "gpgpGetGrammarTerminals");
  uint32_t buckets = 0;
  for (const GpgpGrammarTerminal& terminal : terminals) buckets = std::max(buckets, terminal.bucket + 1);
  materials_.assign(buckets, glm::vec4(0.5f));
  for (auto terminal = terminals.rbegin(); terminal != terminals.rend();
       ++terminal) // the first name of a bucket counts
    materials_[terminal->bucket] = materialOf(terminal->name, terminal->bucket);
}

void City::use(gpgp::Grammar grammar) {
  grammar_ = std::move(grammar); // the old one is destroyed here, and freed when its frames are over
  makeMaterials();
}

void City::prepare(VkCommandBuffer commands, const GpgpFrame& frame, const Camera& camera, uint32_t height) {
  if (auto next = watch_ ? watch_->update() : std::nullopt) use(std::move(*next));
  auto info = gpgp::init<GpgpSpawnInfo>();
  info.base.tag = frame.current;
  info.base.scratch = gpgp_.scratch();
  info.grammar = grammar_;
  info.axioms = axioms_.forGpgp(kNoAccess, kNoAccess);
  info.axiomCount = axiomCount_;
  info.instances = instances_.forGpgp(kVertexInput, kVertexInput);
  info.draws = draws_.forGpgp(kIndirect, kIndirect);
  GpgpSpawnCamera seen{};
  if (budget()) {
    for (int i = 0; i < 16; ++i) seen.viewProjection[i] = camera.viewProjection[i / 4][i % 4];
    for (int i = 0; i < 3; ++i) seen.position[i] = camera.eye[i];
    seen.height = height;
    seen.detail = detail_.detail;
    info.camera = &seen;
  }
  if (gpgp_.check(spawner_.recordPrepare(commands, frame, info), "gpgpRecordPrepareSpawn") == GPGP_SUCCESS)
    prepared_ = true;
}

void City::draw(VkCommandBuffer commands, const Camera& camera) {
  if (!prepared_) return;
  struct {
    glm::mat4 viewProjection;
    glm::vec4 eye, colour;
  } push{camera.viewProjection, camera.eyeAndLight(), glm::vec4(1)};
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_.handle);
  const VkBuffer buffers[] = {corners_.handle, instances_.handle};
  const VkDeviceSize offsets[] = {0, 0};
  vkCmdBindVertexBuffers(commands, 0, 2, buffers, offsets);
  vkCmdBindIndexBuffer(commands, indices_.handle, 0, VK_INDEX_TYPE_UINT16);
  for (uint32_t bucket = 0; bucket < materials_.size(); ++bucket) {
    push.colour = materials_[bucket];
    vkCmdPushConstants(commands, pipeline_.layout, Pipeline::kStages, 0, sizeof push, &push);
    vkCmdDrawIndexedIndirect(commands, draws_.handle, bucket * sizeof(VkDrawIndexedIndirectCommand), 1,
                             sizeof(VkDrawIndexedIndirectCommand));
  }
}

void City::collect() {
  for (auto next = spawner_.report(); next; next = spawner_.report()) {
    report_ = *next;
    ++reports_;
    if (!budget()) continue;
    exceeded_ += report_.terminals > budget();
    gpgp_.check(gpgpAdaptDetail(&budget_, &report_, 0, &detail_), "gpgpAdaptDetail");
  }
}

} // namespace mini
