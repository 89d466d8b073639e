#include "vector/import/lottie/json.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace gpgp::vector::lottie {

Json::Json(Kind what, double value) : kind(what), number(value) {}
Json::Json(std::string value) : kind(Kind::string), text(std::move(value)) {}
Json::~Json() = default;
Json::Json(Json&& other) noexcept = default;
Json& Json::operator=(Json&& other) noexcept = default;

const Json* Json::find(std::string_view key) const {
  const auto at = std::lower_bound(members.begin(), members.end(), key,
                                   [](const Member& member, std::string_view k) { return member.key < k; });
  return at != members.end() && at->key == key ? &at->value : nullptr;
}

namespace {
/// Builds the document from the parser's events, and stops it by returning false.
class Builder final : public nlohmann::json_sax<nlohmann::json> {
public:
  Builder(size_t maxDepth, size_t maxValues, Json& root) : maxDepth_(maxDepth), maxValues_(maxValues), root_(root) {}
  JsonProblem problem;

  bool null() override { return add(Json()); }
  bool boolean(bool value) override { return add(Json(Json::Kind::boolean, value)); }
  bool number_integer(number_integer_t value) override { return number(static_cast<double>(value)); }
  bool number_unsigned(number_unsigned_t value) override { return number(static_cast<double>(value)); }
  bool number_float(number_float_t value, const string_t&) override { return number(value); }
  bool string(string_t& value) override { return add(Json(std::move(value))); }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open(Json::Kind::object); }
  bool start_array(std::size_t) override { return open(Json::Kind::array); }
  bool end_array() override { return close(); }
  bool key(string_t& value) override {
    open_.back()->members.push_back({std::move(value), Json()});
    return true;
  }
  bool end_object() override {
    auto& members = open_.back()->members;
    std::stable_sort(members.begin(), members.end(), [](const auto& a, const auto& b) { return a.key < b.key; });
    size_t kept = 0; // the last one of each key
    for (size_t i = 0; i < members.size(); ++i)
      if (i + 1 == members.size() || members[i + 1].key != members[i].key) {
        if (kept != i) members[kept] = std::move(members[i]);
        ++kept;
      }
    members.resize(kept);
    return close();
  }
  bool parse_error(std::size_t position, const std::string&, const nlohmann::json::exception& failed) override {
    constexpr int kOutOfRange = 406;
    problem = {failed.id == kOutOfRange ? JsonProblem::Kind::number : JsonProblem::Kind::syntax,
               position ? position - 1 : 0};
    return false;
  }

private:
  bool number(double value) { return add(Json(Json::Kind::number, value)); }
  bool add(Json value) { return place(std::move(value)) != nullptr; }
  bool open(Json::Kind kind) {
    Json* const made = place(Json(kind));
    if (made) open_.push_back(made);
    return made != nullptr;
  }
  bool close() {
    open_.pop_back();
    return true;
  }
  /// What is open keeps its place until it is closed: only the innermost list or object grows.
  Json* place(Json value) {
    if (open_.size() > maxDepth_ || ++values_ > maxValues_) {
      problem.kind = open_.size() > maxDepth_ ? JsonProblem::Kind::depth : JsonProblem::Kind::count;
      return nullptr;
    }
    if (open_.empty()) return &(root_ = std::move(value));
    Json& parent = *open_.back();
    if (parent.is_array()) return &parent.items.emplace_back(std::move(value));
    return &(parent.members.back().value = std::move(value));
  }

  const size_t maxDepth_, maxValues_;
  size_t values_ = 0;
  Json& root_;
  std::vector<Json*> open_;
};
} // namespace

JsonProblem parseJson(std::string_view text, size_t maxDepth, size_t maxValues, Json& root) {
  Builder builder(maxDepth, maxValues, root);
  nlohmann::json::sax_parse(text.begin(), text.end(), &builder);
  return builder.problem;
}

} // namespace gpgp::vector::lottie
