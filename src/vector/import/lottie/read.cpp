#include "vector/import/lottie/read.h"

#include "vector/import/lottie/archive.h"
#include "vector/import/lottie/read_value.h"
#include "vector/import/svg/data_uri.h"

#include <map>
#include <unordered_map>

namespace gpgp::vector::lottie {
namespace {

constexpr const char* kBlendNames[] = {
    "normal",     "multiply",   "screen",     "overlay",   "darken", "lighten",    "color dodge", "color burn",
    "hard light", "soft light", "difference", "exclusion", "hue",    "saturation", "color",       "luminosity"};
static_assert(std::size(kBlendNames) == GPGP_BLEND_PLUS_LIGHTER && GPGP_BLEND_LUMINOSITY == 15);

Json parse(std::string_view text, const ReadLimits& limits) {
  Json root;
  const JsonProblem problem = parseJson(text, limits.depth, limits.values, root);
  switch (problem.kind) {
  case JsonProblem::Kind::none: return root;
  case JsonProblem::Kind::number: throw Refusal{nullptr, "the file has a number that is too large"};
  case JsonProblem::Kind::depth:
    throw Refusal{nullptr, "lists and objects are more than " + std::to_string(limits.depth) + " deep"};
  case JsonProblem::Kind::count:
    throw Refusal{nullptr, "the file has more than " + std::to_string(limits.values) + " values"};
  case JsonProblem::Kind::syntax: break;
  }
  const size_t end = std::min(problem.offset, text.size());
  const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(end), '\n');
  const size_t newLine = text.substr(0, end).rfind('\n');
  const size_t column = 1 + end - (newLine == text.npos ? 0 : newLine + 1);
  throw Refusal{nullptr, std::to_string(line) + ":" + std::to_string(column) + ": not JSON"};
}

class FileReader {
public:
  FileReader(const Json& root, const Outside& outside, const Archive* archive, Reporter& reporter,
             const ReadLimits& limits)
      : root_(root), outside_(outside), archive_(archive), limits_(limits), reader_(root, reporter, limits) {}

  Animation read() {
    if (!root_.is_object() || !find(root_, "layers")) throw Refusal{&root_, "no Lottie animation: it has no layers"};
    animation_.width = numberOf(root_, "w");
    animation_.height = numberOf(root_, "h");
    animation_.rate = numberOf(root_, "fr");
    animation_.in = numberOf(root_, "ip");
    animation_.out = numberOf(root_, "op");
    const auto bad = [&](const char* key, const char* text) {
      const Json* where = find(root_, key);
      throw Refusal{where ? where : &root_, text};
    };
    if (!(animation_.width > 0 && animation_.width <= 1e6)) bad("w", "the width must be above 0 and at most 1e6");
    if (!(animation_.height > 0 && animation_.height <= 1e6)) bad("h", "the height must be above 0 and at most 1e6");
    if (!(animation_.rate > 0)) bad("fr", "the frame rate must be above 0");
    if (!(animation_.out > animation_.in)) bad("op", "the animation must end after it begins");
    readAssets();
    readFonts();
    animation_.compositions.resize(1 + compositionValues_.size());
    for (size_t i = 0; i < animation_.compositions.size(); ++i)
      readLayers(listOf(i ? *compositionValues_[i - 1] : root_, "layers"), animation_.compositions[i]);
    return std::move(animation_);
  }

private:
  void readAssets() {
    for (const Json& asset : listOf(root_, "assets")) {
      const std::string id = stringOf(asset, "id");
      if (find(asset, "layers")) {
        if (compositionValues_.size() >= limits_.compositions)
          throw Refusal{&asset, "the file has more than " + std::to_string(limits_.compositions) + " compositions"};
        compositionValues_.push_back(&asset);
        compositions_.emplace(id, compositionValues_.size());
      } else if (find(asset, "p") && find(asset, "w")) {
        images_.emplace(id, animation_.images.size());
        animation_.images.push_back({numberOf(asset, "w"), numberOf(asset, "h")});
        imageValues_.push_back(&asset);
      }
    }
  }

