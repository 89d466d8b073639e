#include "spawn/codegen/generate.h"

#include "spawn/codegen/code_text.h"
#include "spawn/codegen/queues.h"
#include "spawn/codegen/room.h"
#include "spawn/codegen/table.h"
#include "spawn/graph/matching.h"
#include "spawn/kernel/table_format.h"
#include "spawn/shared/operators.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace gpgp::spawn {
namespace {
using namespace shader;

class Generator {
public:
  Generator(const Graph& graph, const std::vector<bool>& waits, const Roots& roots, Queues queues)
      : graph_(graph), waits_(waits), stops_(waits), peers_(graph.nodes.size()), row_(graph.nodes.size()),
        group_(graph.nodes.size(), kNoGroup), table_(makeTable(graph, waits)) {
    uint64_t choices = 0;
    for (uint32_t n = 0; n < graph.nodes.size(); ++n) {
      peers_[n] = {n};
      if (table_.chooses[n]) choices += weightOf(graph, graph.nodes[n]);
    }
    if (choices > kRoom) table_ = makeTable(graph, waits, false);
    for (const Edge& edge : graph.edges)
      if (edge.recursive && edge.target != kNoNode) stops_[edge.target] = true;
    if (!roots.empty()) match(roots);
    for (const std::vector<uint32_t>& peers : peers_) first_.push_back(peers[0]);
    if (queues == Queues::groups) writeQueues(numberQueues(graph, stops_, first_));
  }

  KernelSource run() {
    if (graph_.phases) add("#define GPGP_COLLIDERS\n");
    if (!graph_.fields.empty()) add("#define GPGP_FIELDS\n");
    room_ = findRoom(graph_, waits_, first_, entered(), table_.chooses);
    uint32_t operators = 0;
    for (const Node& node : graph_.nodes) {
      if (node.op == kOpRaiseRoof || node.op == kOpToRoofFace) operators |= kHasRoofs;
      if (table_.family[indexOf(node)]) continue;
      const bool byWords = couldMultiply(node.op) &&
                           (room_.words || node.division == UINT32_MAX || isByWords(node) || stops_[indexOf(node)]);
      if (!multiplies(node) && !byWords) continue;
      operators |= 1u << node.op;
      if (isCutting(node)) operators |= kHasCuts;
      if (node.op == kOpSubDiv && node.division == UINT32_MAX) operators |= kHasDivisions;
      if (node.op == kOpCompSplit && node.shapes != 1u << kShapeBox) operators |= kHasSides;
    }
    add("#define GPGP_OPERATORS " + number(operators) + "\n#include \"spawn/shared/operators.h\"\n");
    writeParameters();
    add("#include \"spawn/shared/fans.h\"\n");
    if (room_.words) add("#include \"spawn/shared/chain.h\"\n");
    writeTable();
    std::vector<uint8_t> written(graph_.nodes.size());
    const std::string before = std::move(out_);
    out_.clear();
    for (uint32_t n = 0; n < graph_.nodes.size(); ++n) writeChain(n, written);
    writeRunChain();
    const auto counted =
        std::count_if(graph_.nodes.begin(), graph_.nodes.end(), [](const Node& n) { return n.op != kOpTerminal; });
    return {before + tables() + out_, std::move(table_.words), static_cast<uint32_t>(counted), room_.byWords};
  }

private:
  void add(const std::string& text) { out_ += text; }

  /// Each node's queue stands behind the table.
  void writeQueues(const QueueNumbers& queues) {
    add("#define GPGP_QUEUES " + number(queues.count) + "\n#define GPGP_QUEUE_TABLE " +
        number(static_cast<uint32_t>(table_.words.size())) + "\n");
    table_.words.insert(table_.words.end(), queues.ofNodes.begin(), queues.ofNodes.end());
    table_.words.resize((table_.words.size() + 3) / 4 * 4);
  }

  // ---------------------------------------------------------------- matched groups

