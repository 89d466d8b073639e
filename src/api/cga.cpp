// The C functions of cga.h, in libgpgp_evaluator, which has no context: messages go to those who made the object.
#include "api/check_struct.h"
#include "api/standalone.h"
#include "spawn/cga/attributes.h"
#include "spawn/cga/compile.h"
#include "spawn/cga/derive.h"
#include "spawn/schedule/fields.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <deque>
#include <exception>
#include <memory>
#include <tuple>

using namespace gpgp;
using namespace gpgp::spawn::cga;
using namespace gpgp::api::standalone;
using api::checkStruct;
using core::makeError;
using core::Result;

namespace {

/// Who gets the messages of a call: with places, as those of compilers.
struct CompileReceiver {
  GpgpCompileMessageFn messageFn = nullptr;
  void* userData = nullptr;
  const char* name = "";

  void tell(const char*, const core::Error& error) const { tell(name, {{}, GPGP_SEVERITY_ERROR, error.text}); }
  void tell(const char* file, const spawn::Diagnostic& d) const {
    const GpgpCompileMessage message{file, d.place.line, d.place.column, d.severity, d.text.c_str(), d.omitted};
    if (messageFn) messageFn(userData, &message);
  }
  void tell(const Messages& messages) const {
    for (const Messages::Message& m : messages.sorted()) tell(m.file.c_str(), m.diagnostic);
  }
};

/// Texts whose addresses stay.
class Texts {
public:
  const char* keep(std::string text) { return all_.emplace_back(std::move(text)).c_str(); }
  const char* const* keep(const std::vector<std::string>& list) {
    auto& pointers = lists_.emplace_back();
    for (const std::string& text : list) pointers.push_back(keep(text));
    return pointers.data();
  }
  void clear() {
    all_.clear();
    lists_.clear();
  }

private:
  std::deque<std::string> all_;
  std::deque<std::vector<const char*>> lists_;
};

ReadFile filesOf(const GpgpFileSystem* system) {
  if (!system) return filesOnDisk();
  return [files = *system](const std::string& path, std::string& text) {
    size_t size = 0, read = 0;
    if (files.read(files.userData, path.c_str(), nullptr, 0, &size) != GPGP_SUCCESS) return false;
    text.resize(size);
    return files.read(files.userData, path.c_str(), text.data(), size, &read) == GPGP_SUCCESS && read == size;
  };
}

struct ProgramObject {
  static constexpr uint32_t kMagic = 0x63676170; // "cgap"
  explicit ProgramObject(const GpgpCgaProgramCreateInfo& info)
      : name(info.name), start(info.start ? info.start : ""), style(info.style ? info.style : ""),
        read(filesOf(info.fileSystem)),
        jobs(info.jobSystem ? *info.jobSystem : GpgpJobSystem{}), receiver{info.messageFn, info.messageUserData,
                                                                           name.c_str()} {}

  CompileOptions options() const { return {name, start, style, read, false, {}}; }

  uint32_t magic = kMagic;
  std::string name, text, start, style;
  ReadFile read;
  GpgpJobSystem jobs;
  CompileReceiver receiver;
  Program program;
  Texts texts, graphTexts;
  std::vector<GpgpCgaAttribute> attributes;
  GraphText graph;
  std::vector<GpgpCgaTerminal> terminals;
};

struct DerivationObject {
  static constexpr uint32_t kMagic = 0x63676164;
  explicit DerivationObject(ProgramObject& owner) : program(owner) {}

