#include "cli/spawn/lsystem.h"

#include "cli/shared/command.h"
#include "cli/shared/painter.h"
#include "cli/shared/session.h"
#include "cli/spawn/grammar_source.h"
#include "cli/spawn/lsystem_mesh.h"
#include "cli/spawn/spawned_gltf.h"
#include "host/files.h"
#include "spawn/lsystem/compile.h"
#include "spawn/lsystem/layout.h"
#include "spawn/lsystem/reference.h"
#include "spawn/lsystem/scanner.h"

#include <gpgp/lsystem.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <set>
#include <sstream>

namespace gpgp::cli {
namespace {

using namespace shader;
using spawn::lsystem::Table;
constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
constexpr GpgpAccess kRead{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT,
                           VK_IMAGE_LAYOUT_UNDEFINED};
/// Passes of rewriting; all others are the turtle's.
const std::set<std::string> kRewriting = {"clear", "begin",  "depths", "place depths", "leaves",
                                          "nodes", "choose", "write",  "place steps"};

/// What a file for a plant modeller leaves to the .v file beside it: the angle, the width and the step.
std::string viewOf(const std::string& file, const std::string& text) {
  std::filesystem::path view(file);
  view.replace_extension(".v");
  std::error_code ignored;
  if (!spawn::lsystem::isOfPlantModeller(text) || !std::filesystem::is_regular_file(view, ignored)) return {};
  std::istringstream lines(host::readText(view.string()));
  std::string line, settings;
  while (std::getline(lines, line)) {
    const size_t colon = line.find(':');
    if (colon == std::string::npos) continue;
    const std::string name = line.substr(0, colon);
    const float value = std::strtof(line.c_str() + colon + 1, nullptr);
    if (!(value > 0 && value < 1e6f)) continue;
    if (name == "angle increment") settings += "\nangle: " + std::to_string(value);
    if (name == "angle factor") settings += "\nangle: " + std::to_string(360.0f / value);
  }
  return settings;
}

std::vector<uint32_t> compile(const LsystemOptions& options) {
  std::string text = host::readText(options.file);
  if (!spawn::lsystem::isOfLpfg(text)) text += viewOf(options.file, text);
  std::vector<spawn::lsystem::Override> overrides;
  for (const std::string& s : options.set) {
    const size_t equals = s.find('=');
    char* end = nullptr;
    const float value = equals == std::string::npos ? 0 : std::strtof(s.c_str() + equals + 1, &end);
    if (equals == 0 || equals == std::string::npos || equals + 1 == s.size() || *end != 0 || !std::isfinite(value))
      throw Usage("--set takes NAME=VALUE with a number, for example --set iterations=5; got \"" + s + "\"");
    overrides.push_back({std::string_view(s).substr(0, equals), value});
  }
  spawn::Diagnostics diagnostics;
  const auto read = [&](const std::string& path, std::string& into) {
    const std::filesystem::path file = std::filesystem::path(options.file).parent_path() / path;
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(file, ignored)) return false;
    into = host::readText(file.string());
    return true;
  };
  auto words = spawn::lsystem::compile(text, overrides, diagnostics, read, options.start);
  report(diagnostics, options.file);
  if (!words) throw Failure(options.file + ": no L-system");
  return std::move(*words);
}

/// The names of terminals, as writeGlb reads them.
spawn::Graph namesOf(const Table& table) {
  spawn::Graph graph(std::pmr::new_delete_resource());
  for (uint32_t t = 0; t < table.count(kLsysSectionTerminals); ++t) {
    const char* name = table.name(table.terminal(t)[kTerminalNameAt]);
    spawn::Terminal terminal{};
    terminal.name = static_cast<uint32_t>(graph.names.size());
    terminal.kind = table.terminal(t)[kTerminalKind];
    terminal.index = terminal.bucket = t;
    graph.terminals.push_back(terminal);
    graph.names.insert(graph.names.end(), name, name + std::strlen(name) + 1);
  }
  return graph;
}

void paint(const LsystemOptions& options, const LsystemMesh& mesh) {
  Bounds bounds;
  const auto at = [&](size_t i) {
    const float* p = mesh.vertices[mesh.indices[i]].position;
    return glm::vec3(p[0], p[1], p[2]);
  };
  for (size_t i = 0; i < mesh.indices.size(); ++i) bounds.add(at(i));
  if (mesh.indices.empty()) bounds.add(glm::vec3(0));
  glm::mat4 camera = viewAll(bounds, options.yaw, options.pitch, options.imageSize.width, options.imageSize.height);
  for (int c = 0; c < 4; ++c) {
    camera[c].x *= options.zoom;
    camera[c].y *= options.zoom;
  }
  Painter painter(options.imageSize.width, options.imageSize.height);
  painter.sun(bounds);
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
    painter.shadow(std::array<glm::vec3, 3>{at(i), at(i + 1), at(i + 2)});
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const float colour = std::max(mesh.colours[i / 3], 0.0f);
    painter.triangle(camera, {{at(i), at(i + 1), at(i + 2)},
                              paletteColour(mesh.vertices[mesh.indices[i]].terminal + static_cast<uint32_t>(colour))});
  }
  host::writePng(options.image, painter.picture());
}