  /// Groups with the same code share it; what differs lies in a table with a row for each of them.
  void match(const Roots& roots) {
    const Partition partition = makePartition(makeFlow(graph_), roots);
    const Matching matching = matchGroups(graph_, partition);
    for (uint32_t n = 0; n < graph_.nodes.size(); ++n) group_[n] = partition.groupOf[n];
    for (const GroupClass& all : matching.classes) {
      std::map<std::vector<uint32_t>, std::vector<uint32_t>> alike; // to groups
      for (const uint32_t g : all.members) alike[folded(partition.groups[g])].push_back(g);
      for (const auto& [key, members] : alike)
        for (size_t position = 0; position < partition.groups[members[0]].nodes.size(); ++position) {
          std::vector<uint32_t> peers;
          for (const uint32_t g : members) peers.push_back(partition.groups[g].nodes[position]);
          for (uint32_t row = 0; row < peers.size(); ++row) {
            peers_[peers[row]] = peers;
            row_[peers[row]] = row;
          }
        }
    }
  }
  /// What code has folded in beside its structure.
  std::vector<uint32_t> folded(const Group& group) const {
    std::vector<uint32_t> key;
    for (const uint32_t index : group.nodes) {
      const Node& node = graph_.nodes[index];
      if (node.op == kOpTerminal) continue;
      key.insert(key.end(), {node.argument, node.argument2, node.filter, node.division == UINT32_MAX, waits_[index],
                             node.op == kOpCompSplit && node.shapes == 1u << kShapeBox, isCutting(node)});
      for (uint32_t i = 0; node.filter && i < node.parameterCount; ++i)
        key.push_back(graph_.parameters[node.firstParameter + i].value);
      for (uint32_t e = 0; e < node.edgeCount; ++e) {
        const Edge& edge = edgeOf(node, e);
        const bool kept = edge.target != kNoNode;
        key.insert(key.end(),
                   {edge.recursive, kept && waits_[edge.target], kept && graph_.nodes[edge.target].op == kOpTerminal});
      }
    }
    return key;
  }
  uint32_t indexOf(const Node& node) const { return static_cast<uint32_t>(&node - graph_.nodes.data()); }
  const std::vector<uint32_t>& peersOf(const Node& node) const { return peers_[indexOf(node)]; }
  std::string chainOf(uint32_t node) const { return "chain" + std::to_string(peers_[node][0]); }
  /// A word that each of the node's peers has one of.
  template <class Value> std::string word(const Node& node, bool isFloat, const Value& value) {
    std::vector<uint32_t> words;
    for (const uint32_t peer : peersOf(node)) words.push_back(value(graph_.nodes[peer]));
    if (std::all_of(words.begin(), words.end(), [&](uint32_t w) { return w == words[0]; }))
      return isFloat ? literal(uintBitsToFloat(words[0])) : number(words[0]);
    const auto [at, isNew] = columns_.try_emplace(words, static_cast<uint32_t>(matched_.size()));
    if (isNew) matched_.insert(matched_.end(), words.begin(), words.end());
    const std::string text = "matchedWords[" + number(at->second) + " + row]";
    return isFloat ? "uintBitsToFloat(" + text + ")" : text;
  }
  std::string tables() const {
    const auto list = [](const char* name, const std::vector<uint32_t>& words) {
      std::string text = std::string("const uint ") + name + "[" + std::to_string(words.size()) + "] = uint[](";
      for (size_t i = 0; i < words.size(); ++i) text += (i % 16 ? ", " : i ? ",\n  " : "\n  ") + number(words[i]);
      return text + ");\n";
    };
    return matched_.empty() ? std::string() : list("matchedWords", matched_) + list("matchedRows", row_);
  }

  /// As nodes appear in Shape::node: their offset among the baked words.
  static uint32_t offsetOf(uint32_t node) { return kHeaderSize + node * kNodeSize; }
  const Edge& edgeOf(const Node& node, uint32_t index) const { return graph_.edges[node.firstEdge + index]; }