  uint32_t magic = kMagic;
  ProgramObject& program;
  Derivation derivation;
  bool isWhole = true;
  std::vector<GpgpCgaLeaf> leaves;
  std::vector<GpgpCgaReport> reports;
  std::vector<const char*> prints;
};

void listAttributes(ProgramObject& object) {
  for (const ListedAttribute& listed : listAttributes(object.program)) {
    const AttributeInfo& info = *listed.info;
    const AttributeDisplay& display = listed.display;
    Texts& texts = object.texts;
    GpgpCgaAttribute a{};
    a.name = texts.keep(info.name);
    a.type = typeOf(listed.value);
    a.flags = display.flags;
    a.text = texts.keep(listed.value.text);
    a.number = listed.value.number;
    a.min = display.min;
    a.max = display.max;
    a.step = display.step;
    a.choices = texts.keep(display.choices);
    a.choiceCount = static_cast<uint32_t>(display.choices.size());
    a.groups = texts.keep(display.groups);
    a.groupCount = static_cast<uint32_t>(display.groups.size());
    a.groupOrder = display.groupOrder;
    a.order = display.order;
    a.description = texts.keep(display.description);
    a.file = texts.keep(info.file);
    a.line = info.place.line;
    a.column = info.place.column;
    a.displayName = texts.keep(display.name);
    a.extensions = texts.keep(display.extensions);
    a.extensionCount = static_cast<uint32_t>(display.extensions.size());
    object.attributes.push_back(a);
  }
}

Result<void> compileProgram(const GpgpCgaProgramCreateInfo& info, ProgramObject& object) {
  if (info.text)
    object.text.assign(info.text, info.size);
  else if (!object.read(object.name, object.text))
    return makeError(GPGP_ERROR_IO, "%s cannot be read", info.name);
  Messages messages;
  std::optional<Program> made = compile(object.text, object.options(), messages);
  if (made) {
    object.program = std::move(*made);
    listAttributes(object);
  }
  object.receiver.tell(messages);
  core::Error told; // the messages were
  told.code = GPGP_ERROR_INVALID_DATA;
  if (!made) return told;
  return {};
}

/// The values of attributes; wrong ones are errors.
Result<void> take(const GpgpCgaValue* values, uint32_t count, const Program& program,
                  std::vector<AttributeValue>& taken) {
  if (count && !values) return invalid("values is NULL, valueCount is not 0");
  for (uint32_t i = 0; i < count; ++i) {
    if (!values[i].name || !values[i].text)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "values[%u] has no name or no text", i);
    taken.push_back({values[i].name, values[i].text});
    if (const std::string why = whyNotSet(taken.back(), program); !why.empty())
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "values[%u] \"%s\"%s", i, values[i].name, why.c_str());
  }
  return {};
}

/// "/edgeattr/NAME" of a lot: a value for each edge, with semicolons behind them.
constexpr std::string_view kEdgeAttribute = "/edgeattr/";
EdgeAttribute edgeAttributeOf(const GpgpCgaValue& value) {
  EdgeAttribute attribute{std::string(value.name).substr(kEdgeAttribute.size()), {}, false};
  const std::string text = value.text;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find(';', begin), text.size());
    attribute.values.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  for (const std::string& one : attribute.values)
    attribute.isString = attribute.isString || !(numberIn(one) || one == "true" || one == "false" || one.empty());
  return attribute;
}

/// The values of a lot: of its attributes, and of its edges.
Result<void> takeValues(const GpgpCgaLot& lot, const Program& program, Axiom& axiom) {
  if (lot.valueCount && !lot.values) return invalid("values is NULL, valueCount is not 0");
  for (uint32_t i = 0; i < lot.valueCount; ++i) {
    const GpgpCgaValue& value = lot.values[i];
    if (value.name && value.text && std::string_view(value.name).starts_with(kEdgeAttribute)) {
      axiom.edgeAttributes.push_back(edgeAttributeOf(value));
      continue;
    }
    if (auto ok = take(&value, 1, program, axiom.attributes); !ok) {
      const std::string text = ok.error().text; // of values[0]
      return makeError(ok.error().code, "values[%u]%s", i,
                       text.substr(std::min(text.find(']') + 1, text.size())).c_str());
    }
  }
  return {};
}

/// A transform that moves and turns, nothing else.
bool isRigid(const glm::mat3& axes, const glm::vec3& middle) {
  constexpr float kTolerance = 1e-3f;
  const glm::mat3 product = glm::transpose(axes) * axes;
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row)
      if (!(std::abs(product[column][row] - (column == row ? 1.0f : 0.0f)) <= kTolerance)) return false;
  return glm::determinant(axes) > 0 && std::isfinite(middle.x + middle.y + middle.z);
}

