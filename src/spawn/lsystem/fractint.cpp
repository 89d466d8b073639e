// Systems as Fractint and its successors have them (.l files of entries, name { ... }), as a File.
//
// Such a system lies in a plane, has no parameters, and begins to the right. F and G turn by + and - alone, in steps of
// a full turn divided by `angle`; D and M by \ and / alone, in degrees. Each is what the turtle does here; what would
// need both in one system is refused. @ scales all that comes behind it up to the end of its branch, which depends on
// the place, as strings do not know: here symbols have that scale as a parameter, and a scale that leaves the rule that
// it stands in may not reach anything that draws.
#include "core/suggest.h"
#include "spawn/lsystem/format.h"
#include "spawn/lsystem/scanner.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace gpgp::spawn::lsystem {
namespace {

using namespace shader;

char lowered(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; }
bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v'; }

/// A character of a system in small letters, with its place.
struct Character {
  char c;
  Place place;
};
using Text = std::vector<Character>;

struct Entry {
  std::string name;
  Place place;
  std::vector<Text> lines;
  bool isClosed = false;
};

std::string plain(const Text& text) {
  std::string result;
  for (const Character& c : text) result += c.c;
  return result;
}

/// Entries with what stands between their braces, without comments.
std::vector<Entry> entriesOf(std::string_view text) {
  std::vector<Entry> entries;
  bool isOpen = false;
  uint32_t number = 0;
  std::string heading; // of the line, up to a brace
  for (size_t at = 0; at <= text.size();) {
    const size_t newline = std::min(text.find('\n', at), text.size());
    std::string_view line = text.substr(at, newline - at);
    line = line.substr(0, line.find(';'));
    ++number;
    Text open;
    uint32_t headingColumn = 1;
    for (size_t i = 0; i < line.size(); ++i) {
      const Place place{number, static_cast<uint32_t>(i + 1)};
      if (!isOpen && line[i] == '{') {
        Entry entry;
        entry.name = heading.substr(0, heading.find_first_of(" \t("));
        entry.place = {number, headingColumn};
        entries.push_back(std::move(entry));
        isOpen = true;
      } else if (!isOpen) {
        if (heading.empty() && isBlank(line[i])) continue;
        if (heading.empty()) headingColumn = place.column;
        heading += line[i];
      } else if (line[i] == '}') {
        if (!open.empty()) entries.back().lines.push_back(std::move(open));
        open.clear();
        entries.back().isClosed = true;
        isOpen = false;
        heading.clear();
      } else if (line[i] != '\r') {
        open.push_back({lowered(line[i]), place});
      }
    }
    if (!open.empty()) entries.back().lines.push_back(std::move(open));
    heading.clear();
    at = newline + 1;
  }
  return entries;
}

bool hasAxiom(const Entry& entry) {
  return std::any_of(entry.lines.begin(), entry.lines.end(), [](const Text& line) {
    std::string text = plain(line);
    text.erase(0, text.find_first_not_of(" \t\f\v"));
    return text.starts_with("axiom ") || text.starts_with("axiom\t") || text.starts_with("axiom=");
  });
}

/// A symbol or command, and the number that it has.
struct Piece {
  char c;
  double number = 0;
  Place place;
};
using Pieces = std::vector<Piece>;

class Fractint {
public:
  Fractint(const Entry& entry, Diagnostics& diagnostics) : entry_(entry), diagnostics_(diagnostics) {
    file_.systems.emplace_back();
    file_.segmentShape = GPGP_SHAPE_PRISM6;
  }

