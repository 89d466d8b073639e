// `gpgp spawn`: compiles a grammar, derives axioms and says what came out, beside the CPU evaluator.
#include "cli/axioms.h"
#include "cli/grammar_source.h"
#include "cli/instances_gltf.h"
#include "cli/painter.h"
#include "cli/session.h"
#include "cli/unit_shapes.h"
#include "host/files.h"
#include "spawn/evaluator/evaluator.h"
#include "spawn/graph/blob.h"

#include <gpgp/spawn.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <sstream>

namespace gpgp::cli {
namespace {

struct SpawnOptions {
  std::string grammar;
  uint32_t axioms = 1, seed = 1, repeat = 1;
  std::array<float, 3> size{1, 1, 1};
  float spacing = 0;
  std::string axiomFile;
  std::vector<std::string> set;
  std::string image, out;
  Size imageSize{1280, 720};
  float yaw = 35, pitch = 25, zoom = 1;
  uint32_t maxInstances = 0, maxShapes = 0, maxDepth = 0;
  std::string schedule = "default";
};

/// What the CPU evaluator derives, on one thread, instances included, into memory that an earlier run has touched: the
/// device's buffers are there before it starts as well.
struct Reference {
  spawn::Derivation result;
  double milliseconds = 0;
};

Reference evaluate(std::span<const uint32_t> words, const std::vector<GpgpAxiom>& axioms, uint32_t maxDepth) {
  spawn::DeriveOptions options;
  if (maxDepth) options.maxDepth = maxDepth;
  Reference reference;
  reference.result = spawn::derive(words, axioms, options);
  if (!reference.result.complete) return reference;
  const auto begin = std::chrono::steady_clock::now();
  reference.result = spawn::derive(words, axioms, options, std::move(reference.result));
  reference.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  return reference;
}

std::vector<std::string> ruleNames(const Blob& blob) {
  const std::span bytes(static_cast<const std::byte*>(blob.data()), blob.size()); // kernels lie behind the graph
  const auto graph = spawn::load(bytes.first(spawn::sizeOfGraph(bytes)), std::pmr::new_delete_resource());
  if (!graph) throw Failure(graph.error().text);
  std::vector<std::string> names;
  for (const spawn::Rule& rule : graph->rules) names.emplace_back(graph->nameAt(rule.name));
  return names;
}

std::vector<std::vector<glm::vec3>> unitShapes() {
  std::vector<std::vector<glm::vec3>> shapes;
  for (uint32_t shape = 0; shape <= GPGP_SHAPE_SPHERE; ++shape) shapes.push_back(unitShape(shape));
  return shapes;
}

/// Terminals are coloured by the index that the grammar gives them, on a square of ground.
void paint(const SpawnOptions& options, const std::vector<GpgpInstance>& instances,
           const std::vector<GpgpGrammarTerminal>& terminals) {
  const std::vector<std::vector<glm::vec3>> shapes = unitShapes();
  Bounds bounds;
  for (const GpgpInstance& instance : instances)
    for (int i = 0; i < 8; ++i)
      bounds.add(placed(instance, {i & 1 ? 0.5f : -0.5f, i & 2 ? 0.5f : -0.5f,
                                   instance.size[2] == 0 ? 0.0f : (i & 4 ? 0.5f : -0.5f)}));
  if (instances.empty()) bounds.add(glm::vec3(0));
  glm::mat4 camera = viewAll(bounds, options.yaw, options.pitch, options.imageSize.width, options.imageSize.height);
  for (int c = 0; c < 4; ++c) {
    camera[c].x *= options.zoom;
    camera[c].y *= options.zoom;
  }
  Painter painter(options.imageSize.width, options.imageSize.height);
  painter.sun(bounds);
  for (const bool shadows : {true, false})
    for (const GpgpInstance& instance : instances) {
      const std::vector<glm::vec3>& shape = shapes[std::min<uint32_t>(instance.shape, GPGP_SHAPE_SPHERE)];
      const glm::vec3 colour = paletteColour(terminals[instance.terminal].index);
      for (size_t i = 0; i + 2 < shape.size(); i += 3) {
        const std::array corners = {placed(instance, shape[i]), placed(instance, shape[i + 1]),
                                    placed(instance, shape[i + 2])};
        shadows ? painter.shadow(corners) : painter.triangle(camera, corners, colour);
      }
    }
  const glm::vec3 extent = bounds.high - bounds.low;
  const float margin = 0.15f * std::max({extent.x, extent.y, extent.z});
  const glm::vec3 a(bounds.low.x - margin, bounds.low.y, bounds.low.z - margin), ground(0.80f, 0.82f, 0.76f);
  const glm::vec3 b(a.x, a.y, bounds.high.z + margin), c(bounds.high.x + margin, a.y, b.z), d(c.x, a.y, a.z);
  painter.triangle(camera, std::array{a, b, c}, ground);
  painter.triangle(camera, std::array{a, c, d}, ground);
  host::writePng(options.image, painter.picture());
}

Outcome spawn(const SpawnOptions& options, const CommonOptions& common) {
  const Blob blob = compileGrammarFile(options.grammar, options.set, options.schedule != "interpreter");
  const AxiomDefaults defaults{options.size, options.seed};
  const std::vector<GpgpAxiom> start = options.axiomFile.empty()
                                           ? axiomGrid(options.axioms, options.spacing, defaults)
                                           : readAxioms(options.axiomFile, ruleNames(blob), defaults);
  std::vector<uint32_t> words(blob.size() / sizeof(uint32_t));
  std::memcpy(words.data(), blob.data(), words.size() * sizeof(uint32_t));
  const Reference reference = evaluate(words, start, options.maxDepth);
  Session session(common);
  host::HeadlessDevice& device = session.device();
  GpgpGrammarCreateInfo grammarInfo = GPGP_GRAMMAR_CREATE_INFO_INIT;
  grammarInfo.label = options.grammar.c_str();
  grammarInfo.data = blob.data();
  grammarInfo.size = blob.size();
  const Grammar grammar = session.take(Grammar::create(session.context(), grammarInfo), "gpgpCreateGrammar");
  uint32_t terminalCount = 0;
  session.check(grammar.terminals(terminalCount, nullptr), "gpgpGetGrammarTerminals");
  std::vector<GpgpGrammarTerminal> terminals(terminalCount);
  session.check(grammar.terminals(terminalCount, terminals.data()), "gpgpGetGrammarTerminals");
  uint32_t buckets = 1;
  for (const GpgpGrammarTerminal& terminal : terminals) buckets = std::max(buckets, terminal.bucket + 1);

  const uint64_t most = device.properties().limits.maxStorageBufferRange / sizeof(GpgpInstance);
  if (options.maxInstances > most)
    throw Usage("--max-instances is too large for this device: at most " + std::to_string(most));
  const uint32_t maxInstances = options.maxInstances
                                    ? options.maxInstances
                                    : static_cast<uint32_t>(std::clamp<uint64_t>(reference.result.terminals, 1,
                                                                                 std::min<uint64_t>(most, 1u << 30)));
  GpgpSpawnerCreateInfo spawnerInfo = GPGP_SPAWNER_CREATE_INFO_INIT;
  spawnerInfo.base = session.workerInfo("spawner");
  spawnerInfo.maxShapes = options.maxShapes;
  spawnerInfo.maxTerminals = maxInstances;
  spawnerInfo.maxDepth = options.maxDepth;
  Spawner spawner = session.take(Spawner::create(session.context(), spawnerInfo), "gpgpCreateSpawner");
  session.check(spawner.prewarm(), "gpgpPrewarm");
  session.check(spawner.prewarm(grammar), "gpgpPrewarmGrammar");
  session.upload();

  const host::Buffer axioms = host::makeBuffer(device, start, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, "axioms");
  const VkDeviceSize instanceBytes = VkDeviceSize{maxInstances} * sizeof(GpgpInstance);
  const host::Buffer instances(device, instanceBytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, host::Memory::device,
                               "instances");
  const host::Buffer draws =
      host::makeBuffer(device, std::vector<VkDrawIndexedIndirectCommand>(std::max(terminalCount, buckets)),
                       VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT, "draws");
  const GpgpAccess transfer{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT,
                            VK_IMAGE_LAYOUT_UNDEFINED};
  const auto [times, report] =
      session.measure(spawner, "deriving", options.repeat,
                      [&](VkCommandBuffer commands, const GpgpFrame& frame, const GpgpRecordInfo& base) {
                        GpgpSpawnInfo info = GPGP_SPAWN_INFO_INIT;
                        info.base = base;
                        info.grammar = grammar;
                        info.axioms = axioms.range();
                        info.axiomCount = static_cast<uint32_t>(start.size());
                        info.instances = instances.range({}, transfer);
                        info.draws = draws.range({}, transfer);
                        return spawner.recordPrepare(commands, frame, info);
                      });
  const auto commands = host::download<VkDrawIndexedIndirectCommand>(device, draws, buckets);
  const auto written = host::download<GpgpInstance>(device, instances, report.instancesWritten);
  session.checkValidation();
  std::vector<std::string> bucketNames(buckets);
  for (const GpgpGrammarTerminal& terminal : terminals) {
    std::string& name = bucketNames[terminal.bucket];
    name += (name.empty() ? "" : ", ") + std::string(terminal.name);
  }
  if (!options.image.empty()) paint(options, written, terminals);
  if (!options.out.empty()) {
    const auto colour = [&](uint32_t bucket) {
      for (const GpgpGrammarTerminal& terminal : terminals)
        if (terminal.bucket == bucket) return paletteColour(terminal.index);
      return paletteColour(0);
    };
    writeGlb(
        options.out, written, buckets, [&](uint32_t bucket) { return bucketNames[bucket]; }, colour);
  }
  uint64_t triangles = 0;
  const std::vector<std::vector<glm::vec3>> shapes = unitShapes();
  for (const GpgpInstance& instance : written)
    triangles += shapes[std::min<uint32_t>(instance.shape, GPGP_SHAPE_SPHERE)].size() / 3;
  const bool exceeded = report.base.status == GPGP_BUDGET_EXCEEDED;
  if (!exceeded && reference.result.complete &&
      (reference.result.terminals != report.terminals ||
       std::memcmp(reference.result.keyHash, report.keyHash, sizeof report.keyHash) != 0))
    throw Failure(options.grammar + ": the device derived something else than the CPU evaluator; please report this");

  Outcome outcome;
  char hash[20];
  std::snprintf(hash, sizeof hash, "%08x%08x", report.keyHash[1], report.keyHash[0]);
  Json bucketList = Json::array(), passes = Json::object();
  for (const auto& [name, time] : times.passes) passes[name] = time;
  const uint64_t bytesWritten = uint64_t{report.instancesWritten} * sizeof(GpgpInstance);
  std::ostringstream text;
  text << report.terminals << " terminals (" << triangles << " triangles) from " << start.size()
       << (start.size() == 1 ? " axiom" : " axioms") << " in " << report.rounds << " rounds on " << device.name()
       << '\n';
  for (uint32_t bucket = 0; bucket < buckets; ++bucket) {
    bucketList.push_back(
        {{"bucket", bucket}, {"name", bucketNames[bucket]}, {"instances", commands[bucket].instanceCount}});
    text << "  " << commands[bucket].instanceCount << "  " << bucketNames[bucket] << '\n';
  }
  text << "peak of " << report.peakShapes << " shapes; GPU " << milliseconds(times.median()) << " (median of "
       << times.totals.size() << "); CPU evaluator, one thread " << milliseconds(reference.milliseconds);
  if (!reference.result.complete) {
    text << ", which gave up";
  } else if (reference.milliseconds > 0) {
    char rate[32];
    std::snprintf(rate, sizeof rate, "%.1f",
                  static_cast<double>(reference.result.terminals) / reference.milliseconds / 1e3);
    text << " (" << rate << " million terminals a second)";
  }
  text << '\n';
  if (report.droppedShapes)
    text << "budget exceeded: " << report.droppedShapes << " shapes did not fit; --max-shapes " << report.peakShapes
         << " would have held that round\n";
  if (report.unfinishedShapes)
    text << "budget exceeded: " << report.unfinishedShapes << " shapes were not finished; raise --max-depth\n";
  if (report.instancesWritten < report.terminals)
    text << "budget exceeded: " << report.terminals - report.instancesWritten
         << " instances did not fit; --max-instances " << report.terminals << " would have\n";
  if (!options.image.empty()) text << "picture: " << options.image << '\n';
  if (!options.out.empty()) text << "triangles: " << options.out << '\n';
  outcome.text = text.str();
  outcome.json = {{"grammar", options.grammar},
                  {"device", device.name()},
                  {"status", statusName(report.base.status)},
                  {"schedule", options.schedule},
                  {"axioms", start.size()},
                  {"seed", options.seed},
                  {"terminals", report.terminals},
                  {"instances", report.instancesWritten},
                  {"triangles", triangles},
                  {"buckets", bucketList},
                  {"rounds", report.rounds},
                  {"peak_shapes", report.peakShapes},
                  {"dropped_shapes", report.droppedShapes},
                  {"unfinished_shapes", report.unfinishedShapes},
                  {"budget_exceeded", exceeded},
                  {"key_hash", hash},
                  {"bytes_written", bytesWritten},
                  {"gpu_ms_median", times.median()},
                  {"passes", passes},
                  {"cpu_reference_terminals", reference.result.terminals},
                  {"cpu_reference_ms", reference.result.complete ? Json(reference.milliseconds) : Json()},
                  {"image", options.image.empty() ? Json() : Json(options.image)},
                  {"out", options.out.empty() ? Json() : Json(options.out)}};
  return outcome;
}

} // namespace

Work addSpawn(CLI::App& app) {
  auto options = std::make_shared<SpawnOptions>();
  CLI::App* command = app.add_subcommand("spawn", "Derive a grammar on the GPU and say what came out");
  command->add_option("GRAMMAR", options->grammar, "PGA-shape grammar text (.pga)")
      ->required()
      ->check(CLI::ExistingFile);
  CLI::Option* axioms = command->add_option("--axioms", options->axioms, "Start shapes, on a square grid")
                            ->check(CLI::Range(1u, 10000000u))
                            ->capture_default_str();
  command
      ->add_option("--axiom-file", options->axiomFile,
                   "Start shapes from a file, CSV or JSON: position, rotation about Y, size, seed, rule")
      ->check(CLI::ExistingFile)
      ->excludes(axioms);
  command
      ->add_option_function<std::string>(
          "--axiom-size", [o = options.get()](const std::string& t) { o->size = parseTriple(t); },
          "Extents of each start shape in metres (default 1,1,1)")
      ->type_name("X,Y,Z");
  command
      ->add_option("--spacing", options->spacing, "Distance of the axioms in metres (default: 1.5 times their width)")
      ->check(CLI::PositiveNumber);
  command->add_option("--seed", options->seed, "Random seed; axiom i has seed S + i")->capture_default_str();
  command->add_option("--set", options->set, "Override a `var` of the grammar; may be repeated")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  command->add_option("--repeat", options->repeat, "Derive N times and report the median time")
      ->check(CLI::Range(1u, 100000u))
      ->capture_default_str();
  command->add_option("--schedule", options->schedule, "How the derivation runs")
      ->check(CLI::IsMember({"interpreter", "default"}))
      ->capture_default_str();
  command->add_option("--image", options->image, "Write a picture of the result")->type_name("FILE.png");
  command->add_option("--yaw", options->yaw, "That picture's view: degrees around the scene")->capture_default_str();
  command->add_option("--pitch", options->pitch, "Degrees above the horizon")
      ->check(CLI::Range(-89.0f, 89.0f))
      ->capture_default_str();
  command->add_option("--zoom", options->zoom, "Times closer to the middle than all of the scene")
      ->check(CLI::Range(0.01f, 1000.0f))
      ->capture_default_str();
  command->add_option("--out", options->out, "Write the instances as triangles")->type_name("FILE.glb");
  addSize(*command, "--image-size", options->imageSize, "Size of that picture (default 1280x720)");
  command
      ->add_option("--max-instances", options->maxInstances,
                   "Budget: instances written (0: what the CPU evaluator counts, as far as the device binds it)")
      ->check(CLI::Range(0u, 1u << 30))
      ->capture_default_str();
  command->add_option("--max-shapes", options->maxShapes,
                      "Budget: shapes alive in one round (0: the library's default)");
  command->add_option("--max-depth", options->maxDepth, "Budget: rounds (0: the library's default)");
  command->footer(R"(
Examples:
  gpgp spawn sponge.pga                                 one axiom of 1 x 1 x 1
  gpgp spawn tower.pga --axioms 256 --axiom-size 24,34,24 --spacing 40
  gpgp spawn tower.pga --set floors=12 --seed 7 --image tower.png --out tower.glb
  gpgp spawn town.pga --axiom-file lots.csv             x,z,rotation,size_x,size_y,size_z,seed,rule on the first line
  gpgp spawn tower.pga --axioms 1024 --repeat 50 --json | jq .gpu_ms_median

An axiom stands on its position. The CPU evaluator derives the same on one thread: cpu_reference_ms, and a check of what
the device did. Errors in the grammar and in axiom files are printed with their place. What exceeds a budget is counted
and reported with the size that would have fitted; it is never silently lost.)");
  return [options](const CommonOptions& common) { return spawn(*options, common); };
}

} // namespace gpgp::cli