  // ---------------------------------------------------------------- parameters

  const Parameter& parameterOf(const Node& node, uint32_t index) const {
    return graph_.parameters[node.firstParameter + index];
  }
  std::string parameter(const Node& node, uint32_t index) {
    const Parameter& own = parameterOf(node, index);
    if (own.kind == kParameterConstant)
      return word(node, true, [&](const Node& peer) { return parameterOf(peer, index).value; });
    if (own.kind == kParameterAttribute) return attribute(own.value);
    std::vector<std::string> stack;
    uint32_t draws = index << kDrawsOfParameter;
    for (uint32_t at = 0; graph_.code[own.value + at] != kCodeEnd; ++at) {
      const uint32_t code = graph_.code[own.value + at];
      if (code == kCodeNumber) {
        ++at;
        stack.push_back(
            word(node, true, [&](const Node& peer) { return graph_.code[parameterOf(peer, index).value + at]; }));
      } else if (code >= kCodeAttributes) {
        stack.push_back(attribute(code));
      } else if (isField(code)) {
        const std::string z = std::move(stack.back());
        stack.pop_back();
        stack.back() = "readField(s, " + number(code - kCodeField) + ", " + stack.back() + ", " + z + ")";
      } else {
        const std::string b = std::move(stack.back());
        stack.pop_back();
        stack.back() = operation(code, stack.back(), b, draws);
        if (code == kCodeRandom) ++draws;
      }
    }
    return stack.back();
  }
  /// The same constant in all peers.
  bool isConstant(const Node& node, uint32_t index) const {
    const Parameter& own = parameterOf(node, index);
    return own.kind == kParameterConstant && std::all_of(peersOf(node).begin(), peersOf(node).end(), [&](uint32_t n) {
             return parameterOf(graph_.nodes[n], index).value == own.value;
           });
  }
  bool areConstant(const Node& node) const {
    for (uint32_t i = 0; i < node.parameterCount; ++i)
      if (!isConstant(node, i)) return false;
    return true;
  }
  float constant(const Node& node, uint32_t index) const { return uintBitsToFloat(parameterOf(node, index).value); }
  std::string vector(const Node& node) {
    return "vec3(" + parameter(node, 0) + ", " + parameter(node, 1) + ", " + parameter(node, 2) + ")";
  }
  std::string array(const Node& node) { // of RandomRule's probabilities
    std::string text = "float[" + std::to_string(node.edgeCount) + "](";
    for (uint32_t i = 0; i < node.edgeCount; ++i)
      text += (i ? ", max(0.0f, " : "max(0.0f, ") + parameter(node, i + 1) + ")";
    return text + ")";
  }

  /// parameter() of fans.h: constants from the words, the rest by expressions.
  void writeParameters() {
    if (room_.words) {
      add("float parameter(Shape s, uint index) {\n"
          "  return evaluate(s, graphWords[s.node + kNodeParameters] + index * kParameterSize, index);\n}\n");
      return;
    }
    add("float parameter(Shape s, uint index) {\n"
        "  const uint at = graphWords[s.node + kNodeParameters] + index * kParameterSize;\n"
        "  if (graphWords[at] == kParameterConstant) return uintBitsToFloat(graphWords[at + 1u]);\n  switch (at) {\n");
    const size_t first = kHeaderSize + graph_.nodes.size() * kNodeSize + graph_.edges.size() * kEdgeSize;
    const auto matched = std::exchange(peers_, {});
    for (uint32_t n = 0; n < graph_.nodes.size(); ++n) peers_.push_back({n}); // a case for each node
    for (const Node& node : graph_.nodes)
      for (uint32_t i = 0; couldMultiply(node.op) && i < node.parameterCount; ++i)
        if (parameterOf(node, i).kind != kParameterConstant)
          add("  case " + number(static_cast<uint32_t>(first + (node.firstParameter + i) * kParameterSize)) +
              ": return " + parameter(node, i) + ";\n");
    peers_ = matched;
    add("  default: return 0.0f;\n  }\n}\n");
  }

