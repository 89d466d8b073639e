// The stack language run plainly on real boxes, without an operator graph: what the compiled form must give. It knows
// boxes alone, and of the operators those that gml_random.cpp writes. Tokens are separated by white space.
#pragma once
#include <array>
#include <cctype>
#include <cmath>
#include <istream>
#include <map>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace gpgp::test {

struct PlainBox {
  int id = 0; ///< numbers that were read from a box are found by it
  double centre[3] = {}, size[3] = {}, axes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
};
struct PlainTerminal {
  std::string name;
  std::array<double, 12> transform;
};

class PlainMachine {
public:
  PlainMachine(const std::string& text, double x, double y, double z) {
    std::istringstream words(text);
    main_ = block(words, "");
    start_.size[0] = x;
    start_.size[1] = y;
    start_.size[2] = z;
  }
  std::vector<PlainTerminal> run() {
    registers_.emplace_back();
    runBlock(*main_);
    return std::move(terminals_);
  }

private:
  struct Block;
  struct Word {
    std::string text;
    std::shared_ptr<Block> block;
  };
  struct Block {
    std::vector<Word> words;
  };
  struct Value {
    enum Kind { number, shape, name, procedure, array } kind = number;
    double known = 0;
    std::map<int, double> each; ///< by box, instead of known
    std::vector<PlainBox> boxes;
    std::string text;
    std::shared_ptr<Block> block;
    std::vector<Value> items;

    double of(const PlainBox& box) const { return each.empty() ? known : each.at(box.id); }
  };
  struct Rule {
    int parameters = 0;
    std::shared_ptr<Block> block;
  };

  static std::shared_ptr<Block> block(std::istream& in, const std::string& end) {
    auto result = std::make_shared<Block>();
    std::string word;
    while (in >> word && word != end) result->words.push_back({word, word == "{" ? block(in, "}") : nullptr});
    return result;
  }
  Value pop() {
    if (stack_.empty()) throw std::runtime_error("the stack is empty");
    Value v = std::move(stack_.back());
    stack_.pop_back();
    return v;
  }
  double popKnown() {
    const Value v = pop();
    if (v.kind != Value::number || !v.each.empty()) throw std::runtime_error("no known number");
    return v.known;
  }
  void pushKnown(double x) {
    Value v;
    v.known = x;
    stack_.push_back(v);
  }
  void pushBoxes(std::vector<PlainBox> boxes) {
    Value v;
    v.kind = Value::shape;
    v.boxes = std::move(boxes);
    stack_.push_back(std::move(v));
  }

  template <class F> void binary(F f) {
    const Value b = pop(), a = pop();
    Value r;
    if (a.each.empty() && b.each.empty()) {
      r.known = f(a.known, b.known);
    } else {
      for (const auto& [id, x] : a.each.empty() ? b.each : a.each)
        r.each[id] = f(a.each.empty() ? a.known : x, b.each.empty() ? b.known : b.each.at(id));
    }
    stack_.push_back(r);
  }

  static void move(PlainBox& b, const double* by) {
    for (int i = 0; i < 3; ++i)
      for (int a = 0; a < 3; ++a) b.centre[i] += b.axes[a][i] * by[a];
  }
  static void turn(PlainBox& b, const double* degrees) {
    const double k = 3.14159265358979323846 / 180;
    const double sx = std::sin(degrees[0] * k), cx = std::cos(degrees[0] * k), sy = std::sin(degrees[1] * k),
                 cy = std::cos(degrees[1] * k), sz = std::sin(degrees[2] * k), cz = std::cos(degrees[2] * k);
    const double m[3][3] = {{cz * cy, cz * sy * sx - sz * cx, cz * sy * cx + sz * sx},
                            {sz * cy, sz * sy * sx + cz * cx, sz * sy * cx - cz * sx},
                            {-sy, cy * sx, cy * cx}};
    PlainBox r = b;
    for (int column = 0; column < 3; ++column)
      for (int i = 0; i < 3; ++i) {
        r.axes[column][i] = 0;
        for (int a = 0; a < 3; ++a) r.axes[column][i] += b.axes[a][i] * m[a][column];
      }
    b = r;
  }
  PlainBox piece(const PlainBox& b, int axis, double from, double extent) {
    PlainBox r = b;
    r.id = ++ids_;
    r.size[axis] = extent;
    double by[3] = {};
    by[axis] = from + extent / 2 - b.size[axis] / 2;
    move(r, by);
    return r;
  }

