// Each entity is expanded once, however often it is asked for, so that time and memory stay near the size of the
// result.
#include "vector/import/svg/entities.h"

#include "vector/import/svg/reporter.h"

#include <algorithm>
#include <string_view>
#include <unordered_map>

namespace gpgp::vector::svg {
namespace {
using core::makeError;

constexpr std::string_view kSpace = " \t\r\n";
constexpr size_t kMaxDepth = 32; // of entities in each other

class Entities {
public:
  Entities(std::string_view text, size_t maxBytes) : text_(text), maxBytes_(maxBytes) {}

  /// Reads the definitions; where the text goes on behind them, or 0 where there are none.
  size_t read() {
    size_t at = 0;
    for (;; at = after(text_.substr(at, 2) == "<?" ? "?>" : "-->", at)) {
      at = text_.find('<', at);
      if (at == text_.npos) return 0;
      if (text_.substr(at, 2) != "<?" && text_.substr(at, 4) != "<!--") break;
    }
    if (text_.substr(at, 9) != "<!DOCTYPE") return 0;
    at = pastQuotes(at, "[>");
    if (at >= text_.size() || text_[at] == '>') return 0;
    for (++at; at < text_.size() && text_[at] != ']';) {
      if (text_.substr(at, 4) == "<!--") {
        at = after("-->", at);
      } else if (text_.substr(at, 2) == "<?") {
        at = after("?>", at);
      } else if (text_[at] == '<') {
        const size_t end = pastQuotes(at, ">");
        define(text_.substr(at, end - at));
        at = end + 1;
      } else {
        ++at;
      }
    }
    return all_.empty() ? 0 : std::min(pastQuotes(at, ">") + 1, text_.size());
  }

  core::Result<void> expand(size_t at, std::string& out) {
    char quote = 0;
    bool tag = false;
    while (at < text_.size()) {
      const std::string_view rest = text_.substr(at);
      size_t copied = 1;
      if (!tag && rest.substr(0, 4) == "<!--") {
        copied = after("-->", at) - at;
      } else if (!tag && rest.substr(0, 9) == "<![CDATA[") {
        copied = after("]]>", at) - at;
      } else if (!tag && rest.substr(0, 2) == "<?") {
        copied = after("?>", at) - at;
      } else if (rest[0] == '&') {
        const auto [entity, length] = find(rest);
        if (entity) {
          if (auto ok = resolve(*entity, 0); !ok) {
            const Place place = placeIn(text_, at, {});
            return makeError(ok.error().code, "%zu:%zu: %s", place.line, place.column, ok.error().text);
          }
          for (const char c : entity->text)
            if (tag && (c == '"' || c == '\''))
              out += c == '"' ? "&quot;" : "&apos;";
            else
              out += c;
          if (out.size() > maxBytes_) return tooLong();
          at += length;
          continue;
        }
      } else if (tag && quote) {
        if (rest[0] == quote) quote = 0;
      } else if (tag && (rest[0] == '"' || rest[0] == '\'')) {
        quote = rest[0];
      } else if (rest[0] == '<' || rest[0] == '>') {
        tag = rest[0] == '<';
      }
      out += rest.substr(0, copied);
      at += copied;
    }
    return {};
  }

private:
  struct Entity {
    std::string text;
    enum { Read, Open, Done } state = Read;
  };

  core::Error tooLong() const {
    return makeError(GPGP_ERROR_INVALID_DATA, "the entities come to more than %zu bytes", maxBytes_);
  }

  /// Behind the next `mark`.
  size_t after(std::string_view mark, size_t at) const {
    const size_t found = text_.find(mark, at);
    return found == text_.npos ? text_.size() : found + mark.size();
  }
  /// The first of `marks` that is not inside quotes.
  size_t pastQuotes(size_t at, std::string_view marks) const {
    char quote = 0;
    for (; at < text_.size(); ++at) {
      const char c = text_[at];
      if (quote) {
        if (c == quote) quote = 0;
      } else if (marks.find(c) != marks.npos) {
        return at;
      } else if (c == '"' || c == '\'') {
        quote = c;
      }
    }
    return at;
  }

  /// <!ENTITY name "text", and nothing else.
  void define(std::string_view d) {
    constexpr std::string_view word = "<!ENTITY";
    if (d.substr(0, word.size()) != word) return;
    d.remove_prefix(word.size());
    const auto skip = [&d] { d.remove_prefix(std::min(d.find_first_not_of(kSpace), d.size())); };
    skip();
    const std::string_view name = d.substr(0, d.find_first_of(kSpace));
    d.remove_prefix(name.size());
    skip();
    constexpr std::string_view known[] = {"amp", "lt", "gt", "quot", "apos"}; // to every parser
    if (std::find(std::begin(known), std::end(known), name) != std::end(known)) return;
    if (name.empty() || name[0] == '%' || d.empty() || (d[0] != '"' && d[0] != '\'')) return;
    std::string text(d.substr(1, d.find(d[0], 1) - 1));
    std::replace(text.begin(), text.end(), '\n', ' ');
    all_.try_emplace(std::string(name), Entity{std::move(text)}); // the first counts
  }

  /// What &name; at the front means, and its length.
  std::pair<Entity*, size_t> find(std::string_view text) {
    const size_t end = text.substr(0, 128).find(';');
    if (end == text.npos) return {};
    const auto found = all_.find(std::string(text.substr(1, end - 1)));
    if (found == all_.end()) return {};
    return {&found->second, end + 1};
  }

  /// Until no more entities are in its text.
  core::Result<void> resolve(Entity& entity, size_t depth) {
    if (entity.state == Entity::Done) return {};
    if (entity.state == Entity::Open || depth >= kMaxDepth)
      return makeError(GPGP_ERROR_INVALID_DATA,
                       entity.state == Entity::Open ? "an entity contains itself" : "entities are nested too deeply");
    entity.state = Entity::Open;
    std::string out;
    for (size_t at = 0; at < entity.text.size();) {
      const std::string_view rest = std::string_view(entity.text).substr(at);
      const auto [inner, length] = rest[0] == '&' ? find(rest) : std::pair<Entity*, size_t>{};
      if (inner) {
        if (auto ok = resolve(*inner, depth + 1); !ok) return ok;
        out += inner->text;
      } else {
        out += rest[0];
      }
      if (out.size() > maxBytes_ - bytes_) return tooLong();
      at += inner ? length : 1;
    }
    bytes_ += out.size();
    entity.text = std::move(out);
    entity.state = Entity::Done;
    return {};
  }

  std::string_view text_;
  size_t maxBytes_, bytes_ = 0; // of expanded entities
  std::unordered_map<std::string, Entity> all_;
};
} // namespace

core::Result<void> expandEntities(std::string& text, size_t maxBytes) {
  Entities entities(text, maxBytes);
  const size_t from = entities.read();
  if (from == 0) return {};
  std::string out(text, 0, from);
  if (auto ok = entities.expand(from, out); !ok) return ok;
  text = std::move(out);
  return {};
}

} // namespace gpgp::vector::svg
