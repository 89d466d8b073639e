#include "cli/spawn/fields.h"

#include "cli/shared/common.h"
#include "host/picture.h"

#include <cmath>
#include <cstdlib>

namespace gpgp::cli {
namespace {

/// Numbers behind commas, from `at` to the text's end.
std::vector<float> numbersOf(const std::string& text, size_t at) {
  std::vector<float> numbers;
  while (at < text.size()) {
    const char* from = text.c_str() + at + 1;
    char* end = nullptr;
    numbers.push_back(std::strtof(from, &end));
    if (end == from || (*end && *end != ',') || !std::isfinite(numbers.back()))
      throw Usage("--field " + text + ": expected numbers behind the file: X0,Z0,X1,Z1, and SCALE");
    at = static_cast<size_t>(end - text.c_str());
  }
  return numbers;
}

} // namespace

void addFields(CLI::App& command, std::vector<std::string>& texts) {
  command
      .add_option(
          "--field", texts,
          "A field of the world, which rules read as Field(NAME), in .cga files as Field(\"NAME\") or as the attr "
          "NAME: a PNG file whose first and last pixels lie at X0,Z0 and X1,Z1 (default: one metre a pixel, around the "
          "origin); black is 0, white is SCALE (default 1). May be repeated")
      ->type_name("NAME=FILE.png[,X0,Z0,X1,Z1[,SCALE]]")
      ->allow_extra_args(false);
}

WorldFields::WorldFields(const std::vector<std::string>& texts) {
  std::vector<size_t> firsts;
  for (const std::string& text : texts) {
    const size_t equals = text.find('=');
    if (equals == 0 || equals == std::string::npos) throw Usage("--field " + text + ": expected NAME=FILE.png");
    const size_t comma = std::min(text.find(',', equals), text.size());
    const std::vector<float> numbers = numbersOf(text, comma);
    if (!numbers.empty() && numbers.size() != 4 && numbers.size() != 5)
      throw Usage("--field " + text + ": expected X0,Z0,X1,Z1, or these and SCALE behind the file");
    const host::Heights heights = host::readHeights(text.substr(equals + 1, comma - equals - 1));
    const float scale = numbers.size() == 5 ? numbers[4] : 1.0f;
    GpgpSpawnField& field = fields_.emplace_back();
    field.name = names_.emplace_back(text.substr(0, equals)).c_str();
    field.grid.width = heights.width;
    field.grid.height = heights.height;
    field.offset = values_.size() * sizeof(float);
    for (int axis = 0; axis < 2; ++axis) { // around the origin, a metre a pixel
      const float half = static_cast<float>((axis ? heights.height : heights.width) - 1) / 2;
      field.grid.min[axis] = numbers.empty() ? -half : numbers[size_t(axis)];
      field.grid.max[axis] = numbers.empty() ? half : numbers[2 + size_t(axis)];
    }
    firsts.push_back(values_.size());
    for (const uint16_t value : heights.values) values_.push_back(scale * static_cast<float>(value) / 65535.0f);
  }
  for (size_t i = 0; i < fields_.size(); ++i) fields_[i].grid.values = values_.data() + firsts[i];
}

void WorldFields::bind(const spawn::Graph& graph) {
  const auto bound = spawn::bindFields(graph, {fields_.data(), static_cast<uint32_t>(fields_.size())});
  if (!bound) throw Usage(std::string("--field: ") + bound.error().text);
  bound_ = *bound;
}

void WorldFields::give(DeriverOptions& options) const {
  options.fields = fields_;
  options.fieldValues = values_;
}

} // namespace gpgp::cli
