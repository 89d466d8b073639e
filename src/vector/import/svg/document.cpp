// Loading: inflate, to UTF-8, expand entities, parse in place, index lines and ids. No other file is ever read.
#include "vector/import/svg/document.h"

#include "vector/import/svg/entities.h"
#include "vector/import/svg/scanner.h"

#include <algorithm>
#include <zlib.h>

namespace gpgp::vector::svg {
namespace {
using core::makeError;

struct Inflater {
  z_stream stream{};
  bool ready = false;
  Inflater() { ready = inflateInit2(&stream, 15 + 16) == Z_OK; }
  ~Inflater() {
    if (ready) inflateEnd(&stream);
  }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;
};

} // namespace

void appendUtf8(std::string& out, uint32_t c) {
  const auto put = [&out](uint32_t v) { out.push_back(static_cast<char>(v)); };
  if (c < 0x80) {
    put(c);
  } else if (c < 0x800) {
    put(0xC0 | c >> 6);
    put(0x80 | (c & 63));
  } else if (c < 0x10000) {
    put(0xE0 | c >> 12);
    put(0x80 | (c >> 6 & 63));
    put(0x80 | (c & 63));
  } else {
    put(0xF0 | c >> 18);
    put(0x80 | (c >> 12 & 63));
    put(0x80 | (c >> 6 & 63));
    put(0x80 | (c & 63));
  }
}

namespace {
std::string fromUtf16(std::string_view bytes, bool bigEndian) {
  std::string out;
  const auto unit = [&](size_t i) {
    const uint32_t a = static_cast<unsigned char>(bytes[i]), b = static_cast<unsigned char>(bytes[i + 1]);
    return bigEndian ? a << 8 | b : b << 8 | a;
  };
  for (size_t i = 0; i + 1 < bytes.size(); i += 2) {
    uint32_t c = unit(i);
    if (c == 0xFEFF) continue;
    if (c >= 0xD800 && c < 0xDC00 && i + 3 < bytes.size()) {
      const uint32_t low = unit(i + 2);
      if (low >= 0xDC00 && low < 0xE000) {
        c = 0x10000 + ((c - 0xD800) << 10) + (low - 0xDC00);
        i += 2;
      }
    }
    appendUtf8(out, c >= 0xD800 && c < 0xE000 ? 0xFFFD : c);
  }
  return out;
}

void toUtf8(std::string& text) {
  const std::string_view view = text;
  const auto byte = [view](size_t i) { return i < view.size() ? static_cast<unsigned char>(view[i]) : 0u; };
  if ((byte(0) == 0xFE && byte(1) == 0xFF) || (byte(0) == 0 && byte(1) == '<')) {
    text = fromUtf16(view, true);
    return;
  }
  if ((byte(0) == 0xFF && byte(1) == 0xFE) || (byte(0) == '<' && byte(1) == 0)) {
    text = fromUtf16(view, false);
    return;
  }
  if (view.substr(0, 5) != "<?xml") return;
  std::string head(view.substr(0, std::min(view.find("?>"), size_t{200})));
  for (char& c : head) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c + 0x20 : c);
  const bool latin = head.find("iso-8859-1") != head.npos || head.find("windows-1252") != head.npos ||
                     head.find("iso-8859-15") != head.npos;
  if (!latin) return;
  std::string out;
  out.reserve(view.size() + view.size() / 8);
  for (const char c : view) appendUtf8(out, static_cast<unsigned char>(c));
  text = std::move(out);
}

std::string_view localName(std::string_view name) {
  const size_t colon = name.find(':');
  return colon == name.npos ? name : name.substr(colon + 1);
}
std::string_view prefixOf(std::string_view name) {
  const size_t colon = name.find(':');
  return name.substr(0, colon == name.npos ? 0 : colon);
}

/// The node after `node` in the file's order, inside `root`; `depth` follows.
pugi::xml_node following(pugi::xml_node node, pugi::xml_node root, size_t& depth) {
  if (node.first_child()) return ++depth, node.first_child();
  for (; node != root && !node.next_sibling(); --depth) node = node.parent();
  return node != root ? node.next_sibling() : pugi::xml_node();
}

constexpr size_t kMaxHtml = 1000;
constexpr std::string_view kNameCharacters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_.:";

/// Behind a document type definition and what it has in brackets.
size_t pastDoctype(std::string_view text, size_t at) {
  char quote = 0;
  bool inside = false;
  for (; at < text.size(); ++at) {
    const char c = text[at];
    if (quote)
      quote = c == quote ? 0 : quote;
    else if (c == '"' || c == '\'')
      quote = c;
    else if (c == '[' || c == ']')
      inside = c == '[';
    else if (c == '>' && !inside)
      return at + 1;
  }
  return at;
}

enum class Space { Other, Svg, XLink, Html };

Space spaceOf(std::string_view uri) {
  const auto has = [uri](std::string_view part) { return uri.find(part) != uri.npos; };
  if (has("w3.org/2000/svg") || has("&ns_svg;")) return Space::Svg;
  if (has("w3.org/1999/xhtml")) return Space::Html;
  return has("w3.org/1999/xlink") || has("&ns_xlink;") ? Space::XLink : Space::Other;
}
} // namespace

