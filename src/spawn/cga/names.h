// What CGA calls its operations, functions, attributes of shapes and selectors: the one table of each.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace gpgp::spawn::cga {

// Operations on shapes: name, fewest and most values, what block follows them. A row is all that the compiler needs;
// the function of its name in operations*.cpp does the work. componentValues is comp(f) { ... } as a value.
#define GPGP_CGA_OPERATIONS(X)                                                                                         \
  X(extrude, 1, 3, none)                                                                                               \
  X(comp, 1, 2, parts)                                                                                                 \
  X(split, 1, 3, parts)                                                                                                \
  X(splitArea, 1, 2, parts)                                                                                            \
  X(setback, 1, 2, parts)                                                                                              \
  X(setbackPerEdge, 1, 2, parts)                                                                                       \
  X(setbackToArea, 1, 2, parts)                                                                                        \
  X(splitAndSetbackPerimeter, 1, 3, parts)                                                                             \
  X(shapeL, 2, 2, parts)                                                                                               \
  X(shapeU, 3, 3, parts)                                                                                               \
  X(shapeO, 4, 4, parts)                                                                                               \
  X(innerRectangle, 1, 1, parts)                                                                                       \
  X(scatter, 3, 6, body)                                                                                               \
  X(inline, 0, 1, body)                                                                                                \
  X(union, 0, 1, body)                                                                                                 \
  X(subtract, 0, 1, body)                                                                                              \
  X(intersect, 0, 1, body)                                                                                             \
  X(modify, 1, 2, parts)                                                                                               \
  X(componentValues, 1, 2, parts)                                                                                      \
  X(offset, 1, 2, none)                                                                                                \
  X(innerRect, 0, 0, none)                                                                                             \
  X(taper, 1, 1, none)                                                                                                 \
  X(roofGable, 1, 6, none)                                                                                             \
  X(roofHip, 1, 4, none)                                                                                               \
  X(roofPyramid, 1, 3, none)                                                                                           \
  X(roofShed, 1, 3, none)                                                                                              \
  X(roofRidge, 1, 2, none)                                                                                             \
  X(envelope, 2, 10, none)                                                                                             \
  X(t, 3, 3, none)                                                                                                     \
  X(s, 3, 3, none)                                                                                                     \
  X(r, 3, 4, none)                                                                                                     \
  X(translate, 5, 5, none)                                                                                             \
  X(rotate, 5, 5, none)                                                                                                \
  X(center, 1, 1, none)                                                                                                \
  X(rotateScope, 3, 3, none)                                                                                           \
  X(mirror, 3, 3, none)                                                                                                \
  X(mirrorScope, 3, 3, none)                                                                                           \
  X(setPivot, 2, 2, none)                                                                                              \
  X(alignScopeToAxes, 0, 1, none)                                                                                      \
  X(alignScopeToGeometry, 2, 3, none)                                                                                  \
  X(alignScopeToGeometryBBox, 0, 1, none)                                                                              \
  X(color, 1, 4, none)                                                                                                 \
  X(texture, 1, 1, none)                                                                                               \
  X(setMaterial, 1, 1, none)                                                                                           \
  X(resetMaterial, 0, 1, none)                                                                                         \
  X(report, 2, 2, none)                                                                                                \
  X(print, 1, 1, none)                                                                                                 \
  X(label, 1, 1, none)                                                                                                 \
  X(i, 1, 4, none)                                                                                                     \
  X(insertAlongUV, 3, 5, none)                                                                                         \
  X(primitiveQuad, 0, 2, none)                                                                                         \
  X(primitiveCube, 0, 3, none)                                                                                         \
  X(primitiveDisk, 0, 2, none)                                                                                         \
  X(primitiveCylinder, 0, 3, none)                                                                                     \
  X(primitiveSphere, 0, 3, none)                                                                                       \
  X(primitiveCone, 0, 3, none)                                                                                         \
  X(cleanupGeometry, 1, 2, none)                                                                                       \
  X(convexify, 0, 1, none)                                                                                             \
  X(deleteHoles, 0, 1, none)                                                                                           \
  X(reverseNormals, 0, 0, none)                                                                                        \
  X(setNormals, 1, 1, none)                                                                                            \
  X(softenNormals, 1, 1, none)                                                                                         \
  X(footprint, 0, 0, none)                                                                                             \
  X(trim, 0, 0, none)                                                                                                  \
  X(rectify, 1, 1, none)                                                                                               \
  X(reduceGeometry, 1, 1, none)                                                                                        \
  X(resetGeometry, 0, 0, none)                                                                                         \
  X(setupProjection, 2, 7, none)                                                                                       \
  X(projectUV, 1, 1, none)                                                                                             \
  X(translateUV, 3, 3, none)                                                                                           \
  X(offsetUV, 3, 3, none)                                                                                              \
  X(scaleUV, 3, 3, none)                                                                                               \
  X(rotateUV, 2, 4, none)                                                                                              \
  X(tileUV, 3, 3, none)                                                                                                \
  X(normalizeUV, 3, 3, none)                                                                                           \
  X(copyUV, 2, 2, none)                                                                                                \
  X(deleteUV, 1, 1, none)                                                                                              \
  X(tag, 1, 2, none)                                                                                                   \
  X(setTagsFromEdgeAttrs, 0, 0, none)                                                                                  \
  X(deleteTags, 0, 2, none)

