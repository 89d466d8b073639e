// Parameters of operators: constants, attributes of the shape, or small programs for a stack machine.
// All values are settled floats; conditions are 1 and 0. Equality tolerates rounding, as the language asks for normals.
#ifndef GPGP_SHADERS_SPAWN_EXPRESSION_H
#define GPGP_SHADERS_SPAWN_EXPRESSION_H
#include "spawn/shared/field.h"
#include "spawn/shared/view.h"

// Fields of the world: the CPU reads them where the engine has them, a GPU in the buffer that is bound. Kernels of
// grammars without fields (GPGP_FIELDS) have nothing of it.
#ifdef __cplusplus
namespace gpgp::shader {
class FieldReader {
public:
  virtual ~FieldReader() = default;
  /// Of field number `field`, at a point in metres along the shape's axes from its centre.
  virtual float read(const Shape& s, uint field, float x, float z) const = 0;
};
} // namespace gpgp::shader
#define GPGP_READ_FIELD(s, field, x, z) (fields ? fields->read(s, field, x, z) : 0.0f)
#elif defined(GPGP_FIELDS)
float readField(Shape s, uint field, float x, float z); // derive/derive.glsl
#define GPGP_READ_FIELD(s, field, x, z) readField(s, field, x, z)
#endif

// What the camera sees of the shape whose operator is being run. Whoever runs the operator works it out before, once
// for all its parameters: in C++ it is passed on, in GLSL look() of derive/derive.glsl leaves it in a variable.
#ifdef __cplusplus
#define GPGP_SEEN_PARAMETER , Seen seen = seenFromNowhere(), const FieldReader *fields = nullptr
#define GPGP_SEEN_ARGUMENT , seen, fields
#define GPGP_LOOK(shape)
#else
#define GPGP_SEEN_PARAMETER
#define GPGP_SEEN_ARGUMENT
#define GPGP_LOOK(shape) look(shape)
Seen seen;
Seen seenOf(Shape s);
void look(Shape s);
#endif

GPGP_SHADER_BEGIN

// In variables, one choice at a time: GLSL then chooses without a branch.
GPGP_FN float component(vec3 v, uint axis) {
  const float x = v.x, y = v.y, z = v.z;
  const float other = axis == 1u ? y : z;
  return axis == 0u ? x : other;
}

GPGP_FN vec3 withComponent(vec3 v, uint axis, float value) {
  return vec3(axis == 0u ? value : v.x, axis == 1u ? value : v.y, axis == 2u ? value : v.z);
}

GPGP_FN bool nearlyEqual(float a, float b) {
  const float scale = max(1.0f, max(abs(a), abs(b)));
  return abs(subtract(a, b)) <= multiply(1.0e-5f, scale);
}

GPGP_FN float attributeOf(Shape s, uint code) {
  if (code >= kCodePosition && code < kCodePosition + 3u) return component(s.position, code - kCodePosition);
  if (code >= kCodeShapeSize && code < kCodeShapeSize + 3u) return component(s.size, code - kCodeShapeSize);
  if (code >= kCodeNormal && code < kCodeNormal + 3u) return component(s.axisZ, code - kCodeNormal);
  if (code >= kCodeRotation && code < kCodeRotation + 9u) {
    const uint axis = (code - kCodeRotation) / 3u;
    const uint element = (code - kCodeRotation) % 3u;
    return component(axis == 0u ? s.axisX : (axis == 1u ? s.axisY : s.axisZ), element);
  }
  return code == kCodeSeed ? unitFloat(s.seed) : s.custom;
}

GPGP_FN float fromBool(bool value) { return value ? 1.0f : 0.0f; }

/// a op b for the codes of two operands. drawn: kCodeRandom's number.
GPGP_FN float combine(uint code, float a, float b, float drawn) {
  // clang-format off
#define GPGP_CASE(name, number, spelling, precedence, kind, code) case kCode##name: return code;
#define GPGP_DEFAULT(name, number, spelling, precedence, kind, code) default: return code;
  // clang-format on
  switch (code) { GPGP_BINARY_TABLE(GPGP_CASE, GPGP_DEFAULT) }
#undef GPGP_CASE
#undef GPGP_DEFAULT
}

/// A parameter's value for a shape; at is its word offset, index its place among the operator's parameters.
GPGP_FN float evaluate(GPGP_GRAPH Shape s, uint at, uint index GPGP_SEEN_PARAMETER) {
  const uint kind = graphWords[at];
  const uint value = graphWords[at + 1u];
  if (kind == kParameterConstant) return uintBitsToFloat(value);
  if (kind == kParameterAttribute) return attributeOf(s, value);
  float stack[kMaxStack];
  uint depth = 0u;
  uint draws = index << kDrawsOfParameter;
  uint next = value;
  for (uint code = graphWords[next]; code != kCodeEnd; code = graphWords[next]) {
    next += 1u;
    if (code == kCodeNumber) {
      stack[depth] = uintBitsToFloat(graphWords[next]);
      next += 1u;
      depth += 1u;
    } else if (code >= kCodeAttributes) {
      stack[depth] = code >= kCodeView ? seenValue(seen, code) : attributeOf(s, code);
      depth += 1u;
#ifdef GPGP_READ_FIELD
    } else if (code >= kCodeField) {
      depth -= 1u;
      stack[depth - 1u] = GPGP_READ_FIELD(s, code - kCodeField, stack[depth - 1u], stack[depth]); // NOLINT
#endif
    } else {
      depth -= 1u;
      float drawn = 0.0f;
      if (code == kCodeRandom) {
        drawn = drawnNumber(s.key, draws);
        draws += 1u;
      }
      // validate() has run each program: none takes from an empty stack. NOLINTNEXTLINE(clang-analyzer-*)
      stack[depth - 1u] = combine(code, stack[depth - 1u], stack[depth], drawn);
    }
  }
  return stack[0]; // NOLINT(clang-analyzer-*)
}

GPGP_SHADER_END
#endif