core::Result<void> inflateIfNeeded(std::span<const std::byte> bytes, size_t maxBytes, std::string& out) {
  out.clear();
  const char* begin = reinterpret_cast<const char*>(bytes.data());
  if (bytes.size() < 2 || bytes[0] != std::byte{0x1f} || bytes[1] != std::byte{0x8b}) {
    if (bytes.size() > maxBytes)
      return makeError(GPGP_ERROR_INVALID_DATA, "the file has %zu bytes, more than %zu", bytes.size(), maxBytes);
    out.assign(begin, bytes.size());
    return {};
  }
  if (bytes.size() > maxBytes)
    return makeError(GPGP_ERROR_INVALID_DATA, "the file has %zu bytes, more than %zu", bytes.size(), maxBytes);
  Inflater inflater;
  if (!inflater.ready) return makeError(GPGP_ERROR_OUT_OF_HOST_MEMORY, "out of memory");
  z_stream& z = inflater.stream;
  z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(begin)); // zlib only reads it
  z.avail_in = static_cast<uInt>(bytes.size());
  for (;;) {
    if (z.avail_out == 0) {
      const size_t had = out.size();
      if (had >= maxBytes)
        return makeError(GPGP_ERROR_INVALID_DATA, "the file inflates to more than %zu bytes", maxBytes);
      out.resize(std::min(std::max(had * 2, size_t{65536}), maxBytes));
      z.next_out = reinterpret_cast<Bytef*>(out.data() + had);
      z.avail_out = static_cast<uInt>(out.size() - had);
    }
    const int status = inflate(&z, Z_NO_FLUSH);
    if (status == Z_MEM_ERROR) return makeError(GPGP_ERROR_OUT_OF_HOST_MEMORY, "out of memory");
    if (status != Z_OK && status != Z_STREAM_END)
      return makeError(GPGP_ERROR_INVALID_DATA,
                       z.avail_in == 0 ? "the gzip data is truncated" : "the gzip data is damaged");
    if (status == Z_OK && z.avail_in == 0 && z.avail_out != 0)
      return makeError(GPGP_ERROR_INVALID_DATA, "the gzip data is truncated");
    if (status != Z_STREAM_END) continue;
    while (z.avail_in && *z.next_in == 0) ++z.next_in, --z.avail_in; // fills blocks of tapes
    if (!z.avail_in) return out.resize(out.size() - z.avail_out), core::Result<void>();
    if (z.avail_in < 2 || z.next_in[0] != 0x1f || z.next_in[1] != 0x8b)
      return makeError(GPGP_ERROR_INVALID_DATA, "something else follows the gzip data");
    inflateReset(&z); // the next member
  }
}

