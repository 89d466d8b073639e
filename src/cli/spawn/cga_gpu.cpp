// .cga files on the GPU: derives by the program's operator graph, and makes of instances what the CPU makes of leaves.
#include "cli/shared/messages.h"
#include "cli/spawn/axioms.h"
#include "cli/spawn/cga.h"
#include "cli/spawn/reference.h"
#include "cli/spawn/unit_shapes.h"
#include "cli/tune/deriver.h"
#include "spawn/cga/compile.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>

namespace gpgp::cli {

namespace {
using namespace spawn::cga;

/// What an instance draws: vertices in the unit box around the origin.
struct Template {
  std::vector<Vertex> vertices;
  std::vector<uint32_t> indices;
};

/// Of an asset or a round primitive, by the CPU, in a scope of one metre.
Template templateOf(const std::string& asset, const Program& program, const spawn::cga::DeriveOptions& derive) {
  const bool isPrimitive = asset.starts_with("primitive") && asset.ends_with(")");
  std::string quoted;
  for (const char c : asset) quoted += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  const bool isBare = asset == "primitiveCylinder" || asset == "primitiveCone" || asset == "primitiveSphere";
  const std::string text = "Lot --> s(1, 1, 1) " + (isPrimitive ? asset
                                                    : isBare    ? asset + "()"
                                                                : "i(\"" + quoted + "\")");
  Messages messages;
  CompileOptions compile{program.folder + "asset.cga", {}, {}, filesOnDisk(), false, {}};
  const auto made = spawn::cga::compile(text, compile, messages);
  Template result;
  if (!made) return result;
  Axiom axiom;
  axiom.origin = glm::vec3(-0.5f);
  spawn::cga::DeriveOptions options = derive;
  options.keepTriangles = true;
  options.attributes.clear();
  spawn::cga::Derivation one = spawn::cga::derive(*made, {axiom}, options, messages);
  for (const Messages::Message& m : messages.sorted())
    std::fprintf(stderr, "%s\n", printable(spawn::format(m.diagnostic, m.file)).c_str());
  return {std::move(one.vertices), std::move(one.indices)};
}

Template templateOf(uint32_t shape) {
  Template result;
  const UnitShape unit = unitShape(shape);
  for (const auto& vertex : unit.vertices) result.vertices.push_back({vertex.position, vertex.normal, vertex.uv});
  for (const auto& triangle : unit.triangles)
    result.indices.insert(result.indices.end(), triangle.begin(), triangle.end());
  return result;
}

/// Leaves of instances, with their triangles.
class Leaves {
public:
  Leaves(const Program& program, const spawn::cga::DeriveOptions& derive) : program_(program), derive_(derive) {
    all.names.push_back({});
  }
  void add(const GpgpInstance& instance) {
    const GraphTerminal& terminal = program_.graph.terminals.at(instance.terminal);
    if (terminal.isReport) {
      const double value = static_cast<double>(instance.attribute);
      Report& report = all.reports[terminal.name];
      report.least = report.count ? std::min(report.least, value) : value;
      report.most = report.count ? std::max(report.most, value) : value;
      report.sum += value;
      ++report.count;
      return;
    }
    Leaf leaf;
    leaf.name = nameOf(terminal.name);
    leaf.texture = nameOf(terminal.texture);
    leaf.axiom = instance.axiomId;
    leaf.color = terminal.color;
    leaf.firstIndex = static_cast<uint32_t>(all.indices.size());
    const Template& shape = shapeOf(terminal, instance.shape);
    all.triangles += shape.indices.size() / 3;
    if (derive_.keepTriangles) {
      const bool mirrored = isMirrored(instance);
      const uint32_t first = static_cast<uint32_t>(all.vertices.size());
      const float* t = instance.transform;
      const glm::vec3 x(t[0], t[4], t[8]), y(t[1], t[5], t[9]), z(t[2], t[6], t[10]);
      const glm::vec3 nx = glm::cross(y, z), ny = glm::cross(z, x), nz = glm::cross(x, y); // of normals
      for (const Vertex& v : shape.vertices) {
        const glm::vec3 n = nx * v.normal.x + ny * v.normal.y + nz * v.normal.z;
        all.vertices.push_back({placed(instance, v.position), glm::length(n) > 0 ? glm::normalize(n) : v.normal, v.uv});
      }
      for (size_t i = 0; i + 2 < shape.indices.size(); i += 3) {
        const uint32_t a = shape.indices[i], b = shape.indices[i + 1], c = shape.indices[i + 2];
        for (const uint32_t index : {a, mirrored ? c : b, mirrored ? b : c}) all.indices.push_back(first + index);
      }
      leaf.indexCount = static_cast<uint32_t>(all.indices.size()) - leaf.firstIndex;
    }
    all.leaves.push_back(leaf);
  }

