// `gpgp spawn`: compiles a grammar, derives axioms and says what came out, beside the CPU evaluator.
#include "cli/shared/command.h"
#include "cli/shared/painter.h"
#include "cli/spawn/axioms.h"
#include "cli/spawn/camera.h"
#include "cli/spawn/cga_source.h"
#include "cli/spawn/fields.h"
#include "cli/spawn/grammar_source.h"
#include "cli/spawn/languages.h"
#include "cli/spawn/lsystem.h"
#include "cli/spawn/measures.h"
#include "cli/spawn/options.h"
#include "cli/spawn/reference.h"
#include "cli/spawn/scene_picture.h"
#include "cli/spawn/spawned_gltf.h"
#include "cli/spawn/spawned_triangles.h"
#include "cli/tune/tuner.h"
#include "core/suggest.h"
#include "host/files.h"

#include <gpgp/spawn.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <sstream>

namespace gpgp::cli {
namespace {

/// The kernel that --schedule names: none for the interpreter.
struct Chosen {
  std::pmr::vector<uint32_t> words;
  std::string name;           ///< of its schedule
  std::filesystem::path file; ///< that it was taken from
  size_t groups = 0;
};

/// --matching on is wrong for what has no code for groups of its own.
void matchesNothing(const SpawnOptions& options, const char* what) {
  if (options.matching == "on") throw Usage(std::string("--matching on changes nothing of ") + what);
}
/// --queues group is for kernels that are compiled here.
void queuesNothing(const SpawnOptions& options, const char* what) {
  if (options.queues == "group") throw Usage(std::string("--queues group changes nothing of ") + what);
}

Chosen chooseKernel(const SpawnOptions& options, const BakedGraph& grammar, const std::vector<GpgpAxiom>& axioms,
                    const DeriverOptions& how, Session& session) {
  const std::string& name = options.schedule;
  const uint32_t count = static_cast<uint32_t>(axioms.size());
  const auto taken = [&](const spawn::Kernel& kernel, const std::filesystem::path& file) {
    spawn::KernelInfo info = kernel.info;
    info.vendor = info.device = 0; // it is the only one here
    return Chosen{kernelWords(grammar, info, kernel.code), info.schedule, file, info.groups};
  };
  if (name == "interpreter") {
    matchesNothing(options, "the interpreter");
    queuesNothing(options, "the interpreter");
    return {{}, name, {}, spawn::namedSchedule(grammar.graph, "default")->groups}; // what waits there waits here
  }
  if (name == "tuned") {
    queuesNothing(options, "tuned schedules, which `gpgp tune` chooses with the rest");
    const std::filesystem::path file = tunedFile(options.grammars, grammar);
    const auto stored = storedKernels(file, grammar, true);
    if (const auto kernel = kernelFor(stored, session.device(), count);
        kernel && isTunedFor(kernel->info, session.device(), count))
      return taken(*kernel, file);
    checkWritable(file);
    std::fprintf(stderr, "gpgp spawn: no stored schedule for this grammar, device and number of axioms; tuning\n");
    TuneSettings settings;
    settings.matching = options.matching == "on";
    settings.heuristics = options.heuristics;
    settings.derive = how;
    const Tuned tuned = tuneGrammar(session, grammar, axioms, settings);
    keepKernel(file, grammar, tuned.info, tuned.code, stored);
    std::fprintf(stderr, "gpgp spawn: kept in %s\n", file.string().c_str());
    return taken({tuned.info, {tuned.code.begin(), tuned.code.end()}}, file);
  }
  const auto queues = options.queues == "group" ? spawn::Queues::groups : spawn::Queues::mixed;
  const spawn::KernelTarget target = targetFor(session.device(), grammar.graph, queues);
  if (spawn::namedSchedule(grammar.graph, name) || !isBaked(name)) {
    auto schedule = scheduleFor(grammar.graph, name, options.heuristics);
    if (!schedule)
      throw Usage("--schedule takes sgl, rw, rules, heuristic, tuned, interpreter, default or a file; there is no \"" +
                  name + "\"");
    if (queues == spawn::Queues::groups) schedule = withQueues(std::move(*schedule));
    if (schedule->roots.empty()) matchesNothing(options, "the default schedule, which is not a partition");
    const auto code = compileOrSay(grammar.graph, *schedule, std::span(&target, 1), options.matching == "on",
                                   joined(options.grammars));
    if (code[0].empty()) return {{}, "interpreter", {}, schedule->groups};
    return {kernelWords(grammar, kernelInfo(*schedule, target), code[0]), schedule->name, {}, schedule->groups};
  }
  const auto kernel = kernelFor(kernelsIn(name, grammar), session.device(), count);
  if (!kernel) throw Failure(name + " holds no kernel that is for this device");
  matchesNothing(options, "kernels that are baked");
  queuesNothing(options, "kernels that are baked");
  return taken(*kernel, name);
}

/// Terminals are coloured by the index that the grammar gives them, on a square of ground.
void paint(const SpawnOptions& options, const Triangles& all, const spawn::Graph& graph) {
  SceneView view{options.imageSize, options.yaw, options.pitch, options.zoom, 0};
  if (options.hasCamera) view.camera = cameraMatrix(options);
  paintScene(options.image, view, all.corners,
             [&](size_t i) { return paletteColour(graph.terminals[all.terminals[i]].index); });
}

std::string counted(uint64_t number, const std::string& one, const std::string& many = {}) {
  return std::to_string(number) + " " + (number == 1 ? one : many.empty() ? one + "s" : many);
}

/// A line for what exceeded a budget: what would have been enough, as far as the device has room for that.
std::string exceeded(const std::string& what, const std::string& option, uint64_t wanted, uint64_t most) {
  return "budget exceeded: " + what + " did not fit; " +
         (wanted <= most ? option + " " + std::to_string(wanted) + " would have held all"
                         : "this device takes " + std::to_string(most) + " at most: use fewer axioms") +
         "\n";
}

/// Of the dropped shapes, those that no budget can save.
struct Hopeless {
  uint32_t tooManyCopies = 0, uncut = 0;
};
/// All budgets that were exceeded, a line each. depth: says how deep rules nest, where that has an end.
std::string exceededBudgets(const GpgpSpawnReport& report, const Hopeless& hopeless,
                            const std::function<std::optional<uint32_t>()>& depth, const Deriver& deriver,
                            bool vertices) {
  std::string text;
  const auto dropped = [&](uint32_t shapes, const std::string& why) {
    if (shapes)
      text += "budget exceeded: " + counted(shapes, "shape") + (shapes == 1 ? " was" : " were") + " dropped, as " +
              why + "\n";
  };
  dropped(hopeless.tooManyCopies, "a Repeat makes at most " + std::to_string(shader::kMaxRepeat) + " copies of one");
  dropped(hopeless.uncut, "SubDiv cuts polygons and prisms by constant weights alone, and each part into one piece");
  const uint32_t waiting =
      report.droppedShapes - std::min(report.droppedShapes, hopeless.tooManyCopies + hopeless.uncut);
  if (waiting && report.peakShapes > deriver.maxShapes())
    text +=
        exceeded(counted(waiting, "shape") + " of a round", "--max-shapes", report.peakShapes, deriver.mostShapes());
  else if (waiting)
    text += "budget exceeded: " + counted(waiting, "shape") + " still waited after the last of " +
            counted(report.rounds, "round") + ", which are as many as a recording takes\n";
  if (report.collidersKept < report.colliders)
    text += exceeded(counted(report.colliders - report.collidersKept, "collider"), "--max-colliders", report.colliders,
                     deriver.mostColliders());
  if (report.unfinishedShapes) {
    const auto enough = depth();
    text += "budget exceeded: " + counted(report.unfinishedShapes, "shape") +
            (report.unfinishedShapes == 1 ? " was" : " were") + " not finished; " +
            (enough ? "--max-depth " + std::to_string(*enough) + " would have been enough"
                    : std::string("the rules nest in themselves without end, or too deep for any --max-depth")) +
            "\n";
  }
  if (!vertices && report.instancesWritten < report.terminals)
    text += exceeded(counted(report.terminals - report.instancesWritten, "instance"), "--max-instances",
                     report.terminals, deriver.mostElements());
  if (report.verticesWritten < report.vertices)
    text += exceeded(counted(report.vertices - report.verticesWritten, "vertex", "vertices"), "--max-instances",
                     report.vertices, deriver.mostElements());
  return text;
}

/// As if it had been one recording.
void add(GpgpSpawnReport& sum, const GpgpSpawnReport& record) {
  if (sum.base.status >= GPGP_SUCCESS) // an error stays one
    sum.base.status =
        record.base.status < GPGP_SUCCESS ? record.base.status : std::max(sum.base.status, record.base.status);
  for (const auto member :
       {&GpgpSpawnReport::terminals, &GpgpSpawnReport::instancesWritten, &GpgpSpawnReport::droppedShapes,
        &GpgpSpawnReport::unfinishedShapes, &GpgpSpawnReport::vertices, &GpgpSpawnReport::verticesWritten,
        &GpgpSpawnReport::colliders, &GpgpSpawnReport::collidersKept})
    sum.*member += record.*member;
  for (const auto member : {&GpgpSpawnReport::peakShapes, &GpgpSpawnReport::rounds, &GpgpSpawnReport::depth})
    sum.*member = std::max(sum.*member, record.*member);
  for (size_t word = 0; word < std::size(sum.keyHash); ++word) sum.keyHash[word] += record.keyHash[word];
}

/// Axioms in parts of equal size, a recording each.
struct Slices {
  const std::vector<GpgpAxiom>& axioms;
  size_t recordings = 1, size = 0;

