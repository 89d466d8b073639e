#include "frame.h"

namespace gpgp::rmlui {

bool same(const TransformPointer& a, const TransformPointer& b) { return a == b || (a && b && *a == *b); }

void CallRecorder::begin() {
  layers_.assign(1, std::make_shared<std::vector<Operation>>());
  state_ = {};
  clip_.reset();
}

void CallRecorder::setTransform(const Transform* transform) {
  if (!transform || *transform == Transform{})
    state_.transform.reset();
  else if (!state_.transform || *state_.transform != *transform)
    state_.transform = std::make_shared<const Transform>(*transform);
}

void CallRecorder::enableClip(bool enable) { state_.clip = enable ? clip_ : nullptr; }

void CallRecorder::clip(ClipOperation operation, GeometryPointer geometry, float x, float y) {
  auto steps = std::make_shared<std::vector<ClipStep>>();
  if (operation == ClipOperation::intersect && clip_) *steps = *clip_;
  steps->push_back({operation, std::move(geometry), x, y, state_.transform});
  clip_ = std::move(steps);
  state_.clip = clip_;
}

void CallRecorder::draw(GeometryPointer geometry, float x, float y, PaintPointer paint) {
  Operation& operation = layers_.back()->emplace_back();
  operation.state = state_;
  operation.geometry = std::move(geometry);
  operation.x = x;
  operation.y = y;
  operation.paint = std::move(paint);
}

size_t CallRecorder::pushLayer() {
  layers_.push_back(std::make_shared<std::vector<Operation>>());
  return layers_.size() - 1;
}

bool CallRecorder::composite(size_t source, size_t destination, bool replace, std::vector<FilterPointer> filters) {
  if (source >= layers_.size() || destination >= layers_.size()) return false;
  Operation operation;
  operation.state = state_;
  operation.state.transform.reset();
  operation.source = contents(source);
  operation.filters = std::move(filters);
  if (replace) { // what was there stays outside of the scissor
    const Contents before = contents(destination);
    layers_[destination] = std::make_shared<std::vector<Operation>>();
    if (state_.scissor) {
      Operation& kept = layers_[destination]->emplace_back();
      kept.source = before;
      kept.state.clip = std::make_shared<const std::vector<ClipStep>>(
          1, ClipStep{ClipOperation::setInverse, boxGeometry(*state_.scissor), 0, 0, nullptr});
    }
  }
  layers_[destination]->push_back(std::move(operation));
  return !replace || !state_.clip;
}

bool CallRecorder::popLayer() {
  if (layers_.size() < 2) return false;
  layers_.pop_back();
  return true;
}

Contents CallRecorder::top() const {
  const Contents all = contents(layers_.size() - 1);
  if (!state_.scissor) return all;
  Operation cut;
  cut.state.scissor = state_.scissor;
  cut.source = all;
  return {std::make_shared<const std::vector<Operation>>(1, std::move(cut)), 1};
}

} // namespace gpgp::rmlui
