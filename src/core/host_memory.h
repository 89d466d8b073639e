// Host memory of a context: the engine's allocation callbacks as a std::pmr::memory_resource.
//
// Everything the run-time library allocates goes through one of these; a failed allocation throws std::bad_alloc,
// which the C API turns into GPGP_ERROR_OUT_OF_HOST_MEMORY. Counts bytes for the memory report.
#pragma once
#include <gpgp/core.h>

#include <atomic>
#include <memory>
#include <memory_resource>
#include <new>

namespace gpgp::core {

class HostMemory final : public std::pmr::memory_resource {
public:
  /// nullptr: the C++ heap.
  explicit HostMemory(const GpgpHostAllocator* callbacks) {
    if (callbacks) callbacks_ = *callbacks;
  }
  uint64_t bytes() const { return bytes_.load(std::memory_order_relaxed); }
  const GpgpHostAllocator& callbacks() const { return callbacks_; }

private:
  void* do_allocate(size_t size, size_t alignment) override {
    void* memory = callbacks_.allocate ? callbacks_.allocate(callbacks_.userData, size, alignment)
                                       : ::operator new(size, std::align_val_t(alignment), std::nothrow);
    if (!memory) throw std::bad_alloc();
    bytes_.fetch_add(size, std::memory_order_relaxed);
    return memory;
  }
  void do_deallocate(void* memory, size_t size, size_t alignment) override {
    bytes_.fetch_sub(size, std::memory_order_relaxed);
    if (callbacks_.allocate)
      callbacks_.free(callbacks_.userData, memory, size, alignment);
    else
      ::operator delete(memory, std::align_val_t(alignment));
  }
  bool do_is_equal(const memory_resource& other) const noexcept override { return this == &other; }

  GpgpHostAllocator callbacks_{};
  std::atomic<uint64_t> bytes_{0};
};

/// Deletes an object that was made with makeUnique from the resource it came from.
struct PmrDelete {
  std::pmr::memory_resource* memory = nullptr;
  size_t size = 0, alignment = 0;
  template <class T> void operator()(T* object) const {
    void* start = dynamic_cast<void*>(object);
    object->~T();
    memory->deallocate(start, size, alignment);
  }
};
template <class T> using Unique = std::unique_ptr<T, PmrDelete>;

/// new T(args...) from a memory resource; T is polymorphic. Throws what the constructor throws, leaking nothing.
template <class T, class... Args> Unique<T> makeUnique(std::pmr::memory_resource& memory, Args&&... args) {
  void* storage = memory.allocate(sizeof(T), alignof(T));
  try {
    return Unique<T>(new (storage) T(std::forward<Args>(args)...), PmrDelete{&memory, sizeof(T), alignof(T)});
  } catch (...) {
    memory.deallocate(storage, sizeof(T), alignof(T));
    throw;
  }
}

/// The same with the pointer to a base class.
template <class Base, class T> Unique<Base> upcast(Unique<T> object) {
  const PmrDelete deleter = object.get_deleter();
  return Unique<Base>(object.release(), deleter);
}

} // namespace gpgp::core
