// Both formats become rows of named values with the line they stand on; one function makes axioms of rows.
#include "cli/axioms.h"

#include "cli/command.h"
#include "host/files.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>

namespace gpgp::cli {
namespace {

struct Row {
  size_t line = 0;
  std::map<std::string, std::string, std::less<>> values;
};

const std::array<std::string_view, 11> kColumns = {"x",      "y",    "z",    "rotation", "size_x",   "size_y",
                                                   "size_z", "seed", "rule", "shape",    "attribute"};

struct Place { // for messages
  std::string file;
  [[noreturn]] void fail(size_t line, const std::string& text) const {
    throw Failure(file + ":" + std::to_string(line) + ": error: " + text);
  }
};

std::string_view trimmed(std::string_view text) {
  const auto isSpace = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && isSpace(text.front())) text.remove_prefix(1);
  while (!text.empty() && isSpace(text.back())) text.remove_suffix(1);
  return text;
}

std::vector<std::string> cells(std::string_view line) {
  std::vector<std::string> result;
  for (size_t at = 0; at <= line.size();) {
    const size_t end = std::min(line.find(',', at), line.size());
    result.emplace_back(trimmed(line.substr(at, end - at)));
    at = end + 1;
  }
  return result;
}

std::vector<Row> readCsv(const std::string& text, const Place& place) {
  std::vector<Row> rows;
  std::vector<std::string> columns;
  std::istringstream lines(text);
  std::string line;
  for (size_t number = 1; std::getline(lines, line); ++number) {
    const std::string_view content = trimmed(std::string_view(line).substr(0, line.find('#')));
    if (content.empty()) continue;
    const std::vector<std::string> values = cells(content);
    if (columns.empty()) {
      for (size_t i = 0; i < values.size(); ++i) {
        if (std::find(kColumns.begin(), kColumns.end(), values[i]) == kColumns.end())
          place.fail(number, "\"" + values[i] +
                                 "\" is no column; the first line names some of x, y, z, rotation, size_x, size_y, "
                                 "size_z, seed, rule, shape, attribute");
        if (std::find(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(i), values[i]) !=
            values.begin() + static_cast<std::ptrdiff_t>(i))
          place.fail(number, "two columns are named \"" + values[i] + "\"");
      }
      columns = values;
      continue;
    }
    if (values.size() != columns.size())
      place.fail(number, std::to_string(values.size()) + " values for " + std::to_string(columns.size()) + " columns");
    Row row{number, {}};
    for (size_t i = 0; i < values.size(); ++i)
      if (!values[i].empty()) row.values[columns[i]] = values[i];
    rows.push_back(std::move(row));
  }
  return rows;
}

/// The line on which each object of the outermost array begins; the text is valid JSON.
std::vector<size_t> linesOfObjects(const std::string& text) {
  std::vector<size_t> lines;
  size_t line = 1, depth = 0;
  bool quoted = false, first = false;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n') ++line;
    if (quoted) {
      if (c == '\\') ++i;
      quoted = c != '"';
      continue;
    }
    if (c == ' ' || c == '\n' || c == '\t' || c == '\r') continue;
    if (depth == 1 && first && c != ']') {
      lines.push_back(line);
      first = false;
    }
    if (c == '"') quoted = true;
    if (c == '[' || c == '{') first = ++depth == 1;
    if (c == ']' || c == '}') --depth;
    if (c == ',' && depth == 1) first = true;
  }
  return lines;
}

