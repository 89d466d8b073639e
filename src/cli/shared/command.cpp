// Options that every subcommand has, and values that CLI11 does not know.
#include "cli/shared/command.h"

#include "host/files.h"

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <iterator>

namespace gpgp::cli {

void addCommonOptions(CLI::App& command, CommonOptions& options) {
  command.add_option(
      "--device", options.device,
      "GPU to use: an index or part of a name, as `gpgp info` lists them (default: $GPGP_DEVICE, else the "
      "software device)");
  command.add_flag("--json", options.json, "Print one JSON object instead of text");
  command.add_flag("--validate", options.validate,
                   "Run under the Khronos validation layer; any message from it makes the command fail");
}

void addDumpOptions(CLI::App& command, CommonOptions& options) {
  auto* pass = command.add_option("--dump-pass", options.dumpPass,
                                  "For debugging: write the scratch buffers that a pass uses, as they are after it, to "
                                  "PASS.BUFFER.bin. If several passes share a name, PASS#2 is the second. "
                                  "shaders/*/shared/layout.h and the CPU reference define their layout");
  command.add_option("--dump-folder", options.dumpFolder, "Folder for these files (default: the current one)")
      ->needs(pass);
}

Size parseSize(const std::string& text) {
  char* end = nullptr;
  const unsigned long width = std::strtoul(text.c_str(), &end, 10);
  if (end != text.c_str() && *end == 'x') {
    const char* second = end + 1;
    const unsigned long height = std::strtoul(second, &end, 10);
    if (end != second && *end == 0 && width >= 1 && height >= 1 && width <= 16384 && height <= 16384 &&
        text[0] != '-' && *second != '-')
      return {static_cast<uint32_t>(width), static_cast<uint32_t>(height)};
  }
  throw CLI::ValidationError("\"" + text + "\" is not a size; write for example 1280x720 (1 to 16384 each)");
}

std::array<float, 3> parseTriple(const std::string& text) {
  std::array<float, 3> values{};
  const char* at = text.c_str();
  for (size_t i = 0; i < 3; ++i) {
    char* end = nullptr;
    values[i] = std::strtof(at, &end);
    const bool last = i == 2;
    if (end == at || *end != (last ? '\0' : ',') || !std::isfinite(values[i]) || values[i] <= 0.0f)
      throw CLI::ValidationError("\"" + text + "\" are not three positive numbers; write for example 10,20,10");
    at = end + 1;
  }
  return values;
}

namespace {
CLI::Validator fileThatEnds(const std::string& ending, const std::string& what) {
  return {[=](std::string& text) {
            const size_t size = text.size(), end = ending.size();
            const bool good = size > end && CLI::detail::to_lower(text.substr(size - end)) == ending;
            return good ? std::string() : text + ": " + what + " are written as " + ending + " alone";
          },
          ""};
}
} // namespace

CLI::Validator pngFile() { return fileThatEnds(".png", "pictures"); }
CLI::Validator glbFile() { return fileThatEnds(".glb", "triangles"); }

CLI::Validator existingInput() {
  return {[](std::string& file) { return file == kStandard ? std::string() : CLI::ExistingFile(file); }, "FILE"};
}

std::string readInput(const std::string& file) {
  if (file != kStandard) return host::readText(file);
  return {std::istreambuf_iterator<char>(std::cin), std::istreambuf_iterator<char>()};
}

std::string inputName(const std::string& file) { return file == kStandard ? "<standard input>" : file; }

CLI::Validator within(double low, double high) {
  std::ostringstream range;
  range << low << " to " << high;
  return {[=, range = range.str()](std::string& text) {
            double value = 0;
            const bool good = CLI::detail::lexical_cast(text, value) && value >= low && value <= high;
            return good ? std::string() : text + " is not within " + range;
          },
          "FLOAT from " + range.str()};
}

CLI::Option* addSize(CLI::App& command, const std::string& name, Size& size, const std::string& help) {
  return command
      .add_option_function<std::string>(
          name, [&size](const std::string& text) { size = parseSize(text); }, help)
      ->type_name("WxH");
}

} // namespace gpgp::cli