  // ---------------------------------------------------------------- by table

  void writeTable() {
    if (std::find(table_.family.begin(), table_.family.end(), true) == table_.family.end()) return;
    if (table_.repeats) add("#define GPGP_REPEATS\n");
    writeChoices();
    const bool programs = table_.programs.size() <= kMostPrograms;
    if (programs) add("#define GPGP_PROGRAMS\nuint runProgram(inout Shape s, uvec4 child);\n");
    add("#define GPGP_TABLE\nbool isStep(uint op, uint which) { return (" + number(table_.stepOperators) +
        " & (1u << which)) != 0u && op == which; }\n#define GPGP_FRAMES " + number(table_.frameFlags) +
        "\n#include \"spawn/kernel/table.glsl\"\n");
    if (programs) writePrograms();
  }
  /// What all children with the same steps do, each with its own numbers. Returns the entry that it chooses, or 0, or
  /// ~0 where there is none.
  void writePrograms() {
    add("#ifndef GPGP_SOFTWARE\nuint runProgram(inout Shape s, uvec4 child) {\n  const uint at = child.x;\n"
        "  switch (child.y >> kEntryProgram) {\n");
    for (uint32_t p = 0; p < table_.programs.size(); ++p) {
      add("  case " + number(p) + ": {\n");
      bool chooses = false;
      for (uint32_t i = 0; i < table_.programs[p].size(); ++i) {
        const auto [op, frame] = table_.programs[p][i];
        const std::string row = "row" + std::to_string(i), where = "at + " + number(kStepSize * i);
        add("    const uvec4 " + row + " = tableAt(" + where + ");\n");
        switch (op & kStepOperator) {
        case kOpSubDiv: {
          const uint32_t axis = (op >> kStepAxis) & 0xff;
          add("    const float remainder" + std::to_string(i) + " = " +
              (op & kStepFixed ? "remainderOf(" + component(axis) + ", uintBitsToFloat(" + row + ".z))"
                               : "max(0.0f, " + component(axis) + ")") +
              ";\n");
          if (op & kStepWeighted) add("    if (!(remainder" + std::to_string(i) + " > 0.0f)) return 0xffffffffu;\n");
          const std::string part = "toPartBy(s, " + number(axis) + ", remainder" + std::to_string(i) + ", " +
                                   (op & kStepFixed ? "true, " : "false, ") + row + ", uintBitsToFloat(tableAt(" +
                                   where + " + 1u)))";
          add(op & kStepFixed ? "    if (!" + part + ") return 0xffffffffu;\n" : "    " + part + ";\n");
          break;
        }
        case kOpCompSplit: add("    toBoxFace(s, " + row + ".y);\n"); break;
        case kOpReplicate: add("    toCopy(s, " + row + ".y);\n"); break;
        case kOpIf:
          add("    return " + row + ".y + chosenEdge(s, " + row + ".z);\n");
          chooses = true;
          break;
        default: break;
        }
        if (frame) add("    transformBy(s, " + row + ".w, " + number(frame) + ");\n");
      }
      add(chooses ? "  }\n" : "    break;\n  }\n");
    }
    add("  default: break;\n  }\n  return 0u;\n}\n#endif\n");
  }
  /// The edges that choices take which families go through.
  void writeChoices() {
    const auto matched = std::exchange(peers_, {});
    for (uint32_t n = 0; n < graph_.nodes.size(); ++n) peers_.push_back({n});
    add("uint chosenEdge(inout Shape s, uint node) {\n  uint chosen = 0u;\n  switch (node) {\n");
    for (uint32_t n = 0; n < graph_.nodes.size(); ++n) {
      if (!table_.chooses[n]) continue;
      const Node& node = graph_.nodes[n];
      add("  case " + number(offsetOf(n)) + ": {\n");
      if (node.op == kOpRandomRule)
        writeDraw(node);
      else
        add("  chosen = " + condition(node) + " ? 0u : 1u;\n");
      addDrawn(node);
      add("  break;\n  }\n");
    }
    add("  default: break;\n  }\n  return chosen;\n}\n");
    peers_ = matched;
  }

