// Executes blocks of statements with names for values: see statements.h.
#include "spawn/lsystem/format.h"
#include "spawn/lsystem/rewrite.h"
#include "spawn/lsystem/statements.h"

#include <algorithm>
#include <cmath>

namespace gpgp::spawn::lsystem {
namespace {

using namespace shader;
constexpr uint32_t kMostTurns = 100'000; // of loops of a block
constexpr uint32_t kMostOpenTurns = 64;  // of a loop that parameters end
constexpr uint32_t kMostWays = 256;      // through a block
constexpr size_t kMostSize = 4096;       // of a value, in operations

size_t sizeOf(const Expression& e) {
  size_t size = 1;
  for (const Expression& operand : e.operands) size += sizeOf(operand);
  return size;
}

Expression number(float value, Place place) {
  Expression e;
  e.number = value;
  e.place = place;
  return e;
}

bool isDraw(const Expression& e) {
  return e.kind == Expression::Kind::operation && (e.code == kLsysRandom || e.code == kLsysNormal);
}

/// Whether a block can leave the way that passes through it, or makes modules.
bool divides(std::span<const Statement> block) {
  return std::any_of(block.begin(), block.end(), [](const Statement& s) {
    return s.kind == Statement::Kind::produce || s.kind == Statement::Kind::stop || divides(s.first) ||
           divides(s.second);
  });
}

} // namespace

std::string elementName(const std::string& array, uint32_t index) { return array + "[" + std::to_string(index) + "]"; }

std::optional<float> Execution::valueOf(const Expression& e) {
  if (e.kind == Expression::Kind::number) return settle(e.number);
  if (e.kind == Expression::Kind::name) {
    const auto found = constants_.find(e.name);
    return found != constants_.end() ? std::optional(found->second) : std::nullopt;
  }
  if (isDraw(e)) {
    if (!drawsNumbers_) return std::nullopt;
    const LsysDraws draws{uvec2(seed_, 0x5eedu), 0};
    const float u = lsysDraw(draws, ++draws_);
    if (e.code == kLsysRandom) return u;
    const float radius = squareRoot(multiply(-1.3862944f, logarithm2(subtract(1.0f, u))));
    return multiply(radius, sineCosineDegrees(multiply(360.0f, lsysDraw(draws, ++draws_))).y);
  }
  if (e.code == kLsysSelect) {
    const auto condition = valueOf(e.operands[0]);
    return condition ? valueOf(e.operands[*condition != 0.0f ? 1 : 2]) : std::nullopt;
  }
  std::vector<float> values;
  for (const Expression& operand : e.operands) {
    const auto value = valueOf(operand);
    if (!value) return std::nullopt;
    values.push_back(*value);
  }
  return values.size() == 1 ? lsysUnary(e.code, values[0]) : lsysBinary(e.code, values[0], values[1]);
}

bool Execution::fits(const Expression& e) {
  if (sizeOf(e) <= kMostSize) return true;
  if (!failed_) diagnostics_.error(e.place, "a value of this code is too long with all that its names stand for");
  failed_ = true;
  return false;
}

/// An expression in terms of the module's values. Its random numbers are drawn here, once.
Expression Execution::settled(const Expression& e, const Way& way) {
  Expression value = e;
  substitute(value, way.values);
  if (const auto known = valueOf(value)) {
    const bool isWhole = value.isWhole;
    value = number(*known, e.place);
    value.isWhole = isWhole;
    return value;
  }
  const std::function<void(Expression&)> share = [&](Expression& x) {
    if (isDraw(x) && !x.draw) x.draw = kSharedDraw | ++draws_;
    for (Expression& operand : x.operands) share(operand);
  };
  share(value);
  return value;
}

void Execution::assign(const Statement& s, Way& way) {
  Expression value = settled(s.value, way);
  if (!fits(value)) return;
  if (s.isWhole && !value.isWhole) {
    value = operation(kLsysTruncate, s.place, {std::move(value)});
    value.isWhole = true;
    value = settled(value, way);
  }
  std::string name = s.name;
  if (s.index) {
    const auto index = valueOf(settled(*s.index, way));
    if (!index) {
      if (!failed_)
        diagnostics_.error(s.place, "the place of '" + s.name + "' that this sets has to be a known number");
      failed_ = true;
      return;
    }
    name = elementName(s.name, static_cast<uint32_t>(std::max(*index, 0.0f)));
  }
  if (!s.declares && guarded_.contains(s.name) && named_.insert(s.name).second)
    diagnostics_.warning(s.place, "'" + s.name + "' is a value of all modules; what one of them sets, no other sees");
  way.values[name] = std::move(value);
}

std::vector<Way> Execution::choose(const Statement& s, Way way) {
  const Expression condition = settled(s.value, way);
  if (const auto known = valueOf(condition)) return all(*known != 0.0f ? s.first : s.second, {std::move(way)});
  Way other = way;
  if (ended_ && (divides(s.first) || divides(s.second))) {
    way.conditions.push_back(condition);
    other.conditions.push_back(operation(kLsysNot, s.place, {condition}));
    std::vector<Way> result = all(s.first, {std::move(way)});
    for (Way& w : all(s.second, {std::move(other)})) result.push_back(std::move(w));
    if ((ways_ = std::max(ways_, static_cast<uint32_t>(result.size()))) > kMostWays && !failed_) {
      diagnostics_.error(s.place, "there are more than " + std::to_string(kMostWays) + " ways through this code");
      failed_ = true;
    }
    return result;
  }
  std::vector<Way> yes = all(s.first, {std::move(way)}), no = all(s.second, {std::move(other)});
  if (yes.empty() || no.empty()) return yes.empty() ? std::move(no) : std::move(yes);
  std::set<std::string> names;
  for (const auto& [n, value] : yes[0].values) names.insert(n);
  for (const auto& [n, value] : no[0].values) names.insert(n);
  for (const std::string& n : names) {
    const auto of = [&](const Way& w) {
      const auto found = w.values.find(n);
      if (found != w.values.end()) return found->second;
      Expression itself; // the parameter or constant of that name
      itself.kind = Expression::Kind::name;
      itself.name = n;
      itself.place = s.place;
      return itself;
    };
    Expression a = of(yes[0]), b = of(no[0]);
    if (a.kind == Expression::Kind::number && b.kind == Expression::Kind::number && a.number == b.number) continue;
    const bool isWhole = a.isWhole && b.isWhole;
    Expression merged = operation(kLsysSelect, s.place, {condition, std::move(a), std::move(b)});
    merged.isWhole = isWhole;
    if (fits(merged)) yes[0].values[n] = std::move(merged);
  }
  return yes;
}

std::vector<Way> Execution::loop(const Statement& s, Way way) {
  std::vector<Way> done, going;
  going.push_back(std::move(way));
  uint32_t open = 0;
  for (bool isFirst = true; !going.empty() && !failed_; isFirst = false) {
    if (++turns_ > kMostTurns) {
      diagnostics_.error(s.place, "the loops of this code turn more than " + std::to_string(kMostTurns) + " times");
      failed_ = true;
      break;
    }
    std::vector<Way> turning;
    for (Way& w : going) {
      if (isFirst && s.testsLast) {
        turning.push_back(std::move(w));
        continue;
      }
      const Expression condition = settled(s.value, w);
      if (const auto known = valueOf(condition)) {
        (*known != 0.0f ? turning : done).push_back(std::move(w));
        continue;
      }
      if (!ended_) {
        diagnostics_.error(s.place, "the number of turns of a loop has to be known when the file is compiled");
        failed_ = true;
        break;
      }
      Way leaves = w;
      leaves.conditions.push_back(operation(kLsysNot, s.place, {condition}));
      done.push_back(std::move(leaves));
      if (++open > kMostOpenTurns) {
        diagnostics_.warning(s.place, "the number of turns of this loop depends on parameters; it turns at most " +
                                          std::to_string(kMostOpenTurns) + " times");
        continue;
      }
      w.conditions.push_back(condition);
      turning.push_back(std::move(w));
    }
    going.clear();
    for (Way& w : all(s.first, std::move(turning))) {
      const Statement::Stop stop = std::exchange(w.stop, Statement::Stop::none);
      if (stop == Statement::Stop::loop)
        done.push_back(std::move(w));
      else
        for (Way& next : all(s.second, {std::move(w)})) going.push_back(std::move(next));
    }
  }
  return done;
}

std::vector<Way> Execution::one(const Statement& s, Way way) {
  std::vector<Way> result;
  switch (s.kind) {
  case Statement::Kind::assign: assign(s, way); break;
  case Statement::Kind::choose: return choose(s, std::move(way));
  case Statement::Kind::loop: return loop(s, std::move(way));
  case Statement::Kind::block: return all(s.first, {std::move(way)});
  case Statement::Kind::stop:
    way.stop = s.stop;
    if (s.stop == Statement::Stop::all) {
      if (s.hasValue) way.result = settled(s.value, way);
      if (ended_) {
        ended_(std::move(way));
        return result;
      }
    }
    break;
  case Statement::Kind::produce:
    for (Module m : s.modules) {
      for (Expression& argument : m.arguments) {
        const bool isWhole = argument.isWhole;
        argument = settled(argument, way);
        argument.isWhole = isWhole;
        if (!fits(argument)) return result;
      }
      way.modules.push_back(std::move(m));
    }
    if (s.isLast && ended_) {
      way.stop = Statement::Stop::none;
      ended_(std::move(way));
      return result;
    }
    break;
  case Statement::Kind::nothing: break;
  }
  result.push_back(std::move(way));
  return result;
}

std::vector<Way> Execution::all(std::span<const Statement> block, std::vector<Way> ways) {
  for (const Statement& s : block) {
    if (failed_) return {};
    std::vector<Way> next;
    for (Way& way : ways) {
      if (way.stop != Statement::Stop::none) {
        next.push_back(std::move(way));
        continue;
      }
      for (Way& w : one(s, std::move(way))) next.push_back(std::move(w));
    }
    ways = std::move(next);
  }
  return ways;
}

std::vector<Way> Execution::run(std::span<const Statement> block, Way from, const std::function<void(Way&&)>& ended) {
  ended_ = ended;
  failed_ = false;
  turns_ = ways_ = 0;
  std::vector<Way> ways;
  ways.push_back(std::move(from));
  return all(block, std::move(ways));
}

void takeChanging(std::span<const Statement> block, std::map<std::string, float>& values,
                  std::map<std::string, float>& start) {
  for (const Statement& s : block) {
    takeChanging(s.first, values, start);
    takeChanging(s.second, values, start);
    if (s.kind != Statement::Kind::assign || s.declares) continue;
    if (!s.index && !values.contains(s.name)) start.try_emplace(s.name, 0.0f);
    for (auto v = values.begin(); v != values.end();) {
      const bool isSet = s.index ? v->first.starts_with(s.name + "[") : v->first == s.name;
      if (isSet) start[v->first] = v->second;
      v = isSet ? values.erase(v) : std::next(v);
    }
  }
}

std::vector<Stepped> steppedValues(std::span<const Statement> before, std::span<const Statement> behind,
                                   float iterations, const std::map<std::string, float>& start,
                                   const std::function<Execution()>& execution) {
  if (!(iterations >= 0 && iterations <= 1000)) return {}; // reported as a setting
  std::map<std::string, std::vector<float>> rows;
  Way way;
  for (const auto& [name, value] : start) way.values[name] = number(value, {});
  const auto run = [&](std::span<const Statement> block) {
    Execution e = execution();
    std::vector<Way> ways = e.run(block, way);
    if (!ways.empty()) way = std::move(ways[0]);
  };
  const auto record = [&](size_t length) {
    for (const auto& [name, value] : way.values) {
      if (value.kind != Expression::Kind::number) continue;
      const auto known = start.find(name);
      auto& row = rows[name];
      if (row.empty()) row.assign(length - 1, known != start.end() ? known->second : 0.0f);
      row.resize(length - 1, row.back());
      row.push_back(value.number);
    }
  };
  const size_t steps = static_cast<size_t>(iterations);
  for (size_t step = 1; step <= steps; ++step) {
    run(before);
    record(step + 1);
    run(behind);
  }
  record(steps + 2);
  std::vector<Stepped> result;
  for (auto& [name, row] : rows) {
    const float first = row[0];
    const bool isConstant = std::all_of(row.begin(), row.end(), [first](float v) { return v == first; });
    if (!isConstant || !start.contains(name)) result.push_back({name, std::move(row)});
  }
  return result;
}

} // namespace gpgp::spawn::lsystem