/// What differs between the device and the CPU reference; nothing where they agree. Transforms may differ by rounding.
std::string difference(const spawn::lsystem::Drawn& drawn, std::span<const GpgpInstance> instances,
                       std::span<const GpgpLsystemCorner> corners) {
  float extent = 1e-6f, worst = 0;
  for (size_t i = 0; i < instances.size(); ++i) {
    GpgpInstance a = drawn.instances[i], b = instances[i];
    for (int c = 0; c < 12; ++c) {
      extent = std::max(extent, std::abs(a.transform[c]));
      worst = std::max(worst, std::abs(a.transform[c] - b.transform[c]));
    }
    for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(a.size[c] - b.size[c]));
    worst = std::max(worst, std::abs(a.attribute - b.attribute));
    std::memset(a.transform, 0, sizeof a.transform);
    std::memset(b.transform, 0, sizeof b.transform);
    std::memcpy(a.size, b.size, sizeof a.size);
    a.attribute = b.attribute;
    if (std::memcmp(&a, &b, sizeof a) != 0) return "instance " + std::to_string(i);
  }
  for (size_t i = 0; i < corners.size(); ++i)
    for (size_t c = 0; c < 3; ++c) {
      extent = std::max(extent, std::abs(drawn.corners[i][c]));
      worst = std::max(worst, std::abs(drawn.corners[i][c] - corners[i].position[c]));
    }
  if (!(worst <= 1e-3f * extent)) return "a transform, by " + std::to_string(worst);
  return {};
}

} // namespace

bool isLsystem(const std::string& file) {
  const auto ending = std::filesystem::path(file).extension();
  return ending == ".lsys" || ending == ".l" || ending == ".ls" || ending == ".lpy";
}