  File run() {
    for (const Text& line : entry_.lines) readLine(line);
    if (!entry_.isClosed) diagnostics_.error(entry_.place, "'" + entry_.name + "' has no '}'");
    if (!axiom_ && !diagnostics_.hasErrors())
      diagnostics_.error(entry_.place,
                         "'" + entry_.name + "' has no axiom; a line 'Axiom F' is where derivation begins");
    if (angle_ == 0 && !diagnostics_.hasErrors())
      diagnostics_.error(entry_.place, "'" + entry_.name + "' has no angle; 'Angle 6' is a sixth of a full turn");
    if (diagnostics_.hasErrors()) return std::move(file_);
    weigh();
    findLeaks();
    if (diagnostics_.hasErrors()) return std::move(file_);
    set(file_.settings.angle, 360.0f / static_cast<float>(angle_));
    set(file_.settings.iterations, 2);
    file_.drawing.emplace_back("D", Place{});
    file_.moving.emplace_back("m", Place{});
    ModuleString axiom{turn("-", 90, axiom_->empty() ? entry_.place : axiom_->front().place)}; // to the right
    const ModuleString rest = string(*axiom_, false);
    axiom.insert(axiom.end(), rest.begin(), rest.end());
    file_.systems[0].axiom = std::move(axiom);
    for (const auto& [symbol, rule] : rules_) {
      Production p;
      p.phase = kPhaseMain;
      p.place = rule.place;
      p.predecessor.name = nameOf(symbol);
      p.predecessor.place = rule.place;
      if (scales_) p.predecessor.arguments.push_back(scaleName(rule.place));
      p.successor = string(rule.pieces, true);
      file_.systems[0].productions.push_back(std::move(p));
    }
    return std::move(file_);
  }

private:
  struct Rule {
    Place place;
    Pieces pieces;
    bool leaks = false; ///< the scale behind it is another one than before it
  };

  static void set(std::optional<Expression>& setting, float value) {
    setting.emplace();
    setting->number = value;
  }

  void readLine(const Text& line) {
    size_t at = 0;
    const auto blanks = [&](bool equals) {
      while (at < line.size() && (isBlank(line[at].c) || (equals && line[at].c == '='))) ++at;
    };
    const auto word = [&](bool endsAtEquals) {
      Text text;
      while (at < line.size() && !isBlank(line[at].c) && !(endsAtEquals && line[at].c == '='))
        text.push_back(line[at++]);
      return text;
    };
    blanks(true);
    if (at >= line.size()) return;
    const Place place = line[at].place;
    const std::string name = plain(word(true));
    blanks(true);
    const bool isRule = name.size() == 1;
    const Text value = word(false);
    if (name == "axiom") {
      axiom_ = pieces(value);
    } else if (name == "angle") {
      const int angle = std::atoi(plain(value).c_str());
      if (angle < 3 || angle > 50)
        diagnostics_.error(place, "'Angle' is a whole number from 3 to 50: the part of a full turn; found '" +
                                      plain(value) + "'");
      angle_ = angle;
    } else if (isRule && std::string_view("+-/\\@|!c<>][").find(name[0]) != std::string_view::npos) {
      diagnostics_.error(place, "'" + name + "' is a command; a rule is for another symbol");
    } else if (isRule) { // a second rule of a symbol goes on with the first
      Rule& rule = rules_.try_emplace(name[0], Rule{place, {}, false}).first->second;
      const Pieces more = pieces(value);
      rule.pieces.insert(rule.pieces.end(), more.begin(), more.end());
    } else {
      core::Suggestion suggestion(name);
      suggestion.offer("axiom");
      suggestion.offer("angle");
      diagnostics_.error(place, "expected 'Axiom', 'Angle' or a rule such as 'F=F+F--F+F'; found '" + name + "'" +
                                    suggestion.text());
      return;
    }
    blanks(false);
    if (at < line.size()) diagnostics_.error(line[at].place, "a string has no blanks; found more behind it");
  }

