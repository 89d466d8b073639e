// Start shapes of .cga files: rectangles on a grid, rows of the axiom files that all grammars take, and polygons of
// GeoJSON files.
#include "cli/shared/command.h"
#include "cli/shared/messages.h"
#include "cli/spawn/axioms.h"
#include "cli/spawn/cga.h"
#include "cli/spawn/grammar_source.h"
#include "host/files.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace gpgp::cli {

namespace {

using spawn::cga::Axiom;

/// The rectangle that an axiom stands on.
Axiom rectangle(const GpgpAxiom& from, const std::string& where) {
  const float* m = from.transform;
  Axiom axiom;
  axiom.axisX = glm::normalize(glm::vec3(m[0], m[4], m[8]));
  axiom.axisY = glm::normalize(glm::vec3(m[1], m[5], m[9]));
  axiom.axisZ = glm::normalize(glm::vec3(m[2], m[6], m[10]));
  axiom.size = {from.size[0], 0, from.size[2]};
  const glm::vec3 middle(m[3], m[7], m[11]);
  axiom.origin = middle - axiom.axisX * (from.size[0] * 0.5f) - axiom.axisY * (from.size[1] * 0.5f) -
                 axiom.axisZ * (from.size[2] * 0.5f);
  axiom.seed = from.seed;
  axiom.where = where;
  return axiom;
}

/// A polygon that is a level rectangle becomes one, with the scope that the polygon would have: x along its first edge.
void toRectangle(Axiom& axiom) {
  if (axiom.points.size() != 4 || axiom.loopSizes.size() != 1) return;
  if (!axiom.streetWidths.empty() || !axiom.edgeAttributes.empty()) return; // which belong to its edges
  const auto& p = axiom.points;
  const glm::vec3 x = p[1] - p[0], z = p[0] - p[3];
  const float width = glm::length(x), depth = glm::length(z), rounding = 1e-4f * (width + depth);
  const bool isLevel = p[0].y == p[1].y && p[1].y == p[2].y && p[2].y == p[3].y;
  const bool isParallel = glm::length(p[2] - p[3] - x) <= rounding;
  if (!isLevel || !isParallel || !(width > 0) || !(depth > 0)) return;
  if (std::fabs(glm::dot(x, z)) > 1e-4f * width * depth) return;
  axiom.axisX = x / width;
  axiom.axisY = {0, 1, 0};
  axiom.axisZ = glm::cross(axiom.axisX, axiom.axisY);
  axiom.size = {width, 0, depth};
  axiom.origin = p[3];
  axiom.points.clear();
  axiom.loopSizes.clear();
}

/// Reads what GeoJSON may hold. All errors are said with the number of the feature.
class GeoJson {
public:
  GeoJson(const CgaOptions& options, const std::vector<std::string>& names) : options_(options), names_(names) {}

  CgaAxioms read(const Json& all) {
    const std::string type = text(all, "type");
    if (type == "FeatureCollection") {
      const auto features = all.find("features");
      if (features == all.end() || !features->is_array()) fail("a FeatureCollection needs an array of features");
      for (const Json& feature : *features) {
        ++number_;
        this->feature(feature);
      }
    } else if (type == "Feature") {
      feature(all);
    } else {
      geometry(all, Json::object());
    }
    if (result_.axioms.empty()) throw Failure(options_.axiomFile + ": there are no polygons in it");
    toMetres();
    return std::move(result_);
  }

private:
  std::string where() const {
    return options_.axiomFile + (number_ ? ": feature " + std::to_string(number_) : std::string());
  }
  [[noreturn]] void fail(const std::string& what) const { throw Failure(where() + ": " + what); }
  static std::string text(const Json& object, const char* name) {
    const auto found = object.is_object() ? object.find(name) : object.end();
    return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
  }

  void feature(const Json& feature) {
    if (text(feature, "type") != "Feature") fail("expected an object of type \"Feature\"");
    const auto properties = feature.find("properties");
    const auto geometry = feature.find("geometry");
    if (geometry == feature.end() || geometry->is_null()) return; // allowed, and without a place
    this->geometry(*geometry, properties != feature.end() && properties->is_object() ? *properties : Json::object());
  }