std::vector<Row> readJson(const std::string& text, const Place& place) {
  Json all;
  try {
    all = Json::parse(text);
  } catch (const Json::parse_error& error) {
    const size_t end = std::min(error.byte, text.size());
    place.fail(1 + static_cast<size_t>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(end), '\n')),
               error.what());
  } catch (const Json::exception& error) { // a number beyond all numbers, without its place
    throw Failure(place.file + ": error: " + error.what());
  }
  if (!all.is_array()) place.fail(1, "expected an array of axioms, [{...}, {...}]");
  const std::vector<size_t> lines = linesOfObjects(text);
  std::vector<Row> rows;
  for (size_t i = 0; i < all.size(); ++i) {
    Row row{lines[i], {}};
    if (!all[i].is_object()) place.fail(row.line, "expected an object with position, rotation, size, seed, rule");
    const auto number = [&](const std::string& name, const Json& value, const std::string& key) {
      if (!value.is_number()) place.fail(row.line, name + " takes numbers");
      row.values[key] = value.dump();
    };
    for (const auto& [name, value] : all[i].items()) {
      if (name == "position" || name == "size") {
        if (!value.is_array() || value.size() != 3) place.fail(row.line, name + " takes three numbers, [x, y, z]");
        for (size_t axis = 0; axis < 3; ++axis)
          number(name, value[axis], (name == "size" ? "size_" : "") + std::string(1, "xyz"[axis]));
      } else if (name == "rotation" || name == "seed" || name == "attribute") {
        number(name, value, name);
      } else if (name == "rule" || name == "shape") {
        if (!value.is_string()) place.fail(row.line, name + " takes a " + name + "'s name");
        row.values[name] = value.get<std::string>();
      } else {
        place.fail(row.line,
                   "\"" + name + "\" is unknown; there are position, rotation, size, seed, rule, shape, attribute");
      }
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

} // namespace

GpgpAxiom axiomAt(const std::array<float, 3>& place, float degrees, const std::array<float, 3>& size, uint32_t seed,
                  uint32_t id) {
  GpgpAxiom axiom{};
  const float radians = degrees * 0.017453293f;
  const float sine = degrees == 0 ? 0.0f : std::sin(radians), cosine = degrees == 0 ? 1.0f : std::cos(radians);
  axiom.transform[0] = axiom.transform[10] = cosine;
  axiom.transform[2] = sine;
  axiom.transform[8] = -sine;
  axiom.transform[5] = 1.0f;
  axiom.transform[3] = place[0];
  axiom.transform[7] = place[1] + size[1] * 0.5f;
  axiom.transform[11] = place[2];
  std::copy(size.begin(), size.end(), axiom.size);
  axiom.seed = seed;
  axiom.id = id;
  axiom.rule = GPGP_AXIOM_DEFAULT_RULE;
  axiom.attribute = std::numeric_limits<float>::quiet_NaN();
  return axiom;
}

std::vector<GpgpAxiom> axiomGrid(uint32_t count, float spacing, const AxiomDefaults& defaults) {
  if (!(spacing > 0)) spacing = std::max(defaults.size[0], defaults.size[2]) * 1.5f;
  const uint32_t side = static_cast<uint32_t>(std::ceil(std::sqrt(static_cast<double>(count))));
  const float offset = static_cast<float>(side - 1) * 0.5f;
  std::vector<GpgpAxiom> axioms;
  axioms.reserve(count);
  for (uint32_t i = 0; i < count; ++i) {
    axioms.push_back(axiomAt(
        {(static_cast<float>(i % side) - offset) * spacing, 0, (static_cast<float>(i / side) - offset) * spacing}, 0,
        defaults.size, defaults.seed + i, i));
    axioms.back().rule = defaults.starts[i % defaults.starts.size()];
  }
  return axioms;
}

std::vector<GpgpAxiom> readAxioms(const std::filesystem::path& file, const std::vector<NamedStart>& starts,
                                  const AxiomDefaults& defaults) {
  std::string text = host::readText(file);
  if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3); // spreadsheets write it
  const Place place{file.string()};
  const size_t begin = text.find_first_not_of(" \t\r\n");
  const bool json = begin != std::string::npos && (text[begin] == '[' || text[begin] == '{');
  std::vector<GpgpAxiom> axioms;
  for (const Row& row : json ? readJson(text, place) : readCsv(text, place)) {
    const auto number = [&](std::string_view name, float otherwise) {
      const auto found = row.values.find(name);
      if (found == row.values.end()) return otherwise;
      float value = 0;
      const char* end = found->second.data() + found->second.size();
      const auto [at, error] = std::from_chars(found->second.data(), end, value);
      if (error != std::errc() || at != end || !std::isfinite(value))
        place.fail(row.line, std::string(name) + " takes a number; \"" + found->second + "\" is none");
      return value;
    };
    for (const char* needed : {"x", "z"})
      if (row.values.find(needed) == row.values.end())
        place.fail(row.line, json ? "an axiom needs a position" : std::string("an axiom needs a value for ") + needed);
    const uint32_t id = static_cast<uint32_t>(axioms.size());
    std::array<float, 3> size{};
    for (size_t axis = 0; axis < 3; ++axis) {
      size[axis] = number(std::string("size_") + "xyz"[axis], defaults.size[axis]);
      if (!(size[axis] > 0)) place.fail(row.line, "sizes are above 0");
    }
    GpgpAxiom axiom =
        axiomAt({number("x", 0), number("y", 0), number("z", 0)}, number("rotation", 0), size, defaults.seed + id, id);
    if (const auto seed = row.values.find("seed"); seed != row.values.end()) {
      const char* end = seed->second.data() + seed->second.size();
      const auto [at, error] = std::from_chars(seed->second.data(), end, axiom.seed);
      if (error != std::errc() || at != end)
        place.fail(row.line, "seed takes a whole number from 0 to 4294967295; \"" + seed->second + "\" is none");
    }
    const auto rule = row.values.find("rule"), shape = row.values.find("shape");
    if (rule != row.values.end()) {
      std::string shapes;
      const auto found = std::find_if(starts.begin(), starts.end(), [&](const NamedStart& start) {
        if (start.name != rule->second) return false;
        if (shapes.find(start.shape) == std::string::npos) shapes += (shapes.empty() ? "" : ", ") + start.shape;
        return shape == row.values.end() || shape->second == start.shape;
      });
      if (found == starts.end() && !shapes.empty())
        place.fail(row.line, "the grammar does not start \"" + rule->second + "\" with shape \"" + shape->second +
                                 "\", only with: " + shapes);
      if (found == starts.end()) {
        const bool linked = starts[0].name.find('.') != std::string::npos;
        place.fail(row.line, "the grammar has no rule \"" + rule->second + "\"" +
                                 (linked ? "; expected a grammar, or its rule as in " + starts[0].name : ""));
      }
      axiom.rule = static_cast<uint32_t>(found - starts.begin());
    } else if (shape != row.values.end()) {
      place.fail(row.line, "a shape needs the rule that starts with it");
    }
    axiom.attribute = number("attribute", axiom.attribute);
    axioms.push_back(axiom);
  }
  if (axioms.empty()) throw Failure(place.file + ": there are no axioms in it");
  return axioms;
}

} // namespace gpgp::cli
