// Arrays, and what the machine leaves to the deriver where values are not two numbers.
#include "spawn/cga/deriver.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace gpgp::spawn::cga {

namespace {
constexpr size_t kMostValues = 4'000'000; // of one array
constexpr size_t kMostInAll = 32'000'000; // of all arrays that an axiom makes
constexpr size_t kMostBytes = 256u << 20; // of all strings that an axiom makes
} // namespace

CgaValue Deriver::array(ArrayValue value) {
  arrayValues_ += value.values.size() + 8;
  if (arrayValues_ > kMostInAll) {
    fail("the arrays of an axiom have more than 32000000 values");
    return floatValue(0);
  }
  arrays_.push_back(std::move(value));
  return cgaMake(kCgaArray, static_cast<uint32_t>(arrays_.size() - 1));
}

const Deriver::ArrayValue& Deriver::arrayOf(const CgaValue& v) {
  static const ArrayValue none;
  return v.type == kCgaArray && v.bits < arrays_.size() ? arrays_[v.bits] : none;
}

/// Values in brackets; where these are arrays themselves, these are its rows.
CgaValue Deriver::cgaArray(uint32_t first, uint32_t count) {
  ArrayValue result;
  for (uint32_t i = 0; i < count; ++i) {
    const CgaValue v = stack_[first + i];
    if (v.type != kCgaArray) {
      result.values.push_back(v);
      continue;
    }
    const ArrayValue row = arrayOf(v);
    if (i == 0) result.columns = std::max<uint32_t>(1, static_cast<uint32_t>(row.values.size()));
    result.values.insert(result.values.end(), row.values.begin(), row.values.end());
    if (result.values.size() > kMostValues) {
      fail("an array has more than 4000000 values");
      break;
    }
  }
  return array(std::move(result));
}

/// A range is an array of first and last, which columns 0 tell from others.
CgaValue Deriver::cgaRange(const CgaValue& a, const CgaValue& b) {
  ArrayValue range;
  range.columns = 0;
  range.values = {a, b};
  return array(std::move(range));
}

CgaValue Deriver::cgaIndex(uint32_t first, uint32_t count) {
  if (stack_[first].type != kCgaArray) {
    warn("index", "[ ] follows something that is not an array");
    return stack_[first];
  }
  const ArrayValue from = arrayOf(stack_[first]);
  // Which rows, or of a table rows and columns.
  const auto chosen = [&](const CgaValue& v, uint32_t size, bool& single) {
    std::vector<uint32_t> result;
    single = false;
    const float whole = static_cast<float>(size);
    const auto take = [&](float at) {
      at = std::floor(at);
      if (at < 0) at += whole;
      if (at >= 0 && at < whole)
        result.push_back(static_cast<uint32_t>(at));
      else
        warn("index range", "an index is outside of its array, " + std::to_string(size) + " values");
    };
    if (v.type != kCgaArray) {
      single = true;
      take(number(v));
      return result;
    }
    const ArrayValue which = arrayOf(v);
    if (which.columns == 0) {
      float begin = which.values[0].type == kCgaNothing ? 0 : std::floor(number(which.values[0]));
      float end = which.values[1].type == kCgaNothing ? whole - 1 : std::floor(number(which.values[1]));
      if (begin < 0) begin += whole;
      if (end < 0) end += whole;
      begin = std::max(begin, 0.0f);
      for (float at = begin; at <= end && at < whole; at += 1) result.push_back(static_cast<uint32_t>(at));
      return result;
    }
    if (!which.values.empty() && which.values[0].type == kCgaBool) {
      for (uint32_t i = 0; i < which.values.size() && i < size; ++i)
        if (which.values[i].bits) result.push_back(i);
      return result;
    }
    for (const CgaValue& at : which.values) take(number(at));
    return result;
  };
  ArrayValue result;
  bool oneRow = false, oneColumn = true;
  if (count == 1) {
    const uint32_t size = static_cast<uint32_t>(from.values.size());
    for (const uint32_t i : chosen(stack_[first + 1], size, oneRow)) result.values.push_back(from.values[i]);
  } else {
    const std::vector<uint32_t> rows = chosen(stack_[first + 1], from.rows(), oneRow);
    const std::vector<uint32_t> columns = chosen(stack_[first + 2], from.columns, oneColumn);
    for (const uint32_t row : rows)
      for (const uint32_t column : columns) result.values.push_back(from.values[row * from.columns + column]);
    result.columns = std::max<uint32_t>(1, static_cast<uint32_t>(columns.size()));
  }
  if (oneRow && oneColumn) return result.values.empty() ? floatValue(0) : result.values[0];
  return array(std::move(result));
}