  Pieces pieces(const Text& text) {
    Pieces all;
    for (size_t i = 0; i < text.size(); ++i) {
      Piece piece{text[i].c, 0, text[i].place};
      if (std::string_view("@\\/c<>").find(piece.c) != std::string_view::npos) {
        bool isRoot = false, isInverse = false;
        const bool isLength = piece.c == '@';
        while (i + 1 < text.size() && (text[i + 1].c == 'q' || text[i + 1].c == 'i'))
          (text[++i].c == 'q' ? isRoot : isInverse) = true;
        std::string number;
        while (i + 1 < text.size() && ((text[i + 1].c >= '0' && text[i + 1].c <= '9') || text[i + 1].c == '.'))
          number += text[++i].c;
        piece.number = std::atof(number.c_str());
        if (isLength && piece.number <= 0)
          diagnostics_.error(piece.place, "'@' is followed by a factor above 0, as in '@.5', '@I2' and '@Q2'");
        if (isRoot) piece.number = std::sqrt(piece.number);
        if (isInverse && piece.number > 0) piece.number = 1 / piece.number;
      }
      all.push_back(piece);
    }
    return all;
  }

  template <class Visit> void forPieces(const Visit& visit) {
    for (const Piece& p : *axiom_) visit(p);
    for (const auto& [symbol, rule] : rules_)
      for (const Piece& p : rule.pieces) visit(p);
  }

  /// Which of the two ways to turn the system has, and what it needs besides.
  void weigh() {
    std::optional<Place> steps, degrees;
    bool reverses = false;
    forPieces([&](const Piece& p) {
      if ((p.c == 'f' || p.c == 'g') && !steps) steps = p.place;
      if ((p.c == 'd' || p.c == 'm') && !degrees) degrees = p.place;
      scales_ = scales_ || p.c == '@';
      reverses = reverses || p.c == '!';
    });
    turnsByDegrees_ = degrees && !steps;
    if (steps && degrees)
      diagnostics_.error(*degrees, "D and M, which turn by \\ and / alone, and F and G, which turn by + and - alone, "
                                   "in one system are not supported");
    if (reverses && angle_ % 2 == 1 && !turnsByDegrees_)
      forPieces([&](const Piece& p) {
        if (p.c == '|') diagnostics_.error(p.place, "'|' of an odd angle in a system that has '!' is not supported");
      });
  }

  /// Scales that leave their rule, and what they would reach.
  void findLeaks() {
    for (bool changed = scales_; changed;) {
      changed = false;
      for (auto& [symbol, rule] : rules_)
        if (!rule.leaks && leaves(rule.pieces, false)) rule.leaks = changed = true;
    }
    if (!scales_) return;
    leaves(*axiom_, true);
    for (const auto& [symbol, rule] : rules_) leaves(rule.pieces, true);
  }
  /// Whether the scale behind a string is not the one before it; tells: of what draws where it is not known.
  bool leaves(const Pieces& string, bool tells) {
    struct State {
      double scale = 1;
      bool isKnown = true;
    };
    std::vector<State> states(1);
    for (const Piece& p : string) {
      if (p.c == '[') states.push_back(states.back());
      if (p.c == ']' && states.size() > 1) states.pop_back();
      if (p.c == '@') states.back().scale *= p.number;
      if (!isSymbol(p.c)) continue;
      const auto rule = rules_.find(p.c);
      const bool matters = rule != rules_.end() || isDrawing(p.c);
      if (tells && matters && !states.back().isKnown) {
        diagnostics_.error(p.place, "the scale here depends on the rule of a symbol before it, which leaves another "
                                    "scale behind than it found; this is not supported");
        return true;
      }
      if (rule != rules_.end() && rule->second.leaks) states.back().isKnown = false;
    }
    return !states[0].isKnown || std::fabs(states[0].scale - 1) > 1e-6;
  }

  static bool isSymbol(char c) { return std::string_view("+-/\\@|!c<>[]").find(c) == std::string_view::npos; }
  static bool isDrawing(char c) { return c == 'f' || c == 'g' || c == 'd' || c == 'm'; }

  /// Names that draw or move here what they do there; letters that would do something else are small.
  static std::string nameOf(char symbol) {
    if (symbol == 'f') return "F";
    if (symbol == 'g') return "f"; // which moves, and is no letter of theirs
    if (symbol == 'm') return "m";
    const char capital = symbol >= 'a' && symbol <= 'z' ? static_cast<char>(symbol - 32) : symbol;
    const bool isPlain = capital != symbol || (symbol >= '0' && symbol <= '9');
    for (const char c : {capital, symbol})
      if (isPlain && turtleOf(std::string(1, c)) == kTurtleNone) return std::string(1, c);
    return std::string("_") + symbol; // names of several letters do nothing
  }