// Set by set(name, value) although they are no attributes of the file.
#define GPGP_CGA_SETTABLE(X)                                                                                           \
  X(scope_tx)                                                                                                          \
  X(scope_ty)                                                                                                          \
  X(scope_tz)                                                                                                          \
  X(scope_rx)                                                                                                          \
  X(scope_ry)                                                                                                          \
  X(scope_rz)                                                                                                          \
  X(scope_sx)                                                                                                          \
  X(scope_sy)                                                                                                          \
  X(scope_sz)                                                                                                          \
  X(trim_horizontal)                                                                                                   \
  X(trim_vertical)                                                                                                     \
  X(material_color_r)                                                                                                  \
  X(material_color_g)                                                                                                  \
  X(material_color_b)                                                                                                  \
  X(material_opacity)                                                                                                  \
  X(material_colormap)                                                                                                 \
  X(material_rgb)                                                                                                      \
  X(material_color_rgb)                                                                                                \
  X(seedian)

// What the compiler writes between operations, for random numbers; no name of the language leads here. Paths are those
// of operator graphs (docs/internals/spawn.md): what a program draws on the CPU, its graph draws on the GPU.
#define GPGP_CGA_PATHS(X)                                                                                              \
  X(fork)      /* what comes next is the first of two ways from here */                                                \
  X(rest)      /* and now the second one */                                                                            \
  X(drawn)     /* numbers that were drawn are over: the key changes */                                                 \
  X(drawsFrom) /* the numbers of the value that comes next are counted from its own place on */

