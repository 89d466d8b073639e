// Measures what the thesis plots. All shares are percent of the truth of 64 x 64 + 1 samples made in the same run, and
// false positives were sampled again at the largest grid where that is finer.
#include "visibility_figures.h"

#include <cmath>

namespace gpgp::test {
namespace {

void print(const char* figure, const std::string& scene, const char* series, const std::string& label, double x,
           double y) {
  std::printf("%s,%s,%s,%s,%.4f,%.4f\n", figure, scene.c_str(), series, label.c_str(), x, y);
  std::fflush(stdout);
}
double percent(float share) { return 100 * static_cast<double>(share); }
std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%g", value);
  return buffer;
}

struct Figures {
  Runner& runner;
  const std::string& scene;
  const uint32_t height;
  const FigureOptions& options;
  Sampler standard, exact, conservative;
  host::Buffer truth, counts, finest;
  bool recheck;
  double standardTime = 0;

  Figures(Runner& r, const std::string& s, uint32_t h, const FigureOptions& o)
      : runner(r), scene(s), height(h), options(o), standard(r.sampler(GPGP_SAMPLING_STANDARD_BIT, 1)),
        exact(r.sampler(GPGP_SAMPLING_EXACT_BIT, 1)), conservative(r.sampler(GPGP_SAMPLING_CONSERVATIVE_BIT, 1)),
        truth(r.makeBits()), counts(r.makeCounts()), finest(r.makeBits()), recheck(o.largestGrid > 64) {}

  std::span<const GpgpCamera> middle() const { return {&runner.camera(), 1}; }
  GpgpSampleReport compare(const host::Buffer& bits, const host::Buffer& with) {
    return runner.metrics(standard, bits, with, nullptr, recheck ? &finest : nullptr);
  }
  static Sampling thesis(float epsilonStatic, float epsilonDynamic, float resolution = 1) {
    return {.method = GPGP_SAMPLING_CONSERVATIVE,
            .resolution = resolution,
            .heuristics = GPGP_HEURISTICS_THESIS,
            .epsilonStatic = epsilonStatic,
            .epsilonDynamic = epsilonDynamic};
  }

  /// Figure 6.9; leaves the truth and the finest grid's bits.
  void grids() {
    runner.truth(options.largestGrid, middle(), finest);
    runner.truth(64, middle(), truth, &counts);
    host::Buffer bits = runner.makeBits();
    const double all = runner.metrics(standard, finest, finest, nullptr, nullptr).truth;
    for (uint32_t n = 1; n <= options.largestGrid; n *= 2) {
      runner.truth(n, middle(), bits);
      const GpgpSampleReport found = runner.metrics(standard, bits, bits, nullptr, nullptr);
      print("6.9", scene, "grid", std::to_string(n), n, 100.0 * found.truth / all);
    }
  }

  /// Figures 6.10, 6.11 and table 6.1.
  void resolutions() {
    const auto run = [&](const char* series, const std::string& label, double factor, Sampler& sampler,
                         const Sampling& sampling) {
      const double time = runner.measure(sampler, sampling, options.repeat).milliseconds;
      if (standardTime == 0) standardTime = time;
      const GpgpSampleReport m = compare(runner.bits(), truth);
      print("6.10", scene, series, label, factor, time);
      print("table6.1", scene, series, label, time, time / standardTime);
      print("6.11", scene, (std::string(series) + " coverage").c_str(), label, factor, percent(m.coverage));
      print("6.11", scene, (std::string(series) + " overestimation").c_str(), label, factor, percent(m.overestimation));
    };
    run("standard", "1", 1, standard, {});
    for (const float factor : {0.25f, 0.5f, 0.75f, 1.0f})
      run("conservative", text(static_cast<double>(factor)), static_cast<double>(factor), conservative,
          thesis(2, 2, factor)); // table 6.1's epsilons
    run("exact", "1", 1, exact, {.method = GPGP_SAMPLING_EXACT});
  }

  /// Figure 6.12.
  void epsilons() {
    for (const float dynamic : {0.0f, 0.1f, 0.5f, 2.0f})
      for (const float still : {0.0f, 0.01f, 0.05f, 0.2f, 1.0f, 5.0f}) {
        runner.record(conservative, thesis(still, dynamic), {}, runner.bits());
        const GpgpSampleReport m = compare(runner.bits(), truth);
        const std::string series = "dynamic " + text(static_cast<double>(dynamic));
        print("6.12", scene, series.c_str(), text(static_cast<double>(still)), percent(m.overestimation),
              percent(m.coverage));
      }
  }

  static std::vector<GpgpCamera> camerasOf(const GpgpViewCellInfo& info) {
    uint32_t count = 0;
    expect(gpgpGetViewCellCameras(&info, &count, nullptr), "view cell");
    std::vector<GpgpCamera> cameras(count);
    expect(gpgpGetViewCellCameras(&info, &count, cameras.data()), "view cell");
    return cameras;
  }
  void unite(Sampler& sampler, Sampling sampling, const std::vector<GpgpCamera>& cameras) {
    for (const GpgpCamera& camera : cameras) {
      runner.record(sampler, sampling, {&camera, 1}, runner.bits());
      sampling.accumulate = true;
    }
  }

