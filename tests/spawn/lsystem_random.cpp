#include "lsystem_random.h"

#include <algorithm>
#include <functional>

namespace gpgp::test {
namespace {

/// A branch: modules and branches in a row.
struct Branch;
struct Item {
  PlainModule module;
  std::unique_ptr<Branch> branch; ///< else the module counts
  size_t place = 0;               ///< of the module in the string
};
struct Branch {
  Branch* around = nullptr;
  size_t at = 0; ///< its place among the items around it
  std::vector<Item> items;
};

class Tree {
public:
  Tree(const PlainString& string, const std::string& ignored) : ignored_(ignored) {
    size_t place = 0;
    fill(root_, string, place);
  }

  /// Calls visit(branch, index) for each module in order.
  void each(const std::function<void(Branch&, size_t)>& visit) { each(root_, visit); }

  bool seen(const Item& item) const { return item.branch || ignored_.find(item.module.name) == std::string::npos; }

  /// The module before an item on the way to the root.
  std::pair<Branch*, size_t> before(Branch* branch, size_t index) const {
    for (;;) {
      while (index-- > 0)
        if (!branch->items[index].branch && seen(branch->items[index])) return {branch, index};
      if (!branch->around) return {nullptr, 0};
      index = branch->at;
      branch = branch->around;
    }
  }

  /// Matches a pattern from an item of a branch on, up to the end or the ']' that closes it; takes what it matched.
  bool matches(const Branch& branch, size_t index, const std::string& pattern, size_t& p,
               std::vector<const PlainModule*>& taken) const {
    while (p < pattern.size()) {
      if (pattern[p] == ']') return true;
      if (pattern[p] == '[') {
        while (index < branch.items.size() && !seen(branch.items[index])) ++index;
        if (index == branch.items.size() || !branch.items[index].branch) return false;
        if (!matches(*branch.items[index].branch, 0, pattern, ++p, taken)) return false;
        ++p; // the ']'
        ++index;
        continue;
      }
      while (index < branch.items.size() && (branch.items[index].branch || !seen(branch.items[index]))) ++index;
      if (index == branch.items.size() || branch.items[index].module.name != pattern[p]) return false;
      taken.push_back(&branch.items[index].module);
      ++p;
      ++index;
    }
    return true;
  }

