// A benchmark's command line: --help, and a clear end where a word makes no sense.
#pragma once
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>

namespace gpgp::bench {

/// The command was used wrongly.
struct Usage : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The words behind the program's name, one after the other.
class Arguments {
public:
  Arguments(int argc, char** argv) : at_(argv), end_(argv + argc) {}
  /// Goes on to the next word. False where there is none.
  bool next() {
    if (end_ - at_ < 2) return false;
    word_ = *++at_;
    return true;
  }
  const std::string& word() const { return word_; }
  /// What is no option: a name, which does not begin with a dash.
  const std::string& name() const {
    if (word_.starts_with("-")) throw Usage("'" + word_ + "' is no option");
    return word_;
  }
  /// What follows the option at hand.
  std::string value() {
    if (end_ - at_ < 2) throw Usage(word_ + " needs a value");
    return *++at_;
  }
  /// The same, a number from least on.
  double real(double least, double most) { return parsed(word_, value(), least, most); }
  uint32_t number(uint32_t least = 1, uint32_t most = 1u << 30) { return whole(word_, value(), least, most); }
  /// The word at hand as a number.
  uint32_t count(uint32_t least = 1) const { return whole("the argument", name(), least, 1u << 30); }

private:
  static double parsed(const std::string& what, const std::string& text, double least, double most) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (end != text.c_str() && *end == 0 && value >= least && value <= most) return value;
    char range[64];
    std::snprintf(range, sizeof range, "%g to %g", least, most);
    throw Usage(what + ": '" + text + "' is not a number from " + range);
  }
  static uint32_t whole(const std::string& what, const std::string& text, uint32_t least, uint32_t most) {
    const double value = parsed(what, text, least, most);
    const auto number = static_cast<uint32_t>(value);
    if (static_cast<double>(number) != value) throw Usage(what + ": '" + text + "' is no whole number");
    return number;
  }
  char **at_, **end_;
  std::string word_;
};

/// main of a benchmark: `run` takes Arguments and returns the exit code. --help: usage, and 0; wrong usage: 2; what
/// else is thrown: 1.
template <class Run> int benchMain(int argc, char** argv, const char* usage, Run&& run) {
  const std::string path = argv[0], name = path.substr(path.find_last_of('/') + 1);
  for (int i = 1; i < argc; ++i)
    if (std::string(argv[i]) == "--help" || std::string(argv[i]) == "-h") return std::fputs(usage, stdout), 0;
  try {
    return run(Arguments(argc, argv));
  } catch (const Usage& error) {
    std::fprintf(stderr, "%s: %s\n\n%s", name.c_str(), error.what(), usage);
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", name.c_str(), error.what());
    return 1;
  }
}

} // namespace gpgp::bench