  /// Figure 6.14: pixels of the grid and skip as the thesis labels them, 32/8.
  void pixelCells() {
    GpgpViewCellInfo info = GPGP_VIEW_CELL_INFO_INIT;
    info.camera = runner.camera();
    info.height = height;
    // The grid lies where half of a walking viewer's surroundings are nearer: its eye moves by millimetres.
    info.distance = 10;
    for (uint32_t pixels = 1; pixels <= options.largestCell; pixels *= 2)
      for (uint32_t skip = 1; skip < std::max(pixels, 2u); skip *= 2) {
        if (pixels / skip > 8) continue; // at most 65 view points
        info.columns = info.rows = pixels;
        info.skip = skip;
        const std::vector<GpgpCamera> cameras = camerasOf(info);
        const std::string label = std::to_string(pixels) + "/" + std::to_string(skip);
        unite(conservative, thesis(0.05f, 0.05f), cameras);
        GpgpSampleReport m = compare(runner.bits(), truth);
        print("6.14", scene, "conservative", label, percent(m.overestimation), percent(m.coverage));
        unite(exact, {.method = GPGP_SAMPLING_EXACT}, cameras);
        m = compare(runner.bits(), truth);
        print("6.14", scene, "exact", label, percent(m.overestimation), percent(m.coverage));
      }
  }

  /// A viewer who walks: half a metre to each side, and up and down. The truth: side x side view points, 16 x 16
  /// samples; what a view point of a method claims beyond that counts as seen from the cell where the largest grid
  /// shows it from one of them.
  void walkingCell() {
    const auto square = [&](uint32_t side) { // rows from below
      std::vector<float> points;
      for (uint32_t i = 0; i < side * side; ++i) {
        const float x = static_cast<float>(i % side) / static_cast<float>(side - 1) - 0.5f;
        const float y = static_cast<float>(i / side) / static_cast<float>(side - 1) - 0.5f;
        if (x != 0 || y != 0) points.insert(points.end(), {x, y, 0});
      }
      return points;
    };
    GpgpViewCellInfo info = GPGP_VIEW_CELL_INFO_INIT;
    info.camera = runner.camera();
    const auto take = [&](const std::vector<float>& points) { // the middle first
      info.points = points.data();
      info.pointCount = static_cast<uint32_t>(points.size() / 3);
      return camerasOf(info);
    };
    host::Buffer whole = runner.makeBits(), again = runner.makeBits();
    runner.truth(16, take(square(options.largestCell >= 32 ? 17 : 5)), whole);
    std::vector<float> points = square(3);
    points.insert(points.end(), {0.25f, -0.5f, 0, -0.5f, -0.25f, 0, 0.5f, 0.25f, 0, -0.25f, 0.5f, 0});
    // Middle; corner, side, corner; side, side; the same; a turned square.
    const std::vector<GpgpCamera> cell = take(points);
    const bool sampledAgain = options.largestGrid > 16;
    if (sampledAgain) runner.truth(options.largestGrid, cell, again);
    const Runner::Run one = runner.measure(exact, {.method = GPGP_SAMPLING_EXACT}, options.repeat);
    Sampler together = runner.sampler(GPGP_SAMPLING_EXACT_BIT, 1, shader::kMaxCameras);
    const auto run = [&](const char* series, Sampler& sampler, const Sampling& sampling, uint32_t perRecord,
                         const std::vector<size_t>& which) {
      std::vector<GpgpCamera> cameras;
      for (const size_t i : which) cameras.push_back(cell[i]);
      const Runner::Run all = runner.measureUnion(sampler, sampling, cameras, perRecord, options.repeat);
      const GpgpSampleReport m =
          runner.metrics(standard, runner.bits(), whole, nullptr, sampledAgain ? &again : nullptr);
      const std::string label = std::to_string(cameras.size()) + (which.back() == 12 ? " turned" : "");
      print("cell", scene, series, label, percent(m.overestimation), percent(m.coverage));
      print("cellcost", scene, series, label, static_cast<double>(cameras.size()), all.milliseconds / one.milliseconds);
      if (sampling.method == GPGP_SAMPLING_EXACT)
        print("cellpairs", scene, series, label, static_cast<double>(cameras.size()),
              double(all.report.neededPairs) / one.report.neededPairs);
    };
    const Sampling exactly{.method = GPGP_SAMPLING_EXACT};
    for (const std::vector<size_t>& which : {std::vector<size_t>{0},
                                             {1, 3, 6, 8},
                                             {9, 10, 11, 12},
                                             {0, 1, 3, 6, 8},
                                             {0, 9, 10, 11, 12},
                                             {1, 8, 3, 6, 2, 7, 4, 5},
                                             {0, 1, 8, 3, 6, 2, 7, 4, 5}}) {
      run("exact", exact, exactly, 1, which);
      if (which.size() > 1) run("exact together", together, exactly, shader::kMaxCameras, which);
    }
    run("standard", standard, {}, 1, {0, 1, 3, 6, 8});
    run("conservative", conservative, thesis(0.05f, 0.05f), 1, {0, 1, 3, 6, 8});
  }
};
} // namespace

void printFigures(Runner& runner, const std::string& scene, uint32_t height, const FigureOptions& options) {
  Figures figures(runner, scene, height, options);
  figures.grids();
  figures.resolutions();
  figures.epsilons();
  figures.pixelCells();
  if (options.largestCell > 1) figures.walkingCell();
}

void printWalkingCell(Runner& runner, const std::string& scene, uint32_t height, const FigureOptions& options) {
  Figures(runner, scene, height, options).walkingCell();
}

} // namespace gpgp::test