Result<void> takeRectangle(const GpgpAxiom& from, uint32_t i, Axiom& axiom) {
  glm::mat3 axes;
  glm::vec3 middle;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) axes[column][row] = from.transform[4 * row + column];
    middle[row] = from.transform[4 * row + 3];
  }
  if (!isRigid(axes, middle))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "lots[%u].axiom.transform does more than move and turn", i);
  axiom.size = {from.size[0], from.size[1], from.size[2]};
  if (!(axiom.size.x > 0 && axiom.size.y >= 0 && axiom.size.z > 0 &&
        std::isfinite(axiom.size.x + axiom.size.y + axiom.size.z)))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "lots[%u].axiom.size: x and z must be above 0, y at least 0", i);
  axiom.axisX = axes[0];
  axiom.axisY = axes[1];
  axiom.axisZ = axes[2];
  axiom.origin = middle - axes * (0.5f * axiom.size);
  return {};
}

Result<void> takePolygon(const GpgpCgaLot& lot, uint32_t i, Axiom& axiom) {
  if (!lot.points || !lot.loopSizes)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "lots[%u] has loops, but points or loopSizes is NULL", i);
  axiom.loopSizes.assign(lot.loopSizes, lot.loopSizes + lot.loopCount);
  uint64_t count = 0;
  for (const uint32_t size : axiom.loopSizes) {
    if (size < 3) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "lots[%u].loopSizes has a loop of %u points", i, size);
    count += size;
  }
  for (uint64_t p = 0; p < count; ++p) {
    const float* point = lot.points[p];
    if (!std::isfinite(point[0] + point[1] + point[2]))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "lots[%u].points[%llu] is not finite", i,
                       static_cast<unsigned long long>(p));
    axiom.points.emplace_back(point[0], point[1], point[2]);
  }
  if (lot.streetWidths) axiom.streetWidths.assign(lot.streetWidths, lot.streetWidths + count);
  return {};
}

Result<void> takeLots(const GpgpCgaDerivationInfo& info, const Program& program, std::vector<Axiom>& axioms) {
  for (uint32_t i = 0; i < info.lotCount; ++i) {
    const GpgpCgaLot& lot = info.lots[i];
    Axiom axiom;
    axiom.where = axiom.name = "lot " + std::to_string(i);
    axiom.seed = lot.axiom.seed;
    if (lot.axiom.start != GPGP_AXIOM_DEFAULT_START)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "lots[%u].axiom.start must be GPGP_AXIOM_DEFAULT_START", i);
    if (auto ok = lot.loopCount ? takePolygon(lot, i, axiom) : takeRectangle(lot.axiom, i, axiom); !ok) return ok;
    if (auto ok = takeValues(lot, program, axiom); !ok)
      return makeError(ok.error().code, "lots[%u].%s", i, ok.error().text);
    axioms.push_back(std::move(axiom));
  }
  return {};
}

bool loadAsset(const GpgpCgaDerivationInfo& info, const std::string& path, Asset& asset, std::string& why) {
  GpgpCgaAsset from{};
  const GpgpResult result = info.loadAsset(info.loadAssetUserData, path.c_str(), &from);
  if (result < 0 || from.indexCount == 0) {
    why = result < 0 ? gpgpResultString(result) : "there is no such asset";
    return false;
  }
  for (uint32_t i = 0; i < from.indexCount; ++i)
    if (from.indexCount % 3 || !from.indices || !from.positions || from.indices[i] >= from.positionCount) {
      why = "its indices are no triangles of its positions";
      return false;
    }
  asset.indices.assign(from.indices, from.indices + from.indexCount);
  for (uint32_t i = 0; i < from.positionCount; ++i)
    asset.positions.emplace_back(from.positions[i][0], from.positions[i][1], from.positions[i][2]);
  for (uint32_t i = 0; i < from.groupCount && from.groups; ++i) asset.groups.emplace_back(from.groups[i]);
  for (uint32_t i = 0; i < from.materialCount && from.materials; ++i) asset.materials.emplace_back(from.materials[i]);
  return true;
}

