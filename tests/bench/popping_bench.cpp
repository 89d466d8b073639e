// What levels of detail look like: walks through the sample wood and town, drawn by the finest level, by levels that
// fade, by levels that do not, and by the detail of a budget. Prints a table in Markdown.
#include "arguments.h"
#include "spawn/walk_scene.h"

#include <optional>

namespace {
using namespace gpgp::test;

const char* const kUsage = R"(usage: popping_bench [options]

  --frames N     of each walk, default 600

A table: instances, and in pixels what levels of detail change of the finest one's picture.
)";

struct Level {
  const char* name;
  std::vector<GpgpVariable> variables;
  uint32_t budget;
};

void show(const Place& place, uint32_t frames) {
  const Level levels[] = {
      {"hard", {{"band", 1.0001f}}, 0}, {"fading", {}, 0}, {"fading, by a budget", {}, place.budget}};
  WalkScene finest(place.file, {{"pixels", 0}}, place.axioms);
  struct Shown {
    std::optional<WalkScene> scene;
    Walk walk;
    GpgpDetail detail{};
    int outlines = 0;
    double differs = 0, most = 0;
    uint32_t exceeded = 0;
    uint64_t fullest = 0;
  } shown[3];
  for (size_t i = 0; i < 3; ++i) {
    shown[i].scene.emplace(place.file, levels[i].variables, place.axioms);
    shown[i].detail.detail = 1;
  }
  Picture before;
  uint64_t fullest = 0;
  int moved = 0;
  for (uint32_t frame = 0; frame < frames; ++frame) {
    const Eye eye = place.walk(static_cast<float>(frame) / static_cast<float>(frames));
    Picture now = finest.from(eye);
    fullest = std::max(fullest, finest.last);
    const std::vector<int> base = frame ? changed(before, now) : std::vector<int>();
    for (const int tile : base) moved = std::max(moved, tile);
    for (size_t i = 0; i < 3; ++i) {
      Shown& s = shown[i];
      const float detail = s.detail.detail;
      s.walk.add(s.scene->from(eye, detail), base);
      s.fullest = std::max(s.fullest, s.scene->last);
      const std::vector<int> tiles = changed(s.walk.before, now);
      double sum = 0;
      for (const int tile : tiles) sum += tile;
      s.differs += sum / (kWidth * kHeight) / frames;
      s.most = std::max(s.most, sum / (kWidth * kHeight));
      if (frame % 20 == 0)
        s.outlines = std::max({s.outlines, farthest(s.walk.before, now, true), farthest(now, s.walk.before, true)});
      if (!levels[i].budget) continue;
      GpgpDetailBudget budget = GPGP_DETAIL_BUDGET_INIT;
      budget.instances = levels[i].budget;
      GpgpSpawnReport report = GPGP_SPAWN_REPORT_INIT;
      report.detail = detail;
      report.terminals = static_cast<uint32_t>(s.scene->last);
      s.exceeded += report.terminals > budget.instances;
      if (gpgpAdaptDetail(&budget, &report, 0, &s.detail) < 0) throw std::runtime_error("gpgpAdaptDetail");
    }
    before = std::move(now);
  }
  std::printf("| %s | finest | %.0f | %llu | | | | %d | |\n", place.name,
              static_cast<double>(finest.instances) / frames, static_cast<unsigned long long>(fullest), moved);
  for (size_t i = 0; i < 3; ++i) {
    const Shown& s = shown[i];
    std::string name = levels[i].name;
    if (levels[i].budget)
      name += " of " + std::to_string(levels[i].budget) + " (exceeded in " + std::to_string(s.exceeded) + " frames)";
    std::printf("| | %s | %.0f | %llu | %d | %.1f %% | %.1f %% | +%d | %llu |\n", name.c_str(),
                static_cast<double>(s.scene->instances) / frames, static_cast<unsigned long long>(s.fullest),
                s.outlines, 100 * s.differs, 100 * s.most, s.walk.worstTile,
                static_cast<unsigned long long>(s.walk.tilesThatPop));
  }
}

int run(gpgp::bench::Arguments arguments) {
  uint32_t frames = 600;
  while (arguments.next()) {
    if (arguments.word() != "--frames") throw gpgp::bench::Usage("'" + arguments.word() + "' is no option");
    frames = arguments.number();
  }
  std::puts(
      "| | level | instances, mean | most | outlines, px | picture, mean | worst | worst tile, px | tiles that pop |"
      "\n|---|---|---|---|---|---|---|---|---|");
  for (const Place& place : walkPlaces(GPGP_WORLD)) show(place, frames);
  return 0;
}

} // namespace

int main(int argc, char** argv) { return gpgp::bench::benchMain(argc, argv, kUsage, run); }
