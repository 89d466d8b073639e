// How a property is set: rows of tables, a table a file.
#pragma once
#include "vector/import/svg/style.h"

#include <span>

namespace gpgp::vector::svg {

/// What a property is set from.
struct PropertyContext {
  Style& style;
  const Style& parent;
  std::string_view value;
  const LengthContext& lengths;
};

/// A property by its name. `set`: false where the value is not valid.
struct Property {
  std::string_view name;
  bool (*set)(const PropertyContext&);
  void (*take)(Style& to, const Style& from);
};

/// A row whose value is copied from a parent as `member`.
#define GPGP_PROPERTY(name, member, setter)                                                                            \
  {                                                                                                                    \
    name, [](const PropertyContext& c) { return setter; },                                                             \
        [](Style& to, const Style& from) { to.member = from.member; }                                                  \
  }
/// A word and what it stands for.
template <class T> struct Word {
  std::string_view word;
  T value;
};
template <class T, size_t N> bool choose(std::string_view text, const Word<T> (&words)[N], T& value) {
  for (const auto& w : words)
    if (isWord(text, w.word)) return value = w.value, true;
  return false;
}
/// Those of text and fonts.
std::span<const Property> textProperties();

} // namespace gpgp::vector::svg