/// The fields of the world, of which the program's must be among them.
Result<void> takeFields(const GpgpCgaDerivationInfo& info, const Program& program, std::vector<WorldField>& fields) {
  if (info.fieldCount && !info.fields) return invalid("fields is NULL, fieldCount is not 0");
  const spawn::FieldSource source{info.fields, info.fieldCount};
  for (uint32_t i = 0; i < info.fieldCount; ++i) {
    if (!info.fields[i].name) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "fields[%u].name is NULL", i);
    const Result<shader::FieldGrid> grid = spawn::fieldGrid(info.fields[i], source);
    if (!grid) return grid.error();
    fields.push_back({info.fields[i].name, *grid, info.fields[i].grid.values});
  }
  const std::string missing = missingField(program, fields);
  if (!missing.empty()) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "%s", missing.c_str());
  return {};
}

DeriveOptions optionsOf(const GpgpCgaDerivationInfo& info, const GpgpJobSystem& jobs) {
  DeriveOptions options;
  const auto limit = [](auto& option, auto value) {
    if (value) option = value;
  };
  limit(options.maxDepth, info.maxDepth);
  limit(options.maxShapes, uint64_t{info.maxShapes});
  limit(options.maxFaces, info.maxFaces);
  limit(options.maxVertices, info.maxVertices);
  limit(options.maxGeometryMiB, info.maxGeometryMiB);
  limit(options.maxWork, uint64_t{info.maxWork} * 1'000'000);
  options.threads = 1;
  options.assetsAreFiles = false;
  options.keepTriangles = !(info.flags & GPGP_CGA_DERIVATION_COUNT_ONLY);
  if (info.flags & GPGP_CGA_DERIVATION_GEOGRAPHIC) options.origin = GeographicPlace{info.longitude, info.latitude};
  if (info.loadAsset)
    options.loadAsset = [&info](const std::string& path, Asset& asset, std::string& why) {
      return loadAsset(info, path, asset, why);
    };
  if (jobs.parallelFor)
    options.parallelFor = [&jobs](uint32_t count, const std::function<void()>& work) {
      struct Argument {
        const std::function<void()>& work;
        std::exception_ptr failed;
        std::atomic<bool> hasFailed{false};
      } argument{work, {}};
      const GpgpJobFn job = [](void* user, uint32_t) {
        auto& to = *static_cast<Argument*>(user);
        try {
          to.work();
        } catch (...) { // nothing is thrown into the engine's jobs
          if (!to.hasFailed.exchange(true)) to.failed = std::current_exception();
        }
      };
      jobs.parallelFor(jobs.userData, count, job, &argument);
      if (argument.failed) std::rethrow_exception(argument.failed);
    };
  return options;
}

void deliverResult(DerivationObject& object) {
  const Derivation& d = object.derivation;
  for (const Leaf& leaf : d.leaves) {
    const glm::vec4& c = leaf.color;
    object.leaves.push_back({d.names[leaf.name].c_str(),
                             d.names[leaf.texture].c_str(),
                             {c.r, c.g, c.b, c.a},
                             leaf.axiom,
                             leaf.firstIndex,
                             leaf.indexCount});
  }
  for (const auto& [name, report] : d.reports)
    object.reports.push_back({name.c_str(), report.count, report.sum, report.least, report.most});
  for (const std::string& print : d.prints) object.prints.push_back(print.c_str());
}

void empty(DerivationObject& object) {
  object.derivation = {};
  object.isWhole = true;
  object.leaves.clear();
  object.reports.clear();
  object.prints.clear();
}

template <class Object> void destroyObject(Object* object) {
  if (!object) return;
  object->magic = 0;
  delete object;
}

static_assert(sizeof(Vertex) == sizeof(GpgpCgaVertex) && offsetof(Vertex, normal) == offsetof(GpgpCgaVertex, normal) &&
              offsetof(Vertex, uv) == offsetof(GpgpCgaVertex, uv));

} // namespace

