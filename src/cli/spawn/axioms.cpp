// Both formats become rows of named values with their places; one class makes axioms of rows.
#include "cli/spawn/axioms.h"

#include "cli/shared/command.h"
#include "cli/spawn/grammar_source.h"
#include "host/files.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <sstream>

namespace gpgp::cli {
namespace {

/// What stands in a file, and where.
struct Cell {
  std::string text;
  spawn::Place place;
  bool isWrong = false; ///< which was reported
};

struct Row {
  spawn::Place place;
  std::map<std::string, Cell, std::less<>> cells;
};

constexpr std::array<std::string_view, 4> kQuaternion = {"qx", "qy", "qz", "qw"};
constexpr std::array<std::string_view, 12> kTransform = {"m00", "m01", "m02", "m03", "m10", "m11",
                                                         "m12", "m13", "m20", "m21", "m22", "m23"};
constexpr std::array<std::string_view, 11> kOtherColumns = {"x",      "y",    "z",    "rotation", "size_x",   "size_y",
                                                            "size_z", "seed", "rule", "shape",    "attribute"};

bool isColumn(std::string_view name) {
  const auto isOf = [&](const auto& list) { return std::find(list.begin(), list.end(), name) != list.end(); };
  return isOf(kOtherColumns) || isOf(kQuaternion) || isOf(kTransform);
}

/// For messages: files may hold anything.
std::string quoted(const std::string& text) {
  constexpr size_t kMost = 40;
  return '"' + (text.size() <= kMost ? text : text.substr(0, kMost) + "...") + '"';
}

std::string_view trimmed(std::string_view text) {
  const auto isSpace = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && isSpace(text.front())) text.remove_prefix(1);
  while (!text.empty() && isSpace(text.back())) text.remove_suffix(1);
  return text;
}

std::vector<Cell> cells(std::string_view line, uint32_t number) {
  std::vector<Cell> result;
  for (size_t at = 0; at <= line.size();) {
    const size_t end = std::min(line.find(',', at), line.size());
    const std::string_view content = trimmed(line.substr(at, end - at));
    const size_t begin = content.empty() ? at : static_cast<size_t>(content.data() - line.data());
    result.push_back({std::string(content), {number, static_cast<uint32_t>(begin + 1)}});
    at = end + 1;
  }
  return result;
}

/// Empty where one of its columns is none.
std::vector<std::string> columnsOf(const std::vector<Cell>& header, spawn::Diagnostics& errors) {
  std::vector<std::string> columns;
  const size_t before = errors.errorCount();
  for (const Cell& cell : header) {
    if (!isColumn(cell.text))
      errors.error(cell.place,
                   quoted(cell.text) +
                       " is not a column; the first line names some of x, y, z, rotation, qx, qy, qz, qw, m00 "
                       "to m23, size_x, size_y, size_z, seed, rule, shape, attribute");
    else if (std::find(columns.begin(), columns.end(), cell.text) != columns.end())
      errors.error(cell.place, "two columns are named " + quoted(cell.text));
    columns.push_back(cell.text);
  }
  return errors.errorCount() == before ? columns : std::vector<std::string>();
}

std::vector<Row> readCsv(const std::string& text, spawn::Diagnostics& errors) {
  std::vector<Row> rows;
  std::vector<std::string> columns;
  std::istringstream lines(text);
  std::string line;
  for (uint32_t number = 1; std::getline(lines, line); ++number) {
    const std::string_view content = std::string_view(line).substr(0, line.find('#'));
    if (trimmed(content).empty()) continue;
    std::vector<Cell> values = cells(content, number);
    if (columns.empty()) {
      columns = columnsOf(values, errors);
      if (columns.empty()) return {}; // nobody knows what the others mean
      continue;
    }
    if (values.size() != columns.size()) {
      errors.error(values[0].place,
                   std::to_string(values.size()) + " values for " + std::to_string(columns.size()) + " columns");
      continue;
    }
    Row row{values[0].place, {}};
    for (size_t i = 0; i < values.size(); ++i)
      if (!values[i].text.empty()) row.cells[columns[i]] = std::move(values[i]);
    rows.push_back(std::move(row));
  }
  return rows;
}

spawn::Place placeOf(const std::string& text, size_t offset) {
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(offset, text.size()));
  const auto lineBegin = std::find(std::make_reverse_iterator(end), text.rend(), '\n').base();
  return {static_cast<uint32_t>(1 + std::count(text.begin(), end, '\n')), static_cast<uint32_t>(1 + (end - lineBegin))};
}

