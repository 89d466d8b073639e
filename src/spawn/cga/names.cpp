#include "spawn/cga/names.h"

#include "spawn/cga/program_format.h"

#include <algorithm>
#include <array>
#include <string>
#include <unordered_map>
#include <vector>

namespace gpgp::spawn::cga {
namespace {

constexpr OperationInfo kOperations[] = {
#define GPGP_CGA_ROW(name, least, most, block) {#name, least, most, Block::block},
    GPGP_CGA_OPERATIONS(GPGP_CGA_ROW)
#undef GPGP_CGA_ROW
};
constexpr std::string_view kSettable[] = {
#define GPGP_CGA_ROW(name) #name,
    GPGP_CGA_SETTABLE(GPGP_CGA_ROW)
#undef GPGP_CGA_ROW
};
constexpr FunctionInfo kFunctions[] = {
#define GPGP_CGA_ROW(name, least, most) {#name, least, most, false, static_cast<uint32_t>(Function::name##_)},
    GPGP_CGA_FUNCTIONS(GPGP_CGA_ROW)
#undef GPGP_CGA_ROW
};
constexpr FunctionInfo kMath[] = {
#define GPGP_CGA_ROW(name, text, least, most) {text, least, most, true, shader::kCga##name##Math},
    GPGP_CGA_MATH(GPGP_CGA_ROW)
#undef GPGP_CGA_ROW
};

constexpr std::string_view kSelectors[] = {"x",
                                           "y",
                                           "z",
                                           "xy",
                                           "xz",
                                           "yz",
                                           "xyz",
                                           "yzx",
                                           "zxy",
                                           "u",
                                           "v",
                                           "uv",
                                           "uvUniform",
                                           "uvSpace",
                                           "unitSpace",
                                           "f",
                                           "e",
                                           "fe",
                                           "v",
                                           "g",
                                           "h",
                                           "m",
                                           "front",
                                           "back",
                                           "left",
                                           "right",
                                           "top",
                                           "bottom",
                                           "side",
                                           "object.front",
                                           "object.back",
                                           "object.left",
                                           "object.right",
                                           "object.top",
                                           "object.bottom",
                                           "object.side",
                                           "world.south",
                                           "world.north",
                                           "world.west",
                                           "world.east",
                                           "world.up",
                                           "world.down",
                                           "world.side",
                                           "world.front",
                                           "world.back",
                                           "world.left",
                                           "world.right",
                                           "world.top",
                                           "world.bottom",
                                           "street.front",
                                           "street.back",
                                           "street.left",
                                           "street.right",
                                           "street.side",
                                           "vertical",
                                           "horizontal",
                                           "aslant",
                                           "nutant",
                                           "border",
                                           "inside",
                                           "eave",
                                           "hip",
                                           "valley",
                                           "ridge",
                                           "all",
                                           "remainder",
                                           "shape",
                                           "scope",
                                           "edge",
                                           "surface",
                                           "volume",
                                           "uniform",
                                           "gaussian",
                                           "center",
                                           "yUp",
                                           "zUp",
                                           "xUp",
                                           "any",
                                           "largest",
                                           "longest",
                                           "world.lowest",
                                           "world",
                                           "object",
                                           "rel",
                                           "abs",
                                           "face.normal",
                                           "vertex.normal",
                                           "world.x",
                                           "world.y",
                                           "world.z",
                                           "world.up.flatTop",
                                           "world.xy",
                                           "world.xz",
                                           "world.yx",
                                           "world.yz",
                                           "world.zx",
                                           "world.zy",
                                           "scope.xy",
                                           "scope.xz",
                                           "scope.yx",
                                           "scope.yz",
                                           "scope.zx",
                                           "scope.zy",
                                           "scope.x",
                                           "scope.y",
                                           "scope.z",
                                           "scopeOrigin",
                                           "adjust",
                                           "noAdjust",
                                           "separatePerFace",
                                           "collectiveAllFaces",
                                           "edges",
                                           "vertices",
                                           "faces",
                                           "maxSlope",
                                           "minSlope",
                                           "azimuth",
                                           "intra",
                                           "inter",
                                           "scopeSize",
                                           "material",
                                           "convex",
                                           "concave",
                                           "floor",
                                           "aboveGround",
                                           "index",
                                           "keepSizeAndPosition",
                                           "alignSizeAndPosition",
                                           "scopeCenter",
                                           "zx",
                                           "zy",
                                           "yx",
                                           "pos",
                                           "dir",
                                           "auto",
                                           "pivot",
                                           "vertexNormal",
                                           "first",
                                           "last",
                                           "bezier",
                                           "front.all",
                                           "closest",
                                           "orient",
                                           "byAngle",
                                           "byHeight",
                                           "normal",
                                           "append",
                                           "unify",
                                           "recompose",
                                           "swap",
                                           "noSwap",
                                           "alignPosition",
                                           "keepPosition",
                                           "sx",
                                           "sy",
                                           "sz",
                                           "tx",
                                           "ty",
                                           "tz",
                                           "hard",
                                           "soft",
                                           "conform",
                                           "used",
                                           "changed",
                                           "geometry",
                                           "alignScope",
                                           "noAlign",
                                           "lon",
                                           "lat",
                                           "world.northernmost",
                                           "world.southernmost",
                                           "world.easternmost",
                                           "world.westernmost",
                                           "world.highest",
                                           "area.largest",
                                           "area.smallest"};

// Operations of CGA that are not there yet; their blocks are passed over.
constexpr std::string_view kUnsupportedOperations[] = {"insert",     "deleteMaterial", "roofMansard",  "polygon",
                                                       "rectangle",  "shapeH",         "setElevation", "snap",
                                                       "pointCloud", "readImage",      "tube",         "sweep"};
constexpr std::string_view kUnsupportedFunctions[] = {"geoCoordinate",   "readBoolTable", "shapeAttr",
                                                      "getObjectAttr",   "getUniqueId",   "geometry.isTexturedBy",
                                                      "geometry.setback"};
// What the compiler writes for other notations: no name of the language leads there.
constexpr std::string_view kHidden[] = {"componentValues", "arrayRows", "sequence",       "eachAnd",
                                        "eachOr",          "eachNot",   "componentResult"};
template <size_t N> bool contains(const std::string_view (&list)[N], std::string_view name) {
  return std::find(std::begin(list), std::end(list), name) != std::end(list);
}

std::string withPoints(std::string_view name) {
  std::string text(name);
  for (const std::string_view part : {"scope_", "geometry_", "pivot_", "split_", "comp_", "initialShape_origin_",
                                      "initialShape_", "material_color_", "material_", "trim_", "edgeAttr_"})
    if (text.starts_with(part)) {
      std::replace(text.begin(), text.end(), '_', '.');
      break;
    }
  return text;
}

struct Index {
  std::vector<std::string> texts; // what the views below see
  std::unordered_map<std::string_view, uint32_t> operations, settable, functions, math;
  std::vector<std::string_view> operationNames, functionNames;