  void geometry(const Json& geometry, const Json& properties) {
    const std::string type = text(geometry, "type");
    if (type == "GeometryCollection" && geometry.contains("geometries") && geometry["geometries"].is_array()) {
      for (const Json& one : geometry["geometries"]) this->geometry(one, properties);
      return;
    }
    const auto found = geometry.is_object() ? geometry.find("coordinates") : geometry.end();
    if (type != "Polygon" && type != "MultiPolygon") {
      if (type.empty()) fail("expected GeoJSON: an object with a type, such as FeatureCollection or Polygon");
      std::fprintf(stderr, "%s: warning: a geometry of type \"%s\" is left out; axioms are polygons\n", where().c_str(),
                   type.substr(0, 40).c_str());
      return;
    }
    if (found == geometry.end() || !found->is_array()) fail("a " + type + " needs coordinates");
    if (type == "Polygon")
      polygon(*found, properties);
    else
      for (const Json& one : *found) polygon(one, properties);
  }

  void polygon(const Json& rings, const Json& properties) {
    if (!rings.is_array() || rings.empty()) fail("a polygon needs an outline");
    Axiom axiom;
    std::vector<bool> turned; // rings
    for (const Json& ring : rings) {
      if (!ring.is_array()) fail("a polygon's ring is an array of places");
      std::vector<glm::dvec3> points;
      for (const Json& place : ring) {
        if (!place.is_array() || place.size() < 2 || !place[0].is_number() || !place[1].is_number())
          fail("a place is an array of two or three numbers");
        const double height = place.size() > 2 && place[2].is_number() ? place[2].get<double>() : 0.0;
        const glm::dvec3 point(place[0].get<double>(), place[1].get<double>(), height);
        if (!std::isfinite(point.x) || !std::isfinite(point.y) || !std::isfinite(point.z))
          fail("a place is not finite");
        points.push_back(point);
      }
      if (points.size() > 1 && points.front() == points.back()) points.pop_back();
      if (points.size() < 3) fail("a polygon's ring needs at least three places");
      // Counter-clockwise seen from above, holes clockwise.
      double area = 0;
      for (size_t i = 0; i < points.size(); ++i) {
        const glm::dvec3 &a = points[i], &b = points[(i + 1) % points.size()];
        area += a.x * b.y - a.y * b.x;
      }
      const bool turns = (area < 0) == axiom.loopSizes.empty();
      if (turns) std::reverse(points.begin(), points.end());
      turned.push_back(turns);
      if (axiom.loopSizes.empty()) streets(properties, points.size(), turns, axiom);
      axiom.loopSizes.push_back(static_cast<uint32_t>(points.size()));
      places_.insert(places_.end(), points.begin(), points.end());
    }
    edges(properties, turned, axiom);
    axiom.seed = options_.seed + static_cast<uint32_t>(result_.axioms.size());
    axiom.where = where();
    std::string rule;
    for (const auto& [name, value] : properties.items()) {
      if (name == "seed" && value.is_number_integer()) axiom.seed = value.get<uint32_t>();
      if (name == "rule" && value.is_string()) rule = value.get<std::string>();
      if (name == "name" && value.is_string()) axiom.name = value.get<std::string>();
      if (value.is_string()) axiom.attributes.push_back({name, value.get<std::string>()});
      if (value.is_number() || value.is_boolean()) axiom.attributes.push_back({name, value.dump()});
    }
    if (!rule.empty() && std::find(names_.begin(), names_.end(), rule) == names_.end())
      fail("the grammar has no rule \"" + rule.substr(0, 60) + "\" without parameters");
    result_.axioms.push_back(std::move(axiom));
    result_.rules.push_back(std::move(rule));
  }

  /// "/edgeattr/NAME": an array of a value for each edge of the outline, or of all rings. turned: those that were
  /// reversed.
  void edges(const Json& properties, const std::vector<bool>& turned, Axiom& axiom) const {
    size_t all = 0;
    for (const uint32_t size : axiom.loopSizes) all += size;
    for (const auto& [key, list] : properties.items()) {
      constexpr std::string_view kPrefix = "/edgeattr/";
      if (!key.starts_with(kPrefix)) continue;
      const std::string name = printable(key);
      if (!list.is_array() || (list.size() != axiom.loopSizes[0] && list.size() != all))
        fail("\"" + name + "\" is an array of a value for each of the " + std::to_string(axiom.loopSizes[0]) +
             " edges of the outline, or of all rings");
      spawn::cga::EdgeAttribute attribute{key.substr(kPrefix.size()), {}, false};
      size_t first = 0;
      for (size_t ring = 0; ring < axiom.loopSizes.size() && first < list.size(); ++ring) {
        const size_t count = axiom.loopSizes[ring];
        for (size_t i = 0; i < count; ++i) {
          const Json& value = list[first + (turned[ring] ? (2 * count - 2 - i) % count : i)];
          if (!value.is_string() && !value.is_number() && !value.is_boolean())
            fail("\"" + name + "\" holds numbers, strings, true and false");
          attribute.isString = attribute.isString || value.is_string();
          attribute.values.push_back(value.is_string() ? value.get<std::string>() : value.dump());
        }
        first += count;
      }
      axiom.edgeAttributes.push_back(std::move(attribute));
    }
  }

