// One thread's derivation: runs rules on shapes of one axiom after the other. The machine of
// shaders/spawn/cga/machine.h is a part of it; the operations and functions that the machine leaves to it are in
// operations*.cpp and functions*.cpp.
#pragma once
#include "spawn/cga/box_forms.h"
#include "spawn/cga/derive.h"
#include "spawn/cga/functions.h"
#include "spawn/cga/names.h"
#include "spawn/cga/strings.h"

#include <array>
#include <memory>
#include <unordered_map>

namespace gpgp::spawn::cga {

using namespace shader;

/// "#rrggbb" or "#rrggbbaa"; false: it is none.
bool parseColor(std::string_view text, glm::vec4& color, bool& hasOpacity);

/// An entry of the queue: a shape, and the rule that is to be run on it.
struct Shape {
  Form form;
  vec3 pivot{0};                         ///< where scope.t counts from
  vec3 pivotX{1, 0, 0}, pivotY{0, 1, 0}; ///< and the axes along which
  glm::vec4 color{1};
  uint32_t texture = 0; ///< string
  uint32_t splitIndex = 0, splitTotal = 0, compIndex = 0, compTotal = 0, compSelector = 0;
  uvec2 key{0, 0};                  ///< of the path to it, for random numbers
  uint32_t draws = 0;               ///< numbers that were drawn at that key
  uint32_t children = 0;            ///< that have keys of their own
  uint32_t values = 0, changes = 0; ///< attributes: a block of all, and a chain of what was set since
  uint32_t changeCount = 0;         ///< length of that chain
  uint32_t projections = 0;         ///< chain of what setupProjection() said
  uint32_t trims = 0;               ///< chain of planes that cut off what is inserted
  bool trimsHorizontal = false, trimsVertical = true;
  float softAngle = 0;                                 ///< degrees below which normals are smooth across edges
  uint32_t chunk = 0, first = 0, count = 0, depth = 0; ///< the rule, its values, how many rules came before
};

class Deriver {
public:
  Deriver(const Program& program, const DeriveOptions& options);
  /// Adds what comes of an axiom.
  void run(const Axiom& axiom, uint32_t number, Derivation& result, Messages& messages);
  std::vector<FirstValue> firstValues(const Axiom& axiom, Messages& messages);
  /// What context queries of other axioms may see of one. Its own queries look no farther than the axiom.
  std::vector<Occluder> seen(const Axiom& axiom, uint32_t number, Messages& messages);

private:
  struct Change {
    uint32_t slot, next;
    CgaValue value;
  };
  struct Projection {
    uint32_t set, next;
    UvProjection map;
  };
  struct Trim {
    uint32_t next = 0;
    TrimPlane plane;
    bool isHorizontal = false; ///< its edge is less than 40 degrees from the x axis of the face
  };
  struct ArrayValue {
    static constexpr uint32_t kOneRow = UINT32_MAX;
    std::vector<CgaValue> values; ///< row by row
    uint32_t width = kOneRow;     ///< of a row; 0: the ends of an open range
    uint32_t columns() const { return width == kOneRow ? static_cast<uint32_t>(values.size()) : width; }
    uint32_t rows() const {
      return values.empty() || !columns() ? 0 : static_cast<uint32_t>(values.size()) / columns();
    }
  };
  struct Labelled {
    uint32_t label;
    Hull hull;
    uvec2 key;
    float area; ///< of its faces
  };
  /// Values of an operation or a function, on the machine's stack.
  struct Arguments {
    const CgaValue* values;
    uint32_t count;
    const CgaValue& operator[](uint32_t i) const { return values[i]; }
  };
  using OperationFunction = bool (Deriver::*)(const Arguments&);
  using BlockFunction = bool (Deriver::*)(const Arguments&, uint32_t table, uint32_t base);
  using ValueFunction = CgaValue (Deriver::*)(const Arguments&);