  // ---------------------------------------------------------------- chains

  /// A shape leaves along an edge: goes on, waits or ends.
  std::string take(const Node& node, uint32_t index) {
    const Edge& edge = edgeOf(node, index);
    if (edge.target == kNoNode) return "end = kEndDiscarded;";
    std::string text =
        "s.node = " + word(node, false, [&](const Node& peer) { return offsetOf(edgeOf(peer, index).target); }) + "; ";
    if (edge.recursive) text += "s.depth += 1u; ";
    const Node& target = graph_.nodes[edge.target];
    const char* end = target.op == kOpTerminal                                      ? "kEndTerminal"
                      : waits_[edge.target] || edge.recursive || multiplies(target) ? "kEndWaits"
                      : isContext(target.op)                                        ? "kEndContext"
                                                                                    : nullptr;
    if (end && edge.recursive) return text + "end = s.depth > maxDepth ? kEndUnfinished : " + end + ";";
    if (end) return text + "end = " + end + ";";
    const bool inside = group_[edge.target] == group_[indexOf(node)] && group_[edge.target] != kNoGroup;
    return text + "end = " + chainOf(edge.target) + "(s, maxDepth, " + (inside ? "row" : number(row_[edge.target])) +
           ");";
  }

  void writeChain(uint32_t index, std::vector<uint8_t>& written) {
    // Depth first by hand, as chains may be long: what a chain calls is written before it.
    std::vector<std::pair<uint32_t, uint32_t>> stack;
    const auto open = [&](uint32_t any) {
      const uint32_t node = peers_[any][0];
      if (written[node] || !room_.coded[node]) return;
      written[node] = 1;
      stack.push_back({node, 0});
    };
    open(index);
    while (!stack.empty()) {
      const auto [node, edge] = stack.back();
      const Node& n = graph_.nodes[node];
      if (edge < n.edgeCount) {
        ++stack.back().second;
        const Edge& e = edgeOf(n, edge);
        if (e.target != kNoNode && !e.recursive && !waits_[e.target]) open(e.target);
        continue;
      }
      stack.pop_back();
      add("uint chain" + std::to_string(node) + "(inout Shape s, uint maxDepth, uint row) { // " + operatorName(n.op) +
          "\n  uint end = kEndDiscarded;\n");
      writeOperator(n);
      add("  return end;\n}\n");
    }
  }