  void readFonts() {
    if (const Json* fonts = find(root_, "fonts"))
      for (const Json& value : listOf(*fonts, "list")) {
        Font font{stringOf(value, "fName"), stringOf(value, "fFamily"), stringOf(value, "fStyle"),
                  numberOf(value, "ascent", 75)};
        const auto has = [&font](const char* word) { return font.style.find(word) != std::string::npos; };
        font.weight = has("Bold") ? 700 : has("Light") ? 300 : has("Medium") ? 500 : 400;
        font.italic = has("Italic") || has("Oblique");
        if (animation_.fonts.size() < 256) animation_.fonts.push_back(std::move(font));
      }
    for (const Json& value : listOf(root_, "chars")) {
      if (animation_.glyphs.size() >= 65'536) throw Refusal{&value, "the file has more than 65536 glyphs"};
      Glyph glyph{stringOf(value, "ch"),        stringOf(value, "style"), stringOf(value, "fFamily"),
                  numberOf(value, "size", 100), numberOf(value, "w"),     {}};
      if (const Json* data = find(value, "data")) glyph.shapes = reader_.shapes(listOf(*data, "shapes"));
      if (glyph.size > 0) animation_.glyphs.push_back(std::move(glyph));
    }
  }

  std::vector<uint8_t> imageBytes(const Json& asset, const char** why) {
    std::string path = stringOf(asset, "p");
    if (path.starts_with("data:")) return svg::decodeDataUri(path);
    const size_t left = limits_.imageBytes - std::min(imageBytes_, limits_.imageBytes);
    std::string bytes;
    if (archive_) {
      for (const std::string& folder : {std::string("images/"), std::string("i/"), stringOf(asset, "u"), std::string()})
        if (auto found = archive_->read(folder + path, left)) {
          bytes = std::move(*found);
          break;
        }
    } else if (outside_.files) {
      path = stringOf(asset, "u") + path;
      const bool leads = path.empty() || path[0] == '/' || path.find('\\') != path.npos ||
                         path.find(':') != path.npos || ("/" + path + "/").find("/../") != path.npos;
      if (leads) {
        *why = "lies outside of the animation's folder";
        return {};
      }
      size_t size = 0;
      const GpgpFileSystem& files = *outside_.files;
      if (files.read(files.userData, path.c_str(), nullptr, 0, &size) == GPGP_SUCCESS && size <= left) {
        bytes.resize(size);
        if (files.read(files.userData, path.c_str(), bytes.data(), bytes.size(), &size) != GPGP_SUCCESS) bytes.clear();
      }
    }
    imageBytes_ += bytes.size();
    return {bytes.begin(), bytes.end()};
  }

  /// Decoded when the first layer shows it.
  void takeImage(size_t i) {
    Image& image = animation_.images[i];
    if (!tried_.insert(i).second) return;
    const Json& asset = *imageValues_[i];
    const auto left = [&](const std::string& why) {
      reader_.unsupported(asset, "image '" + stringOf(asset, "id").substr(0, 40) + "' " + why + ": it is not drawn");
    };
    if (!outside_.imageFn) return reader_.unsupported(asset, "images are not supported here");
    if (animation_.imageCount >= GPGP_MAX_IMAGES)
      return left("is one more than the " + std::to_string(GPGP_MAX_IMAGES) + " that a drawing can have");
    const char* why = nullptr;
    const std::vector<uint8_t> bytes = imageBytes(asset, &why);
    if (bytes.empty()) return left(why ? why : "cannot be read");
    uint32_t width = 0, height = 0;
    if (!outside_.imageFn(outside_.imageUserData, animation_.imageCount, bytes.data(), bytes.size(), &width, &height) ||
        !width || !height)
      return left("cannot be decoded");
    image.index = animation_.imageCount++;
    if (!(image.width > 0 && image.height > 0)) image.width = width, image.height = height;
  }

  void readLayer(const Json& value, Layer& layer) {
    if (find(value, "ind")) layer.index = static_cast<int64_t>(numberOf(value, "ind"));
    if (find(value, "parent")) layer.parent = static_cast<int64_t>(numberOf(value, "parent"));
    layer.in = numberOf(value, "ip");
    layer.out = numberOf(value, "op");
    layer.start = numberOf(value, "st");
    layer.stretch = numberOf(value, "sr", 1);
    if (layer.stretch == 0) layer.stretch = 1;
    layer.hidden = numberOf(value, "hd") != 0;
    layer.autoOrient = numberOf(value, "ao") != 0;
    layer.transform = reader_.transform(orNothing(find(value, "ks")));
    if (numberOf(value, "ddd") != 0)
      reader_.unsupported(value, "layers in three dimensions are not supported: they are drawn flat");
    if (numberOf(value, "mb") != 0) reader_.unsupported(value, "motion blur is not supported");
    if (!listOf(value, "sy").empty()) reader_.unsupported(value, "layer styles are not supported");
    layer.blend = intOf(value, "bm");
    if (layer.blend < 0 || layer.blend > GPGP_BLEND_PLUS_LIGHTER) {
      reader_.unsupported(value, "blend mode " + std::to_string(layer.blend) + " is not supported: it is normal");
      layer.blend = 0;
    }
    layer.matte = std::clamp(intOf(value, "tt"), 0, 4);
    layer.isMatte = numberOf(value, "td") != 0;
    layer.masks = reader_.masks(listOf(value, "masksProperties"));
    layer.effects = reader_.effects(listOf(value, "ef"));
    const std::string reference = stringOf(value, "refId");
    const auto assetIn = [&](const std::map<std::string, size_t>& assets, const char* kind) {
      const auto found = assets.find(reference);
      if (found == assets.end()) {
        reader_.ignored(value, std::string("there is no ") + kind + " '" + reference.substr(0, 40) +
                                   "': the layer is left out");
        return SIZE_MAX;
      }
      return found->second;
    };
    switch (intOf(value, "ty", 3)) {
    case 0:
      layer.kind = LayerKind::Precomp;
      layer.asset = assetIn(compositions_, "composition");
      if (const Json* remap = find(value, "tm")) layer.timeRemap = reader_.propertyOf(*remap);
      layer.width = numberOf(value, "w");
      layer.height = numberOf(value, "h");
      break;
    case 1:
      layer.kind = LayerKind::Solid;
      layer.width = numberOf(value, "sw");
      layer.height = numberOf(value, "sh");
      if (!Reader::hexColor(stringOf(value, "sc"), layer.color))
        reader_.ignored(value, "a solid's colour is not #rrggbb: it is black");
      break;
    case 2:
      layer.kind = LayerKind::Image;
      layer.asset = assetIn(images_, "image");
      if (layer.asset != SIZE_MAX) takeImage(layer.asset);
      break;
    case 4:
      layer.kind = LayerKind::Shape;
      layer.shapes = reader_.shapes(listOf(value, "shapes"));
      break;
    case 5:
      layer.kind = LayerKind::Text;
      if (const Json* t = find(value, "t")) layer.documents = reader_.documents(*t);
      break;
    case 3: layer.kind = LayerKind::Null; break;
    case 6: layer.kind = LayerKind::Null; break; // sound
    case 13:
      reader_.unsupported(value, "cameras are not supported: layers are drawn flat");
      layer.kind = LayerKind::Null;
      break;
    default:
      reader_.unsupported(value, "a layer of type " + std::to_string(intOf(value, "ty")) + " is not supported");
      layer.kind = LayerKind::Null;
    }
  }

  void readLayers(const Json& list, Composition& composition) {
    if (list.size() > 65'536) throw Refusal{&list, "a composition has more than 65536 layers"};
    std::unordered_map<int64_t, int64_t> places;
    std::vector<Layer>& layers = composition.layers;
    for (const Json& value : list) {
      layers.emplace_back();
      if (value.is_object()) readLayer(value, layers.back());
      if (layers.back().index) places.emplace(*layers.back().index, static_cast<int64_t>(layers.size()) - 1);
    }
    animation_.layers += layers.size();
    for (size_t i = 0; i < layers.size(); ++i) {
      Layer& layer = layers[i];
      if (layer.parent) {
        const auto parent = places.find(*layer.parent);
        if (parent == places.end())
          reader_.ignored(list[i], "layer " + std::to_string(*layer.parent) + ", a parent, is not there");
        else
          layer.parentPlace = parent->second;
      }
      if (layer.matte == 0) continue;
      layer.mattePlace = static_cast<int64_t>(i) - 1;
      if (find(list[i], "tp")) {
        const auto matte = places.find(static_cast<int64_t>(numberOf(list[i], "tp")));
        layer.mattePlace = matte == places.end() ? -1 : matte->second;
      } else if (i > 0) {
        layers[i - 1].isMatte = true;
      }
      if (layer.mattePlace < 0) {
        reader_.ignored(list[i], "a matte is not there: the layer is drawn without it");
        layer.matte = 0;
      }
    }
    for (size_t i = 0; i < layers.size(); ++i) { // a chain of parents that never ends has no end to begin at
      int64_t at = layers[i].parentPlace;
      for (size_t steps = 0; at >= 0; at = layers[static_cast<size_t>(at)].parentPlace)
        if (++steps > kMaxParents) {
          reader_.ignored(list[i], "layers are their own parents, or have more than 256: the parent is left out");
          layers[i].parentPlace = -1;
          break;
        }
    }
  }

  static constexpr size_t kMaxParents = 256;
  const Json& root_;
  const Outside& outside_;
  const Archive* archive_;
  const ReadLimits& limits_;
  Reader reader_;
  Animation animation_;
  std::vector<const Json*> compositionValues_, imageValues_;
  std::map<std::string, size_t> compositions_, images_; ///< by id
  std::set<size_t> tried_;
  size_t imageBytes_ = 0;
};

/// The animation's JSON in an archive: the first of the manifest's, or the first there is.
std::string unpacked(const Archive& archive, const ReadLimits& limits) {
  std::vector<std::string> wanted;
  if (const auto manifest = archive.read("manifest.json", size_t(1) << 20)) {
    const Json json = parse(*manifest, limits);
    for (const Json& animation : listOf(json, "animations")) {
      const std::string id = stringOf(animation, "id");
      wanted.insert(wanted.end(), {"animations/" + id + ".json", "a/" + id + ".json"});
    }
  }
  for (const std::string& name : archive.names())
    if ((name.starts_with("animations/") || name.starts_with("a/")) && name.ends_with(".json")) wanted.push_back(name);
  for (const std::string& name : wanted)
    if (auto text = archive.read(name, limits.bytes)) return std::move(*text);
  throw Refusal{nullptr, "the archive holds no animation that can be read"};
}

} // namespace

void Reporter::say(GpgpSeverity severity, GpgpResult code, const std::string& place, const std::string& text,
                   const char* apiFunction) {
  if (!said_.insert(text).second) return;
  const std::string label = name_.empty() ? place : place.empty() ? name_ : name_ + ": " + place;
  const GpgpMessage message{severity, code, apiFunction, label.c_str(), text.c_str()};
  if (function_) function_(userData_, &message);
}

void Reporter::error(const core::Error& error, const char* apiFunction) {
  // "3:14: not JSON" has its place at the front, "layers[2]: ..." has it likewise.
  std::string text = error.text, label = name_;
  const size_t digits = text.find_first_not_of("0123456789:");
  if (digits != text.npos && digits > 1 && text.compare(digits - 1, 2, ": ") == 0) {
    label += (label.empty() ? "" : ":") + text.substr(0, digits - 1);
    text.erase(0, digits + 1);
  } else if (const size_t colon = text.find(": "); error.code == GPGP_ERROR_INVALID_DATA && colon != text.npos &&
                                                   text.substr(0, colon).find(' ') == text.npos) {
    label += (label.empty() ? "" : ": ") + text.substr(0, colon);
    text.erase(0, colon + 2);
  }
  const GpgpMessage message{GPGP_SEVERITY_ERROR, error.code, apiFunction, label.c_str(), text.c_str()};
  if (function_) function_(userData_, &message);
}

core::Result<Animation> readAnimation(std::span<const std::byte> bytes, const Outside& outside, Reporter& reporter,
                                      const ReadLimits& limits) {
  Json root;
  try {
    std::optional<Archive> archive;
    std::string own;
    std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (Archive::is(bytes)) {
      archive = Archive::open(bytes);
      if (!archive) throw Refusal{nullptr, "a damaged archive"};
      own = unpacked(*archive, limits);
      text = own;
    }
    if (text.size() > limits.bytes)
      throw Refusal{nullptr, "the file has more than " + std::to_string(limits.bytes >> 20) + " MiB"};
    root = parse(text, limits);
    return FileReader(root, outside, archive ? &*archive : nullptr, reporter, limits).read();
  } catch (const Refusal& refusal) {
    const std::string place = refusal.where ? placeOf(root, refusal.where) : std::string();
    return core::makeError(GPGP_ERROR_INVALID_DATA, "%s%s%s", place.c_str(), place.empty() ? "" : ": ",
                           refusal.text.c_str());
  }
}

} // namespace gpgp::vector::lottie
