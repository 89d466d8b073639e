#include "spawn/cga/program.h"

#include "spawn/cga/names.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iomanip>
#include <sstream>

namespace gpgp::spawn::cga {
namespace {

struct InstructionInfo {
  const char* name;
  uint32_t operands;
};
constexpr InstructionInfo kInstructions[] = {
#define GPGP_CGA_ROW(name, operands) {#name, operands},
    GPGP_CGA_INSTRUCTIONS(GPGP_CGA_ROW)
#undef GPGP_CGA_ROW
};

/// Walks all chunks that can be reached, and all tables.
class Validator {
public:
  explicit Validator(const Program& program) : program_(program), words_(program.words) {}

  std::string run() {
    begins_.assign(words_.size(), false);
    for (const RuleInfo& rule : program_.rules) chunk(rule.chunk);
    for (const AttributeInfo& a : program_.attributes)
      if (a.chunk) chunk(a.chunk);
    if (program_.start >= program_.rules.size()) fail(0, "there is no start rule");
    for (const uint32_t slot : program_.order)
      if (slot >= program_.attributes.size()) fail(0, "an attribute's slot is out of range");
    while (!pending_.empty() && error_.empty()) {
      const uint32_t at = pending_.back();
      pending_.pop_back();
      code(at);
    }
    for (const uint32_t target : targets_)
      if (error_.empty() && !begins_[target]) fail(target, "a jump leads into an instruction");
    return error_;
  }

private:
  void fail(uint32_t at, const std::string& what) {
    if (error_.empty()) error_ = "word " + std::to_string(at) + ": " + what;
  }
  bool within(uint32_t at, uint32_t count) const { return at <= words_.size() && count <= words_.size() - at; }
  void chunk(uint32_t at) {
    if (at == 0 || !within(at, kHeader + 1)) return fail(at, "a chunk is out of range");
    if (words_[at] >= program_.strings.size()) return fail(at, "a string is out of range");
    if (words_[at + 1] > words_[at + 2] || words_[at + 2] > 1024) return fail(at, "a chunk has too many locals");
    if (begins_[at + kHeader]) return;
    pending_.push_back(at + kHeader);
  }
  void table(uint32_t at, uint32_t values, uint32_t depth) {
    if (depth > 256 || !within(at, 1) || !within(at + 1, words_[at]) || words_[at] > words_.size())
      return fail(at, "a table is out of range");
    for (uint32_t i = 0; i < words_[at] && error_.empty(); ++i) {
      const uint32_t part = words_[at + 1 + i];
      if (!within(part, shader::kCgaPartWords)) return fail(part, "a part is out of range");
      const uint32_t kind = words_[part + shader::kCgaPartKind], selector = words_[part + shader::kCgaPartSelector];
      if (kind > shader::kCgaPartRepeated || (selector != shader::kCgaNoSelector && selector >= values))
        return fail(part, "a part is wrong");
      const uint32_t body = words_[part + shader::kCgaPartBody];
      if (kind >= shader::kCgaPartGroup)
        table(body, values, depth + 1);
      else
        chunk(body);
    }
  }
  /// To the end of a straight piece of code.
  void code(uint32_t at) {
    using namespace shader;
    while (error_.empty()) {
      if (!within(at, 1)) return fail(at, "code has no end");
      if (begins_[at]) return;
      const uint32_t op = words_[at];
      if (op >= kCgaInstructions) return fail(at, "no instruction");
      const uint32_t operands = kInstructions[op].operands;
      if (!within(at + 1, operands)) return fail(at, "an instruction is cut off");
      begins_[at] = true;
      const auto operand = [&](uint32_t i) { return words_[at + 1 + i]; };
      switch (op) {
      case kCgaPushStringCode:
      case kCgaPushWordCode:
      case kCgaLeafCode:
        if (operand(0) >= program_.strings.size()) fail(at, "a string is out of range");
        break;
      case kCgaAttributeCode:
      case kCgaSetAttributeCode:
        if (operand(0) >= program_.attributes.size()) fail(at, "an attribute's slot is out of range");
        break;
      case kCgaLocalCode:
      case kCgaSetLocalCode:
        if (operand(0) > 1024) fail(at, "a local is out of range");
        break;
      case kCgaJumpCode:
      case kCgaJumpUnlessCode:
      case kCgaAndCode:
      case kCgaOrCode:
      case kCgaChooseCode:
        if (operand(0) >= words_.size()) {
          fail(at, "a jump is out of range");
        } else {
          targets_.push_back(operand(0));
          pending_.push_back(operand(0));
        }
        break;
      case kCgaCallCode:
      case kCgaInvokeCode:
      case kCgaInvokeLastCode:
        chunk(operand(0));
        if (error_.empty() && words_[operand(0) + kCgaChunkParameters] != operand(1))
          fail(at, "a call has other values");
        break;
      case kCgaFunctionCode:
        if (operand(0) >= static_cast<uint32_t>(Function::count)) fail(at, "no function");
        break;
      case kCgaOperationCode:
        if (operand(0) >= static_cast<uint32_t>(Operation::count)) fail(at, "no operation");
        break;
      case kCgaBlockCode:
        if (operand(0) >= static_cast<uint32_t>(Operation::count)) fail(at, "no operation");
        table(operand(2), operand(1), 0);
        break;
      default: break;
      }
      if (op == kCgaJumpCode || op == kCgaReturnCode || op == kCgaEndCode || op == kCgaInvokeLastCode) return;
      at += 1 + operands;
    }
  }

  static constexpr uint32_t kHeader = shader::kCgaChunkHeader;
  const Program& program_;
  const std::vector<uint32_t>& words_;
  std::vector<bool> begins_;
  std::vector<uint32_t> pending_, targets_;
  std::string error_;
};

} // namespace

std::optional<float> numberIn(const std::string& text) {
  char* end = nullptr;
  const float number = std::strtof(text.c_str(), &end);
  if (text.empty() || *end != 0 || !std::isfinite(number)) return std::nullopt;
  return number;
}

const SourceOf* Program::sourceOf(uint32_t at) const {
  const auto found = std::upper_bound(sources.begin(), sources.end(), at,
                                      [](uint32_t value, const SourceOf& source) { return value < source.at; });
  return found == sources.begin() ? nullptr : &*(found - 1);
}

std::string validate(const Program& program) { return Validator(program).run(); }

std::string disassemble(const Program& program) {
  std::ostringstream text;
  std::vector<std::pair<uint32_t, std::string>> chunks;
  for (const RuleInfo& rule : program.rules) chunks.push_back({rule.chunk, rule.name + " -->"});
  for (const AttributeInfo& a : program.attributes)
    if (a.chunk) chunks.push_back({a.chunk, a.name + " ="});
  for (const auto& [begin, name] : chunks) {
    text << name << '\n';
    for (uint32_t at = begin + shader::kCgaChunkHeader; at < program.words.size();) {
      const uint32_t op = program.words[at];
      if (op >= shader::kCgaInstructions) break;
      text << std::setw(6) << at << "  " << kInstructions[op].name;
      for (uint32_t i = 0; i < kInstructions[op].operands; ++i) text << ' ' << program.words[at + 1 + i];
      text << '\n';
      at += 1 + kInstructions[op].operands;
      if (op == shader::kCgaEndCode || op == shader::kCgaReturnCode) break;
    }
  }
  return text.str();
}

} // namespace gpgp::spawn::cga
