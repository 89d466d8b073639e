// Any bytes as a file of axioms, in CSV, JSON or GeoJSON, as rectangles for all grammars and as polygons for .cga: an
// error, or axioms whose transforms, sizes and places are finite.
#include "cli/spawn/axioms.h"
#include "cli/spawn/cga.h"
#include "fuzz/file.h"

#include <cmath>

namespace {
using namespace gpgp::cli;

void check(bool holds) {
  if (!holds) std::abort();
}
void check(const glm::vec3& v) { check(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z)); }

template <class Read> void readOrFail(const Read& read) {
  try {
    read();
  } catch (const Failure&) { // with its place, for a person
  } catch (const Usage&) {
  }
}
} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const gpgp::test::InputFile input(".json");
  const std::filesystem::path& file = input.write(data, size);
  const std::vector<NamedStart> starts = {{"Lot", "Box"}, {"Tower", "Prism"}};
  for (const float interval : {0.0f, 7.0f})
    readOrFail([&] {
      AxiomDefaults defaults;
      defaults.interval = interval;
      const auto axioms = readAxioms(file, starts, defaults);
      check(!axioms.empty());
      for (const GpgpAxiom& axiom : axioms) {
        for (const float number : axiom.transform) check(std::isfinite(number));
        for (const float side : axiom.size) check(std::isfinite(side) && side >= 0);
        check(axiom.start < starts.size() || axiom.start == GPGP_AXIOM_DEFAULT_START);
      }
    });
  for (const bool geographic : {false, true})
    readOrFail([&] {
      CgaOptions options;
      options.axiomFile = file.string();
      options.geographic = geographic;
      const CgaAxioms axioms = cgaAxioms(options, {"Lot", "Tower"});
      check(!axioms.axioms.empty() && axioms.axioms.size() == axioms.rules.size());
      for (const auto& axiom : axioms.axioms) {
        size_t points = 0;
        for (const uint32_t loop : axiom.loopSizes) points += loop;
        check(points == axiom.points.size());
        for (const glm::vec3& point : axiom.points) check(point);
        for (const glm::vec3& v : {axiom.origin, axiom.axisX, axiom.axisY, axiom.axisZ, axiom.size}) check(v);
      }
    });
  return 0;
}
