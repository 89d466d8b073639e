#include "spawn/graph/export_layout.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace gpgp::spawn {
namespace {
constexpr uint32_t kNone = UINT32_MAX;
constexpr double kLaneWidth = 6, kSpace = 14;
constexpr int kOrderSweeps = 12, kPlaceSweeps = 24;
constexpr size_t kMostOrdered = 10000; // boxes and lanes; more stay in the order in which they come

/// What stands in a layer: a box, or a lane where an edge passes.
struct Item {
  uint32_t box = kNone;
  double width = kLaneWidth, x = 0;
  size_t place = 0; // in its layer
};
/// Between items of neighbouring layers.
struct Tie {
  uint32_t upper = 0, lower = 0;
  double upperOffset = 0, lowerOffset = 0, weight = 1;
};

class Layers {
public:
  explicit Layers(Layout& layout) : layout_(layout) {
    assignLayers();
    makeItems();
    order();
    place();
    write();
  }

private:
  void assignLayers() {
    layerOf_.assign(layout_.boxes.size(), 0);
    std::vector<std::vector<uint32_t>> targets(layout_.boxes.size());
    for (const LayoutEdge& e : layout_.edges)
      if (e.to > e.from) targets[e.from].push_back(e.to);
    uint32_t deepest = 0;
    for (uint32_t b = 0; b < layout_.boxes.size(); ++b) {
      if (!layout_.boxes[b].isLast) deepest = std::max(deepest, layerOf_[b]);
      for (const uint32_t t : targets[b]) layerOf_[t] = std::max(layerOf_[t], layerOf_[b] + 1);
    }
    uint32_t count = deepest + 1;
    for (uint32_t b = 0; b < layout_.boxes.size(); ++b)
      if (layout_.boxes[b].isLast) layerOf_[b] = count;
    for (const uint32_t layer : layerOf_) count = std::max(count, layer + 1);
    layers_.resize(count);
    for (LayoutEdge& e : layout_.edges) e.isBack = layerOf_[e.to] <= layerOf_[e.from];
  }

  uint32_t add(uint32_t layer, Item item) {
    item.place = layers_[layer].size();
    layers_[layer].push_back(static_cast<uint32_t>(items_.size()));
    items_.push_back(item);
    return static_cast<uint32_t>(items_.size() - 1);
  }

  void makeItems() {
    for (uint32_t b = 0; b < layout_.boxes.size(); ++b) add(layerOf_[b], {b, layout_.boxes[b].width});
    lanes_.resize(layout_.edges.size()); // box b is item b
    for (size_t i = 0; i < layout_.edges.size(); ++i) {
      const LayoutEdge& e = layout_.edges[i];
      const uint32_t first = e.isBack ? layerOf_[e.to] : layerOf_[e.from] + 1;
      const uint32_t end = e.isBack ? layerOf_[e.from] + 1 : layerOf_[e.to];
      for (uint32_t layer = first; layer < end; ++layer) lanes_[i].push_back(add(layer, {}));
      for (size_t l = 1; l < lanes_[i].size(); ++l) ties_.push_back({lanes_[i][l - 1], lanes_[i][l], 0, 0, 8});
      if (e.isBack) continue;
      if (lanes_[i].empty()) {
        ties_.push_back({e.from, e.to, e.fromOffset, e.toOffset});
      } else {
        ties_.push_back({e.from, lanes_[i].front(), e.fromOffset, 0, 2});
        ties_.push_back({lanes_[i].back(), e.to, 0, e.toOffset, 2});
      }
    }
    above_.resize(items_.size());
    below_.resize(items_.size());
    layerOfItem_.resize(items_.size());
    for (uint32_t t = 0; t < ties_.size(); ++t) {
      below_[ties_[t].upper].push_back(t);
      above_[ties_[t].lower].push_back(t);
    }
    for (uint32_t layer = 0; layer < layers_.size(); ++layer)
      for (const uint32_t item : layers_[layer]) layerOfItem_[item] = layer;
    tiesBelow_.resize(layers_.size());
    for (uint32_t t = 0; t < ties_.size(); ++t) tiesBelow_[layerOfItem_[ties_[t].upper]].push_back(t);
  }

  // Where an end of a tie is, as far as order goes: offsets tell apart the edges of one box.
  double orderAt(uint32_t item, double offset) const {
    return static_cast<double>(items_[item].place) + offset / (items_[item].width + 1);
  }

  size_t crossings() const {
    size_t count = 0;
    for (const auto& ties : tiesBelow_)
      for (size_t i = 0; i < ties.size(); ++i)
        for (size_t j = 0; j < i; ++j) {
          const Tie &a = ties_[ties[i]], &b = ties_[ties[j]];
          count += (orderAt(a.upper, a.upperOffset) - orderAt(b.upper, b.upperOffset)) *
                       (orderAt(a.lower, a.lowerOffset) - orderAt(b.lower, b.lowerOffset)) <
                   0;
        }
    return count;
  }