  void subdivide() {
    const Value parts = pop();
    const int axis = pop().text[0] - 'X';
    const Value shape = pop();
    std::vector<const Value*> values, procedures;
    for (const Value& v : parts.items) (v.kind == Value::procedure ? procedures : values).push_back(&v);
    std::vector<Value> made(values.size());
    for (Value& v : made) v.kind = Value::shape;
    for (const PlainBox& box : shape.boxes) {
      double lengths = 0, weights = 0, at = 0;
      for (const Value* v : values) (v->of(box) < 0 ? weights : lengths) += std::abs(v->of(box));
      const double rest = std::max(0.0, box.size[axis] - lengths);
      for (size_t i = 0; i < values.size(); ++i) {
        const double v = values[i]->of(box), extent = v < 0 ? rest * -v / weights : v, room = box.size[axis] - at;
        const bool allFit = rest > 0;
        if ((allFit || room > extent * 1e-4) && extent > 0)
          made[i].boxes.push_back(piece(box, axis, at, allFit ? extent : std::min(extent, room)));
        at += extent;
      }
    }
    if (procedures.empty()) {
      Value array;
      array.kind = Value::array;
      array.items = std::move(made);
      stack_.push_back(std::move(array));
      return;
    }
    for (size_t i = 0; i < made.size(); ++i) {
      stack_.push_back(made[i]);
      runBlock(*procedures[i]->block);
    }
  }

  void tile() {
    const Value extent = pop();
    const int axis = pop().text[0] - 'X';
    const Value shape = pop();
    std::vector<PlainBox> made;
    for (const PlainBox& box : shape.boxes) {
      const double size = box.size[axis], wanted = extent.of(box) < 0 ? size * -extent.of(box) : extent.of(box);
      if (!(wanted > 0) || !(size > 0)) continue;
      const int count = std::max(1, static_cast<int>(std::floor(size / wanted + 1e-4)));
      for (int i = 0; i < count; ++i) made.push_back(piece(box, axis, i * size / count, size / count));
    }
    pushBoxes(std::move(made));
  }

  void choose(const Value& condition, const Block* yes, const Block* no) {
    if (condition.each.empty()) {
      if (condition.known != 0)
        runBlock(*yes);
      else if (no)
        runBlock(*no);
      return;
    }
    size_t at = stack_.size();
    while (stack_[at - 1].kind != Value::shape) --at;
    const std::vector<PlainBox> all = stack_[at - 1].boxes;
    const std::vector<Value> before = stack_;
    std::vector<Value> left[2];
    for (int side = 0; side < 2; ++side) {
      stack_ = before;
      stack_[at - 1].boxes.clear();
      for (const PlainBox& box : all)
        if ((condition.of(box) != 0) == (side == 0)) stack_[at - 1].boxes.push_back(box);
      if (side == 0)
        runBlock(*yes);
      else if (no)
        runBlock(*no);
      left[side] = std::move(stack_);
    }
    stack_ = left[0];
    for (size_t i = at - 1; i < stack_.size(); ++i) { // a shape each, or a number of it
      stack_[i].boxes.insert(stack_[i].boxes.end(), left[1][i].boxes.begin(), left[1][i].boxes.end());
      if (stack_[i].kind != Value::number) continue;
      Value joined;
      for (const PlainBox& box : all) joined.each[box.id] = left[condition.of(box) != 0 ? 0 : 1][i].of(box);
      stack_[i] = joined;
    }
  }

  void runBlock(const Block& block) {
    for (const Word& word : block.words) runWord(word);
  }
  void runWord(const Word& word) {
    const std::string& w = word.text;
    if (++steps_ > 200000) throw std::length_error("too long");
    if (word.block) {
      Value v;
      v.kind = Value::procedure;
      v.block = word.block;
      stack_.push_back(v);
    } else if (std::isdigit(static_cast<unsigned char>(w[0])) || (w[0] == '-' && w.size() > 1)) {
      pushKnown(std::stof(w));
    } else if (w[0] == '/' || w == "X" || w == "Y" || w == "Z") {
      Value v;
      v.kind = Value::name;
      v.text = w[0] == '/' ? w.substr(1) : w;
      stack_.push_back(v);
    } else if (w[0] == '!') {
      registers_.back()[w.substr(1)] = pop();
    } else if (w[0] == ':') {
      stack_.push_back(registers_.back().at(w.substr(1)));
    } else if (definitions_.count(w)) {
      const Value v = definitions_.at(w);
      if (v.kind != Value::procedure) return stack_.push_back(v);
      registers_.emplace_back();
      runBlock(*v.block);
      registers_.pop_back();
    } else if (rules_.count(w)) {
      runRule(rules_.at(w));
    } else if (w[0] == 'T') {
      for (const PlainBox& b : pop().boxes) {
        PlainTerminal t;
        t.name = w;
        for (int row = 0; row < 3; ++row)
          for (int a = 0; a < 4; ++a)
            t.transform[static_cast<size_t>(4 * row + a)] = a == 3 ? b.centre[row] : b.axes[a][row] * b.size[a];
        terminals_.push_back(t);
        if (terminals_.size() > 4000) throw std::length_error("too many");
      }
    } else {
      runOperator(w);
    }
  }
  void runRule(const Rule& rule) {
    const auto parameters = static_cast<std::ptrdiff_t>(rule.parameters) + 1;
    std::vector<Value> own(stack_.end() - parameters, stack_.end());
    stack_.resize(stack_.size() - own.size());
    if (own[0].boxes.empty()) return;
    std::swap(stack_, own);
    registers_.emplace_back();
    runBlock(*rule.block);
    registers_.pop_back();
    std::swap(stack_, own);
  }

