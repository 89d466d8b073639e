// A JSON document as nlohmann's parser reads it. Its own values allocate memory where they are destroyed, which ends
// the program when there is none; these do not, and are destroyed as deep as they were read.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace gpgp::vector::lottie {

class Json {
public:
  struct Member;
  enum class Kind : uint8_t { null, boolean, number, string, array, object };

  explicit Json(Kind what = Kind::null, double value = 0);
  explicit Json(std::string value);
  ~Json(); // where Member is known, as all that makes or ends one
  Json(Json&& other) noexcept;
  Json& operator=(Json&& other) noexcept;
  static Json array() { return Json(Kind::array); }
  static Json object() { return Json(Kind::object); }

  bool is_null() const { return kind == Kind::null; }
  bool is_boolean() const { return kind == Kind::boolean; }
  bool is_number() const { return kind == Kind::number; }
  bool is_string() const { return kind == Kind::string; }
  bool is_array() const { return kind == Kind::array; }
  bool is_object() const { return kind == Kind::object; }

  const Json& operator[](size_t index) const { return items[index]; } ///< of an array
  size_t size() const { return items.size(); }
  bool empty() const { return items.empty(); }
  std::vector<Json>::const_iterator begin() const { return items.begin(); }
  std::vector<Json>::const_iterator end() const { return items.end(); }
  const Json* find(std::string_view key) const; ///< of an object; null: it has no such member

  Kind kind = Kind::null;
  double number = 0; ///< 0 or 1 of a boolean
  std::string text;
  std::vector<Json> items;     ///< of an array
  std::vector<Member> members; ///< of an object, by key
};

struct Json::Member {
  std::string key;
  Json value;
};

/// What is wrong with a text: where, in bytes from 0, and whether it is a number beyond what double holds; or that
/// there are lists and objects too deep in each other, or too many values.
struct JsonProblem {
  enum class Kind { none, syntax, number, depth, count } kind = Kind::none;
  size_t offset = 0;
};

/// Of members with the same key the last one counts.
JsonProblem parseJson(std::string_view text, size_t maxDepth, size_t maxValues, Json& root);

} // namespace gpgp::vector::lottie
