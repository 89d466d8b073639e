// <image> as a rectangle painted with the image (SVG 2, 12.4), which is embedded or lies beside the drawing. Whoever
// compiles decodes PNG, JPEG and the like, and keeps the texture; here the picture is fitted into its place.
#include "vector/import/svg/data_uri.h"
#include "vector/import/svg/importer.h"

#include <algorithm>
#include <cmath>

#include <zlib.h>

namespace gpgp::vector::svg {
namespace {

/// What a file says that it is, for the message where it is not decoded.
const char* formatOf(const std::vector<uint8_t>& bytes) {
  struct Format {
    std::string_view begin;
    const char* name;
  };
  using namespace std::literals;
  static constexpr Format kFormats[] = {{"\x89PNG"sv, "a PNG file"}, {"\xff\xd8\xff"sv, "a JPEG file"},
                                        {"GIF8"sv, "a GIF file"},    {"RIFF"sv, "a WebP file"},
                                        {"BM"sv, "a BMP file"},      {"II*\0"sv, "a TIFF file"},
                                        {"MM\0*"sv, "a TIFF file"},  {"<svg"sv, "an SVG file"},
                                        {"<?xml"sv, "an SVG file"}};
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  for (const Format& format : kFormats)
    if (text.starts_with(format.begin)) return format.name;
  return nullptr;
}

/// RGBA of 8 bits each as a PNG file; empty where there is no memory for it.
std::vector<uint8_t> pngOf(const uint8_t* pixels, uint32_t width, uint32_t height) {
  const auto word = [](std::vector<uint8_t>& to, uint32_t value) {
    for (const int shift : {24, 16, 8, 0}) to.push_back(static_cast<uint8_t>(value >> shift));
  };
  std::vector<uint8_t> file{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  const auto chunk = [&](std::string_view name, const std::vector<uint8_t>& data) {
    word(file, static_cast<uint32_t>(data.size()));
    const size_t begin = file.size();
    file.insert(file.end(), name.begin(), name.end());
    file.insert(file.end(), data.begin(), data.end());
    word(file, static_cast<uint32_t>(crc32(0, file.data() + begin, static_cast<uInt>(file.size() - begin))));
  };
  std::vector<uint8_t> header, rows;
  word(header, width), word(header, height);
  header.insert(header.end(), {8, 6, 0, 0, 0}); // bits, RGBA
  const size_t row = size_t(4) * width;
  for (uint32_t y = 0; y < height; ++y) {
    rows.push_back(0); // not filtered
    rows.insert(rows.end(), pixels + y * row, pixels + (y + 1) * row);
  }
  uLongf size = compressBound(static_cast<uLong>(rows.size()));
  std::vector<uint8_t> packed(size);
  if (compress2(packed.data(), &size, rows.data(), static_cast<uLong>(rows.size()), Z_BEST_SPEED) != Z_OK) return {};
  packed.resize(size);
  chunk("IHDR", header);
  chunk("IDAT", packed);
  chunk("IEND", {});
  return file;
}

} // namespace

const Importer::Picture* Importer::pictureOf(pugi::xml_node node) {
  const std::string_view href = trim(hrefOf(node).value());
  const auto [known, isNew] = pictures_.try_emplace(href);
  Picture& picture = known->second;
  if (!isNew) return picture.width || picture.drawing ? &picture : nullptr;
  picture.index = pictureCount_;
  std::vector<uint8_t> bytes;
  if (isWord(href.substr(0, 5), "data:")) {
    bytes = decodeDataUri(href);
  } else if (images_.fn && pictureCount_ < GPGP_MAX_IMAGES) {
    std::string path, read;
    const size_t left = limits_.imageBytes - std::min(imageBytes_, limits_.imageBytes);
    const Read result = readBeside(href, {}, left, path, read);
    picture.why = result.isTooLarge ? "makes more bytes of images than are read" : result.why;
    imageBytes_ += read.size();
    bytes.assign(read.begin(), read.end());
  }
  uint32_t width = 0, height = 0;
  if (!bytes.empty() && images_.fn && pictureCount_ < GPGP_MAX_IMAGES &&
      images_.fn(images_.userData, picture.index, bytes.data(), bytes.size(), &width, &height) && width && height) {
    picture.width = width;
    picture.height = height;
    ++pictureCount_;
    return &picture;
  }
  picture.format = formatOf(bytes);
  const std::string_view mark = "<svg";
  const bool isPacked = bytes.size() > 2 && bytes[0] == 0x1f && bytes[1] == 0x8b;
  if (isPacked || std::search(bytes.begin(), bytes.end(), mark.begin(), mark.end()) != bytes.end()) {
    const auto drawing = std::make_shared<Document>();
    const Place place = document_.place(node);
    drawing->setFile((place.file.empty() ? reporter_.name() : std::string(place.file)) + ":" +
                     std::to_string(place.line) + ":" + std::to_string(place.column) + ": image");
    if (drawing->load(std::as_bytes(std::span(bytes)))) return picture.drawing = drawing, &picture;
  }
  return nullptr;
}

const Importer::Picture* Importer::pictureOfGlyph(const GpgpSvgGlyph& glyph) {
  if (!images_.fn || pictureCount_ >= GPGP_MAX_IMAGES) return nullptr;
  std::vector<uint8_t> file = pngOf(glyph.image, glyph.imageWidth, glyph.imageHeight);
  if (file.empty()) return nullptr;
  const auto [known, isNew] = glyphPictures_.try_emplace(std::move(file));
  Picture& picture = known->second;
  if (isNew) {
    picture.index = pictureCount_;
    uint32_t width = 0, height = 0;
    const std::vector<uint8_t>& bytes = known->first;
    if (images_.fn(images_.userData, picture.index, bytes.data(), bytes.size(), &width, &height) && width && height)
      picture.width = width, picture.height = height, ++pictureCount_;
  }
  return picture.width ? &picture : nullptr;
}

void Importer::exchange(Importer& other) {
  std::swap(result_, other.result_);
  std::swap(aside_, other.aside_);
  for (size_t Importer::*count :
       {&Importer::elements_, &Importer::points_, &Importer::work_, &Importer::steps_, &Importer::imageBytes_,
        &Importer::layerCount_, &Importer::blendCount_, &Importer::filterSteps_, &Importer::filterNumbers_})
    std::swap(this->*count, other.*count);
  std::swap(pictureCount_, other.pictureCount_);
  std::swap(stopped_, other.stopped_);
  madeClips_.clear(), other.madeClips_.clear();
}

/// A drawing is a picture of its own: it has its own style sheets and ids, reads no files, and is clipped to its
/// place, not to its page.
void Importer::drawDrawing(pugi::xml_node node, const State& state, const ViewBox& box, const Document& drawing) {
  if (state.depth >= limits_.depth || depthOfDrawings_ >= 8)
    return reporter_.warn(document_.place(node), element(node) + " holds a drawing that is nested too deeply");
  elements_ += drawing.bytes() / 64; // it is read again each time
  if (stopped(node)) return;
  Importer inner(drawing, reporter_, limits_, images_, detail_, nullptr, text_);
  inner.depthOfDrawings_ = depthOfDrawings_ + 1;
  State first = inner.begin();
  if (inner.empty_) return;
  const double pw = inner.result_.width, ph = inner.result_.height;
  const bool isSized = pw > 0 && ph > 0;
  double w = box.width, h = box.height;
  if (w < 0) w = isSized ? h >= 0 ? h * pw / ph : pw : 300;
  if (h < 0) h = isSized ? w * ph / pw : 150;
  if (!(w > 0 && h > 0)) return;
  const Affine fitted =
      Affine{1, 0, 0, 1, box.x, box.y} * (isSized ? fitViewBox({0, 0, pw, ph}, w, h, aspectRatio(node)) : Affine{});
  if (mode_ == Mode::Measure) return measure(rectangle(box.x, box.y, w, h, 0, 0, 1), toBox_ * state.transform);
  if (mode_ == Mode::Clip || !state.style.visible) return;
  first.transform = state.transform * fitted * first.transform;
  inner.toPage_ = first.transform;
  first.opacity = state.opacity, first.depth = state.depth + 1;
  State outer = state;
  clipped(node, state.transform * Affine{1, 0, 0, 1, box.x, box.y}, w, h, outer, [&] {
    first.group = outer.group, first.fading = outer.fading, first.clips = outer.clips, first.layers = outer.layers;
    exchange(inner);
    inner.visit(drawing.root(), first);
    exchange(inner);
  });
}

void Importer::drawImage(pugi::xml_node node, const State& state) {
  LengthContext lengths = state.lengths;
  lengths.fontSize = state.style.fontSize;
  bool hasWidth = false, hasHeight = false;
  const double w = extent(node, state.style, "width", lengths, LengthAxis::X, 0, &hasWidth);
  const double h = extent(node, state.style, "height", lengths, LengthAxis::Y, 0, &hasHeight);
  const double x = length(node, state.style, "x", lengths, LengthAxis::X, 0),
               y = length(node, state.style, "y", lengths, LengthAxis::Y, 0);
  constexpr double unset = -1;
  drawPicture(node, state, {x, y, hasWidth ? w : unset, hasHeight ? h : unset});
}

void Importer::drawPicture(pugi::xml_node node, const State& state, const ViewBox& box) {
  const std::string_view href = trim(hrefOf(node).value());
  const Place place = document_.place(node);
  const Picture* picture = pictureOf(node);
  if (!picture && !images_.fn) return reporter_.warn(place, element(node) + " is not supported");
  if (!picture) {
    const Picture& refused = pictures_.find(href)->second;
    if (refused.why)
      return reporter_.warn(place, element(node) + " '" + std::string(href.substr(0, 60)) + "' " + refused.why +
                                       "; it is not drawn");
    const std::string why = refused.index >= GPGP_MAX_IMAGES
                                ? "is one more than the " + std::to_string(GPGP_MAX_IMAGES) + " that a drawing can have"
                            : refused.format ? std::string("holds ") + refused.format + " that cannot be decoded"
                                             : "holds nothing that can be decoded";
    return reporter_.warn(place, element(node) + " " + why + "; not supported");
  }
  if (picture->drawing) return drawDrawing(node, state, box, *picture->drawing);
  const double pw = picture->width, ph = picture->height, x = box.x, y = box.y;
  double w = box.width, h = box.height;
  if (w < 0) w = h >= 0 ? h * pw / ph : pw;
  if (h < 0) h = w * ph / pw;
  if (!(w > 0 && h > 0)) return;
  const Affine fitted = Affine{1, 0, 0, 1, x, y} * fitViewBox({0, 0, pw, ph}, w, h, aspectRatio(node));
  if (state.style.overflowVisible && aspectRatio(node).slice)
    reporter_.warn(place, "overflow 'visible' is not supported: " + element(node) + " is drawn without it");
  // What of the picture is within its place.
  const double left = std::max(x, fitted.e), top = std::max(y, fitted.f);
  const double right = std::min(x + w, fitted.e + pw * fitted.a), bottom = std::min(y + h, fitted.f + ph * fitted.d);
  if (!(right > left && bottom > top)) return;
  if (mode_ == Mode::Measure)
    return measure(rectangle(left, top, right - left, bottom - top, 0, 0, 1), toBox_ * state.transform);
  if (mode_ == Mode::Clip || !state.style.visible) return;
  const Affine map = fitted * Affine{pw, 0, 0, ph, 0, 0};
  group_ = state.group;
  emitPicture(
      rectangle((left - map.e) / map.a, (top - map.f) / map.d, (right - left) / map.a, (bottom - top) / map.d, 0, 0, 1),
      state, map, *picture, node);
}

void Importer::emitPicture(const Shape& shape, const State& state, const Affine& own, const Picture& picture,
                           pugi::xml_node node) {
  const Affine map = state.transform * own;
  const double to[6] = {map.a, map.b, map.c, map.d, map.e, map.f};
  auto paint = std::make_shared<GpgpImagePaint>();
  paint->image = picture.index;
  for (size_t i = 0; i < 6; ++i) paint->transform[i] = static_cast<float>(to[i]);
  const float* t = paint->transform;
  const auto area =
      static_cast<double>(t[0]) * static_cast<double>(t[3]) - static_cast<double>(t[1]) * static_cast<double>(t[2]);
  for (const float v : paint->transform)
    if (!(std::fabs(static_cast<double>(v) / area) < 1e20 && std::fabs(v) < 1e15f)) return; // seen from its edge
  emit(shape, map, GPGP_FILL_NON_ZERO, {{0, 0, 0, 1}, nullptr, std::move(paint)}, state.opacity, node);
}

} // namespace gpgp::vector::svg