  // --- what the machine asks for (machine.h) ---
  uint32_t cgaWord(uint32_t at) const { return words_[at]; }
  const CgaValue& cgaStack(uint32_t at) const { return stack_[at]; }
  void cgaSetStack(uint32_t at, const CgaValue& v) { stack_[at] = v; }
  static constexpr uint32_t cgaStackSize() { return kStackSize; }
  uint32_t cgaFrame(uint32_t at) const { return frames_[at]; }
  void cgaSetFrame(uint32_t at, uint32_t v) { frames_[at] = v; }
  uint32_t cgaMostFrames() const { return options_.maxFunctionDepth; }
  uint32_t cgaMostTurns() const { return options_.maxInstructions; }
  CgaValue cgaAttribute(uint32_t slot) const;
  void cgaSetAttribute(uint32_t slot, const CgaValue& v);
  float cgaRandom();
  CgaValue cgaAddOther(const CgaValue& a, const CgaValue& b);
  CgaValue cgaCompareOther(uint32_t code, const CgaValue& a, const CgaValue& b);
  CgaValue cgaEach(uint32_t code, const CgaValue& a, const CgaValue& b);
  CgaValue cgaFunction(uint32_t function, uint32_t first, uint32_t count);
  CgaValue cgaArray(uint32_t first, uint32_t count);
  CgaValue cgaIndex(uint32_t first, uint32_t count);
  CgaValue cgaRange(const CgaValue& a, const CgaValue& b);
  bool cgaOperation(uint32_t operation, uint32_t first, uint32_t count);
  bool cgaBlock(uint32_t operation, uint32_t first, uint32_t count, uint32_t table, uint32_t base);
  bool cgaInvoke(uint32_t chunk, uint32_t first, uint32_t count);
  bool cgaGoOn(uint32_t chunk);
  bool cgaLeaf(uint32_t name);
  void cgaNil() { made_ = true; }
  bool cgaPushShape();
  bool cgaPopShape();
  bool cgaEnd();
  void cgaAt(uint32_t at) { at_ = at; }
#include "spawn/cga/machine.h"

  // --- deriver.cpp ---
  void clear(); ///< what the axiom before left
  bool start(const Axiom& axiom, uint32_t number);
  bool growPool(); ///< false: it is as large as it may be, and the derivation has failed
  void attributes(const Axiom& axiom, const std::vector<uint32_t>& order);
  void derive();
  bool runRule(const Shape& shape);
  void fail(const std::string& what);
  /// Once a kind, at the place of the instruction that runs.
  void warn(const std::string& kind, const std::string& text);
  void warnAt(uint32_t at, bool isError, const std::string& kind, const std::string& text);
  bool enters(uint32_t chunk, uint32_t depth);
  bool isWithin(const Form& form);      ///< a shape's faces and vertices, within the limits
  bool works(uint64_t steps = 0);       ///< adds to the work that was done, and whether some is left
  std::string ruleAndOperation() const; ///< that run, for messages
  void addLeaf(uint32_t name);
  void writeLeaves(Derivation& result, uint32_t number, size_t firstLeaf);
  void writeTriangles(const Form& form, float softAngle, Derivation& result);
  LeafScope scopeOf(const Shape& shape) const;

  // --- for operations ---
  float number(const CgaValue& v) const { return cgaNumber(v); }
  /// A length; behind ' a part of whole.
  float length(const CgaValue& v, float whole) const;
  vec3 lengths(const Arguments& a, const vec3& whole) const;
  std::string_view word(const CgaValue& v) const; ///< of selectors and strings; else empty
  const std::string& text(const CgaValue& v);     ///< of whatever it is
  CgaValue stringValue(std::string_view text) { return cgaMake(kCgaString, strings_.number(text)); }
  /// What an operator of src/spawn/geometry returned. False: the run ends, since the pool has no room.
  bool check(Status status, const char* what);
  void setScope(const Scope& scope); ///< the geometry goes along
  void resetPivot(Shape& shape) const;
  Axes axes(std::string_view system) const;
  /// A child of the shape that runs; its form and numbers are the caller's.
  Shape& child();
  bool addChild(Shape& shape, uint32_t body, uint32_t base);
  /// Behind what drew numbers at the current key: the next ones are drawn at another.
  void settleDraws();
  /// What a chunk that is a value gives on a component of the shape that runs.
  bool valueOn(uint32_t chunk, uint32_t base, uint32_t top, const Form& form, uint32_t index, uint32_t total,
               CgaValue& value);
  bool path(Operation operation, const Arguments& a);

