// Memory for the stages that convert a path, which hand large tables to each other. A table that a stage is done with
// serves the next one, so that the system clears fewer pages.
#pragma once
#include <cstddef>
#include <memory_resource>
#include <vector>

namespace gpgp::vector {

/// Small blocks lie behind each other and go with the resource. Large ones that were given back are handed out again;
/// the heap gets them at the end.
class Scratch : public std::pmr::memory_resource {
public:
  explicit Scratch(std::pmr::memory_resource* heap)
      : heap_(heap), small_(nearby_, sizeof nearby_, heap), large_(heap) {}
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  ~Scratch() override {
    for (const Block& block : large_) heap_->deallocate(block.data, block.size);
  }

private:
  struct Block {
    void* data;
    size_t size;
    bool used;
  };
  static constexpr size_t kLarge = 1 << 20;

  void* do_allocate(size_t bytes, size_t alignment) override {
    if (bytes < kLarge || alignment > alignof(std::max_align_t)) return small_.allocate(bytes, alignment);
    Block* best = nullptr; // the smallest that is large enough
    for (Block& block : large_)
      if (!block.used && block.size >= bytes && (!best || block.size < best->size)) best = &block;
    if (!best) {
      best = &large_.emplace_back(Block{nullptr, 0, false});
      best->data = heap_->allocate(bytes);
      best->size = bytes;
    }
    best->used = true;
    return best->data;
  }
  void do_deallocate(void* data, size_t bytes, size_t alignment) override {
    if (bytes < kLarge || alignment > alignof(std::max_align_t)) return; // goes with small_
    for (Block& block : large_)
      if (block.data == data) block.used = false;
  }
  bool do_is_equal(const std::pmr::memory_resource& other) const noexcept override { return this == &other; }

  std::pmr::memory_resource* heap_;
  alignas(std::max_align_t) std::byte nearby_[32 << 10];
  std::pmr::monotonic_buffer_resource small_;
  std::pmr::vector<Block> large_;
};

} // namespace gpgp::vector
