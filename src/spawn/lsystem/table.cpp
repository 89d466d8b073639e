// Checks a compiled L-system, so that neither the CPU nor a shader reads outside it or loops without end.
#include "spawn/lsystem/table.h"

#include <gpgp/spawn.h>

#include <bit>
#include <cmath>
#include <cstring>

namespace gpgp::spawn::lsystem {
namespace {

using core::makeError;
using core::Result;
using namespace shader;

constexpr uint32_t kEntryWords[kLsysSections] = {
    kSymbolSize, kProductionSize, kContextSize, kModuleSize, kTerminalWords, 1, 1};

/// What a program leaves on the stack, and where it ends; 0: it is none.
class Programs {
public:
  Programs(std::span<const uint32_t> words, uint32_t begin, uint32_t end, uint32_t rows)
      : words_(words), begin_(begin), end_(end), rows_(rows) {}

  /// The word behind a program, or 0 where it is not one that leaves one value.
  uint32_t behind(uint32_t at, uint32_t variables) const {
    uint32_t depth = 0;
    if (at < begin_) return 0;
    for (uint32_t length = 0; length < kMostProgram; ++length) {
      if (at >= end_) return 0;
      const uint32_t code = words_[at++];
      if (code == kLsysEnd) return depth == 1 ? at : 0;
      if (code < kLsysNegate) {
        if (code > kLsysByStep || at >= end_) return 0;
        const uint32_t word = words_[at++];
        if (code == kLsysByStep && word >= rows_) return 0;
        if (code == kLsysVariable && word >= variables) return 0;
        if (code == kLsysNumber && !(std::abs(std::bit_cast<float>(word)) <= 1.2676506e30f)) return 0;
        if (++depth > kMostStackDepth) return 0;
      } else if (code < kLsysAdd) {
        if (code > kLsysTruncate || depth < 1) return 0;
      } else if (code < kLsysSelect) {
        if (code > kLsysAtan2 || depth < 2) return 0;
        depth -= 1;
      } else {
        if (code != kLsysSelect || depth < 3) return 0;
        depth -= 2;
      }
    }
    return 0;
  }

private:
  std::span<const uint32_t> words_;
  uint32_t begin_, end_, rows_; ///< of the table of steps
};

Result<void> bad(const char* what) { return makeError(GPGP_ERROR_INVALID_DATA, "not a compiled L-system: %s", what); }

} // namespace

uint32_t checksumOf(std::span<const uint32_t> words) {
  uint32_t hash = 0x811c9dc5u;
  for (const uint32_t word : words) {
    hash = (hash ^ word) * 0x01000193u;
    hash ^= hash >> 15;
  }
  return hash;
}

float Table::value(uint32_t word) const { return std::bit_cast<float>(words_[word]); }

uint32_t Table::stepCount(uint32_t iterations) const {
  const uint32_t parts = head(kLsysHeadDecompositions);
  return parts + iterations * (1 + parts) + head(kLsysHeadHomomorphisms) + (has(kLsysCuts) ? 1 : 0);
}

uint32_t Table::phaseOf(uint32_t step, uint32_t iterations) const {
  const uint32_t parts = head(kLsysHeadDecompositions);
  if (step < parts) return kPhaseDecomposition;
  step -= parts;
  if (step < iterations * (1 + parts)) return step % (1 + parts) == 0 ? kPhaseMain : kPhaseDecomposition;
  step -= iterations * (1 + parts);
  // What is cut goes before homomorphism looks.
  if (has(kLsysCuts)) return step == 0 ? kPhaseCut : kPhaseHomomorphism;
  return kPhaseHomomorphism;
}

Result<Table> Table::load(std::span<const std::byte> bytes, std::pmr::memory_resource* memory) {
  const auto fail = [](const char* what) { return bad(what).error(); };
  if (bytes.size() < kLsysHeadSize * 4 || bytes.size() % 4 || bytes.size() / 4 > (1u << 28))
    return fail("its size is not one that they have");
  std::pmr::vector<uint32_t> words(bytes.size() / 4, memory);
  std::memcpy(words.data(), bytes.data(), bytes.size());
  if (words[kLsysHeadMagic] != kLsysMagic) return fail("it does not begin with \"gpls\"");
  if (words[kLsysHeadVersion] != kLsysVersion)
    return makeError(GPGP_ERROR_INVALID_DATA,
                     "the L-system was compiled in format %u; this library reads format %u: compile it again",
                     words[kLsysHeadVersion], kLsysVersion);
  if (words[kLsysHeadWords] != words.size()) return fail("it was cut, or something follows it");
  if (words[kLsysHeadChecksum] != checksumOf(std::span(words).subspan(kLsysHeadIterations)))
    return fail("its checksum is wrong");
  Table table(std::move(words));
  if (auto ok = table.check(); !ok) return ok.error();
  return table;
}

Result<void> Table::check() const {
  uint64_t expected = kLsysHeadSize;
  for (uint32_t s = 0; s < kLsysSections; ++s) {
    if (offset(s) != expected) return bad("a section is not where it should be");
    expected += uint64_t(count(s)) * kEntryWords[s];
    if (expected > words_.size()) return bad("a section is longer than the table");
  }
  if (expected != words_.size()) return bad("its sections do not fill it");
  if (head(kLsysHeadIterations) > kMostIterations || head(kLsysHeadDecompositions) > kMostRepeats ||
      head(kLsysHeadHomomorphisms) > kMostRepeats)
    return bad("it has too many steps");
  for (uint32_t word = kLsysHeadAngle; word < kLsysHeadAxiom; ++word)
    if (!(std::abs(value(word)) <= 1e30f)) return bad("one of its numbers is not finite");
  if (head(kLsysHeadSegment) > GPGP_SHAPE_SPHERE) return bad("there is no such shape");

  const uint32_t symbols = count(kLsysSectionSymbols);
  const uint32_t nameBytes = count(kLsysSectionNames) * 4;
  if (nameBytes == 0 || name(0)[nameBytes - 1] != 0) return bad("its names have no end");
  if (count(kLsysSectionTerminals) > kMostTerminals) return bad("it has too many terminals");
  for (uint32_t t = 0; t < count(kLsysSectionTerminals); ++t)
    if (terminal(t)[kTerminalNameAt] >= nameBytes || terminal(t)[kTerminalKind] > 1 ||
        terminal(t)[kTerminalShape] > GPGP_SHAPE_SPHERE)
      return bad("a terminal is wrong");
  if (symbols <= kSymbolAxiom || symbols > (1u << 16)) return bad("the number of its symbols is wrong");
  const uint32_t firstProduction = offset(kLsysSectionProductions);
  uint32_t owned = 0; // productions that symbols name
  for (uint32_t s = 0; s < symbols; ++s) {
    const uint32_t* w = symbol(s);
    if (w[kSymbolName] >= nameBytes || w[kSymbolArity] > kMostArity || w[kSymbolTurtle] >= kTurtleCommands ||
        w[kSymbolFlags] > kSymbolIgnored)
      return bad("a symbol is wrong");
    const uint32_t turtle = w[kSymbolTurtle];
    const bool draws = turtle == kTurtleDraw || turtle == kTurtleDrawOnly || turtle == kTurtleAsset ||
                       turtle == kTurtlePolygon || turtle == kTurtleCylinder;
    if (draws ? w[kSymbolTerminal] >= count(kLsysSectionTerminals) : w[kSymbolTerminal] != kNoTerminal)
      return bad("a symbol's terminal is wrong");
    const auto asks = [&](uint32_t flag, bool needed) { return !needed || has(flag); };
    if ((s == kSymbolOpen) != (turtle == kTurtleOpen) || (s == kSymbolClose) != (turtle == kTurtleClose) ||
        (s == kSymbolAxiom) != (turtle == kTurtleAxiom))
      return bad("its first symbols are wrong");
    if (!asks(kLsysCuts, turtle == kTurtleCut) || !asks(kLsysPolygons, turtle == kTurtlePolygon) ||
        !asks(kLsysCylinders, turtle == kTurtleCylinder) || !asks(kLsysWalks, turtle >= kTurtleUpright))
      return bad("its flags do not say what its symbols do");
    for (uint32_t phase = 0; phase < kPhases3; ++phase) {
      const uint32_t first = w[kSymbolPhases + 2 * phase], number = w[kSymbolPhases + 2 * phase + 1];
      if (number > kMostAlternatives) return bad("a symbol has too many productions");
      if (number == 0) continue;
      if (s <= kSymbolAxiom) return bad("a bracket has a production");
      const uint32_t index = (first - firstProduction) / kProductionSize;
      if (first < firstProduction || (first - firstProduction) % kProductionSize ||
          uint64_t(index) + number > count(kLsysSectionProductions))
        return bad("a symbol's productions are not there");
      for (uint32_t p = 0; p < number; ++p)
        if (words_[first + p * kProductionSize + kProductionPredecessor] != s ||
            (phase != kPhaseMain && (words_[first + p * kProductionSize + kProductionLeft + 1] ||
                                     words_[first + p * kProductionSize + kProductionRight + 1])))
          return bad("a production is not that of its symbol");
      owned += number;
    }
  }
  if (symbol(kSymbolOpen)[kSymbolArity] || symbol(kSymbolClose)[kSymbolArity] ||
      symbol(kSymbolAxiom)[kSymbolArity] != 1 || value(kLsysHeadTropism + 3) * 0 != 0 ||
      (value(kLsysHeadTropism + 3) != 0 && !has(kLsysWalks)))
    return bad("its first symbols are wrong");
  if (owned + 1 != count(kLsysSectionProductions)) return bad("it has productions without a symbol");

  // The table of steps is what the code begins with, in whole rows.
  const uint32_t rows = head(kLsysHeadRows), steps = count(kLsysSectionCode) ? words_[offset(kLsysSectionCode)] : 0;
  if (rows && (steps == 0 || 1 + uint64_t(rows) * steps > count(kLsysSectionCode)))
    return bad("its table of steps is wrong");
  const uint32_t behindRows = rows ? 1 + rows * steps : 0;
  for (uint32_t i = 1; i < behindRows; ++i)
    if (!(std::abs(value(offset(kLsysSectionCode) + i)) <= 1.2676506e30f)) return bad("its table of steps is wrong");
  const Programs programs(words_, offset(kLsysSectionCode) + behindRows,
                          offset(kLsysSectionCode) + count(kLsysSectionCode), rows);
  const auto entries = [&](uint32_t first, uint32_t number, uint32_t section, uint32_t most) {
    const uint32_t size = kEntryWords[section];
    return number <= most && (number == 0 || (first >= offset(section) && (first - offset(section)) % size == 0 &&
                                              uint64_t(first - offset(section)) / size + number <= count(section)));
  };
  for (uint32_t p = 0; p < count(kLsysSectionProductions); ++p) {
    const uint32_t at = firstProduction + p * kProductionSize;
    const uint32_t* w = words_.data() + at;
    if (w[kProductionPredecessor] >= symbols) return bad("a production has no predecessor");
    const bool isAxiom = w[kProductionPredecessor] == kSymbolAxiom;
    if (isAxiom != (at == axiom())) return bad("its axiom is wrong");
    uint32_t variables = isAxiom ? 0 : symbol(w[kProductionPredecessor])[kSymbolArity];
    for (const uint32_t side : {kProductionLeft, kProductionRight}) {
      const uint32_t first = w[side], number = w[side + 1];
      if (!entries(first, number, kLsysSectionContexts, kMostContext)) return bad("a context is not there");
      if (number && (!has(kLsysContexts) || isAxiom)) return bad("its flags do not say that it has contexts");
      uint32_t depth = 0;
      for (uint32_t i = 0; i < number; ++i) {
        const uint32_t* e = words_.data() + first + i * kContextSize;
        if (e[kContextSymbol] == kContextOpen && side == kProductionRight) {
          ++depth;
        } else if (e[kContextSymbol] == kContextClose && side == kProductionRight && depth) {
          --depth;
        } else {
          if (e[kContextSymbol] >= symbols || e[kContextSymbol] <= kSymbolClose) return bad("a context is wrong");
          if (e[kContextVariable] != variables) return bad("a context's parameters are not in order");
          variables += symbol(e[kContextSymbol])[kSymbolArity];
        }
      }
    }
    if (variables > kMostVariables) return bad("a production has too many parameters");
    for (const uint32_t program : {w[kProductionCondition], w[kProductionProbability]})
      if (program && !programs.behind(program, variables)) return bad("a program is wrong");
    if (isAxiom && (w[kProductionCondition] || w[kProductionProbability])) return bad("its axiom is wrong");
    const uint32_t first = w[kProductionSuccessor], number = w[kProductionSuccessor + 1];
    if (!entries(first, number, kLsysSectionModules, kMostSuccessor)) return bad("a successor is not there");
    uint32_t parameters = 0, depth = 0;
    for (uint32_t m = 0; m < number; ++m) {
      const uint32_t* e = words_.data() + first + m * kModuleSize;
      if (e[kModuleSymbol] >= symbols || e[kModuleSymbol] == kSymbolAxiom) return bad("a successor's module is wrong");
      if (e[kModuleSymbol] == kSymbolOpen) ++depth;
      if (e[kModuleSymbol] == kSymbolClose && depth-- == 0) return bad("a successor's brackets are wrong");
      const uint32_t arity = symbol(e[kModuleSymbol])[kSymbolArity];
      uint32_t program = e[kModuleCode];
      for (uint32_t i = 0; i < arity; ++i)
        if ((program = programs.behind(program, variables)) == 0) return bad("a program is wrong");
      parameters += arity;
    }
    if (depth) return bad("a successor's brackets are wrong");
    if (parameters != w[kProductionParameters]) return bad("a production counts its parameters wrongly");
  }
  const uint32_t start = axiom();
  if (start < firstProduction || (start - firstProduction) % kProductionSize ||
      (start - firstProduction) / kProductionSize >= count(kLsysSectionProductions))
    return bad("its axiom is not there");
  return {};
}

} // namespace gpgp::spawn::lsystem