core::Result<void> Document::load(std::span<const std::byte> bytes) {
  if (auto ok = inflateIfNeeded(bytes, kMaxBytes, text_); !ok) return ok;
  toUtf8(text_);
  if (auto ok = expandEntities(text_, kMaxBytes); !ok) return ok;
  size_t tags = 0, attributes = 0;
  mayBlend_ = text_.find("-blend-") != text_.npos;
  mayLayer_ = mayBlend_ || text_.find("filter") != text_.npos || text_.find("mask") != text_.npos;
  for (size_t i = 0; i < text_.size(); ++i) {
    tags += text_[i] == '<';
    attributes += text_[i] == '=';
    if (text_[i] == '\n') newlines_.push_back(i);
  }
  if (tags > kMaxTags || attributes > kMaxAttributes)
    return makeError(GPGP_ERROR_INVALID_DATA, "more than %zu tags or %zu attributes", kMaxTags, kMaxAttributes);
  findUnknownEntities();
  const pugi::xml_parse_result parsed = tree_.load_buffer_inplace(
      text_.data(), text_.size(), pugi::parse_default | pugi::parse_pi | pugi::parse_ws_pcdata, pugi::encoding_utf8);
  if (parsed.status == pugi::status_out_of_memory) return makeError(GPGP_ERROR_OUT_OF_HOST_MEMORY, "out of memory");
  if (!parsed) {
    const Place at = placeAt(static_cast<size_t>(std::max<ptrdiff_t>(parsed.offset, 0)));
    return makeError(GPGP_ERROR_INVALID_DATA, "%zu:%zu: not well-formed XML (%s)", at.line, at.column,
                     parsed.description());
  }
  const pugi::xml_node top = tree_.document_element();
  const Place rootAt = place(top);
  if (localName(top.name()) != "svg")
    return makeError(GPGP_ERROR_INVALID_DATA, "%zu:%zu: the outermost element is <%.60s>, not <svg>", rootAt.line,
                     rootAt.column, top.name());
  root_ = top;
  resolveNamespaces();
  if (name(root_).empty())
    return makeError(GPGP_ERROR_INVALID_DATA, "%zu:%zu: the outermost element is in another namespace than SVG's",
                     rootAt.line, rootAt.column);
  size_t depth = 0;
  for (pugi::xml_node n = root_; n; n = following(n, root_, depth))
    if (const pugi::xml_attribute id = n.attribute("id"); id && n.type() == pugi::node_element)
      ids_.try_emplace(id.value(), n);
  return {};
}

/// SVG's elements get their local names, others none; XLink's href is called xlink:href.
void Document::resolveNamespaces() {
  const std::string top = root_.name();
  std::unordered_map<std::string_view, Space> spaces{// of prefixes; some files declare none
                                                     {prefixOf(top), Space::Svg},
                                                     {"xlink", Space::XLink}};
  struct Hidden {
    size_t depth;
    std::string_view prefix;
    Space space;
  };
  std::vector<Hidden> hidden; // by the declarations around
  size_t depth = 0;
  for (pugi::xml_node n = root_; n; n = following(n, root_, depth)) {
    for (; !hidden.empty() && hidden.back().depth >= depth; hidden.pop_back())
      spaces[hidden.back().prefix] = hidden.back().space;
    if (n.type() != pugi::node_element) continue;
    for (const pugi::xml_attribute a : n.attributes()) {
      const std::string_view name = a.name(), uri = a.value();
      if (name != "xmlns" && name.substr(0, 6) != "xmlns:") continue;
      if (n == root_ && uri.empty()) continue;                                       // as if it were not there
      const std::string_view prefix = name.substr(std::min<size_t>(name.size(), 6)); // none: the default
      Space& space = spaces[prefix];
      hidden.push_back({depth, prefix, space});
      space = spaceOf(uri);
    }
    const auto spaceIn = [&spaces](std::string_view name) {
      const auto found = spaces.find(prefixOf(name));
      return found == spaces.end() ? Space::Other : found->second;
    };
    for (pugi::xml_attribute a = n.first_attribute(), next; a; a = next) {
      next = a.next_attribute();
      const std::string_view name = a.name();
      if (name.find(':') == name.npos || localName(name) != "href") continue;
      if (spaceIn(name) != Space::XLink)
        n.remove_attribute(a);
      else if (name != "xlink:href")
        a.set_name("xlink:href");
    }
    const Space space = spaceIn(n.name());
    if (space == Space::Html && html_.size() < kMaxHtml)
      html_.push_back({n, std::string(localName(n.name())), place(n)});
    const std::string local(space == Space::Svg ? localName(n.name()) : std::string_view());
    if (local != n.name()) n.set_name(local.c_str());
  }
}

