// `gpgp spawn`: compiles a grammar, derives axioms on a grid and says what came out.
#include "cli/painter.h"
#include "cli/session.h"
#include "cli/unit_shapes.h"
#include "host/files.h"

#include <gpgp/spawn.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

namespace gpgp::cli {
namespace {

struct SpawnOptions {
  std::string grammar;
  uint32_t axioms = 1, seed = 1, repeat = 1;
  std::array<float, 3> size{1, 1, 1};
  float spacing = 0;
  std::vector<std::string> set;
  std::string image;
  Size imageSize{1280, 720};
  uint32_t maxInstances = 1u << 20, maxShapes = 0, maxDepth = 0;
};

std::vector<GpgpVariable> variables(const std::vector<std::string>& assignments) {
  std::vector<GpgpVariable> result;
  for (const std::string& assignment : assignments) {
    const size_t equals = assignment.find('=');
    char* end = nullptr;
    const float value = equals == std::string::npos ? 0.0f : std::strtof(assignment.c_str() + equals + 1, &end);
    if (equals == 0 || equals == std::string::npos || equals + 1 == assignment.size() || *end != 0)
      throw Usage("--set takes NAME=VALUE with a number, for example --set floors=12; got \"" + assignment + "\"");
    result.push_back({nullptr, value}); // the name follows once the strings lie still
  }
  return result;
}

Blob compile(const SpawnOptions& options) {
  const std::string text = host::readText(options.grammar);
  std::vector<GpgpVariable> overrides = variables(options.set);
  std::vector<std::string> names;
  for (const std::string& assignment : options.set) names.push_back(assignment.substr(0, assignment.find('=')));
  for (size_t i = 0; i < names.size(); ++i) overrides[i].name = names[i].c_str();
  GpgpGrammarSource source = GPGP_GRAMMAR_SOURCE_INIT;
  source.name = options.grammar.c_str();
  source.text = text.data();
  source.size = text.size();
  source.variables = overrides.data();
  source.variableCount = static_cast<uint32_t>(overrides.size());
  struct Errors {
    std::string first;
    uint32_t count = 0;
  } errors;
  source.messageUserData = &errors;
  source.messageFn = [](void* userData, const GpgpCompileMessage* message) {
    auto* all = static_cast<Errors*>(userData);
    std::ostringstream line;
    line << message->file << ':' << message->line << ':' << message->column << ": "
         << (message->severity == GPGP_SEVERITY_ERROR     ? "error: "
             : message->severity == GPGP_SEVERITY_WARNING ? "warning: "
                                                          : "")
         << message->text;
    std::fprintf(stderr, "%s\n", line.str().c_str());
    if (message->severity != GPGP_SEVERITY_ERROR) return;
    if (all->count++ == 0) all->first = line.str();
  };
  Result<Blob> blob = compileGrammar(source);
  if (blob) return std::move(*blob);
  if (errors.count == 0) throw Failure(options.grammar + ": " + blob.name());
  throw Failure(errors.first + (errors.count > 1 ? " (and " + std::to_string(errors.count - 1) + " more)" : ""));
}

/// A square grid in the ground plane around the origin, row by row; axiom i has the seed S + i.
std::vector<GpgpAxiom> axiomGrid(const SpawnOptions& options) {
  const float spacing = options.spacing > 0 ? options.spacing : std::max(options.size[0], options.size[2]) * 1.5f;
  const uint32_t side = static_cast<uint32_t>(std::ceil(std::sqrt(static_cast<double>(options.axioms))));
  std::vector<GpgpAxiom> axioms(options.axioms);
  for (uint32_t i = 0; i < options.axioms; ++i) {
    GpgpAxiom& axiom = axioms[i];
    axiom = GpgpAxiom{};
    const float offset = static_cast<float>(side - 1) * 0.5f;
    axiom.transform[0] = axiom.transform[5] = axiom.transform[10] = 1.0f;
    axiom.transform[3] = (static_cast<float>(i % side) - offset) * spacing;
    axiom.transform[7] = options.size[1] * 0.5f; // stands on the ground: shapes have their origin in the middle
    axiom.transform[11] = (static_cast<float>(i / side) - offset) * spacing;
    std::copy(options.size.begin(), options.size.end(), axiom.size);
    axiom.seed = options.seed + i;
    axiom.id = i;
    axiom.rule = GPGP_AXIOM_DEFAULT_RULE;
    axiom.attribute = std::nanf("");
  }
  return axioms;
}

glm::vec3 place(const GpgpInstance& instance, const glm::vec3& p) {
  const float* m = instance.transform;
  return {m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3], m[4] * p.x + m[5] * p.y + m[6] * p.z + m[7],
          m[8] * p.x + m[9] * p.y + m[10] * p.z + m[11]};
}

void paint(const SpawnOptions& options, const std::vector<GpgpInstance>& instances) {
  std::vector<std::vector<glm::vec3>> shapes;
  for (uint32_t shape = 0; shape <= GPGP_SHAPE_SPHERE; ++shape) shapes.push_back(unitShape(shape));
  Bounds bounds;
  for (const GpgpInstance& instance : instances)
    for (const glm::vec3& corner : {glm::vec3(-0.5f), glm::vec3(0.5f)}) bounds.add(place(instance, corner));
  if (instances.empty()) bounds.add(glm::vec3(0));
  const glm::mat4 camera = viewAll(bounds, 35, 25, options.imageSize.width, options.imageSize.height);
  Painter painter(options.imageSize.width, options.imageSize.height);
  for (const GpgpInstance& instance : instances) {
    const std::vector<glm::vec3>& shape = shapes[std::min<uint32_t>(instance.shape, GPGP_SHAPE_SPHERE)];
    for (size_t i = 0; i + 2 < shape.size(); i += 3) {
      const std::array corners = {place(instance, shape[i]), place(instance, shape[i + 1]),
                                  place(instance, shape[i + 2])};
      painter.triangle(camera, corners, paletteColour(instance.bucket));
    }
  }
  host::writePng(options.image, painter.picture());
}

Outcome spawn(const SpawnOptions& options, const CommonOptions& common) {
  const Blob blob = compile(options);
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

  GpgpSpawnerCreateInfo spawnerInfo = GPGP_SPAWNER_CREATE_INFO_INIT;
  spawnerInfo.base = session.workerInfo("spawner");
  spawnerInfo.maxShapes = options.maxShapes;
  spawnerInfo.maxDepth = options.maxDepth;
  Spawner spawner = session.take(Spawner::create(session.context(), spawnerInfo), "gpgpCreateSpawner");
  session.check(spawner.prewarm(), "gpgpPrewarm");
  session.upload();

  const host::Buffer axioms =
      host::makeBuffer(device, axiomGrid(options), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, "axioms");
  const VkDeviceSize instanceBytes = VkDeviceSize{options.maxInstances} * sizeof(GpgpInstance);
  if (instanceBytes > device.properties().limits.maxStorageBufferRange)
    throw Usage("--max-instances is too large for this device: at most " +
                std::to_string(device.properties().limits.maxStorageBufferRange / sizeof(GpgpInstance)));
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
                        info.axiomCount = options.axioms;
                        info.instances = instances.range({}, transfer);
                        info.draws = draws.range({}, transfer);
                        return spawner.recordPrepare(commands, frame, info);
                      });
  const auto commands = host::download<VkDrawIndexedIndirectCommand>(device, draws, buckets);
  if (!options.image.empty()) paint(options, host::download<GpgpInstance>(device, instances, report.instancesWritten));
  session.checkValidation();

  Outcome outcome;
  char hash[20];
  std::snprintf(hash, sizeof hash, "%08x%08x", report.keyHash[1], report.keyHash[0]);
  Json bucketList = Json::array();
  std::ostringstream text;
  text << report.terminals << " terminals from " << options.axioms << (options.axioms == 1 ? " axiom" : " axioms")
       << " in " << report.rounds << " rounds on " << device.name() << '\n';
  for (uint32_t bucket = 0; bucket < buckets; ++bucket) {
    std::string name;
    for (const GpgpGrammarTerminal& terminal : terminals)
      if (terminal.bucket == bucket) name += (name.empty() ? "" : ", ") + std::string(terminal.name);
    bucketList.push_back({{"bucket", bucket}, {"name", name}, {"instances", commands[bucket].instanceCount}});
    text << "  " << commands[bucket].instanceCount << "  " << name << '\n';
  }
  text << "peak of " << report.peakShapes << " shapes; GPU " << milliseconds(times.median()) << " (median of "
       << times.totals.size() << ")\n";
  if (report.droppedShapes)
    text << "budget exceeded: " << report.droppedShapes << " shapes did not fit; --max-shapes " << report.peakShapes
         << " would have held that round\n";
  if (report.unfinishedShapes)
    text << "budget exceeded: " << report.unfinishedShapes << " shapes were not finished; raise --max-depth\n";
  if (report.instancesWritten < report.terminals)
    text << "budget exceeded: " << report.terminals - report.instancesWritten
         << " instances did not fit; --max-instances " << report.terminals << " would have\n";
  if (!options.image.empty()) text << "picture: " << options.image << '\n';
  outcome.text = text.str();
  outcome.json = {{"grammar", options.grammar},
                  {"device", device.name()},
                  {"status", statusName(report.base.status)},
                  {"axioms", options.axioms},
                  {"seed", options.seed},
                  {"terminals", report.terminals},
                  {"instances", report.instancesWritten},
                  {"buckets", bucketList},
                  {"rounds", report.rounds},
                  {"peakShapes", report.peakShapes},
                  {"droppedShapes", report.droppedShapes},
                  {"unfinishedShapes", report.unfinishedShapes},
                  {"keyHash", hash},
                  {"gpuMilliseconds", times.json()},
                  {"image", options.image.empty() ? Json() : Json(options.image)}};
  return outcome;
}

} // namespace

