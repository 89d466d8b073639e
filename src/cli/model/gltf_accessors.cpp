#include "cli/model/gltf_accessors.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace gpgp::cli {
namespace {

[[noreturn]] void fail(const std::string& what) { throw std::runtime_error(what); }

/// Where an accessor's elements lie, and how many bytes each is behind the one before it.
struct Elements {
  const unsigned char* first = nullptr;
  size_t step = 0;
};

/// `count` elements of `size` bytes from `offset` on, all of them within their buffer view and its buffer.
Elements elementsOf(const tinygltf::Model& gltf, int index, size_t offset, size_t count, size_t size) {
  const std::string name = "buffer view " + std::to_string(index);
  if (index < 0 || static_cast<size_t>(index) >= gltf.bufferViews.size())
    fail("there is no " + name + ", which an accessor names");
  const tinygltf::BufferView& view = gltf.bufferViews[static_cast<size_t>(index)];
  if (view.buffer < 0 || static_cast<size_t>(view.buffer) >= gltf.buffers.size()) fail(name + " names no buffer");
  const std::vector<unsigned char>& bytes = gltf.buffers[static_cast<size_t>(view.buffer)].data;
  if (bytes.empty())
    for (const auto& [extension, ignored] : view.extensions)
      if (extension.find("meshopt_compression") != std::string::npos)
        fail(name + " is compressed by " + extension + ", which is not supported; save it without compression");
  if (view.byteOffset > bytes.size() || view.byteLength > bytes.size() - view.byteOffset)
    fail(name + " reaches beyond its buffer");
  const size_t step = view.byteStride ? view.byteStride : size;
  if (offset > view.byteLength ||
      (count && (size > view.byteLength - offset || count - 1 > (view.byteLength - offset - size) / step)))
    fail("an accessor reaches beyond " + name);
  return {bytes.data() + view.byteOffset + offset, step};
}

/// A component as what it stands for: normalized integers are -1 to 1 or 0 to 1.
double numberAt(const unsigned char* bytes, int type, bool normalized) {
  const auto read = [&](auto value) -> double {
    std::memcpy(&value, bytes, sizeof value);
    using Value = decltype(value);
    if (!normalized || !std::is_integral_v<Value>) return static_cast<double>(value);
    return std::max(static_cast<double>(value) / static_cast<double>(std::numeric_limits<Value>::max()), -1.0);
  };
  switch (type) {
  case TINYGLTF_COMPONENT_TYPE_BYTE: return read(int8_t{});
  case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return read(uint8_t{});
  case TINYGLTF_COMPONENT_TYPE_SHORT: return read(int16_t{});
  case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return read(uint16_t{});
  case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return read(uint32_t{});
  case TINYGLTF_COMPONENT_TYPE_FLOAT: return read(float{});
  default: fail("an accessor has an unknown type");
  }
}

} // namespace

const tinygltf::Accessor& accessorOf(const tinygltf::Model& gltf, int index) {
  if (index < 0 || static_cast<size_t>(index) >= gltf.accessors.size())
    fail("a primitive names accessor " + std::to_string(index) + "; there are " +
         std::to_string(gltf.accessors.size()));
  return gltf.accessors[static_cast<size_t>(index)];
}

std::vector<double> numbersOf(const tinygltf::Model& gltf, const tinygltf::Accessor& accessor) {
  const auto components = static_cast<size_t>(tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor.type)));
  const auto bytesOf = [](int type) {
    return static_cast<size_t>(std::max(tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(type)), 1));
  };
  const size_t each = bytesOf(accessor.componentType), size = each * components;
  std::vector<double> numbers;
  const auto copy = [&](const Elements& from, size_t i, size_t to) {
    for (size_t c = 0; c < components; ++c)
      numbers[to * components + c] =
          numberAt(from.first + i * from.step + c * each, accessor.componentType, accessor.normalized);
  };
  if (accessor.bufferView >= 0) {
    const Elements from = elementsOf(gltf, accessor.bufferView, accessor.byteOffset, accessor.count, size);
    numbers.resize(accessor.count * components);
    for (size_t i = 0; i < accessor.count; ++i) copy(from, i, i);
  } else { // all of them 0 (3.6.2.3): no bytes bound their number
    if (accessor.count > kMostVertices) fail("an accessor without buffer view has more elements than a buffer holds");
    numbers.resize(accessor.count * components);
  }
  if (!accessor.sparse.isSparse) return numbers;
  const auto& indices = accessor.sparse.indices;
  const auto& values = accessor.sparse.values;
  if (accessor.sparse.count < 0 || indices.byteOffset < 0 || values.byteOffset < 0)
    fail("a sparse accessor has a negative number");
  const auto replaced = static_cast<size_t>(accessor.sparse.count);
  const Elements places = elementsOf(gltf, indices.bufferView, static_cast<size_t>(indices.byteOffset), replaced,
                                     bytesOf(indices.componentType));
  const Elements from = elementsOf(gltf, values.bufferView, static_cast<size_t>(values.byteOffset), replaced, size);
  for (size_t i = 0; i < replaced; ++i) {
    const double place = numberAt(places.first + i * places.step, indices.componentType, false);
    if (!(place >= 0 && place < static_cast<double>(accessor.count))) fail("a sparse accessor's index is out of range");
    copy(from, i, static_cast<size_t>(place));
  }
  return numbers;
}

} // namespace gpgp::cli
