// The geometry of shapes: polygons with holes and meshes in a pool, and the operators of grammars on them.
//
// Conventions. A form is a mesh in a scope (shaders/spawn/geometry/pool.h). Lengths are metres and angles degrees. "The
// frame" is the frame of the axiom: right-handed, y up. The operators that derivations on the GPU need as well are
// functions of shaders/spawn/geometry/, which this header's functions call; all results are equal on all devices.
//
// Errors. Each operator returns a status and leaves its arguments as they were unless that is kGeometryOk, or
// kGeometryEmpty: nothing is left, and the mesh is 0. A failed operator keeps nothing in the pool. Meshes are never
// changed, so copies of a form are cheap and stay valid until the pool is cleared.
#pragma once
#include "spawn/geometry/pool.h"

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace gpgp::spawn {

using shader::Form;
using shader::MeshPool;
using shader::Scope;
using Status = shader::uint; ///< kGeometry... of pool.h
using shader::vec2;
using shader::vec3;

/// A pool with its memory. capacity: words of all meshes; work: words of one operator's workspace.
class GeometryPool : public MeshPool {
public:
  explicit GeometryPool(uint32_t capacityWords = 1u << 22, uint32_t workWords = 1u << 20);
  /// Forgets all meshes and counts.
  void clear();

private:
  std::vector<uint32_t> words_, work_;
};

/// One sentence without a full stop: "the polygon touches or crosses itself".
std::string_view describeStatus(Status status);

// ---------------------------------------------------------------- making

/// A polygon from points in the frame, in a plane but for rounding. loopSizes: points of the outer loop, then of each
/// hole; either orientation is taken, the outer loop's decides the normal (counter-clockwise seen from its tip). Points
/// that repeat the one before are left out. The scope: x along the first edge, y along the normal, tight.
/// kGeometryNotSimple, kGeometryNotPlanar, kGeometryTooLarge, kGeometryBadArgument (fewer than 3 points).
Status makePolygon(MeshPool& pool, std::span<const vec3> points, std::span<const uint32_t> loopSizes, Form& form);

/// A mesh as files have it. corners: vertex of each corner, faces one behind the other; faceSizes: corners of each
/// face; uvs: empty, or one for each corner. form: scope and mesh in the frame's axes, tight.
Status makeMesh(MeshPool& pool, std::span<const vec3> positions, std::span<const uint32_t> corners,
                std::span<const uint32_t> faceSizes, std::span<const vec2> uvs, Form& form);

enum class Primitive { Quad, Cube, Disk, Cylinder, Sphere, Cone };
/// Replaces the geometry by a primitive that fills the scope; extents of 0 become 1 (but for y of Quad and Disk, which
/// lie in the scope's xz plane with their normal along y). sides: of a disk, cylinder or cone (3 and more), segments of
/// a sphere; rings: of a sphere (2 and more). Cylinder and cone stand along y. Texture set 0 covers each face.
Status insertPrimitive(MeshPool& pool, Form& form, Primitive primitive, uint32_t sides = 16, uint32_t rings = 8);

/// Replaces the geometry by another form's, fitted to the scope. Extents of the scope that are 0 follow from the
/// asset's proportions (all 0: the asset's size).
Status insertForm(MeshPool& pool, Form& form, const Form& asset);

/// The faces of all forms in one mesh, in the first form's scope axes; the scope is tight.
Status combine(MeshPool& pool, std::span<const Form> forms, Form& combined);

// ---------------------------------------------------------------- measures

struct Bounds {
  vec3 low, high;
};
uint32_t faceCount(const MeshPool& pool, const Form& form);
uint32_t edgeCount(MeshPool& pool, const Form& form);   ///< edges that faces share count once
uint32_t vertexCount(MeshPool& pool, const Form& form); ///< places that vertices share count once
/// Of one face in the frame, unit length; 0 where it has no area.
vec3 faceNormal(const MeshPool& pool, const Form& form, uint32_t face);
float faceArea(const MeshPool& pool, const Form& form, uint32_t face);
float area(const MeshPool& pool, const Form& form);         ///< of all faces, square metres
float volume(const MeshPool& pool, const Form& form);       ///< of a closed mesh; 0 of an open one
Bounds scopeBounds(const MeshPool& pool, const Form& form); ///< along the scope's axes, from its origin, metres
Bounds frameBounds(const MeshPool& pool, const Form& form); ///< along the frame's axes
vec3 centroid(const MeshPool& pool, const Form& form); ///< in the frame; of the volume of closed meshes, else the area
bool isClosedSurface(MeshPool& pool, const Form& form);
bool isConcave(const MeshPool& pool, const Form& form);     ///< a face has a hole or a corner above 180 degrees
bool isPlanar(const MeshPool& pool, const Form& form);      ///< all faces lie in one plane
bool isRectangular(const MeshPool& pool, const Form& form); ///< one face of four right angles
/// Of a face's corner, inside, degrees.
float cornerAngle(const MeshPool& pool, const Form& form, uint32_t face, uint32_t corner);
/// Smallest and largest texture coordinates of a set.
void uvBounds(const MeshPool& pool, const Form& form, uint32_t set, vec2& low, vec2& high);

// ---------------------------------------------------------------- output

struct OutputVertex {
  vec3 position; ///< in the frame
  vec3 normal;   ///< of the face
  vec2 uv;       ///< of set 0
};
/// Appends triangles, counter-clockwise seen from outside, holes cut out. T-joints are not closed.
Status triangulate(MeshPool& pool, const Form& form, std::vector<OutputVertex>& vertices,
                   std::vector<uint32_t>& indices);
/// Normals of one shape become the means of those of the faces at a place that meet at an angle below this one; 180 and
/// above: of all.
void softenNormals(std::span<OutputVertex> vertices, float degrees);

// ---------------------------------------------------------------- components

enum class Component {
  Faces,
  Edges,     ///< that faces share count once
  FaceEdges, ///< one for each corner
  Vertices,  ///< places that vertices share count once
  Groups,    ///< faces that hang together by edges
  Holes      ///< each as a face of its own, normal as its face's
};
uint32_t componentCount(MeshPool& pool, const Form& form, Component kind);

/// By the direction of normals: of a face its own, of an edge the mean of its faces', or, of a single face's edge, the
/// direction out of the face within its plane, of FaceEdges always that; of a vertex the mean of its faces'; of a group
/// the sum of its faces'.
enum class Selector {
  Front,      ///< +z; top, bottom and these four: the quadrant that the normal lies in, 45 degrees to each side
  Back,       ///< -z
  Left,       ///< -x
  Right,      ///< +x
  Top,        ///< +y
  Bottom,     ///< -y
  Side,       ///< neither up nor down within 11.25 degrees: all but Horizontal
  Vertical,   ///< normal within 11.25 degrees of the xz plane
  Horizontal, ///< normal within 11.25 degrees of y or -y
  Aslant,     ///< between both, upwards
  Nutant,     ///< between both, downwards
  Border,     ///< at an edge that a single face has
  Inside,     ///< no Border
  Eave,       ///< edges by their tags of roofs
  Hip,
  Valley,
  Ridge,
  StreetFront, ///< by their tags: kTagStreetFront and its like
  StreetBack,
  StreetLeft,
  StreetRight,
  StreetSide, ///< left and right
  All
};
/// The axes of a classification, in the frame: of the scope itself (front, ...), of the axiom (object.front, ...: the
/// default), or world axes brought into the frame (world.south is Front).
struct Axes {
  vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
};
Axes axesOf(const Scope& scope);
bool matches(MeshPool& pool, const Form& form, Component kind, uint32_t index, Selector selector, const Axes& axes);
/// Whether a component has one of these tags (kTag... of pool.h).
uint32_t componentTags(MeshPool& pool, const Form& form, Component kind, uint32_t index);

struct MeshEdge {
  uint32_t from, to;               ///< vertices, of one place the first, from < to
  uint32_t corner, face;           ///< one that has it, the first
  uint32_t faces;                  ///< how many corners have it
  uint32_t otherCorner, otherFace; ///< the second, if there is one
  bool opposed;                    ///< all of its faces but the first run along it the other way
};

/// All components of a kind, found once: for loops over them. The functions below it are for single ones.
class Components {
public:
  Components(MeshPool& pool, const Form& form, Component kind);
  uint32_t count() const { return count_; }
  bool matches(uint32_t index, Selector selector, const Axes& axes) const;
  uint32_t tags(uint32_t index) const;
  uint32_t tagsOfEdges(uint32_t index) const;         ///< of a face's edges, of others as tags()
  Status take(uint32_t index, Form& component) const; ///< as toComponent()

private:
  const std::vector<MeshEdge>& edges() const;
  bool isBorder(uint32_t index) const;
  vec3 normal(uint32_t index) const;

  MeshPool& pool_;
  Form form_;
  Component kind_;
  uint32_t count_ = 0;
  std::vector<uint32_t> faceAt_, places_; // the face of each corner; for each place a vertex
  std::vector<vec3> sums_;                // of the normals of the faces at a vertex
  std::vector<std::vector<uint32_t>> groups_;
  std::vector<std::pair<uint32_t, uint32_t>> holes_; // face and loop
  // What only some selectors need.
  mutable std::vector<MeshEdge> edges_;
  mutable std::vector<bool> border_;
  mutable std::vector<uint32_t> number_;
  mutable bool hasEdges_ = false, hasBorder_ = false;
};

/// The component as a form of its own. Scopes: a face has z along the normal, x along its first edge, in the order in
/// which y points up within the face; extents are tight. An edge has x along itself, z along its mean normal. A vertex
/// has its mean normal as z. Edges and vertices have mesh 0. Groups keep the scope's axes, and are tight.
Status toComponent(MeshPool& pool, const Form& form, Component kind, uint32_t index, Form& component);
/// Components in one form (the operator `=` of CGA): axes of the form, tight. Texture coordinates and tags stay.
Status toComponents(MeshPool& pool, const Form& form, Component kind, std::span<const uint32_t> indices,
                    Form& combined);
/// Tags or'ed into those of a component.
Status tagComponent(MeshPool& pool, Form& form, Component kind, uint32_t index, uint32_t tags);

/// Sets and clears tags of all faces, of all edges (their corners), or both.
Status tagAll(MeshPool& pool, Form& form, bool faces, bool edges, uint32_t set, uint32_t clear);
/// The tags of all faces, or of all edges, or'ed.
uint32_t tagsOf(MeshPool& pool, const Form& form, bool faces, bool edges);

// ---------------------------------------------------------------- extrusion

enum class Extrusion {
  FaceNormal,      ///< each face by itself
  VertexNormal,    ///< along the mean normals of vertices that faces share, so that faces stay joined
  Direction,       ///< each face along a direction of the frame
  DirectionFlatTop ///< as Direction, the top flat: distance from the highest point of each face
};
/// Faces become solids: the old face, reversed, at the bottom, sides, the new face. Negative distances reverse the
/// solid. The scope keeps its axes and becomes tight. direction: unit length, in the frame; world up is (0, 1, 0).
Status extrude(MeshPool& pool, Form& form, Extrusion kind, float distance, vec3 direction = {0, 1, 0});
/// FaceNormal with the top moved inwards by inset: concave outlines and holes as well, which may part or vanish.
Status extrudeTapered(MeshPool& pool, Form& form, float distance, float inset);
/// Each face becomes a pyramid whose apex is distance above the face's centroid.
Status taper(MeshPool& pool, Form& form, float distance);

// ---------------------------------------------------------------- splits

/// The part of a form between two planes at right angles to an axis of the scope (0 x, 1 y, 2 z), metres from the
/// scope's origin. Closed meshes stay closed. The scope is the slab; with adjust, tight along the other two axes.
/// kGeometryEmpty: nothing is between.
Status slice(MeshPool& pool, const Form& form, uint32_t axis, float from, float to, bool adjust, Form& piece);
/// The part of a form whose texture coordinate (axis 0 u, 1 v) of a set is between two values. Faces are cut where they
/// lie, nothing is closed. Axes of the form; tight.
Status sliceUv(MeshPool& pool, const Form& form, uint32_t set, uint32_t axis, float from, float to, Form& piece);
/// The part in front of a plane: dot(normal, p) >= offset, in the frame. CGA's trim. Scope as it was.
Status trim(MeshPool& pool, Form& form, vec3 normal, float offset, bool close);
/// A plane between two faces, of which one is in front: dot(normal, p) >= offset, in the frame.
struct TrimPlane {
  vec3 normal{0, 1, 0};
  float offset = 0.0f;
  vec3 along{1, 0, 0}; ///< the direction of the edge between them
};
/// For each face the planes to those that it shares an edge with.
std::vector<std::vector<TrimPlane>> trimPlanes(MeshPool& pool, const Form& form);

/// How far along an axis of the scope, metres from its origin, the faces have an area below: one for each of the areas,
/// square metres, ascending. Of faces at right angles to the axis all or nothing is below.
std::vector<float> placesOfAreas(MeshPool& pool, const Form& form, uint32_t axis, std::span<const double> areas);

// ---------------------------------------------------------------- Boolean operations

enum class Boolean { Union, Difference, Intersection };
/// Of two forms in one plane, or of two closed meshes, whose faces are tagged kTagBooleanA and kTagBooleanB. Axes of a;
/// tight. Coordinates go. kGeometryEmpty: nothing is left. kGeometryNotPlanar: flat forms of two planes.
/// kGeometryBadArgument: an open mesh. The surface of a mesh that is not convex may touch itself along edges.
Status boolean(MeshPool& pool, const Form& a, const Form& b, Boolean what, Form& result);

// ---------------------------------------------------------------- bending

enum class BendAlong { ScopeY, VertexNormal };
/// Replaces the geometry by an asset, repeated and bent along texture coordinates: its extent along x is one unit of u,
/// that along z one of -v, that along y `height` metres, in the direction of `along`. The asset stands on the faces;
/// keepPosition: its origin does. Faces of three and four corners only, others give nothing. Tight.
Status insertAlongUv(MeshPool& pool, Form& form, uint32_t set, const Form& asset, float height, BendAlong along,
                     bool keepPosition);

// ---------------------------------------------------------------- setbacks and offsets

/// Moves edges of faces inwards. distances: one for each component FaceEdges, 0 and less: stays. pieces: for each of
/// these the strip between the old edge and the new one, mesh 0 where there is none. remainder: what is left, mesh 0
/// where nothing is. All keep the form's axes, and are tight. Each face by itself. kGeometryUnsettled: edges of very
/// different distances overtook each other.
Status setback(MeshPool& pool, const Form& form, std::span<const float> distances, std::vector<Form>& pieces,
               Form& remainder);
/// shapeL (front, left), shapeU (and right), shapeO (and back): strips as one form, of few faces, and the rest.
Status shapeWings(MeshPool& pool, const Form& form, float front, float right, float back, float left, Form& shape,
                  Form& remainder);
/// From a place along the perimeter to a later one, metres; 0 and less of depth gives nothing.
struct PerimeterPart {
  float from, to, depth;
};
/// Sets parts of a face's perimeter back, each by its depth. chain: the components FaceEdges of the face that the
/// perimeter consists of, one behind the other; places beyond its end begin again. pieces: one for each part, mesh 0
/// where it has no area. The deeper of two that overlap has the overlap, of equal ones the earlier. remainder: what of
/// the face is left. All keep the form's axes, and are tight; coordinates go.
Status setbackPerimeter(MeshPool& pool, const Form& form, uint32_t face, std::span<const uint32_t> chain,
                        std::span<const PerimeterPart> parts, std::vector<Form>& pieces, Form& remainder);
enum class OffsetPart { All, Inside, Border };
/// Each face's outline moved outwards (distance above 0) or inwards. Inside: the new polygon; Border: what is between;
/// All: both. Corners are mitred. A face that vanishes gives no Inside.
Status offset(MeshPool& pool, Form& form, float distance, OffsetPart part);
/// The largest rectangle that was found within each face, sides along the face's longest edge, or the scope's axes.
Status innerRectangle(MeshPool& pool, const Form& form, bool alongScope, Form& rectangle);

// ---------------------------------------------------------------- roofs

enum class Roof { Hip, Gable, Pyramid, Shed, Mansard };
struct RoofOptions {
  Roof kind = Roof::Hip;
  bool byHeight = false;      ///< value: height of the highest point above the face, else the angle of the roof's faces
  float value = 30.0f;        ///< above 0, and below 90 degrees
  float overhangX = 0.0f;     ///< beyond eaves, on the roof, metres
  float overhangY = 0.0f;     ///< beyond gables and the shed's sides, metres
  bool even = false;          ///< Gable: ridges' ends are as high as the highest one; faces may leave their planes
  int32_t index = -1;         ///< Gable: the edge that gets a gable (-1: those that hips end at); Shed: the eave's edge
  float upperAngle = 0.0f;    ///< Mansard: angle above the break; 0: value / 3
  float breakDistance = 0.0f; ///< Mansard: of the break from the outline, in the plane; 0: 30 % of the way to the ridge
};
/// Puts a roof on each face of the form: the face itself, reversed (kTagRoofBottom), faces of the roof (kTagRoofTop),
/// vertical sides (kTagRoofSide). y of the scope becomes the first face's normal, x its old direction projected; the
/// scope is tight. Edges are tagged. Overhangs are sheets beyond the solid, at the same slope.
Status roof(MeshPool& pool, Form& form, const RoofOptions& options);

/// A roof of two planes over each face, whose ridge runs along x of the scope, over the middle. The outline may be
/// concave, and have holes. Tags and scope as roof(). kGeometryBadArgument: an outline touches itself or a hole.
Status ridgeRoof(MeshPool& pool, Form& form, bool byHeight, float value);

// ---------------------------------------------------------------- changes of the whole

/// Its faces projected along y of the scope into the plane y = 0, and united.
Status footprint(MeshPool& pool, Form& form);

enum AxisBits : uint32_t { AxisX = 1, AxisY = 2, AxisZ = 4 };
/// Mirrors at the scope's middle, along axes (AxisBits). Faces still face outwards.
Status mirror(MeshPool& pool, Form& form, uint32_t axes);
Status reverseNormals(MeshPool& pool, Form& form);
/// Reverses faces so that those that share an edge run along it in opposite directions. What hangs together then faces
/// outwards where it is closed, else up in the frame; where it faces neither up nor down, most of its area stays as it
/// is. Edges of more than two faces join nothing.
Status conformNormals(MeshPool& pool, Form& form);
/// The scope's axes become these; the geometry stays where it is, the scope is tight.
Status alignScope(MeshPool& pool, Form& form, const Axes& axes);
/// alignScopeToAxes: axis 0 x, 1 y, 2 z of `axes`: only this axis of the scope is aligned, the others as near as can
/// be; 3: all.
Status alignScopeToAxes(MeshPool& pool, Form& form, const Axes& axes, uint32_t axis = 3);
enum class Pick { Index, WorldLowest, Largest, Longest, Any };
/// x along an edge, the face's normal as y, or as z (zUp). up: world up in the frame. Indices are taken modulo the
/// counts. face: Index, WorldLowest, Largest, Any (with an edge that is not Index); edge: Index, WorldLowest, Longest.
Status alignScopeToGeometry(MeshPool& pool, Form& form, bool zUp, Pick face, int32_t faceIndex, Pick edge,
                            int32_t edgeIndex, vec3 up = {0, 1, 0});
/// The rectangle of least area around the geometry seen along an axis of the scope, which stays; the longer side is x
/// (of z: x, of y: x, of x: y).
Status alignScopeToGeometryBox(MeshPool& pool, Form& form, uint32_t fixedAxis);
/// Tight around the geometry, with the axes it has.
Status fitScope(MeshPool& pool, Form& form);
/// Sets extents of the scope; the geometry is scaled with it. What is flat stays flat.
void resizeScope(Form& form, vec3 size);
/// Moves the form so that its scope's middle is that of another scope, along its own axes (AxisBits).
void center(Form& form, const Scope& to, uint32_t axes);
/// Corners within angle of 90 or 180 degrees become exactly that where they can, with the outline's ends moved along.
Status rectify(MeshPool& pool, Form& form, float degrees);
struct Cleanup {
  bool vertices = true; ///< that share a place become one; corners between collinear edges go
  bool faces = true;    ///< of one plane that share an edge become one; faces without area go
  float degrees = 1.0f; ///< what counts as one plane, and as collinear
};
Status cleanup(MeshPool& pool, Form& form, const Cleanup& what = {});
/// Leaves out vertices of outlines whose loss moves the outline least: part (0 to 1) of those that can go.
Status reduce(MeshPool& pool, Form& form, float part);
Status convexify(MeshPool& pool, Form& form); ///< faces in convex pieces, no holes
Status deleteHoles(MeshPool& pool, Form& form);

struct Envelope {
  float maxHeight = 0.0f;
  /// Of front, right, back, left: the height up to which the side is vertical, and the angle from the ground that the
  /// volume keeps behind it.
  float baseHeight[4] = {};
  float angle[4] = {90, 90, 90, 90};
};
/// The volume above each face within planes that lean inwards from its edges.
Status envelope(MeshPool& pool, Form& form, const Envelope& shape);

enum class ScatterDomain { Surface, Volume, Scope };
struct Scatter {
  ScatterDomain domain = ScatterDomain::Surface; ///< Volume of an open mesh: Surface
  bool gaussian = false;
  vec3 mean{0.5f, 0.5f, 0.5f};         ///< gaussian: in parts of the scope
  vec3 deviation{0.16f, 0.16f, 0.16f}; ///< gaussian: in parts of the scope
};
/// Point number index of those that a key draws: a scope of extents 0, on a surface with y along its normal. Uniform
/// points are uniform by area, or volume; each depends on key and index only.
Status scatterPoint(MeshPool& pool, const Form& form, const Scatter& how, shader::uvec2 key, uint32_t index,
                    Scope& point);

// ---------------------------------------------------------------- texture coordinates

/// An affine map of points of the frame: u = dot(u.xyz, p) + u.w.
struct UvProjection {
  glm::vec4 u{1, 0, 0, 0}, v{0, 1, 0, 0};
};
enum class UvAxes {
  ScopeXY,
  ScopeXZ,
  ScopeYX,
  ScopeYZ,
  ScopeZX,
  ScopeZY,
  WorldXY,
  WorldXZ,
  WorldYX,
  WorldYZ,
  WorldZX,
  WorldZY
};
/// setupProjection: the two axes become u and v; 1 is textureWidth metres of u and textureHeight metres of v (0: the
/// scope's extent). offset: metres. world: the world's axes in the frame, and worldOrigin its origin.
UvProjection setupProjection(const Form& form, UvAxes axes, float textureWidth, float textureHeight,
                             vec2 offset = {0, 0}, const Axes& world = {}, vec3 worldOrigin = {0, 0, 0});
Status projectUv(MeshPool& pool, Form& form, uint32_t set, const UvProjection& projection);
/// uv = uv.x * x + uv.y * y + move, of one set. Which sets there are is meshUvSets of pool.h.
Status mapUv(MeshPool& pool, Form& form, uint32_t set, vec2 x, vec2 y, vec2 move);
Status translateUv(MeshPool& pool, Form& form, uint32_t set, float u, float v);
Status scaleUv(MeshPool& pool, Form& form, uint32_t set, float u, float v);
Status rotateUv(MeshPool& pool, Form& form, uint32_t set, float degrees); ///< about (0, 0)
/// Scales so that a texture of these extents in metres tiles: coordinates that ran from 0 to 1 over the scope's x and
/// y run to size / extent; extents of 0 leave that coordinate as it is.
Status tileUv(MeshPool& pool, Form& form, uint32_t set, float textureWidth, float textureHeight);
/// Coordinates into 0 to 1. u, v: which; perFace: each face by itself.
Status normalizeUv(MeshPool& pool, Form& form, uint32_t set, bool u, bool v, bool perFace);
Status copyUv(MeshPool& pool, Form& form, uint32_t from, uint32_t to);
Status deleteUv(MeshPool& pool, Form& form, uint32_t set);

// ---------------------------------------------------------------- hulls

/// Convex pieces of a form for queries between shapes: points in the frame of the world. A closed mesh that is not
/// convex is taken by the prisms over its faces' convex pieces where it is an extrusion, else by its oriented box.
struct Hull {
  std::vector<vec3> points;
  std::vector<uint32_t> sizes; ///< points of each piece
  Bounds bounds;
};
/// toWorld: the axiom's transform, columns x, y, z and the origin.
Hull makeHull(MeshPool& pool, const Form& form, const Axes& toWorld = {}, vec3 origin = {0, 0, 0});
float minimumDistance(const Hull& a, const Hull& b); ///< 0 where they touch or overlap
bool overlaps(const Hull& a, const Hull& b);         ///< by more than rounding
bool touches(const Hull& a, const Hull& b);          ///< no farther than rounding, and no overlap
bool inside(const Hull& a, const Hull& b);           ///< all of a in b

} // namespace gpgp::spawn
