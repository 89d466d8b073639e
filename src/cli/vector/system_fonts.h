// The fonts that the system has, by fontconfig.
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

struct _FcConfig;

namespace gpgp::cli {

/// A face in a file; of a variable font with the values of its axes.
struct SystemFont {
  std::string file;
  uint32_t face = 0;
  std::vector<std::pair<std::string, float>> axes; ///< tag and value
  bool operator==(const SystemFont&) const = default;
};

/// What is asked for besides a family.
struct FontStyle {
  float weight = 400;  ///< from 1 to 1000
  float stretch = 100; ///< percent
  bool italic = false;
};

class SystemFonts {
public:
  /// Whether the command is built with fontconfig.
  static bool areThere();
  /// Reads what fontconfig knows, which takes some time.
  SystemFonts();
  /// The one that fits best, then others for the characters of the UTF-8 text that it does not have. `families` as
  /// font-family lists them.
  std::vector<SystemFont> find(const std::vector<std::string>& families, const FontStyle& style,
                               const std::string& language, std::string_view text) const;

private:
  struct Closer {
    void operator()(_FcConfig* config) const;
  };
  std::unique_ptr<_FcConfig, Closer> config_;
};

} // namespace gpgp::cli
