// A context on a headless device; every subcommand's work is one recording, repeated and measured.
#include "cli/shared/session.h"

#include "cli/shared/command.h"
#include "cli/shared/median.h"
#include "cli/shared/processors.h"
#include "cli/shared/progress.h"

#include <algorithm>
#include <cstdio>
#include <optional>

namespace gpgp::cli {
namespace {

/// Destroys the query pool on every way out.
struct QueryPool {
  host::HeadlessDevice& device;
  VkQueryPool pool = VK_NULL_HANDLE;
  QueryPool(host::HeadlessDevice& d, uint32_t count) : device(d) {
    VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
    info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    info.queryCount = count;
    host::check(d.vk().vkCreateQueryPool(d.device(), &info, nullptr, &pool), "vkCreateQueryPool");
  }
  QueryPool(const QueryPool&) = delete;
  QueryPool& operator=(const QueryPool&) = delete;
  ~QueryPool() { device.vk().vkDestroyQueryPool(device.device(), pool, nullptr); }
};

} // namespace

void GpuTimes::add(const GpuTimes& other) {
  totals.resize(std::max(totals.size(), other.totals.size()));
  for (size_t i = 0; i < other.totals.size(); ++i) totals[i] += other.totals[i];
  passes.insert(passes.end(), other.passes.begin(), other.passes.end());
}

double GpuTimes::median() const { return medianOf(totals); }
double GpuTimes::least() const { return totals.empty() ? 0.0 : *std::min_element(totals.begin(), totals.end()); }

Json GpuTimes::json() const {
  Json list = Json::array();
  for (const auto& [name, time] : passes) list.push_back({{"name", name}, {"milliseconds", time}});
  return {{"repeats", totals.size()}, {"median", median()}, {"least", least()}, {"passes", list}};
}

std::string milliseconds(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f ms", value);
  return text;
}

std::string statusName(GpgpResult status) { return gpgpResultString(status); }

void Session::onMessage(void* userData, const GpgpMessage* message) {
  auto* session = static_cast<Session*>(userData);
  const std::lock_guard lock(session->messages_);
  if (message->severity == GPGP_SEVERITY_ERROR) {
    session->lastError_ = message->text; // thrown, and so printed, by check
    return;
  }
  std::fprintf(stderr, "gpgp: %s: %s%s%s\n", message->severity == GPGP_SEVERITY_WARNING ? "warning" : "note",
               message->label, message->label[0] ? ": " : "", message->text);
}

Session::Session(const CommonOptions& options)
    : device_(host::DeviceOptions{.device = options.device, .validation = options.validate}), frames_(device_, 2),
      busy_(device_), dumpPass_(options.dumpPass), dumpFolder_(options.dumpFolder), json_(options.json) {
  GpgpContextCreateInfo info = device_.contextCreateInfo();
  info.label = "gpgp command";
  info.messageFn = onMessage;
  info.messageUserData = this;
  GpgpJobSystem jobs{}; // drivers take seconds for large pipelines
  jobs.parallelFor = [](void*, uint32_t count, GpgpJobFn job, void* argument) {
    onAllProcessors(count, [&](size_t i) { job(argument, static_cast<uint32_t>(i)); });
  };
  info.jobSystem = &jobs;
  context_ = take(Context::create(info), "gpgpCreateContext");
}

Session::~Session() { device_.vk().vkDeviceWaitIdle(device_.device()); }

GpgpResult Session::check(GpgpResult result, const char* what) {
  if (result >= 0) return result;
  const std::string text = lastError_.empty() ? std::string(what) + ": " + gpgpResultString(result) : lastError_;
  lastError_.clear();
  throw Failure(text);
}

GpgpRecorderCreateInfo Session::recorderInfo(const char* label) const {
  GpgpRecorderCreateInfo info{};
  info.label = label;
  info.queueFamily = device_.graphics().family;
  info.queueFlags = device_.graphics().flags;
  return info;
}

void Session::upload() {
  for (VkDeviceSize pending = 1; pending > 0;) {
    VkCommandBuffer commands = frames_.begin();
    check(gpgpAdvance(context_, &frames_.frame()), "gpgpAdvance");
    const VkDeviceSize before = pending;
    check(gpgpRecordUpload(context_, commands, &frames_.frame(), 0, &pending), "gpgpRecordUpload");
    frames_.submit();
    frames_.waitAll();
    if (pending > 0 && pending == before) throw Failure("the upload makes no progress");
  }
}

GpuTimes Session::run(GpgpRecorder recorder, const char* label, uint32_t repeat, const Record& record,
                      const std::function<void()>& collectReports) {
  uint32_t passCount = 0;
  check(gpgpGetPasses(recorder, &passCount, nullptr), "gpgpGetPasses");
  std::vector<const char*> names(passCount);
  check(gpgpGetPasses(recorder, &passCount, names.data()), "gpgpGetPasses");
  const bool timed = device_.properties().limits.timestampComputeAndGraphics == VK_TRUE;
  const uint32_t whole = passCount + 1, queryCount = passCount + 3; // two around the recording behind those of passes
  const QueryPool queries(device_, queryCount);
  const auto writeTimestamp = [&](VkCommandBuffer commands, uint32_t query) {
    if (timed) device_.vk().vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, queries.pool, query);
  };
  const double period = static_cast<double>(device_.properties().limits.timestampPeriod) * 1e-6;