  void writeOperator(const Node& node) {
    switch (node.op) {
    case kOpTranslate: {
      const std::string terms = frameTerms(node);
      if (!terms.empty()) add("  precise vec3 p = s.position" + terms + ";\n  s.position = settleFinite3(p);\n");
      addDrawn(node);
      add("  " + take(node, 0) + "\n");
      return;
    }
    case kOpRotate:
      if (!areConstant(node)) return writeRotation(node);
      writeRotation(rotationOf(vec3(constant(node, 0), constant(node, 1), constant(node, 2))));
      add("  " + take(node, 0) + "\n");
      return;
    case kOpIf:
    case kOpIfSizeLess: return writeIf(node);
    case kOpRandomRule: return writeRandomRule(node);
    default:
      if (couldMultiply(node.op)) return writeFilter(node);
      add("  " + callOf(node) + ";\n");
      addDrawn(node);
      add("  " + take(node, 0) + "\n");
    }
  }
  /// What the table says of an operator that passes on one shape.
  std::string callOf(const Node& node) {
    // An angle that is known is a slope: as rotation() says.
    const bool isAngle = node.op == kOpRaiseRoof && isConstant(node, 1) && isConstant(node, 2) &&
                         std::floor(constant(node, 1)) >= static_cast<float>(kRoofByAngle);
    if (isAngle)
      return "raiseRoof(s, vec3(" + parameter(node, 0) + ", " + literal(static_cast<float>(kRoofBySlope)) + ", " +
             literal(slopeOfDegrees(constant(node, 2))) + "))";
    return replaced(kOperators[node.op].call, [&](std::string_view word) {
      return word == "GPGP_VALUES"      ? vector(node)
             : word == "GPGP_VALUE"     ? parameter(node, 0)
             : word == "GPGP_ARGUMENT"  ? number(node.argument)
             : word == "GPGP_ARGUMENT2" ? number(node.argument2)
                                        : std::string(word);
    });
  }
  /// + axisX * x + axisY * y + axisZ * z, without what is always zero.
  std::string frameTerms(const Node& node) {
    static constexpr const char* kAxes[] = {" + s.axisX * ", " + s.axisY * ", " + s.axisZ * "};
    std::string terms;
    for (uint32_t i = 0; i < 3; ++i) {
      if (!isConstant(node, i) || parameterOf(node, i).value != 0) terms += kAxes[i] + ("(" + parameter(node, i) + ")");
    }
    return terms;
  }
  /// Angles that are known are none for the device: NVIDIA's compiler folds sums of products of constants without the
  /// product's rounding, although they are precise, and then rotates by something else than all others.
  std::string rotation(const Node& node) {
    std::string angles;
    for (uint32_t i = 0; i < 3; ++i) {
      const vec2 known = isConstant(node, i) ? sineCosineDegrees(constant(node, i)) : vec2(0);
      angles += (i ? ", " : "") + (isConstant(node, i) ? "vec2(" + literal(known.x) + ", " + literal(known.y) + ")"
                                                       : "sineCosineDegrees(" + parameter(node, i) + ")");
    }
    return "rotationOfAngles(" + angles + ")";
  }
  void writeRotation(const Node& node) {
    const bool known = isConstant(node, 0) || isConstant(node, 1) || isConstant(node, 2);
    // Without any that is known, a loop is less code; software devices count its turns.
    if (!known) add("#ifndef GPGP_SOFTWARE\n  rotate(s, rotationOf(" + vector(node) + "));\n#else\n");
    add("  rotate(s, " + rotation(node) + ");\n");
    if (!known) add("#endif\n");
    addDrawn(node);
    add("  " + take(node, 0) + "\n");
  }
  /// rotate() with known columns: zeros are left out, ones are not multiplied with.
  void writeRotation(const Rotation& rotation) {
    static constexpr const char* kAxes[] = {"s.axisX", "s.axisY", "s.axisZ"};
    const std::array<vec3, 3> columns{rotation.c0, rotation.c1, rotation.c2};
    for (int c = 0; c < 3; ++c) {
      std::string terms;
      for (int i = 0; i < 3; ++i) {
        const float v = columns[c][i];
        if (v == 0) continue;
        terms += (terms.empty() ? "" : " + ") + std::string(kAxes[i]) + (v == 1 ? "" : " * " + literal(v));
      }
      add("  precise vec3 c" + std::to_string(c) + " = " + (terms.empty() ? "vec3(0.0f)" : terms) + ";\n");
    }
    add("  s.axisX = settleFinite3(c0);\n  s.axisY = settleFinite3(c1);\n  s.axisZ = settleFinite3(c2);\n");
  }
  std::string condition(const Node& node) {
    return node.op == kOpIf ? parameter(node, 0) + " != 0.0f" : component(node.argument) + " < " + parameter(node, 0);
  }
  void writeIf(const Node& node) {
    add("  const bool holds = " + condition(node) + ";\n");
    addDrawn(node);
    add("  if (holds) { " + take(node, 0) + " } else { " + take(node, 1) + " }\n");
  }
  /// Behind what draws numbers.
  void addDrawn(const Node& node) {
    if (node.draws) add("  s.key = drawnKey(s.key);\n");
  }
  /// The edge that RandomRule takes, as `chosen`.
  void writeDraw(const Node& node) {
    const uint32_t count = node.edgeCount;
    add("  const float p[" + std::to_string(count) + "] = " + array(node) + ";\n");
    add("  const float first = " + parameter(node, 0) + ";\n  float total = 0.0f;\n");
    for (uint32_t i = 0; i < count; ++i) add("  total = add(total, p[" + std::to_string(i) + "]);\n");
    add("  const float x = multiply(subtract(first, floor(first)), total);\n  float sum = 0.0f;\n");
    for (uint32_t i = 0; i < count; ++i) {
      const std::string at = "p[" + std::to_string(i) + "]";
      add("  if (" + at + " > 0.0f && sum <= x) chosen = " + number(i) + ";\n");
      if (i + 1 < count) add("  sum = add(sum, " + at + ");\n");
    }
  }
  void writeRandomRule(const Node& node) {
    const uint32_t count = node.edgeCount;
    add("  uint chosen = 0u;\n");
    writeDraw(node);
    addDrawn(node);
    add("  switch (chosen) {\n");
    for (uint32_t i = 0; i + 1 < count; ++i) add("  case " + number(i) + ": " + take(node, i) + " break;\n");
    add("  default: " + take(node, count - 1) + " break;\n  }\n");
  }
  /// Whether a filter has no code of its own: what it keeps depends on parameters, or pieces of polygons on the shape.
  static bool isByWords(const Node& node) {
    return node.op == kOpRepeat || (node.op == kOpSubDiv && (node.division == UINT32_MAX || isCutting(node)));
  }
  /// An operator that could multiply, but keeps one successor at most.
  void writeFilter(const Node& node) {
    uint32_t kept = kNoNode;
    for (uint32_t e = 0; e < node.edgeCount; ++e)
      if (edgeOf(node, e).target != kNoNode) kept = e;
    if (kept == kNoNode) return add("  return kEndDiscarded;\n");
    std::string there = "true";
    const std::string place = number(kept);
    if (node.op == kOpReplicate) {
      add("  toCopy(s, " + place + ");\n");
    } else if (node.op == kOpCompSplit) {
      const bool boxes = node.shapes == 1u << kShapeBox;
      if (!boxes) add("  if (facesOf(s.geometry, " + number(1u << kept) + ").count == 0u) return kEndDiscarded;\n");
      add(std::string(boxes ? "  toBoxFace" : "  toFace") + "(s, " + place + ");\n");
    } else if (!isByWords(node)) {
      const uint32_t* division = graph_.divisions.data() + node.division;
      const bool fixed = division[kDivisionFixedParts] != 0;
      if (!fixed && division[kDivisionWeightedParts] == 0) {
        add("  return kEndDiscarded;\n");
        return;
      }
      add("  const float remainder = remainderOf(" + component(node.argument) + ", " +
          literal(uintBitsToFloat(division[0])) + ");\n");
      const uint32_t* part = division + kDivisionParts + kept * kPartSize;
      std::string values;
      for (uint32_t i = 0; i < kPartSize; ++i) values += (i ? ", " : "") + literal(uintBitsToFloat(part[i]));
      there = (fixed ? "toPart(s, " : "remainder > 0.0f && toPart(s, ") + number(node.argument) + ", remainder, Part(" +
              values + "), " + place + ")";
    } else { // by the words; on software devices when it has waited, as they count loops
      add("  s.node = " + word(node, false, [&](const Node& peer) { return offsetOf(indexOf(peer)); }) +
          ";\n#ifdef GPGP_SOFTWARE\n  return kEndWaits;\n#endif\n");
      if (node.sees) add("  look(s);\n");
      add("  const Division d = divisionOf(s, " + place + ");\n");
      there = "d.fan.count != 0u && toPart(s, " + number(node.argument) + ", d.fan.extent, d.part, " + place + ")";
    }
    add("  if (" + there + ") { " + take(node, kept) + " }\n");
  }