Work addSpawn(CLI::App& app) {
  auto options = std::make_shared<SpawnOptions>();
  CLI::App* command = app.add_subcommand("spawn", "Derive a grammar on the GPU and say what came out");
  command->add_option("GRAMMAR", options->grammar, "PGA-shape grammar text (.pga)")
      ->required()
      ->check(CLI::ExistingFile);
  command->add_option("--axioms", options->axioms, "Start shapes, on a square grid")
      ->check(CLI::Range(1u, 1000000u))
      ->capture_default_str();
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
  command->add_option("--image", options->image, "Write a picture of the result")->type_name("FILE.png");
  addSize(*command, "--image-size", options->imageSize, "Size of that picture (default 1280x720)");
  command->add_option("--max-instances", options->maxInstances, "Budget: instances written")
      ->check(CLI::Range(1u, 1u << 30))
      ->capture_default_str();
  command->add_option("--max-shapes", options->maxShapes,
                      "Budget: shapes alive in one round (0: the library's default)");
  command->add_option("--max-depth", options->maxDepth, "Budget: rounds (0: the library's default)");
  command->footer(R"(
Examples:
  gpgp spawn sponge.pga                                 one axiom of 1 x 1 x 1
  gpgp spawn tower.pga --axioms 256 --axiom-size 24,34,24 --spacing 40
  gpgp spawn tower.pga --set floors=12 --seed 7 --image tower.png
  gpgp spawn tower.pga --axioms 1024 --repeat 50 --json | jq .gpuMilliseconds

Errors in the grammar are printed as FILE:LINE:COLUMN. What exceeds a budget is counted and reported with the size that
would have fitted; it is never silently lost.)");
  return [options](const CommonOptions& common) { return spawn(*options, common); };
}

} // namespace gpgp::cli
