// A recorder with one shader and three passes, for tests of the machinery that all services share.
// Also the shortest example of how a service uses core/: describe resources and passes, init, fill a Record.
#pragma once
#include "core/recorder.h"
#include "core/resident.h"
#include "shaders/toy.spv.h"

namespace gpgp::test {

class ToyAsset final : public core::Resident {
public:
  static core::Unique<ToyAsset> create(core::Context& context, std::span<const uint32_t> words) {
    auto asset = core::makeUnique<ToyAsset>(context.host(), context);
    std::pmr::vector<std::byte> bytes(words.size_bytes(), &context.host());
    std::memcpy(bytes.data(), words.data(), bytes.size());
    if (auto ok = asset->makeResident(GPGP_SERVICE_CORE, std::move(bytes)); !ok) return nullptr;
    const std::lock_guard lock(context.objects);
    asset->attach(); // tests that give it no handle upload it as well
    return asset;
  }
  explicit ToyAsset(core::Context& owner) : Resident(owner, core::Kind::grammar, "toy asset") {}
};

class ToyRecorder final : public core::Recorder {
public:
  struct Constants {
    uint32_t count, factor;
  };
  struct Report {
    uint32_t sum, passes, unused[2];
  };
  static core::Result<core::Unique<ToyRecorder>> create(core::Context& context, const GpgpRecorderCreateInfo& info) {
    auto recorder = core::makeUnique<ToyRecorder>(context.host(), context, info);
    core::PassList list(&context.host());
    // The order of resources is the order of bindings in the shader.
    const auto input = list.add({"input", core::ResourceKind::buffer});
    const auto output = list.add({"output", core::ResourceKind::buffer});
    const auto counters = list.add({"counters", core::ResourceKind::scratch, sizeof(Report)});
    const auto arguments = list.add({"arguments", core::ResourceKind::scratch, sizeof(VkDispatchIndirectCommand)});
    const auto constants = list.add({"constants", core::ResourceKind::constants, sizeof(Constants)});
    const auto shader = list.add(core::ShaderDesc{"toy", toy});
    using enum core::UseKind;
    list.fill("clear counters", counters, 0);
    // A pass names all that its shader could touch, taken or not: validation looks at the shader, not at the branch.
    const std::initializer_list<core::Use> uses = {
        {input, read}, {output, readWrite}, {counters, readWrite}, {arguments, write}, {constants, read}};
    list.dispatch("scale", shader, uses, 0, {0});
    list.dispatchIndirect("sum", shader, uses, arguments, 0, {1});
    list.report = counters;
    list.reportBytes = sizeof(Report);
    if (auto ok = recorder->init(std::move(list)); !ok) return ok.error();
    return recorder;
  }
  ToyRecorder(core::Context& owner, const GpgpRecorderCreateInfo& info)
      : Recorder(owner, core::Kind::spawner, info, GPGP_SERVICE_CORE) {}

  core::Result<void> run(VkCommandBuffer cmd, const GpgpRecordingInfo& base, const ToyAsset& input,
                         const GpgpBuffer& output, uint32_t count, uint32_t factor) {
    const Constants constants{count, factor};
    core::Record r;
    r.commandBuffer = cmd;
    r.info = &base;
    r.bindings[0].ownBuffer = input.buffer();
    r.bindings[0].ownSize = input.size();
    r.bindings[1].engineBuffer = &output;
    r.groups[0] = {(count + 63) / 64, 1, 1};
    r.constants[0] = std::as_bytes(std::span(&constants, 1));
    if (auto ok = check(r); !ok) return ok;
    return record(r);
  }
};

} // namespace gpgp::test
