// JSON values of a Lottie file, and where they stand in it.
#pragma once
#include "vector/import/lottie/json.h"
#include "vector/import/lottie/read.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace gpgp::vector::lottie {

/// Refuses the whole file. Thrown and caught inside of the reader only.
struct Refusal {
  const Json* where;
  std::string text;
};

constexpr double kMaxNumber = 1e9;

inline const Json* find(const Json& object, const char* key) {
  const Json* found = object.find(key);
  return found && !found->is_null() ? found : nullptr;
}
/// Within +-1e9.
inline double toNumber(const Json& value, double otherwise = 0) {
  return value.is_boolean() || value.is_number() ? std::clamp(value.number, -kMaxNumber, kMaxNumber) : otherwise;
}
inline double numberOf(const Json& object, const char* key, double otherwise = 0) {
  const Json* value = find(object, key);
  return value ? toNumber(*value, otherwise) : otherwise;
}
inline int intOf(const Json& object, const char* key, int otherwise = 0) {
  return static_cast<int>(numberOf(object, key, otherwise));
}
inline std::string stringOf(const Json& object, const char* key) {
  const Json* value = find(object, key);
  return value && value->is_string() ? value->text : std::string();
}
inline const Json& listOf(const Json& object, const char* key) {
  static const Json kNone = Json::array();
  const Json* value = find(object, key);
  return value && value->is_array() ? *value : kNone;
}
/// The value, or one without anything. A conditional expression would copy the value.
inline const Json& orNothing(const Json* value) {
  static const Json kNothing = Json::object();
  return value ? *value : kNothing;
}
/// "layers[2].shapes[0]"
std::string placeOf(const Json& root, const Json* value);

/// Reads the parts of a file; messages go to the reporter with their place.
class Reader {
public:
  Reader(const Json& root, Reporter& reporter, const ReadLimits& limits)
      : root_(root), reporter_(reporter), limits_(limits) {}

  /// Names what is not supported, once.
  void unsupported(const Json& where, const std::string& text);
  void ignored(const Json& where, const std::string& text);

  Property property(const Json& object, const char* key, std::vector<double> otherwise = {});
  /// `colors`: the number of a gradient's stops, where it is one; numbers stay as they are.
  Property propertyOf(const Json& value, std::vector<double> otherwise = {});
  Transform transform(const Json& value);
  std::vector<ShapeItem> shapes(const Json& list, size_t depth = 0);
  std::vector<Mask> masks(const Json& list);
  std::vector<Effect> effects(const Json& list);
  std::vector<TextDocument> documents(const Json& text);
  /// 0 to 1 each, whether the file has them so or up to 255.
  static void unitColor(Property& color);
  static bool hexColor(const std::string& text, double (&color)[3]);

private:
  std::vector<double> numbers(const Json& value, bool& closed);
  Keyframe keyframe(const Json& value, bool& closed);
  bool shape(const Json& value, ShapeItem& item, size_t depth);
  void gradient(const Json& value, ShapeItem& item);
  void stroke(const Json& value, ShapeItem& item);

  const Json& root_;
  Reporter& reporter_;
  const ReadLimits& limits_;
  std::set<std::string> named_;
  size_t keyframes_ = 0;
};

} // namespace gpgp::vector::lottie
