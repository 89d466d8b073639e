// Arrays, and what the machine leaves to the deriver where values are not two numbers.
#include "spawn/cga/deriver.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace gpgp::spawn::cga {

namespace {
/// What stands for a value that an array does not have.
CgaValue noneOf(uint32_t type) { return cgaMake(type == kCgaBool || type == kCgaString ? type : kCgaFloat, 0); }
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

/// Values in brackets. Arrays among them are joined: of one row each to one row, of several rows side by side.
CgaValue Deriver::cgaArray(uint32_t first, uint32_t count) {
  ArrayValue result;
  uint32_t rows = 1;
  for (uint32_t i = 0; i < count; ++i)
    if (stack_[first + i].type == kCgaArray) rows = std::max(rows, arrayOf(stack_[first + i]).rows());
  for (uint32_t row = 0; row < rows; ++row)
    for (uint32_t i = 0; i < count; ++i) {
      const CgaValue v = stack_[first + i];
      if (v.type != kCgaArray) {
        if (rows > 1 && row == 0) warn("array rows", "values of one row and of several are side by side in an array");
        result.values.push_back(v);
        continue;
      }
      const ArrayValue part = arrayOf(v);
      if (part.rows() != rows && part.rows() && row == 0)
        warn("array rows", "arrays of " + std::to_string(part.rows()) + " and of " + std::to_string(rows) +
                               " rows are side by side in an array");
      const size_t width = part.columns(), from = row * width;
      for (size_t c = 0; c < width; ++c)
        result.values.push_back(from + c < part.values.size() ? part.values[from + c] : floatValue(0));
      if (result.values.size() > kMostValues) {
        fail("an array has more than 4000000 values");
        return array(std::move(result));
      }
    }
  if (rows > 1) result.width = static_cast<uint32_t>(result.values.size()) / rows;
  return array(std::move(result));
}

/// Arrays one below the other; shorter rows end with the values that stand for none.
CgaValue Deriver::arrayRows_(const Arguments& a) {
  ArrayValue result;
  uint32_t width = 0;
  for (uint32_t i = 0; i < a.count; ++i) width = std::max(width, arrayOf(a[i]).columns());
  for (uint32_t i = 0; i < a.count; ++i) {
    const ArrayValue part = arrayOf(a[i]);
    if (part.columns() != width) warn("array columns", "the rows of an array have different numbers of values");
    for (uint32_t row = 0; row < part.rows(); ++row)
      for (uint32_t c = 0; c < width; ++c)
        result.values.push_back(c < part.columns() ? part.values[row * part.columns() + c]
                                                   : noneOf(part.values.front().type));
    if (result.values.size() > kMostValues) {
      fail("an array has more than 4000000 values");
      break;
    }
  }
  result.width = width;
  return array(std::move(result));
}

/// first:last and first:step:last.
CgaValue Deriver::sequence_(const Arguments& a) {
  const float first = number(a[0]), last = number(a[a.count - 1]), step = a.count == 3 ? number(a[1]) : 1.0f;
  ArrayValue result;
  if (step == 0) warn("sequence", "a sequence has the step 0, and no values");
  const double count = step == 0 ? 0.0 : std::floor((double{last} - double{first}) / double{step} + 1e-6) + 1;
  if (count > static_cast<double>(kMostValues)) {
    fail("an array has more than 4000000 values");
    return floatValue(0);
  }
  for (double i = 0; i < count; i += 1)
    result.values.push_back(floatValue(add(first, multiply(static_cast<float>(i), step))));
  return array(std::move(result));
}

/// The beginning and the end of an index of which one is left out; columns 0 tell it from arrays.
CgaValue Deriver::cgaRange(const CgaValue& a, const CgaValue& b) {
  ArrayValue range;
  range.width = 0;
  range.values = {a, b};
  return array(std::move(range));
}

/// The places that an index means, -1 where there is none: of a number one, of an array of numbers as many, of an array
/// of conditions where they hold. Returns the array of the index, or nothing for a number.
CgaValue Deriver::placesOf(const CgaValue& v, uint32_t size, std::vector<int64_t>& places) {
  const auto take = [&](float at) {
    at = std::floor(at);
    places.push_back(at >= 0 && at < 1e9f ? static_cast<int64_t>(at) : -1);
  };
  if (v.type != kCgaArray) {
    take(number(v));
    return cgaMake(kCgaNothing, 0);
  }
  const ArrayValue which = arrayOf(v);
  if (which.width == 0) {
    const float begin = which.values[0].type == kCgaNothing ? 0 : std::floor(number(which.values[0]));
    const float end = which.values[1].type == kCgaNothing ? static_cast<float>(size) - 1
                                                          : std::min(number(which.values[1]), static_cast<float>(size));
    for (float at = std::max(begin, -1e6f); at <= end; at += 1) take(at);
  } else if (!which.values.empty() && which.values[0].type == kCgaBool) {
    for (uint32_t i = 0; i < which.values.size(); ++i)
      if (which.values[i].bits) places.push_back(i);
  } else {
    for (const CgaValue& at : which.values) take(number(at));
  }
  return v;
}

CgaValue Deriver::cgaIndex(uint32_t first, uint32_t count) {
  if (stack_[first].type != kCgaArray) {
    warn("index", "[ ] follows something that is not an array");
    return stack_[first];
  }
  const ArrayValue from = arrayOf(stack_[first]);
  const CgaValue none = noneOf(from.values.empty() ? kCgaFloat : from.values[0].type);
  const auto at = [&](int64_t i) {
    return i >= 0 && i < static_cast<int64_t>(from.values.size()) ? from.values[static_cast<size_t>(i)] : none;
  };
  ArrayValue result;
  if (count == 1) {
    std::vector<int64_t> places;
    const CgaValue index = placesOf(stack_[first + 1], static_cast<uint32_t>(from.values.size()), places);
    if (index.type == kCgaNothing) return at(places[0]);
    for (const int64_t i : places) result.values.push_back(at(i));
    const ArrayValue& shape = arrayOf(index);
    if (shape.width != 0 && shape.values.size() == places.size()) result.width = shape.width;
    return array(std::move(result));
  }
  std::vector<int64_t> rows, columns;
  const CgaValue row = placesOf(stack_[first + 1], from.rows(), rows);
  const CgaValue column = placesOf(stack_[first + 2], from.columns(), columns);
  if (rows.size() * columns.size() > kMostValues) {
    fail("an array has more than 4000000 values");
    return floatValue(0);
  }
  for (const int64_t r : rows)
    for (const int64_t c : columns)
      result.values.push_back(c >= 0 && c < static_cast<int64_t>(from.columns()) && r >= 0
                                  ? at(r * static_cast<int64_t>(from.columns()) + c)
                                  : none);
  if (row.type == kCgaNothing && column.type == kCgaNothing) return result.values[0];
  result.width = static_cast<uint32_t>(columns.size());
  if (result.width == 0) result.width = ArrayValue::kOneRow;
  return array(std::move(result));
}

/// setElems(array, indices, values), setElems(array, rows, columns, values): places beyond the array make it larger.
CgaValue Deriver::setElems_(const Arguments& a) {
  if (a[0].type != kCgaArray) {
    warn("setElems", "setElems needs an array first");
    return a[0];
  }
  ArrayValue to = arrayOf(a[0]);
  const CgaValue& value = a[a.count - 1];
  const ArrayValue values = value.type == kCgaArray ? arrayOf(value) : ArrayValue{};
  const auto valueAt = [&](size_t i) {
    return value.type != kCgaArray ? value : i < values.values.size() ? values.values[i] : floatValue(0);
  };
  const CgaValue none = noneOf(to.values.empty() ? valueAt(0).type : to.values[0].type);
  std::vector<int64_t> rows, columns;
  placesOf(a[1], a.count == 3 ? static_cast<uint32_t>(to.values.size()) : to.rows(), rows);
  if (a.count == 4) placesOf(a[2], to.columns(), columns);
  const size_t needed = a.count == 3 ? rows.size() : rows.size() * columns.size();
  if (value.type == kCgaArray && values.values.size() != needed)
    warn("setElems count",
         "setElems sets " + std::to_string(needed) + " places to " + std::to_string(values.values.size()) + " values");
  const auto most = [](const std::vector<int64_t>& places) {
    int64_t m = -1;
    for (const int64_t p : places) m = std::max(m, p);
    return static_cast<size_t>(m + 1);
  };
  size_t width = to.columns(), height = to.rows();
  if (a.count == 4) {
    width = std::max(width, most(columns));
    height = std::max(height, most(rows));
  } else if (const size_t last = most(rows); last > to.values.size()) {
    if (height > 1)
      height = (last + width - 1) / width;
    else
      width = last, height = 1;
  }
  if (width > kMostValues || height > kMostValues || width * height > kMostValues) {
    fail("an array has more than 4000000 values");
    return floatValue(0);
  }
  if (width != to.columns() || height != to.rows()) {
    ArrayValue larger;
    larger.width = height > 1 ? static_cast<uint32_t>(width) : ArrayValue::kOneRow;
    larger.values.assign(width * height, none);
    for (size_t r = 0; r < to.rows(); ++r)
      for (size_t c = 0; c < to.columns(); ++c) larger.values[r * width + c] = to.values[r * to.columns() + c];
    to = std::move(larger);
  }
  size_t next = 0;
  if (a.count == 3) {
    for (const int64_t i : rows) {
      if (i >= 0) to.values[static_cast<size_t>(i)] = valueAt(next);
      ++next;
    }
  } else {
    for (const int64_t r : rows)
      for (const int64_t c : columns) {
        if (r >= 0 && c >= 0) to.values[static_cast<size_t>(r) * width + static_cast<size_t>(c)] = valueAt(next);
        ++next;
      }
  }
  return array(std::move(to));
}

CgaValue Deriver::isNull_(const Arguments& a) {
  return cgaBoolValue(a[0].type == kCgaNothing || (a[0].type == kCgaString && text(a[0]) == "\\ue000"));
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
    bool equal = x.values.size() == y.values.size() && x.columns() == y.columns();
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
  ArrayValue x = a.type == kCgaArray ? arrayOf(a) : ArrayValue{};
  ArrayValue y = b.type == kCgaArray ? arrayOf(b) : ArrayValue{};
  if (a.type != kCgaArray) x.values.assign(b.type == kCgaArray ? y.values.size() : 1, a);
  if (b.type != kCgaArray) y.values.assign(x.values.size(), b);
  ArrayValue result;
  result.width = a.type == kCgaArray ? x.width : y.width;
  if (x.values.size() != y.values.size())
    warn("element-wise", "an operator of elements stands between arrays of different sizes");
  for (size_t i = 0; i < std::min(x.values.size(), y.values.size()); ++i)
    result.values.push_back(cgaBinary(code, x.values[i], y.values[i]));
  if (result.values.size() != (a.type == kCgaArray ? x : y).values.size()) result.width = ArrayValue::kOneRow;
  return array(std::move(result));
}
CgaValue Deriver::eachAnd_(const Arguments& a) {
  ArrayValue x = arrayOf(a[0]);
  const ArrayValue y = arrayOf(a[1]);
  for (size_t i = 0; i < x.values.size(); ++i)
    x.values[i] = cgaBoolValue(cgaIsTrue(x.values[i]) && i < y.values.size() && cgaIsTrue(y.values[i]));
  return array(std::move(x));
}
CgaValue Deriver::eachOr_(const Arguments& a) {
  ArrayValue x = arrayOf(a[0]);
  const ArrayValue y = arrayOf(a[1]);
  for (size_t i = 0; i < x.values.size(); ++i)
    x.values[i] = cgaBoolValue(cgaIsTrue(x.values[i]) || (i < y.values.size() && cgaIsTrue(y.values[i])));
  return array(std::move(x));
}
CgaValue Deriver::eachNot_(const Arguments& a) {
  ArrayValue x = arrayOf(a[0]);
  for (CgaValue& v : x.values) v = cgaBoolValue(!cgaIsTrue(v));
  return array(std::move(x));
}

CgaValue Deriver::size_(const Arguments& a) {
  return floatValue(a[0].type == kCgaArray ? static_cast<float>(arrayOf(a[0]).values.size()) : 1.0f);
}
CgaValue Deriver::nRows_(const Arguments& a) { return floatValue(static_cast<float>(arrayOf(a[0]).rows())); }
CgaValue Deriver::nColumns_(const Arguments& a) { return floatValue(static_cast<float>(arrayOf(a[0]).columns())); }
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
/// Of each row by itself, as indices into the whole.
CgaValue Deriver::sortIndices_(const Arguments& a) {
  const ArrayValue all = arrayOf(a[0]);
  std::vector<size_t> order(all.values.size());
  std::iota(order.begin(), order.end(), size_t{0});
  for (uint32_t row = 0; row < all.rows(); ++row) {
    const auto begin = order.begin() + static_cast<ptrdiff_t>(size_t{row} * all.columns());
    std::stable_sort(begin, begin + all.columns(),
                     [&](size_t i, size_t k) { return isLess(all.values[i], all.values[k]); });
  }
  ArrayValue result;
  result.width = all.width;
  for (const size_t i : order) result.values.push_back(floatValue(static_cast<float>(i)));
  return array(std::move(result));
}
CgaValue Deriver::sortRowIndices_(const Arguments& a) {
  const ArrayValue all = arrayOf(a[0]);
  std::vector<size_t> order(all.rows());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t i, size_t k) {
    for (size_t c = 0; c < all.columns(); ++c) {
      const CgaValue &x = all.values[i * all.columns() + c], &y = all.values[k * all.columns() + c];
      if (isLess(x, y)) return true;
      if (isLess(y, x)) return false;
    }
    return false;
  });
  ArrayValue result;
  for (const size_t i : order) result.values.push_back(floatValue(static_cast<float>(i)));
  return array(std::move(result));
}
bool Deriver::isLess(const CgaValue& x, const CgaValue& y) const {
  return x.type == kCgaString && y.type == kCgaString ? strings_.text(x.bits) < strings_.text(y.bits)
                                                      : number(x) < number(y);
}
CgaValue Deriver::sort_(const Arguments& a) {
  const ArrayValue order = arrayOf(sortIndices_(a)), all = arrayOf(a[0]);
  ArrayValue result;
  result.width = all.width;
  for (const CgaValue& i : order.values) result.values.push_back(all.values[static_cast<size_t>(number(i))]);
  return array(std::move(result));
}
CgaValue Deriver::transpose_(const Arguments& a) {
  const ArrayValue from = arrayOf(a[0]);
  ArrayValue result;
  result.width = std::max(1u, from.rows());
  for (uint32_t c = 0; c < from.columns(); ++c)
    for (uint32_t r = 0; r < from.rows(); ++r) result.values.push_back(from.values[r * from.columns() + c]);
  return array(std::move(result));
}

/// floatArray(n), floatArray(value, n), floatArray(value, rows, columns).
CgaValue Deriver::filled(uint32_t type, const Arguments& a) {
  const CgaValue value = a.count > 1 ? a[0] : cgaMake(type, 0);
  const float rows = a.count == 0 ? 0 : number(a[a.count == 1 ? 0 : 1]), columns = a.count > 2 ? number(a[2]) : 1;
  ArrayValue result;
  const float width = std::floor(std::clamp(columns, 1.0f, 1e6f));
  if (a.count > 2) result.width = static_cast<uint32_t>(width);
  const float count = std::max(0.0f, std::floor(rows)) * width;
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

CgaValue Deriver::clamp_(const Arguments& a) {
  const float low = number(a[1]), high = number(a[2]);
  return floatValue(std::max(low, std::min(number(a[0]), high)));
}

} // namespace gpgp::spawn::cga