  Expression scaleName(Place place) const {
    Expression e;
    e.kind = Expression::Kind::name;
    e.name = "s";
    e.place = place;
    return e;
  }
  static Expression numberOf(double value, Place place) {
    Expression e;
    e.number = static_cast<float>(value);
    e.place = place;
    return e;
  }
  static Module turn(const char* name, double degrees, Place place) {
    return {name, {}, {numberOf(degrees, place)}, place};
  }

  ModuleString string(const Pieces& pieces, bool inRule) {
    ModuleString all;
    std::vector<double> scales(1, 1.0);
    for (const Piece& p : pieces) {
      const auto add = [&](const char* name) { all.push_back({name, {}, {}, p.place}); };
      switch (p.c) {
      case '+':
      case '-':
        if (!turnsByDegrees_) add(p.c == '+' ? "+" : "-");
        break;
      case '\\':
      case '/':
        if (turnsByDegrees_) all.push_back(turn(p.c == '\\' ? "+" : "-", p.number, p.place));
        break;
      case '|': // as near to a half turn as steps come; always to the right
        if (turnsByDegrees_) break;
        if (angle_ % 2 == 0)
          add("|");
        else
          all.push_back(turn("-", 360.0 / angle_ * (angle_ / 2), p.place));
        break;
      case '!': all.push_back(turn("/", 180, p.place)); break; // left and right change places in a plane
      case '@': scales.back() *= p.number; break;
      case 'c': all.push_back({";", {}, {numberOf(p.number, p.place)}, p.place}); break;
      case '<':
      case '>':
        if (isColourTold_) break;
        isColourTold_ = true;
        diagnostics_.warning(p.place, std::string("'") + p.c + "', which changes the colour by steps, has no effect");
        break;
      case '[':
        scales.push_back(scales.back());
        add("[");
        break;
      case ']':
        if (scales.size() > 1) scales.pop_back();
        add("]");
        break;
      default: {
        Module m{nameOf(p.c), {}, {}, p.place};
        if (scales_) {
          Expression scale = numberOf(scales.back(), p.place);
          if (inRule) scale = operation(kLsysMultiply, p.place, {scaleName(p.place), std::move(scale)});
          m.arguments.push_back(std::move(scale));
        }
        all.push_back(std::move(m));
      }
      }
    }
    return all;
  }

  const Entry& entry_;
  Diagnostics& diagnostics_;
  std::optional<Pieces> axiom_;
  std::map<char, Rule> rules_;
  int angle_ = 0;
  bool scales_ = false, turnsByDegrees_ = false, isColourTold_ = false;
  File file_;
};

} // namespace

bool isOfFractint(std::string_view text) {
  const std::vector<Entry> entries = entriesOf(text);
  return std::any_of(entries.begin(), entries.end(), hasAxiom);
}

File parseFractint(std::string_view text, Diagnostics& diagnostics, std::string_view start) {
  const std::vector<Entry> entries = entriesOf(text);
  core::Suggestion suggestion{std::string(start)};
  const Entry* found = nullptr;
  size_t systems = 0;
  for (const Entry& entry : entries) {
    if (!hasAxiom(entry)) continue;
    ++systems;
    suggestion.offer(entry.name);
    if (!found && (start.empty() || entry.name == start)) found = &entry;
  }
  if (!found) {
    diagnostics.error({}, "there is no system '" + std::string(start) + "' in the file" + suggestion.text());
    File none;
    none.systems.emplace_back();
    return none;
  }
  if (start.empty() && systems > 1)
    diagnostics.info(found->place, "this file has " + std::to_string(systems) + " systems; '" + found->name +
                                       "', the first, is read");
  return Fractint(*found, diagnostics).run();
}

} // namespace gpgp::spawn::lsystem