Outcome spawnLsystem(const LsystemOptions& options, const CommonOptions& common) {
  const std::vector<uint32_t> words = compile(options);
  const auto loaded = Table::load(std::as_bytes(std::span(words)), std::pmr::new_delete_resource());
  if (!loaded) throw Failure(options.file + ": " + loaded.error().text);
  const Table& table = *loaded;
  const uint32_t iterations = table.head(kLsysHeadIterations), steps = table.stepCount(iterations);
  if (steps > kLsysMostSteps)
    throw Failure(options.file + ": " + std::to_string(iterations) + " iterations take " + std::to_string(steps) +
                  " steps; a recording takes at most " + std::to_string(kLsysMostSteps));
  Session session(common);
  const uint64_t range = session.device().properties().limits.maxStorageBufferRange;
  const uint32_t most = static_cast<uint32_t>(std::min<uint64_t>(range / 64, kLsysMostModules));
  if (options.maxModules > most)
    throw Usage("--max-modules is too large for this device: at most " + std::to_string(most));

  spawn::lsystem::Limits limits{options.maxModules ? options.maxModules : most,
                                static_cast<uint32_t>(std::min<uint64_t>(range / 8, 1u << 26))};
  const auto begun = std::chrono::steady_clock::now();
  const auto derived = spawn::lsystem::derive(table, options.axioms, iterations, limits);
  const auto drawn = spawn::lsystem::draw(table, derived.string, options.axioms);
  const double cpuMilliseconds =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begun).count();

  GpgpLsystemRecorderCreateInfo info = GPGP_LSYSTEM_RECORDER_CREATE_INFO_INIT;
  info.base = session.recorderInfo("L-system recorder");
  if (table.has(kLsysContexts) || table.has(kLsysCuts)) info.flags = GPGP_LSYSTEM_RECORDER_CONTEXTS;
  info.maxModules = options.maxModules
                        ? options.maxModules
                        : static_cast<uint32_t>(std::clamp<uint64_t>(derived.modulesNeeded, 256, limits.modules));
  info.maxParameters = static_cast<uint32_t>(std::clamp<uint64_t>(derived.parametersNeeded, 256, limits.parameters));
  info.maxSteps = std::max(steps, 1u);
  info.maxRounds =
      static_cast<uint32_t>(std::min(drawn.depth + derived.string.modules.size() / kLsysWalkLength + 2, size_t{1024}));
  LsystemRecorder recorder =
      session.take(LsystemRecorder::create(session.context(), info), "gpgpCreateLsystemRecorder");
  session.check(recorder.prewarm(), "gpgpPrewarm");
  GpgpLsystemCreateInfo assetInfo = GPGP_LSYSTEM_CREATE_INFO_INIT;
  assetInfo.label = options.file.c_str();
  assetInfo.data = words.data();
  assetInfo.size = words.size() * 4;
  const Lsystem lsystem = session.take(Lsystem::create(session.context(), assetInfo), "gpgpCreateLsystem");
  session.upload();

  host::HeadlessDevice& device = session.device();
  const auto buffer = [&](uint64_t elements, uint64_t size) {
    return host::Buffer(device, std::max<uint64_t>(std::min(elements, range / size), 1) * size, kStorage);
  };
  const uint64_t wanted = options.maxInstances ? options.maxInstances : drawn.instances.size();
  const host::Buffer axioms = host::makeBuffer(device, options.axioms, kStorage, "axioms");
  const host::Buffer instances = buffer(wanted, sizeof(GpgpInstance));
  const host::Buffer corners = buffer(drawn.corners.size(), sizeof(GpgpLsystemCorner));
  const auto measured =
      session.measure(recorder, "deriving", options.repeat,
                      [&](VkCommandBuffer commands, const GpgpFrame& frame, const GpgpRecordingInfo& base) {
                        GpgpLsystemInfo recording = GPGP_LSYSTEM_INFO_INIT;
                        recording.base = base;
                        recording.lsystem = lsystem.get();
                        recording.axioms = axioms.range();
                        recording.axiomCount = static_cast<uint32_t>(options.axioms.size());
                        recording.instances = instances.range({}, kRead);
                        recording.corners = corners.range({}, kRead);
                        if (iterations == 0) recording.iterations = GPGP_LSYSTEM_NO_ITERATIONS;
                        return recorder.recordPrepare(commands, frame, recording);
                      });
  const GpgpLsystemReport& report = measured.report;
  session.checkValidation();
  if (report.base.status < GPGP_SUCCESS) throw Failure(options.file + ": " + statusName(report.base.status));
  const auto written = host::download<GpgpInstance>(device, instances, report.instancesWritten);
  const auto places = host::download<GpgpLsystemCorner>(device, corners, report.cornersWritten);

  const auto hash = spawn::lsystem::hashOf(table, derived.string);
  std::string what;
  if (hash[0] != report.stringHash[0] || hash[1] != report.stringHash[1])
    what = "the string";
  else if (report.instances != drawn.instances.size() || report.corners != drawn.corners.size())
    what = "the number of instances or corners";
  else if (!report.unfinishedBranches && report.instancesWritten == report.instances)
    what = difference(drawn, written, places);
  if (!what.empty())
    throw Failure(options.file + ": the device derived something else than the CPU reference: " + what +
                  "; please report this");

  const LsystemMesh mesh = meshOf(written, places);
  if (!options.image.empty()) paint(options, mesh);
  if (!options.out.empty()) {
    const spawn::Graph names = namesOf(table);
    if (places.empty())
      writeGlb(options.out, names, {written, {}, {}}, options.instances);
    else
      writeGlb(options.out, names, {{}, mesh.vertices, mesh.indices}, GlbInstances::triangles);
  }

  double rewriting = 0, turtle = 0;
  Json passes = Json::object();
  for (const auto& [name, time] : measured.times.passes) {
    passes[name] = passes.value(name, 0.0) + time;
    (kRewriting.contains(name) ? rewriting : turtle) += time;
  }
  std::vector<uint64_t> counts(table.count(kLsysSectionTerminals)), triangles(counts.size());
  for (const GpgpInstance& instance : written) ++counts[instance.terminal];
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) ++triangles[mesh.vertices[mesh.indices[i]].terminal];

  Outcome outcome;
  std::ostringstream text;
  const uint64_t own = 3 * options.axioms.size(); // the brackets and the number of each axiom
  text << report.modules - own << " modules, " << report.instances << " instances (" << mesh.indices.size() / 3
       << " triangles) from " << options.axioms.size() << (options.axioms.size() == 1 ? " axiom" : " axioms") << " in "
       << report.steps << " steps on " << device.name() << '\n';
  Json buckets = Json::array();
  for (size_t t = 0; t < counts.size(); ++t) {
    const char* name = table.name(table.terminal(static_cast<uint32_t>(t))[kTerminalNameAt]);
    text << "  " << counts[t] << "  " << name << '\n';
    buckets.push_back({{"bucket", t}, {"name", name}, {"instances", counts[t]}, {"triangles", triangles[t]}});
  }
  text << "GPU " << milliseconds(measured.times.median()) << " (median of " << measured.times.totals.size() << ")";
  if (!measured.times.passes.empty())
    text << ", " << milliseconds(rewriting / std::max(report.steps, 1u)) << " a step, " << milliseconds(turtle)
         << " the turtle, by its passes";
  text << "; CPU reference, one thread " << milliseconds(cpuMilliseconds) << '\n';
  std::string printed;
  if (options.string) text << (printed = spawn::lsystem::print(table, derived.string)) << '\n';
  if (!options.image.empty()) text << "picture: " << options.image << '\n';
  if (!options.out.empty()) text << "triangles: " << options.out << '\n';
  outcome.text = text.str();
  std::ostringstream exceeded;
  if (report.steps < steps)
    exceeded << "budget exceeded: the string of step " << report.steps + 1 << " of " << steps << " did not fit; "
             << (report.modulesNeeded > limits.modules
                     ? (report.modulesNeeded <= most ? "--max-modules " + std::to_string(report.modulesNeeded) +
                                                           " would have held it; later ones may need more"
                                                     : "this device takes " + std::to_string(most) + " modules at most")
                     : "it has " + std::to_string(report.parametersNeeded) + " parameters, and this device takes " +
                           std::to_string(limits.parameters))
             << "; what is drawn is the string of the step before\n";
  if (report.unfinishedBranches)
    exceeded << "budget exceeded: " << report.unfinishedBranches
             << " branches were not drawn to their end; they are too long for turtles that walk\n";
  if (report.instancesWritten < report.instances)
    exceeded << "budget exceeded: " << report.instances - report.instancesWritten
             << " instances did not fit; --max-instances " << report.instances << " would have held all\n";
  outcome.failure = exceeded.str();
  if (!outcome.failure.empty()) outcome.failure.pop_back();
  char hashText[20];
  std::snprintf(hashText, sizeof hashText, "%08x%08x", report.stringHash[1], report.stringHash[0]);
  outcome.json = {{"grammar", options.file},
                  {"device", device.name()},
                  {"status", statusName(report.base.status)},
                  {"output", "instances"},
                  {"axioms", options.axioms.size()},
                  {"iterations", iterations},
                  {"steps", report.steps},
                  {"modules", report.modules - own},
                  {"modules_needed", report.modulesNeeded},
                  {"parameters", report.parameters},
                  {"terminals", report.instances},
                  {"instances", written.size()},
                  {"corners", places.size()},
                  {"triangles", mesh.indices.size() / 3},
                  {"buckets", buckets},
                  {"depth", report.depth},
                  {"unfinished_branches", report.unfinishedBranches},
                  {"budget_exceeded", report.base.status == GPGP_BUDGET_EXCEEDED},
                  {"string_hash", hashText},
                  {"bytes_written", written.size() * sizeof(GpgpInstance) + places.size() * sizeof(GpgpLsystemCorner)},
                  {"gpu_ms_median", measured.times.median()},
                  {"rewriting_ms_per_step", rewriting / std::max(report.steps, 1u)},
                  {"turtle_ms", turtle},
                  {"passes", passes},
                  {"cpu_reference_terminals", drawn.instances.size()},
                  {"cpu_reference_ms", cpuMilliseconds},
                  {"image", options.image.empty() ? Json() : Json(options.image)},
                  {"out", options.out.empty() ? Json() : Json(options.out)}};
  if (options.string) outcome.json["string"] = printed;
  return outcome;
}

} // namespace gpgp::cli
