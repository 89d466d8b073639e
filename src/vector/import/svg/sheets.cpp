// Files beside a drawing, and its style sheets (SVG 2, 6.3 to 6.5): <?xml-stylesheet?>, HTML's <link> and <style>,
// <style>, and what these import. Files are asked for by their path relative to the drawing's folder, and lie in it or
// below; no address with a scheme or a host is ever followed.
#include "vector/import/svg/data_uri.h"
#include "vector/import/svg/importer.h"
#include "vector/import/svg/media.h"

#include <algorithm>

namespace gpgp::vector::svg {
namespace {

constexpr size_t kMaxDepth = 16; // of sheets that import each other

/// "text/css" and no type at all; what follows a semicolon are its parameters.
bool isCss(std::string_view type) {
  type = trim(type.substr(0, type.find(';')));
  return type.empty() || isWord(type, "text/css");
}

/// A name and a colon, as "https:" or "C:".
bool hasScheme(std::string_view uri) {
  const size_t colon = uri.find(':');
  return colon != uri.npos && colon > 0 && uri.substr(0, colon).find_first_of("/?#") == uri.npos;
}

/// "a/../b/./c.css" as "b/c.css"; empty where it leads out of the folder, or to one.
std::string normalised(std::string_view path) {
  std::vector<std::string_view> parts;
  for (size_t begin = 0; begin <= path.size();) {
    const size_t end = std::min(path.find('/', begin), path.size());
    const std::string_view part = path.substr(begin, end - begin);
    begin = end + 1;
    if (part == "..") {
      if (parts.empty()) return {};
      parts.pop_back();
    } else if (!part.empty() && part != ".") {
      parts.push_back(part);
    }
  }
  std::string joined;
  for (const std::string_view part : parts) joined.append(joined.empty() ? "" : "/").append(part);
  return joined;
}

/// With the slash behind it; empty where there is none.
std::string_view folderOf(std::string_view path) {
  const size_t slash = path.rfind('/');
  return path.substr(0, slash == path.npos ? 0 : slash + 1);
}

/// The value of name="value" in an instruction; whether it is there.
bool pseudoAttribute(std::string_view text, std::string_view name, std::string& value) {
  Scanner s(text);
  for (s.skipSpace(); !s.done(); s.skipSpace()) {
    const std::string_view found = s.name();
    s.skipSpace();
    if (found.empty() || !s.take("=")) return false;
    s.skipSpace();
    const char quote = s.peek();
    if (quote != '"' && quote != '\'') return false;
    s.advance();
    const size_t begin = s.offset();
    while (!s.done() && s.peek() != quote) s.advance();
    const std::string_view inside = text.substr(begin, s.offset() - begin);
    if (!s.done()) s.advance();
    if (found != name) continue;
    value.clear();
    for (size_t i = 0; i < inside.size(); ++i) {
      value += inside[i];
      if (inside.substr(i, 5) == "&amp;") i += 4;
    }
    return true;
  }
  return false;
}

} // namespace

void Importer::readSheets() {
  for (const pugi::xml_node instruction : document_.styleInstructions()) {
    const Place place = document_.place(instruction);
    const std::string who = "<?xml-stylesheet?>";
    std::string href, type, media, alternate;
    const std::string_view text = instruction.value();
    pseudoAttribute(text, "type", type);
    pseudoAttribute(text, "media", media);
    pseudoAttribute(text, "alternate", alternate);
    if (!pseudoAttribute(text, "href", href)) {
      reporter_.ignored(place, who + " has no href; ignored");
    } else if (!isCss(type)) {
      reporter_.warn(place, who + " of type '" + type.substr(0, 60) + "' is not supported");
    } else if (alternate != "yes" && isForScreen(media, place, who)) {
      readSheet(href, {}, place, 0);
    }
  }
  // <style> elements of both languages and HTML's <link>, in the file's order.
  struct Sheet {
    pugi::xml_node node;
    std::string_view name;
    Place place;
  };
  std::vector<Sheet> sheets;
  for (const pugi::xml_node node : document_.all({"style"})) sheets.push_back({node, "style", document_.place(node)});
  const size_t own = sheets.size();
  for (const Document::Html& html : document_.html())
    if (html.name == "style" || html.name == "link") sheets.push_back({html.node, html.name, html.place});
  std::inplace_merge(
      sheets.begin(), sheets.begin() + static_cast<ptrdiff_t>(own), sheets.end(), [](const Sheet& a, const Sheet& b) {
        return a.place.line != b.place.line ? a.place.line < b.place.line : a.place.column < b.place.column;
      });
  for (const Sheet& sheet : sheets) readStyleElement(sheet.node, sheet.place, sheet.name);
}

void Importer::readStyleElement(pugi::xml_node node, const Place& place, std::string_view name) {
  const std::string who = name == "link" ? "<link>" : "<style>";
  const std::string_view type = node.attribute("type").value(), media = node.attribute("media").value();
  if (name == "link") {
    bool isSheet = false, isAlternate = false;
    const std::string rel = lowered(node.attribute("rel").value());
    for (std::string_view rest = rel; !(rest = trim(rest)).empty();) {
      const std::string_view word = rest.substr(0, rest.find_first_of(" \t\r\n\f"));
      rest.remove_prefix(word.size());
      isSheet |= word == "stylesheet";
      isAlternate |= word == "alternate";
    }
    if (!isSheet || isAlternate) return; // an icon, a licence
  }
  if (!isCss(type))
    return reporter_.warn(place, who + " of type '" + std::string(type.substr(0, 60)) + "' is not supported");
  if (!isForScreen(media, node.attribute("media") ? document_.place(node.attribute("media"), 0) : place, who)) return;
  if (name == "link") {
    const pugi::xml_attribute href = node.attribute("href");
    return href ? readSheet(href.value(), {}, place, 0) : reporter_.ignored(place, who + " has no href; ignored");
  }
  std::string text;
  Place begin = place, end = place; // of the text, which may be in several parts
  for (const pugi::xml_node part : node.children()) {
    const std::string_view value = part.value();
    if (value.empty()) continue;
    const Place at = document_.placeInText(part, 0);
    if (text.empty())
      begin = at;
    else
      text.append(at.line > end.line ? at.line - end.line : 0, '\n');
    text += value;
    end = document_.placeInText(part, value.size());
  }
  parseSheet(text, {}, begin, 0);
}

bool Importer::isForScreen(std::string_view media, const Place& place, const std::string& who) {
  const Media is = evaluateMedia(media);
  if (is == Media::Unknown)
    reporter_.warn(place, std::string("media '") + std::string(media.substr(0, 60)) + "' is not supported: " + who +
                              " does not count for it");
  return is == Media::Yes;
}

void Importer::parseSheet(std::string_view text, std::string_view folder, const Place& place, size_t depth) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  mayBlend_ |= text.find("-blend-") != text.npos;
  for (const char* effect : {"-blend-", "filter", "mask", "clip-path"}) sharesClips_ &= text.find(effect) == text.npos;
  sheet_.parse(text, place, reporter_,
               [&](std::string_view uri, const Place& from) { readSheet(uri, folder, from, depth + 1); });
}