  GpuTimes times;
  core::Recorder& inside = PassDump::recorderOf(recorder);
  std::optional<PassDump> dump;
  if (!dumpPass_.empty()) dump.emplace(device_, inside, dumpPass_);
  std::vector<bool> ran(passCount);
  std::vector<std::vector<double>> perPass(passCount);
  if (repeat > 1) busy_.warmUp();
  std::optional<Progress> progress; // of single recordings those know that make many of them
  if (repeat > 1) progress.emplace(label, repeat);
  const uint32_t each = repeat > 1 && timed ? 2 : 1; // recordings: one by pass, one as a whole; a single one is both
  for (uint32_t i = 0; i < each * repeat; ++i) {
    const bool byPass = i % 2 == 0 || each == 1, asWhole = i % 2 == 1 || each == 1;
    VkCommandBuffer commands = frames_.begin();
    check(gpgpAdvance(context_, &frames_.frame()), "gpgpAdvance");
    collectReports();
    if (repeat > 1) busy_.record(commands);
    GpgpRecordingInfo base{};
    base.tag = i / each;
    if (timed) {
      device_.vk().vkCmdResetQueryPool(commands, queries.pool, 0, queryCount);
      if (byPass) base.timestamps = {queries.pool, 0, whole};
    }
    host::fullBarrier(device_, commands); // repeats write the same buffers
    writeTimestamp(commands, whole);
    const GpgpResult result = check(record(commands, frames_.frame(), base), label);
    if (result != GPGP_SUCCESS) throw Failure(std::string(label) + ": " + gpgpResultString(result));
    for (uint32_t p = 0; p < passCount; ++p) ran[p] = ran[p] || inside.ran(p);
    writeTimestamp(commands, whole + 1);
    frames_.submit();
    frames_.waitAll();
    const auto read = [&](uint32_t first, uint32_t count) {
      std::vector<uint64_t> timestamps(count);
      host::check(device_.vk().vkGetQueryPoolResults(
                      device_.device(), queries.pool, first, count, timestamps.size() * sizeof(uint64_t),
                      timestamps.data(), sizeof(uint64_t), VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
                  "vkGetQueryPoolResults");
      return timestamps;
    };
    const auto timestamps = timed && byPass ? read(0, whole) : std::vector<uint64_t>();
    for (size_t p = 0; p + 1 < timestamps.size(); ++p)
      perPass[p].push_back(static_cast<double>(timestamps[p + 1] - timestamps[p]) * period);
    const auto ends = timed && asWhole ? read(whole, 2) : std::vector<uint64_t>();
    if (!ends.empty()) times.totals.push_back(static_cast<double>(ends[1] - ends[0]) * period);
    if (asWhole && progress) progress->advance();
  }
  // Everything is finished: one more advance makes the last report ready.
  frames_.begin();
  check(gpgpAdvance(context_, &frames_.frame()), "gpgpAdvance");
  frames_.submit();
  frames_.waitAll();
  collectReports();
  for (uint32_t p = 0; p < passCount; ++p)
    if (ran[p]) times.passes.emplace_back(names[p], medianOf(perPass[p]));
  if (dump) {
    const std::string written = dump->write(dumpFolder_);
    if (!json_) std::fprintf(stderr, "%s", written.c_str());
  }
  return times;
}

void checkValidation(host::HeadlessDevice& device) {
  const std::vector<std::string> messages = device.takeValidationMessages();
  for (const std::string& message : messages) std::fprintf(stderr, "validation: %s\n", message.c_str());
  if (!messages.empty())
    throw Failure("the validation layer had " + std::to_string(messages.size()) + " messages (above)");
}

} // namespace gpgp::cli
