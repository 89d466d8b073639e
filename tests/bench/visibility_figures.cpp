// Measures what the thesis plots. All shares are percent of the reference of 64 x 64 + 1 samples made in the same run,
// and false positives were sampled again at the largest grid where that is finer.
#include "visibility_figures.h"

#include <chrono>
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
  VisibilityRecorder standard, exact, conservative;
  host::Buffer reference, counts, finest;
  bool recheck;
  double standardTime = 0;

  Figures(Runner& r, const std::string& s, uint32_t h, const FigureOptions& o)
      : runner(r), scene(s), height(h), options(o), standard(r.recorder(GPGP_SAMPLING_STANDARD_BIT, 1)),
        exact(r.recorder(GPGP_SAMPLING_EXACT_BIT, 1)), conservative(r.recorder(GPGP_SAMPLING_CONSERVATIVE_BIT, 1)),
        reference(r.makeBits()), counts(r.makeCounts()), finest(r.makeBits()), recheck(o.largestGrid > 64) {}

  std::span<const GpgpCamera> middle() const { return {&runner.camera(), 1}; }
  GpgpVisibilityReport compare(const host::Buffer& bits, const host::Buffer& with) {
    return runner.metrics(standard, bits, with, nullptr, recheck ? &finest : nullptr);
  }
  static Sampling thesis(float epsilonStatic, float epsilonDynamic, float resolution = 1) {
    return {.method = GPGP_SAMPLING_CONSERVATIVE,
            .resolution = resolution,
            .heuristics = GPGP_HEURISTICS_DEFAULT,
            .epsilonStatic = epsilonStatic,
            .epsilonDynamic = epsilonDynamic};
  }

  /// Figure 6.9; leaves the reference and the finest grid's bits.
  void grids() {
    runner.reference(options.largestGrid, middle(), finest);
    runner.reference(64, middle(), reference, &counts);
    host::Buffer bits = runner.makeBits();
    const double all = runner.metrics(standard, finest, finest, nullptr, nullptr).reference;
    for (uint32_t n = 1; n <= options.largestGrid; n *= 2) {
      runner.reference(n, middle(), bits);
      const GpgpVisibilityReport found = runner.metrics(standard, bits, bits, nullptr, nullptr);
      print("6.9", scene, "grid", std::to_string(n), n, 100.0 * found.reference / all);
    }
  }

  /// Figures 6.10, 6.11 and table 6.1.
  void resolutions() {
    const auto run = [&](const char* series, const std::string& label, double factor, VisibilityRecorder& recorder,
                         const Sampling& sampling) {
      const double time = runner.measure(recorder, sampling, options.repeat).milliseconds;
      if (standardTime == 0) standardTime = time;
      const GpgpVisibilityReport m = compare(runner.bits(), reference);
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
        const GpgpVisibilityReport m = compare(runner.bits(), reference);
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
  void unite(VisibilityRecorder& recorder, Sampling sampling, const std::vector<GpgpCamera>& cameras) {
    for (const GpgpCamera& camera : cameras) {
      runner.record(recorder, sampling, {&camera, 1}, runner.bits());
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
        GpgpVisibilityReport m = compare(runner.bits(), reference);
        print("6.14", scene, "conservative", label, percent(m.overestimation), percent(m.coverage));
        unite(exact, {.method = GPGP_SAMPLING_EXACT}, cameras);
        m = compare(runner.bits(), reference);
        print("6.14", scene, "exact", label, percent(m.overestimation), percent(m.coverage));
      }
  }

  /// A viewer who walks: half a metre to each side, and up and down. The reference: side x side view points, 16 x 16
  /// samples. What a method claims beyond is not sampled again, so it counts as too much even where it is seen from
  /// between those view points, or between those samples.
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
    host::Buffer whole = runner.makeBits();
    const std::vector<GpgpCamera> all = take(square(options.largestCell >= 32 ? 17 : 5));
    const auto start = std::chrono::steady_clock::now();
    runner.reference(16, all, whole, nullptr, [&](size_t n) {
      const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      if (n % 17 == 0 || n == all.size()) print("cellreference", scene, "view points", std::to_string(n), seconds, 0);
    });
    const Runner::Run one = runner.measure(exact, {.method = GPGP_SAMPLING_EXACT}, options.repeat);
    host::Buffer again = runner.makeBits();
    const auto row = [&](const char* series, const std::string& label, double milliseconds, const Runner::Run& run,
                         std::span<const GpgpCamera> claiming) {
      GpgpVisibilityReport m = runner.metrics(standard, runner.bits(), whole, nullptr, nullptr);
      print("cell", scene, series, label, percent(m.overestimation), percent(m.coverage));
      Sampling whence{.method = GPGP_SAMPLING_EXACT};
      for (const GpgpCamera& camera : claiming) {
        runner.record(exact, whence, {&camera, 1}, again);
        whence.accumulate = true;
      }
      m = runner.metrics(standard, runner.bits(), whole, nullptr, &again);
      print("cellagain", scene, series, label, percent(m.overestimation), percent(m.coverage));
      print("cellcost", scene, series, label, milliseconds, milliseconds / one.milliseconds);
      print("cellpairs", scene, series, label, double(run.report.neededPairs),
            double(run.report.neededPairs) / one.report.neededPairs);
      if (run.report.unresolved) print("cellbudget", scene, series, label, double(run.report.unresolved), 0);
    };
    // Whole views: the middle; corners; those, the sides and the middle.
    const std::vector<GpgpCamera> nine = take(square(3));
    for (const std::vector<size_t>& which : {std::vector<size_t>{0}, {1, 3, 6, 8}, {1, 8, 3, 6, 0, 2, 7, 4, 5}}) {
      std::vector<GpgpCamera> cameras;
      for (const size_t i : which) cameras.push_back(nine[i]);
      const Runner::Run run = runner.measureUnion(exact, {.method = GPGP_SAMPLING_EXACT}, cameras, 1, options.repeat);
      row("exact", std::to_string(cameras.size()), run.milliseconds, run, cameras);
    }
    // Many small views: those of gpgpGetViewCellCameras; and in rows on the reference's own grid, in every other row
    // moved by half a step.
    const auto rows = [](uint32_t count) {
      std::vector<float> points;
      for (uint32_t y = 0; y < count; ++y)
        for (uint32_t x = y % 2; x < 17; x += 2)
          points.insert(points.end(), {static_cast<float>(x) / 16 - 0.5f,
                                       static_cast<float>(y) / static_cast<float>(count - 1) - 0.5f, 0});
      return points;
    };
    GpgpViewCellInfo walk = GPGP_VIEW_CELL_INFO_INIT;
    walk.camera = runner.camera();
    walk.walkDistance = 0.5f;
    std::vector<GpgpCamera> corners = take({-0.5f, -0.5f, 0, 0.5f, -0.5f, 0, -0.5f, 0.5f, 0, 0.5f, 0.5f, 0});
    corners.erase(corners.begin());
    const auto spread = [&](uint32_t count) {
      walk.walkCount = count;
      return camerasOf(walk);
    };
    const bool few = options.largestCell < 32;
    using Views = std::vector<SmallViews>;
    const Views usual =
        few ? Views{{4, 16}} : Views{{4, 16}, {6, 24}, {8, 32}, {8, 80, 0.06f}, {8, 80, 0.06f, 1u << 22}};
    for (const SmallViews& views : options.views.empty() ? usual : options.views)
      smallViews(corners, views, spread, "", row);
    if (!options.views.empty()) return;
    for (const uint32_t count : few ? std::vector{3u} : std::vector{5u, 9u})
      smallViews(
          corners, {4, UINT32_MAX}, [&](uint32_t) { return take(rows(count)); }, " on grid", row);
  }

  /// Views with a part of the width and height, of what may be seen from the cell: no place in it is farther from a
  /// corner than the reach. The first of the cameras for a number of views, the middle, is left out.
  template <class Cameras, class Row>
  void smallViews(const std::vector<GpgpCamera>& corners, const SmallViews& which, const Cameras& cameras,
                  const char* kind, const Row& row) {
    const uint32_t room = std::min(runner.triangles(), 1u << 18);
    const DrawLists lists = runner.makeLists(room);
    constexpr uint32_t kNearbyDivisor = 4;
    const float reach = std::sqrt(0.5f);
    VisibilityRecorder nearby = runner.recorder(GPGP_SAMPLING_NEARBY_BIT, 1, 4, kNearbyDivisor);
    const Runner::Run first = runner.measure(
        nearby, {.method = GPGP_SAMPLING_NEARBY, .divisor = kNearbyDivisor, .reach = reach, .listed = &lists},
        options.repeat, corners);
    const uint32_t listed = std::max(first.report.neededDrawTriangles, 1u);
    const std::vector<GpgpCamera> views =
        cameras(which.most ? std::clamp(which.most / listed, 1u, which.count) : which.count);
    std::vector<GpgpCamera> spread; // neighbours in different records, so that the first ones find most
    for (size_t k = 1; k < 6; ++k)
      for (size_t i = k; i < views.size(); i += 5) spread.push_back(views[i]);
    const uint32_t perRecord = std::min(runner.camerasPerRecord(which.divisor), static_cast<uint32_t>(spread.size()));
    VisibilityRecorder small = runner.recorder(GPGP_SAMPLING_EXACT_BIT, 1, perRecord, which.divisor, room);
    const Runner::Run run = runner.measureUnion(
        small, {.method = GPGP_SAMPLING_EXACT, .divisor = which.divisor, .reach = which.reach, .lists = &lists}, spread,
        perRecord, options.repeat);
    const std::string series = "exact at 1/" + std::to_string(which.divisor) + kind +
                               (which.reach > 0 ? " with a reach of " + text(double(which.reach)) : "") +
                               (which.most ? " of " + std::to_string(which.most) + " triangles" : ""),
                      label = std::to_string(spread.size());
    print("cellnearby", scene, series.c_str(), label, first.report.neededDrawTriangles, first.milliseconds);
    row(series.c_str(), label, first.milliseconds + run.milliseconds, run, spread);
    if (!options.passes) return;
    for (const auto& [pass, time] : first.passes)
      if (time > 0.01) print("cellpass", scene, "nearby", pass, time, 0);
    for (const auto& [pass, time] : run.passes)
      if (time > 0.01) print("cellpass", scene, series.c_str(), pass, time, 0);
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