// Functions that ask the shape, the file system, or compute with strings and arrays: name, fewest and most values.
#define GPGP_CGA_FUNCTIONS(X)                                                                                          \
  X(str, 1, 1)                                                                                                         \
  X(float, 1, 1)                                                                                                       \
  X(bool, 1, 1)                                                                                                        \
  X(sel, 1, 1)                                                                                                         \
  X(len, 1, 1)                                                                                                         \
  X(substring, 2, 3)                                                                                                   \
  X(find, 2, 3)                                                                                                        \
  X(findFirst, 2, 2)                                                                                                   \
  X(findLast, 2, 2)                                                                                                    \
  X(replace, 3, 3)                                                                                                     \
  X(count, 2, 2)                                                                                                       \
  X(getPrefix, 2, 2)                                                                                                   \
  X(getSuffix, 2, 2)                                                                                                   \
  X(getRange, 3, 3)                                                                                                    \
  X(splitString, 2, 2)                                                                                                 \
  X(toUpper, 1, 1)                                                                                                     \
  X(toLower, 1, 1)                                                                                                     \
  X(listItem, 2, 2)                                                                                                    \
  X(listSize, 1, 1)                                                                                                    \
  X(listFirst, 1, 1)                                                                                                   \
  X(listLast, 1, 1)                                                                                                    \
  X(listRandom, 1, 1)                                                                                                  \
  X(listIndex, 2, 2)                                                                                                   \
  X(listRange, 3, 3)                                                                                                   \
  X(listAdd, 2, 2)                                                                                                     \
  X(listRemove, 2, 2)                                                                                                  \
  X(listRemoveAll, 2, 2)                                                                                               \
  X(listRetainAll, 2, 2)                                                                                               \
  X(listClean, 1, 1)                                                                                                   \
  X(listCount, 2, 2)                                                                                                   \
  X(listTerminate, 1, 1)                                                                                               \
  X(listToArray, 1, 1)                                                                                                 \
  X(listFromArray, 1, 1)                                                                                               \
  X(size, 1, 1)                                                                                                        \
  X(nRows, 1, 1)                                                                                                       \
  X(nColumns, 1, 1)                                                                                                    \
  X(sum, 1, 1)                                                                                                         \
  X(index, 2, 2)                                                                                                       \
  X(findFirstIndex, 2, 2)                                                                                              \
  X(sortIndices, 1, 1)                                                                                                 \
  X(sort, 1, 1)                                                                                                        \
  X(transpose, 1, 1)                                                                                                   \
  X(setElems, 3, 4)                                                                                                    \
  X(sortRowIndices, 1, 1)                                                                                              \
  X(isNull, 1, 1)                                                                                                      \
  X(arrayRows, 1, 2000)                                                                                                \
  X(sequence, 2, 3)                                                                                                    \
  X(eachAnd, 2, 2)                                                                                                     \
  X(eachOr, 2, 2)                                                                                                      \
  X(eachNot, 1, 1)                                                                                                     \
  X(componentResult, 0, 0)                                                                                             \
  X(floatArray, 0, 3)                                                                                                  \
  X(boolArray, 0, 3)                                                                                                   \
  X(stringArray, 0, 3)                                                                                                 \
  X(fileExists, 1, 1)                                                                                                  \
  X(fileSearch, 1, 1)                                                                                                  \
  X(fileRandom, 1, 1)                                                                                                  \
  X(filesSearch, 1, 1)                                                                                                 \
  X(fileName, 1, 1)                                                                                                    \
  X(fileBasename, 1, 1)                                                                                                \
  X(fileExtension, 1, 1)                                                                                               \
  X(fileDirectory, 1, 1)                                                                                               \
  X(readTextFile, 1, 1)                                                                                                \
  X(readStringTable, 1, 2)                                                                                             \
  X(readFloatTable, 1, 2)                                                                                              \
  X(colorHexToR, 1, 1)                                                                                                 \
  X(colorHexToG, 1, 1)                                                                                                 \
  X(colorHexToB, 1, 1)                                                                                                 \
  X(colorHexToO, 1, 1)                                                                                                 \
  X(colorHexToH, 1, 1)                                                                                                 \
  X(colorHexToS, 1, 1)                                                                                                 \
  X(colorHexToV, 1, 1)                                                                                                 \
  X(colorHSVToHex, 3, 3)                                                                                               \
  X(colorHSVOToHex, 4, 4)                                                                                              \
  X(colorRGBToHex, 3, 3)                                                                                               \
  X(colorRGBOToHex, 4, 4)                                                                                              \
  X(colorRamp, 2, 2)                                                                                                   \
  X(clamp, 3, 3)                                                                                                       \
  X(assetInfo, 2, 2)                                                                                                   \
  X(assetNamingInfo, 2, 2)                                                                                             \
  X(assetNamingInfos, 2, 2)                                                                                            \
  X(assetMetadata, 3, 3)                                                                                               \
  X(assetsSortSize, 3, 3)                                                                                              \
  X(assetsSortRatio, 2, 2)                                                                                             \
  X(assetBestSize, 2, 2)                                                                                               \
  X(assetBestRatio, 2, 2)                                                                                              \
  X(assetApproxSize, 3, 3)                                                                                             \
  X(assetApproxRatio, 3, 3)                                                                                            \
  X(assetFitSize, 3, 3)                                                                                                \
  X(imageInfo, 2, 2)                                                                                                   \
  X(imagesSortRatio, 2, 2)                                                                                             \
  X(imageBestRatio, 2, 2)                                                                                              \
  X(imageApproxRatio, 3, 3)                                                                                            \
  X(readMaterial, 1, 1)                                                                                                \
  X(getMaterial, 2, 2)                                                                                                 \
  X(printed, 1, 1)                                                                                                     \
  X(Field, 1, 3)                                                                                                       \
  X(getGeoCoord, 1, 1)                                                                                                 \
  X(edgeAttr_getFloat, 1, 1)                                                                                           \
  X(edgeAttr_getString, 1, 1)                                                                                          \
  X(edgeAttr_getBool, 1, 1)                                                                                            \
  X(convert, 4, 7)                                                                                                     \
  X(geometry_area, 0, 1)                                                                                               \
  X(geometry_volume, 0, 0)                                                                                             \
  X(geometry_height, 0, 1)                                                                                             \
  X(geometry_nVertices, 0, 0)                                                                                          \
  X(geometry_nEdges, 0, 0)                                                                                             \
  X(geometry_nFaces, 0, 0)                                                                                             \
  X(geometry_nHoles, 0, 0)                                                                                             \
  X(geometry_isConcave, 0, 0)                                                                                          \
  X(geometry_isPlanar, 0, 1)                                                                                           \
  X(geometry_isRectangular, 0, 1)                                                                                      \
  X(geometry_isClosedSurface, 0, 0)                                                                                    \
  X(geometry_isOriented, 0, 1)                                                                                         \
  X(geometry_isInstanced, 0, 0)                                                                                        \
  X(geometry_boundaryLength, 0, 1)                                                                                     \
  X(geometry_angle, 1, 1)                                                                                              \
  X(geometry_du, 2, 2)                                                                                                 \
  X(geometry_dv, 2, 2)                                                                                                 \
  X(geometry_uMin, 0, 1)                                                                                               \
  X(geometry_uMax, 0, 1)                                                                                               \
  X(geometry_vMin, 0, 1)                                                                                               \
  X(geometry_vMax, 0, 1)                                                                                               \
  X(geometry_hasUVs, 0, 1)                                                                                             \
  X(geometry_isTagged, 1, 2)                                                                                           \
  X(geometry_hasTags, 0, 2)                                                                                            \
  X(geometry_tags, 0, 2)                                                                                               \
  X(isTagged, 1, 2)                                                                                                    \
  X(inside, 0, 2)                                                                                                      \
  X(overlaps, 0, 2)                                                                                                    \
  X(touches, 0, 2)                                                                                                     \
  X(minimumDistance, 1, 2)                                                                                             \
  X(contextCount, 2, 2)                                                                                                \
  X(contextCompare, 3, 3)                                                                                              \
  X(scope_tx, 0, 0)                                                                                                    \
  X(scope_ty, 0, 0)                                                                                                    \
  X(scope_tz, 0, 0)                                                                                                    \
  X(scope_rx, 0, 0)                                                                                                    \
  X(scope_ry, 0, 0)                                                                                                    \
  X(scope_rz, 0, 0)                                                                                                    \
  X(scope_sx, 0, 0)                                                                                                    \
  X(scope_sy, 0, 0)                                                                                                    \
  X(scope_sz, 0, 0)                                                                                                    \
  X(scope_elevation, 0, 0)                                                                                             \
  X(pivot_px, 0, 0)                                                                                                    \
  X(pivot_py, 0, 0)                                                                                                    \
  X(pivot_pz, 0, 0)                                                                                                    \
  X(pivot_ox, 0, 0)                                                                                                    \
  X(pivot_oy, 0, 0)                                                                                                    \
  X(pivot_oz, 0, 0)                                                                                                    \
  X(split_index, 0, 0)                                                                                                 \
  X(split_total, 0, 0)                                                                                                 \
  X(comp_index, 0, 0)                                                                                                  \
  X(comp_total, 0, 0)                                                                                                  \
  X(comp_sel, 0, 0)                                                                                                    \
  X(initialShape_name, 0, 0)                                                                                           \
  X(initialShape_startRule, 0, 0)                                                                                      \
  X(initialShape_origin_px, 0, 0)                                                                                      \
  X(initialShape_origin_py, 0, 0)                                                                                      \
  X(initialShape_origin_pz, 0, 0)                                                                                      \
  X(initialShape_origin_ox, 0, 0)                                                                                      \
  X(initialShape_origin_oy, 0, 0)                                                                                      \
  X(initialShape_origin_oz, 0, 0)                                                                                      \
  X(trim_horizontal, 0, 0)                                                                                             \
  X(trim_vertical, 0, 0)                                                                                               \
  X(material_color_r, 0, 0)                                                                                            \
  X(material_color_g, 0, 0)                                                                                            \
  X(material_color_b, 0, 0)                                                                                            \
  X(material_rgb, 0, 0)                                                                                                \
  X(material_color_rgb, 0, 0)                                                                                          \
  X(material_opacity, 0, 0)                                                                                            \
  X(material_colormap, 0, 0)                                                                                           \
  X(seedian, 0, 0)                                                                                                     \
  X(getTreeKey, 0, 0)