  spawn::cga::Derivation all;

private:
  uint32_t nameOf(const std::string& name) {
    if (name.empty()) return 0;
    const auto [found, isNew] = names_.try_emplace(name, static_cast<uint32_t>(all.names.size()));
    if (isNew) all.names.push_back(name);
    return found->second;
  }
  const Template& shapeOf(const GraphTerminal& terminal, uint32_t shape) {
    const std::string key = terminal.asset.empty() ? std::to_string(shape) : "asset " + terminal.asset;
    const auto [found, isNew] = templates_.try_emplace(key);
    if (isNew)
      found->second = terminal.asset.empty() ? templateOf(shape) : templateOf(terminal.asset, program_, derive_);
    return found->second;
  }
  const Program& program_;
  const spawn::cga::DeriveOptions& derive_;
  std::map<std::string, uint32_t> names_;
  std::map<std::string, Template> templates_;
};

} // namespace

GpgpAxiom graphAxiom(const Axiom& axiom, uint32_t id) {
  GpgpAxiom result{};
  const glm::vec3 middle = axiom.origin + (axiom.axisX * axiom.size.x + axiom.axisZ * axiom.size.z) * 0.5f;
  const glm::vec3 columns[4] = {axiom.axisX, axiom.axisY, axiom.axisZ, middle};
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) result.transform[4 * row + column] = columns[column][row];
  result.size[0] = axiom.size.x;
  result.size[2] = axiom.size.z;
  result.seed = axiom.seed;
  result.id = id;
  result.start = GPGP_AXIOM_DEFAULT_START;
  result.attribute = std::numeric_limits<float>::quiet_NaN();
  return result;
}

std::optional<GpuDerivation> deriveOnGpu(const CgaOptions& options, const CommonOptions& common, const Program& program,
                                         const std::vector<Axiom>& axioms, const spawn::cga::DeriveOptions& derive,
                                         WorldFields& fields) {
  const BakedGraph grammar = bakeText(options.file, program.graph.text);
  std::vector<GpgpAxiom> start;
  for (const Axiom& axiom : axioms) start.push_back(graphAxiom(axiom, static_cast<uint32_t>(start.size())));
  // The CPU evaluator of graphs, with as deep rules as there are.
  fields.bind(grammar.graph);
  const World world{nullptr, &fields.bound()};
  const std::optional<uint32_t> depth = depthOf(grammar.words, start, world);
  if (!depth) return std::nullopt;
  const Reference reference = evaluate(grammar.words, start, std::max(*depth, 64u), nullptr, options.file, world);
  CommonOptions chosen = common;
  if (chosen.device == "gpu") chosen.device.clear(); // whichever is the default
  Session session(chosen);
  std::pmr::vector<uint32_t> kernel;
  GpuDerivation result;
  result.schedule = "interpreter";
  if (options.schedule == "default" && !session.device().isSoftware()) { // there it takes longer than it saves
    const spawn::KernelTarget target = targetFor(session.device(), grammar.graph);
    const auto schedule = scheduleFor(grammar.graph, options.schedule, {});
    const auto code = compileOrSay(grammar.graph, *schedule, std::span(&target, 1), false, options.file);
    if (!code[0].empty()) {
      kernel = kernelWords(grammar, kernelInfo(*schedule, target), code[0]);
      result.schedule = schedule->name;
    }
  }
  const uint64_t most = Deriver::mostAxioms(session);
  const auto slice = [&](size_t first) {
    return std::vector<GpgpAxiom>(start.begin() + static_cast<ptrdiff_t>(first),
                                  start.begin() + static_cast<ptrdiff_t>(std::min<size_t>(start.size(), first + most)));
  };
  DeriverOptions deriverOptions;
  deriverOptions.maxDepth = std::max(*depth, 64u);
  deriverOptions.expected = reference.result.terminals;
  fields.give(deriverOptions);
  deriverOptions.kernelsOnly = !kernel.empty();
  Deriver deriver(session, grammar, slice(0), deriverOptions);
  const Grammar prepared = deriver.prepare(kernel);
  Leaves leaves(program, derive);
  GpgpSpawnReport sum = GPGP_SPAWN_REPORT_INIT;
  std::vector<GpgpInstance> instances;
  for (size_t first = 0; first < start.size(); first += most) {
    if (first) deriver.setAxioms(slice(first));
    deriver.fit(prepared);
    const auto measured = deriver.measure(prepared, options.repeat);
    result.milliseconds += measured.times.median();
    result.rounds = std::max(result.rounds, measured.report.rounds);
    sum.terminals += measured.report.terminals;
    for (size_t word = 0; word < std::size(sum.keyHash); ++word) sum.keyHash[word] += measured.report.keyHash[word];
    const std::vector<GpgpInstance> written = deriver.instances();
    instances.insert(instances.end(), written.begin(), written.end());
    if (measured.report.droppedShapes || written.size() < measured.report.terminals)
      result.failure = "budget exceeded: not all of it was derived on " + session.device().name() +
                       "; --device cpu derives it on the CPU";
  }
  session.checkValidation();
  result.device = session.device().name();
  result.instances = instances.size();
  if (result.failure.empty())
    if (const std::string what = difference(reference.result, sum, instances); !what.empty())
      throw Failure(options.file + ": the device derived something else than the CPU evaluator: " + what +
                    "; please report this");
  // In the same order whatever the device did first.
  std::sort(instances.begin(), instances.end(), [](const GpgpInstance& a, const GpgpInstance& b) {
    return std::tie(a.axiomId, a.key[0], a.key[1]) < std::tie(b.axiomId, b.key[0], b.key[1]);
  });
  for (const GpgpInstance& instance : instances) leaves.add(instance);
  result.all = std::move(leaves.all);
  result.all.shapes = reference.result.shapes;
  result.all.depth = reference.result.depth;
  return result;
}

} // namespace gpgp::cli