/// Where each value of the outermost array begins; the text is valid JSON.
std::vector<spawn::Place> placesOfValues(const std::string& text) {
  std::vector<spawn::Place> places;
  spawn::Place at{1, 0};
  size_t depth = 0;
  bool quotes = false, first = false, escaped = false;
  for (const char c : text) {
    ++at.column;
    if (c == '\n') at = {at.line + 1, 0};
    if (quotes) {
      quotes = escaped || c != '"';
      escaped = !escaped && c == '\\';
      continue;
    }
    if (c == ' ' || c == '\n' || c == '\t' || c == '\r') continue;
    if (depth == 1 && first && c != ']') {
      places.push_back(at);
      first = false;
    }
    if (c == '"') quotes = true;
    if (c == '[' || c == '{') first = ++depth == 1;
    if (c == ']' || c == '}') --depth;
    if (c == ',' && depth == 1) first = true;
  }
  return places;
}

Row rowOf(const Json& object, spawn::Place place, spawn::Diagnostics& errors) {
  Row row{place, {}};
  const auto number = [&](const std::string& name, const Json& value, std::string_view key) {
    row.cells[std::string(key)] = {value.dump(), place, !value.is_number()};
    if (!value.is_number()) errors.error(place, name + " takes numbers");
  };
  const auto list = [&](const std::string& name, const Json& values, std::span<const std::string_view> names,
                        const char* text) {
    if (!values.is_array() || values.size() != names.size()) {
      errors.error(place, name + " takes " + text);
      for (const std::string_view key : names) row.cells[std::string(key)] = {{}, place, true};
      return;
    }
    for (size_t i = 0; i < names.size(); ++i) number(name, values[i], names[i]);
  };
  constexpr std::array<std::string_view, 3> kPosition = {"x", "y", "z"}, kSize = {"size_x", "size_y", "size_z"};
  for (const auto& [name, value] : object.items()) {
    if (name == "position") {
      list(name, value, kPosition, "three numbers, [x, y, z]");
    } else if (name == "size") {
      list(name, value, kSize, "three numbers, [x, y, z]");
    } else if (name == "quaternion") {
      list(name, value, kQuaternion, "four numbers, [x, y, z, w]");
    } else if (name == "transform") {
      list(name, value, kTransform, "twelve numbers, the rows of a 3x4 matrix");
    } else if (name == "rotation" || name == "seed" || name == "attribute") {
      number(name, value, name);
    } else if (name == "rule" || name == "shape") {
      row.cells[name] = {value.is_string() ? value.get<std::string>() : std::string(), place, !value.is_string()};
      if (!value.is_string()) errors.error(place, std::string(name).append(" takes a ").append(name).append("'s name"));
    } else {
      errors.error(place, quoted(name) +
                              " is unknown; there are position, rotation, quaternion, transform, size, seed, "
                              "rule, shape, attribute");
    }
  }
  return row;
}

Json parseJson(const std::string& text, spawn::Diagnostics& errors) {
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    errors.error(placeOf(text, error.byte ? error.byte - 1 : 0), error.what());
  } catch (const Json::exception& error) { // a number beyond all numbers, without its place
    errors.error({}, error.what());
  }
  return {};
}

std::vector<Row> rowsOfArray(const std::string& text, const Json& all, spawn::Diagnostics& errors) {
  const std::vector<spawn::Place> places = placesOfValues(text);
  std::vector<Row> rows;
  for (size_t i = 0; i < all.size(); ++i) {
    if (all[i].is_object())
      rows.push_back(rowOf(all[i], places[i], errors));
    else
      errors.error(places[i], "expected an object with position, rotation, size, seed, rule");
  }
  return rows;
}

// ---------------------------------------------------------------- GeoJSON

/// Points, and lines with a row at intervals, become rows; properties that rows have as well are theirs.
class GeoJsonRows {
public:
  GeoJsonRows(const std::string& text, float interval, spawn::Diagnostics& errors)
      : text_(text), interval_(interval), errors_(errors) {}