  // Operations, by GPGP_CGA_OPERATIONS.
#define GPGP_CGA_none(name) bool name##_(const Arguments& a);
#define GPGP_CGA_parts(name) bool name##_(const Arguments& a, uint32_t table, uint32_t base);
#define GPGP_CGA_body(name) bool name##_(const Arguments& a, uint32_t table, uint32_t base);
#define GPGP_CGA_DECLARE(name, least, most, block) GPGP_CGA_##block(name)
  GPGP_CGA_OPERATIONS(GPGP_CGA_DECLARE)
#undef GPGP_CGA_DECLARE
#undef GPGP_CGA_none
#undef GPGP_CGA_parts
#undef GPGP_CGA_body
  bool setAttributeOfShape(Operation operation, const CgaValue& v);
  bool rotateScopeBy(const vec3& degrees, const vec3& fixed);
  bool roofBy(const Arguments& a, RoofOptions& options, const char* what);
  bool primitive(Primitive kind, uint32_t sides, uint32_t rings, const vec3& size);
  bool wings(float front, float right, float back, float left, const Arguments& a, uint32_t table, uint32_t base);
  bool shapeAndRemainder(const Form& inner, const Form& rest, const Arguments& a, uint32_t table, uint32_t base);
  bool setbackBy(const std::vector<float>& distances, const Arguments& a, uint32_t table, uint32_t base);
  bool setbackEach(bool isArray, const std::vector<float>& each, const Arguments& a, uint32_t table, uint32_t base);
  /// For each part of a table, the components that it is the first to select.
  std::vector<std::vector<uint32_t>> selectedBy(const Components* components, uint32_t count, const Arguments& a,
                                                uint32_t table);
  void setTrims(Shape& part, const std::vector<TrimPlane>& planes);
  bool applyTrims();
  bool material(std::string_view name, const CgaValue& v);
  CgaValue firstOfMaterial(std::string_view name); ///< what an attribute of materials is that nobody set
  bool compMaterial(const Arguments& a, uint32_t table, uint32_t base);
  bool splitUv(const Arguments& a, uint32_t table, uint32_t base);
  bool selects(std::string_view selector, const Components* components, uint32_t index, uint32_t count,
               const CgaValue& value);
  uint32_t uvSet(const CgaValue& v);
  void tagStreets(const Axiom& axiom);
  uint32_t tagBits(std::string_view query) const; ///< of the names that a query matches
  uint32_t tagBit(const std::string& name);       ///< its own bit; 0: there are too many names
  bool tagNames(const Arguments& a, uint32_t set, uint32_t clear);
  bool hasTags(const Arguments& a);
  Form* assetForm(const std::string& path, std::string& why); ///< none: why not, or there is no room

  // --- functions_world.cpp ---
  const WorldField* fieldNamed(std::string_view name) const;
  float fieldAt(const WorldField& field, const vec3& place) const;
  uint32_t edgeBehind(const std::vector<vec3>& points, const vec3& facing);
  const std::string* edgeText(const CgaValue& name);
  float ownArea() const;

  // --- operations_inline.cpp ---
  /// Derives a part of a block at once from the shape that runs; a value behind the block's is the first free one.
  bool deriveNow(uint32_t body, uint32_t base, uint32_t top, std::vector<Shape>& leaves);
  /// The shape that runs becomes what leaves are together.
  bool gather(const std::vector<Shape>& leaves, bool unify, const char* what);
  bool combineBy(Boolean what, const Arguments& a, uint32_t table, uint32_t base);
  uint32_t topOf(const Arguments& a) const { return static_cast<uint32_t>(a.values - stack_.data()) + a.count; }