  Slices(const std::vector<GpgpAxiom>& all, size_t most) : axioms(all) {
    recordings = (all.size() + most - 1) / most;
    size = (all.size() + recordings - 1) / recordings;
  }
  std::vector<GpgpAxiom> of(size_t record) const {
    const size_t first = std::min(record * size, axioms.size()), end = std::min(first + size, axioms.size());
    return {axioms.begin() + std::ptrdiff_t(first), axioms.begin() + std::ptrdiff_t(end)};
  }
};

Slices slicesFor(const SpawnOptions& options, const std::vector<GpgpAxiom>& axioms, const spawn::Graph& graph,
                 Session& session) {
  uint64_t most = Deriver::mostAxioms(session);
  if (options.slice) most = std::min<uint64_t>(most, options.slice);
  if (axioms.size() > most && graph.phases)
    throw Usage(counted(axioms.size(), "axiom") + " take several recordings of at most " + std::to_string(most) +
                ", but colliders know only those of their recording; use fewer axioms");
  return {axioms, most};
}

/// Whether terminals can be shapes with corners of their own, which instances do not say.
bool hasDynamicTerminals(const spawn::Graph& graph) {
  return std::any_of(graph.nodes.begin(), graph.nodes.end(), [](const spawn::Node& node) {
    return node.op == shader::kOpTerminal && (node.shapes & shader::kDynamicShapes);
  });
}

/// The rule or axiom that --start names.
uint32_t startNamed(const BakedGraph& grammar, const std::string& name) {
  const std::vector<NamedStart> starts = grammar.namedStarts();
  core::Suggestion suggestion(name);
  for (uint32_t i = 0; i < starts.size(); ++i) {
    if (starts[i].name == name) return i;
    suggestion.offer(starts[i].name);
  }
  throw Usage("--start " + name + ": there is no such rule" + suggestion.text());
}

/// --changed: some of the axioms, spread over all, get other seeds.
Changes change(const SpawnOptions& options, const std::vector<GpgpAxiom>& axioms, Deriver& deriver,
               const Grammar& grammar) {
  std::map<uint32_t, GpgpAxiom> changed;
  const size_t count = std::max<size_t>(size_t(double(axioms.size()) * options.changed / 100 + 0.5), 1);
  for (size_t i = 0; i < count; ++i) {
    const size_t number = i * axioms.size() / count;
    GpgpAxiom axiom = axioms[number];
    axiom.seed += 0x9e3779b9u;
    changed.emplace(static_cast<uint32_t>(number), axiom);
  }
  const Changes changes = deriver.change(grammar, axioms, changed, options.repeat);
  if (changes.moved || changes.foreign)
    throw Failure("deriving some axioms anew changed " + std::to_string(changes.moved) +
                  " instances of others, and wrote " + std::to_string(changes.foreign) +
                  " that are not theirs; please report this");
  return changes;
}

Outcome spawn(const SpawnOptions& options, const CommonOptions& common) {
  if (std::any_of(options.grammars.begin(), options.grammars.end(), isCga)) return spawnCgaFile(options, common);
  if (std::any_of(options.grammars.begin(), options.grammars.end(), isLsystem))
    return spawnLsystemFile(options, common);
  expectOfGrammars(options);
  const bool vertices = options.output == "vertices";
  if (vertices && options.sorted) throw Usage("--sorted is for --output instances");
  if (options.changed > 0 && (vertices || options.sorted || options.slice || options.maxInstances))
    throw Usage("--changed is for --output instances without --sorted, --slice and --max-instances");
  const BakedGraph grammar = bakeGraph(options.grammars, options.set);
  const spawn::Graph& graph = grammar.graph;
  const AxiomDefaults defaults{
      options.size, options.seed,
      options.start.empty() ? grammar.starts() : std::vector{startNamed(grammar, options.start)}, options.interval};
  const uint32_t grammarCount = static_cast<uint32_t>(defaults.starts.size());
  const std::vector<GpgpAxiom> start =
      !options.axiomFile.empty() ? readAxioms(options.axiomFile, grammar.namedStarts(), defaults)
      : options.scatter.distance > 0.0f
          ? scatterAxioms(options.scatter, defaults)
          : axiomGrid(options.axioms ? options.axioms : grammarCount, options.spacing, defaults);
  Session session(common);
  const Slices slices = slicesFor(options, start, graph, session);
  const WorldFields fields(options.fields, graph);
  std::optional<GpgpSpawnCamera> camera;
  if (options.hasCamera) camera = cameraOf(options);
  if (options.budget)
    camera->detail = detailWithin(options.budget, *camera, grammar.words, start, options.maxDepth,
                                  joined(options.grammars), fields.bound());
  const shader::View view = viewOf(camera);
  const World world{&view, &fields.bound()};
  const auto layout = spawn::layoutOf(Deriver::layout());
  const Reference reference =
      evaluate(grammar.words, start, options.maxDepth, vertices ? &*layout : nullptr, joined(options.grammars), world);
  DeriverOptions how; // whatever is written
  how.maxDepth = options.maxDepth;
  how.camera = camera;
  fields.give(how);
  const Chosen chosen = chooseKernel(options, grammar, slices.of(0), how, session);

  DeriverOptions deriverOptions = how;
  deriverOptions.kernelsOnly = !chosen.words.empty();
  deriverOptions.vertices = vertices;
  deriverOptions.sorted = options.sorted;
  deriverOptions.maxShapes = options.maxShapes;
  deriverOptions.maxColliders = options.maxColliders;
  deriverOptions.maxInstances = options.maxInstances;
  deriverOptions.expected =
      (vertices ? reference.result.vertexWords.size() * 4 / sizeof(SpawnedVertex) : reference.result.terminals) /
      slices.recordings;
  Deriver deriver(session, grammar, slices.of(0), deriverOptions);
  if (options.maxInstances > deriver.mostElements())
    throw Usage("--max-instances is too large for this device: at most " + std::to_string(deriver.mostElements()));
  const Grammar prepared = deriver.prepare(chosen.words);
  GpgpSpawnReport report = GPGP_SPAWN_REPORT_INIT;
  GpuTimes times;
  uint64_t bytesWritten = 0, verticesWritten = 0;
  std::vector<GpgpInstance> instances;
  // Of shapes whose corners instances do not say, what is drawn and counted is derived once more, as vertices.
  std::optional<Deriver> asVertices;
  if (!vertices && hasDynamicTerminals(graph)) {
    deriverOptions.vertices = true;
    deriverOptions.sorted = false;
    deriverOptions.maxInstances = 0;
    deriverOptions.expected = 0;
    deriverOptions.kernelsOnly = !deriver.interprets();
    asVertices.emplace(session, grammar, slices.of(0), deriverOptions);
  }
  Triangles triangles{!options.image.empty(), std::vector<uint64_t>(graph.terminals.size())};
  std::vector<SpawnedVertex> allVertices; // for --out
  std::vector<uint32_t> allIndices;
  const auto take = [&](Deriver& from) {
    const std::vector<SpawnedVertex> written = from.vertices();
    const std::vector<uint32_t> indices = from.indices();
    addTriangles(triangles, written, indices);
    if (options.out.empty()) return written.size();
    const uint32_t first = static_cast<uint32_t>(allVertices.size());
    allVertices.insert(allVertices.end(), written.begin(), written.end());
    for (const uint32_t index : indices) allIndices.push_back(first + index);
    return written.size();
  };
  std::string budgets; // that the first recording exceeded that exceeded any
  for (size_t record = 0; record < slices.recordings; ++record) {
    if (record) deriver.setAxioms(slices.of(record));
    deriver.fit(prepared);
    const auto measured = deriver.measure(prepared, options.repeat);
    add(report, measured.report);
    times.add(measured.times);
    bytesWritten += deriver.bytesWritten();
    if (budgets.empty()) {
      Hopeless hopeless; // which the report does not tell from those that still waited
      if (measured.report.droppedShapes && reference.result.droppedShapes) {
        const spawn::Derivation own =
            checkThatItEnds(grammar.words, slices.of(record), options.maxDepth, joined(options.grammars), world);
        hopeless = {own.droppedShapes - own.uncutShapes, own.uncutShapes};
      }
      const auto depth = [&] { return depthOf(grammar.words, slices.of(record), world); };
      budgets = exceededBudgets(measured.report, hopeless, depth, deriver, vertices);
      if (!budgets.empty() && slices.recordings > 1)
        budgets.insert(0,
                       "recording " + std::to_string(record + 1) + " of " + std::to_string(slices.recordings) + ":\n");
    }
    if (vertices) {
      verticesWritten += take(deriver);
    } else {
      const std::vector<GpgpInstance> written = deriver.instances();
      if (asVertices) {
        if (written.size() < measured.report.terminals)
          throw Usage("of " + std::to_string(measured.report.terminals) + " instances " +
                      std::to_string(written.size()) +
                      " were written, and some have corners of their own, that instances do not say: what they would "
                      "draw is not known; raise --max-instances, or --output vertices says it");
        if (record) asVertices->setAxioms(slices.of(record));
        asVertices->fit(prepared);
        take(*asVertices);
      } else {
        addTriangles(triangles, written);
      }
      instances.insert(instances.end(), written.begin(), written.end());
    }
  }
  std::optional<Changes> changes;
  if (options.changed > 0) changes = change(options, start, deriver, prepared);
  Json measures;
  if (!options.measures.empty()) measures = measureAxioms(session, grammar, options.measures, start, how, world);
  session.checkValidation();

  std::vector<std::string> bucketNames(std::max(graph.buckets, 1u));
  for (const spawn::Terminal& terminal : graph.terminals) {
    std::string& name = bucketNames[terminal.bucket];
    name += (name.empty() ? "" : ", ") + std::string(graph.nameAt(terminal.name));
  }
  std::vector<uint64_t> bucketInstances(bucketNames.size()), bucketTriangles(bucketNames.size());
  std::map<uint32_t, uint64_t> ruleInstances;
  for (const GpgpInstance& instance : instances) {
    ++bucketInstances.at(instance.bucket);
    ++ruleInstances[instance.rule];
  }
  for (size_t terminal = 0; terminal < triangles.counts.size(); ++terminal)
    bucketTriangles[graph.terminals[terminal].bucket] += triangles.counts[terminal];
  if (report.base.status < GPGP_SUCCESS)
    throw Failure(joined(options.grammars) + ": " + statusName(report.base.status) +
                  ": the device ended loops of a shader early, so the result is wrong");
  if (!options.image.empty()) paint(options, triangles, graph);
  if (!options.out.empty()) writeGlb(options.out, graph, {instances, allVertices, allIndices}, glbInstances(options));
  const bool exceeded = report.base.status == GPGP_BUDGET_EXCEEDED;
  const bool whole = !report.droppedShapes && report.collidersKept == report.colliders &&
                     report.unfinishedShapes == reference.result.unfinishedShapes;
  if (whole && reference.result.complete)
    if (const std::string what = difference(reference.result, report, instances); !what.empty())
      throw Failure(joined(options.grammars) + ": the device derived something else than the CPU evaluator: " + what +
                    "; please report this");

  Outcome outcome;
  char hash[20];
  std::snprintf(hash, sizeof hash, "%08x%08x", report.keyHash[1], report.keyHash[0]);
  Json bucketList = Json::array(), ruleList = Json::array(), passes = Json::object();
  for (const auto& [rule, count] : ruleInstances)
    ruleList.push_back({{"rule", rule == GPGP_NO_RULE ? Json() : Json(graph.nameAt(graph.rules.at(rule).name))},
                        {"instances", count}});
  for (const auto& [name, time] : times.passes) // rounds of derivation have the same name
    passes[name] = passes.value(name, 0.0) + time;
  std::ostringstream text;
  text << report.terminals << " terminals (" << triangles.total << " triangles) from " << start.size()
       << (start.size() == 1 ? " axiom" : " axioms") << " in "
       << (slices.recordings > 1 ? std::to_string(slices.recordings) + " recordings of up to " : std::string())
       << report.rounds << " rounds on " << session.device().name() << "; schedule " << chosen.name << ", "
       << chosen.groups << " execution groups\n";
  for (uint32_t bucket = 0; bucket < bucketNames.size(); ++bucket) {
    bucketList.push_back({{"bucket", bucket},
                          {"name", bucketNames[bucket]},
                          {"instances", bucketInstances[bucket]},
                          {"triangles", bucketTriangles[bucket]}});
    text << "  " << (vertices ? bucketTriangles : bucketInstances)[bucket] << (vertices ? " triangles  " : "  ")
         << bucketNames[bucket] << '\n';
  }
  text << "peak of " << report.peakShapes << " shapes; GPU " << milliseconds(times.median()) << " (median of "
       << times.totals.size() << "), " << bytesWritten << " bytes written; CPU evaluator, one thread "
       << milliseconds(reference.milliseconds);
  if (!reference.result.complete) {
    text << ", which gave up";
  } else if (reference.milliseconds > 0) {
    char rate[32];
    std::snprintf(rate, sizeof rate, "%.1f",
                  static_cast<double>(reference.result.terminals) / reference.milliseconds / 1e3);
    text << " (" << rate << " million terminals a second)";
  }
  text << '\n';
  if (changes)
    text << "derived anew: " << changes->changed << " of " << changes->instances << " instances in "
         << milliseconds(changes->part.median()) << " instead of " << milliseconds(changes->whole.median())
         << " for all; all others are unchanged\n";
  if (options.budget)
    text << "detail " << camera->detail << ": " << reference.result.terminals << " of the " << options.budget
         << " terminals that --budget allows\n";
  for (const std::string& name : options.measures) {
    double sum = 0;
    for (const Json& axiom : measures) sum += axiom["sums"][name].get<double>();
    text << name << ": " << sum << " of all axioms\n";
  }
  if (!chosen.file.empty()) text << "kernel: " << chosen.file.string() << '\n';
  if (!options.image.empty()) text << "picture: " << options.image << '\n';
  if (!options.out.empty()) text << "triangles: " << options.out << '\n';
  outcome.text = text.str();
  if (!budgets.empty()) budgets.pop_back(); // the end of its line
  outcome.failure = budgets.empty() && exceeded ? "not all of it was derived" : budgets;
  outcome.json = {{"grammar", jsonOf(options.grammars)},
                  {"device", session.device().name()},
                  {"status", statusName(report.base.status)},
                  {"output", options.output},
                  {"schedule", chosen.name},
                  {"schedule_file", chosen.file.empty() ? Json() : Json(chosen.file.string())},
                  {"execution_groups", chosen.groups},
                  {"axioms", start.size()},
                  {"recordings", slices.recordings},
                  {"seed", options.seed},
                  {"terminals", report.terminals},
                  {"instances", instances.size()},
                  {"vertices", verticesWritten},
                  {"triangles", triangles.total},
                  {"buckets", bucketList},
                  {"rules", ruleList},
                  {"rounds", report.rounds},
                  {"peak_shapes", report.peakShapes},
                  {"max_shapes", deriver.maxShapes()},
                  {"max_rounds", deriver.maxRounds()},
                  {"dropped_shapes", report.droppedShapes},
                  {"unfinished_shapes", report.unfinishedShapes},
                  {"colliders", report.colliders},
                  {"budget_exceeded", exceeded},
                  {"key_hash", hash},
                  {"bytes_written", bytesWritten},
                  {"gpu_ms_median", times.median()},
                  {"passes", passes},
                  {"cpu_reference_terminals", reference.result.terminals},
                  {"cpu_reference_ms", reference.result.complete ? Json(reference.milliseconds) : Json()},
                  {"changed", changes ? Json{{"instances", changes->changed},
                                             {"of", changes->instances},
                                             {"gpu_ms_median", changes->part.median()},
                                             {"gpu_ms_median_of_all", changes->whole.median()}}
                                      : Json()},
                  {"measures", measures},
                  {"detail", camera ? Json(camera->detail > 0 ? camera->detail : 1) : Json()},
                  {"image", options.image.empty() ? Json() : Json(options.image)},
                  {"out", options.out.empty() ? Json() : Json(options.out)}};
  return outcome;
}

} // namespace

Work addSpawn(CLI::App& app) {
  auto options = std::make_shared<SpawnOptions>();
  addSpawnOptions(*app.add_subcommand("spawn", "Derive a grammar on the GPU and report the result"), *options);
  return [options](const CommonOptions& common) { return spawn(*options, common); };
}

} // namespace gpgp::cli