  std::vector<Row> read(const Json& all) {
    const std::string type = typeOf(all);
    const auto features = all.find("features");
    if (type != "FeatureCollection") {
      place_ = placeOf(text_, text_.find('{'));
      type == "Feature" ? feature(all) : geometry(all, Json::object());
      return std::move(rows_);
    }
    if (features == all.end() || !features->is_array()) {
      errors_.error(placeOf(text_, text_.find('{')), "a FeatureCollection needs an array of features");
      return {};
    }
    const size_t key = text_.find("\"features\""), begin = text_.find('[', key);
    std::vector<spawn::Place> places = placesOfValues(text_.substr(begin));
    const spawn::Place start = placeOf(text_, begin);
    for (size_t i = 0; i < features->size(); ++i) {
      place_ = start;
      if (i < places.size())
        place_ = {start.line + places[i].line - 1, places[i].column + (places[i].line == 1 ? start.column - 1 : 0)};
      feature((*features)[i]);
    }
    return std::move(rows_);
  }

private:
  static std::string typeOf(const Json& object) {
    const auto type = object.is_object() ? object.find("type") : object.end();
    return type != object.end() && type->is_string() ? type->get<std::string>() : std::string();
  }
  void feature(const Json& feature) {
    const auto properties = feature.find("properties"), shape = feature.find("geometry");
    if (typeOf(feature) != "Feature") return errors_.error(place_, "expected an object of type \"Feature\"");
    if (shape == feature.end() || shape->is_null()) return; // allowed, and without a place
    Json known = Json::object();
    if (properties != feature.end() && properties->is_object())
      for (const char* name : {"size", "seed", "rule", "shape", "attribute"})
        if (const auto found = properties->find(name); found != properties->end()) known[name] = *found;
    geometry(*shape, known);
  }
  void geometry(const Json& geometry, const Json& properties) {
    const std::string type = typeOf(geometry);
    const auto list = geometry.is_object() ? geometry.find("coordinates") : geometry.end();
    if (type.empty()) return errors_.error(place_, "expected GeoJSON: an object with a type, such as LineString");
    if (type == "GeometryCollection" && geometry.contains("geometries") && geometry["geometries"].is_array()) {
      for (const Json& one : geometry["geometries"]) this->geometry(one, properties);
      return;
    }
    const bool isPoint = type == "Point", many = type == "MultiPoint" || type == "MultiLineString";
    if (!isPoint && !many && type != "LineString")
      return errors_.error(place_, quoted(type) +
                                       " is not a geometry for axioms; those are points and lines (polygons: of "
                                       ".cga files)");
    if (list == geometry.end() || !list->is_array()) return errors_.error(place_, "a " + type + " needs coordinates");
    if (type == "MultiLineString")
      for (const Json& one : *list) line(one, properties);
    else if (type == "MultiPoint")
      for (const Json& one : *list) point(one, properties);
    else
      isPoint ? point(*list, properties) : line(*list, properties);
  }

  /// x east, y up, z south.
  std::optional<std::array<double, 3>> vertex(const Json& place) {
    const auto isNumber = [&](size_t i) { return i < place.size() && place[i].is_number(); };
    if (!place.is_array() || !isNumber(0) || !isNumber(1)) {
      errors_.error(place_, "a place is an array of two or three numbers");
      return std::nullopt;
    }
    return std::array{place[0].get<double>(), isNumber(2) ? place[2].get<double>() : 0.0, -place[1].get<double>()};
  }
  void point(const Json& place, const Json& properties) {
    if (const auto p = vertex(place)) row(*p, 0, properties);
  }
  /// As many axioms as intervals fit, at least one, each in the middle of its part; X along the line.
  void line(const Json& places, const Json& properties) {
    std::vector<std::array<double, 3>> points;
    if (places.is_array())
      for (const Json& place : places) {
        const auto p = vertex(place);
        if (!p) return;
        points.push_back(*p);
      }
    if (points.size() < 2) return errors_.error(place_, "a line needs at least two places");
    std::vector<double> ends{0}; // of its segments
    for (size_t i = 1; i < points.size(); ++i)
      ends.push_back(ends.back() + std::hypot(points[i][0] - points[i - 1][0], points[i][1] - points[i - 1][1],
                                              points[i][2] - points[i - 1][2]));
    const double length = ends.back(), fitting = std::floor(length / interval_ + 1e-6);
    if (!(length > 0)) return errors_.error(place_, "this line has no length");
    if (!(fitting <= kMostOfALine))
      return errors_.error(place_, "this line would have more than 10 million axioms; raise --interval");
    const auto count = static_cast<size_t>(std::max(fitting, 1.0));
    size_t segment = 1;
    for (size_t i = 0; i < count; ++i) {
      const double at = (static_cast<double>(i) + 0.5) * length / static_cast<double>(count);
      while (segment + 1 < points.size() && ends[segment] < at) ++segment;
      const auto &a = points[segment - 1], &b = points[segment];
      const double t = (at - ends[segment - 1]) / (ends[segment] - ends[segment - 1]);
      row({a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])},
          std::atan2(a[2] - b[2], b[0] - a[0]) * 57.29577951308232, properties);
    }
  }
  void row(const std::array<double, 3>& place, double rotation, const Json& properties) {
    Json object = properties;
    object["position"] = {place[0], place[1], place[2]};
    object["rotation"] = rotation;
    rows_.push_back(rowOf(object, place_, errors_));
  }

  static constexpr double kMostOfALine = 1e7;
  const std::string& text_;
  const double interval_;
  spawn::Diagnostics& errors_;
  spawn::Place place_; // of the feature
  std::vector<Row> rows_;
};