  void runOperator(const std::string& w) {
    const auto three = [&](auto change) {
      const Value c = pop(), b = pop(), a = pop();
      Value shape = pop();
      for (PlainBox& box : shape.boxes) {
        const double v[3] = {a.of(box), b.of(box), c.of(box)};
        change(box, v);
      }
      stack_.push_back(std::move(shape));
    };
    if (w == "add") return binary([](double a, double b) { return a + b; });
    if (w == "sub") return binary([](double a, double b) { return a - b; });
    if (w == "mul") return binary([](double a, double b) { return a * b; });
    if (w == "lt") return binary([](double a, double b) { return a < b ? 1.0 : 0.0; });
    if (w == "gt") return binary([](double a, double b) { return a > b ? 1.0 : 0.0; });
    if (w == "and") return binary([](double a, double b) { return a != 0 && b != 0 ? 1.0 : 0.0; });
    if (w == "translate") return three(move);
    if (w == "rotate") return three(turn);
    if (w == "scale")
      return three([](PlainBox& b, const double* v) {
        for (int i = 0; i < 3; ++i) b.size[i] = v[i] < 0 ? b.size[i] * -v[i] : v[i];
      });
    if (w == "subdiv") return subdivide();
    if (w == "tile") return tile();
    if (w == "nothing") return pushBoxes({});
    if (w == "axiom") return pop(), pushBoxes({start_});
    if (w == "dup") return stack_.push_back(Value(stack_.back()));
    if (w == "pop") return void(pop());
    if (w == "exch") return std::swap(stack_[stack_.size() - 1], stack_[stack_.size() - 2]);
    if (w == "index") {
      const auto below = static_cast<size_t>(popKnown());
      return stack_.push_back(Value(stack_[stack_.size() - 1 - below]));
    }
    if (w == "roll") {
      const int up = static_cast<int>(popKnown()), n = static_cast<int>(popKnown());
      for (int i = 0; i < ((up % n) + n) % n; ++i) {
        Value top = pop();
        stack_.insert(stack_.end() - (n - 1), std::move(top));
      }
      return;
    }
    if (w == "size") {
      const int axis = pop().text[0] - 'X';
      Value v;
      for (const PlainBox& box : stack_.back().boxes) v.each[box.id] = box.size[axis];
      if (v.each.empty()) v.each[-1] = 0;
      return stack_.push_back(v);
    }
    if (w == "def") {
      Value v = pop();
      definitions_[pop().text] = std::move(v);
      return;
    }
    if (w == "rule") {
      const Value body = pop();
      const int parameters = static_cast<int>(popKnown());
      rules_[pop().text] = {parameters, body.block};
      return;
    }
    if (w == "terminal") return void((pop(), pop(), pop()));
    if (w == "[") return marks_.push_back(stack_.size());
    if (w == "]") {
      Value v;
      v.kind = Value::array;
      v.items.assign(stack_.begin() + static_cast<std::ptrdiff_t>(marks_.back()), stack_.end());
      stack_.resize(marks_.back());
      marks_.pop_back();
      return stack_.push_back(std::move(v));
    }
    if (w == "aload") {
      const Value v = pop();
      stack_.insert(stack_.end(), v.items.begin(), v.items.end());
      return;
    }
    if (w == "forall" || w == "map") {
      const Value body = pop(), array = pop();
      Value made;
      made.kind = Value::array;
      for (const Value& item : array.items) {
        stack_.push_back(item);
        runBlock(*body.block);
        if (w == "map") made.items.push_back(pop());
      }
      if (w == "map") stack_.push_back(std::move(made));
      return;
    }
    if (w == "repeat" || w == "for") {
      const Value body = pop();
      const double last = popKnown(), step = w == "for" ? popKnown() : 1, first = w == "for" ? popKnown() : 1;
      for (double i = first; i < last + 0.5 * step; i += step) {
        if (w == "for") pushKnown(i);
        runBlock(*body.block);
      }
      return;
    }
    if (w == "ifelse") {
      const Value no = pop(), yes = pop(), condition = pop();
      return choose(condition, yes.block.get(), no.block.get());
    }
    if (w == "if") {
      const Value yes = pop(), condition = pop();
      return choose(condition, yes.block.get(), nullptr);
    }
    if (w == "exec") {
      const Value body = pop();
      return runBlock(*body.block);
    }
    throw std::runtime_error("the plain machine does not know " + w);
  }

  std::shared_ptr<Block> main_;
  PlainBox start_;
  std::vector<Value> stack_;
  std::vector<size_t> marks_;
  std::map<std::string, Value> definitions_;
  std::map<std::string, Rule> rules_;
  std::vector<std::map<std::string, Value>> registers_;
  std::vector<PlainTerminal> terminals_;
  int ids_ = 0;
  size_t steps_ = 0;
};

} // namespace gpgp::test
