// The bytes of a drawing as an XML tree whose elements know their places.
#pragma once
#include "core/result.h"
#include "vector/import/svg/reporter.h"

#include <pugixml.hpp>

#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace gpgp::vector::svg {

/// Inflates gzip, all its members; other bytes come out as they are. Errors: damaged or truncated data, bytes behind it
/// that are not zero, more than `maxBytes`.
core::Result<void> inflateIfNeeded(std::span<const std::byte> bytes, size_t maxBytes, std::string& out);

/// Appends a character by its code point.
void appendUtf8(std::string& out, uint32_t c);

class Document {
public:
  static constexpr size_t kMaxBytes = size_t(64) << 20;     ///< of XML
  static constexpr size_t kMaxTags = size_t(4) << 20;       ///< '<' signs, so that the tree's size is bounded
  static constexpr size_t kMaxAttributes = size_t(8) << 20; ///< '=' signs, likewise

  /// Parses SVG or gzip-compressed SVG in UTF-8, UTF-16 or Latin-1. Errors begin with their "line:column: ".
  core::Result<void> load(std::span<const std::byte> bytes);

  /// Names the file in places: that of a drawing inside another one.
  void setFile(std::string name) { file_ = std::move(name); }
  size_t bytes() const { return text_.size(); } ///< of XML

  /// The outermost <svg>; empty where there is none.
  pugi::xml_node root() const { return root_; }
  /// Of an element's or processing instruction's first character.
  Place place(pugi::xml_node node) const;
  /// Of the character `offset` in an attribute's value.
  Place place(pugi::xml_attribute attribute, size_t offset) const { return placeOf(attribute.value(), offset); }
  /// Of the character `offset` in the text of a node.
  Place placeInText(pugi::xml_node node, size_t offset) const { return placeOf(node.value(), offset); }
  /// The element's name without its prefix; empty for other namespaces than SVG's and for what is no element.
  std::string_view name(pugi::xml_node node) const;
  /// The element a reference such as "#id" means; empty where there is none in this file.
  pugi::xml_node find(std::string_view reference) const;
  /// All elements with one of these names, in the file's order.
  std::vector<pugi::xml_node> all(std::initializer_list<std::string_view> names) const;

  /// An element of HTML that a drawing may hold.
  struct Html {
    pugi::xml_node node;
    std::string name; ///< without its prefix
    Place place;
  };
  const std::vector<Html>& html() const { return html_; }
  /// <?xml-stylesheet ...?> before the outermost element.
  std::vector<pugi::xml_node> styleInstructions() const;
  /// Whether the file speaks of modes of mixing, and of those, masks and filters.
  bool mayBlend() const { return mayBlend_; }
  bool mayLayer() const { return mayLayer_; }
  /// References to entities that the file does not define.
  struct Unknown {
    std::string text; ///< "&name;"
    Place place;
  };
  const std::vector<Unknown>& unknownEntities() const { return unknownEntities_; }

private:
  Place placeAt(size_t offset) const;
  Place placeOf(const char* value, size_t offset) const;
  void resolveNamespaces();
  void findUnknownEntities();

  bool mayBlend_ = false, mayLayer_ = false;
  std::string file_;
  std::string text_; // the tree points into it
  pugi::xml_document tree_;
  pugi::xml_node root_;
  std::vector<size_t> newlines_;
  std::vector<Html> html_;
  std::vector<Unknown> unknownEntities_;
  std::unordered_map<std::string_view, pugi::xml_node> ids_;
};

/// href, or XLink's as it was called before.
pugi::xml_attribute hrefOf(pugi::xml_node node);

} // namespace gpgp::vector::svg