// Their names have points where the enumerators have underscores: geometry.area is geometry_area.

enum class Block : uint8_t { none, parts, body };

enum class Operation : uint32_t {
#define GPGP_CGA_ENUMERATOR(name, least, most, block) name##_,
  GPGP_CGA_OPERATIONS(GPGP_CGA_ENUMERATOR)
#undef GPGP_CGA_ENUMERATOR
#define GPGP_CGA_ENUMERATOR(name) set_##name,
      GPGP_CGA_SETTABLE(GPGP_CGA_ENUMERATOR)
#undef GPGP_CGA_ENUMERATOR
#define GPGP_CGA_ENUMERATOR(name) path_##name,
          GPGP_CGA_PATHS(GPGP_CGA_ENUMERATOR)
#undef GPGP_CGA_ENUMERATOR
              count
};
enum class Function : uint32_t {
#define GPGP_CGA_ENUMERATOR(name, least, most) name##_,
  GPGP_CGA_FUNCTIONS(GPGP_CGA_ENUMERATOR)
#undef GPGP_CGA_ENUMERATOR
      count
};

struct OperationInfo {
  std::string_view name;
  uint32_t least, most;
  Block block;
};
struct FunctionInfo {
  std::string_view name; ///< with points
  uint32_t least, most;
  bool isMath;     ///< of GPGP_CGA_MATH
  uint32_t number; ///< in its list
};

const OperationInfo& operationInfo(Operation operation);
std::optional<Operation> findOperation(std::string_view name);
/// Which values of an operation, or a function, are words: bit i is value i. There a word is no name of the file.
uint32_t wordArguments(std::string_view name, size_t count);
/// What set(name, ...) does where it is no attribute.
std::optional<Operation> findSettable(std::string_view name);
std::optional<FunctionInfo> findFunction(std::string_view name);
/// A word that operations take as a value: world.up, yUp, surface.
bool isSelector(std::string_view name);
/// What CGA has and gpgp has not: they are named by a warning, and do nothing.
bool isUnsupportedOperation(std::string_view name);
bool isUnsupportedFunction(std::string_view name);
std::span<const std::string_view> operationNames();
std::span<const std::string_view> functionNames();
std::span<const std::string_view> selectorNames();

} // namespace gpgp::spawn::cga