GpgpResult GPGP_CALL gpgpCreateCgaProgram(const GpgpCgaProgramCreateInfo* info, GpgpCgaProgram* program) {
  CompileReceiver to;
  if (info && info->sType == GPGP_STRUCTURE_CGA_PROGRAM_CREATE_INFO)
    to = {info->messageFn, info->messageUserData, info->name ? info->name : ""};
  return guarded("gpgpCreateCgaProgram", to, [&]() -> Result<void> {
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_CGA_PROGRAM_CREATE_INFO, "info"); !ok) return ok;
    if (!program) return invalid("program is NULL");
    if (!info->name) return invalid("name is NULL");
    if (!info->text && info->size) return invalid("text is NULL, size is not 0");
    if (info->fileSystem && !info->fileSystem->read) return invalid("fileSystem needs read");
    auto object = std::make_unique<ProgramObject>(*info);
    if (auto ok = compileProgram(*info, *object); !ok) return ok;
    *program = reinterpret_cast<GpgpCgaProgram>(object.release());
    return {};
  });
}

void GPGP_CALL gpgpDestroyCgaProgram(GpgpCgaProgram handle) { destroyObject(objectOf<ProgramObject>(handle)); }

GpgpResult GPGP_CALL gpgpGetCgaAttributes(GpgpCgaProgram handle, uint32_t* count, GpgpCgaAttribute* attributes) {
  const auto* object = objectOf<ProgramObject>(handle);
  return guarded("gpgpGetCgaAttributes", object ? object->receiver : CompileReceiver{}, [&]() -> Result<void> {
    if (!object) return notA("program", "a CGA program");
    return deliver(static_cast<uint32_t>(object->attributes.size()), count, attributes, "attributes",
                   [&](uint32_t i) { return object->attributes[i]; });
  });
}

GpgpResult GPGP_CALL gpgpGetCgaGraph(GpgpCgaProgram handle, const GpgpCgaValue* values, uint32_t valueCount,
                                     GpgpCgaGraph* graph) {
  auto* object = objectOf<ProgramObject>(handle);
  const CompileReceiver to = object ? object->receiver : CompileReceiver{};
  return guarded("gpgpGetCgaGraph", to, [&]() -> Result<void> {
    if (!object) return notA("program", "a CGA program");
    if (auto ok = checkStruct(graph, GPGP_STRUCTURE_CGA_GRAPH, "graph"); !ok) return ok;
    CompileOptions options = object->options();
    options.graph = true;
    if (auto ok = take(values, valueCount, object->program, options.attributes); !ok) return ok;
    Messages messages; // those of the program were told when it was made
    std::optional<Program> made = compile(object->text, options, messages);
    if (!made) return makeError(GPGP_ERROR_INVALID_DATA, "a file that the program imports has changed");
    if (made->graph.text.empty()) {
      const std::string why = made->graph.why + " has no operator on the GPU";
      to.tell(made->graph.file.c_str(), {made->graph.place, GPGP_SEVERITY_ERROR, why});
      core::Error told;
      told.code = GPGP_ERROR_UNSUPPORTED;
      return told;
    }
    object->graph = std::move(made->graph);
    object->graphTexts.clear();
    object->terminals.clear();
    for (const GraphTerminal& t : object->graph.terminals)
      object->terminals.push_back({object->graphTexts.keep(t.name),
                                   {t.color.r, t.color.g, t.color.b, t.color.a},
                                   object->graphTexts.keep(t.texture),
                                   object->graphTexts.keep(t.asset),
                                   t.isReport});
    graph->text = object->graph.text.c_str();
    graph->size = object->graph.text.size();
    graph->terminals = object->terminals.data();
    graph->terminalCount = static_cast<uint32_t>(object->terminals.size());
    graph->needsUpright = object->graph.needsUpright;
    return {};
  });
}