  void orderLayer(std::vector<uint32_t>& layer, bool down) {
    std::vector<std::pair<double, uint32_t>> keys;
    for (const uint32_t item : layer) {
      const auto& ties = down ? above_[item] : below_[item];
      double sum = 0;
      for (const uint32_t t : ties)
        sum += down ? orderAt(ties_[t].upper, ties_[t].upperOffset) : orderAt(ties_[t].lower, ties_[t].lowerOffset);
      keys.emplace_back(ties.empty() ? static_cast<double>(items_[item].place) : sum / static_cast<double>(ties.size()),
                        item);
    }
    std::stable_sort(keys.begin(), keys.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (size_t i = 0; i < layer.size(); ++i) {
      layer[i] = keys[i].second;
      items_[layer[i]].place = i;
    }
  }

  void order() {
    if (items_.size() > kMostOrdered) return;
    auto best = layers_;
    size_t fewest = crossings();
    for (int sweep = 0; sweep < kOrderSweeps && fewest; ++sweep) {
      const bool down = sweep % 2 == 0;
      for (size_t l = 0; l < layers_.size(); ++l) orderLayer(layers_[down ? l : layers_.size() - 1 - l], down);
      const size_t count = crossings();
      if (count >= fewest) continue;
      fewest = count;
      best = layers_;
    }
    layers_ = best;
    for (const auto& layer : layers_)
      for (size_t i = 0; i < layer.size(); ++i) items_[layer[i]].place = i;
  }

  /// The places nearest to those wanted (least squares) that keep order and distances: isotonic regression by pooling.
  void placeLayer(const std::vector<uint32_t>& layer, bool down) {
    struct Pool {
      double sum, weight;
      size_t count;
    };
    std::vector<Pool> pools;
    std::vector<double> start(layer.size(), 0);
    for (size_t i = 0; i < layer.size(); ++i) {
      const Item& item = items_[layer[i]];
      if (i) start[i] = start[i - 1] + (items_[layer[i - 1]].width + item.width) / 2 + kSpace;
      double sum = item.x * 0.1, weight = 0.1;
      for (const uint32_t t : down ? above_[layer[i]] : below_[layer[i]]) {
        const Tie& tie = ties_[t];
        const double wanted = down ? items_[tie.upper].x + tie.upperOffset - tie.lowerOffset
                                   : items_[tie.lower].x + tie.lowerOffset - tie.upperOffset;
        sum += tie.weight * wanted;
        weight += tie.weight;
      }
      pools.push_back({sum - start[i] * weight, weight, 1});
      while (pools.size() > 1 &&
             pools.end()[-2].sum / pools.end()[-2].weight > pools.back().sum / pools.back().weight) {
        const Pool last = pools.back();
        pools.pop_back();
        pools.back() = {pools.back().sum + last.sum, pools.back().weight + last.weight,
                        pools.back().count + last.count};
      }
    }
    size_t i = 0;
    for (const Pool& pool : pools)
      for (size_t k = 0; k < pool.count; ++k, ++i) items_[layer[i]].x = start[i] + pool.sum / pool.weight;
  }

  void place() {
    for (int sweep = 0; sweep <= kPlaceSweeps; ++sweep) { // ends downwards
      const bool down = sweep % 2 == 0;
      for (size_t l = 0; l < layers_.size(); ++l) placeLayer(layers_[down ? l : layers_.size() - 1 - l], down);
    }
  }

  void write() {
    double left = std::numeric_limits<double>::max(), right = std::numeric_limits<double>::lowest();
    for (const Item& item : items_) {
      left = std::min(left, item.x - item.width / 2);
      right = std::max(right, item.x + item.width / 2);
    }
    if (items_.empty()) left = right = 0;
    std::vector<double> top(layers_.size() + 1, 0), bottom(layers_.size(), 0);
    for (size_t l = 0; l < layers_.size(); ++l) {
      double height = 0;
      for (const uint32_t i : layers_[l])
        if (items_[i].box != kNone) height = std::max(height, layout_.boxes[items_[i].box].height);
      bottom[l] = top[l] + height;
      top[l + 1] = bottom[l] + layout_.gap;
    }
    for (uint32_t b = 0; b < layout_.boxes.size(); ++b) {
      layout_.boxes[b].x = items_[b].x - left;
      layout_.boxes[b].top = top[layerOf_[b]];
      layout_.boxes[b].layerBottom = bottom[layerOf_[b]];
    }
    for (size_t i = 0; i < layout_.edges.size(); ++i) {
      LayoutEdge& edge = layout_.edges[i];
      edge.lanes.clear();
      for (const uint32_t item : lanes_[i])
        edge.lanes.push_back({items_[item].x - left, top[layerOfItem_[item]], bottom[layerOfItem_[item]]});
      if (edge.isBack) std::reverse(edge.lanes.begin(), edge.lanes.end());
    }
    layout_.width = right - left;
    layout_.height = bottom.empty() ? 0 : bottom.back();
  }

  Layout& layout_;
  std::vector<uint32_t> layerOf_; // by box
  std::vector<Item> items_;
  std::vector<std::vector<uint32_t>> layers_, lanes_, above_, below_, tiesBelow_;
  std::vector<uint32_t> layerOfItem_;
  std::vector<Tie> ties_;
};
} // namespace

void Layout::run() { Layers{*this}; }

} // namespace gpgp::spawn