// ---------------------------------------------------------------- axioms

/// An axiom of a row; what is wrong is said, and then the axiom is of no use.
class RowReader {
public:
  RowReader(const Row& row, const std::vector<NamedStart>& starts, const AxiomDefaults& defaults, uint32_t id,
            spawn::Diagnostics& errors)
      : row_(row), starts_(starts), defaults_(defaults), id_(id), errors_(errors) {}

  GpgpAxiom axiom() {
    std::array<float, 3> size{};
    for (size_t axis = 0; axis < 3; ++axis) {
      const std::string name = std::string("size_") + "xyz"[axis];
      size[axis] = number(name, defaults_.size[axis]);
      if (!(size[axis] > 0)) errors_.error(placeOf(name), "sizes are above 0");
    }
    GpgpAxiom axiom = axiomAt({number("x", 0), number("y", 0), number("z", 0)}, number("rotation", 0), size,
                              defaults_.seed + id_, id_);
    const bool turned = isComplete(kQuaternion), placed = isComplete(kTransform);
    if (turned) turn(axiom, size);
    if (placed)
      for (size_t i = 0; i < kTransform.size(); ++i) axiom.transform[i] = number(kTransform[i], 0);
    if (turned && has("rotation")) errors_.error(placeOf("rotation"), "rotation or a quaternion, not both");
    for (const char* name : {"x", "y", "z", "rotation", "qx"})
      if (placed && has(name)) errors_.error(placeOf(name), std::string(name) + " stands beside a whole transform");
    for (const char* needed : {"x", "z"})
      if (!placed && !has(needed)) errors_.error(row_.place, std::string("an axiom needs a value for ") + needed);
    if (isRead("seed")) axiom.seed = seed();
    if (defaults_.starts.size() == 1) axiom.start = defaults_.starts[0]; // of --start
    if (isRead("rule"))
      axiom.start = rule();
    else if (has("shape") && !has("rule"))
      errors_.error(placeOf("shape"), "a shape needs the rule that starts with it");
    axiom.attribute = number("attribute", axiom.attribute);
    return axiom;
  }

private:
  bool has(std::string_view name) const { return row_.cells.find(name) != row_.cells.end(); }
  bool isRead(std::string_view name) const { return has(name) && !row_.cells.find(name)->second.isWrong; }
  spawn::Place placeOf(std::string_view name) const {
    const auto found = row_.cells.find(name);
    return found == row_.cells.end() ? row_.place : found->second.place;
  }
  const std::string& textOf(std::string_view name) const { return row_.cells.find(name)->second.text; }

  float number(std::string_view name, float otherwise) {
    if (!isRead(name)) return otherwise;
    const std::string& text = textOf(name);
    float value = 0;
    const char* end = text.data() + text.size();
    const auto [at, error] = std::from_chars(text.data(), end, value);
    if (error == std::errc() && at == end && std::isfinite(value)) return value;
    errors_.error(placeOf(name), std::string(name) + " takes a number; " + quoted(text) + " is none");
    return otherwise;
  }

  uint32_t seed() {
    const std::string& text = textOf("seed");
    uint32_t value = 0;
    const char* end = text.data() + text.size();
    const auto [at, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || at != end)
      errors_.error(placeOf("seed"), "seed takes a whole number from 0 to 4294967295; " + quoted(text) + " is none");
    return value;
  }

  /// Whether all of these are there; some of them are not enough.
  template <size_t N> bool isComplete(const std::array<std::string_view, N>& names) {
    const size_t count = static_cast<size_t>(std::count_if(names.begin(), names.end(), [&](auto n) { return has(n); }));
    if (count && count < N)
      errors_.error(row_.place, "an axiom with some of " + std::string(names.front()) + " to " +
                                    std::string(names.back()) + " needs all " + std::to_string(N));
    return count == N;
  }

