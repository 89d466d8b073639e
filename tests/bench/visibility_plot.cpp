// SVG pictures of the lines that printFigures prints: one axis each way, a colour a series, a label a point.
#include "visibility_figures.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

namespace gpgp::test {
namespace {

struct Point {
  std::string label;
  double x, y;
};
using Series = std::vector<std::pair<std::string, std::vector<Point>>>; // in the order of the file

struct Style {
  const char *title, *x, *y;
  bool lines, logX;
};
const std::map<std::string, Style>& styles() {
  static const std::map<std::string, Style> all = {
      {"6.9", {"Triangles found by N x N samples a pixel", "N", "% of the finest grid's", true, true}},
      {"6.10", {"GPU time by resolution", "factor of resolution", "ms", true, false}},
      {"6.11", {"Found and too much by resolution", "factor of resolution", "% of the reference", true, false}},
      {"6.12", {"Static and dynamic epsilon", "overestimation, %", "coverage, %", true, false}},
      {"6.14", {"View cells: pixels/skip", "overestimation, %", "coverage, %", false, false}},
      {"cell", {"A walking viewer's cell, by view points", "overestimation, %", "coverage, %", false, false}}};
  return all;
}

/// A step of 1, 2 or 5 times a power of ten that cuts the range into at most eight.
double stepOf(double range) {
  const double rough = std::max(range, 1e-9) / 8, power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double m : {1.0, 2.0, 5.0})
    if (m * power >= rough) return m * power;
  return 10 * power;
}

void writePlot(const std::string& file, const std::string& scene, const Style& style, const Series& series) {
  constexpr double kWidth = 720, kHeight = 460, kLeft = 64, kRight = 170, kTop = 36, kBottom = 48;
  static const char* const kColours[] = {"#1b6ca8", "#d1495b", "#3a8f5c", "#b8860b", "#6a4c93", "#555555"};
  const auto place = [&](double x) { return style.logX ? std::log2(std::max(x, 1e-9)) : x; };
  double lowX = 1e300, highX = -1e300, lowY = 1e300, highY = -1e300;
  for (const auto& [name, points] : series)
    for (const Point& p : points) {
      lowX = std::min(lowX, place(p.x)), highX = std::max(highX, place(p.x));
      lowY = std::min(lowY, p.y), highY = std::max(highY, p.y);
    }
  const double stepX = style.logX ? 1 : stepOf(highX - lowX), stepY = stepOf(highY - lowY);
  lowX = std::floor(lowX / stepX) * stepX, highX = std::max(std::ceil(highX / stepX) * stepX, lowX + stepX);
  lowY = std::floor(lowY / stepY) * stepY, highY = std::max(std::ceil(highY / stepY) * stepY, lowY + stepY);
  const auto atX = [&](double x) { return kLeft + (x - lowX) / (highX - lowX) * (kWidth - kLeft - kRight); };
  const auto atY = [&](double y) {
    return kHeight - kBottom - (y - lowY) / (highY - lowY) * (kHeight - kTop - kBottom);
  };
  std::ofstream svg(file);
  svg << "<svg xmlns='http://www.w3.org/2000/svg' width='" << kWidth << "' height='" << kHeight
      << "' font-family='sans-serif' font-size='11'>\n<rect width='100%' height='100%' fill='white'/>\n<text x='"
      << kLeft << "' y='20' font-size='14'>" << style.title << ": " << scene << "</text>\n";
  for (double x = lowX; x <= highX + stepX / 2; x += stepX)
    svg << "<path d='M" << atX(x) << ' ' << kTop << 'V' << kHeight - kBottom << "' stroke='#ddd'/><text x='" << atX(x)
        << "' y='" << kHeight - kBottom + 16 << "' text-anchor='middle'>"
        << (style.logX ? std::exp2(x) : std::round(x / stepX) * stepX) << "</text>\n";
  for (double y = lowY; y <= highY + stepY / 2; y += stepY)
    svg << "<path d='M" << kLeft << ' ' << atY(y) << 'H' << kWidth - kRight << "' stroke='#ddd'/><text x='" << kLeft - 6
        << "' y='" << atY(y) + 4 << "' text-anchor='end'>" << std::round(y / stepY) * stepY << "</text>\n";
  svg << "<text x='" << (kLeft + kWidth - kRight) / 2 << "' y='" << kHeight - 10 << "' text-anchor='middle'>" << style.x
      << "</text>\n<text transform='translate(14 " << kHeight / 2 << ") rotate(-90)' text-anchor='middle'>" << style.y
      << "</text>\n";
  size_t n = 0;
  for (const auto& [name, points] : series) {
    const char* colour = kColours[n % std::size(kColours)];
    if (style.lines && points.size() > 1) {
      svg << "<path fill='none' stroke='" << colour << "' d='";
      for (size_t i = 0; i < points.size(); ++i)
        svg << (i ? 'L' : 'M') << atX(place(points[i].x)) << ' ' << atY(points[i].y);
      svg << "'/>\n";
    }
    for (const Point& p : points)
      svg << "<circle r='3' fill='" << colour << "' cx='" << atX(place(p.x)) << "' cy='" << atY(p.y) << "'/><text x='"
          << atX(place(p.x)) + 5 << "' y='" << atY(p.y) - 4 << "' fill='" << colour << "' font-size='9'>" << p.label
          << "</text>\n";
    svg << "<circle r='4' fill='" << colour << "' cx='" << kWidth - kRight + 16 << "' cy='"
        << kTop + 10 + 18 * static_cast<double>(n) << "'/><text x='" << kWidth - kRight + 26 << "' y='"
        << kTop + 14 + 18 * static_cast<double>(n) << "'>" << name << "</text>\n";
    ++n;
  }
  svg << "</svg>\n";
}
} // namespace

bool plotFigures(const std::vector<std::string>& files, const std::string& folder) {
  std::map<std::pair<std::string, std::string>, Series> figures;
  for (const std::string& name : files) {
    std::ifstream file(name);
    if (!file) {
      std::fprintf(stderr, "%s cannot be read\n", name.c_str());
      return false;
    }
    for (std::string line; std::getline(file, line);) {
      std::istringstream parts(line);
      std::string figure, scene, series, x, y;
      Point point{};
      if (!std::getline(parts, figure, ',') || !styles().count(figure) || !std::getline(parts, scene, ',') ||
          !std::getline(parts, series, ',') || !std::getline(parts, point.label, ',') || !std::getline(parts, x, ',') ||
          !std::getline(parts, y))
        continue;
      point.x = std::atof(x.c_str());
      point.y = std::atof(y.c_str());
      Series& all = figures[{figure, scene}];
      const auto known = std::find_if(all.begin(), all.end(), [&](const auto& s) { return s.first == series; });
      (known == all.end() ? all.emplace_back(series, std::vector<Point>()) : *known).second.push_back(point);
    }
  }
  std::filesystem::create_directories(folder);
  for (const auto& [key, series] : figures) {
    const std::string file = folder + "/figure-" + key.first + "-" + key.second + ".svg";
    writePlot(file, key.second, styles().at(key.first), series);
    std::printf("%s\n", file.c_str());
  }
  return !figures.empty();
}

} // namespace gpgp::test