CgaValue Deriver::cgaAddOther(const CgaValue& a, const CgaValue& b) {
  if (a.type == kCgaString || b.type == kCgaString) {
    std::string sum = text(a);
    sum += text(b);
    if (sum.size() > (1u << 20) || strings_.bytes() > kMostBytes) {
      fail("a string is longer than 1 MiB, or all strings of an axiom than 256 MiB");
      return stringValue({});
    }
    return stringValue(sum);
  }
  if (a.type == kCgaArray && b.type == kCgaArray) {
    ArrayValue joined = arrayOf(a);
    const ArrayValue& other = arrayOf(b);
    if (joined.values.size() + other.values.size() > kMostValues) {
      fail("an array has more than 4000000 values");
      return a;
    }
    joined.values.insert(joined.values.end(), other.values.begin(), other.values.end());
    return array(std::move(joined));
  }
  if (a.type == kCgaArray || b.type == kCgaArray)
    warn("array sum", "'+' joins an array with something that is not an array");
  return floatValue(add(number(a), number(b)));
}

CgaValue Deriver::cgaCompareOther(uint32_t code, const CgaValue& a, const CgaValue& b) {
  const auto isText = [](const CgaValue& v) { return v.type == kCgaString || v.type == kCgaWord; };
  if (isText(a) && isText(b)) {
    if (code == kCgaEqualCode) return cgaBoolValue(a.bits == b.bits);
    if (code == kCgaNotEqualCode) return cgaBoolValue(a.bits != b.bits);
    const int order = strings_.text(a.bits).compare(strings_.text(b.bits));
    return cgaBoolValue(cgaCompare(code, static_cast<float>(order), 0));
  }
  if (a.type == kCgaArray && b.type == kCgaArray && (code == kCgaEqualCode || code == kCgaNotEqualCode)) {
    const ArrayValue x = arrayOf(a), y = arrayOf(b);
    bool equal = x.values.size() == y.values.size();
    for (size_t i = 0; equal && i < x.values.size(); ++i)
      equal = x.values[i].type == y.values[i].type && x.values[i].bits == y.values[i].bits;
    return cgaBoolValue(equal == (code == kCgaEqualCode));
  }
  if (isText(a) != isText(b)) { // a string and a number are different, as long as they are only compared for that
    if (code == kCgaEqualCode) return cgaBoolValue(false);
    if (code == kCgaNotEqualCode) return cgaBoolValue(true);
    warn("comparison", "a string is compared with something that is not a string");
    return cgaBoolValue(false);
  }
  return cgaBoolValue(cgaCompare(code, number(a), number(b)));
}

CgaValue Deriver::cgaEach(uint32_t code, const CgaValue& a, const CgaValue& b) {
  ArrayValue x = a.type == kCgaArray ? arrayOf(a) : ArrayValue{{a}, 1};
  ArrayValue y = b.type == kCgaArray ? arrayOf(b) : ArrayValue{{b}, 1};
  if (a.type != kCgaArray) x.values.assign(y.values.size(), a);
  if (b.type != kCgaArray) y.values.assign(x.values.size(), b);
  ArrayValue result;
  result.columns = std::max(1u, a.type == kCgaArray ? x.columns : y.columns);
  for (size_t i = 0; i < std::min(x.values.size(), y.values.size()); ++i)
    result.values.push_back(cgaBinary(code, x.values[i], y.values[i]));
  return array(std::move(result));
}

