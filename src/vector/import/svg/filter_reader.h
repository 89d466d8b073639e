// One element's filter while it becomes steps (layers.h).
#pragma once
#include "vector/import/svg/importer.h"

#include <map>

namespace gpgp::vector::svg {

/// Three rows of a colour matrix (Filter Effects 1, 9.6).
std::array<double, 9> saturation(double amount);
std::array<double, 9> hueRotation(double radians);

/// Of an effect that is measured by an element: what it says of itself, and of the element.
struct Importer::FilterReader {
  Importer& importer;
  const State& state; ///< of the element inside its layer
  pugi::xml_node node;
  Affine space;             ///< of the element's coordinates, in which filters work, to the page
  std::function<Box()> box; ///< of the element, without strokes and effects
  Box drawn;                ///< what it has drawn, in its coordinates
  ImportedLayer& layer;

  /// Appends the steps of all functions. False: nothing of the element is shown.
  bool read(const std::vector<FilterFunction>& functions);

  // Of one <filter>, in primitives.cpp.
  struct Primitive {
    pugi::xml_node node;
    std::string_view name;
    Style style;
    Box place;  ///< its subregion
    Box region; ///< what of it is in the filter's region
    int32_t encoding = 0;
    uint32_t input = 0; ///< the first one
  };
  void readPrimitive(Primitive& p);

  // filter.cpp
  GpgpFilterStep& add(GpgpFilterKind kind, const Box& region, int32_t encoding, std::initializer_list<double> values,
                      uint32_t input = 0, uint32_t input2 = 0);
  uint32_t last() const { return GPGP_FILTER_FIRST_STEP + static_cast<uint32_t>(layer.steps.size()) - 1; }
  bool readElement(pugi::xml_node filter);
  void readFunction(const FilterFunction& function);
  /// What `in` or `in2` means.
  uint32_t inputOf(pugi::xml_node primitive, const char* name);
  bool isStandard(uint32_t input) const {
    return input < GPGP_FILTER_FIRST_STEP || input == source_ || input == alpha_;
  }
  Box regionOfInput(uint32_t input) const;
  Box subregion(const Primitive& p, const std::vector<uint32_t>& inputs);
  /// Regions end between pixels of the scale that the drawing is compiled for, as others draw them.
  Box onPixels(const Box& b) const;
  /// Makes a step's distances, at `first` and behind it, those of such pixels.
  void setDistances(GpgpFilterStep& step, size_t first) const;
  /// What is kept of a subregion.
  Box regionOf(const Box& place) const;
  uint32_t sourceAlpha();

  // primitives.cpp
  void transparent(const Primitive& p) { add(GPGP_FILTER_FLOOD, p.region, p.encoding, {0, 0, 0, 0}); }
  void passOn(const Primitive& p) { add(GPGP_FILTER_OFFSET, p.region, p.encoding, {0, 0}, p.input); }
  double number(pugi::xml_node from, const char* name, double otherwise);
  std::array<double, 2> pair(const Primitive& p, const char* name, double otherwise);
  std::vector<double> numbers(pugi::xml_node from, const char* name, size_t most);
  template <size_t N>
  int32_t choice(pugi::xml_node from, const char* name, const std::string_view (&words)[N], int32_t otherwise) {
    const pugi::xml_attribute a = from.attribute(name);
    const auto* found = std::find(std::begin(words), std::end(words), trim(a.value()));
    if (found != std::end(words)) return static_cast<int32_t>(found - words);
    if (a) importer.ignored(from, a);
    return otherwise;
  }
  const float* table(std::vector<float> numbers, GpgpFilterStep& step);
  std::array<double, 4> colorOf(const Style::StopColor& color, double opacity, const Style& style) const;
  void unsupported(pugi::xml_node from, const std::string& what);
  void blend(Primitive& p);
  void colorMatrix(Primitive& p);
  void componentTransfer(Primitive& p);
  void composite(Primitive& p);
  void convolveMatrix(Primitive& p);
  void lighting(Primitive& p);
  void displacementMap(Primitive& p);
  void dropShadow(Primitive& p);
  void flood(Primitive& p);
  void gaussianBlur(Primitive& p);
  void image(Primitive& p);
  void merge(Primitive& p);
  void morphology(Primitive& p);
  void offset(Primitive& p);
  void tile(Primitive& p);
  void turbulence(Primitive& p);

  bool tooMany = false;   ///< steps
  GpgpFilterStep spare{}; ///< for those
  Box region_{};          ///< of the filter at hand, or of what functions have made
  uint32_t source_ = GPGP_FILTER_SOURCE, alpha_ = GPGP_FILTER_SOURCE_ALPHA;
  bool hasAlpha_ = true;
  // Of the <filter> at hand.
  pugi::xml_node filter_;
  bool byBox_ = false, cuts_ = true; ///< units of primitives; whether their regions are cut to the filter's
  Box unit_{};                       ///< the element's box where those are in its units
  std::map<std::string, uint32_t, std::less<>> results_;
  uint32_t previous_ = 0;
};

} // namespace gpgp::vector::svg