Importer::Read Importer::readBeside(std::string_view href, std::string_view folder, size_t limit, std::string& path,
                                    std::string& bytes, const std::function<bool()>& isWanted) {
  if (href.empty() || href[0] == '#') return {"is not a file"};
  if (hasScheme(href) || href.starts_with("//")) return {"is not beside the drawing, and other places are not read"};
  if (href[0] == '/') return {"has an absolute path, and only paths from the drawing's folder are read"};
  const std::string plain = percentDecoded(href.substr(0, href.find_first_of("?#")));
  path = normalised(std::string(folder) + plain);
  if (path.empty() || plain.find('\0') != plain.npos || plain.find('\\') != plain.npos)
    return {"leads out of the drawing's folder, where nothing is read"};
  if (isWanted && !isWanted()) return {nullptr, false, false, true};
  if (!files_ || !files_->read) return {"is another file, and no files are read here"};
  size_t size = 0, read = 0;
  if (files_->read(files_->userData, path.c_str(), nullptr, 0, &size) != GPGP_SUCCESS) return {"cannot be read", true};
  if (size > limit) return {nullptr, false, true};
  bytes.resize(size);
  if (size && (files_->read(files_->userData, path.c_str(), bytes.data(), size, &read) != GPGP_SUCCESS || read != size))
    return {"cannot be read", true};
  return {};
}

void Importer::readSheet(std::string_view href, std::string_view folder, const Place& place, size_t depth) {
  href = trim(href);
  const std::string shown = std::string("the style sheet '") + std::string(href.substr(0, 60)) + "' ";
  const auto refused = [&](const std::string& why) { reporter_.warn(place, shown + why + "; it does not count"); };
  const auto invalid = [&](const std::string& why) { reporter_.ignored(place, shown + why + "; it does not count"); };
  if (depth > kMaxDepth) return refused("is imported through more than 16 others");
  if (++sheetCount_ > limits_.sheets)
    return refused("is one more than the " + std::to_string(limits_.sheets) + " that are read");
  std::string bytes;
  std::string_view name; // for messages
  std::string path;
  if (isWord(href.substr(0, 5), "data:")) {
    const std::vector<uint8_t> data = decodeDataUri(href);
    bytes.assign(data.begin(), data.end());
    name = "data:";
  } else {
    const size_t left = limits_.sheetBytes - std::min(sheetBytes_, limits_.sheetBytes);
    const Read read = readBeside(href, folder, left, path, bytes, [&] {
      return std::find(openSheets_.begin(), openSheets_.end(), path) == openSheets_.end();
    });
    if (read.isRefused) return invalid("imports itself");
    if (read.isTooLarge)
      return refused("makes more than the " + std::to_string(limits_.sheetBytes) +
                     " bytes that are read of style sheets");
    if (read.why) return read.isInvalid ? invalid(read.why) : refused(read.why);
    const std::string_view own = reporter_.name();
    name = sheetNames_.emplace_back(std::string(folderOf(own)) + path);
  }
  sheetBytes_ += bytes.size();
  if (sheetBytes_ > limits_.sheetBytes)
    return refused("makes more than the " + std::to_string(limits_.sheetBytes) +
                   " bytes that are read of style sheets");
  openSheets_.push_back(path);
  parseSheet(bytes, folderOf(path), {1, 1, name}, depth);
  openSheets_.pop_back();
}

} // namespace gpgp::vector::svg
