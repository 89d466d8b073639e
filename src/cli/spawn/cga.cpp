#include "cli/spawn/cga.h"

#include "cli/shared/command.h"
#include "cli/shared/messages.h"
#include "cli/spawn/asset_names.h"
#include "cli/spawn/cga_source.h"
#include "host/files.h"
#include "spawn/cga/attributes.h"
#include "spawn/cga/compile.h"

#ifdef GPGP_WITH_VISIBILITY
#include "cli/model/model.h"
#endif

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <numeric>
#include <sstream>

namespace gpgp::cli {

namespace {

using namespace spawn::cga;

bool loadAsset(const std::string& path, spawn::cga::Asset& asset, std::string& why) {
#ifdef GPGP_WITH_VISIBILITY
  try {
    for (const glm::vec3& corner : worldCorners(loadModel(path))) {
      asset.indices.push_back(static_cast<uint32_t>(asset.positions.size()));
      asset.positions.push_back(corner);
    }
    AssetNames names = assetNames(path);
    asset.groups = std::move(names.groups);
    asset.materials = std::move(names.materials);
    return true;
  } catch (const std::exception& error) {
    why = error.what();
    return false;
  }
#else
  (void)path;
  (void)asset;
  why = "this build reads no models";
  return false;
#endif
}

/// Both of one program's strings and others.
void join(Derivation& all, Derivation&& part) {
  if (all.names.empty()) {
    all = std::move(part);
    return;
  }
  std::vector<uint32_t> places(part.names.size(), 0); // 0 stays empty
  if (!places.empty()) std::iota(places.begin() + 1, places.end(), static_cast<uint32_t>(all.names.size()) + 1);
  all.names.insert(all.names.end(), part.names.begin(), part.names.end());
  append(all, std::move(part), places);
}

void paint(const CgaOptions& options, const Derivation& derivation) {
  std::vector<std::array<glm::vec3, 3>> triangles;
  std::vector<glm::vec3> colours;
  for (const Leaf& leaf : derivation.leaves) {
    if (leaf.color.w <= 0.01f) continue;
    for (uint32_t i = 0; i < leaf.indexCount; i += 3) {
      const auto at = [&](uint32_t k) {
        return derivation.vertices[derivation.indices[leaf.firstIndex + i + k]].position;
      };
      triangles.push_back({at(0), at(1), at(2)});
      colours.push_back(glm::vec3(leaf.color));
    }
  }
  paintScene(options.image, options.view, triangles, [&](size_t i) { return colours[i]; });
}

} // namespace

namespace {
/// The fields of the command, for the CPU.
std::vector<WorldField> fieldsOf(const WorldFields& given, const Program& program) {
  std::vector<WorldField> fields;
  for (const GpgpSpawnField& field : given.all()) {
    const auto grid = spawn::fieldGrid(field, {given.all().data(), static_cast<uint32_t>(given.all().size())});
    if (!grid) throw Usage(std::string("--field: ") + grid.error().text);
    fields.push_back({field.name, *grid, field.grid.values});
  }
  if (const std::string missing = missingField(program, fields); !missing.empty())
    throw Usage(missing + "; --field NAME=FILE.png gives it");
  for (const WorldField& field : fields) {
    const bool isRead = std::any_of(program.fields.begin(), program.fields.end(),
                                    [&](const FieldRead& read) { return read.name == field.name; });
    const bool isAttribute =
        std::any_of(program.attributes.begin(), program.attributes.end(),
                    [&](const AttributeInfo& a) { return a.name == field.name && !a.isConstant && !a.isMaterial; });
    if (!isRead && !isAttribute)
      std::fprintf(stderr, "warning: --field %s: nothing reads this field, and no attr has its name\n",
                   printable(field.name).c_str());
  }
  return fields;
}

/// Why these axioms cannot be the graph's; empty: they can.
std::string whyNot(const CgaAxioms& start, const Program& program, const DeriveOptions& derive) {
  if (program.graph.text.empty()) return misfit(program.graph);
  const auto isSet = [&](const std::string& name) {
    return std::any_of(derive.attributes.begin(), derive.attributes.end(),
                       [&](const AttributeValue& value) { return value.name == name; });
  };
  for (const WorldField& field : derive.fields)
    for (const AttributeInfo& attribute : program.attributes)
      if (attribute.name == field.name && !attribute.isConstant && !isSet(field.name))
        return "'" + field.name + "', an attr that has its value from a field, derives on the CPU";
  for (size_t i = 0; i < start.axioms.size(); ++i) {
    const Axiom& axiom = start.axioms[i];
    const std::string where = axiom.where.empty() ? std::string() : axiom.where + ": ";
    if (!axiom.points.empty()) return where + "an axiom that is a polygon and no rectangle derives on the CPU";
    for (const AttributeValue& value : axiom.attributes)
      for (const AttributeInfo& attribute : program.attributes)
        if (attribute.name == value.name && !attribute.isConstant)
          return where + "an axiom with a value of its own for '" + value.name + "' derives on the CPU";
    if (!axiom.streetWidths.empty()) return where + "an axiom with streets derives on the CPU";
    if (!start.rules[i].empty() && start.rules[i] != start.rules[0])
      return where + "axioms that start at several rules derive on the CPU";
    if (program.graph.needsUpright && axiom.axisY != glm::vec3(0, 1, 0))
      return where + "an axiom that does not stand upright derives on the CPU, as the program uses world axes";
  }
  return {};
}
} // namespace

Outcome spawnCga(const CgaOptions& options, const CommonOptions& common) {
  const bool isCpu = common.device == "cpu", isGpu = !isCpu && !common.device.empty();
  const std::string text = host::readText(options.file);
  DeriveOptions derive;
  derive.attributes = attributeValues(options.attributes);
  derive.loadAsset = loadAsset;
  derive.keepTriangles = !options.image.empty() || !options.out.empty();
  if (options.maxDepth) derive.maxDepth = options.maxDepth;
  if (options.maxShapes) derive.maxShapes = options.maxShapes;
  if (options.maxFaces) derive.maxFaces = options.maxFaces;
  if (options.maxVertices) derive.maxVertices = options.maxVertices;
  if (options.maxGeometry) derive.maxGeometryMiB = options.maxGeometry;
  if (options.maxWork) derive.maxWork = uint64_t{options.maxWork} * 1'000'000;

  CompileOptions compile{options.file, options.start, options.style, filesOnDisk(), !isCpu, derive.attributes};
  Messages compiled;
  std::optional<Program> program = spawn::cga::compile(text, compile, compiled);
  const std::optional<ErrorsShown> wrong = print(compiled);
  if (!program) throw wrong.value();
  checkAttributes(derive.attributes, *program);
  if (options.listsAttributes) {
    Outcome listed;
    listed.text = attributesText(*program);
    listed.json = {{"grammar", options.file},
                   {"start", program->rules[program->start].name},
                   {"attributes", attributesOf(*program)}};
    return listed;
  }
  WorldFields fields(options.fields);
  derive.fields = fieldsOf(fields, *program);
  std::vector<std::string> names;
  for (const RuleInfo& rule : program->rules)
    if (rule.parameters == 0) names.push_back(rule.name);
  const CgaAxioms start = cgaAxioms(options, names);
  derive.origin = start.origin;

  std::optional<Program> firstRule;
  if (!start.rules.empty() && !start.rules[0].empty() && !isCpu) {
    Messages same; // as above
    CompileOptions first = compile;
    first.start = start.rules[0];
    firstRule = spawn::cga::compile(text, first, same);
  }
  const Program& graphed = firstRule ? *firstRule : *program;
  std::string why = isCpu ? "--device cpu" : whyNot(start, graphed, derive);
  if (why.empty() && (options.maxDepth || options.maxShapes || options.maxFaces || options.maxVertices ||
                      options.maxGeometry || options.maxWork))
    why = "--max-depth, --max-shapes, --max-faces, --max-vertices, --max-geometry and --max-work are for the CPU";
  std::optional<GpuDerivation> gpu;
  if (why.empty()) gpu = deriveOnGpu(options, common, graphed, start.axioms, derive, fields);
  if (why.empty() && !gpu) why = options.file + ": rules nest in themselves without end, or too deep for the GPU";
  if (isGpu && !gpu) throw Failure(why + "; without --device it derives on the CPU");
  const bool onGpu = gpu.has_value();
  if (!onGpu && (options.repeat > 1 || options.schedule != "default"))
    throw Usage("--repeat and --schedule are for what derives on the GPU; " + why);

  // Axioms of one rule after the other; each rule has a program, for which attributes it needs.
  struct OfRule {
    std::vector<Axiom> axioms;
    std::optional<Program> own;
  };
  std::map<std::string, OfRule> byRule;
  for (size_t i = 0; i < start.axioms.size() && !onGpu; ++i) byRule[start.rules[i]].axioms.push_back(start.axioms[i]);
  for (auto& [rule, part] : byRule) {
    if (rule.empty()) continue;
    Messages same; // as above
    compile.start = rule;
    part.own = spawn::cga::compile(text, compile, same);
  }
  Derivation all;
  Messages messages;
  const auto begin = std::chrono::steady_clock::now();
  spawn::cga::Surroundings surroundings;
  if (program->asksAround && byRule.size() > 1) { // axioms see those of other rules as well
    for (const auto& [rule, part] : byRule) {
      spawn::cga::addSurroundings(part.own ? *part.own : *program, part.axioms, derive, surroundings);
      derive.firstAxiom += static_cast<uint32_t>(part.axioms.size());
    }
    surroundings.build();
    derive.surroundings = &surroundings;
    derive.firstAxiom = 0;
  }
  for (const auto& [rule, part] : byRule) {
    join(all, spawn::cga::derive(part.own ? *part.own : *program, part.axioms, derive, messages));
    derive.firstAxiom += static_cast<uint32_t>(part.axioms.size());
  }
  double milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  const std::optional<ErrorsShown> wrongLater = print(messages);
  if (gpu) {
    all = std::move(gpu->all);
    milliseconds = gpu->milliseconds;
  }
  if (!options.image.empty()) paint(options, all);
  if (!options.out.empty()) writeGlb(options.out, all);

  std::map<std::string, std::pair<uint64_t, uint64_t>> rules; // shapes, and triangles where they are kept
  for (const Leaf& leaf : all.leaves) {
    auto& [shapes, triangles] = rules[all.names[leaf.name]];
    ++shapes;
    triangles += leaf.indexCount / 3;
  }
  Outcome outcome;
  if (gpu) {
    outcome.failure = gpu->failure;
  } else if (wrongLater) {
    outcome.failure = wrongLater->what();
    outcome.errorsShown = wrongLater->count;
  }
  std::ostringstream said;
  said << all.leaves.size() << " terminals (" << all.triangles << " triangles) from " << start.axioms.size()
       << (start.axioms.size() == 1 ? " axiom" : " axioms");
  if (gpu)
    said << " in " << gpu->rounds << " rounds on " << gpu->device << "; schedule " << gpu->schedule << ", "
         << milliseconds << " ms\n";
  else
    said << ", " << all.shapes << " shapes in " << all.depth + 1 << " generations on the CPU, " << milliseconds
         << " ms\n";
  if (!onGpu && !isCpu) said << "on the CPU: " << printable(why) << '\n';
  Json ruleList = Json::array(), reports = Json::object(), statistics = Json::object(), prints = Json::array();
  for (const auto& [name, counts] : rules) {
    said << "  " << counts.first << "  " << printable(name) << '\n';
    Json rule{{"rule", printable(name)}, {"instances", counts.first}};
    if (derive.keepTriangles) rule["triangles"] = counts.second;
    ruleList.push_back(rule);
  }
  for (const auto& [name, report] : all.reports) {
    said << "  report " << printable(name) << ": " << report.sum << " (" << report.count << " times)\n";
    reports[printable(name)] = report.sum;
    statistics[printable(name)] = {
        {"count", report.count}, {"sum", report.sum}, {"min", report.least}, {"max", report.most}};
  }
  for (const std::string& print : all.prints) {
    said << "  print " << printable(print) << '\n';
    prints.push_back(printable(print));
  }
  if (all.printed > all.prints.size()) said << "  and " << all.printed - all.prints.size() << " more\n";
  if (!options.image.empty()) said << "picture: " << options.image << '\n';
  if (!options.out.empty()) said << "triangles: " << options.out << '\n';
  outcome.text = said.str();
  outcome.json = {{"grammar", options.file},
                  {"device", gpu ? Json(gpu->device) : Json()},
                  {"on_cpu_because", onGpu ? Json() : Json(printable(why))},
                  {"status", outcome.failure.empty() ? "GPGP_SUCCESS" : "GPGP_BUDGET_EXCEEDED"},
                  {"axioms", start.axioms.size()},
                  {"seed", options.seed},
                  {"start", program->rules[program->start].name},
                  {"terminals", all.leaves.size()},
                  {"vertices", all.vertices.size()},
                  {"triangles", all.triangles},
                  {"shapes", all.shapes},
                  {"depth", all.depth},
                  {"rules", ruleList},
                  {"reports", reports},
                  {"report_statistics", statistics},
                  {"prints", prints},
                  {"attributes", attributesOf(*program)},
                  {gpu ? "gpu_ms_median" : "cpu_ms", milliseconds},
                  {"image", options.image.empty() ? Json() : Json(options.image)},
                  {"out", options.out.empty() ? Json() : Json(options.out)}};
  return outcome;
}

} // namespace gpgp::cli