  Index() {
    texts.reserve(std::size(kFunctions) + std::size(kSettable));
    for (uint32_t i = 0; i < std::size(kOperations); ++i) {
      if (contains(kHidden, kOperations[i].name)) continue;
      operations[kOperations[i].name] = i;
      operationNames.push_back(kOperations[i].name);
    }
    for (uint32_t i = 0; i < std::size(kSettable); ++i) {
      texts.push_back(withPoints(kSettable[i]));
      settable[texts.back()] = i;
    }
    for (uint32_t i = 0; i < std::size(kFunctions); ++i) {
      texts.push_back(withPoints(kFunctions[i].name));
      if (texts.back() == "printed") texts.back() = "print"; // an operation has the name too
      if (contains(kHidden, texts.back())) continue;
      functions[texts.back()] = i;
      functionNames.push_back(texts.back());
    }
    for (uint32_t i = 0; i < std::size(kMath); ++i) {
      math[kMath[i].name] = i;
      functionNames.push_back(kMath[i].name);
    }
  }
};
const Index& index() {
  static const Index all; // constant
  return all;
}

} // namespace

const OperationInfo& operationInfo(Operation operation) { return kOperations[static_cast<uint32_t>(operation)]; }

std::optional<Operation> findOperation(std::string_view name) {
  const auto found = index().operations.find(name);
  if (found == index().operations.end()) return std::nullopt;
  return static_cast<Operation>(found->second);
}

uint32_t wordArguments(std::string_view name, size_t count) {
  struct Row {
    std::string_view name;
    uint32_t bits;
    size_t least; // values
  };
  constexpr Row kRows[] = {{"comp", 3, 1},
                           {"modify", 3, 1},
                           {"setNormals", 1, 1},
                           {"roofRidge", 1, 1},
                           {"resetMaterial", 1, 1},
                           {"getMaterial", 3, 2},
                           {"assetsSortSize", 2, 2},
                           {"assetsSortRatio", 2, 2},
                           {"assetBestSize", 2, 2},
                           {"assetBestRatio", 2, 2},
                           {"assetApproxSize", 2, 2},
                           {"assetApproxRatio", 2, 2},
                           {"assetFitSize", 2, 2},
                           {"imageInfo", 2, 2},
                           {"imagesSortRatio", 2, 2},
                           {"split", 3, 1},
                           {"splitArea", 3, 1},
                           {"inline", 1, 1},
                           {"union", 1, 1},
                           {"subtract", 1, 1},
                           {"intersect", 1, 1},
                           {"insertAlongUV", 0x18, 4},
                           {"tag", 2, 2},
                           {"deleteTags", 2, 2},
                           {"isTagged", 2, 2},
                           {"geometry.isTagged", 2, 2},
                           {"geometry.hasTags", 2, 2},
                           {"geometry.tags", 2, 2},
                           {"assetInfo", 2, 2},
                           {"assetNamingInfo", 2, 2},
                           {"assetNamingInfos", 2, 2},
                           {"getGeoCoord", 1, 1},
                           {"contextCompare", 5, 3},
                           {"scatter", 0xd, 1},
                           {"center", 1, 1},
                           {"innerRectangle", 1, 1},
                           {"offset", 2, 2},
                           {"extrude", 1, 2},
                           {"envelope", 1, 1},
                           {"r", 1, 4},
                           {"rotate", 3, 5},
                           {"translate", 3, 5},
                           {"setPivot", 1, 2},
                           {"alignScopeToAxes", 1, 1},
                           {"alignScopeToGeometry", 7, 1},
                           {"alignScopeToGeometryBBox", 1, 1},
                           {"cleanupGeometry", 1, 1},
                           {"setupProjection", 2, 1},
                           {"normalizeUV", 6, 1},
                           {"convert", 0xf, 5},
                           {"convert", 7, 4},
                           {"roofGable", 1, 1},
                           {"roofHip", 1, 1},
                           {"roofShed", 1, 1},
                           {"roofPyramid", 1, 1},
                           {"geometry.angle", 1, 1},
                           {"geometry.du", 2, 1},
                           {"geometry.dv", 2, 1},
                           {"geometry.area", 1, 1},
                           {"geometry.height", 1, 1},
                           {"inside", 1, 1},
                           {"overlaps", 1, 1},
                           {"touches", 1, 1},
                           {"minimumDistance", 1, 1},
                           {"contextCount", 1, 1}};
  for (const Row& row : kRows)
    if (row.name == name && count >= row.least) return row.bits;
  return 0;
}

std::optional<Operation> findSettable(std::string_view name) {
  const auto found = index().settable.find(name);
  if (found == index().settable.end()) return std::nullopt;
  return static_cast<Operation>(std::size(kOperations) + found->second);
}

std::optional<FunctionInfo> findFunction(std::string_view name) {
  if (const auto found = index().math.find(name); found != index().math.end()) return kMath[found->second];
  const auto found = index().functions.find(name);
  if (found == index().functions.end()) return std::nullopt;
  FunctionInfo info = kFunctions[found->second];
  info.name = found->first;
  return info;
}

bool isSelector(std::string_view name) { return contains(kSelectors, name); }
bool isUnsupportedOperation(std::string_view name) { return contains(kUnsupportedOperations, name); }
bool isUnsupportedFunction(std::string_view name) {
  return contains(kUnsupportedFunctions, name) || name.starts_with("edgeAttr.") || name.starts_with("trim.") ||
         name.starts_with("initialShape.") || name.starts_with("geometry.") || name.starts_with("readImage.");
}
std::span<const std::string_view> operationNames() { return index().operationNames; }
std::span<const std::string_view> functionNames() { return index().functionNames; }
std::span<const std::string_view> selectorNames() { return kSelectors; }

} // namespace gpgp::spawn::cga