  /// By node: whether a shape can come there that no chain has brought.
  std::vector<bool> entered() const {
    std::vector<bool> nodes = table_.entered;
    const auto starts = [&](uint32_t node) {
      if (node != kNoNode) nodes[node] = true; // a rule may be Discard() alone
    };
    for (const Rule& rule : graph_.rules) starts(rule.node);
    for (const Axiom& axiom : graph_.axioms) starts(axiom.node);
    for (const Node& node : graph_.nodes)
      for (uint32_t e = 0; e < node.edgeCount; ++e) {
        const Edge& edge = edgeOf(node, e);
        // What waits for an operator that could multiply is made its child by the graph's words.
        const bool waits = couldMultiply(node.op) && (stops_[indexOf(node)] || isByWords(node));
        const bool brought = isChain(node) && !edge.recursive && !waits;
        if (edge.target == kNoNode || table_.family[indexOf(node)]) continue;
        if (!brought || waits_[edge.target]) nodes[edge.target] = true;
      }
    return nodes;
  }
  /// A shape comes from an operator that multiplies (arrives), or has waited for this one. What is named here is
  /// inlined to its end, and software devices run all of it, so that only those chains are that a shape can come to.
  void writeRunChain() {
    add("uint runChain(inout Shape s, bool arrives, uint maxDepth) {\n"
        "  uint end = s.node == 0u ? kEndDiscarded : kEndUnfinished;\n"
        "  if (s.node != 0u && s.depth <= maxDepth) switch (s.node) {\n");
    std::string terminals;
    for (uint32_t n = 0; n < graph_.nodes.size(); ++n) {
      if (graph_.nodes[n].op == kOpTerminal && !room_.words) terminals += "  case " + number(offsetOf(n)) + ":\n";
      if (isContext(graph_.nodes[n].op) && !room_.words)
        add("  case " + number(offsetOf(n)) +
            ": end = " + (waits_[n] ? "arrives ? kEndWaits : kEndContext" : "kEndContext") + "; break;\n");
      if (!room_.named[n]) continue;
      for (const uint32_t peer : peers_[n]) add("  case " + number(offsetOf(peer)) + ":");
      const std::string row =
          matched_.empty() ? "0u" : "matchedRows[(s.node - " + number(kHeaderSize) + ") / " + number(kNodeSize) + "]";
      add(std::string(waits_[n] ? " if (arrives) end = kEndWaits; else" : "") + " end = " + chainOf(n) +
          "(s, maxDepth, " + (peers_[n].size() > 1 ? row : number(row_[n])) + "); break;\n");
    }
    if (!terminals.empty()) add(terminals + "    end = kEndTerminal; break;\n");
    if (room_.words)
      add("  default: end = kEndGoesOn; break;\n  }\n  if (end == kEndGoesOn) end = runWords(s, maxDepth);\n"
          "  return end;\n}\n");
    else
      add("  default: end = kEndWaits; break;\n  }\n  return end;\n}\n");
  }

  const Graph& graph_;
  const std::vector<bool>& waits_;
  std::vector<bool> stops_;                  // by node: shapes wait there, those that come back to it included
  std::vector<std::vector<uint32_t>> peers_; // by node: in its place in matching groups, by row
  std::vector<uint32_t> row_, group_;        // by node
  std::vector<uint32_t> first_;              // of its peers, by node
  Room room_;
  std::vector<uint32_t> matched_;
  KernelTable table_;
  std::map<std::vector<uint32_t>, uint32_t> columns_; // to where they begin in the table
  std::string out_;
};
} // namespace

KernelSource generate(const Graph& graph, const std::vector<bool>& waits, const Roots& matched, Queues queues) {
  return Generator(graph, waits, matched, queues).run();
}

} // namespace gpgp::spawn