Place Document::placeAt(size_t offset) const {
  const auto next = std::lower_bound(newlines_.begin(), newlines_.end(), offset);
  const size_t begin = next == newlines_.begin() ? 0 : *(next - 1) + 1;
  return {1 + static_cast<size_t>(next - newlines_.begin()), 1 + offset - begin, file_};
}

Place Document::place(pugi::xml_node node) const {
  const ptrdiff_t name = node.offset_debug(), before = node.type() == pugi::node_pi ? 2 : 1; // "<?" or "<"
  return name < before ? Place{1, 1, file_} : placeAt(static_cast<size_t>(name - before));
}

Place Document::placeOf(const char* value, size_t offset) const {
  // Parsed in place, so values are where they were in the file.
  const std::less_equal<const char*> ordered;
  if (!ordered(text_.data(), value) || !ordered(value, text_.data() + text_.size())) return {};
  return placeAt(static_cast<size_t>(value - text_.data()) + offset);
}

/// What is left of them when those that the file defines are expanded; at most a hundred.
void Document::findUnknownEntities() {
  constexpr std::string_view known[] = {"amp", "lt", "gt", "quot", "apos", "ns_svg", "ns_xlink"};
  const std::string_view text = text_;
  const auto past = [text](std::string_view mark, size_t at) {
    const size_t found = text.find(mark, at);
    return found == text.npos ? text.size() : found + mark.size();
  };
  for (size_t at = text.find_first_of("&<"); at < text.size() && unknownEntities_.size() < 100;
       at = text.find_first_of("&<", at)) {
    const std::string_view rest = text.substr(at, 128);
    const bool skips = rest.starts_with("<!--") || rest.starts_with("<![CDATA[") || rest.starts_with("<!DOCTYPE");
    if (rest.starts_with("<!--"))
      at = past("-->", at);
    else if (rest.starts_with("<![CDATA["))
      at = past("]]>", at);
    else if (rest.starts_with("<!DOCTYPE"))
      at = pastDoctype(text, at);
    if (skips) continue;
    ++at;
    if (rest[0] != '&' || rest.substr(1, 1) == "#") continue;
    const size_t end = rest.find_first_not_of(kNameCharacters, 1);
    const std::string_view name = rest.substr(1, std::min(end, rest.size()) - 1);
    if (end == rest.npos || rest[end] != ';' || name.empty() || oneOf(name, known)) continue;
    unknownEntities_.push_back({std::string(rest.substr(0, end + 1)), placeAt(at - 1)});
  }
}

std::vector<pugi::xml_node> Document::styleInstructions() const {
  std::vector<pugi::xml_node> found;
  for (pugi::xml_node n = tree_.first_child(); n && n != root_ && found.size() < 100; n = n.next_sibling())
    if (n.type() == pugi::node_pi && std::string_view(n.name()) == "xml-stylesheet") found.push_back(n);
  return found;
}

std::string_view Document::name(pugi::xml_node node) const {
  if (node.type() != pugi::node_element) return {};
  return node.name();
}

pugi::xml_node Document::find(std::string_view reference) const {
  if (reference.empty() || reference[0] != '#') return {};
  const auto found = ids_.find(reference.substr(1));
  return found == ids_.end() ? pugi::xml_node() : found->second;
}

std::vector<pugi::xml_node> Document::all(std::initializer_list<std::string_view> wanted) const {
  std::vector<pugi::xml_node> found;
  size_t depth = 0;
  for (pugi::xml_node n = root_; n; n = following(n, root_, depth))
    if (std::find(wanted.begin(), wanted.end(), name(n)) != wanted.end()) found.push_back(n);
  return found;
}

pugi::xml_attribute hrefOf(pugi::xml_node node) {
  const pugi::xml_attribute href = node.attribute("href");
  return href ? href : node.attribute("xlink:href");
}

} // namespace gpgp::vector::svg