CgaValue Deriver::size_(const Arguments& a) {
  return floatValue(a[0].type == kCgaArray ? static_cast<float>(arrayOf(a[0]).values.size()) : 1.0f);
}
CgaValue Deriver::nRows_(const Arguments& a) { return floatValue(static_cast<float>(arrayOf(a[0]).rows())); }
CgaValue Deriver::nColumns_(const Arguments& a) { return floatValue(static_cast<float>(arrayOf(a[0]).columns)); }
CgaValue Deriver::sum_(const Arguments& a) {
  float sum = 0;
  for (const CgaValue& v : arrayOf(a[0]).values) sum = add(sum, number(v));
  return floatValue(sum);
}
CgaValue Deriver::index_(const Arguments& a) { return findFirstIndex_(a); }
CgaValue Deriver::findFirstIndex_(const Arguments& a) {
  const ArrayValue& all = arrayOf(a[0]);
  for (size_t i = 0; i < all.values.size(); ++i)
    if (all.values[i].type == a[1].type && all.values[i].bits == a[1].bits) return floatValue(static_cast<float>(i));
  return floatValue(-1);
}
CgaValue Deriver::sortIndices_(const Arguments& a) {
  const ArrayValue all = arrayOf(a[0]);
  std::vector<size_t> order(all.values.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t i, size_t k) {
    const CgaValue &x = all.values[i], &y = all.values[k];
    return x.type == kCgaString && y.type == kCgaString ? strings_.text(x.bits) < strings_.text(y.bits)
                                                        : number(x) < number(y);
  });
  ArrayValue result;
  for (const size_t i : order) result.values.push_back(floatValue(static_cast<float>(i)));
  return array(std::move(result));
}
CgaValue Deriver::sort_(const Arguments& a) {
  const ArrayValue order = arrayOf(sortIndices_(a)), all = arrayOf(a[0]);
  ArrayValue result;
  for (const CgaValue& i : order.values) result.values.push_back(all.values[static_cast<size_t>(number(i))]);
  return array(std::move(result));
}
CgaValue Deriver::transpose_(const Arguments& a) {
  const ArrayValue from = arrayOf(a[0]);
  ArrayValue result;
  result.columns = std::max(1u, from.rows());
  for (uint32_t c = 0; c < from.columns; ++c)
    for (uint32_t r = 0; r < from.rows(); ++r) result.values.push_back(from.values[r * from.columns + c]);
  return array(std::move(result));
}

/// floatArray(n), floatArray(value, n), floatArray(value, rows, columns).
CgaValue Deriver::filled(uint32_t type, const Arguments& a) {
  const CgaValue value = a.count > 1 ? a[0] : cgaMake(type, 0);
  const float rows = a.count == 0 ? 0 : number(a[a.count == 1 ? 0 : 1]), columns = a.count > 2 ? number(a[2]) : 1;
  ArrayValue result;
  result.columns = static_cast<uint32_t>(std::clamp(columns, 1.0f, 1e6f));
  const float count = std::max(0.0f, std::floor(rows)) * static_cast<float>(result.columns);
  if (count > static_cast<float>(kMostValues)) {
    fail("an array has more than 4000000 values");
    return floatValue(0);
  }
  result.values.assign(static_cast<size_t>(count), value);
  return array(std::move(result));
}
CgaValue Deriver::floatArray_(const Arguments& a) { return filled(kCgaFloat, a); }
CgaValue Deriver::boolArray_(const Arguments& a) { return filled(kCgaBool, a); }
CgaValue Deriver::stringArray_(const Arguments& a) { return filled(kCgaString, a); }

/// Extents of an asset, and where its lowest corner is, metres.
CgaValue Deriver::assetInfo_(const Arguments& a) {
  const std::string path = text(a[0]);
  const std::string_view which = word(a[1]);
  std::string why;
  const Form* asset = assetForm(path, why);
  if (!asset) {
    warn("asset " + path, "nothing is known of the asset \"" + path + "\": " + why);
    return floatValue(0);
  }
  const int axis = which.ends_with('y') ? 1 : which.ends_with('z') ? 2 : 0;
  return floatValue(which.starts_with('t') ? asset->scope.origin[axis] : asset->scope.size[axis]);
}

CgaValue Deriver::clamp_(const Arguments& a) {
  const float low = number(a[1]), high = number(a[2]);
  return floatValue(std::max(low, std::min(number(a[0]), high)));
}

} // namespace gpgp::spawn::cga