  /// "streetWidth": of all edges of the outline, or an array of one for each; turned: the outline was reversed.
  void streets(const Json& properties, size_t edges, bool turned, Axiom& axiom) const {
    const auto found = properties.find("streetWidth");
    if (found == properties.end() || found->is_null()) return;
    const bool isArray = found->is_array();
    if (!isArray && !found->is_number()) fail("\"streetWidth\" is a number, or an array of a number for each edge");
    if (isArray && found->size() != edges)
      fail("\"streetWidth\" has " + std::to_string(found->size()) + " numbers; the outline has " +
           std::to_string(edges) + " edges");
    for (size_t i = 0; i < edges; ++i) {
      const Json& width = isArray ? (*found)[turned ? (2 * edges - 2 - i) % edges : i] : *found;
      if (!width.is_number()) fail("\"streetWidth\" is a number, or an array of a number for each edge");
      axiom.streetWidths.push_back(width.get<float>());
    }
  }

  /// x east, z south, y up; around the middle of all where they are degrees.
  void toMetres() {
    glm::dvec3 low(1e300), high(-1e300);
    for (const glm::dvec3& p : places_) {
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
    glm::dvec2 scale(1), origin(0);
    if (options_.geographic) {
      if (std::fabs(low.x) > 360 || std::fabs(high.x) > 360 || std::fabs(low.y) > 90 || std::fabs(high.y) > 90)
        throw Failure(options_.axiomFile + ": these are not longitudes and latitudes; leave --geographic out");
      origin = glm::dvec2(low + high) * 0.5;
      scale.y = spawn::cga::kMetresOfADegree;
      scale.x = scale.y * std::cos(origin.y * 0.017453292519943295);
      result_.origin = spawn::cga::GeographicPlace{origin.x, origin.y};
    } else if (std::max(high.x - low.x, high.y - low.y) < 0.05) {
      std::fprintf(stderr, "%s: warning: all polygons lie within 5 cm; --geographic takes coordinates as degrees\n",
                   options_.axiomFile.c_str());
    }
    size_t at = 0;
    for (Axiom& axiom : result_.axioms)
      for (const uint32_t size : axiom.loopSizes)
        for (uint32_t i = 0; i < size; ++i, ++at)
          axiom.points.push_back({static_cast<float>((places_[at].x - origin.x) * scale.x),
                                  static_cast<float>(places_[at].z),
                                  static_cast<float>((origin.y - places_[at].y) * scale.y)});
    for (Axiom& axiom : result_.axioms) toRectangle(axiom);
  }

  const CgaOptions& options_;
  const std::vector<std::string>& names_;
  CgaAxioms result_;
  std::vector<glm::dvec3> places_; // of all loops of all axioms
  uint32_t number_ = 0;
};

} // namespace

CgaAxioms cgaAxioms(const CgaOptions& options, const std::vector<std::string>& names) {
  CgaAxioms result;
  const AxiomDefaults defaults{options.size, options.seed, {GPGP_AXIOM_DEFAULT_START}};
  if (options.axiomFile.empty()) {
    for (const GpgpAxiom& axiom : axiomGrid(std::max(options.axioms, 1u), options.spacing, defaults))
      result.axioms.push_back(rectangle(axiom, {}));
    result.rules.resize(result.axioms.size());
    return result;
  }
  std::string text = host::readText(options.axiomFile);
  if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);
  const size_t begin = text.find_first_not_of(" \t\r\n");
  if (begin != std::string::npos && text[begin] == '{') {
    Json all;
    try {
      all = Json::parse(text);
    } catch (const Json::exception& error) {
      throw Failure(options.axiomFile + ": " + error.what());
    }
    return GeoJson(options, names).read(all);
  }
  if (options.geographic) throw Usage("--geographic is for GeoJSON files");
  std::vector<NamedStart> starts;
  for (const std::string& name : names) starts.push_back({name, {}});
  if (starts.empty()) starts.push_back({});
  uint32_t number = 0;
  for (const GpgpAxiom& axiom : readAxioms(options.axiomFile, starts, defaults)) {
    result.axioms.push_back(rectangle(axiom, options.axiomFile + ": axiom " + std::to_string(++number)));
    result.rules.push_back(axiom.start < names.size() ? names[axiom.start] : std::string());
  }
  return result;
}

} // namespace gpgp::cli
