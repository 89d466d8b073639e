// Derives a .cga program on the CPU: shapes, breadth first, from polygons or rectangles in the ground plane.
//
// Results depend on the program, the axioms and their seeds only: neither on the number of threads nor on the order in
// which shapes are derived, since random numbers are keyed by the path to a shape (shaders/core/random.h).
#pragma once
#include "spawn/cga/modules.h"
#include "spawn/cga/program.h"
#include "spawn/cga/surroundings.h"
#include "spawn/shared/layout.h"

#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <string>
#include <vector>

namespace gpgp::spawn::cga {

/// Values of the edges of an axiom's polygon, in the order of its points, as texts; what is missing is empty.
struct EdgeAttribute {
  std::string name;
  std::vector<std::string> values;
  bool isString = true; ///< not all of them are numbers, true or false
};

/// A field of the world (shaders/spawn/shared/field.h), which functions and attributes read by name.
struct WorldField {
  std::string name;
  shader::FieldGrid grid{};
  const float* values = nullptr; ///< from the grid's first one on
};

/// Where the origin of the world lies: degrees.
struct GeographicPlace {
  double longitude = 0, latitude = 0;
};
constexpr double kMetresOfADegree = 111319.490793; ///< of latitude

/// A start shape. World space, metres, y up.
struct Axiom {
  std::vector<glm::vec3> points;   ///< of a polygon, empty: a rectangle
  std::vector<uint32_t> loopSizes; ///< points of its outline, then of each hole
  glm::vec3 origin{0};             ///< of a rectangle: its corner of least x and z, before rotation
  glm::vec3 axisX{1, 0, 0}, axisY{0, 1, 0}, axisZ{0, 0, 1};
  glm::vec3 size{1, 0, 1}; ///< of a rectangle; with a height it is a box
  uint32_t seed = 1;
  std::string name;
  std::string where; ///< for messages about it: "lots.json:3:5"
  std::vector<AttributeValue> attributes;
  /// Of the street beside each edge of the polygon, 0: none; empty: nothing is known of streets.
  std::vector<float> streetWidths;
  std::vector<EdgeAttribute> edgeAttributes;
};

/// A file's triangles for i(): positions and indices, and the names that the file has for their groups and materials.
struct Asset {
  std::vector<glm::vec3> positions;
  std::vector<uint32_t> indices;
  std::vector<std::string> groups, materials;
};

struct DeriveOptions {
  uint32_t maxDepth = 2000;            ///< rules that follow one another
  uint64_t maxShapes = 4'000'000;      ///< of one axiom
  uint32_t maxFunctionDepth = 512;     ///< functions that call one another
  uint32_t maxInstructions = 1u << 24; ///< of one rule
  uint32_t maxFaces = 250'000;         ///< of one shape
  uint32_t maxVertices = 1'000'000;    ///< of one shape
  uint32_t maxGeometryMiB = 2048;      ///< of all meshes that one axiom makes, and of the triangles that are kept
  uint64_t maxWork = 1'000'000'000;    ///< of one axiom's geometry: words written and corners looked at
  uint32_t threads = 0;                ///< 0: as many as the machine has; not with parallelFor
  /// Calls work that often, on as many threads as there are. None: threads of its own.
  std::function<void(uint32_t count, const std::function<void()>& work)> parallelFor;
  bool keepTriangles = true; ///< else they are only counted
  bool keepScopes = false;   ///< Derivation::scopes
  std::vector<AttributeValue> attributes;
  /// An attr of a field's name has the field's value at the middle of the axiom, where nothing else sets it.
  std::vector<WorldField> fields;
  std::optional<GeographicPlace> origin;
  /// Reads a file for i(); false: it cannot, and text says why.
  std::function<bool(const std::string& path, Asset& asset, std::string& text)> loadAsset;
  bool assetsAreFiles = true; ///< loadAsset gets paths of files on the disk alone
  /// Shapes that context queries see beyond their axiom; null: derive() derives all axioms once more to find them,
  /// where the program asks.
  const Surroundings* surroundings = nullptr;
  uint32_t firstAxiom = 0; ///< the number that the first axiom has there
};

/// A shape in which a derivation ends.
struct Leaf {
  uint32_t name = 0; ///< of Derivation::names: the rule that it ended in
  uint32_t axiom = 0;
  uint32_t texture = 0; ///< of Derivation::names; 0: none
  glm::vec4 color{1};   ///< sRGB, and opacity
  uint32_t firstIndex = 0, indexCount = 0;
};

/// Where a leaf is, as an instance of an operator graph says it.
struct LeafScope {
  glm::vec3 centre, x, y, z; ///< world space; axes of the length of its extents. A polygon faces z, of length 1
  glm::uvec2 key;      ///< of the path: instanceKey() of shaders/spawn/shared/shape.h makes GpgpInstance::key of it
  bool isQuad = false; ///< or another polygon in its plane
};

struct Vertex {
  glm::vec3 position, normal;
  glm::vec2 uv;
};

struct Report {
  uint64_t count = 0;
  double sum = 0, least = 0, most = 0;
};

struct Derivation {
  std::vector<Leaf> leaves;       ///< in the order of axioms
  std::vector<std::string> names; ///< 0 is empty
  std::vector<LeafScope> scopes;  ///< of the leaves, where DeriveOptions::keepScopes asks for them
  std::vector<Vertex> vertices;
  std::vector<uint32_t> indices;
  std::map<std::string, Report> reports;
  std::vector<std::string> prints; ///< what print() said, in order, up to kMostPrints
  uint64_t printed = 0;
  uint64_t shapes = 0;    ///< that rules were run on
  uint64_t triangles = 0; ///< of all leaves
  uint32_t depth = 0;     ///< of the deepest shape
  uint64_t work = 0;      ///< steps of the axiom that needed most, of DeriveOptions::maxWork
  static constexpr size_t kMostPrints = 1000;
};

/// Messages get what went wrong on the way, once a kind, with its place; exceeded limits are errors.
Derivation derive(const Program& program, const std::vector<Axiom>& axioms, const DeriveOptions& options,
                  Messages& messages);

/// Adds what context queries of other axioms may see of these, whose numbers begin at options.firstAxiom: what they
/// derive to where no query looks beyond its own axiom.
void addSurroundings(const Program& program, const std::vector<Axiom>& axioms, const DeriveOptions& options,
                     Surroundings& surroundings);

/// A value that an attribute has where nobody sets it.
struct FirstValue {
  uint32_t type = 0; ///< kCgaFloat and so on (shaders/spawn/cga/program_format.h)
  double number = 0;
  std::string text;
  std::vector<std::string> elements; ///< of an array
};
/// By slots of attributes, on a lot of 1 x 1 metres with seed 1.
std::vector<FirstValue> firstValues(const Program& program, const DeriveOptions& options, Messages& messages);

/// Puts a part behind what there is. places: of the part's names, in all.names.
void append(Derivation& all, Derivation&& part, const std::vector<uint32_t>& places);

} // namespace gpgp::spawn::cga