  Branch& root() { return root_; }

private:
  void fill(Branch& branch, const PlainString& string, size_t& place) {
    while (place < string.size()) {
      const PlainModule& m = string[place];
      if (m.name == ']') return;
      Item item;
      item.place = place++;
      if (m.name == '[') {
        item.branch = std::make_unique<Branch>();
        item.branch->around = &branch;
        item.branch->at = branch.items.size();
        fill(*item.branch, string, place);
        ++place;
      } else {
        item.module = m;
      }
      branch.items.push_back(std::move(item));
    }
  }
  void each(Branch& branch, const std::function<void(Branch&, size_t)>& visit) {
    for (size_t i = 0; i < branch.items.size(); ++i) {
      if (branch.items[i].branch) {
        visit(branch, i);
        each(*branch.items[i].branch, visit);
      } else {
        visit(branch, i);
      }
    }
  }
  std::string ignored_;
  Branch root_;
};

PlainString make(const std::vector<PlainMade>& made, const std::vector<int>& variables) {
  PlainString string;
  for (const PlainMade& m : made) {
    PlainModule module{m.name, {}};
    for (const PlainValue& v : m.values)
      module.values.push_back((v.variable < 0 ? 0 : variables[static_cast<size_t>(v.variable)]) * v.factor + v.term);
    string.push_back(std::move(module));
  }
  return string;
}

std::string text(const std::vector<PlainMade>& made) {
  std::string all;
  for (const PlainMade& m : made) {
    all += m.name;
    for (size_t i = 0; i < m.values.size(); ++i) {
      const PlainValue& v = m.values[i];
      all += i ? ", " : "(";
      if (v.variable >= 0)
        all +=
            "v" + std::to_string(v.variable) + " * " + std::to_string(v.factor) + " + (" + std::to_string(v.term) + ")";
      else
        all += std::to_string(v.term);
    }
    if (!m.values.empty()) all += ')';
  }
  return all;
}

} // namespace

std::string print(const PlainString& string) {
  std::string all;
  for (const PlainModule& m : string) {
    all += m.name;
    for (size_t i = 0; i < m.values.size(); ++i) all += (i ? "," : "(") + std::to_string(m.values[i]);
    if (!m.values.empty()) all += ')';
  }
  return all;
}

std::string PlainSystem::text() const {
  std::string all = "axiom: " + test::text(axiom) + "\niterations: " + std::to_string(iterations) + "\n";
  if (!ignored.empty()) {
    all += "ignore:";
    for (const char c : ignored) all += std::string(" ") + c;
    all += '\n';
  }
  for (const PlainProduction& p : productions) {
    int variable = 0;
    const auto module = [&](char name, int first) {
      std::string m(1, name);
      if (name < 'A' || name > 'D') return m;
      for (int i = 0; i < arity[name - 'A']; ++i) m += (i ? ",v" : "(v") + std::to_string(first + i);
      return arity[name - 'A'] ? m + ")" : m;
    };
    const auto count = [&](char name) { return name >= 'A' && name <= 'D' ? arity[name - 'A'] : 0; };
    const std::string own = module(p.name, 0);
    variable = count(p.name);
    // Variables are numbered from the nearest module of the left context on.
    std::string left, right;
    for (size_t i = p.left.size(); i-- > 0;) {
      left = module(p.left[i], variable) + " " + left;
      variable += count(p.left[i]);
    }
    for (const char c : p.right) {
      right += module(c, variable);
      variable += count(c);
    }
    if (!left.empty()) all += left + "< ";
    all += own;
    if (!right.empty()) all += " > " + right;
    if (variable) all += " : v0 >= " + std::to_string(p.least) + " && v0 <= " + std::to_string(p.most);
    all += " --> " + test::text(p.made) + "\n";
  }
  return all;
}

std::optional<PlainString> PlainSystem::derive(int count, size_t most) const {
  PlainString string = make(axiom, {});
  for (int step = 0; step < count; ++step) {
    Tree tree(string, ignored);
    std::vector<std::optional<PlainString>> becomes(string.size());
    std::vector<bool> removed(string.size());
    // A cut removes all behind it up to the end of its branch.
    std::function<void(Branch&, bool)> cut = [&](Branch& branch, bool gone) {
      for (Item& item : branch.items) {
        if (!item.branch && item.module.name == '%') gone = true;
        removed[item.place] = gone;
        if (item.branch) {
          cut(*item.branch, gone);
          size_t depth = 1, end = item.place;
          while (depth) {
            ++end;
            if (string[end].name == '[') ++depth;
            if (string[end].name == ']') --depth;
          }
          removed[end] = gone;
        }
      }
    };
    cut(tree.root(), false);
    tree.each([&](Branch& branch, size_t index) {
      const Item& item = branch.items[index];
      if (item.branch) return;
      for (const PlainProduction& p : productions) {
        if (p.name != item.module.name) continue;
        std::vector<int> variables = item.module.values;
        std::pair<Branch*, size_t> at{&branch, index};
        bool holds = true;
        for (size_t i = p.left.size(); holds && i-- > 0;) {
          at = tree.before(at.first, at.second);
          holds = at.first && at.first->items[at.second].module.name == p.left[i];
          if (holds) {
            const auto& values = at.first->items[at.second].module.values;
            variables.insert(variables.end(), values.begin(), values.end());
          }
        }
        if (!holds) continue;
        std::vector<const PlainModule*> taken;
        size_t position = 0;
        if (!tree.matches(branch, index + 1, p.right, position, taken)) continue;
        for (const PlainModule* m : taken) variables.insert(variables.end(), m->values.begin(), m->values.end());
        if (!variables.empty() && (variables[0] < p.least || variables[0] > p.most)) continue;
        becomes[item.place] = make(p.made, variables);
        break;
      }
    });
    PlainString next;
    for (size_t i = 0; i < string.size(); ++i) {
      if (removed[i]) continue;
      if (becomes[i])
        next.insert(next.end(), becomes[i]->begin(), becomes[i]->end());
      else
        next.push_back(string[i]);
    }
    string = std::move(next);
    if (string.size() > most) return std::nullopt;
  }
  return string;
}

PlainSystem randomSystem(std::mt19937& random) {
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  PlainSystem s;
  for (int& a : s.arity) a = below(3);
  if (below(2)) s.ignored = below(2) ? "+" : "D";
  s.iterations = 1 + below(4);
  const auto letter = [&] { return static_cast<char>('A' + below(4)); };
  const auto string = [&](int length, int variables) {
    std::vector<PlainMade> made;
    int open = 0;
    const bool cuts = below(8) == 0;
    for (int i = 0; i < length; ++i) {
      const int kind = below(10);
      if (kind < 2) {
        made.push_back({'[', {}});
        ++open;
      } else if (kind < 4 && open) {
        made.push_back({']', {}});
        --open;
      } else if (kind == 4) {
        made.push_back({'+', {}});
      } else if (kind == 5 && cuts) {
        made.push_back({'%', {}});
      } else {
        PlainMade m{letter(), {}};
        for (int p = 0; p < s.arity[m.name - 'A']; ++p)
          m.values.push_back({variables ? below(variables + 1) - 1 : -1, below(2), below(5) - 1});
        made.push_back(std::move(m));
      }
    }
    for (; open; --open) made.push_back({']', {}});
    return made;
  };
  s.axiom = string(3 + below(10), 0);
  const int productions = 1 + below(6);
  for (int i = 0; i < productions; ++i) {
    PlainProduction p;
    p.name = letter();
    const auto context = [&](char c) { return s.ignored.find(c) == std::string::npos; };
    if (below(2))
      for (int k = below(3); k > 0; --k)
        if (const char c = letter(); context(c)) p.left += c;
    if (below(2)) {
      int open = 0;
      for (int k = below(4); k > 0; --k) {
        if (below(4) == 0) {
          p.right += '[';
          ++open;
        } else if (open && below(3) == 0) {
          p.right += ']';
          --open;
        } else if (const char c = letter(); context(c)) {
          p.right += c;
        }
      }
      for (; open; --open) p.right += ']';
    }
    int variables = s.arity[p.name - 'A'];
    for (const char c : p.left + p.right)
      if (c >= 'A' && c <= 'D') variables += s.arity[c - 'A'];
    p.least = below(3) - 1;
    p.most = p.least + below(6);
    p.made = string(below(6), variables);
    s.productions.push_back(std::move(p));
  }
  return s;
}

} // namespace gpgp::test
