#include "cli/info/pipelines.h"

#include <gpgp/gpgp.hpp>

#include <algorithm>
#include <iomanip>
#include <sstream>
#include <vector>

namespace gpgp::cli {
namespace {

/// Keeps the last error of a context.
struct LastError {
  std::string text;
  static void GPGP_CALL keep(void* self, const GpgpMessage* message) {
    if (message->severity == GPGP_SEVERITY_ERROR) static_cast<LastError*>(self)->text = message->text;
  }
  void check(GpgpResult result, const char* what) const {
    if (result < 0) throw Failure(text.empty() ? std::string(what) + ": " + gpgpResultString(result) : text);
  }
};

class Lister {
public:
  explicit Lister(host::HeadlessDevice& device) : device_(device) {
    GpgpContextCreateInfo info = device.contextCreateInfo();
    info.label = "gpgp info";
    info.messageFn = LastError::keep;
    info.messageUserData = &error_;
    auto context = Context::create(info);
    error_.check(context.code(), "gpgpCreateContext");
    context_ = std::move(*context);
  }

  /// Makes a recorder of the info that `set` completes, and lists its pipelines.
  template <class RecorderType, class Info, class Set> void list(const char* name, Info info, Set&& set) {
    info.base.queueFamily = device_.graphics().family;
    info.base.queueFlags = device_.graphics().flags;
    set(info);
    auto recorder = RecorderType::create(context_, info);
    error_.check(recorder.code(), name);
    prewarm(*recorder);
    uint32_t count = 0;
    error_.check(recorder->pipelines(count, nullptr), "gpgpGetPipelines");
    std::vector<GpgpPipelineInfo> pipelines(count);
    error_.check(recorder->pipelines(count, pipelines.data()), "gpgpGetPipelines");
    add(name, pipelines);
  }
  Outcome finish() {
    outcome_.json = {{"device", device_.name()}, {"recorders", std::move(recorders_)}};
    outcome_.text = text_.str();
    return std::move(outcome_);
  }

private:
  void prewarm(Recorder& recorder) { error_.check(recorder.prewarm(), "gpgpPrewarm"); }
  /// Those that draw: into one target.
  void prewarmTarget(Recorder& recorder) {
    GpgpTargetInfo target = GPGP_TARGET_INFO_INIT;
    target.colorFormat = VK_FORMAT_R8G8B8A8_UNORM;
    GpgpPrewarmInfo info = GPGP_PREWARM_INFO_INIT;
    if (device_.features() & GPGP_FEATURE_DYNAMIC_RENDERING) {
      info.targets = &target;
      info.targetCount = 1;
    }
    error_.check(recorder.prewarm(info), "gpgpPrewarm");
  }
  void prewarm(Canvas& recorder) { prewarmTarget(recorder); }
  void prewarm(PatchRecorder& recorder) { prewarmTarget(recorder); }

  void add(const char* name, std::vector<GpgpPipelineInfo>& pipelines) {
    std::stable_sort(pipelines.begin(), pipelines.end(),
                     [](const auto& a, const auto& b) { return a.milliseconds > b.milliseconds; });
    double milliseconds = 0;
    uint64_t bytes = 0;
    Json list = Json::array();
    for (const GpgpPipelineInfo& pipeline : pipelines) {
      milliseconds += static_cast<double>(pipeline.milliseconds);
      bytes += pipeline.codeBytes;
      list.push_back({{"name", pipeline.name}, {"code_bytes", pipeline.codeBytes}, {"ms", pipeline.milliseconds}});
    }
    recorders_.push_back({{"name", name}, {"ms", milliseconds}, {"code_bytes", bytes}, {"pipelines", std::move(list)}});
    text_ << (recorders_.size() > 1 ? "\n" : "") << name << ": " << pipelines.size() << " pipelines, "
          << (bytes + 512) / 1024 << " KiB of SPIR-V, " << std::fixed << std::setprecision(1) << milliseconds
          << " ms\n";
    size_t shown = 0;
    for (; shown < pipelines.size(); ++shown) {
      const GpgpPipelineInfo& pipeline = pipelines[shown];
      if (shown >= 3 && static_cast<double>(pipeline.milliseconds) < 0.05 * milliseconds) break;
      text_ << std::setw(10) << pipeline.milliseconds << " ms " << std::setw(5) << (pipeline.codeBytes + 512) / 1024
            << " KiB  " << pipeline.name << '\n';
    }
    if (shown < pipelines.size()) {
      double others = 0;
      for (size_t i = shown; i < pipelines.size(); ++i) others += static_cast<double>(pipelines[i].milliseconds);
      text_ << std::setw(10) << others << " ms            " << pipelines.size() - shown << " others\n";
    }
  }

  host::HeadlessDevice& device_;
  LastError error_;
  Context context_;
  Json recorders_ = Json::array();
  std::ostringstream text_;
  Outcome outcome_;
};

} // namespace

Outcome listPipelines(host::HeadlessDevice& device) {
  Lister lister(device);
#ifdef GPGP_WITH_SPAWN
  const auto spawner = [&](const char* name, auto&& set) {
    lister.list<Spawner>(name, init<GpgpSpawnerCreateInfo>(), [&](GpgpSpawnerCreateInfo& info) {
      info.maxShapes = info.maxTerminals = 1024;
      set(info);
    });
  };
  spawner("spawner", [](auto&) {});
  spawner("spawner with colliders", [](auto& info) { info.maxColliders = 1024; });
  lister.list<LsystemRecorder>("L-system recorder", init<GpgpLsystemRecorderCreateInfo>(),
                               [](auto& info) { info.flags = GPGP_LSYSTEM_RECORDER_CONTEXTS; });
#endif
#ifdef GPGP_WITH_VECTOR
  const auto canvas = [&](const char* name, auto&& set) {
    lister.list<Canvas>(name, init<GpgpCanvasCreateInfo>(), [&](GpgpCanvasCreateInfo& info) {
      info.maxWidth = info.maxHeight = 256;
      set(info);
    });
  };
  canvas("canvas for RGBA8 images", [](auto& info) { info.targets = GPGP_CANVAS_TARGET_RGBA8; });
  canvas("canvas", [](auto&) {});
  canvas("canvas with layers", [](auto& info) { info.maxLayerPixels = 1 << 16; });
  canvas("canvas by patches", [](auto& info) { info.method = GPGP_CANVAS_PATCHES; });
  lister.list<PatchRecorder>("patch recorder", init<GpgpPatchRecorderCreateInfo>(), [](auto&) {});
#endif
#ifdef GPGP_WITH_VISIBILITY
  const auto visibility = [&](const char* name, uint32_t methods) {
    lister.list<VisibilityRecorder>(name, init<GpgpVisibilityRecorderCreateInfo>(),
                                    [&](GpgpVisibilityRecorderCreateInfo& info) {
                                      info.maxWidth = info.maxHeight = 256;
                                      info.maxDraws = 256;
                                      info.maxTriangles = 1 << 16;
                                      info.methods = methods;
                                    });
  };
  visibility("visibility recorder, standard", GPGP_SAMPLING_STANDARD_BIT);
  visibility("visibility recorder, conservative", GPGP_SAMPLING_CONSERVATIVE_BIT);
  visibility("visibility recorder, exact", GPGP_SAMPLING_EXACT_BIT);
  lister.list<AtlasRecorder>("atlas recorder", init<GpgpAtlasRecorderCreateInfo>(),
                             [](auto& info) { info.maxTriangles = 1 << 16; });
#endif
  return lister.finish();
}

} // namespace gpgp::cli