GpgpResult GPGP_CALL gpgpCreateCgaDerivation(GpgpCgaProgram handle, GpgpCgaDerivation* derivation) {
  auto* object = objectOf<ProgramObject>(handle);
  return guarded("gpgpCreateCgaDerivation", object ? object->receiver : CompileReceiver{}, [&]() -> Result<void> {
    if (!object) return notA("program", "a CGA program");
    if (!derivation) return invalid("derivation is NULL");
    *derivation = reinterpret_cast<GpgpCgaDerivation>(new DerivationObject(*object));
    return {};
  });
}

void GPGP_CALL gpgpDestroyCgaDerivation(GpgpCgaDerivation handle) { destroyObject(objectOf<DerivationObject>(handle)); }

GpgpResult GPGP_CALL gpgpDeriveCga(GpgpCgaDerivation handle, const GpgpCgaDerivationInfo* info) {
  auto* object = objectOf<DerivationObject>(handle);
  CompileReceiver to;
  if (object && info && info->sType == GPGP_STRUCTURE_CGA_DERIVATION_INFO)
    to = {info->messageFn, info->messageUserData, object->program.name.c_str()};
  return guarded("gpgpDeriveCga", to, [&]() -> Result<void> {
    if (!object) return notA("derivation", "a CGA derivation");
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_CGA_DERIVATION_INFO, "info"); !ok) return ok;
    if (info->lotCount && !info->lots) return invalid("lots is NULL, lotCount is not 0");
    if (info->flags & ~(GPGP_CGA_DERIVATION_COUNT_ONLY | GPGP_CGA_DERIVATION_GEOGRAPHIC))
      return invalid("flags has unknown bits");
    if ((info->flags & GPGP_CGA_DERIVATION_GEOGRAPHIC) &&
        !(std::abs(info->longitude) <= 360 && std::abs(info->latitude) < 90))
      return invalid("longitude is not within 360 degrees of 0, or latitude not within 90");
    const Program& program = object->program.program;
    DeriveOptions options = optionsOf(*info, object->program.jobs);
    if (auto ok = take(info->values, info->valueCount, program, options.attributes); !ok) return ok;
    if (auto ok = takeFields(*info, program, options.fields); !ok) return ok;
    std::vector<Axiom> axioms;
    if (auto ok = takeLots(*info, program, axioms); !ok) return ok;
    empty(*object);
    Messages messages;
    try {
      object->derivation = derive(program, axioms, options, messages);
      object->isWhole = !messages.hasErrors();
      deliverResult(*object);
    } catch (...) {
      empty(*object);
      throw;
    }
    to.tell(messages);
    return {};
  });
}

GpgpResult GPGP_CALL gpgpGetCgaDerivationResult(GpgpCgaDerivation handle, GpgpCgaDerivationResult* result) {
  auto* object = objectOf<DerivationObject>(handle);
  const CompileReceiver to = object ? object->program.receiver : CompileReceiver{};
  return guarded("gpgpGetCgaDerivationResult", to, [&]() -> Result<void> {
    if (!object) return notA("derivation", "a CGA derivation");
    if (auto ok = checkStruct(result, GPGP_STRUCTURE_CGA_DERIVATION_RESULT, "result"); !ok) return ok;
    const Derivation& d = object->derivation;
    result->status = object->isWhole ? GPGP_SUCCESS : GPGP_BUDGET_EXCEEDED;
    result->leaves = object->leaves.data();
    result->leafCount = static_cast<uint32_t>(object->leaves.size());
    result->vertices = reinterpret_cast<const GpgpCgaVertex*>(d.vertices.data());
    result->vertexCount = static_cast<uint32_t>(d.vertices.size());
    result->indices = d.indices.data();
    result->indexCount = static_cast<uint32_t>(d.indices.size());
    result->reports = object->reports.data();
    result->reportCount = static_cast<uint32_t>(object->reports.size());
    result->prints = object->prints.data();
    result->printCount = static_cast<uint32_t>(object->prints.size());
    result->printed = d.printed;
    result->shapes = d.shapes;
    result->triangles = d.triangles;
    result->depth = d.depth;
    return {};
  });
}