  /// By the quaternion, of any length. It stands on its place along its own Y.
  void turn(GpgpAxiom& axiom, const std::array<float, 3>& size) {
    double q[4], length = 0;
    for (size_t i = 0; i < 4; ++i) {
      q[i] = static_cast<double>(number(kQuaternion[i], 1)); // what is wrong was reported: no length of 0 besides
      length += q[i] * q[i];
    }
    if (!(length > 0)) {
      errors_.error(placeOf("qx"), "a quaternion of length 0 turns nowhere");
      return;
    }
    const double x = q[0], y = q[1], z = q[2], w = q[3], s = 2 / length;
    const double turned[9] = {1 - s * (y * y + z * z), s * (x * y - z * w),     s * (x * z + y * w),
                              s * (x * y + z * w),     1 - s * (x * x + z * z), s * (y * z - x * w),
                              s * (x * z - y * w),     s * (y * z + x * w),     1 - s * (x * x + y * y)};
    for (size_t r = 0; r < 3; ++r) {
      for (size_t c = 0; c < 3; ++c) axiom.transform[4 * r + c] = static_cast<float>(turned[3 * r + c]);
      axiom.transform[4 * r + 3] =
          number(std::string_view("xyz").substr(r, 1), 0) + axiom.transform[4 * r + 1] * size[1] * 0.5f;
    }
  }

  uint32_t rule() {
    const std::string &name = textOf("rule"), shape = has("shape") ? textOf("shape") : std::string();
    std::string shapes;
    for (size_t i = 0; i < starts_.size(); ++i) {
      if (starts_[i].name != name) continue;
      if (shape.empty() || shape == starts_[i].shape) return static_cast<uint32_t>(i);
      if (shapes.find(starts_[i].shape) == std::string::npos) shapes += (shapes.empty() ? "" : ", ") + starts_[i].shape;
    }
    const bool linked = starts_[0].name.find('.') != std::string::npos;
    if (!shapes.empty())
      errors_.error(placeOf("shape"), "the grammar does not start " + quoted(name) + " with shape " + quoted(shape) +
                                          ", only with: " + shapes);
    else
      errors_.error(placeOf("rule"), "the grammar has no rule " + quoted(name) +
                                         (linked ? "; expected a grammar, or its rule as in " + starts_[0].name : ""));
    return GPGP_AXIOM_DEFAULT_START;
  }

  const Row& row_;
  const std::vector<NamedStart>& starts_;
  const AxiomDefaults& defaults_;
  const uint32_t id_;
  spawn::Diagnostics& errors_;
};

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
  axiom.start = GPGP_AXIOM_DEFAULT_START;
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
    axioms.back().start = defaults.starts[i % defaults.starts.size()];
  }
  return axioms;
}

std::vector<GpgpAxiom> readAxioms(const std::filesystem::path& file, const std::vector<NamedStart>& starts,
                                  const AxiomDefaults& defaults) {
  std::string text = host::readText(file);
  if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3); // spreadsheets write it
  const size_t begin = text.find_first_not_of(" \t\r\n");
  const bool json = begin != std::string::npos && (text[begin] == '[' || text[begin] == '{');
  spawn::Diagnostics errors;
  std::vector<GpgpAxiom> axioms;
  std::vector<Row> rows;
  if (json) {
    const Json all = parseJson(text, errors);
    if (defaults.interval > 0 && !(all.is_object() && all.contains("type")))
      throw Usage("--interval is for lines of GeoJSON, which " + file.string() + " is not");
    if (all.is_array()) rows = rowsOfArray(text, all, errors);
    if (all.is_object() && all.contains("type"))
      rows = GeoJsonRows(text, defaults.interval > 0 ? defaults.interval : defaults.size[0], errors).read(all);
    else if (all.is_object())
      errors.error(placeOf(text, text.find('{')), "expected an array of axioms, [{...}, {...}], or GeoJSON");
  } else {
    if (defaults.interval > 0) throw Usage("--interval is for lines of GeoJSON, which " + file.string() + " is not");
    rows = readCsv(text, errors);
  }
  for (const Row& row : rows)
    axioms.push_back(RowReader(row, starts, defaults, static_cast<uint32_t>(axioms.size()), errors).axiom());
  report(errors, file.string());
  if (axioms.empty()) throw Failure(file.string() + ": there are no axioms in it");
  return axioms;
}

} // namespace gpgp::cli