  // Functions, by GPGP_CGA_FUNCTIONS.
#define GPGP_CGA_DECLARE(name, least, most) CgaValue name##_(const Arguments& a);
  GPGP_CGA_FUNCTIONS(GPGP_CGA_DECLARE)
#undef GPGP_CGA_DECLARE
  CgaValue array(ArrayValue value);
  bool isLess(const CgaValue& x, const CgaValue& y) const;
  CgaValue placesOf(const CgaValue& v, uint32_t size, std::vector<int64_t>& places);
  std::vector<std::string> namesOfAsset(const Arguments& a);
  std::vector<std::string> filesOf(const CgaValue& v);
  std::vector<std::string> sortedFiles(const std::vector<std::string>& files, std::string_view axes, bool byRatio,
                                       bool arePictures, float mostError);
  CgaValue sorted(const Arguments& a, bool byRatio, bool arePictures, float mostError);
  CgaValue oneOf(const Arguments& a, bool byRatio, bool arePictures, float best, float mostError);
  const ArrayValue& arrayOf(const CgaValue& v);
  CgaValue filled(uint32_t type, const Arguments& a);
  std::vector<std::string> list(const CgaValue& v);
  CgaValue listValue(const std::vector<std::string>& items);
  const std::vector<std::string>& searchFiles(const std::string& pattern);
  std::vector<std::string> soughtFiles(const std::string& pattern);
  std::string findFile(const std::string& path);
  std::string soughtFile(const std::string& path);
  CgaValue table(const Arguments& a, bool asStrings);
  struct ContextQuery {
    bool isIntra = true, isInter = true;
    std::string label; ///< empty: all shapes
  };
  ContextQuery contextQuery(const Arguments& a, uint32_t labelAt);
  bool sees(const ContextQuery& query, const Labelled& other) const;
  bool comparesWith(const Hull& other); ///< counts the work; false: there is none left
  void noteUnlabelled(const Form& form);
  CgaValue context(const Arguments& a, bool (*query)(const Hull&, const Hull&));
  const Hull& ownHull();
  vec3 euler(const vec3& x, const vec3& y, const vec3& z) const;
  CgaValue floatValue(float x) const { return cgaFloatValue(x); }

  static constexpr uint32_t kStackSize = 8192;
  static constexpr uint32_t kDrawsOfSlot = 1024;
  static constexpr uint32_t kMostStates = 64; ///< [ in [
  static constexpr uint32_t kLongestChain = 24;
  static constexpr uint32_t kMostNested = 32; ///< derivations within rules

  const Program& program_;
  const DeriveOptions& options_;
  Messages* messages_ = nullptr;
  const uint32_t* words_;
  StringTable strings_;
  GeometryPool pool_;
  uint32_t poolWords_;
  BoxForms boxes_;

  Shape shape_;        // that the rule runs on
  Scope ruleScope_;    // its scope when the rule began
  bool made_ = false;  // whether anything came of it
  uint32_t chunk_ = 0; // that runs
  uint32_t at_ = 0;
  std::string_view operation_; // that runs
  std::array<CgaValue, kStackSize> stack_;
  std::vector<uint32_t> frames_;
  std::vector<Shape> states_;
  std::vector<uvec2> forks_;         // keys where ways fork
  bool drawn_ = false;               // numbers, since the last settleDraws()
  uint32_t attributeSlot_ = kNoSlot; // whose value is worked out: it draws from the axiom's seed
  static constexpr uint32_t kNoSlot = UINT32_MAX;

  std::vector<Shape> queue_, next_;
  std::vector<CgaValue> queueValues_, nextValues_;
  std::vector<Shape> leaves_;
  std::vector<CgaValue> blocks_; // attributes, a block after the other
  std::vector<Change> changes_;
  std::vector<Projection> projections_;
  std::vector<Trim> trims_;
  std::vector<ArrayValue> arrays_;
  size_t arrayValues_ = 0; ///< of all arrays
  std::vector<Labelled> labels_;
  const Surroundings* around_ = nullptr;         // of the axiom that runs
  uint32_t axiomNumber_ = 0;                     // its own there
  std::vector<Occluder>* unlabelled_ = nullptr;  // where seen() wants them
  std::vector<uint32_t> tagNames_;               ///< strings, by their bit from kTagUser on
  std::unordered_map<uint32_t, Report> reports_; // by string
  std::vector<uint32_t> prints_;
  std::string scratch_; // of text()
  std::unordered_map<std::string, std::unique_ptr<Asset>> assets_;
  std::unordered_map<std::string, Form> assetForms_; // in the pool
  std::unordered_map<std::string, std::string> foundFiles_;
  std::unordered_map<std::string, std::vector<std::string>> searches_;
  CgaValue componentValue_ = cgaFloatValue(0); ///< that comp() as a value gave last
  Hull hull_;
  bool hasHull_ = false;

  const Axiom* axiom_ = nullptr;
  Form start_; // of the axiom
  uint64_t shapes_ = 0, printCount_ = 0;
  uint32_t deepest_ = 0;
  uint32_t stackBase_ = 0, nested_ = 0; // of a derivation within a rule
  bool noRoom_ = false, stopped_ = false, overLimit_ = false;
};

} // namespace gpgp::spawn::cga
