#include "tests/render/glsl_resources.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <regex>
#include <sstream>

namespace lackwerk::test {
namespace {

using Macros = std::map<std::string, long, std::less<>>;

/// Value of a preprocessor expression; unknown names are 0, as the language has it.
class Expression {
 public:
  Expression(std::string_view text, const Macros& macros) : text_(text), macros_(&macros) {}
  long value() { return either(); }

 private:
  void skip() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) ++at_;
  }
  bool take(std::string_view sign) {
    skip();
    if (text_.substr(at_, sign.size()) != sign) return false;
    at_ += sign.size();
    return true;
  }
  long either() {
    long v = both();
    while (take("||")) v = static_cast<long>((both() != 0) | (v != 0));
    return v;
  }
  long both() {
    long v = compared();
    while (take("&&")) v = static_cast<long>((compared() != 0) & (v != 0));
    return v;
  }
  long compared() {
    const long v = single();
    if (take("==")) return static_cast<long>(v == single());
    if (take("!=")) return static_cast<long>(v != single());
    if (take("<=")) return static_cast<long>(v <= single());
    if (take(">=")) return static_cast<long>(v >= single());
    if (take("<")) return static_cast<long>(v < single());
    if (take(">")) return static_cast<long>(v > single());
    return v;
  }
  long single() {
    if (take("!")) return static_cast<long>(single() == 0);
    if (take("(")) {
      const long v = either();
      (void)take(")");
      return v;
    }
    skip();
    const std::size_t begin = at_;
    while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) != 0 || text_[at_] == '_'))
      ++at_;
    const std::string word(text_.substr(begin, at_ - begin));
    if (word == "defined") {
      const bool bracket = take("(");
      skip();
      const std::size_t name = at_;
      while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) != 0 || text_[at_] == '_'))
        ++at_;
      const bool known = macros_->count(text_.substr(name, at_ - name)) != 0;
      if (bracket) (void)take(")");
      return static_cast<long>(known);
    }
    if (!word.empty() && std::isdigit(static_cast<unsigned char>(word[0])) != 0) return std::stol(word);
    const auto found = macros_->find(word);
    return found == macros_->end() ? 0 : found->second;
  }

  std::string_view text_;
  const Macros* macros_;
  std::size_t at_ = 0;
};

int columns_of(const std::string& type) {
  if (type == "vec2") return 2;
  if (type == "vec3") return 3;
  if (type == "vec4" || type == "mat4") return 4;
  return 1;
}

std::string without_comment(const std::string& line) { return line.substr(0, line.find("//")); }

bool used_again(const std::string& text, const std::string& name, std::size_t after) {
  const std::regex word("\\b" + name + "\\b");
  return std::regex_search(text.begin() + static_cast<std::ptrdiff_t>(after), text.end(), word);
}

}  // namespace

std::string preprocessed(std::string_view source) {
  Macros macros;
  std::vector<bool> open = {true};  // does the text count at each depth of #if
  std::istringstream lines{std::string(source)};
  std::string out, line;
  while (std::getline(lines, line)) {
    line = without_comment(line);
    std::istringstream words(line);
    std::string directive, name;
    words >> directive;
    const bool counts = std::all_of(open.begin(), open.end(), [](bool b) { return b; });
    if (directive == "#if") {
      open.push_back(Expression(std::string_view(line).substr(line.find("#if") + 3), macros).value() != 0);
    } else if (directive == "#ifdef" || directive == "#ifndef") {
      words >> name;
      open.push_back((macros.count(name) != 0) == (directive == "#ifdef"));
    } else if (directive == "#else") {
      open.back() = !open.back();
    } else if (directive == "#endif") {
      open.pop_back();
    } else if (directive == "#define" && counts) {
      std::string value;
      words >> name >> value;
      const bool number = !value.empty() && std::isdigit(static_cast<unsigned char>(value[0])) != 0;
      if (name.find('(') == std::string::npos) macros[name] = number ? std::stol(value) : 1;
      // Other macros' texts may use variables: they stay in the text.
      if (!number) out += line.substr(line.find(name) + name.size()) + "\n";
    } else if (counts && directive.rfind('#', 0) != 0) {
      out += line + "\n";
    }
  }
  for (const auto& [macro, value] : macros) {
    std::string brackets = "\\[";
    brackets.append(macro).append("\\]");
    out = std::regex_replace(out, std::regex(brackets), "[" + std::to_string(value) + "]");
  }
  return out;
}

std::vector<ShaderVariable> used_variables(const std::string& text, std::string_view storage) {
  std::vector<ShaderVariable> out;
  const std::regex declaration(
      "\\b" + std::string(storage) +
      R"(\s+(?:(?:lowp|mediump|highp)\s+)?(float|vec2|vec3|vec4|mat4)\s+(\w+)(?:\[(\d+)\])?\s*;)");
  for (std::sregex_iterator it(text.begin(), text.end(), declaration), end; it != end; ++it) {
    const std::smatch& found = *it;
    const std::string name = found[2];
    if (!used_again(text, name, static_cast<std::size_t>(found.position() + found.length()))) continue;
    const int count = found[3].matched ? std::stoi(found[3]) : 1;
    out.push_back({name, columns_of(found[1]), count * (found[1] == "mat4" ? 4 : 1)});
  }
  return out;
}

int used_samplers(const std::string& text) {
  const std::regex declaration(R"(\buniform\s+sampler2D\s+(\w+)\s*;)");
  int count = 0;
  for (std::sregex_iterator it(text.begin(), text.end(), declaration), end; it != end; ++it)
    count += used_again(text, (*it)[1], static_cast<std::size_t>(it->position() + it->length())) ? 1 : 0;
  return count;
}

// The specification's greedy order: four columns first, then three; two-column ones beside each other in rows of their
// own or in the columns 0 1 and 2 3; single ones in the fullest column that still has room, so that gaps are filled.
int packed_rows(std::vector<ShaderVariable> variables) {
  std::stable_sort(variables.begin(), variables.end(), [](const ShaderVariable& a, const ShaderVariable& b) {
    return a.columns != b.columns ? a.columns > b.columns : a.rows > b.rows;
  });
  constexpr int limit = 256;
  std::array<std::array<bool, 4>, limit> taken{};
  const auto fits = [&](int row, int column, const ShaderVariable& v) {
    for (int r = row; r < row + v.rows; ++r)
      for (int c = column; c < column + v.columns; ++c)
        if (r >= limit || taken[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)]) return false;
    return true;
  };
  for (const ShaderVariable& v : variables) {
    // Lowest row wherever it fits; two columns only at 0 or 2, three and four only at 0.
    const int step = v.columns == 2 ? 2 : 1, last = v.columns > 2 ? 0 : 4 - v.columns;
    int best_row = limit, best_column = 0;
    for (int column = 0; column <= last; column += step)
      for (int row = 0; row < best_row; ++row)
        if (fits(row, column, v)) {
          best_row = row;
          best_column = column;
        }
    for (int r = best_row; r < std::min(best_row + v.rows, limit); ++r)
      for (int c = best_column; c < best_column + v.columns; ++c)
        taken[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)] = true;
  }
  int rows = 0;
  for (int r = 0; r < limit; ++r)
    for (const bool cell : taken[static_cast<std::size_t>(r)])
      if (cell) rows = r + 1;
  return rows;
}

}  // namespace lackwerk::test
